//! Taylor impacts: rods that are shortened and spread by a rigid wall.

use whipple_solver::method::Preset;
use whipple_solver::space::method::Method;
use whipple_solver::space::scene::{
    Body, EosData, Failure, Flow, GammaLaw, Hold, Material, Scene, Shape, Side, Strength, Wall,
};
use whipple_solver::units::Units;

use super::figures::{curves, figure, histories, over, profiles};
use super::parts::discs::Discs;
use super::parts::schemes::{Error, Schemes};
use super::parts::{Columns, control, moments, resting, times};
use super::{Case, Claim, Claims, Kind, Level, Quantity, Wanted, Weight, run_of};
use crate::plots::{Along, Axis, Dash, Figure, Layer, Panel, Series as Curve};
use crate::record::{Records, RunKey, Series};
use crate::report::Table;
use crate::run::{Findings, RunError, SpaceDriver};
use crate::scene::AnyScene;

/// A case: one rod.
pub(super) struct Taylor {
    id: &'static str,
    title: &'static str,
    about: &'static str,
    source: &'static str,
    /// Diameter, length in cm, speed in cm/us.
    rod: [f64; 3],
    material: fn() -> Material,
    /// Final length in cm, foot radius in cm and where they come from.
    wanted: [f64; 2],
    reference: &'static str,
    /// How far from them is near enough, relative to them.
    share: f64,
    variants: &'static [&'static str],
}

const COPPER: &str = "taylor-copper";
const STEEL: &str = "taylor-42crmo4";
/// The rods are at rest, or leave the wall, before, us.
const STOP: f64 = 80.0;
/// Entries of the histories.
const ENTRIES: usize = 160;
/// Cells across.
const SIZES: [usize; 2] = [8, 12];
/// Which density is cheaper at equal error, against the length in the experiment, 16.2 mm of 25.4.
const SCHEMES: Schemes = Schemes {
    case: COPPER,
    sizes: &[SIZES[0]],
    error: Error::Off("length_mm", 16.2),
    name: "the length, against the experiment",
};
/// What is read off a state, in this order; lengths in mm.
const HISTORY: [&str; 8] =
    ["time", "length", "foot", "foot_left", "reach", "kinetic", "momentum", "dead"];
const HALF: &str = "viscosity-half";
const TWICE: &str = "viscosity-twice";
const VARIANTS: [&str; 5] = ["", HALF, TWICE, control::HOURGLASS, control::CENTRING];
/// Millimetres of a centimetre.
const MM: f64 = 10.0;
/// Where the bulge is measured, over the initial length.
const BULGE: f64 = 0.2;

/// The copper rod of Johnson and Cook.
pub(super) const COPPER_ROD: Taylor = Taylor {
    id: COPPER,
    title: "Taylor impact of copper",
    about: "A rod of OFHC copper, 7.62 mm by 25.4 mm, hits a rigid, frictionless wall at 190 m/s. \
            Johnson-Cook strength; no failure. n counts the cells across. Length: from the lowest to \
            the highest node of a live element, the mean over the last quarter of the run. The foot is \
            the lowest plane of the lattice, its radius that of the disc with the area of the faces in \
            it, which does not see how the rim of the circle is stepped: faces of elements that are dead \
            count as large as they were last seen live. The foot of live elements is that without the dead, \
            and the reach the farthest node of a live element from the axis. The final sizes \
            of the experiment, 0.638 of the length and 1.78 of the diameter, were read in a \
            transcription of digitised figures, not in the reports themselves: nothing required rests \
            on them. Variants have half and twice every coefficient of the viscosity; `hourglass-on` \
            has the drag against hourglass modes that solids without strength have, `centring-on` the \
            motion of centroids against their corners, with 0.05 of the stiffness of a cell.",
    source: "Johnson and Cook (1983), constants as in `references/materials.toml`, test as in \
             `references/taylor_impact.csv` (bbanerjee/HighRateExptData); equation of state of copper OFHC",
    rod: [0.762, 2.54, 0.019],
    material: copper,
    wanted: [1.62, 0.678],
    reference: "experiment, transcribed",
    share: 0.05,
    variants: &VARIANTS,
};

