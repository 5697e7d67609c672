//! Cuts: the parts of a ray inside or outside of closed objects.

use std::collections::HashMap;

use glam::{Vec3, vec3};

use super::error::MeshError;

use crate::bvh::behind;
use crate::geometry::Ray;
use crate::machine::functions::vec3;
use crate::machine::generic::min;
use crate::shading::Scene;
use crate::{Type, kernel};

/// Walk along a ray through closed objects, from one part of it that is inside of any, or outside
/// of all, to the next.
///
/// The objects are those of a scene: primitives with an inside, such as spheres and cuboids, and
/// closed meshes of triangles whose vertices run anticlockwise seen from outside
/// ([`check_closed()`] says whether they are); one inside another, touching, as many as there are.
/// Every crossing counts once, whatever edge or vertex the ray passes through, and one that only
/// touches an object changes nothing; the ends of parts are the distances of hits. The ray may
/// begin inside. A plane is the surface of all that is behind it, for rays that cross it somewhere,
/// also before they begin; of several planes one may be entered only where none is left: crossings do
/// not tell that a line is inside of one plane or another everywhere.
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl::shading::Surface;
/// use raydsl::volume::Cut;
/// use raydsl::kernel;
///
/// #[primitive(sphere(center, radius))]
/// struct Ball {
///     center: Vec3,
///     radius: f32,
/// }
///
/// #[kernel]
/// impl Surface for Ball {
///     fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
///         self.surface_point(ray, hit)
///     }
///
///     fn albedo(&self, _ray: Ray, _hit: Hit) -> Vec3 {
///         Vec3::ONE
///     }
/// }
///
/// let ball = |x| Ball { center: vec3(x, 0.0, 0.0), radius: 1.0 };
/// let balls = [ball(3.0), ball(4.0), ball(9.0)];
/// let tool = &balls[..];
/// let outside = kernel!(|ray: Ray| {
///     let mut cut = Cut::new(tool, ray);
///     let mut length = 0.0;
///     while let Some(part) = cut.next_outside(tool) {
///         length += part.t_max - part.t_min;
///     }
///     length
/// });
/// let ray = Ray::new(Vec3::ZERO, Vec3::X).with_range(0.0, 12.0);
/// assert_eq!(outside.call((ray,)), 2.0 + 3.0 + 2.0);
/// ```
#[derive(Clone, Copy, Debug, Type)]
pub struct Cut {
    /// What is left of the ray.
    pub rest: Ray,
    /// Number of objects around the point where the rest begins.
    pub depth: i32,
    /// Whether the hits at the beginning of the rest are counted already.
    is_behind: bool,
    /// Whether the rest is empty.
    is_done: bool,
}

/// 2^-18: share of a distance by which two hits of one point may differ.
const NEARBY: f32 = 1.0 / 262_144.0;

#[kernel]
impl Cut {
    /// Begins a walk at the ray's `t_min`. It takes all hits of the whole line, also behind the
    /// ray's ends, since what they count up to says what the ray begins in.
    pub fn new<S: Scene + ?Sized>(scene: &S, ray: Ray) -> Self {
        let line = ray.with_range(-f32::MAX, f32::MAX);
        let (mut sum, mut least, mut before) = (0i32, 0i32, 0i32);
        let mut at = -f32::MAX;
        for hit in scene.hits(line) {
            // Where rounding decides which of two hits comes first, their order says nothing.
            if hit.t - at > hit.t.abs() * NEARBY {
                least = min(least, sum);
            }
            at = hit.t;
            sum += scene.crossing(line, hit);
            if hit.t < ray.t_min {
                before = sum;
            }
        }
        least = min(least, sum);
        Self { rest: ray, depth: before - least, is_behind: false, is_done: ray.t_min >= ray.t_max }
    }

    /// Returns the next part of the ray that is inside of an object.
    pub fn next_inside<S: Scene + ?Sized>(&mut self, scene: &S) -> Option<Ray> {
        self.next_where(scene, true)
    }

    /// Returns the next part of the ray that is outside of all objects.
    pub fn next_outside<S: Scene + ?Sized>(&mut self, scene: &S) -> Option<Ray> {
        self.next_where(scene, false)
    }

