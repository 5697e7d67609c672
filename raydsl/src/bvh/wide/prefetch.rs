//! A hint to the processor.

/// Asks the processor to fetch the first line of `item`, which is wanted soon. Loops that read from all
/// over memory wait for one line after another otherwise. Where Rust has no such hint, as on AArch64, it
/// does nothing.
#[inline(always)]
#[cfg_attr(not(target_arch = "x86_64"), expect(unused_variables))]
pub(super) fn prefetch<T>(item: &T) {
    #[cfg(target_arch = "x86_64")]
    {
        use core::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        // SAFETY: a hint that reads nothing, of an address that a reference has.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(core::ptr::from_ref(item).cast()) }
    }
}
