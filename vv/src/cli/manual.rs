//! `whipple man` and `whipple completions`: the command line, written down for other programs.

use std::path::{Path, PathBuf};

use clap::{Command, CommandFactory};
use clap_mangen::Man;

use super::{Cli, Failure, print};
use crate::files::{ensure_writable_dir, write_atomic};

pub(super) const MAN_EXAMPLES: &str = "\
Examples:
  whipple man | man -l -                          the program as a whole
  whipple man --out ~/.local/share/man/man1       a page of every command";

pub(super) const COMPLETIONS_EXAMPLES: &str = "\
Examples:
  whipple completions bash > ~/.local/share/bash-completion/completions/whipple
  whipple completions zsh > ~/.zfunc/_whipple
  whipple completions fish > ~/.config/fish/completions/whipple.fish
  whipple completions powershell >> $PROFILE";

/// Prints a completion script.
pub(super) fn completions(shell: clap_complete::Shell) -> Result<u8, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "whipple", &mut script);
    print(&String::from_utf8_lossy(&script))?;
    Ok(0)
}

/// Prints the manual page of the program, or writes those of all commands into a folder.
pub(super) fn man(out: Option<&Path>) -> Result<u8, Failure> {
    let mut whole = Cli::command();
    whole.build();
    let Some(out) = out else {
        print(&String::from_utf8_lossy(&page(&whole)?))?;
        return Ok(0);
    };
    let pages = pages(&whole)?;
    // Pages of another version are as much of the program as these; what is no page of it is not.
    for (name, _) in &pages {
        refuse_other(&out.join(name))?;
    }
    ensure_writable_dir(out)?;
    let mut written = String::new();
    for (name, text) in pages {
        let path = out.join(name);
        write_atomic(&path, &text)?;
        written += &format!("{}\n", path.display());
    }
    print(&written)?;
    Ok(0)
}

/// A command as a manual page.
fn page(command: &Command) -> Result<Vec<u8>, Failure> {
    let mut text = Vec::new();
    Man::new(command.clone()).render(&mut text).map_err(Failure::usage)?;
    Ok(text)
}

/// Pages of a command that is built and of those within it, by the names of their files.
fn pages(command: &Command) -> Result<Vec<(PathBuf, Vec<u8>)>, Failure> {
    let name = command.get_display_name().unwrap_or_else(|| command.get_name());
    let mut all = vec![(PathBuf::from(format!("{name}.1")), page(command)?)];
    for part in command.get_subcommands().filter(|part| part.get_name() != "help") {
        all.extend(pages(part)?);
    }
    Ok(all)
}

/// Refuses to write over a file that is no manual page of this program.
fn refuse_other(path: &Path) -> Result<(), Failure> {
    let Ok(text) = std::fs::read(path) else { return Ok(()) };
    if String::from_utf8_lossy(&text).contains(".TH whipple") {
        return Ok(());
    }
    let message = format!(
        "{} is there already, and no manual page of this program: name another folder with --out, or move that \
         file away",
        path.display()
    );
    Err(Failure::usage(message))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every command has a page of its own, which names it, and says its options.
    #[test]
    fn every_command_has_a_page() {
        let mut whole = Cli::command();
        whole.build();
        let pages = pages(&whole).expect("pages");
        let named = |wanted: &str| {
            let page = pages.iter().find(|(name, _)| name.as_os_str() == wanted);
            String::from_utf8_lossy(&page.unwrap_or_else(|| panic!("no {wanted}")).1).into_owned()
        };
        assert!(named("whipple.1").contains(".TH whipple 1"));
        let run = named("whipple-run.1");
        assert!(run.contains(".TH whipple-run 1") && run.contains("max"), "{run}");
        assert!(named("whipple-material-show.1").contains("Hugoniot"));
        assert!(pages.iter().all(|(name, _)| !name.display().to_string().contains("help")));
    }

    /// What is no page of the program stays.
    #[test]
    fn other_files_are_not_written_over() {
        let folder = tempfile::tempdir().expect("a folder");
        let other = folder.path().join("whipple-run.1");
        std::fs::write(&other, "mine").expect("a file");
        assert!(man(Some(folder.path())).is_err());
        assert_eq!(std::fs::read_to_string(&other).expect("it"), "mine");
        assert_eq!(std::fs::read_dir(folder.path()).expect("the folder").count(), 1);
        std::fs::remove_file(&other).expect("to remove it");
        for _ in 0..2 {
            assert!(man(Some(folder.path())).is_ok());
        }
    }
}
