//! Scenes of instances, asked without a tree.

use raydsl::bvh::Object;
use raydsl::prelude::*;

/// A tree of the scene, and the maps to it, the outermost first.
pub struct Placed<'a, P: Primitive> {
    /// The tree.
    pub tree: &'a Bvh<'a, P>,
    /// The number of its first primitive.
    pub first: u32,
    /// From each space to the next.
    pub maps: Vec<Affine3>,
}

/// Every placed tree in the order of its number, of a scene whose last group was made of `top`.
pub fn unfold<'a, P: Primitive>(
    scene: &Instances<'_, P>,
    trees: &'a [Bvh<'a, P>],
    top: &[Instance],
) -> Vec<Placed<'a, P>> {
    let mut all = Vec::new();
    unfold_group(scene, trees, top, &[], &mut all);
    all
}

fn unfold_group<'a, P: Primitive>(
    scene: &Instances<'_, P>,
    trees: &'a [Bvh<'a, P>],
    group: &[Instance],
    outer: &[Affine3],
    all: &mut Vec<Placed<'a, P>>,
) {
    for instance in group {
        let maps = [outer, &[inverse_of(instance.to_outer)]].concat();
        match instance.object {
            Object::Tree(tree) => {
                let first = scene.first_of(tree);
                all.push(Placed { tree: &trees[tree], first, maps });
            }
            Object::Group(group) => {
                unfold_group(scene, trees, scene.instances_of(group), &maps, all);
            }
        }
    }
}

/// As a scene inverts it: in `f64`, rounded once.
fn inverse_of(map: Affine3) -> Affine3 {
    let m = map.matrix3;
    let [x, y, z, w] = [m.x_axis, m.y_axis, m.z_axis, map.translation].map(|v| v.as_dvec3());
    let inverse = glam::DAffine3::from_cols(x, y, z, w).inverse();
    Affine3::from_cols_array(&inverse.to_cols_array().map(|x| x as f32))
}

/// All hits in order, by asking every primitive of every instance.
pub fn brute_force<P: Primitive<Hit = Hit, Shared = ()>>(
    placed: &[Placed<'_, P>],
    ray: Ray,
) -> Vec<Hit> {
    let mut hits = Vec::new();
    if !(ray.origin.is_finite() && ray.direction.is_finite()) {
        return hits;
    }
    for (inst, placed) in placed.iter().enumerate() {
        let local = placed.maps.iter().fold(ray, |ray, map| transform_ray(ray, *map));
        for (id, prim) in placed.tree.primitives().iter().enumerate() {
            let hit = prim.intersect(local, &[]);
            if hit.is_hit && hit.t >= ray.t_min && hit.t <= ray.t_max {
                let (inst_id, prim_id) = (inst as u32, placed.first + id as u32);
                hits.push(Hit { inst_id, prim_id, ..hit });
            }
        }
    }
    hits.sort_by(|a, b| {
        // Zeros of either sign are one distance.
        let nearer = (a.t + 0.0).total_cmp(&(b.t + 0.0));
        nearer.then((a.inst_id, a.prim_id).cmp(&(b.inst_id, b.prim_id)))
    });
    hits
}
