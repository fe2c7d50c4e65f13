//! Gas problems: regions of uniform or linear initial states, and an exact answer at every point.

use whipple_solver::method::Preset;
use whipple_solver::output::Snapshot;
use whipple_solver::scene::{
    Body, Boundaries, Boundary, EosData, Interface, Layout, Material, Profile, Scene,
};
use whipple_solver::units::Units;

use super::figures::{exact_line, extent};
use super::{
    Case, Claim, Claims, Eulerian, Kind, Level, Quantity, Wanted, Weight, conservation, default_run,
};
use crate::exact::Gas;
use crate::exact::riemann::Riemann;
use crate::godunov::{self, Domain, Godunov};
use crate::norms;
use crate::plots::{Axis, Figure, Panel, Series as Curve};
use crate::record::{Records, RunKey, Scheme, Series};
use crate::run::{Driver, Findings, RunError};
use crate::scene::AnyScene;

/// Time-step factor of the Godunov code.
const GODUNOV_CFL: f64 = 0.5;

/// Internal energy that stands for cold gas where the exact solution has none: a pressure that no
/// norm can see.
pub(super) const COLD_PRESSURE: f64 = 1e-14;

/// A stretch of gas.
#[derive(Debug, Clone, Copy)]
pub(super) struct Region {
    /// Left and right face.
    pub span: (f64, f64),
    /// State at x = 0, or everywhere.
    pub gas: Gas,
    /// Change of the velocity per length.
    pub gradient: f64,
    /// Share of the particles.
    pub share: f64,
}

/// Exact state at a position and time.
pub(super) type ExactState = Box<dyn Fn(f64, f64) -> Result<Gas, RunError> + Sync>;

/// A problem, for one variant.
pub(super) struct Setup {
    /// Regions from left to right, joined.
    pub regions: Vec<Region>,
    /// Ends.
    pub ends: Boundaries,
    /// Internal energy of the cold gas: without it the viscosity of the paper has nothing to act
    /// on in cold gas, whose sound speed would be zero.
    pub u_0: f64,
    /// End time.
    pub time: f64,
    /// Exact state at a position and time.
    pub exact: ExactState,
}

/// Numbers of particles.
pub(super) struct Sizes {
    /// For the quick level.
    pub quick: &'static [usize],
    /// For the others.
    pub standard: &'static [usize],
    /// The one whose profiles are drawn.
    pub drawn: usize,
    /// More cells for the Godunov code, at the full level.
    pub fine: &'static [usize],
}

/// A gas problem with its exact solution.
pub(super) struct GasProblem {
    pub id: &'static str,
    pub title: &'static str,
    pub about: &'static str,
    pub source: &'static str,
    pub variants: &'static [&'static str],
    pub sizes: Sizes,
    pub setup: fn(variant: &str) -> Result<Setup, RunError>,
    pub claims: fn() -> Vec<Claim>,
    /// What the answer is called: exact, or a reference.
    pub answer: &'static str,
    /// Whether the Godunov code can run it.
    pub eulerian: bool,
}

/// Columns of the norm tables: relative, mass-weighted L1 errors.
pub(super) const L1_NORMS: &[(&str, &str)] = &[
    ("density_l1", "L1 ρ"),
    ("velocity_l1", "L1 v"),
    ("pressure_l1", "L1 p"),
    ("energy_l1", "L1 u"),
];

/// A field: its name, its label in figures, and what it is of a state.
type Field = (&'static str, &'static str, fn(&Gas) -> f64);

/// What is compared and drawn.
const FIELDS: [Field; 4] = [
    ("density", "density", |g| g.density),
    ("velocity", "velocity", |g| g.velocity),
    ("pressure", "pressure", |g| g.pressure),
    ("energy", "specific internal energy", Gas::energy),
];

/// Both sides of a membrane, with equal particle spacing over the whole.
fn two_regions(left: (f64, Gas), membrane: f64, right: (f64, Gas)) -> Vec<Region> {
    let length = right.0 - left.0;
    let region = |span: (f64, f64), gas| Region {
        span,
        gas,
        gradient: 0.0,
        share: (span.1 - span.0) / length,
    };
    vec![region((left.0, membrane), left.1), region((membrane, right.0), right.1)]
}

