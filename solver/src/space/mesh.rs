//! The particles and elements of all bodies, numbered for streaming.
//!
//! All nodes come first, body by body in lattice order, then all centroids. Every body's part starts
//! at a multiple of eight and is followed by at least eight inert particles, so that eight lanes can
//! always be read. Elements stand in groups of up to eight neighbours along the fast axis; chunks of
//! groups are whole slow planes, so that every other chunk touches particles of its own.

use std::ops::Range;

use super::cells::{Mapped, bond_areas};
use super::element::skew_factors;
use super::eos::Eos;
use super::lanes::{F8, LANES, Lanes, Mask};
use super::lattice::{CENTROID_SHARE, Lattice, contact_length, dot};
use super::method::{Expansion, Method, Particles};
use super::scene::{Body as BodyData, Hold, Scene, Wall};
use super::strength::Solid;
use crate::method::Viscosity;

/// Fewest groups of a chunk.
const CHUNK_GROUPS: usize = 40;

/// Fewest slow planes of a chunk: between those that it shares with its neighbours it has one of its
/// own, so that chunks of one colour have no eight in common.
const CHUNK_PLANES: usize = 2;

/// Levels of the damage that particles feel.
const LEVELS: u16 = u8::MAX as u16;

/// What all particles and elements of a body share.
#[derive(Debug, Clone)]
pub struct Body {
    /// Index of its material.
    pub material: usize,
    /// Equation of state.
    pub eos: Eos,
    /// Strength and failure of its elements.
    pub solid: Solid,
    /// Reference density `rho_o`.
    pub rho_0: f64,
    /// Its lattice.
    pub lattice: Lattice,
    /// Its nodes, inert ones excluded.
    pub nodes: Range<usize>,
    /// Its centroids, inert ones excluded.
    pub centroids: Range<usize>,
    /// Velocity of its translation.
    pub velocity: [f64; 3],
    /// Angular velocity at the start.
    pub spin: [f64; 3],
    /// Way of its translation so far.
    pub way: [f64; 3],
    /// Contact length `2 beta h` of its particles, or of spheres as large.
    pub length: f64,
    /// The same, of ellipsoids along their longest axis.
    pub longest: f64,
    /// Contact lengths `2 beta h_k` along the axes of the lattice, where particles are ellipsoids.
    pub ellipsoid: Option<[f64; 3]>,
    /// What the bonds of cells with unequal edges differ by from their diagonals.
    pub skew: Option<[f64; 3]>,
    /// Half of the diagonal of a cell.
    pub diagonal: f64,
    /// Volume of a cell; the mean of mapped ones.
    pub cell_volume: f64,
    /// Mass of a sixteenth of a cell.
    pub sixteenth: f64,
    /// Its cells, if they are not all alike: they have shapes of their own then, and their particles
    /// masses of their own.
    pub mapped: Mapped,
    /// The corners of a cell from its centre, slot by slot.
    pub corners: [[f64; 3]; 8],
    /// Reference volumes of the six pyramids, by the arithmetic of the elements.
    pub pyramids: [f64; 6],
    /// One over them.
    pub per_pyramid: [f64; 6],
    /// Area of the bonds of its elements, by [`bond_areas`].
    pub bond_areas: [f64; 2],
    /// Slope of the shock speed.
    pub slope: f64,
    /// By axis of the lattice and end: the coordinate that a mirror there turns round, if there is one.
    pub mirrors: [[Option<usize>; 2]; 3],
}

