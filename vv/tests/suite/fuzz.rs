//! Whatever is parsed is fed with damaged and made-up input: it is read, or refused with one message, and nothing panics.

#![allow(clippy::print_stdout)]

use std::io::Cursor;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use whipple_solver::method::Preset;
use whipple_solver::units::Units;
use whipple_vv::checkpoint::Reader;
use whipple_vv::overrides::apply;
use whipple_vv::record::RunRecord;
use whipple_vv::references::Table;
use whipple_vv::scene::AnyScene;
use whipple_vv::scenes::build::Built;
use whipple_vv::scenes::probes::Probes;
use whipple_vv::scenes::quantity::{self, Kind};
use whipple_vv::scenes::stl::Surface;
use whipple_vv::suite::scene_of;

use crate::checkpoint::{SCENE, small};
use crate::common::{case, key, record};

/// Inputs of each target; `WHIPPLE_FUZZ=5000000` for what hard cases ask for.
const INPUTS: u64 = 2000;

/// Longest message about a damaged input.
const LONGEST: usize = 2000;

/// `SplitMix64` (G. Steele, D. Lea and C. Flood, *Fast splittable pseudorandom number generators*, OOPSLA 2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n.max(1) as u64) as usize
    }
}

/// What is put in: numbers at the ends of their types, signs of the languages, and words of scenes.
const WORDS: &[&str] = &[
    "0",
    "-1",
    "1e308",
    "-1e308",
    "1e-320",
    "nan",
    "inf",
    "-inf",
    "18446744073709551616",
    "9223372036854775807",
    "4294967296",
    "65536",
    "0.1",
    "=",
    "==",
    ".",
    "..",
    ",",
    "[",
    "]",
    "{",
    "}",
    "\"",
    "'",
    "\\",
    "\n",
    "\0",
    "#",
    "true",
    "null",
    "bodies",
    "materials",
    "method",
    "walls",
    "0.",
    ".0",
    ".99999999999",
    "cells",
    "velocity",
    "eos",
    "density",
    "\u{7f}",
    "\u{1b}[31m",
    "\u{202e}",
    "\u{fffd}",
    "1 ",
    "\t",
    "[[[[[[[[[[",
    "{a={a={a={a=",
    "\"1e300 km\"",
    "\"-3 mm\"",
    "\"1 um\"",
    "[[body]]",
    "sphere",
    "through",
    "stop",
];

/// A member of a corpus with a few damages.
fn damaged(random: &mut Random, corpus: &[Vec<u8>]) -> Vec<u8> {
    let mut input = corpus[random.below(corpus.len())].clone();
    for _ in 0..=random.below(4) {
        let at = random.below(input.len() + 1);
        let end = (at + 1 + random.below(16)).min(input.len());
        match random.below(8) {
            0 if at < input.len() => input[at] ^= 1 << random.below(8),
            1 if at < input.len() => input[at] = random.next() as u8,
            2 => drop(input.drain(at..end.max(at))),
            3 => input.truncate(at),
            4 => {
                let twice = input[at..end.max(at)].to_vec();
                input.splice(at..at, twice);
            }
            5 => {
                let other = &corpus[random.below(corpus.len())];
                let from = random.below(other.len() + 1);
                input.truncate(at);
                input.extend_from_slice(&other[from..]);
            }
            _ => {
                let word = WORDS[random.below(WORDS.len())].bytes();
                input.splice(at..at, word);
            }
        }
    }
    input
}

