//! What a run continues from, as named arrays: [`Simulation::sections`] and [`Simulation::restore`].
//!
//! A section holds what a step reads before it writes it; everything else is made anew from the scene
//! or within the step. Sums are zero between steps. Names and lengths of the sections follow from the
//! scene alone.
//!
//! A contact is found whenever it is in reach, in an order that only the members decide, and so is a surface:
//! forces do not depend on when the list of pairs was made. The count of pairs does: the places of the members
//! at that time are kept too, and the list is made again from them. A scene of spheres has no section of rotations.

use thiserror::Error;

use super::columns::Column;
use super::contacts::Memory;
use super::lanes::{F8, LANES};
use super::mesh::Group;
use super::simulation::Simulation;
use super::surfaces;
use super::votes::{VOTERS, Voter};

/// Among the counts: the first of the particles that decide the next step, who decided the last one, and the first
/// of those of how often.
const FIRST: usize = 10;
const LAST: usize = 11;
const DECIDED: usize = 12;

/// A named array.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// Name, unique among the sections.
    pub name: String,
    /// Its numbers.
    pub values: Values,
}

/// The numbers of a section.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Double precision.
    F64(Vec<f64>),
    /// Counts.
    U64(Vec<u64>),
    /// Indices.
    U32(Vec<u32>),
    /// Flags and masks.
    U8(Vec<u8>),
}

/// Sections that do not fit the scene. The simulation is left as it was.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("section `{section}` holds {found}, wanted {wanted}")]
pub struct RestartError {
    /// Name of the section.
    pub section: String,
    /// What stands there.
    pub found: String,
    /// What should stand there.
    pub wanted: String,
}

impl RestartError {
    fn new(section: &str, found: impl Into<String>, wanted: impl Into<String>) -> Self {
        Self { section: section.to_owned(), found: found.into(), wanted: wanted.into() }
    }
}

impl Values {
    /// Number and type of the values.
    #[must_use]
    pub fn form(&self) -> String {
        match self {
            Self::F64(v) => format!("{} of f64", v.len()),
            Self::U64(v) => format!("{} of u64", v.len()),
            Self::U32(v) => format!("{} of u32", v.len()),
            Self::U8(v) => format!("{} of u8", v.len()),
        }
    }
}

/// Eights of a group, by name.
struct Eights {
    name: &'static str,
    get: fn(&Group) -> &[F8],
    set: fn(&mut Group) -> &mut [F8],
}

/// Declares the eights of a group that are kept.
macro_rules! eights {
    ($($field:ident as $slice:ident, $slice_mut:ident);* $(;)?) => {
        [$(Eights {
            name: concat!("group.", stringify!($field)),
            get: |group| $slice(&group.$field),
            set: |group| $slice_mut(&mut group.$field),
        }),*]
    };
}

fn many<const N: usize>(eights: &[F8; N]) -> &[F8] {
    eights
}

fn many_mut<const N: usize>(eights: &mut [F8; N]) -> &mut [F8] {
    eights
}

/// The stress also tells the energy that is stored between steps.
const EIGHTS: [Eights; 6] = eights! {
    plastic as many, many_mut;
    stress as many, many_mut;
    strain as one, one_mut;
    flow as one, one_mut;
    rate as one, one_mut;
    damage as one, one_mut;
};

fn one(eight: &F8) -> &[F8] {
    std::slice::from_ref(eight)
}

fn one_mut(eight: &mut F8) -> &mut [F8] {
    std::slice::from_mut(eight)
}

impl Eights {
    /// Eight after eight of one component, then of the next.
    fn gather(&self, groups: &[Group]) -> Vec<f64> {
        let components = groups.first().map_or(0, |group| (self.get)(group).len());
        let of = |k: usize| groups.iter().flat_map(move |group| (self.get)(group)[k].0);
        (0..components).flat_map(of).collect()
    }

    fn scatter(&self, groups: &mut [Group], values: &[f64]) {
        let count = groups.len();
        for (at, eight) in values.as_chunks::<LANES>().0.iter().enumerate() {
            (self.set)(&mut groups[at % count])[at / count] = F8(*eight);
        }
    }
}