/// Up to eight elements, neighbours along the fast axis.
#[derive(Debug, Clone)]
pub struct Group {
    /// First node of the rows (mid, slow) = (0,0), (1,0), (0,1), (1,1).
    pub rows: [u32; 4],
    /// First centroid.
    pub centre: u32,
    /// Index of the body.
    pub body: u16,
    /// Elements in it.
    pub lanes: u8,
    /// Elements that are a volume.
    pub live: u8,
    /// Elements that fail or have failed.
    pub failed: u8,
    /// Live elements that cease to be a volume at the end of the step.
    pub dying: u8,
    /// Elements whose damage has grown since their particles were told.
    pub tearing: u8,
    /// Levels of damage that their particles know of.
    told: [u8; LANES],
    /// Whether anything has moved here yet.
    pub awake: bool,
    /// Plastic strain `E^p`: 11, 22, 33, 12, 13, 23.
    pub plastic: [F8; 6],
    /// Deviatoric stress `S` of the last step.
    pub stress: [F8; 6],
    /// Viscous force over separation of the eight bonds.
    pub bonds: [F8; 8],
    /// Pressure that the six pyramids have beside that of the particles, if there is any.
    pub stiff: Option<Box<[F8; 6]>>,
    /// First of the centroids beyond each corner, lane by lane.
    pub beyond: [u32; 8],
    /// Lanes that have a live element beyond each corner.
    pub has_beyond: [Mask; 8],
    /// Lanes that had none beyond some corner at the start: the surface of the body.
    pub bare: Mask,
    /// Those of them with none beyond more than four: edges of the body.
    pub light: Mask,
    /// Coordinates, bit by bit, in which that element is a mirror image.
    pub mirrored: [u8; 8],
    /// Effective plastic strain.
    pub strain: F8,
    /// Hardening and rate factor of the yield stress, softening apart.
    pub flow: F8,
    /// Plastic strain rate of the last flow.
    pub rate: F8,
    /// Damage `d = D`.
    pub damage: F8,
}

/// Groups of whole slow planes of one body.
#[derive(Debug, Clone)]
pub struct Chunk {
    /// Its groups.
    pub groups: Range<usize>,
    /// Nodes that they touch, in whole eights.
    pub nodes: Range<usize>,
    /// Centroids that they touch, counted among all particles, in whole eights.
    pub centres: Range<usize>,
    /// Nodes and centroids that are kicked with it: of each eight, with the first chunk that touches
    /// it, where those of even number come before the others.
    pub kick: [Range<usize>; 2],
    /// Nodes and centroids that respond with it: with the last chunk that touches them.
    pub respond: [Range<usize>; 2],
}

/// Particles of one kind of one body, inert ones included, worked on together.
#[derive(Debug, Clone)]
pub struct Piece {
    /// Its particles.
    pub range: Range<usize>,
    /// How many of them are real.
    pub real: usize,
    /// Body.
    pub body: usize,
}

/// Everything that does not change while particles move.
#[derive(Debug, Clone)]
pub struct Mesh {
    /// Bodies.
    pub bodies: Vec<Body>,
    /// Chunks of groups.
    pub chunks: Vec<Chunk>,
    /// Pieces of particles.
    pub pieces: Vec<Piece>,
    /// Where the centroids begin.
    pub first_centroid: usize,
    /// Particles, inert ones included.
    pub len: usize,
    /// Real particles.
    pub particles: usize,
    /// Elements.
    pub elements: usize,
    /// Cells round a node, or the share of a centroid: mass in sixteenths of a cell; of inert
    /// particles one.
    pub share: Vec<u8>,
    /// Masses, if a body has mapped cells; empty otherwise, where they follow from the shares.
    pub masses: Vec<f64>,
    /// Reference volume over the reference volume of live elements; zero without live elements.
    pub ratio: Vec<f64>,
    /// Of the share of a particle what its elements have lost to damage, in levels; all of it if particles feel cold tension
    /// as well.
    torn: Vec<u16>,
    /// `V_o^(2/3)` by share, body by body.
    pub areas: Vec<[f64; 9]>,
    piece_at: Vec<u32>,
}

