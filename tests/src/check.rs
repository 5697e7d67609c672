//! One kernel through every variant.

use std::fmt::Debug;

use raydsl::kernel::{Kernel, Lifted, Variant};
use raydsl::machine::{KernelFn, KernelInfo, Lanes, One, Packet, Rounding, Scalar, Type};
#[cfg(feature = "gpu")]
use raydsl::prelude::Renderer;
use raydsl::testing::{Cause, explain};

use crate::gpu::{gpu, keeps_denormals};
use crate::levels::{LevelTask, each_level_padded, gangs, widest_level};
use crate::rng::Rng;
use crate::scaled;
use crate::values::{Numbers, compare, compare_within, garbage, random};

/// How many inputs a kernel is given, at full scale.
const INPUTS: usize = 1003;

/// Whether WGSL must give the CPU's bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wgsl {
    /// The same bits.
    Same,
    /// The same bits for inputs whose every number is finite.
    SameIfFinite,
    /// Floats within this many ulp, for inputs whose every number is finite.
    Ulps(u32),
    /// What rounding as WGSL allows it explains, for inputs whose every number is finite: a device
    /// may reorder sums and products, and fuse or not fuse.
    Explained,
}

/// Runs a kernel through every variant and compares with its untouched source.
///
/// # Panics
///
/// If any result of any variant differs.
pub fn check<F: KernelFn>(name: &str, numbers: Numbers, wgsl: Wgsl)
where
    F::Args: Debug + Sync,
    F::Output: Sync,
{
    let mut rng = Rng::of(name);
    // Not a multiple of any width, so that the last packet is partly filled.
    let count = scaled(INPUTS) | 1;
    let inputs: Vec<F::Args> = (0..count).map(|_| random(&mut rng, numbers)).collect();
    let expected: Vec<F::Output> = inputs.iter().map(|a| F::scalar(*a)).collect();
    let case = Case::<F> { name, inputs, expected };
    case.scalar_machine();
    case.packets("one lane", One, 1);
    each_level_padded(&mut |name, lanes, width| case.packets(name, lanes, width));
    widest_level(&mut &case);
    for gang in gangs() {
        case.packets(&gang.name, gang.lanes, gang.width);
    }
    wgsl_agrees(name, &recorded::<F>(), &case.inputs, &case.expected, wgsl);
}

/// Runs a kernel in WGSL, if there is a device, and compares with what is `expected` of its source.
///
/// # Panics
///
/// If any result differs by more than `wgsl` allows.
pub fn wgsl_agrees<A: Type + Debug + Sync, R: Type>(
    name: &str,
    kernel: &Kernel<'_, A, R>,
    inputs: &[A],
    expected: &[R],
    wgsl: Wgsl,
) {
    let Some(gpu) = gpu() else { return };
    let is_taken: Vec<bool> = inputs.iter().map(|a| wgsl == Wgsl::Same || is_finite(a)).collect();
    let (inputs, expected) = (taken(inputs, &is_taken), taken(expected, &is_taken));
    let mut found = vec![garbage(); inputs.len()];
    if let Err(error) = gpu.batch(kernel, &inputs, &mut found) {
        panic!("{name} in WGSL: {error}\n{}", kernel.wgsl());
    }
    let ulps = match wgsl {
        Wgsl::Same | Wgsl::SameIfFinite => 0,
        Wgsl::Ulps(ulps) => ulps,
        Wgsl::Explained => return assert_explained(name, kernel, &inputs, &found),
    };
    let result =
        compare_within(format!("{name} in WGSL"), ulps, keeps_denormals(gpu), &expected, &found);
    if result.count() > 0 {
        println!("{}", kernel.wgsl());
    }
    result.assert_same(|i| format!("{:?}", inputs[i]));
}