/// Walls at both ends.
pub(super) fn walls(from: f64, to: f64) -> Boundaries {
    Boundaries { left: Boundary::Mirror(from), right: Boundary::Mirror(to) }
}

/// Sizes of a problem of the 1D study.
pub(super) const STUDIED: &[usize] = &[100, 200, 400];

/// Its claims: the L1 error of the density that the study reached at n = 200, and the order.
pub(super) fn studied(id: &'static str, bound: f64) -> Vec<Claim> {
    let study = "1D study, section 5: its best prototype at n = 200";
    let aim = Claims::new(id, Kind::Verification, Weight::Aim, study);
    let key = default_run(id, 200);
    let order = Claims { source: "first order in L1", weight: Weight::Must, ..aim };
    let keys = STUDIED.iter().map(|&n| default_run(id, n)).collect();
    let mut out = vec![
        aim.claim(
            "L1 ρ, n = 200, `default`",
            Quantity::Norm(key.clone(), "density_l1"),
            Wanted::AtMost(bound),
        ),
        order.claim(
            "order of L1 ρ, `default`",
            Quantity::Order(keys, "density_l1"),
            Wanted::AtLeast(0.8),
        ),
    ];
    out.extend(conservation(id, &key));
    out
}

/// The waves of a membrane that breaks at a place.
pub(super) fn membrane(left: Gas, place: f64, right: Gas) -> Result<ExactState, RunError> {
    let riemann = Riemann::new(left, right)?;
    Ok(Box::new(move |x, t| Ok(riemann.sample((x - place) / t).gas)))
}

impl Setup {
    /// Gases at rest or in motion on both sides of a membrane that breaks, between walls, until a
    /// time.
    pub(super) fn tube(
        left: (f64, Gas),
        place: f64,
        right: (f64, Gas),
        time: f64,
    ) -> Result<Self, RunError> {
        Ok(Self {
            regions: two_regions(left, place, right),
            ends: walls(left.0, right.0),
            u_0: 0.0,
            time,
            exact: membrane(left.1, place, right.1)?,
        })
    }

    /// The scene of the problem with `n` particles.
    pub(super) fn scene(&self, name: &str, preset: Preset, n: usize) -> Scene {
        let mut scene = Scene {
            name: name.into(),
            units: Units::None,
            stop_time: self.time,
            method: preset.method(),
            boundaries: self.ends,
            materials: Vec::new(),
            bodies: Vec::new(),
        };
        let mut placed = 0;
        let mut share = 0.0;
        for (k, region) in self.regions.iter().enumerate() {
            share += region.share;
            let until = (share * n as f64).round() as usize;
            let Gas { density, velocity, gamma, .. } = region.gas;
            let material = format!("gas {}", k + 1);
            scene.materials.push(Material {
                name: material.clone(),
                density,
                eos: EosData::IdealGas {
                    adiabatic_index: gamma,
                    c_v: 1.0,
                    u_0: self.u_0,
                    theta_0: 0.0,
                },
            });
            scene.bodies.push(Body {
                material,
                from: region.span.0,
                to: region.span.1,
                particles: until - placed,
                layout: Layout::Centres,
                compression: 1.0,
                interface: Interface::Joined,
                velocity: if region.gradient == 0.0 {
                    Profile::Uniform(velocity)
                } else {
                    Profile::Linear { at_origin: velocity, slope: region.gradient }
                },
                energy: Profile::Uniform(self.u_0 + region.gas.energy()),
            });
            placed = until;
        }
        scene
    }

    /// Relative L1 errors of fields, and the fields beside the exact ones.
    pub(super) fn compare(&self, time: f64, fields: &Fields) -> Result<Findings, RunError> {
        let exact: Vec<Gas> =
            fields.x.iter().map(|&x| (self.exact)(x, time)).collect::<Result<_, _>>()?;
        let columns = [&fields.density, &fields.velocity, &fields.pressure, &fields.energy];
        let mut findings = Findings::default();
        let mut profile = Series::default();
        profile.0.insert("x".into(), fields.x.clone());
        for ((name, _, of), found) in FIELDS.into_iter().zip(columns) {
            let wanted: Vec<f64> = exact.iter().map(of).collect();
            let errors: Vec<f64> = found.iter().zip(&wanted).map(|(f, w)| f - w).collect();
            let l1 = match norms::relative_l1(&errors, &fields.mass, &wanted) {
                // A field that is uniform in the exact solution has no range to divide by.
                Err(norms::NormError::NoMeasure { .. }) => {
                    norms::l1_weighted(&errors, &fields.mass)
                }
                other => other,
            }?;
            findings.norms.insert(format!("{name}_l1"), l1);
            profile.0.insert(format!("{name}_exact"), wanted);
            profile.0.insert(name.into(), found.clone());
        }
        findings.profile = Some(profile);
        Ok(findings)
    }