impl Mesh {
    /// The mesh of a scene, and its elements.
    #[must_use]
    pub fn new(scene: &Scene) -> (Self, Vec<Group>) {
        let lattices: Vec<Lattice> = scene.bodies.iter().map(Lattice::new).collect();
        let mut next = 0;
        let mut place = |n: usize| {
            let start = next;
            next = (start + n + 2 * LANES).next_multiple_of(LANES);
            start..start + n
        };
        let nodes: Vec<_> = lattices.iter().map(|l| place(l.nodes.len())).collect();
        let centroids: Vec<_> = lattices.iter().map(|l| place(l.centroids.len())).collect();
        let first_centroid = centroids[0].start;
        let len = next;
        let mut mesh = Self {
            bodies: Vec::new(),
            chunks: Vec::new(),
            pieces: Vec::new(),
            first_centroid,
            len,
            particles: lattices.iter().map(|l| l.nodes.len() + l.centroids.len()).sum(),
            elements: lattices.iter().map(|l| l.centroids.len()).sum(),
            share: vec![1; len],
            masses: vec![1.0; if lattices.iter().any(Lattice::is_mapped) { len } else { 0 }],
            ratio: vec![0.0; len],
            torn: vec![0; len],
            areas: Vec::new(),
            piece_at: vec![u32::MAX; len / LANES],
        };
        let mut groups = Vec::new();
        for (k, lattice) in lattices.into_iter().enumerate() {
            let body = Body::new(scene, &scene.bodies[k], lattice, [&nodes[k], &centroids[k]]);
            mesh.weigh(&body);
            let sixteenth = body.cell_volume / 16.0;
            let area = |share: usize| (share as f64 * sixteenth).powf(2.0 / 3.0);
            mesh.areas.push(std::array::from_fn(area));
            mesh.group(&body, k, &mut groups);
            mesh.bodies.push(body);
        }
        for group in &mut groups {
            let zonal = mesh.bodies[usize::from(group.body)].zonal(&scene.method);
            if scene.method.visc_volume > 0.0 || zonal > 0.0 {
                group.stiff = Some(Box::default());
            }
        }
        if scene.method.expansion == Expansion::Whole {
            for (torn, &share) in mesh.torn.iter_mut().zip(&mesh.share) {
                *torn = u16::from(share) * LEVELS;
            }
        }
        groups.shrink_to_fit();
        mesh.cut(&nodes);
        mesh.cut(&centroids);
        (mesh, groups)
    }

    fn weigh(&mut self, body: &Body) {
        let shares = body.lattice.share.iter().copied();
        let shares = shares.chain(std::iter::repeat_n(CENTROID_SHARE, body.centroids.len()));
        for (i, share) in body.nodes.clone().chain(body.centroids.clone()).zip(shares) {
            self.share[i] = share;
            self.ratio[i] = 1.0;
        }
        if self.masses.is_empty() {
            return;
        }
        for i in body.nodes.clone().chain(body.centroids.clone()) {
            self.masses[i] = f64::from(self.share[i]) * body.sixteenth;
        }
        if body.mapped.is_empty() {
            return;
        }
        for (k, &at) in body.lattice.nodes.iter().enumerate() {
            let shares = body.lattice.cells_round(at);
            // From the node the cell lies in this octant: the node is its opposite corner.
            let volume: f64 =
                shares.map(|(octant, cell)| body.mapped.share(cell as usize, 7 - octant)).sum();
            self.masses[body.nodes.start + k] = body.rho_0 * volume;
        }
        for cell in 0..body.mapped.len() {
            self.masses[body.centroids.start + cell] = 0.5 * body.rho_0 * body.mapped.volume(cell);
        }
    }

