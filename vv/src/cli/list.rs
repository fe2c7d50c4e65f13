//! `whipple list`.

use std::collections::BTreeSet;

use whipple_solver::method::Preset;

use super::run::{find, named_variants};
use super::{Failure, ListArgs, print};
use crate::cases::{ALL, Case, Level};
use crate::claims::{Claim, Weight};
use crate::keys::{Key, idle, of_method, of_presets, of_problem};
use crate::scene::AnyScene;
use crate::suite::level_of;
use crate::words::counted;

/// Columns of the terminal that texts are broken for.
const WIDTH: usize = 100;

pub(super) const EXAMPLES: &str = "\
Examples:
  whipple list                 all cases with sizes and variants
  whipple list noh             one of them: what is measured, claims with what is wanted
  whipple list noh --keys      what --set can change in it, with the values of both presets";

/// Prints the cases, one of them whole, or the keys of `--set`.
pub(super) fn list(args: &ListArgs) -> Result<u8, Failure> {
    let case = args.case.as_deref().map(find).transpose()?;
    print(&match case {
        None if args.keys => all_keys()?,
        None => ALL.map(line).concat(),
        Some(case) if args.keys => keys_of(case),
        Some(case) => whole(case),
    })?;
    Ok(0)
}

/// A case in two or three lines: title, sizes, variants.
fn line(case: &dyn Case) -> String {
    let mut text = format!("{:<22} {}\n", case.id(), case.title());
    text += &wrapped(&sizes(case), 25);
    let named = named_variants(case);
    if !named.is_empty() {
        text += &wrapped(&format!("variants: {}", named.join(", ")), 25);
    }
    text
}

/// The default size and those of the levels.
fn sizes(case: &dyn Case) -> String {
    let mut text = format!("--n {} by default", case.default_size());
    let of = |level| sizes_of(case, level);
    let mut levels = Level::ALL.into_iter().peekable();
    while let Some(level) = levels.next() {
        let sizes = of(level);
        let mut names = level.name().to_owned();
        while let Some(same) = levels.next_if(|&next| of(next) == sizes) {
            names += &format!(", {}", same.name());
        }
        let sizes: Vec<String> = sizes.iter().map(usize::to_string).collect();
        text += &format!("; {names}: {}", sizes.join(" "));
    }
    text
}

/// Sizes that a level runs, each once.
fn sizes_of(case: &dyn Case, level: Level) -> BTreeSet<usize> {
    case.runs(level).into_iter().map(|key| key.n).collect()
}

/// A remark on a case whose smallest size another level than `quick` has.
fn small_elsewhere(case: &dyn Case) -> &'static str {
    let least = |level| sizes_of(case, level).first().copied();
    let elsewhere = Level::ALL.into_iter().any(|level| least(level) < least(Level::Quick));
    if elsewhere { " (quick goes without the smallest)" } else { "" }
}

/// Everything that can be known of a case without running it.
fn whole(case: &dyn Case) -> String {
    let scene = case.scene(Preset::Default, "", case.default_size());
    let mut text = format!("{}: {}\n\n", case.id(), case.title());
    text += &wrapped(case.about(), 0);
    text += &wrapped(&format!("Source: {}", case.source()), 0);
    text += "\n";
    text += &wrapped(&format!("Sizes: {}{}", sizes(case), small_elsewhere(case)), 0);
    let runs = Level::ALL.map(|level| format!("{} {}", level.name(), case.runs(level).len()));
    text += &format!("Runs of the levels: {}\n", runs.join(", "));
    let named = named_variants(case);
    if !named.is_empty() {
        text += &wrapped(&format!("Variants: {}", named.join(", ")), 0);
    }
    for choice in case.choices() {
        let (name, values) = (choice.name, choice.values.join(", "));
        text += &wrapped(&format!("--{name}: {values}; the first if none is given"), 0);
    }
    let kind = match scene {
        AnyScene::Line(_) => "along a line",
        AnyScene::Space(_) => "in three dimensions",
    };
    text += &format!("Scene: {kind}; `whipple list {} --keys` has its values\n", case.id());
    text += "\nWhat is measured, besides energy, momentum, work and time:\n";
    let mut measured = case.tabulated().to_vec();
    measured.extend(case.quantities().iter().filter(|(name, _)| !names(case).contains(name)));
    for (name, title) in measured {
        text += &format!("  {name:<28} {title}\n");
    }
    text + &claims_of(case)
}

/// Names that a case tabulates.
fn names(case: &dyn Case) -> Vec<&'static str> {
    case.tabulated().iter().map(|(name, _)| *name).collect()
}

/// The claims of a case with what is wanted, required ones first.
fn claims_of(case: &dyn Case) -> String {
    let mut claims = case.claims();
    claims.sort_by_key(|claim| claim.weight);
    let count = |weight| claims.iter().filter(|claim| claim.weight == weight).count();
    let mut text = format!(
        "\nClaims: {} required, {}, {} shown. The level is the lowest that runs what a claim needs.\n",
        count(Weight::Must),
        counted(count(Weight::Aim), ["goal", "goals"]),
        counted(count(Weight::Shown), ["known limit", "known limits"])
    );
    for claim in &claims {
        let Claim { weight, kind, what, wanted, source, in_sample, .. } = claim;
        let level = level_of(case, claim).map_or("no level", Level::name);
        let (weight, kind) = (weight.name(), kind.name());
        // Not to be broken.
        let wanted = wanted.text().replace(' ', "\u{a0}");
        let sample = if *in_sample { "; in sample" } else { "" };
        text += &wrapped(what, 2);
        text += &wrapped(
            &format!("wanted {wanted}; {weight}, {kind}, level {level}; by: {source}{sample}"),
            6,
        );
    }
    text
}

