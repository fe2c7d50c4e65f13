//! `whipple run`: one case, once.

use std::path::Path;

use whipple_solver::error::StepError;
use whipple_solver::method::Preset;
use whipple_solver::space;
use whipple_solver::units::{Dimension, Units};

use super::folder::{begin, clear, end, refuse_another_run};
use super::hard;
use super::progress::{Outlook, Progress};
use super::results::{Bounds, json, text, write_outputs};
use super::resume::{self, refusal, resume};
use super::sizes::{cannot, foresee};
use super::{Failure, INTERRUPTED, NUMERICAL_FAILURE, RunArgs, print, say};
use crate::cases::{self, Case};
use crate::keys;
use crate::lock::FolderLock;
use crate::memory::Keeps;
use crate::overrides;
use crate::record::{Outcome, RunKey, RunRecord, Scheme};
use crate::report::sig;
use crate::run::{Request, RunError, SpaceOptions, run_with};
use crate::scene::AnyScene;
use crate::scenes::case::{FileCase, OVER};
use crate::space::checkpoint::load;
use crate::space::diagnosis::Diagnosis;
use crate::space::recorder::Recorder;
use crate::suggest::did_you_mean;
use crate::suite::{command_of, scene_of};
use crate::words::counted;

pub(super) const EXAMPLES: &str = "\
Examples:
  whipple run noh --preset paper --n 400 --json
  whipple run sod --set heating=printed --out out/sod
  whipple run shield.toml --vtu 2us --checkpoint 10min --out out/shield

Exit codes:
  0    the run came to its end, also where its numbers are not what is wanted
  2    wrong use or input
  3    numerical failure
  130  interrupted, or --max-wall is over";

/// Steps up to which a run has hardly left its start.
const FEW_STEPS: u64 = 2;

/// Runs a case as the arguments say.
pub(super) fn run(args: &RunArgs) -> Result<u8, Failure> {
    let own = file_case(&args.case)?;
    let case = match &own {
        Some(own) => own as &dyn Case,
        None => find(&args.case)?,
    };
    let variant = variant(case, args)?;
    let (request, bounds, mut notes) = request(case, &variant, args)?;
    let scene = request.scene.clone();
    let (options, outlook, _lock) = match &scene {
        Some(AnyScene::Space(scene)) => options(scene, args, &request, &mut notes)?,
        _ => (SpaceOptions::default(), Outlook::default(), only_in_space(args, &request)?),
    };
    let unit = scene.as_ref().map_or("", |scene| scene.units().label(Dimension::Time));

    let progress = Progress::new(outlook);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(args.threads).build();
    let pool = pool.map_err(|e| Failure::usage(format!("cannot start threads: {e}")))?;
    notes.extend(own.iter().flat_map(|own| own.built().notes.clone()));
    notes.extend(note_threads(args.threads));
    // Not before a refusal.
    notes.iter().for_each(|note| say(&format!("note: {note}")));
    progress.start(case.id(), unit);
    let command = request.command.clone();
    let done = pool.install(|| run_with(case, request, options, &progress));
    progress.done();
    let done = match done {
        Err(RunError::Interrupted { checkpoint }) => {
            let why = if progress.is_late() { "--max-wall is over" } else { "interrupted" };
            let space = matches!(scene, Some(AnyScene::Space(_)));
            let next = space.then(|| how_to_go_on(args, &command, checkpoint.as_deref()));
            let message = format!("{why}{}", next.unwrap_or_default());
            return Err(Failure { code: INTERRUPTED, message });
        }
        Err(RunError::Resume(error)) => {
            let path = args.resume.as_deref().unwrap_or(Path::new(""));
            return Err(refusal(path, &error, &command));
        }
        other => other?,
    };

    if let Some(out) = &args.out {
        write_outputs(out, case, &done)?;
        end(out)?;
    }
    notes_on(&done.record).iter().for_each(|note| say(&format!("note: {note}")));
    print(&if args.json { json(&bounds, &done.record)? } else { text(&bounds, &done.record) })?;
    match done.failure {
        Some(error) => {
            let told = match (&args.out, &done.checkpoint, &scene) {
                (Some(out), Some(checkpoint), Some(AnyScene::Space(scene))) => {
                    told(scene, &error, [out, checkpoint])
                }
                (None, _, Some(AnyScene::Space(_))) => {
                    "; with --out DIR it keeps the last good state and says where it broke"
                        .to_owned()
                }
                _ => String::new(),
            };
            Err(Failure { code: NUMERICAL_FAILURE, message: format!("{error}{told}") })
        }
        None => Ok(0),
    }
}

