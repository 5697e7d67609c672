//! Three primitives and two kernels of a crate that calls raydsl `rt`.
//!
//! The macros write `::raydsl`; the next line says who that is.

extern crate rt as raydsl;

use rt::kernel;
use rt::prelude::*;

/// A ring around the z axis.
#[primitive]
#[derive(Debug)]
pub struct Torus {
    /// Its middle.
    pub center: Vec3,
    /// From the middle to the middle of the tube.
    pub major: f32,
    /// The radius of the tube.
    pub minor: f32,
}

/// How far `p` is from the ring's surface; negative inside.
#[kernel]
fn distance_to_ring(p: Vec3, major: f32, minor: f32) -> f32 {
    let aside = (p.x * p.x + p.y * p.y).sqrt() - major;
    (aside * aside + p.z * p.z).sqrt() - minor
}

#[primitive]
impl Torus {
    /// Sphere tracing (Hart, 1996) through the sphere around the ring.
    fn intersect(&self, ray: Ray) -> Hit {
        let reach = self.major + self.minor;
        let scale = 1.0 / ray.direction.dot(ray.direction).sqrt();
        let d = ray.direction * scale;
        let o = ray.origin - self.center;
        let along = -o.dot(d);
        let aside = o + d * along;
        let square = reach * reach * 1.0001 - aside.dot(aside);
        if square < 0.0 || self.minor <= 0.0 {
            return Hit::miss();
        }
        let half = square.sqrt();
        // From the nearest point of the sphere, so that no digits are lost on the way to it.
        let mut way = max(-half, ray.t_min / scale - along);
        let mut gone = false;
        for _ in 0u32..200 {
            let step = distance_to_ring(aside + d * way, self.major, self.minor).abs();
            if step < 1e-6 * reach {
                gone = true;
                break;
            }
            way += step;
            if way > half {
                break;
            }
        }
        Hit::new(gone, (way + along) * scale)
    }

    fn get_bounds(&self) -> Aabb {
        let reach = self.major + self.minor;
        let size = vec3(reach, reach, self.minor) * 1.00001;
        Aabb::new(self.center - size, self.center + size)
    }
}

/// A cube of a grid.
#[primitive]
#[derive(Debug)]
pub struct Voxel {
    /// Its place in the grid.
    pub x: u32,
    /// Its place in the grid.
    pub y: u32,
    /// Its place in the grid.
    pub z: u32,
    /// How dense it is.
    pub density: f32,
}

/// What a ray finds in a grid.
#[derive(Clone, Copy, Debug, PartialEq, Type, HitRecord)]
pub struct Crossing {
    /// Where it enters.
    pub hit: Hit,
    /// Where it leaves.
    pub leaves: f32,
    /// The integral of the density along the way.
    pub depth: f32,
}

#[primitive]
impl Voxel {
    fn intersect(&self, ray: Ray) -> Crossing {
        let low = vec3(self.x as f32, self.y as f32, self.z as f32);
        let a = (low - ray.origin) / ray.direction;
        let b = (low + 1.0 - ray.origin) / ray.direction;
        let (near, far) = (min(a, b), max(a, b));
        let enters = max(max(near.x, near.y), max(near.z, ray.t_min));
        let leaves = min(min(far.x, far.y), far.z);
        let hit = Hit::new(enters <= leaves, enters);
        Crossing { hit, leaves, depth: (leaves - enters) * self.density }
    }

    fn get_bounds(&self) -> Aabb {
        let low = vec3(self.x as f32, self.y as f32, self.z as f32);
        Aabb::new(low, low + 1.0)
    }
}

/// A ball by the library's shape, with members in an order of its own.
#[primitive(sphere(at, size * 0.5))]
#[derive(Debug)]
pub struct Marble {
    /// Its diameter.
    pub size: f32,
    /// Where it is.
    pub at: Vec3,
}

/// Light from above on rings.
#[kernel]
pub fn lit(rings: &Bvh<Torus>, ray: Ray) -> f32 {
    let hit = rings.closest_hit(ray);
    if !hit.is_hit {
        return 0.0;
    }
    let p = ray.at(hit.t) + vec3(0.0, 1e-3, 0.0);
    let dark = rings.any_hit(Ray::new(p, Vec3::Y).with_range(0.01, 10.0));
    if dark { 0.2 } else { 1.0 }
}

/// What is seen through the first voxels behind a marble.
#[kernel]
pub fn seen(marbles: &[Marble], voxels: &Bvh<Voxel>, ray: Ray) -> f32 {
    let first = marbles.closest_hit(ray);
    let start = if first.is_hit { first.t } else { 0.0 };
    let crossing = voxels.closest_hit(ray.with_range(start, ray.t_max));
    if crossing.hit.is_hit { exp(-crossing.depth) } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use rt::assert_variants_agree;
    use rt::prelude::*;

    use super::{Marble, Torus, Voxel, lit, seen};

    fn rays() -> Vec<(Ray,)> {
        let share = |i: u32, n: u32| (i * n % 1009) as f32 / 1009.0 - 0.5;
        (0..2000)
            .map(|i| {
                let origin = vec3(8.0 * share(i, 7), 8.0 * share(i, 31), 6.0);
                (Ray::new(origin, vec3(share(i, 17), share(i, 101), -1.0)),)
            })
            .collect()
    }

    /// The two nearest roots of the quartic, computed elsewhere with forty digits.
    #[test]
    fn a_ring_is_where_its_quartic_says() {
        let ring = Torus { center: Vec3::ZERO, major: 2.0, minor: 0.5 };
        let ray = Ray::new(vec3(0.25, 0.125, 4.0), vec3(0.375, 0.0625, -1.0));
        for (after, root) in [(0.0, 3.639_993_7), (3.7, 4.499_578_4)] {
            let hit = ring.intersect(ray.with_range(after, 100.0));
            assert!(hit.is_hit && (hit.t - root as f32).abs() < 1e-5, "{hit:?}, {root}");
        }
    }

    #[test]
    fn rings_agree() {
        let rings: Vec<Torus> = (0..20)
            .map(|i| Torus {
                center: vec3((i % 5) as f32 - 2.0, (i / 5) as f32 - 2.0, 0.1 * i as f32),
                major: 0.5,
                minor: 0.12,
            })
            .collect();
        let bvh = Bvh::build(&rings).expect("finite bounds");
        let rays = rays();
        assert!(rays.iter().filter(|(r,)| bvh.any_hit(*r)).count() > 100);
        let kernel = kernel!(|ray: Ray| lit(&bvh, ray));
        assert_variants_agree!(&kernel, &rays);
    }

    #[test]
    fn marbles_and_voxels_agree() {
        let voxels: Vec<Voxel> = (0..64)
            .map(|i| Voxel { x: i % 4, y: i / 4 % 4, z: i / 16, density: 0.1 * i as f32 })
            .collect();
        let marbles =
            [1.0, 2.0, 3.0].map(|x| Marble { size: 0.8, at: vec3(x - 2.0, 0.5 * x, 4.5) });
        let (bvh, marbles) = (Bvh::build(&voxels).expect("finite bounds"), &marbles[..]);
        let kernel = kernel!(|ray: Ray| seen(marbles, &bvh, ray));
        assert_variants_agree!(&kernel, &rays());
    }
}
