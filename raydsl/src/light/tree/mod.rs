//! A tree of lights, by which kernels choose one of many.
//!
//! Conty Estevez and Kulla, "Importance Sampling of Many Lights with Adaptive Tree Splitting" (2018),
//! without the splitting; the bound of a node's light is that of Pharr, Jakob and Humphreys,
//! "Physically Based Rendering" (4th edition, 2023), 12.6.3. From the root on, one of two children is
//! chosen in proportion to that bound, down to a leaf, which is one light.

mod build;
mod cone;

pub(super) use build::{LightTree, Lit, NOT_IN_TREE};

use glam::Vec3;

use crate::geometry::SurfacePoint;
use crate::machine::generic::{max, min};
use crate::{Type, kernel};

/// Node of the tree. Children are side by side.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct LightNode {
    /// Centre of a sphere around its lights.
    pub(super) center: Vec3,
    /// Square of the radius.
    pub(super) radius2: f32,
    /// Square of the least distance that counts.
    pub(super) near2: f32,
    /// Axis of a cone around the normals of its lights.
    pub(super) axis: Vec3,
    /// Cosine of the angle of that cone.
    pub(super) cos_normals: f32,
    /// Its sine, which the cosine of a narrow cone does not tell.
    pub(super) sin_normals: f32,
    /// Cosine of the greatest angle to a normal under which light leaves, a little less than that.
    pub(super) cos_emitted: f32,
    /// Greatest radiant intensity, all lights together; that of the root is 1.
    pub(super) power: f32,
    /// Number of the first child; of a leaf that of the light, with [`LEAF`].
    pub(super) child: u32,
}

/// Bit of [`LightNode::child`].
pub(super) const LEAF: u32 = 1 << 31;

/// A node shines at least this much, compared with straight ahead, in any direction into which it
/// may shine, and as much beyond: more than what rounding does to cosines of small angles.
pub(super) const LEAST_EMITTED: f32 = 1e-3;

/// Least cosine of the receiver. Normals for shading differ from those of the surface, and a point of
/// a medium has none.
const LEAST_RECEIVED: f32 = 0.1;

/// A light that was chosen among the list, and the probability of that.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct LightChoice {
    /// The number of the light.
    pub light: u32,
    /// The probability with which it is chosen from this point.
    pub chance: f32,
}

/// Returns the cosine of the difference between the angle with the cosine `c` and the sine `s` and a
/// smaller one; 1 if the other is not smaller.
#[kernel]
#[inline]
fn cos_less(c: f32, s: f32, other_c: f32, other_s: f32) -> f32 {
    if c > other_c { 1.0 } else { c * other_c + s * other_s }
}

/// Returns about how much light a node sends to a point, at most: the power over the square of the
/// distance, and the cosines that the box and the normals of its lights allow. The surface may
/// scatter light from behind: its cosine has no sign.
#[kernel]
#[inline]
fn importance(node: LightNode, from: SurfacePoint) -> f32 {
    let way = from.position - node.center;
    let squared = max(way.dot(way), f32::MIN_POSITIVE);
    let wi = way / squared.sqrt();
    // The angle under which the sphere is seen.
    let is_inside = squared <= node.radius2;
    let sin2_seen = min(node.radius2 / squared, 1.0);
    let sin_seen = sin2_seen.sqrt();
    let cos_seen = (1.0 - sin2_seen).sqrt();
    // The angle to the axis, less that of the normals, and less that of the sphere.
    let cos_axis = node.axis.dot(wi);
    let sin_axis = max(1.0 - cos_axis * cos_axis, 0.0).sqrt();
    let cos_near = cos_less(cos_axis, sin_axis, node.cos_normals, node.sin_normals);
    let sin_near = if cos_axis > node.cos_normals {
        0.0
    } else {
        sin_axis * node.cos_normals - cos_axis * node.sin_normals
    };
    let cos_least = cos_less(cos_near, max(sin_near, 0.0), cos_seen, sin_seen);
    let cos_emitted = if is_inside { 1.0 } else { cos_least };
    let emitted =
        if cos_emitted > node.cos_emitted { max(cos_emitted, LEAST_EMITTED) } else { 0.0 };
    let cos_normal = from.normal.dot(wi).abs();
    let sin_normal = max(1.0 - cos_normal * cos_normal, 0.0).sqrt();
    let cos_received = cos_less(cos_normal, sin_normal, cos_seen, sin_seen);
    // A point of a medium has no normal.
    let has_normal = from.normal.dot(from.normal) > 0.0;
    let is_facing = is_inside || !has_normal;
    let received = if is_facing { 1.0 } else { max(cos_received, LEAST_RECEIVED) };
    node.power * emitted * received / max(squared, node.near2)
}

