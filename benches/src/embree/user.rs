//! Primitives of one's own in Embree: user geometry, whose callbacks run the primitive's own
//! `intersect`.
//!
//! One ray runs the function as the user wrote it, a packet the same function lifted to the registers
//! of the machine, as in the library's own packets. Callbacks know their instruction set by their type:
//! nothing is looked up in a call.

use std::ffi::{c_int, c_uint, c_void};

use raydsl::geometry::{HitOn, HitRecord, Primitive, RayOn, shared_views};
use raydsl::kernel::{PacketKernel, PacketTask};
use raydsl::machine::{B, Entered, F, Lanes, Machine, Packet, V3, op};
use raydsl::prelude::*;

use super::api::{Callback, Handle};

/// Primitives, and how packets of rays are tested.
pub struct User<'a> {
    data: Box<dyn Data + 'a>,
    /// Rays in a packet that one call tests at once; packets of other widths are tested ray by ray.
    pub lanes: usize,
    /// The instruction set of these packets.
    pub isa: &'static str,
}

/// Primitives, and the registers of a packet.
struct Typed<'a, P, L> {
    prims: &'a [P],
    lanes: L,
}

/// Primitives of some type.
trait Data: Sync {
    fn callbacks(&self) -> Callbacks;
}

/// What a scene is given: data of the callbacks, the number of primitives, and the callbacks.
pub(super) struct Callbacks {
    pub(super) user: *const c_void,
    pub(super) count: c_uint,
    pub(super) bounds: Callback,
    pub(super) intersect: Callback,
    pub(super) occluded: Callback,
}

impl<P: Primitive<Shared = ()>, L: Lanes> Data for Typed<'_, P, L> {
    fn callbacks(&self) -> Callbacks {
        Callbacks {
            user: (&raw const *self).cast(),
            count: self.prims.len() as c_uint,
            bounds: bounds::<P, L>,
            intersect: intersect::<P, L>,
            occluded: occluded::<P, L>,
        }
    }
}

impl<'a> User<'a> {
    /// Primitives that the packets of a variant test; none if the machine has no such packets.
    ///
    /// # Panics
    ///
    /// If there are more primitives than Embree can count.
    pub fn new<P: Primitive<Shared = ()>>(prims: &'a [P], variant: Variant) -> Option<Self> {
        assert!(u32::try_from(prims.len()).is_ok(), "Embree counts primitives with 32 bits");
        // A kernel chooses the registers of each variant; this one is not run.
        let kernel = kernel!(|x: f32| x);
        kernel.with_packets(variant, WithLanes(prims))
    }

    pub(super) fn callbacks(&self) -> Callbacks {
        self.data.callbacks()
    }
}

/// Takes the lanes of a variant.
struct WithLanes<'a, P>(&'a [P]);

impl<'a, P: Primitive<Shared = ()>> PacketTask<(f32,), f32> for WithLanes<'a, P> {
    type Output = Option<User<'a>>;

    fn run<L: Lanes>(self, lanes: L, _: &PacketKernel<'_, L, (f32,), f32>) -> Self::Output {
        let data = Box::new(Typed { prims: self.0, lanes });
        Some(User { data, lanes: L::N, isa: lanes.isa() })
    }

    fn scalar(self, _: &(dyn Fn((f32,)) -> f32 + Send + Sync)) -> Self::Output {
        None
    }
}

/// `RTCBoundsFunctionArguments`.
#[repr(C)]
struct BoundsArguments {
    user: Handle,
    primitive: c_uint,
    time_step: c_uint,
    bounds: *mut Bounds,
}

/// `RTCBounds`.
#[repr(C, align(16))]
struct Bounds {
    lower: [f32; 4],
    upper: [f32; 4],
}

/// `RTCIntersectFunctionNArguments` and `RTCOccludedFunctionNArguments`, which have the same layout.
#[repr(C)]
struct RayArguments {
    valid: *const c_int,
    user: Handle,
    primitive: c_uint,
    context: Handle,
    /// `RTCRayHitN` or `RTCRayN`: registers of `count` numbers, one after another.
    rays: *mut f32,
    count: c_uint,
    geometry: c_uint,
}

/// Places of the members of `RTCRayHitN`, in registers.
mod member {
    pub(super) const ORIGIN: usize = 0;
    pub(super) const T_NEAR: usize = 3;
    pub(super) const DIRECTION: usize = 4;
    pub(super) const T_FAR: usize = 8;
    pub(super) const U: usize = 15;
    pub(super) const V: usize = 16;
    pub(super) const PRIMITIVE: usize = 17;
    pub(super) const GEOMETRY: usize = 18;
}