/// Feeds a target; both outcomes must occur.
fn feed(name: &str, corpus: &[Vec<u8>], target: impl Fn(&[u8]) -> Result<(), String>) {
    let inputs = std::env::var("WHIPPLE_FUZZ").ok().and_then(|n| n.parse().ok()).unwrap_or(INPUTS);
    for whole in corpus {
        target(whole).expect("what is not damaged is read");
    }
    let mut random = Random(7);
    let (mut read, mut refused) = (0u64, 0u64);
    for k in 0..inputs {
        let input = damaged(&mut random, corpus);
        let shown = || String::from_utf8_lossy(&input[..input.len().min(300)]).into_owned();
        match catch_unwind(AssertUnwindSafe(|| target(&input))) {
            Ok(Ok(())) => read += 1,
            Ok(Err(message)) => {
                let fair = !message.is_empty() && message.len() < LONGEST;
                assert!(fair, "{name} {k}: {message:?}\n{:?}", shown());
                refused += 1;
            }
            Err(_) => panic!("{name} {k} panicked at {:?}", shown()),
        }
    }
    println!("{name}: {inputs} inputs, {read} read, {refused} refused");
    assert!(read > 0 && refused > 0, "{name}");
}

fn text(input: &[u8]) -> String {
    String::from_utf8_lossy(input).into_owned()
}

fn scene(id: &str) -> AnyScene {
    scene_of(case(id), &key(id, Preset::Default, 20)).expect("a scene")
}

/// `--set` of a scene along a line, and of one in space.
#[test]
fn overrides() {
    let of_both = ["cfl=0.5", "method.heating=pair", "stop_time=0.1", "materials.0.density=2.5"];
    let line = ["bodies.0.particles=7", "bodies.0.velocity={ uniform = -1.0 }"];
    let space = [
        "bodies.0.cells=[4,4,4]",
        "walls=[]",
        "materials.0.failure.spall=0.01",
        "bodies.0.turn.degrees=30.0",
    ];
    for (id, own) in [("noh", &line[..]), ("planar-impact", &space)] {
        let whole = scene(id);
        let corpus: Vec<Vec<u8>> =
            of_both.iter().chain(own).map(|set| set.as_bytes().to_vec()).collect();
        let target = |input: &[u8]| {
            let scene = apply(whole.clone(), &[text(input)]).map_err(|error| error.to_string())?;
            scene.validate().map_err(|error| error.to_string())
        };
        let corpus: Vec<_> = corpus.into_iter().filter(|set| target(set).is_ok()).collect();
        assert!(corpus.len() > 2, "{id}");
        feed(&format!("--set of {id}"), &corpus, target);
    }
}

#[test]
fn references() {
    let corpus = [
        include_str!("../../../references/paper_table5_rod_results.csv"),
        include_str!("../../../references/rcc_penetration_prediction.csv"),
        include_str!("../../../references/paper_table7_cost.csv"),
    ];
    feed("reference", &corpus.map(|file| file.as_bytes().to_vec()), |input| {
        let table = Table::parse("fuzz.csv", &text(input)).map_err(|error| error.to_string())?;
        // Columns of words are refused as numbers, which is no fault of the file.
        for name in table.names() {
            let _ = table.optional_column(name);
            let _ = table.text(name);
        }
        Ok(())
    });
}

#[test]
fn records() {
    let whole = record(&key("noh", Preset::Default, 20));
    let corpus = [serde_json::to_vec(&whole).expect("JSON")];
    feed("record", &corpus, |input| {
        serde_json::from_slice::<RunRecord>(input).map(drop).map_err(|error| error.to_string())
    });
}

/// The checksum lets nothing through that is damaged: headers are damaged before it is made.
#[test]
fn checkpoints() {
    let read = |file: Vec<u8>| {
        let mut reader = Reader::from_bytes(file, SCENE)?;
        for section in reader.sections().to_vec() {
            let shape: Vec<usize> = section.shape.iter().map(|&n| n as usize).collect();
            drop(reader.array::<f64>(&section.name, &shape));
            drop(reader.bytes(&section.name));
        }
        Ok(())
    };
    feed("checkpoint", &[small()], |input| {
        let mut file = input.to_vec();
        if let Some((version, rest)) =
            file.split_at_checked(16).map(|(a, b)| (a.to_vec(), b.to_vec()))
        {
            let length = u32::from_le_bytes(version[12..16].try_into().expect("four")) as usize;
            if rest.len() > 4 && rest.len() - 4 >= length {
                let mut hasher = crc32fast::Hasher::new();
                hasher.update(&version[8..16]);
                hasher.update(&rest[4..4 + length]);
                file[16..20].copy_from_slice(&hasher.finalize().to_le_bytes());
            }
        }
        read(file).map_err(|error: whipple_vv::checkpoint::CheckpointError| error.to_string())
    });
}

