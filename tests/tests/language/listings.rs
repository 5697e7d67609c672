//! The five listings of the examples, in every variant.

use raydsl::assert_variants_agree;
use raydsl::prelude::*;
use raydsl_tests::rng::Rng;

#[path = "../../../examples/listings/cloud.rs"]
mod cloud;
#[path = "../../../examples/listings/kinds.rs"]
mod kinds;
#[path = "../../../examples/listings/menu.rs"]
mod menu;
#[path = "../../../examples/listings/texture.rs"]
mod texture;
#[path = "../../../examples/listings/width.rs"]
mod width;

fn rays(rng: &mut Rng, eye: Vec3, aim: f32) -> Vec<(Ray,)> {
    (0..2000).map(|_| (Ray::new(eye, rng.point(aim) - eye),)).collect()
}

#[test]
fn a_wand_picks_a_button() {
    let menu = menu::menu(5);
    for i in 0..5u32 {
        let aim = vec3(0.3, 0.9 - 0.3 * i as f32, 2.0);
        assert_eq!(menu::picked(&menu, Ray::new(Vec3::ZERO, aim)), Some(i));
    }
    // Between two buttons, beside them, and away from them.
    for aim in [vec3(0.0, 0.75, 2.0), vec3(1.2, 0.9, 2.0), vec3(0.0, 0.9, -2.0)] {
        assert_eq!(menu::picked(&menu, Ray::new(Vec3::ZERO, aim)), None);
    }
    let menu = &menu[..];
    let pick = kernel!(|ray: Ray| {
        let hit = menu.closest_hit(ray);
        if hit.is_hit { hit.prim_id } else { 99 }
    });
    let mut rng = Rng::of("menu");
    assert_variants_agree!(&pick, &rays(&mut rng, vec3(0.0, 0.0, -1.0), 2.5));
}

#[test]
fn a_texture_is_referred_to() {
    let (texels, grid) = texture::tiles();
    let texels = &texels[..];
    // Texel (5, 2), and the same a period away.
    for uv in [vec2(0.65, 0.3), vec2(3.65, -0.7)] {
        assert_eq!(texture::tex2(texels, grid, uv), texels[2 * 8 + 5]);
    }
    let floor = kernel!(|ray: Ray| texture::floor(texels, grid, ray));
    let mut rng = Rng::of("floor");
    assert_variants_agree!(&floor, &rays(&mut rng, vec3(0.2, 1.5, -4.0), 3.0));
}

#[test]
fn one_function_has_every_width() {
    let rays = rays(&mut Rng::of("width"), vec3(0.0, 0.3, -3.0), 1.5);
    for variant in [Variant::Packet4, Variant::Packet8, Variant::Packet16] {
        let (packets, scalar) = width::means(variant, &rays);
        assert!(packets == scalar && packets > 0.1, "{packets} {scalar}");
    }
    assert_variants_agree!(width::thickness, &rays);
}

#[test]
fn kinds_share_a_scene() {
    let shapes = [
        kinds::Shape::Ball(kinds::Ball { center: vec3(-1.0, 0.5, 4.0), radius: 1.0 }),
        kinds::Shape::Facet(Triangle {
            v0: vec3(0.2, -0.5, 3.5),
            v1: vec3(2.2, -0.5, 4.5),
            v2: vec3(1.2, 1.5, 4.0),
        }),
    ];
    let scene = Bvh::build(&shapes).expect("finite bounds");
    let plastic = kinds::Plastic { color: vec3(0.8, 0.2, 0.1), exponent: 40.0 };
    let matte = kinds::Matte { color: vec3(0.3, 0.6, 0.8) };
    let mut rng = Rng::of("kinds");
    let rays = rays(&mut rng, vec3(0.0, 0.3, 8.0), 3.0);
    for light in [kinds::Light::Sky, kinds::Light::Lamp] {
        let shaded = kernel!(|ray: Ray| kinds::radiance(&scene, plastic, matte, light, ray));
        let bright = rays.iter().filter(|(r,)| shaded.call((*r,)) != Vec3::ZERO).count();
        assert!(bright > 50, "{bright} rays meet anything");
        assert_variants_agree!(&shaded, &rays);
    }
}

#[test]
fn a_cloud_has_colours() {
    let points = cloud::spiral(2000);
    assert_eq!(size_of::<cloud::ColorSphere>(), 16);
    let bvh = Bvh::build(&points).expect("finite bounds");
    let seen = kernel!(|ray: Ray| {
        let found = bvh.closest_hit(ray);
        if found.hit.is_hit { found.color } else { Vec3::ONE }
    });
    let mut rng = Rng::of("cloud");
    let rays = rays(&mut rng, vec3(0.0, 1.5, -3.2), 1.3);
    for (ray,) in &rays {
        let found = bvh.closest_hit(*ray);
        if found.hit.is_hit {
            let color = points[found.hit.prim_id as usize].color.map(|c| c.to_f32());
            assert_eq!(seen.call((*ray,)).to_array(), color);
        }
    }
    assert_variants_agree!(&seen, &rays);
}
