//! A scene in motion: the step, and what can be asked of it.

use super::columns::{Derived, State, Sums, pieces};
use super::contacts::Contacts;
use super::dispatch::Instructions;
use super::element::{Demand, Laws, Read};
use super::lanes::LANES;
use super::lattice::cross;
use super::ledger::Holdings;
use super::mesh::{Group, Mesh};
use super::method::Method;
use super::outset;
use super::pass::{COLOURS, Load, Motion, Pass, over_elements};
use super::phase::Phase;
use super::scene::Scene;
use super::surfaces::Surfaces;
use super::sweep::{Allowed, Lengths, Particles, Respond, Stage};
use super::volumes;
use super::votes::{Voter, Votes};
use super::walls::{Given, Wall};
use crate::counters::Counters;
use crate::error::{SceneError, StepError};
use crate::method::{Density, Integrator};
use crate::timestep::SMALLEST_STEP;
use crate::units::Dimension;

/// Largest growth of the time step.
const GROWTH: f64 = 1.05;

/// Longest step over the time in which sound crosses a particle, or the cell of a body at rest.
pub(super) const CROSSING: f64 = 1.0 / 3.0;

/// Smallest part of an allowed step that is taken after a longer one.
const LEAST_PART: f64 = 0.5;

/// Smallest drift over the next at which the change of volumes in it is more than round-off: after a shorter one, to land
/// on a time, pressures lag for a step.
const SHORT: f64 = 1e-6;

/// A scene in motion, in three dimensions.
#[derive(Debug, Clone)]
pub struct Simulation {
    pub(super) mesh: Mesh,
    pub(super) groups: Vec<Group>,
    pub(super) state: State,
    pub(super) derived: Derived,
    pub(super) sums: Sums,
    pub(super) contacts: Contacts,
    pub(super) surfaces: Surfaces,
    pub(super) walls: Vec<Wall>,
    pub(super) method: Method,
    /// Pieces that were ever moved or pushed.
    pub(super) active: Vec<bool>,
    /// Particles that touch others.
    touched: Vec<bool>,
    /// Pieces in which something moves, while some sleep.
    stirring: Vec<bool>,
    /// What the last evaluation of the equation of state allows.
    pub(super) allowed: Allowed,
    demand: Demand,
    /// Largest rates of contacts and of springs: inverse steps.
    pushed: [f64; 2],
    pub(super) votes: Votes,
    pub(super) time: f64,
    /// Length of the last drift.
    pub(super) dt: f64,
    /// Length of the last kick.
    pub(super) kick: f64,
    /// Length that the last drift was allowed, whatever time it was to land on or step it followed.
    pub(super) free_dt: f64,
    /// A step below this has collapsed.
    smallest_step: f64,
    /// Longest step in which no body leaps through another that it does not touch yet.
    leap: f64,
    /// Work of the particles on the elements' shear and tension so far.
    pub(super) element_work: f64,
    /// Heat of plastic flow and damage so far.
    pub(super) element_heat: f64,
    /// Work of the particles on the springs between surfaces so far.
    pub(super) spring_work: f64,
    /// Heat of springs that were released.
    pub(super) spring_heat: f64,
    pub(super) initial: Holdings,
    /// What the walls have given so far.
    pub(super) walls_gave: Given,
    pub(super) counters: Counters,
    instructions: Instructions,
    pub(super) asleep: bool,
    pub(super) volumes: bool,
}

/// Two bodies that begin so near to each other that springs between them would begin compressed.
fn too_near(scene: &Scene, [body, other]: [usize; 2], [distance, least]: [f64; 2]) -> SceneError {
    let name = |body: usize| &scene.bodies[body].name;
    let unit = match scene.units.label(Dimension::Length) {
        "" => String::new(),
        unit => format!(" {unit}"),
    };
    let value = format!("that of `{}`, {distance:.3e}{unit} from `{}`", name(body), name(other));
    let wanted = format!(
        "bodies must be at least {least:.3e}{unit} apart, an eighth of a cell: move one of them away, or take \
         smaller cells"
    );
    SceneError::new(format!("bodies.{body}.centre"), value, &wanted)
}

