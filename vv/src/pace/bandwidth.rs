//! What the memory of this machine gives.

use std::hint::black_box;
use std::time::Instant;

/// Bytes that a measurement moves at least.
const MOVED: usize = 1_000_000_000;
/// Bytes of an entry in three arrays.
const ENTRY: usize = 24;

/// Bytes a second of one thread on `a = b + s c` over three arrays of so many bytes together: two read
/// and one written, as the benchmark STREAM counts. The best of three.
#[must_use]
pub(super) fn triad(bytes: usize) -> f64 {
    let n = (bytes / ENTRY).max(1);
    let (mut a, b, c) = (vec![0.0_f64; n], vec![1.0_f64; n], vec![2.0_f64; n]);
    let repeats = MOVED / (ENTRY * n) + 1;
    let mut best = 0.0_f64;
    for _ in 0..3 {
        let start = Instant::now();
        for _ in 0..repeats {
            for ((a, b), c) in a.iter_mut().zip(&b).zip(&c) {
                *a = b + 1.5 * c;
            }
            black_box(&mut a);
        }
        best = best.max((repeats * ENTRY * n) as f64 / start.elapsed().as_secs_f64());
    }
    best
}
