//! Textures from their definition: an endless lattice of texels, weights as polynomials, `f64`.

use raydsl::prelude::*;
use raydsl::texture::{Address, Filter};

/// The texel at place `i` of the endless lattice; `None` is the border.
fn at(i: i64, n: i64, address: Address) -> Option<i64> {
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

/// The coordinate near the texture that is the same one: repeated ones have the period 2, others are
/// as good as far outside; what is no number is documented.
fn reduced(x: f32, address: Address) -> f64 {
    let repeats = matches!(address, Address::Wrap | Address::Mirror);
    match f64::from(x) {
        x if repeats && x.is_finite() => x.rem_euclid(2.0),
        _ if repeats => 0.0,
        x if x.is_nan() => -100.0,
        x => x.clamp(-100.0, 100.0),
    }
}

/// The texels around a place (`None` is the border) and their weights.
fn taps(filter: Filter, n: u32, address: Address, x: f64) -> Vec<(Option<i64>, f64)> {
    let n = i64::from(n);
    let place = x * n as f64;
    let i = place.floor() as i64;
    if filter == Filter::Nearest {
        return vec![(at(i, n, address), 1.0)];
    }
    let all = (i - 3)..=(i + 3);
    all.map(|i| (at(i, n, address), kernel(filter, place - 0.5 - i as f64)))
        .filter(|tap| tap.1 != 0.0)
        .collect()
}

/// What a filter gives at a coordinate that is off by `off`, of `n` texels, or the border, with these
/// values.
pub(super) fn exact_1d(
    n: u32,
    filter: Filter,
    address: Address,
    x: f32,
    off: f64,
    value: impl Fn(Option<i64>) -> f64,
) -> f64 {
    let taps = taps(filter, n, address, reduced(x, address) + off);
    taps.into_iter().map(|(i, w)| w * value(i)).sum()
}

/// What a texture's filter gives at a point.
pub(super) fn exact_3d(texture: &Texture3<'_, f32>, p: Vec3) -> f64 {
    let (size, config) = (texture.size(), texture.config());
    let [x, y, z] = [0, 1, 2].map(|axis| {
        let address = config.address[axis];
        taps(config.filter, size[axis], address, reduced(p[axis], address))
    });
    let [w, h, _] = size.map(i64::from);
    let mut sum = 0.0;
    for &(z, wz) in &z {
        for &(y, wy) in &y {
            for &(x, wx) in &x {
                let i = (|| Some((z? * h + y?) * w + x?))();
                let texel = i.map_or(config.border.x, |i| texture.texels()[i as usize]);
                sum += wx * wy * wz * f64::from(texel);
            }
        }
    }
    sum
}
