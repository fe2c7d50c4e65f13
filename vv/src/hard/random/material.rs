//! Materials of random impacts: those of the hard cases and of the cases in space. Units: cm, g, us, Mbar.

use whipple_solver::space::scene::{EosData, Failure, Flow, Material, Strength};

use super::super::contact::{brittle, foam};
use super::super::scenes::{ALUMINIUM, COPPER, Metal, STEEL, TUNGSTEN, gas, rod_metals};
use super::draw::Draw;

/// Specific heat of the gases: that of air.
const GAS_HEAT: f64 = 0.718e-5;

/// A material with a name of its own, and the energy per mass that its body starts with.
pub(super) fn draw_material(draw: &mut Draw, number: usize) -> (Material, f64) {
    let metals = [COPPER, ALUMINIUM, TUNGSTEN, STEEL];
    let (kind, mut material) = match draw.weighted(&[0.2, 0.15, 0.4, 0.05, 0.2]) {
        0 => ("fluid", metals[draw.below(4)].fluid()),
        1 => ("elastic", metals[draw.below(4)].elastic()),
        2 => ("that fails", failing(draw.below(6))),
        3 => ("fluid", foam()),
        _ => ("", thin_gas(draw)),
    };
    let is_gas = matches!(material.eos, EosData::IdealGas { .. });
    let energy = match is_gas {
        true if draw.chance(0.9) => draw.log_between(1e-6, 1e-1),
        false if draw.chance(0.15) => draw.log_between(1e-6, 1e-2),
        _ => 0.0,
    };
    material.name = format!("{} {kind}", material.name).trim_end().to_owned();
    material.name += &format!(" {number}");
    (material, energy)
}

/// A gas of any density.
fn thin_gas(draw: &mut Draw) -> Material {
    let adiabatic_index = draw.one_of(&[1.4, 5.0 / 3.0]);
    let density = draw.log_between(1e-3, 1.0);
    let eos = EosData::IdealGas { adiabatic_index, c_v: GAS_HEAT };
    Material { density, eos, ..gas(adiabatic_index) }
}

/// Solids with a yield stress: tungsten and steel of the rod, aluminium of the sphere, carbon-carbon, copper and steel
/// of the Taylor impacts, by number from 0 to 5.
fn failing(number: usize) -> Material {
    let [tungsten, steel] = rod_metals();
    match number {
        0 => tungsten,
        1 => steel,
        2 => brittle(&ALUMINIUM),
        3 => carbon(),
        4 => softening(&COPPER, [0.0009, 0.00292, 0.31, 0.025, 1.09, 1356.0]),
        _ => softening(&STEEL, [0.00806, 0.00614, 0.168, 0.0089, 1.1, 1813.0]),
    }
}

/// Carbon-carbon (`rcc_baseline`), whose yield stress rises with the temperature.
fn carbon() -> Material {
    let metal = Metal {
        name: "carbon-carbon",
        constants: [1.58, 0.246, 1.6, 0.24, 0.712e-5],
        shear: 0.0718,
    };
    let mut material = metal.ductile([0.000_771, 2.0, 1.0, 3840.0]);
    if let Some(Strength { flow: Some(Flow::Hardening { eta, .. }), .. }) = &mut material.strength {
        *eta = -1.0;
    }
    material.failure.plastic_strain = Some(0.5);
    material
}

/// A metal with the strength of Johnson and Cook: `A`, `B`, `n`, `C`, `m` and the melt temperature.
fn softening(metal: &Metal, [a, b, n, c, m, melt]: [f64; 6]) -> Material {
    let flow = Flow::JohnsonCook { a, b, n, c, rate_0: 1e-6, m, reference: 293.15, melt };
    let strength = Some(Strength { shear_modulus: metal.shear, flow: Some(flow) });
    let failure = Failure { melt: Some(melt), ..Failure::default() };
    Material { strength, failure, ..metal.fluid() }
}
