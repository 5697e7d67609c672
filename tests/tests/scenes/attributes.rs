//! What the attributes of a mesh give at the points that rays hit, against plain arithmetic in `f64`.

use std::error::Error;

use glam::{DMat3, DVec3};
use raydsl::prelude::*;
use raydsl::shading::{Mesh, MeshAttributes};
use raydsl::{assert_variants_agree, kernel};

/// An octahedron. Its triangles run anticlockwise, seen from outside.
fn octahedron() -> (Vec<Vec3>, Vec<IndexedTriangle>) {
    let vertices = [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z];
    let face = |i: u32| {
        let [x, y, z] = [(i & 1) * 3, 1 + (i >> 1 & 1) * 3, 2 + (i >> 2 & 1) * 3];
        let is_turned = i.count_ones() % 2 == 1;
        IndexedTriangle { vertices: if is_turned { [x, z, y] } else { [x, y, z] } }
    };
    (vertices.map(|v| v * 1.5).into(), (0..8).map(face).collect())
}

/// Rays from outside towards the middle.
fn rays(seed: u32) -> Vec<(Ray,)> {
    let mut rng = Rng::new(UVec2::ZERO, seed, 9);
    let mut ray = |_| {
        let (from, to) = (sample_uniform_sphere(rng.next_2d()) * 5.0, rng.next_3d() * 0.8 - 0.4);
        (Ray::new(from, to - from),)
    };
    (0..300).map(&mut ray).collect()
}

/// The sum of a triangle's three values, weighted as at a hit.
fn between(triangle: IndexedTriangle, hit: Hit, value: impl Fn(usize) -> DVec3) -> DVec3 {
    let (u, v) = (f64::from(hit.u), f64::from(hit.v));
    let [a, b, c] = triangle.vertices.map(|i| value(i as usize));
    a * (1.0 - u - v) + b * u + c * v
}

fn direction(tangent: Vec4) -> DVec3 {
    tangent.truncate().as_dvec3()
}

#[test]
fn colors_are_those_between_the_vertices() -> Result<(), Box<dyn Error>> {
    let (vertices, triangles) = octahedron();
    let bvh = Bvh::build_sharing(&triangles, &vertices, &BuildConfig::default())?;
    let colors: Vec<Vec3> =
        vertices.iter().map(|v| vec3(0.4 + 0.2 * v.x, 0.5 - 0.3 * v.y, 0.3 + 0.1 * v.z)).collect();
    let mesh = Mesh::new(&bvh, MeshAttributes { colors: &colors, ..Default::default() })?;
    let seen = kernel!(|ray: Ray| mesh.shading_point(ray, mesh.closest_hit(ray)).albedo);
    let rays = rays(1);
    assert_variants_agree!(&seen, &rays);
    for (ray,) in &rays {
        let hit = mesh.closest_hit(*ray);
        let color = |i: usize| colors[i].as_dvec3();
        let expected = between(triangles[hit.prim_id as usize], hit, color);
        let off = (seen.call((*ray,)).as_dvec3() - expected).length();
        assert!(hit.is_hit && off < 1e-6, "{off} at {hit:?}");
    }
    Ok(())
}

