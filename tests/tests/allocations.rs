//! A frame allocates nothing for a tile or a ray.

use std::alloc::{GlobalAlloc, Layout, System};
use std::error::Error;
use std::sync::atomic::{AtomicUsize, Ordering};

use raydsl::bvh::BuildConfig;
use raydsl::integrators::ambient_occlusion;
use raydsl::prelude::*;
use raydsl_tests::scenes::triangles;

/// The system's allocator, which counts.
struct Counting;

static COUNT: AtomicUsize = AtomicUsize::new(0);

// SAFETY: everything is left to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.fetch_add(1, Ordering::Relaxed);
        // SAFETY: as the caller promises.
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: as the caller promises.
        unsafe { System.dealloc(memory, layout) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// The allocations of a frame, the least of some: a thread makes room for its first query.
fn allocations(mut frame: impl FnMut()) -> usize {
    let counts = (0..8).map(|_| {
        let before = COUNT.load(Ordering::Relaxed);
        frame();
        COUNT.load(Ordering::Relaxed) - before
    });
    counts.min().expect("there are frames")
}

#[test]
fn frames_allocate_nothing() -> Result<(), Box<dyn Error>> {
    let soup = triangles(300);
    let camera = Pinhole::new(vec3(2.0, 3.0, 16.0), Vec3::ZERO, Vec3::Y, 0.8);
    for is_wide in [false, true] {
        let config = BuildConfig::default();
        let scene =
            if is_wide { Bvh::build_wide(&soup, &[], &config)? } else { Bvh::build(&soup)? };
        assert!(!scene.is_wide() || is_wide);
        let kernel = kernel!(|ray: Ray, pixel: UVec2| {
            let sampler = Sampler::new(pixel, 1, 0, 1, SampleMethod::Sobol);
            ambient_occlusion::<_, 2>(&scene, 1.5, ray, sampler)
        });
        let mut image = Image::filled(160, 144, Vec4::ZERO);
        for variant in [Variant::Scalar, Variant::Packet4, Variant::Packet8, Variant::Packet16] {
            let scheduler = SimpleScheduler::new().variant(variant);
            let count = allocations(|| scheduler.frame(&camera, &kernel, &mut image));
            assert_eq!(count, 0, "{variant:?} {is_wide}");
            // What rayon needs for a job that comes from outside, now and then.
            let scheduler = TiledScheduler::new().variant(variant).tile(4);
            let count = allocations(|| scheduler.frame(&camera, &kernel, &mut image));
            assert!(count <= 1, "{count} of 1440 tiles, {variant:?} {is_wide}");
        }
    }
    Ok(())
}