    fn group(&mut self, body: &Body, index: usize, groups: &mut Vec<Group>) {
        let lattice = &body.lattice;
        let mut chunk_start = groups.len();
        let mut first_plane = 0;
        // Where the chunk before ends.
        let mut lower = [0; 2];
        let planes = lattice.cells[2];
        let mut runs = lattice.runs.iter().peekable();
        for plane in 0..planes {
            while let Some(run) = runs.next_if(|run| run.slow == plane) {
                for from in (0..run.cells).step_by(LANES) {
                    let lanes = (run.cells - from).min(LANES);
                    let rows = run.rows.map(|row| row + (from + body.nodes.start) as u32);
                    let centre = run.centre + (from + body.centroids.start) as u32;
                    let mut group = Group::new(rows, centre, index as u16, lanes, &body.solid);
                    group.look_beyond(body);
                    groups.push(group);
                }
            }
            let enough = groups.len() - chunk_start >= CHUNK_GROUPS
                && plane + 1 - first_plane >= CHUNK_PLANES
                && plane + 1 + CHUNK_PLANES <= planes;
            if enough || plane + 1 == planes {
                let node = |plane: usize| body.nodes.start + lattice.node_planes[plane];
                let cell = |plane: usize| body.centroids.start + lattice.cell_planes[plane];
                let from = [node(first_plane), cell(first_plane)];
                let upper = [node(plane + 1), cell(plane + 1)];
                let own = [from[0]..node(plane + 2), from[1]..upper[1]];
                let touched = own.map(|own| eights_round(&own));
                let inner = [0, 1].map(|kind| {
                    // At the ends of the body there is no neighbour.
                    let low = if first_plane == 0 { from[kind] } else { lower[kind] };
                    let high = if plane + 1 == planes { touched[kind].end } else { upper[kind] };
                    low.next_multiple_of(LANES)..high / LANES * LANES
                });
                let even = self.chunks.len().is_multiple_of(2);
                lower = [node(plane + 2), upper[1]];
                self.chunks.push(Chunk {
                    groups: chunk_start..groups.len(),
                    nodes: touched[0].clone(),
                    centres: touched[1].clone(),
                    kick: if even { touched.clone() } else { inner.clone() },
                    respond: if even { inner } else { touched },
                });
                (chunk_start, first_plane) = (groups.len(), plane + 1);
            }
        }
    }

    /// Cuts ranges of particles, one a body, into pieces.
    fn cut(&mut self, ranges: &[Range<usize>]) {
        for (body, range) in ranges.iter().enumerate() {
            for start in range.clone().step_by(super::columns::PIECE) {
                let real = (range.end - start).min(super::columns::PIECE);
                let end = start + real.next_multiple_of(LANES);
                self.piece_at[start / LANES..end / LANES].fill(self.pieces.len() as u32);
                self.pieces.push(Piece { range: start..end, real, body });
            }
        }
    }

    /// Takes the element of a centroid out of the volumes of its particles.
    pub fn bury(&mut self, centre: u32) {
        let (body, at) = self.place(centre as usize);
        self.ratio[centre as usize] = 0.0;
        for corner in 0..8 {
            let side = |d: usize| if corner >> d & 1 == 1 { 1 } else { -1 };
            let at = [at[0] + side(0), at[1] + side(1), at[2] + side(2)];
            let own = &self.bodies[body];
            let i = own.nodes.start + own.lattice.node(at) as usize;
            let is_live = |cell: &u32| self.ratio[own.centroids.start + *cell as usize] > 0.0;
            let cells = own.lattice.cells_round(at);
            let live = cells.filter(|(_, cell)| is_live(cell));
            self.ratio[i] = if own.mapped.is_empty() {
                part(f64::from(self.share[i]), live.map(|_| 1.0).sum())
            } else {
                let share = |(octant, cell)| own.mapped.share(cell as usize, 7 - octant);
                part(self.masses[i] / own.rho_0, live.map(share).sum())
            };
        }
    }

