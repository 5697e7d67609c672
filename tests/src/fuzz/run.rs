//! What a program of generated kernels does: runs them through every variant.
//!
//! A batch of kernels is compiled without optimisation, and only their bodies are: everything here
//! is compiled once, with the library of the tests. So a body is lifted three times, for the scalar
//! machine, for packets whose level and width are values, and for the recorder.

use std::panic::{AssertUnwindSafe, catch_unwind};

use raydsl::kernel::{Kernel, Lifted, Variant};
use raydsl::machine::{KernelFn, Lanes, Packet, Recorder, Scalar, Type};
#[cfg(feature = "gpu")]
use raydsl::prelude::Renderer;
use raydsl::prelude::Vec3;

use super::types::{INFO, Outcome, Small, resources};
use super::watch::{Watch, is_loose};
use crate::check::each_pass;
use crate::gpu::gpu;
use crate::levels::{LevelTask, each_level};
use crate::rng::Rng;
use crate::run_time::RunTime;
use crate::values::{Numbers, compare, garbage, random};

/// The parameters of generated kernels.
pub type Args = (f32, Vec3, u32, Small);

/// Lanes of every level and of every width up to this one.
type Any = RunTime<16>;
type On<T, M> = <T as Type>::On<M>;
type LiftedTo<M> = fn(&M, On<Args, M>) -> On<Outcome, M>;

