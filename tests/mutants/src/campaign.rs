//! The runs: which tests reach which mutants, and which of those kill them.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use crate::build::mutants;
use crate::folder::Folder;
use crate::program::{End, Runner, in_parallel, numbers};
use crate::rooms::OF_TEXT;

/// A test without a mutant.
#[derive(Serialize, Deserialize)]
struct Test {
    program: String,
    name: String,
    passes: bool,
    seconds: f64,
    /// The mutants that it reaches.
    reached: Vec<usize>,
}

/// What became of a mutant.
#[derive(Clone, Serialize, Deserialize)]
pub(crate) struct Verdict {
    pub(crate) mutant: usize,
    pub(crate) fate: Fate,
    /// The program and tests that killed it.
    pub(crate) by: String,
    /// The number of tests that were to be run.
    pub(crate) tests: usize,
}

impl Verdict {
    pub(crate) fn is_alive(&self) -> bool {
        matches!(self.fate, Fate::Survived | Fate::Unreached)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) enum Fate {
    /// A test failed.
    Failed,
    /// A test ran much longer than without it.
    Late,
    /// A test ended without a result.
    Crashed,
    /// All tests that reach it pass.
    Survived,
    /// No test reaches it.
    Unreached,
}

const TESTS: &str = "tests.jsonl";
const VERDICTS: &str = "verdicts.jsonl";

/// A test shorter than this is run together with others of its program.
const SHORT: f64 = 0.4;

/// Tests longer than this are not used.
const LONGEST: f64 = 60.0;

/// Together these run no longer than so.
const TOGETHER: f64 = 2.0;

/// Runs every test once without a mutant, and writes down the mutants that it reaches.
pub(crate) fn reach(folder: &Folder, before: &[String], jobs: usize, only: &[String]) {
    let runner = Runner::new(folder, before);
    // Programs that are named may have changed.
    let known: BTreeSet<(String, String)> = match only {
        [] => tests(folder).into_iter().map(|t| (t.program, t.name)).collect(),
        _ => BTreeSet::new(),
    };
    let mut wanted = Vec::new();
    let is_wanted = |p: &&str| only.is_empty() || only.iter().any(|o| o == p);
    for program in runner.programs().filter(is_wanted) {
        let names = runner.tests(program).into_iter().map(|n| (program.to_owned(), n));
        let names = names.filter(|(_, n)| !OF_TEXT.iter().any(|text| n.contains(text)));
        wanted.extend(names.filter(|test| !known.contains(test)).enumerate());
    }
    in_parallel(&wanted, jobs, |(i, (program, name))| {
        let file = folder.path(&format!("reached-{program}-{i}"));
        let outcome = runner.run(program, &[name], &format!("seen:{}", file.display()), LONGEST);
        let passes = outcome.end == End::Passed;
        if !passes {
            println!("{program} {name}: {:?} without a mutant, not used", outcome.end);
        }
        let (seconds, reached) = (outcome.seconds, numbers(&file));
        // It has no file if it reaches none.
        std::fs::remove_file(&file).ok();
        let (program, name) = (program.clone(), name.clone());
        folder.append(TESTS, &Test { program, name, passes, seconds, reached });
    });
    let tests = tests(folder);
    let seconds: f64 = tests.iter().map(|t| t.seconds).sum();
    let passing = tests.iter().filter(|t| t.passes).count();
    let reached: BTreeSet<usize> = tests.iter().flat_map(|t| &t.reached).copied().collect();
    println!(
        "{} tests in {seconds:.0} s, {passing} pass; they reach {} of {} mutants",
        tests.len(),
        reached.len(),
        mutants(folder).len()
    );
}

/// Returns what was last found out of each test.
fn tests(folder: &Folder) -> Vec<Test> {
    let all = folder.lines::<Test>(TESTS).into_iter();
    let last: BTreeMap<_, _> = all.map(|t| ((t.program.clone(), t.name.clone()), t)).collect();
    last.into_values().collect()
}

/// Tests of one program that are run together.
struct Batch<'a> {
    program: &'a str,
    names: Vec<&'a str>,
    seconds: f64,
}

