//! The cases: one file each, with all its facts.
//!
//! A case says what is to be simulated, what is measured, and what is claimed of it. It knows
//! nothing of files, pages or the command line.

/// Source of numbers that are wanted of this solver and stand in no reference: where a reader finds them,
/// and what there is to say besides.
macro_rules! wanted {
    () => {
        "README, Accuracy wanted"
    };
    ($more:literal) => {
        concat!(wanted!(), "; ", $more)
    };
}

mod al_sphere_plate;
mod beam;
mod block_collision;
mod einfeldt;
mod elastic_plastic_piston;
mod figures;
mod free_surface;
mod galilean_boost;
mod gas;
mod heat_chain;
mod kolsky;
mod lattice_kinematics;
mod leblanc;
mod long_rod;
mod noh;
mod noh_space;
mod parts;
mod planar_impact;
mod rcc_plate;
mod saltzman;
mod sedov;
mod sod;
mod spall;
mod spinning_block;
mod strong_shock_tube;
mod taylor;
mod two_stream_noh;
mod unequal_masses;
mod uniform_collapse;
mod vacuum_release;
mod verney;
pub(crate) mod woodward_colella;

use std::time::Duration;

use whipple_solver::method::Preset;
use whipple_solver::scene::Scene;
use whipple_solver::space;

use crate::claims::{Claim, Kind, Quantity, Wanted, Weight};
use crate::plots::Figure;
use crate::record::{Records, RunKey, Scheme};
use crate::report::Table;
use crate::run::{Driver, Findings, RunError, SpaceDriver};
use crate::scene::AnyScene;

/// How much is run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, clap::ValueEnum)]
pub enum Level {
    /// Few sizes of every case, not always its smallest.
    Quick,
    /// Most sizes that claims need.
    Standard,
    /// Every size that a claim needs, the long rod at 9 cells, it and the plate in their variants.
    Full,
}

impl Level {
    /// All levels, the shortest first.
    pub const ALL: [Self; 3] = [Self::Quick, Self::Standard, Self::Full];

    /// Name, as on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Quick => "quick",
            Self::Standard => "standard",
            Self::Full => "full",
        }
    }

    /// What it runs of three sizes, the coarsest first.
    fn first(self, sizes: &[usize; 3]) -> &[usize] {
        &sizes[..=self as usize]
    }
}

/// What the Godunov code made of a case.
#[derive(Debug, Clone, Default)]
pub struct Eulerian {
    /// Norms and fields.
    pub findings: Findings,
    /// Time steps.
    pub steps: u64,
    /// Cells advanced by a step.
    pub cell_steps: u64,
    /// Largest error of the energy balance over the initial energy.
    pub energy_drift: f64,
    /// CPU time of the stepping alone, where more than that was done.
    pub cpu: Option<Duration>,
}

/// Something of a problem that an option of its own chooses on the command line, `--angle` or `--eos`.
#[derive(Debug, Clone, Copy)]
pub struct Choice {
    /// Name of the option.
    pub name: &'static str,
    /// What can be chosen; the first is what the plain variant has.
    pub values: &'static [&'static str],
}

impl Choice {
    /// What a value adds to the name of a variant, whether or not the plain one has it.
    #[must_use]
    pub fn part(&self, value: &str) -> String {
        format!("{}-{value}", self.name)
    }

    /// What a value adds to the name of a variant: nothing if the plain one has it.
    #[must_use]
    pub fn named(&self, value: &str) -> Option<String> {
        (value != self.values[0]).then(|| self.part(value))
    }
}

/// A problem with a known answer.
pub trait Case: Sync {
    /// Name on the command line.
    fn id(&self) -> &'static str;

    /// Title in the report.
    fn title(&self) -> &'static str;

    /// What the problem is and what it shows, in a few sentences.
    fn about(&self) -> &'static str;

    /// Where problem and answer come from.
    fn source(&self) -> &'static str;

