//! The one-dimensional element: a segment between two neighbours of one body.

/// Whether a scene has elements.
pub trait Solid: Send + Sync + 'static {
    /// Whether its segments resist tension.
    const RESISTS: bool;
    /// The pressure that the particles carry, of the `pressure` by the equation of state.
    fn carried(pressure: f64) -> f64;
    /// Force in a segment of stiffness `bulk` stretched to `zeta`, repulsive: zero or negative.
    fn tension(bulk: f64, zeta: f64) -> f64;
}

/// A gas: no element, no memory, no code.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoSolid;

impl Solid for NoSolid {
    const RESISTS: bool = false;

    #[inline(always)]
    fn carried(pressure: f64) -> f64 {
        pressure
    }

    #[inline(always)]
    fn tension(_: f64, _: f64) -> f64 {
        0.0
    }
}

/// Segments that carry tension. Their strain energy is Eq. (25) with the Jacobian `J = zeta` and no
/// damage,
///
/// `psi = K <J - 1>^2 / 2`,
///
/// with the bracket of Eq. (26); it enters the potential energy, Eqs. (21), (27), (28), and its
/// derivative by the positions is the conservative force `g` of Eq. (29). In compression the
/// particles carry the load alone: with both, the stiffness would double (gap G33).
#[derive(Debug, Clone, Copy, Default)]
pub struct Segments;

impl Solid for Segments {
    const RESISTS: bool = true;

    /// Particles push and never pull (decision 0001).
    #[inline(always)]
    fn carried(pressure: f64) -> f64 {
        pressure.max(0.0)
    }

    #[inline(always)]
    fn tension(bulk: f64, zeta: f64) -> f64 {
        -bulk * (zeta - 1.0).max(0.0)
    }
}

/// Stiffness of a segment whose halves have these moduli.
#[inline(always)]
#[must_use]
pub fn series(a: f64, b: f64) -> f64 {
    2.0 * a * b / (a + b)
}