/// The steel rod of the codes.
pub(super) const STEEL_ROD: Taylor = Taylor {
    id: STEEL,
    title: "Taylor impact of 42CrMo4 steel",
    about: "A rod of 42CrMo4 steel, 6.4 mm by 32.4 mm, hits a rigid, frictionless wall at 287 m/s: a \
            benchmark of codes in Lagrangian coordinates, run to 80 us. Johnson-Cook strength; no failure. \
            n counts the cells across. Length, foot and reach are as in `taylor-copper`: elements of the \
            rim of the foot that are pressed flat cease to be volumes, their number is given, and the radius \
            that is judged counts them; that of the elements that are left alone stands beside it as a goal. The benchmark has no thermal pressure \
            and a linear elastic law: K = E/(3 (1 - 2 nu)), no Grueneisen coefficient, and the slope of \
            the Hugoniot of steel, as the solver takes none below 0.85; its heat fraction of 0.9 enters \
            as the specific heat over 0.9.",
    source: "DynELA manual, benchmark Taylor: DynELA 26.52 mm and 11.18 mm, Abaqus 26.55 mm and \
             11.22 mm in three dimensions; `references/taylor_impact.csv`",
    rod: [0.64, 3.24, 0.0287],
    material: steel,
    wanted: [2.65, 0.558],
    reference: "DynELA, Abaqus",
    share: 0.02,
    variants: &[""],
};

fn copper() -> Material {
    Material {
        name: "copper".into(),
        density: 8.96,
        eos: EosData::MieGruneisen {
            c0: 0.394,
            s: 1.489,
            gamma_0: 2.02,
            law: GammaLaw::ConstantProduct,
            c_v: 0.383e-5,
            theta_0: 300.0,
        },
        strength: Some(Strength {
            shear_modulus: 0.477,
            flow: Some(Flow::JohnsonCook {
                a: 0.0009,
                b: 0.00292,
                n: 0.31,
                c: 0.025,
                rate_0: 1e-6,
                m: 1.09,
                reference: 300.0,
                melt: 1356.0,
            }),
        }),
        failure: Failure::default(),
    }
}

fn steel() -> Material {
    let (young, poisson, density) = (2.069, 0.3, 7.83);
    let bulk: f64 = young / (3.0 * (1.0 - 2.0 * poisson));
    Material {
        name: "42CrMo4".into(),
        density,
        eos: EosData::MieGruneisen {
            c0: (bulk / density).sqrt(),
            s: 1.33,
            gamma_0: 0.0,
            law: GammaLaw::ConstantProduct,
            c_v: 0.46e-5 / 0.9,
            theta_0: 293.15,
        },
        strength: Some(Strength {
            shear_modulus: young / (2.0 * (1.0 + poisson)),
            flow: Some(Flow::JohnsonCook {
                a: 0.00806,
                b: 0.00614,
                n: 0.168,
                c: 0.0089,
                rate_0: 1e-6,
                m: 1.1,
                reference: 293.15,
                melt: 1813.15,
            }),
        }),
        failure: Failure::default(),
    }
}

/// Every coefficient of the viscosity times a factor.
fn varied(method: Method, variant: &str) -> Method {
    let factor = match variant {
        HALF => 0.5,
        TWICE => 2.0,
        _ => 1.0,
    };
    Method {
        visc_linear: factor * method.visc_linear,
        visc_quad: factor * method.visc_quad,
        visc_expansion: factor * method.visc_expansion,
        ..method
    }
}

/// The panel with the foot of live elements alone, where that is another.
fn with_the_live(panel: Panel, runs: &[(String, &Series)]) -> Panel {
    let feet = runs.iter().enumerate().filter_map(|(hue, (name, history))| {
        let left = history.points("time", "foot_left");
        let line = Curve::line(format!("{name}, live"), left.clone());
        (left != history.points("time", "foot")).then(|| line.styled(Dash::Dotted, hue))
    });
    feet.fold(panel, Panel::with)
}

impl Taylor {
    fn key(&self, preset: Preset, n: usize) -> RunKey {
        run_of(self.id, preset, n)
    }

    fn default_key(&self, n: usize) -> RunKey {
        self.key(Preset::Default, n)
    }
}

