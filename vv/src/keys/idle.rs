//! Keys of a method that a scene has no use for: to set them changes no bit of the run.

use whipple_solver::method::{Conduction, Density, Viscosity};
use whipple_solver::scene::{self, EosData as LineEos};
use whipple_solver::space;
use whipple_solver::space::scene::{EosData, Material};

use crate::scene::AnyScene;

/// What a key needs, and what is said where it is not there.
type Need = (bool, &'static str);

const ELEMENTS: &str = "it acts where elements carry the pressure, with density=hybrid alone";
const LIMITED: &str = "it belongs to viscosity=limited";
const KERNEL: &str = "it belongs to density=kernel";
const FACTOR: &str = "Eq. (53) multiplies it with visc_linear, which is 0";

/// Why a key of the method, with or without `method.` before it, changes nothing in a scene; none if it may.
#[must_use]
pub fn idle(key: &str, scene: &AnyScene) -> Option<&'static str> {
    let key = key.strip_prefix("method.").unwrap_or(key);
    let needs = match scene {
        AnyScene::Line(scene) => along_a_line(key, scene),
        AnyScene::Space(scene) => in_space(key, scene),
    };
    needs.into_iter().find(|(met, _)| !met).map(|(_, why)| why)
}

/// What a key needs in a scene along a line.
fn along_a_line(key: &str, scene: &scene::Scene) -> Vec<Need> {
    let method = &scene.method;
    let limited = method.viscosity == Viscosity::Limited;
    let gas = scene.materials.iter().any(|m| matches!(m.eos, LineEos::IdealGas { .. }));
    match key {
        "visc_expansion" | "limiter" => vec![(limited, LIMITED)],
        "visc_quad" => vec![(limited || method.visc_linear > 0.0, FACTOR)],
        "heat_coeff" => vec![(method.conduction != Conduction::None, "conduction is none")],
        "conduction" => vec![(method.heat_coeff > 0.0, "heat_coeff is 0")],
        "sound_speed" => vec![(gas, "an elastic solid has one speed of sound")],
        "kernel_support" => vec![(method.density == Density::Kernel, KERNEL)],
        _ => Vec::new(),
    }
}

/// What a key needs in a scene in space.
fn in_space(key: &str, scene: &space::Scene) -> Vec<Need> {
    let method = &scene.method;
    let hybrid = method.density == Density::Hybrid;
    let kernel = method.density == Density::Kernel;
    let limited = method.viscosity == Viscosity::Limited;
    let any = |of: fn(&Material) -> bool| {
        let mut bodies = scene.bodies.iter().filter_map(|b| scene.material_index(&b.material));
        bodies.any(|k| of(&scene.materials[k]))
    };
    let solid = any(is_solid);
    match key {
        "visc_volume" | "balance" => vec![(hybrid, ELEMENTS)],
        "visc_expansion" | "limiter" => vec![(hybrid, ELEMENTS), (limited, LIMITED)],
        "visc_quad" => vec![(limited || method.visc_linear > 0.0, FACTOR)],
        "visc_hourglass" => vec![
            (hybrid, ELEMENTS),
            (
                any(|m| is_solid(m) && m.strength.is_none()),
                "it acts in solids without strength, and no body is one",
            ),
        ],
        "visc_hourglass_strong" => vec![
            (hybrid, ELEMENTS),
            (
                any(|m| is_solid(m) && m.strength.is_some()),
                "it acts in solids with strength, and no body is one",
            ),
        ],
        "hourglass" => vec![(solid || hybrid, "in gas it acts with density=hybrid alone")],
        "centring" => vec![(solid, "it acts in solids, and no body is one")],
        "heat_coeff" => vec![(
            hybrid || !limited,
            "with viscosity=limited heat flows where elements carry the pressure, with density=hybrid alone",
        )],
        "contact_tolerance" | "contact_reach" => {
            vec![(
                !kernel,
                "it belongs to the contact rule (35), which density=kernel does without",
            )]
        }
        "kernel_support" => vec![(kernel, KERNEL)],
        "yield_norm" => {
            vec![(any(|m| m.strength.is_some_and(|s| s.flow.is_some())), "no body yields")]
        }
        "spall" => vec![(any(|m| m.failure.spall.is_some()), "no body has a tensile strength")],
        _ => Vec::new(),
    }
}

