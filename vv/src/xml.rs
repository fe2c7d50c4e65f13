//! The little XML that figures and VTK files need: texts and attribute values, written and read
//! back.

/// Characters that cannot stand in an attribute value, with what stands for them. `&` comes first:
/// the entities put in after it are left alone, and undone before it.
const ENTITIES: [(char, &str); 4] = [('&', "&amp;"), ('<', "&lt;"), ('>', "&gt;"), ('"', "&quot;")];

/// Whether XML forbids a character, or need not keep it.
pub(crate) fn is_odd(c: char) -> bool {
    c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}')
}

/// Whether `text` can be an attribute value that survives every XML parser unchanged.
pub(crate) fn is_plain(text: &str) -> bool {
    !text.is_empty() && !text.contains(is_odd)
}

/// `text` as a text or an attribute value.
pub(crate) fn escape(text: &str) -> String {
    let replace = |text: String, &(c, entity): &(char, &str)| text.replace(c, entity);
    ENTITIES.iter().fold(text.to_owned(), replace)
}

/// The text that an attribute value made by [`escape`] stands for.
pub(crate) fn unescape(text: &str) -> String {
    let restore = |text: String, &(c, entity): &(char, &str)| text.replace(entity, &c.to_string());
    ENTITIES.iter().rev().fold(text.to_owned(), restore)
}

/// The value of the attribute `name` of the element in `line`, still escaped.
pub(crate) fn attribute<'a>(line: &'a str, name: &str) -> Option<&'a str> {
    let start = line.find(&format!(" {name}=\""))? + name.len() + 3;
    line[start..].split_once('"').map(|(value, _)| value)
}
