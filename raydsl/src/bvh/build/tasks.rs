//! Parallel execution with the `parallel` feature, sequential without.
//!
//! Work is cut into pieces by size alone, never by the number of threads, and results come back in
//! the order of the pieces: the tree does not depend on who did which piece.

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
pub(in crate::bvh) fn map_pieces<T: Sync, R: Send>(
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

/// Maps pieces as [`map_pieces`] does, with mutable access.
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

/// Sorts without stability: equal items are identical.
pub(super) fn sort<T: Ord + Send>(items: &mut [T]) {
    #[cfg(feature = "parallel")]
    rayon::slice::ParallelSliceMut::par_sort_unstable(items);
    #[cfg(not(feature = "parallel"))]
    items.sort_unstable();
}
