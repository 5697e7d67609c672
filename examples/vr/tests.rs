use raydsl::kernel;
use raydsl::kernel::Variants;
use raydsl::testing::can_run;

use super::*;
use crate::frames::Failure;
use crate::light::traced;

const SIZE: (u32, u32) = (120, 108);

/// Calls `test` with everything that is seen, drawn by code.
fn with_hybrid(test: impl FnOnce(&Hybrid<'_>) -> Result<(), Failure>) {
    let world = World::new();
    let (triangles, colors) = world.for_rays();
    let plant = Bvh::build(&world.parts).expect("finite triangles");
    let drawn = Bvh::build(&triangles).expect("finite triangles");
    let (rasterizer, colors) = (&Rasterizer::Software, &colors[..]);
    test(&Hybrid { world: &world, plant: &plant, drawn: &drawn, colors, rasterizer })
        .expect("nothing is refused");
}

/// The same picture without a rasteriser: its pixels are those of rays too.
#[test]
fn a_rasteriser_and_rays_make_the_picture_of_rays_alone() {
    with_hybrid(|hybrid| {
        for (i, eye) in
            head::path(5).iter().flat_map(|h| head::eyes(*h, BETWEEN_EYES, &SCREEN)).enumerate()
        {
            let (mixed, _) = hybrid.frame(&eye, SIZE, Variant::widest())?;
            let camera = eye.camera()?;
            let window = camera.begin_frame(SIZE.0, SIZE.1);
            let Hybrid { world, plant, drawn, .. } = *hybrid;
            let (lamp, colors) = (world.lamp, hybrid.colors);
            // What the rasteriser draws, by rays: the depth of the nearest triangle. The colours of its
            // corners are those of its pixels.
            let rasterised = kernel!(|ray: Ray| {
                let hit = drawn.closest_hit(ray);
                let before = if hit.is_hit { window.window_depth(ray.at(hit.t)) } else { 1.0 };
                let color = vec4(0.0, 0.0, 0.0, 0.0);
                traced(plant, drawn, colors, lamp, window, Fragment { color, depth: before }, ray)
            });
            let mut alone = Image::filled(SIZE.0, SIZE.1, Fragment::default());
            SimpleScheduler::new().frame(&camera, &rasterised, &mut alone);
            let (mut others, mut covered, mut shadows) = (0, 0, 0);
            for (mixed, alone) in mixed.pixels().iter().zip(alone.pixels()) {
                // Edges of triangles may go through the middle of a pixel to within rounding.
                others += usize::from((mixed.depth - alone.depth).abs() > 1e-5);
                covered += usize::from(alone.depth < 1.0 && alone.color.w == 1.0);
                shadows += usize::from(alone.color.w > 0.0 && alone.color.w < 1.0);
            }
            assert!(covered > 2000 && shadows > 100, "{i}: {covered} and {shadows} pixels");
            assert!(others * 200 < mixed.pixels().len(), "{i}: {others} pixels differ");
        }
        Ok(())
    });
}

/// What is nearer is seen: a triangle in front of all hides the plant, and one behind all nothing.
#[test]
fn depths_hide_both_ways() {
    with_hybrid(|hybrid| {
        let eye = head::eyes(head::path(1)[0], 0.0, &SCREEN)[0];
        let (whole, _) = hybrid.frame(&eye, SIZE, Variant::Scalar)?;
        let wall = |z: f32| {
            let corner = |x: f32, y: f32| raydsl_examples::rasterizer::Corner {
                place: vec3(x, y, z),
                color: vec3(1.0, 0.0, 1.0),
            };
            vec![[corner(-99.0, -99.0), corner(99.0, -99.0), corner(0.0, 99.0)]]
        };
        let mut world = World::new();
        for (z, most) in [(2.5, 1.0), (-4.0, 0.8)] {
            world.drawn = wall(z);
            let (image, _) =
                Hybrid { world: &world, ..*hybrid }.frame(&eye, SIZE, Variant::Scalar)?;
            // Magenta, in the shadow or not.
            let is_wall =
                |f: &&Fragment| f.color.y == 0.0 && f.color.x > 0.3 && f.color.x == f.color.z;
            let share =
                image.pixels().iter().filter(is_wall).count() as f32 / image.pixels().len() as f32;
            if z > 0.0 {
                assert_eq!(share, most);
            } else {
                assert!(share > 0.05 && share < most, "{share}");
                let same = image.pixels().iter().zip(whole.pixels());
                let nearer = same.filter(|(a, b)| a.depth == b.depth && b.depth < 1.0).count();
                assert!(nearer > 1000, "{nearer}");
            }
        }
        Ok(())
    });
}

#[test]
fn variants_agree() {
    with_hybrid(|hybrid| {
        for eye in head::eyes(head::path(9)[4], BETWEEN_EYES, &SCREEN) {
            let mut variants = Variants::cpu();
            if can_run(Variant::Wgsl, "rays beside a rasteriser") {
                variants = Variants::all();
            }
            let found = hybrid.compare(&eye, SIZE, &variants, 1)?;
            assert!(found.agrees(), "{}", found.table());
        }
        Ok(())
    });
}
