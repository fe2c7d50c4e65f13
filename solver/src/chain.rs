//! Topology of one dimension: particles in a row, in the order of their positions.
//!
//! Invariant: the order never changes. Neighbours need no list, and a particle that passes another
//! is a numerical failure that the audit reports.

use crate::scene::{Body, Boundary, Interface, Scene};

/// Mirror images kept behind a wall where pairs beyond the nearest act.
const IMAGES: usize = 16;

/// Two particles seen from each other.
#[derive(Debug, Clone, Copy)]
pub struct Contact {
    /// Separation `r = |c_i - c_j|`, Eq. (13) in one dimension.
    pub r: f64,
    /// Contact length `2 beta h`, the mean of both particles' (decision 0002).
    pub length: f64,
    /// Contact coordinate `zeta = r / length`, Eq. (9) in one dimension.
    pub zeta: f64,
    /// Whether nothing lies between them and they touch: `W` of Eq. (35).
    pub nearest: bool,
    /// Whether they are also of one continuous medium, so that they can pull.
    pub bonded: bool,
    /// Whether they are of one continuous medium, near or far.
    pub joined: bool,
}

/// One particle of a pair.
#[derive(Debug, Clone, Copy)]
pub struct Side {
    /// Index in the chain, images included.
    pub index: usize,
    /// Mass `m`.
    pub m: f64,
    /// Contact length `2 beta h` of a pair of its kind.
    pub l: f64,
    /// Reference density `rho_o`.
    pub rho_0: f64,
    /// Index of its material.
    pub material: u16,
    /// Continuous medium that it belongs to.
    pub medium: u16,
    /// Density, where the scheme stores one.
    pub rho: f64,
    /// Internal energy per unit mass `u`.
    pub u: f64,
}

/// What all particles of a body share.
#[derive(Debug, Clone, Copy)]
struct BodyRow {
    rho_0: f64,
    /// Contact length `2 beta h`.
    l: f64,
    /// Initial density over the reference density.
    compression: f64,
    material: u16,
    /// Bodies that are joined are one medium.
    medium: u16,
}

/// Masses, sizes and bodies of the particles, mirror images included.
#[derive(Debug)]
pub struct Chain {
    m: Vec<f64>,
    body: Vec<u16>,
    rows: Vec<BodyRow>,
    walls: [Option<f64>; 2],
    first: usize,
    end: usize,
    longest: f64,
}

impl Chain {
    /// Chain of a valid scene and the initial positions. `far`: whether pairs beyond the nearest
    /// neighbours act.
    pub(crate) fn new(scene: &Scene, far: bool) -> (Self, Vec<f64>) {
        let n = scene.particles();
        let images = if far { IMAGES } else { 2 };
        let wall = |b| {
            if let Boundary::Mirror(x) = b { Some(x) } else { None }
        };
        let walls = [wall(scene.boundaries.left), wall(scene.boundaries.right)];
        // Two walls mirror each other's images; one alone has as many as there are particles.
        let images = if walls.iter().all(Option::is_some) { images } else { images.min(n) };
        let [before, behind] = walls.map(|w| if w.is_some() { images } else { 0 });

        let total = before + n + behind;
        let mut chain = Self {
            m: vec![0.0; total],
            body: vec![0; total],
            rows: Vec::with_capacity(scene.bodies.len()),
            walls,
            first: before,
            end: before + n,
            longest: 0.0,
        };
        let mut x = vec![0.0; total];
        let mut i = before;
        for (k, body) in scene.bodies.iter().enumerate() {
            chain.rows.push(chain.row(scene, k, body));
            let BodyRow { rho_0, l, .. } = chain.rows[k];
            chain.longest = chain.longest.max(l);
            let cell_mass = rho_0 * l;
            for p in 0..body.particles {
                let (position, share) = body.particle(p);
                x[i] = position;
                chain.m[i] = share * cell_mass;
                chain.body[i] = k as u16;
                i += 1;
            }
        }
        for (image, of) in chain.images().collect::<Vec<_>>() {
            chain.m[image] = chain.m[of];
            chain.body[image] = chain.body[of];
        }
        (chain, x)
    }

    fn row(&self, scene: &Scene, k: usize, body: &Body) -> BodyRow {
        // Validation guarantees that the material exists.
        let material = scene.material_index(&body.material).unwrap_or(0);
        let medium = match (k, body.interface) {
            (0, _) => 0,
            (_, Interface::Joined) => self.rows[k - 1].medium,
            (_, Interface::Contact) => self.rows[k - 1].medium + 1,
        };
        let rho_0 = scene.materials[material].density;
        let l = body.compression * body.cell();
        let compression = body.compression;
        BodyRow { rho_0, l, compression, material: material as u16, medium }
    }

    /// Number of particles, images included.
    #[must_use]
    pub fn len(&self) -> usize {
        self.m.len()
    }