fn is_solid(material: &Material) -> bool {
    matches!(material.eos, EosData::MieGruneisen { .. })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases::find;
    use crate::keys::{of_method, of_presets};
    use crate::overrides::apply;
    use crate::record::{RunKey, Scheme};
    use crate::run::{Request, Silent, run};
    use whipple_solver::method::Preset;

    /// Small scenes: a case, its preset, its variant, its size and what is set before.
    const SCENES: [(&str, Preset, &str, usize, &[&str]); 9] = [
        ("noh", Preset::Paper, "", 10, &[]),
        ("noh", Preset::Default, "", 10, &["conduction=none"]),
        ("noh", Preset::Paper, "", 10, &["visc_linear=0", "heat_coeff=0", "heating=pair"]),
        ("kolsky", Preset::Default, "", 11, &[]),
        ("planar-impact", Preset::Default, "", 16, &["stop_time=1"]),
        ("planar-impact", Preset::Paper, "", 16, &["stop_time=1"]),
        ("planar-impact", Preset::Default, "", 16, &["density=kernel", "stop_time=1"]),
        ("noh-space", Preset::Default, "", 6, &["stop_time=0.1"]),
        ("beam", Preset::Default, "", 4, &["stop_time=2"]),
    ];

    fn scene(of: usize) -> AnyScene {
        let (case, preset, variant, n, sets) = SCENES[of];
        let scene = find(case).expect("a case").scene(preset, variant, n);
        apply(scene, &sets.iter().map(|set| (*set).to_owned()).collect::<Vec<_>>()).expect("sets")
    }

    /// All numbers of a run but those of the machine.
    fn numbers(of: usize, scene: AnyScene) -> String {
        let (case, preset, variant, n, _) = SCENES[of];
        let key = RunKey::new(case, Scheme::preset(preset), n).variant(variant);
        let request = Request { key, scene: Some(scene), threads: 1, command: String::new() };
        let record = run(find(case).expect("a case"), request, &Silent).expect("a record").record;
        let balance = record.space.map(|space| space.balance);
        format!("{:?} {:?} {} {balance:?}", record.outcome, record.norms, record.steps)
    }

    /// Another value than that which a key has.
    fn other(value: &str, choices: &[String]) -> String {
        match value.parse::<f64>() {
            Ok(number) => (1.1 * number + 0.05).to_string(),
            Err(_) if value == "true" => "false".into(),
            Err(_) if value == "false" => "true".into(),
            Err(_) => choices.iter().find(|choice| *choice != value).expect("a choice").clone(),
        }
    }

    /// What is said to change nothing changes nothing.
    #[test]
    fn idle_keys_move_no_bit() {
        let mut tried = 0;
        for (of, name) in SCENES.iter().enumerate() {
            let plain = scene(of);
            let both = of_presets(|_| plain.clone());
            let numbers_of_plain = numbers(of, plain.clone());
            for key in of_method([&both[0], &both[1]]) {
                if idle(&key.name, &plain).is_none() {
                    continue;
                }
                let set = format!("{}={}", key.name, other(&key.values[1], &key.choices));
                let changed = apply(plain.clone(), std::slice::from_ref(&set)).expect("a value");
                assert_ne!(changed, plain, "{set}");
                assert_eq!(numbers(of, changed), numbers_of_plain, "{name:?}: {set}");
                tried += 1;
            }
        }
        assert!(tried > 25, "{tried}");
    }

    #[test]
    fn idle_keys_are_named_with_the_reason() {
        let all = |of: usize| {
            let scene = scene(of);
            let keys = of_method([&scene, &scene]);
            let said = keys.iter().filter_map(|key| Some((&key.name, idle(&key.name, &scene)?)));
            said.map(|(name, why)| format!("{name}: {why}\n")).collect::<String>()
        };
        insta::assert_snapshot!(all(3), @r"
        heat_coeff: conduction is none
        kernel_support: it belongs to density=kernel
        sound_speed: an elastic solid has one speed of sound
        ");
        insta::assert_snapshot!(all(4), @r"
        kernel_support: it belongs to density=kernel
        spall: no body has a tensile strength
        visc_hourglass_strong: it acts in solids with strength, and no body is one
        yield_norm: no body yields
        ");
        insta::assert_snapshot!(all(5), @r"
        balance: it acts where elements carry the pressure, with density=hybrid alone
        kernel_support: it belongs to density=kernel
        limiter: it acts where elements carry the pressure, with density=hybrid alone
        spall: no body has a tensile strength
        visc_expansion: it acts where elements carry the pressure, with density=hybrid alone
        visc_hourglass: it acts where elements carry the pressure, with density=hybrid alone
        visc_hourglass_strong: it acts where elements carry the pressure, with density=hybrid alone
        visc_volume: it acts where elements carry the pressure, with density=hybrid alone
        yield_norm: no body yields
        ");
        assert_eq!(idle("method.visc_linear", &scene(4)), None);
        assert_eq!(idle("stop_time", &scene(4)), None);
    }
}