/// Tangents of vertices, of a mesh and of a stretched instance of it: in the plane across the normal,
/// with the sign that the vertices have.
#[test]
fn tangents_are_those_between_the_vertices() -> Result<(), Box<dyn Error>> {
    let (vertices, triangles) = octahedron();
    let trees = [Bvh::build_sharing(&triangles, &vertices, &BuildConfig::default())?];
    let matrix3 = Mat3::from_rotation_y(0.4) * Mat3::from_diagonal(vec3(1.2, 0.7, 0.9));
    let placement = Affine3 { matrix3, translation: vec3(0.2, -0.1, 0.1) };
    let placed = Instances::build(&trees, &[Instance::new(0, placement)])?;
    let rays = rays(2);
    for sign in [1.0, -1.0] {
        let tangent = |v: &Vec3| vec4(0.3 + v.y, 1.0 - v.z, 0.5 * v.x, sign);
        let tangents: Vec<Vec4> = vertices.iter().map(tangent).collect();
        let attributes = MeshAttributes { tangents: &tangents, ..Default::default() };
        let (alone, among) = (Mesh::new(&trees[0], attributes)?, Mesh::new(&placed, attributes)?);
        let of_alone = kernel!(|ray: Ray| alone.shading_point(ray, alone.closest_hit(ray)));
        let of_among = kernel!(|ray: Ray| among.shading_point(ray, among.closest_hit(ray)));
        assert_variants_agree!(&of_alone, &rays);
        assert_variants_agree!(&of_among, &rays);
        for (ray,) in &rays {
            let cases = [
                (alone.closest_hit(*ray), of_alone.call((*ray,)), DMat3::IDENTITY),
                (among.closest_hit(*ray), of_among.call((*ray,)), matrix3.as_dmat3()),
            ];
            for (hit, found, to_scene) in cases {
                let own = |i: usize| direction(tangents[i]);
                let along = to_scene * between(triangles[hit.prim_id as usize], hit, own);
                let normal = found.shading_normal.as_dvec3();
                let expected = (along - normal * normal.dot(along)).normalize();
                let off = (direction(found.tangent) - expected).length();
                assert!(hit.is_hit && off < 1e-5, "{off} at {hit:?}");
                assert_eq!(found.tangent.w, sign);
                let on_ray = ray.origin.as_dvec3() + ray.direction.as_dvec3() * f64::from(hit.t);
                let off = (found.point.position.as_dvec3() - on_ray).length();
                assert!(off < 1e-5, "{off} from {on_ray}");
            }
        }
    }
    Ok(())
}

/// Without tangents of its own a mesh has those of its surface coordinates: the first one grows along
/// the tangent, the second one along the bitangent, also where the coordinates are mirrored.
#[test]
fn tangents_are_those_of_surface_coordinates() -> Result<(), Box<dyn Error>> {
    let (vertices, triangles) = octahedron();
    let bvh = Bvh::build_sharing(&triangles, &vertices, &BuildConfig::default())?;
    let (of_u, of_v) = (vec3(1.0, 0.1, 0.4), vec3(-0.2, 0.9, 0.3));
    let uvs: Vec<Vec2> = vertices.iter().map(|v| vec2(v.dot(of_u), v.dot(of_v))).collect();
    let mesh = Mesh::new(&bvh, MeshAttributes { uvs: &uvs, ..Default::default() })?;
    let seen = kernel!(|ray: Ray| mesh.shading_point(ray, mesh.closest_hit(ray)));
    let rays = rays(3);
    assert_variants_agree!(&seen, &rays);
    let mut mirrored = 0;
    for (ray,) in &rays {
        let found = seen.call((*ray,));
        let tangent = direction(found.tangent);
        let normal = found.shading_normal.as_dvec3();
        let bitangent = normal.cross(tangent) * f64::from(found.tangent.w);
        let (of_u, of_v) = (of_u.as_dvec3(), of_v.as_dvec3());
        assert!(found.tangent.w.abs() == 1.0 && (tangent.length() - 1.0).abs() < 1e-6);
        assert!(tangent.dot(of_u) > 0.0 && tangent.dot(of_v).abs() < 1e-6, "{found:?}");
        assert!(bitangent.dot(of_v) > 0.0, "{found:?}");
        mirrored += usize::from(found.tangent.w < 0.0);
    }
    assert!(mirrored > 50 && mirrored < 250, "{mirrored}");
    // In a mirrored instance too.
    let matrix3 = Mat3::from_diagonal(vec3(-1.0, 1.0, 1.0));
    let trees = [Bvh::build_sharing(&triangles, &vertices, &BuildConfig::default())?];
    let placement = Affine3 { matrix3, translation: Vec3::ZERO };
    let placed = Instances::build(&trees, &[Instance::new(0, placement)])?;
    let mesh = Mesh::new(&placed, MeshAttributes { uvs: &uvs, ..Default::default() })?;
    let seen = kernel!(|ray: Ray| mesh.shading_point(ray, mesh.closest_hit(ray)));
    assert_variants_agree!(&seen, &rays);
    for (ray,) in &rays {
        let found = seen.call((*ray,));
        let (tangent, normal) = (direction(found.tangent), found.shading_normal.as_dvec3());
        let bitangent = normal.cross(tangent) * f64::from(found.tangent.w);
        let (of_u, of_v) = ((matrix3 * of_u).as_dvec3(), (matrix3 * of_v).as_dvec3());
        assert!(tangent.dot(of_u) > 0.0 && bitangent.dot(of_v) > 0.0, "{found:?}");
    }
    Ok(())
}
