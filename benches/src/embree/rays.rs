//! Rays as Embree reads them: one, or packets of 8 and 16.

use raydsl::prelude::*;

/// The alignment of `RTCRay`.
#[derive(Clone, Copy)]
#[repr(align(16))]
pub struct Align16;
/// The alignment of `RTCRay8`.
#[derive(Clone, Copy)]
#[repr(align(32))]
pub struct Align32;
/// The alignment of `RTCRay16`.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub struct Align64;

/// A number of lanes.
pub struct Lanes<const N: usize>;

/// Numbers of lanes that Embree has functions for: 1, 8 and 16.
///
/// # Safety
///
/// The alignment must be that of Embree's structs for so many rays.
pub unsafe trait Width {
    /// What is aligned as Embree wants it.
    type Align: Copy;
}

// SAFETY: the alignment is that of `RTCRay`.
unsafe impl Width for Lanes<1> {
    type Align = Align16;
}

// SAFETY: the alignment is that of `RTCRay8`.
unsafe impl Width for Lanes<8> {
    type Align = Align32;
}

// SAFETY: the alignment is that of `RTCRay16`.
unsafe impl Width for Lanes<16> {
    type Align = Align64;
}

/// `RTCRay`, `RTCRay8`, `RTCRay16`.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Rays<const N: usize>
where
    Lanes<N>: Width,
{
    align: [<Lanes<N> as Width>::Align; 0],
    origin: [[f32; N]; 3],
    t_near: [f32; N],
    direction: [[f32; N]; 3],
    time: [f32; N],
    t_far: [f32; N],
    mask: [u32; N],
    id: [u32; N],
    flags: [u32; N],
}

/// `RTCRayHit`, `RTCRayHit8`, `RTCRayHit16`.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct RayHits<const N: usize>
where
    Lanes<N>: Width,
{
    rays: Rays<N>,
    normal: [[f32; N]; 3],
    uv: [[f32; N]; 2],
    prim: [u32; N],
    geometry: [u32; N],
    instance: [u32; N],
    instance_prim: [u32; N],
}

/// `RTC_INVALID_GEOMETRY_ID`.
const NONE: u32 = u32::MAX;

impl<const N: usize> Rays<N>
where
    Lanes<N>: Width,
{
    /// At most `N` rays. Lanes without one end before they begin.
    pub fn of(rays: impl IntoIterator<Item = Ray>) -> Self {
        let mut packet = Self {
            align: [],
            origin: [[0.0; N]; 3],
            t_near: [0.0; N],
            direction: [[1.0; N]; 3],
            time: [0.0; N],
            t_far: [-1.0; N],
            mask: [u32::MAX; N],
            id: [0; N],
            flags: [0; N],
        };
        for (lane, ray) in rays.into_iter().enumerate().take(N) {
            for axis in 0..3 {
                packet.origin[axis][lane] = ray.origin[axis];
                packet.direction[axis][lane] = ray.direction[axis];
            }
            packet.t_near[lane] = ray.t_min;
            packet.t_far[lane] = ray.t_max;
        }
        packet
    }

    /// How many met something when asked whether they do.
    pub fn occluded(&self) -> usize {
        self.t_far.iter().filter(|t| **t == f32::NEG_INFINITY).count()
    }
}

impl<const N: usize> RayHits<N>
where
    Lanes<N>: Width,
{
    /// At most `N` rays, which have met nothing yet.
    pub fn of(rays: impl IntoIterator<Item = Ray>) -> Self {
        Self {
            rays: Rays::of(rays),
            normal: [[0.0; N]; 3],
            uv: [[0.0; N]; 2],
            prim: [NONE; N],
            geometry: [NONE; N],
            instance: [NONE; N],
            instance_prim: [NONE; N],
        }
    }

    /// The distances of those that met something.
    pub fn distances(&self) -> impl Iterator<Item = f32> {
        let hits = self.geometry.iter().zip(&self.rays.t_far);
        hits.filter(|(geometry, _)| **geometry != NONE).map(|(_, t)| *t)
    }
}
