//! Sizes and memory: what is said before a run that cannot be, or that is large.

use whipple_solver::error::SceneError;
use whipple_solver::method::Density;

use super::run::named_variants;
use super::{Failure, say};
use crate::cases::{Case, Level};
use crate::memory::{Fit, Keeps, Need, available, bytes_text, fit};
use crate::record::{RunKey, Scheme};
use crate::scene::AnyScene;
use crate::suite::scene_of;

/// How far beyond a size that does not fit the next is looked for.
const FURTHER: usize = 100;

/// A run this many times as large as the largest of the levels is mentioned.
const UNTRIED: usize = 8;

/// Why a case cannot run so, and how it can.
pub(super) fn cannot(case: &dyn Case, key: &RunKey, error: &SceneError) -> Failure {
    let fits = |key: RunKey| scene_of(case, &key).is_none_or(|scene| scene.validate().is_ok());
    let sized = |n: usize| fits(RunKey { n, ..key.clone() });
    // Where the size of the case does not help, none does.
    if sized(case.default_size()) {
        no_size(case, key, error, sized)
    } else {
        no_scheme(case, key, error, fits)
    }
}

/// A scheme that the case cannot run under, and what else it could be.
fn no_scheme(
    case: &dyn Case,
    key: &RunKey,
    error: &SceneError,
    fits: impl Fn(RunKey) -> bool,
) -> Failure {
    let Scheme::Particles { preset, .. } = key.scheme else { return Failure::usage(error) };
    let n = case.default_size();
    let densities = Density::ALL.into_iter().map(|density| {
        let scheme = Scheme::Particles { preset, density };
        (RunKey { scheme, n, ..key.clone() }, format!("`--density {}`", density.name()))
    });
    let variants = named_variants(case).into_iter().map(|variant| {
        (RunKey { n, ..key.clone() }.variant(variant), format!("`--variant {variant}`"))
    });
    let ways = densities.chain(variants).filter_map(|(key, way)| fits(key).then_some(way));
    let advice = match ways.collect::<Vec<String>>().join(" or ") {
        none if none.is_empty() => none,
        ways => format!("; use {ways}"),
    };
    Failure::usage(format!(
        "`{}` cannot run under `{}`: {error}{advice}",
        case.id(),
        key.scheme.label()
    ))
}

/// A size that the case cannot have, and the nearest that it can.
fn no_size(
    case: &dyn Case,
    key: &RunKey,
    error: &SceneError,
    fits: impl Fn(usize) -> bool,
) -> Failure {
    let n = key.n;
    let advice = match (n + 1..=n.saturating_add(FURTHER)).find(|&n| fits(n)) {
        Some(next) => format!("the next size that it can have is {next}"),
        None => {
            format!("the largest that it can have is {}", largest(case.default_size(), n, fits))
        }
    };
    let (n, why) = (grouped(n as u64), with_groups(&error.to_string()));
    Failure::usage(format!("`{}` cannot have --n {n}: {why}; {advice}", case.id()))
}

/// The largest size that fits, between one that does and one that does not.
fn largest(mut low: usize, mut high: usize, fits: impl Fn(usize) -> bool) -> usize {
    while low + 1 < high {
        let middle = low + (high - low) / 2;
        if fits(middle) { low = middle } else { high = middle }
    }
    low
}

/// The largest size that the levels run.
pub(super) fn largest_tried(case: &dyn Case) -> usize {
    let sizes = case.runs(Level::Full).into_iter().map(|key| key.n);
    sizes.max().unwrap_or(0).max(case.default_size())
}

/// Refuses what needs more memory than there is, and mentions what is large. The size is given with the
/// option that sets it.
pub(super) fn expect(
    case: &dyn Case,
    size: (&str, usize),
    scene: &AnyScene,
    keeps: Keeps,
) -> Result<(), Failure> {
    foresee(case, size, scene, keeps)?.iter().for_each(|note| say(&format!("note: {note}")));
    Ok(())
}

/// As [`expect`], and returns what is to be mentioned.
pub(super) fn foresee(
    case: &dyn Case,
    size: (&str, usize),
    scene: &AnyScene,
    keeps: Keeps,
) -> Result<Option<String>, Failure> {
    outlook(case, size, Need::of(scene, keeps), available()).map_err(Failure::usage)
}