fn assert_explained<A: Type + Debug + Sync, R: Type>(
    name: &str,
    kernel: &Kernel<'_, A, R>,
    inputs: &[A],
    found: &[R],
) {
    assert!(!inputs.is_empty(), "{name} in WGSL: nothing was compared");
    let why = explain(kernel, inputs, found, Rounding::WGSL);
    let is_open = |cause| matches!(cause, Cause::Unexplained | Cause::Undecided);
    if let Some((i, cause)) = why.causes.iter().find(|(_, cause)| is_open(*cause)) {
        println!("{}\n{name} in WGSL: {cause:?}", kernel.wgsl());
        compare(format!("{name} in WGSL"), &[kernel.call(inputs[*i])], &found[*i..=*i])
            .assert_same(|_| format!("{:?}", inputs[*i]));
    }
    // Where much is open, other paths mean little. Inputs at the ends of the range of `f32` have no
    // bound, but then no difference of theirs is explained either.
    let (decided, sample) = (why.count(Cause::Decision), why.sample);
    assert!(decided == 0 || sample.is_meaningful(), "{name} in WGSL: {decided} of {sample:?}");
    assert!(sample.median_width_ulp < 1000.0, "{name} in WGSL: {sample:?}");
}

fn taken<T: Copy>(all: &[T], is_taken: &[bool]) -> Vec<T> {
    all.iter().zip(is_taken).filter(|(_, is_taken)| **is_taken).map(|(v, _)| *v).collect()
}

fn is_finite<T: Type>(v: &T) -> bool {
    crate::values::floats(v).into_iter().all(f32::is_finite)
}

struct Case<'a, F: KernelFn> {
    name: &'a str,
    inputs: Vec<F::Args>,
    expected: Vec<F::Output>,
}

type PacketKernel<F, L> = dyn Fn(
    &Packet<L>,
    <<F as KernelFn>::Args as Type>::On<Packet<L>>,
) -> <<F as KernelFn>::Output as Type>::On<Packet<L>>;

impl<F: KernelFn> Case<'_, F>
where
    F::Args: Debug,
{
    fn assert_same(&self, how: &str, found: &[F::Output]) {
        let who = format!("{} on {how}", self.name);
        compare(who, &self.expected, found).assert_same(|i| format!("{:?}", self.inputs[i]));
    }

    /// The lifted body with plain numbers.
    fn scalar_machine(&self) {
        let run = |a: &F::Args| {
            let m = Scalar::default();
            F::Output::lane::<Scalar>(&F::lifted(&m, F::Args::splat(&m, *a)), 0)
        };
        let found: Vec<F::Output> = self.inputs.iter().map(run).collect();
        self.assert_same("the scalar machine", &found);
    }

    fn packets<L: Lanes>(&self, name: &str, lanes: L, width: usize) {
        let kernel: &PacketKernel<F, L> = &|m, args| F::lifted(m, args);
        let run = |bits: u64, input: &dyn Fn(usize) -> F::Args, out: &mut [F::Output]| {
            run_packet::<F, L>(lanes, kernel, bits, input, out);
        };
        each_pass(&run, width, &self.inputs, &mut |how, found: &[F::Output]| {
            self.assert_same(&format!("{name}{how}"), found);
        });
    }
}

impl<F: KernelFn> LevelTask for &Case<'_, F>
where
    F::Args: Debug,
{
    fn run<L: Lanes>(&mut self, name: &str, lanes: L) {
        self.packets(name, lanes, L::N);
    }
}

/// Runs the lanes in `bits` of one packet; `out` is given the results of all.
///
/// One function and a `dyn` kernel, so that a kernel is compiled once a level, not once a check.
#[inline(never)]
fn run_packet<F: KernelFn, L: Lanes>(
    lanes: L,
    kernel: &PacketKernel<F, L>,
    bits: u64,
    input: &dyn Fn(usize) -> F::Args,
    out: &mut [F::Output],
) {
    let m = Packet::with_bits(lanes, bits);
    lanes.vectorize(|| {
        let args = F::Args::from_lanes(&m, input);
        let result = kernel(&m, args);
        for (l, out) in out.iter_mut().enumerate() {
            *out = F::Output::lane::<Packet<L>>(&result, l);
        }
    });
}

pub(crate) type Run<'a, A, R> = &'a dyn Fn(u64, &dyn Fn(usize) -> A, &mut [R]);

/// Runs all inputs through packets of `n` lanes, in each of the ways in which lanes may meet.
pub(crate) fn each_pass<A: Type, R: Type>(
    run: Run<'_, A, R>,
    n: usize,
    inputs: &[A],
    result: &mut dyn FnMut(&str, &[R]),
) {
    result("", &all_lanes(run, n, inputs));
    result(", shuffled", &shuffled(run, n, inputs));
    result(", one lane at a time", &one_lane_at_a_time(run, n, inputs));
    result(", garbage in dead lanes", &garbage_in_dead_lanes(run, n, inputs));
}

