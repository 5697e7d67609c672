//! What the robust box test costs: the same walk with the test that textbooks have.

use raydsl::bvh::Node;
use raydsl::prelude::*;

/// The reciprocals of a direction, with infinities where it has zeros.
struct Plain {
    origin: Vec3,
    inverse: Vec3,
    t_min: f32,
}

impl Plain {
    /// Where the ray enters the box, if it does before `limit`: nothing is widened.
    fn enter(&self, node: &Node, limit: f32) -> Option<f32> {
        let t0 = (node.min - self.origin) * self.inverse;
        let t1 = (node.max - self.origin) * self.inverse;
        let near = t0.min(t1).max_element().max(self.t_min);
        let far = t0.max(t1).min_element().min(limit);
        (near <= far).then_some(near)
    }
}

/// The nodes that the closest hit of `ray` visits, in the order of the library's scalar walk, if
/// boxes are tested by IEEE arithmetic alone and nothing is allowed for rounding.
fn plain_visits<P: Primitive<Hit = Hit, Shared = ()>>(bvh: &Bvh<'_, P>, ray: &Ray) -> u32 {
    let (nodes, indices, prims) = (bvh.nodes(), bvh.indices(), bvh.primitives());
    let Some(root) = nodes.first() else { return 0 };
    let boxes = Plain { origin: ray.origin, inverse: ray.direction.recip(), t_min: ray.t_min };
    let mut limit = ray.t_max;
    let mut visits = 1;
    let mut stack: Vec<(u32, f32)> =
        boxes.enter(root, limit).map(|enter| (0, enter)).into_iter().collect();
    while let Some((at, enter)) = stack.pop() {
        if enter > limit {
            continue;
        }
        let node = &nodes[at as usize];
        if node.is_leaf() {
            for &id in &indices[node.first as usize..][..node.count as usize] {
                let hit = prims[id as usize].intersect(*ray, &[]);
                if hit.is_hit && hit.t >= ray.t_min && hit.t < limit {
                    limit = hit.t;
                }
            }
            continue;
        }
        visits += 2;
        let entered = [node.first, node.first + 1]
            .map(|child| boxes.enter(&nodes[child as usize], limit).map(|enter| (child, enter)));
        match entered {
            [Some(left), Some(right)] => {
                // The nearer one is on top.
                let is_right_nearer = right.1 < left.1;
                let (near, far) = if is_right_nearer { (right, left) } else { (left, right) };
                stack.extend([far, near]);
            }
            [one, other] => stack.extend(one.or(other)),
        }
    }
    visits
}

/// The nodes that the library visits for these rays, and how many the textbook's test does.
pub(crate) fn visits<P: Primitive<Hit = Hit, Shared = ()>>(
    bvh: &Bvh<'_, P>,
    rays: &[Ray],
) -> (u64, u64) {
    let robust = rays.iter().map(|ray| u64::from(bvh.closest_hit_with_cost(*ray).1.nodes)).sum();
    let plain = rays.iter().map(|ray| u64::from(plain_visits(bvh, ray))).sum();
    (robust, plain)
}
