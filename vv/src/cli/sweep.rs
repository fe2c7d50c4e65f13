//! `whipple sweep`: a scene file with other values, one process a run; `whipple limit`: where its condition begins to be met.

mod draw;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Component, Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Mutex;

use super::folder::RECORD;
use super::{Failure, LimitArgs, NUMERICAL_FAILURE, SweepArgs, print, say};
use crate::cases::Case;
use crate::files::{ensure_writable_dir, write_atomic};
use crate::plots::Figure;
use crate::record::{Outcome, RunRecord};
use crate::report::sig;
use crate::scenes::case::FileCase;
use crate::scenes::file::SceneFile;
use crate::scenes::vary::{Key, combinations, vary};

/// Name of the scene file of a run, beside its results.
const CASE: &str = "case.toml";

/// Name of the table of a sweep.
const TABLE: &str = "sweep.csv";

/// Name of what a run printed.
const LOG: &str = "log.txt";

/// A run of a sweep: its folder, and what was changed for it.
struct Point<'a> {
    folder: PathBuf,
    changes: Vec<(&'a Key, &'a str)>,
}

impl Point<'_> {
    /// Writes its scene file, if another is not there, and checks it.
    fn prepare(&self, text: &str) -> Result<(), Failure> {
        ensure_writable_dir(&self.folder)?;
        let path = self.folder.join(CASE);
        let own = vary(text, &self.changes).map_err(Failure::usage)?;
        match fs::read_to_string(&path) {
            Ok(there) if there != own => {
                let message = format!(
                    "{} is of another sweep: take another --out, or remove it",
                    path.display()
                );
                return Err(Failure::usage(message));
            }
            Ok(_) => {}
            Err(_) => write_atomic(&path, own.as_bytes())?,
        }
        FileCase::read(&path).map(|_| ()).map_err(Failure::usage)
    }

    /// Copies the surfaces that a scene in this folder names beside its own scene file, so that the run can go elsewhere.
    fn bring(&self, surfaces: &[PathBuf], from: &Path) -> Result<(), Failure> {
        for surface in surfaces {
            if surface.components().any(|part| part == Component::ParentDir) {
                let message = format!(
                    "{} is not in the folder of the scene or below: runs of a sweep take their surfaces with them",
                    surface.display()
                );
                return Err(Failure::usage(message));
            }
            let (source, copy) = (from.join(surface), self.folder.join(surface));
            let bytes = fs::read(&source).map_err(|error| {
                Failure::usage(format!("{} cannot be read: {error}", source.display()))
            })?;
            if fs::read(&copy).ok().as_ref() != Some(&bytes) {
                ensure_writable_dir(copy.parent().unwrap_or(&self.folder))?;
                write_atomic(&copy, &bytes)?;
            }
        }
        Ok(())
    }

    /// The command of its run.
    fn command(&self) -> [String; 4] {
        let folder = self.folder.display();
        ["run".into(), format!("{folder}/{CASE}"), "--out".into(), format!("{folder}/run")]
    }

    /// What its run found, if it has come to an end.
    fn record(&self) -> Option<RunRecord> {
        RunRecord::read(&self.folder.join("run").join(RECORD)).ok()
    }

    /// Runs it in a process of its own, unless that was done.
    fn run(&self) -> Result<RunRecord, Failure> {
        if let Some(record) = self.record() {
            return Ok(record);
        }
        let program = std::env::current_exe().map_err(Failure::usage)?;
        let output = Command::new(program)
            .args(self.command())
            .stdin(Stdio::null())
            .output()
            .map_err(Failure::usage)?;
        let log = [&output.stdout[..], &output.stderr[..]].concat();
        write_atomic(&self.folder.join(LOG), &log)?;
        let failed = i32::from(NUMERICAL_FAILURE);
        match (output.status.code(), self.record()) {
            (Some(code), Some(record)) if code == 0 || code == failed => Ok(record),
            _ => Err(Failure::usage(format!(
                "{} did not end well: {} has what it said",
                self.folder.display(),
                self.folder.join(LOG).display()
            ))),
        }
    }
}

fn text_of(path: &Path) -> Result<String, Failure> {
    fs::read_to_string(path)
        .map_err(|error| Failure::usage(format!("{} cannot be read: {error}", path.display())))
}

/// Relative paths of the surfaces that a scene names, and its folder.
fn surfaces<'a>(text: &str, scene: &'a Path) -> (Vec<PathBuf>, &'a Path) {
    let file = toml::from_str::<SceneFile>(text);
    let bodies = file.map(|file| file.body).unwrap_or_default();
    let named = bodies
        .iter()
        .filter_map(|body| Some(PathBuf::from(body.get_ref().stl.as_ref()?.file.get_ref())));
    (named.filter(|path| path.is_relative()).collect(), scene.parent().unwrap_or(Path::new("")))
}

