//! Embree 4, loaded while the program runs: there is nothing to link.

mod api;
mod question;
mod rays;
mod scene;
mod user;

use std::ffi::{CString, OsStr, OsString};
use std::sync::atomic::{AtomicIsize, Ordering};

use libloading::Library;

use api::{Api, Handle};
pub use question::{Mode, Question};
pub use rays::{Lanes, RayHits, Rays, Width};
pub use scene::{Coherence, Quality, Robustness, Scene, Shape};
pub use user::User;

/// Bytes that Embree holds now. Devices count one after another: a program builds one tree at a
/// time.
static HELD: AtomicIsize = AtomicIsize::new(0);

unsafe extern "C" fn count(_: Handle, bytes: isize, _: bool) -> bool {
    HELD.fetch_add(bytes, Ordering::Relaxed);
    true
}

/// What `RAYDSL_EMBREE` names; without it, says so.
pub fn path() -> Option<OsString> {
    let path = std::env::var_os("RAYDSL_EMBREE");
    if path.is_none() {
        eprintln!("skipped Embree: RAYDSL_EMBREE names no library");
    }
    path
}

/// A device of Embree.
pub struct Embree {
    api: Api,
    device: Handle,
    threads: usize,
}

// SAFETY: Embree's devices may be used from any thread, and here one at a time does.
unsafe impl Send for Embree {}
// SAFETY: what takes a shared device is safe to call from several threads.
unsafe impl Sync for Embree {}

impl Embree {
    /// A device with this many threads.
    ///
    /// # Errors
    ///
    /// If the library cannot be loaded, or gives no device.
    pub fn load(path: &OsStr, threads: usize) -> Result<Self, String> {
        // SAFETY: the user names the library; loading Embree runs its initialisers alone.
        let library = unsafe { Library::new(path) }.map_err(|error| error.to_string())?;
        // Never unloaded: its threads outlive its devices.
        let library: &'static Library = Box::leak(Box::new(library));
        let api = Api::of(library)?;
        let config = CString::new(format!("threads={threads}")).map_err(|e| e.to_string())?;
        // SAFETY: the string ends with a zero and outlives the call.
        let device = unsafe { (api.new_device)(config.as_ptr()) };
        if device.is_null() {
            return Err("rtcNewDevice gave no device".to_owned());
        }
        // SAFETY: the device is there, and `count` may be called from any thread.
        unsafe { (api.monitor_memory)(device, count, std::ptr::null_mut()) };
        Ok(Self { api, device, threads })
    }
}

impl Drop for Embree {
    fn drop(&mut self) {
        // SAFETY: the device is this one's own.
        unsafe { (self.api.release_device)(self.device) };
    }
}
