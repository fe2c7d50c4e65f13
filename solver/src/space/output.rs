//! Results as plain data: what the harness reads of a simulation.

use super::lanes::LANES;
use super::simulation::Simulation;

/// A particle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Particle {
    /// Its number, as elements name it.
    pub id: u32,
    /// Index of its body.
    pub body: usize,
    /// Mass.
    pub mass: f64,
    /// Position `c`.
    pub position: [f64; 3],
    /// Velocity.
    pub velocity: [f64; 3],
    /// Density.
    pub rho: f64,
    /// Pressure.
    pub pressure: f64,
    /// Temperature.
    pub theta: f64,
    /// Internal energy per mass.
    pub u: f64,
    /// Share of its elements that are live, 0 to 1.
    pub held: f64,
}

/// How an ellipsoidal particle lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ellipsoid {
    /// Its axes, unit vectors in global ones: the columns of `R`, Eq. (2).
    pub axes: [[f64; 3]; 3],
    /// Half-lengths `h_k` along them.
    pub half_lengths: [f64; 3],
    /// Contact lengths `2 beta h_k`.
    pub contact_lengths: [f64; 3],
}

/// An element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Element {
    /// Index of its body.
    pub body: usize,
    /// Particles at its corners, slot `b1 + 2 b2 + 4 b3` for the bits along the lattice axes.
    pub corners: [u32; 8],
    /// Particle at its centroid.
    pub centre: u32,
    /// Whether it is a volume.
    pub live: bool,
    /// Whether it fails or has failed.
    pub failed: bool,
    /// Effective plastic strain.
    pub strain: f64,
    /// Damage, 0 to 1.
    pub damage: f64,
    /// Von Mises equivalent of the deviatoric stress `S`.
    pub equivalent_stress: f64,
}

impl Element {
    /// Corners in the order that visualisation files use: round the bottom, then round the top.
    #[must_use]
    pub fn ring(&self) -> [u32; 8] {
        [0, 1, 3, 2, 4, 5, 7, 6].map(|slot| self.corners[slot])
    }
}

impl Simulation {
    /// Present state of particle `id`.
    #[must_use]
    pub fn particle(&self, id: u32) -> Particle {
        let i = id as usize;
        let ratio = self.mesh.ratio[i];
        Particle {
            id,
            body: self.mesh.place(i).0,
            mass: self.mesh.mass(i),
            position: self.position(i),
            velocity: self.velocity(i),
            rho: self.derived.rho[i],
            pressure: self.derived.pressure[i],
            theta: self.derived.theta[i],
            u: self.state.u[i],
            held: if ratio > 0.0 { 1.0 / ratio } else { 0.0 },
        }
    }

    /// All particles: nodes of all bodies, then centroids.
    pub fn all_particles(&self) -> impl Iterator<Item = Particle> + '_ {
        self.mesh.real().map(|i| self.particle(i as u32))
    }

    /// All elements, dead ones included, body by body.
    pub fn all_elements(&self) -> impl Iterator<Item = Element> + '_ {
        self.groups.iter().flat_map(|group| {
            (0..group.lanes as usize).map(move |lane| {
                debug_assert!(lane < LANES);
                let s = group.stress.map(|s| s.0[lane]);
                let diagonal = s[0] * s[0] + s[1] * s[1] + s[2] * s[2];
                let square = diagonal + 2.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]);
                let trace = s[0] + s[1] + s[2];
                Element {
                    body: group.body as usize,
                    corners: std::array::from_fn(|slot| (group.node(slot) + lane) as u32),
                    centre: group.centre + lane as u32,
                    live: group.live >> lane & 1 == 1,
                    failed: group.failed >> lane & 1 == 1,
                    strain: group.strain.0[lane],
                    damage: group.damage.0[lane],
                    equivalent_stress: (1.5 * (square - trace * trace / 3.0).max(0.0)).sqrt(),
                }
            })
        })
    }

    /// Pairs in the list of those that may touch.
    #[must_use]
    pub fn pairs(&self) -> usize {
        self.contacts.pairs()
    }

    /// Pairs of them that acted on each other in the last step.
    #[must_use]
    pub fn acting(&self) -> usize {
        self.contacts.acting()
    }

    /// What the search for pairs has done since the scene was made, or restored.
    #[must_use]
    pub fn searches(&self) -> super::near::Counters {
        self.contacts.searches()
    }

    /// Elements that the present step evaluates: live, and reached by a wave.
    #[must_use]
    pub fn working(&self) -> usize {
        let awake = self.groups.iter().filter(|group| group.awake);
        awake.map(|group| group.live.count_ones() as usize).sum()
    }

    /// Particles that the present step moves: those that no wave has reached are left out.
    #[must_use]
    pub fn moving(&self) -> usize {
        let pieces = self.mesh.pieces.iter().zip(&self.active);
        pieces.filter(|(_, active)| **active).map(|(piece, _)| piece.real).sum()
    }

    /// Number of bodies.
    #[must_use]
    pub fn bodies(&self) -> usize {
        self.mesh.bodies.len()
    }

    /// Whether particles are ellipsoids, of a body at least.
    #[must_use]
    pub fn rotates(&self) -> bool {
        self.contacts.rotates()
    }

    /// A particle that is an ellipsoid; nothing of a sphere.
    #[must_use]
    pub fn ellipsoid(&self, id: u32) -> Option<Ellipsoid> {
        self.contacts.ellipsoid((&self.mesh, &self.state), id as usize)
    }

    /// Contact length `2 beta h` of the particles of a body, and the edges of its cells along its
    /// lattice axes.
    #[must_use]
    pub fn sizes(&self, body: usize) -> (f64, [f64; 3]) {
        (self.mesh.bodies[body].length, self.mesh.bodies[body].lattice.size)
    }
}
