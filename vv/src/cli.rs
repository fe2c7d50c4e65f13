//! The command line: where strings become types, and results become exit codes.

use std::io::Write;
use std::path::PathBuf;
use std::time::Duration;

use clap::{CommandFactory, Parser, Subcommand, ValueEnum};
use whipple_solver::method::{Density, Preset};

use crate::cases::Level;
use crate::scenes::case::Section;
use crate::scenes::vary::{Key, Variation};
use crate::space::picture::Shown;
use crate::words::harmless;
use numbers::{SCENES, SIZES, THREADS, whole};
use times::{SimulatedTime, wall_time};

mod bench;
mod check;
mod compare;
mod folder;
mod hard;
mod list;
mod manual;
mod material;
mod numbers;
mod progress;
mod random;
mod reports;
mod results;
mod resume;
mod run;
mod score;
mod sensitivity;
mod show;
mod sizes;
mod sweep;
mod times;

/// Exit code when a required claim failed.
const CLAIM_FAILED: u8 = 1;
/// Exit code of wrong use or input.
const WRONG_USE: u8 = 2;
/// Exit code of a numerical failure.
const NUMERICAL_FAILURE: u8 = 3;
/// Exit code after an interrupt.
const INTERRUPTED: u8 = 130;

/// Verification and validation of impact simulations.
#[derive(Debug, Parser)]
#[command(name = "whipple", version, about, long_about = None, after_help = EXAMPLES)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

const EXAMPLES: &str = "\
Examples:
  whipple vv                          run every case, judge, write the report to reports/
  whipple vv noh --level quick        one case, few sizes
  whipple list noh                    what is measured and claimed of a case
  whipple run noh --preset paper --n 400 --json
  whipple run sod --set heating=printed --out out/sod
  whipple run long-rod --vtu 5us --max-wall 30min --out out/rod
  whipple new shield.toml             a scene of your own to begin with
  whipple check shield.toml           what it makes, before it runs
  whipple run shield.toml --out out/shield

Exit codes:
  0    fine; of run also where its numbers are not what is wanted: it is one run of many
  1    a required claim failed (vv, report), or the report differs (report --check)
  2    wrong use or input
  3    numerical failure
  130  interrupted, or --max-wall is over (run)";

#[derive(Debug, Subcommand)]
enum Command {
    /// List the cases with sizes and variants, one case with its claims, or the keys of --set
    #[command(after_help = list::EXAMPLES)]
    List(ListArgs),
    /// Run one case, or a scene file, and print what was measured
    #[command(after_help = run::EXAMPLES)]
    Run(RunArgs),
    /// Say what a scene file makes, without running it: sizes, masses, gaps, memory, time, a picture
    #[command(after_help = "Example:\n  whipple check shield.toml --out out/shield")]
    Check(CheckArgs),
    /// Write a scene file to begin with, with comments
    #[command(after_help = "Example:\n  whipple new shield.toml")]
    New(NewArgs),
    /// Print the JSON schema of scene files, by which editors complete and check keys
    #[command(after_help = "Example:\n  whipple schema > scene.schema.json")]
    Schema,
    /// The material library: its list, or a material with its sources and Hugoniot
    #[command(after_help = material::EXAMPLES)]
    Material(MaterialArgs),
    /// Run a scene file with all combinations of values, a process each, into one table
    #[command(
        after_help = "Example:\n  whipple sweep shield.toml --vary 'body.sphere.velocity.2=5 km/s, 6 km/s, 7 km/s' --out out/sweep"
    )]
    Sweep(SweepArgs),
    /// Find by bisection where the `until` of a scene file begins to be met, such as a ballistic limit
    #[command(
        after_help = "Example:\n  whipple limit shield.toml body.sphere.velocity.2 --low '2 km/s' --high '6 km/s' --out out/limit"
    )]
    Limit(LimitArgs),
    /// Show what a run has left in its folder: findings, energies, fragments, a picture of its last state
    #[command(after_help = show::EXAMPLES)]
    Show(ShowArgs),
    /// Compare two runs: scenes, findings, histories
    #[command(after_help = compare::EXAMPLES)]
    Compare(CompareArgs),
    /// Judge results of any program on a case with an exact profile: norms, orders, figure, ours beside
    #[command(after_help = score::EXAMPLES)]
    Score(score::ScoreArgs),
    /// Run cases, judge their claims and write the report
    #[command(after_help = reports::VV_EXAMPLES)]
    Vv(VvArgs),
    /// Redraw the report from its records, over the one that is there, without running anything
    #[command(after_help = reports::REPORT_EXAMPLES)]
    Report(ReportArgs),
    /// Measure speed: cost of the density schemes, and the cases of impact in three dimensions
    #[command(after_help = bench::EXAMPLES)]
    Bench(BenchArgs),
    /// Make the reference of woodward-colella, which has no exact solution; takes some minutes
    ///
    /// The Godunov code runs with 20 000 cells, and its fields, averaged to 4000 rows, are written as CSV.
    /// Records are compared with the reference that the program was built with: a new one counts after the
    /// next build.
    #[command(after_help = reports::REFERENCE_EXAMPLE)]
    Reference(ReferenceArgs),
    /// Print a completion script for a shell
    #[command(after_help = manual::COMPLETIONS_EXAMPLES)]
    Completions {
        /// Shell
        shell: clap_complete::Shell,
    },
    /// Print the manual page of the program, or write those of all commands
    #[command(after_help = manual::MAN_EXAMPLES)]
    Man {
        /// Folder for a page of every command
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
}

