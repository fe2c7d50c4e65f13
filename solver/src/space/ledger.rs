//! What the scene holds: mass, momentum, angular momentum and every kind of energy.

use serde::{Deserialize, Serialize};

use super::cells::Cells;
use super::lanes::Lanes;
use super::simulation::Simulation;
use crate::method::Integrator;

/// Sums over a body, or over all.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Holdings {
    /// Mass.
    pub mass: f64,
    /// Momentum, Eq. (20).
    pub momentum: [f64; 3],
    /// Angular momentum about the origin.
    pub angular: [f64; 3],
    /// Kinetic co-energy, Eqs. (18)-(19).
    pub kinetic: f64,
    /// Internal energy, the first term of Eq. (21).
    pub internal: f64,
    /// Energy stored in shear, Eq. (24).
    pub shear: f64,
    /// Energy stored in tension, Eq. (25).
    pub tension: f64,
    /// Energy stored in hourglass modes.
    #[serde(default)]
    pub hourglass: f64,
    /// Energy of the springs between surfaces, half to each body.
    #[serde(default)]
    pub spring: f64,
    /// Sum of `m |v|`, the scale of the momentum.
    pub momentum_scale: f64,
    /// Sum of `m |x| |v|`, the scale of the angular momentum.
    pub angular_scale: f64,
}

impl Holdings {
    /// Adds another's.
    #[must_use]
    pub fn and(self, other: &Self) -> Self {
        let add = |a: [f64; 3], b: [f64; 3]| std::array::from_fn(|d| a[d] + b[d]);
        Self {
            mass: self.mass + other.mass,
            momentum: add(self.momentum, other.momentum),
            angular: add(self.angular, other.angular),
            kinetic: self.kinetic + other.kinetic,
            internal: self.internal + other.internal,
            shear: self.shear + other.shear,
            tension: self.tension + other.tension,
            hourglass: self.hourglass + other.hourglass,
            spring: self.spring + other.spring,
            momentum_scale: self.momentum_scale + other.momentum_scale,
            angular_scale: self.angular_scale + other.angular_scale,
        }
    }

    /// Energy that elements and springs give back.
    #[must_use]
    pub fn stored(&self) -> f64 {
        self.shear + self.tension + self.hourglass + self.spring
    }

    /// All energy.
    #[must_use]
    pub fn energy(&self) -> f64 {
        self.kinetic + self.internal + self.stored()
    }
}

/// The balance of a run.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Balance {
    /// At the start.
    pub initial: Holdings,
    /// Now.
    pub now: Holdings,
    /// Impulse of the walls.
    pub wall_impulse: [f64; 3],
    /// Its moment about the origin.
    pub wall_moment: [f64; 3],
    /// Work of the walls.
    pub wall_work: f64,
    /// Work of the particles on the elements' shear and tension.
    pub element_work: f64,
    /// Heat of plastic flow and damage.
    pub element_heat: f64,
    /// Work of the particles on the springs between surfaces.
    #[serde(default)]
    pub spring_work: f64,
    /// Heat of springs whose surface died.
    #[serde(default)]
    pub spring_heat: f64,
}

impl Balance {
    /// Work done on elements and springs that is neither stored nor heat: the error of integrating
    /// their forces over steps of finite length.
    #[must_use]
    pub fn residual(&self) -> f64 {
        let given = self.element_work - self.element_heat + (self.spring_work - self.spring_heat);
        given - (self.now.stored() - self.initial.stored())
    }

    /// The residual over the initial kinetic energy, or the internal where nothing moved.
    #[must_use]
    pub fn relative_residual(&self) -> f64 {
        self.residual() / self.scale()
    }

    /// Error of the energy balance with the residual booked, over the same.
    #[must_use]
    pub fn energy_drift(&self) -> f64 {
        let held = self.now.energy() + self.residual();
        (held - self.initial.energy() - self.wall_work).abs() / self.scale()
    }

    /// Error of the momentum balance over `sum m |v|`.
    #[must_use]
    pub fn momentum_drift(&self) -> f64 {
        let error =
            |d: usize| self.now.momentum[d] - self.initial.momentum[d] - self.wall_impulse[d];
        let scale = self.initial.momentum_scale.max(self.now.momentum_scale);
        worst(error) / scale.max(f64::MIN_POSITIVE)
    }

    /// Error of the angular momentum balance over `sum m |x| |v|`.
    #[must_use]
    pub fn angular_drift(&self) -> f64 {
        let error = |d: usize| self.now.angular[d] - self.initial.angular[d] - self.wall_moment[d];
        let scale = self.initial.angular_scale.max(self.now.angular_scale);
        worst(error) / scale.max(f64::MIN_POSITIVE)
    }

    /// Change of the mass over the mass.
    #[must_use]
    pub fn mass_error(&self) -> f64 {
        ((self.now.mass - self.initial.mass) / self.initial.mass).abs()
    }

