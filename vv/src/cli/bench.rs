//! `whipple bench`: what the density costs.

use whipple_solver::method::{Density, Integrator, Preset};

use super::{BenchArgs, Failure, NUMERICAL_FAILURE, print};
use crate::cost::{Comparison, Contender, CostError, EQUAL_LIST, compare};

impl From<CostError> for Failure {
    fn from(error: CostError) -> Self {
        match error {
            CostError::Scene(error) => Self::usage(error),
            CostError::Step(error) => Self { code: NUMERICAL_FAILURE, message: error.to_string() },
        }
    }
}

/// Runs the comparisons and prints them.
pub(super) fn bench(args: &BenchArgs) -> Result<u8, Failure> {
    let natural = Preset::Default.method().kernel_support;
    let with = |density, support| Contender { density, support };
    let paper = with(Density::Nonholonomic, natural);
    let rows = [
        ("kernel, equal contact list", with(Density::Kernel, EQUAL_LIST)),
        ("kernel, natural support", with(Density::Kernel, natural)),
        ("hybrid", with(Density::Hybrid, natural)),
    ];
    let head = format!(
        "{:<12} {:<28} {:>8} {:>17} {:>12} {:>12} {:>12}\n",
        "integrator",
        "against nonholonomic",
        "ratio",
        "spread",
        "ns/particle",
        "ns/pair",
        "A: ns/part."
    );
    print(&head)?;
    for integrator in [Integrator::SinglePass, Integrator::Compatible] {
        for (name, rival) in rows {
            let found = compare([paper, rival], integrator, args.n, args.rounds)?;
            print(&row(integrator, name, &found))?;
        }
    }
    print(
        "CPU time, medians over A B B A rounds; ns per particle and step, and per pair and step.\n",
    )?;
    Ok(0)
}

fn row(integrator: Integrator, name: &str, found: &Comparison) -> String {
    let (low, high) = found.spread();
    let integrator = match integrator {
        Integrator::SinglePass => "single pass",
        Integrator::Compatible => "compatible",
    };
    let spread = format!("{low:.3} .. {high:.3}");
    format!(
        "{integrator:<12} {name:<28} {:>8.3} {spread:>17} {:>12.1} {:>12.1} {:>12.1}\n",
        found.median(),
        found.b.per_particle_step,
        found.b.per_pair,
        found.a.per_particle_step,
    )
}
