//! Pictures: the same bits from every scheduler, variant and number of threads.

use raydsl::bvh::BuildError;
use raydsl::prelude::*;
use raydsl_tests::gpu::gpu;
use raydsl_tests::scenes::spheres;
use raydsl_tests::values::compare;

const SIZES: [(u32, u32); 6] = [(1, 1), (17, 33), (0, 5), (5, 0), (64, 48), (3, 100)];
const CPU: [Variant; 4] = [Variant::Scalar, Variant::Packet4, Variant::Packet8, Variant::Packet16];

fn camera() -> Pinhole {
    Pinhole::new(vec3(1.0, 2.0, -14.0), vec3(0.2, 0.0, 0.0), vec3(0.0, 1.0, 0.0), 0.9)
}

fn same(who: &str, expected: &Image, found: &Image) {
    if expected.pixels().is_empty() {
        return assert!(found.pixels().is_empty());
    }
    let width = expected.width() as usize;
    compare(who, expected.pixels(), found.pixels())
        .assert_same(|i| format!("pixel ({}, {})", i % width, i / width));
}

macro_rules! primary {
    ($bvh:ident, $background:ident) => {
        kernel!(|ray: Ray| {
            let hit = $bvh.closest_hit(ray);
            let color = if hit.is_hit { $bvh.primitive(hit).rgb() } else { $background };
            Shaded { color, depth: hit.t, id: hit.prim_id }
        })
    };
}

#[test]
fn every_scheduler_and_variant() -> Result<(), BuildError> {
    let points = spheres(800);
    let bvh = Bvh::build(&points)?;
    let background = vec3(0.1, 0.2, 0.3);
    let primary = primary!(bvh, background);
    for (width, height) in SIZES {
        let mut expected = Image::new(width, height);
        SimpleScheduler::new().frame(&camera(), &primary, &mut expected);
        if width == 64 {
            let hits = expected.pixels().iter().filter(|p| p.color != background).count();
            assert!(hits > 100 && hits < 64 * 48, "{hits} pixels show a sphere");
        }
        for v in CPU {
            let mut found = Image::filled(width, height, Shaded::default());
            SimpleScheduler::new().variant(v).frame(&camera(), &primary, &mut found);
            same(&format!("simple {v:?} {width}x{height}"), &expected, &found);
            let mut found = Image::filled(width, height, Shaded::default());
            TiledScheduler::new().variant(v).frame(&camera(), &primary, &mut found);
            same(&format!("tiled {v:?} {width}x{height}"), &expected, &found);
        }
        if let Some(gpu) = gpu() {
            let mut found = Image::new(width, height);
            if let Err(e) = gpu.frame(&camera(), &primary, &mut found) {
                panic!("{width}x{height}: {e}");
            }
            same(&format!("WGSL {width}x{height}"), &expected, &found);
        }
    }
    Ok(())
}

#[test]
fn any_number_of_threads() -> Result<(), Box<dyn std::error::Error>> {
    let points = spheres(800);
    let bvh = Bvh::build(&points)?;
    let background = vec3(0.1, 0.2, 0.3);
    let primary = primary!(bvh, background);
    let mut expected = Image::new(131, 77);
    SimpleScheduler::new().frame(&camera(), &primary, &mut expected);
    for threads in [1, 2, 7] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
        for v in CPU {
            let mut found = Image::new(131, 77);
            pool.install(|| {
                TiledScheduler::new().variant(v).frame(&camera(), &primary, &mut found)
            });
            same(&format!("{v:?} on {threads} threads"), &expected, &found);
        }
    }
    Ok(())
}

/// An empty scene is a scene.
#[test]
fn nothing_to_see() -> Result<(), BuildError> {
    let points = spheres(0);
    let bvh = Bvh::build(&points)?;
    let background = vec3(0.1, 0.2, 0.3);
    let primary = primary!(bvh, background);
    let mut expected = Image::new(9, 7);
    SimpleScheduler::new().frame(&camera(), &primary, &mut expected);
    assert!(expected.pixels().iter().all(|p| p.color == background && p.depth == 0.0));
    for v in CPU {
        let mut found = Image::new(9, 7);
        TiledScheduler::new().variant(v).frame(&camera(), &primary, &mut found);
        same(&format!("{v:?}"), &expected, &found);
    }
    if let Some(gpu) = gpu() {
        let mut found = Image::new(9, 7);
        if let Err(e) = gpu.frame(&camera(), &primary, &mut found) {
            panic!("{e}");
        }
        same("WGSL", &expected, &found);
    }
    Ok(())
}
