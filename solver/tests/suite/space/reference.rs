//! The step in three dimensions once more, as plainly as it can be written: one particle, one
//! element and one pair after the other, positions instead of displacements, whole matrices in global
//! axes, and a search for contacts through all pairs.
//!
//! It knows the hybrid scheme with the limited viscosity, Mie-Grueneisen solids with the hardening
//! law (44) and the von Mises reading, boxes and cylinders.

use whipple_solver::space::Scene;
use whipple_solver::space::lattice::rotation;
use whipple_solver::space::method::{Method, Release};
use whipple_solver::space::scene::{Body, EosData, Flow, Material, Shape};

pub type V = [f64; 3];
type M = [[f64; 3]; 3];

fn add(a: V, b: V) -> V {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub fn sub(a: V, b: V) -> V {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn times(a: V, s: f64) -> V {
    a.map(|a| a * s)
}

pub fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn norm(a: V) -> f64 {
    dot(a, a).sqrt()
}

const NOTHING: M = [[0.0; 3]; 3];
const ONE: M = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

fn matrix(f: impl Fn(usize, usize) -> f64) -> M {
    std::array::from_fn(|i| std::array::from_fn(|j| f(i, j)))
}

fn product(a: &M, b: &M) -> M {
    matrix(|i, j| (0..3).map(|k| a[i][k] * b[k][j]).sum())
}

fn transposed(a: &M) -> M {
    matrix(|i, j| a[j][i])
}

/// `a + s b`.
fn plus(a: &M, s: f64, b: &M) -> M {
    matrix(|i, j| a[i][j] + s * b[i][j])
}

fn scaled(a: &M, s: f64) -> M {
    matrix(|i, j| s * a[i][j])
}

fn contract(a: &M, b: &M) -> f64 {
    (0..3).map(|i| dot(a[i], b[i])).sum()
}

fn trace(a: &M) -> f64 {
    a[0][0] + a[1][1] + a[2][2]
}

fn determinant(a: &M) -> f64 {
    dot(a[0], cross(a[1], a[2]))
}

fn cofactors(a: &M) -> M {
    [cross(a[1], a[2]), cross(a[2], a[0]), cross(a[0], a[1])]
}

/// A bound of the largest eigenvalue of a symmetric matrix.
fn largest(a: &M) -> f64 {
    let mean = trace(a) / 3.0;
    let own = plus(a, -mean, &ONE);
    mean + (2.0 / 3.0 * contract(&own, &own)).sqrt()
}

/// The norm (40).
fn size(a: &M) -> f64 {
    (0.5 * contract(a, a)).sqrt()
}

/// `(A B + B A) / 2`.
fn symmetric_product(a: &M, b: &M) -> M {
    scaled(&plus(&product(a, b), 1.0, &product(b, a)), 0.5)
}

#[derive(Debug, Clone, Copy, Default)]
pub struct Particle {
    pub body: usize,
    /// Half cells along the body's own axes.
    pub place: [i32; 3],
    pub start: V,
    pub displacement: V,
    /// Relative to the body's translation, as the displacement.
    pub v: V,
    pub mass: f64,
    /// Elements round it, and those of them that are live; a centroid counts its own as eight.
    pub round: usize,
    pub live: usize,
    /// Damage of the elements round it, in 255 levels, summed.
    lost: u16,
    pub rho: f64,
    pub u: f64,
    rho_rate: f64,
    u_rate: f64,
    /// At the time of the positions.
    pub rho_now: f64,
    pub pressure: f64,
    theta: f64,
    sound: f64,
    /// Density over the volume of its live elements' shares.
    dilate: f64,
    force: V,
    mean: V,
    heat: f64,
    growth: f64,
    growth_rate: f64,
    /// Over the velocity before the kick: by gradients in the first step, then what the last drift has done.
    growth_rate_before: f64,
    /// Of live elements, at the positions before the last drift.
    growth_before: f64,
    contact_rate: f64,
    touched: bool,
    /// Rate at which contacts damp it.
    damped: f64,
    exposed: bool,
}

#[derive(Debug, Clone)]
pub struct Element {
    pub body: usize,
    pub corners: [usize; 8],
    pub centre: usize,
    /// Elements beyond its corners.
    beyond: [Option<usize>; 8],
    pub live: bool,
    pub failed: bool,
    dying: bool,
    pub damage: f64,
    pub strain: f64,
    plastic: M,
    stress: M,
    piola: M,
    tension: [f64; 6],
    bonds: [f64; 8],
}

struct Solid {
    material: Material,
    c0: f64,
    s: f64,
    gamma: f64,
    c_v: f64,
    theta_0: f64,
    bulk: f64,
    mu: f64,
    /// Longitudinal sound speed.
    fast: f64,
    cell: V,
    axes: [V; 3],
    edge: f64,
    volume: f64,
    length: f64,
    velocity: V,
    way: V,
}

struct Contact {
    pair: [usize; 2],
    r: V,
    row: [f64; 2],
    push: [f64; 2],
    drag: f64,
}

/// A point of a body on the surface of another: a loose particle, or one of a face.
struct Spring {
    /// Particles and their shares.
    own: Vec<(usize, f64)>,
    element: usize,
    /// Area that the point stands for, and its gradients.
    area: f64,
    slopes: Vec<(usize, V)>,
    /// Corners of the face and their shares.
    face: [(usize, f64); 4],
    way: V,
    z: f64,
    stand: f64,
    stiffness: f64,
    force: f64,
    drag: f64,
}

impl Spring {
    fn energy(&self) -> f64 {
        let deep = self.z.max(0.2);
        let below = 0.5 * (1.0 / (deep * deep) - 1.0) * (deep - self.z);
        if self.z < 1.0 {
            self.stiffness * (0.5 * (1.0 - deep).powi(2) / deep + below)
        } else {
            0.0
        }
    }

    fn parts(&self) -> Vec<(usize, f64)> {
        let mut parts = self.own.clone();
        parts.extend(self.face.map(|(i, share)| (i, -share)));
        parts
    }
}

/// Whether two springs start from the same point.
fn same(a: &Spring, b: &Spring) -> bool {
    let has = |&(i, share): &(usize, f64)| {
        a.own.iter().any(|&(j, other)| i == j && (share - other).abs() < 1e-9)
    };
    a.own.len() == b.own.len() && b.own.iter().all(has)
}

/// The Gauss points of a face, in the order of its corners.
const POINTS: [[f64; 2]; 4] = {
    let (low, high) = (0.211_324_865_405_187_1, 0.788_675_134_594_812_9);
    [[low, low], [high, low], [high, high], [low, high]]
};

fn bilinear([u, v]: [f64; 2]) -> [f64; 4] {
    [(1.0 - u) * (1.0 - v), u * (1.0 - v), u * v, (1.0 - u) * v]
}

pub struct Plain {
    method: Method,
    bodies: Vec<Solid>,
    pub particles: Vec<Particle>,
    pub elements: Vec<Element>,
    contacts: Vec<Contact>,
    springs: Vec<Spring>,
    pub dt: f64,
    /// What the last step could have been, had the one before not been longer.
    free: f64,
    allowed: [f64; 2],
    rate: f64,
    /// Contacts of all steps so far, and deaths.
    pub touches: usize,
    /// Contacts whose viscosity was lessened.
    pub slackened: usize,
    pub deaths: usize,
}

/// Corners round the six faces, seen from outside against the clock.
fn faces() -> Vec<[usize; 4]> {
    let mut all = Vec::new();
    for axis in 0..3 {
        let (next, last) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
        let up = 1 << axis;
        all.push([up, up + next, up + next + last, up + last]);
        all.push([0, last, next + last, next]);
    }
    all
}

/// Volume of the pyramid from the ninth point to a face: the sum over the triangles between the edges
/// and the face's middle.
fn pyramid(y: &[V; 9], face: [usize; 4]) -> f64 {
    let middle = times(face.iter().fold([0.0; 3], |sum, &k| add(sum, y[k])), 0.25);
    let top = y[8];
    (0..4)
        .map(|k| {
            let (a, b) = (sub(y[face[k]], top), sub(y[face[(k + 1) % 4]], top));
            dot(sub(middle, top), cross(a, b)) / 6.0
        })
        .sum()
}

/// Gradient of that volume with respect to the nine points, from the same triangles.
fn pyramid_gradient(y: &[V; 9], face: [usize; 4]) -> [V; 9] {
    let middle = times(face.iter().fold([0.0; 3], |sum, &k| add(sum, y[k])), 0.25);
    let mut out = [[0.0; 3]; 9];
    for k in 0..4 {
        let (i, j) = (face[k], face[(k + 1) % 4]);
        let (m, a, b) = (sub(middle, y[8]), sub(y[i], y[8]), sub(y[j], y[8]));
        let (to_m, to_a, to_b) = (cross(a, b), cross(b, m), cross(m, a));
        for &corner in &face {
            out[corner] = add(out[corner], times(to_m, 0.25 / 6.0));
        }
        out[i] = add(out[i], times(to_a, 1.0 / 6.0));
        out[j] = add(out[j], times(to_b, 1.0 / 6.0));
        let all = add(to_m, add(to_a, to_b));
        out[8] = sub(out[8], times(all, 1.0 / 6.0));
    }
    out
}

/// Weights of the nine particles in a pyramid (decision 0013).
fn weights(face: [usize; 4], balance: f64) -> [f64; 9] {
    std::array::from_fn(|slot| match slot {
        8 => 0.5,
        slot if face.contains(&slot) => 0.125 + 0.125 * balance,
        _ => -0.125 * balance,
    })
}

fn in_shape(body: &Body, cell: [usize; 3]) -> bool {
    let off = |axis: usize| {
        let n = body.cells[axis] as f64;
        ((cell[axis] as f64 + 0.5) / n - 0.5) * 2.0
    };
    match body.shape {
        Shape::Box { .. } => true,
        Shape::Cylinder { .. } => off(0).powi(2) + off(1).powi(2) <= 1.0,
        Shape::Sphere { .. } => off(0).powi(2) + off(1).powi(2) + off(2).powi(2) <= 1.0,
        // The others are looked at in `bodies`.
        _ => false,
    }
}

impl Plain {
    pub fn new(scene: &Scene) -> Self {
        let mut plain = Self {
            method: scene.method,
            bodies: Vec::new(),
            particles: Vec::new(),
            elements: Vec::new(),
            contacts: Vec::new(),
            springs: Vec::new(),
            dt: 0.0,
            free: 0.0,
            allowed: [f64::INFINITY; 2],
            rate: 0.0,
            touches: 0,
            slackened: 0,
            deaths: 0,
        };
        for body in &scene.bodies {
            let index = scene.material_index(&body.material).expect("a material");
            plain.fill(body, &scene.materials[index]);
        }
        plain.respond(0.0, 0.0);
        plain
    }

    fn fill(&mut self, data: &Body, material: &Material) {
        let k = self.bodies.len();
        let cells: Vec<[usize; 3]> = (0..data.cells[0])
            .flat_map(|i| (0..data.cells[1]).map(move |j| (i, j)))
            .flat_map(|(i, j)| (0..data.cells[2]).map(move |l| [i, j, l]))
            .filter(|&cell| in_shape(data, cell))
            .collect();
        let mut cell: V = std::array::from_fn(|d| data.shape.extent()[d] / data.cells[d] as f64);
        let wanted = data.shape.volume() / cells.len() as f64;
        let nominal = cell[0] * cell[1] * cell[2];
        if let Shape::Cylinder { .. } = data.shape {
            for edge in &mut cell[..2] {
                *edge *= (wanted / nominal).sqrt();
            }
        }
        let volume: f64 = cell.iter().product();
        let axes = rotation(data.turn.axis, data.turn.degrees.to_radians());
        let EosData::MieGruneisen { c0, s, gamma_0, c_v, theta_0, .. } = material.eos else {
            panic!("the plain step knows solids alone");
        };
        let mu = material.strength.map_or(0.0, |s| s.shear_modulus);
        let bulk = material.density * c0 * c0;
        self.bodies.push(Solid {
            material: material.clone(),
            c0,
            s,
            gamma: gamma_0,
            c_v,
            theta_0,
            bulk,
            mu,
            fast: ((bulk + 4.0 / 3.0 * mu) / material.density).sqrt(),
            cell,
            axes,
            edge: cell.iter().copied().fold(f64::INFINITY, f64::min),
            volume,
            length: 0.75f64.sqrt() * volume.cbrt(),
            velocity: data.velocity,
            way: [0.0; 3],
        });
        let at = |place: [i32; 3]| {
            let mut x = data.centre;
            for d in 0..3 {
                let along = 0.5 * cell[d] * (f64::from(place[d]) - data.cells[d] as f64);
                x = add(x, times(axes[d], along));
            }
            x
        };
        let mut found = std::collections::BTreeMap::new();
        for cell in &cells {
            let centre = cell.map(|c| 2 * c as i32 + 1);
            for (place, round) in
                corners_of(centre).into_iter().map(|p| (p, 1)).chain([(centre, 8)])
            {
                let i = *found.entry(place).or_insert_with(|| {
                    self.particles.push(Particle {
                        body: k,
                        place,
                        start: at(place),
                        rho: material.density,
                        u: data.energy,
                        ..Particle::default()
                    });
                    self.particles.len() - 1
                });
                self.particles[i].round += round;
            }
        }
        for p in self.particles.iter_mut().filter(|p| p.body == k) {
            p.live = p.round;
            p.mass = material.density * volume * p.round as f64 / 16.0;
            p.exposed = p.round < 8;
            p.v = cross(data.spin, sub(p.start, data.centre));
        }
        let first = self.elements.len();
        let number: std::collections::BTreeMap<[usize; 3], usize> =
            cells.iter().enumerate().map(|(n, &cell)| (cell, first + n)).collect();
        for cell in &cells {
            let centre = cell.map(|c| 2 * c as i32 + 1);
            let beyond = corners_of([0; 3]).map(|way| {
                let next: [i32; 3] = std::array::from_fn(|d| cell[d] as i32 + way[d]);
                let inside = next.iter().all(|&c| c >= 0);
                inside.then(|| number.get(&next.map(|c| c as usize)).copied()).flatten()
            });
            self.elements.push(Element {
                body: k,
                corners: corners_of(centre).map(|place| found[&place]),
                centre: found[&centre],
                beyond,
                live: true,
                failed: false,
                dying: false,
                damage: 0.0,
                strain: 0.0,
                plastic: NOTHING,
                stress: NOTHING,
                piola: NOTHING,
                tension: [0.0; 6],
                bonds: [0.0; 8],
            });
        }
    }

    pub fn position(&self, i: usize) -> V {
        let p = &self.particles[i];
        add(p.start, add(self.bodies[p.body].way, p.displacement))
    }

    pub fn velocity(&self, i: usize) -> V {
        add(self.particles[i].v, self.bodies[self.particles[i].body].velocity)
    }

    pub fn length(&self, body: usize) -> f64 {
        self.bodies[body].length
    }

    /// One step.
    pub fn step(&mut self) {
        self.rate = 0.0;
        for e in 0..self.elements.len() {
            if self.elements[e].live {
                self.load(e);
            }
        }
        self.touch();
        for (i, energy) in self.renew_springs() {
            self.particles[i].heat += energy;
        }
        self.slacken();
        self.spring();
        let before = self.dt;
        self.dt = self.elect();
        let kick = 0.5 * (before + self.dt);
        for p in &mut self.particles {
            let gain = times(p.force, kick / p.mass);
            p.mean = add(p.v, times(gain, 0.5));
            p.v = add(p.v, gain);
            if before > 0.0 {
                p.growth_rate_before = (p.growth - p.growth_before) / before;
            }
        }
        self.work(kick);
        self.spring_work(kick);
        self.respond(kick, self.dt);
        self.bury();
    }

    fn slots(&self, e: usize) -> [usize; 9] {
        let e = &self.elements[e];
        std::array::from_fn(|slot| if slot == 8 { e.centre } else { e.corners[slot] })
    }

    /// Positions of an element's particles about its centroid at the start, at the start and now.
    fn points(&self, e: usize) -> ([V; 9], [V; 9]) {
        let slots = self.slots(e);
        let origin = self.particles[slots[8]].start;
        let rest = slots.map(|i| sub(self.particles[i].start, origin));
        let now = std::array::from_fn(|k| add(rest[k], self.particles[slots[k]].displacement));
        (rest, now)
    }

    /// Gradients of the corners' shape functions.
    fn shape_gradients(&self, body: usize) -> [V; 8] {
        let solid = &self.bodies[body];
        std::array::from_fn(|slot| {
            (0..3).fold([0.0; 3], |sum, d| {
                let sign = if slot >> d & 1 == 1 { 0.25 } else { -0.25 };
                add(sum, times(solid.axes[d], sign / solid.cell[d]))
            })
        })
    }

    fn load(&mut self, e: usize) {
        let body = self.elements[e].body;
        let (rest, now) = self.points(e);
        let slots = self.slots(e);
        let gradients = self.shape_gradients(body);
        let solid = &self.bodies[body];
        let method = self.method;
        let gradient = |y: &[V; 9]| {
            matrix(|i, j| (0..8).map(|slot| y[slot][i] * gradients[slot][j]).sum::<f64>())
        };
        let f = plus(&ONE, 1.0, &plus(&gradient(&now), -1.0, &gradient(&rest)));
        let jacobian = determinant(&f);
        let q = jacobian.max(1e-3).powf(-2.0 / 3.0);
        let c = product(&transposed(&f), &f);
        let faces = faces();
        let volumes: Vec<f64> = faces.iter().map(|&face| pyramid(&now, face)).collect();
        let references: Vec<f64> = faces.iter().map(|&face| pyramid(&rest, face)).collect();
        let opening: Vec<f64> = (0..6).map(|k| volumes[k] / references[k] - 1.0).collect();
        let volume: f64 = volumes.iter().sum();
        let areas: Vec<V> = faces
            .iter()
            .map(|face| {
                let [a, b, c, d] = face.map(|k| now[k]);
                times(cross(sub(c, a), sub(d, b)), 0.5)
            })
            .collect();
        let widest_face = areas.iter().map(|&area| norm(area)).fold(0.0, f64::max);
        let warmth: Vec<f64> = slots.iter().map(|&i| self.particles[i].theta).collect();
        let theta = 0.5 * warmth[8] + warmth[..8].iter().sum::<f64>() / 16.0;
        let stretch = q * trace(&c) / 3.0 * q.max(1.0);

        // Failure (47), and the end of an element as a volume.
        let element = &mut self.elements[e];
        let failure = &solid.material.failure;
        let smallest = opening.iter().copied().fold(f64::INFINITY, f64::min);
        let widest = opening.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let crushed = smallest < 0.2 - 1.0 || jacobian < failure.compression;
        let spent = failure.plastic_strain.is_some_and(|limit| element.strain > limit)
            || failure.melt.is_some_and(|limit| theta > limit);
        let pull = (1.0 - element.damage) * solid.bulk * widest;
        let heat =
            (theta - solid.theta_0).max(0.0) * solid.gamma * solid.material.density * solid.c_v;
        let pulled = method.spall && failure.spall.is_some_and(|limit| pull - heat > limit);
        element.failed |= spent || crushed || pulled;
        let thinnest = if element.failed { 0.35 } else { 0.2 };
        let flat = volume < widest_face * thinnest * solid.edge;
        element.dying = crushed || flat || stretch > 16.0 || element.failed && jacobian > 1.2;
        element.failed |= element.dying;

        let mut freed = 0.0;
        if element.failed {
            let step = match method.release {
                Release::Steps(n) => 1.0 / n,
                Release::Crossings(n) => self.dt * solid.fast / (n * solid.edge),
            };
            let before = element.damage;
            element.damage = if element.dying { 1.0 } else { (before + step).min(1.0) };
            let lost = (255.0 * element.damage) as u16 - (255.0 * before) as u16;
            for (slot, &i) in slots.iter().enumerate() {
                self.particles[i].lost += if slot == 8 { 8 * lost } else { lost };
            }
            let whole = 1.0 - before;
            let elastic = if whole > 0.0 && solid.mu > 0.0 {
                scaled(&element.stress, 0.5 / (whole * solid.mu))
            } else {
                NOTHING
            };
            let shear = solid.mu * contract(&elastic, &elastic) * solid.volume;
            let tension: f64 = (0..6)
                .map(|k| 0.5 * solid.bulk * references[k] * opening[k].max(0.0).powi(2))
                .sum();
            freed += (shear + tension) * (element.damage - before);
            element.stress = scaled(&element.stress, (1.0 - element.damage) / whole.max(1e-300));
        }
        let intact = 1.0 - element.damage;
        let outer = |v: V| matrix(|i, j| v[i] * v[j]);
        let mut forces = [[0.0; 3]; 9];
        let mut shear = NOTHING;
        if solid.mu > 0.0 {
            let strain = scaled(&plus(&scaled(&c, q), -1.0, &ONE), 0.5);
            let (old, from) = (element.stress, element.plastic);
            let modulus = 2.0 * intact * solid.mu;
            flow(element, solid, &strain, (modulus, intact, theta));
            element.stress = scaled(&plus(&strain, -1.0, &element.plastic), modulus);
            let flowed = plus(&element.plastic, -1.0, &from);
            freed += solid.volume * contract(&plus(&old, 1.0, &element.stress), &flowed) * 0.5;
            let spin = contract(&element.stress, &c) / (3.0 * jacobian);
            element.piola = scaled(&plus(&product(&f, &element.stress), -spin, &cofactors(&f)), q);
            for slot in 0..8 {
                let pull: V = std::array::from_fn(|d| dot(element.piola[d], gradients[slot]));
                forces[slot] = sub(forces[slot], times(pull, solid.volume));
            }
            let planes = 32.0 / 3.0 * intact * solid.mu / solid.material.density;
            let planes = q * q * planes / solid.edge.powi(2);
            let change = (q * q * contract(&c, &c) - 3.0).max(0.0) * 2.0 / 9.0 * intact * solid.mu
                / solid.material.density
                / volume.powi(2);
            shear = scaled(&product(&f, &transposed(&f)), planes);
            for area in &areas {
                shear = plus(&shear, 4.0 * change, &outer(*area));
            }
        }
        let mut heat: [f64; 9] = [freed / 16.0; 9];
        heat[8] = 0.5 * freed;

        // Tension (25) and pressure of the pyramids.
        let mut growth = [0.0; 9];
        for (k, &face) in faces.iter().enumerate() {
            element.tension[k] = intact * solid.bulk * opening[k].max(0.0);
            let weights = weights(face, method.balance);
            let mut push = -element.tension[k];
            for slot in 0..9 {
                let p = &self.particles[slots[slot]];
                push += weights[slot] * p.pressure * p.mass / (p.rho_now * p.rho_now) * p.dilate;
                growth[slot] += weights[slot] * (volumes[k] - references[k]);
            }
            let slopes = pyramid_gradient(&now, face);
            let rate: f64 =
                (0..9).map(|slot| dot(slopes[slot], self.particles[slots[slot]].v)).sum();
            for slot in 0..9 {
                forces[slot] = add(forces[slot], times(slopes[slot], push));
                if self.dt == 0.0 {
                    self.particles[slots[slot]].growth_rate_before += weights[slot] * rate;
                }
            }
        }
        let fastest = slots.iter().map(|&i| self.particles[i].sound).fold(0.0, f64::max);
        let sum = areas.iter().fold(scaled(&ONE, 0.0), |sum, &area| plus(&sum, 1.0, &outer(area)));
        let mut squares = scaled(&sum, 2.0 * (fastest / volume).powi(2));
        let bare = self.elements[e].beyond.iter().any(Option::is_none);
        let surface = if bare { trace(&squares) } else { 0.0 };
        squares = plus(&plus(&squares, surface, &ONE), 1.0, &shear);
        if opening.iter().any(|&open| open > 0.0) {
            let stiff = intact * solid.bulk / solid.material.density / solid.volume.powi(2);
            squares = plus(&squares, 4.0 * stiff, &sum);
        }

        // Limited viscosity, the heat flux in shocks, and that of heat that alternates.
        let corners = warmth[..8].iter().copied();
        let spread = corners.clone().fold(f64::MIN, f64::max) - corners.fold(f64::MAX, f64::min);
        let off = (warmth[8] - warmth[..8].iter().sum::<f64>() / 8.0).abs();
        let alternating = if off > spread { (off - spread) / off } else { 0.0 };
        let area = 0.75 * solid.volume.powf(2.0 / 3.0);
        let mut ways = scaled(&ONE, 0.0);
        let (mut all, mut most) = (ways, 0.0f64);
        let bonds: [f64; 8] = std::array::from_fn(|slot| {
            let [n, x, opposite] = [slot, 8, 7 - slot].map(|k| &self.particles[slots[k]]);
            let apart = sub(now[slot], now[8]);
            let along = times(apart, 1.0 / norm(apart));
            let own = dot(along, sub(x.v, n.v));
            let before = dot(along, sub(opposite.v, x.v));
            let beyond = self.elements[e].beyond[slot].filter(|&b| self.elements[b].live);
            let beyond = beyond
                .map_or(0.0, |b| dot(along, sub(n.v, self.particles[self.elements[b].centre].v)));
            let mean = method.limiter * before * beyond / ((before + beyond) * own);
            let same = before * own > 0.0 && beyond * own > 0.0;
            let rings = before * own < 0.0 && beyond * own < 0.0;
            let jump = match (own > 0.0, same, rings) {
                (true, true, _) => own * (1.0 - mean.min(1.0)),
                (true, false, _) => own,
                (false, _, true) => own * (-4.0 * mean).min(1.0),
                (false, _, false) => 0.0,
            };
            let sound = 0.5 * (n.sound + x.sound);
            let rho = 0.5 * (n.rho_now + x.rho_now);
            let nu = rho
                * area
                * if jump > 0.0 {
                    let steep = method.visc_quad * solid.s * jump;
                    steep + steep.hypot(method.visc_linear * sound)
                } else {
                    method.visc_expansion * sound
                };
            if jump.abs() > 1e-9 * sound {
                ways = plus(&ways, nu, &outer(along));
                most = most.max(nu);
            }
            all = plus(&all, 1.0, &outer(along));
            forces[slot] = add(forces[slot], times(along, nu * jump));
            forces[8] = sub(forces[8], times(along, nu * jump));
            let conducts = |speed| method.heat_coeff * rho * area * speed * self.dt;
            let most = solid.material.density * solid.volume / 192.0;
            let flux = conducts(jump.max(0.0)) + conducts(0.02 * sound * alternating).min(most);
            let flux = flux * solid.c_v * (n.theta - x.theta);
            heat[slot] -= flux;
            heat[8] += flux;
            nu * jump / norm(apart)
        });
        self.elements[e].bonds = bonds;
        let mass = 0.5 * solid.material.density * solid.volume;
        let missing = self.elements[e].beyond.iter().filter(|b| b.is_none()).count();
        let corner = if missing > 4 { 4.0 * most } else { most };
        let mut damping = scaled(&plus(&ways, corner, &all), 1.0 / mass);
        let weights = self.hourglass_weights(&now, body);
        let whole = self.drag(e);
        let drag = whole / lighter(&weights);
        let held = 2.0 * whole / mass;
        damping = plus(&damping, held, &ONE);
        for weights in weights {
            let rate = amplitude(&weights, |slot| self.particles[slots[slot]].v);
            for slot in 0..8 {
                forces[slot] = sub(forces[slot], times(rate, drag * weights[slot]));
            }
        }
        let alone = 0.5 * largest(&damping);
        let half = 0.75 * alone;
        let rate = 0.5 * (half + (half * half + largest(&squares)).sqrt());
        let slack = plus(&scaled(&squares, 0.25 / (rate * rate)), 0.375 / rate, &damping);
        self.rate = self.rate.max(rate * largest(&slack).sqrt()).max(alone);
        for slot in 0..9 {
            let p = &mut self.particles[slots[slot]];
            p.force = add(p.force, forces[slot]);
            p.heat += heat[slot];
            p.growth += growth[slot];
        }
    }

    /// Contacts, Eqs. (35)-(36), (78) and their viscosity.
    fn touch(&mut self) {
        self.contacts.clear();
        let positions: Vec<V> = (0..self.particles.len()).map(|i| self.position(i)).collect();
        let reach = self.method.contact_reach;
        for i in 0..self.particles.len() {
            for j in 0..i {
                let (a, b) = (&self.particles[i], &self.particles[j]);
                let widest = reach * self.bodies[a.body].length.max(self.bodies[b.body].length);
                let r = sub(positions[i], positions[j]);
                if r.iter().any(|r| r.abs() >= widest) || dot(r, r) >= widest * widest {
                    continue;
                }
                if (a.exposed || b.exposed) && self.strangers(i, j) {
                    self.contact([i, j], r);
                }
            }
        }
        self.touches += self.contacts.len();
    }

    /// Whether particles meet through contact alone.
    fn strangers(&self, i: usize, j: usize) -> bool {
        let (a, b) = (&self.particles[i], &self.particles[j]);
        if a.body != b.body {
            // Live surfaces keep others off.
            return a.live == 0 && b.live == 0;
        }
        let span = (0..3).map(|d| (a.place[d] - b.place[d]).abs()).max().unwrap_or(0);
        let broken = a.live < a.round || b.live < b.round;
        let share = |e: &Element| {
            let has = |i: usize| e.centre == i || e.corners.contains(&i);
            e.live && has(i) && has(j)
        };
        (span > 12 || broken) && (span > 2 || !self.elements.iter().any(share))
    }

    fn contact(&mut self, pair: [usize; 2], r: V) {
        let p = pair.map(|i| self.particles[i]);
        let solid = p.map(|p| &self.bodies[p.body]);
        let distance = norm(r);
        let row = [0, 1].map(|k| {
            let other = 1 - k;
            let zeta = distance / solid[other].length;
            let ratio = (p[other].rho_now / solid[other].material.density).cbrt();
            if zeta >= self.method.contact_reach
                || zeta * ratio >= 1.0 + self.method.contact_tolerance
            {
                return 0.0;
            }
            let zeta = zeta.max(0.8 / ratio);
            0.375 * solid[k].material.density / (zeta.powi(5) * solid[other].length.powi(2))
        });
        let near = distance < solid[0].length.max(solid[1].length);
        if row == [0.0; 2] && !near {
            return;
        }
        let push = [0, 1].map(|k| row[k] * p[k].mass * p[k].pressure / p[k].rho_now.powi(2));
        let approach = -dot(r, sub(self.velocity(pair[0]), self.velocity(pair[1]))) / distance;
        let (mut drag, mut nu) = (0.0, 0.0);
        if near && approach > 0.0 {
            let impedance = [0, 1].map(|k| {
                let volume = p[k].mass / solid[k].material.density;
                solid[k].material.density * p[k].sound * volume.powf(2.0 / 3.0)
            });
            let sound = 0.5 * (p[0].sound + p[1].sound);
            let slope = 0.5 * (solid[0].s + solid[1].s);
            let steep = self.method.visc_quad * slope * approach / sound;
            nu = 0.5
                * (impedance[0] + impedance[1])
                * (steep + steep.hypot(self.method.visc_linear));
            drag = nu * approach / distance;
        }
        let force = times(r, push[0] + push[1] + drag);
        for (k, i) in pair.into_iter().enumerate() {
            let p = &mut self.particles[i];
            p.touched = true;
            p.damped += nu / p.mass;
            p.force = if k == 0 { add(p.force, force) } else { sub(p.force, force) };
        }
        self.contacts.push(Contact { pair, r, row, push, drag });
    }

    /// Takes back what contacts damp particles with beyond what stops pairs, and nine tenths of what stops a particle.
    fn slacken(&mut self) {
        if self.dt == 0.0 {
            let rates = self.particles.iter().map(|p| p.damped);
            self.rate = self.rate.max(rates.fold(0.0, f64::max));
            return;
        }
        let longest = 0.5 * (self.dt + 1.05 * self.free);
        let contacts: Vec<Contact> = self.contacts.drain(..).collect();
        let masses = |c: &Contact| c.pair.map(|i| self.particles[i].mass);
        let coefficient = |c: &Contact| {
            let [i, j] = c.pair;
            let closing = -dot(c.r, sub(self.velocity(i), self.velocity(j)));
            if c.drag > 0.0 { c.drag * dot(c.r, c.r) / closing } else { 0.0 }
        };
        let alone = |c: &Contact| {
            let whole: f64 = masses(c).map(|m| coefficient(c) / m).iter().sum();
            if whole * longest > 1.0 { 1.0 / (whole * longest) } else { 1.0 }
        };
        let mut damped = vec![0.0; self.particles.len()];
        for c in &contacts {
            for (i, m) in c.pair.into_iter().zip(masses(c)) {
                damped[i] += alone(c) * coefficient(c) / m;
            }
        }
        let parts: Vec<f64> = contacts
            .iter()
            .map(|c| {
                let most = c.pair.map(|i| damped[i]).into_iter().fold(0.0, f64::max) * longest;
                alone(c) * if most > 0.9 { 0.9 / most } else { 1.0 }
            })
            .collect();
        for (mut contact, part) in contacts.into_iter().zip(parts) {
            let force = times(contact.r, contact.drag * (1.0 - part));
            contact.drag *= part;
            self.slackened += usize::from(part < 1.0);
            let [i, j] = contact.pair;
            self.particles[i].force = sub(self.particles[i].force, force);
            self.particles[j].force = add(self.particles[j].force, force);
            self.contacts.push(contact);
        }
    }

    /// Corners of the faces that live elements of a body do not share, and their elements.
    fn surface(&self, body: usize) -> Vec<(usize, [usize; 4])> {
        let live = |e: &&Element| e.live && e.body == body;
        let mut all = Vec::new();
        for (k, e) in self.elements.iter().enumerate().filter(|(_, e)| live(e)) {
            for face in faces() {
                let face = face.map(|slot| e.corners[slot]);
                let shared = self.elements.iter().filter(live).any(|other| {
                    other.centre != e.centre && face.iter().all(|i| other.corners.contains(i))
                });
                if !shared {
                    all.push((k, face));
                }
            }
        }
        all
    }

    /// Nearest point of a bilinear face: one inside, where Newton's iteration finds some, or of an edge.
    fn nearest(&self, x: V, face: [usize; 4]) -> ([f64; 4], V) {
        let corners = face.map(|i| self.position(i));
        let [a, b, c, d] = corners;
        let twist = sub(sub(c, d), sub(b, a));
        let mut candidates = Vec::new();
        for start in 0..9 {
            let (mut u, mut v) =
                (0.1 + 0.4 * f64::from(start % 3), 0.1 + 0.4 * f64::from(start / 3));
            // The distance does not tell a point that is still 1e-8 of a side away: only the iteration does,
            // which from some starts wanders before it finds one.
            let mut step = f64::INFINITY;
            for _ in 0..40 {
                let (p, q) = (add(sub(b, a), times(twist, v)), add(sub(d, a), times(twist, u)));
                let r = sub(sub(x, a), add(times(sub(b, a), u), times(q, v)));
                let mixed = dot(p, q) - dot(r, twist);
                let whole = dot(p, p) * dot(q, q) - mixed * mixed;
                let (along, across) = (dot(r, p), dot(r, q));
                let by = (along * dot(q, q) - across * mixed) / whole;
                let other = (across * dot(p, p) - along * mixed) / whole;
                (u, v, step) = (u + by, v + other, by.abs() + other.abs());
            }
            if step < 1e-12 && (0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v) {
                candidates.push(bilinear([u, v]));
            }
        }
        for k in 0..4 {
            let (from, to) = (corners[k], corners[(k + 1) % 4]);
            let along = sub(to, from);
            let t = (dot(sub(x, from), along) / dot(along, along)).clamp(0.0, 1.0);
            let mut shares = [0.0; 4];
            (shares[k], shares[(k + 1) % 4]) = (1.0 - t, t);
            candidates.push(shares);
        }
        let away = |shares: &[f64; 4]| {
            sub(x, (0..4).fold([0.0; 3], |sum, k| add(sum, times(corners[k], shares[k]))))
        };
        let least = |a: &[f64; 4], b: &[f64; 4]| norm(away(a)).total_cmp(&norm(away(b)));
        let best = candidates.into_iter().min_by(least).expect("edges at least");
        (best, away(&best))
    }

    /// Area of a point of a face with its gradients, and the normal there.
    fn part(&self, face: [usize; 4], [u, v]: [f64; 2]) -> (f64, Vec<(usize, V)>, V) {
        let corners = face.map(|i| self.position(i));
        let by_u = [v - 1.0, 1.0 - v, v, -v];
        let by_v = [u - 1.0, -u, u, 1.0 - u];
        let sum = |by: [f64; 4]| (0..4).fold([0.0; 3], |s, k| add(s, times(corners[k], by[k])));
        let (along, across) = (sum(by_u), sum(by_v));
        let area = cross(along, across);
        let normal = times(area, 1.0 / norm(area));
        let slopes = (0..4).map(|k| {
            let slope =
                add(times(cross(across, normal), by_u[k]), times(cross(normal, along), by_v[k]));
            (face[k], times(slope, 0.25))
        });
        (0.25 * norm(area), slopes.collect(), normal)
    }

    /// Where a point with these shares of particles is.
    fn place(&self, shares: &[(usize, f64)]) -> V {
        shares.iter().fold([0.0; 3], |x, &(i, share)| add(x, times(self.position(i), share)))
    }

    fn spring_on(&self, own: &[(usize, f64)], element: usize, face: [usize; 4]) -> Spring {
        let x = self.place(own);
        let p = &self.particles[own[0].0];
        let (shares, r) = self.nearest(x, face);
        let (first, other) = (&self.bodies[p.body], &self.bodies[self.elements[element].body]);
        let modulus = |solid: &Solid| solid.material.density * solid.fast * solid.fast;
        let series = 1.0 / (1.0 / modulus(first) + 1.0 / modulus(other));
        Spring {
            own: own.to_vec(),
            element,
            area: 4.0 * p.mass / first.material.density / first.edge,
            slopes: Vec::new(),
            face: std::array::from_fn(|k| (face[k], shares[k])),
            way: times(r, 1.0 / norm(r)),
            z: norm(r),
            stand: 0.0,
            stiffness: 0.5 * first.edge * series,
            force: 0.0,
            drag: 0.0,
        }
    }

    /// The spring of a point on the faces of a body round its node nearest to a particle; and where it ends
    /// on their rim, round the corner there as well.
    fn nearest_spring(
        &self,
        own: &[(usize, f64)],
        particle: usize,
        surface: &[(usize, [usize; 4])],
    ) -> Option<Spring> {
        let x = self.position(particle);
        let away = |&node: &usize| norm(sub(self.position(node), x));
        let nodes = surface.iter().flat_map(|(_, face)| face).copied();
        let mut node = nodes.min_by(|a, b| away(a).total_cmp(&away(b)))?;
        let mut best: Option<Spring> = None;
        loop {
            let round = surface.iter().filter(|(_, face)| face.contains(&node));
            let all = round.map(|&(e, face)| self.spring_on(own, e, face));
            let near = all.min_by(|a, b| a.z.total_cmp(&b.z))?;
            if best.as_ref().is_some_and(|best| near.z >= best.z) {
                return best;
            }
            let inside = near.face.iter().any(|&(i, share)| i == node && share > 0.0);
            let next = near.face.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
            node = next.0;
            best = Some(near);
            if inside {
                return best;
            }
        }
    }

    fn find_springs(&mut self, old: &[Spring]) {
        let surfaces: Vec<_> = (0..self.bodies.len()).map(|body| self.surface(body)).collect();
        let mut found = Vec::new();
        for body in 0..self.bodies.len() {
            for other in (0..self.bodies.len()).filter(|&other| other != body) {
                let loose = (0..self.particles.len()).filter(|&i| {
                    let p = &self.particles[i];
                    p.body == body && p.exposed && p.live == 0
                });
                found.extend(
                    loose.filter_map(|i| self.nearest_spring(&[(i, 1.0)], i, &surfaces[other])),
                );
                // Nodes of rims that meet rims, or are pressed since they did.
                let mut nodes: Vec<usize> =
                    surfaces[body].iter().flat_map(|(_, face)| *face).collect();
                nodes.sort_unstable();
                nodes.dedup();
                for i in nodes.into_iter().filter(|&i| self.particles[i].live <= 2) {
                    let Some(spring) = self.nearest_spring(&[(i, 1.0)], i, &surfaces[other]) else {
                        continue;
                    };
                    let pressed = old.iter().any(|old| same(old, &spring) && old.z < 1.0);
                    let end =
                        spring.face.iter().max_by(|a, b| a.1.total_cmp(&b.1)).map(|end| end.0);
                    let rim = spring.face.iter().any(|&(_, share)| share == 0.0);
                    let oblique = |body: usize, node: usize| {
                        let round = surfaces[body].iter().filter(|(_, face)| face.contains(&node));
                        let mut cosines = round
                            .map(|&(_, face)| dot(self.part(face, [0.5; 2]).2, spring.way).abs());
                        cosines.all(|cosine| cosine <= 0.8)
                    };
                    if pressed
                        || rim && oblique(body, i) && end.is_some_and(|end| oblique(other, end))
                    {
                        found.push(spring);
                    }
                }
                for &(_, face) in &surfaces[body] {
                    for (k, at) in POINTS.into_iter().enumerate() {
                        let shares = bilinear(at);
                        let own: [(usize, f64); 4] = std::array::from_fn(|j| (face[j], shares[j]));
                        let Some(mut spring) = self.nearest_spring(&own, face[k], &surfaces[other])
                        else {
                            continue;
                        };
                        let (area, slopes, normal) = self.part(face, at);
                        (spring.area, spring.slopes) = (area, slopes);
                        if dot(normal, spring.way).abs() > 0.5 {
                            found.push(spring);
                        }
                    }
                }
            }
        }
        for mut spring in found {
            let edges = [self.particles[spring.own[0].0].body, self.elements[spring.element].body]
                .map(|body| self.bodies[body].edge);
            let full = 0.25 * (edges[0] + edges[1]);
            let before = old.iter().find(|old| same(old, &spring)).map_or(0.0, |old| old.stand);
            let grown = if before < 0.25 * full { spring.z } else { before.max(spring.z) };
            spring.stand = grown.min(full);
            if spring.stand >= 0.25 * full {
                spring.z /= spring.stand;
                self.springs.push(spring);
            }
        }
    }

    /// Springs that slide go on; others begin where they are, and what they had is returned.
    fn renew_springs(&mut self) -> Vec<(usize, f64)> {
        let old = std::mem::take(&mut self.springs);
        self.find_springs(&old);
        let mut heat = Vec::new();
        let mut slid = vec![false; self.springs.len()];
        for old in old {
            let mut was = self.spring_on(&old.own, old.element, old.face.map(|(i, _)| i));
            let now = self.springs.iter().position(|s| same(s, &old));
            let mut kept = 0.0;
            let moved = now.map(|k| (k, self.springs[k].z * self.springs[k].stand / was.z));
            if let Some((k, moved)) = moved.filter(|(_, moved)| *moved >= 0.8) {
                slid[k] = true;
                if moved < 1.001 {
                    continue;
                }
                // Its own face has died.
                kept = old.area * self.springs[k].energy();
            }
            if old.z < 1.0 {
                (was.stand, was.area) = (old.stand, old.area);
                was.z /= was.stand;
                let energy = (was.area * was.energy() - kept).max(0.0);
                let parts = was.parts().into_iter();
                heat.extend(parts.map(|(i, share)| (i, 0.5 * share.abs() * energy)));
            }
        }
        for (s, _) in self.springs.iter_mut().zip(slid).filter(|(_, slid)| !slid) {
            let distance = s.z * s.stand;
            s.stand = s.stand.min(distance);
            s.z = distance / s.stand;
        }
        heat
    }

    fn spring(&mut self) {
        for k in 0..self.springs.len() {
            let s = &self.springs[k];
            let bodies = [self.particles[s.own[0].0].body, self.elements[s.element].body];
            let edges = self.bodies[bodies[0]].edge + self.bodies[bodies[1]].edge;
            if s.stand < 0.0625 * edges {
                continue;
            }
            let p = |i: usize| &self.particles[i];
            let parts = s.parts();
            let velocity = parts.iter().map(|&(i, share)| times(self.velocity(i), share));
            let approach = -dot(s.way, velocity.fold([0.0; 3], add));
            self.rate = self.rate.max(approach / (0.4 * s.stand * s.z.max(0.2)));
            let solid = &self.bodies[bodies[0]];
            let inertia: f64 = if s.own.len() == 1 {
                parts.iter().map(|&(i, share)| share * share / p(i).mass).sum()
            } else {
                // Of the nodes of both flat surfaces, for the area of one point of four, or of a node where that has less.
                let lightness = bodies.map(|b| {
                    let own = &self.bodies[b];
                    let edge = own.edge.min(solid.edge);
                    4.0 / (own.material.density * own.edge) * 4.0 / (edge * edge)
                });
                lightness[0] + lightness[1]
            };
            if s.z * s.stand < s.stand + approach * solid.edge / solid.fast {
                let stiff = s.area * s.stiffness / s.z.clamp(0.2, 1.0).powi(3);
                self.rate = self.rate.max((stiff * inertia).sqrt() / s.stand);
            }
            // What is met within two steps slows them down before.
            let ahead = if self.dt > 0.0 { 2.0 * self.free } else { solid.edge / solid.fast };
            let mut drag = 0.0;
            if approach > 0.0 && s.stand * (s.z - 1.0) < approach * ahead {
                let mean = |pick: &dyn Fn(&Particle) -> f64| -> f64 {
                    parts.iter().map(|&(i, share)| 0.5 * share.abs() * pick(p(i))).sum()
                };
                let impedance = 0.5 * s.area * mean(&|p| p.rho_now * p.sound);
                let slope = 0.5 * (solid.s + self.bodies[bodies[1]].s);
                let steep = self.method.visc_quad * slope * approach / mean(&|p| p.sound);
                let nu = impedance * (steep + steep.hypot(self.method.visc_linear));
                self.rate = self.rate.max(2.0 * nu * inertia);
                drag = nu * approach;
            }
            if s.z >= 1.0 {
                continue;
            }
            self.touches += 1;
            let deep = s.z.max(0.2);
            let force = s.area * s.stiffness * 0.5 * (1.0 / (deep * deep) - 1.0) / s.stand;
            let way = s.way;
            for (i, share) in parts {
                let p = &mut self.particles[i];
                p.touched = true;
                p.force = add(p.force, times(way, share * (force + drag)));
            }
            let tension = self.springs[k].energy();
            for (i, slope) in &self.springs[k].slopes {
                let p = &mut self.particles[*i];
                p.force = sub(p.force, times(*slope, tension));
            }
            (self.springs[k].force, self.springs[k].drag) = (force, drag);
        }
    }

    fn elect(&mut self) -> f64 {
        let mut dt = self.allowed[0];
        for solid in &self.bodies {
            dt = dt.min(solid.edge / (3.0 * solid.fast));
        }
        dt = (self.method.cfl * dt.min(1.0 / self.rate)).min(self.allowed[1]);
        // No bodies near each other by more than half a cell; in the first step, of bodies that do not turn, as if they
        // touched (decision 0022).
        let far = if self.dt > 0.0 { 0.5 } else { 0.08 };
        for (k, one) in self.bodies.iter().enumerate() {
            for other in &self.bodies[..k] {
                let apart = norm(sub(one.velocity, other.velocity));
                dt = dt.min(far * one.edge.min(other.edge) / apart);
            }
        }
        self.free = if self.dt > 0.0 { dt.min(1.05 * self.free) } else { dt };
        // So that the mean of two steps is a stable one, unless that takes less than half.
        let mean = 2.0 * self.free / self.method.cfl - self.dt;
        self.free.min(mean.max(0.5 * self.free))
    }

    /// Coefficient of the drag against the hourglass modes of an element.
    fn drag(&self, e: usize) -> f64 {
        let element = &self.elements[e];
        let solid = &self.bodies[element.body];
        let [plain, strong] = [self.method.visc_hourglass, self.method.visc_hourglass_strong];
        let lost = if solid.mu > 0.0 { element.damage } else { 1.0 };
        let kappa = if element.dying { 0.0 } else { lost * (plain - strong) + strong };
        let sound = self.particles[element.centre].sound;
        kappa * solid.material.density * sound * solid.volume.powf(2.0 / 3.0)
    }

    /// Weights of the corners in the four hourglass modes, such that no linear field has an amplitude.
    fn hourglass_weights(&self, now: &[V; 9], body: usize) -> Vec<[f64; 8]> {
        let reference = self.shape_gradients(body);
        let f = matrix(|i, j| (0..8).map(|slot| now[slot][i] * reference[slot][j]).sum());
        let inverse = scaled(&transposed(&cofactors(&f)), 1.0 / determinant(&f));
        let present = reference.map(|b| {
            let row = |j: usize| (0..3).map(|k| b[k] * inverse[k][j]).sum::<f64>();
            [row(0), row(1), row(2)]
        });
        hourglass_modes()
            .into_iter()
            .map(|mode| {
                let warp = amplitude(&mode, |slot| now[slot]);
                std::array::from_fn(|slot| mode[slot] - dot(present[slot], warp))
            })
            .collect()
    }

    /// Rates over the mean velocity of the step.
    fn work(&mut self, kick: f64) {
        for e in 0..self.elements.len() {
            if !self.elements[e].live {
                continue;
            }
            let (_, now) = self.points(e);
            let slots = self.slots(e);
            let mean = slots.map(|i| self.particles[i].mean);
            let modes = self.hourglass_weights(&now, self.elements[e].body);
            let power: f64 = modes
                .iter()
                .map(|mode| {
                    let before = |p: &Particle| sub(times(p.mean, 2.0), p.v);
                    let made = amplitude(mode, |slot| before(&self.particles[slots[slot]]));
                    dot(made, amplitude(mode, |slot| mean[slot]))
                })
                .sum();
            let warmth = kick * self.drag(e) / lighter(&modes) * power;
            for (slot, &i) in slots.iter().enumerate() {
                self.particles[i].heat += if slot == 8 { 0.5 } else { 0.0625 } * warmth;
            }
            for face in faces() {
                let slopes = pyramid_gradient(&now, face);
                let rate: f64 = (0..9).map(|slot| dot(slopes[slot], mean[slot])).sum();
                let weights = weights(face, self.method.balance);
                for slot in 0..9 {
                    self.particles[slots[slot]].growth_rate += weights[slot] * rate;
                }
            }
            for slot in 0..8 {
                let r = sub(now[slot], now[8]);
                let closing = dot(r, sub(mean[8], mean[slot]));
                let half = 0.5 * self.elements[e].bonds[slot] * closing * kick;
                self.particles[slots[slot]].heat += half;
                self.particles[slots[8]].heat += half;
            }
        }
        for contact in &self.contacts {
            let mean = contact.pair.map(|i| {
                let p = &self.particles[i];
                add(p.mean, self.bodies[p.body].velocity)
            });
            let closing = -dot(contact.r, sub(mean[0], mean[1]));
            for k in 0..2 {
                let p = &mut self.particles[contact.pair[k]];
                p.contact_rate += contact.row[k] * closing;
                p.heat += kick * (contact.push[k] + 0.5 * contact.drag) * closing;
            }
        }
    }

    fn spring_work(&mut self, kick: f64) {
        for spring in &self.springs {
            let mean = |i: usize| {
                let p = &self.particles[i];
                add(p.mean, self.bodies[p.body].velocity)
            };
            let parts = spring.parts();
            let velocity = parts.iter().map(|&(i, share)| times(mean(i), share));
            let approach = -dot(spring.way, velocity.fold([0.0; 3], add));
            for (i, share) in parts {
                self.particles[i].heat += 0.5 * kick * share.abs() * spring.drag * approach;
            }
        }
    }

    /// Density, energy and position after a kick and a drift, and what follows from them.
    fn respond(&mut self, kick: f64, dt: f64) {
        self.allowed = [f64::INFINITY; 2];
        for p in &mut self.particles {
            let solid = &self.bodies[p.body];
            let rho_0 = solid.material.density;
            let pressure_work = p.pressure * p.mass / (p.rho_now * p.rho_now) * p.dilate;
            let mut rate = p.contact_rate - p.dilate * p.growth_rate;
            if p.live == 0 && !p.touched && p.pressure > 0.0 && p.rho_now > 0.8 * rho_0 {
                rate = -0.07 * p.sound / solid.length * p.rho_now;
            }
            let ahead = p.growth_rate - p.growth_rate_before;
            if kick > 0.0 {
                let gain = (p.heat - pressure_work * p.growth_rate * kick) / p.mass;
                p.u_rate = gain / kick;
                p.u += gain;
                p.rho_rate = rate;
                // Half a drift with the velocity before, half one with that after.
                let uneven = p.dilate * ahead * (dt - kick);
                p.rho = (p.rho + rate * kick - uneven).clamp(0.3 * rho_0, 10.0 * rho_0);
            }
            // Over the velocity of the drift.
            p.rho_rate -= p.dilate * ahead;
            p.u_rate -= pressure_work * ahead / p.mass;
            let growth = p.growth + (p.growth_rate + ahead) * dt;
            p.displacement = add(p.displacement, times(p.v, dt));
            (p.force, p.heat) = ([0.0; 3], 0.0);
            p.growth_before = p.growth;
            (p.growth, p.growth_rate, p.growth_rate_before) = (0.0, 0.0, 0.0);
            (p.contact_rate, p.damped) = (0.0, 0.0);

            let change = (0.5 * dt * p.rho_rate / p.rho).min(0.5);
            p.rho_now = (p.rho / (1.0 - change)).clamp(0.3 * rho_0, 10.0 * rho_0);
            let damage = f64::from(p.lost) / (255 * p.round) as f64;
            (p.pressure, p.sound, p.theta) =
                eos(solid, p.rho_now, p.u + 0.5 * dt * p.u_rate, damage);
            let reference = p.mass / rho_0;
            p.dilate = if p.live > 0 {
                let part = p.live as f64 / p.round as f64;
                p.rho_now / (reference + growth / part).max(0.1 * reference)
            } else {
                0.0
            };
            if p.touched || p.live < p.round {
                let crossing = (rho_0 / p.rho_now).min(1.0) / p.sound;
                self.allowed[0] = self.allowed[0].min(solid.edge * crossing / 3.0);
            }
            if p.pressure > 0.0 && p.rho_rate != 0.0 {
                self.allowed[1] = self.allowed[1].min(0.08 * p.rho_now / p.rho_rate.abs());
            }
            p.touched = false;
        }
        for solid in &mut self.bodies {
            solid.way = add(solid.way, times(solid.velocity, dt));
        }
    }

    /// Shares of the particles of an element in its growth, at the positions before the last drift.
    fn growth_before(&self, e: usize) -> [f64; 9] {
        let (rest, now) = self.points(e);
        let slots = self.slots(e);
        let then: [V; 9] =
            std::array::from_fn(|k| sub(now[k], times(self.particles[slots[k]].v, self.dt)));
        let mut growth = [0.0; 9];
        for face in faces() {
            let weights = weights(face, self.method.balance);
            let grown = pyramid(&then, face) - pyramid(&rest, face);
            growth.iter_mut().zip(weights).for_each(|(growth, weight)| *growth += weight * grown);
        }
        growth
    }

    fn bury(&mut self) {
        let before = self.deaths;
        for e in 0..self.elements.len() {
            let element = &mut self.elements[e];
            if !(element.live && element.dying) {
                continue;
            }
            element.live = false;
            self.deaths += 1;
            let lost = self.growth_before(e);
            for (i, lost) in self.slots(e).into_iter().zip(lost) {
                let p = &mut self.particles[i];
                p.live -= if i == self.elements[e].centre { 8 } else { 1 };
                p.growth_before -= lost;
                p.exposed = true;
            }
        }
        if self.deaths > before {
            for (i, energy) in self.renew_springs() {
                let p = &mut self.particles[i];
                p.u += energy / p.mass;
            }
        }
    }
}

/// Weights of the corners in the hourglass modes of a cube.
fn hourglass_modes() -> [[f64; 8]; 4] {
    let sign = |slot: usize, axis: usize| if slot >> axis & 1 == 1 { 1.0 } else { -1.0 };
    [&[0, 1][..], &[1, 2], &[2, 0], &[0, 1, 2]].map(|axes| {
        std::array::from_fn(|slot| {
            0.125 * axes.iter().map(|&axis| sign(slot, axis)).product::<f64>()
        })
    })
}

/// How much lighter hourglass modes with these weights are than those of a cube.
fn lighter(weights: &[[f64; 8]]) -> f64 {
    let undone = weights.iter().zip(hourglass_modes()).map(|(weights, mode)| {
        weights.iter().zip(mode).map(|(w, m)| (w - m) * (w - m)).sum::<f64>()
    });
    1.0 + 8.0 * undone.sum::<f64>()
}

/// Sum of a field of the corners with these weights.
fn amplitude(mode: &[f64; 8], v: impl Fn(usize) -> V) -> V {
    (0..8).fold([0.0; 3], |sum, slot| add(sum, times(v(slot), mode[slot])))
}

fn corners_of(centre: [i32; 3]) -> [[i32; 3]; 8] {
    std::array::from_fn(|slot| {
        std::array::from_fn(|d| centre[d] + if slot >> d & 1 == 1 { 1 } else { -1 })
    })
}

/// Pressure, sound speed and temperature.
fn eos(solid: &Solid, rho: f64, u: f64, damage: f64) -> (f64, f64, f64) {
    let rho_0 = solid.material.density;
    let eta = (1.0 - rho_0 / rho).max(0.0);
    let cap = 0.85 / solid.s;
    let cold = |eta: f64| {
        let shock = solid.bulk * eta / (1.0 - solid.s * eta).powi(2);
        let slope = solid.bulk * (1.0 + solid.s * eta) / (1.0 - solid.s * eta).powi(3);
        let release = 1.0 - 0.5 * solid.gamma * eta;
        (shock * release, slope * release - 0.5 * solid.gamma * shock)
    };
    let (p_cold, slope) = if rho < rho_0 {
        (solid.bulk * damage * (rho - rho_0) / rho_0, solid.bulk / rho_0)
    } else if eta < cap {
        let (p, by_eta) = cold(eta);
        // Exactly nothing at the reference density.
        (if rho == rho_0 { 0.0 } else { p }, by_eta * rho_0 / (rho * rho))
    } else {
        let last = rho_0 / (1.0 - cap);
        let (p, by_eta) = cold(cap);
        let slope = by_eta * rho_0 / (last * last);
        (p + slope * (rho - last), slope)
    };
    let product = solid.gamma * rho_0;
    let pressure = (p_cold + product * u).max(0.0);
    let squared = (slope + pressure * product / (rho * rho)).max(0.25 * solid.c0 * solid.c0);
    let eta = eta.min(cap);
    (pressure, squared.sqrt(), solid.theta_0 + (u / solid.c_v + isentrope(solid, eta)).max(0.0))
}

/// `theta_s - theta_0 - u_s / c_v` on the isentrope through the reference state: ten terms of
/// `theta_s = theta_0 exp(Gamma_o eta)` and of the solution of
/// `u' = c0^2 eta (1 - Gamma_o eta / 2) / (1 - s eta)^2 + Gamma_o u`.
fn isentrope(solid: &Solid, eta: f64) -> f64 {
    let (mut heating, mut energy, mut sum) = (solid.theta_0, 0.0, 0.0);
    for n in 1..=10 {
        let k = f64::from(n) - 1.0;
        heating *= solid.gamma / f64::from(n);
        let shock =
            k * solid.s.powf(k - 1.0) - 0.5 * solid.gamma * (k - 1.0) * solid.s.powf(k - 2.0);
        let pushed = if n > 1 { solid.c0 * solid.c0 * shock } else { 0.0 };
        energy = (pushed + solid.gamma * energy) / f64::from(n);
        sum += (heating - energy / solid.c_v) * eta.powi(n);
    }
    sum
}

/// Plastic flow of the von Mises reading until the effective stress lies on the yield surface.
fn flow(
    element: &mut Element,
    solid: &Solid,
    strain: &M,
    (modulus, intact, theta): (f64, f64, f64),
) {
    let Some(Flow::Hardening { y_0, kappa, alpha, eta, reference, melt }) =
        solid.material.strength.and_then(|s| s.flow)
    else {
        return;
    };
    let homologous = ((theta - reference) / (melt - reference)).clamp(0.0, 1.0);
    let soft = (1.0 - eta * homologous).max(0.0) * intact / 3f64.sqrt();
    let yield_stress = |eps: f64| soft * y_0 * (1.0 + kappa * eps).powf(alpha);
    let before = element.strain;
    // Where nothing is left to yield, the surface is a point, and the map only approaches it.
    for sweep in 0..20 {
        let stress = scaled(&plus(strain, -1.0, &element.plastic), modulus);
        let c = plus(&ONE, 2.0, &element.plastic);
        let both = symmetric_product(&c, &stress);
        let driver = plus(&both, -trace(&both) / 3.0, &ONE);
        let gap = size(&driver) - yield_stress(element.strain);
        if gap <= 0.0 && sweep == 0
            || gap.abs() <= 1e-10 * yield_stress(element.strain) + 1e-13 * modulus
        {
            return;
        }
        let direction = symmetric_product(&c, &driver);
        let normal = contract(&direction, &direction) / contract(&driver, &driver);
        let hardening =
            alpha * kappa * yield_stress(element.strain) / (1.0 + kappa * element.strain);
        let measure = 2.0 / 3f64.sqrt();
        let step = gap / (modulus * normal + hardening * measure);
        let flowed = plus(&c, 2.0 * step / size(&driver), &direction);
        let isochoric = scaled(&flowed, determinant(&flowed).powf(-1.0 / 3.0));
        element.plastic = scaled(&plus(&isochoric, -1.0, &ONE), 0.5);
        element.strain = (element.strain + step * measure).max(before);
    }
}