#[derive(Debug, clap::Args)]
struct ListArgs {
    /// Case to be shown whole: problem, sizes, what is measured, claims with what is wanted
    case: Option<String>,
    /// What `run --set` can change: key, default of each preset, unit, meaning; with a case, also the
    /// values of its scene
    #[arg(long)]
    keys: bool,
}

#[derive(Debug, clap::Args)]
struct RunArgs {
    /// Case, as `whipple list` names it, or a scene file, whose name ends in .toml
    case: String,
    /// Numerical choices
    #[arg(long, value_enum, default_value_t = PresetArg::Default)]
    preset: PresetArg,
    /// Density scheme, if not the preset's own
    #[arg(long, value_enum)]
    density: Option<DensityArg>,
    /// Size: number of particles; in three dimensions, of cells across what the case names. `whipple
    /// list CASE` has those that the levels run
    #[arg(long, allow_hyphen_values = true, value_parser = whole(SIZES))]
    n: Option<usize>,
    /// Variant of the case
    #[arg(long, default_value = "", allow_hyphen_values = true)]
    variant: String,
    /// Angle of the impact from the normal in degrees, of a case that has a choice of them; this chooses
    /// the variant
    #[arg(long, value_name = "DEGREES", conflicts_with = "variant", allow_hyphen_values = true)]
    angle: Option<String>,
    /// Equation of state of the target, of a case that has a choice of them; this chooses the variant
    #[arg(long, value_name = "NAME", conflicts_with = "variant", allow_hyphen_values = true)]
    eos: Option<String>,
    /// Stop at this time instead of the case's own: a number in the units of the scene, or with a
    /// unit (20us, 0.5ms)
    #[arg(long, value_name = "TIME", conflicts_with = "godunov", allow_hyphen_values = true)]
    stop: Option<SimulatedTime>,
    /// Change one value of the scene, such as heating=pair (repeatable); `whipple list --keys` has all
    /// keys
    #[arg(long = "set", value_name = "KEY=VALUE", allow_hyphen_values = true)]
    sets: Vec<String>,
    /// Run the Eulerian Godunov code on the case instead
    #[arg(long, conflicts_with_all = ["preset", "density", "sets"])]
    godunov: bool,
    /// Threads
    #[arg(
        long,
        default_value_t = 1,
        allow_hyphen_values = true,
        value_parser = whole(THREADS)
    )]
    threads: usize,
    /// Folder for the record, the scene and the fields as CSV; in three dimensions also for the
    /// ledger, pictures, frames and checkpoints
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// In three dimensions: write the state as VTU files every so often, such as 5us; `run.pvd`
    /// lists them
    #[arg(long, value_name = "EVERY", conflicts_with = "godunov", allow_hyphen_values = true)]
    vtu: Option<SimulatedTime>,
    /// In three dimensions: go on from this checkpoint of the same case and options; the bits are
    /// those of a run that was never stopped
    #[arg(long, value_name = "FILE", conflicts_with = "godunov")]
    resume: Option<PathBuf>,
    /// In three dimensions: after this time on the clock, such as 30s or 2min, write a checkpoint
    /// and stop with exit code 130, as an interrupt (Ctrl-C) does
    #[arg(
        long,
        value_name = "TIME",
        conflicts_with = "godunov",
        allow_hyphen_values = true,
        value_parser = wall_time
    )]
    max_wall: Option<Duration>,
    /// In three dimensions: write a checkpoint this often on the clock, such as 10min; the last two
    /// are kept
    #[arg(
        long,
        value_name = "EVERY",
        conflicts_with = "godunov",
        allow_hyphen_values = true,
        value_parser = wall_time
    )]
    checkpoint: Option<Duration>,
    /// Print one JSON object on standard output
    #[arg(long)]
    json: bool,
}

