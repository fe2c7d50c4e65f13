//! Counts in sentences.

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

#[cfg(test)]
mod tests {
    use super::counted;

    #[test]
    fn one_is_singular_and_none_is_not() {
        let said = [0, 1, 2].map(|count| counted(count, ["case has", "cases have"]));
        assert_eq!(said, ["0 cases have", "1 case has", "2 cases have"]);
    }
}
