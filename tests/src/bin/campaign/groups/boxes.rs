//! Rays at boxes where a box test is easily wrong, through a tree.

use raydsl::prelude::*;
use raydsl_tests::hard_rays::boxes::{self, EXPONENTS, ROWS};

use super::fault;
use crate::outcome::Outcome;
use crate::row::{Bound, Group, Row, Unit};

pub(crate) const GROUP: Group = Group {
    name: "boxes",
    title: "Boxes of trees, at five sizes from 1e-15 to 1e15",
    clauses: &[
        "No ray misses a box that it meets.",
        "A ray with a NaN or an infinity hits nothing.",
        "A batch of which half the rays have one takes at most 2.5 times as long as one without.",
    ],
    rows,
};

/// Trees at each size.
const TREES: u64 = 16;

fn rows() -> Vec<Row> {
    ROWS.iter().map(lost).collect()
}

/// The textbook is the test in IEEE arithmetic, with nothing allowed for rounding, without a tree.
fn lost(row: &'static boxes::Row) -> Row {
    Row::new(row.name, 1, Unit::Faults, Bound::NONE, |run| {
        let mut all = Outcome::default();
        let mut textbook = 0.0;
        let share = 1.0 / (EXPONENTS.len() as f64 * TREES as f64);
        for (i, exponent) in EXPONENTS.into_iter().enumerate() {
            let scale = 2.0f32.powi(exponent);
            for seed in 0..TREES {
                let marks = boxes::marks(row, seed);
                let scene = boxes::at_scale(&marks, scale);
                let bvh = Bvh::build(&scene)?;
                let kernels = [
                    kernel!(|ray: Ray| bvh.closest_hit(ray).is_hit),
                    kernel!(|ray: Ray| bvh.any_hit(ray)),
                ];
                let part = run.part(share, i as u64 * TREES + seed);
                // One tree at each size: another one is sent to the device, and asked little.
                let part = if seed == 0 { part } else { part.without_wgsl() };
                let ray = |rng: &mut _| boxes::ray(rng, row, &marks, scale);
                let outcome =
                    part.measure(&kernels, |rng| (ray(rng),), |_, is_hit| fault(!is_hit))?;
                all.merge(run.unit, outcome);
                textbook += share
                    * part.broken_by(part.count / 100, |rng| {
                        !boxes::textbook(&marks, scale, &ray(rng))
                    });
            }
        }
        Ok(all.beside(textbook))
    })
}
