//! Shapes of lights, and how they are sampled from a point.

use core::f32::consts::PI;

use glam::{Vec2, Vec3, vec2, vec3};

use super::LightExtent;
use super::triangle::{sample_spherical_triangle, solid_angle};
use crate::geometry::{SurfacePoint, Triangle, disk, rectangle, sphere, triangle};
use crate::machine::functions::{vec2, vec3};
use crate::machine::generic::{clamp, length, max, min};
use crate::sampling::{
    Frame, ONE_MINUS_EPSILON, UNIFORM_HEMISPHERE_PDF, UNIFORM_SPHERE_PDF, cone_pdf, one_minus_cos,
    sample_cone, sample_uniform_hemisphere, sample_uniform_sphere,
};
use crate::{Type, kernel};

/// The shape of an [`AreaLight`](super::AreaLight).
///
/// A shape of your own is sampled by its area in three lines; see [`sample_by_area()`].
#[kernel]
pub trait LightShape {
    /// Samples a point of the surface, as seen from `from`, by a point of the unit square.
    fn sample_from(&self, from: Vec3, u: Vec2) -> ShapeSample;

    /// Returns the density per solid angle with which [`sample_from`](Self::sample_from) chooses the
    /// point `at` of the surface.
    fn pdf_from(&self, from: Vec3, at: SurfacePoint) -> f32;

    /// Returns the area of the surface.
    fn surface_area(&self) -> f32;

    /// Returns the box around it and its normals; it shines up to a right angle from them.
    fn shape_extent(&self) -> LightExtent;
}

/// A sampled point of a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct ShapeSample {
    /// Unit vector towards it.
    pub wi: Vec3,
    /// The point.
    pub point: SurfacePoint,
    /// Density per solid angle; 0 where there is none.
    pub pdf: f32,
}

/// Returns the sample of a point that was chosen uniformly on a surface of this area.
///
/// ```
/// use raydsl::kernel;
/// use raydsl::light::{LightExtent, LightShape, ShapeSample, area_pdf, sample_by_area};
/// use raydsl::prelude::*;
///
/// /// A tube that shines.
/// #[primitive(tube(p0, p1, radius))]
/// struct Neon {
///     p0: Vec3,
///     p1: Vec3,
///     radius: f32,
/// }
///
/// #[kernel]
/// impl LightShape for Neon {
///     fn sample_from(&self, from: Vec3, u: Vec2) -> ShapeSample {
///         sample_by_area(tube::sample(u, self.p0, self.p1, self.radius), self.surface_area(), from)
///     }
///
///     fn pdf_from(&self, from: Vec3, at: SurfacePoint) -> f32 {
///         area_pdf(at, self.surface_area(), from)
///     }
///
///     fn surface_area(&self) -> f32 {
///         tube::area(self.p0, self.p1, self.radius)
///     }
///
///     fn shape_extent(&self) -> LightExtent {
///         let r = Vec3::splat(self.radius);
///         LightExtent {
///             min: self.p0.min(self.p1) - r,
///             max: self.p0.max(self.p1) + r,
///             axis: vec3(0.0, 0.0, 1.0),
///             cos_normals: -1.0,
///             cos_emitted: 0.0,
///         }
///     }
/// }
/// ```
#[kernel]
pub fn sample_by_area(point: SurfacePoint, area: f32, from: Vec3) -> ShapeSample {
    let way = point.position - from;
    let squared = way.dot(way);
    let is_there = squared > 1e-30 && area > 0.0;
    let wi = if is_there { way / squared.sqrt() } else { vec3(0.0, 0.0, 1.0) };
    // A shape without area has no point.
    let nowhere = SurfacePoint { position: from, normal: wi, error: 0.0 };
    let point = if is_there { point } else { nowhere };
    ShapeSample { wi, point, pdf: if is_there { area_pdf(point, area, from) } else { 0.0 } }
}

