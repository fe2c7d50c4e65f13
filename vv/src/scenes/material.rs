//! Materials as they are written, made into those of the solver; the library.

use std::path::Path;
use std::sync::LazyLock;

use serde::Deserialize;
use whipple_solver::space::scene::{EosData, Failure, Flow, GammaLaw, Material as Data, Strength};
use whipple_solver::units::Units;

use super::build::Reading;
use super::error::FileError;
use super::file::{self, Material, Status};
use super::quantity::Kind;
use super::schema::Spanned;

/// The library, as it is written.
const LIBRARY: &str = include_str!("../../../references/library.toml");

/// What messages call it.
const LIBRARY_FILE: &str = "references/library.toml";

/// Temperature of rest, where none is given.
const COLD: f64 = 300.0;

/// A library file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Materials {
    material: Vec<Spanned<Material>>,
}

static MATERIALS: LazyLock<Result<Vec<Spanned<Material>>, FileError>> = LazyLock::new(|| {
    let read: Result<Materials, _> = toml::from_str(LIBRARY);
    read.map(|read| read.material)
        .map_err(|error| FileError::toml(Path::new(LIBRARY_FILE), LIBRARY, &error))
});

/// All materials of the library, in its order.
///
/// # Errors
/// A library that is not of its form.
pub fn library() -> Result<&'static [Spanned<Material>], FileError> {
    MATERIALS.as_deref().map_err(Clone::clone)
}

/// A reading of the library in these units.
#[must_use]
pub fn reading(units: Units) -> Reading<'static> {
    Reading::new(Path::new(LIBRARY_FILE), LIBRARY, units)
}

/// Up to where the constants of a material are good, in the units of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Pressure.
    pub pressure: f64,
    /// Temperature.
    pub temperature: f64,
}

/// A material for the solver, with the range of its constants.
///
/// # Errors
/// A number that is none, or laws that exclude each other.
pub fn data(of: &Reading<'_>, material: &Spanned<Material>) -> Result<(Data, Range), FileError> {
    let (span, material) = (material.span(), material.get_ref());
    let name = material.name.get_ref();
    let (eos, pressure) = match (&material.solid, &material.gas) {
        (Some(solid), None) => {
            let law = solid.b.map_or(GammaLaw::ConstantProduct, GammaLaw::Steinberg);
            let eos = EosData::MieGruneisen {
                c0: of.read(&solid.c0, Kind::VELOCITY)?,
                s: solid.s,
                gamma_0: solid.gamma_0,
                law,
                c_v: of.read(&solid.c_v, Kind::SPECIFIC_HEAT)?,
                theta_0: of.or(solid.theta_0.as_ref(), Kind::TEMPERATURE, COLD)?,
            };
            (eos, of.or(solid.valid_to.as_ref(), Kind::PRESSURE, f64::INFINITY)?)
        }
        (None, Some(gas)) => {
            let c_v = of.read(&gas.c_v, Kind::SPECIFIC_HEAT)?;
            (EosData::IdealGas { adiabatic_index: gas.index, c_v }, f64::INFINITY)
        }
        _ => {
            let message = format!("the material `{name}` needs one of `solid` and `gas`");
            return Err(of.wrong(span, message));
        }
    };
    let strength = material.strength.as_ref().map(|own| strength(of, own, (&span, name)));
    let temperature = material.strength.as_ref().and_then(|s| s.valid_to.as_ref());
    let range =
        Range { pressure, temperature: of.or(temperature, Kind::TEMPERATURE, f64::INFINITY)? };
    let data = Data {
        name: name.clone(),
        density: of.read(&material.density, Kind::DENSITY)?,
        eos,
        strength: strength.transpose()?,
        failure: failure(of, material)?,
    };
    Ok((data, range))
}

