//! `whipple material`: the library.

use std::fmt::Write as _;

use whipple_solver::space::scene::{EosData, Flow};
use whipple_solver::units::Units;

use super::{Failure, MaterialArgs, MaterialCommand, print};
use crate::exact::hugoniot::Hugoniot;
use crate::files::{ensure_writable_dir, write_atomic};
use crate::plots::{Axis, Figure, Panel, Series};
use crate::report::sig;
use crate::scenes::file::{Material, Status};
use crate::scenes::material::{data, library, reading, sources};
use crate::scenes::schema::Spanned;
use crate::suggest::did_you_mean;

/// Particle velocities of the Hugoniot that is shown, in km/s.
const SPEEDS: [f64; 6] = [0.1, 0.5, 1.0, 2.0, 3.0, 5.0];

/// Points of a curve.
const POINTS: usize = 60;

pub(super) const EXAMPLES: &str = "\
Examples:
  whipple material list
  whipple material show copper --out out/copper";

pub(super) const LIST_EXAMPLE: &str = "Example:\n  whipple material list";

pub(super) const SHOW_EXAMPLE: &str = "Example:\n  whipple material show copper --out out/copper";

/// Shows the library.
pub(super) fn material(args: &MaterialArgs) -> Result<u8, Failure> {
    match &args.command {
        MaterialCommand::List => list(),
        MaterialCommand::Show { name, out } => show(name, out.as_deref()),
    }
}

/// A word for whether sources were read.
fn word(status: Status) -> &'static str {
    match status {
        Status::Read => "read",
        Status::Recalled => "recalled, not read",
        Status::Chosen => "chosen",
    }
}

fn list() -> Result<u8, Failure> {
    let mut out = String::new();
    for material in library().map_err(Failure::usage)? {
        let own = material.get_ref();
        let recalled = sources(own).iter().any(|(_, _, status)| *status == Status::Recalled);
        let mark = if recalled { "recalled" } else { "" };
        let title = own.title.as_deref().unwrap_or_default();
        let line = format!(
            "{:<18} {:<12} {:<9} {title}",
            own.name.get_ref(),
            own.density.get_ref().0,
            mark
        );
        let _ = writeln!(out, "{}", line.trim_end());
    }
    print(&out)?;
    Ok(0)
}

fn show(name: &str, folder: Option<&std::path::Path>) -> Result<u8, Failure> {
    let all = library().map_err(Failure::usage)?;
    let found = all.iter().find(|m| m.get_ref().name.get_ref() == name).ok_or_else(|| {
        let known = all.iter().map(|m| m.get_ref().name.get_ref().as_str());
        let hint = did_you_mean(name, known);
        Failure::usage(format!(
            "there is no material `{name}`{hint} (`whipple material list` names them all)"
        ))
    })?;
    let mut out = told(found)?;
    if let Some(folder) = folder {
        ensure_writable_dir(folder)?;
        for figure in figures(found)? {
            let path = folder.join(format!("{}.svg", figure.id));
            let drawn = crate::plots::render_svg(&figure).map_err(Failure::usage)?;
            write_atomic(&path, drawn.as_bytes())?;
            let _ = writeln!(out, "{}", path.display());
        }
    }
    print(&out)?;
    Ok(0)
}