    /// Whether the chain has no particles; never, for a valid scene.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.m.is_empty()
    }

    /// Range of the particles proper.
    #[must_use]
    pub fn real(&self) -> std::ops::Range<usize> {
        self.first..self.end
    }

    /// Largest contact length.
    #[must_use]
    pub fn longest(&self) -> f64 {
        self.longest
    }

    /// Mass of particle `i`.
    #[inline(always)]
    #[must_use]
    pub fn mass(&self, i: usize) -> f64 {
        self.m[i]
    }

    /// Masses of all particles.
    #[must_use]
    pub fn masses(&self) -> &[f64] {
        &self.m
    }

    /// Reference density of particle `i`.
    #[inline(always)]
    #[must_use]
    pub fn rho_0(&self, i: usize) -> f64 {
        self.rows[usize::from(self.body[i])].rho_0
    }

    /// Initial density of particle `i` over its reference density.
    #[must_use]
    pub fn compression(&self, i: usize) -> f64 {
        self.rows[usize::from(self.body[i])].compression
    }

    /// Whether there would be further images beyond the last on the left and on the right.
    #[must_use]
    pub fn unending(&self) -> [bool; 2] {
        let [left, right] = self.walls.map(|wall| wall.is_some());
        let kept = self.first.max(self.len() - self.end);
        let more = left && right || kept < self.end - self.first;
        [left && more, right && more]
    }

    /// Whether there are images on the left and on the right.
    #[must_use]
    pub fn walled(&self) -> [bool; 2] {
        self.walls.map(|wall| wall.is_some())
    }

    /// Index of the material of particle `i`.
    #[inline(always)]
    #[must_use]
    pub fn material(&self, i: usize) -> usize {
        usize::from(self.rows[usize::from(self.body[i])].material)
    }

    /// Index of the body of particle `i`.
    #[must_use]
    pub fn body(&self, i: usize) -> usize {
        usize::from(self.body[i])
    }

    /// Whether all particles of a range are of one body.
    #[inline(always)]
    #[must_use]
    pub fn one_body(&self, range: std::ops::Range<usize>) -> bool {
        let bodies = &self.body[range];
        bodies.iter().fold(true, |same, &body| same & (body == bodies[0]))
    }

    /// Whether two particles belong to one continuous medium.
    #[must_use]
    pub fn joined(&self, a: usize, b: usize) -> bool {
        let medium = |i: usize| self.rows[usize::from(self.body[i])].medium;
        medium(a) == medium(b)
    }

    /// Particle `i` as one side of a pair.
    #[inline(always)]
    #[must_use]
    pub fn side(&self, i: usize, rho: f64, u: f64) -> Side {
        let BodyRow { rho_0, l, material, medium, .. } = self.rows[usize::from(self.body[i])];
        Side { index: i, m: self.m[i], l, rho_0, material, medium, rho, u }
    }

    /// A particle and one on its right at the distance `r`.
    #[inline(always)]
    #[must_use]
    pub fn contact(&self, left: &Side, right: &Side, r: f64) -> Contact {
        let length = 0.5 * (left.l + right.l);
        let zeta = r / length;
        let neighbours = right.index == left.index + 1;
        let joined = left.medium == right.medium;
        let bonded = neighbours && joined;
        let nearest = bonded || (neighbours && zeta < 1.0);
        Contact { r, length, zeta, nearest, bonded, joined }
    }

    /// The pair of particle `a` and a particle `b` on its right, at these positions.
    #[must_use]
    pub fn contact_at(&self, x: &[f64], a: usize, b: usize) -> Contact {
        self.contact(&self.side(a, 0.0, 0.0), &self.side(b, 0.0, 0.0), x[b] - x[a])
    }

    /// Contact length of particle `i`.
    #[inline(always)]
    #[must_use]
    pub fn length(&self, i: usize) -> f64 {
        self.rows[usize::from(self.body[i])].l
    }

    /// Contact coordinates of the one or two nearest neighbours that particle `i` touches.
    pub fn touching<'a>(&'a self, x: &'a [f64], i: usize) -> impl Iterator<Item = f64> + 'a {
        let left = (i > 0).then(|| self.contact_at(x, i - 1, i));
        let right = (i + 1 < self.len()).then(|| self.contact_at(x, i, i + 1));
        left.into_iter().chain(right).filter(|c| c.nearest).map(|c| c.zeta)
    }

    /// Images and what they are images of, as pairs of indices: particles, or images that come earlier.
    pub fn images(&self) -> impl Iterator<Item = (usize, usize)> + 'static {
        let (first, end, total) = (self.first, self.end, self.len());
        (0..first.max(total - end)).flat_map(move |k| {
            let left = (k < first).then(|| (first - 1 - k, first + k));
            let right = (k < total - end).then(|| (end + k, end - 1 - k));
            left.into_iter().chain(right)
        })
    }

    /// Puts every image where its wall shows it: `x` mirrored, `v` reversed.
    pub fn reflect(&self, x: &mut [f64], v: &mut [f64]) {
        for (image, of) in self.images() {
            let wall = self.walls[usize::from(image >= self.end)];
            if let Some(wall) = wall {
                x[image] = 2.0 * wall - x[of];
                v[image] = -v[of];
            }
        }
    }
}
