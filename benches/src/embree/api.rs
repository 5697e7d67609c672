//! The functions of Embree 4 that are called.

use std::ffi::{c_char, c_int, c_uint, c_void};

use libloading::Library;

pub(super) type Handle = *mut c_void;

type Monitor = unsafe extern "C" fn(Handle, isize, bool) -> bool;
type ShareBuffer =
    unsafe extern "C" fn(Handle, c_int, c_uint, c_int, *const c_void, usize, usize, usize);
/// A callback of user geometry: its arguments are a struct of its own kind.
pub(super) type Callback = unsafe extern "C" fn(Handle);
/// `rtcIntersect1`, `rtcOccluded1`: the scene, the ray, the arguments.
pub(super) type TraceOne = unsafe extern "C" fn(Handle, *mut c_void, *mut Arguments);
/// `rtcIntersect8` and the like: the lanes that count, the scene, the rays, the arguments.
pub(super) type TraceMany = unsafe extern "C" fn(*const c_int, Handle, *mut c_void, *mut Arguments);

/// `RTCIntersectArguments` and `RTCOccludedArguments`, which have the same layout. The last member
/// is there in some configurations of Embree alone; the others do not look at it.
#[repr(C)]
pub(super) struct Arguments {
    pub(super) flags: c_int,
    pub(super) features: c_int,
    pub(super) context: Handle,
    pub(super) filter: Handle,
    pub(super) function: Handle,
    pub(super) width_factor: f32,
}

/// Asks the library for functions by name. The types are those of the headers of Embree 4.
macro_rules! api {
    ($($member:ident: $name:literal $ty:ty,)+) => {
        /// Functions of the library.
        pub(super) struct Api {
            $(pub(super) $member: $ty,)+
            /// Of 8 and of 16 rays.
            pub(super) intersect: [TraceMany; 2],
            pub(super) occluded: [TraceMany; 2],
        }

        impl Api {
            /// The functions of a library that stays loaded.
            pub(super) fn of(library: &'static Library) -> Result<Self, String> {
                // SAFETY: the types are those of the headers of Embree 4.
                unsafe {
                    Ok(Self {
                        $($member: symbol(library, $name)?,)+
                        intersect: [
                            symbol(library, "rtcIntersect8")?,
                            symbol(library, "rtcIntersect16")?,
                        ],
                        occluded: [
                            symbol(library, "rtcOccluded8")?,
                            symbol(library, "rtcOccluded16")?,
                        ],
                    })
                }
            }
        }
    };
}

api! {
    new_device: "rtcNewDevice" unsafe extern "C" fn(*const c_char) -> Handle,
    release_device: "rtcReleaseDevice" unsafe extern "C" fn(Handle),
    monitor_memory: "rtcSetDeviceMemoryMonitorFunction"
        unsafe extern "C" fn(Handle, Monitor, Handle),
    new_scene: "rtcNewScene" unsafe extern "C" fn(Handle) -> Handle,
    release_scene: "rtcReleaseScene" unsafe extern "C" fn(Handle),
    set_scene_quality: "rtcSetSceneBuildQuality" unsafe extern "C" fn(Handle, c_int),
    set_scene_flags: "rtcSetSceneFlags" unsafe extern "C" fn(Handle, c_int),
    commit_scene: "rtcCommitScene" unsafe extern "C" fn(Handle),
    new_geometry: "rtcNewGeometry" unsafe extern "C" fn(Handle, c_int) -> Handle,
    release_geometry: "rtcReleaseGeometry" unsafe extern "C" fn(Handle),
    set_geometry_quality: "rtcSetGeometryBuildQuality" unsafe extern "C" fn(Handle, c_int),
    share_buffer: "rtcSetSharedGeometryBuffer" ShareBuffer,
    set_user_data: "rtcSetGeometryUserData" unsafe extern "C" fn(Handle, *const c_void),
    set_user_count: "rtcSetGeometryUserPrimitiveCount" unsafe extern "C" fn(Handle, c_uint),
    set_bounds: "rtcSetGeometryBoundsFunction" unsafe extern "C" fn(Handle, Callback, Handle),
    set_intersect: "rtcSetGeometryIntersectFunction" unsafe extern "C" fn(Handle, Callback),
    set_occluded: "rtcSetGeometryOccludedFunction" unsafe extern "C" fn(Handle, Callback),
    commit_geometry: "rtcCommitGeometry" unsafe extern "C" fn(Handle),
    attach_geometry: "rtcAttachGeometry" unsafe extern "C" fn(Handle, Handle) -> c_uint,
    intersect_1: "rtcIntersect1" TraceOne,
    occluded_1: "rtcOccluded1" TraceOne,
}

/// # Safety
///
/// `T` must be the type of the function.
unsafe fn symbol<T: Copy>(library: &'static Library, name: &str) -> Result<T, String> {
    // SAFETY: as the caller says.
    let found = unsafe { library.get::<T>(name.as_bytes()) };
    found.map(|function| *function).map_err(|error| error.to_string())
}