    /// Takes as much of elements as their damage has grown by out of what holds their particles in tension. Damage counts in
    /// whole levels, whose sums are the same in any order: after a restart too.
    pub fn tear(&mut self, group: &mut Group) {
        for lane in (0..u32::from(group.lanes)).filter(|lane| group.tearing >> lane & 1 == 1) {
            let (level, told) = (group.level(lane), group.told[lane as usize]);
            for i in group.particles(lane) {
                let lost = if i >= self.first_centroid { CENTROID_SHARE } else { 1 };
                let all = u16::from(self.share[i]) * LEVELS;
                self.torn[i] = (self.torn[i] + u16::from(lost) * u16::from(level - told)).min(all);
            }
            group.told[lane as usize] = level;
        }
        group.tearing = 0;
    }

    /// Damage of the elements of the particles from `first` on, their mean.
    #[inline(always)]
    pub fn loose<F: Lanes>(&self, first: usize) -> F {
        F::whole(&self.torn, first) * (1.0 / f64::from(LEVELS)) / F::whole(&self.share, first)
    }

    /// Bytes that it takes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let lattices: usize = self.bodies.iter().map(|body| body.lattice.bytes()).sum();
        let mapped: usize = self.bodies.iter().map(|body| body.mapped.bytes()).sum();
        let pieces = 4 * self.piece_at.capacity();
        let own = 8 * (self.ratio.capacity() + self.masses.capacity());
        own + self.share.capacity() + 2 * self.torn.capacity() + pieces + lattices + mapped
    }

    /// Mass of a particle.
    #[inline(always)]
    #[must_use]
    pub fn mass(&self, i: usize) -> f64 {
        if let Some(&mass) = self.masses.get(i) {
            return mass;
        }
        let body = &self.bodies[self.pieces[self.piece_of(i)].body];
        f64::from(self.share[i]) * body.sixteenth
    }

    /// Piece of a particle.
    #[inline(always)]
    #[must_use]
    pub fn piece_of(&self, i: usize) -> usize {
        self.piece_at[i / LANES] as usize
    }

    /// Body and half-cell coordinates of a particle.
    #[must_use]
    pub fn place(&self, i: usize) -> (usize, [i16; 3]) {
        let by = |range: fn(&Body) -> &Range<usize>| {
            self.bodies.partition_point(|body| range(body).end <= i)
        };
        if i < self.first_centroid {
            let k = by(|body| &body.nodes);
            (k, self.bodies[k].lattice.nodes[i - self.bodies[k].nodes.start])
        } else {
            let k = by(|body| &body.centroids);
            (k, self.bodies[k].lattice.centroids[i - self.bodies[k].centroids.start])
        }
    }

    /// Whether a particle can touch others: it is on a surface, or an element at it is dead.
    #[must_use]
    pub fn exposed(&self, i: usize) -> bool {
        self.share[i] < CENTROID_SHARE || self.ratio[i] != 1.0
    }

    /// Particles of a body within so many cells of these coordinates.
    pub fn within(
        &self,
        cells: i16,
        body: usize,
        at: [i16; 3],
    ) -> impl Iterator<Item = usize> + '_ {
        let own = &self.bodies[body];
        let near = move |parity: i16| {
            let half = 2 * cells;
            let axis =
                move |d: usize| (at[d] - half..=at[d] + half).filter(move |c| c & 1 == parity);
            axis(0).flat_map(move |f| axis(1).flat_map(move |m| axis(2).map(move |s| [f, m, s])))
        };
        let some = |index: u32, start: usize| {
            (index != super::lattice::NONE).then(|| start + index as usize)
        };
        let nodes = near(0).filter_map(move |at| some(own.lattice.node(at), own.nodes.start));
        let cells = near(1).filter_map(move |at| some(own.lattice.cell(at), own.centroids.start));
        nodes.chain(cells)
    }

    /// Whether a live element holds a particle.
    #[inline(always)]
    #[must_use]
    pub fn held(&self, i: usize) -> bool {
        self.ratio[i] > 0.0
    }

    /// Whether all elements of a particle are live.
    #[must_use]
    pub fn whole(&self, i: usize) -> bool {
        self.ratio[i] == 1.0
    }

    /// Whether particles at these coordinates of a body share a live element.
    #[must_use]
    pub fn bonded(&self, body: usize, a: [i16; 3], b: [i16; 3]) -> bool {
        if (0..3).any(|d| (a[d] - b[d]).abs() > 2) {
            return false;
        }
        let own = &self.bodies[body];
        let live = |cell: u32| {
            cell != super::lattice::NONE && self.ratio[own.centroids.start + cell as usize] > 0.0
        };
        match (a[0] & 1, b[0] & 1) {
            (1, 1) => false,
            (1, _) => (0..3).all(|d| (a[d] - b[d]).abs() == 1) && live(own.lattice.cell(a)),
            (_, 1) => (0..3).all(|d| (a[d] - b[d]).abs() == 1) && live(own.lattice.cell(b)),
            _ => own.lattice.cells_round(a).any(|(_, cell)| {
                let at = own.lattice.centroids[cell as usize];
                (0..3).all(|d| (at[d] - b[d]).abs() == 1) && live(cell)
            }),
        }
    }

    /// Velocity of the translation of one body relative to another's.
    #[inline(always)]
    #[must_use]
    pub fn drift_of(&self, a: usize, b: usize) -> [f64; 3] {
        let (a, b) = (&self.bodies[a].velocity, &self.bodies[b].velocity);
        [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
    }

    /// Whether a surface keeps two particles apart: of two solid bodies, and one of them held.
    #[inline(always)]
    #[must_use]
    pub fn keeps_apart(&self, pair: [usize; 2], bodies: [usize; 2]) -> bool {
        bodies[0] != bodies[1]
            && pair.iter().any(|&i| self.held(i))
            && bodies.iter().all(|&b| self.bodies[b].solid.sound > 0.0)
    }

    /// The real particles, in order.
    pub fn real(&self) -> impl Iterator<Item = usize> + '_ {
        let nodes = self.bodies.iter().flat_map(|b| b.nodes.clone());
        nodes.chain(self.bodies.iter().flat_map(|b| b.centroids.clone()))
    }
}