#[derive(Debug, clap::Args)]
struct CheckArgs {
    /// Scene file
    #[arg(value_name = "FILE")]
    scene: PathBuf,
    /// Cells through the thinnest part of any body, if not as the file has it
    #[arg(long, allow_hyphen_values = true, value_parser = whole(SIZES))]
    n: Option<usize>,
    /// Folder for pictures of the start
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

#[derive(Debug, clap::Args)]
struct NewArgs {
    /// File to write
    file: PathBuf,
}

#[derive(Debug, clap::Args)]
struct SweepArgs {
    /// Scene file
    #[arg(value_name = "FILE")]
    scene: PathBuf,
    /// A key of the file and its values, such as 'body.sphere.velocity.2=5 km/s, 6 km/s' (repeatable: all combinations); parts
    /// of a list are named by number from 0, or by their name
    #[arg(long, required = true, value_name = "KEY=VALUES")]
    vary: Vec<Variation>,
    /// Folder, with one of its own for each run; runs that are there already are not run again
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Runs at a time
    #[arg(long, default_value_t = 1, allow_hyphen_values = true, value_parser = whole(THREADS))]
    jobs: usize,
    /// Finding that is drawn in sweep.svg and sweep.png over the first key with numbers (repeatable); without, the first four
    /// that change
    #[arg(long, value_name = "NAME")]
    plot: Vec<String>,
    /// Write the scene files and print the commands of the runs, for a scheduler, without running them
    #[arg(long)]
    list: bool,
}

#[derive(Debug, clap::Args)]
struct LimitArgs {
    /// Scene file, with an `until`
    #[arg(value_name = "FILE")]
    scene: PathBuf,
    /// Key of the file that is changed, such as body.sphere.velocity.2
    key: Key,
    /// One end of the range
    #[arg(long, allow_hyphen_values = true)]
    low: String,
    /// The other end, where the condition is met if it is not at the first, or the other way round
    #[arg(long, allow_hyphen_values = true)]
    high: String,
    /// Runs between them: each halves the range
    #[arg(long, default_value_t = 5, allow_hyphen_values = true, value_parser = whole(1..=40))]
    runs: usize,
    /// Folder, with one of its own for each run; runs that are there already are not run again
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

#[derive(Debug, clap::Args)]
struct ShowArgs {
    /// Folder of a run
    #[arg(value_name = "RUN")]
    run: PathBuf,
    /// Checkpoint whose state is shown, if not the last one of the folder
    #[arg(long, value_name = "FILE")]
    checkpoint: Option<PathBuf>,
    /// Cut the picture at a plane, such as y=0 or 'z=2 mm'; it passes a quarter of a cell beside the value, since a
    /// cut along faces of elements is ragged
    #[arg(long, value_name = "AXIS=PLACE", allow_hyphen_values = true)]
    section: Option<Section>,
    /// What decides the colours
    #[arg(long, value_enum, default_value_t = ColourArg::Body)]
    colour: ColourArg,
    /// Folder for the picture, for light and dark pages, and for fragments.csv; other files are not replaced
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print one JSON object on standard output
    #[arg(long)]
    json: bool,
}

/// What `show` colours by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum ColourArg {
    /// The body
    Body,
    /// The material
    Material,
    /// The speed
    Velocity,
    /// The pressure
    Pressure,
    /// The density
    Density,
    /// The temperature
    Temperature,
    /// The damage of elements
    Damage,
    /// The effective plastic strain of elements
    PlasticStrain,
}

impl ColourArg {
    fn shown(self) -> Shown {
        match self {
            Self::Body => Shown::Body,
            Self::Material => Shown::Material,
            Self::Velocity => Shown::Velocity,
            Self::Pressure => Shown::Pressure,
            Self::Density => Shown::Density,
            Self::Temperature => Shown::Temperature(None),
            Self::Damage => Shown::Damage,
            Self::PlasticStrain => Shown::PlasticStrain(None),
        }
    }