    /// Variants; the first is the one that runs when none is named, and its name is empty.
    fn variants(&self) -> &'static [&'static str] {
        &[""]
    }

    /// What has options of its own on the command line. Chosen values that the plain variant does not have
    /// make the name of the variant that runs, joined by `_` in this order: all of them are in
    /// [`Case::variants`].
    fn choices(&self) -> &'static [Choice] {
        &[]
    }

    /// Size when none is given: of particles along a line, of cells across what the case names in space.
    fn default_size(&self) -> usize;

    /// The problem with the choices of a preset.
    fn scene(&self, preset: Preset, variant: &str, n: usize) -> AnyScene;

    /// Runs a scene along a line to its end and measures.
    ///
    /// # Errors
    /// A numerical failure, an interrupt, or a norm that is not a number.
    fn measure(
        &self,
        _scene: &Scene,
        _key: &RunKey,
        _driver: &mut Driver<'_>,
    ) -> Result<Findings, RunError> {
        Err(RunError::NotThere { case: self.id().into(), what: "along a line".into() })
    }

    /// Runs a scene in space to its end and measures.
    ///
    /// # Errors
    /// A numerical failure, an interrupt, or a norm that is not a number.
    fn measure_space(
        &self,
        _scene: &space::Scene,
        _key: &RunKey,
        _driver: &mut SpaceDriver<'_>,
    ) -> Result<Findings, RunError> {
        Err(RunError::NotThere { case: self.id().into(), what: "in space".into() })
    }

    /// The second opinion of the Godunov code.
    ///
    /// # Errors
    /// Where there is none, or it fails.
    fn eulerian(&self, _variant: &str, _n: usize) -> Result<Eulerian, RunError> {
        Err(RunError::NotThere { case: self.id().into(), what: "the Godunov code".into() })
    }

    /// Every column of the fields and histories of a run whose scene has units, with its own; empty for ratios
    /// and counts, and where the name says it.
    fn units(&self) -> &'static [(&'static str, &'static str)] {
        &[]
    }

    /// Whether a figure shows the fields or histories of a run: records of others leave them out.
    fn draws(&self, key: &RunKey) -> bool {
        key.n == self.default_size() && self.variants().contains(&key.variant.as_str())
    }

    /// The runs that a level asks for.
    fn runs(&self, level: Level) -> Vec<RunKey>;

    /// What is claimed.
    fn claims(&self) -> Vec<Claim>;

    /// The norms that the report tabulates, with their titles.
    fn tabulated(&self) -> &'static [(&'static str, &'static str)];

    /// What a norm of a run is held against, by name, whether or not a claim is made of that run: variants and
    /// sizes of which nothing is claimed have an answer as well.
    fn references(&self, _key: &RunKey, _norm: &str) -> Vec<(&'static str, f64)> {
        Vec::new()
    }

    /// Decimals of a norm that is measured too coarsely for four digits.
    fn decimals(&self, _norm: &str) -> Option<usize> {
        None
    }

    /// Which of what is tabulated are errors, whose orders the report fits.
    fn errors(&self) -> &'static [&'static str] {
        &[]
    }

    /// Quantities whose own convergence is studied, with their titles: what an exact solution is not
    /// needed for.
    fn quantities(&self) -> &'static [(&'static str, &'static str)] {
        &[]
    }

    /// Tables of the report that only this case has.
    fn extra_tables(&self, _records: &Records) -> Vec<Table> {
        Vec::new()
    }

    /// The figures of the report.
    fn figures(&self, records: &Records) -> Vec<Figure>;
}

/// All cases, in the order of the report.
pub const ALL: [&dyn Case; 30] = [
    &noh::Noh,
    &kolsky::Kolsky,
    &uniform_collapse::CASE,
    &sod::CASE,
    &einfeldt::CASE,
    &leblanc::CASE,
    &strong_shock_tube::CASE,
    &vacuum_release::CASE,
    &two_stream_noh::CASE,
    &unequal_masses::CASE,
    &woodward_colella::CASE,
    &galilean_boost::GalileanBoost,
    &block_collision::BlockCollision,
    &heat_chain::HeatChain,
    &lattice_kinematics::LatticeKinematics,
    &planar_impact::PlanarImpact,
    &elastic_plastic_piston::ElasticPlasticPiston,
    &free_surface::FreeSurface,
    &spall::Spall,
    &spinning_block::SpinningBlock,
    &beam::Beam,
    &noh_space::NohSpace,
    &sedov::Sedov,
    &saltzman::Saltzman,
    &verney::Verney,
    &taylor::COPPER_ROD,
    &taylor::STEEL_ROD,
    &long_rod::LongRod,
    &rcc_plate::RccPlate,
    &al_sphere_plate::AlSpherePlate,
];

/// The case of a name.
#[must_use]
pub fn find(id: &str) -> Option<&'static dyn Case> {
    ALL.into_iter().find(|c| c.id() == id)
}

