//! Every variant of small kernels agrees with the untouched source, bit for bit; and their WGSL is
//! what it was.

#[cfg(feature = "gpu")]
mod golden;

use raydsl_tests::check::{Wgsl, check};
use raydsl_tests::kernels;
use raydsl_tests::values::Numbers;

macro_rules! tests {
    ($($kernel:ident: $numbers:ident $wgsl:ident;)+) => {
        $(
            #[test]
            fn $kernel() {
                check::<kernels::$kernel>(stringify!($kernel), Numbers::$numbers, Wgsl::$wgsl);
            }
        )+
    };
}

raydsl_tests::kernel_table!(tests);

/// The levels of this machine, for the log: which ones the tests above ran on.
#[test]
fn levels_are_named() {
    let names = raydsl_tests::levels::level_names();
    println!("levels: {names:?}");
    assert!(names.len() >= 4, "one lane and three portable widths are everywhere");
}

/// Gangs with every operation inlined, as a program would have them.
#[test]
fn inlined_gangs() {
    use raydsl::kernel::run_fn;
    use raydsl::machine::{Gang, Lanes};
    use raydsl_tests::levels::{LevelTask, widest_level};

    type Inputs = Vec<(f32, u32)>;
    struct Gangs(Inputs, Vec<f32>);
    impl LevelTask for Gangs {
        fn run<L: Lanes>(&mut self, name: &str, lanes: L) {
            self.gang(name, Gang::<L, 2>(lanes));
            self.gang(name, Gang::<L, 4>(lanes));
        }
    }
    impl Gangs {
        fn gang<L: Lanes>(&self, name: &str, lanes: L) {
            let mut found = vec![f32::NAN; self.0.len()];
            run_fn::<kernels::labelled, _>(lanes, &self.0, &mut found);
            assert_eq!(found, self.1, "{} lanes of {name}", L::N);
        }
    }
    let inputs: Inputs = (0..999).map(|i| (i as f32 * 0.11, i % 19)).collect();
    let expected = inputs.iter().map(|(x, n)| kernels::labelled(*x, *n)).collect();
    widest_level(&mut Gangs(inputs, expected));
}

/// `run_fn` and `Kernel::of` are the public ways to the same results.
#[test]
fn public_entry_points() {
    use raydsl::kernel::{Kernel, Variant, run_fn};
    let inputs: Vec<(f32, u32)> = (0..999).map(|i| (i as f32 * 0.11, i % 19)).collect();
    let expected: Vec<f32> = inputs.iter().map(|(x, n)| kernels::labelled(*x, *n)).collect();
    let mut found = vec![0.0; inputs.len()];
    run_fn::<kernels::labelled, _>(raydsl::machine::One, &inputs, &mut found);
    assert_eq!(found, expected);
    let kernel = Kernel::of::<kernels::labelled>();
    for variant in [Variant::Scalar, Variant::Packet4, Variant::Packet8, Variant::Packet16] {
        found.fill(f32::NAN);
        kernel.run(variant, &inputs, &mut found);
        assert_eq!(found, expected, "{variant:?}");
    }
}

/// Conditions of the host: the arm not taken leaves no trace, in any variant.
mod host {
    use raydsl::prelude::*;
    use raydsl_tests::gpu::gpu;
    use raydsl_tests::rng::Rng;
    use raydsl_tests::values::{Numbers, compare, random};

    fn every_variant(kernel: &Kernel<'_, (f32, u32), f32>) {
        let mut rng = Rng::new(5);
        let inputs: Vec<(f32, u32)> = (0..500).map(|_| random(&mut rng, Numbers::Tame)).collect();
        let mut expected = vec![0.0; inputs.len()];
        kernel.run(Variant::Scalar, &inputs, &mut expected);
        let same = |who: &str, found: &[f32]| {
            compare(who, &expected, found).assert_same(|i| format!("{:?}", inputs[i]));
        };
        for variant in [Variant::Packet4, Variant::Packet8, Variant::Packet16] {
            let mut found = vec![0.0; inputs.len()];
            kernel.run(variant, &inputs, &mut found);
            same(variant.name(), &found);
        }
        let Some(gpu) = gpu() else { return };
        let mut found = vec![0.0; inputs.len()];
        if let Err(e) = gpu.batch(kernel, &inputs, &mut found) {
            panic!("{e}\n{}", kernel.wgsl());
        }
        same("WGSL", &found);
    }

    /// WGSL refuses a literal 0 as a divisor, even where no ray comes.
    #[test]
    fn zero_as_a_divisor() {
        let (none, nothing) = (0u32, 0i32);
        every_variant(&kernel!(|x: f32, n: u32| {
            if n < 100_000 {
                return x;
            }
            (n / host(none) + n % host(none)) as f32 + (n as i32 / host(nothing)) as f32
        }));
    }

    #[test]
    fn conditions_prune() {
        for (soft, fast) in [(false, false), (false, true), (true, false), (true, true)] {
            let scale = 1.5;
            let kernel = kernel!(|x: f32, n: u32| {
                if fast {
                    return x * scale;
                }
                let mut sum = 0.0;
                for i in 0..n {
                    if soft && x > 3.0 {
                        sum += 123.0;
                        continue;
                    }
                    if !soft {
                        sum += 0.5;
                    } else {
                        sum -= i as f32;
                    }
                }
                if soft || fast { sum } else { -sum }
            });
            every_variant(&kernel);
            let wgsl = kernel.wgsl();
            assert_eq!(wgsl.contains("params.scale"), fast, "{wgsl}");
            assert_eq!(wgsl.contains("lit_123_0"), soft && !fast, "{wgsl}");
        }
    }

