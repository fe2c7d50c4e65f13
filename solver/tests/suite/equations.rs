//! Which equations of the paper the sources cite.

use std::collections::BTreeSet;
use std::path::Path;

/// Equations of the paper.
const ALL: std::ops::RangeInclusive<u32> = 1..=83;

/// Numbers of equations that a comment cites: `(34)`, `(51)-(53)`.
fn cited(comment: &str) -> BTreeSet<u32> {
    let mut numbers = BTreeSet::new();
    let mut last: Option<(u32, &str)> = None;
    let mut rest = comment;
    while let Some(open) = rest.find('(') {
        let (before, inside) = (&rest[..open], &rest[open + 1..]);
        let called = before.ends_with(|c: char| c.is_alphanumeric() || c == '_');
        let number = inside.split_once(')').filter(|_| !called);
        let number = number.and_then(|(n, behind)| Some((n.parse::<u32>().ok()?, behind)));
        let Some((number, behind)) = number.filter(|(n, _)| ALL.contains(n)) else {
            rest = inside;
            continue;
        };
        let from = match last {
            Some((first, tail))
                if tail.len() == before.len() + rest.len() - open && before == "-" =>
            {
                first
            }
            _ => number,
        };
        numbers.extend(from..=number);
        last = Some((number, behind));
        rest = behind;
    }
    numbers
}

/// Numbers cited by the documentation comments of a folder of sources.
fn cited_below(folder: &Path) -> BTreeSet<u32> {
    let mut numbers = BTreeSet::new();
    for entry in std::fs::read_dir(folder).expect("a folder of sources") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            numbers.extend(cited_below(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            let text = std::fs::read_to_string(&path).expect("a source");
            let comment: Vec<&str> = text
                .lines()
                .filter_map(|line| {
                    let line = line.trim_start();
                    line.strip_prefix("///").or_else(|| line.strip_prefix("//!"))
                })
                .map(str::trim)
                .collect();
            numbers.extend(cited(&comment.join(" ")));
        }
    }
    numbers
}

/// Every equation is cited by an item.
#[test]
fn every_equation_is_cited() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut found = cited_below(&root.join("solver/src"));
    found.extend(cited_below(&root.join("vv/src")));
    let missing: Vec<u32> = ALL.filter(|n| !found.contains(n)).collect();
    assert!(missing.is_empty(), "not cited by any item: {missing:?}");
}

/// What counts as a citation.
#[test]
fn citations_are_read() {
    let read = |text: &str| cited(text).into_iter().collect::<Vec<_>>();
    assert_eq!(read("Eq. (34)"), [34]);
    assert_eq!(read("Eqs. (51)-(53) and (74), but f(3), (84), (x) and G18"), [51, 52, 53, 74]);
    assert_eq!(read("eqs (81), (82)"), [81, 82]);
    assert_eq!(read("a - (2)"), [2]);
}
