//! Execution of kernels on this machine: the variants, their instruction sets, and the fibers that
//! batch queries of packets.

pub(crate) mod clock;
#[cfg_attr(
    not(all(
        unix,
        target_pointer_width = "64",
        any(target_arch = "x86_64", target_arch = "aarch64"),
        not(miri)
    )),
    path = "one_by_one.rs"
)]
pub(crate) mod fibers;
mod levels;
mod variant;

use core::any::Any;

pub use levels::{Counting, Native4, Native8, Native16};
pub(crate) use levels::{
    Lanes4, Lanes8, Lanes16, LanesTask, Levels, has_wide_lanes, with_wide_lanes,
};
pub use variant::{Variant, Variants};

/// Scratch memory of a query, which is reused.
pub(crate) trait Scratch: Any + Default {
    /// Removes the rays of the last query.
    fn clear(&mut self);
}

/// The key of a batch: the address of the function that answers its queries, and that of the scene.
///
/// The scene of a waiting packet is borrowed, so no other scene has its address; and the function
/// is that of its type of primitives, or one with the same code.
pub(crate) type Key = (usize, [usize; 3]);