impl Simulation {
    /// A scene at t = 0.
    ///
    /// # Errors
    /// What [`Scene::validate`] finds.
    pub fn new(scene: &Scene) -> Result<Self, SceneError> {
        scene.validate()?;
        let (mesh, groups) = Mesh::new(scene);
        let volumes = scene.method.density == Density::Hybrid;
        let mut state = State::zeros(mesh.len);
        state.rho.fill(1.0);
        for piece in &mesh.pieces {
            // Inert particles of the last eight too: they are evaluated with the others.
            state.rho[piece.range.clone()].fill(mesh.bodies[piece.body].rho_0);
        }
        for (body, data) in mesh.bodies.iter().zip(&scene.bodies) {
            for i in body.nodes.clone().chain(body.centroids.clone()) {
                state.u[i] = data.energy;
                if data.noise > 0.0 {
                    state.vx[i] = data.noise * scatter(3 * i as u64);
                    state.vy[i] = data.noise * scatter(3 * i as u64 + 1);
                    state.vz[i] = data.noise * scatter(3 * i as u64 + 2);
                }
                if data.spin != [0.0; 3] {
                    let x = body.lattice.position(mesh.place(i).1);
                    let v = cross(data.spin, std::array::from_fn(|d| x[d] - data.centre[d]));
                    state.vx[i] += v[0];
                    state.vy[i] += v[1];
                    state.vz[i] += v[2];
                }
            }
        }
        let surfaces = Surfaces::new(&mesh, volumes);
        if let Some((body, [far, most])) = surfaces.too_wide(&mesh) {
            let given = format!("corners {far:.3e} from the middle of a face");
            let wanted = format!("another body must find one within {most:.3e}: cells more alike");
            return Err(SceneError::new(format!("bodies.{body}.mapping"), given, &wanted));
        }
        let mut simulation = Self {
            derived: Derived::zeros(mesh.len),
            sums: Sums::zeros(mesh.len),
            contacts: Contacts::new(&mesh, &scene.method),
            surfaces,
            walls: Wall::all(scene, &mesh),
            active: vec![true; mesh.pieces.len()],
            touched: vec![false; mesh.len],
            stirring: Vec::new(),
            allowed: Allowed::ANYTHING,
            demand: Demand::NONE,
            pushed: [0.0; 2],
            votes: Votes::default(),
            method: scene.method,
            time: 0.0,
            dt: 0.0,
            kick: 0.0,
            free_dt: 0.0,
            smallest_step: SMALLEST_STEP * scene.stop_time,
            leap: outset::leap(&mesh, &state),
            element_work: 0.0,
            element_heat: 0.0,
            spring_work: 0.0,
            spring_heat: 0.0,
            initial: Holdings::default(),
            walls_gave: Given::default(),
            counters: Counters::default(),
            instructions: Instructions::detect(),
            asleep: true,
            volumes,
            mesh,
            groups,
            state,
        };
        for wall in &simulation.walls {
            wall.mirror(&simulation.mesh, &mut simulation.contacts);
        }
        simulation.respond(simulation.end());
        simulation.touch(&mut |_| {});
        if let Some((bodies, [distance, least])) =
            simulation.surfaces.too_close(&simulation.mesh, &simulation.contacts)
        {
            return Err(too_near(scene, bodies, [distance, least]));
        }
        simulation.active =
            (0..simulation.mesh.pieces.len()).map(|p| simulation.stirs(p)).collect();
        simulation.wake();
        simulation.start_books();
        Ok(simulation)
    }

    /// Computes material at rest as well, which changes no bit of the answer.
    pub fn keep_awake(&mut self) {
        self.active.fill(true);
        self.groups.iter_mut().for_each(|group| group.awake = true);
        self.asleep = false;
    }

    /// Computes with these instructions if the processor has them, which changes no bit of the answer.
    pub fn compute_with(&mut self, instructions: Instructions) {
        if Instructions::available().any(|own| own == instructions) {
            self.instructions = instructions;
        }
    }

