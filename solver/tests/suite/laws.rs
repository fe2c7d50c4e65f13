//! The laws alone: limiter, equations of state, conduction.

use proptest::prelude::*;
use whipple_solver::chain::{Contact, Side};
use whipple_solver::eos::{Eos, IdealGas, Linear};
use whipple_solver::heat::{ArtificialConduction, Heat};
use whipple_solver::method::{Conduction, Method, Preset, SoundSpeed};
use whipple_solver::scene::EosData;
use whipple_solver::viscosity::{Closing, unexplained};

use crate::common::cases;

/// Central difference of a function.
fn derivative(f: impl Fn(f64) -> f64, x: f64) -> f64 {
    let h = 1e-5 * x.abs().max(1e-3);
    (f(x + h) - f(x - h)) / (2.0 * h)
}

fn near(a: f64, b: f64, share: f64) -> bool {
    (a - b).abs() <= share * (a.abs() + b.abs())
}

/// An ideal gas with this ratio of specific heats.
fn gas(adiabatic_index: f64, u_0: f64, sound: SoundSpeed) -> IdealGas {
    let data = EosData::IdealGas { adiabatic_index, c_v: 2.0, u_0, theta_0: 3.0 };
    IdealGas::new(1.0, &data, sound).expect("data of a gas")
}

fn side(index: usize, u: f64) -> Side {
    Side { index, m: 1.0, l: 1.0, rho_0: 1.0, material: 0, medium: 0, rho: 1.0, u }
}