/// The sections that are not columns, as they were read.
struct Taken<'a> {
    sections: std::slice::Iter<'a, Section>,
}

/// Takes the next section; types and names have been compared before.
macro_rules! take {
    ($name:ident, $variant:ident, $type:ty) => {
        fn $name(&mut self) -> &'a [$type] {
            match self.sections.next().map(|section| &section.values) {
                Some(Values::$variant(values)) => values,
                _ => &[],
            }
        }
    };
}

impl<'a> Taken<'a> {
    take!(f64s, F64, f64);
    take!(u64s, U64, u64);
    take!(u32s, U32, u32);
    take!(u8s, U8, u8);
}

impl Simulation {
    /// Everything that the run continues from, between two steps.
    #[must_use]
    pub fn sections(&self) -> Vec<Section> {
        let mut all = Vec::new();
        let mut add = |name: &str, values| all.push(Section { name: name.to_owned(), values });
        for (name, column) in self.state.named() {
            add(&format!("state.{name}"), Values::F64(column.to_vec()));
        }
        for (name, column) in self.derived.named() {
            add(&format!("derived.{name}"), Values::F64(column.to_vec()));
        }
        for eights in EIGHTS {
            add(eights.name, Values::F64(eights.gather(&self.groups)));
        }
        let flags = |of: fn(&Group) -> u8| Values::U8(self.groups.iter().map(of).collect());
        add("group.live", flags(|group| group.live));
        add("group.failed", flags(|group| group.failed));
        add("group.awake", flags(|group| u8::from(group.awake)));
        add("mesh.ratio", Values::F64(self.mesh.ratio.clone()));
        let ways = self.mesh.bodies.iter().flat_map(|body| body.way);
        add("mesh.way", Values::F64(ways.collect()));
        let active = self.active.iter().map(|&active| u8::from(active));
        add("piece.active", Values::U8(active.collect()));
        let contacts = self.contacts.memory();
        add("contact.member", Values::U32(contacts.index));
        add("contact.flags", Values::U8(contacts.flags));
        for (name, places) in ["list.x", "list.y", "list.z"].into_iter().zip(contacts.places) {
            add(name, Values::F64(places));
        }
        add("list.stale", Values::U8(vec![u8::from(contacts.stale)]));
        add("list.skin", Values::F64(contacts.skin.to_vec()));
        if let Some(rigid) = contacts.rigid {
            add("spin.rigid", Values::F64(rigid));
        }
        let surfaces = self.surfaces.memory(&self.mesh, &self.contacts);
        add("surface.stand", Values::F64(surfaces.stand));
        add("surface.distance", Values::F64(surfaces.distance));
        add("surface.area", Values::F64(surfaces.area));
        add("surface.face", Values::U64(surfaces.face));
        add("run.clock", Values::F64(self.clock().to_vec()));
        add("run.ledger", Values::F64(self.books().to_vec()));
        add("run.counts", Values::U64(self.counts().to_vec()));
        all
    }

    /// Continues from sections of the same scene: the next steps give the same bits as those of the
    /// run that the sections are of. The simulation must be new.
    ///
    /// # Errors
    /// The first section of another name, type or length than [`Simulation::sections`] gives, or with
    /// values that no run has. Nothing is changed then.
    pub fn restore(&mut self, sections: &[Section]) -> Result<(), RestartError> {
        let wanted = self.sections();
        for (section, wanted) in sections.iter().zip(&wanted) {
            if section.name != wanted.name {
                return Err(RestartError::new(
                    &wanted.name,
                    section.name.as_str(),
                    "this section here",
                ));
            }
            let (found, form) = (section.values.form(), wanted.values.form());
            if found != form {
                return Err(RestartError::new(&section.name, found, form));
            }
        }
        if let Some(missing) = wanted.get(sections.len()) {
            return Err(RestartError::new(&missing.name, "nothing", missing.values.form()));
        }
        if let Some(extra) = sections.get(wanted.len()) {
            return Err(RestartError::new(&extra.name, extra.values.form(), "no such section"));
        }
        self.inspect(sections)?;
        self.take(Taken { sections: sections.iter() });
        Ok(())
    }