/// Returns the density per solid angle of a point that was chosen uniformly on a surface of this
/// area: 0 where the surface is seen edge-on, or from itself.
#[kernel]
#[inline]
pub fn area_pdf(point: SurfacePoint, area: f32, from: Vec3) -> f32 {
    let way = point.position - from;
    let cosine = way.dot(point.normal).abs();
    let is_seen = area > 0.0 && cosine > 0.0;
    let pdf = way.dot(way) * way.dot(way).sqrt() / (area * cosine);
    if is_seen && pdf < 1e30 { pdf } else { 0.0 }
}

/// A sphere, whose normals are outside. From points within 7.6e-6 radii of the surface it is seen as
/// from inside.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct SphereShape {
    /// Centre.
    pub center: Vec3,
    /// Radius.
    pub radius: f32,
}

/// A rectangle or other parallelogram, whose normal is `cross(u_edge, v_edge)`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct RectangleShape {
    /// A corner.
    pub corner: Vec3,
    /// An edge from there.
    pub u_edge: Vec3,
    /// The other edge.
    pub v_edge: Vec3,
}

/// A disk.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct DiskShape {
    /// Centre.
    pub center: Vec3,
    /// Normal, of any length.
    pub normal: Vec3,
    /// Radius.
    pub radius: f32,
}

/// Factor of the squared radius up to which a point is on the sphere: twice what rounding does to
/// points of a surface.
const ON_SPHERE: f32 = 1.0 + 1.0 / 65536.0;

#[kernel]
impl SphereShape {
    /// Returns the height of the cone in which the sphere is seen; 0 from inside, and from the sphere
    /// itself, to rounding: from there all of it is seen on its inside.
    #[inline]
    fn cone(self, from: Vec3) -> f32 {
        let way = self.center - from;
        let squared = way.dot(way);
        let around = self.radius * self.radius * ON_SPHERE;
        let is_outside = squared > around && self.radius > 0.0;
        let sine = self.radius / max(squared, f32::MIN_POSITIVE).sqrt();
        if is_outside { max(one_minus_cos(sine), f32::MIN_POSITIVE) } else { 0.0 }
    }
}

#[kernel]
impl LightShape for SphereShape {
    fn sample_from(&self, from: Vec3, u: Vec2) -> ShapeSample {
        let way = self.center - from;
        let height = SphereShape::cone(*self, from);
        let d = way.dot(way).sqrt();
        let is_outside = height > 0.0;
        let ahead = if is_outside { way / d } else { vec3(0.0, 0.0, 1.0) };
        let inside = sample_uniform_sphere(u);
        let local = if is_outside { sample_cone(u, height) } else { inside };
        let wi = Frame::around(ahead).to_world(local);
        // The half chord, from the sine of the direction.
        let along = way.dot(wi);
        let aside = way - wi * along;
        let half = max((self.radius * self.radius) - aside.dot(aside), 0.0).sqrt();
        let towards = wi * (if is_outside { -half } else { half }) - aside;
        let squared = towards.dot(towards);
        let outwards = towards / max(squared, f32::MIN_POSITIVE).sqrt();
        // Of a sphere that is small from here, what is left of the chord is rounding.
        let is_away = is_outside && outwards.dot(wi) >= 0.0;
        let normal = if squared > 0.0 && !is_away { outwards } else { -wi };
        let point = sphere::of_normal(normal, self.center, self.radius);
        let pdf = if is_outside { cone_pdf(height) } else { UNIFORM_SPHERE_PDF };
        ShapeSample { wi, point, pdf: if self.radius > 0.0 { pdf } else { 0.0 } }
    }

    fn pdf_from(&self, from: Vec3, _at: SurfacePoint) -> f32 {
        let height = SphereShape::cone(*self, from);
        if height > 0.0 { cone_pdf(height) } else { UNIFORM_SPHERE_PDF }
    }

    fn surface_area(&self) -> f32 {
        sphere::area(self.center, self.radius)
    }

