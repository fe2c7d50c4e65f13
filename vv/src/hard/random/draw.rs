//! Random numbers of a seed.

/// The generator `SplitMix64` of Steele, Lea and Flood (2014): all that it gives follows from the seed.
///
/// Where logarithms and sines stand behind a number, its last bit may differ between platforms.
#[derive(Debug)]
pub(super) struct Draw(u64);

impl Draw {
    /// That of a seed.
    pub(super) fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next 64 bits.
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number from 0 to below 1.
    fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / 2f64.powi(53)
    }

    /// A number between two others.
    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// A number between two positive ones, whose logarithm is evenly spread.
    pub(super) fn log_between(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.unit())
    }

    /// A whole number below `end`, which is not 0.
    pub(super) fn below(&mut self, end: usize) -> usize {
        ((end as f64 * self.unit()) as usize).min(end - 1)
    }

    /// Whether something of this probability happens.
    pub(super) fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    /// One of some, which are not none.
    pub(super) fn one_of<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.below(all.len())]
    }

    /// The number of one of some, which have these weights.
    pub(super) fn weighted(&mut self, weights: &[f64]) -> usize {
        let mut left = weights.iter().sum::<f64>() * self.unit();
        for (k, weight) in weights.iter().enumerate() {
            left -= weight;
            if left < 0.0 {
                return k;
            }
        }
        weights.len() - 1
    }

    /// A unit vector, any as likely as any other.
    pub(super) fn direction(&mut self) -> [f64; 3] {
        let z = self.between(-1.0, 1.0);
        let (sine, cosine) = self.between(0.0, std::f64::consts::TAU).sin_cos();
        let r = (1.0 - z * z).sqrt();
        [r * cosine, r * sine, z]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_those_of_splitmix64() {
        // Of the seed 1234567: the first outputs that implementations are compared by.
        let mut draw = Draw::new(1_234_567);
        let first = [draw.bits(), draw.bits(), draw.bits()];
        assert_eq!(
            first,
            [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423]
        );
    }

    #[test]
    fn numbers_keep_to_their_ranges() {
        let mut draw = Draw::new(7);
        for _ in 0..1000 {
            assert!((2.0..3.0).contains(&draw.between(2.0, 3.0)));
            assert!((1e-3..=5.0).contains(&draw.log_between(1e-3, 5.0)));
            assert!(draw.below(3) < 3 && draw.weighted(&[1.0, 0.0, 2.0]) != 1);
            let size: f64 = draw.direction().iter().map(|x| x * x).sum();
            // Rounded a few times.
            assert!((size - 1.0).abs() < 1e-14);
        }
    }
}
