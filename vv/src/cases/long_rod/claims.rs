//! Which runs a level asks for, and what is claimed of them.

use whipple_solver::method::Preset;

use super::problem::{EXCHANGED, ID, SIZES, STEPS, VARIANTS, WIDE, words};
use super::published::KNOWN;
use super::{SCHEMES, SHAPES, kernel_key, key, varied_key};
use crate::cases::parts::control;
use crate::cases::{Claim, Claims, Kind, Level, Quantity, Wanted, Weight, conservation_in_space};
use crate::record::RunKey;

/// The runs of a level: the smallest of `default`; those that a claim at two sizes needs; all.
pub(super) fn runs(level: Level) -> Vec<RunKey> {
    let [small, middle, large] = SIZES;
    let mut keys = vec![key(Preset::Default, small)];
    if level >= Level::Standard {
        keys.extend([key(Preset::Paper, small), key(Preset::Default, middle)]);
    }
    if level == Level::Full {
        keys.push(key(Preset::Default, large));
        keys.extend([key(Preset::Paper, middle), key(Preset::Paper, large)]);
        let shapes = SHAPES.runs();
        let others = VARIANTS[1..].iter().map(|v| varied_key(Preset::Default, v));
        keys.extend(others.filter(|key| !shapes.contains(key)));
        keys.extend(shapes);
        // What the uncertainty by the inputs needs; the paper's own reading stands in Table 5.
        keys.extend(["", EXCHANGED, WIDE].map(|v| varied_key(Preset::Paper, v)));
        keys.extend(SCHEMES.runs());
        keys.push(kernel_key(Preset::Paper));
    }
    keys
}

/// The claims.
pub(super) fn all() -> Vec<Claim> {
    let experiment = Claims::new(
        ID,
        Kind::Validation,
        Weight::Must,
        wanted!("experiment as the paper quotes it; no constant fitted to it"),
    );
    let table = Claims::new(ID, Kind::Replication, Weight::Aim, "paper, Table 5");
    let mut out = Vec::new();
    for n in SIZES {
        for known in KNOWN.iter().rev() {
            out.push(experiment.claim(
                format!("residual {} in {}, n = {n}, `default`", known.name, known.unit),
                Quantity::Norm(key(Preset::Default, n), known.norm),
                known.near_experiment(),
            ));
        }
    }
    for (size, n) in SIZES.into_iter().enumerate() {
        for known in KNOWN.iter().rev() {
            out.push(table.claim(
                format!("residual {} in {}, n = {n}, `paper`, as printed", known.name, known.unit),
                Quantity::Norm(key(Preset::Paper, n), known.norm),
                known.near_table_5(size),
            ));
        }
    }
    let must = Claims::new(ID, Kind::Verification, Weight::Must, wanted!());
    for key in [Preset::Default, Preset::Paper].map(|preset| key(preset, SIZES[0])) {
        let scheme = key.scheme.label();
        out.extend(conservation_in_space(ID, &key));
        out.push(must.claim(
            format!("residual of the elements over the initial kinetic energy, `{scheme}`"),
            Quantity::Residual(key.clone()),
            Wanted::WithinZero(1e-3),
        ));
        out.push(must.claim(
            format!("mass as meshed over that of the shapes, error, `{scheme}`"),
            Quantity::GeometryMass(key),
            Wanted::AtMost(1e-3),
        ));
    }
    let area = Claims { source: wanted!("gap G25: the size of the plate is inferred"), ..must };
    for known in &KNOWN {
        let [wide, plain] = [WIDE, ""].map(|variant| varied_key(Preset::Default, variant));
        out.push(area.claim(
            format!("twice the plate: change of the residual {}, n = 5, `default`", known.name),
            Quantity::Change(wide, plain, known.norm),
            Wanted::WithinZero(known.edge),
        ));
    }
    let step = Claims { weight: Weight::Aim, source: "as wanted of twice the plate", ..must };
    for variant in STEPS {
        for known in &KNOWN {
            let [short, plain] = [variant, ""].map(|v| varied_key(Preset::Default, v));
            out.push(step.claim(
                format!(
                    "{}: change of the residual {}, n = 5, `default`",
                    words(variant),
                    known.name
                ),
                Quantity::Change(short, plain, known.norm),
                Wanted::WithinZero(known.edge),
            ));
        }
    }
    let answers = KNOWN.each_ref().map(|known| (known.norm, known.name));
    out.extend(control::claims(ID, &key(Preset::Default, SIZES[0]), &answers));
    out
}