    fn shape_extent(&self) -> LightExtent {
        let r = Vec3::splat(self.radius);
        let axis = vec3(0.0, 0.0, 1.0);
        let (min, max) = (self.center - r, self.center + r);
        LightExtent { min, max, axis, cos_normals: -1.0, cos_emitted: 0.0 }
    }
}

/// Solid angle below which a flat shape is sampled by its area: the spherical one has no digits left,
/// and the density hardly varies.
const MIN_SOLID_ANGLE: f32 = 1e-4;

/// Solid angle above which the whole hemisphere is sampled: the shape is next to the point, and as good
/// as all around on its side.
const MAX_SOLID_ANGLE: f32 = 6.2;

/// Returns the coordinates, along two edges, of where the line from `from` along `wi` meets their plane.
#[kernel]
#[inline(always)]
fn on_plane(from: Vec3, wi: Vec3, corner: Vec3, e1: Vec3, e2: Vec3) -> Vec2 {
    let across = e1.cross(e2);
    let n = across / max(across.dot(across), f32::MIN_POSITIVE);
    let facing = across.dot(wi);
    let t = if facing == 0.0 { 0.0 } else { across.dot(corner - from) / facing };
    let p = from + wi * t - corner;
    vec2(n.dot(p.cross(e2)), n.dot(e1.cross(p)))
}

/// Returns where the line from `from` along `wi` meets a triangle, which it does but for rounding.
#[kernel]
#[inline(always)]
fn on_triangle(from: Vec3, wi: Vec3, v0: Vec3, v1: Vec3, v2: Vec3) -> SurfacePoint {
    let b = on_plane(from, wi, v0, v1 - v0, v2 - v0);
    let (b1, b2) = (max(b.x, 0.0), max(b.y, 0.0));
    let over = max(b1 + b2, 1.0);
    triangle::weighted(b1 / over, b2 / over, v0, v1, v2)
}

/// Samples the hemisphere on the side of `from` on which a plane is.
#[kernel]
#[inline]
fn sample_side(from: Vec3, u: Vec2, corner: Vec3, across: Vec3) -> Vec3 {
    let n = across / max(across.dot(across), f32::MIN_POSITIVE).sqrt();
    let away = if n.dot(corner - from) < 0.0 { -n } else { n };
    Frame::around(away).to_world(sample_uniform_hemisphere(u))
}

/// Returns the density of a flat shape's samples.
#[kernel]
#[inline]
fn flat_pdf(angle: f32, by_area: f32) -> f32 {
    let by_angle = if angle > MAX_SOLID_ANGLE { UNIFORM_HEMISPHERE_PDF } else { 1.0 / angle };
    if angle > MIN_SOLID_ANGLE { by_angle } else { by_area }
}

/// Share of the coordinates by which a point is beside a plane, and not on it but for rounding.
const BESIDE: f32 = 1e-6;

/// Returns whether a point is beside the plane of a flat shape with an area: from the plane itself none
/// of it is seen, although its solid angle is that of a hemisphere.
#[kernel]
#[inline]
fn is_beside(from: Vec3, corner: Vec3, across: Vec3) -> bool {
    let height = across.dot(corner - from).abs();
    height > BESIDE * length(across) * (length(from) + length(corner))
}

/// Samples a triangle that is seen nearly all around.
#[kernel]
#[inline(never)]
fn sample_near_triangle(from: Vec3, u: Vec2, v0: Vec3, v1: Vec3, v2: Vec3) -> ShapeSample {
    let (e1, e2) = (v1 - v0, v2 - v0);
    let wi = sample_side(from, u, v0, e1.cross(e2));
    let b = on_plane(from, wi, v0, e1, e2);
    let is_met = b.x >= 0.0 && b.y >= 0.0 && b.x + b.y <= 1.0;
    let pdf = if is_met { UNIFORM_HEMISPHERE_PDF } else { 0.0 };
    ShapeSample { wi, point: on_triangle(from, wi, v0, v1, v2), pdf }
}