    /// In names of files.
    fn name(self) -> String {
        self.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
    }
}

#[derive(Debug, clap::Args)]
struct CompareArgs {
    /// Folders of two runs
    #[arg(value_name = "RUN", num_args = 2)]
    runs: Vec<PathBuf>,
    /// Folder for a figure of the histories, as SVG and PNG; other files are not replaced
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print one JSON object on standard output
    #[arg(long)]
    json: bool,
}

#[derive(Debug, clap::Args)]
struct MaterialArgs {
    #[command(subcommand)]
    command: MaterialCommand,
}

#[derive(Debug, Subcommand)]
enum MaterialCommand {
    /// All materials of the library
    #[command(after_help = material::LIST_EXAMPLE)]
    List,
    /// One material: constants, sources, Hugoniot
    #[command(after_help = material::SHOW_EXAMPLE)]
    Show {
        /// Name
        name: String,
        /// Folder for its Hugoniot and its yield stress as curves
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
}

#[derive(Debug, clap::Args)]
struct VvArgs {
    /// Cases; all when none is named. `hard` is the group of cases that try to break the solver; those named after
    /// it, such as `hard H03`, run alone
    cases: Vec<String>,
    /// How much to run
    #[arg(long, value_parser = reports::levels(), default_value = Level::Standard.name())]
    level: Level,
    /// With `hard`: not the other schemes, which take most of the time, but `default` alone, which the exit code is about
    #[arg(long)]
    default_only: bool,
    /// With `hard`: so many small random impacts instead of the cases, with what holds of any; the report does not
    /// show them
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = whole(SCENES))]
    random: Option<usize>,
    /// First seed of the random impacts, each of which follows from its seed alone: `--random 1 --from SEED` repeats
    /// one, says all of it and writes no record
    #[arg(long, value_name = "SEED", requires = "random", default_value_t = 0)]
    from: u64,
    /// With `hard`: how far the numbers of impacts move with time step, lattice, viscosity and constants of failure;
    /// cases named after the group are studied alone
    #[arg(long, conflicts_with = "random")]
    sensitivity: bool,
    /// Folder of the report: one that is there is drawn anew, with the records of its other runs
    #[arg(long, value_name = "DIR", default_value = "reports")]
    out: PathBuf,
    /// Also write single-file.html in that folder: the page with its pictures within, to send around
    #[arg(long)]
    single_file: bool,
}

#[derive(Debug, clap::Args)]
struct ReportArgs {
    /// Folder of the report, with its records
    #[arg(long, value_name = "DIR", default_value = "reports")]
    out: PathBuf,
    /// Write nothing: compare with the report that is there, exit 1 if it differs
    #[arg(long)]
    check: bool,
    /// Write (or check) single-file.html in that folder instead, and nothing else: the page with its
    /// pictures within, to send around
    #[arg(long)]
    single_file: bool,
}