    /// Refuses flags and indices that would lead astray.
    fn inspect(&self, sections: &[Section]) -> Result<(), RestartError> {
        for section in sections {
            let name = section.name.as_str();
            let bad =
                |value: u64, wanted: &str| Err(RestartError::new(name, value.to_string(), wanted));
            match &section.values {
                Values::U8(values) if matches!(name, "group.live" | "group.failed") => {
                    let beyond =
                        |(group, mask): (&Group, &u8)| group.lanes < 8 && mask >> group.lanes != 0;
                    if let Some((_, mask)) =
                        self.groups.iter().zip(values).find(|&pair| beyond(pair))
                    {
                        return bad(u64::from(*mask), "bits of the elements alone");
                    }
                }
                Values::U8(values) => {
                    let most = if name == "contact.flags" { 3 } else { 1 };
                    if let Some(value) = values.iter().find(|&&value| value > most) {
                        return bad(u64::from(*value), "known flags alone");
                    }
                }
                Values::U32(index) => {
                    if let Some(value) = super::contacts::no_order(&self.mesh, index) {
                        return bad(u64::from(value), "every member of the contacts once");
                    }
                }
                Values::U64(faces) if name == "surface.face" => {
                    let nodes = self.mesh.first_centroid;
                    if let Some(value) = surfaces::Memory::no_face(faces, nodes) {
                        return bad(value, "corners that there are");
                    }
                }
                Values::U64(counts) => {
                    let [first, last] = [FIRST, LAST].map(|at| counts.get(at).copied());
                    let (first, last) = (first.unwrap_or_default(), last.unwrap_or_default());
                    let all = self.derived.rho.len() as u64;
                    if first.saturating_add(LANES as u64) > all {
                        return bad(first, "the number of a particle, before seven others");
                    }
                    if last > VOTERS as u64 {
                        return bad(last, "the number of a voter, or of none");
                    }
                }
                Values::F64(_) => {}
            }
        }
        Ok(())
    }

    fn take(&mut self, mut from: Taken<'_>) {
        let mut fill = |column: &mut Column| column.copy_from_slice(from.f64s());
        self.state.named_mut().for_each(|(_, column)| fill(column));
        self.derived.named_mut().for_each(|(_, column)| fill(column));
        for eights in EIGHTS {
            eights.scatter(&mut self.groups, from.f64s());
        }
        let mut flag = |set: fn(&mut Group, u8)| {
            self.groups.iter_mut().zip(from.u8s()).for_each(|(group, &value)| set(group, value));
        };
        flag(|group, value| group.live = value);
        flag(|group, value| group.failed = value);
        flag(|group, value| group.awake = value != 0);
        for group in &mut self.groups {
            group.tearing = group.failed;
            self.mesh.tear(group);
        }
        self.mesh.ratio.copy_from_slice(from.f64s());
        for group in &mut self.groups {
            group.look_beyond_the_dead(&self.mesh.ratio);
        }
        for (body, way) in self.mesh.bodies.iter_mut().zip(from.f64s().as_chunks().0) {
            body.way = *way;
        }
        for (active, &value) in self.active.iter_mut().zip(from.u8s()) {
            *active = value != 0;
        }
        let memory = Memory {
            index: from.u32s().to_vec(),
            flags: from.u8s().to_vec(),
            places: [from.f64s().to_vec(), from.f64s().to_vec(), from.f64s().to_vec()],
            stale: from.u8s() != [0],
            skin: from.f64s().try_into().unwrap_or_default(),
            rigid: self.contacts.rotates().then(|| from.f64s().to_vec()),
        };
        self.contacts.recall(&self.mesh, &memory, &self.method);
        // The list is that of its time; the members stand where they are now.
        self.contacts.look_again(&self.mesh, &self.state, &self.method);
        let memory = surfaces::Memory {
            stand: from.f64s().to_vec(),
            distance: from.f64s().to_vec(),
            area: from.f64s().to_vec(),
            face: from.u64s().to_vec(),
        };
        self.surfaces.recall(&self.mesh, &self.contacts, &memory);
        self.set_clock(from.f64s());
        self.set_books(from.f64s());
        self.set_counts(from.u64s());
        self.asleep = self.groups.iter().any(|group| !group.awake);
    }

