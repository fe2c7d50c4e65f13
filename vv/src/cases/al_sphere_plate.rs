//! An aluminium sphere through an aluminium plate: work that other programs were measured at.

use whipple_solver::method::Preset;
use whipple_solver::space::scene::Scene;
use whipple_solver::units::Units;

use super::parts::impact::{Impact, SPHERE_METAL, STOP};
use super::parts::perforation;
use super::{Case, Claim, Level, conservation_in_space, default_run};
use crate::plots::Figure;
use crate::record::{Records, RunKey};
use crate::references;
use crate::report::{Cell, Column, Table};
use crate::run::{Findings, RunError, SpaceDriver};
use crate::scene::AnyScene;

/// The case.
pub(super) struct AlSpherePlate;

const ID: &str = "al-sphere-plate";
/// Edge of the plate in cm.
const EDGE: f64 = 3.0;
/// Cells through the plate: as many particles as the other programs had, and cells of 0.59 mm.
const SIZES: [usize; 2] = [6, 8];

/// Other programs at this work.
const PEERS: &str = include_str!("../../../references/peer_sphere_plate_cost.csv");

/// Name of the table of other programs.
const PEERS_FILE: &str = "peer_sphere_plate_cost.csv";

impl Case for AlSpherePlate {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Aluminium sphere on an aluminium plate"
    }

    fn about(&self) -> &'static str {
        "A sphere of aluminium, 6.18 mm wide, hits a plate of the same of 30 x 30 x 4.7 mm straight on \
         with 7 km/s; 10 µs are run. Other programs were run on this: the case compares their cost with \
         ours. n counts the cells through the plate: 6 have as many particles as those programs, one \
         for each cube of 0.62 mm; 8 are cells of 0.59 mm. Strength and failure of both bodies are those of \
         the sphere in Table 6 of the paper, their spall strength that of 6061 in \
         `references/materials.toml`, off in `paper`. What is measured is what `rcc-plate` measures. No \
         constant was fitted to this case."
    }

    fn source(&self) -> &'static str {
        "set up for the comparison; `references/peer_sphere_plate_cost.csv`"
    }

    fn default_size(&self) -> usize {
        SIZES[0]
    }

    fn scene(&self, preset: Preset, _variant: &str, n: usize) -> AnyScene {
        let material = SPHERE_METAL.material();
        let materials = [material.name.as_str(); 2];
        let impact = Impact { edge: EDGE, through: n, aspect: 1, degrees: 0.0, materials };
        let bodies = impact.bodies();
        let scene = Scene {
            name: ID.into(),
            units: Units::CmGUsMbar,
            stop_time: STOP,
            method: preset.space(),
            walls: Vec::new(),
            materials: vec![material],
            bodies,
        };
        scene.into()
    }

    fn measure_space(
        &self,
        scene: &Scene,
        _key: &RunKey,
        driver: &mut SpaceDriver<'_>,
    ) -> Result<Findings, RunError> {
        perforation::measure(driver, scene, |_, _| Ok(()))
    }

    fn units(&self) -> &'static [(&'static str, &'static str)] {
        &perforation::UNITS
    }

    fn draws(&self, _: &RunKey) -> bool {
        false
    }

    fn runs(&self, level: Level) -> Vec<RunKey> {
        let sizes = if level == Level::Full { &SIZES[..] } else { &SIZES[..1] };
        sizes.iter().map(|&n| default_run(ID, n)).collect()
    }

    fn claims(&self) -> Vec<Claim> {
        let key = default_run(ID, SIZES[0]);
        let mut out = conservation_in_space(ID, &key);
        out.extend(perforation::claims(ID, &key));
        out
    }

    fn tabulated(&self) -> &'static [(&'static str, &'static str)] {
        &perforation::TABULATED
    }

    fn extra_tables(&self, records: &Records) -> Vec<Table> {
        peers(records).into_iter().collect()
    }

    fn figures(&self, _: &Records) -> Vec<Figure> {
        Vec::new()
    }
}

/// Cost of the other programs beside ours.
fn peers(records: &Records) -> Option<Table> {
    let others = references::Table::parse(PEERS_FILE, PEERS).ok()?;
    let texts = |name: &str| others.text(name).unwrap_or_default();
    let names = ["program", "particles", "updates_per_cpu_s", "cpu_s_to_10_us", "outcome"];
    let columns = names.map(texts);
    let mut rows: Vec<Vec<Cell>> = (0..others.row_count())
        .map(|row| columns.iter().map(|column| column[row].into()).collect())
        .collect();
    for record in SIZES.iter().filter_map(|&n| records.get(&default_run(ID, n))) {
        let Some(space) = record.space else { continue };
        rows.push(vec![
            format!("this one, n = {}", record.key.n).into(),
            Cell::count(space.particles as u64),
            Cell::number(space.updates_per_cpu_second, 3),
            Cell::number(record.cpu_seconds, 3),
            format!("{} steps", record.steps).into(),
        ]);
    }
    Some(Table {
        id: "al-sphere-plate-peers".into(),
        caption: "Cost of other programs at this work and of this one, for one core. Particle updates are \
                  not equal work across methods, each program has the nearest material model that it \
                  offers, and their times are of other days on a machine of the same kind: a comparison \
                  of size, not a race."
            .into(),
        columns: vec![
            Column::text("program"),
            Column::number("particles", ""),
            Column::number("updates per CPU second", ""),
            Column::number("CPU seconds to 10 µs", ""),
            Column::text("outcome"),
        ],
        rows,
    })
}
