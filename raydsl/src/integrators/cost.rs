//! Traversal cost: as counts, and as a false-colour picture.

use glam::{Vec3, vec3};

use crate::bvh::{Cost, RecordQuery};
use crate::geometry::Ray;
use crate::kernel;
use crate::machine::functions::vec3;
use crate::machine::generic::clamp;
use crate::texture::srgb_to_linear;

// ANCHOR: bvh_cost
/// Counts the nodes and primitives that are tested to find the closest hit of `ray`. In a packet,
/// each ray is counted as if it were traced by itself.
#[kernel]
pub fn bvh_cost<S: RecordQuery + ?Sized>(scene: &S, ray: Ray) -> Cost {
    let (_, cost) = scene.closest_hit_with_cost(ray);
    cost
}

/// Returns the traversal cost of `ray` as a colour: the [`heat_color()`] of its tests of nodes and
/// primitives, relative to `most`, a number above 0, which is the hot end of the map.
#[kernel]
pub fn bvh_cost_color<S: RecordQuery + ?Sized>(scene: &S, most: f32, ray: Ray) -> Vec3 {
    let cost = bvh_cost(scene, ray);
    heat_color((cost.nodes + cost.primitives) as f32 / most)
}
// ANCHOR_END: bvh_cost

/// Evaluates the colour map "turbo" in linear light: dark blue at 0, through green and yellow, to
/// dark red at 1. Values outside are clamped to the ends, and NaN has the colour of 0.
///
/// Uses Mikhailov's polynomials (2019), which differ from his table by up to 0.09 of sRGB's range
/// at the ends.
#[kernel]
pub fn heat_color(x: f32) -> Vec3 {
    let x = if x > 0.0 { clamp(x, 0.0, 1.0) } else { 0.0 };
    let red = polynomial([0.13572139, 4.6153927, -42.660324, 132.13109, -152.9424, 59.28638], x);
    let green = polynomial([0.09140261, 2.1941884, 4.8429666, -14.185034, 4.2772985, 2.829566], x);
    let blue = polynomial([0.1066733, 12.641946, -60.582047, 110.36277, -89.90311, 27.34825], x);
    vec3(red, green, blue)
}

/// Evaluates a polynomial, constant term first, as an sRGB value and decodes it to linear light.
#[kernel]
fn polynomial(c: [f32; 6], x: f32) -> f32 {
    let code = c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * c[5]))));
    srgb_to_linear(clamp(code, 0.0, 1.0))
}
