//! `whipple score`: results of any program judged on a case with an exact profile.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use serde::Serialize;
use whipple_solver::method::Preset;

use super::numbers::{SIZES, whole};
use super::show::write_new;
use super::{Failure, print};
use crate::cases::{ALL, Case, find};
use crate::plots::{Figure, THEME, render_svg, svg_to_png, themed};
use crate::record::{RunKey, RunRecord, Scheme, files_in};
use crate::report::sig;
use crate::run::{Request, Silent, run};
use crate::score::answer::{Answer, Fields, known};
use crate::score::columns::Named;
use crate::score::figure::figure;
use crate::score::judge::{Norms, Orders, Profile, ScoreError, Weights, norms, orders};
use crate::score::table::Table;
use crate::suggest::did_you_mean;
use crate::suite::{command_of, scene_of};

pub(super) const EXAMPLES: &str = "\
Examples:
  whipple score sod references/examples/sod_first_order_100.dat --column x=zone_centre
  whipple score sod theirs.csv --unit density=kg/m^3 --unit pressure=GPa --ours 200 --plot out/score.svg
  whipple score noh coarse.csv middle.csv fine.csv --csv out/score.csv";

/// Pixels of the PNG figure over those of the SVG.
const SCALE: f32 = 2.0;
/// Places of the line of the exact solution.
const DRAWN: usize = 2000;

#[derive(Debug, clap::Args)]
pub(super) struct ScoreArgs {
    /// Case with an exact profile along a line
    case: String,
    /// Tables of numbers at one time, with names above the columns; several resolutions give orders
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// Variant of the case
    #[arg(long, default_value = "", allow_hyphen_values = true)]
    variant: String,
    /// Name of a column in the files, such as density=rho1 (repeatable); x, density, velocity, pressure, energy,
    /// temperature, width, mass; usual names are known
    #[arg(long = "column", value_name = "WHAT=NAME", value_parser = pair)]
    columns: Vec<(String, String)>,
    /// Unit of a column, such as density=kg/m^3 (repeatable), if not in brackets behind its name; 1 of a case stands
    /// for cm, g, us, Mbar
    #[arg(long = "unit", value_name = "WHAT=UNIT", value_parser = pair)]
    units: Vec<(String, String)>,
    /// Time of the tables, if not the end time of the case
    #[arg(long, allow_hyphen_values = true)]
    time: Option<f64>,
    /// Run our own code at this size too, and judge and draw it likewise
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = whole(SIZES))]
    ours: Option<usize>,
    /// Folder of records that are shown beside
    #[arg(long, value_name = "DIR", default_value = "reports/records")]
    records: PathBuf,
    /// Figure to write, .svg or .png, with one for dark pages beside it; other files are not replaced
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// Table of the norms to write; other files are not replaced
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Print one JSON object on standard output
    #[arg(long)]
    json: bool,
}

fn pair(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((what, name)) if !what.trim().is_empty() && !name.trim().is_empty() => {
            Ok((what.trim().into(), name.trim().into()))
        }
        _ => Err("wanted two words with = between, such as density=rho".into()),
    }
}

impl From<ScoreError> for Failure {
    fn from(error: ScoreError) -> Self {
        Self::usage(error)
    }
}

/// One judged profile.
#[derive(Serialize)]
struct Row {
    name: String,
    n: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    weights: Option<Weights>,
    norms: BTreeMap<String, Norms>,
}

/// L1 norms of a run of ours, as its record has them.
#[derive(Serialize)]
struct Recorded {
    run: String,
    n: usize,
    l1: BTreeMap<String, f64>,
}

/// What `--json` prints.
#[derive(Serialize)]
struct Summary<'a> {
    case: &'a str,
    variant: &'a str,
    time: f64,
    theirs: Vec<Row>,
    orders: BTreeMap<String, Orders>,
    ours: Vec<Row>,
    records: Vec<Recorded>,
}