/// Where a run broke and the likely cause, and what is left of it. That it cannot be found out or drawn is said, and
/// hides nothing.
fn told(scene: &space::Scene, error: &StepError, [out, checkpoint]: [&Path; 2]) -> String {
    let kept = format!("; the last good state is kept in {}", checkpoint.display());
    let Ok(halted) = load(checkpoint, scene) else { return kept };
    let Ok(Some(found)) = Diagnosis::new(scene, &halted.simulation, error) else { return kept };
    let drawn = match found.draw(out) {
        Ok(path) => format!("what lies near it is drawn in {}", path.display()),
        Err(error) => format!("what lies near it cannot be drawn: {error}"),
    };
    format!("; {}; {drawn}{kept}", found.text())
}

/// Takes the folder for the results of a run along a line; options that such a run has no use for are
/// refused.
fn only_in_space(args: &RunArgs, request: &Request) -> Result<Option<FolderLock>, Failure> {
    let given = [
        ("--vtu", args.vtu.is_some()),
        ("--resume", args.resume.is_some()),
        ("--max-wall", args.max_wall.is_some()),
        ("--checkpoint", args.checkpoint.is_some()),
    ];
    if let Some((option, _)) = given.into_iter().find(|(_, given)| *given) {
        let message = format!("{option} needs a case in three dimensions, `{}` is none", args.case);
        return Err(Failure::usage(message));
    }
    let lock = args.out.as_deref().map(FolderLock::take).transpose()?;
    if let Some(out) = &args.out {
        refuse_another_run(out, request, false, &request.command)?;
    }
    Ok(lock)
}

/// What a run in three dimensions goes on from and leaves, what to expect of it, and its folder. Nothing is
/// written before the checkpoint has been read.
fn options(
    scene: &space::Scene,
    args: &RunArgs,
    request: &Request,
    notes: &mut Vec<String>,
) -> Result<(SpaceOptions, Outlook, Option<FolderLock>), Failure> {
    let command = &request.command;
    let every = args.vtu.map(|every| every.in_units("--vtu", scene.units)).transpose()?;
    let from = args.resume.as_deref().map(|path| resume(path, scene, command)).transpose()?;
    let lock = args.out.as_deref().map(FolderLock::take).transpose()?;
    let recorder = match &args.out {
        Some(out) => {
            refuse_another_run(out, request, from.is_some(), &repeated(args, command))?;
            begin(out, command)?;
            if from.is_none() {
                clear(out)?;
            }
            let recorder = Recorder::new(out, scene, every, from.as_ref());
            let mut recorder = recorder.map_err(Failure::usage)?.of(command);
            if let (Some(path), Some(halted)) = (&args.resume, &from) {
                let time = (halted.simulation.time(), scene.units);
                notes.extend(resume::carry(&mut recorder, (out, path), time, every.is_some()));
            }
            Some(match args.checkpoint {
                Some(every) => recorder.keeping(every),
                None => recorder,
            })
        }
        None => {
            refuse_without_folder(args)?;
            let note =
                "nothing of this run is kept without --out: no record, pictures or checkpoint";
            notes.push(note.to_owned());
            None
        }
    };
    let done = from.as_ref().map(|halted| &halted.simulation);
    let outlook = Outlook {
        from: done.map_or((0.0, 0), |s| (s.time(), s.counters().particle_steps)),
        max_wall: args.max_wall,
    };
    let pictures = recorder.is_some();
    Ok((SpaceOptions { from, recorder, pictures }, outlook, lock))
}