impl Case for Taylor {
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
        SIZES[0]
    }

    fn scene(&self, preset: Preset, variant: &str, n: usize) -> AnyScene {
        let [diameter, length, speed] = self.rod;
        let along = (length / diameter * n as f64).round() as usize;
        let material = (self.material)();
        let shape = Shape::Cylinder { diameter, length };
        let rod = Body {
            velocity: [0.0, 0.0, -speed],
            ..resting(&material.name, shape, [n, n, along], [0.0, 0.0, 0.5 * length])
        };
        Scene {
            name: self.id.into(),
            units: Units::CmGUsMbar,
            stop_time: STOP,
            method: varied(control::controlled(preset.space(), variant), variant),
            walls: vec![Wall { axis: 2, position: 0.0, material: Side::Above, hold: Hold::Rest }],
            materials: vec![material],
            bodies: vec![rod],
        }
        .into()
    }

    fn measure_space(
        &self,
        scene: &Scene,
        _: &RunKey,
        driver: &mut SpaceDriver<'_>,
    ) -> Result<Findings, RunError> {
        let [_, length, _] = self.rod;
        let mut discs = Discs::new(driver.solver());
        let mut history = Columns::default();
        for time in times(scene.stop_time, ENTRIES) {
            driver.advance_to(time)?;
            let mut now = driver.look(|solver, balance| {
                let rod = discs.look(solver);
                let foot = rod.foot();
                let mut row = vec![
                    solver.time(),
                    MM * rod.length,
                    MM * foot.radius,
                    MM * foot.left,
                    MM * rod.reach,
                    balance.now.kinetic / balance.initial.kinetic,
                    balance.now.momentum[2],
                    solver.failed().1 as f64,
                ];
                // A run that goes on has not seen the elements that are dead by then.
                row.extend(discs.memory());
                row
            })?;
            discs.recall(&now.split_off(HISTORY.len()));
            history.read(&HISTORY, &now);
        }
        let rod = discs.look(driver.solver());
        let foot = rod.foot();
        let lengths = history.column("length");
        let shortest = lengths.iter().copied().fold(f64::INFINITY, f64::min);
        // A rod that has left the wall rings.
        let (last, _) = moments(&lengths[lengths.len() - ENTRIES / 4..]);
        let strains = driver.solver().all_elements().filter(|e| e.live).map(|e| e.strain);
        let mut findings = Findings::default();
        findings.enter("length_ratio", last / (MM * length));
        findings.enter("length_mm", last);
        findings.enter("shortest_mm", shortest);
        findings.enter("foot_radius_mm", MM * foot.radius);
        findings.enter("foot_left_mm", MM * foot.left);
        findings.enter("foot_reach_mm", MM * rod.reach);
        findings.enter("bulge_radius_mm", MM * rod.radius_at(BULGE * length));
        findings.enter("largest_strain", strains.fold(0.0, f64::max));
        findings.enter("dead_elements", driver.solver().failed().1 as f64);
        let mut profile = Columns::default();
        for section in rod.sections.iter().filter(|s| s.height.is_finite()) {
            profile.row([("height", MM * section.height), ("radius", MM * section.radius)]);
        }
        findings.history = Some(history.series());
        findings.profile = Some(profile.series());
        Ok(findings)
    }

    fn units(&self) -> &'static [(&'static str, &'static str)] {
        &[
            ("time", "µs"),
            ("length", "mm"),
            ("foot", "mm"),
            ("foot_left", "mm"),
            ("reach", "mm"),
            ("kinetic", ""),
            ("momentum", "g·cm/µs"),
            ("dead", ""),
            ("height", "mm"),
            ("radius", "mm"),
        ]
    }

    fn draws(&self, _: &RunKey) -> bool {
        true
    }

    fn runs(&self, level: Level) -> Vec<RunKey> {
        let mut keys = vec![self.default_key(SIZES[0])];
        if level >= Level::Standard {
            let others = self.variants[1..].iter();
            keys.extend(others.map(|v| self.default_key(SIZES[0]).variant(v)));
            keys.push(self.default_key(SIZES[1]));
            keys.push(self.key(Preset::Paper, SIZES[0]));
        }
        if level == Level::Full && self.id == COPPER {
            keys.extend(SCHEMES.runs());
        }
        keys
    }

    fn claims(&self) -> Vec<Claim> {
        let mut out = Vec::new();
        let plain = || self.default_key(SIZES[0]);
        let must = Claims::new(self.id, Kind::Verification, Weight::Must, wanted!());
        if self.id == COPPER {
            let others = [
                ("12 against 8 cells across", self.default_key(SIZES[1])),
                ("half the viscosity", plain().variant(HALF)),
                ("twice the viscosity", plain().variant(TWICE)),
            ];
            // 0.01 of the initial length, over a final length of two thirds of it.
            for (text, key) in others {
                out.push(must.claim(
                    format!("final length, {text}: change"),
                    Quantity::Change(key, plain(), "length_ratio"),
                    Wanted::WithinZero(0.015),
                ));
            }
            let answers = [("length_mm", "final length"), ("foot_radius_mm", "foot radius")];
            out.extend(control::claims(COPPER, &plain(), &answers));
        }
        let aim = Claims::new(self.id, Kind::Validation, Weight::Aim, self.reference);
        let codes = Claims { kind: Kind::Comparison, weight: Weight::Must, ..aim };
        let claims = if self.id == COPPER { aim } else { codes };
        for n in SIZES {
            let names = [("length_mm", "final length"), ("foot_radius_mm", "foot radius")];
            for ((name, text), wanted) in names.into_iter().zip(self.wanted) {
                out.push(claims.claim(
                    format!("{text} in mm, n = {n}, `default`"),
                    Quantity::Norm(self.default_key(n), name),
                    Wanted::Near(MM * wanted, self.share),
                ));
            }
        }
        // What a reader would measure on the elements that are left; of copper none dies.
        let left = Claims { weight: Weight::Aim, ..claims };
        for n in SIZES.into_iter().filter(|_| self.id == STEEL) {
            out.push(left.claim(
                format!("foot radius of live elements alone in mm, n = {n}, `default`"),
                Quantity::Norm(self.default_key(n), "foot_left_mm"),
                Wanted::Near(MM * self.wanted[1], self.share),
            ));
        }
        out.extend(super::conservation_in_space(self.id, &plain()));
        out
    }

    fn tabulated(&self) -> &'static [(&'static str, &'static str)] {
        &[
            ("length_mm", "length, mm"),
            ("length_ratio", "length / initial"),
            ("shortest_mm", "shortest, mm"),
            ("foot_radius_mm", "foot radius, dead elements counted, mm"),
            ("foot_left_mm", "foot of live elements, mm"),
            ("foot_reach_mm", "reach, mm"),
            ("bulge_radius_mm", "radius at 0.2 L, mm"),
            ("largest_strain", "largest plastic strain"),
            ("dead_elements", "dead elements"),
        ]
    }

    fn quantities(&self) -> &'static [(&'static str, &'static str)] {
        &[("length_mm", "final length, mm"), ("foot_radius_mm", "foot radius, mm")]
    }

    fn figures(&self, records: &Records) -> Vec<Figure> {
        let defaults = SIZES.map(|n| (format!("default, n = {n}"), self.default_key(n)));
        let paper = [("paper".to_owned(), self.key(Preset::Paper, SIZES[0]))];
        let runs: Vec<_> = defaults.into_iter().chain(paper).collect();
        let histories = histories(records, runs.clone());
        let panel = |x: &str, y: &str| Panel::new("", Axis::linear(x), Axis::linear(y));
        let measured = [("length", "length, mm"), ("foot", "foot radius, mm")];
        let panels = measured.into_iter().zip(self.wanted).filter_map(|((name, label), wanted)| {
            let panel = curves(panel("time, µs", label), over(&histories, "time", name))?;
            let panel = if name == "foot" { with_the_live(panel, &histories) } else { panel };
            let wanted = MM * wanted;
            Some(panel.with(Layer::Span {
                along: Along::Horizontal,
                limits: (wanted * (1.0 - self.share), wanted * (1.0 + self.share)),
                name: format!("{}, ± {} %", self.reference, 100.0 * self.share),
            }))
        });
        let profiles = profiles(records, runs);
        let outlines = over(&profiles, "radius", "height").map(|(name, side)| {
            let left = side.iter().map(|p| (-p.0, p.1));
            (name, left.chain(side.iter().rev().copied()).collect())
        });
        let shape = curves(panel("distance from the axis, mm", "height, mm"), outlines);
        let caption = "Length, foot radius (dotted: of live elements alone, where others are dead), and \
                       outline at the end: radii of the discs with the area of the sections, dead \
                       elements counted.";
        figure(format!("{}-shape", self.id), caption, panels.chain(shape.map(Panel::equal)))
    }

    fn extra_tables(&self, records: &Records) -> Vec<Table> {
        SCHEMES.table(records).filter(|_| self.id == COPPER).into_iter().collect()
    }
}
