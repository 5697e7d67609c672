//! Primitives, materials and lights of several kinds in one scene, without virtual calls.

use raydsl::kernel;
use raydsl::prelude::*;

/// A ball and what it is made of.
#[primitive(sphere(center, radius))]
#[derive(Debug)]
pub(crate) struct Ball {
    /// Its centre.
    pub(crate) center: Vec3,
    /// Its radius.
    pub(crate) radius: f32,
}

// ANCHOR: enum
/// What a scene is made of; its WGSL has the kinds that are there.
#[primitive(normal)]
#[derive(Debug)]
pub(crate) enum Shape {
    /// A sphere.
    Ball(Ball),
    /// A triangle.
    Facet(Triangle),
}
// ANCHOR_END: enum

/// What a surface does with light.
#[kernel]
pub(crate) trait Material {
    /// The share of light that goes on, under this cosine.
    fn shade(&self, cos: f32) -> Vec3;
}

/// The same in all directions.
#[derive(Clone, Copy, Debug, Type)]
pub(crate) struct Matte {
    /// Its colour.
    pub(crate) color: Vec3,
}

#[kernel]
impl Material for Matte {
    fn shade(&self, cos: f32) -> Vec3 {
        self.color * max(cos, 0.0)
    }
}

/// With a highlight.
#[derive(Clone, Copy, Debug, Type)]
pub(crate) struct Plastic {
    /// Its colour.
    pub(crate) color: Vec3,
    /// How narrow the highlight is.
    pub(crate) exponent: f32,
}

#[kernel]
impl Material for Plastic {
    fn shade(&self, cos: f32) -> Vec3 {
        let c = max(cos, 0.0);
        self.color * c + 0.4 * pow(c, self.exponent)
    }
}

/// Where light comes from.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub(crate) enum Light {
    /// From above.
    Sky,
    /// From a lamp at the origin.
    Lamp,
}

#[kernel]
fn toward(light: Light, at: Vec3) -> Vec3 {
    match light {
        Light::Sky => Vec3::Y,
        Light::Lamp => (-at).normalize(),
    }
}

/// Colour of what a ray meets: the shape's kind chooses the normal and the material.
#[kernel]
pub(crate) fn radiance<A: Material, B: Material>(
    scene: &Bvh<Shape>,
    balls: A,
    facets: B,
    light: Light,
    ray: Ray,
) -> Vec3 {
    let hit = scene.closest_hit(ray);
    if !hit.is_hit {
        return Vec3::ZERO;
    }
    let way = toward(light, ray.at(hit.t));
    // ANCHOR: match
    let shape = scene.primitive(hit);
    let cos = shape.normal(ray, hit).dot(way);
    match shape {
        Shape::Ball(_) => balls.shade(cos),
        Shape::Facet(_) => facets.shade(cos.abs()),
    }
    // ANCHOR_END: match
}