#[derive(Debug, clap::Args)]
struct BenchArgs {
    /// What to measure; all of it when nothing is named
    what: Vec<Bench>,
    /// Density: particles along the line
    #[arg(
        long,
        default_value_t = 10_000,
        allow_hyphen_values = true,
        value_parser = whole(2..=10_000_000)
    )]
    n: usize,
    /// Density, rivals: A/B/B/A rounds
    #[arg(long, default_value_t = 10, allow_hyphen_values = true, value_parser = whole(1..=1000))]
    rounds: usize,
    /// Impacts: size, as `run --n`; that of the case if none is given
    #[arg(long, allow_hyphen_values = true, value_parser = whole(1..=1000))]
    cells: Option<usize>,
    /// Impacts: steps of each run, from its start
    #[arg(
        long,
        default_value_t = 400,
        allow_hyphen_values = true,
        value_parser = whole(1..=10_000_000)
    )]
    steps: usize,
    /// Impacts: runs to their end instead
    #[arg(long, conflicts_with = "steps")]
    whole: bool,
    /// Impacts: threads that are compared with one
    #[arg(long, default_value_t = 2, allow_hyphen_values = true, value_parser = whole(THREADS))]
    threads: usize,
    /// Folder for the tables as CSV and, of impacts and rivals, the figures as SVG
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// What `bench` measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Bench {
    /// Cost of the density schemes along a line
    Density,
    /// Speed, phases and memory of the long rod in three dimensions
    Rod,
    /// The same of the sphere on carbon-carbon
    Plate,
    /// The same of the sphere on aluminium
    Sphere,
    /// Density of a kernel against the paper's on carbon-carbon, its Table 7, and ellipsoids against spheres; not run unless
    /// it is named
    Rivals,
}

#[derive(Debug, clap::Args)]
struct ReferenceArgs {
    /// File to write
    #[arg(long, value_name = "FILE", default_value = crate::cases::woodward_colella::REFERENCE_FILE)]
    out: PathBuf,
    /// Write over a file that is there
    #[arg(long)]
    force: bool,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum PresetArg {
    /// Reproduces the paper's tables
    Paper,
    /// Everything else
    Default,
}

impl From<PresetArg> for Preset {
    fn from(arg: PresetArg) -> Self {
        match arg {
            PresetArg::Paper => Self::Paper,
            PresetArg::Default => Self::Default,
        }
    }
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum DensityArg {
    /// Integrated from contact kinematics: the paper's
    Nonholonomic,
    /// Summed over a kernel
    Kernel,
    /// From the segments between neighbours
    Hybrid,
}

impl From<DensityArg> for Density {
    fn from(arg: DensityArg) -> Self {
        match arg {
            DensityArg::Nonholonomic => Self::Nonholonomic,
            DensityArg::Kernel => Self::Kernel,
            DensityArg::Hybrid => Self::Hybrid,
        }
    }
}

/// How a command ended, if not well.
#[derive(Debug)]
struct Failure {
    code: u8,
    message: String,
}

impl Failure {
    fn usage(message: impl std::fmt::Display) -> Self {
        Self { code: WRONG_USE, message: message.to_string() }
    }
}

impl From<crate::run::RunError> for Failure {
    fn from(error: crate::run::RunError) -> Self {
        use crate::run::RunError as E;
        let code = match error {
            E::Interrupted { .. } => INTERRUPTED,
            E::Step(_) | E::Norm(_) | E::Godunov(_) => NUMERICAL_FAILURE,
            E::Scene(_)
            | E::Reference(_)
            | E::NotThere { .. }
            | E::Picture { .. }
            | E::Resume(_)
            | E::Output(_) => WRONG_USE,
        };
        Self { code, message: error.to_string() }
    }
}

impl From<crate::suite::SuiteError> for Failure {
    fn from(error: crate::suite::SuiteError) -> Self {
        match error {
            crate::suite::SuiteError::Run { key, source } => {
                let inner = Self::from(source);
                Self { code: inner.code, message: format!("{key}: {}", inner.message) }
            }
            other => Self::usage(other),
        }
    }
}

impl From<crate::files::FileError> for Failure {
    fn from(error: crate::files::FileError) -> Self {
        Self::usage(error)
    }
}

impl From<crate::lock::LockError> for Failure {
    fn from(error: crate::lock::LockError) -> Self {
        Self::usage(error)
    }
}

impl From<crate::hard::HardError> for Failure {
    fn from(error: crate::hard::HardError) -> Self {
        Self::usage(error)
    }
}

impl From<crate::record::RecordError> for Failure {
    fn from(error: crate::record::RecordError) -> Self {
        Self::usage(error)
    }
}

/// The command line as data, for manuals and for tests that read commands without running them.
#[must_use]
pub fn command() -> clap::Command {
    Cli::command()
}

/// Runs the program and returns its exit code.
#[must_use]
pub fn main() -> u8 {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            let code = if error.use_stderr() { WRONG_USE } else { 0 };
            // Nothing can be done about a closed terminal.
            let _ = error.print();
            return code;
        }
    };
    let ended = match cli.command {
        Command::List(args) => list::list(&args),
        Command::Run(args) => run::run(&args),
        Command::Check(args) => check::check(&args),
        Command::New(args) => check::new(&args),
        Command::Schema => check::schema(),
        Command::Material(args) => material::material(&args),
        Command::Sweep(args) => sweep::sweep(&args),
        Command::Limit(args) => sweep::limit(&args),
        Command::Show(args) => show::show(&args),
        Command::Compare(args) => compare::compare(&args),
        Command::Score(args) => score::score(&args),
        Command::Vv(args) => vv(&args),
        Command::Report(args) => reports::report(&args),
        Command::Bench(args) => bench::bench(&args),
        Command::Reference(args) => reports::reference(&args),
        Command::Completions { shell } => manual::completions(shell),
        Command::Man { out } => manual::man(out.as_deref()),
    };
    match ended {
        Ok(code) => code,
        Err(failure) => {
            // A stop that was asked for is no error.
            let word = if failure.code == INTERRUPTED { "note" } else { "error" };
            say(&format!("{word}: {}", harmless(&as_called(&failure.message, &program()))));
            failure.code
        }
    }
}

