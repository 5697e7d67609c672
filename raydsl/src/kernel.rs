//! Kernels with all their variants.

use core::any::TypeId;
use core::cell::Cell;
use core::sync::atomic::{AtomicU64, Ordering};

use crate::machine::{
    Count, Counted, KernelFn, KernelInfo, LaneMachine, Lanes, Leaf, Machine, Margin, Outcomes,
    Packet, Place, Recorder, Recording, Resource, Rounding, Simd4, Simd8, Simd16, Type, U, count,
    wgsl,
};
#[cfg(feature = "gpu")]
use crate::machine::{Description, Frame, Identity, Value};
use crate::run::{Levels, fibers};

pub use crate::run::{Counting, Native4, Native8, Native16, Variant, Variants};

/// The lifted body of a closure, for one machine.
pub type LiftedFn<'a, M, A, R> =
    Box<dyn Fn(&M, <A as Type>::On<M>) -> <R as Type>::On<M> + Send + Sync + 'a>;

/// The lifted body of a closure, for every machine that it is lifted for. `RAYDSL_VARIANTS` may
/// have excluded some.
#[expect(missing_docs, reason = "the members are named like their machines")]
pub struct Lifted<'a, A: Type, R: Type> {
    pub native4: Option<LiftedFn<'a, Native4, A, R>>,
    pub native8: Option<LiftedFn<'a, Native8, A, R>>,
    pub native16: Option<LiftedFn<'a, Native16, A, R>>,
    pub recorder: Option<LiftedFn<'a, Recorder, A, R>>,
    pub margin: Option<LiftedFn<'a, Margin, A, R>>,
}

type Resources<'a> = Box<dyn Fn(&mut dyn FnMut(&dyn Resource)) + Send + Sync + 'a>;

/// A kernel from `A` (a tuple of parameters) to `R`, with all its variants.
///
/// It borrows its closure's captures.
pub struct Kernel<'a, A: Type, R: Type> {
    info: &'static KernelInfo,
    scalar: Box<dyn Fn(A) -> R + Send + Sync + 'a>,
    lifted: Lifted<'a, A, R>,
    resources: Resources<'a>,
    arithmetic: wgsl::Arithmetic,
    number: u64,
    /// The type of its closure: kernels of the same code.
    #[cfg_attr(not(feature = "gpu"), expect(dead_code, reason = "only a device keeps recordings"))]
    code: TypeId,
}

/// Returns a number that no kernel had before.
fn new_number() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    NEXT.fetch_add(1, Ordering::Relaxed)
}

/// Returns what identifies a closure's code: its type, apart from lifetimes.
fn code_of<T>(_: &T) -> TypeId {
    typeid::of::<T>()
}

/// A kernel's scalar function before its lifted copies are added; the first step of `kernel!`.
#[doc(hidden)]
pub struct ScalarKernel<'a, A, R> {
    info: &'static KernelInfo,
    scalar: Box<dyn Fn(A) -> R + Send + Sync + 'a>,
}

impl<'a, A: Type, R: Type> ScalarKernel<'a, A, R> {
    /// A lifted copy, whose result is that of the function: what rustc infers there it need not
    /// infer here.
    pub fn like<M: Machine, F: Fn(&M, A::On<M>) -> R::On<M>>(&self, copy: F) -> F {
        copy
    }

    /// Adds the lifted copies. `resources` visits all that they capture: kernels with the same type
    /// of it, and the same facts, share a recording.
    pub fn lifted(
        self,
        lifted: Lifted<'a, A, R>,
        resources: impl Fn(&mut dyn FnMut(&dyn Resource)) + Send + Sync + 'a,
    ) -> Kernel<'a, A, R> {
        let code = code_of(&resources);
        let Self { info, scalar } = self;
        let (resources, arithmetic) = (Box::new(resources), wgsl::Arithmetic::Strict);
        Kernel { info, scalar, lifted, resources, arithmetic, number: new_number(), code }
    }
}

/// The lifted body for packets of one kind.
pub type PacketKernel<'k, L, A, R> =
    dyn Fn(&Packet<L>, <A as Type>::On<Packet<L>>) -> <R as Type>::On<Packet<L>> + Send + Sync + 'k;

/// A task to run with packets of one kind; see [`Kernel::with_packets`].
pub trait PacketTask<A: Type, R: Type> {
    /// Its result.
    type Output;

