//! Filter taps: texels and weights for a coordinate along one axis.

use super::config::{Address, Filter};
use crate::Type;
use crate::kernel;
use crate::machine::generic::{max, min, select};

/// Index of a texel, or of a row's first, that is outside: the border applies.
pub(super) const OUTSIDE: u32 = u32::MAX;

/// Reduces a coordinate to an equivalent one near the texture: within one period, or not far
/// outside. Where the texture repeats, NaN and infinity become 0.
#[kernel]
fn reduced(x: f32, #[host] address: Address) -> f32 {
    if address == Address::Wrap {
        let c = select(x.is_finite(), x, 0.0);
        // From 0 to 1, which small negative numbers round to.
        c - c.floor()
    } else if address == Address::Mirror {
        let c = select(x.is_finite(), x, 0.0);
        c - 2.0 * (c * 0.5).floor()
    } else {
        // Far enough that none of four texels is inside, even of a single one. In this order NaN
        // becomes -2.
        min(max(-2.0, x), 3.0)
    }
}

/// Returns the texel at position `i` of an axis with `n`: as far outside as filters reach, and for
/// mirrors within two periods.
#[kernel]
fn texel_at(i: i32, n: i32, #[host] address: Address) -> u32 {
    let last = n - 1;
    if address == Address::Wrap {
        let j = if i < 0 { i + n } else { i };
        let k = if j > last { j - n } else { j };
        // Filters are wider than a texture of one texel.
        min(max(k, 0), last) as u32
    } else if address == Address::Mirror {
        let j = if i > last { 2 * n - 1 - i } else { i };
        let k = if j < 0 { -1 - j } else { j };
        min(k, last) as u32
    } else if address == Address::Clamp {
        min(max(i, 0), last) as u32
    } else if i >= 0 && i < n {
        i as u32
    } else {
        OUTSIDE
    }
}

/// Returns the texel at any place `i` of an axis.
#[kernel]
pub(super) fn texel_of(i: i32, size: u32, #[host] address: Address) -> u32 {
    let n = size as i32;
    // Divisions are slow, and most places are inside.
    let is_inside = i >= 0 && i < n;
    if address == Address::Wrap {
        let j = if is_inside { i } else { i.rem_euclid(n) };
        j as u32
    } else if address == Address::Mirror {
        let j = if is_inside { i } else { i.rem_euclid(2 * n) };
        min(j, 2 * n - 1 - j) as u32
    } else {
        texel_at(i, n, address)
    }
}

/// Returns the texel that contains `x`.
#[kernel]
pub(super) fn nearest_texel(x: f32, size: u32, #[host] address: Address) -> u32 {
    let n = size as i32;
    let i = (reduced(x, address) * size as f32).floor() as i32;
    if address == Address::Wrap {
        // A period ends with its last texel: the coordinate may have been rounded up to 1.
        min(i, n - 1) as u32
    } else {
        texel_at(i, n, address)
    }
}

/// Two neighbours and the share of the second.
#[derive(Clone, Copy, Debug, Type)]
pub(super) struct Pair {
    pub(super) first: u32,
    pub(super) second: u32,
    pub(super) share: f32,
}

/// Returns the neighbours of `x`. Index and share come from one number: computed apart, rounding
/// could put them a whole texel off each other.
#[kernel]
pub(super) fn pair(x: f32, size: u32, #[host] address: Address) -> Pair {
    let n = size as i32;
    let place = reduced(x, address) * size as f32 - 0.5;
    let below = place.floor();
    let i = below as i32;
    Pair {
        first: texel_at(i, n, address),
        second: texel_at(i + 1, n, address),
        share: place - below,
    }
}

/// Four neighbours and the weights of all but the second, which has the rest of 1.
#[derive(Clone, Copy, Debug, Type)]
pub(super) struct Four {
    pub(super) first: u32,
    pub(super) second: u32,
    pub(super) third: u32,
    pub(super) fourth: u32,
    pub(super) w1: f32,
    pub(super) w3: f32,
    pub(super) w4: f32,
}

/// Returns the neighbours of `x` for a cubic filter.
#[kernel]
pub(super) fn four(x: f32, size: u32, #[host] address: Address, #[host] filter: Filter) -> Four {
    let n = size as i32;
    let place = reduced(x, address) * size as f32 - 0.5;
    let below = place.floor();
    let i = below as i32;
    let w = weights(place - below, filter);
    Four {
        first: texel_at(i - 1, n, address),
        second: texel_at(i, n, address),
        third: texel_at(i + 1, n, address),
        fourth: texel_at(i + 2, n, address),
        w1: w.first,
        w3: w.third,
        w4: w.fourth,
    }
}

/// Weights of the first, third and fourth of four neighbours.
#[derive(Clone, Copy, Debug, Type)]
struct Weights {
    first: f32,
    third: f32,
    fourth: f32,
}

/// Returns the weights for the share `a` of the way from the second to the third, from 0 to 1.
///
/// They are products of non-negative factors, so rounding never flips a sign: expanded as
/// `1 - 3a + 3a² - a³`, the first weight of the B-spline does become negative near `a = 1`.
#[kernel]
fn weights(a: f32, #[host] filter: Filter) -> Weights {
    let b = 1.0 - a;
    if filter == Filter::BSpline {
        Weights {
            first: b * b * b / 6.0,
            third: (1.0 + 3.0 * a * (1.0 + a * b)) / 6.0,
            fourth: a * a * a / 6.0,
        }
    } else {
        Weights {
            first: -0.5 * (a * b * b),
            third: 0.5 * a * (1.0 + a * (4.0 - 3.0 * a)),
            fourth: -0.5 * (a * a * b),
        }
    }
}
