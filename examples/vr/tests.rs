use raydsl::kernel;
use raydsl::kernel::Variants;
use raydsl::render::over;
use raydsl::testing::can_run;

use super::*;
use crate::frames::Failure;
use crate::head::Eye;
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

/// The same picture without a rasteriser: where both have the same depth, they have the same colour.
#[test]
fn a_rasteriser_and_rays_make_the_picture_of_rays_alone() {
    with_hybrid(|hybrid| {
        for (i, head) in head::path(5).into_iter().enumerate() {
            for eye in head::eyes(head, BETWEEN_EYES, &SCREEN)? {
                let (mixed, _) = hybrid.frame(&eye, SIZE, Variant::widest())?;
                let drawn = hybrid.rasterizer.draw(&hybrid.world.drawn, eye.clip(), SIZE)?;
                let alone = by_rays_alone(hybrid, &eye)?;
                let (mut others, mut covered, mut shadows) = (0, 0, 0);
                let pixels = mixed.pixels().iter().zip(alone.pixels()).zip(drawn.pixels());
                for ((mixed, alone), drawn) in pixels {
                    // Rays have no colours of what is rasterised: what they let through is its own.
                    let color = over(alone.color, drawn.color);
                    let is_near = (mixed.depth - alone.depth).abs() <= 1e-5;
                    // Edges of triangles, and of shadows on them, may go through the middle of a
                    // pixel to within rounding.
                    others += usize::from(!is_near || mixed.color != color);
                    covered += usize::from(alone.depth < 1.0 && alone.color.w == 1.0);
                    shadows += usize::from(alone.color.w > 0.0 && alone.color.w < 1.0);
                }
                assert!(covered > 2000 && shadows > 100, "{i}: {covered} and {shadows} pixels");
                assert!(others * 200 < mixed.pixels().len(), "{i}: {others} pixels differ");
            }
        }
        Ok(())
    });
}

/// What an eye sees by rays, of which the nearest rasterised triangle cuts each.
fn by_rays_alone(hybrid: &Hybrid<'_>, eye: &Eye) -> Result<Image<Fragment>, Failure> {
    let camera = eye.camera()?;
    let window = camera.begin_frame(SIZE.0, SIZE.1);
    let Hybrid { world, plant, drawn, colors, .. } = *hybrid;
    let lamp = world.lamp;
    let kernel = kernel!(|ray: Ray| {
        let hit = drawn.closest_hit(ray);
        let before = if hit.is_hit { window.window_depth(ray.at(hit.t)) } else { 1.0 };
        let color = vec4(0.0, 0.0, 0.0, 0.0);
        traced(plant, drawn, colors, lamp, window, Fragment { color, depth: before }, ray)
    });
    let mut image = Image::filled(SIZE.0, SIZE.1, Fragment::default());
    SimpleScheduler::new().frame(&camera, &kernel, &mut image);
    Ok(image)
}

/// What is nearer is seen: a triangle in front of all hides the plant, and one behind all nothing.
#[test]
fn depths_hide_both_ways() {
    with_hybrid(|hybrid| {
        let eye = head::eyes(head::path(1)[0], 0.0, &SCREEN)?[0];
        let mut world = World::new();
        world.drawn = Vec::new();
        // Nothing is drawn, and what mirrors and shadows show is as it was.
        let (bare, _) = Hybrid { world: &world, ..*hybrid }.frame(&eye, SIZE, Variant::Scalar)?;
        for (z, hides) in [(2.5, true), (-4.0, false)] {
            let corner = |x: f32, y: f32| raydsl_examples::rasterizer::Corner {
                place: vec3(x, y, z),
                color: vec3(1.0, 0.0, 1.0),
            };
            world.drawn = vec![[corner(-99.0, -99.0), corner(99.0, -99.0), corner(0.0, 99.0)]];
            let wall = hybrid.rasterizer.draw(&world.drawn, eye.clip(), SIZE)?;
            assert!(wall.pixels().iter().all(|w| w.depth < 1.0), "it is as large as the picture");
            let (image, _) =
                Hybrid { world: &world, ..*hybrid }.frame(&eye, SIZE, Variant::Scalar)?;
            let mut walls = 0;
            for (i, found) in image.pixels().iter().enumerate() {
                let (bare, wall) = (bare.pixels()[i], wall.pixels()[i]);
                if hides || bare.depth == 1.0 {
                    walls += 1;
                    // Magenta, in the shadow or not.
                    let [x, y, z, w] = found.color.to_array();
                    let is_magenta = y == 0.0 && x == z && x > 0.3 && w == 1.0;
                    assert!(is_magenta && found.depth == wall.depth, "{i}: {found:?} {wall:?}");
                } else {
                    assert_eq!(*found, bare, "{i}");
                }
            }
            let share = walls as f32 / image.pixels().len() as f32;
            assert!(hides || (0.05..0.95).contains(&share), "both are seen: {share}");
        }
        Ok(())
    });
}

#[test]
fn variants_agree() {
    with_hybrid(|hybrid| {
        for eye in head::eyes(head::path(9)[4], BETWEEN_EYES, &SCREEN)? {
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
