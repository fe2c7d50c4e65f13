//! `whipple list` and `whipple completions`.

use clap::CommandFactory;

use super::{Cli, Failure, print};
use crate::cases::ALL;

/// Prints the cases.
pub(super) fn list() -> Result<u8, Failure> {
    let mut text = String::new();
    let width = ALL.iter().map(|case| case.id().len()).max().unwrap_or(0);
    for case in ALL {
        text += &format!("{:<width$} {}\n", case.id(), case.title());
        let named: Vec<&str> = case.variants().iter().copied().filter(|v| !v.is_empty()).collect();
        if !named.is_empty() {
            text += &format!("{:<width$}   variants: {}\n", "", named.join(", "));
        }
    }
    print(&text)?;
    Ok(0)
}

/// Prints a completion script.
pub(super) fn completions(shell: clap_complete::Shell) -> Result<u8, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "whipple", &mut script);
    print(&String::from_utf8_lossy(&script))?;
    Ok(0)
}