/// A material in words: its constants as they are written, their sources, and its Hugoniot.
fn told(material: &Spanned<Material>) -> Result<String, Failure> {
    let own = material.get_ref();
    let mut out = format!("{}: {}\n", own.name.get_ref(), own.title.as_deref().unwrap_or_default());
    let mut line = |name: &str, value: &str| {
        let _ = writeln!(out, "  {name:<16} {value}");
    };
    line("density", &own.density.get_ref().0);
    if let Some(solid) = &own.solid {
        line("c0", &solid.c0.get_ref().0);
        line("s", &solid.s.to_string());
        line("gamma_0", &solid.gamma_0.to_string());
        if let Some(b) = solid.b {
            line("b", &b.to_string());
        }
        line("c_v", &solid.c_v.get_ref().0);
        if let Some(limit) = &solid.valid_to {
            line("valid to", &limit.get_ref().0);
        }
    }
    if let Some(gas) = &own.gas {
        line("index", &gas.index.to_string());
        line("c_v", &gas.c_v.get_ref().0);
    }
    if let Some(strength) = &own.strength {
        line("shear modulus", &strength.shear_modulus.get_ref().0);
        if let Some(stress) = &strength.yield_stress {
            line("yield stress", &stress.get_ref().0);
        }
        if let Some(law) = &strength.hardening {
            let text = format!(
                "{} (1 + {} eps)^{} (1 - {} theta_H), melt {}",
                law.y_0.get_ref().0,
                law.kappa,
                law.alpha,
                law.eta.unwrap_or(1.0),
                law.melt.get_ref().0
            );
            line("yield stress", &text);
        }
        if let Some(law) = &strength.johnson_cook {
            let text = format!(
                "({} + {} eps^{}) (1 + {} ln rate) (1 - theta_H^{}), melt {}",
                law.a.get_ref().0,
                law.b.get_ref().0,
                law.n,
                law.c,
                law.m,
                law.melt.get_ref().0
            );
            line("yield stress", &text);
        }
    }
    if let Some(failure) = &own.failure {
        let texts = [
            ("failure strain", failure.plastic_strain.map(|strain| strain.to_string())),
            ("melts at", failure.melt.as_ref().map(|melt| melt.get_ref().0.clone())),
            ("spall strength", failure.spall.as_ref().map(|spall| spall.get_ref().0.clone())),
        ];
        for (name, text) in texts {
            if let Some(text) = text {
                line(name, &text);
            }
        }
    }
    out += "sources\n";
    for (what, source, status) in sources(own) {
        let _ = writeln!(out, "  {what}: {source} ({})", word(status));
    }
    if let Some(hugoniot) = hugoniot(material)? {
        out += "Hugoniot\n  up, km/s   Us, km/s   pressure, GPa   density, g/cm3\n";
        for up in SPEEDS {
            let Ok(state) = hugoniot.at_particle_speed(0.1 * up) else { continue };
            let _ = writeln!(
                out,
                "  {:<10} {:<10} {:<15} {}",
                sig(up, 3),
                sig(10.0 * state.shock_speed, 4),
                sig(100.0 * state.pressure, 4),
                sig(state.density, 4)
            );
        }
    }
    Ok(out)
}

/// The shock Hugoniot of a solid, in cm, g and us.
fn hugoniot(material: &Spanned<Material>) -> Result<Option<Hugoniot>, Failure> {
    let (data, _) = data(&reading(Units::CmGUsMbar), material).map_err(Failure::usage)?;
    let EosData::MieGruneisen { c0, s, .. } = data.eos else { return Ok(None) };
    Ok(Hugoniot::new(data.density, c0, s).ok())
}

/// Hugoniot and yield stress as curves.
fn figures(material: &Spanned<Material>) -> Result<Vec<Figure>, Failure> {
    let name = material.get_ref().name.get_ref();
    let mut all = Vec::new();
    if let Some(hugoniot) = hugoniot(material)? {
        let speeds = (1..=POINTS).map(|k| 0.5 * k as f64 / POINTS as f64);
        let states: Vec<_> = speeds.filter_map(|up| hugoniot.at_particle_speed(up).ok()).collect();
        let points = states.iter().map(|s| (s.density, 100.0 * s.pressure)).collect();
        let panel = Panel::new("", Axis::linear("density, g/cm³"), Axis::linear("pressure, GPa"))
            .with(Series::line("Hugoniot", points));
        let caption = format!("Shock Hugoniot of {name} to a particle velocity of 5 km/s.");
        all.push(Figure::new(format!("{name}-hugoniot"), caption, vec![panel]));
    }
    let (data, _) = data(&reading(Units::CmGUsMbar), material).map_err(Failure::usage)?;
    let Some(flow) = data.strength.and_then(|strength| strength.flow) else { return Ok(all) };
    let mut panel =
        Panel::new("", Axis::linear("plastic strain"), Axis::linear("yield stress, MPa"));
    for theta in [300.0, 600.0, 900.0] {
        let points = (0..=POINTS).map(|k| {
            let strain = k as f64 / POINTS as f64;
            (strain, 1e5 * stress(&flow, strain, theta))
        });
        panel = panel.with(Series::line(format!("{theta} K"), points.collect()));
    }
    let caption = format!("Yield stress of {name}, slowly strained, at three temperatures.");
    all.push(Figure::new(format!("{name}-yield"), caption, vec![panel]));
    Ok(all)
}

/// Yield stress of a law, at rates without effect.
fn stress(flow: &Flow, strain: f64, theta: f64) -> f64 {
    let part =
        |reference: f64, melt: f64| ((theta - reference) / (melt - reference)).clamp(0.0, 1.0);
    match *flow {
        Flow::Hardening { y_0, kappa, alpha, eta, reference, melt } => {
            let soft = (1.0 - eta * part(reference, melt)).max(0.0);
            y_0 * (1.0 + kappa * strain).powf(alpha) * soft
        }
        Flow::JohnsonCook { a, b, n, m, reference, melt, .. } => {
            (a + b * strain.powf(n)) * (1.0 - part(reference, melt).powf(m))
        }
    }
}
