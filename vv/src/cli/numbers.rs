//! Whole numbers on the command line, with what is allowed said in the refusal.

use std::ops::RangeInclusive;

use whipple_solver::scene::MAX_PARTICLES;

use super::sizes::grouped;

/// Sizes that a case may be asked for; whether it has such a size is for its scene to say.
pub(super) const SIZES: RangeInclusive<usize> = 1..=MAX_PARTICLES;

/// Threads that a run may ask for.
pub(super) const THREADS: RangeInclusive<usize> = 1..=1024;

/// Random impacts that may be asked for.
pub(super) const SCENES: RangeInclusive<usize> = 1..=10_000_000;

/// A parser of whole numbers in a range.
pub(super) fn whole(
    range: RangeInclusive<usize>,
) -> impl Fn(&str) -> Result<usize, String> + Clone + Send + Sync {
    move |text| {
        let number = text.trim().parse().ok().filter(|number| range.contains(number));
        number.ok_or_else(|| {
            let [start, end] = [range.start(), range.end()].map(|&bound| grouped(bound as u64));
            format!("wanted a whole number from {start} to {end}")
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_outside_the_range_are_refused_with_it() {
        let parse = whole(THREADS);
        assert_eq!((parse("1"), parse(" 1024 ")), (Ok(1), Ok(1024)));
        for text in ["0", "1025", "-1", "1.0", "1e2", "two", "", "99999999999999999999999"] {
            let refused = Err("wanted a whole number from 1 to 1024".to_owned());
            assert_eq!(parse(text), refused, "{text}");
        }
    }
}