/// Refuses options that say what to leave in a folder where none is named.
fn refuse_without_folder(args: &RunArgs) -> Result<(), Failure> {
    let given = [
        ("--vtu", args.vtu.is_some(), "the frames"),
        ("--max-wall", args.max_wall.is_some(), "the checkpoint that the run goes on from"),
        ("--checkpoint", args.checkpoint.is_some(), "the checkpoints"),
    ];
    given.into_iter().find(|(_, given, _)| *given).map_or(Ok(()), |(option, _, what)| {
        let message = format!(
            "{option} needs a folder for {what}: add --out DIR, such as --out out/{}",
            args.case
        );
        Err(Failure::usage(message))
    })
}

/// Mentions more threads than the machine can run at once.
fn note_threads(threads: usize) -> Option<String> {
    let most = std::thread::available_parallelism().ok()?.get();
    (threads > most).then(|| {
        let processors = counted(most, ["processor", "processors"]);
        format!("--threads {threads} are more than the {processors} of this machine, and slower than --threads {most}")
    })
}

/// Where a run that was stopped stands, and the command that continues it.
fn how_to_go_on(args: &RunArgs, command: &str, checkpoint: Option<&Path>) -> String {
    let (Some(out), Some(checkpoint)) = (&args.out, checkpoint) else {
        return if args.out.is_some() {
            "; no checkpoint: this case reads states that a checkpoint does not keep".into()
        } else {
            "; nothing is kept without --out".into()
        };
    };
    let again = repeated(args, command);
    let [out, checkpoint] = [out, checkpoint].map(|path| path.display());
    format!(
        "; the state is kept in {checkpoint}; continue with\n  {again} --out {out} --resume {checkpoint}"
    )
}

/// The command of a run with the options that its record does not know of, but for those of its folder.
fn repeated(args: &RunArgs, command: &str) -> String {
    let mut again = command.to_owned();
    if let Some(every) = args.vtu {
        again += &format!(" --vtu {every}");
    }
    if args.threads != 1 {
        again += &format!(" --threads {}", args.threads);
    }
    // Whoever waits for the rest wants it whole: `--max-wall` is left out.
    if let Some(every) = args.checkpoint {
        let every = humantime::format_duration(every).to_string().replace(' ', "");
        again += &format!(" --checkpoint {every}");
    }
    again
}

/// What is compared with what where a run ends at another time, or is of another problem.
fn note_changes(case: &dyn Case, scene: &AnyScene, mut plain: AnyScene) -> Vec<String> {
    let mut notes = Vec::new();
    if scene.stop_time() != plain.stop_time() {
        let note = "the run ends at another time: an answer that is a function of time is taken then, any \
                    other stays that of the end of the case";
        notes.push(note.to_owned());
        plain.set_stop_time(scene.stop_time());
    }
    if !scene.same_problem(&plain) {
        notes.push(format!(
            "the problem is not that of `{}`: what was measured is compared with the answer to the case as \
             it stands, not to this problem",
            case.id()
        ));
    }
    notes
}

/// Mentions the `--set` that change nothing: those that are redundant, and keys that this scene has no use
/// for.
fn note_idle(sets: &[String], redundant: &[&String], scene: &AnyScene) -> Vec<String> {
    let note = |set: &String| {
        let key = set.split('=').next().unwrap_or_default().trim();
        if redundant.contains(&set) {
            return Some(format!(
                "`--set {set}` changes nothing: the scene has this value already"
            ));
        }
        keys::idle(key, scene)
            .map(|why| format!("`--set {set}` changes nothing in this run: {why}"))
    };
    sets.iter().filter_map(note).collect()
}

/// Mentions a variant of the kernel's support that is run without it.
fn note_support(variant: &str, scene: &AnyScene) -> Option<String> {
    let why = keys::idle("kernel_support", scene).filter(|_| variant.starts_with("support-"))?;
    Some(format!("the variant `{variant}` changes nothing in this run: {why}"))
}

