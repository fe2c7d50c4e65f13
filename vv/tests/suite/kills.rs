//! A run that is killed at any moment leaves a state that goes on to the same bits, or nothing that is in the way of a new
//! beginning.
#![cfg(unix)]
#![allow(clippy::print_stdout)]

use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

use crate::common::{said, whipple};
use crate::long_runs::{PLAIN, assert_same_run, assert_well, names, short_rod};

/// How often a run is killed; `WHIPPLE_KILLS=200` for what the report of hard cases asks for.
const KILLS: u64 = 10;

/// Checkpoints with every step, frames, and the ledger.
fn arguments() -> Vec<&'static str> {
    let writes = ["--stop", "3", "--vtu", "0.4us", "--checkpoint", "1us", "--out", "out"];
    [&short_rod()[..], &PLAIN, &writes].concat()
}

/// A share of the whole, another for every number: the golden ratio leaves no gaps.
fn share(k: u64) -> f64 {
    (k as f64 * 0.618_033_988_749_894_9).fract()
}

/// Newest checkpoint in a folder.
fn newest(folder: &Path) -> Option<String> {
    if !folder.exists() {
        return None;
    }
    names(folder).into_iter().rfind(|name| name.ends_with(".whp"))
}

/// Files of a folder that are no checkpoints.
fn others(folder: &Path) -> Vec<String> {
    names(folder).into_iter().filter(|name| !name.ends_with(".whp")).collect()
}

#[test]
fn killed_runs_go_on_to_the_same_bits() {
    let kills = std::env::var("WHIPPLE_KILLS").ok().and_then(|n| n.parse().ok()).unwrap_or(KILLS);
    let whole = tempfile::tempdir().expect("a folder");
    let start = Instant::now();
    assert_well(&said(whole.path(), &arguments()));
    let time = start.elapsed();
    let whole = whole.path().join("out");
    let (mut resumed, mut anew, mut ended) = (0, 0, 0);
    for k in 1..=kills {
        let folder = tempfile::tempdir().expect("a folder");
        let at = folder.path();
        let mut child = whipple(&arguments())
            .current_dir(at)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("the program starts");
        std::thread::sleep(Duration::from_secs_f64(share(k) * time.as_secs_f64()));
        child.kill().expect("it is killed, or has ended");
        let well = child.wait().expect("it ends").success();
        match newest(&at.join("out")) {
            _ if well => ended += 1,
            Some(name) => {
                let from = format!("out/{name}");
                assert_well(&said(at, &[&arguments()[..], &["--resume", &from]].concat()));
                resumed += 1;
            }
            None => {
                assert_well(&said(at, &arguments()));
                anew += 1;
            }
        }
        assert_same_run(&whole, &at.join("out"));
        assert_eq!(others(&whole), others(&at.join("out")), "kill {k}");
    }
    println!("{kills} kills: {resumed} went on, {anew} began anew, {ended} had ended");
    assert!(resumed > kills / 3);
}
