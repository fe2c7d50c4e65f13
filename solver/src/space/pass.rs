//! The two passes over elements: loads on the particles, and their motion over the step.
//!
//! Chunks of one colour touch no common particle, so all even chunks go at once, then all odd ones.
//! Each runs through memory once, from the first slow plane to the last.

use super::cells::Cells;
use super::columns::{AllSlices, Cut, SumsSlices};
use super::dispatch::{Instructions, Kernel};
use super::element::{Demand, Laws, Read, Sink};
use super::lanes::{LANES, Lanes};
use super::mesh::{Chunk, Group, Mesh};
use super::sweep::{Allowed, Particles};

/// Groups between the one that is worked on and the one that is asked for.
const AHEAD: usize = 3;

/// Particles that are kicked earlier than need be: what has just been written is slow to read if it
/// is cut otherwise.
const LEAD: usize = 4 * LANES;

/// Colours of the chunks.
pub const COLOURS: [usize; 2] = [0, 1];

/// A pass over elements that writes to columns `C`.
pub trait Pass<C>: Sync {
    /// Result of a chunk.
    type Output: Copy + Send + Sync;
    /// Result of nothing.
    const NONE: Self::Output;
    /// What is done with a group, when those before it have given so much.
    fn group<F: Lanes, const MAPPED: bool>(
        &self,
        group: &mut Group,
        cells: &Cells<'_, MAPPED>,
        sink: (&mut Sink<C>, &Self::Output),
    ) -> Self::Output;
    /// Asks for what a group will read and write.
    fn fetch<F: Lanes>(&self, group: &Group, sink: &Sink<C>);
    /// Joins two results.
    fn and(one: Self::Output, other: Self::Output) -> Self::Output;

    /// What is done with particles before a group, or after the last one.
    #[inline(always)]
    fn particles<F: Lanes>(
        &self,
        _: Option<&Group>,
        _: &mut Wave,
        _: &mut Sink<C>,
    ) -> Self::Output {
        Self::NONE
    }
}

/// How far a pass has come with the particles of a chunk, nodes and centroids: up to where they are
/// kicked before the first element that they belong to, and respond after the last.
pub struct Wave {
    kick: [std::ops::Range<usize>; 2],
    respond: [std::ops::Range<usize>; 2],
}

/// Groups, and the columns of nodes and of centroids: cut by the chunks of one colour.
struct Cuttable<'a, C> {
    groups: &'a mut [Group],
    nodes: C,
    centres: C,
    /// First group, node and centroid of what is held.
    from: [usize; 3],
}

/// Runs a pass over all awake groups of one colour.
pub fn over_elements<C: Cut, P: Pass<C>>(
    pass: &P,
    (mesh, colour): (&Mesh, usize),
    groups: &mut [Group],
    columns: C,
    instructions: Instructions,
) -> P::Output {
    let (nodes, centres) = columns.cut(mesh.first_centroid);
    let all = Cuttable { groups, nodes, centres, from: [0, 0, mesh.first_centroid] };
    let chunks = mesh.chunks.len().saturating_sub(colour).div_ceil(2);
    let coloured = Coloured { pass, mesh, colour, instructions };
    coloured.run(all, 0..chunks).unwrap_or(P::NONE)
}

struct Coloured<'a, P> {
    pass: &'a P,
    mesh: &'a Mesh,
    colour: usize,
    instructions: Instructions,
}

