//! Two blast waves that collide between walls: no exact solution, a fine reference instead.

use std::sync::OnceLock;

use super::gas::{GasProblem, Region, Setup, Sizes, walls};
use super::{
    Claim, Claims, Kind, Quantity, Scheme, Wanted, Weight, conservation, default_run, paper_run,
};
use crate::exact::Gas;
use crate::record::RunKey;
use crate::references::Table;
use crate::run::RunError;

const ID: &str = "woodward-colella";
const SIZES: &[usize] = &[200, 400, 800];
/// Cells of the reference run, and of those that show its convergence.
const FINE: &[usize] = &[5000, 10_000, 20_000];
const TIME: f64 = 0.038;
const GAMMA: f64 = 1.4;

/// The reference, made by `whipple reference`.
const REFERENCE: &str = include_str!("../../../references/woodward_colella_t0.038.csv");
/// Its name.
pub(crate) const REFERENCE_FILE: &str = "references/woodward_colella_t0.038.csv";
/// Rows that the reference is averaged to.
const ROWS: usize = 4000;

/// The case.
pub(super) const CASE: GasProblem = GasProblem {
    id: ID,
    title: "Woodward and Colella's blast waves",
    about: "Gas of density 1 (γ = 1.4) at pressure 1000, 0.01 and 100 between two walls: two blast \
            waves collide. There is no exact solution; the reference is a run of the Eulerian \
            Godunov code with 20 000 cells, whose own convergence is in the table. Agreement with \
            it is a comparison of two codes, not verification.",
    source: "Woodward & Colella, J. Comput. Phys. 54 (1984) 115 (recalled); own reference run",
    variants: &[""],
    sizes: Sizes { quick: &[200], standard: SIZES, drawn: 400, fine: FINE },
    setup,
    claims,
    answer: "reference",
    eulerian: true,
};

/// Columns of the reference.
struct Reference {
    density: Vec<f64>,
    velocity: Vec<f64>,
    pressure: Vec<f64>,
}

fn reference() -> Result<&'static Reference, RunError> {
    static TABLE: OnceLock<Result<Reference, String>> = OnceLock::new();
    let read = || {
        let table = Table::parse(REFERENCE_FILE, REFERENCE).map_err(|e| e.to_string())?;
        let column = |name| table.column(name).map_err(|e| e.to_string());
        let (density, velocity, pressure) =
            (column("density")?, column("velocity")?, column("pressure")?);
        Ok(Reference { density, velocity, pressure })
    };
    TABLE.get_or_init(read).as_ref().map_err(|e| RunError::Reference(e.clone()))
}

impl Reference {
    /// The state at `x`: linear between the centres of the rows.
    fn at(&self, x: f64) -> Gas {
        let rows = self.density.len();
        let place = (x * rows as f64 - 0.5).clamp(0.0, (rows - 1) as f64);
        let left = (place as usize).min(rows - 2);
        let share = place - left as f64;
        let mean = |column: &[f64]| column[left] * (1.0 - share) + column[left + 1] * share;
        Gas {
            density: mean(&self.density),
            velocity: mean(&self.velocity),
            pressure: mean(&self.pressure),
            gamma: GAMMA,
        }
    }
}

/// The problem without its answer.
fn problem() -> Setup {
    let region = |from: f64, to: f64, pressure| Region {
        span: (from, to),
        gas: Gas { density: 1.0, velocity: 0.0, pressure, gamma: GAMMA },
        gradient: 0.0,
        share: to - from,
    };
    Setup {
        regions: vec![region(0.0, 0.1, 1000.0), region(0.1, 0.9, 0.01), region(0.9, 1.0, 100.0)],
        ends: walls(0.0, 1.0),
        u_0: 0.0,
        time: TIME,
        exact: Box::new(|x, _| Ok(reference()?.at(x))),
    }
}

fn setup(_: &str) -> Result<Setup, RunError> {
    Ok(problem())
}

/// Makes the reference: the text of its file.
///
/// # Errors
/// A failure of the Godunov code.
pub(crate) fn make_reference() -> Result<String, RunError> {
    let cells = FINE[FINE.len() - 1];
    let mut code = problem().godunov(cells)?;
    code.advance_to(TIME)?;
    let gas: Vec<Gas> = code.cells().collect();
    let group = cells / ROWS;
    let mut text = format!(
        "# Woodward-Colella blast waves at t = {TIME}: own run of the second-order Godunov code of \
         this project, {cells} cells averaged in groups of {group}\n\
         # made by `whipple reference`; its convergence stands in the report; status: derived; \
         dimensionless\n\
         x,density,velocity,pressure\n"
    );
    for (k, cells) in gas.chunks(group).enumerate() {
        let count = cells.len() as f64;
        let density = cells.iter().map(|g| g.density).sum::<f64>() / count;
        let momentum = cells.iter().map(|g| g.density * g.velocity).sum::<f64>() / count;
        let pressure = cells.iter().map(|g| g.pressure).sum::<f64>() / count;
        let x = (k as f64 + 0.5) / ROWS as f64;
        text += &format!("{x:.6},{density:.7e},{:.7e},{pressure:.7e}\n", momentum / density);
    }
    Ok(text)
}

fn claims() -> Vec<Claim> {
    let source = wanted!("L1 of density over its range, n = 400, against the fine Godunov run");
    let must = Claims::new(ID, Kind::Comparison, Weight::Must, source);
    let key = default_run(ID, 400);
    let mut out = vec![must.claim(
        "L1 ρ, n = 400, `default`",
        Quantity::Norm(key.clone(), "density_l1"),
        Wanted::AtMost(0.03),
    )];
    let fine = Claims { source: "the reference must be finer than what it judges", ..must };
    out.push(fine.claim(
        "L1 ρ of the Godunov code with 10 000 cells: convergence of the reference",
        Quantity::Norm(RunKey::new(ID, Scheme::Godunov, 10_000), "density_l1"),
        Wanted::AtMost(0.003),
    ));
    let limit = "the printed heating (60) ends the run; with half and half it needs cfl of 0.07";
    let shown = Claims::new(ID, Kind::Stability, Weight::Shown, limit);
    out.push(shown.claim(
        "L1 ρ, n = 400, `paper`",
        Quantity::Norm(paper_run(ID, 400), "density_l1"),
        Wanted::AtMost(0.03),
    ));
    out.extend(conservation(ID, &key));
    out
}