/// Refuses a value that both an option of its own and `--set` give.
fn refuse_given_twice(args: &RunArgs) -> Result<(), Failure> {
    let own = [
        ("density", "density", args.density.is_some()),
        ("stop", "stop_time", args.stop.is_some()),
    ];
    let twice = |&(_, key, given): &(&str, &str, bool)| {
        given && args.sets.iter().any(|set| overrides::key(set) == key)
    };
    own.iter().find(|own| twice(own)).map_or(Ok(()), |(option, key, _)| {
        let message = format!("`--{option}` and `--set {key}` both give one value: one has to do");
        Err(Failure::usage(message))
    })
}

/// The scene of a file, where a name is that of one.
fn file_case(name: &str) -> Result<Option<FileCase>, Failure> {
    let path = Path::new(name);
    let is_file = path.extension().is_some_and(|end| end == "toml");
    is_file.then(|| FileCase::read(path).map_err(Failure::usage)).transpose()
}

/// What is said of material constants that a run took beyond their range.
fn note_ranges(record: &RunRecord) -> Vec<String> {
    let over =
        record.norms.iter().filter_map(|(name, times)| Some((name.strip_suffix(OVER)?, times)));
    let said = over.map(|(name, times)| {
        let (material, what) = name.rsplit_once('.').unwrap_or((name, ""));
        let times = sig(*times, 3);
        format!("the {what} of `{material}` went to {times} times the range of its constants")
    });
    said.collect()
}

/// What is to be said of a record: ranges that were left, and a run that says nothing.
fn notes_on(record: &RunRecord) -> Vec<String> {
    let mut notes = note_ranges(record);
    if record.outcome == Outcome::Completed && (1..=FEW_STEPS).contains(&record.steps) {
        let steps = counted(record.steps as usize, ["step", "steps"]);
        notes.push(format!(
            "the run took {steps}: its end is shorter than a few of them, and what was measured is the start"
        ));
    }
    notes
}

/// The case of a name.
pub(super) fn find(name: &str) -> Result<&'static dyn Case, Failure> {
    cases::find(name).ok_or_else(|| {
        if let Some(group) = hard::named(name) {
            return Failure::usage(format!(
                "`{name}` is one of the cases that try to break the solver, or their group: `whipple vv {group}` runs it"
            ));
        }
        let known: Vec<&str> = cases::ALL.iter().map(|c| c.id()).collect();
        let hint = did_you_mean(name, known);
        Failure::usage(format!("there is no case `{name}`{hint} (`whipple list` names them all)"))
    })
}

/// Cases by name; all when none is named.
pub(super) fn find_all(names: &[String]) -> Result<Vec<&'static dyn Case>, Failure> {
    if names.is_empty() {
        return Ok(cases::ALL.to_vec());
    }
    let mut cases: Vec<&'static dyn Case> = Vec::new();
    for name in names {
        let case = find(name)?;
        // One that is named twice runs once.
        if !cases.iter().any(|other| other.id() == case.id()) {
            cases.push(case);
        }
    }
    Ok(cases)
}

/// A variant that the case does not have.
fn no_variant(case: &dyn Case, wanted: &str) -> Failure {
    let known = named_variants(case);
    let hint = did_you_mean(wanted, known.iter().copied());
    let all = if known.is_empty() { "none".into() } else { known.join(", ") };
    Failure::usage(format!("`{}` has no variant `{wanted}`{hint} (it has: {all})", case.id()))
}

/// The variant of a run: that named, or the one that options of the case choose.
fn variant(case: &dyn Case, args: &RunArgs) -> Result<String, Failure> {
    let given = [("angle", &args.angle), ("eos", &args.eos)];
    let mut parts = Vec::new();
    for (name, value) in given.into_iter().filter_map(|(name, value)| Some((name, value.as_ref()?)))
    {
        let Some(choice) = case.choices().iter().find(|choice| choice.name == name) else {
            return Err(no_choice(case, name));
        };
        if !choice.values.contains(&value.as_str()) {
            // Numbers have no neighbours in spelling.
            let words = choice.values.iter().copied().filter(|_| value.parse::<f64>().is_err());
            let hint = did_you_mean(value, words);
            let all = choice.values.join(", ");
            let id = case.id();
            let message = format!("`{id}` has no --{name} {value}{hint} (it has: {all})");
            return Err(Failure::usage(message));
        }
        parts.extend(choice.named(value));
    }
    let variant = if parts.is_empty() { args.variant.clone() } else { parts.join("_") };
    if case.variants().contains(&variant.as_str()) {
        Ok(variant)
    } else {
        Err(no_variant(case, &variant))
    }
}

