//! Embree 4, loaded while the program runs: there is nothing to link.

use std::ffi::{CString, OsStr, c_char, c_int, c_uint, c_void};
use std::sync::atomic::{AtomicIsize, Ordering};

use libloading::{Library, Symbol};
use raydsl::prelude::*;
use raydsl_benches::clock::seconds_on;

type Handle = *mut c_void;

/// `RTC_GEOMETRY_TYPE_TRIANGLE`, the buffer types and formats of `rtcore_geometry.h`.
const TRIANGLES: c_int = 0;
const INDEX: c_int = 0;
const VERTEX: c_int = 1;
const UINT3: c_int = 0x5003;
const FLOAT3: c_int = 0x9003;

/// Bytes that Embree holds now. Devices count one after another: a program builds one tree at a
/// time.
static HELD: AtomicIsize = AtomicIsize::new(0);

unsafe extern "C" fn count(_: Handle, bytes: isize, _: bool) -> bool {
    HELD.fetch_add(bytes, Ordering::Relaxed);
    true
}

/// A device of Embree.
pub(crate) struct Embree {
    /// Never unloaded: its threads outlive its devices.
    library: &'static Library,
    device: Handle,
    threads: usize,
}

// SAFETY: Embree's devices may be used from any thread, and here one at a time does.
unsafe impl Send for Embree {}

/// Vertices and indices as Embree reads them.
#[derive(Clone)]
pub(crate) struct Vertices {
    positions: Vec<[f32; 3]>,
    indices: Vec<[u32; 3]>,
}

impl Embree {
    /// Three vertices of its own for each triangle, as the library has them. One more, since Embree
    /// reads 16 bytes for each.
    pub(crate) fn vertices(triangles: &[Triangle]) -> Vertices {
        let corners = triangles.iter().flat_map(|t| [t.v0, t.v1, t.v2]);
        let mut positions: Vec<[f32; 3]> = corners.map(|v| v.to_array()).collect();
        positions.push([0.0; 3]);
        let indices = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        Vertices { positions, indices }
    }

    /// A device with this many threads.
    pub(crate) fn load(path: &OsStr, threads: usize) -> Result<Self, String> {
        // SAFETY: the user names the library; loading Embree runs its initialisers alone.
        let library = unsafe { Library::new(path) }.map_err(|error| error.to_string())?;
        let library: &'static Library = Box::leak(Box::new(library));
        let config = CString::new(format!("threads={threads}")).map_err(|e| e.to_string())?;
        // SAFETY: the signatures are those of `rtcore_device.h` of Embree 4.
        let device = unsafe {
            let new: Symbol<'_, unsafe extern "C" fn(*const c_char) -> Handle> =
                symbol(library, "rtcNewDevice")?;
            let device = new(config.as_ptr());
            let monitor: Symbol<
                '_,
                unsafe extern "C" fn(
                    Handle,
                    unsafe extern "C" fn(Handle, isize, bool) -> bool,
                    Handle,
                ),
            > = symbol(library, "rtcSetDeviceMemoryMonitorFunction")?;
            if device.is_null() {
                return Err("rtcNewDevice gave no device".to_owned());
            }
            monitor(device, count, std::ptr::null_mut());
            device
        };
        Ok(Self { library, device, threads })
    }

    /// Builds a scene; the seconds, and the bytes that it holds afterwards.
    pub(crate) fn build(&self, v: &Vertices, quality: c_int) -> Result<(f64, usize), String> {
        let library = self.library;
        let before = HELD.load(Ordering::Relaxed);
        // SAFETY: the signatures are those of `rtcore_scene.h` and `rtcore_geometry.h` of Embree 4.
        // Both buffers outlive the scene, which is released before this returns, and the vertices
        // have the padding that is asked for.
        unsafe {
            let make: Symbol<'_, unsafe extern "C" fn(Handle) -> Handle> =
                symbol(library, "rtcNewScene")?;
            let set: Symbol<'_, unsafe extern "C" fn(Handle, c_int)> =
                symbol(library, "rtcSetSceneBuildQuality")?;
            let geometry: Symbol<'_, unsafe extern "C" fn(Handle, c_int) -> Handle> =
                symbol(library, "rtcNewGeometry")?;
            let share: Symbol<'_, ShareBuffer> = symbol(library, "rtcSetSharedGeometryBuffer")?;
            let attach: Symbol<'_, unsafe extern "C" fn(Handle, Handle) -> c_uint> =
                symbol(library, "rtcAttachGeometry")?;
            let refine: Symbol<'_, unsafe extern "C" fn(Handle, c_int)> =
                symbol(library, "rtcSetGeometryBuildQuality")?;
            let [commit_geometry, commit, drop_geometry, drop_scene] =
                ["rtcCommitGeometry", "rtcCommitScene", "rtcReleaseGeometry", "rtcReleaseScene"]
                    .map(|name| symbol::<unsafe extern "C" fn(Handle)>(library, name));
            let [commit_geometry, commit, drop_geometry, drop_scene] =
                [commit_geometry?, commit?, drop_geometry?, drop_scene?];
            let count = v.indices.len();
            let (scene, seconds) = seconds_on(self.threads, || {
                let scene = make(self.device);
                set(scene, quality);
                let shape = geometry(self.device, TRIANGLES);
                refine(shape, quality);
                share(shape, INDEX, 0, UINT3, v.indices.as_ptr().cast(), 0, 12, count);
                share(shape, VERTEX, 0, FLOAT3, v.positions.as_ptr().cast(), 0, 12, 3 * count);
                commit_geometry(shape);
                attach(scene, shape);
                drop_geometry(shape);
                commit(scene);
                scene
            });
            let bytes = HELD.load(Ordering::Relaxed) - before;
            drop_scene(scene);
            Ok((seconds, bytes.max(0) as usize))
        }
    }
}

type ShareBuffer =
    unsafe extern "C" fn(Handle, c_int, c_uint, c_int, *const c_void, usize, usize, usize);

/// # Safety
///
/// `T` must be the type of the function.
unsafe fn symbol<'a, T>(library: &'a Library, name: &str) -> Result<Symbol<'a, T>, String> {
    // SAFETY: as the caller says.
    unsafe { library.get(name.as_bytes()) }.map_err(|error| error.to_string())
}

impl Drop for Embree {
    fn drop(&mut self) {
        // SAFETY: the device is this one's own.
        unsafe {
            if let Ok(release) =
                symbol::<unsafe extern "C" fn(Handle)>(self.library, "rtcReleaseDevice")
            {
                release(self.device);
            }
        }
    }
}
