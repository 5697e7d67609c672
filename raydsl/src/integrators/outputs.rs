//! Arbitrary output variables (AOVs): geometry and material at the first hit.

use glam::{Vec3, vec3};

use crate::geometry::Ray;
use crate::machine::functions::vec3;
use crate::shading::{Scene, facing};
use crate::{Type, kernel};

// ANCHOR: aovs
/// The arbitrary output variables (AOVs) that denoisers, compositors and pickers ask for.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
#[repr(C)]
pub struct Aovs {
    /// The albedo, as red, green and blue; 0 where the ray misses.
    pub albedo: Vec3,
    /// The unit normal, on the side that the ray comes from; 0 where the ray misses.
    pub normal: Vec3,
    /// The distance in lengths of the ray's direction; [`f32::MAX`] where the ray misses.
    pub depth: f32,
    /// The id of the primitive; [`u32::MAX`] where the ray misses.
    pub prim_id: u32,
    /// The id of the instance; 0 in a scene without instances, [`u32::MAX`] where the ray misses.
    pub inst_id: u32,
}

/// Returns the AOVs at the closest hit of `ray`. [`Image::map`](crate::render::Image::map) makes a
/// picture of each member.
#[kernel]
pub fn aovs<S: Scene + ?Sized>(scene: &S, ray: Ray) -> Aovs {
    let hit = scene.closest_hit(ray);
    if !hit.is_hit {
        let nothing = vec3(0.0, 0.0, 0.0);
        return Aovs {
            albedo: nothing,
            normal: nothing,
            depth: f32::MAX,
            prim_id: u32::MAX,
            inst_id: u32::MAX,
        };
    }
    let seen = scene.shading_point(ray, hit);
    let point = facing(seen.point, ray.direction);
    Aovs {
        albedo: seen.albedo,
        normal: point.normal,
        depth: hit.t,
        prim_id: hit.prim_id,
        inst_id: hit.inst_id,
    }
}
// ANCHOR_END: aovs