/// Runs cases, those of the group `hard`, or random impacts.
fn vv(args: &VvArgs) -> Result<u8, Failure> {
    match args.random {
        Some(count) => random::random(args, count),
        None if args.sensitivity => sensitivity::sensitivity(args),
        None if args.cases.iter().any(|name| name == hard::GROUP) => hard::hard(args),
        None => reports::vv(args),
    }
}

/// The program as it was called.
fn program() -> String {
    let own = || Cli::command().get_name().to_owned();
    std::env::args().next().filter(|name| !name.is_empty()).unwrap_or_else(own)
}

/// Text whose commands begin with the program as it was called, so that they can be copied.
fn as_called(text: &str, program: &str) -> String {
    ["`", "\n  "].into_iter().fold(text.to_owned(), |text, before| {
        text.replace(&format!("{before}whipple "), &format!("{before}{program} "))
    })
}

/// Prints results. A reader that has gone away is no error.
fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Failure::usage(format!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// Prints a message.
fn say(text: &str) {
    // There is nowhere left to complain about a closed standard error.
    let _ = writeln!(std::io::stderr(), "{text}");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_in_messages_are_those_of_the_program() {
        let said = |text| as_called(text, "target/release/whipple");
        assert_eq!(said("see `whipple list`"), "see `target/release/whipple list`");
        assert_eq!(
            said("continue with\n  whipple run noh"),
            "continue with\n  target/release/whipple run noh"
        );
        assert_eq!(said("whipple is a program"), "whipple is a program");
    }

    #[test]
    fn arguments_are_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn help_reads_well() {
        let mut command = Cli::command().term_width(90);
        insta::assert_snapshot!("help", command.render_long_help());
        for name in ["run", "check", "vv", "report", "bench", "reference"] {
            let sub = command.find_subcommand_mut(name).expect("a command");
            insta::assert_snapshot!(
                format!("help_{name}"),
                sub.clone().term_width(90).render_long_help()
            );
        }
    }
}
