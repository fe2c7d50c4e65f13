//! Names what the records depend on: the sources of solver, cases and norms, and the compiler.

use std::path::{Path, PathBuf};
use std::process::Command;

/// Sources whose change makes a record stale.
const WATCHED: [&str; 8] = [
    "../solver/src",
    "src/cases",
    "src/exact",
    "src/godunov",
    "src/godunov.rs",
    "src/norms.rs",
    "src/run",
    "src/run.rs",
];

fn main() {
    let root = PathBuf::from(std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    let mut files = Vec::new();
    for place in WATCHED {
        println!("cargo::rerun-if-changed={place}");
        collect(&root.join(place), &mut files);
    }
    files.sort();
    let mut hash = blake3::Hasher::new();
    for file in &files {
        for line in std::fs::read_to_string(file).unwrap_or_default().lines() {
            let line = line.trim();
            // Comments and blank lines change no result.
            if !line.is_empty() && !line.starts_with("//") {
                hash.update(line.as_bytes());
                hash.update(b"\n");
            }
        }
    }
    let fingerprint = &hash.finalize().to_hex()[..16];
    println!("cargo::rustc-env=WHIPPLE_FINGERPRINT={fingerprint}");

    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let version = Command::new(rustc).arg("--version").output();
    let version = version.map(|o| String::from_utf8_lossy(&o.stdout).trim().to_owned());
    println!("cargo::rustc-env=WHIPPLE_RUSTC={}", version.unwrap_or_else(|_| "unknown".into()));
    for name in ["PROFILE", "TARGET"] {
        println!("cargo::rustc-env=WHIPPLE_{name}={}", std::env::var(name).unwrap_or_default());
    }
}

fn collect(place: &Path, files: &mut Vec<PathBuf>) {
    if place.is_file() {
        return files.push(place.to_owned());
    }
    let Ok(entries) = std::fs::read_dir(place) else {
        return;
    };
    for entry in entries.flatten() {
        let path = entry.path();
        if path.is_dir() || path.extension().is_some_and(|e| e == "rs") {
            collect(&path, files);
        }
    }
}
