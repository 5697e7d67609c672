//! Textures by the definition of their filters, also at coordinates that are far outside or no number.

use raydsl::prelude::*;
use raydsl::texture::{Address, Filter};
use raydsl_tests::filters::taps;

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
