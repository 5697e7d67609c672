//! Filters of textures from their definition: an endless lattice of texels, weights as polynomials,
//! `f64`.

use raydsl::texture::{Address, Filter};

/// The texel at place `i` of the endless lattice; `None` is the border.
pub fn texel_at(i: i64, n: i64, address: Address) -> Option<i64> {
    match address {
        Address::Wrap => Some(i.rem_euclid(n)),
        Address::Mirror => {
            let j = i.rem_euclid(2 * n);
            Some(if j < n { j } else { 2 * n - 1 - j })
        }
        Address::Clamp => Some(i.clamp(0, n - 1)),
        Address::Border => (0..n).contains(&i).then_some(i),
    }
}

/// The kernel of a filter at a distance in texels.
fn kernel(filter: Filter, d: f64) -> f64 {
    let d = d.abs();
    match filter {
        Filter::Nearest => unreachable!("its only texel is found by `floor`"),
        Filter::Linear => (1.0 - d).max(0.0),
        Filter::BSpline if d < 1.0 => 2.0 / 3.0 - d * d + d * d * d / 2.0,
        Filter::BSpline => (2.0 - d).max(0.0).powi(3) / 6.0,
        Filter::CatmullRom if d < 1.0 => 1.5 * d.powi(3) - 2.5 * d * d + 1.0,
        Filter::CatmullRom if d < 2.0 => -0.5 * d.powi(3) + 2.5 * d * d - 4.0 * d + 2.0,
        Filter::CatmullRom => 0.0,
    }
}

/// The texels around `x`, which is 1 at the end of `n` texels, and their weights; `None` is the border.
pub fn taps(filter: Filter, n: u32, address: Address, x: f64) -> Vec<(Option<i64>, f64)> {
    let n = i64::from(n);
    let place = x * n as f64;
    let i = place.floor() as i64;
    if filter == Filter::Nearest {
        return vec![(texel_at(i, n, address), 1.0)];
    }
    let all = (i - 3)..=(i + 3);
    all.map(|i| (texel_at(i, n, address), kernel(filter, place - 0.5 - i as f64)))
        .filter(|tap| tap.1 != 0.0)
        .collect()
}
