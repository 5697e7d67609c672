//! Parts of rays inside and outside of closed objects, against `f64`.

use raydsl::geometry::IndexedTriangle;
use raydsl::prelude::*;
use raydsl::shading::{Mesh, MeshAttributes, Surface};
use raydsl::volume::{
    Cut, ExactCell, Grid, GridConfig, MeshError, TransferFunction, Volume, VolumeLight,
    check_closed, is_inside,
};
use raydsl::{assert_variants_agree, kernel, testing};
use raydsl_tests::rng::Rng;
use raydsl_tests::scaled;

use super::agreement::assert_close;

#[primitive(sphere(center, radius))]
pub(crate) struct Ball {
    pub(crate) center: Vec3,
    pub(crate) radius: f32,
}

#[kernel]
impl Surface for Ball {
    fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
        self.surface_point(ray, hit)
    }

    fn albedo(&self, _ray: Ray, _hit: Hit) -> Vec3 {
        Vec3::ONE
    }
}

/// Half of space: all that is behind a plane.
#[primitive(plane(normal, offset))]
struct Half {
    normal: Vec3,
    offset: f32,
}

#[kernel]
impl Surface for Half {
    fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
        self.surface_point(ray, hit)
    }

    fn albedo(&self, _ray: Ray, _hit: Hit) -> Vec3 {
        Vec3::ONE
    }
}

/// Lengths inside and outside of the objects, and how many parts each has.
#[kernel]
fn parts<S: Scene + ?Sized>(scene: &S, ray: Ray) -> (f32, f32, u32, u32) {
    let (mut inside, mut outside) = (0.0, 0.0);
    let (mut inner, mut outer) = (0u32, 0u32);
    let mut cut = Cut::new(scene, ray);
    while let Some(part) = cut.next_inside(scene) {
        inside += part.t_max - part.t_min;
        inner += 1;
    }
    let mut cut = Cut::new(scene, ray);
    while let Some(part) = cut.next_outside(scene) {
        outside += part.t_max - part.t_min;
        outer += 1;
    }
    (inside, outside, inner, outer)
}

/// The union of intervals in `f64`, within a range: its parts.
fn union(mut intervals: Vec<(f64, f64)>, range: (f64, f64)) -> Vec<(f64, f64)> {
    intervals.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut all: Vec<(f64, f64)> = Vec::new();
    for (a, b) in intervals {
        let (a, b) = (a.max(range.0), b.min(range.1));
        if a >= b {
            continue;
        }
        match all.last_mut() {
            Some(last) if a <= last.1 => last.1 = last.1.max(b),
            _ => all.push((a, b)),
        }
    }
    all
}

fn through_ball(ball: &Ball, ray: Ray) -> Option<(f64, f64)> {
    let (o, d) = (ray.origin.as_dvec3() - ball.center.as_dvec3(), ray.direction.as_dvec3());
    let (a, b) = (d.dot(d), o.dot(d));
    let nearest = o - d * (b / a);
    let radicand = f64::from(ball.radius).powi(2) - nearest.length_squared();
    let half = (radicand.max(0.0) / a).sqrt();
    (radicand > 0.0).then_some((-b / a - half, -b / a + half))
}

#[test]
fn balls_are_cut_where_they_are() {
    let ball = |x: f32, y: f32, z: f32, radius| Ball { center: vec3(x, y, z), radius };
    let mut balls = vec![
        // One in another, two that touch, two that are one, and some more.
        ball(0.0, 0.0, 0.0, 1.0),
        ball(0.25, 0.0, 0.0, 0.5),
        ball(2.0, 0.0, 0.0, 1.0),
        ball(-3.0, 0.5, 0.0, 0.75),
        ball(-3.0, 0.5, 0.0, 0.75),
    ];
    let mut rng = Rng::of("balls");
    balls.extend((0..12).map(|_| Ball { center: rng.point(4.0), radius: rng.range(0.2, 1.5) }));
    let tree = Bvh::build(&balls).expect("finite bounds");
    let rays: Vec<(Ray,)> = (0..scaled(2000))
        .map(|i| {
            let origin = rng.point(if i % 3 == 0 { 2.0 } else { 9.0 });
            let target =
                if i % 2 == 0 { rng.pick(&[0usize, 1, 2, 3]) } else { rng.below(balls.len()) };
            let direction = balls[target].center + rng.point(1.0) - origin;
            let ray = Ray::new(origin, direction);
            (if i % 5 == 0 { ray.with_range(0.3, 1.1) } else { ray.with_range(0.0, 50.0) },)
        })
        .collect();
    let kernel = kernel!(|ray: Ray| parts(&tree, ray));
    for &(ray,) in &rays {
        let range = (f64::from(ray.t_min), f64::from(ray.t_max));
        let all = balls.iter().filter_map(|ball| through_ball(ball, ray)).collect();
        let expected = union(all, range);
        let length: f64 = expected.iter().map(|p| p.1 - p.0).sum();
        let (inside, outside, ..) = kernel.call((ray,));
        let off = (f64::from(inside) - length).abs();
        // Grazing rays cross where rounding moves much: half chords below 1e-3 are off by more.
        assert!(off < 2e-3, "{ray:?}: {inside}, not {length}");
        let whole = f64::from(inside) + f64::from(outside);
        assert!((whole - (range.1 - range.0)).abs() < 1e-4, "{ray:?}: {inside} and {outside}");
    }
    assert_variants_agree!(&kernel, &rays[..rays.len().min(2000) / 4]);
}

