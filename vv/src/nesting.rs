//! Brackets that are open at once in a text, before it is read as TOML: the reader runs out of its stack, which ends the
//! program, in a megabyte of tables in a line that never close.

/// Brackets that may be open at once; a scene has four.
pub(crate) const DEEPEST: usize = 64;

/// Where too many brackets are open, those in comments and strings counted too.
pub(crate) fn too_deep(text: &str) -> Option<usize> {
    let mut open = 0usize;
    text.bytes().position(|byte| {
        match byte {
            b'[' | b'{' => open += 1,
            b']' | b'}' => open = open.saturating_sub(1),
            _ => {}
        }
        open > DEEPEST
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn brackets_are_counted_that_are_open_at_once() {
        assert_eq!(too_deep(&"a = [[1], [{ b = 2 }]]\n".repeat(1000)), None);
        assert_eq!(too_deep(&"]".repeat(1000)), None);
        assert_eq!(too_deep(&"[".repeat(DEEPEST)), None);
        assert_eq!(too_deep(&"{[".repeat(DEEPEST)), Some(DEEPEST));
    }
}