/// Samples a triangle that is hardly more than a point.
#[kernel]
#[inline(never)]
fn sample_far_triangle(from: Vec3, u: Vec2, v0: Vec3, v1: Vec3, v2: Vec3) -> ShapeSample {
    sample_by_area(triangle::sample(u, v0, v1, v2), triangle::area(v0, v1, v2), from)
}

#[kernel]
fn sample_triangle_from(from: Vec3, u: Vec2, v0: Vec3, v1: Vec3, v2: Vec3) -> ShapeSample {
    let angle = solid_angle(from, v0, v1, v2);
    let is_seen = is_beside(from, v0, (v1 - v0).cross(v2 - v0));
    let wi = sample_spherical_triangle(u, from, v0, v1, v2);
    let point = on_triangle(from, wi, v0, v1, v2);
    let mut sample = ShapeSample { wi, point, pdf: 1.0 / angle };
    if angle <= MIN_SOLID_ANGLE || !is_seen {
        sample = sample_far_triangle(from, u, v0, v1, v2);
    } else if angle > MAX_SOLID_ANGLE {
        sample = sample_near_triangle(from, u, v0, v1, v2);
    }
    ShapeSample { pdf: if is_seen { sample.pdf } else { 0.0 }, ..sample }
}

#[kernel]
fn triangle_pdf_from(from: Vec3, at: SurfacePoint, v0: Vec3, v1: Vec3, v2: Vec3) -> f32 {
    let by_area = area_pdf(at, triangle::area(v0, v1, v2), from);
    let pdf = flat_pdf(solid_angle(from, v0, v1, v2), by_area);
    if is_beside(from, v0, (v1 - v0).cross(v2 - v0)) { pdf } else { 0.0 }
}

#[kernel]
impl LightShape for Triangle {
    fn sample_from(&self, from: Vec3, u: Vec2) -> ShapeSample {
        sample_triangle_from(from, u, self.v0, self.v1, self.v2)
    }

    fn pdf_from(&self, from: Vec3, at: SurfacePoint) -> f32 {
        triangle_pdf_from(from, at, self.v0, self.v1, self.v2)
    }

    fn surface_area(&self) -> f32 {
        triangle::area(self.v0, self.v1, self.v2)
    }

    fn shape_extent(&self) -> LightExtent {
        flat(
            min(min(self.v0, self.v1), self.v2),
            max(max(self.v0, self.v1), self.v2),
            (self.v1 - self.v0).cross(self.v2 - self.v0),
        )
    }
}

/// Returns the extent of a flat surface.
#[kernel]
#[inline]
fn flat(min: Vec3, max: Vec3, normal: Vec3) -> LightExtent {
    let squared = normal.dot(normal);
    let axis = if squared > 0.0 { normal / squared.sqrt() } else { vec3(0.0, 0.0, 1.0) };
    LightExtent { min, max, axis, cos_normals: 1.0, cos_emitted: 0.0 }
}

#[kernel]
impl RectangleShape {
    /// Returns the solid angles of the two triangles that have the diagonal in common.
    #[inline]
    fn halves(self, from: Vec3) -> Vec2 {
        let (a, b, d) = (self.corner, self.corner + self.u_edge, self.corner + self.v_edge);
        let c = b + self.v_edge;
        vec2(solid_angle(from, a, b, c), solid_angle(from, a, c, d))
    }

    /// Samples one of the halves by its solid angle.
    #[inline]
    fn sample_spherical(self, from: Vec3, u: Vec2, angles: Vec2) -> ShapeSample {
        let (a, b, d) = (self.corner, self.corner + self.u_edge, self.corner + self.v_edge);
        let c = b + self.v_edge;
        // The first number chooses the half, and is used again within it.
        let angle = angles.x + angles.y;
        let share = angles.x / angle;
        let is_first = u.x < share;
        let x = if is_first { u.x / share } else { (u.x - share) / (1.0 - share) };
        let within = vec2(min(x, ONE_MINUS_EPSILON), u.y);
        let (v1, v2) = (if is_first { b } else { c }, if is_first { c } else { d });
        let wi = sample_spherical_triangle(within, from, a, v1, v2);
        ShapeSample { wi, point: on_triangle(from, wi, a, v1, v2), pdf: 1.0 / angle }
    }