proptest! {
    #![proptest_config(cases(512))]

    /// The limiter takes a share between nothing and all of a jump.
    #[test]
    fn limiter_takes_a_share(jumps in [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0], steepness in 0.1..20.0_f64) {
        let share = unexplained(jumps, steepness) / jumps[1];
        prop_assert!((0.0..=1.0).contains(&share), "{share}");
    }

    /// It is odd, symmetric in left and right, and has no scale.
    #[test]
    fn limiter_is_odd_and_free_of_scale(
        jumps in [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0], steepness in 0.1..20.0_f64,
    ) {
        let [a, b, c] = jumps;
        let seen = unexplained(jumps, steepness);
        prop_assert_eq!(unexplained([-a, -b, -c], steepness), -seen);
        prop_assert_eq!(unexplained([c, b, a], steepness), seen);
        prop_assert_eq!(unexplained([8.0 * a, 8.0 * b, 8.0 * c], steepness), 8.0 * seen);
    }

    /// A linear velocity field is explained wholly from steepness 2 on.
    #[test]
    fn limiter_explains_a_linear_field(jump in -1.0..1.0_f64, steepness in 2.0..20.0_f64) {
        prop_assert_eq!(unexplained([jump; 3], steepness), 0.0);
    }

    /// A zigzag and a front are not explained at all.
    #[test]
    fn limiter_leaves_a_zigzag_and_a_front(
        a in 0.01..1.0_f64, b in 0.01..1.0_f64, c in 0.01..1.0_f64, steepness in 0.1..20.0_f64,
    ) {
        for jumps in [[-a, b, -c], [0.0, b, 0.0], [0.0, b, c], [a, b, -c]] {
            prop_assert_eq!(unexplained(jumps, steepness), jumps[1]);
            prop_assert_eq!(unexplained(jumps.map(|j| -j), steepness), -jumps[1]);
        }
    }

    /// No jump is torn: a small change of the jumps changes what is seen a little.
    #[test]
    fn limiter_is_continuous(
        jumps in [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0],
        push in [-1e-9..1e-9_f64, -1e-9..1e-9, -1e-9..1e-9],
    ) {
        let pushed = [jumps[0] + push[0], jumps[1] + push[1], jumps[2] + push[2]];
        let change = (unexplained(pushed, 12.0) - unexplained(jumps, 12.0)).abs();
        // Its slope is at most 1 + the steepness.
        prop_assert!(change < 2e-8, "{change:e}");
    }

    /// Thermodynamic sound speed is the isentropic derivative of the pressure, temperature the
    /// energy over `c_v`: Eq. (80).
    #[test]
    fn gas_is_consistent(gamma in 1.1..3.0_f64, rho in 0.1..10.0_f64, heat in 0.1..10.0_f64, u_0 in 0.0..2.0_f64) {
        let eos = gas(gamma, u_0, SoundSpeed::Thermodynamic);
        let u = u_0 + heat;
        let c2 = derivative(|rho| eos.pressure(rho, u), rho)
            + eos.pressure(rho, u) / (rho * rho) * derivative(|u| eos.pressure(rho, u), u);
        prop_assert!(near(eos.sound_speed(u).powi(2), c2, 1e-7));
        prop_assert!(near(1.0 / derivative(|u| eos.temperature(u), u), eos.c_v(), 1e-7));
        prop_assert!(near(eos.temperature(u_0), 3.0, 1e-14));
        prop_assert_eq!(eos.pressure(rho, u_0), 0.0);
    }

    /// The shock slope is that of the Hugoniot: with `U_s = b + sqrt(b^2 + c^2)`, `b = s [u]`,
    /// mass, momentum and energy balance across the shock.
    #[test]
    fn shock_slope_is_the_hugoniot_s(gamma in 1.1..3.0_f64, heat in 0.0..10.0_f64, jump in 0.01..10.0_f64) {
        let eos = gas(gamma, 0.0, SoundSpeed::Thermodynamic);
        let b = eos.shock_slope() * jump;
        let speed = b + (b * b + eos.sound_speed(heat).powi(2)).sqrt();
        let (p, rho) = (eos.pressure(1.0, heat), speed / (speed - jump));
        let p_behind = p + speed * jump;
        let u_behind = heat + 0.5 * (p + p_behind) * (1.0 - 1.0 / rho);
        prop_assert!(near(eos.pressure(rho, u_behind), p_behind, 1e-12));
    }

    /// The linear solid: bulk modulus and sound speed are derivatives of its pressure, Eq. (83).
    #[test]
    fn solid_is_consistent(bulk in 0.1..10.0_f64, rho_0 in 0.1..10.0_f64, strain in 0.8..1.2_f64) {
        let data = EosData::Linear { bulk, c_v: 2.0, theta_0: 1.0 };
        let eos = Linear::new(rho_0, &data, SoundSpeed::Thermodynamic).expect("data of a solid");
        let slope = derivative(|rho| eos.pressure(rho, 0.3), strain * rho_0);
        prop_assert!(near(rho_0 * slope, eos.bulk(), 1e-7));
        prop_assert!(near(eos.sound_speed(0.3).powi(2), slope, 1e-7));
        prop_assert!(near(1.0 / derivative(|u| eos.temperature(u), 0.3), eos.c_v(), 1e-7));
    }

    /// No transfer coefficient is negative, so that heat flows from hot to cold; it is the same
    /// from both sides; and the shock form rests where nothing converges.
    #[test]
    fn transfer_is_never_negative(
        zeta in 0.2..1.8_f64, jump in -2.0..2.0_f64, u in [0.0..5.0_f64, 0.0..5.0], nearest in any::<bool>(),
    ) {
        let eos = gas(1.4, 0.0, SoundSpeed::Thermodynamic);
        let contact = Contact { r: zeta, length: 1.0, zeta, nearest, bonded: nearest, joined: true };
        let sound = u.map(|u| eos.sound_speed(u));
        let closing = Closing { jump, rho: [1.0 / zeta, 1.1 / zeta], sound };
        let other = Closing { rho: [1.1 / zeta, 1.0 / zeta], sound: [sound[1], sound[0]], ..closing };
        let (a, b) = (side(0, u[0]), side(1, u[1]));
        for conduction in [Conduction::Linear, Conduction::Shock] {
            let law = ArtificialConduction::new(&Method { conduction, ..Preset::Default.method() });
            let flow = law.transfer(&contact, &closing, [(&a, &eos), (&b, &eos)]);
            prop_assert!(flow >= 0.0);
            prop_assert!(near(flow, law.transfer(&contact, &other, [(&b, &eos), (&a, &eos)]), 1e-14));
            let acts = match conduction {
                Conduction::Shock => nearest && jump > 0.0,
                _ => zeta < 1.0 && sound != [0.0; 2],
            };
            prop_assert_eq!(flow > 0.0, acts);
        }
    }
}

/// The three readings of the sound speed in the gas of Table 1 at its cold energy.
#[test]
fn readings_of_the_sound_speed() {
    let at = |sound, u| gas(5.0 / 3.0, 1.0, sound).sound_speed(u);
    // sqrt(gamma (gamma - 1)) = 1.0541: the constant of the paper.
    let paper = (10.0_f64 / 9.0).sqrt();
    assert_eq!(at(SoundSpeed::Thermodynamic, 1.0), 0.0);
    assert!(near(at(SoundSpeed::Total, 1.0), paper, 1e-14));
    assert!(near(at(SoundSpeed::Reference, 1.7), paper, 1e-14));
    assert!(near(at(SoundSpeed::Total, 1.5), paper * 1.5_f64.sqrt(), 1e-14));
}