/// Judges tables.
pub(super) fn score(args: &ScoreArgs) -> Result<u8, Failure> {
    let case = case(args)?;
    let Some(answer) = Answer::of(case, &args.variant)? else {
        let message = format!(
            "{} has no exact profile along a line; these have: {}",
            case.id(),
            known().join(", ")
        );
        return Err(Failure::usage(message));
    };
    let named = Named { columns: args.columns.clone(), units: args.units.clone() };
    named.check().map_err(Failure::usage)?;
    let time = time(args, &answer)?;
    let mut theirs = Vec::new();
    for file in &args.files {
        let table = Table::read(file).map_err(Failure::usage)?;
        theirs.push(Profile::of(&table, &named, &answer, time)?);
    }
    theirs.sort_by_key(|profile| profile.x.len());
    let ours: Vec<Profile> =
        args.ours.map(|n| own(case, args, &answer, (n, time))).transpose()?.into_iter().collect();
    let rows = |all: &[Profile]| all.iter().map(row).collect::<Result<Vec<Row>, Failure>>();
    let judged = rows(&theirs)?;
    let sizes: Vec<usize> = judged.iter().map(|row| row.n).collect();
    let all: Vec<BTreeMap<String, Norms>> = judged.iter().map(|row| row.norms.clone()).collect();
    let summary = Summary {
        case: case.id(),
        variant: &args.variant,
        time,
        orders: orders(&sizes, &all),
        theirs: judged,
        ours: rows(&ours)?,
        records: if time == answer.end() { recorded(case, args)? } else { Vec::new() },
    };
    let mut written = Vec::new();
    if let Some(file) = &args.csv {
        written.extend(write(file, vec![(String::new(), csv(&summary).into_bytes())])?);
    }
    if let Some(file) = &args.plot {
        let line = exact_line(&theirs, &answer, time)?;
        let title = format!("{} at t = {}", case.title(), sig(time, 4));
        written.extend(draw(file, &figure(&title, &theirs, &ours, (&line.0, &line.1)))?);
    }
    let text = if args.json {
        serde_json::to_string_pretty(&summary).map_err(Failure::usage)? + "\n"
    } else {
        let lines: String = written.iter().map(|path| format!("{}\n", path.display())).collect();
        said(&summary, args) + &lines
    };
    print(&text)?;
    Ok(0)
}

fn case(args: &ScoreArgs) -> Result<&'static dyn Case, Failure> {
    let ids = || ALL.into_iter().map(Case::id);
    let case = find(&args.case).ok_or_else(|| {
        let near = did_you_mean(&args.case, ids());
        Failure::usage(format!("there is no case `{}`{near} `whipple list` has all", args.case))
    })?;
    if !case.variants().contains(&args.variant.as_str()) {
        let near = did_you_mean(&args.variant, case.variants().iter().copied());
        return Err(Failure::usage(format!(
            "{} has no variant `{}`{near}",
            case.id(),
            args.variant
        )));
    }
    Ok(case)
}

fn time(args: &ScoreArgs, answer: &Answer) -> Result<f64, Failure> {
    let end = answer.end();
    let time = args.time.unwrap_or(end);
    if !(time > 0.0 && time <= end) {
        let message =
            format!("--time {time}: wanted a time above 0, up to {end}, the end of the case");
        return Err(Failure::usage(message));
    }
    if !answer.knows(time)? {
        return Err(Failure::usage(format!(
            "--time {time}: the case has an answer at {end} alone"
        )));
    }
    Ok(time)
}

fn row(profile: &Profile) -> Result<Row, Failure> {
    Ok(Row {
        name: profile.name.clone(),
        n: profile.x.len(),
        weights: Some(profile.weights),
        norms: norms(profile)?,
    })
}

/// Our own run, judged at its particles with their masses as far as its profile tells them.
fn own(
    case: &'static dyn Case,
    args: &ScoreArgs,
    answer: &Answer,
    (n, time): (usize, f64),
) -> Result<Profile, Failure> {
    let scheme = Scheme::preset(Preset::Default);
    let key = RunKey::new(case.id(), scheme, n).variant(&args.variant);
    let mut scene = scene_of(case, &key);
    if let Some(scene) = &mut scene {
        scene.set_stop_time(time);
    }
    let command = command_of(&key);
    let ended = run(case, Request { key, scene, threads: 1, command }, &Silent)?;
    if let Some(failure) = ended.failure {
        return Err(Failure::from(crate::run::RunError::Step(failure)));
    }
    let name = format!("ours, n = {n}");
    let columns = ended.record.profile.map(|profile| profile.0).unwrap_or_default();
    let lines = columns.values().map(Vec::len).max().unwrap_or(0);
    let head: Vec<&str> = columns.keys().map(String::as_str).collect();
    let mut text = head.join(",") + "\n";
    for k in 0..lines {
        let cells: Vec<String> =
            columns.values().map(|values| format!("{:e}", values[k])).collect();
        text += &(cells.join(",") + "\n");
    }
    let table = Table::parse(Path::new(&name), text).map_err(Failure::usage)?;
    Ok(Profile::of(&table, &Named::default(), answer, time)?)
}

/// Runs of the default preset in the folder of records, if there is one.
fn recorded(case: &dyn Case, args: &ScoreArgs) -> Result<Vec<Recorded>, Failure> {
    if !args.records.is_dir() {
        return Ok(Vec::new());
    }
    let begin = format!("{}_", case.id());
    let mut out = Vec::new();
    for path in files_in(&args.records)? {
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned());
        if !name.is_some_and(|name| name.starts_with(&begin)) {
            continue;
        }
        let record = RunRecord::read(&path)?;
        let own = record.key.scheme == Scheme::preset(Preset::Default);
        if !own || record.key.case != case.id() || record.key.variant != args.variant {
            continue;
        }
        let l1 = record
            .norms
            .iter()
            .filter_map(|(name, value)| Some((name.strip_suffix("_l1")?.to_owned(), *value)));
        let stale = if record.provenance.is_stale() { ", of an earlier version" } else { "" };
        let run = format!("{}{stale}", record.key.scheme.label());
        out.push(Recorded { run, n: record.key.n, l1: l1.collect() });
    }
    out.sort_by_key(|record| record.n);
    Ok(out)
}

