//! Scenes of Embree: how they are built, and what rays ask them.

use std::ffi::c_int;
use std::sync::atomic::Ordering;

use raydsl::prelude::*;

use super::api::{Arguments, Handle, TraceMany, TraceOne};
use super::rays::{Lanes, RayHits, Rays, Width};
use super::user::{Callbacks, User};
use super::{Embree, HELD};
use crate::clock::seconds_on;

/// `RTC_GEOMETRY_TYPE_TRIANGLE`, `RTC_GEOMETRY_TYPE_SPHERE_POINT` and `RTC_GEOMETRY_TYPE_USER`, the
/// buffer types and formats of `rtcore_geometry.h`.
const TRIANGLES: c_int = 0;
const SPHERES: c_int = 50;
const USER: c_int = 120;
const INDEX: c_int = 0;
const VERTEX: c_int = 1;
const UINT3: c_int = 0x5003;
const FLOAT3: c_int = 0x9003;
const FLOAT4: c_int = 0x9004;
/// `RTC_FEATURE_FLAG_ALL`.
const ALL_FEATURES: c_int = -1;

/// How well a scene is built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quality {
    /// `RTC_BUILD_QUALITY_LOW`.
    Low,
    /// `RTC_BUILD_QUALITY_MEDIUM`.
    Medium,
    /// `RTC_BUILD_QUALITY_HIGH`.
    High,
}

impl Quality {
    /// `low`, `medium` or `high`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Low => "low",
            Self::Medium => "medium",
            Self::High => "high",
        }
    }
}

/// Whether rays may be lost to rounding at edges and boxes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Robustness {
    /// They may: `RTC_SCENE_FLAG_NONE`.
    Off,
    /// They are not: `RTC_SCENE_FLAG_ROBUST`.
    On,
}

impl Robustness {
    const fn flags(self) -> c_int {
        match self {
            Self::Off => 0,
            Self::On => 1 << 2,
        }
    }
}

/// What Embree is told of the rays of a packet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coherence {
    /// `RTC_RAY_QUERY_FLAG_INCOHERENT`.
    Incoherent,
    /// `RTC_RAY_QUERY_FLAG_COHERENT`.
    Coherent,
}

/// Primitives as Embree reads them.
#[derive(Clone)]
pub enum Shape {
    /// Three vertices of its own for each triangle.
    Triangles {
        /// The vertices, and one more.
        positions: Vec<[f32; 3]>,
        /// Three for each triangle.
        indices: Vec<[u32; 3]>,
    },
    /// Centres and radii.
    Spheres(Vec<[f32; 4]>),
}

impl Shape {
    /// Three vertices of its own for each triangle, as the library has them. One more, since Embree
    /// reads 16 bytes for each.
    pub fn triangles(triangles: &[Triangle]) -> Self {
        let corners = triangles.iter().flat_map(|t| [t.v0, t.v1, t.v2]);
        let mut positions: Vec<[f32; 3]> = corners.map(|v| v.to_array()).collect();
        positions.push([0.0; 3]);
        let indices = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        Self::Triangles { positions, indices }
    }

    const fn kind(&self) -> c_int {
        match self {
            Self::Triangles { .. } => TRIANGLES,
            Self::Spheres(_) => SPHERES,
        }
    }
}

/// A scene that is built.
pub struct Scene<'a> {
    embree: &'a Embree,
    scene: Handle,
    /// How long that took; see [`seconds_on`].
    pub seconds: f64,
    /// What it holds, with its copies of the primitives.
    pub bytes: usize,
}

// SAFETY: a scene that is committed may be asked from any thread.
unsafe impl Send for Scene<'_> {}
// SAFETY: likewise, from several at once.
unsafe impl Sync for Scene<'_> {}

