//! Random numbers, sequences and warps.

mod convergence;
mod warps;
mod words;

use crate::row::{Group, Row};

pub(crate) const GROUP: Group = Group {
    name: "sampling",
    title: "Random numbers, sequences and warps",
    clauses: &[
        "Numbers are at least 0 and below 1, and log(1 - u) is finite, for all 2^32 words (the last \
         thousand always, the others as far as the count goes).",
        "Hashes and sequences are the same integers in every variant, and those of their papers.",
        "Samples of neighbouring pixels and of two dimensions are uncorrelated: below \
         4 / sqrt(n), which is the figure's unit.",
        "Samples of every warp have its density: the chi-square of 64 x 64 bins is within 5 \
         standard deviations, or of 16 x 16 below 100,000 samples.",
        "Densities are right to 1e-4, and so integrate to 1 within 1e-4.",
        "A warp's inverse returns the sample's numbers to 1e-6, in a table of its cell.",
        "Errors fall as theory says: with the power -1/2 of the number of random samples, -1 of \
         stratified ones, and of Owen-scrambled Sobol ones below -1.2.",
    ],
    rows,
};

fn rows() -> Vec<Row> {
    words::rows().into_iter().chain(warps::rows()).chain(convergence::rows()).collect()
}