    /// Samples it where it is seen nearly all around.
    #[inline(never)]
    fn sample_near(self, from: Vec3, u: Vec2) -> ShapeSample {
        let wi = sample_side(from, u, self.corner, self.u_edge.cross(self.v_edge));
        let at = on_plane(from, wi, self.corner, self.u_edge, self.v_edge);
        let is_met = at.x >= 0.0 && at.x <= 1.0 && at.y >= 0.0 && at.y <= 1.0;
        let within = clamp(at, vec2(0.0, 0.0), vec2(1.0, 1.0));
        let point = rectangle::sample(within, self.corner, self.u_edge, self.v_edge);
        ShapeSample { wi, point, pdf: if is_met { UNIFORM_HEMISPHERE_PDF } else { 0.0 } }
    }

    /// Samples it where it is hardly more than a point.
    #[inline(never)]
    fn sample_far(self, from: Vec3, u: Vec2) -> ShapeSample {
        let point = rectangle::sample(u, self.corner, self.u_edge, self.v_edge);
        sample_by_area(point, rectangle::area(self.corner, self.u_edge, self.v_edge), from)
    }
}

#[kernel]
impl LightShape for RectangleShape {
    fn sample_from(&self, from: Vec3, u: Vec2) -> ShapeSample {
        let angles = RectangleShape::halves(*self, from);
        let angle = angles.x + angles.y;
        let is_seen = is_beside(from, self.corner, self.u_edge.cross(self.v_edge));
        let mut sample = RectangleShape::sample_spherical(*self, from, u, angles);
        if angle <= MIN_SOLID_ANGLE || !is_seen {
            sample = RectangleShape::sample_far(*self, from, u);
        } else if angle > MAX_SOLID_ANGLE {
            sample = RectangleShape::sample_near(*self, from, u);
        }
        ShapeSample { pdf: if is_seen { sample.pdf } else { 0.0 }, ..sample }
    }

    fn pdf_from(&self, from: Vec3, at: SurfacePoint) -> f32 {
        let angles = RectangleShape::halves(*self, from);
        let pdf = flat_pdf(angles.x + angles.y, area_pdf(at, self.surface_area(), from));
        let is_seen = is_beside(from, self.corner, self.u_edge.cross(self.v_edge));
        if is_seen { pdf } else { 0.0 }
    }

    fn surface_area(&self) -> f32 {
        rectangle::area(self.corner, self.u_edge, self.v_edge)
    }

    fn shape_extent(&self) -> LightExtent {
        let (a, b, d) = (self.corner, self.corner + self.u_edge, self.corner + self.v_edge);
        let c = b + self.v_edge;
        flat(min(min(a, b), min(c, d)), max(max(a, b), max(c, d)), self.u_edge.cross(self.v_edge))
    }
}

#[kernel]
impl LightShape for DiskShape {
    fn sample_from(&self, from: Vec3, u: Vec2) -> ShapeSample {
        sample_by_area(
            disk::sample(u, self.center, self.normal, self.radius),
            self.surface_area(),
            from,
        )
    }

    fn pdf_from(&self, from: Vec3, at: SurfacePoint) -> f32 {
        area_pdf(at, self.surface_area(), from)
    }

    fn surface_area(&self) -> f32 {
        PI * self.radius * self.radius
    }

    fn shape_extent(&self) -> LightExtent {
        let r = Vec3::splat(self.radius);
        flat(self.center - r, self.center + r, self.normal)
    }
}
