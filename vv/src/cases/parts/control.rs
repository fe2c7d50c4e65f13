//! Drag against hourglass modes and stiffness against the motion of centroids, as variants of a case:
//! what the default goes without in solids with strength must not be what holds its answer.

use whipple_solver::space::method::Method;

use crate::cases::{Claim, Claims, Kind, Quantity, Wanted, Weight};
use crate::record::RunKey;

/// Hourglass modes are resisted, or the motion of centroids against their corners.
pub(in crate::cases) const HOURGLASS: &str = "hourglass-on";
pub(in crate::cases) const CENTRING: &str = "centring-on";

/// Drag on hourglass modes: that of solids without strength (decision 0019).
const DRAG: f64 = 0.1;

/// Stiffness of centroids over that of a cell, not varied here.
const STIFFNESS: f64 = 0.05;

/// Largest change of an answer.
const CHANGE: f64 = 0.005;

/// The method of a variant.
pub(in crate::cases) fn controlled(method: Method, variant: &str) -> Method {
    match variant {
        HOURGLASS => Method { visc_hourglass_strong: DRAG, ..method },
        CENTRING => Method { centring: STIFFNESS, ..method },
        _ => method,
    }
}

/// The runs with either control on.
pub(in crate::cases) fn runs(plain: &RunKey) -> [RunKey; 2] {
    [HOURGLASS, CENTRING].map(|variant| plain.clone().variant(variant))
}

/// That either control moves the answers, norms with their names, by little.
pub(in crate::cases) fn claims(
    id: &'static str,
    plain: &RunKey,
    answers: &[(&'static str, &str)],
) -> Vec<Claim> {
    let source = wanted!("the answer changes less than 0.5 %");
    let must = Claims::new(id, Kind::Verification, Weight::Must, source);
    let of = |(name, text): (&'static str, &str)| {
        runs(plain).map(|key| {
            must.claim(
                format!("{}: change of the {text}, n = {}", key.variant, plain.n),
                Quantity::Change(key, plain.clone(), name),
                Wanted::WithinZero(CHANGE),
            )
        })
    };
    answers.iter().copied().flat_map(of).collect()
}