/// What is to be done with a kernel that borrows.
pub type Use<'a> = &'a mut dyn FnMut(&Kernel<'_, Args, Outcome>);

/// How many inputs a kernel is given; not a multiple of any width.
const INPUTS: usize = 77;

/// What the program prints before it runs a kernel.
pub const RUNS: &str = "runs ";
/// What it prints before the description of a failure, which ends with [`END`].
pub const FAILED: &str = "FAILED ";
/// The line behind the description of a failure.
pub const END: &str = "---";
/// What it prints before its numbers, at its end.
pub const DONE: &str = "done ";

/// A generated kernel.
#[derive(Clone, Copy)]
pub struct Case {
    name: &'static str,
    source: fn(Args) -> Outcome,
    scalar: LiftedTo<Scalar>,
    packet: LiftedTo<Packet<Any>>,
    recorder: LiftedTo<Recorder>,
    closure: Option<fn(Use<'_>)>,
}

impl Case {
    /// The kernel `F`.
    pub fn of<F: KernelFn<Args = Args, Output = Outcome>>(name: &'static str) -> Self {
        Self {
            name,
            source: F::scalar,
            scalar: F::lifted,
            packet: F::lifted,
            recorder: F::lifted,
            closure: None,
        }
    }

    /// With the same body as a closure.
    #[must_use]
    pub fn with(self, closure: fn(Use<'_>)) -> Self {
        Self { closure: Some(closure), ..self }
    }
}

/// Runs all kernels, and prints which ones fail and how.
pub fn main(cases: &[Case]) {
    std::panic::set_hook(Box::new(|_| {}));
    let levels = levels();
    let (mut compared, mut taken) = (0, 0);
    for case in cases {
        println!("{RUNS}{}", case.name);
        let result = catch_unwind(AssertUnwindSafe(|| case.check(&levels)));
        match result {
            Ok(of_wgsl) => {
                compared += of_wgsl;
                taken += usize::from(of_wgsl > 0);
            }
            Err(error) => {
                println!("{FAILED}{}\n{}\n{END}", case.name, panic_text(&*error));
            }
        }
    }
    println!("{DONE}{} {taken} {compared}", cases.len());
}

fn panic_text(error: &(dyn std::any::Any + Send)) -> String {
    let text = error.downcast_ref::<String>().cloned();
    let text = text.or_else(|| error.downcast_ref::<&str>().map(|s| (*s).to_owned()));
    text.unwrap_or_else(|| "a panic without a text".to_owned())
}

/// Runs `f`; says in whose run a panic came.
fn naming<R>(who: &str, f: impl FnOnce() -> R) -> R {
    catch_unwind(AssertUnwindSafe(f))
        .unwrap_or_else(|error| panic!("{who}: {}", panic_text(&*error)))
}

struct Level {
    name: String,
    width: usize,
    lanes: Any,
}

/// One lane, and every width of every level.
fn levels() -> Vec<Level> {
    struct Collect(Vec<Level>);
    impl LevelTask for Collect {
        fn run<L: Lanes>(&mut self, name: &str, lanes: L) {
            self.0.push(Level { name: name.to_owned(), width: L::N, lanes: Any::new(lanes) });
        }
    }
    let mut levels = Collect(vec![]);
    each_level(&mut levels);
    levels.0
}

impl Case {
    /// Panics where a variant differs; gives the number of inputs that WGSL was compared for.
    fn check(&self, levels: &[Level]) -> usize {
        let mut rng = Rng::of(self.name);
        let numbers = |i| if i % 2 == 0 { Numbers::Tame } else { Numbers::Any };
        let inputs: Vec<Args> = (0..INPUTS).map(|i| random(&mut rng, numbers(i))).collect();
        let expected: Vec<Outcome> =
            naming("the source", || inputs.iter().map(|a| (self.source)(*a)).collect());
        let lifted = |a: &Args| {
            let m = Scalar::default();
            Outcome::lane::<Scalar>(&(self.scalar)(&m, Args::splat(&m, *a)), 0)
        };
        let found: Vec<Outcome> =
            naming("the scalar machine", || inputs.iter().map(lifted).collect());
        self.assert_same("the scalar machine", &inputs, &expected, &found);
        for level in levels {
            let run = |bits: u64, input: &dyn Fn(usize) -> Args, out: &mut [Outcome]| {
                self.packet(level.lanes, level.width, bits, input, out);
            };
            naming(&level.name, || {
                each_pass(&run, level.width, &inputs, &mut |pass, found: &[Outcome]| {
                    let who = format!("{}{pass}", level.name);
                    self.assert_same(&who, &inputs, &expected, found);
                });
            });
        }
        let strict = self.strict(&inputs);
        self.closure(&inputs, &expected, &strict);
        self.wgsl(&self.recorded(), &inputs, &expected, &strict)
    }

    /// The closure's own variants.
    fn closure(&self, inputs: &[Args], expected: &[Outcome], strict: &[usize]) {
        let Some(closure) = self.closure else { return };
        closure(&mut |kernel| self.variants(kernel, inputs, expected, strict));
    }

    fn variants(
        &self,
        kernel: &Kernel<'_, Args, Outcome>,
        inputs: &[Args],
        expected: &[Outcome],
        strict: &[usize],
    ) {
        for variant in [Variant::Scalar, Variant::Packet4, Variant::Packet8, Variant::Packet16] {
            let who = format!("the closure's {}", variant.name());
            let mut found = vec![garbage(); inputs.len()];
            naming(&who, || kernel.run(variant, inputs, &mut found));
            self.assert_same(&who, inputs, expected, &found);
        }
        self.wgsl(kernel, inputs, expected, strict);
    }

    fn packet(
        &self,
        lanes: Any,
        width: usize,
        bits: u64,
        input: &dyn Fn(usize) -> Args,
        out: &mut [Outcome],
    ) {
        let m = Packet::with_bits(lanes, bits);
        let args = Args::from_lanes(&m, |l| if l < width { input(l) } else { garbage() });
        let result = (self.packet)(&m, args);
        for (l, out) in out.iter_mut().enumerate() {
            *out = Outcome::lane::<Packet<Any>>(&result, l);
        }
    }

    fn assert_same(&self, who: &str, inputs: &[Args], expected: &[Outcome], found: &[Outcome]) {
        compare(format!("{} on {who}", self.name), expected, found)
            .assert_same(|i| format!("{:?}", inputs[i]));
    }

    /// The inputs for which WGSL leaves nothing open.
    fn strict(&self, inputs: &[Args]) -> Vec<usize> {
        let watch = Any::new(Watch);
        let is_strict = |i: &usize| {
            let mut out = [garbage()];
            !is_loose(|| self.packet(watch, 1, 1, &|_| inputs[*i], &mut out))
        };
        (0..inputs.len()).filter(is_strict).collect()
    }

    /// Compares WGSL for the inputs in `strict`, and says how many these are.
    fn wgsl(
        &self,
        kernel: &Kernel<'_, Args, Outcome>,
        inputs: &[Args],
        expected: &[Outcome],
        strict: &[usize],
    ) -> usize {
        let Some(gpu) = gpu() else { return 0 };
        let mut found = vec![garbage(); inputs.len()];
        if let Err(error) = gpu.batch(kernel, inputs, &mut found) {
            panic!("{} on WGSL: {error}\n{}", self.name, kernel.wgsl());
        }
        if strict.is_empty() {
            return 0;
        }
        let expected: Vec<Outcome> = strict.iter().map(|i| expected[*i]).collect();
        let found: Vec<Outcome> = strict.iter().map(|i| found[*i]).collect();
        let result = compare(format!("{} on WGSL", self.name), &expected, &found);
        if result.count() > 0 {
            println!("{}", kernel.wgsl());
        }
        result.assert_same(|i| format!("{:?}", inputs[strict[i]]));
        strict.len()
    }

    fn recorded(&self) -> Kernel<'static, Args, Outcome> {
        Kernel::scalar(&INFO, self.source).lifted(
            Lifted {
                native4: None,
                native8: None,
                native16: None,
                recorder: Some(Box::new(self.recorder)),
                margin: None,
            },
            resources,
        )
    }
}
