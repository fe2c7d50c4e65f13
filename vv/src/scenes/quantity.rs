//! Numbers with units: "7 km/s", "10 us", "8.96 g/cm3", "0.000 732 lbf s^2/in^4".
//!
//! A number is turned into the units of a scene. Where the two units differ by a power of ten alone, as most do, the decimal
//! digits are moved before they are read, so that "10 us" is exactly 10 and "0.5 mm" exactly 0.05 cm.

use whipple_solver::units::Units;

use crate::suggest::nearest;

/// Exponents of length, mass, time and temperature. Angles have none.
type Powers = [i32; 4];

/// What a number measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Kind {
    /// In words.
    pub name: &'static str,
    powers: Powers,
    /// An example with its unit.
    pub example: &'static str,
}

macro_rules! kinds {
    ($($name:ident $words:literal [$($power:literal),*] $example:literal;)*) => {
        impl Kind {
            $(#[doc = concat!("Of ", $words, ".")]
            pub const $name: Self = Self { name: $words, powers: [$($power),*], example: $example };)*
        }
    };
}

kinds! {
    LENGTH "a length" [1, 0, 0, 0] "0.5 cm";
    TIME "a time" [0, 0, 1, 0] "20 us";
    VELOCITY "a velocity" [1, 0, -1, 0] "7 km/s";
    SPIN "an angular velocity" [0, 0, -1, 0] "3000 rad/s";
    RATE "a rate" [0, 0, -1, 0] "1 1/s";
    DENSITY "a density" [-3, 1, 0, 0] "2.7 g/cm3";
    PRESSURE "a pressure" [-1, 1, -2, 0] "27.6 GPa";
    TEMPERATURE "a temperature" [0, 0, 0, 1] "300 K";
    SPECIFIC_ENERGY "an energy per mass" [2, 0, -2, 0] "10 kJ/kg";
    SPECIFIC_HEAT "a specific heat" [2, 0, -2, -1] "884 J/kg/K";
    ENERGY "an energy" [2, 1, -2, 0] "5 kJ";
    ANGLE "an angle" [0, 0, 0, 0] "30 deg";
    NUMBER "a number without a unit" [0, 0, 0, 0] "1.34";
}

/// A unit: what it measures, and its size in metre, kilogram, second and kelvin as a number times a power of ten.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Unit {
    powers: Powers,
    size: f64,
    ten: i32,
}

const fn unit(powers: Powers, size: f64, ten: i32) -> Unit {
    Unit { powers, size, ten }
}

const LENGTH: Powers = [1, 0, 0, 0];
const MASS: Powers = [0, 1, 0, 0];
const TIME: Powers = [0, 0, 1, 0];
const FORCE: Powers = [1, 1, -2, 0];
const PRESSURE: Powers = [-1, 1, -2, 0];
const ENERGY: Powers = [2, 1, -2, 0];
const NOTHING: Powers = [0; 4];

/// Pounds in kilograms and pound-forces in newtons (exact by definition), psi by them.
const POUND: f64 = 4.535_923_7;
const POUND_FORCE: f64 = 4.448_221_615_260_5;

