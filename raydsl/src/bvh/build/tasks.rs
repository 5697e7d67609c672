//! Work in parallel where the `parallel` feature gives threads, one after the other where not.
//!
//! What is cut into pieces here is cut by size alone, never by the number of threads, and results
//! come back in the order of the pieces: the tree does not depend on who did which piece.

/// Runs both, possibly at the same time.
#[cfg(feature = "parallel")]
pub(super) fn join<A: Send, B: Send>(
    a: impl FnOnce() -> A + Send,
    b: impl FnOnce() -> B + Send,
) -> (A, B) {
    rayon::join(a, b)
}

/// Runs both.
#[cfg(not(feature = "parallel"))]
pub(super) fn join<A: Send, B: Send>(
    a: impl FnOnce() -> A + Send,
    b: impl FnOnce() -> B + Send,
) -> (A, B) {
    (a(), b())
}

/// Maps the pieces of `size` items (the last may be shorter), possibly at the same time; `f` also
/// gets the index of the piece's first item.
pub(super) fn map_pieces<T: Sync, R: Send>(
    items: &[T],
    size: usize,
    f: impl Fn(usize, &[T]) -> R + Sync,
) -> Vec<R> {
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        items.par_chunks(size).enumerate().map(|(k, piece)| f(k * size, piece)).collect()
    }
    #[cfg(not(feature = "parallel"))]
    items.chunks(size).enumerate().map(|(k, piece)| f(k * size, piece)).collect()
}

/// [`map_pieces`] for pieces that are written.
pub(in crate::bvh) fn map_pieces_mut<T: Send, R: Send>(
    items: &mut [T],
    size: usize,
    f: impl Fn(usize, &mut [T]) -> R + Sync,
) -> Vec<R> {
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        items.par_chunks_mut(size).enumerate().map(|(k, piece)| f(k * size, piece)).collect()
    }
    #[cfg(not(feature = "parallel"))]
    items.chunks_mut(size).enumerate().map(|(k, piece)| f(k * size, piece)).collect()
}

/// Maps all items, in pieces of at least `size` of them.
pub(in crate::bvh) fn map<T: Sync, R: Send>(
    items: &[T],
    size: usize,
    f: impl Fn(&T) -> R + Sync + Send,
) -> Vec<R> {
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        items.par_iter().with_min_len(size).map(f).collect()
    }
    #[cfg(not(feature = "parallel"))]
    {
        let _ = size;
        items.iter().map(f).collect()
    }
}

/// Sorts; equal items are the same, so that their order is of no account.
pub(super) fn sort<T: Ord + Send>(items: &mut [T]) {
    #[cfg(feature = "parallel")]
    rayon::slice::ParallelSliceMut::par_sort_unstable(items);
    #[cfg(not(feature = "parallel"))]
    items.sort_unstable();
}
