//! The elastic-plastic piston: a wall driven at constant speed into a solid at rest.
//!
//! Each wave is a shock obeying, with `V = 1/rho`, `sigma = p + s` and the base state `1`:
//! `(u2 - u1)^2 = (sigma2 - sigma1)(V1 - V2)`, `e2 - e1 = (sigma1 + sigma2)(V1 - V2)/2` and
//! `p = P(rho, e - psi/rho0)`, with the deviator `s` and the stored shear energy `psi` of the
//! [strength law](super::strength). The elastic wave leads to first yield; a plastic wave follows
//! it to the piston velocity. A piston slower than the particles at yield sends only an elastic
//! wave; one whose plastic wave would overtake the elastic one sends a single shock.
//! Sources: H. S. Udaykumar et al. (2003), E. J. Lieberman et al. (2019), as in `ExactPack`.

use super::gruneisen::MieGruneisen;
use super::numerics::root;
use super::strength::Strength;
use super::{InputError, above, at_least, below};

/// Largest `gamma rho (V0 - V)/2` for which the energy of a jump is well determined.
const STRONGEST: f64 = 0.95;

/// State of the solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PistonState {
    /// Density.
    pub density: f64,
    /// Velocity in the direction of the piston.
    pub velocity: f64,
    /// Pressure, the mean of the compressive stresses.
    pub pressure: f64,
    /// Compressive axial stress `sigma = p + s`.
    pub stress: f64,
    /// Specific internal energy, stored shear energy included; energy per mass.
    pub energy: f64,
}

/// Waves ahead of the piston; speeds are those of the laboratory, where the solid was at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Structure {
    /// An elastic wave only: the piston is slower than the particles at yield.
    Elastic {
        /// Speed of the wave.
        speed: f64,
    },
    /// An elastic precursor and a plastic wave.
    TwoWave {
        /// Speed of the precursor.
        elastic: f64,
        /// Speed of the plastic wave.
        plastic: f64,
    },
    /// One shock from rest to the plastic state: the plastic wave has overtaken the precursor.
    Overdriven {
        /// Speed of the shock.
        speed: f64,
    },
}

/// Solution of a piston problem.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piston {
    velocity: f64,
    rest: PistonState,
    at_yield: PistonState,
    driven: PistonState,
    structure: Structure,
}

impl Piston {
    /// Piston at `velocity` into the solid of equation of state `eos` and law `strength`.
    ///
    /// # Errors
    /// `velocity <= 0`, or a velocity beyond the largest compression the equation of state
    /// determines.
    pub fn new(eos: &MieGruneisen, strength: &Strength, velocity: f64) -> Result<Self, InputError> {
        let velocity = above("piston velocity", velocity, 0.0)?;
        let yield_stretch = strength.yield_stretch();
        let jump = |base: &PistonState, stretch: f64| {
            let deviator = strength.response(stretch, yield_stretch);
            shock(eos, base, stretch, [deviator.stress, deviator.stored_energy])
        };
        let density = eos.hugoniot().density();
        let rest = PistonState { density, velocity: 0.0, pressure: 0.0, stress: 0.0, energy: 0.0 };
        let at_yield = jump(&rest, yield_stretch);
        let solution = |driven, structure| Self { velocity, rest, at_yield, driven, structure };
        if velocity <= at_yield.velocity {
            let stretch = root(|l| jump(&rest, l).velocity - velocity, yield_stretch, 1.0);
            let driven = jump(&rest, stretch);
            let speed = wave_speed(&rest, &driven);
            return Ok(solution(driven, Structure::Elastic { speed }));
        }
        let smallest = smallest_stretch(eos, 2.0 * velocity)?.min(yield_stretch);
        let drive = |base: &PistonState| {
            below("piston velocity", velocity, jump(base, smallest).velocity)?;
            let stretch = root(|l| jump(base, l).velocity - velocity, smallest, yield_stretch);
            Ok(jump(base, stretch))
        };
        let driven = drive(&at_yield)?;
        let (elastic, plastic) = (wave_speed(&rest, &at_yield), wave_speed(&at_yield, &driven));
        if plastic < elastic {
            return Ok(solution(driven, Structure::TwoWave { elastic, plastic }));
        }
        let driven = drive(&rest)?;
        let speed = wave_speed(&rest, &driven);
        Ok(solution(driven, Structure::Overdriven { speed }))
    }

    /// The waves.
    #[must_use]
    pub const fn structure(&self) -> Structure {
        self.structure
    }

    /// State at first yield, the Hugoniot elastic limit, whether or not it occurs.
    #[must_use]
    pub const fn at_yield(&self) -> &PistonState {
        &self.at_yield
    }

    /// State next to the piston.
    #[must_use]
    pub const fn driven(&self) -> &PistonState {
        &self.driven
    }

    /// State at `x` and time `t`; the piston starts from `x = 0`, and a wave counts as arrived.
    ///
    /// # Errors
    /// `t < 0`, or `x` behind the piston.
    pub fn sample(&self, x: f64, t: f64) -> Result<PistonState, InputError> {
        let t = at_least("t", t, 0.0)?;
        let x = at_least("x", x, self.velocity * t)?;
        let (leading, trailing) = match self.structure {
            Structure::TwoWave { elastic, plastic } => (elastic, plastic),
            Structure::Elastic { speed } | Structure::Overdriven { speed } => (speed, speed),
        };
        Ok(match t > 0.0 {
            true if x <= trailing * t => self.driven,
            true if x <= leading * t => self.at_yield,
            _ => self.rest,
        })
    }
}

