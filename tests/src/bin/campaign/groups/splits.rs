//! Primitives that are cut by planes, trees with cut ones, ties, and several hits in order.

use std::slice;

use raydsl::prelude::*;
use raydsl_tests::hard_rays::wide::{D3, minus, plus, wide};
use raydsl_tests::rng::Rng;
use raydsl_tests::scenes;

use super::{closest, fault};
use crate::outcome::{Found, Outcome};
use crate::row::{Bound, Group, Row, Unit};

pub(crate) const GROUP: Group = Group {
    name: "splits",
    title: "Spatial splits, ties, and hits in order",
    clauses: &[
        "The boxes of the two parts of a primitive hold all of it, and keep to their sides of the \
         plane.",
        "A tree with spatial splits gives the bits of one without.",
        "It has no more entries than its setting allows.",
        "Of hits at one distance the first is that of the least id, in any tree.",
        "Several hits come in the order of distance and id, and none is left out.",
    ],
    rows,
};

fn rows() -> Vec<Row> {
    let mut all: Vec<Row> = SHAPES.iter().map(pieces).collect();
    all.extend([same_bits(), entries(), ties(), in_order()]);
    all
}

type Split = Box<dyn Fn(usize, f32) -> (Aabb, Aabb)>;
type Point = Box<dyn Fn(&mut Rng, usize, f32) -> D3>;

/// A primitive, as boxes and points.
struct Solid {
    bounds: Aabb,
    split: Split,
    /// A point of it, or of its convex hull; one in the plane `axis = at` where that says more.
    point: Point,
}

struct Shape {
    name: &'static str,
    /// One of about this size at an offset.
    make: fn(&mut Rng, f32, Vec3) -> Solid,
}

const SHAPES: [Shape; 9] = [
    Shape {
        name: "triangle",
        make: |rng, size, offset| {
            let v = [(); 3].map(|()| offset + rng.point(size));
            Solid {
                bounds: triangle::get_bounds(v[0], v[1], v[2]),
                split: Box::new(move |axis, at| {
                    triangle::split_primitive(axis, at, v[0], v[1], v[2])
                }),
                point: Box::new(move |rng, _, _| of_polygon(rng, &v)),
            }
        },
    },
    Shape {
        name: "sphere",
        make: |rng, size, offset| {
            let (center, radius) = (offset + rng.point(size), size * rng.range(0.0, 2.0));
            Solid {
                bounds: sphere::get_bounds(center, radius),
                split: Box::new(move |axis, at| sphere::split_primitive(axis, at, center, radius)),
                point: Box::new(move |rng, axis, at| of_sphere(rng, center, radius, axis, at)),
            }
        },
    },
    Shape {
        name: "quad",
        make: |rng, size, offset| {
            let (a, u, v) = (offset + rng.point(size), rng.point(size), rng.point(size));
            let skew = if rng.below(2) == 0 { Vec3::ZERO } else { rng.point(size * 0.3) };
            let c = [a, a + u, a + u + v + skew, a + v];
            // It need not be flat: a line between its halves may leave it.
            let half = rng.pick(&[[c[0], c[1], c[3]], [c[2], c[3], c[1]]]);
            Solid {
                bounds: quad::get_bounds(c[0], c[1], c[2], c[3]),
                split: Box::new(move |axis, at| {
                    quad::split_primitive(axis, at, c[0], c[1], c[2], c[3])
                }),
                point: Box::new(move |rng, _, _| of_polygon(rng, &half)),
            }
        },
    },
    Shape {
        name: "rectangle",
        make: |rng, size, offset| {
            let (corner, u, v) = (offset + rng.point(size), rng.point(size), rng.point(size));
            Solid {
                bounds: rectangle::get_bounds(corner, u, v),
                split: Box::new(move |axis, at| rectangle::split_primitive(axis, at, corner, u, v)),
                point: Box::new(move |rng, _, _| {
                    let (s, t) = (share(rng), share(rng));
                    plus(plus(wide(corner), wide(u), s), wide(v), t)
                }),
            }
        },
    },
    Shape {
        name: "disk",
        make: |rng, size, offset| {
            let normal = rng.direction() * rng.pick(&[1e-4, 1.0, 1e4]);
            let (center, radius) = (offset + rng.point(size), size * rng.range(0.1, 1.0));
            Solid {
                bounds: disk::get_bounds(center, normal, radius),
                split: Box::new(move |axis, at| {
                    disk::split_primitive(axis, at, center, normal, radius)
                }),
                point: Box::new(move |rng, _, _| {
                    around(rng, wide(center), wide(normal), radius.into())
                }),
            }
        },
    },
    Shape {
        name: "cylinder",
        make: |rng, size, offset| {
            let (p0, p1, radius) = axis(rng, size, offset);
            Solid {
                bounds: cylinder::get_bounds(p0, p1, radius),
                split: Box::new(move |axis, at| {
                    cylinder::split_primitive(axis, at, p0, p1, radius)
                }),
                point: Box::new(move |rng, _, _| of_cone(rng, p0, p1, [radius, radius])),
            }
        },
    },
    Shape {
        name: "tube",
        make: |rng, size, offset| {
            let (p0, p1, radius) = axis(rng, size, offset);
            Solid {
                bounds: tube::get_bounds(p0, p1, radius),
                split: Box::new(move |axis, at| tube::split_primitive(axis, at, p0, p1, radius)),
                point: Box::new(move |rng, _, _| of_cone(rng, p0, p1, [radius, radius])),
            }
        },
    },
    Shape {
        name: "cone",
        make: |rng, size, offset| {
            let (base, apex, radius) = axis(rng, size, offset);
            Solid {
                bounds: cone::get_bounds(base, apex, radius),
                split: Box::new(move |axis, at| {
                    cone::split_primitive(axis, at, base, apex, radius)
                }),
                point: Box::new(move |rng, _, _| of_cone(rng, base, apex, [radius, 0.0])),
            }
        },
    },
    Shape {
        name: "cuboid",
        make: |rng, size, offset| {
            let (a, b) = (offset + rng.point(size), offset + rng.point(size));
            let (min, max) = (a.min(b), a.max(b));
            Solid {
                bounds: cuboid::get_bounds(min, max),
                split: Box::new(move |axis, at| cuboid::split_primitive(axis, at, min, max)),
                point: Box::new(move |rng, _, _| {
                    let s = [(); 3].map(|()| share(rng));
                    std::array::from_fn(|i| {
                        let (low, high) = (f64::from(min[i]), f64::from(max[i]));
                        low + (high - low) * s[i]
                    })
                }),
            }
        },
    },
];

