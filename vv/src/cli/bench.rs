//! `whipple bench`: what the density costs along a line, and how fast the cases of impact are in space.

use whipple_solver::method::{Density, Integrator, Preset};

use super::sizes::expect;
use super::{Bench, BenchArgs, Failure, NUMERICAL_FAILURE, print, say};
use crate::cost::{Comparison, Contender, CostError, EQUAL_LIST, compare};
use crate::files::write_atomic;
use crate::lock::FolderLock;
use crate::memory::Keeps;
use crate::pace::rivals::{self, Contest, Rival};
use crate::pace::{self, PaceError, Stretch, measure};
use crate::plots;
use crate::record::{RunKey, Scheme};
use crate::report::{self, Align, Cell, Column, Table};
use crate::suite::scene_of;
use crate::words::counted;

impl From<CostError> for Failure {
    fn from(error: CostError) -> Self {
        match error {
            CostError::Scene(error) => Self::usage(error),
            CostError::Step(error) => Self { code: NUMERICAL_FAILURE, message: error.to_string() },
        }
    }
}

impl From<PaceError> for Failure {
    fn from(error: PaceError) -> Self {
        match error {
            PaceError::Step(error) => Self { code: NUMERICAL_FAILURE, message: error.to_string() },
            PaceError::Scene(_) | PaceError::Threads { .. } => Self::usage(error),
        }
    }
}

pub(super) const EXAMPLES: &str = "\
Examples:
  whipple bench rod --steps 200                    speed and phases of the long rod
  whipple bench density --n 10000 --rounds 4       cost of the density schemes
  whipple bench sphere --threads 4 --out out/bench";

/// Measures what was asked for and prints it.
pub(super) fn bench(args: &BenchArgs) -> Result<u8, Failure> {
    let wants = |what: Bench| args.what.is_empty() || args.what.contains(&what);
    let _lock = args.out.as_deref().map(FolderLock::take).transpose()?;
    if wants(Bench::Density) {
        density(args)?;
    }
    for (what, impact) in IMPACTS {
        if wants(what) {
            pace_of(&impact, args)?;
        }
    }
    if args.what.contains(&Bench::Rivals) {
        rivals(args)?;
    }
    Ok(0)
}

/// Time, in us, in the middle of the impact, from which rivals are compared.
const MIDDLE: f64 = 2.0;

/// Updates of a turn of rivals, and its steps at least: a list serves both sides several times within them.
const TURN: usize = 600_000;
const STEPS: usize = 16;

/// Integrations that are compared.
const BOTH: [Integrator; 2] = [Integrator::SinglePass, Integrator::Compatible];

/// What the density of a kernel costs on carbon-carbon, the paper's Table 7, and what ellipsoids do.
fn rivals(args: &BenchArgs) -> Result<(), Failure> {
    let case = super::run::find("rcc-plate")?;
    let sizes = args.cells.map_or_else(|| vec![4, 6, 8], |n| vec![n]);
    let (mut kernels, mut shapes, mut free) = (Vec::new(), Vec::new(), Vec::new());
    for n in sizes {
        let of = |preset, density| {
            let scene =
                scene_of(case, &RunKey::new(case.id(), Scheme::Particles { preset, density }, n));
            let scene = scene.and_then(|scene| scene.space().cloned());
            scene.ok_or_else(|| Failure::usage("`rcc-plate` is in space"))
        };
        let paper = of(Preset::Paper, Density::Kernel)?;
        expect(case, ("--cells", n), &paper.clone().into(), Keeps::default())?;
        let particles =
            whipple_solver::space::Simulation::new(&paper).map_err(Failure::usage)?.particles();
        let steps = (TURN / particles).max(STEPS) as u64;
        let contest = |integrator: Integrator, rival: Rival| {
            say(&format!("{}, {n} cells, {}, {} ...", case.id(), integrator.name(), rival.name()));
            Contest { integrator, rival, from: MIDDLE, steps, rounds: args.rounds }
        };
        for (integrator, rival) in BOTH.into_iter().flat_map(|by| Rival::KERNELS.map(|r| (by, r))) {
            let contest = contest(integrator, rival);
            kernels.push(rivals::compare(&paper, contest)?);
            if args.whole {
                free.push(rivals::run_free(&paper, contest)?);
            }
        }
        for (preset, density) in
            [(Preset::Paper, Density::Nonholonomic), (Preset::Default, Density::Hybrid)]
        {
            let scene = of(preset, density)?;
            let contest = contest(scene.method.integrator, Rival::Ellipsoids);
            shapes.push(rivals::compare(&scene, contest)?);
        }
    }
    let mut tables =
        vec![rivals::ratios(&kernels), rivals::phases(&kernels), rivals::shapes(&shapes)];
    if args.whole {
        tables.push(rivals::whole(&free));
    }
    show(&tables, args, "")?;
    draw(&rivals::figure(&kernels), args, "rivals.svg")
}

/// Prints tables, and writes them where that is wanted.
fn show(tables: &[Table], args: &BenchArgs, prefix: &str) -> Result<(), Failure> {
    for table in tables {
        print(&format!("\n{}", grid(table)))?;
        if let Some(out) = &args.out {
            let file = format!("{prefix}{}.csv", table.id);
            write_atomic(&out.join(file), report::csv(table).as_bytes())?;
        }
    }
    Ok(())
}

/// Writes a figure, where that is wanted.
fn draw(figure: &plots::Figure, args: &BenchArgs, file: &str) -> Result<(), Failure> {
    let Some(out) = &args.out else { return Ok(()) };
    let svg = plots::render_svg(figure).map_err(Failure::usage)?;
    Ok(write_atomic(&out.join(file), svg.as_bytes())?)
}

