//! Pictures of the run, as in the paper's Figures 11 to 15.

use crate::cases::parts::photos::Wish;
use crate::space::picture::Shown;

/// Temperatures at the ends of the colour bar, in K: those of rest and where carbon-carbon melts in Table
/// 6.
const TEMPERATURES: (f64, f64) = (300.0, 3840.0);

/// Plastic strains at the ends of the colour bar: twice that at which the plate fails.
const STRAINS: (f64, f64) = (0.0, 1.0);

/// Share of the loose particles beyond either end of each axis that may lie outside a picture.
const OUTSIDE: f64 = 0.06;

/// What is taken.
pub(super) const WISHES: [Wish; 5] = [
    Wish {
        time: 0.0,
        id: "rcc-plate-start",
        title: "Elements before the impact",
        caption: "Elements of sphere and plate before the impact (the paper's Figure 11); the arrow is the way of the \
                  sphere. n = 4, `default`, as all pictures of this case.",
        section: false,
        outside: Some(OUTSIDE),
        shown: Shown::Body,
    },
    Wish {
        time: 10.0,
        id: "rcc-plate-end",
        title: "Elements and particles after the perforation",
        caption: "Live elements, and particles that no element holds any more, at 10 µs (the paper's \
                  Figure 12). Up to 6 % of those particles lie outside, beyond each side.",
        section: false,
        outside: Some(OUTSIDE),
        shown: Shown::Body,
    },
    Wish {
        time: 10.0,
        id: "rcc-plate-elements",
        title: "Elements after the perforation",
        caption: "Live elements alone at 10 µs (the paper's Figure 13).",
        section: false,
        outside: None,
        shown: Shown::Body,
    },
    Wish {
        time: 10.0,
        id: "rcc-plate-temperature",
        title: "Section through the plane of flight",
        caption: "Section through the plane of flight at 10 µs, live elements and loose particles \
                  coloured by temperature (the paper's Figure 14). The colour bar ends where \
                  carbon-carbon melts in Table 6.",
        section: true,
        outside: Some(OUTSIDE),
        shown: Shown::Temperature(Some(TEMPERATURES)),
    },
    Wish {
        time: 10.0,
        id: "rcc-plate-strain",
        title: "Section through the plane of flight",
        caption: "The same of live elements alone, coloured by effective plastic strain (the paper's \
                  Figure 15). The plate fails at 0.5, the sphere at 1.",
        section: true,
        outside: None,
        shown: Shown::PlasticStrain(Some(STRAINS)),
    },
];