impl Body {
    fn new(
        scene: &Scene,
        data: &BodyData,
        lattice: Lattice,
        [nodes, centroids]: [&Range<usize>; 2],
    ) -> Self {
        let index = scene.material_index(&data.material).unwrap_or_default();
        let material = &scene.materials[index];
        let eos = Eos::new(material);
        let corners = corners(&lattice);
        let pyramids = super::element::pyramid_volumes(&corners);
        let mapped = Mapped::new(&lattice, scene.method.balance);
        let [cell_volume, edge] = if mapped.is_empty() {
            [lattice.cell_volume(), lattice.shortest()]
        } else {
            [mapped.mean_volume(), mapped.edge()]
        };
        let unequal = mapped.is_empty() && !lattice.nearly_cubic();
        let round = unequal || mapped.is_empty() && scene.method.particles == Particles::Ellipsoids;
        let length = contact_length(cell_volume);
        let ellipsoid = round.then(|| lattice.size.map(|edge| 0.5 * 3f64.sqrt() * edge));
        Self {
            material: index,
            eos,
            solid: Solid::new(material, &scene.method, edge),
            rho_0: material.density,
            length,
            longest: ellipsoid.map_or(length, |own| own.into_iter().fold(0.0, f64::max)),
            ellipsoid,
            skew: unequal.then(|| skew_factors(lattice.size)),
            diagonal: if unequal { 0.5 * dot(lattice.size, lattice.size).sqrt() } else { length },
            cell_volume,
            sixteenth: material.density * cell_volume / 16.0,
            mapped,
            pyramids,
            per_pyramid: pyramids.map(|volume| 1.0 / volume),
            bond_areas: bond_areas(
                cell_volume,
                if unequal { cell_volume / edge } else { cell_volume.powf(2.0 / 3.0) },
            ),
            slope: eos.slope(),
            mirrors: mirrors(scene, &lattice, data.velocity),
            corners,
            lattice,
            nodes: nodes.clone(),
            centroids: centroids.clone(),
            velocity: data.velocity,
            spin: data.spin,
            way: [0.0; 3],
        }
    }
}

