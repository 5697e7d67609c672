//! Shared rules of every query: the validity of rays and hits, the order of hits, the culling
//! distance behind a hit, and the box test.
//!
//! Each rule is a kernel; those that do not depend on trees are in `geometry::slabs`. Single-ray
//! traversal calls the function; packets, WGSL and the rounding bounds run its lifted body. These
//! places have their own box arithmetic:
//!
//! * [`SiblingSlabs`]: the two boxes of siblings side by side in registers;
//! * `packet_slabs`: a node's planes are the same for all lanes;
//! * `wide::rays`, `wide::step` and `wide::packet`: planes are multiplied before the origin is
//!   subtracted, one multiply-add each, which takes more padding;
//! * `wide::beam`: intervals of many rays, in the same form;
//! * `on::beam`: in `f64`, with bounds.
//!
//! **Boxes.** A box test must never lose a hit that `intersect` accepts. The ray's origin is moved
//! apart by a padding, once a ray: lower faces are measured from the upper origin and vice versa.
//! That widens every box by `SLACK` times the distance to the farthest corner of the scene and
//! absorbs all rounding, at no cost in the loop. A direction component that is 0, or 2^60 times
//! smaller than the largest, is replaced by one of that size: its reciprocal is finite, so no
//! product is NaN, and the widened slab decides alone. (After Ize, "Robust BVH Ray Traversal", JCGT
//! 2013.)

use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};

use super::Node;
use crate::geometry::slabs::largest;
pub(crate) use crate::geometry::slabs::{finite_inverse, is_finite, overlap};
use crate::geometry::{Hit, Primitive, Ray};
use crate::machine::generic::{max, min};
use crate::machine::margin::{Interval, Known};
use crate::machine::{Kinds, KnownFunction, Margin, WithoutNan};
use crate::{Type, kernel};

/// 2^-23: an ulp of a number is at most this fraction of it.
pub(crate) const ULP: f32 = f32::EPSILON;

/// Returns whether a hit lies within the range of its ray.
#[kernel]
#[inline(always)]
pub(crate) fn is_within(hit: Hit, ray: Ray) -> bool {
    hit.is_hit & ((hit.t >= ray.t_min) & (hit.t <= ray.t_max))
}

/// Returns whether a hit comes before another in the order of `(t, inst_id, prim_id)`. Without
/// instances, all instance ids are 0 and are not compared.
#[kernel]
#[inline(always)]
pub(crate) fn precedes(#[host] is_placed: bool, hit: Hit, other: Hit) -> bool {
    let mut is_first = hit.prim_id < other.prim_id;
    if is_placed {
        is_first = (hit.inst_id < other.inst_id) | ((hit.inst_id == other.inst_id) & is_first);
    }
    (hit.t < other.t) | ((hit.t == other.t) & is_first)
}

/// Returns whether a hit comes before `best`; any comes before a miss.
#[kernel]
#[inline(always)]
pub(crate) fn is_before(#[host] is_placed: bool, hit: Hit, best: Hit) -> bool {
    !best.is_hit | precedes(is_placed, hit, best)
}

/// Returns the distance up to which boxes may hold a hit that precedes one at `t`, of a ray that
/// ends at `t_max`: rounding may change a hit, but must not cull it. See [`Primitive::SLACK`].
#[kernel]
#[inline(always)]
pub(crate) fn limit_behind(t: f32, slack: f32, t_max: f32) -> f32 {
    // In this order NaN becomes the ray's end.
    min(t_max, t + t.abs() * slack)
}

/// Returns the smallest distance greater than `t`, at which the next crossing of a primitive is
/// searched. Distances nearer to 0 than the smallest normal number count as one: a device may flush
/// them to 0.
#[kernel(known = Behind)]
#[inline(always)]
pub(crate) fn behind(t: f32) -> f32 {
    let is_small = t.abs() < f32::MIN_POSITIVE;
    let bits = t.to_bits();
    let next = f32::from_bits(if t > 0.0 { bits.wrapping_add(1) } else { bits.wrapping_sub(1) });
    if is_small { f32::MIN_POSITIVE } else { next }
}

/// Rounding bounds of [`behind()`], where its bit arithmetic says nothing.
#[derive(Debug)]
struct Behind;

impl KnownFunction for Behind {
    fn bound(&self, m: &Margin, args: &[Known]) -> Option<Vec<Known>> {
        let range = args[0].range;
        let next = |t: f64| f64::from(behind(t as f32)).max(t);
        // A device may flush to 0 anything smaller than the smallest normal number.
        let high = match next(range.high) {
            high if high < 0.0 && high > -f64::from(f32::MIN_POSITIVE) => 0.0,
            high => high,
        };
        let range = Interval::new(range.low, high, range.may_break());
        Some(vec![m.bounded(next(args[0].value), range)])
    }
}

