//! Pairs of particles in reach of each other.

use std::collections::HashMap;

/// Members.
#[derive(Debug, Clone, Copy)]
pub struct Points<'a> {
    /// Positions.
    pub x: &'a [f64],
    /// Positions, second component.
    pub y: &'a [f64],
    /// Positions, third component.
    pub z: &'a [f64],
    /// Contact lengths.
    pub length: &'a [f32],
    /// Whether a pair may be of this member and any other.
    pub exposed: &'a [bool],
    /// Bodies.
    pub body: &'a [u16],
}

/// How far a list reaches.
#[derive(Debug, Clone, Copy, Default)]
pub struct Reach {
    /// Reach of a contact over the larger contact length.
    pub factor: f64,
    /// Margin.
    pub skin: f64,
}

/// A half list of pairs.
#[derive(Debug, Clone, Default)]
pub struct PairList {
    pairs: Vec<[u32; 2]>,
    at: Vec<[f64; 3]>,
    skin: f64,
}

impl PairList {
    /// The pairs.
    #[must_use]
    pub fn pairs(&self) -> &[[u32; 2]] {
        &self.pairs
    }

    /// Bytes that it takes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.pairs.capacity() * 8 + self.at.capacity() * 24
    }

    /// Whether a pair may have come in reach that is not listed.
    #[must_use]
    pub fn is_stale(&self, points: &Points<'_>) -> bool {
        let mut mean = [0.0; 3];
        for (i, at) in self.at.iter().enumerate() {
            let d = [points.x[i] - at[0], points.y[i] - at[1], points.z[i] - at[2]];
            for k in 0..3 {
                mean[k] += d[k] / self.at.len() as f64;
            }
        }
        self.at.iter().enumerate().any(|(i, at)| {
            let d = [points.x[i] - at[0], points.y[i] - at[1], points.z[i] - at[2]];
            (0..3).map(|k| (d[k] - mean[k]).powi(2)).sum::<f64>() > 0.25 * self.skin * self.skin
        })
    }

    /// Finds all pairs anew.
    pub fn rebuild(&mut self, p: &Points<'_>, reach: Reach, keep: impl Fn(u32, u32) -> bool) {
        let longest = f64::from(p.length.iter().copied().fold(0.0, f32::max));
        let r = reach.factor * longest + reach.skin;
        let cell = |i: usize| [p.x[i], p.y[i], p.z[i]].map(|x| (x / r).floor() as i64);
        let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
        for i in 0..p.x.len() {
            cells.entry(cell(i)).or_default().push(i as u32);
        }
        self.pairs.clear();
        for i in 0..p.x.len() {
            let c = cell(i);
            let start = self.pairs.len();
            for n in 0..27 {
                let o = [n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1];
                let Some(others) = cells.get(&[c[0] + o[0], c[1] + o[1], c[2] + o[2]]) else {
                    continue;
                };
                for &j in others.iter().filter(|&&j| j as usize > i) {
                    let k = j as usize;
                    let d = [p.x[i] - p.x[k], p.y[i] - p.y[k], p.z[i] - p.z[k]];
                    let near = d.iter().map(|d| d * d).sum::<f64>() < r * r;
                    if near && (p.exposed[i] || p.exposed[k]) && keep(i as u32, j) {
                        self.pairs.push([i as u32, j]);
                    }
                }
            }
            self.pairs[start..].sort_unstable();
        }
        self.at = (0..p.x.len()).map(|i| [p.x[i], p.y[i], p.z[i]]).collect();
        self.skin = reach.skin;
    }
}