impl Body {
    /// Shortest edge of a cell; of mapped cells, the smallest volume over the largest face.
    #[inline(always)]
    #[must_use]
    pub fn edge(&self) -> f64 {
        self.solid.edge
    }

    /// Whether it is a gas: its elements carry no tension, and it has no shape of its own.
    #[inline(always)]
    #[must_use]
    pub fn is_gas(&self) -> bool {
        self.solid.bulk == 0.0
    }

    /// Stiffness of pyramids against being denser than their cell, over that of the gas; a solid has
    /// that of its hourglass modes instead.
    #[inline(always)]
    #[must_use]
    pub fn zonal(&self, method: &Method) -> f64 {
        if self.is_gas() { method.hourglass } else { 0.0 }
    }

    /// Sound speed that a form of the viscosity sees of a particle with this one: the printed form has
    /// that of the reference state (gap G17), which a gas has not.
    #[inline(always)]
    #[must_use]
    pub fn viscous_sound(&self, form: Viscosity, current: f64) -> f64 {
        match form {
            Viscosity::Pairwise if self.solid.bulk > 0.0 => self.sound(),
            Viscosity::Pairwise | Viscosity::Limited => current,
        }
    }

    /// Sound speed of its particles in the reference state.
    #[must_use]
    pub fn sound(&self) -> f64 {
        (self.solid.bulk / self.rho_0).sqrt()
    }
}

/// A whole over what is left of it; zero if nothing is.
fn part(whole: f64, left: f64) -> f64 {
    if left > 0.0 { whole / left } else { 0.0 }
}

/// The eights that a range lies in.
fn eights_round(range: &Range<usize>) -> Range<usize> {
    range.start / LANES * LANES..range.end.next_multiple_of(LANES)
}

/// Mirrors on which a lattice ends, that move with it.
fn mirrors(scene: &Scene, lattice: &Lattice, velocity: [f64; 3]) -> [[Option<usize>; 2]; 3] {
    let mut found = [[None; 2]; 3];
    let still = |wall: &&Wall| wall.hold == Hold::Mirror && velocity[wall.axis] == 0.0;
    for wall in scene.walls.iter().filter(still) {
        for (k, found) in found.iter_mut().enumerate() {
            if lattice.is_mapped() {
                for (end, found) in [0, 2 * lattice.cells[k] as i16].into_iter().zip(found) {
                    if lattice.lies_on(wall, (k, end)) {
                        *found = Some(wall.axis);
                    }
                }
                continue;
            }
            let along = lattice.axes[k][wall.axis];
            if along.abs() < 1.0 - 1e-12 {
                continue;
            }
            let at = (wall.position - lattice.origin[wall.axis]) / (along * lattice.size[k]);
            for (end, found) in [0.0, lattice.cells[k] as f64].into_iter().zip(found) {
                if (at - end).abs() < 1e-6 {
                    *found = Some(wall.axis);
                }
            }
        }
    }
    found
}

/// Corners of a cell from its centre; slot `b1 + 2 b2 + 4 b3` for the bits along the axes.
fn corners(lattice: &Lattice) -> [[f64; 3]; 8] {
    std::array::from_fn(|slot| {
        std::array::from_fn(|d| {
            let along = |k: usize| {
                let half = 0.5 * lattice.size[k] * lattice.axes[k][d];
                if slot >> k & 1 == 1 { half } else { -half }
            };
            along(0) + along(1) + along(2)
        })
    })
}

