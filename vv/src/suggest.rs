//! "Did you mean": the known name nearest to a mistyped one, by edit distance.

/// Number of single-character insertions, deletions, replacements and swaps of neighbours that
/// turn `a` into `b` (Damerau-Levenshtein in its optimal-string-alignment form; case counts).
///
/// Time is the product of the two lengths; memory is three rows.
#[must_use]
pub fn edit_distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let mut before = vec![0; b.len() + 1];
    let mut above: Vec<usize> = (0..=b.len()).collect();
    let mut row = above.clone();
    for i in 1..=a.len() {
        row[0] = i;
        for j in 1..=b.len() {
            let replaced = above[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            row[j] = replaced.min(above[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                row[j] = row[j].min(before[j - 2] + 1);
            }
        }
        std::mem::swap(&mut before, &mut above);
        std::mem::swap(&mut above, &mut row);
    }
    above[b.len()]
}

/// Letters from which on the beginning of a name stands for it.
const BEGINNING: usize = 3;

/// The name of `known` nearest to `wanted`: one within a third of its letters (at least one edit), else one that
/// begins with it, or `None`. Case is ignored; of equally near names the first is taken.
pub fn nearest<'a>(wanted: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let wanted = wanted.to_lowercase();
    let letters = wanted.chars().count();
    let allowed = (letters / 3).max(1);
    let known: Vec<&str> = known.into_iter().collect();
    let begins = || {
        let begins = |name: &&&str| name.to_lowercase().starts_with(&wanted);
        known.iter().find(begins).copied().filter(|_| letters >= BEGINNING)
    };
    known
        .iter()
        .copied()
        .filter(|name| name.chars().count().abs_diff(letters) <= allowed)
        .map(|name| (edit_distance(&wanted, &name.to_lowercase()), name))
        .filter(|&(distance, _)| distance <= allowed)
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, name)| name)
        .or_else(begins)
}

/// The end of an error message: `` "; did you mean `name`?" `` with the name [`nearest`] finds, or
/// nothing.
pub fn did_you_mean<'a>(wanted: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    nearest(wanted, known).map_or_else(String::new, |name| format!("; did you mean `{name}`?"))
}

#[cfg(test)]
mod tests {
    use super::{did_you_mean, edit_distance, nearest};
    use proptest::prelude::{prop_assert, prop_assert_eq, proptest};

    #[test]
    fn known_distances() {
        for (a, b, wanted) in [
            ("", "", 0),
            ("", "noh", 3),
            ("kitten", "sitting", 3),
            ("desnity", "density", 1),
            ("ca", "abc", 3),
            ("größe", "grösse", 2),
        ] {
            assert_eq!(edit_distance(a, b), wanted, "{a} {b}");
        }
    }

    #[test]
    fn nearest_name_or_none() {
        let known = ["density", "velocity", "temperature", "n"];
        assert_eq!(nearest("Densty", known), Some("density"));
        assert_eq!(nearest("veloctiy", known), Some("velocity"));
        assert_eq!(nearest("m", known), Some("n"));
        assert_eq!(nearest("pressure", known), None);
        assert_eq!(nearest("density", []), None);
        assert_eq!(nearest("temp", known), Some("temperature"));
        assert_eq!(nearest("te", known), None);
        assert_eq!(did_you_mean("temprature", known), "; did you mean `temperature`?");
        assert_eq!(did_you_mean("pressure", known), "");
    }

    proptest! {
        #[test]
        fn distance_is_symmetric_and_bounded(a in "[a-d]{0,9}", b in "[a-d]{0,9}") {
            let distance = edit_distance(&a, &b);
            prop_assert_eq!(distance, edit_distance(&b, &a));
            prop_assert_eq!(distance == 0, a == b);
            prop_assert!(distance >= a.len().abs_diff(b.len()));
            prop_assert!(distance <= a.len().max(b.len()));
        }
    }
}