/// The keys of the method along a line and in space.
fn all_keys() -> Result<String, Failure> {
    let mut text = String::from(
        "Keys of `run --set KEY=VALUE`: the value of the presets `paper` and `default`, and the unit.\n",
    );
    for (head, case) in [("Along a line", "noh"), ("In three dimensions", "long-rod")] {
        let case = find(case)?;
        let [paper, default] = of_presets(|preset| case.scene(preset, "", case.default_size()));
        text += &format!("\n{head}:\n\n{}", table(&of_method([&paper, &default])));
    }
    text += "\n";
    text += &wrapped(
        "A case may choose some of these itself, and has keys of what it simulates besides: times, walls, \
         materials, bodies. `whipple list CASE --keys` has them with their values. Values are TOML; a word \
         needs no quotes.",
        0,
    );
    Ok(text)
}

/// The keys of the scene of a case, at its default size and plain variant.
fn keys_of(case: &dyn Case) -> String {
    let [paper, default] = of_presets(|preset| case.scene(preset, "", case.default_size()));
    let both = [&paper, &default];
    let method = of_method(both).into_iter().map(|key| {
        let meaning = key.meaning.clone() + &changes_nothing(&key.name, both);
        Key { meaning, ..key }
    });
    format!(
        "Keys of `run {} --set KEY=VALUE`: the value under the presets `paper` and `default` at --n {}, and \
         the unit.\n\nMethod:\n\n{}\nProblem:\n\n{}",
        case.id(),
        case.default_size(),
        table(&method.collect::<Vec<Key>>()),
        table(&of_problem(both))
    )
}

/// What is said of a key that one or both scenes of a case have no use for.
fn changes_nothing(key: &str, scenes: [&AnyScene; 2]) -> String {
    let (who, why) = match scenes.map(|scene| idle(key, scene)) {
        [None, None] => return String::new(),
        [Some(why), Some(_)] => ("in this case", why),
        [Some(why), None] => ("under `paper`", why),
        [None, Some(why)] => ("under `default`", why),
    };
    format!(" Changes nothing {who}: {why}.")
}

/// Keys with their values, and what they are below them.
fn table(keys: &[Key]) -> String {
    let width = |f: &dyn Fn(&Key) -> usize| keys.iter().map(f).max().unwrap_or(0);
    let name = width(&|key| key.name.len()).max(3);
    let values = [0, 1].map(|k| width(&|key| key.values[k].len()).max(7));
    let row = |cells: [&str; 4]| {
        let [key, paper, default, unit] = cells;
        let [first, second] = values;
        let line = format!("  {key:<name$}  {paper:<first$}  {default:<second$}  {unit}");
        format!("{}\n", line.trim_end())
    };
    let mut text = row(["KEY", "paper", "default", "unit"]);
    for key in keys {
        let [paper, default] = &key.values;
        text +=
            &row([&key.name, paper, default, if key.unit.is_empty() { "–" } else { &key.unit }]);
        let choices = match key.choices.join(", ") {
            none if none.is_empty() => none,
            all => format!(" One of: {all}."),
        };
        text += &wrapped(&format!("{}{choices}", key.meaning), 6);
    }
    text
}

/// A text in lines no longer than the terminal, indented by so many columns; broken at plain spaces.
fn wrapped(text: &str, indent: usize) -> String {
    let mut out = String::new();
    let mut column = 0;
    for word in text.split(' ').filter(|word| !word.is_empty()) {
        let letters = word.chars().count();
        if column > 0 && column + 1 + letters > WIDTH {
            out.push('\n');
            column = 0;
        }
        let gap = if column == 0 { indent } else { 1 };
        out.extend(std::iter::repeat_n(' ', gap));
        out.push_str(&word.replace('\u{a0}', " "));
        column += gap + letters;
    }
    out.push('\n');
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_broken_between_words() {
        let text = wrapped(&"seven ".repeat(40), 4);
        assert!(text.lines().all(|line| line.starts_with("    seven") && line.len() <= WIDTH));
        assert_eq!(text.split_whitespace().count(), 40);
        assert_eq!(wrapped("µ", 2), "  µ\n");
        let whole = wrapped(&format!("{} a\u{a0}b", "x".repeat(WIDTH - 2)), 0);
        assert!(whole.ends_with("\na b\n"), "{whole}");
    }

    /// Who takes `quick` for the smallest sizes is told where it is not.
    #[test]
    fn levels_without_the_smallest_size_say_so() {
        let said = |id| whole(find(id).expect("a case")).replace('\n', " ");
        let sizes = "quick: 200; standard, full: 100 200 400 (quick goes without the smallest)";
        assert!(said("einfeldt-123").contains(sizes), "{}", said("einfeldt-123"));
        assert!(!said("noh").contains("the smallest"));
    }

    /// One goal is no goals.
    #[test]
    fn claims_are_counted_in_words() {
        let all = ALL.map(claims_of).concat();
        assert!(all.contains(" 1 goal, ") && all.contains(" 2 goals, "), "{all}");
        assert!(!all.contains(" 1 goals, ") && !all.contains(" 1 known limits shown"), "{all}");
    }

    /// `full` runs what every claim needs, as its help says.
    #[test]
    fn the_full_level_runs_what_claims_need() {
        for case in ALL {
            for claim in case.claims() {
                assert!(level_of(case, &claim).is_some(), "{}: {}", case.id(), claim.what);
            }
        }
    }
}
