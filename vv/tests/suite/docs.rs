//! What is written for readers is true: commands parse, links lead somewhere, scenes are read, formulas are formulas.

use std::fs;
use std::path::{Path, PathBuf};

use whipple_vv::cli::command;
use whipple_vv::scenes::case::FileCase;

/// Pages that are looked at, from the folder of the project on.
const PAGES: [&str; 7] = [
    "README.md",
    "ARCHITECTURE.md",
    "CONTRIBUTING.md",
    "PERFORMANCE.md",
    "docs/tutorial.md",
    "docs/guide.md",
    "docs/theory.md",
];

/// Folders whose files are named in full.
const FOLDERS: [&str; 6] = ["benches/", "docs/", "references/", "reports/", "solver/", "vv/"];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn read(page: &str) -> String {
    fs::read_to_string(root().join(page)).unwrap_or_else(|e| panic!("{page}: {e}"))
}

/// A fenced block: its language and its lines.
struct Fenced {
    language: String,
    text: String,
}

/// Fenced blocks of a page, and what stands outside of them.
fn split(page: &str) -> (Vec<Fenced>, String) {
    let (mut blocks, mut rest): (Vec<Fenced>, String) = (Vec::new(), String::new());
    let mut within = false;
    for line in page.lines() {
        match line.strip_prefix("```") {
            Some(language) if !within => {
                blocks.push(Fenced { language: language.trim().into(), text: String::new() });
                within = true;
            }
            Some(_) => within = false,
            None if within => {
                if let Some(block) = blocks.last_mut() {
                    block.text += &format!("{line}\n");
                }
            }
            None => rest += &format!("{line}\n"),
        }
    }
    assert!(!within, "a block without an end");
    (blocks, rest)
}

/// Code within a line.
fn code(prose: &str) -> impl Iterator<Item = &str> {
    prose.split('`').skip(1).step_by(2)
}

/// Words of a command line, as a shell splits them, up to what is no word of the first command.
fn words(line: &str) -> Vec<String> {
    let (mut all, mut word, mut quote) = (Vec::new(), None::<String>, None);
    for c in line.chars() {
        match (quote, c) {
            (Some(mark), c) if c == mark => quote = None,
            (Some(_), c) => word.get_or_insert_default().push(c),
            (None, '\'' | '"') => {
                quote = Some(c);
                word.get_or_insert_default();
            }
            (None, '#' | '|' | '>' | '&') if word.is_none() => break,
            (None, c) if c.is_whitespace() => all.extend(word.take()),
            (None, c) => word.get_or_insert_default().push(c),
        }
    }
    all.extend(word);
    all
}

/// Why a command is none of the program, if it is not.
fn wrong(line: &str) -> Option<String> {
    let error = command().try_get_matches_from(words(line)).err()?;
    // Help and version end the program too.
    error.use_stderr().then(|| format!("{line}\n{error}"))
}

/// The same of a command in a sentence, which may be named without what it needs.
fn wrong_in_prose(line: &str) -> Option<String> {
    let words = words(line);
    let root = command();
    let named = words.get(1).and_then(|name| root.find_subcommand(name));
    if words.len() == 2 && named.is_some() { None } else { wrong(line) }
}

/// Commands of the program in a line of a shell: by its name, or by cargo.
fn called(line: &str) -> Option<String> {
    let line = line.trim();
    if line.starts_with("whipple ") {
        return Some(line.to_owned());
    }
    let of = line.strip_prefix("cargo run ").filter(|of| !of.contains("--example"))?;
    of.split_once("-- ").map(|(_, rest)| format!("whipple {rest}"))
}

#[test]
fn commands_of_the_pages_are_commands_of_the_program() {
    let mut count = 0;
    let mut bad = Vec::new();
    for page in PAGES {
        let (blocks, prose) = split(&read(page));
        let shell = blocks.iter().filter(|block| block.language == "sh");
        let lines: Vec<String> = shell.flat_map(|b| b.text.lines().filter_map(called)).collect();
        // Words in capitals stand for others.
        let inline = code(&prose)
            .filter_map(called)
            .map(|line| line.replace("COMMAND", "run").replace("--n N", "--n 5"));
        let inline: Vec<String> = inline.collect();
        count += lines.len() + inline.len();
        let found = lines.iter().filter_map(|line| wrong(line));
        let found = found.chain(inline.iter().filter_map(|line| wrong_in_prose(line)));
        bad.extend(found.map(|why| format!("{page}: {why}")));
    }
    assert!(bad.is_empty(), "{}", bad.join("\n"));
    assert!(count > 60, "{count} commands were found");
}

#[test]
fn what_is_no_command_is_found() {
    assert!(wrong("whipple run noh --n 400 --json").is_none());
    assert!(wrong("whipple --version").is_none());
    assert!(wrong("whipple sweep a.toml --vary 'b=1 km/s, 2 km/s' --out out # all").is_none());
    for line in ["whipple rum noh", "whipple run noh --sizes 3", "whipple run noh --n x"] {
        assert!(wrong(line).is_some(), "{line}");
    }
}

/// Every command says how it is used by examples that are right.
#[test]
fn help_ends_with_examples_that_parse() {
    fn look(command: &clap::Command, path: &str) {
        let help = command.get_after_help().map(ToString::to_string).unwrap_or_default();
        let lines: Vec<&str> =
            help.lines().map(str::trim).filter(|line| line.starts_with("whipple ")).collect();
        let own = |line: &&&str| format!("{} ", line.trim()).starts_with(&format!("{path} "));
        assert!(lines.iter().any(|line| own(&line)), "`{path}` has no example:\n{help}");
        for line in lines {
            // What an example says beside its command is two spaces away.
            let line = line.split("  ").next().unwrap_or(line);
            assert_eq!(wrong(line), None, "{path}");
        }
        for part in command.get_subcommands() {
            look(part, &format!("{path} {}", part.get_name()));
        }
    }
    look(&command(), "whipple");
}