    /// Time, what the next step's length depends on, and what was allowed the last one.
    fn clock(&self) -> [f64; 6 + VOTERS] {
        let Self { time, dt, kick, free_dt, allowed, votes, .. } = self;
        let mut clock = [0.0; 6 + VOTERS];
        clock[..6].copy_from_slice(&[*time, *dt, *kick, *free_dt, allowed.sound, allowed.density]);
        clock[6..].copy_from_slice(&votes.allowed);
        clock
    }

    fn set_clock(&mut self, clock: &[f64]) {
        let Ok(clock) = <[f64; 6 + VOTERS]>::try_from(clock) else { return };
        let [time, dt, kick, free, sound, density, allowed @ ..] = clock;
        (self.time, self.dt, self.kick, self.free_dt) = (time, dt, kick, free);
        (self.allowed.sound, self.allowed.density) = (sound, density);
        self.votes.allowed = allowed;
    }

    /// What the balance has booked, and what the scene held at the start.
    fn books(&self) -> [f64; 26] {
        let (h, walls) = (&self.initial, &self.walls_gave);
        let [px, py, pz] = h.momentum;
        let [lx, ly, lz] = h.angular;
        let [ix, iy, iz] = walls.impulse;
        let [mx, my, mz] = walls.moment;
        [
            self.element_work,
            self.element_heat,
            self.spring_work,
            self.spring_heat,
            h.hourglass,
            h.spring,
            walls.work,
            ix,
            iy,
            iz,
            mx,
            my,
            mz,
            h.mass,
            px,
            py,
            pz,
            lx,
            ly,
            lz,
            h.kinetic,
            h.internal,
            h.shear,
            h.tension,
            h.momentum_scale,
            h.angular_scale,
        ]
    }

    fn set_books(&mut self, books: &[f64]) {
        let Ok(b) = <[f64; 26]>::try_from(books) else { return };
        (self.element_work, self.element_heat) = (b[0], b[1]);
        (self.spring_work, self.spring_heat) = (b[2], b[3]);
        let walls = &mut self.walls_gave;
        walls.work = b[6];
        walls.impulse = [b[7], b[8], b[9]];
        walls.moment = [b[10], b[11], b[12]];
        let h = &mut self.initial;
        (h.hourglass, h.spring, h.mass) = (b[4], b[5], b[13]);
        h.momentum = [b[14], b[15], b[16]];
        h.angular = [b[17], b[18], b[19]];
        (h.kinetic, h.internal, h.shear, h.tension) = (b[20], b[21], b[22], b[23]);
        (h.momentum_scale, h.angular_scale) = (b[24], b[25]);
    }

    /// Counters, the first of the particles that decide the next step, and who decided the last one and all so far.
    fn counts(&self) -> [u64; DECIDED + VOTERS] {
        let c = &self.counters;
        let mut counts = [0; DECIDED + VOTERS];
        counts[..DECIDED].copy_from_slice(&[
            c.steps,
            c.particle_steps,
            c.stages,
            c.sweeps,
            c.work_sweeps,
            c.pairs,
            c.kernel_evaluations,
            c.floored,
            c.packed,
            c.lessened,
            self.allowed.first as u64,
            self.votes.last.map_or(VOTERS as u64, |voter| voter as u64),
        ]);
        counts[DECIDED..].copy_from_slice(&self.votes.decided);
        counts
    }

    fn set_counts(&mut self, counts: &[u64]) {
        let Ok(c) = <[u64; DECIDED + VOTERS]>::try_from(counts) else { return };
        self.counters = crate::counters::Counters {
            steps: c[0],
            particle_steps: c[1],
            stages: c[2],
            sweeps: c[3],
            work_sweeps: c[4],
            pairs: c[5],
            kernel_evaluations: c[6],
            floored: c[7],
            packed: c[8],
            lessened: c[9],
        };
        self.allowed.first = c[FIRST] as usize;
        self.votes.last = Voter::ALL.get(c[LAST] as usize).copied();
        self.votes.decided.copy_from_slice(&c[DECIDED..]);
    }
}