    /// Runs the task. `kernel` is the lifted body for packets of `lanes`.
    fn run<L: Lanes>(self, lanes: L, kernel: &PacketKernel<'_, L, A, R>) -> Self::Output;

    /// Runs the task one lane at a time, if the machine has no such lanes, or `RAYDSL_VARIANTS` has
    /// excluded the lifted bodies.
    fn scalar(self, kernel: &(dyn Fn(A) -> R + Send + Sync)) -> Self::Output;
}

impl<'a, A: Type, R: Type> Kernel<'a, A, R> {
    /// Creates a kernel from its scalar function; the first call of `kernel!`.
    #[doc(hidden)]
    pub fn scalar(
        info: &'static KernelInfo,
        scalar: impl Fn(A) -> R + Send + Sync + 'a,
    ) -> ScalarKernel<'a, A, R> {
        ScalarKernel { info, scalar: Box::new(scalar) }
    }

    /// Creates the kernel of a `#[kernel] fn`: `Kernel::of::<name>()`.
    pub fn of<F: KernelFn<Args = A, Output = R>>() -> Self {
        Self {
            info: F::info(),
            scalar: Box::new(F::scalar),
            lifted: Lifted {
                native4: Some(Box::new(F::lifted)),
                native8: Some(Box::new(F::lifted)),
                native16: Some(Box::new(F::lifted)),
                recorder: Some(Box::new(F::lifted)),
                margin: Some(Box::new(F::lifted)),
            },
            resources: Box::new(|_| {}),
            arithmetic: wgsl::Arithmetic::Strict,
            number: new_number(),
            code: typeid::of::<F>(),
        }
    }