/// The run of a preset with its own density scheme.
fn run_of(case: &str, preset: Preset, n: usize) -> RunKey {
    RunKey::new(case, Scheme::preset(preset), n)
}

/// The run of the default preset.
fn default_run(case: &str, n: usize) -> RunKey {
    run_of(case, Preset::Default, n)
}

/// The run of the preset that replicates the paper.
fn paper_run(case: &str, n: usize) -> RunKey {
    run_of(case, Preset::Paper, n)
}

/// A variant by its name, the plain one by what it is.
fn named<'a>(variant: &'a str, plain: &'a str) -> &'a str {
    if variant.is_empty() { plain } else { variant }
}

/// Both presets with their own density schemes, at these sizes.
fn both_presets(case: &str, sizes: &[usize]) -> Vec<RunKey> {
    Preset::ALL
        .into_iter()
        .flat_map(|p| sizes.iter().map(move |&n| (p, n)))
        .map(|(p, n)| run_of(case, p, n))
        .collect()
}

/// Builds claims of one case: the fields that they share are given once.
#[derive(Clone, Copy)]
struct Claims {
    case: &'static str,
    kind: Kind,
    weight: Weight,
    source: &'static str,
    in_sample: bool,
}

impl Claims {
    const fn new(case: &'static str, kind: Kind, weight: Weight, source: &'static str) -> Self {
        Self { case, kind, weight, source, in_sample: false }
    }

    const fn in_sample(self) -> Self {
        Self { in_sample: true, ..self }
    }

    fn claim(self, what: impl Into<String>, quantity: Quantity, wanted: Wanted) -> Claim {
        let Self { case, kind, weight, source, in_sample } = self;
        Claim { case, kind, weight, what: what.into(), quantity, wanted, source, in_sample }
    }
}

/// Scheme, variant and size of a run.
fn in_words(key: &RunKey) -> String {
    let variant = if key.variant.is_empty() { "" } else { ", " };
    format!("`{}`{variant}{}, n = {}", key.scheme.label(), key.variant, key.n)
}

/// The claim that the compatible integrator keeps the energy, and every integrator the momentum.
fn conservation(case: &'static str, key: &RunKey) -> Vec<Claim> {
    let energy = Claims::new(
        case,
        Kind::Verification,
        Weight::Must,
        "round-off of sums over a run; the compatible integrator conserves total energy exactly",
    );
    let momentum = Claims { source: "round-off; pair forces are opposite and equal", ..energy };
    let run = in_words(key);
    vec![
        energy.claim(
            format!("energy drift over the run, {run}"),
            Quantity::EnergyDrift(key.clone()),
            Wanted::AtMost(1e-12),
        ),
        momentum.claim(
            format!("momentum drift over the run, {run}"),
            Quantity::MomentumDrift(key.clone()),
            Wanted::AtMost(1e-12),
        ),
    ]
}

/// The default preset with the kernel density.
fn kernel_default() -> Scheme {
    Scheme::Particles { preset: Preset::Default, density: whipple_solver::method::Density::Kernel }
}

/// What every run in three dimensions keeps: energy with the residual of the elements booked,
/// momentum and angular momentum with what walls give.
fn conservation_in_space(case: &'static str, key: &RunKey) -> Vec<Claim> {
    let mut out = conservation(case, key);
    let source = "round-off; pair forces are opposite and central, element forces without moment";
    let must = Claims::new(case, Kind::Verification, Weight::Must, source);
    out.push(must.claim(
        format!("angular momentum drift over the run, {}", in_words(key)),
        Quantity::AngularDrift(key.clone()),
        Wanted::AtMost(1e-12),
    ));
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_shown_as_a_limit_of_the_paper_s_method_is_run_by_it() {
        let of_the_paper = |key: &RunKey| key.scheme == Scheme::preset(Preset::Paper);
        for claim in ALL.iter().flat_map(|case| case.claims()) {
            let runs = claim.quantity.runs();
            assert!(
                claim.weight != Weight::Shown || runs.iter().all(of_the_paper),
                "{}: {}",
                claim.case,
                claim.what
            );
        }
    }

    #[test]
    fn errors_are_tabulated() {
        for case in ALL {
            let tabulated: Vec<&str> = case.tabulated().iter().map(|(name, _)| *name).collect();
            let strange = case.errors().iter().find(|name| !tabulated.contains(name));
            assert_eq!(strange, None, "{}", case.id());
        }
    }
}
