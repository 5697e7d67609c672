//! Where the primitives of a scene are.

use raydsl::prelude::*;

use super::{Choices, Subject};

/// Up to a hundred primitives, somewhere.
pub(super) fn chosen<P: Subject>(choices: &mut Choices<'_>) -> Vec<P> {
    let count = choices.pick(&[3, 0, 1, 2, 20, 60, 100]);
    let unit = choices.pick(&[1.0, 1e-6, 1e-3, 1e6, 1e9]);
    let center = choices.point() * unit * choices.pick(&[0.0, 1.0, 1000.0]);
    let size = unit * choices.pick(&[0.2, 0.01, 1.0]);
    let kind = choices.below(8);
    let mut prims: Vec<P> = Vec::with_capacity(count);
    for k in 0..count {
        let at = center + unit * place(choices, kind, k);
        let prim = match (kind, prims.first()) {
            // The same one, over and over.
            (1, Some(first)) => *first,
            _ => P::chosen(choices, at, size),
        };
        prims.push(prim);
    }
    match (choices.below(10), prims.first_mut()) {
        // One that dwarfs the others.
        (1, Some(first)) => *first = P::chosen(choices, center, 1000.0 * unit),
        (2, Some(first)) => *first = P::chosen(choices, Vec3::splat(f32::NAN), unit),
        (3, Some(first)) => *first = P::chosen(choices, Vec3::splat(f32::INFINITY), unit),
        _ => {}
    }
    prims
}

/// Where the primitive `k` is.
fn place(choices: &mut Choices<'_>, kind: usize, k: usize) -> Vec3 {
    let k = k as f32;
    match kind {
        // In one place, on a line, on a slanted one, in a plane, on a lattice, ever closer to a
        // point.
        2 => Vec3::ZERO,
        3 => vec3(0.01 * k, 0.0, 0.0),
        4 => Vec3::ONE * 0.01 * k,
        5 => choices.point() * vec3(1.0, 0.0, 1.0),
        6 => vec3(k % 4.0, (k / 4.0).floor() % 4.0, (k / 16.0).floor()),
        7 => Vec3::ONE * 0.5f32.powf(k),
        _ => choices.point(),
    }
}

/// Replaces some primitives by others.
pub(super) fn move_some<P: Subject>(choices: &mut Choices<'_>, prims: &mut [P]) {
    for _ in 0..choices.below(8) {
        if let Some(prim) = prims.get_mut(choices.below(100)) {
            let at = choices.point() * choices.pick(&[1.0, 100.0]);
            *prim = P::chosen(choices, at, 0.3);
        }
    }
}