    /// Creates the kernel of a `#[kernel] fn` with lanes that count:
    /// `Kernel::counted_of::<name>()`.
    pub fn counted_of<F: KernelFn<Args = A, Output = R>>() -> CountedKernel<'a, A, R> {
        Self::of::<F>().counted(Box::new(F::lifted))
    }

    /// Adds the copy that counts; the last call of `kernel!(counted ..)`.
    #[doc(hidden)]
    pub fn counted(self, counted: LiftedFn<'a, Counting, A, R>) -> CountedKernel<'a, A, R> {
        CountedKernel { kernel: self, counted }
    }

    /// Returns the same kernel with another arithmetic of its WGSL variant; the others are
    /// unchanged.
    ///
    /// ```
    /// use raydsl::prelude::*;
    ///
    /// let k = kernel!(|x: f32| sin(x) * 1.7);
    /// assert!(k.wgsl().contains("lit_1_7"));
    /// let fast = k.arithmetic(Arithmetic::Fast);
    /// assert!(fast.wgsl().contains("sin(x) * 1.7f"));
    /// ```
    #[must_use]
    pub fn arithmetic(self, arithmetic: wgsl::Arithmetic) -> Self {
        Self { arithmetic, number: new_number(), ..self }
    }

    /// Returns the source location and the parameter names.
    pub fn info(&self) -> &'static KernelInfo {
        self.info
    }

    /// Runs the user's own function.
    #[inline]
    pub fn call(&self, args: A) -> R {
        (self.scalar)(args)
    }

    /// Passes the lifted body for `variant`'s packets to `task`.
    ///
    /// A width whose level the machine lacks, or whose copy `RAYDSL_VARIANTS` has excluded, runs as
    /// several packets of the next narrower one, or the scalar function if there is none.
    pub fn with_packets<T: PacketTask<A, R>>(&self, variant: Variant, task: T) -> T::Output {
        let Lifted { native4, native8, native16, .. } = &self.lifted;
        let Levels { narrow, middle, wide, .. } = Levels::detect();
        let is_wide = variant == Variant::Packet16;
        let is_middle = is_wide || variant == Variant::Packet8;
        if is_wide && let (Some(level), Some(kernel)) = (wide, native16) {
            task.run(Simd16(level), &**kernel)
        } else if is_middle && let (Some(level), Some(kernel)) = (middle, native8) {
            task.run(Simd8(level), &**kernel)
        } else if let (Some(level), Some(kernel)) = (narrow, native4) {
            task.run(Simd4(level), &**kernel)
        } else {
            task.scalar(&*self.scalar)
        }
    }

    /// Runs a CPU variant over `inputs`; `outputs` has the same length.
    ///
    /// # Panics
    ///
    /// If the lengths differ, or for [`Variant::Wgsl`], which needs a device.
    pub fn run(&self, variant: Variant, inputs: &[A], outputs: &mut [R]) {
        self.run_in_gangs(variant, GANG, inputs, outputs);
    }

    /// Runs the kernel like [`Kernel::run`], in gangs of `lanes` lanes: packets that run as fibers,
    /// whose queries of [wide trees](crate::bvh::Bvh::build_wide) are answered in batches, since
    /// traversals are faster with more rays. [`Kernel::run`] uses gangs of [`GANG`]; with fewer
    /// lanes than in two packets, each packet runs by itself. The outputs are the same.
    ///
    /// Each of the at most 64 packets of a gang has a stack of its own, of 8 MiB of address space;
    /// a kernel that needs more aborts the program. There are gangs on Unix, on x86-64 and AArch64;
    /// elsewhere each packet runs by itself. A packet of a [`Gang`](crate::machine::Gang) is one
    /// packet here, however many registers it has.
    ///
    /// # Panics
    ///
    /// As for [`Kernel::run`].
    pub fn run_in_gangs(&self, variant: Variant, lanes: usize, inputs: &[A], outputs: &mut [R]) {
        assert_eq!(inputs.len(), outputs.len(), "one output for each input");
        match variant {
            Variant::Scalar => {
                for (a, r) in inputs.iter().zip(outputs) {
                    *r = self.call(*a);
                }
            }
            Variant::Wgsl => panic!("WGSL runs on a device: use raydsl::gpu"),
            packet => self.with_packets(packet, Batch { gang: lanes, inputs, outputs }),
        }
    }

    /// Returns the reference result in `f64`: every scalar of `R` in order of declaration, integers
    /// and truth values as numbers.
    ///
    /// Floats of `args` and of the scene widen exactly. Literals have the value of their decimal
    /// text, and a constant equal to one of [`core::f32::consts`] has that constant's `f64` value;
    /// other constants widen. Elementary functions are std's of `f64`. `to_bits` acts on the value
    /// rounded to `f32`, so generators of random numbers give the same ones.
    ///
    /// A loop that does not end within 260 thousand iterations in `f64` is abandoned.
    pub fn reference(&self, args: A) -> Vec<f64> {
        let outcomes = self.outcomes(args, Rounding::IEEE, 1);
        outcomes.reference().iter().copied().map(Leaf::value).collect()
    }

    /// Returns all possible results of the variants under rounding; see [`Outcomes`]. At most
    /// `limit` paths through the decisions are followed.
    pub fn outcomes(&self, args: A, rounding: Rounding, limit: usize) -> Outcomes {
        Outcomes::of(rounding, limit, |m| self.on_margin(m, A::splat(m, args)))
    }

    /// Runs the lifted body on the margin machine, for arguments computed there: see
    /// [`Outcomes::of`].
    pub fn on_margin(&self, m: &Margin, args: A::On<Margin>) -> R::On<Margin> {
        self.built(&self.lifted.margin, "reference")(m, args)
    }

    fn on_recorder(&self) -> &LiftedFn<'a, Recorder, A, R> {
        self.built(&self.lifted.recorder, "wgsl")
    }

    /// Returns a lifted copy, or panics if it was excluded.
    fn built<'c, F>(&self, copy: &'c Option<F>, name: &str) -> &'c F {
        copy.as_ref().unwrap_or_else(|| {
            let KernelInfo { name: kernel, file, line, .. } = self.info;
            panic!(
                "`{kernel}` ({file}:{line}) was compiled without the variant `{name}`: add it to the \
                 environment variable RAYDSL_VARIANTS, or unset that"
            )
        })
    }

    /// Returns the kernel as WGSL that reads its parameters from a buffer, for WebGPU's guaranteed
    /// limits.
    pub fn wgsl(&self) -> String {
        self.record().module(&wgsl::Limits::default()).source
    }

    /// Returns a number that no other kernel of the process has: it always identifies the same
    /// recording.
    pub fn number(&self) -> u64 {
        self.number
    }

    /// Returns what identifies the kernel's recording, and that of kernels like it.
    #[cfg(feature = "gpu")]
    pub(crate) fn identity<'k>(&'k self, describe: &'k dyn Fn(&mut Description)) -> Identity<'k> {
        Identity { number: self.number, code: self.code, arithmetic: self.arithmetic, describe }
    }

    /// Describes what the kernel captures.
    #[cfg(feature = "gpu")]
    pub(crate) fn describe(&self, out: &mut Description) {
        (self.resources)(&mut |resource| resource.describe(out));
    }

    /// Returns the frame around the body when it runs over a buffer of parameters.
    #[cfg(feature = "gpu")]
    pub(crate) fn frame(&self) -> Frame {
        Frame::new(Recording::batch::<A, R>(self.arithmetic, |m, _| Value::zero(m)))
    }

    /// Records the kernel over a buffer of parameters.
    pub fn record(&self) -> Recording {
        Recording::batch::<A, R>(self.arithmetic, |m, args| self.on_recorder()(m, args))
    }

    /// Records the computation for each pixel of a film: `pixel` receives its coordinates and the
    /// lifted body.
    pub fn record_grid<O: Type>(
        &self,
        pixel: impl FnOnce(
            &Recorder,
            U<Recorder>,
            U<Recorder>,
            &LiftedFn<'a, Recorder, A, R>,
        ) -> O::On<Recorder>,
    ) -> Recording {
        Recording::grid::<O>(self.arithmetic, |m, x, y| pixel(m, x, y, self.on_recorder()))
    }

    /// Visits the buffers that the recorded kernel may read.
    pub fn resources(&self, visit: &mut dyn FnMut(&dyn Resource)) {
        (self.resources)(visit);
    }
}

