//! How samples are taken, and how many a pass adds.

use raydsl::prelude::Sampling;

/// The sampling of the page's pictures.
pub const SAMPLING: Sampling = Sampling::new(256);

/// The most samples of a pass: a page answers between passes only.
const LARGEST: u32 = 8;

/// Returns the number of samples of the pass behind `done` samples, of `limit` in all: twice as many
/// as before at most. It depends on nothing else, so that a page has the same film as any program
/// that adds the same passes.
pub fn next_pass(done: u32, limit: u32) -> u32 {
    done.clamp(1, LARGEST).min(limit.saturating_sub(done))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_grow_and_reach_the_limit() {
        let mut passes = Vec::new();
        let mut done = 0;
        while done < 35 {
            passes.push(next_pass(done, 35));
            done += next_pass(done, 35);
        }
        assert_eq!(passes, [1, 1, 2, 4, 8, 8, 8, 3]);
        assert_eq!(next_pass(35, 35), 0);
        assert_eq!(next_pass(36, 35), 0);
    }
}