/// Units by their symbols. Of several for one thing the first is the one that messages use.
const UNITS: &[(&str, Unit)] = &[
    ("cm", unit(LENGTH, 1.0, -2)),
    ("mm", unit(LENGTH, 1.0, -3)),
    ("m", unit(LENGTH, 1.0, 0)),
    ("um", unit(LENGTH, 1.0, -6)),
    ("µm", unit(LENGTH, 1.0, -6)),
    ("nm", unit(LENGTH, 1.0, -9)),
    ("km", unit(LENGTH, 1.0, 3)),
    ("in", unit(LENGTH, 2.54, -2)),
    ("ft", unit(LENGTH, 3.048, -1)),
    ("mil", unit(LENGTH, 2.54, -5)),
    ("g", unit(MASS, 1.0, -3)),
    ("kg", unit(MASS, 1.0, 0)),
    ("mg", unit(MASS, 1.0, -6)),
    ("t", unit(MASS, 1.0, 3)),
    ("lb", unit(MASS, POUND, -1)),
    ("us", unit(TIME, 1.0, -6)),
    ("µs", unit(TIME, 1.0, -6)),
    ("s", unit(TIME, 1.0, 0)),
    ("ms", unit(TIME, 1.0, -3)),
    ("ns", unit(TIME, 1.0, -9)),
    ("K", unit([0, 0, 0, 1], 1.0, 0)),
    ("N", unit(FORCE, 1.0, 0)),
    ("kN", unit(FORCE, 1.0, 3)),
    ("lbf", unit(FORCE, POUND_FORCE, 0)),
    ("GPa", unit(PRESSURE, 1.0, 9)),
    ("MPa", unit(PRESSURE, 1.0, 6)),
    ("kPa", unit(PRESSURE, 1.0, 3)),
    ("Pa", unit(PRESSURE, 1.0, 0)),
    ("TPa", unit(PRESSURE, 1.0, 12)),
    ("Mbar", unit(PRESSURE, 1.0, 11)),
    ("kbar", unit(PRESSURE, 1.0, 8)),
    ("bar", unit(PRESSURE, 1.0, 5)),
    ("psi", unit(PRESSURE, POUND_FORCE / (2.54 * 2.54), 4)),
    ("ksi", unit(PRESSURE, POUND_FORCE / (2.54 * 2.54), 7)),
    ("J", unit(ENERGY, 1.0, 0)),
    ("kJ", unit(ENERGY, 1.0, 3)),
    ("MJ", unit(ENERGY, 1.0, 6)),
    ("erg", unit(ENERGY, 1.0, -7)),
    ("rad", unit(NOTHING, 1.0, 0)),
    ("deg", unit(NOTHING, std::f64::consts::PI / 180.0, 0)),
    ("°", unit(NOTHING, std::f64::consts::PI / 180.0, 0)),
    ("turn", unit(NOTHING, 2.0 * std::f64::consts::PI, 0)),
    ("%", unit(NOTHING, 1.0, -2)),
    ("1", unit(NOTHING, 1.0, 0)),
];

/// The units of length, mass, time and temperature of a system; none where scenes have none.
fn system(units: Units) -> Option<[Unit; 4]> {
    let named = |symbol: &str| UNITS.iter().find(|(known, _)| *known == symbol).map(|u| u.1);
    let all = match units {
        Units::None => return None,
        Units::CmGUsMbar => ["cm", "g", "us", "K"].map(named),
        Units::InLbfS => {
            // The mass of a pound-force per inch and second squared.
            let mass = unit(MASS, POUND_FORCE / 2.54, 2);
            [named("in"), Some(mass), named("s"), named("K")]
        }
    };
    let [Some(length), Some(mass), Some(time), Some(temperature)] = all else { return None };
    Some([length, mass, time, temperature])
}