/// A kernel also lifted for lanes that count active lanes by place, for `utilisation` of the crate
/// `raydsl-report`: `kernel!(counted |ray: Ray| ..)`, or [`Kernel::counted_of`]. It compiles one
/// more copy.
pub struct CountedKernel<'a, A: Type, R: Type> {
    kernel: Kernel<'a, A, R>,
    counted: LiftedFn<'a, Counting, A, R>,
}

impl<'a, A: Type, R: Type> core::ops::Deref for CountedKernel<'a, A, R> {
    type Target = Kernel<'a, A, R>;

    fn deref(&self) -> &Kernel<'a, A, R> {
        &self.kernel
    }
}

impl<A: Type, R: Type> CountedKernel<'_, A, R> {
    /// The number of lanes that count.
    pub const LANES: usize = Counting::LANES;

    /// Runs packets of 8 lanes, of the target's baseline level, and counts the running lanes at
    /// each place that a packet passes, ordered by place.
    pub fn count(&self, inputs: &[A]) -> Vec<(Place, Count)> {
        let mut outputs = vec![R::read(&vec![0; R::SCHEMA.size()]); inputs.len()];
        let lanes = Counted(Simd8(Levels::detect().least));
        // One packet at a time: a fiber's counts would go to whichever packet runs.
        count(|| run_in_gangs(lanes, 0, &*self.counted, inputs, &mut outputs))
    }
}

/// The default lanes of a gang; see [`Kernel::run_in_gangs`].
pub const GANG: usize = 64;

struct Batch<'b, A, R> {
    gang: usize,
    inputs: &'b [A],
    outputs: &'b mut [R],
}

impl<A: Type, R: Type> PacketTask<A, R> for Batch<'_, A, R> {
    type Output = ();

    fn run<L: Lanes>(self, lanes: L, kernel: &PacketKernel<'_, L, A, R>) {
        run_in_gangs(lanes, self.gang, kernel, self.inputs, self.outputs);
    }

    fn scalar(self, kernel: &(dyn Fn(A) -> R + Send + Sync)) {
        for (a, r) in self.inputs.iter().zip(self.outputs) {
            *r = kernel(*a);
        }
    }
}

/// Runs `kernel` over `inputs` in packets; the last one may be partly filled. The packets of a gang
/// of `gang` lanes run as fibers, and their queries are batched.
pub(crate) fn run_in_gangs<L: Lanes, A: Type, R: Type>(
    lanes: L,
    gang: usize,
    kernel: &(impl Fn(&Packet<L>, A::On<Packet<L>>) -> R::On<Packet<L>> + ?Sized),
    inputs: &[A],
    outputs: &mut [R],
) {
    let outputs = Cell::from_mut(outputs).as_slice_of_cells();
    fibers::each(inputs.len().div_ceil(L::N), gang / L::N, &|packet| {
        lanes.vectorize(
            #[inline(always)]
            || {
                let first = packet * L::N;
                let inputs = &inputs[first..inputs.len().min(first + L::N)];
                let m = Packet::with_count(lanes, inputs.len());
                let args = A::from_lanes(
                    &m,
                    #[inline(always)]
                    |l| inputs[l.min(inputs.len() - 1)],
                );
                let result = kernel(&m, args);
                for (l, out) in outputs[first..].iter().take(inputs.len()).enumerate() {
                    out.set(R::lane(&result, l));
                }
            },
        );
    });
}

/// Runs `kernel` over `inputs` in packets; the last one may be partly filled.
pub fn run_batch<L: Lanes, A: Type, R: Type>(
    lanes: L,
    kernel: &(impl Fn(&Packet<L>, A::On<Packet<L>>) -> R::On<Packet<L>> + ?Sized),
    inputs: &[A],
    outputs: &mut [R],
) {
    run_in_gangs(lanes, GANG, kernel, inputs, outputs);
}

/// Runs the lifted body of a `#[kernel] fn` on packets of `lanes`, for tests of every level.
pub fn run_fn<F: KernelFn, L: Lanes>(lanes: L, inputs: &[F::Args], outputs: &mut [F::Output]) {
    run_batch(lanes, &|m: &Packet<L>, args| F::lifted(m, args), inputs, outputs);
}

const _: () = assert!(<Counting as LaneMachine>::LANES == 8);