/// Writes a figure, over one of the same name, and says where.
fn write_figure(out: &Path, figure: &Figure) -> Result<(), Failure> {
    for (name, bytes) in draw::files(figure)? {
        let path = out.join(name);
        write_atomic(&path, &bytes)?;
        print(&format!("{}\n", path.display()))?;
    }
    Ok(())
}

/// The findings of all runs that have come to an end along the first key whose values are numbers of one unit.
fn numbers(args: &SweepArgs, points: &[Point<'_>]) -> Option<draw::Sweep> {
    let along = |k: &usize| -> Option<(String, Vec<f64>)> {
        let values = points.iter().map(|point| split(point.changes[*k].1).ok());
        let (numbers, units): (Vec<f64>, Vec<String>) =
            values.collect::<Option<Vec<_>>>()?.into_iter().unzip();
        let unit = units.first()?.clone();
        let key = &args.vary[*k].key;
        let label = if unit.is_empty() { key.to_string() } else { format!("{key}, {unit}") };
        units.iter().all(|own| *own == unit).then_some((label, numbers))
    };
    let (axis, (key, places)) = (0..args.vary.len()).find_map(|k| Some((k, along(&k)?)))?;
    let records: Vec<Option<RunRecord>> = points.iter().map(Point::record).collect();
    let names: BTreeSet<&String> = records.iter().flatten().flat_map(|r| r.norms.keys()).collect();
    let run = |((point, record), place): ((&Point<'_>, &Option<RunRecord>), f64)| {
        let norms = &record.as_ref()?.norms;
        let others = point.changes.iter().enumerate().filter(|(k, _)| *k != axis);
        let others: Vec<String> =
            others.map(|(_, (key, value))| format!("{key} = {value}")).collect();
        let found = names.iter().map(|name| norms.get(*name).copied()).collect();
        Some((place, others.join(", "), found))
    };
    let runs = points.iter().zip(&records).zip(places).filter_map(run).collect();
    let case = FileCase::read(&args.scene).ok()?;
    let title = |name: &&String| {
        let known = case.tabulated().iter().find(|(own, _)| own == *name);
        [(*name).clone(), known.map_or_else(|| (*name).clone(), |(_, title)| (*title).to_owned())]
    };
    Some(draw::Sweep { key, runs, names: names.iter().map(title).collect() })
}

/// Runs a scene with all combinations of values.
pub(super) fn sweep(args: &SweepArgs) -> Result<u8, Failure> {
    let text = text_of(&args.scene)?;
    let points: Vec<Point<'_>> = combinations(&args.vary)
        .into_iter()
        .enumerate()
        .map(|(k, changes)| Point { folder: args.out.join(format!("{:03}", k + 1)), changes })
        .collect();
    let (surfaces, from) = surfaces(&text, &args.scene);
    for point in &points {
        point.bring(&surfaces, from)?;
        point.prepare(&text)?;
    }
    if args.list {
        let lines = points.iter().map(|point| format!("whipple {}\n", point.command().join(" ")));
        print(&lines.collect::<String>())?;
        return Ok(0);
    }
    let next = Mutex::new(0);
    let failed = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..args.jobs {
            scope.spawn(|| {
                loop {
                    let k = {
                        let mut next =
                            next.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
                        *next += 1;
                        *next - 1
                    };
                    let Some(point) = points.get(k) else { return };
                    let named = |(key, value): &(&Key, &str)| format!("{key} = {value}");
                    let what = point.changes.iter().map(named).collect::<Vec<String>>().join(", ");
                    match point.run() {
                        Ok(record) => say(&format!("{what}: {:.1} CPU s", record.cpu_seconds)),
                        Err(failure) => {
                            say(&format!("{what}: {}", failure.message));
                            let mut failed =
                                failed.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
                            failed.push(failure);
                        }
                    }
                }
            });
        }
    });
    let table = args.out.join(TABLE);
    write_atomic(&table, rows(args, &points)?.as_bytes())?;
    print(&format!("{}\n", table.display()))?;
    if let Some(figure) = numbers(args, &points).and_then(|found| draw::sweep(&found, &args.plot)) {
        write_figure(&args.out, &figure)?;
    }
    let failed = failed.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    failed.into_iter().next().map_or(Ok(0), Err)
}