/// Padding of boxes: makes them hold the rounded hits of the primitives in them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Padding {
    /// Relative to the distance from the ray's origin to the farthest corner of the scene: see
    /// [`Primitive::SLACK`].
    pub(crate) slack: f32,
    /// Relative to the coordinates of the ray's origin.
    pub(crate) origin: f32,
}

impl Padding {
    /// Returns the padding of a tree over these primitives.
    #[inline(always)]
    pub(crate) const fn of<P: Primitive>() -> Self {
        Self::with(P::SLACK)
    }

    /// Returns that of a tree in which they are of these kinds alone.
    pub(crate) fn among<P: Primitive>(kinds: Kinds) -> Self {
        Self::with(P::limits_of(kinds).0)
    }

    #[inline(always)]
    const fn with(slack: f32) -> Self {
        // Not 0: a distance that overflows makes the padding infinite, and not a NaN.
        let slack = if slack > 0.0 { slack } else { f32::MIN_POSITIVE };
        Self { slack, origin: 0.0 }
    }
}

/// Ray prepared for box tests: the origins for upper and lower faces, and finite reciprocals of the
/// direction.
#[derive(Clone, Copy, Debug, Type)]
pub(crate) struct Slabs {
    pub(crate) lower: Vec3,
    pub(crate) upper: Vec3,
    pub(crate) inverse: Vec3,
}

impl Slabs {
    /// Prepares one ray for the tree under `root`, with [`slabs()`].
    #[inline(always)]
    pub(crate) fn of(ray: &Ray, root: &Node, padding: Padding) -> Self {
        slabs(padding.origin != 0.0, *ray, root.min, root.max, padding.slack, padding.origin)
    }

    /// Returns the distance at which the ray, from `t_min` on, enters a node's box, if at or before
    /// `limit`.
    #[inline(always)]
    pub(crate) fn enter(&self, node: &Node, t_min: f32, limit: f32) -> Option<f32> {
        let span = enter_leave(*self, node.min, node.max, t_min, limit);
        (span.x <= span.y).then_some(span.x)
    }
}

/// [`Slabs`] in registers of four numbers, for the boxes of two siblings at a time: a single ray
/// tests them with half the instructions. Its results are those of [`enter_leave`], but for the sign
/// of 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SiblingSlabs {
    lower: Vec4,
    upper: Vec4,
    inverse: Vec4,
}

impl SiblingSlabs {
    #[inline(always)]
    pub(crate) fn of(slabs: &Slabs) -> Self {
        // The last numbers belong to no axis, and nobody reads their results. Nodes have integers
        // there, which are denormal as floats and slow to multiply: a difference from 1 is not.
        Self {
            lower: slabs.lower.extend(1.0),
            upper: slabs.upper.extend(1.0),
            inverse: slabs.inverse.extend(0.0),
        }
    }

    /// Returns the distances at which the ray enters the boxes of two nodes, and those at which it
    /// leaves them, as [`enter_leave`] does.
    #[inline(always)]
    pub(crate) fn spans(&self, pair: [&Node; 2], t_min: f32, t_max: f32) -> [[f32; 2]; 2] {
        let slabs = |node: &Node| {
            let [low, high] = bytemuck::cast::<Node, [[f32; 4]; 2]>(*node);
            let a = (Vec4::from_array(low) - self.lower) * self.inverse;
            let b = (Vec4::from_array(high) - self.upper) * self.inverse;
            (a.min(b), a.max(b))
        };
        let ((a, a_far), (b, b_far)) = (slabs(pair[0]), slabs(pair[1]));
        // The boxes side by side, two axes at a time; the range of the ray is the fourth axis.
        let near = Vec4::new(a.x, b.x, a.y, b.y).max(Vec4::new(a.z, b.z, t_min, t_min));
        let far = Vec4::new(a_far.x, b_far.x, a_far.y, b_far.y);
        let far = far.min(Vec4::new(a_far.z, b_far.z, t_max, t_max));
        let (near, far) = (near.max(near.zwzw()), far.min(far.zwzw()));
        [[near.x, near.y], [far.x, far.y]]
    }
}