    #[test]
    fn loops_with_host_conditions() {
        for stop in [false, true] {
            let kernel = kernel!(|x: f32, n: u32| {
                let mut y = x;
                for i in 0..n {
                    y += 1.0;
                    if stop {
                        break;
                    }
                    if y > 12.0 {
                        return y * i as f32;
                    }
                }
                y
            });
            every_variant(&kernel);
        }
    }

    #[test]
    fn captures_of_every_kind() {
        let (a, b, c, flag) = (0.75f32, -3i32, 7u32, true);
        let (v2, v3, v4) = (vec2(1.0, 2.0), vec3(0.5, -0.25, 8.0), vec4(1.0, -2.0, 3.0, -4.0));
        let particle =
            raydsl_tests::kernels::Particle { position: v3, mass: 2.5, alive: false, hits: 11 };
        let kernel = kernel!(|x: f32, n: u32| {
            let moved = particle.moved(v3 * x);
            let sum = moved.position.dot(v3) + v2.x + v4.w * a + b as f32 + (c * n) as f32;
            if flag && !moved.alive { sum } else { -sum }
        });
        every_variant(&kernel);
    }
}

/// With debug assertions, what Rust calls an error is one in every variant.
#[cfg(debug_assertions)]
mod overflow {
    use std::panic::{AssertUnwindSafe, catch_unwind};

    use raydsl::kernel;
    use raydsl::kernel::{PacketKernel, run_batch};
    use raydsl::machine::{KernelFn, Lanes, Packet, Scalar, Type};
    use raydsl_tests::levels::{LevelTask, each_level};

    #[kernel]
    fn sum(a: u32, b: u32) -> u32 {
        a + b
    }

    #[kernel]
    fn difference(a: i32, b: i32) -> i32 {
        a - b
    }

    #[kernel]
    fn product(a: i32, b: i32) -> i32 {
        a * b
    }

    #[kernel]
    fn quotient(a: i32, b: i32) -> i32 {
        a / b
    }

    #[kernel]
    fn remainder(a: u32, b: u32) -> u32 {
        a % b
    }

    #[kernel]
    fn left(a: u32, b: u32) -> u32 {
        a << b
    }

    #[kernel]
    fn right(a: i32, b: u32) -> i32 {
        a >> b
    }

    #[kernel]
    fn negated(a: i32) -> i32 {
        -a
    }

    #[kernel]
    fn assigned(a: u32, b: u32) -> u32 {
        let mut x = a;
        x -= b;
        x
    }

    /// What the panic says, if there is one.
    fn panic_of(f: impl FnOnce()) -> Option<String> {
        let error = catch_unwind(AssertUnwindSafe(f)).err()?;
        let text = error.downcast_ref::<String>().cloned();
        Some(
            text.or_else(|| error.downcast_ref::<&str>().map(|s| (*s).to_owned()))
                .unwrap_or_default(),
        )
    }

    struct Overflow<F: KernelFn> {
        good: F::Args,
        bad: F::Args,
    }

    impl<F: KernelFn> LevelTask for Overflow<F> {
        fn run<L: Lanes>(&mut self, name: &str, lanes: L) {
            let kernel: &PacketKernel<'_, L, F::Args, F::Output> = &|m, args| F::lifted(m, args);
            for lane in 0..L::N {
                let mut inputs = vec![self.good; L::N];
                inputs[lane] = self.bad;
                let mut out = vec![F::scalar(self.good); L::N];
                let text = panic_of(|| run_batch(lanes, kernel, &inputs, &mut out));
                let text = text.unwrap_or_else(|| panic!("{name}: lane {lane} does not panic"));
                assert!(text.contains(&format!("lane {lane} ")), "{name}, lane {lane}: {text}");
                // The same lane, not running.
                let alive = !(1u64 << lane);
                let m = Packet::with_bits(lanes, alive);
                let text = panic_of(|| {
                    kernel(&m, F::Args::from_lanes(&m, |l| inputs[l]));
                });
                assert_eq!(text, None, "{name}: the dead lane {lane} panics");
            }
        }
    }

    fn overflows<F: KernelFn>(good: F::Args, bad: F::Args) {
        assert!(
            panic_of(|| {
                F::scalar(bad);
            })
            .is_some(),
            "the source does not panic"
        );
        let m = Scalar::default();
        let lifted = panic_of(|| {
            F::lifted(&m, F::Args::splat(&m, bad));
        });
        assert!(lifted.is_some(), "the scalar machine does not panic");
        each_level(&mut Overflow::<F> { good, bad });
    }

    macro_rules! tests {
        ($($kernel:ident: $good:tt $bad:tt;)+) => {
            mod each {
                $(
                    #[test]
                    fn $kernel() {
                        super::overflows::<super::$kernel>($good, $bad);
                    }
                )+
            }
        };
    }

    tests! {
        sum: (1, 2) (4294967295, 1);
        difference: (1, 2) (-2147483648, 1);
        product: (3, 4) (65536, 32768);
        quotient: (7, 2) (7, 0);
        remainder: (7, 2) (7, 0);
        left: (1, 31) (1, 32);
        right: (-8, 31) (-8, 32);
        negated: (5,) (-2147483648,);
        assigned: (5, 3) (3, 5);
    }
}