/// A number in the units of a scene.
///
/// # Errors
/// What is wrong with it, in words, with the wanted form.
pub fn read(text: &str, kind: Kind, units: Units) -> Result<f64, String> {
    let text = text.trim();
    let (digits, symbols) = split(text);
    let wanted = || format!("wanted {} such as \"{}\"", kind.name, kind.example);
    // Digits may stand in groups.
    let digits: String = digits.chars().filter(|c| !matches!(c, ' ' | '_')).collect();
    let number: f64 = digits
        .parse()
        .map_err(|_| format!("`{text}` does not begin with a number: {}", wanted()))?;
    if kind == Kind::NUMBER || symbols.is_empty() {
        return match (kind.powers == NOTHING && kind != Kind::ANGLE, symbols.is_empty()) {
            (true, true) => Ok(number),
            (true, false) if symbols == "%" => Ok(shifted(&digits, number, -2)),
            (true, false) => Err(format!("`{text}` has a unit, but {}", wanted())),
            (false, _) if units == Units::None => Ok(number),
            (false, _) => Err(format!("`{text}` has no unit: {}", wanted())),
        };
    }
    let Some(own) = expression(symbols)? else {
        return Err(format!("`{symbols}` is no unit: {}", wanted()));
    };
    if own.powers != kind.powers {
        return Err(format!("`{symbols}` is no unit of {}: {}", kind.name, wanted()));
    }
    let Some(system) = system(units) else {
        if kind.powers == NOTHING {
            return Ok(number * own.size);
        }
        let message = format!("`{text}` has a unit, but the scene has none (`units = \"none\"`)");
        return Err(message);
    };
    let (mut size, mut ten) = (own.size, own.ten);
    for (base, power) in system.iter().zip(kind.powers) {
        size /= base.size.powi(power);
        ten -= base.ten * power;
    }
    // What cancels but for round-off cancels.
    let size = if (size - 1.0).abs() < 1e-14 { 1.0 } else { size };
    let value = shifted(&digits, number, ten) * size;
    if value.is_finite() { Ok(value) } else { Err(format!("`{text}` is not finite")) }
}

/// The number of these digits times a power of ten, rounded once.
fn shifted(digits: &str, number: f64, ten: i32) -> f64 {
    if ten == 0 {
        return number;
    }
    let (mantissa, exponent) = digits.split_once(['e', 'E']).unwrap_or((digits, "0"));
    let Ok(exponent) = exponent.parse::<i32>() else { return number };
    format!("{mantissa}e{}", exponent.saturating_add(ten)).parse().unwrap_or(number)
}

/// The number and the rest.
fn split(text: &str) -> (&str, &str) {
    let mut end = 0;
    let bytes = text.as_bytes();
    while end < bytes.len() {
        let c = bytes[end];
        let after = |k: usize| bytes.get(end + k).copied().unwrap_or(0);
        let exponent = matches!(c, b'e' | b'E')
            && (after(1).is_ascii_digit()
                || (matches!(after(1), b'+' | b'-') && after(2).is_ascii_digit()));
        let sign = matches!(c, b'+' | b'-') && (end == 0 || matches!(bytes[end - 1], b'e' | b'E'));
        // A group of digits: "0.000 732".
        let group = matches!(c, b' ' | b'_')
            && end > 0
            && bytes[end - 1].is_ascii_digit()
            && after(1).is_ascii_digit()
            && !(after(1) == b'1' && after(2) == b'/');
        if c.is_ascii_digit() || c == b'.' || exponent || sign || group {
            end += 1;
        } else {
            break;
        }
    }
    (&text[..end], text[end..].trim())
}

/// The unit of an expression such as `km/s`, `g/cm3` or `lbf s^2/in^4`; nothing if it is none.
fn expression(text: &str) -> Result<Option<Unit>, String> {
    let mut whole = unit(NOTHING, 1.0, 0);
    for (k, part) in text.split('/').enumerate() {
        let part = part.trim().trim_start_matches('(').trim_end_matches(')');
        let factors = part.split([' ', '*', '·']).filter(|factor| !factor.is_empty());
        let mut any = false;
        for factor in factors {
            any = true;
            let letters = factor.trim_end_matches(|c: char| c.is_ascii_digit() || c == '-');
            let letters = if letters.is_empty() { factor } else { letters };
            let power = factor[letters.len()..].trim_start_matches('^');
            let letters = letters.trim_end_matches('^');
            let power: i32 = match (power, factor) {
                ("", _) => 1,
                (power, _) => match power.parse() {
                    Ok(power) if (-9..=9).contains(&power) => power,
                    _ => return Ok(None),
                },
            };
            let (letters, power) = match letters.strip_suffix(['²', '³']) {
                Some(plain) if letters.ends_with('²') => (plain, 2 * power),
                Some(plain) => (plain, 3 * power),
                None => (letters, power),
            };
            let Some((_, own)) = UNITS.iter().find(|(symbol, _)| *symbol == letters) else {
                let near = nearest(letters, UNITS.iter().map(|u| u.0))
                    .map_or_else(String::new, |name| format!("; did you mean `{name}`?"));
                return Err(format!("`{letters}` is no unit that is known{near}"));
            };
            let power = if k == 0 { power } else { -power };
            whole.size *= own.size.powi(power);
            whole.ten += own.ten * power;
            for (sum, own) in whole.powers.iter_mut().zip(own.powers) {
                *sum += own * power;
            }
        }
        if !any {
            return Ok(None);
        }
    }
    Ok(Some(whole))
}

