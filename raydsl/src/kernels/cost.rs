//! What rays cost in their tree.

use glam::{Vec3, vec3};

use crate::bvh::{Bvh, Cost, RayQuery};
use crate::geometry::{Primitive, Ray};
use crate::kernel;
use crate::machine::functions::vec3;
use crate::machine::generic::clamp;
use crate::texture::srgb_to_linear;

// ANCHOR: bvh_cost
/// The nodes and primitives that are tested for the closest hit of `ray`, were it alone: a packet
/// counts for each ray what that ray would visit, not what the packet does.
#[kernel]
pub fn bvh_cost<P: Primitive>(scene: &Bvh<'_, P>, ray: Ray) -> Cost {
    let (_, cost) = scene.closest_hit_with_cost(ray);
    cost
}

/// What `ray` costs as a colour: [`heat_color()`] of its tests of nodes and primitives, where
/// `most` of them, a number above 0, are the hottest.
#[kernel]
pub fn bvh_cost_color<P: Primitive>(scene: &Bvh<'_, P>, most: f32, ray: Ray) -> Vec3 {
    let cost = bvh_cost(scene, ray);
    heat_color((cost.nodes + cost.primitives) as f32 / most)
}
// ANCHOR_END: bvh_cost

/// The colour map "turbo" as linear light: dark blue at 0, through green and yellow, dark red at 1.
/// What is outside has the colour of the end, and NaN that of 0.
///
/// Mikhailov's polynomials (2019), which leave his table by up to 0.09 of sRGB's range at the ends.
#[kernel]
pub fn heat_color(x: f32) -> Vec3 {
    let x = if x > 0.0 { clamp(x, 0.0, 1.0) } else { 0.0 };
    let red = polynomial([0.13572139, 4.6153927, -42.660324, 132.13109, -152.9424, 59.28638], x);
    let green = polynomial([0.09140261, 2.1941884, 4.8429666, -14.185034, 4.2772985, 2.829566], x);
    let blue = polynomial([0.1066733, 12.641946, -60.582047, 110.36277, -89.90311, 27.34825], x);
    vec3(red, green, blue)
}

/// A polynomial, from its constant on, which is a code of sRGB: as linear light.
#[kernel]
fn polynomial(c: [f32; 6], x: f32) -> f32 {
    let code = c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * c[5]))));
    srgb_to_linear(clamp(code, 0.0, 1.0))
}