fn all_lanes<A: Type, R: Type>(run: Run<'_, A, R>, n: usize, inputs: &[A]) -> Vec<R> {
    let mut found = vec![garbage(); inputs.len()];
    for (inputs, out) in inputs.chunks(n).zip(found.chunks_mut(n)) {
        let bits = u64::MAX >> (64 - inputs.len());
        run(bits, &|l| inputs[l.min(inputs.len() - 1)], out);
    }
    found
}

/// Results move with the lanes.
fn shuffled<A: Type, R: Type>(run: Run<'_, A, R>, n: usize, inputs: &[A]) -> Vec<R> {
    let order = Rng::new(n as u64).permutation(inputs.len());
    let moved: Vec<A> = order.iter().map(|i| inputs[*i]).collect();
    let results = all_lanes(run, n, &moved);
    let mut found = vec![garbage(); inputs.len()];
    for (i, v) in order.into_iter().zip(results) {
        found[i] = v;
    }
    found
}

/// The other lanes have their inputs, but do not run.
fn one_lane_at_a_time<A: Type, R: Type>(run: Run<'_, A, R>, n: usize, inputs: &[A]) -> Vec<R> {
    let mut out = vec![garbage(); n];
    let one = |i: usize| {
        let (first, lane) = (i - i % n, i % n);
        run(1 << lane, &|l| inputs[(first + l) % inputs.len()], &mut out);
        out[lane]
    };
    (0..inputs.len()).map(one).collect()
}

/// Every second lane holds NaN and integers that overflow, and does not run.
fn garbage_in_dead_lanes<A: Type, R: Type>(run: Run<'_, A, R>, n: usize, inputs: &[A]) -> Vec<R> {
    let mut out = vec![garbage(); n];
    let one = |i: usize| {
        let lane = i % n;
        let alive = |l: usize| l % 2 == lane % 2;
        let bits = (0..n).fold(0, |bits, l| bits | u64::from(alive(l)) << l);
        let input = |l: usize| {
            if alive(l) { inputs[(i + l + inputs.len() - lane) % inputs.len()] } else { garbage() }
        };
        run(bits, &input, &mut out);
        out[lane]
    };
    (0..inputs.len()).map(one).collect()
}

/// A closure's kernel through its natural variants, against its untouched source.
///
/// # Panics
///
/// If any result of any variant differs.
pub fn every_variant<A: Type + Debug, R: Type>(kernel: &Kernel<'_, A, R>, inputs: &[A]) {
    let expected: Vec<R> = inputs.iter().map(|a| kernel.call(*a)).collect();
    let same = |who: &str, found: &[R]| {
        compare(who, &expected, found).assert_same(|i| format!("{:?}", inputs[i]));
    };
    let mut found = expected.clone();
    for variant in [Variant::Packet4, Variant::Packet8, Variant::Packet16] {
        found.fill(garbage());
        kernel.run(variant, inputs, &mut found);
        same(variant.name(), &found);
    }
    let Some(gpu) = gpu() else { return };
    found.fill(garbage());
    if let Err(e) = gpu.batch(kernel, inputs, &mut found) {
        panic!("{e}\n{}", kernel.wgsl());
    }
    same("WGSL", &found);
}

/// Inputs for [`every_variant`].
pub fn inputs<A: Type>(seed: u64) -> Vec<A> {
    let mut rng = Rng::new(seed);
    (0..501).map(|_| random(&mut rng, Numbers::Tame)).collect()
}

/// The kernel of `F` with its recorder only: the packets of `Kernel::of` would double the time
/// that the tests take to compile, and are the same functions.
pub fn recorded<F: KernelFn>() -> Kernel<'static, F::Args, F::Output> {
    static INFO: KernelInfo =
        KernelInfo { name: "function", file: file!(), line: line!(), params: &[], known: None };
    Kernel::scalar(&INFO, F::scalar).lifted(
        Lifted {
            native4: None,
            native8: None,
            native16: None,
            recorder: Some(Box::new(F::lifted)),
            margin: Some(Box::new(F::lifted)),
        },
        |_| {},
    )
}