/// A ball of triangles around the origin, wound anticlockwise from outside.
fn icosphere(levels: u32) -> (Vec<Vec3>, Vec<IndexedTriangle>) {
    let mut vertices = vec![Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z];
    let mut faces = Vec::new();
    for x in [0u32, 1] {
        for y in [2u32, 3] {
            for z in [4u32, 5] {
                let turned = (x + y + z) % 2 == 1;
                faces.push(if turned { [x, z, y] } else { [x, y, z] });
            }
        }
    }
    for _ in 0..levels {
        let mut middle = std::collections::HashMap::new();
        let mut split = Vec::new();
        for [a, b, c] in faces {
            let mut between = |a: u32, b: u32| {
                *middle.entry((a.min(b), a.max(b))).or_insert_with(|| {
                    let sum = vertices[a as usize] + vertices[b as usize];
                    vertices.push(sum.normalize());
                    vertices.len() as u32 - 1
                })
            };
            let (ab, bc, ca) = (between(a, b), between(b, c), between(c, a));
            split.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        faces = split;
    }
    (vertices, faces.into_iter().map(|vertices| IndexedTriangle { vertices }).collect())
}

/// The number of times that the mesh winds around a point: the sum of solid angles over 4 pi. (Van
/// Oosterom and Strackee, "The Solid Angle of a Plane Triangle", 1983.)
fn winding(vertices: &[Vec3], triangles: &[IndexedTriangle], p: glam::DVec3) -> f64 {
    let sum: f64 = triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.vertices.map(|i| vertices[i as usize].as_dvec3() - p);
            let (x, y, z) = (a.length(), b.length(), c.length());
            let over = a.dot(b.cross(c));
            let under = x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y;
            2.0 * over.atan2(under)
        })
        .sum();
    sum / (4.0 * std::f64::consts::PI)
}

#[test]
fn meshes_are_cut_at_edges_and_vertices() {
    let (vertices, triangles) = icosphere(2);
    assert_eq!(winding(&vertices, &triangles, glam::DVec3::ZERO).round(), 1.0);
    let corners = |t: &IndexedTriangle| t.vertices.map(|i| vertices[i as usize]);
    assert_eq!(check_closed(triangles.iter().map(corners)), Ok(()));
    let tree = Bvh::build_sharing(&triangles, &vertices, &BuildConfig::default()).expect("a tree");
    let mesh = Mesh::new(&tree, MeshAttributes::default()).expect("no attributes");
    let mut rng = Rng::of("edges");
    let mut rays = Vec::new();
    for i in 0..scaled(4000) {
        let triangle = &triangles[rng.below(triangles.len())];
        let [a, b, _] = triangle.vertices.map(|i| vertices[i as usize]);
        let origin = match i % 4 {
            0 => rng.pick(&[Vec3::X, Vec3::Y, Vec3::Z]) * rng.pick(&[-2.0, 2.0]),
            1 => rng.point(2.0),
            2 => (a * 2.0).round() * 1.5,
            // Along an edge, and through two vertices at once.
            _ => a + (a - b) * rng.pick(&[1.0, 2.0]),
        };
        let target = match i % 3 {
            0 => a,
            1 => a * 0.5 + b * 0.5,
            _ => b,
        };
        if origin != target {
            rays.push((Ray::new(origin, target - origin).with_range(0.0, 20.0),));
        }
    }
    let kernel = kernel!(|ray: Ray| parts(&mesh, ray));
    let mut tested = 0;
    for &(ray,) in &rays {
        let mut cut = Cut::new(&mesh, ray);
        let mut checked = |part: Ray, is_inside: bool| {
            let middle = 0.5 * (f64::from(part.t_min) + f64::from(part.t_max));
            let length = f64::from(part.t_max - part.t_min) * f64::from(ray.direction.length());
            if length > 1e-5 {
                let p = ray.origin.as_dvec3() + ray.direction.as_dvec3() * middle;
                let around = |d: glam::DVec3| winding(&vertices, &triangles, p + d * 1e-5).round();
                let found = around(glam::DVec3::ZERO);
                let is_right = (found == 1.0) == is_inside;
                let axes = [glam::DVec3::X, glam::DVec3::Y, glam::DVec3::Z];
                let differs = |d: &glam::DVec3| around(*d) != found || around(-*d) != found;
                // On the surface itself, along an edge or a face, either is right.
                assert!(is_right || axes.iter().any(differs), "{ray:?} {part:?}: {found}");
                tested += usize::from(is_right);
            }
        };
        while let Some(part) = cut.next_inside(&mesh) {
            checked(part, true);
        }
        let mut cut = Cut::new(&mesh, ray);
        while let Some(part) = cut.next_outside(&mesh) {
            checked(part, false);
        }
        let (inside, outside, ..) = kernel.call((ray,));
        assert!((inside + outside - 20.0).abs() < 1e-4, "{ray:?}: {inside} and {outside}");
    }
    assert!(tested > rays.len(), "{tested} parts of {} rays", rays.len());
    rays.truncate(4000);
    let expected = testing::run(&kernel, Variant::Scalar, &rays);
    for variant in [Variant::Packet4, Variant::Packet8, Variant::Packet16] {
        if testing::can_run(variant, "cuts") {
            assert_eq!(testing::run(&kernel, variant, &rays), expected, "{}", variant.name());
        }
    }
    if testing::can_run(Variant::Wgsl, "cuts") {
        let found = testing::run(&kernel, Variant::Wgsl, &rays);
        for (i, (a, b)) in expected.iter().zip(&found).enumerate() {
            let off = (a.0 - b.0).abs().max((a.1 - b.1).abs());
            assert!(off < 1e-3, "WGSL: {:?}: {b:?}, not {a:?}", rays[i]);
        }
    }
}

