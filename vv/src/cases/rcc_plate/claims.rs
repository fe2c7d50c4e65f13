//! Which runs a level asks for, and what is claimed of them.

use whipple_solver::method::Preset;

use super::problem::{ANGLES, CHOICES, EOS, ID, SIZES, changes, degrees};
use super::{SHAPES, kernel, varied};
use crate::cases::parts::impact::{DIAMETER, SPEED};
use crate::cases::parts::{metals, perforation};
use crate::cases::{
    Claim, Claims, Kind, Level, Quantity, Wanted, Weight, conservation_in_space, default_run,
    paper_run,
};
use crate::exact::penetration::Penetration;
use crate::record::RunKey;

/// Density of carbon-carbon in g/cm3: Table 6.
pub(super) const RCC_DENSITY: f64 = 1.58;

/// Norm of the hole, and what it is held against: an equation fitted to tests, no test.
pub(super) const HOLE: &str = "hole_diameter_cm";
pub(super) const EQUATION: &str = "NASA's equation";

/// How far from NASA's equation a hole may be: its scatter is not stated, and this is a working value.
pub(super) const SCATTER: f64 = 0.15;

/// Diameter of the hole by NASA's equation at the angle of a variant, in cm.
pub(super) fn nasa(variant: &str) -> f64 {
    let densities = [metals::ALUMINIUM.density(), RCC_DENSITY];
    let sphere = Penetration::new(DIAMETER, densities, 10.0 * SPEED, degrees(variant));
    sphere.map_or(f64::NAN, |sphere| sphere.hole())
}

/// The runs of the plain equation of state at every angle, the plain one first.
pub(super) fn angles() -> [RunKey; 4] {
    ANGLES.map(|angle| varied(&CHOICES[0].named(angle).unwrap_or_default()))
}

/// The runs of every equation of state at the plain angle, the plain one first.
pub(super) fn states() -> [RunKey; 3] {
    EOS.map(|eos| varied(&CHOICES[1].named(eos).unwrap_or_default()))
}

/// The runs of a level: the smallest of `default`, or all.
pub(super) fn runs(level: Level) -> Vec<RunKey> {
    let mut keys = vec![varied("")];
    if level == Level::Full {
        keys.extend(SIZES[1..].iter().map(|&n| default_run(ID, n)));
        keys.extend(angles().into_iter().skip(1).chain(states().into_iter().skip(1)));
        let shapes = SHAPES.runs();
        let others = changes().iter().map(|variant| varied(variant));
        keys.extend(others.filter(|key| !shapes.contains(key)));
        keys.extend(shapes);
        keys.push(paper_run(ID, SIZES[0]));
        keys.extend(Preset::ALL.map(kernel));
    }
    keys
}

/// The claims.
pub(super) fn all() -> Vec<Claim> {
    let source = "NASA/TM-2009-214785, Eq. 5-34, fitted to tests of coated panels, whose scatter is not stated: 15 % \
                  is a working value; panels of 4.7 mm without a coating are outside them; no constant fitted to it";
    let equation = Claims::new(ID, Kind::Comparison, Weight::Must, source);
    let hole = |key: RunKey| {
        equation.claim(
            format!(
                "hole in cm beside NASA's equation, {} degrees, n = {}, `default`",
                degrees(&key.variant),
                key.n
            ),
            Quantity::Norm(key.clone(), HOLE),
            Wanted::Near(nasa(&key.variant), SCATTER),
        )
    };
    let mut out: Vec<Claim> = angles().into_iter().map(hole).collect();
    out.extend(SIZES[1..].iter().map(|&n| hole(default_run(ID, n))));
    let mut every: Vec<RunKey> = angles().into_iter().chain(states().into_iter().skip(1)).collect();
    every.extend(SIZES[1..].iter().map(|&n| default_run(ID, n)));
    every.push(paper_run(ID, SIZES[0]));
    every.extend(Preset::ALL.map(kernel));
    for key in &every {
        out.extend(conservation_in_space(ID, key));
        out.extend(perforation::claims(ID, key));
    }
    let must = Claims::new(ID, Kind::Verification, Weight::Must, wanted!());
    for n in SIZES {
        out.push(must.claim(
            format!("mass as meshed over that of the shapes, error, n = {n}"),
            Quantity::GeometryMass(default_run(ID, n)),
            Wanted::AtMost(1e-3),
        ));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::references::Table;
    use approx::assert_relative_eq;

    /// What is wanted stands in the references, to the digits given there.
    #[test]
    fn holes_are_those_of_the_references() {
        let text = include_str!("../../../../references/rcc_penetration_prediction.csv");
        let table = Table::parse("rcc_penetration_prediction.csv", text).unwrap();
        let column = |name: &str| table.column(name).unwrap();
        let at = [column("d_cm"), column("angle_deg"), column("rho_t_g_cm3")];
        let holes = table.text("through_hole_diameter_cm").unwrap();
        for key in angles() {
            let wanted = [DIAMETER, degrees(&key.variant), RCC_DENSITY];
            let same = |row: &usize| (0..3).all(|k| at[k][*row] == wanted[k]);
            let row = (0..table.row_count()).find(same).unwrap();
            assert_relative_eq!(
                nasa(&key.variant),
                holes[row].parse().unwrap(),
                max_relative = 1e-5
            );
        }
    }
}
