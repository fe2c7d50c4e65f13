//! Counts and numbers in sentences.

/// The form of a word, or of some, that goes with a count: that of one, or of any other number.
#[must_use]
pub fn either(count: usize, [one, many]: [&'static str; 2]) -> &'static str {
    if count == 1 { one } else { many }
}

/// A count before what is counted: `1 goal`, `2 goals`, `1 claim fails`.
#[must_use]
pub fn counted(count: usize, forms: [&'static str; 2]) -> String {
    format!("{count} {}", either(count, forms))
}

/// Digits of a number in a message, unless more are needed.
const DIGITS: usize = 6;

/// A number with no more digits than a reader needs, or than tell it from another.
#[must_use]
pub fn told_apart(value: f64, other: f64) -> f64 {
    // As text, so that what is shown is the shortest that reads so.
    let rounded = |x: f64, digits: usize| format!("{x:.*e}", digits - 1).parse().unwrap_or(x);
    let apart =
        |digits: &usize| value == other || rounded(value, *digits) != rounded(other, *digits);
    rounded(value, (DIGITS..MOST_DIGITS).find(apart).unwrap_or(MOST_DIGITS))
}

/// Digits that tell any two numbers apart.
const MOST_DIGITS: usize = 17;

/// A message with whatever would move the cursor, colour the terminal or turn the direction of writing shown as its code: input
/// is quoted in messages.
#[must_use]
pub fn harmless(message: &str) -> String {
    let turns = |c: char| matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    let shown = |c: char| {
        let harms = c != '\n' && c.is_control() || turns(c);
        if harms { c.escape_unicode().to_string() } else { c.to_string() }
    };
    message.chars().map(shown).collect()
}

#[cfg(test)]
mod tests {
    use super::{counted, harmless, told_apart};

    #[test]
    fn what_moves_the_cursor_is_shown_as_its_code() {
        assert_eq!(harmless("a\u{1b}[31mb\nc\u{202e}\u{7f}"), "a\\u{1b}[31mb\nc\\u{202e}\\u{7f}");
        assert_eq!(harmless("Δ = 1 µs, „größer“"), "Δ = 1 µs, „größer“");
    }

    #[test]
    fn numbers_have_the_digits_that_tell_them_apart() {
        assert_eq!(told_apart(1.500_000_000_000_004, 2.0), 1.5);
        assert_eq!(told_apart(0.1 + 0.2, 0.3), 0.1 + 0.2);
        assert_eq!(told_apart(2.000_000_04, 2.0), 2.000_000_04);
        assert_eq!(told_apart(0.1 + 0.2, 0.1 + 0.2), 0.3);
    }

    #[test]
    fn one_is_singular_and_none_is_not() {
        let said = [0, 1, 2].map(|count| counted(count, ["case has", "cases have"]));
        assert_eq!(said, ["0 cases have", "1 case has", "2 cases have"]);
    }
}