    /// Whether anything moves in a piece, in the frame of its body, or is pushed or under pressure.
    fn stirs(&self, piece: usize) -> bool {
        let range = self.mesh.pieces[piece].range.clone();
        let any = |column: &[f64]| column[range.clone()].iter().any(|&x| x != 0.0);
        let state = &self.state;
        let moves = any(&state.vx) || any(&state.vy) || any(&state.vz);
        let pushed = || any(&self.sums.fx) || any(&self.sums.fy) || any(&self.sums.fz);
        moves || pushed() || any(&self.derived.pressure)
    }

    /// Wakes groups that touch a stirring piece, and the pieces that they touch.
    fn wake(&mut self) {
        if !self.asleep {
            return;
        }
        let mut stirring = std::mem::take(&mut self.stirring);
        stirring.clear();
        stirring.extend((0..self.active.len()).map(|p| self.active[p] && self.stirs(p)));
        self.asleep = false;
        for group in self.groups.iter_mut().filter(|group| !group.awake) {
            let last = u32::from(group.lanes);
            let corners = group.rows.into_iter().flat_map(|r| [r, r + last]);
            let all = corners.chain([group.centre, group.centre + last - 1]);
            let own = all.map(|i| self.mesh.piece_of(i as usize));
            if own.clone().any(|p| stirring[p]) {
                group.awake = true;
                own.for_each(|p| self.active[p] = true);
            } else {
                self.asleep = true;
            }
        }
        self.stirring = stirring;
    }

    /// Takes one step, at most to the time `until`: compatible leapfrog (decision 0012). At that time
    /// or later there is no step.
    ///
    /// # Errors
    /// A numerical failure.
    pub fn step(&mut self, until: f64) -> Result<(), StepError> {
        self.step_by_phases(until, &mut |_| {})
    }

    /// [`Simulation::step`], and `enter` is told whenever a phase begins.
    ///
    /// # Errors
    /// A numerical failure.
    pub fn step_by_phases(
        &mut self,
        until: f64,
        enter: &mut impl FnMut(Phase),
    ) -> Result<(), StepError> {
        if until <= self.time {
            return Ok(());
        }
        self.load(enter);
        enter(Phase::Control);
        self.tear();
        let dt = self.elect(until)?;
        let arrival = self.keep_in(dt);
        // What a contact or a wall pushes strains elements in this step already.
        self.wake();
        self.advance(enter);
        self.touch(enter);
        enter(Phase::Control);
        self.allowed.density = self.allowed.density.min(arrival);
        self.time = if dt >= until - self.time { until } else { self.time + dt };
        self.bury(enter);
        self.wake();
        self.count();
        self.check()
    }

    /// Steps until `time`, which is reached exactly.
    ///
    /// # Errors
    /// The first numerical failure.
    pub fn advance_to(&mut self, time: f64) -> Result<(), StepError> {
        while self.time < time {
            self.step(time)?;
        }
        Ok(())
    }

    fn laws(&self, dt: f64) -> Laws {
        Laws { method: self.method, volumes: self.volumes, dt }
    }

    /// Forces on all particles: elements, then contacts.
    fn load(&mut self, enter: &mut impl FnMut(Phase)) {
        enter(Phase::Elements);
        let pass = Load {
            laws: self.laws(self.dt),
            read: Read {
                displacement: [&self.state.dx, &self.state.dy, &self.state.dz],
                velocity: [&self.state.vx, &self.state.vy, &self.state.vz],
                grip: &self.derived.grip,
                theta: &self.derived.theta,
                sound: &self.derived.sound,
                rho: &self.derived.rho,
            },
        };
        let (mesh, groups) = (&self.mesh, &mut self.groups);
        let [even, odd] = COLOURS.map(|colour| {
            let sums = self.sums.slices();
            over_elements(&pass, (mesh, colour), groups, sums, self.instructions)
        });
        self.demand = even.and(odd);
        self.element_heat += self.demand.heat;
        let columns = (&self.state, &self.derived);
        // Of the longest next kick. Before the first step nothing is known of it, and where no volumes carry the
        // pressure the viscosity of contacts is that of the method: there they vote.
        let longest = 0.5 * (self.dt + GROWTH * self.free_dt);
        let damping = if self.volumes && longest > 0.0 { 1.0 / longest } else { f64::INFINITY };
        enter(Phase::Contacts);
        let (contacts, lessened) = self.contacts.push(
            &self.mesh,
            columns,
            (&self.method, self.dt, damping),
            (&mut self.sums, &mut self.touched, &mut self.active),
        );
        enter(Phase::Springs);
        let [rate, heat] = self.surfaces.push(
            (&self.mesh, &self.contacts),
            columns,
            (&self.method, self.dt.max(self.free_dt)),
            (&mut self.sums, &mut self.touched, &mut self.active),
        );
        self.pushed = [contacts, rate];
        self.counters.lessened += lessened;
        self.spring_heat += heat;
    }

