//! Pictures of an impact at fixed times of its run.

use whipple_solver::space::Scene;

use crate::run::{RunError, SpaceDriver};
use crate::space::picture::{
    Shot, Shown, frame, from_the_side, onto_the_section, shoot, symmetry_plane,
};

/// A picture of the state at some time.
pub(in crate::cases) struct Wish {
    pub(in crate::cases) time: f64,
    pub(in crate::cases) id: &'static str,
    pub(in crate::cases) title: &'static str,
    pub(in crate::cases) caption: &'static str,
    /// Cut in the plane of symmetry, and seen straight on.
    pub(in crate::cases) section: bool,
    pub(in crate::cases) shown: Shown,
    /// Share of the particles that no element holds which may lie outside, beyond either end of each
    /// axis; without one none of them is painted.
    pub(in crate::cases) outside: Option<f64>,
}

/// Takes the pictures that are wanted of the present state.
pub(in crate::cases) fn take(
    wishes: &[Wish],
    driver: &mut SpaceDriver<'_>,
    scene: &Scene,
    time: f64,
) -> Result<(), RunError> {
    for wish in wishes.iter().filter(|wish| wish.time == time) {
        driver.photograph(wish.id, wish.caption, |simulation| {
            let (mut camera, section) = if wish.section {
                (onto_the_section(), Some(symmetry_plane(simulation)))
            } else {
                (from_the_side(), None)
            };
            // Before the impact there are no far particles.
            let outside = wish.outside.filter(|_| time > 0.0);
            camera.frame = outside.map(|share| frame(simulation, share));
            let (title, loose) = (wish.title.into(), wish.outside.is_some());
            shoot(simulation, scene, &Shot { title, camera, section, shown: wish.shown, loose })
        })?;
    }
    Ok(())
}