/// Scene files: read, and what they make is looked at as `check` does before it makes any cell.
#[test]
fn scene_files() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../references/scenes");
    let mut corpus = vec![include_bytes!("../../src/cli/template.toml").to_vec()];
    for entry in std::fs::read_dir(&folder).expect("the examples") {
        let path = entry.expect("a file").path();
        if path.extension().is_some_and(|e| e == "toml") {
            corpus.push(std::fs::read(path).expect("a scene"));
        }
    }
    corpus.sort();
    let file = folder.join("fuzz.toml");
    feed("scene file", &corpus, |input| {
        let built = Built::of(&file, &text(input), None).map_err(|error| error.to_string())?;
        built.scene.validate().map_err(|error| error.to_string())?;
        Probes::new(&built).map(drop).map_err(|error| error.to_string())
    });
}

/// Numbers with units.
#[test]
fn quantities() {
    let all = [
        "10 us",
        "884 J/kg/K",
        "0.47 cm",
        "-3.5e2 m/s",
        "5 lbf s^2/in^4",
        "12 %",
        "30 deg",
        "27.6 GPa",
    ];
    let kinds = [
        Kind::TIME,
        Kind::LENGTH,
        Kind::VELOCITY,
        Kind::DENSITY,
        Kind::PRESSURE,
        Kind::SPECIFIC_HEAT,
        Kind::ANGLE,
        Kind::NUMBER,
    ];
    feed("quantity", &all.map(|q| q.as_bytes().to_vec()), |input| {
        let text = text(input);
        let read = kinds.map(|kind| quantity::read(&text, kind, Units::CmGUsMbar));
        let plain = quantity::read(&text, Kind::TIME, Units::None);
        let mut refused = read.into_iter().chain([plain]).filter_map(Result::err);
        match refused.nth(kinds.len()) {
            Some(message) => Err(message),
            None => Ok(()),
        }
    });
}

/// Closed surfaces, as text and as bytes.
#[test]
fn surfaces() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0_f32]];
    let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
    let mut words = "solid corner\n".to_owned();
    let mut bytes = vec![0; 80];
    bytes.extend(4_u32.to_le_bytes());
    for face in faces {
        words += " facet normal 0 0 0\n outer loop\n";
        bytes.extend([0; 12]);
        for corner in face.map(|k: usize| corners[k]) {
            let [x, y, z] = corner;
            words += &format!("  vertex {x} {y} {z}\n");
            corner.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
        }
        words += " endloop\n endfacet\n";
        bytes.extend([0; 2]);
    }
    words += "endsolid corner\n";
    feed("surface", &[words.into_bytes(), bytes], |input| {
        Surface::parse("fuzz.stl", &mut Cursor::new(input), 1.0).map(drop)
    });
}

/// Tables of other programs.
#[test]
fn scored_tables() {
    let corpus = [
        b"x,rho,u\n0.1,1.0,0.0\n0.2,1,0.5\n0.3,0.5,1e-3\n".to_vec(),
        b"# by a code\n# cell x_c[m] rho p\n 1 0.5 1.0 1e5\n 2 1.5 0.5D0 2e5\n".to_vec(),
        b"\"x\";\"Density\"\n0;1\n1;0.5\n".to_vec(),
    ];
    feed("scored table", &corpus, |input| {
        whipple_vv::score::table::Table::parse(Path::new("fuzz.csv"), text(input))
            .map(drop)
            .map_err(|error| error.to_string())
    });
}