/// Prepares a ray for the tree whose root has the corners `low` and `high`, with a [`Padding`];
/// `origin` is ignored unless the tree `is_placed`.
#[kernel(known = WithoutNan)]
#[inline(always)]
pub(crate) fn slabs(
    #[host] is_placed: bool,
    ray: Ray,
    low: Vec3,
    high: Vec3,
    slack: f32,
    origin: f32,
) -> Slabs {
    let reach = max((low - ray.origin).abs(), (high - ray.origin).abs());
    let mut padding = max(slack * largest(reach), f32::MIN_POSITIVE);
    let distant = ray.origin.abs();
    if is_placed {
        padding += largest(distant) * origin;
    }
    // Where the origin is large against the scene, the padding must still move it.
    let padding = distant * ULP + padding;
    Slabs {
        lower: ray.origin + padding,
        upper: ray.origin - padding,
        inverse: finite_inverse(ray.direction),
    }
}

/// Returns the distances at which a ray enters a box, not before `t_min`, and leaves it, not behind
/// `t_max`: it hits the box if the first is not greater than the second.
#[kernel(known = WithoutNan)]
#[inline(always)]
pub(crate) fn enter_leave(s: Slabs, low: Vec3, high: Vec3, t_min: f32, t_max: f32) -> Vec2 {
    let a = (low - s.lower) * s.inverse;
    let b = (high - s.upper) * s.inverse;
    overlap(min(a, b), max(a, b), t_min, t_max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::Rng;
    use glam::uvec2;

    /// Distances of every size and sign.
    fn distances() -> impl Iterator<Item = f32> {
        let sizes = (-140..128).map(|e| 1.375 * 2f32.powi(e));
        sizes.flat_map(|t| [t, -t]).chain([0.0, -0.0, 1.0, -1.0, f32::MAX, f32::MIN_POSITIVE])
    }

    #[test]
    fn the_next_distance_is_the_next_number() {
        for t in distances().filter(|t| t.abs() > f32::MIN_POSITIVE && *t < f32::MAX) {
            assert_eq!(behind(t), t.next_up(), "{t}");
        }
        for t in distances().filter(|t| t.abs() < f32::MIN_POSITIVE) {
            assert_eq!(behind(t), f32::MIN_POSITIVE, "{t}");
        }
    }

    /// Whatever integers the nodes hold.
    #[test]
    fn siblings_are_entered_and_left_where_each_box_is() {
        let mut rng = Rng::new(uvec2(1, 2), 3, 4);
        let mut entered = 0;
        for i in 0..20_000u32 {
            let mut node = |bits: u32| {
                let (a, b) = (rng.next_3d(), rng.next_3d());
                Node { min: a.min(b), first: bits, max: a.max(b), count: !bits }
            };
            // Denormals, infinities and NaNs among others.
            let pair = [node(i), node(i.wrapping_mul(0x9e37_79b9) | 0x7f80_0000)];
            // Most rays go through the first box.
            let at = pair[0].min + (pair[0].max - pair[0].min) * rng.next_3d();
            let origin = 2.0 * rng.next_3d() - 0.5;
            let mut direction = at - origin;
            if i % 4 == 0 {
                direction.x = 0.0;
            }
            let ray = Ray::new(origin, direction);
            let root = Node::inner(pair[0].bounds().union(pair[1].bounds()), 1);
            let slabs = Slabs::of(&ray, &root, Padding { slack: 1e-6, origin: 0.0 });
            let (t_min, t_max) = (0.1 * rng.next_f32(), 2.0 * rng.next_f32());
            let [enters, leaves] =
                SiblingSlabs::of(&slabs).spans([&pair[0], &pair[1]], t_min, t_max);
            for (k, node) in pair.iter().enumerate() {
                let span = enter_leave(slabs, node.min, node.max, t_min, t_max);
                assert_eq!((enters[k], leaves[k]), (span.x, span.y), "{ray:?} {node:?}");
                entered += u32::from(span.x <= span.y);
            }
        }
        assert!((5_000..35_000).contains(&entered), "{entered}");
    }

    #[test]
    fn the_limit_lies_behind_a_hit_by_its_slack() {
        for t in distances().filter(|t| t.abs() > 1e-30 && t.abs() < 1e30) {
            for slack in [0.0, 1e-6, 0.25] {
                let exact = f64::from(t) + f64::from(t).abs() * f64::from(slack);
                let found = f64::from(limit_behind(t, slack, f32::INFINITY));
                assert!((found - exact).abs() <= f64::from(t).abs() * 1.2e-7, "{t} {slack}");
                assert!(slack < 1e-7 || found > f64::from(t), "{t} {slack}");
            }
            assert_eq!(limit_behind(t, 0.5, t), t, "the ray's end is the limit");
        }
        assert_eq!(limit_behind(f32::NAN, 0.5, 3.0), 3.0);
    }
}