/// Speed of the shock between two states, in the frame of their velocities.
fn wave_speed(ahead: &PistonState, behind: &PistonState) -> f64 {
    let rise = behind.stress - ahead.stress;
    ahead.velocity + rise / (ahead.density * (behind.velocity - ahead.velocity))
}

/// State behind the shock from `base` to the `stretch` with the deviator and stored energy given.
///
/// The equation of state is linear in the energy, so the jump relations give the stress directly.
fn shock(
    eos: &MieGruneisen,
    base: &PistonState,
    stretch: f64,
    [deviator, stored]: [f64; 2],
) -> PistonState {
    let reference = eos.hugoniot().density();
    let density = reference / stretch;
    let change = 1.0 / base.density - 1.0 / density;
    let thermal = eos.gamma_density(density);
    let known = base.energy + 0.5 * base.stress * change - stored / reference;
    let cold = eos.raw_pressure(density, known) + deviator;
    let stress = cold / (1.0 - 0.5 * thermal * change);
    PistonState {
        density,
        velocity: base.velocity + ((stress - base.stress) * change).max(0.0).sqrt(),
        pressure: stress - deviator,
        stress,
        energy: base.energy + 0.5 * (base.stress + stress) * change,
    }
}

/// Volume ratio of the shock of velocity `particle_speed`, limited by [`STRONGEST`].
fn smallest_stretch(eos: &MieGruneisen, particle_speed: f64) -> Result<f64, InputError> {
    let hugoniot = eos.hugoniot();
    let heating = |stretch: f64| {
        let reference = hugoniot.density();
        0.5 * eos.gamma_density(reference / stretch) / reference * (1.0 - stretch) - STRONGEST
    };
    let floor = root(heating, 1.0 - 1.0 / hugoniot.slope(), 1.0);
    Ok(hugoniot.at_particle_speed(particle_speed)?.volume_ratio.max(floor))
}

#[cfg(test)]
mod tests {
    use super::super::hugoniot::Hugoniot;
    use super::super::strength::{Elasticity, YieldReading};
    use super::super::testing::cases;
    use super::*;
    use proptest::prelude::*;

    fn eos(rho0: f64, c0: f64, s: f64, gamma: f64) -> MieGruneisen {
        MieGruneisen::constant_gamma(Hugoniot::new(rho0, c0, s).unwrap(), gamma).unwrap()
    }

    #[test]
    fn the_profile_has_its_waves_and_nonsense_is_refused() {
        let cold = eos(2.79, 0.533, 1.34, 0.0);
        let solid = eos(2.79, 0.533, 1.34, 2.0);
        let law = Strength::new(Elasticity::Hypoelastic, 0.286, 0.0026).unwrap();
        let speed = |velocity| Piston::new(&solid, &law, velocity).unwrap();
        let piston = speed(0.01);
        assert_eq!(piston.sample(0.7, 1.0).unwrap().velocity, 0.0);
        assert_eq!(piston.sample(0.6, 1.0).unwrap(), *piston.at_yield());
        assert_eq!(piston.sample(0.5, 1.0).unwrap(), *piston.driven());
        assert!(piston.sample(0.0, 1.0).is_err() && piston.sample(0.1, -1.0).is_err());
        assert!(Piston::new(&cold, &law, 0.01).is_ok());
        assert!(matches!(speed(0.001).structure(), Structure::Elastic { .. }));
        assert!(matches!(speed(0.3).structure(), Structure::Overdriven { .. }));
        assert!(
            Piston::new(&solid, &law, 0.0).is_err() && Piston::new(&solid, &law, 50.0).is_err()
        );
    }

    proptest! {
        #![proptest_config(cases(96))]

        #[test]
        fn waves_conserve_mass_momentum_and_energy(
            law in 0..6_usize, y in 1e-5..0.01, up in 1e-4..0.4, gamma in 0.0..2.5,
        ) {
            let law = match law {
                0 => Elasticity::Hypoelastic,
                1 => Elasticity::Infinitesimal,
                2 => Elasticity::Finite,
                reading => Elasticity::IsochoricGreen(YieldReading::ALL[reading - 3]),
            };
            let (solid, law) = (eos(2.7, 0.53, 1.35, gamma), Strength::new(law, 0.28, y).unwrap());
            let piston = Piston::new(&solid, &law, up).unwrap();
            let (rest, driven) = (piston.rest, piston.driven);
            prop_assert!((driven.velocity / up - 1.0).abs() < 1e-9);
            let balance = |a: PistonState, b: PistonState, d: f64| {
                let flux = |s: PistonState| {
                    let mass = s.density * (d - s.velocity);
                    let energy = s.energy + 0.5 * s.velocity.powi(2);
                    [mass, mass * s.velocity - s.stress, mass * energy - s.stress * s.velocity]
                };
                let scale = [a.density * d, b.stress, b.stress * b.velocity];
                super::super::testing::close(flux(a), flux(b), scale, 1e-9)
            };
            match piston.structure() {
                Structure::TwoWave { elastic, plastic } => {
                    prop_assert!(plastic < elastic && plastic > up);
                    prop_assert!(balance(rest, piston.at_yield, elastic));
                    prop_assert!(balance(piston.at_yield, driven, plastic));
                }
                Structure::Elastic { speed } | Structure::Overdriven { speed } => {
                    prop_assert!(balance(rest, driven, speed) && speed > up);
                }
            }
        }
    }
}