/// A share from 0 to 1, often one of the ends.
fn share(rng: &mut Rng) -> f64 {
    match rng.below(4) {
        0 => 0.0,
        1 => 1.0,
        _ => f64::from(rng.unit()),
    }
}

/// A corner, or a point inside.
fn of_polygon(rng: &mut Rng, corners: &[Vec3; 3]) -> D3 {
    let [a, b, c] = corners.map(wide);
    let (s, t) = (share(rng), share(rng));
    let inner = plus(b, minus(c, b), t);
    if s == 0.0 { a } else { plus(a, minus(inner, a), s) }
}

/// A point of the circle around an axis, or a pole of it.
fn around(rng: &mut Rng, center: D3, axis: D3, radius: f64) -> D3 {
    let axis = glam::DVec3::from_array(axis).normalize();
    let out = loop {
        let toward = match rng.below(2) {
            // The farthest along an axis of the world.
            0 => glam::DVec3::AXES[rng.below(3)],
            _ => rng.direction().as_dvec3().normalize(),
        };
        // Along the circle's own axis nothing but rounding is left.
        let out = toward - axis * toward.dot(axis);
        if out.length() > 1e-3 {
            break out.normalize() * radius;
        }
    };
    let sign = if rng.below(2) == 0 { 1.0 } else { -1.0 };
    // The last bits of `f64` may lie outside.
    plus(center, out.to_array(), sign * (1.0 - 1e-14))
}

/// A point of one end's rim: what lies between two of them lies between the ends.
fn of_cone(rng: &mut Rng, p0: Vec3, p1: Vec3, radii: [f32; 2]) -> D3 {
    let end = rng.below(2);
    let axis = minus(wide(p1), wide(p0));
    around(rng, wide([p0, p1][end]), axis, radii[end].into())
}

fn axis(rng: &mut Rng, size: f32, offset: Vec3) -> (Vec3, Vec3, f32) {
    let p0 = offset + rng.point(size);
    let way = rng.direction() * (size * rng.range(0.1, 2.0));
    (p0, p0 + way, size * rng.range(0.05, 1.0))
}

