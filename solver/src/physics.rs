//! What exists in a scene, as types: an absent thing costs no memory, no time and no code path.

use std::marker::PhantomData;

use crate::density::DensityScheme;
use crate::elements::{NoSolid, Segments, Solid};
use crate::eos::{Eos, IdealGas, Linear};
use crate::heat::Heat;

/// The composition of a scene in `D` dimensions. Every associated type is a decision, taken once,
/// when a scene becomes a simulation.
///
/// The particle shape joins here with the three-dimensional solver: along a chain every particle is
/// a sphere whose only size is its contact length.
pub trait Physics<const D: usize>: Send + Sync + 'static {
    /// How density answers to motion.
    type Density: DensityScheme<D>;
    /// Equation of state; its constants are data, one set a material.
    type Eos: Eos;
    /// Elements.
    type Solid: Solid;
    /// Heat diffusion.
    type Heat: Heat;
}

/// Gas: ideal, without elements.
pub struct Gas<S, H>(PhantomData<(S, H)>);

impl<const D: usize, S: DensityScheme<D>, H: Heat> Physics<D> for Gas<S, H> {
    type Density = S;
    type Eos = IdealGas;
    type Solid = NoSolid;
    type Heat = H;
}

/// Elastic bars: linear, with segments that carry tension.
pub struct Bar<S, H>(PhantomData<(S, H)>);

impl<const D: usize, S: DensityScheme<D>, H: Heat> Physics<D> for Bar<S, H> {
    type Density = S;
    type Eos = Linear;
    type Solid = Segments;
    type Heat = H;
}