/// What is said of a need where so much memory is available; refused in the error.
fn outlook(
    case: &dyn Case,
    (option, n): (&str, usize),
    need: Need,
    available: Option<u64>,
) -> Result<Option<String>, String> {
    let what = format!(
        "`{}` with {option} {n} has about {} particles and needs about {} of memory",
        case.id(),
        grouped(need.particles),
        bytes_text(need.bytes)
    );
    let room = available.map_or(String::new(), bytes_text);
    let tried = largest_tried(case);
    match fit(need, available) {
        Fit::Not => Err(format!("{what}, and {room} are available; take a smaller {option}")),
        Fit::Tightly => Ok(Some(format!("{what}, more than half of the {room} available"))),
        Fit::Well if n > UNTRIED * tried => Ok(Some(format!(
            "{what}; the largest size of the levels is {tried}, and steps grow in number with n as well"
        ))),
        Fit::Well => Ok(None),
    }
}

/// A count with its digits in groups of three, if it has more than four.
pub(super) fn grouped(count: u64) -> String {
    in_groups(&count.to_string())
}

/// Digits in groups of three, if there are more than four.
fn in_groups(digits: &str) -> String {
    let mut out = String::new();
    for (k, digit) in digits.chars().enumerate() {
        if digits.len() > 4 && k > 0 && (digits.len() - k).is_multiple_of(3) {
            out.push(' ');
        }
        out.push(digit);
    }
    out
}

/// A text with the digits of its whole numbers in groups.
fn with_groups(text: &str) -> String {
    let number = |word: &str| word.chars().all(|c| c.is_ascii_digit());
    let words =
        text.split(' ').map(|word| if number(word) { in_groups(word) } else { word.into() });
    words.collect::<Vec<String>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases::{ALL, find};
    use whipple_solver::method::Preset;

    /// What is wrong with a size of a case.
    fn wrong(case: &dyn Case, n: usize) -> Option<SceneError> {
        let key = RunKey::new(case.id(), Scheme::preset(Preset::Default), n);
        scene_of(case, &key).expect("a scene").validate().err()
    }

    /// Every case says of every small size whether it can be, and none panics over it.
    #[test]
    fn sizes_that_cannot_be_name_one_that_can() {
        let mut refused = 0;
        for case in ALL {
            for n in (1..=24).chain([20_000, 100_000_000]) {
                let Some(error) = wrong(case, n) else { continue };
                refused += 1;
                let key = RunKey::new(case.id(), Scheme::preset(Preset::Default), n);
                let said = cannot(case, &key, &error).message;
                let named = said.rsplit(' ').next().and_then(|word| word.parse().ok());
                assert!(named.is_some_and(|named| wrong(case, named).is_none()), "{said}");
            }
        }
        assert!(refused > ALL.len(), "{refused}");
    }

    /// What decides is blamed: the scheme where no size helps, with one that runs.
    #[test]
    fn sizes_are_blamed_where_they_decide() {
        let said = |density: Density, n| {
            let case = find("saltzman").expect("the case");
            let scheme = Scheme::Particles { preset: Preset::Paper, density };
            let key = RunKey::new("saltzman", scheme, n);
            let scene = scene_of(case, &key).expect("a scene");
            cannot(case, &key, &scene.validate().expect_err("refused")).message
        };
        let scheme = said(Density::Nonholonomic, 8);
        assert!(scheme.starts_with(
            "`saltzman` cannot run under `paper`: `method.density` is nonholonomic, but"
        ));
        assert!(scheme.ends_with("; use `--density hybrid` or `--variant regular`"), "{scheme}");
        let size = said(Density::Hybrid, 100_000);
        assert!(size.starts_with("`saltzman` cannot have --n 100 000: "), "{size}");
    }

    #[test]
    fn large_runs_are_mentioned_and_too_large_ones_refused() {
        let case = find("noh-space").expect("the case");
        let scene = |variant: &str, n| case.scene(Preset::Default, variant, n);
        let said = |variant: &str, n, room| {
            outlook(case, ("--n", n), Need::of(&scene(variant, n), Keeps::default()), room)
        };
        assert_eq!(said("spherical", 24, Some(1 << 30)), Ok(None));
        let tight = said("spherical", 100, Some(1_500_000_000)).expect("it fits").expect("a note");
        assert!(tight.ends_with("more than half of the 1.5 GB available"), "{tight}");
        let refused = said("spherical", 250, Some(8_000_000_000)).expect_err("too large");
        assert_eq!(
            refused,
            "`noh-space` with --n 250 has about 31 438 251 particles and needs about 15.7 GB of \
             memory, and 8.0 GB are available; take a smaller --n"
        );
        let large = said("", 4000, Some(1 << 40)).expect("it fits").expect("a note");
        assert!(large.contains("the largest size of the levels is 24"), "{large}");
        // Elsewhere nothing is known of the memory.
        assert_eq!(said("spherical", 150, None), Ok(None));
    }
}