impl Group {
    fn new(rows: [u32; 4], centre: u32, body: u16, lanes: usize, solid: &Solid) -> Self {
        Self {
            rows,
            centre,
            body,
            lanes: lanes as u8,
            live: if lanes == LANES { u8::MAX } else { (1 << lanes) - 1 },
            failed: 0,
            dying: 0,
            tearing: 0,
            told: [0; LANES],
            awake: false,
            plastic: [F8::ZERO; 6],
            stress: [F8::ZERO; 6],
            bonds: [F8::ZERO; 8],
            stiff: None,
            beyond: [0; 8],
            has_beyond: [0; 8],
            bare: 0,
            light: 0,
            mirrored: [0; 8],
            strain: F8::ZERO,
            flow: F8::splat(solid.first_flow()),
            rate: F8::ZERO,
            damage: F8::ZERO,
        }
    }

    /// Finds the elements that continue the diagonals beyond the corners, or whose mirror images do. They
    /// lie in one row side by side, as the elements of the group do; what does not is left out.
    fn look_beyond(&mut self, body: &Body) {
        let lattice = &body.lattice;
        for corner in 0..8 {
            let mut way = [0, 1, 2].map(|d| if corner >> d & 1 == 1 { 2 } else { -2 });
            let own = lattice.centroids[self.centre as usize - body.centroids.start];
            for k in [1, 2] {
                let end = corner >> k & 1;
                let last = [1, 2 * lattice.cells[k] as i16 - 1][end];
                if let (Some(d), true) = (body.mirrors[k][end], own[k] == last) {
                    way[k] = 0;
                    self.mirrored[corner] |= 1 << d;
                }
            }
            let mut first = None;
            for lane in 0..u32::from(self.lanes) {
                let own = (self.centre + lane) as usize - body.centroids.start;
                let at = lattice.centroids[own];
                let cell = lattice.cell([at[0] + way[0], at[1] + way[1], at[2] + way[2]]);
                if cell == super::lattice::NONE {
                    continue;
                }
                let centre = cell + body.centroids.start as u32;
                // The first lanes may be without: their places count backwards.
                let start = *first.get_or_insert(centre.saturating_sub(lane));
                if start + lane == centre {
                    self.has_beyond[corner] |= 1 << lane;
                }
            }
            self.beyond[corner] = first.unwrap_or(self.centre);
        }
        for lane in 0..self.lanes {
            let missing = self.has_beyond.iter().filter(|has| *has >> lane & 1 == 0).count();
            self.bare |= u8::from(missing > 0) << lane;
            self.light |= u8::from(missing > 4) << lane;
        }
    }

    /// Forgets elements beyond the corners that are no volume any more.
    pub fn look_beyond_the_dead(&mut self, ratio: &[f64]) {
        for corner in 0..8 {
            let mut left = self.has_beyond[corner];
            while left != 0 {
                let lane = left.trailing_zeros();
                left &= left - 1;
                if ratio[(self.beyond[corner] + lane) as usize] == 0.0 {
                    self.has_beyond[corner] &= !(1 << lane);
                }
            }
        }
    }

    /// Lanes that die after the step.
    pub fn dying_lanes(&self) -> impl Iterator<Item = u32> + use<> {
        let Self { lanes, dying, .. } = *self;
        (0..u32::from(lanes)).filter(move |lane| dying >> lane & 1 == 1)
    }

    /// Damage of a lane in whole levels.
    fn level(&self, lane: u32) -> u8 {
        (self.damage.0[lane as usize] * f64::from(LEVELS)) as u8
    }

    /// The nine particles of a lane, slot by slot.
    pub fn particles(&self, lane: u32) -> impl Iterator<Item = usize> + '_ {
        let nodes = (0..8).map(|slot| self.node(slot));
        nodes.chain([self.centre as usize]).map(move |first| first + lane as usize)
    }

    /// Node of a slot of lane 0.
    #[inline(always)]
    #[must_use]
    pub fn node(&self, slot: usize) -> usize {
        self.rows[slot >> 1] as usize + (slot & 1)
    }
}
