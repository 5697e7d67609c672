//! Hairs: cubic curves with a round section that get thinner towards the tip, on a ball.
//!
//! `cargo run --release --example hair -- FOLDER` writes `hair.png` to FOLDER (`out` if none is
//! given) and says how the variants agree; with `--wgsl` instead it prints the kernel's WGSL.

mod fur;
mod shape;

use std::error::Error;
use std::path::PathBuf;
use std::{env, fs};

use raydsl::kernel;
use raydsl::prelude::*;
use raydsl_examples::picture::reduced;
use raydsl_report::Compare;

use fur::fur;

// ANCHOR: shade
/// Kajiya and Kay, "Rendering Fur with Three Dimensional Textures" (1989): what a thin cylinder
/// along `tangent` sends to `eye` of the light from `lamp`. The second number is the highlight.
#[kernel]
fn strand(tangent: Vec3, lamp: Vec3, eye: Vec3) -> Vec2 {
    let (l, e) = (tangent.dot(lamp), tangent.dot(eye));
    let (sin_l, sin_e) = (max(1.0 - l * l, 0.0).sqrt(), max(1.0 - e * e, 0.0).sqrt());
    vec2(sin_l, pow(max(sin_l * sin_e - l * e, 0.0), 40.0))
}
// ANCHOR_END: shade

fn main() -> Result<(), Box<dyn Error>> {
    let argument = env::args().nth(1).unwrap_or_else(|| "out".to_owned());

    // ANCHOR: kernel
    let hairs = fur(36_000);
    let bvh = Bvh::build(&hairs)?;
    let sun = vec3(-0.6, 0.65, 0.5).normalize();
    let primary = kernel!(|ray: Ray| {
        let skin = sphere::intersect(ray, Vec3::ZERO, 1.0);
        let reach = if skin.is_hit { skin.t } else { ray.t_max };
        let found = bvh.closest_hit(ray.with_range(ray.t_min, reach));
        if !found.hit.is_hit {
            let away = ray.direction.x * ray.direction.x + ray.direction.y * ray.direction.y;
            let behind = vec3(0.16, 0.2, 0.26) * (1.0 - 2.0 * away);
            let color = if skin.is_hit { vec3(0.05, 0.02, 0.01) } else { behind };
            return Shaded { color, depth: f32::MAX, id: 0xffff_ffffu32 };
        }
        // Between hairs light goes a little way.
        let shadow = Ray::new(ray.at(found.hit.t), sun).with_range(0.02, 10.0);
        let is_dark = sphere::intersect(shadow, Vec3::ZERO, 1.0).is_hit || bvh.any_hit(shadow);
        let seen = strand(found.tangent, sun, -ray.direction);
        let color = vec3(0.45, 0.16, 0.04).lerp(vec3(0.95, 0.55, 0.24), found.share);
        let mut light = color * (0.3 * found.share + 0.1);
        if !is_dark {
            light = max(light, color * seen.x);
            light += vec3(0.5, 0.42, 0.3) * seen.y;
        }
        Shaded { color: light, depth: found.hit.t, id: found.hit.prim_id }
    });
    // ANCHOR_END: kernel

    if argument == "--wgsl" {
        println!("{}", primary.wgsl());
        return Ok(());
    }
    let folder = PathBuf::from(argument);
    fs::create_dir_all(&folder)?;
    let camera = Pinhole::new(vec3(0.0, 0.5, 4.6), vec3(0.02, -0.07, 0.0), Vec3::Y, 0.61);
    let mut image = Image::new(1350, 1005);
    TiledScheduler::new().frame(&camera, &primary, &mut image);
    reduced(&image, 3).write_png(folder.join("hair.png"))?;

    // Hundreds of curves for a ray are too many for a look at some pixels in `f64`.
    let found = Compare::new().size(320, 200).runs(3).samples(0).run(&primary, &camera);
    println!("{}", found.table());
    Ok(())
}
