//! Ranges, ticks and the mapping from data to pixels.

use super::model::{Axis, Scale};

/// Values beyond this magnitude (or below its inverse, on a logarithmic axis) are not drawn.
const HUGE: f64 = 1e150;

/// One labelled tick; labels of a low rank are kept when there is no room for all.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    pub(super) at: f64,
    pub(super) label: String,
    pub(super) rank: u8,
}

/// The ticks of an axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Ticks {
    pub(super) major: Vec<Tick>,
    pub(super) minor: Vec<f64>,
    /// Common factor of the labels, such as `×10⁻⁶`.
    pub(super) factor: Option<String>,
}

/// Whether a value can be drawn on a scale.
pub(super) fn drawable(scale: Scale, value: f64) -> bool {
    match scale {
        Scale::Linear => value.abs() < HUGE,
        Scale::Log10 => value > HUGE.recip() && value < HUGE,
    }
}

/// Whether fixed limits make sense.
pub(super) fn valid(axis: &Axis) -> bool {
    axis.range.is_none_or(|(lo, hi)| {
        drawable(axis.scale, lo)
            && drawable(axis.scale, hi)
            && widened(axis.scale, lo, hi) == (lo, hi)
    })
}

/// The fixed range of an axis, else that of the values with a margin.
pub(super) fn range(axis: &Axis, values: impl Iterator<Item = f64>) -> (f64, f64) {
    if let Some(fixed) = axis.range {
        return fixed;
    }
    let (lo, hi) = values
        .filter(|v| drawable(axis.scale, *v))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)));
    match axis.scale {
        _ if lo > hi => {
            if axis.scale == Scale::Linear {
                (0.0, 1.0)
            } else {
                (0.1, 10.0)
            }
        }
        Scale::Linear => {
            let (a, b) = widened(Scale::Linear, lo, hi);
            let margin = 0.04 * (b - a);
            (a - margin, b + margin)
        }
        Scale::Log10 => {
            let (a, b) = widened(Scale::Log10, lo, hi);
            let margin = (b / a).powf(0.05);
            (a / margin, b * margin)
        }
    }
}

/// Limits far enough apart to be told from each other on the axis.
fn widened(scale: Scale, lo: f64, hi: f64) -> (f64, f64) {
    match scale {
        Scale::Linear => {
            let least = 1e-9 * lo.abs().max(hi.abs());
            match hi - lo > least {
                true => (lo, hi),
                false if lo == 0.0 => (-1.0, 1.0),
                false => (lo - 0.1 * lo.abs(), hi + 0.1 * hi.abs()),
            }
        }
        Scale::Log10 if hi / lo > 1.0 + 1e-9 => (lo, hi),
        Scale::Log10 => (lo / 2.0, hi * 2.0),
    }
}

/// Ticks of an axis over a range, about `count` of them.
pub(super) fn ticks(scale: Scale, (lo, hi): (f64, f64), count: usize) -> Ticks {
    match scale {
        Scale::Linear => linear_ticks(lo, hi, count),
        Scale::Log10 => log_ticks(lo, hi, count),
    }
}

fn linear_ticks(lo: f64, hi: f64, count: usize) -> Ticks {
    let raw = (hi - lo) / count.max(1) as f64;
    let unit = power_of_ten(raw.log10().floor() as i32);
    let step = [1.0, 2.0, 5.0].map(|m| m * unit).into_iter().find(|s| *s >= raw * (1.0 - 1e-9));
    let step = step.unwrap_or(10.0 * unit);
    let size = lo.abs().max(hi.abs()).log10().floor() as i32;
    let power = if (-2..=4).contains(&size) { 0 } else { size.div_euclid(3) * 3 };
    let scale = power_of_ten(power);
    let decimals = (-(step / scale * (1.0 + 1e-9)).log10().floor()).max(0.0) as usize;
    let (first, last) = ((lo / step - 1e-6).ceil(), (hi / step + 1e-6).floor());
    let major = (0..=(last - first).max(0.0) as usize)
        .map(|i| (first + i as f64) * step)
        .map(|at| Tick { at, label: minus(&format!("{:.decimals$}", at / scale + 0.0)), rank: 0 })
        .collect();
    let factor = (power != 0).then(|| format!("×10{}", superscript(power)));
    Ticks { major, minor: Vec::new(), factor }
}

fn log_ticks(lo: f64, hi: f64, count: usize) -> Ticks {
    let (first, last) = (lo.log10().floor() as i32, hi.log10().ceil() as i32);
    let inside = |v: &f64| *v >= lo * (1.0 - 1e-9) && *v <= hi * (1.0 + 1e-9);
    let multiples = |ms: &'static [u8]| {
        (first..=last)
            .flat_map(move |e| ms.iter().map(move |m| (*m, e)))
            .filter(move |(m, e)| inside(&(f64::from(*m) * power_of_ten(*e))))
    };
    let span = (hi / lo).log10();
    let stride = (span / count.max(1) as f64).ceil().max(1.0) as i32;
    if span < 3.0 && multiples(&[1, 2, 5]).count() < 3 {
        return linear_ticks(lo, hi, count.min(5));
    }
    let (chosen, minor): (&'static [u8], &'static [u8]) = match span {
        s if s < 3.0 => (&[1, 2, 5], &[3, 4, 6, 7, 8, 9]),
        _ if stride == 1 => (&[1], &[2, 3, 4, 5, 6, 7, 8, 9]),
        _ => (&[1], &[1]),
    };
    let plain = span < 3.0 && lo >= 0.9e-3 && hi <= 2e4;
    let major = multiples(chosen).filter(|(_, e)| e.rem_euclid(stride) == 0);
    let major = major.map(|(m, e)| Tick {
        at: f64::from(m) * power_of_ten(e),
        label: match (plain, m) {
            (true, _) => {
                format!("{:.*}", usize::try_from(-e).unwrap_or(0), f64::from(m) * power_of_ten(e))
            }
            (false, 1) => format!("10{}", superscript(e)),
            (false, _) => format!("{m}×10{}", superscript(e)),
        },
        rank: u8::from(m != 1),
    });
    let minor = multiples(minor).map(|(m, e)| f64::from(m) * power_of_ten(e));
    Ticks { major: major.collect(), minor: minor.collect(), factor: None }
}

