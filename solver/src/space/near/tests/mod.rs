//! The search against brute force.

mod list;
mod stale;

use proptest::prelude::*;

use super::{DEBRIS, EXPOSED, PairList, Points, Reach};

/// Members that own their columns.
#[derive(Debug, Clone, Default)]
struct Cloud {
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
    length: Vec<f32>,
    flags: Vec<u8>,
    body: Vec<u16>,
    lattice: Vec<[i16; 3]>,
}

fn config() -> ProptestConfig {
    ProptestConfig { cases: 400, failure_persistence: None, ..Default::default() }
}

const REACH: Reach = Reach { factor: 1.12, skin: 0.7 };

impl Cloud {
    fn push(&mut self, at: [f64; 3], length: f32, flags: u8) {
        self.x.push(at[0]);
        self.y.push(at[1]);
        self.z.push(at[2]);
        self.length.push(length);
        self.flags.push(flags);
        self.body.push(0);
        self.lattice.push([0; 3]);
    }

    fn len(&self) -> usize {
        self.x.len()
    }

    fn points(&self) -> Points<'_> {
        let Self { x, y, z, length, flags, body, .. } = self;
        Points { x, y, z, length, flags, body, lattice: None }
    }

    fn points_in_lattice(&self) -> Points<'_> {
        Points { lattice: Some(&self.lattice), ..self.points() }
    }

    fn at(&self, i: usize) -> [f64; 3] {
        [self.x[i], self.y[i], self.z[i]]
    }

    fn shift(&mut self, i: usize, by: [f64; 3]) {
        self.x[i] += by[0];
        self.y[i] += by[1];
        self.z[i] += by[2];
    }

    /// Pairs, one of them exposed, that are nearer than `factor * max(length) + more`.
    fn brute(&self, factor: f64, more: f64) -> Vec<[u32; 2]> {
        let mut pairs = Vec::new();
        for i in 0..self.len() {
            for j in i + 1..self.len() {
                let [a, b] = [self.at(i), self.at(j)];
                let r = (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt();
                let limit = factor * f64::from(self.length[i].max(self.length[j])) + more;
                if r < limit && (self.flags[i] | self.flags[j]) & EXPOSED != 0 {
                    pairs.push([i as u32, j as u32]);
                }
            }
        }
        pairs
    }

    fn longest(&self) -> f64 {
        f64::from(self.length.iter().fold(0.0_f32, |a, &b| a.max(b)))
    }
}

fn all(_: u32, _: u32) -> bool {
    true
}

fn is_strictly_sorted(pairs: &[[u32; 2]]) -> bool {
    pairs.windows(2).all(|two| two[0] < two[1]) && pairs.iter().all(|[i, j]| i < j)
}

fn lists_all(list: &PairList, needed: &[[u32; 2]]) -> bool {
    needed.iter().all(|pair| list.pairs().binary_search(pair).is_ok())
}

/// Clusters of any width at places any distance apart, some members on top of each other.
fn clouds() -> impl Strategy<Value = Cloud> {
    let width = prop_oneof![Just(0.0), Just(1.0), Just(4.0), Just(12.0), Just(60.0)];
    let span = prop_oneof![Just(0.0), Just(10.0), Just(1e3), Just(1e6), Just(3e7), Just(1e8)];
    let cluster = (prop::array::uniform3(-1.0..1.0), width);
    let unit = || prop_oneof![9 => -0.5..0.5, 1 => Just(0.25)];
    let member = (
        prop::array::uniform3(unit()),
        0..4_usize,
        prop_oneof![5 => Just(1.0_f32), 1 => 0.0..3.0_f32],
        0..2_u8,
    );
    (span, prop::array::uniform4(cluster), prop::collection::vec(member, 0..250)).prop_map(
        |(span, clusters, members)| {
            let mut cloud = Cloud::default();
            for (at, c, length, flags) in members {
                let (centre, width) = clusters[c];
                let at = [0, 1, 2].map(|k| centre[k] * span + at[k] * width);
                cloud.push(at, length, flags);
            }
            cloud
        },
    )
}

/// A body-centred block, intact within and exposed on its surface.
fn block(cloud: &mut Cloud, cells: [i16; 3], corner: [f64; 3], body: u16) {
    for half in 0..2_i16 {
        let ends = cells.map(|n| n + 1 - half);
        for i in 0..ends[0] {
            for j in 0..ends[1] {
                for k in 0..ends[2] {
                    let place = [2 * i + half, 2 * j + half, 2 * k + half];
                    let at = [0, 1, 2].map(|a| corner[a] + 0.5 * f64::from(place[a]));
                    let surface = (0..3).any(|a| place[a] == 0 || place[a] == 2 * cells[a]);
                    cloud.push(at, 0.866, if surface { EXPOSED } else { 0 });
                    *cloud.body.last_mut().unwrap() = body;
                    *cloud.lattice.last_mut().unwrap() = place;
                }
            }
        }
    }
}