/// An option that the case does not have.
fn no_choice(case: &dyn Case, name: &str) -> Failure {
    let has = |case: &&dyn Case| case.choices().iter().any(|choice| choice.name == name);
    let others: Vec<&str> = cases::ALL.iter().copied().filter(has).map(Case::id).collect();
    let message = format!("`{}` has no --{name}; {} has", case.id(), others.join(", "));
    Failure::usage(message)
}

/// Variants that are named, which the plain one is not.
pub(super) fn named_variants(case: &dyn Case) -> Vec<&'static str> {
    case.variants().iter().copied().filter(|variant| !variant.is_empty()).collect()
}

/// The run that the arguments ask for, what is wanted of its numbers, and what is to be said of it.
fn request<'a>(
    case: &'a dyn Case,
    variant: &str,
    args: &RunArgs,
) -> Result<(Request, Bounds<'a>, Vec<String>), Failure> {
    refuse_given_twice(args)?;
    let preset = Preset::from(args.preset);
    let scheme = if args.godunov {
        Scheme::Godunov
    } else {
        let density = args.density.map_or(preset.method().density, Into::into);
        Scheme::Particles { preset, density }
    };
    let n = args.n.unwrap_or_else(|| case.default_size());
    let mut key = RunKey::new(case.id(), scheme, n).variant(variant);
    let own = key.clone();
    let plain = scene_of(case, &key);
    let units = plain.as_ref().map_or(Units::None, AnyScene::units);
    let stop = args.stop.map(|time| time.in_units("--stop", units)).transpose()?;
    let redundant = plain.as_ref().map(|plain| overrides::redundant(plain, &args.sets));
    let redundant = redundant.unwrap_or_default();
    let (scene, mut notes) = match plain {
        Some(plain) => changed(case, &mut key, (plain, stop), args).map(|(s, n)| (Some(s), n))?,
        None => (None, Vec::new()),
    };
    if let Some(scene) = &scene {
        notes.extend(note_idle(&args.sets, &redundant, scene));
        notes.extend(note_support(&args.variant, scene));
    }
    let stop = stop.iter().map(|time| format!("--stop {time}"));
    let text = |set: &String| format!("--set {set}");
    let sets = args.sets.iter().filter(|set| !redundant.contains(set)).map(text);
    let bounds = Bounds::new(case, own, &stop.clone().chain(sets).collect::<Vec<String>>());
    let command = [command_of(&key)].into_iter().chain(stop).chain(args.sets.iter().map(text));
    let command = command.collect::<Vec<String>>().join(" ");
    Ok((Request { key, scene, threads: args.threads, command }, bounds, notes))
}

/// The plain scene of a run with what `--set` and `--stop` make of it, checked, and what is to be said of
/// it; the key follows it.
fn changed(
    case: &dyn Case,
    key: &mut RunKey,
    (plain, stop): (AnyScene, Option<f64>),
    args: &RunArgs,
) -> Result<(AnyScene, Vec<String>), Failure> {
    let mut scene = overrides::apply(plain.clone(), &args.sets).map_err(Failure::usage)?;
    if let Some(time) = stop {
        scene.set_stop_time(time);
    }
    scene.validate().map_err(|error| match plain.validate() {
        Err(error) => cannot(case, key, &error),
        Ok(()) => Failure::usage(error),
    })?;
    let (folder, resumed) = (args.out.is_some(), args.resume.is_some());
    let size = foresee(case, ("--n", key.n), &scene, Keeps { folder, resumed })?;
    if let AnyScene::Line(scene) = &scene {
        key.n = scene.particles();
    }
    // The record says what ran, whichever option chose it.
    if let (Scheme::Particles { density, .. }, true) =
        (&mut key.scheme, scene.density() != plain.density())
    {
        *density = scene.density();
    }
    let notes = size.into_iter().chain(note_changes(case, &scene, plain)).collect();
    Ok((scene, notes))
}