    /// The length of the step: what sound, the density and the elements allow, and landing on `until`.
    fn elect(&mut self, until: f64) -> Result<f64, StepError> {
        let mut sound = self.allowed.sound;
        for body in &self.mesh.bodies {
            sound = sound.min(CROSSING * body.edge() / body.solid.sound);
        }
        let cfl = self.method.cfl;
        let [contacts, springs] = self.pushed;
        let after = |rate: f64| if rate > 0.0 { cfl / rate } else { f64::INFINITY };
        let growth = if self.dt > 0.0 { GROWTH * self.free_dt } else { f64::INFINITY };
        if self.dt == 0.0 {
            // No step has found rates of density yet.
            let of = (&self.mesh, &self.groups[..]);
            self.allowed.density = outset::first(of, (&self.state, &self.contacts), &self.walls);
        }
        let dt = self.votes.cast([
            (Voter::Sound, cfl * sound),
            (Voter::Density, self.allowed.density),
            (Voter::Elements, after(self.demand.rate)),
            (Voter::Contacts, after(contacts)),
            (Voter::Springs, after(springs)),
            (Voter::Leap, self.leap),
            (Voter::Growth, growth),
        ]);
        self.free_dt = dt;
        let floor = self.smallest_step;
        if dt.is_nan() || dt < floor {
            let (particle, time, value) = (self.soonest(), self.time, dt);
            let limiter = self.votes.last.map_or("nothing", Voter::cause);
            return Err(StepError::TimeStep { particle, time, value, floor, limiter });
        }
        // The kick also takes half of the last drift: where that was much longer, a shorter one follows.
        let bearable = (2.0 * dt / cfl - self.dt).max(LEAST_PART * dt);
        let dt = self.votes.shorten(dt, Voter::Kick, bearable);
        let left = until - self.time;
        // The last two steps share what is left, so that none is tiny.
        let share = if dt >= left { left } else { 0.5 * left };
        Ok(if 2.0 * dt > left { self.votes.shorten(dt, Voter::Landing, share) } else { dt })
    }

    /// Sets the length of the step; walls push what would cross them. Returns the longest next step by what nears them.
    fn keep_in(&mut self, dt: f64) -> f64 {
        if self.dt == 0.0 && self.volumes {
            let of = (&self.mesh, &self.groups[..]);
            let volume = &mut self.derived.volume;
            volumes::look_back(of, &self.state, (&self.method, dt), volume);
        }
        self.kick = 0.5 * (self.dt + dt);
        self.dt = dt;
        let mut arrival = f64::INFINITY;
        for wall in &self.walls {
            let next = wall.keep(
                (&self.mesh, &self.contacts),
                (&self.state, &mut self.sums),
                [self.kick, dt, GROWTH * self.free_dt],
                &mut self.walls_gave,
                |i, stopped| {
                    self.active[self.mesh.piece_of(i)] = true;
                    self.touched[i] |= stopped;
                },
            );
            arrival = arrival.min(next);
        }
        for (given, torque) in self.walls_gave.moment.iter_mut().zip(self.contacts.barred()) {
            *given -= self.kick * torque;
        }
        arrival
    }