/// A case whose speed is measured.
struct Impact {
    case: &'static str,
    /// The variant that `paper` runs.
    of_paper: &'static str,
}

const IMPACTS: [(Bench, Impact); 3] = [
    (Bench::Rod, Impact { case: "long-rod", of_paper: "as-printed" }),
    (Bench::Plate, Impact { case: "rcc-plate", of_paper: "" }),
    (Bench::Sphere, Impact { case: "al-sphere-plate", of_paper: "" }),
];

/// Speed, phases and memory of a case: `default`, the paper's method, and the kernel that it removes.
fn pace_of(impact: &Impact, args: &BenchArgs) -> Result<(), Failure> {
    let stretch = if args.whole { Stretch::Whole } else { Stretch::Steps(args.steps as u64) };
    let case = super::run::find(impact.case)?;
    let n = args.cells.unwrap_or(case.default_size());
    let scene = |scheme: Scheme, variant: &str| {
        let key = RunKey::new(case.id(), scheme, n).variant(variant);
        let scene = scene_of(case, &key).and_then(|scene| scene.space().cloned());
        scene.ok_or_else(|| Failure::usage(format!("`{}` is not in space", case.id())))
    };
    let kernel = Scheme::Particles { preset: Preset::Paper, density: Density::Kernel };
    // The kernel takes the most memory.
    let largest = scene(kernel, impact.of_paper)?.into();
    expect(case, ("--cells", n), &largest, Keeps::default())?;
    let run = |(scheme, variant): (Scheme, &str), threads: usize| {
        let (label, cells) = (scheme.label(), counted(n, ["cell", "cells"]));
        say(&format!("{}, {cells}, {label}, threads: {threads} ...", case.id()));
        Ok::<_, Failure>(measure(&label, &scene(scheme, variant)?, stretch, threads)?)
    };
    let default = (Scheme::preset(Preset::Default), "");
    // One after the other, so that the machine is the same.
    let (one, more) = (run(default, 1)?, run(default, args.threads)?);
    let paper = run((Scheme::preset(Preset::Paper), impact.of_paper), 1)?;
    let kernel = run((kernel, impact.of_paper), 1)?;
    let paces = [one, paper, kernel];
    let tables = [pace::work(&paces), pace::phases(&paces), pace::machine(&paces[0], &more)];
    show(&tables, args, &format!("{}-", case.id()))?;
    draw(&pace::figure(&paces), args, &format!("{}-pace.svg", case.id()))
}

/// A table for the terminal: names to the left, numbers to the right, its caption below.
fn grid(table: &Table) -> String {
    let head = |column: &Column| match column.unit.as_str() {
        "" => column.name.clone(),
        unit => format!("{}, {unit}", column.name),
    };
    let texts = |row: &Vec<Cell>| row.iter().map(|cell| cell.text.clone()).collect();
    let mut rows: Vec<Vec<String>> = vec![table.columns.iter().map(head).collect()];
    rows.extend(table.rows.iter().map(texts));
    let width =
        |k: usize| rows.iter().filter_map(|row| row.get(k)).map(|t| t.chars().count()).max();
    let mut out = String::new();
    for row in &rows {
        for (k, text) in row.iter().enumerate() {
            let width = width(k).unwrap_or(0);
            match table.columns[k].align {
                Align::Right => out += &format!("  {text:>width$}"),
                Align::Left | Align::Center => out += &format!("  {text:<width$}"),
            }
        }
        out += "\n";
    }
    out + &table.caption + "\n"
}

/// Runs the comparisons of the density schemes.
fn density(args: &BenchArgs) -> Result<(), Failure> {
    let natural = Preset::Default.method().kernel_support;
    let with = |density, support| Contender { density, support };
    let paper = with(Density::Nonholonomic, natural);
    let rivals = [
        ("kernel, equal contact list", with(Density::Kernel, EQUAL_LIST)),
        ("kernel, natural support", with(Density::Kernel, natural)),
        ("hybrid", with(Density::Hybrid, natural)),
    ];
    let mut rows = Vec::new();
    for integrator in BOTH {
        for (name, rival) in rivals {
            say(&format!("{name} against nonholonomic, {} ...", integrator.name()));
            rows.push(row(
                integrator,
                name,
                &compare([paper, rival], integrator, args.n, args.rounds)?,
            ));
        }
    }
    let number = |name: &str| Column::number(name, "");
    let columns = vec![
        Column::text("integrator"),
        Column::text("against nonholonomic"),
        number("ratio"),
        number("least"),
        number("greatest"),
        number("ns/particle"),
        number("ns/pair"),
        number("ns/particle, nonholonomic"),
    ];
    let caption = "CPU time, medians over A B B A rounds, and the least and greatest ratio of a round; \
                   nanoseconds per particle and step, and per pair and step.";
    let table = Table { id: "density".into(), caption: caption.into(), columns, rows };
    show(&[table], args, "")
}

fn row(integrator: Integrator, name: &str, found: &Comparison) -> Vec<Cell> {
    let (low, high) = found.spread();
    let mut cells = vec![integrator.name().into(), name.into()];
    cells.extend([found.median(), low, high].map(|ratio| Cell::number(ratio, 4)));
    let times = [found.b.per_particle_step, found.b.per_pair, found.a.per_particle_step];
    cells.extend(times.map(|time| Cell::number(time, 4)));
    cells
}
