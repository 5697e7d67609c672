//! Scenes of primitives: queries, and what they return.

use raydsl::kernel;
use raydsl::machine::Recording;
use raydsl::prelude::*;
use raydsl::shading::Surface;
use raydsl_tests::scenes::{ColorSphere, spheres, triangles};

use super::Made;
use super::lit::lit_triangles;

#[kernel]
pub(crate) fn colors(bvh: &Bvh<'_, ColorSphere>, background: Vec3, ray: Ray) -> Shaded {
    let hit = bvh.closest_hit(ray);
    let color = if hit.is_hit { bvh.primitive(hit).rgb() } else { background };
    Shaded { color, depth: hit.t, id: hit.prim_id }
}

pub(super) fn points() -> Made {
    let points = spheres(50);
    let (bvh, background) = (&Bvh::build(&points)?, vec3(0.1, 0.2, 0.3));
    Ok(recorded!(colors(bvh, background)(ray: Ray) -> Shaded))
}

#[kernel]
pub(super) fn distance(scene: &Bvh<'_, Triangle>, ray: Ray) -> f32 {
    scene.closest_hit(ray).t
}

pub(super) fn depth() -> Made {
    let soup = triangles(50);
    let bvh = &Bvh::build(&soup)?;
    Ok(recorded!(distance(bvh)(ray: Ray) -> f32))
}

pub(super) fn wide() -> Made {
    let soup = triangles(80);
    let bvh = &Bvh::build_wide(&soup, &[], &BuildConfig::default())?;
    Ok(recorded!(distance(bvh)(ray: Ray) -> f32))
}

#[kernel]
pub(super) fn is_hit(few: &[Triangle], ray: Ray) -> bool {
    few.any_hit(ray)
}

pub(super) fn few() -> Made {
    let soup = triangles(5);
    let few = &soup[..];
    Ok(recorded!(is_hit(few)(ray: Ray) -> bool))
}

#[kernel]
pub(super) fn number(scene: &Instances<'_, Triangle>, ray: Ray) -> u32 {
    scene.closest_hit(ray).inst_id
}

pub(super) fn instances() -> Made {
    let soup = triangles(20);
    let trees = [Bvh::build(&soup)?];
    let scene = &Instances::build(&trees, &[Instance::new(0, Affine3::IDENTITY)])?;
    Ok(recorded!(number(scene)(ray: Ray) -> u32))
}

/// A sphere, a disk or a triangle.
#[primitive]
pub(super) enum Shape {
    Ball(Ball),
    Plate(Plate),
    Face(Triangle),
}

#[primitive(sphere(center, radius))]
pub(super) struct Ball {
    center: Vec3,
    radius: f32,
}

#[primitive(disk(center, normal, radius))]
pub(super) struct Plate {
    center: Vec3,
    normal: Vec3,
    radius: f32,
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

/// A triangle that is a surface.
#[primitive(triangle(v0, v1, v2))]
pub(crate) struct Face {
    pub(crate) v0: Vec3,
    pub(crate) v1: Vec3,
    pub(crate) v2: Vec3,
}

#[kernel]
impl Surface for Face {
    fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
        self.surface_point(ray, hit)
    }

    fn albedo(&self, _ray: Ray, _hit: Hit) -> Vec3 {
        Vec3::splat(0.8)
    }
}

pub(super) fn balls() -> Vec<Ball> {
    (0..9).map(|i| Ball { center: vec3(i as f32 - 4.0, 0.0, 0.0), radius: 0.4 }).collect()
}

#[kernel]
pub(super) fn distance_of_shape(scene: &Bvh<'_, Shape>, ray: Ray) -> f32 {
    scene.closest_hit(ray).t
}

/// The list has two of the three kinds.
pub(super) fn kinds() -> Made {
    let plate = Plate { center: Vec3::ZERO, normal: Vec3::Y, radius: 9.0 };
    let balls = balls().into_iter().map(Shape::Ball);
    let shapes: Vec<Shape> = balls.chain([Shape::Plate(plate)]).collect();
    let bvh = &Bvh::build(&shapes)?;
    Ok(recorded!(distance_of_shape(bvh)(ray: Ray) -> f32))
}

#[kernel]
pub(super) fn second(scene: &Bvh<'_, ColorSphere>, ray: Ray) -> f32 {
    let hits = scene.multi_hit_by::<2>(ray, |a: Hit, b: Hit| a.t > b.t);
    hits[1].t
}

pub(super) fn layers() -> Made {
    let points = spheres(50);
    let bvh = &Bvh::build(&points)?;
    Ok(recorded!(second(bvh)(ray: Ray) -> f32))
}

#[kernel]
pub(super) fn nodes(scene: &Bvh<'_, Triangle>, ray: Ray) -> u32 {
    scene.closest_hit_with_cost(ray).1.nodes
}

pub(super) fn cost() -> Made {
    let soup = triangles(50);
    let bvh = &Bvh::build(&soup)?;
    Ok(recorded!(nodes(bvh)(ray: Ray) -> u32))
}

#[kernel]
pub(super) fn coordinates_of(scene: &Bvh<'_, Face>, ray: Ray) -> Vec2 {
    let hit = scene.closest_hit(ray);
    let seen = scene.shading_point(ray, hit);
    seen.uv
}

/// Of a shading point nothing but these.
pub(super) fn coordinates() -> Made {
    let (soup, _) = lit_triangles();
    let scene = &Bvh::build(&soup)?;
    Ok(recorded!(coordinates_of(scene)(ray: Ray) -> Vec2))
}