    /// The rest of the step in one pass through memory: velocities at the middle of the next drift,
    /// Eq. (74); rates over the mean velocity, by which what forces take from motion becomes heat,
    /// pressure work and strain; Eqs. (36), (58), (76), and the equation of state (22).
    fn advance(&mut self, enter: &mut impl FnMut(Phase)) {
        let (mesh, state, sums) = (&self.mesh, &self.state, &mut self.sums);
        let half = 0.5 * self.kick;
        let force = [&sums.fx, &sums.fy, &sums.fz];
        let mean = |i: usize| {
            let v = [state.vx[i], state.vy[i], state.vz[i]];
            std::array::from_fn(|d| v[d] + half / mesh.mass(i) * force[d][i])
        };
        enter(Phase::Work);
        self.contacts.work(mesh, mean, self.kick, (&mut sums.rho_rate, &mut sums.heat));
        enter(Phase::Springs);
        let of = (mesh, &self.contacts);
        self.spring_work += self.surfaces.work(of, mean, self.kick, &mut sums.heat);
        enter(Phase::Motion);
        self.contacts.turn(mesh, [self.kick, self.dt]);
        let pass = Motion {
            laws: self.laws(self.kick),
            works: self.method.integrator == Integrator::Compatible,
            particles: Particles {
                mesh,
                active: &self.active,
                touched: &self.touched,
                volumes: self.volumes,
                stage: self.end(),
            },
        };
        let groups = &mut self.groups;
        let [even, odd] = COLOURS.map(|colour| {
            let columns = (self.state.slices(), self.derived.slices(), self.sums.slices());
            over_elements(&pass, (&self.mesh, colour), groups, columns, self.instructions)
        });
        let moved = Motion::and(even, odd);
        self.element_work += self.kick * moved.power;
        self.allowed = moved.allowed;
    }

    /// How the step ends.
    fn end(&self) -> Stage {
        // The kick is the mean of two drifts; the first step has a drift of its own length before it.
        let before = match 2.0 * self.kick - self.dt {
            _ if self.counters.steps == 0 => self.dt,
            before if before > SHORT * self.dt => before,
            _ => 0.0,
        };
        let lengths = Lengths { before, kick: self.kick, drift: self.dt };
        match self.method.density {
            Density::Kernel => Stage::Moved(lengths),
            Density::Nonholonomic | Density::Hybrid => Stage::Whole(lengths),
        }
    }

    /// The particles that may touch at the new positions, and the density, if they give it.
    fn touch(&mut self, enter: &mut impl FnMut(Phase)) {
        enter(Phase::List);
        for body in &mut self.mesh.bodies {
            for (way, velocity) in body.way.iter_mut().zip(body.velocity) {
                *way += self.dt * velocity;
            }
        }
        self.contacts.refresh(&self.mesh, &self.state, &self.method);
        if self.method.density == Density::Kernel {
            enter(Phase::Kernel);
            let rho = &mut self.derived.rho;
            self.counters.kernel_evaluations +=
                self.contacts.sum_density(&self.mesh, &self.state, rho);
            let Allowed { sane, floored, packed, .. } = self.allowed;
            self.respond(Stage::State(self.dt));
            self.allowed = Allowed { sane, floored, packed, ..self.allowed };
        }
        self.touched.fill(false);
    }

    /// The response of all particles, elements apart.
    fn respond(&mut self, stage: Stage) {
        let particles = Particles {
            mesh: &self.mesh,
            active: &self.active,
            touched: &self.touched,
            volumes: self.volumes,
            stage,
        };
        let columns = (self.state.slices(), self.derived.slices(), self.sums.slices());
        let work = Respond(particles, self.instructions);
        if let Some(allowed) = pieces(columns, 0, 0..self.mesh.pieces.len(), &work) {
            self.allowed = allowed;
        }
    }

    /// Gives the particles of elements whose damage grew in the step as much of their own tension back.
    fn tear(&mut self) {
        if !self.demand.tearing {
            return;
        }
        for group in self.groups.iter_mut().filter(|group| group.tearing != 0) {
            self.mesh.tear(group);
        }
    }

