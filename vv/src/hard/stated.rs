//! The list of hard cases: what is set up, and what decides.

use serde::Deserialize;

/// The lists, as they stand in `references/`: the given one, and that of this project's own invention.
const LISTS: [&str; 2] = [
    include_str!("../../../references/hard_cases.toml"),
    include_str!("../../../references/own_cases.toml"),
];

/// How much a failure weighs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    /// It blocks a release.
    Must,
    /// It is reported with its reason.
    Should,
}

impl Severity {
    /// Name for tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Must => "must",
            Self::Should => "should",
        }
    }
}

/// A case as the list states it.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stated {
    /// Its name in commands and tables, H01 to H30 and W01 to W10.
    pub id: String,
    /// What it is called.
    pub name: String,
    /// What is set up.
    pub setup: String,
    /// What decides.
    pub pass: String,
    /// Why it is in the list.
    #[serde(default)]
    pub why: String,
    /// How much a failure weighs.
    pub severity: Severity,
}

/// The hard cases of both lists; without those of one that cannot be read, which a test excludes.
#[must_use]
pub fn stated() -> Vec<Stated> {
    #[derive(Deserialize)]
    struct List {
        case: Vec<Stated>,
    }
    let read = |list: &str| toml::from_str::<List>(list).map(|list| list.case).unwrap_or_default();
    LISTS.into_iter().flat_map(read).collect()
}
