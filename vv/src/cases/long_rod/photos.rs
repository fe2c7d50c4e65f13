//! Pictures of the run, as in the paper's Figures 7 to 10.

use whipple_solver::space::Scene;

use crate::run::{RunError, SpaceDriver};
use crate::space::picture::{
    Shot, Shown, frame, from_the_side, onto_the_section, shoot, symmetry_plane,
};

/// Temperatures at the ends of the colour bar, in K: those of rest and where tungsten alloy melts in
/// Table 4.
const TEMPERATURES: (f64, f64) = (300.0, 1723.0);

/// Share of the loose particles beyond either end of each axis that may lie outside a picture.
const OUTSIDE: f64 = 0.01;
/// The same at the end, when debris has spread far.
const SPREAD: f64 = 0.08;

/// A picture of the state at some time.
struct Wish {
    time: f64,
    id: &'static str,
    title: &'static str,
    caption: &'static str,
    section: bool,
    outside: f64,
}

const WISHES: [Wish; 4] = [
    Wish {
        time: 0.0,
        id: "long-rod-start",
        title: "Elements before the impact",
        caption: "Elements of rod and plate before the impact (the paper's Figure 7); n = 5, `default`.",
        section: false,
        outside: OUTSIDE,
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
        outside: OUTSIDE,
    },
    Wish {
        time: 40.0,
        id: "long-rod-section-40",
        title: "Section through the axis of the rod",
        caption: "The same at 40 µs (the paper's Figure 10).",
        section: true,
        outside: OUTSIDE,
    },
    Wish {
        time: 100.0,
        id: "long-rod-end",
        title: "Elements and particles after the perforation",
        caption: "Elements and particles that no element holds any more, at 100 µs (the paper's Figure \
                  8). Debris farther from rod and plate lies outside: up to 8 % of it beyond each side. n = 5, `default`.",
        section: false,
        outside: SPREAD,
    },
];

/// Takes the picture that is wanted of the present state, if one is.
pub(super) fn take(driver: &mut SpaceDriver<'_>, scene: &Scene, time: f64) -> Result<(), RunError> {
    let Some(wish) = WISHES.iter().find(|wish| wish.time == time) else { return Ok(()) };
    driver.photograph(wish.id, wish.caption, |simulation| {
        let (mut camera, section, shown) = if wish.section {
            let plane = symmetry_plane(simulation);
            (onto_the_section(), Some(plane), Shown::Temperature(Some(TEMPERATURES)))
        } else {
            (from_the_side(), None, Shown::Body)
        };
        // Before the impact there are no far particles.
        camera.frame = (time > 0.0).then(|| frame(simulation, wish.outside));
        shoot(
            simulation,
            scene,
            &Shot { title: wish.title.into(), camera, section, shown, loose: true },
        )
    })
}