#[cfg(test)]
mod tests {
    use super::*;

    const CM: Units = Units::CmGUsMbar;

    #[test]
    fn decimal_units_are_exact() {
        for (text, kind, wanted) in [
            ("10 us", Kind::TIME, 10.0),
            ("10us", Kind::TIME, 10.0),
            ("0.5 mm", Kind::LENGTH, 0.05),
            ("7 km/s", Kind::VELOCITY, 0.7),
            ("1500 m/s", Kind::VELOCITY, 0.15),
            ("2.7 g/cm3", Kind::DENSITY, 2.7),
            ("8960 kg/m^3", Kind::DENSITY, 8.96),
            ("27.6 GPa", Kind::PRESSURE, 0.276),
            ("276 MPa", Kind::PRESSURE, 0.00276),
            ("884 J/kg/K", Kind::SPECIFIC_HEAT, 0.884e-5),
            ("884 J/(kg K)", Kind::SPECIFIC_HEAT, 0.884e-5),
            ("1 1/s", Kind::RATE, 1e-6),
            ("1e3 rad/s", Kind::SPIN, 1e-3),
            ("300 K", Kind::TEMPERATURE, 300.0),
            ("10 kJ/g", Kind::SPECIFIC_ENERGY, 0.1),
            ("-4.7 mm", Kind::LENGTH, -0.47),
            ("12 %", Kind::NUMBER, 0.12),
            ("1_000 µm", Kind::LENGTH, 0.1),
        ] {
            assert_eq!(read(text, kind, CM), Ok(wanted), "{text}");
        }
    }

    #[test]
    fn other_units_are_right_to_round_off() {
        for (text, kind, units, wanted) in [
            ("1 in", Kind::LENGTH, CM, 2.54),
            ("30 deg", Kind::ANGLE, CM, 30f64.to_radians()),
            ("14.503 773 773 psi", Kind::PRESSURE, CM, 1e-6),
            ("1 cm", Kind::LENGTH, Units::InLbfS, 1.0 / 2.54),
            ("1 psi", Kind::PRESSURE, Units::InLbfS, 1.0),
            ("0.000 732 lbf s^2/in^4", Kind::DENSITY, Units::InLbfS, 0.000_732),
            ("2 s", Kind::TIME, Units::InLbfS, 2.0),
        ] {
            let found = read(text, kind, units).unwrap();
            assert!((found / wanted - 1.0).abs() < 1e-9, "{text}: {found} {wanted}");
        }
        assert_eq!(read("1.5", Kind::LENGTH, Units::None), Ok(1.5));
        assert_eq!(read("1.5", Kind::NUMBER, CM), Ok(1.5));
    }

    #[test]
    fn what_is_no_quantity_says_what_is_wanted() {
        let said = |text, kind| read(text, kind, CM).unwrap_err();
        insta::assert_snapshot!(
            [
                said("7", Kind::VELOCITY),
                said("7 km", Kind::VELOCITY),
                said("fast", Kind::VELOCITY),
                said("7 kmh", Kind::VELOCITY),
                said("7 km//s", Kind::VELOCITY),
                said("3 cm", Kind::NUMBER),
                said("", Kind::LENGTH),
                said("1e999 cm", Kind::LENGTH),
                said("30", Kind::ANGLE),
                read("3 cm", Kind::LENGTH, Units::None).unwrap_err(),
            ]
            .join("\n")
        );
    }
}