unsafe extern "C" fn bounds<P: Primitive<Shared = ()>, L: Lanes>(arguments: Handle) {
    // SAFETY: Embree calls this with its arguments, and the scene's primitives outlive it.
    let (arguments, user) = unsafe {
        let arguments = &*arguments.cast::<BoundsArguments>();
        (arguments, &*arguments.user.cast::<Typed<'_, P, L>>())
    };
    let Aabb { min, max } = user.prims[arguments.primitive as usize].get_bounds(&[]);
    let wide = |v: Vec3| [v.x, v.y, v.z, 0.0];
    // SAFETY: that is where the box goes.
    unsafe { *arguments.bounds = Bounds { lower: wide(min), upper: wide(max) } };
}

unsafe extern "C" fn intersect<P: Primitive<Shared = ()>, L: Lanes>(arguments: Handle) {
    // SAFETY: as the caller, which is Embree, must see to.
    unsafe { answer::<P, L, true>(arguments) };
}

unsafe extern "C" fn occluded<P: Primitive<Shared = ()>, L: Lanes>(arguments: Handle) {
    // SAFETY: likewise.
    unsafe { answer::<P, L, false>(arguments) };
}

/// # Safety
///
/// The arguments must be those of a callback, with rays that have hits if the question `IS_CLOSEST`,
/// and the user data a [`Typed`] of these types.
#[inline(always)]
unsafe fn answer<P: Primitive<Shared = ()>, L: Lanes, const IS_CLOSEST: bool>(arguments: Handle) {
    // SAFETY: as the caller says.
    let (arguments, user) = unsafe {
        let arguments = &*arguments.cast::<RayArguments>();
        (arguments, &*arguments.user.cast::<Typed<'_, P, L>>())
    };
    user.lanes.vectorize(
        #[inline(always)]
        || {
            let prim = &user.prims[arguments.primitive as usize];
            let count = arguments.count as usize;
            // SAFETY: as the caller says; lanes are below `count`, and a packet has `L::N`.
            unsafe {
                if count == L::N {
                    answer_packet::<P, L, IS_CLOSEST>(arguments, prim, user.lanes);
                } else {
                    for lane in 0..count {
                        if *arguments.valid.add(lane) != 0 {
                            answer_ray::<P, IS_CLOSEST>(arguments, prim, lane);
                        }
                    }
                }
            }
        },
    );
}

impl RayArguments {
    /// Where a member of lane 0 is.
    #[inline(always)]
    unsafe fn at(&self, member: usize) -> *mut f32 {
        // SAFETY: the caller names a member that is there.
        unsafe { self.rays.add(member * self.count as usize) }
    }
}

/// Tests the ray of one lane.
///
/// # Safety
///
/// As for [`answer`], with a lane that is there.
#[inline(always)]
unsafe fn answer_ray<P: Primitive<Shared = ()>, const IS_CLOSEST: bool>(
    a: &RayArguments,
    prim: &P,
    lane: usize,
) {
    // SAFETY: as the caller says.
    let at = |member: usize| unsafe { a.at(member).add(lane) };
    // SAFETY: as the caller says.
    let get = |member: usize| unsafe { *at(member) };
    let vector = |first: usize| vec3(get(first), get(first + 1), get(first + 2));
    let ray = Ray::new(vector(member::ORIGIN), vector(member::DIRECTION))
        .with_range(get(member::T_NEAR), get(member::T_FAR));
    let hit = prim.intersect(ray, &[]).hit();
    if !(hit.is_hit && hit.t >= ray.t_min && hit.t <= ray.t_max) {
        return;
    }
    // SAFETY: as the caller says.
    unsafe {
        if IS_CLOSEST {
            *at(member::T_FAR) = hit.t;
            *at(member::U) = hit.u;
            *at(member::V) = hit.v;
            *at(member::PRIMITIVE).cast() = a.primitive;
            *at(member::GEOMETRY).cast() = a.geometry;
        } else {
            *at(member::T_FAR) = f32::NEG_INFINITY;
        }
    }
}

/// Tests a packet that fills a register. A ray alone in it, as Embree asks where a packet has come
/// apart, is tested in the same way: the function of one ray is no faster for any of the scenes.
///
/// # Safety
///
/// As for [`answer`], with `L::N` rays.
#[inline(always)]
unsafe fn answer_packet<P: Primitive<Shared = ()>, L: Lanes, const IS_CLOSEST: bool>(
    a: &RayArguments,
    prim: &P,
    lanes: L,
) {
    let l = Entered::new(lanes);
    let valid = l.i32_from_fn(
        #[inline(always)]
        // SAFETY: as the caller says.
        |lane| unsafe { *a.valid.add(lane) },
    );
    let valid = l.i32_compare(op::Ne, valid, l.i32(0));
    let m = &Packet::with_bits(l, l.bits(valid));
    // SAFETY: as the caller says.
    let ray = unsafe {
        RayOn {
            origin: vector(a, l, member::ORIGIN),
            direction: vector(a, l, member::DIRECTION),
            t_min: F(load(a, l, member::T_NEAR)),
            t_max: F(load(a, l, member::T_FAR)),
        }
    };
    let hit = P::Hit::hit_on(P::intersect_one_on(m, prim, ray, shared_views::<()>(&[])));
    let hits = l.mask_binary(op::And, valid, within(m, hit, ray));
    if !l.any(hits) {
        return;
    }
    let id = |id: u32| l.f32_from_bits(l.u32(id));
    // SAFETY: as the caller says.
    unsafe {
        if IS_CLOSEST {
            store(a, l, hits, member::T_FAR, hit.t.0);
            store(a, l, hits, member::U, hit.u.0);
            store(a, l, hits, member::V, hit.v.0);
            store(a, l, hits, member::PRIMITIVE, id(a.primitive));
            store(a, l, hits, member::GEOMETRY, id(a.geometry));
        } else {
            store(a, l, hits, member::T_FAR, l.f32(f32::NEG_INFINITY));
        }
    }
}

/// A member of all lanes.
///
/// # Safety
///
/// The arguments must have `L::N` rays, and the member.
#[inline(always)]
unsafe fn load<L: Lanes>(a: &RayArguments, l: L, member: usize) -> L::F32 {
    l.f32_from_fn(
        #[inline(always)]
        // SAFETY: as the caller says.
        |lane| unsafe { *a.at(member).add(lane) },
    )
}

/// Three members of all lanes.
///
/// # Safety
///
/// As for [`load`].
#[inline(always)]
unsafe fn vector<L: Lanes>(a: &RayArguments, l: L, first: usize) -> V3<Packet<L>> {
    // SAFETY: as the caller says.
    unsafe {
        V3 { x: F(load(a, l, first)), y: F(load(a, l, first + 1)), z: F(load(a, l, first + 2)) }
    }
}

/// Replaces a member in some lanes.
///
/// # Safety
///
/// As for [`load`].
#[inline(always)]
unsafe fn store<L: Lanes>(a: &RayArguments, l: L, lanes: L::Mask, member: usize, value: L::F32) {
    // SAFETY: as the caller says.
    let (value, out) = unsafe {
        let value = l.f32_select(lanes, value, load(a, l, member));
        (value, std::slice::from_raw_parts_mut(a.at(member), L::N))
    };
    l.f32_store(value, out);
}

/// The lanes whose hit is within the range of their ray.
#[inline(always)]
fn within<L: Lanes>(m: &Packet<L>, hit: HitOn<Packet<L>>, ray: RayOn<Packet<L>>) -> L::Mask {
    let l = m.lanes();
    let B(is_hit) = hit.is_hit;
    let behind_start = m.f32_compare(op::Ge, hit.t.0, ray.t_min.0);
    let before_end = m.f32_compare(op::Le, hit.t.0, ray.t_max.0);
    l.mask_binary(op::And, is_hit, l.mask_binary(op::And, behind_start, before_end))
}

#[cfg(test)]
mod tests {
    use raydsl_tests::scenes::{random_rays, spheres};

    use super::*;
    use crate::embree::rays::{self, RayHits, Rays, Width};

    /// A lane that does not count.
    const IDLE: usize = 3;

    /// Runs both callbacks for every primitive and a packet of `N` rays; how many hits there were.
    fn check<const N: usize>(user: &User<'_>, prims: &[raydsl_tests::scenes::ColorSphere]) -> usize
    where
        rays::Lanes<N>: Width,
    {
        let Callbacks { user, intersect, occluded, .. } = user.callbacks();
        let valid: [c_int; N] = std::array::from_fn(|lane| -c_int::from(lane != IDLE));
        let call = |callback: Callback, primitive: usize, rays: *mut f32| {
            let mut arguments = RayArguments {
                valid: valid.as_ptr(),
                user: user.cast_mut(),
                primitive: primitive as c_uint,
                context: std::ptr::null_mut(),
                rays,
                count: N as c_uint,
                geometry: 0,
            };
            // SAFETY: the arguments are those that Embree gives.
            unsafe { callback((&raw mut arguments).cast()) };
        };
        let mut count = 0;
        for (i, prim) in prims.iter().enumerate() {
            let rays = random_rays(i as u64, N);
            let lanes = rays.iter().enumerate().filter(|(lane, _)| *lane != IDLE);
            let hits = lanes.map(|(_, ray)| (ray, prim.intersect(*ray)));
            let hits = hits.filter(|(ray, h)| h.is_hit && h.t >= ray.t_min && h.t <= ray.t_max);
            let expected: Vec<f32> = hits.map(|(_, hit)| hit.t).collect();
            let mut closest = RayHits::<N>::of(rays.iter().copied());
            call(intersect, i, (&raw mut closest).cast());
            assert_eq!(closest.distances().collect::<Vec<_>>(), expected, "primitive {i}");
            let mut any = Rays::<N>::of(rays);
            call(occluded, i, (&raw mut any).cast());
            assert_eq!(any.occluded(), expected.len(), "primitive {i}");
            count += expected.len();
        }
        count
    }

    #[test]
    fn callbacks_find_what_primitives_find() {
        let prims = spheres(2000);
        for variant in [Variant::Packet4, Variant::Packet8, Variant::Packet16] {
            let Some(user) = User::new(&prims, variant).filter(|_| variant.is_native()) else {
                continue;
            };
            // A packet of the variant's width, and one that is answered ray by ray.
            assert!(check::<8>(&user, &prims) > 20);
            assert!(check::<16>(&user, &prims) > 20);
        }
    }
}