/// A pole, a point anywhere, or one of the circle in the plane.
fn of_sphere(rng: &mut Rng, center: Vec3, radius: f32, axis: usize, at: f32) -> D3 {
    let (c, r) = (wide(center), f64::from(radius) * (1.0 - 1e-14));
    let aside = f64::from(at) - c[axis];
    if aside.abs() < r && rng.below(2) == 0 {
        let rim = (r * r - aside * aside).sqrt() * (1.0 - 1e-14);
        let (sin, cos) = match rng.below(2) {
            0 => rng.pick(&[(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)]),
            _ => f64::from(rng.range(0.0, 6.3)).sin_cos(),
        };
        let mut p = c;
        p[axis] = f64::from(at);
        p[(axis + 1) % 3] += rim * cos;
        p[(axis + 2) % 3] += rim * sin;
        return p;
    }
    let toward = match rng.below(2) {
        0 => glam::DVec3::AXES[rng.below(3)] * f64::from(rng.pick(&[1.0f32, -1.0])),
        _ => rng.direction().as_dvec3().normalize(),
    };
    plus(c, toward.to_array(), r)
}

fn pieces(shape: &'static Shape) -> Row {
    let row = Row::new(format!("parts of a {}", shape.name), 1, Unit::Faults, Bound::NONE, |run| {
        Ok(run.on_host(|rng| {
            let size = 10f32.powi(rng.below(7) as i32 - 3);
            let offset = rng.point(1.0) * size * rng.pick(&[0.0, 1.0, 100.0, 1e5]);
            let solid = (shape.make)(rng, size, offset);
            let axis = rng.below(3);
            let (min, max) = (solid.bounds.min[axis], solid.bounds.max[axis]);
            let corner = (solid.point)(rng, axis, 0.0)[axis] as f32;
            let anywhere = rng.range(min, max);
            let at = rng.pick(&[anywhere, min, max, corner]);
            let parts = (solid.split)(axis, at);
            let is_wrong = !keeps_to_its_side(parts, solid.bounds, axis, at)
                || (0..8).any(|_| !holds_points(rng, &solid, parts, axis, at));
            (
                f64::from(u8::from(is_wrong)),
                format!("{size:?} at {offset:?}: {axis} = {at:?}: {parts:?}"),
            )
        }))
    });
    row.share(0.1)
}

fn keeps_to_its_side((below, above): (Aabb, Aabb), whole: Aabb, axis: usize, at: f32) -> bool {
    let is_within = |part: Aabb| !part.is_valid() || part == part.intersection(whole);
    is_within(below)
        && is_within(above)
        && (!below.is_valid() || below.max[axis] <= at)
        && (!above.is_valid() || above.min[axis] >= at)
}

/// Takes two points; also the one between them that is in the plane, if they are on both sides.
fn holds_points(rng: &mut Rng, solid: &Solid, parts: (Aabb, Aabb), axis: usize, at: f32) -> bool {
    let plane = f64::from(at);
    let (a, b) = ((solid.point)(rng, axis, at), (solid.point)(rng, axis, at));
    let mut points = vec![a, b];
    if (a[axis] - plane) * (b[axis] - plane) < 0.0 && solid.bounds.is_valid() {
        let mut between = plus(a, minus(b, a), (plane - a[axis]) / (b[axis] - a[axis]));
        between[axis] = plane;
        points.push(between);
    }
    points.into_iter().all(|p| {
        // Rounding of `f64`, far below an ulp of `f32`.
        let pad = |i: usize| 1e-14 * (p[i].abs() + f64::from(solid.bounds.size().max_element()));
        let holds = |part: Aabb| {
            (0..3).all(|i| {
                let (low, high) = (f64::from(part.min[i]), f64::from(part.max[i]));
                low - pad(i) <= p[i] && p[i] <= high + pad(i)
            })
        };
        let (is_below, is_above) = (p[axis] < plane, p[axis] > plane);
        (is_above || holds(parts.0)) && (is_below || holds(parts.1))
    })
}

/// Long, slanted triangles, which are cut; a third of them twice.
fn slanted() -> Vec<Triangle> {
    let mut rng = Rng::new(21);
    let mut all = scenes::triangles(300);
    all.extend((0..150).map(|_| {
        let v0 = rng.point(5.0);
        Triangle { v0, v1: v0 + rng.point(6.0), v2: v0 + rng.point(0.2) }
    }));
    for i in 0..150 {
        all.push(all[i * 3]);
    }
    all
}

