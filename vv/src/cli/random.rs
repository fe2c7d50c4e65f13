//! `whipple vv hard --random`: small random impacts, and what holds of any.

use super::hard::GROUP;
use super::{CLAIM_FAILED, Failure, VvArgs, print, say};
use crate::hard::folder;
use crate::hard::random::{Broken, Ending, Examined, Impact, Outcome, RandomRecord, Threads};
use crate::lock::FolderLock;
use crate::words::counted;

/// Seeds that a line of a table names.
const NAMED: usize = 12;

/// Runs the scenes of so many seeds, writes their record, and prints what was found; of a single one it prints all
/// and writes nothing.
pub(super) fn random(args: &VvArgs, count: usize) -> Result<u8, Failure> {
    if args.cases != [GROUP] {
        let message = "--random goes with the group `hard` alone: whipple vv hard --random N";
        return Err(Failure::usage(message));
    }
    let last = args.from.checked_add(count as u64 - 1);
    let last = last.ok_or_else(|| Failure::usage("--from: seeds end at 2^64 - 1"))?;
    let threads = Threads::start();
    let threads = threads.map_err(|e| Failure::usage(format!("cannot start a thread: {e}")))?;
    if count == 1 {
        let impact = Impact::of(args.from);
        let examined = threads.examine(&impact);
        print(&single(&impact, &examined))?;
        return Ok(code(examined.broken.is_empty()));
    }
    let records = RandomRecord::folder(&folder(&args.out));
    let _lock = FolderLock::take(&records)?;
    let mut record = RandomRecord::new(args.from);
    for seed in args.from..=last {
        let impact = Impact::of(seed);
        let examined = threads.examine(&impact);
        if examined.outcome() == Outcome::Failed {
            say(&format!("FAILED {impact}\n{}", broken(&examined.broken)));
        }
        record.enter(&impact, examined);
    }
    record.write(&records)?;
    let file = records.join(record.file_name());
    print(&format!("{}record: {}\n", table(&record), file.display()))?;
    Ok(code(record.failed.is_empty()))
}

/// The exit code.
fn code(holds: bool) -> u8 {
    if holds { 0 } else { CLAIM_FAILED }
}

/// The properties that do not hold, a line each.
fn broken(all: &[Broken]) -> String {
    let line = |broken: &Broken| {
        let worst = broken.worst.map_or(String::new(), |worst| format!(", worst {worst:.3e}"));
        let Broken { property, step, seen, .. } = broken;
        format!("  -> {} after step {step}: {seen}{worst}\n", property.name())
    };
    all.iter().map(line).collect()
}

/// A scene and all that was seen of it.
fn single(impact: &Impact, examined: &Examined) -> String {
    let mut text = format!("{impact}\n{}: ", examined.outcome().name());
    text += &match &examined.ending {
        Ending::Ran => "to its end".to_owned(),
        Ending::Refused { said, .. } | Ending::Reported { said, .. } | Ending::Panicked(said) => {
            said.clone()
        }
    };
    text.push('\n');
    if let Some(figures) = &examined.figures {
        let how = if figures.met { "bodies met" } else { "bodies did not meet" };
        text += &format!(
            "{}, {}, {}, {how}\n",
            counted(figures.particles, ["particle", "particles"]),
            counted(figures.steps as usize, ["step", "steps"]),
            counted(figures.died, ["element died", "elements died"])
        );
        for (what, value) in figures.errors() {
            text += &format!("{value:>11.3e}  {what}\n");
        }
        let lengths = [
            ("shortest step over the crossing of a cell", figures.shortest),
            ("20 steps in a row over those of a quiet scene", figures.pace),
        ];
        for (what, value) in lengths {
            let value = value.map_or("-".to_owned(), |value| format!("{value:.3e}"));
            text += &format!("{value:>11}  {what}\n");
        }
    }
    if examined.twice {
        text += "run on two threads too\n";
    }
    text + &broken(&examined.broken)
}

/// Counts by outcome and scheme, and the seeds of failures.
fn table(record: &RandomRecord) -> String {
    let mut text = format!("{:<28}", "scheme");
    for outcome in Outcome::ALL {
        text += &format!("{:>28}", outcome.name());
    }
    text += &format!(
        "{:>8}{:>8}{:>18}{:>8}{:>8}\n",
        "met", "died", "residual > 0.1 %", "grown", "slow"
    );
    let mut sums = [0; 9];
    for tally in &record.tallies {
        let [ran, refused, reported, failed] = tally.outcomes;
        let row = [
            ran,
            refused,
            reported,
            failed,
            tally.met,
            tally.died,
            tally.above,
            tally.grown,
            tally.slow,
        ];
        text += &counts(&tally.scheme.label(), row);
        sums.iter_mut().zip(row).for_each(|(sum, count)| *sum += count);
    }
    text += &counts("all", sums);
    for (what, worst) in &record.worst {
        text += &format!("largest {what}: {:.3e} (seed {})\n", worst.value, worst.seed);
    }
    for (key, count) in &record.refused {
        text += &format!("refused for {key}: {count}\n");
    }
    for (kind, seeds) in &record.reported {
        text +=
            &format!("reported, {kind}: {}\n", named(&seeds.keys().copied().collect::<Vec<u64>>()));
    }
    for (property, seeds) in record.broken() {
        text += &format!("FAILED, {}: {}\n", property.name(), named(&seeds));
    }
    if !record.grown.is_empty() {
        text += &format!("grown, not asked for: {}\n", named(&record.grown));
    }
    text + &format!(
        "seeds {} on, {} run on two threads too\n",
        record.from,
        counted(record.twice, ["scene", "scenes"])
    )
}

/// A row of the table.
fn counts(label: &str, row: [usize; 9]) -> String {
    let widths = [28, 28, 28, 28, 8, 8, 18, 8, 8];
    let each = row.iter().zip(widths).map(|(count, width)| format!("{count:>width$}"));
    format!("{label:<28}{}\n", each.collect::<String>())
}

/// How many seeds, and the first of them.
fn named(seeds: &[u64]) -> String {
    let first: Vec<String> = seeds.iter().take(NAMED).map(u64::to_string).collect();
    let more = if seeds.len() > NAMED { ", ..." } else { "" };
    format!("{} (seeds {}{more})", seeds.len(), first.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases::Level;

    #[test]
    fn random_impacts_go_with_the_hard_cases_alone_and_their_seeds_end() {
        let refused = |cases: &[&str], from| {
            let args = VvArgs {
                cases: cases.iter().map(ToString::to_string).collect(),
                level: Level::Standard,
                sensitivity: false,
                default_only: false,
                random: Some(2),
                from,
                out: "nowhere".into(),
                single_file: false,
            };
            random(&args, 2).expect_err("it is refused").message
        };
        for cases in [&[][..], &["noh"], &[GROUP, "H01"]] {
            assert!(refused(cases, 0).contains("hard --random"), "{cases:?}");
        }
        assert!(refused(&[GROUP], u64::MAX).contains("2^64"));
    }

    #[test]
    fn many_seeds_are_counted_and_the_first_named() {
        assert_eq!(named(&[0, 1, 2]), "3 (seeds 0, 1, 2)");
        let many = named(&(0..40).collect::<Vec<u64>>());
        assert!(many.starts_with("40 (seeds 0, 1") && many.ends_with("11, ...)"), "{many}");
    }
}
