//! How kernels run on this machine: which variants there are, which instructions it has for them, and
//! packets that wait for each other.

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
    Lanes4, Lanes8, Lanes16, LanesTask, Levels, has_wide_walks, with_wide_walks,
};
pub use variant::{Variant, Variants};

/// The memory of a query, which is used again.
pub(crate) trait Scratch: Any + Default {
    /// Forgets what was asked.
    fn clear(&mut self);
}

/// Packets whose key is the same ask the same of the same scene: the function that answers, and
/// where the scene lies.
///
/// The scene of a packet that waits is borrowed, so no other one lies there; and the function is
/// that of its type of primitives, or one of the same code.
pub(crate) type Key = (usize, [usize; 3]);
