//! Tabulated densities.

use raydsl::prelude::*;
use raydsl::sampling::invert_table_2d;
use raydsl_tests::rng::Rng as Source;
use raydsl_tests::scaled;

use crate::statistics::{SIDE, assert_distributed, histogram, shares};

/// Weights over many orders of magnitude, some 0.
fn weights(count: usize) -> Vec<f32> {
    let mut rng = Source::new(12);
    let mut weight = || if rng.below(5) == 0 { 0.0 } else { 10f32.powf(rng.range(-2.0, 2.0)) };
    (0..count).map(|_| weight()).collect()
}

#[test]
fn squares() -> Result<(), Box<dyn std::error::Error>> {
    let all = weights(SIDE * SIDE);
    let table = Distribution2d::new(&all, UVec2::splat(SIDE as u32))?;
    let counts = histogram("table of a square", |rng| {
        let sample = sample_table_2d(rng.next_2d(), table.cdf(), table.size());
        assert!(sample.pdf > 0.0);
        [sample.point.x, sample.point.y].map(f64::from)
    });
    let pdf =
        |x: f64, y: f64| table_2d_pdf(vec2(x as f32, y as f32), table.cdf(), table.size()).into();
    assert_distributed("table of a square", &counts, &shares([2, 2], pdf));
    // The density is that of the weights, to within what rounding of shares does.
    let sum: f64 = all.iter().copied().map(f64::from).sum();
    for (share, weight) in shares([1, 1], pdf).iter().zip(&all) {
        assert!((share - f64::from(*weight) / sum).abs() < 1e-7);
    }
    Ok(())
}

/// Bins and cells that do not fit each other.
#[test]
fn lines() -> Result<(), Box<dyn std::error::Error>> {
    let all = weights(37);
    let table = Distribution1d::new(&all)?;
    let counts = histogram("table of a line", |rng| {
        let u = rng.next_2d();
        [sample_table(u.x, table.cdf()).x, u.y].map(f64::from)
    });
    // As many midpoints as make cells' edges lie between them.
    let pdf = |x: f64, _: f64| f64::from(table_pdf(x as f32, table.cdf()));
    assert_distributed("table of a line", &counts, &shares([37, 1], pdf));
    let mean = all.iter().copied().map(f64::from).sum::<f64>() / 37.0;
    assert!((table.integral() - mean).abs() < 1e-12 * mean);
    Ok(())
}

#[test]
fn samples_come_back() -> Result<(), Box<dyn std::error::Error>> {
    let mut rng = Source::new(5);
    for (columns, rows) in [(1, 1), (1, 7), (300, 1), (64, 33), (4097, 49)] {
        let table =
            Distribution2d::new(&weights(columns * rows), uvec2(columns as u32, rows as u32));
        let Ok(table) = table else { continue };
        for _ in 0..scaled(100_000) {
            let u = vec2(rng.unit(), rng.unit());
            let sample = sample_table_2d(u, table.cdf(), table.size());
            // The point lies in its cell, however it is rounded.
            let pdf = table_2d_pdf(sample.point, table.cdf(), table.size());
            assert_eq!(pdf, sample.pdf, "{columns} by {rows}: {u}");
            let back = invert_table_2d(sample.point, table.cdf(), table.size());
            // A cell's place is rounded to 2^-24 of the table, which is more of a heavy cell.
            let off = (back - u).abs() / sample.pdf.max(1.0);
            assert!(off.max_element() < 1e-6, "{columns} by {rows}: {u} {back}");
        }
    }
    Ok(())
}
