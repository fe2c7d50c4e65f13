//! Pictures of the run, as in the paper's Figures 7 to 10.

use crate::cases::parts::photos::Wish;
use crate::space::picture::Shown;

/// Temperatures at the ends of the colour bar, in K: those of rest and where tungsten alloy melts in
/// Table 4.
const TEMPERATURES: (f64, f64) = (300.0, 1723.0);

/// Share of the loose particles beyond either end of each axis that may lie outside a picture.
const OUTSIDE: f64 = 0.01;
/// The same at the end, when debris has spread far.
const SPREAD: f64 = 0.08;

/// What is taken.
pub(super) const WISHES: [Wish; 4] = [
    Wish {
        time: 0.0,
        id: "long-rod-start",
        title: "Elements before the impact",
        caption: "Elements of rod and plate before the impact (the paper's Figure 7); the arrow is the way of the rod. \
                  n = 5, `default`.",
        section: false,
        shown: Shown::Body,
        outside: Some(OUTSIDE),
    },
    Wish {
        time: 20.0,
        id: "long-rod-section-20",
        title: "Section through the axis of the rod",
        caption: "Section through the axis of the rod at 20 µs, coloured by temperature (the paper's \
                  Figure 9): live elements, and particles that no element holds any more. The colour bar \
                  ends where the tungsten alloy melts; a few far particles lie outside. n = 5, \
                  `default`.",
        section: true,
        shown: Shown::Temperature(Some(TEMPERATURES)),
        outside: Some(OUTSIDE),
    },
    Wish {
        time: 40.0,
        id: "long-rod-section-40",
        title: "Section through the axis of the rod",
        caption: "The same at 40 µs (the paper's Figure 10).",
        section: true,
        shown: Shown::Temperature(Some(TEMPERATURES)),
        outside: Some(OUTSIDE),
    },
    Wish {
        time: 100.0,
        id: "long-rod-end",
        title: "Elements and particles after the perforation",
        caption: "Elements and particles that no element holds any more, at 100 µs (the paper's Figure \
                  8). Debris farther from rod and plate lies outside: up to 8 % of it beyond each side. n = 5, `default`.",
        section: false,
        shown: Shown::Body,
        outside: Some(SPREAD),
    },
];