/// The anchor of a heading.
fn slug(heading: &str) -> String {
    let kept = |c: &char| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_');
    heading.trim().to_lowercase().chars().filter(kept).collect::<String>().replace(' ', "-")
}

/// Targets of the links of a page.
fn links(prose: &str) -> impl Iterator<Item = &str> {
    prose.split("](").skip(1).filter_map(|rest| rest.split_once(')').map(|(target, _)| target))
}

#[test]
fn links_lead_somewhere() {
    for page in PAGES {
        let folder = root().join(page).parent().expect("a folder").to_owned();
        let (_, prose) = split(&read(page));
        for target in links(&prose).filter(|target| !target.contains("://")) {
            let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
            let path = if file.is_empty() { root().join(page) } else { folder.join(file) };
            assert!(path.exists(), "{page}: {target}");
            if !anchor.is_empty() {
                let text = fs::read_to_string(&path).expect("a page");
                let (_, there) = split(&text);
                let heads = there.lines().filter(|line| line.starts_with('#'));
                let mut slugs = heads.map(|line| slug(line.trim_start_matches('#')));
                assert!(slugs.any(|slug| slug == anchor), "{page}: {target}");
            }
        }
    }
}

#[test]
fn files_that_are_named_are_there() {
    let mut count = 0;
    for page in PAGES {
        let (blocks, prose) = split(&read(page));
        let shell = blocks.iter().filter(|block| block.language == "sh");
        let all =
            shell.flat_map(|block| block.text.lines()).chain(code(&prose)).collect::<Vec<_>>();
        for word in all.into_iter().flat_map(words) {
            // A stroke at the end is a folder's; capitals stand for other names.
            let named = FOLDERS.iter().any(|folder| word.starts_with(folder));
            if !named || word.contains(['*', '{', '<']) || word.contains("NAME") {
                continue;
            }
            count += 1;
            assert!(root().join(&word).exists(), "{page}: {word}");
        }
    }
    assert!(count > 30, "{count} files are named");
}

/// What the fragments of scenes in the guide are put into.
const REST: &str = r#"
stop = "4 us"
resolution = { cell = "1 mm" }

[[body]]
name = "sphere"
material = "copper"
sphere = { diameter = "5 mm" }
at = ["10 cm", "10 cm", "10 cm"]
velocity = ["0 km/s", "0 km/s", "1 km/s"]

[[body]]
name = "rod"
material = "copper"
box = { size = ["4 mm", "4 mm", "32 mm"] }
at = ["2 mm", "2 mm", "16 mm"]
"#;

#[test]
fn scenes_of_the_pages_are_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut count = 0;
    for page in PAGES {
        let (blocks, _) = split(&read(page));
        for block in blocks.iter().filter(|block| block.language == "toml") {
            let text = &block.text;
            let scene = if text.contains("stop = ") {
                text.clone()
            } else if text.starts_with('[') {
                format!("{REST}\n{text}")
            } else {
                format!("{text}\n{REST}")
            };
            let path = folder.path().join(format!("{count}.toml"));
            fs::write(&path, scene).expect("a file");
            if let Err(error) = FileCase::read(&path) {
                panic!("{page}: {error}\n{text}");
            }
            count += 1;
        }
    }
    assert!(count >= 6, "{count} scenes");
}

/// Formulas of a page, those of a line and those that stand alone.
fn formulas(prose: &str) -> Vec<String> {
    let mut all = Vec::new();
    // What is code has no formulas.
    let plain: String = prose.split('`').step_by(2).collect();
    for (k, part) in plain.split("$$").enumerate() {
        if k % 2 == 1 {
            all.push(part.to_owned());
            continue;
        }
        let mut rest = part.split('$');
        rest.next();
        all.extend(rest.step_by(2).map(str::to_owned));
    }
    all
}

/// Formulas are right TeX, and have nothing that Markdown takes away.
#[test]
fn formulas_are_formulas() {
    use pulldown_latex::{Parser, Storage};
    let mut count = 0;
    for page in PAGES {
        let (_, prose) = split(&read(page));
        for tex in formulas(&prose) {
            count += 1;
            let storage = Storage::new();
            for event in Parser::new(&tex, &storage) {
                assert!(event.is_ok(), "{page}: {tex}: {event:?}");
            }
            let escaped = tex
                .split('\\')
                .skip(1)
                .find(|rest| rest.chars().next().is_some_and(|c| c.is_ascii_punctuation()));
            assert_eq!(escaped, None, "{page}: {tex}");
        }
    }
    assert!(count > 100, "{count} formulas");
}

/// Figures that the guide gives of accuracy are those of the README, which is compared with the records.
#[test]
fn figures_of_the_guide_are_those_of_the_readme() {
    let (guide, readme) = (read("docs/guide.md"), read("README.md"));
    let section = guide.split("\n## What to trust").nth(1).expect("the section");
    let figures = section.split(|c: char| !(c.is_ascii_digit() || c == '.'));
    let of_two = figures.filter(|word| {
        word.split_once('.').is_some_and(|(whole, part)| !whole.is_empty() && !part.is_empty())
    });
    for figure in of_two {
        assert!(readme.contains(figure), "{figure} stands in docs/guide.md, and not in README.md");
    }
}