/// Returns the tests that reach a mutant, the quick ones first.
fn batches(tests: &[Test], mutant: usize) -> Vec<Batch<'_>> {
    let mut reaching: Vec<&Test> =
        tests.iter().filter(|t| t.passes && t.reached.contains(&mutant)).collect();
    reaching.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
    let mut done = Vec::new();
    let mut open: BTreeMap<&str, Batch<'_>> = BTreeMap::new();
    for test in reaching {
        let new = || Batch { program: &test.program, names: Vec::new(), seconds: 0.0 };
        let batch = open.entry(&test.program).or_insert_with(new);
        let is_full = batch.seconds + test.seconds > TOGETHER || test.seconds > SHORT;
        if is_full && !batch.names.is_empty() {
            done.push(core::mem::replace(batch, new()));
        }
        batch.names.push(&test.name);
        batch.seconds += test.seconds;
    }
    done.extend(open.into_values());
    done.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
    done
}

/// Which mutants to run, and how long.
pub(crate) struct Plan {
    pub(crate) wanted: Vec<usize>,
    /// Also those that survived.
    pub(crate) again: bool,
    /// The most seconds that the tests of a mutant take without it.
    pub(crate) within: f64,
    /// Only tests of these programs; of all if there are none.
    pub(crate) programs: Vec<String>,
}

/// Runs the tests on each of these mutants that has no verdict yet.
pub(crate) fn run(folder: &Folder, before: &[String], jobs: usize, plan: &Plan) {
    let Plan { wanted, again, within, programs } = plan;
    let runner = Runner::new(folder, before);
    let mut tests = tests(folder);
    tests.retain(|t| programs.is_empty() || programs.contains(&t.program));
    let verdicts = verdicts(folder);
    let is_open = |i: &usize| match verdicts.get(i) {
        None => true,
        Some(v) => *again && v.is_alive(),
    };
    let all = mutants(folder);
    let open: Vec<usize> =
        wanted.iter().copied().filter(|i| *i < all.len()).filter(is_open).collect();
    in_parallel(&open, jobs, |&mutant| {
        let verdict = judge(&runner, &tests, mutant, *within);
        let site = &all[mutant].site;
        let what = format!("{}:{} {}", site.file, site.line, site.change);
        println!("{mutant:3} {what}: {:?} {}", verdict.fate, verdict.by);
        // One that survives some tests more is as it was.
        if programs.is_empty() || !verdict.is_alive() {
            folder.append(VERDICTS, &verdict);
        }
    });
}

/// Runs the tests that reach a mutant until one fails.
fn judge(runner: &Runner, tests: &[Test], mutant: usize, within: f64) -> Verdict {
    let mut batches = batches(tests, mutant);
    let mut seconds = 0.0;
    batches.retain(|b| {
        seconds += b.seconds;
        seconds <= within
    });
    let count = batches.iter().map(|b| b.names.len()).sum();
    let none = if count == 0 { Fate::Unreached } else { Fate::Survived };
    for batch in &batches {
        let limit = 15.0 + 10.0 * batch.seconds;
        let outcome = runner.run(batch.program, &batch.names, &mutant.to_string(), limit);
        let fate = match outcome.end {
            End::Passed => continue,
            End::Failed => Fate::Failed,
            End::Late => Fate::Late,
            End::Crashed => Fate::Crashed,
        };
        let by = format!("{} {}", batch.program, outcome.failed.join(" "));
        return Verdict { mutant, fate, by, tests: count };
    }
    Verdict { mutant, fate: none, by: String::new(), tests: count }
}

/// Returns the last verdict of each mutant.
pub(crate) fn verdicts(folder: &Folder) -> BTreeMap<usize, Verdict> {
    folder.lines::<Verdict>(VERDICTS).into_iter().map(|v| (v.mutant, v)).collect()
}