impl Embree {
    /// Builds a scene, which reads the buffers of `shape` as long as it lives.
    pub fn build<'a>(
        &'a self,
        shape: &'a Shape,
        quality: Quality,
        robustness: Robustness,
    ) -> Scene<'a> {
        // SAFETY: both buffers outlive the scene, and the vertices have the padding that is asked
        // for.
        self.build_of(shape.kind(), quality, robustness, |geometry| unsafe {
            self.share(geometry, shape);
        })
    }

    /// Builds a scene of primitives with callbacks, which it calls as long as it lives.
    pub fn build_user<'a>(
        &'a self,
        user: &'a User<'_>,
        quality: Quality,
        robustness: Robustness,
    ) -> Scene<'a> {
        let api = &self.api;
        let Callbacks { user, count, bounds, intersect, occluded } = user.callbacks();
        // SAFETY: the callbacks are of their kinds, and what they read outlives the scene.
        self.build_of(USER, quality, robustness, |geometry| unsafe {
            (api.set_user_count)(geometry, count);
            (api.set_user_data)(geometry, user);
            (api.set_bounds)(geometry, bounds, std::ptr::null_mut());
            (api.set_intersect)(geometry, intersect);
            (api.set_occluded)(geometry, occluded);
        })
    }

    /// Builds a scene of one geometry of this kind, which `fill` gives its primitives.
    fn build_of(
        &self,
        kind: c_int,
        quality: Quality,
        robustness: Robustness,
        fill: impl FnOnce(Handle),
    ) -> Scene<'_> {
        let (api, quality) = (&self.api, quality as c_int);
        let before = HELD.load(Ordering::Relaxed);
        // SAFETY: each handle is used while it is held.
        let (scene, seconds) = seconds_on(self.threads, || unsafe {
            let scene = (api.new_scene)(self.device);
            (api.set_scene_quality)(scene, quality);
            (api.set_scene_flags)(scene, robustness.flags());
            let geometry = (api.new_geometry)(self.device, kind);
            (api.set_geometry_quality)(geometry, quality);
            fill(geometry);
            (api.commit_geometry)(geometry);
            (api.attach_geometry)(scene, geometry);
            (api.release_geometry)(geometry);
            (api.commit_scene)(scene);
            scene
        });
        let bytes = (HELD.load(Ordering::Relaxed) - before).max(0) as usize;
        Scene { embree: self, scene, seconds, bytes }
    }

    /// # Safety
    ///
    /// The buffers of `shape` must outlive the geometry.
    unsafe fn share(&self, geometry: Handle, shape: &Shape) {
        let share = self.api.share_buffer;
        // SAFETY: as the caller says; sizes and formats are those of the buffers.
        unsafe {
            match shape {
                Shape::Triangles { positions, indices } => {
                    let count = indices.len();
                    share(geometry, INDEX, 0, UINT3, indices.as_ptr().cast(), 0, 12, count);
                    share(geometry, VERTEX, 0, FLOAT3, positions.as_ptr().cast(), 0, 12, 3 * count);
                }
                Shape::Spheres(spheres) => {
                    let data = spheres.as_ptr().cast();
                    share(geometry, VERTEX, 0, FLOAT4, data, 0, 16, spheres.len());
                }
            }
        }
    }
}

impl Scene<'_> {
    /// Finds the closest hits of the rays.
    pub fn intersect<const N: usize>(&self, rays: &mut [RayHits<N>], coherence: Coherence)
    where
        Lanes<N>: Width,
    {
        let api = &self.embree.api;
        // SAFETY: the functions are those for packets of `N`.
        unsafe { self.trace::<N, _>(api.intersect_1, api.intersect, rays, coherence) };
    }

    /// Finds out which rays meet something.
    pub fn occluded<const N: usize>(&self, rays: &mut [Rays<N>], coherence: Coherence)
    where
        Lanes<N>: Width,
    {
        let api = &self.embree.api;
        // SAFETY: the functions are those for packets of `N`.
        unsafe { self.trace::<N, _>(api.occluded_1, api.occluded, rays, coherence) };
    }

    /// # Safety
    ///
    /// `one` must take a `T` if `N` is 1, else the first or second of `many`, for 8 and 16.
    unsafe fn trace<const N: usize, T>(
        &self,
        one: TraceOne,
        [by_8, by_16]: [TraceMany; 2],
        packets: &mut [T],
        coherence: Coherence,
    ) {
        let mut args = arguments(coherence);
        let many = if N == 8 { by_8 } else { by_16 };
        for packet in packets {
            let packet = (&raw mut *packet).cast();
            // SAFETY: the scene is committed; the rest is as the caller says.
            unsafe {
                match N {
                    1 => one(self.scene, packet, &raw mut args),
                    _ => many(VALID.0.as_ptr(), self.scene, packet, &raw mut args),
                }
            }
        }
    }
}

/// Lanes that count: all.
#[repr(align(64))]
struct Valid([c_int; 16]);

static VALID: Valid = Valid([-1; 16]);

fn arguments(coherence: Coherence) -> Arguments {
    let none = std::ptr::null_mut();
    Arguments {
        flags: c_int::from(coherence == Coherence::Coherent) << 16,
        features: ALL_FEATURES,
        context: none,
        filter: none,
        function: none,
        width_factor: 0.0,
    }
}

impl Drop for Scene<'_> {
    fn drop(&mut self) {
        // SAFETY: the scene is this one's own.
        unsafe { (self.embree.api.release_scene)(self.scene) };
    }
}