    /// Takes elements that died in the step out of the volumes, and lets their particles touch others.
    fn bury(&mut self, enter: &mut impl FnMut(Phase)) {
        if !self.demand.dying {
            return;
        }
        if self.contacts.rotates() {
            for group in self.groups.iter().filter(|group| self.volumes && group.dying != 0) {
                let particles = group.dying_lanes().flat_map(|lane| group.particles(lane));
                particles.for_each(|i| self.contacts.part(&self.mesh, &self.state, i));
            }
        }
        let mut buried = false;
        for group in self.groups.iter_mut().filter(|group| group.dying != 0) {
            if self.volumes {
                let volume = &mut self.derived.volume;
                volumes::forget((&self.mesh, group), &self.state, (&self.method, self.dt), volume);
            }
            for lane in group.dying_lanes() {
                self.mesh.bury(group.centre + lane);
                group.particles(lane).for_each(|i| self.contacts.expose(&self.mesh, i));
            }
            group.live &= !group.dying;
            group.dying = 0;
            buried = true;
        }
        if buried {
            self.contacts.let_go(&self.mesh);
            for group in &mut self.groups {
                group.look_beyond_the_dead(&self.mesh.ratio);
            }
            enter(Phase::List);
            self.contacts.open(&self.mesh, &self.state, &self.method);
            enter(Phase::Springs);
            let u = &mut self.state.u;
            self.spring_heat += self.surfaces.release(&self.mesh, &self.contacts, u);
            enter(Phase::Control);
        }
    }

    fn count(&mut self) {
        self.counters.steps += 1;
        self.votes.count();
        self.counters.particle_steps += self.moving() as u64;
        self.counters.pairs += self.contacts.pairs() as u64;
        self.counters.floored += u64::from(self.allowed.floored);
        self.counters.packed += u64::from(self.allowed.packed);
    }

    /// Of the eight particles that decide the step the one that sound crosses soonest.
    fn soonest(&self) -> usize {
        let Derived { rho, sound, .. } = &self.derived;
        let haste = |i: usize| rho[i] * sound[i];
        let first = self.allowed.first;
        (first..first + LANES).max_by(|&i, &j| haste(i).total_cmp(&haste(j))).unwrap_or(first)
    }

    /// Names the particle that is no longer a number.
    fn check(&self) -> Result<(), StepError> {
        if self.allowed.sane {
            return Ok(());
        }
        let columns = self.state.named();
        let bad = |column: &[f64]| self.mesh.real().find(|&i| !column[i].is_finite());
        for (quantity, column) in columns {
            if let Some(particle) = bad(column) {
                let value = column[particle];
                return Err(StepError::NotFinite { quantity, particle, time: self.time, value });
            }
        }
        Ok(())
    }

    /// Present time.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Number of particles, those at rest included.
    #[must_use]
    pub fn particles(&self) -> usize {
        self.mesh.particles
    }

    /// Number of elements, dead ones included.
    #[must_use]
    pub fn elements(&self) -> usize {
        self.mesh.elements
    }

    /// Work done so far.
    #[must_use]
    pub fn counters(&self) -> Counters {
        self.counters
    }

    /// Length of the last step.
    #[must_use]
    pub fn last_step(&self) -> f64 {
        self.dt
    }

    /// Votes on the last step, and who decided those so far.
    #[must_use]
    pub fn votes(&self) -> &Votes {
        &self.votes
    }

    /// Elements that have failed, and those of them that are no volume any more.
    #[must_use]
    pub fn failed(&self) -> (usize, usize) {
        let count = |f: fn(&Group) -> u32| self.groups.iter().map(f).sum::<u32>() as usize;
        let dead = count(|g| u32::from(g.lanes) - g.live.count_ones());
        (count(|g| g.failed.count_ones()), dead)
    }

    /// Bytes of memory that it holds.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.state.bytes()
            + self.derived.bytes()
            + self.sums.bytes()
            + self.groups.capacity() * std::mem::size_of::<Group>()
            + self.contacts.bytes()
            + self.surfaces.bytes()
            + self.mesh.bytes()
            + self.touched.capacity()
            + self.stirring.capacity()
    }
}

/// A number from -1 to 1 that looks random: the finaliser of `SplitMix64`.
fn scatter(k: u64) -> f64 {
    let mut z = (k + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    (z ^ z >> 31) as f64 / 2f64.powi(63) - 1.0
}