impl<P> Coloured<'_, P> {
    fn chunk(&self, k: usize) -> &Chunk {
        &self.mesh.chunks[2 * k + self.colour]
    }

    fn run<C: Cut>(&self, held: Cuttable<'_, C>, range: std::ops::Range<usize>) -> Option<P::Output>
    where
        P: Pass<C>,
    {
        if range.is_empty() {
            return None;
        }
        if range.len() == 1 {
            let chunk = self.chunk(range.start);
            let (_, own) = held.cut(chunk);
            // A chunk has elements of one body.
            let mapped = |group: &Group| !self.mesh.bodies[group.body as usize].mapped.is_empty();
            return Some(if own.groups.first().is_some_and(mapped) {
                self.instructions.run(Whole::<_, _, true> { coloured: self, chunk, held: own })
            } else {
                self.instructions.run(Whole::<_, _, false> { coloured: self, chunk, held: own })
            });
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

impl<C: Cut> Cuttable<'_, C> {
    /// What comes before a chunk, and the chunk with all after it.
    fn cut(self, chunk: &Chunk) -> (Self, Self) {
        let at = [chunk.groups.start, chunk.nodes.start, chunk.centres.start];
        let groups = self.groups.split_at_mut(at[0] - self.from[0]);
        let nodes = self.nodes.cut(at[1] - self.from[1]);
        let centres = self.centres.cut(at[2] - self.from[2]);
        (
            Self { groups: groups.0, nodes: nodes.0, centres: centres.0, from: self.from },
            Self { groups: groups.1, nodes: nodes.1, centres: centres.1, from: at },
        )
    }
}

struct Whole<'a, 'b, P, C, const MAPPED: bool> {
    coloured: &'a Coloured<'a, P>,
    chunk: &'a Chunk,
    held: Cuttable<'b, C>,
}

impl<C, P: Pass<C>, const MAPPED: bool> Kernel for Whole<'_, '_, P, C, MAPPED> {
    type Output = P::Output;

    #[inline(always)]
    fn run<F: Lanes>(self) -> P::Output {
        let Self { coloured, chunk, held } = self;
        let (pass, mesh) = (coloured.pass, coloured.mesh);
        let mut sink = Sink {
            nodes: held.nodes,
            centres: held.centres,
            first_node: held.from[1],
            first_centre: held.from[2],
        };
        let mut wave = Wave { kick: chunk.kick.clone(), respond: chunk.respond.clone() };
        let mut out = P::NONE;
        let mut groups = &mut held.groups[..chunk.groups.len()];
        while let Some((group, rest)) = groups.split_first_mut() {
            if let Some(far) = rest.get(2 * AHEAD) {
                far.fetch::<F>();
            }
            if let Some(next) = rest.get(AHEAD) {
                pass.fetch::<F>(next, &sink);
            }
            out = P::and(out, pass.particles::<F>(Some(group), &mut wave, &mut sink));
            if group.awake && group.live != 0 {
                let body = &mesh.bodies[group.body as usize];
                let cells = Cells::<MAPPED>::new(body, group.centre);
                let own = pass.group::<F, MAPPED>(group, &cells, (&mut sink, &out));
                out = P::and(out, own);
            }
            groups = rest;
        }
        P::and(out, pass.particles::<F>(None, &mut wave, &mut sink))
    }
}

/// First pass.
pub struct Load<'a> {
    /// Laws.
    pub laws: Laws,
    /// Particles.
    pub read: Read<'a>,
}

impl<'c> Pass<SumsSlices<'c>> for Load<'_> {
    type Output = Demand;
    const NONE: Demand = Demand::NONE;

    #[inline(always)]
    fn group<F: Lanes, const MAPPED: bool>(
        &self,
        group: &mut Group,
        cells: &Cells<'_, MAPPED>,
        (sink, so_far): (&mut Sink<SumsSlices<'c>>, &Demand),
    ) -> Demand {
        group.load_particles::<F, MAPPED>(cells, &self.laws, &self.read, (sink, so_far.rate))
    }

    #[inline(always)]
    fn fetch<F: Lanes>(&self, group: &Group, sink: &Sink<SumsSlices<'c>>) {
        group.fetch_load::<F>(&self.read, sink);
    }

    #[inline(always)]
    fn and(one: Demand, other: Demand) -> Demand {
        one.and(other)
    }
}

/// Second pass: kick, work and the end of the step.
pub struct Motion<'a> {
    /// Laws, with the length of the kick.
    pub laws: Laws,
    /// Whether the work of elements is made out, over the mean velocities: not in a single pass.
    pub works: bool,
    /// What is done with the particles.
    pub particles: Particles<'a>,
}

/// What the motion gives.
#[derive(Debug, Clone, Copy)]
pub struct Moved {
    /// Power of the elements' own forces.
    pub power: f64,
    /// The time step that particles allow next.
    pub allowed: Allowed,
}

impl<'c> Pass<AllSlices<'c>> for Motion<'_> {
    type Output = Moved;
    const NONE: Moved = Moved { power: 0.0, allowed: Allowed::ANYTHING };

    #[inline(always)]
    fn group<F: Lanes, const MAPPED: bool>(
        &self,
        group: &mut Group,
        cells: &Cells<'_, MAPPED>,
        (sink, _): (&mut Sink<AllSlices<'c>>, &Moved),
    ) -> Moved {
        if !self.works {
            return Self::NONE;
        }
        Moved { power: group.work::<F, MAPPED>(cells, &self.laws, sink), ..Self::NONE }
    }

    #[inline(always)]
    fn fetch<F: Lanes>(&self, group: &Group, _: &Sink<AllSlices<'c>>) {
        group.fetch_work::<F>();
    }

    /// Kicks the particles of a group and all before them; those that no group from here on touches
    /// respond.
    #[inline(always)]
    fn particles<F: Lanes>(
        &self,
        group: Option<&Group>,
        wave: &mut Wave,
        sink: &mut Sink<AllSlices<'c>>,
    ) -> Moved {
        let (mut first, mut beyond) = ([usize::MAX; 2], [usize::MAX; 2]);
        if let Some(group) = group {
            let lanes = group.lanes as usize;
            first = [group.rows[0] as usize, group.centre as usize];
            beyond =
                [group.rows[3] as usize + 1, group.centre as usize].map(|at| at + lanes + LEAD);
        }
        let mut allowed = Allowed::ANYTHING;
        let columns = [(&mut sink.nodes, sink.first_node), (&mut sink.centres, sink.first_centre)];
        for (kind, (columns, start)) in columns.into_iter().enumerate() {
            let kick = &mut wave.kick[kind];
            while kick.start < kick.end.min(beyond[kind]) {
                self.particles.kick::<F>(columns, kick.start - start, kick.start);
                kick.start += LANES;
            }
            let respond = &mut wave.respond[kind];
            while respond.start + LANES <= respond.end.min(first[kind]) {
                let own =
                    self.particles.respond::<F>(columns, respond.start - start, respond.start);
                allowed = allowed.and(own);
                respond.start += LANES;
            }
        }
        Moved { allowed, ..Self::NONE }
    }

    #[inline(always)]
    fn and(one: Moved, other: Moved) -> Moved {
        Moved { power: one.power + other.power, allowed: one.allowed.and(other.allowed) }
    }
}
