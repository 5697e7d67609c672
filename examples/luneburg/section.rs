//! Rays in a plane through the middle of each lens.

use std::error::Error;

use raydsl::kernel;
use raydsl::prelude::*;
use raydsl_examples::lens::{Medium, RungeKutta, State, Stepper};

use crate::Glass;
use crate::scene::rainbow;

/// A part of a ray.
#[primitive(tube(from, to, radius))]
struct Part {
    from: Vec3,
    radius: f32,
    to: Vec3,
    color: [Unorm8; 4],
}

#[kernel]
impl Part {
    fn rgb(&self) -> Vec3 {
        vec3(self.color[0].to_f32(), self.color[1].to_f32(), self.color[2].to_f32())
    }
}

/// Centres of the two lenses.
const CENTERS: [Vec3; 2] = [vec3(-0.2, 1.6, 0.0), vec3(-0.2, -1.6, 0.0)];
/// What is shown is twice as high as wide.
const HEIGHT: f32 = 6.4;

/// The places of a ray: it enters a lens of radius 1 in the state, and goes on behind it, but not
/// as far as to the other lens.
fn path(medium: Glass, entry: State) -> Vec<Vec3> {
    let stepper = RungeKutta { medium };
    let mut places = vec![entry.at];
    let mut state = entry;
    for _ in 0..200 {
        let next = stepper.step(state, 0.02).end;
        if next.at.length() > 1.0 && next.at.dot(next.momentum) > 0.0 {
            break;
        }
        state = next;
        places.push(state.at);
    }
    let beyond = (1.5 / state.momentum.y.abs()).min(4.0);
    places.push(state.at + state.momentum * beyond);
    places
}

fn parts(center: Vec3, places: &[Vec3], color: Vec3) -> impl Iterator<Item = Part> {
    let color = color.extend(1.0).to_array().map(Unorm8::from);
    let part =
        move |w: &[Vec3]| Part { from: center + w[0], radius: 0.014, to: center + w[1], color };
    places.windows(2).map(part)
}

/// A beam of parallel light through the first lens; light from a point of the second one.
fn rays(media: &[Glass; 2]) -> Vec<Part> {
    let count = 13u8;
    let mut all = Vec::new();
    for i in 0..count {
        let share = f32::from(i) / f32::from(count - 1);
        let color = 0.25 + 0.75 * rainbow(0.85 * share);
        let height = 1.8 * share - 0.9;
        let entry = vec3(-(1.0 - height * height).sqrt(), height, 0.0);
        let mut places = path(media[0], State { at: entry, momentum: Vec3::X });
        places.insert(0, vec3(-4.0, height, 0.0));
        all.extend(parts(CENTERS[0], &places, color));
        let angle = 2.8 * share - 1.4;
        let momentum = vec3(angle.cos(), angle.sin(), 0.0);
        let places = path(media[1], State { at: -Vec3::X, momentum });
        all.extend(parts(CENTERS[1], &places, color));
    }
    all
}

/// Rays over what the index is, lighter where it is higher.
pub(crate) fn picture(
    media: &[Glass; 2],
    (width, height): (u32, u32),
) -> Result<Image, Box<dyn Error>> {
    let rays = rays(media);
    let bvh = Bvh::build(&rays)?;
    let [upper, lower] = CENTERS;
    let [of_upper, of_lower] = *media;
    let kernel = kernel!(|ray: Ray| {
        let hit = bvh.closest_hit(ray);
        let flat = vec3(ray.origin.x, ray.origin.y, 0.0);
        let at = if flat.y > 0.0 { flat - upper } else { flat - lower };
        let square =
            if flat.y > 0.0 { of_upper.index_squared(at) } else { of_lower.index_squared(at) };
        let mut color = vec3(0.035, 0.045, 0.07);
        if at.dot(at) < 1.0 {
            color =
                color.lerp(vec3(0.16, 0.30, 0.50), clamp(0.25 + 0.4 * (square - 1.0), 0.0, 1.0));
        }
        if (length(at) - 1.0).abs() < 0.012 {
            color = vec3(0.45, 0.55, 0.68);
        }
        if hit.is_hit {
            color = bvh.primitive(hit).rgb();
        }
        Shaded { color, depth: hit.t, id: hit.prim_id }
    });
    let camera = Orthographic::new(Vec3::Z * 5.0, Vec3::ZERO, Vec3::Y, HEIGHT);
    let mut image = Image::new(width, height);
    TiledScheduler::new().frame(&camera, &kernel, &mut image);
    Ok(image)
}
