//! Claims and tables name what the runs give: a typing error would be a claim without a record.

use std::collections::{BTreeMap, BTreeSet};

use whipple_solver::method::Preset;
use whipple_vv::cases::{ALL, Case, Level};
use whipple_vv::claims::Quantity;
use whipple_vv::record::{RunKey, Scheme};

use crate::common::{beginning, record};

/// Name of the norm that a quantity is made from.
fn norm_of(quantity: &Quantity) -> Option<&'static str> {
    match quantity {
        Quantity::Norm(_, name)
        | Quantity::WrongParticles(_, name)
        | Quantity::Order(_, name)
        | Quantity::Change(_, _, name) => Some(name),
        _ => None,
    }
}

/// Norms that a case gives at its smallest size, by variant; in space, where runs are long, after the
/// beginning.
fn given(case: &dyn Case) -> BTreeMap<String, BTreeSet<String>> {
    let runs = case.runs(Level::Quick);
    let in_space = case.scene(Preset::Default, "", case.default_size()).space().is_some();
    let smallest = runs.iter().map(|k| k.n).min().expect("a run");
    let mut out = BTreeMap::new();
    for variant in case.variants() {
        let default = Scheme::preset(Preset::Default);
        let fits = |k: &&RunKey| k.variant == *variant && k.scheme == default;
        let record = if in_space {
            beginning(&RunKey::new(case.id(), default, smallest).variant(variant))
        } else if let Some(key) = runs.iter().filter(fits).min_by_key(|k| k.n) {
            record(key)
        } else {
            continue;
        };
        out.insert((*variant).to_owned(), record.norms.into_keys().collect());
    }
    out
}

/// Every run that a claim needs is made at the full level; all but the largest at the standard one.
#[test]
fn claims_refer_to_runs_that_are_made() {
    for case in ALL {
        let runs: BTreeSet<RunKey> = case.runs(Level::Full).into_iter().collect();
        for claim in case.claims() {
            assert_eq!(claim.case, case.id());
            for key in claim.quantity.runs() {
                assert!(runs.contains(&key), "{}: {}: {key:?}", case.id(), claim.what);
            }
        }
    }
}

/// Every run is made once, of the case itself and of a variant that it has; levels only add.
#[test]
fn runs_are_the_case_s_own() {
    for case in ALL {
        let sets = [Level::Quick, Level::Standard, Level::Full].map(|level| {
            let runs = case.runs(level);
            let set: BTreeSet<RunKey> = runs.iter().cloned().collect();
            assert_eq!(set.len(), runs.len(), "{}: a run twice at {level:?}", case.id());
            set
        });
        assert!(sets[1].is_subset(&sets[2]), "{}", case.id());
        for key in sets.iter().flatten() {
            assert_eq!(key.case, case.id());
            assert!(case.variants().contains(&key.variant.as_str()), "{key:?}");
        }
        let files: BTreeSet<String> = sets[2].iter().map(RunKey::file_name).collect();
        assert_eq!(files.len(), sets[2].len(), "{}: two runs in one file", case.id());
    }
}

/// Every norm of a claim or a table is one that the runs give.
#[test]
fn norms_of_claims_and_tables_are_given() {
    for case in ALL {
        let given = given(case);
        for claim in case.claims() {
            let Some(name) = norm_of(&claim.quantity) else {
                continue;
            };
            for key in claim.quantity.runs() {
                let names = given.get(&key.variant).expect("the variant runs");
                assert!(names.contains(name), "{}: {}: no norm `{name}`", case.id(), claim.what);
            }
        }
        for (name, _) in case.tabulated() {
            assert!(given.values().any(|names| names.contains(*name)), "{}: `{name}`", case.id());
        }
    }
}

/// Every case says what it is, has a claim that must hold, and builds a valid scene for every
/// preset and variant at any size.
#[test]
fn cases_are_complete() {
    for case in ALL {
        assert!(!case.about().is_empty() && !case.source().is_empty() && !case.title().is_empty());
        assert!(case.claims().iter().any(|c| c.weight == whipple_vv::claims::Weight::Must));
        assert_eq!(case.variants()[0], "", "{}: the first variant has no name", case.id());
        for variant in case.variants() {
            for preset in Preset::ALL {
                // A thousand cells each way are more particles than a scene may have.
                let solid = case.scene(preset, variant, 5).space().is_some();
                for n in [16, case.default_size(), if solid { 20 } else { 1000 }] {
                    let scene = case.scene(preset, variant, n);
                    let mapped = |scene: &whipple_solver::space::Scene| {
                        scene.bodies.iter().any(|body| body.mapping.is_some())
                    };
                    // The density of the paper knows equal cells alone, and says so.
                    let refused = preset == Preset::Paper && scene.space().is_some_and(mapped);
                    let found = scene.validate().map_err(|error| error.key);
                    let wanted = if refused { Err("method.density".to_owned()) } else { Ok(()) };
                    assert_eq!(found, wanted, "{} {variant}", case.id());
                }
            }
        }
    }
}

/// A scene is plain data: written as TOML it reads back as itself.
#[test]
fn scenes_survive_toml() {
    for case in whipple_vv::cases::ALL {
        for preset in whipple_solver::method::Preset::ALL {
            for variant in case.variants() {
                let scene = case.scene(preset, variant, case.default_size());
                let text = toml::to_string(&scene).expect("a scene is TOML");
                let back: whipple_vv::scene::AnyScene =
                    toml::from_str(&text).expect("it reads back");
                assert_eq!(back, scene, "{} {variant}", case.id());
            }
        }
    }
}