/// Returns the probability of going on with the first child.
#[kernel]
#[inline]
pub(super) fn share_of_first(first: LightNode, second: LightNode, from: SurfacePoint) -> f32 {
    let (a, b) = (importance(first, from), importance(second, from));
    let sum = a + b;
    let by_power = first.power / (first.power + second.power);
    // Neither shines here, or too far away for numbers.
    let (is_bright, is_number) = (sum >= f32::MIN_POSITIVE, sum <= f32::MAX);
    if is_bright && is_number { a / sum } else { by_power }
}

#[cfg(test)]
mod tests {
    use glam::{UVec2, vec3};

    use super::*;
    use crate::geometry::Triangle;
    use crate::light::{AnyLight, AreaLight, DiskShape, Light, PointLight, SphereShape, SpotLight};
    use crate::sampling::{Rng, sample_uniform_sphere};

    fn any_light(random: &mut Rng, i: usize) -> AnyLight {
        let position = random.next_3d();
        let direction = sample_uniform_sphere(random.next_2d());
        let (radiance, intensity) = (Vec3::ONE, Vec3::ONE);
        let size = 10f32.powi(-(i as i32 % 5));
        let is_two_sided = i.is_multiple_of(3);
        match i % 4 {
            0 => {
                let cos_outer = 1.9 * random.next_f32() - 1.0;
                let cos_inner = cos_outer + 0.1 * random.next_f32() * size;
                AnyLight::Spot(SpotLight { position, intensity, direction, cos_inner, cos_outer })
            }
            1 => {
                let v1 = position + direction * size;
                let v2 = position + random.next_3d() * size;
                let shape = Triangle { v0: position, v1, v2 };
                AnyLight::Triangle(AreaLight { shape, radiance, is_two_sided })
            }
            2 => {
                let shape = DiskShape { center: position, normal: direction, radius: size };
                AnyLight::Disk(AreaLight { shape, radiance, is_two_sided })
            }
            _ if is_two_sided => AnyLight::Point(PointLight { position, intensity }),
            _ => {
                let shape = SphereShape { center: position, radius: 0.3 * size };
                AnyLight::Sphere(AreaLight { shape, radiance, is_two_sided })
            }
        }
    }

    /// From the root down to a light that shines at a point every node does.
    #[test]
    fn what_shines_at_a_point_is_never_left_out() {
        let mut random = Rng::new(UVec2::ZERO, 1, 5);
        let mut seen = 0;
        for round in 0..40 {
            // Those of the other rounds are in one place.
            let place = |l: AnyLight| match l {
                AnyLight::Spot(s) if round % 4 == 3 => {
                    AnyLight::Spot(SpotLight { position: Vec3::ONE, ..s })
                }
                other => other,
            };
            let count = [1, 2, 9, 300][round % 4];
            let list: Vec<AnyLight> =
                (0..count).map(|i| place(any_light(&mut random, i))).collect();
            let lit = |(i, l): (usize, &AnyLight)| Lit::new(i as u32, l.extent(), l.power(1.0));
            let lights: Vec<Lit> = list.iter().enumerate().filter_map(lit).collect();
            let tree = LightTree::new(lights, count);
            for k in 0..8000 {
                let (i, u) = (k % count, random.next_2d());
                // Next to the plane of a light is where rounding decides.
                let emitter = list[i].sample(Vec3::splat(0.5), random.next_2d()).end;
                let away = sample_uniform_sphere(random.next_2d());
                let flat = away - emitter.normal * away.dot(emitter.normal);
                let lift = emitter.normal * 10f32.powi(-(k as i32 % 9)) * (u.x - 0.2);
                let position = if k % 2 == 0 {
                    vec3(2.0, 2.0, 2.0) * (random.next_3d() - 0.25)
                } else {
                    emitter.position + (flat + lift) * (0.01 + random.next_f32())
                };
                let sample = list[i].sample(position, u);
                if !(sample.pdf > 0.0 && sample.light != Vec3::ZERO) {
                    continue;
                }
                seen += 1;
                let from = SurfacePoint { position, normal: away, error: 0.0 };
                let (mut at, mut trail) = (0, tree.trails[i]);
                loop {
                    let node = tree.nodes[at];
                    assert!(importance(node, from) > 0.0, "{i} {:?} {node:?} {from:?}", list[i]);
                    if node.child >= LEAF {
                        break;
                    }
                    at = (node.child + (trail & 1)) as usize;
                    trail >>= 1;
                }
            }
        }
        assert!(seen > 100_000, "{seen}");
    }
}