#[test]
fn points_are_inside_or_outside() {
    let ball = [Ball { center: vec3(1.0, 0.0, 0.0), radius: 0.5 }];
    let ball = &ball[..];
    let (vertices, triangles) = icosphere(2);
    let tree = Bvh::build_sharing(&triangles, &vertices, &BuildConfig::default()).expect("a tree");
    let mesh = Mesh::new(&tree, MeshAttributes::default()).expect("no attributes");
    for axis in [Vec3::X, Vec3::Y, Vec3::Z, vec3(0.6, 0.0, -0.8)] {
        for axis in [axis, -axis] {
            let middle = vec3(1.0, 0.0, 0.0);
            assert!(is_inside(ball, middle + axis * 0.4), "{axis}");
            assert!(!is_inside(ball, middle + axis * 0.6), "{axis}");
            assert!(is_inside(&mesh, axis * 0.8), "{axis}");
            assert!(!is_inside(&mesh, axis * 1.2), "{axis}");
        }
    }
    // Planes along each axis, and between two.
    for normal in [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z, vec3(0.6, 0.8, 0.0)] {
        let half = [Half { normal, offset: 0.5 }];
        let half = &half[..];
        let behind = kernel!(|p: Vec3| {
            let is_behind = is_inside(half, p);
            if is_behind { 1.0 } else { 0.0 }
        });
        let inputs = [-7.0, 0.25, 0.75, 7.0].map(|along| (normal * along,));
        let expected = [1.0, 1.0, 0.0, 0.0];
        assert_eq!(inputs.map(|p| behind.call(p)), expected, "{normal}");
        if normal == Vec3::X {
            assert_variants_agree!(&behind, &inputs);
        }
    }
}

#[test]
fn meshes_with_holes_are_refused() {
    let (vertices, triangles) = icosphere(1);
    let corners = |t: &IndexedTriangle| t.vertices.map(|i| vertices[i as usize]);
    let mut all: Vec<[Vec3; 3]> = triangles.iter().map(corners).collect();
    let hole = check_closed(all[1..].iter().copied());
    assert!(matches!(hole, Err(MeshError::Open { edges: 3, .. })), "{hole:?}");
    // A triangle that is turned, one that is there twice, one without area, one that is no number.
    all[0].swap(0, 1);
    let turned = check_closed(all.iter().copied());
    assert!(matches!(turned, Err(MeshError::Open { edges: 3, .. })), "{turned:?}");
    all[0].swap(0, 1);
    let twice = check_closed(all.iter().chain([&all[5]]).copied());
    assert!(matches!(twice, Err(MeshError::Open { edges: 3, .. })), "{twice:?}");
    let flat = [all[0][0], all[0][1], all[0][0]];
    assert_eq!(check_closed(all.iter().chain([&flat]).copied()), Ok(()));
    all[7][1].y = f32::NAN;
    assert_eq!(check_closed(all), Err(MeshError::NotFinite { triangle: 7 }));
    assert_eq!(check_closed([]), Ok(()));
}

