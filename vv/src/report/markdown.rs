//! The report as GitHub-flavoured Markdown, with links to the files beside it.

use super::inline::{markdown as rich, plain};
use super::model::{Align, Block, Cell, Report, Status, Table};
use super::outline::outline;

/// The report as Markdown; figures are links to `figures/ID.svg`, pictures to `figures/ID.png`.
pub fn markdown(report: &Report) -> String {
    let mut parts = vec![format!("# {}", rich(&report.title))];
    let counts: Vec<_> =
        report.summary.counts.iter().map(|(s, n)| format!("{n} {}", s.word())).collect();
    parts.extend([&report.subtitle, &report.summary.text].map(|text| rich(text)));
    parts.push(if counts.is_empty() {
        String::new()
    } else {
        format!("**{}**", counts.join(", "))
    });
    for chapter in outline(report) {
        let marks = "#".repeat((chapter.depth + 2).min(6));
        let (anchor, title) = (anchor("", &chapter.section.id), rich(&chapter.section.title));
        parts.push(format!("{marks} {anchor}{} {title}", chapter.number));
        parts.extend(chapter.blocks.iter().map(|(number, content)| block(*number, content)));
    }
    parts.retain(|part| !part.is_empty());
    parts.join("\n\n") + "\n"
}

fn block(number: usize, block: &Block) -> String {
    match block {
        Block::Paragraph(text) => rich(text),
        Block::Equation { tex, number } => {
            let tag = number.as_ref().map(|n| format!(" \\tag{{{n}}}")).unwrap_or_default();
            format!("$$\n{}{tag}\n$$", tex.trim())
        }
        Block::Table(content) => table(number, content),
        Block::Figure { id, caption } => figure(number, (id, "svg"), caption),
        Block::Picture { id, caption } => figure(number, (id, "png"), caption),
        Block::List(items) => lines(items.iter().map(|item| format!("- {}", rich(item)))),
        Block::Definitions(pairs) => {
            let item =
                |(name, text): &(String, String)| format!("- **{}**: {}", rich(name), rich(text));
            lines(pairs.iter().map(item))
        }
        Block::Callout { kind, text } => {
            let name = match kind {
                Status::Pass => "TIP",
                Status::Fail => "CAUTION",
                Status::Warn => "WARNING",
                Status::Stale => "IMPORTANT",
                Status::Info => "NOTE",
            };
            format!("> [!{name}]\n> {}", rich(text))
        }
    }
}

fn figure(number: usize, (id, kind): (&str, &str), caption: &str) -> String {
    let name = plain(caption).replace(['[', ']', '\n'], " ");
    let (anchor, caption) = (anchor("fig-", id), rich(caption));
    format!("{anchor}![{name}](figures/{id}.{kind})\n\n**Figure {number}** – {caption}")
}

fn table(number: usize, table: &Table) -> String {
    let head = table.columns.iter().map(|column| match column.unit.as_str() {
        "" => rich(&column.name),
        unit => format!("{} / {}", rich(&column.name), rich(unit)),
    });
    let align = table.columns.iter().map(|column| match column.align {
        Align::Left => ":--".to_owned(),
        Align::Center => ":-:".to_owned(),
        Align::Right => "--:".to_owned(),
    });
    let rows = table.rows.iter().map(|cells| row(cells.iter().map(cell)));
    let grid = lines([row(head), row(align)].into_iter().chain(rows));
    let (anchor, caption) = (anchor("tab-", &table.id), rich(&table.caption));
    let file = format!("[CSV](tables/{}.csv)", table.id);
    format!("{anchor}**Table {number}** – {caption} ({file})\n\n{grid}")
}

/// The target of links into the report, named as in the page.
fn anchor(kind: &str, id: &str) -> String {
    format!("<a id=\"{kind}{id}\"></a>")
}

fn cell(cell: &Cell) -> String {
    let text = rich(&cell.text);
    match (cell.status, cell.remark()) {
        (Some(status), Some(word)) => format!("{text} {} {word}", status.sign()),
        (Some(status), None) => format!("{} {text}", status.sign()),
        _ => text,
    }
}

fn row(cells: impl Iterator<Item = String>) -> String {
    format!("| {} |", cells.collect::<Vec<_>>().join(" | "))
}

fn lines(lines: impl Iterator<Item = String>) -> String {
    lines.collect::<Vec<_>>().join("\n")
}
