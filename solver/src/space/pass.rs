//! The two passes over elements: loads on the particles, and the work of the step's mean velocity.
//!
//! Chunks of one colour touch no common particle, so all even chunks go at once, then all odd ones.

use super::columns::SumsSlices;
use super::dispatch::{Instructions, Kernel};
use super::element::{Demand, Laws, Read, Sink};
use super::lanes::Lanes;
use super::mesh::{Chunk, Group, Mesh};

/// Groups between the one that is worked on and the one that is asked for.
const AHEAD: usize = 1;

/// A pass over elements.
pub trait Pass: Sync {
    /// Result of a chunk.
    type Output: Copy + Send + Sync;
    /// Result of nothing.
    const NONE: Self::Output;
    /// What is done with a group.
    fn group<F: Lanes>(&self, group: &mut Group, mesh: &Mesh, sink: &mut Sink<'_>) -> Self::Output;
    /// Asks for what a group will read.
    fn fetch<F: Lanes>(&self, group: &Group);
    /// Joins two results.
    fn and(one: Self::Output, other: Self::Output) -> Self::Output;
}

/// Groups, and the sums of nodes and of centroids: cut by the chunks of one colour.
struct Cuttable<'a> {
    groups: &'a mut [Group],
    nodes: SumsSlices<'a>,
    centres: SumsSlices<'a>,
    /// First group, node and centroid of what is held.
    from: [usize; 3],
}

/// Runs a pass over all awake groups.
pub fn over_elements<P: Pass>(
    pass: &P,
    mesh: &Mesh,
    groups: &mut [Group],
    sums: SumsSlices<'_>,
    instructions: Instructions,
) -> P::Output {
    let (mut nodes, mut centres) = sums.split_at(mesh.first_centroid);
    let mut out = P::NONE;
    for colour in 0..2 {
        let all = Cuttable {
            groups: &mut *groups,
            nodes: nodes.reborrow(),
            centres: centres.reborrow(),
            from: [0, 0, mesh.first_centroid],
        };
        let chunks = mesh.chunks.len().saturating_sub(colour).div_ceil(2);
        let coloured = Coloured { pass, mesh, colour, instructions };
        if let Some(one) = coloured.run(all, 0..chunks) {
            out = P::and(out, one);
        }
    }
    out
}

struct Coloured<'a, P> {
    pass: &'a P,
    mesh: &'a Mesh,
    colour: usize,
    instructions: Instructions,
}

impl<P: Pass> Coloured<'_, P> {
    fn chunk(&self, k: usize) -> &Chunk {
        &self.mesh.chunks[2 * k + self.colour]
    }

    fn run(&self, held: Cuttable<'_>, range: std::ops::Range<usize>) -> Option<P::Output> {
        if range.is_empty() {
            return None;
        }
        if range.len() == 1 {
            let chunk = self.chunk(range.start);
            let (_, own) = held.cut(chunk);
            return Some(self.instructions.run(Whole { coloured: self, chunk, held: own }));
        }
        let middle = range.start + range.len() / 2;
        let (low, high) = held.cut(self.chunk(middle));
        let (low, high) = rayon::join(
            || self.run(low, range.start..middle),
            || self.run(high, middle..range.end),
        );
        match (low, high) {
            (Some(low), Some(high)) => Some(P::and(low, high)),
            (one, other) => one.or(other),
        }
    }
}

impl<'a> Cuttable<'a> {
    /// What comes before a chunk, and the chunk with all after it.
    fn cut(self, chunk: &Chunk) -> (Self, Self) {
        let at = [chunk.groups.start, chunk.nodes.start, chunk.centres.start];
        let groups = self.groups.split_at_mut(at[0] - self.from[0]);
        let nodes = self.nodes.split_at(at[1] - self.from[1]);
        let centres = self.centres.split_at(at[2] - self.from[2]);
        (
            Self { groups: groups.0, nodes: nodes.0, centres: centres.0, from: self.from },
            Self { groups: groups.1, nodes: nodes.1, centres: centres.1, from: at },
        )
    }
}

struct Whole<'a, 'b, P> {
    coloured: &'a Coloured<'a, P>,
    chunk: &'a Chunk,
    held: Cuttable<'b>,
}

impl<P: Pass> Kernel for Whole<'_, '_, P> {
    type Output = P::Output;

    #[inline(always)]
    fn run<F: Lanes>(self) -> P::Output {
        let Self { coloured, chunk, held } = self;
        let mut sink = Sink {
            nodes: held.nodes,
            centres: held.centres,
            first_node: held.from[1],
            first_centre: held.from[2],
        };
        let mut out = P::NONE;
        let mut groups = &mut held.groups[..chunk.groups.len()];
        while let Some((group, rest)) = groups.split_first_mut() {
            if let Some(next) = rest.get(AHEAD).filter(|next| next.awake && next.live != 0) {
                next.fetch::<F>();
                coloured.pass.fetch::<F>(next);
                sink.fetch::<F>(next);
            }
            if group.awake && group.live != 0 {
                out = P::and(out, coloured.pass.group::<F>(group, coloured.mesh, &mut sink));
            }
            groups = rest;
        }
        out
    }
}

/// First pass.
pub struct Load<'a> {
    /// Laws.
    pub laws: Laws,
    /// Particles.
    pub read: Read<'a>,
}

impl Pass for Load<'_> {
    type Output = Demand;
    const NONE: Demand = Demand::NONE;

    #[inline(always)]
    fn group<F: Lanes>(&self, group: &mut Group, mesh: &Mesh, sink: &mut Sink<'_>) -> Demand {
        let body = &mesh.bodies[group.body as usize];
        group.load_particles::<F>(body, &self.laws, &self.read, sink)
    }

    #[inline(always)]
    fn fetch<F: Lanes>(&self, group: &Group) {
        let read = &self.read;
        let vectors = read.displacement.into_iter().chain(read.velocity);
        for column in vectors.chain([read.grip, read.theta, read.sound, read.rho]) {
            group.fetch_column::<F>(column);
        }
    }

    #[inline(always)]
    fn and(one: Demand, other: Demand) -> Demand {
        one.and(other)
    }
}

/// Second pass.
pub struct Labour<'a> {
    /// Laws, with the length of the kick.
    pub laws: Laws,
    /// Displacements.
    pub displacement: [&'a [f64]; 3],
    /// Mean velocities of the step.
    pub mean: [&'a [f64]; 3],
}

impl Pass for Labour<'_> {
    type Output = f64;
    const NONE: f64 = 0.0;

    #[inline(always)]
    fn group<F: Lanes>(&self, group: &mut Group, mesh: &Mesh, sink: &mut Sink<'_>) -> f64 {
        let body = &mesh.bodies[group.body as usize];
        let motion = (self.displacement, self.mean);
        group.work::<F>(body, motion, &self.laws, sink)
    }

    #[inline(always)]
    fn fetch<F: Lanes>(&self, group: &Group) {
        for column in self.displacement.into_iter().chain(self.mean) {
            group.fetch_column::<F>(column);
        }
    }

    #[inline(always)]
    fn and(one: f64, other: f64) -> f64 {
        one + other
    }
}