/// The numbers of all runs that have come to an end, a row each.
fn rows(args: &SweepArgs, points: &[Point<'_>]) -> Result<String, Failure> {
    let records: Vec<Option<RunRecord>> = points.iter().map(Point::record).collect();
    let names: BTreeSet<&String> =
        records.iter().flatten().flat_map(|record| record.norms.keys()).collect();
    let mut writer = csv::Writer::from_writer(Vec::new());
    let wrong = |error: csv::Error| Failure::usage(format!("cannot make a CSV table: {error}"));
    let own = ["outcome", "cpu_seconds", "energy_drift"].map(str::to_owned);
    let keys = args.vary.iter().map(|variation| variation.key.to_string());
    let head = ["run".to_owned()].into_iter().chain(keys).chain(own);
    writer.write_record(head.chain(names.iter().map(|name| (*name).clone()))).map_err(wrong)?;
    for (point, record) in points.iter().zip(&records) {
        let folder = point.folder.file_name().map(|name| name.to_string_lossy().into_owned());
        let values = point.changes.iter().map(|(_, value)| (*value).to_owned());
        let told = match record {
            None => [String::from("not run"), String::new(), String::new()],
            Some(record) => [
                if record.outcome == Outcome::Completed { "completed" } else { "failed" }
                    .to_owned(),
                record.cpu_seconds.to_string(),
                record.energy_drift.to_string(),
            ],
        };
        let number = |name: &&String| {
            record.as_ref().and_then(|r| r.norms.get(*name)).map_or(String::new(), f64::to_string)
        };
        let row = folder.into_iter().chain(values).chain(told).chain(names.iter().map(number));
        writer.write_record(row).map_err(wrong)?;
    }
    let bytes = writer.into_inner().map_err(Failure::usage)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Finds by bisection where the condition of a scene, its `until`, begins to be met.
pub(super) fn limit(args: &LimitArgs) -> Result<u8, Failure> {
    let text = text_of(&args.scene)?;
    if FileCase::read(&args.scene).map_err(Failure::usage)?.built().file.until.is_none() {
        let message = "a limit needs an `until` in the scene: what is met on one side of it and not on the other";
        return Err(Failure::usage(message));
    }
    let (number, unit) = split(&args.low)?;
    let (other, other_unit) = split(&args.high)?;
    if unit != other_unit {
        let message =
            format!("--low is in `{unit}` and --high in `{other_unit}`: one unit for both");
        return Err(Failure::usage(message));
    }
    let (surfaces, from) = surfaces(&text, &args.scene);
    let mut runs = Vec::new();
    let mut met = |value: f64| -> Result<bool, Failure> {
        let said = format!("{value} {unit}");
        let said = said.trim();
        let folder = args.out.join(said.replace([' ', '/'], "_"));
        let point = Point { folder, changes: vec![(&args.key, said)] };
        point.bring(&surfaces, from)?;
        point.prepare(&text)?;
        let record = point.run()?;
        let met = record.norms.contains_key("ended_at");
        say(&format!("{} = {said}: {}", args.key, if met { "met" } else { "not met" }));
        runs.push((value, met));
        Ok(met)
    };
    let (mut low, mut high) = (number, other);
    let [at_low, at_high] = [met(low)?, met(high)?];
    if at_low == at_high {
        let how = if at_low { "met" } else { "not met" };
        let message = format!("the condition is {how} at both ends: take others");
        return Err(Failure::usage(message));
    }
    for _ in 0..args.runs {
        let middle = 0.5 * (low + high);
        if met(middle)? == at_low { low = middle } else { high = middle }
    }
    let [met_at, not_at] = if at_low { [low, high] } else { [high, low] };
    let out = format!(
        "{}: met at {} {unit}, not at {} {unit}; middle {} {unit}\n",
        args.key,
        sig(met_at, 6),
        sig(not_at, 6),
        sig(0.5 * (low + high), 6)
    );
    print(&out)?;
    let row = |(value, met): &(f64, bool)| format!("{value},{unit},{met}\n");
    let table = runs.iter().map(row).collect::<String>();
    write_atomic(&args.out.join("limit.csv"), format!("value,unit,met\n{table}").as_bytes())?;
    let label =
        if unit.is_empty() { args.key.to_string() } else { format!("{}, {unit}", args.key) };
    write_figure(&args.out, &draw::limit(&label, &runs, 0.5 * (low + high)))?;
    Ok(0)
}

/// A number and its unit.
fn split(text: &str) -> Result<(f64, String), Failure> {
    let (number, unit) = text.trim().split_once(' ').unwrap_or((text.trim(), ""));
    let wrong = || Failure::usage(format!("`{text}` is no number with a unit, such as \"5 km/s\""));
    Ok((number.parse().map_err(|_| wrong())?, unit.trim().to_owned()))
}