fn best(
    prims: &[Triangle],
    max_duplication: f32,
) -> Result<Bvh<'_, Triangle>, raydsl::bvh::BuildError> {
    let quality = BuildQuality::Best;
    Bvh::build_with(prims, &BuildConfig { quality, max_duplication, ..BuildConfig::default() })
}

fn same_bits() -> Row {
    let row = Row::new("the bits of a tree without", 2, Unit::Faults, Bound::NONE, |run| {
        let prims = slanted();
        let (bvh, cut) = (Bvh::build(&prims)?, best(&prims, 0.5)?);
        if cut.indices().len() == prims.len() {
            return Err("no triangle was cut: the row would say nothing".into());
        }
        let make = |rng: &mut Rng| (scenes::random_ray(rng),);
        let judge = |(ray,): &(Ray,), hit: &Hit| fault(*hit != bvh.closest_hit(*ray));
        closest(&cut, |kernel| run.measure(slice::from_ref(kernel), make, judge))
    });
    row.share(0.5)
}

fn entries() -> Row {
    Row::new("entries over the budget", 3, Unit::Faults, Bound::NONE, |run| {
        let mut all = Found::new("host");
        let sets = [slanted(), scenes::triangles(2000), scenes::triangles(3), Vec::new()];
        for prims in &sets {
            for share in [0.0, 0.01, 0.3, 1.0, 4.0] {
                let entries = best(prims, share)?.indices().len();
                let most = prims.len() + (prims.len() as f64 * f64::from(share)) as usize;
                all.add(run.unit, f64::from(u8::from(entries > most)), || {
                    format!("{entries} of {} with {share}", prims.len())
                });
            }
        }
        Ok(Outcome::host(all))
    })
}

/// Every triangle many times, in an order of no meaning.
fn copies() -> Vec<Triangle> {
    let mut rng = Rng::new(9);
    let few = scenes::triangles(24);
    rng.permutation(8 * few.len()).into_iter().map(|i| few[i % few.len()]).collect()
}

/// All hits in order, by a loop.
fn by_loop(prims: &[Triangle], ray: Ray) -> Vec<Hit> {
    let hits = (0..).zip(prims).map(|(id, one)| Hit { prim_id: id, ..one.intersect(ray) });
    let in_range = |hit: &Hit| hit.is_hit && ray.t_min <= hit.t && hit.t <= ray.t_max;
    let mut all: Vec<Hit> = hits.filter(in_range).collect();
    // Both zeros are one distance.
    all.sort_by(|a, b| (a.t + 0.0).total_cmp(&(b.t + 0.0)).then(a.prim_id.cmp(&b.prim_id)));
    all
}

fn ties() -> Row {
    let row = Row::new("eight of each triangle", 4, Unit::Faults, Bound::NONE, |run| {
        let prims = copies();
        let (plain, cut) = (Bvh::build(&prims)?, best(&prims, 0.5)?);
        let make = |rng: &mut Rng| (scenes::random_ray(rng),);
        let judge = |(ray,): &(Ray,), hit: &Hit| {
            let first = by_loop(&prims, *ray).first().copied();
            fault(*hit != first.unwrap_or(Hit::miss()))
        };
        let mut all = Outcome::default();
        for (part, bvh) in [(0, &plain), (1, &cut)] {
            let part = run.part(0.5, part);
            all.merge(
                run.unit,
                closest(bvh, |kernel| part.measure(slice::from_ref(kernel), make, judge))?,
            );
        }
        Ok(all)
    });
    row.share(0.1)
}

fn in_order() -> Row {
    let row = Row::new("the first four hits", 5, Unit::Faults, Bound::NONE, |run| {
        let prims = copies();
        let cut = best(&prims, 0.5)?;
        let kernel = kernel!(|ray: Ray| cut.multi_hit::<4>(ray));
        let make = |rng: &mut Rng| (scenes::random_ray(rng),);
        run.measure(&[kernel], make, |(ray,), hits| {
            let all = by_loop(&prims, *ray);
            let at = |i: usize| all.get(i).copied().unwrap_or(Hit::miss());
            fault(*hits != [0, 1, 2, 3].map(at))
        })
    });
    row.share(0.1)
}