fn strength(
    of: &Reading<'_>,
    own: &file::Strength,
    (span, name): (&std::ops::Range<usize>, &str),
) -> Result<Strength, FileError> {
    let flow = match (&own.hardening, &own.johnson_cook, &own.yield_stress) {
        (None, None, None) => None,
        (Some(law), None, None) => Some(Flow::Hardening {
            y_0: of.read(&law.y_0, Kind::PRESSURE)?,
            kappa: law.kappa,
            alpha: law.alpha,
            eta: law.eta.unwrap_or(1.0),
            reference: of.or(law.reference.as_ref(), Kind::TEMPERATURE, COLD)?,
            melt: of.read(&law.melt, Kind::TEMPERATURE)?,
        }),
        (None, Some(law), None) => {
            // One per second, in whatever a scene counts time.
            let second = of.plain("1 1/s", Kind::RATE).unwrap_or(1.0);
            Some(Flow::JohnsonCook {
                a: of.read(&law.a, Kind::PRESSURE)?,
                b: of.read(&law.b, Kind::PRESSURE)?,
                n: law.n,
                c: law.c,
                rate_0: of.or(law.rate_0.as_ref(), Kind::RATE, second)?,
                m: law.m,
                reference: of.or(law.reference.as_ref(), Kind::TEMPERATURE, COLD)?,
                melt: of.read(&law.melt, Kind::TEMPERATURE)?,
            })
        }
        (None, None, Some(stress)) => Some(Flow::Hardening {
            y_0: of.read(stress, Kind::PRESSURE)?,
            kappa: 0.0,
            alpha: 0.0,
            eta: 0.0,
            reference: COLD,
            melt: 2.0 * COLD,
        }),
        _ => {
            let message = format!(
                "the strength of `{name}` needs one law: `hardening`, `johnson_cook` or `yield_stress`"
            );
            return Err(of.wrong(span.clone(), message));
        }
    };
    Ok(Strength { shear_modulus: of.read(&own.shear_modulus, Kind::PRESSURE)?, flow })
}

fn failure(of: &Reading<'_>, material: &Material) -> Result<Failure, FileError> {
    let gas = material.gas.is_some();
    let usual = if gas {
        // A gas bears any compression.
        Failure { compression: 0.0, ..Failure::default() }
    } else {
        Failure::default()
    };
    let Some(own) = &material.failure else { return Ok(usual) };
    let maybe = |quantity: &Option<file::Quantity>, kind| {
        quantity.as_ref().map(|quantity| of.read(quantity, kind)).transpose()
    };
    Ok(Failure {
        plastic_strain: own.plastic_strain,
        melt: maybe(&own.melt, Kind::TEMPERATURE)?,
        compression: own.compression.unwrap_or(usual.compression),
        spall: maybe(&own.spall, Kind::PRESSURE)?,
    })
}

/// Groups of constants of a material: what they are, where they come from, and whether that was read.
#[must_use]
pub fn sources(material: &Material) -> Vec<(&'static str, &str, Status)> {
    let solid =
        material.solid.as_ref().map(|s| ("equation of state", s.source.as_deref(), s.status));
    let gas = material.gas.as_ref().map(|g| ("equation of state", g.source.as_deref(), g.status));
    let strength = material.strength.as_ref().map(|s| ("strength", s.source.as_deref(), s.status));
    let failure = material.failure.as_ref().map(|f| ("failure", f.source.as_deref(), f.status));
    let all = [solid, gas, strength, failure].into_iter().flatten();
    all.map(|(what, source, status)| (what, source.unwrap_or("no source is given"), status))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every material of the library can be used in either system of units, names its sources, and is named once.
    #[test]
    fn the_library_is_whole() {
        let all = library().unwrap();
        assert!(all.len() >= 20);
        let mut names: Vec<&str> =
            all.iter().map(|m| m.get_ref().name.get_ref().as_str()).collect();
        for units in [Units::CmGUsMbar, Units::InLbfS] {
            for material in all {
                let (data, range) =
                    data(&reading(units), material).unwrap_or_else(|e| panic!("{e}"));
                assert!(range.pressure > 0.0 && data.density > 0.0);
                for (what, source, _) in sources(material.get_ref()) {
                    assert!(source != "no source is given", "{}: {what}", data.name);
                }
            }
        }
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), all.len());
    }

    /// Numbers of the library are those of the record of what was read.
    #[test]
    fn the_library_is_what_was_read() {
        let aluminium =
            library().unwrap().iter().find(|m| m.get_ref().name.get_ref() == "al-6061-t6");
        let (data, range) = data(&reading(Units::CmGUsMbar), aluminium.unwrap()).unwrap();
        assert_eq!(data.density, 2.703);
        let EosData::MieGruneisen { c0, s, c_v, .. } = data.eos else { panic!("a solid") };
        assert_eq!([c0, s, c_v], [0.524, 1.4, 0.885e-5]);
        let strength = data.strength.unwrap();
        assert_eq!(strength.shear_modulus, 0.276);
        assert!(matches!(strength.flow, Some(Flow::Hardening { y_0: 0.0029, kappa: 125.0, .. })));
        assert_eq!(data.failure.spall, Some(0.0098));
        assert_eq!(range, Range { pressure: 1.0, temperature: 1220.0 });
    }
}