/// The exact solution over the extent of their profiles, with their own places, where it can be had.
fn exact_line(
    theirs: &[Profile],
    answer: &Answer,
    time: f64,
) -> Result<(Vec<f64>, Fields), Failure> {
    let mut x: Vec<f64> = theirs.iter().flat_map(|profile| profile.x.iter().copied()).collect();
    x.sort_by(f64::total_cmp);
    if let [from, .., to] = x[..] {
        x.extend((0..DRAWN).map(|k| from + (to - from) * (k as f64 + 0.5) / DRAWN as f64));
    }
    x.sort_by(f64::total_cmp);
    x.dedup();
    let fields = answer.at(&x, time)?;
    Ok((x, fields))
}

fn draw(file: &Path, figure: &Figure) -> Result<Vec<PathBuf>, Failure> {
    let light = render_svg(figure).map_err(Failure::usage)?;
    let dark = THEME.iter().fold(themed(&light), |svg, (name, light, dark)| {
        svg.replace(&format!("var({name},#{light:06x})"), &format!("#{dark:06X}"))
    });
    let images = match file.extension().and_then(|end| end.to_str()) {
        Some("svg") => [light.into_bytes(), dark.into_bytes()],
        Some("png") => [
            svg_to_png(&light, SCALE).map_err(Failure::usage)?,
            svg_to_png(&dark, SCALE).map_err(Failure::usage)?,
        ],
        _ => {
            let message =
                format!("--plot {}: wanted a name that ends in .svg or .png", file.display());
            return Err(Failure::usage(message));
        }
    };
    let [light, dark] = images;
    write(file, vec![(String::new(), light), ("-dark".into(), dark)])
}

/// Writes a file, and others beside it whose names go on before the ending.
fn write(file: &Path, parts: Vec<(String, Vec<u8>)>) -> Result<Vec<PathBuf>, Failure> {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    let end = file.extension().map(|end| format!(".{}", end.to_string_lossy())).unwrap_or_default();
    let folder = file.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let files = parts.into_iter().map(|(more, bytes)| (format!("{stem}{more}{end}"), bytes));
    write_new(folder, &files.collect::<Vec<_>>())
}

fn csv(summary: &Summary) -> String {
    let mut out = "name,n,field,l1,l2,linf\n".to_owned();
    for row in summary.theirs.iter().chain(&summary.ours) {
        for (field, Norms { l1, l2, linf }) in &row.norms {
            let name = row.name.replace('"', "\"\"");
            let _ = writeln!(out, "\"{name}\",{},{field},{l1:e},{l2:e},{linf:e}", row.n);
        }
    }
    out
}

fn said(summary: &Summary, args: &ScoreArgs) -> String {
    let mut out = format!(
        "{} at t = {}, against the solution of the case\n",
        summary.case,
        sig(summary.time, 4)
    );
    out += "errors over the range of the exact field, weighted by mass:\n";
    let _ =
        writeln!(out, "  {:<12} {:>6}  {:<10} {:<10} {:<10} of", "field", "n", "L1", "L2", "Linf");
    let fields: Vec<&String> =
        summary.theirs.first().map(|row| row.norms.keys().collect()).unwrap_or_default();
    for field in fields {
        for row in summary.theirs.iter().chain(&summary.ours) {
            let Some(Norms { l1, l2, linf }) = row.norms.get(field) else { continue };
            let [l1, l2, linf] = [l1, l2, linf].map(|x| sig(*x, 4));
            let _ = writeln!(
                out,
                "  {field:<12} {:>6}  {l1:<10} {l2:<10} {linf:<10} {}",
                row.n, row.name
            );
        }
        for record in &summary.records {
            let Some(l1) = record.l1.get(field) else { continue };
            let l1 = sig(*l1, 4);
            let _ = writeln!(
                out,
                "  {field:<12} {:>6}  {l1:<10} {:<10} {:<10} record, {}",
                record.n, "", "", record.run
            );
        }
    }
    for (field, orders) in &summary.orders {
        let pairs: Vec<String> = orders.pairwise.iter().map(|order| sig(*order, 3)).collect();
        let _ = write!(out, "order of L1 of {field}: {}", pairs.join(", "));
        if let Some((order, (low, high))) = orders.fitted {
            let [order, low, high] = [order, low, high].map(|x| sig(x, 3));
            let _ = write!(out, "; fitted {order} (95 %: {low} to {high})");
        }
        out.push('\n');
    }
    for row in summary.theirs.iter().chain(&summary.ours) {
        let weights = row.weights.map_or("", Weights::said);
        let _ = writeln!(out, "weights of {}: {weights}", row.name);
    }
    if summary.records.is_empty() {
        let _ = writeln!(
            out,
            "no record of ours at this time in {}: --ours N runs our own code, --records DIR names another folder",
            args.records.display()
        );
    }
    out
}