    /// The Godunov code on this problem, at t = 0.
    pub(super) fn godunov(&self, n: usize) -> Result<Godunov, RunError> {
        let (first, last) = (&self.regions[0], &self.regions[self.regions.len() - 1]);
        let end = |kind: Boundary, region: &Region| match kind {
            Boundary::Mirror(_) => godunov::Boundary::Wall,
            _ if region.gas.pressure > COLD_PRESSURE => godunov::Boundary::Outflow,
            _ => godunov::Boundary::Inflow(region.gas),
        };
        let domain = Domain {
            start: first.span.0,
            end: last.span.1,
            left: end(self.ends.left, first),
            right: end(self.ends.right, last),
            cfl: GODUNOV_CFL,
        };
        let width = (domain.end - domain.start) / n as f64;
        let cell = |k: usize| {
            let x = domain.start + (k as f64 + 0.5) * width;
            let region = self.regions.iter().find(|r| x < r.span.1).unwrap_or(last);
            Gas { velocity: region.gas.velocity + region.gradient * x, ..region.gas }
        };
        let cells: Vec<Gas> = (0..n).map(cell).collect();
        Ok(Godunov::new(domain, &cells)?)
    }
}

/// Fields of particles or cells.
pub(super) struct Fields {
    pub x: Vec<f64>,
    pub density: Vec<f64>,
    pub velocity: Vec<f64>,
    pub pressure: Vec<f64>,
    pub energy: Vec<f64>,
    pub mass: Vec<f64>,
}

impl Fields {
    /// Of particles, with the energy above that of the cold gas.
    pub(super) fn of_particles(s: Snapshot, u_0: f64) -> Self {
        let (density, velocity, pressure) = (s.rho, s.v, s.pressure);
        let energy = s.u.into_iter().map(|u| u - u_0).collect();
        Self { x: s.x, density, velocity, pressure, energy, mass: s.m }
    }

    pub(super) fn of_cells(code: &Godunov) -> Self {
        let column = |of: fn(&Gas) -> f64| code.cells().map(|g| of(&g)).collect::<Vec<f64>>();
        let density = column(|g| g.density);
        Self {
            x: code.centres().collect(),
            mass: density.iter().map(|rho| rho * code.width()).collect(),
            density,
            velocity: column(|g| g.velocity),
            pressure: column(|g| g.pressure),
            energy: column(Gas::energy),
        }
    }
}

/// Error of the energy balance of the Godunov code, relative to the energy that it has seen.
pub(super) fn eulerian_drift(code: &Godunov, before: [f64; 3]) -> f64 {
    let (now, inflow) = (code.totals(), code.inflow());
    ((now[2] - before[2] - inflow[2]) / (before[2].abs() + inflow[2].abs())).abs()
}

