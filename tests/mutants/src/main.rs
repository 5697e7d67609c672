//! Mutation tests of the library's core.
//!
//! A mutant is one changed expression: a comparison, a sign, a number off by one. Tests that do not fail
//! with it have a hole, or the change makes no difference. Compiling each mutant by itself would take
//! days; so all are compiled into one copy of the workspace, and the environment chooses the active one.
//! (Untch, Offutt and Harrold, "Mutation Analysis Using Mutant Schemata", 1993.)

mod build;
mod campaign;
mod copy;
mod draw;
mod folder;
mod program;
mod rooms;
mod site;
mod table;

use std::path::{Path, PathBuf};

use clap::{Parser, Subcommand};

use campaign::Plan;
use folder::Folder;

#[derive(Parser)]
#[command(about = "Mutation tests of geometry, trees, volumes, shading and masks")]
struct Options {
    /// The folder of the copy and of what is found out; target/mutants without it.
    #[arg(long, global = true)]
    folder: Option<PathBuf>,
    /// The seed of the draw.
    #[arg(long, global = true, default_value_t = 20_261_127)]
    seed: u64,
    /// The number of mutants.
    #[arg(long, global = true, default_value_t = 300)]
    count: usize,
    /// The number of tests at a time.
    #[arg(long, global = true, default_value_t = 1)]
    jobs: usize,
    /// Words before each test program, such as `nice`.
    #[arg(long, global = true, value_delimiter = ' ')]
    before: Vec<String>,
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Prints how many mutants there are, and those drawn.
    List,
    /// Writes the copy and builds it.
    Build,
    /// Runs all tests without a mutant, and writes down which mutants each reaches.
    Reach {
        /// Only those of these programs, also if they were run before; `raydsl` is the library's
        /// unit tests.
        programs: Vec<String>,
    },
    /// Runs the tests on each mutant; goes on where an earlier run ended.
    Run {
        /// Only these mutants; the first few are a fair sample.
        #[arg(default_value = "0..300")]
        mutants: String,
        /// Also those that survived.
        #[arg(long)]
        again: bool,
        /// The most seconds that the tests of a mutant take without it, the quick ones first.
        #[arg(long, default_value_t = f64::INFINITY)]
        within: f64,
        /// Only tests of these programs, such as those that were changed.
        #[arg(long, value_delimiter = ',')]
        programs: Vec<String>,
    },
    /// Prints the tables.
    Table,
}

fn main() {
    let options = Options::parse();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).expect("the workspace");
    let folder = Folder::new(&options.folder.unwrap_or_else(|| root.join("target/mutants")));
    match options.task {
        Task::List => list(root, &folder, options.seed, options.count),
        Task::Build => build::build(root, &folder, options.seed, options.count),
        Task::Reach { programs } => {
            campaign::reach(&folder, &options.before, options.jobs, &programs);
        }
        Task::Run { mutants, again, within, programs } => {
            let plan = Plan { wanted: wanted(&mutants), again, within, programs };
            campaign::run(&folder, &options.before, options.jobs, &plan);
        }
        Task::Table => table::print(&folder),
    }
}

/// Returns the numbers of `3`, `0..60` or `1,5,9`.
fn wanted(text: &str) -> Vec<usize> {
    let number = |t: &str| t.parse::<usize>().unwrap_or_else(|e| panic!("{t:?} is no mutant: {e}"));
    match text.split_once("..") {
        Some((from, to)) => (number(from)..number(to)).collect(),
        None => text.split(',').map(number).collect(),
    }
}

fn list(root: &Path, folder: &Folder, seed: u64, count: usize) {
    let source = root.join("raydsl/src");
    for (room, sites) in draw::all(&source) {
        println!("{}: {} mutants", room.name, sites.len());
    }
    let refused = folder.read("refused.json").unwrap_or_default();
    println!("seed {seed}:");
    for (i, mutant) in draw::draw(&source, seed, count, &refused).iter().enumerate() {
        let site = &mutant.site;
        println!("{i:3} {:8} {}:{} {}", mutant.room, site.file, site.line, site.change);
    }
}
