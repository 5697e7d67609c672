//! The shapes of the library: against closed forms in `f64`, in every variant, in trees, cut.

mod all;
mod cases;
mod exact;
mod harness;
mod subject;

use raydsl::assert_variants_agree;
use raydsl::geometry::SurfacePoint;
use raydsl::prelude::*;
use raydsl_tests::rng::Rng;
use raydsl_tests::scaled;

use harness::square;
use subject::{Ball, Cone, Crate, Disk, Face, Leaf, Panel, Plane, Rod, Subject, Tube};

/// Some primitives, and rays at them.
fn scene<P: Subject>(name: &str) -> (Vec<P>, Vec<(Ray,)>) {
    let mut rng = Rng::of(name);
    let prims: Vec<P> = (0..8)
        .map(|_| {
            let offset = rng.point(2.0);
            P::random(&mut rng, 1.0, offset)
        })
        .collect();
    let rays = (0..scaled(2000))
        .map(|_| {
            let prim = rng.pick(&prims);
            let target = prim.point(square(&mut rng)).position + rng.point(0.5);
            let d = rng.direction();
            (Ray::new(target - d * rng.range(0.0, 4.0), d),)
        })
        .collect();
    (prims, rays)
}

/// The tests of one shape.
macro_rules! shape {
    ($module:ident: $prim:ident) => {
        mod $module {
            use super::*;

            #[test]
            fn hits() {
                harness::hits_are_exact::<$prim>(stringify!($module));
            }

            #[test]
            fn samples() {
                harness::samples_are_uniform::<$prim>(stringify!($module));
            }

            #[test]
            fn degenerate() {
                harness::nothing_is_missed::<$prim>(stringify!($module));
            }

            #[test]
            fn bounces() {
                harness::bounces_leave::<$prim>(stringify!($module));
            }

            #[test]
            fn levels() {
                harness::lanes_agree::<$prim>(stringify!($module));
            }

            #[test]
            fn variants() {
                let (prims, rays) = scene::<$prim>(stringify!($module));
                let prims = &prims[..];
                let shaded = kernel!(|ray: Ray| {
                    let hit = prims.closest_hit(ray);
                    let prim = prims.primitive(hit);
                    if hit.is_hit {
                        (hit.prim_id, hit.t, prim.normal(ray, hit), prim.uv(ray, hit))
                    } else {
                        (100, 0.0, vec3(0.0, 0.0, 0.0), vec2(0.0, 0.0))
                    }
                });
                assert_variants_agree!(&shaded, &rays);
                let first = prims[0];
                let sampled = kernel!(|u: Vec2| {
                    let p: SurfacePoint = first.sample(u);
                    (p.position, p.normal, first.area() * 0.5)
                });
                let mut rng = Rng::of(stringify!($module));
                let points: Vec<(Vec2,)> = (0..scaled(2000)).map(|_| (square(&mut rng),)).collect();
                assert_variants_agree!(&sampled, &points);
            }
        }
    };
}

/// The tests of one that has bounds.
macro_rules! bounded {
    ($module:ident: $prim:ident) => {
        mod $module {
            use super::*;

            #[test]
            fn bounds() {
                harness::bounds_are_tight::<$prim>(stringify!($module));
            }

            #[test]
            fn trees() {
                harness::trees_change_nothing::<$prim>(stringify!($module));
            }
        }
    };
}

shape!(spheres: Ball);
shape!(triangles: Face);
shape!(quads: Leaf);
shape!(rectangles: Panel);
shape!(disks: Disk);
shape!(planes: Plane);
shape!(cylinders: Rod);
shape!(tubes: Tube);
shape!(cones: Cone);
shape!(cuboids: Crate);

bounded!(sphere_bounds: Ball);
bounded!(triangle_bounds: Face);
bounded!(quad_bounds: Leaf);
bounded!(rectangle_bounds: Panel);
bounded!(disk_bounds: Disk);
bounded!(cylinder_bounds: Rod);
bounded!(tube_bounds: Tube);
bounded!(cone_bounds: Cone);
bounded!(cuboid_bounds: Crate);