impl Case for GasProblem {
    fn id(&self) -> &'static str {
        self.id
    }

    fn title(&self) -> &'static str {
        self.title
    }

    fn about(&self) -> &'static str {
        self.about
    }

    fn source(&self) -> &'static str {
        self.source
    }

    fn variants(&self) -> &'static [&'static str] {
        self.variants
    }

    fn default_size(&self) -> usize {
        self.sizes.drawn
    }

    fn scene(&self, preset: Preset, variant: &str, n: usize) -> AnyScene {
        match (self.setup)(variant) {
            Ok(setup) => setup.scene(self.id, preset, n).into(),
            // Setups are constants of this crate; a test builds every one.
            Err(error) => unreachable!("{}: {error}", self.id),
        }
    }

    fn measure(
        &self,
        scene: &Scene,
        key: &RunKey,
        driver: &mut Driver<'_>,
    ) -> Result<Findings, RunError> {
        driver.advance_to(scene.stop_time)?;
        let setup = (self.setup)(&key.variant)?;
        let fields = Fields::of_particles(driver.solver().snapshot(), setup.u_0);
        setup.compare(scene.stop_time, &fields)
    }

    fn eulerian(&self, variant: &str, n: usize) -> Result<Eulerian, RunError> {
        if !self.eulerian {
            return Err(RunError::NotThere {
                case: self.id.into(),
                what: "the Godunov code".into(),
            });
        }
        let setup = (self.setup)(variant)?;
        let mut code = setup.godunov(n)?;
        let before = code.totals();
        let start = cpu_time::ProcessTime::now();
        code.advance_to(setup.time)?;
        let cpu = Some(start.elapsed());
        let findings = setup.compare(setup.time, &Fields::of_cells(&code))?;
        let work = code.work();
        let energy_drift = eulerian_drift(&code, before);
        Ok(Eulerian { findings, steps: work.steps, cell_steps: work.cell_steps, energy_drift, cpu })
    }

    fn runs(&self, level: Level) -> Vec<RunKey> {
        let sizes = if level == Level::Quick { self.sizes.quick } else { self.sizes.standard };
        let mut keys = Vec::new();
        for variant in self.variants {
            keys.extend(
                super::both_presets(self.id, sizes).into_iter().map(|k| k.variant(variant)),
            );
            let kernel = super::kernel_default();
            keys.push(RunKey::new(self.id, kernel, self.sizes.drawn).variant(variant));
            let godunov = |&n: &usize| RunKey::new(self.id, Scheme::Godunov, n).variant(variant);
            if self.eulerian {
                let fine = if level == Level::Full { self.sizes.fine } else { &[] };
                keys.extend(sizes.iter().chain(fine).map(godunov));
            }
        }
        keys
    }

    fn claims(&self) -> Vec<Claim> {
        (self.claims)()
    }

    fn tabulated(&self) -> &'static [(&'static str, &'static str)] {
        L1_NORMS
    }

    fn errors(&self) -> &'static [&'static str] {
        &["density_l1", "velocity_l1", "pressure_l1", "energy_l1"]
    }

    fn figures(&self, records: &Records) -> Vec<Figure> {
        self.variants.iter().filter_map(|v| self.figure(v, records)).collect()
    }
}

impl GasProblem {
    fn figure(&self, variant: &str, records: &Records) -> Option<Figure> {
        let n = self.sizes.drawn;
        let record = |scheme| records.get(&RunKey::new(self.id, scheme, n).variant(variant));
        let schemes = [Scheme::preset(Preset::Paper), Scheme::preset(Preset::Default)];
        let profile = |scheme| record(scheme).and_then(|r| Some((scheme, r.profile.as_ref()?)));
        let mut drawn: Vec<(Scheme, &Series)> = schemes.into_iter().filter_map(profile).collect();
        drawn.extend(profile(Scheme::Godunov));
        if drawn.is_empty() {
            return None;
        }
        let setup = (self.setup)(variant).ok()?;
        let named: Vec<(String, &Series)> =
            drawn.iter().map(|(s, run)| (s.label(), *run)).collect();
        let x = extent(&named, "x");
        let panels = FIELDS
            .map(|(name, label, of)| {
                let exact = |x: f64| (setup.exact)(x, setup.time).map(|gas| of(&gas));
                let mut panel = Panel::new("", Axis::linear("x"), Axis::linear(label));
                panel = panel.with(exact_line(self.answer, x, exact));
                for (scheme, profile) in &drawn {
                    panel = panel.with(curve(*scheme, profile.points("x", name)));
                }
                panel
            })
            .into();
        let id = if variant.is_empty() { self.id.into() } else { format!("{}-{variant}", self.id) };
        let what = if variant.is_empty() { String::new() } else { format!(" ({variant})") };
        let caption =
            format!("{}{what}: n = {n}, against the {} solution.", self.title, self.answer);
        Some(Figure::new(id, caption, panels))
    }
}

/// Particles as points, cells as a line.
pub(super) fn curve(scheme: Scheme, points: Vec<(f64, f64)>) -> Curve {
    match scheme {
        Scheme::Godunov => Curve::line(scheme.label(), points),
        Scheme::Particles { .. } => Curve::scatter(scheme.label(), points),
    }
}