/// The nearest double to a power of ten, which `powi` does not always give.
fn power_of_ten(exponent: i32) -> f64 {
    format!("1e{exponent}").parse().unwrap_or(f64::NAN)
}

/// An integer as Unicode superscript.
pub fn superscript(n: i32) -> String {
    n.to_string()
        .chars()
        .map(|c| match c {
            '-' => '⁻',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            digit => char::from_u32('⁰' as u32 + digit as u32 - '0' as u32).unwrap_or(digit),
        })
        .collect()
}

/// A number with a true minus sign.
fn minus(text: &str) -> String {
    text.replace('-', "−")
}

/// Maps data to pixels along one direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mapping {
    scale: Scale,
    data: (f64, f64),
    pixels: (f64, f64),
}

impl Mapping {
    /// The mapping of a range onto pixels.
    pub(super) fn new(scale: Scale, (lo, hi): (f64, f64), pixels: (f64, f64)) -> Self {
        Self { scale, data: (Self::length(scale, lo), Self::length(scale, hi)), pixels }
    }

    /// Where a value lies, or nothing when it cannot be drawn.
    pub(super) fn at(&self, value: f64) -> Option<f64> {
        let fraction =
            (Self::length(self.scale, value) - self.data.0) / (self.data.1 - self.data.0);
        // Far beyond the frame all places are alike, and integer pixels must not overflow.
        drawable(self.scale, value)
            .then(|| self.pixels.0 + fraction.clamp(-1e4, 1e4) * (self.pixels.1 - self.pixels.0))
    }

    fn length(scale: Scale, value: f64) -> f64 {
        match scale {
            Scale::Linear => value,
            Scale::Log10 => value.log10(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(ticks: &Ticks) -> Vec<&str> {
        ticks.major.iter().map(|t| t.label.as_str()).collect()
    }

    #[test]
    fn linear_ticks_are_round() {
        assert_eq!(labels(&ticks(Scale::Linear, (-0.31, 0.52), 5)), ["−0.2", "0.0", "0.2", "0.4"]);
        assert_eq!(labels(&ticks(Scale::Linear, (0.0, 4.2), 5)), ["0", "1", "2", "3", "4"]);
        let small = ticks(Scale::Linear, (0.0, 8.1e-4), 5);
        assert_eq!(labels(&small), ["0", "200", "400", "600", "800"]);
        assert_eq!(small.factor.as_deref(), Some("×10⁻⁶"));
    }

    #[test]
    fn log_ticks_are_125_under_three_decades_and_decades_beyond() {
        let near = ticks(Scale::Log10, (40.0, 2100.0), 8);
        assert_eq!(labels(&near), ["50", "100", "200", "500", "1000", "2000"]);
        assert!(near.minor.contains(&300.0));
        let far = ticks(Scale::Log10, (3e-9, 0.2), 8);
        assert_eq!(labels(&far), ["10⁻⁸", "10⁻⁷", "10⁻⁶", "10⁻⁵", "10⁻⁴", "10⁻³", "10⁻²", "10⁻¹"]);
        assert_eq!(ticks(Scale::Log10, (1e-30, 1.0), 6).major.len(), 7);
        assert_eq!(labels(&ticks(Scale::Log10, (2e-6, 6e-5), 8))[0], "2×10⁻⁶");
        assert_eq!(labels(&ticks(Scale::Log10, (0.11, 0.18), 8)).len(), 4);
    }

    #[test]
    fn ranges_survive_any_data() {
        let (lin, log) = (Axis::linear("x"), Axis::log("x"));
        assert_eq!(range(&lin, [].into_iter()), (0.0, 1.0));
        assert_eq!(range(&log, [-1.0, 0.0, f64::NAN].into_iter()), (0.1, 10.0));
        let (lo, hi) = range(&lin, [7.0, f64::INFINITY].into_iter());
        assert!(lo < 7.0 && hi > 7.0);
        assert_eq!(range(&lin, [0.0, 10.0].into_iter()), (-0.4, 10.4));
        for value in [1e-140, 1.0, 1e140] {
            for axis in [&lin, &log] {
                let r = range(axis, [value, value].into_iter());
                assert!(ticks(axis.scale, r, 6).major.len() < 20);
            }
        }
        assert!(!valid(&log.clone().range(0.0, 1.0)) && !valid(&lin.clone().range(2.0, 1.0)));
    }

    #[test]
    fn mapping_skips_what_it_cannot_draw() {
        let log = Mapping::new(Scale::Log10, (1.0, 100.0), (0.0, 200.0));
        assert_eq!(log.at(10.0), Some(100.0));
        assert_eq!(log.at(-1.0), None);
        assert_eq!(log.at(f64::NAN), None);
    }
}
