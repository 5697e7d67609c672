//! Counter-based random numbers and the lattice noise that is built on them.
//!
//! Every value is a function of a seed and an index. No generator state runs along with
//! the points, hence a point comes out the same whichever thread makes it, in any order.

/// Spreads the bits of `index` under `seed`: the finaliser of `SplitMix64`.
pub(super) fn hash(seed: u64, index: u64) -> u64 {
    let mut z = seed ^ index.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// Uniform in `0.0..1.0`.
pub(super) fn unit(seed: u64, index: u64) -> f64 {
    const STEP: f64 = 1.0 / (1u64 << 53) as f64;
    (hash(seed, index) >> 11) as f64 * STEP
}

/// Uniform in `low..high`.
pub(super) fn range(seed: u64, index: u64, low: f64, high: f64) -> f64 {
    low + (high - low) * unit(seed, index)
}

/// 0 below `low`, 1 above `high`, smooth between them.
pub(super) fn smoothstep(low: f64, high: f64, x: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Linear interpolation.
pub(super) fn mix(a: f64, b: f64, t: f64) -> f64 {
    a + (b - a) * t
}

/// Splits a lattice coordinate into its cell and a smoothed fraction.
fn lattice(x: f64) -> (i64, f64) {
    let cell = x.floor();
    let f = x - cell;
    (cell as i64, f * f * (3.0 - 2.0 * f))
}

/// A lattice node's value. One multiplicative hash is enough here: neighbours differ in
/// several bits before the finaliser sees them.
fn node(seed: u64, x: i64, y: i64, z: i64) -> f64 {
    let index = (x as u64)
        .wrapping_mul(0x8da6_b343)
        .wrapping_add((y as u64).wrapping_mul(0xd816_3841))
        .wrapping_add((z as u64).wrapping_mul(0xcb1a_b31f));
    unit(seed, index)
}

/// Value noise in the plane, `-1.0..1.0`, features one unit wide.
pub(super) fn noise2(seed: u64, x: f64, y: f64) -> f64 {
    let ((ix, fx), (iy, fy)) = (lattice(x), lattice(y));
    let row = |y| mix(node(seed, ix, y, 0), node(seed, ix + 1, y, 0), fx);
    mix(row(iy), row(iy + 1), fy) * 2.0 - 1.0
}

/// Value noise in space, `-1.0..1.0`, features one unit wide.
pub(super) fn noise3(seed: u64, p: [f64; 3]) -> f64 {
    let [(ix, fx), (iy, fy), (iz, fz)] = p.map(lattice);
    let row = |y, z| mix(node(seed, ix, y, z), node(seed, ix + 1, y, z), fx);
    let slice = |z| mix(row(iy, z), row(iy + 1, z), fy);
    mix(slice(iz), slice(iz + 1), fz) * 2.0 - 1.0
}

/// Octaves of [`noise2`] with halved amplitudes, `-1.0..1.0`.
pub(super) fn fractal(seed: u64, x: f64, y: f64, octaves: u32) -> f64 {
    // A rotation between octaves keeps the lattices from lining up.
    const TURN: (f64, f64) = (0.8, 0.6);
    let (mut x, mut y) = (x, y);
    let (mut sum, mut amplitude, mut total) = (0.0, 1.0, 0.0);
    for octave in 0..octaves {
        sum += amplitude * noise2(seed.wrapping_add(u64::from(octave)), x, y);
        total += amplitude;
        amplitude *= 0.5;
        (x, y) = (2.0 * (TURN.0 * x - TURN.1 * y), 2.0 * (TURN.1 * x + TURN.0 * y));
    }
    sum / total
}
