//! Every instruction set that this machine has, in every width.

use fearless_simd::{Fallback, Level, Simd};
use raydsl::machine::{Gang, Lanes, One, Simd4, Simd8, Simd16};

use crate::run_time::{Numbered, RunTime};

/// Something to do with packets of every kind.
pub trait LevelTask {
    /// Does it; `name` is for messages.
    fn run<L: Lanes>(&mut self, name: &str, lanes: L);
}

/// Does `task` with one lane, and with 4, 8 and 16 lanes of every level of this machine, whose
/// operations are calls.
pub fn each_level(task: &mut impl LevelTask) {
    task.run("one lane", One);
    for (name, lanes) in at_run_time() {
        match lanes {
            AtRunTime::Four(lanes) => task.run(&name, lanes),
            AtRunTime::Eight(lanes) => task.run(&name, lanes),
            AtRunTime::Sixteen(lanes) => task.run(&name, lanes),
        }
    }
}

/// Lanes of their width, whose operations are calls.
enum AtRunTime {
    Four(RunTime<4>),
    Eight(RunTime<8>),
    Sixteen(RunTime<16>),
}

/// Returns the lanes of every level of this machine. It is independent of tasks, so that tables of
/// operations are compiled once, not for every test.
fn at_run_time() -> Vec<(String, AtRunTime)> {
    struct All(Vec<(String, AtRunTime)>);
    impl Widths for All {
        fn run<L: Lanes>(&mut self, lanes: L) {
            // Known when code is made, so that each table is there once.
            let kind = if const { L::N == 4 } {
                AtRunTime::Four(RunTime::new(lanes))
            } else if const { L::N == 8 } {
                AtRunTime::Eight(RunTime::new(lanes))
            } else {
                AtRunTime::Sixteen(RunTime::new(lanes))
            };
            self.0.push((format!("{} x{}", lanes.isa(), L::N), kind));
        }
    }
    let mut all = All(Vec::new());
    widths(&mut all, Fallback::new());
    native(&mut all, Level::new());
    all.0
}

/// Runs `task` with 4, 8 and 16 lanes of every level of this machine, in lanes of one kind of width
/// 16, whose lanes beyond the width are empty: a kernel is compiled once for all.
pub fn each_level_padded(task: &mut dyn FnMut(&str, RunTime<16>, usize)) {
    struct Padded<'a>(&'a mut dyn FnMut(&str, RunTime<16>, usize));
    impl Widths for Padded<'_> {
        fn run<L: Lanes>(&mut self, lanes: L) {
            self.0(&format!("{} x{}", lanes.isa(), L::N), RunTime::new(lanes), L::N);
        }
    }
    let task = &mut Padded(task);
    widths(task, Fallback::new());
    native(task, Level::new());
}

/// Something to do with one width of one level.
trait Widths {
    fn run<L: Lanes>(&mut self, lanes: L);
}

/// Does `task` with the widest packets that this machine has registers for, as production has
/// them: every operation inlined.
pub fn widest_level(task: &mut impl LevelTask) {
    struct Inlined<'a, T>(&'a mut T);
    impl<T: LevelTask> LevelTask for Inlined<'_, T> {
        fn run<L: Lanes>(&mut self, name: &str, lanes: L) {
            self.0.run(&format!("{name}, inlined"), lanes);
        }
    }
    widest(&mut Inlined(task), Level::new());
}

/// Does something with the widths for which closures are lifted, each on its level: in one kind of
/// 16 lanes for all, of which the upper ones may hold nothing, and whose operations are calls.
pub fn natural_levels(task: &mut dyn FnMut(&str, Numbered)) {
    natural(task, Level::new());
}

fn padded<L: Lanes>(task: &mut dyn FnMut(&str, Numbered), lanes: L) {
    task(&format!("{} x{}", lanes.isa(), L::N), Numbered::new(lanes));
}

#[cfg(target_arch = "x86_64")]
fn natural(task: &mut dyn FnMut(&str, Numbered), level: Level) {
    if let Some(s) = level.as_sse2() {
        padded(task, Simd8(s));
    }
    if let Some(s) = level.as_sse4_2() {
        padded(task, Simd4(s));
    }
    if let Some(s) = level.as_avx2() {
        padded(task, Simd8(s));
        padded(task, Simd16(s));
    }
    if let Some(s) = level.as_avx512() {
        padded(task, Simd16(s));
    }
}

#[cfg(target_arch = "aarch64")]
fn natural(task: &mut dyn FnMut(&str, Numbered), level: Level) {
    if let Some(s) = level.as_neon() {
        padded(task, Simd4(s));
        padded(task, Simd8(s));
        padded(task, Simd16(s));
    }
}

#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
fn natural(task: &mut dyn FnMut(&str, Numbered), level: Level) {
    if let Some(s) = level.as_wasm_simd128() {
        padded(task, Simd4(s));
        padded(task, Simd8(s));
        padded(task, Simd16(s));
    }
}

#[cfg(not(any(
    target_arch = "x86_64",
    target_arch = "aarch64",
    all(target_arch = "wasm32", target_feature = "simd128")
)))]
fn natural(task: &mut dyn FnMut(&str, Numbered), _: Level) {
    padded(task, Simd8(Fallback::new()));
}

