//! Metals with the constants of `references/materials.toml`.

use whipple_solver::space::scene::{EosData, Failure, Flow, GammaLaw, Material, Strength};

use crate::exact::InputError;
use crate::exact::gruneisen::MieGruneisen;
use crate::exact::hugoniot::Hugoniot;

/// A metal: density, `c0`, `s`, Grueneisen's constant, `c_v`.
pub(in crate::cases) struct Metal {
    pub(in crate::cases) name: &'static str,
    pub(in crate::cases) constants: [f64; 5],
}

pub(in crate::cases) const COPPER: Metal =
    Metal { name: "copper", constants: [8.93, 0.394, 1.489, 2.02, 0.383e-5] };
pub(in crate::cases) const ALUMINIUM: Metal =
    Metal { name: "aluminium", constants: [2.70, 0.5386, 1.339, 1.97, 0.884e-5] };
pub(in crate::cases) const TUNGSTEN: Metal =
    Metal { name: "tungsten alloy", constants: [17.6, 0.403, 1.237, 1.67, 0.143e-5] };
pub(in crate::cases) const STEEL: Metal =
    Metal { name: "steel", constants: [7.87, 0.4578, 1.33, 1.67, 0.448e-5] };

impl Metal {
    /// Without strength, with a constant product of Grueneisen's coefficient and density.
    pub(in crate::cases) fn material(&self) -> Material {
        let [density, c0, s, gamma_0, c_v] = self.constants;
        let law = GammaLaw::ConstantProduct;
        Material {
            name: self.name.into(),
            density,
            eos: EosData::MieGruneisen { c0, s, gamma_0, law, c_v, theta_0: 300.0 },
            strength: None,
            failure: Failure::default(),
        }
    }

    /// Density of the reference state.
    pub(in crate::cases) fn density(&self) -> f64 {
        self.constants[0]
    }

    /// Bulk sound speed of the reference state.
    pub(in crate::cases) fn sound(&self) -> f64 {
        self.constants[1]
    }

    /// Its Hugoniot.
    pub(in crate::cases) fn hugoniot(&self) -> Result<Hugoniot, InputError> {
        let [density, c0, s, ..] = self.constants;
        Hugoniot::new(density, c0, s)
    }

    /// Its equation of state.
    pub(in crate::cases) fn gruneisen(&self) -> Result<MieGruneisen, InputError> {
        MieGruneisen::constant_product(self.hugoniot()?, self.constants[3])
    }
}

/// A material with strength by Eq. (44) that fails.
pub(in crate::cases) struct Ductile {
    pub(in crate::cases) metal: Metal,
    pub(in crate::cases) shear_modulus: f64,
    /// `Y_o`, `kappa`, `alpha`, `eta` and melt temperature of Eq. (44).
    pub(in crate::cases) hardening: [f64; 5],
    /// Plastic strain at which it fails.
    pub(in crate::cases) strain: f64,
    /// Tensile strength.
    pub(in crate::cases) spall: Option<f64>,
}

impl Ductile {
    /// With softening from 300 K on (gap G6), and elements that fail at the melt temperature and at 0.3
    /// of their volume (gap G21).
    pub(in crate::cases) fn material(&self) -> Material {
        let [y_0, kappa, alpha, eta, melt] = self.hardening;
        let flow = Flow::Hardening { y_0, kappa, alpha, eta, reference: 300.0, melt };
        Material {
            strength: Some(Strength { shear_modulus: self.shear_modulus, flow: Some(flow) }),
            failure: Failure {
                plastic_strain: Some(self.strain),
                melt: Some(melt),
                compression: 0.3,
                spall: self.spall,
            },
            ..self.metal.material()
        }
    }
}
