//! Inline markup, and what it becomes in HTML, Markdown and plain text.

use pulldown_latex::config::DisplayMode;
use pulldown_latex::{Parser, ParserError, RenderConfig, Storage, push_mathml};

/// A piece of marked-up text.
#[derive(Debug, PartialEq)]
enum Span<'a> {
    /// A single sign taken literally.
    Sign(char),
    Code(&'a str),
    Math(&'a str),
    Emphasis(&'a str),
    Link(&'a str, &'a str),
}

/// Splits a text; marks without a partner are ordinary signs.
fn spans(text: &str) -> Vec<Span<'_>> {
    let mut spans = Vec::new();
    let mut rest = text;
    while let Some(sign) = rest.chars().next() {
        let after = &rest[sign.len_utf8()..];
        let found = match sign {
            '\\' => after
                .chars()
                .next()
                .filter(char::is_ascii_punctuation)
                .map(|c| (Span::Sign(c), &after[c.len_utf8()..])),
            '`' => closed(after, '`').map(|(code, rest)| (Span::Code(code), rest)),
            '*' => tight(after, '*').map(|(text, rest)| (Span::Emphasis(text), rest)),
            // A price, "$5 and $6", is no formula.
            '$' => tight(after, '$')
                .filter(|(_, rest)| !rest.starts_with(|c: char| c.is_ascii_digit()))
                .map(|(tex, rest)| (Span::Math(tex), rest)),
            '[' => link(after),
            _ => None,
        };
        let (span, tail) = found.unwrap_or((Span::Sign(sign), after));
        spans.push(span);
        rest = tail;
    }
    spans
}

/// The text before a closing mark, and the rest.
fn closed(text: &str, mark: char) -> Option<(&str, &str)> {
    text.split_once(mark).filter(|(inner, _)| !inner.is_empty())
}

/// The same, with no space at the inner sides of the marks.
fn tight(text: &str, mark: char) -> Option<(&str, &str)> {
    let spaced = |t: &str| t.starts_with(char::is_whitespace) || t.ends_with(char::is_whitespace);
    closed(text, mark).filter(|(inner, _)| !spaced(inner))
}

fn link(text: &str) -> Option<(Span<'_>, &str)> {
    let (name, rest) = closed(text, ']')?;
    let (address, rest) = closed(rest.strip_prefix('(')?, ')')?;
    // An address without scheme is relative; of the schemes only harmless ones are let through.
    let scheme = address.split_once(':').map(|(scheme, _)| scheme);
    let harmless = scheme.is_none_or(|s| ["http", "https", "mailto"].contains(&s));
    let whole = !address.contains(|c: char| c.is_whitespace() || "<>\"'".contains(c));
    (harmless && whole).then_some((Span::Link(name, address), rest))
}

/// Marked-up text as HTML.
pub(super) fn html(text: &str) -> String {
    written(text, |_| true)
}

/// The same for a page that stands alone: links to files beside it are their text.
pub(super) fn html_alone(text: &str) -> String {
    written(text, |address| address.starts_with('#') || address.contains(':'))
}

/// Marked-up text as HTML, with those links whose addresses `leads` lets through.
fn written(text: &str, leads: fn(&str) -> bool) -> String {
    let mut out = String::new();
    for span in spans(text) {
        match span {
            Span::Sign(c) => out.push_str(&escape(c.encode_utf8(&mut [0; 4]))),
            Span::Code(code) => out.push_str(&format!("<code>{}</code>", escape(code))),
            Span::Math(tex) => out.push_str(&math(tex, DisplayMode::Inline)),
            Span::Emphasis(text) => out.push_str(&format!("<em>{}</em>", written(text, leads))),
            Span::Link(text, address) if leads(address) => {
                let text = written(text, leads);
                out.push_str(&format!("<a href=\"{}\">{text}</a>", escape(address)));
            }
            Span::Link(text, _) => out.push_str(&written(text, leads)),
        }
    }
    out
}

/// Marked-up text as GitHub-flavoured Markdown, on one line.
pub(super) fn markdown(text: &str) -> String {
    let mut out = String::new();
    for span in spans(text) {
        match span {
            Span::Sign('\n') => out.push(' '),
            Span::Sign(c) => {
                if "\\`*_[]<>|$#~".contains(c) {
                    out.push('\\');
                }
                out.push(c);
            }
            Span::Code(code) => out.push_str(&format!("`{}`", code.replace('|', "\\|"))),
            Span::Math(tex) => out.push_str(&format!("${}$", tex.replace('|', "\\vert "))),
            Span::Emphasis(text) => out.push_str(&format!("*{}*", markdown(text))),
            Span::Link(text, to) => out.push_str(&format!("[{}]({to})", markdown(text))),
        }
    }
    out
}

/// Marked-up text without its marks.
pub(super) fn plain(text: &str) -> String {
    let mut out = String::new();
    for span in spans(text) {
        match span {
            Span::Sign(c) => out.push(c),
            Span::Code(text) | Span::Math(text) => out.push_str(text),
            Span::Emphasis(text) | Span::Link(text, _) => out.push_str(&plain(text)),
        }
    }
    out
}

/// A displayed formula as MathML.
pub(super) fn display(tex: &str) -> String {
    math(tex, DisplayMode::Block)
}

/// TeX as MathML; what is no valid TeX is shown as it stands.
fn math(tex: &str, display_mode: DisplayMode) -> String {
    let storage = Storage::new();
    let events: Result<Vec<_>, ParserError> = Parser::new(tex, &storage).collect();
    let config = RenderConfig { display_mode, annotation: Some(tex), ..RenderConfig::default() };
    let mut out = String::new();
    let drawn = events.is_ok_and(|events| {
        let events = events.into_iter().map(Ok::<_, ParserError>);
        push_mathml(&mut out, events, config).is_ok()
    });
    if drawn { out } else { format!("<code class=\"tex\">{}</code>", escape(tex)) }
}

/// Text with the signs that mean something in HTML replaced.
pub(super) fn escape(text: &str) -> String {
    let named = [('&', "&amp;"), ('<', "&lt;"), ('>', "&gt;"), ('"', "&quot;"), ('\'', "&#39;")];
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match named.iter().find(|(sign, _)| *sign == c) {
            Some((_, name)) => out.push_str(name),
            None => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_in_three_forms() {
        let text =
            "See *all of* `a|b` in [the code](https://example.org) <b>, 2 * 3 and $5 or \\*.";
        assert_eq!(
            html(text),
            "See <em>all of</em> <code>a|b</code> in <a href=\"https://example.org\">the code</a> \
             &lt;b&gt;, 2 * 3 and $5 or *."
        );
        assert_eq!(
            markdown(text),
            "See *all of* `a\\|b` in [the code](https://example.org) \\<b\\>, 2 \\* 3 and \\$5 or \\*."
        );
        assert_eq!(plain(text), "See all of a|b in the code <b>, 2 * 3 and $5 or *.");
        let links = "[a](#a) [b](records/b.json)";
        assert_eq!(html(links), "<a href=\"#a\">a</a> <a href=\"records/b.json\">b</a>");
        assert_eq!(html_alone(links), "<a href=\"#a\">a</a> b");
    }

    #[test]
    fn formulas_become_mathml_or_stay() {
        assert!(html("$\\|e\\|_2$").starts_with("<math"));
        assert_eq!(html("$\\frac{$"), "<code class=\"tex\">\\frac{</code>");
    }

    #[test]
    fn scripts_do_not_get_through() {
        assert!(!html("[x](javascript:alert(1))").contains("href"));
        assert!(!html("[x](a\"onclick=\"b)").contains("href"));
        assert!(!html("[`<script>`](#a)").contains("<script>"));
    }
}