/// One of the two is compiled: `build.rs` knows the machine.
#[cfg(target_arch = "x86_64")]
fn widest(task: &mut impl LevelTask, level: Level) {
    #[cfg(has_avx512)]
    match level.as_avx512() {
        Some(s) => one_width(task, Simd16(s)),
        None => println!("SKIPPED: the tests were built for a machine with AVX-512"),
    }
    #[cfg(not(has_avx512))]
    match level.as_avx2() {
        Some(_) if level.as_avx512().is_some() => {
            println!("SKIPPED: the tests were built for a machine without AVX-512");
        }
        Some(s) => one_width(task, Simd8(s)),
        None => {
            println!("SKIPPED: this machine has no AVX2, and nothing inlined is compiled for less")
        }
    }
}

#[cfg(target_arch = "aarch64")]
fn widest(task: &mut impl LevelTask, level: Level) {
    if let Some(s) = level.as_neon() {
        one_width(task, Simd8(s));
    }
}

#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
fn widest(task: &mut impl LevelTask, level: Level) {
    if let Some(s) = level.as_wasm_simd128() {
        one_width(task, Simd8(s));
    }
}

#[cfg(not(any(
    target_arch = "x86_64",
    target_arch = "aarch64",
    all(target_arch = "wasm32", target_feature = "simd128")
)))]
fn widest(task: &mut impl LevelTask, _: Level) {
    one_width(task, Simd8(Fallback::new()));
}

/// Several registers a value, at the widest level of this machine: 32 and 64 lanes.
///
/// Both are of one type, so that a kernel is compiled once for them.
pub fn gangs() -> Vec<AnyGang> {
    struct Gangs(Vec<AnyGang>);
    impl LevelTask for Gangs {
        fn run<L: Lanes>(&mut self, name: &str, lanes: L) {
            let gang = |width, lanes| {
                let name = format!("{name} in a gang of {width}");
                AnyGang { name, width, lanes }
            };
            self.0.push(gang(32, RunTime::new(Gang::<L, 2>(lanes))));
            self.0.push(gang(64, RunTime::new(Gang::<Gang<L, 2>, 2>(Gang(lanes)))));
        }
    }
    let mut all = Gangs(Vec::new());
    widest_of_16(&mut all, Level::new());
    all.0
}

/// Sixteen lanes of the widest level, which may hold them in several registers itself.
#[cfg(target_arch = "x86_64")]
fn widest_of_16(task: &mut impl LevelTask, level: Level) {
    if let Some(s) = level.as_avx512() {
        one_width(task, Simd16(s));
    } else if let Some(s) = level.as_avx2() {
        one_width(task, Simd16(s));
    } else if let Some(s) = level.as_sse2() {
        one_width(task, Simd16(s));
    }
}

#[cfg(target_arch = "aarch64")]
fn widest_of_16(task: &mut impl LevelTask, level: Level) {
    if let Some(s) = level.as_neon() {
        one_width(task, Simd16(s));
    }
}

#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
fn widest_of_16(task: &mut impl LevelTask, level: Level) {
    if let Some(s) = level.as_wasm_simd128() {
        one_width(task, Simd16(s));
    }
}

#[cfg(not(any(
    target_arch = "x86_64",
    target_arch = "aarch64",
    all(target_arch = "wasm32", target_feature = "simd128")
)))]
fn widest_of_16(task: &mut impl LevelTask, _: Level) {
    one_width(task, Simd16(Fallback::new()));
}

/// A gang of up to 64 lanes.
pub struct AnyGang {
    /// For messages.
    pub name: String,
    /// How many lanes there are; those above hold nothing.
    pub width: usize,
    /// The operations.
    pub lanes: RunTime<64>,
}

#[cfg(target_arch = "x86_64")]
fn native(task: &mut impl Widths, level: Level) {
    match level.as_sse2() {
        Some(s) => widths(task, s),
        None => unreachable!("SSE2 is a part of x86-64"),
    }
    match level.as_sse4_2() {
        Some(s) => widths(task, s),
        None => println!("SKIPPED: this machine has no SSE4.2"),
    }
    match level.as_avx2() {
        Some(s) => widths(task, s),
        None => println!("SKIPPED: this machine has no AVX2"),
    }
    match level.as_avx512() {
        Some(s) => widths(task, s),
        None => println!("SKIPPED: this machine has no AVX-512"),
    }
}

#[cfg(target_arch = "aarch64")]
fn native(task: &mut impl Widths, level: Level) {
    match level.as_neon() {
        Some(s) => widths(task, s),
        None => println!("SKIPPED: this machine has no NEON"),
    }
}

#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
fn native(task: &mut impl Widths, level: Level) {
    match level.as_wasm_simd128() {
        Some(s) => widths(task, s),
        None => println!("SKIPPED: the module is not compiled for simd128"),
    }
}

#[cfg(not(any(
    target_arch = "x86_64",
    target_arch = "aarch64",
    all(target_arch = "wasm32", target_feature = "simd128")
)))]
fn native(_: &mut impl Widths, _: Level) {
    println!("SKIPPED: no levels are known for this target");
}

fn widths<S: Simd>(task: &mut impl Widths, s: S) {
    task.run(Simd4(s));
    task.run(Simd8(s));
    task.run(Simd16(s));
}

fn one_width<L: Lanes>(task: &mut impl LevelTask, lanes: L) {
    task.run(&format!("{} x{}", lanes.isa(), L::N), lanes);
}

/// The names of all levels, to show that none was left out.
pub fn level_names() -> Vec<String> {
    struct Names(Vec<String>);
    impl LevelTask for Names {
        fn run<L: Lanes>(&mut self, name: &str, _: L) {
            self.0.push(name.to_owned());
        }
    }
    let mut names = Names(Vec::new());
    each_level(&mut names);
    names.0
}