    fn next_where<S: Scene + ?Sized>(&mut self, scene: &S, is_inside: bool) -> Option<Ray> {
        let whole = self.rest;
        if self.is_done {
            return None;
        }
        let first = if self.is_behind { behind(whole.t_min) } else { whole.t_min };
        let ray = whole.with_range(first, whole.t_max);
        let mut depth = self.depth;
        // The hits at `at` are counted, those behind are not.
        let (mut at, mut begin, mut end) = (whole.t_min, whole.t_min, whole.t_max);
        let (mut has_begun, mut has_ended) = (false, false);
        for hit in scene.hits(ray) {
            if hit.t > at {
                let is_wanted = (depth > 0) == is_inside;
                if has_begun && !is_wanted {
                    has_ended = true;
                    end = at;
                    break;
                }
                if !has_begun && is_wanted {
                    has_begun = true;
                    begin = at;
                }
                at = hit.t;
            }
            depth += scene.crossing(ray, hit);
        }
        if !has_ended {
            // Behind the last hit.
            let is_wanted = (depth > 0) == is_inside && at < whole.t_max;
            if has_begun && !is_wanted {
                end = at;
            } else if is_wanted && !has_begun {
                has_begun = true;
                begin = at;
            }
        }
        self.depth = depth;
        self.rest = whole.with_range(end, whole.t_max);
        self.is_behind = true;
        self.is_done = !has_ended;
        if has_begun { Some(whole.with_range(begin, end)) } else { None }
    }
}

/// Checks that triangles are closed: that each edge of one is that of another, the other way round.
/// A mesh with a hole, or with a triangle that is turned, has no inside, and [`Cut`] would give
/// parts of rays that mean nothing.
///
/// Edges are those between equal positions, so that both indexed meshes and loose triangles can be
/// checked. Triangles without area do not count.
///
/// # Errors
///
/// If an edge has no neighbour, or a position is not finite.
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl::volume::{MeshError, check_closed};
///
/// let [o, x, y, z] = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
/// let solid = [[o, y, x], [o, z, y], [o, x, z], [x, y, z]];
/// assert_eq!(check_closed(solid), Ok(()));
/// let error = check_closed(solid[1..].iter().copied());
/// assert!(matches!(error, Err(MeshError::Open { edges: 3, .. })));
/// ```
pub fn check_closed(triangles: impl IntoIterator<Item = [Vec3; 3]>) -> Result<(), MeshError> {
    // Both zeros are one position.
    let key = |p: Vec3| (p + 0.0).to_array().map(f32::to_bits);
    let mut edges: HashMap<[[u32; 3]; 2], (i64, [Vec3; 2], usize)> = HashMap::new();
    for (index, corners) in triangles.into_iter().enumerate() {
        if !corners.iter().all(|p| p.is_finite()) {
            return Err(MeshError::NotFinite { triangle: index });
        }
        for (a, b) in [(0, 1), (1, 2), (2, 0)] {
            let (from, to) = (key(corners[a]), key(corners[b]));
            let (ends, sign) = if from < to { ([from, to], 1) } else { ([to, from], -1) };
            let at_first = (0, [corners[a], corners[b]], index);
            if from != to {
                edges.entry(ends).or_insert(at_first).0 += sign;
            }
        }
    }
    let open = || edges.values().filter(|edge| edge.0 != 0);
    match open().min_by_key(|edge| edge.2) {
        None => Ok(()),
        Some(&(_, [from, to], triangle)) => {
            Err(MeshError::Open { edges: open().count(), from, to, triangle })
        }
    }
}

/// Returns whether a point is inside of a closed object of the scene, or behind a plane of it.
///
/// It follows a [`Cut`] along the fixed direction `(0.36, 0.48, 0.8)`, which is oblique to all axes: a
/// plane parallel to it does not count.
#[kernel]
pub fn is_inside<S: Scene + ?Sized>(scene: &S, point: Vec3) -> bool {
    let ray = Ray::new(point, vec3(0.36, 0.48, 0.8));
    Cut::new(scene, ray).depth > 0
}