    fn scale(&self) -> f64 {
        let Holdings { kinetic, internal, .. } = self.initial;
        if kinetic > 0.0 { kinetic } else { internal.max(f64::MIN_POSITIVE) }
    }
}

fn worst(error: impl Fn(usize) -> f64) -> f64 {
    (0..3).map(|d| error(d).abs()).fold(0.0, f64::max)
}

impl Simulation {
    /// What each body holds, in order.
    #[must_use]
    pub fn holdings(&self) -> Vec<Holdings> {
        let mut all: Vec<Holdings> = (0..self.mesh.bodies.len()).map(|k| self.carried(k)).collect();
        for group in &self.groups {
            let body = &self.mesh.bodies[group.body as usize];
            let (columns, step) = (self.state.motion(), (&self.method, self.dt));
            let [shear, tension, hourglass] = if body.mapped.is_empty() {
                group.stored(&Cells::<false>::new(body, group.centre), columns, step)
            } else {
                group.stored(&Cells::<true>::new(body, group.centre), columns, step)
            };
            all[group.body as usize].shear += shear.sum();
            all[group.body as usize].tension += tension.sum();
            all[group.body as usize].hourglass += hourglass.sum();
        }
        for (holdings, spring) in
            all.iter_mut().zip(self.surfaces.stored(&self.mesh, &self.contacts))
        {
            holdings.spring = spring;
        }
        all
    }

    /// What the particles of a body hold.
    fn carried(&self, k: usize) -> Holdings {
        let body = &self.mesh.bodies[k];
        let mut h = Holdings::default();
        for i in body.nodes.clone().chain(body.centroids.clone()) {
            if let Some((energy, angular)) = self.contacts.rotation(&self.mesh, i) {
                h.kinetic += energy;
                h.angular.iter_mut().zip(angular).for_each(|(own, more)| *own += more);
            }
            let (m, x, v) = (self.mesh.mass(i), self.position(i), self.velocity(i));
            let p = v.map(|v| m * v);
            let l = super::lattice::cross(x, p);
            let size = |a: [f64; 3]| a.iter().map(|a| a * a).sum::<f64>();
            h.mass += m;
            h.kinetic += 0.5 * m * size(v);
            h.internal += m * self.state.u[i];
            h.momentum_scale += m * size(v).sqrt();
            h.angular_scale += m * (size(x) * size(v)).sqrt();
            for d in 0..3 {
                h.momentum[d] += p[d];
                h.angular[d] += l[d];
            }
        }
        h
    }

    /// The balance since the start.
    #[must_use]
    pub fn balance(&self) -> Balance {
        let now = self.holdings().iter().fold(Holdings::default(), Holdings::and);
        // A single pass does not make out the work of elements: what they err is in the energy.
        let element_work = match self.method.integrator {
            Integrator::Compatible => self.element_work,
            Integrator::SinglePass => self.element_heat + (now.stored() - self.initial.stored()),
        };
        Balance {
            initial: self.initial,
            now,
            wall_impulse: self.walls_gave.impulse,
            wall_moment: self.walls_gave.moment,
            wall_work: self.walls_gave.work,
            element_work,
            element_heat: self.element_heat,
            spring_work: self.spring_work,
            spring_heat: self.spring_heat,
        }
    }

    /// Takes what is held now for what was held at the start: after a change of a new simulation to a
    /// state that no scene states.
    pub fn start_books(&mut self) {
        self.initial = self.balance().now;
    }

    /// Position of a particle.
    #[must_use]
    pub fn position(&self, i: usize) -> [f64; 3] {
        let (body, at) = self.mesh.place(i);
        let body = &self.mesh.bodies[body];
        let (start, own) = (body.lattice.position(at), self.displacement(i));
        std::array::from_fn(|d| start[d] + (body.way[d] + own[d]))
    }

    /// The particles, in order: nodes of all bodies, then centroids.
    pub fn real(&self) -> impl Iterator<Item = usize> + '_ {
        self.mesh.real()
    }

    /// Pressure of a particle.
    #[must_use]
    pub fn pressure(&self, i: usize) -> f64 {
        self.derived.pressure[i]
    }

    /// Displacement of a particle relative to the translation of its body.
    #[must_use]
    pub fn displacement(&self, i: usize) -> [f64; 3] {
        [self.state.dx[i], self.state.dy[i], self.state.dz[i]]
    }

    /// Velocity of a particle, half a step ahead of its position.
    #[must_use]
    pub fn velocity(&self, i: usize) -> [f64; 3] {
        let whole = self.mesh.bodies[self.mesh.place(i).0].velocity;
        [self.state.vx[i] + whole[0], self.state.vy[i] + whole[1], self.state.vz[i] + whole[2]]
    }
}
