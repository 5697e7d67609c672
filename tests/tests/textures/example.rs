//! The scene of the example `textures` in every variant: textures read while a tree is traversed.

use raydsl::assert_variants_agree;
use raydsl::prelude::*;
use raydsl::texture::{AsTextureRef, Filter, LevelFilter};
use raydsl_tests::rng::Rng;

#[path = "../../../examples/textures/scene.rs"]
mod scene;

#[test]
fn panes_on_a_floor_agree() -> Result<(), Box<dyn std::error::Error>> {
    let config = TextureConfig::new().level_filter(LevelFilter::Linear);
    let petals = Texture2::new(scene::flower(), [16, 16], config)?;
    let read_by =
        |filter| petals.as_texture_ref().with_config(config.border(Vec4::ZERO).filter(filter));
    let (nearest, linear) = (read_by(Filter::Nearest), read_by(Filter::Linear));
    let (spline, catmull_rom) = (read_by(Filter::BSpline), read_by(Filter::CatmullRom));
    let floor = Texture2::new(scene::tiles(), [32, 32], config)?.with_levels()?;
    let panes = scene::panes();
    let bvh = Bvh::build(&panes)?;
    let sun = vec3(-0.35, 0.8, -0.75).normalize();
    let eye = vec3(0.0, 1.45, 6.0);
    let mut rng = Rng::new(50);
    let ray =
        |aim: Vec3| Ray::new(eye, (aim * vec3(2.6, 1.0, 0.5) + Vec3::Y * 0.4 - eye).normalize());
    let rays: Vec<(Ray,)> = (0..500).map(|_| (ray(rng.point(1.0)),)).collect();
    let shaded = kernel!(|ray: Ray| {
        scene::shade(&bvh, &nearest, &linear, &spline, &catmull_rom, &floor, sun, ray)
    });
    let hits = rays.iter().filter(|(ray,)| bvh.any_hit(*ray)).count();
    assert!(hits > 50 && hits < 450, "{hits}");
    assert_variants_agree!(&shaded, &rays);
    Ok(())
}
