//! The exact profile of a case at any places, asked of the case itself.
//!
//! Cases along a line compare their particles with the exact state where these are, and give both. So a cold gas that
//! rests with particles at the places asked for, and goes nowhere since nothing acts on it, is measured by the case:
//! what it gives as exact is the answer there. No case needs code of its own for this.

use std::collections::BTreeMap;

use whipple_solver::method::Preset;
use whipple_solver::scene::{
    Body, Boundaries, Boundary, EosData, Interface, Layout, Material, Profile, Scene,
};

use crate::cases::{ALL, Case};
use crate::record::{RunKey, Scheme};
use crate::run::{Driver, RunError, Silent};

/// Ending of the columns that hold exact fields.
const EXACT: &str = "_exact";
/// Places over the case that are asked along with others: norms of a case want particles in its windows.
const BACKGROUND: usize = 400;
/// Places that are asked at once: a scene has only so many bodies.
const AT_ONCE: usize = 50_000;

/// Exact fields by name, one value a place.
pub type Fields = BTreeMap<String, Vec<f64>>;

/// Who knows the exact profile of a case.
pub struct Answer {
    case: &'static dyn Case,
    scene: Scene,
    key: RunKey,
}

impl Answer {
    /// That of a variant of a case; none if the case has no exact profile along a line.
    ///
    /// # Errors
    /// Whatever the case says.
    pub fn of(case: &'static dyn Case, variant: &str) -> Result<Option<Self>, RunError> {
        let n = case.default_size();
        let scene = case.scene(Preset::Default, variant, n);
        let Some(scene) = scene.line().cloned() else { return Ok(None) };
        let key = RunKey::new(case.id(), Scheme::preset(Preset::Default), n).variant(variant);
        let answer = Self { case, scene, key };
        // Without a density there is no profile of a flow.
        match answer.at(&answer.background(), answer.end()) {
            Ok(fields) if fields.contains_key("density") => Ok(Some(answer)),
            Ok(_) | Err(RunError::NotThere { .. }) => Ok(None),
            Err(other) => Err(other),
        }
    }

    /// The end time of the case.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.scene.stop_time
    }

    /// Whether the case knows the answer at a time other than its end: some know one time alone, and say the same
    /// of any.
    ///
    /// # Errors
    /// Whatever the case says.
    pub fn knows(&self, time: f64) -> Result<bool, RunError> {
        let places = self.background();
        Ok(time == self.end() || self.at(&places, time)? != self.at(&places, self.end())?)
    }

    /// Exact fields at places that increase, at a time.
    ///
    /// # Errors
    /// Whatever the case says, such as of places behind its wall.
    pub fn at(&self, x: &[f64], time: f64) -> Result<Fields, RunError> {
        let mut out = Fields::new();
        for places in x.chunks(AT_ONCE) {
            for (name, values) in self.ask(places, time)? {
                out.entry(name).or_default().extend(values);
            }
        }
        Ok(out)
    }

    /// Places over the bodies of the case, in the middle of equal cells.
    fn background(&self) -> Vec<f64> {
        let bodies = &self.scene.bodies;
        let from = bodies.iter().map(|body| body.from).fold(f64::INFINITY, f64::min);
        let to = bodies.iter().map(|body| body.to).fold(f64::NEG_INFINITY, f64::max);
        let place = |k: usize| from + (to - from) * (k as f64 + 0.5) / BACKGROUND as f64;
        (0..BACKGROUND).map(place).collect()
    }

    fn ask(&self, x: &[f64], time: f64) -> Result<Fields, RunError> {
        let mut places = self.background();
        places.extend(x);
        places.sort_by(f64::total_cmp);
        places.dedup();
        if !places.len().is_multiple_of(2) {
            let [.., before, last] = places[..] else { return Ok(Fields::new()) };
            places.insert(places.len() - 1, 0.5 * (before + last));
        }
        let mut wanted = self.scene.clone();
        wanted.stop_time = time;
        let still = self.still(&places, time);
        let mut driver = Driver::new(&still, &Silent)?;
        let findings = self.case.measure(&wanted, &self.key, &mut driver)?;
        let Some(profile) = findings.profile.filter(|p| p.0.contains_key("x")) else {
            return Ok(Fields::new());
        };
        let index = |x: &f64| places.partition_point(|place| place < x);
        let exact = profile.0.iter().filter_map(|(name, all)| {
            let name = name.strip_suffix(EXACT)?;
            let values = x.iter().map(|x| all.get(index(x)).copied().unwrap_or(f64::NAN));
            Some((name.to_owned(), values.collect()))
        });
        Ok(exact.collect())
    }

    /// Cold gas at rest: two particles a body, at its ends.
    fn still(&self, places: &[f64], time: f64) -> Scene {
        let gas = EosData::IdealGas { adiabatic_index: 1.4, c_v: 1.0, u_0: 1.0, theta_0: 0.0 };
        let body = |ends: &[f64]| Body {
            material: "gas".into(),
            from: ends[0],
            to: ends[1],
            particles: 2,
            layout: Layout::Nodes,
            compression: 1.0,
            interface: Interface::Contact,
            velocity: Profile::Uniform(0.0),
            energy: Profile::Uniform(1.0),
        };
        Scene {
            stop_time: time,
            boundaries: Boundaries { left: Boundary::Free, right: Boundary::Free },
            materials: vec![Material { name: "gas".into(), density: 1.0, eos: gas }],
            bodies: places.chunks_exact(2).map(body).collect(),
            ..self.scene.clone()
        }
    }
}

/// Names of the cases that have an exact profile.
#[must_use]
pub fn known() -> Vec<&'static str> {
    let knows = |case: &&&'static dyn Case| matches!(Answer::of(**case, ""), Ok(Some(_)));
    ALL.iter().filter(knows).map(|case| case.id()).collect()
}
