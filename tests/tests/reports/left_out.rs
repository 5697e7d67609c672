//! Kernels of which `RAYDSL_VARIANTS` has left out some copies: what is there stands in.

use std::panic::{AssertUnwindSafe, catch_unwind};

use raydsl::__private::Lifted;
use raydsl::kernel::{Kernel, PacketKernel, PacketTask, Variant};
use raydsl::machine::{KernelFn, KernelInfo, Lanes};
use raydsl::prelude::*;

#[raydsl::kernel]
fn steps(n: u32) -> f32 {
    let mut x = n as f32;
    let mut count = 0.0;
    while x > 1.0 {
        x *= 0.7;
        count += 1.0;
    }
    count
}

const PACKETS: [Variant; 3] = [Variant::Packet4, Variant::Packet8, Variant::Packet16];

/// The kernel with the copies for these packets, and without WGSL and the reference.
fn with(packets: &[Variant]) -> Kernel<'static, (u32,), f32> {
    static INFO: KernelInfo =
        KernelInfo { name: "steps", file: "steps.rs", line: 7, params: &["n"], known: None };
    let has = |variant| packets.contains(&variant);
    Kernel::scalar(&INFO, steps::scalar).lifted(
        Lifted {
            native4: if has(Variant::Packet4) { Some(Box::new(steps::lifted)) } else { None },
            native8: if has(Variant::Packet8) { Some(Box::new(steps::lifted)) } else { None },
            native16: if has(Variant::Packet16) { Some(Box::new(steps::lifted)) } else { None },
            recorder: None,
            margin: None,
        },
        |_| {},
    )
}

/// How many lanes run a variant; 1 for the scalar function.
struct Width;

impl PacketTask<(u32,), f32> for Width {
    type Output = usize;

    fn run<L: Lanes>(self, _: L, _: &PacketKernel<'_, L, (u32,), f32>) -> usize {
        L::N
    }

    fn scalar(self, _: &(dyn Fn((u32,)) -> f32 + Send + Sync)) -> usize {
        1
    }
}

#[test]
fn narrower_packets_or_the_scalar_function_stand_in() {
    let inputs: Vec<(u32,)> = (0..101).map(|n| (n,)).collect();
    let expected: Vec<f32> = inputs.iter().map(|(n,)| steps(*n)).collect();
    for copies in [&PACKETS[..], &PACKETS[..2], &PACKETS[..1], &PACKETS[1..2], &[]] {
        let kernel = with(copies);
        for variant in PACKETS {
            let mut found = vec![f32::NAN; inputs.len()];
            kernel.run(variant, &inputs, &mut found);
            assert_eq!(found, expected, "{variant:?} of {copies:?}");
            let lanes = kernel.with_packets(variant, Width);
            let is_there = copies.contains(&variant) && variant.is_native();
            assert!(lanes <= variant.isa().1, "{variant:?} of {copies:?}: {lanes} lanes");
            assert!(!is_there || lanes == variant.isa().1, "{variant:?} of {copies:?}: {lanes}");
            let has_narrowest = copies.contains(&Variant::Packet4) && Variant::Packet4.is_native();
            assert!(lanes > 1 || !has_narrowest, "{variant:?} of {copies:?}: {lanes}");
        }
    }
    assert_eq!(with(&[]).with_packets(Variant::Packet8, Width), 1);
}

#[test]
fn frames_are_the_same() {
    let camera = Pinhole::new(vec3(0.0, 0.0, 3.0), Vec3::ZERO, Vec3::Y, 0.9);
    let frame = |kernel: &Kernel<'_, (Ray,), f32>, variant| {
        let mut image = Image::filled(37, 21, 0.0);
        SimpleScheduler::new().variant(variant).frame(&camera, kernel, &mut image);
        image
    };
    let whole = kernel!(|ray: Ray| ray.direction.x * 3.0 + ray.direction.y);
    static INFO: KernelInfo =
        KernelInfo { name: "sum", file: "sum.rs", line: 1, params: &["ray"], known: None };
    let sum = |(ray,): (Ray,)| ray.direction.x * 3.0 + ray.direction.y;
    let none =
        Lifted { native4: None, native8: None, native16: None, recorder: None, margin: None };
    let bare = Kernel::scalar(&INFO, sum).lifted(none, |_| {});
    for variant in PACKETS {
        assert_eq!(frame(&bare, variant), frame(&whole, variant), "{variant:?}");
    }
}

#[test]
fn what_needs_another_copy_says_so() {
    let kernel = with(&PACKETS);
    let message = |f: &dyn Fn()| {
        let panic = catch_unwind(AssertUnwindSafe(f)).expect_err("the copy is not there");
        panic.downcast_ref::<String>().cloned().unwrap_or_default()
    };
    let of_wgsl = message(&|| drop(kernel.wgsl()));
    let of_reference = message(&|| drop(kernel.reference((3,))));
    for (text, name) in [(of_wgsl, "`wgsl`"), (of_reference, "`reference`")] {
        let says = |what: &str| assert!(text.contains(what), "{text}");
        says(name);
        says("`steps` (steps.rs:7)");
        says("RAYDSL_VARIANTS");
    }
}