/// A slab with a ball cut out: P-V8 of the closed forms is a ball less a ball.
#[test]
fn a_ball_less_a_ball() {
    // The outer ball is a tool too: the volume is homogeneous.
    let outer = [Ball { center: Vec3::ZERO, radius: 1.0 }];
    let inner = [Ball { center: vec3(0.25, 0.0, 0.0), radius: 0.5 }];
    let (outer, inner) = (&outer[..], &inner[..]);
    let voxels = [1.0f32; 8];
    let config = GridConfig::new().spacing(Vec3::splat(4.0)).origin(Vec3::splat(-2.0));
    let grid = Grid::new(&voxels[..], uvec3(2, 2, 2), config).expect("a grid");
    let function = TransferFunction::from_extinction(&[(0.0, Vec3::ONE)], &[(0.0, 1.5)]);
    let volume = Volume::new(&grid, function.expect("a function"));
    let exact = ExactCell::new().least(0.0);
    let kernel = kernel!(|ray: Ray| {
        let mut light = VolumeLight::new();
        let mut within = Cut::new(outer, ray);
        while let Some(part) = within.next_inside(outer) {
            let mut without = Cut::new(inner, part);
            while let Some(part) = without.next_outside(inner) {
                light = volume.integrate(&exact, part, light);
            }
        }
        (light.depth, light.transmittance())
    });
    let ray = Ray::new(vec3(0.1, 0.2, -3.0), Vec3::Z);
    let (depth, transmittance) = kernel.call((ray,));
    assert!((f64::from(depth) - 1.6250001977660312).abs() < 3e-6, "{depth}");
    assert!((f64::from(transmittance) - 0.1969116362617574).abs() < 1e-6, "{transmittance}");
    assert_variants_agree!(&kernel, &[(ray,), (Ray::new(vec3(0.1, 0.7, -3.0), Vec3::Z),)]);
}

/// A volume and a picture that something else has drawn, with the distance of what it shows: each
/// is in front of the other somewhere, and the volume is cut.
#[test]
fn a_drawn_picture_is_before_within_and_behind() {
    let grid = Grid::new(
        &[1.0f32; 8][..],
        uvec3(2, 2, 2),
        GridConfig::new().spacing(Vec3::splat(2.0)).origin(Vec3::splat(-1.0)),
    );
    let grid = grid.expect("a grid");
    let function = TransferFunction::from_extinction(&[(0.0, Vec3::Y)], &[(0.0, 0.7)]);
    let volume = Volume::new(&grid, function.expect("a function"));
    let hole = [Ball { center: vec3(0.0, 0.0, -0.4), radius: 0.3 }];
    let hole = &hole[..];
    let exact = ExactCell::new().least(0.0);
    // Depths in front of the volume, within, in the hole, at its border, behind, and nothing drawn.
    let depths = [1.0f32, 2.2, 2.6, 2.9, 3.5, 9.0, f32::MAX];
    let drawn: Vec<Vec4> = depths.iter().map(|depth| vec4(1.0, 0.0, 0.25, *depth)).collect();
    let drawn = &drawn[..];
    let kernel = kernel!(|x: f32, pixel: u32| {
        let behind: Vec4 = drawn[pixel as usize];
        let ray = Ray::new(vec3(x, 0.0, -3.0), Vec3::Z).with_range(0.0, behind.w);
        let mut light = VolumeLight::new();
        let mut cut = Cut::new(hole, ray);
        while let Some(part) = cut.next_outside(hole) {
            light = volume.integrate(&exact, part, light);
        }
        light.over(behind.truncate()).extend(light.opacity())
    });
    let mut inputs = Vec::new();
    for x in [0.0, 0.1, 0.29, 0.5, 1.5] {
        inputs.extend((0..depths.len()).map(|pixel| (x, pixel as u32)));
    }
    for &(x, pixel) in &inputs {
        let end = f64::from(depths[pixel as usize]).min(4.0);
        // The volume is from 2 to 4, the ball's chord is around 2.6.
        let half = (0.09 - f64::from(x).powi(2)).max(0.0).sqrt();
        let is_beside = x > 1.0;
        let within = (end - 2.0).max(0.0);
        let missing = (end.min(2.6 + half) - (2.6 - half)).clamp(0.0, 2.0 * half);
        let depth = if is_beside { 0.0 } else { 0.7 * (within - missing) };
        let passed = (-depth).exp();
        let found = kernel.call((x, pixel));
        for (found, expected) in
            found.to_array().into_iter().zip([passed, 1.0 - passed, 0.25 * passed, 1.0 - passed])
        {
            assert!(
                (f64::from(found) - expected).abs() < 2e-6,
                "{x}, {pixel}: {found}, not {expected}"
            );
        }
    }
    assert_close(&kernel, &inputs, 1e-5);
}
