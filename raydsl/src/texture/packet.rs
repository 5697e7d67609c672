//! Textures in packets. Filter, address modes and levels are selected once per lookup, not per
//! texel; and a filter is a function of its own, compiled once for a type of texels and lanes,
//! however often kernels call it.
//!
//! This repeats the arithmetic of the kernels in `filter` and `sample` for scalar code, WGSL and
//! the reference: the same operations in the same order, for the same bits. Change both together.

use super::config::{Address, ColorSpace, Filter};
use super::sample::{level_start, level_within, size_at};
use super::taps::{OUTSIDE, four, nearest_texel, pair, texel_of};
use super::texel::Texel;
use super::view::Texels;
use crate::Type;
use crate::machine::{Entered, F, Floats, I, Lanes, Machine, Packet, U, Value, X3, fill, op};

/// The machine that computes positions: its kernels are inlined. Those that decode texels are not:
/// the sRGB curve makes them long.
type Inner<L> = Packet<Entered<L>>;

/// Value of texels of type `T`.
type Given<L, T> = <<T as Texel>::Value as Type>::On<Packet<L>>;

impl<T: Texel> Texels<'_, T> {
    /// Looks up the texture at positions of `D` axes.
    #[inline(always)]
    pub(crate) fn in_packet<L: Lanes, const D: usize>(
        &self,
        m: &Packet<L>,
        at: &[F<Packet<L>>; D],
    ) -> Given<L, T> {
        filtered(m, self, at, None)
    }

    /// Looks up the texture at positions of `D` axes and levels of detail.
    #[inline(always)]
    pub(crate) fn in_packet_at_level<L: Lanes, const D: usize>(
        &self,
        m: &Packet<L>,
        at: &[F<Packet<L>>; D],
        level: F<Packet<L>>,
    ) -> Given<L, T> {
        if self.has_levels() { leveled(m, self, at, level) } else { filtered(m, self, at, None) }
    }

    /// Fetches texels at places of `D` axes and levels.
    #[inline(always)]
    pub(crate) fn fetched_in_packet<L: Lanes, const D: usize>(
        &self,
        m: &Packet<L>,
        at: &[I<Packet<L>>; D],
        level: U<Packet<L>>,
    ) -> Given<L, T> {
        if self.has_levels() {
            fetched_at_level(m, self, at, level)
        } else {
            fetched(m, self, at, None)
        }
    }
}

/// Size of a level, and its first texel.
struct Extent<L: Lanes> {
    size: [L::U32; 3],
    first: L::U32,
}

/// Filters a level at a position; level 0 if no other is given.
#[inline(always)]
fn filtered<L: Lanes, T: Texel, const D: usize>(
    m: &Packet<L>,
    texels: &Texels<'_, T>,
    at: &[F<Packet<L>>; D],
    extent: Option<&Extent<L>>,
) -> Given<L, T> {
    match texels.config.filter {
        Filter::Nearest => nearest(m, texels, at, extent),
        Filter::Linear => linear(m, texels, at, extent),
        Filter::BSpline | Filter::CatmullRom => cubic(m, texels, at, extent),
    }
}

/// Filters one level, or blends two neighbours, by the texture's
/// [`LevelFilter`](super::LevelFilter).
#[inline(never)]
fn leveled<L: Lanes, T: Texel, const D: usize>(
    m: &Packet<L>,
    texels: &Texels<'_, T>,
    at: &[F<Packet<L>>; D],
    level: F<Packet<L>>,
) -> Given<L, T> {
    let l = m.lanes();
    l.enter_again(
        #[inline(always)]
        || {
            let inner = &Packet::with_mask(Entered::new(l), m.active());
            let last = l.u32(texels.levels - 1);
            let place = level_within::on(inner, F(level.0), U(last)).0;
            if !texels.blends_levels() {
                let nearest = l.f32_unary(op::Floor, l.f32_binary(op::Add, place, l.f32(0.5)));
                let extent = Extent::of(inner, texels, l.f32_to_u32(nearest));
                return filtered(m, texels, at, Some(&extent));
            }
            let finer = l.f32_unary(op::Floor, place);
            let share = l.f32_binary(op::Sub, place, finer);
            let finer = l.f32_to_u32(finer);
            let extent = Extent::of(inner, texels, finer);
            let a = filtered(m, texels, at, Some(&extent));
            let is_last = l.u32_compare(op::Ge, finer, last);
            let b = filtered(m, texels, at, Some(&extent.next(inner, texels, finer, is_last)));
            blend(m, a, b, share)
        },
    )
}

/// Fetches a texel of one level, or of the last one if there are fewer.
#[inline(never)]
fn fetched_at_level<L: Lanes, T: Texel, const D: usize>(
    m: &Packet<L>,
    texels: &Texels<'_, T>,
    at: &[I<Packet<L>>; D],
    level: U<Packet<L>>,
) -> Given<L, T> {
    let l = m.lanes();
    l.enter_again(
        #[inline(always)]
        || {
            let inner = &Packet::with_mask(Entered::new(l), m.active());
            let last = l.u32(texels.levels - 1);
            let is_beyond = l.u32_compare(op::Lt, last, level.0);
            let level = l.u32_select(is_beyond, last, level.0);
            fetched(m, texels, at, Some(&Extent::of(inner, texels, level)))
        },
    )
}

impl<L: Lanes> Extent<L> {
    /// Returns the extent of a level.
    #[inline(always)]
    fn of<T: Texel>(m: &Inner<L>, texels: &Texels<'_, T>, level: L::U32) -> Self {
        let l = m.lanes();
        let [w, h, d] = texels.size;
        let whole = X3 { x: U(l.u32(w)), y: U(l.u32(h)), z: U(l.u32(d)) };
        let first = level_start::on(m, whole, U(level)).0;
        Self { size: Self::size(m, texels, level), first }
    }

    #[inline(always)]
    fn size<T: Texel>(m: &Inner<L>, texels: &Texels<'_, T>, level: L::U32) -> [L::U32; 3] {
        fill(
            #[inline(always)]
            |axis| size_at::on(m, U(m.lanes().u32(texels.size[axis])), U(level)).0,
        )
    }

    /// Returns the extent of the level after this one, which is `level`; this one again if it is
    /// the last.
    #[inline(always)]
    fn next<T: Texel>(
        &self,
        m: &Inner<L>,
        texels: &Texels<'_, T>,
        level: L::U32,
        is_last: L::Mask,
    ) -> Self {
        let l = m.lanes();
        let up = l.u32_select(is_last, l.u32(0), l.u32(1));
        let [w, h, d] = self.size;
        let texels_here = l.u32_binary(op::Mul, l.u32_binary(op::Mul, w, h), d);
        let behind = l.u32_binary(op::Add, self.first, texels_here);
        Self {
            size: Self::size(m, texels, l.u32_binary(op::Add, level, up)),
            first: l.u32_select(is_last, self.first, behind),
        }
    }
}

/// Runs a filter as a function compiled for the lanes' level.
#[inline(always)]
fn entered<L: Lanes, T: Texel>(
    m: &Packet<L>,
    texels: &Texels<'_, T>,
    extent: Option<&Extent<L>>,
    filter: impl FnOnce(&Places<'_, L, T>) -> Given<L, T>,
) -> Given<L, T> {
    // A declared variable without a texture yet.
    if texels.all.is_empty() {
        return Value::zero(m);
    }
    m.lanes().enter_again(
        #[inline(always)]
        || filter(&Places::of(m, texels, extent)),
    )
}

#[inline(never)]
fn nearest<L: Lanes, T: Texel, const D: usize>(
    m: &Packet<L>,
    texels: &Texels<'_, T>,
    at: &[F<Packet<L>>; D],
    extent: Option<&Extent<L>>,
) -> Given<L, T> {
    entered(
        m,
        texels,
        extent,
        #[inline(always)]
        |places| {
            let mut index = places.first;
            for axis in (0..D).rev() {
                let (size, address) = places.axis(axis);
                let i = nearest_texel::on(&places.inner, F(at[axis].0), size, address);
                index = places.part(index, axis, i.0);
            }
            let [value] = places.values(&[index], 1);
            value
        },
    )
}

#[inline(never)]
fn fetched<L: Lanes, T: Texel, const D: usize>(
    m: &Packet<L>,
    texels: &Texels<'_, T>,
    at: &[I<Packet<L>>; D],
    extent: Option<&Extent<L>>,
) -> Given<L, T> {
    entered(
        m,
        texels,
        extent,
        #[inline(always)]
        |places| {
            let mut index = places.first;
            for axis in (0..D).rev() {
                let (size, address) = places.axis(axis);
                let i = texel_of::on(&places.inner, I(at[axis].0), size, address);
                index = places.part(index, axis, i.0);
            }
            let [value] = places.values(&[index], 1);
            value
        },
    )
}

#[inline(never)]
fn linear<L: Lanes, T: Texel, const D: usize>(
    m: &Packet<L>,
    texels: &Texels<'_, T>,
    at: &[F<Packet<L>>; D],
    extent: Option<&Extent<L>>,
) -> Given<L, T> {
    entered(
        m,
        texels,
        extent,
        #[inline(always)]
        |places| {
            let l = m.lanes();
            let (mut taps, mut shares) = ([[l.u32(0); 2]; 3], [l.f32(0.0); 3]);
            for axis in 0..D {
                let (size, address) = places.axis(axis);
                let found = pair::on(&places.inner, F(at[axis].0), size, address);
                (taps[axis], shares[axis]) = ([found.first.0, found.second.0], found.share.0);
            }
            // Unrolled by hand, so that each loop along an axis has a known length and is unrolled
            // too.
            let mut indices = [places.first; 8];
            if const { D > 2 } {
                places.split(2, &taps[2], &mut indices, 1 << (D - 3));
            }
            if const { D > 1 } {
                places.split(1, &taps[1], &mut indices, 1 << (D - 2));
            }
            places.split(0, &taps[0], &mut indices, 1 << (D - 1));
            let mut values = places.values(&indices, 1 << D);
            join(m, shares[0], &mut values, 1 << (D - 1));
            if const { D > 1 } {
                join(m, shares[1], &mut values, 1 << (D - 2));
            }
            if const { D > 2 } {
                join(m, shares[2], &mut values, 1 << (D - 3));
            }
            values[0]
        },
    )
}

/// Blends pairs of values; the second one has the share.
#[inline(always)]
fn join<M: Machine, V: Value<M>>(m: &M, share: M::F32, values: &mut [V; 8], count: usize) {
    for i in 0..count {
        values[i] = blend(m, values[2 * i], values[2 * i + 1], share);
    }
}

#[inline(never)]
fn cubic<L: Lanes, T: Texel, const D: usize>(
    m: &Packet<L>,
    texels: &Texels<'_, T>,
    at: &[F<Packet<L>>; D],
    extent: Option<&Extent<L>>,
) -> Given<L, T> {
    entered(
        m,
        texels,
        extent,
        #[inline(always)]
        |places| {
            let l = m.lanes();
            let filter = texels.config.filter;
            let mut weights = [[l.f32(0.0); 3]; D];
            let mut taps = [[l.u32(0); 4]; D];
            for axis in 0..D {
                let (size, address) = places.axis(axis);
                let found = four::on(&places.inner, F(at[axis].0), size, address, filter);
                weights[axis] = [found.w1.0, found.w3.0, found.w4.0];
                taps[axis] = [found.first.0, found.second.0, found.third.0, found.fourth.0];
            }
            // Find the rows along the first axis.
            let mut rows = [places.first; 16];
            for axis in (1..D).rev() {
                for i in (0..1 << (2 * (D - 1 - axis))).rev() {
                    let start = rows[i];
                    for k in 0..4 {
                        rows[4 * i + k] = places.part(start, axis, taps[axis][k]);
                    }
                }
            }
            let mut values = [Given::<L, T>::zero(m); 16];
            for i in 0..1 << (2 * (D - 1)) {
                let row = fill(
                    #[inline(always)]
                    |k| places.part(rows[i], 0, taps[0][k]),
                );
                values[i] = blend4(m, &places.values(&row, 4), &weights[0]);
            }
            for (axis, weights) in weights.iter().enumerate().skip(1) {
                for i in 0..1 << (2 * (D - 1 - axis)) {
                    let column = fill(
                        #[inline(always)]
                        |k| values[4 * i + k],
                    );
                    values[i] = blend4(m, &column, weights);
                }
            }
            values[0]
        },
    )
}

/// Level of a texture, and the layout of its texels.
struct Places<'t, L: Lanes, T: Texel> {
    m: &'t Packet<L>,
    inner: Inner<L>,
    texels: &'t Texels<'t, T>,
    size: [L::U32; 3],
    first: L::U32,
    /// Stride along each axis.
    steps: [L::U32; 3],
    /// Whether a position may be outside.
    has_border: bool,
}

impl<'t, L: Lanes, T: Texel> Places<'t, L, T> {
    #[inline(always)]
    fn of(m: &'t Packet<L>, texels: &'t Texels<'t, T>, extent: Option<&Extent<L>>) -> Self {
        let l = m.lanes();
        let (size, first) = match extent {
            Some(extent) => (extent.size, extent.first),
            None => {
                let [w, h, d] = texels.size;
                ([l.u32(w), l.u32(h), l.u32(d)], l.u32(0))
            }
        };
        let steps = [l.u32(1), size[0], l.u32_binary(op::Mul, size[0], size[1])];
        let inner = Packet::with_mask(Entered::new(l), m.active());
        Self { m, inner, texels, size, first, steps, has_border: texels.has_border() }
    }

    /// Returns the size and the address mode of an axis.
    #[inline(always)]
    fn axis(&self, axis: usize) -> (U<Inner<L>>, Address) {
        (U(self.size[axis]), self.texels.config.address[axis])
    }

    /// Returns the first texel of part `i` along an axis, from `first` on.
    #[inline(always)]
    fn part(&self, first: L::U32, axis: usize, i: L::U32) -> L::U32 {
        let l = self.m.lanes();
        let steps = if axis == 0 { i } else { l.u32_binary(op::Mul, i, self.steps[axis]) };
        let inside = l.u32_binary(op::Add, first, steps);
        if !self.has_border {
            return inside;
        }
        let outside = l.u32(OUTSIDE);
        let (a, b) = (l.u32_compare(op::Eq, first, outside), l.u32_compare(op::Eq, i, outside));
        l.u32_select(l.mask_binary(op::Or, a, b), outside, inside)
    }

    /// Splits each index in two along an axis: neighbours along the first axis are consecutive.
    #[inline(always)]
    fn split(&self, axis: usize, &[a, b]: &[L::U32; 2], indices: &mut [L::U32; 8], count: usize) {
        for i in (0..count).rev() {
            let start = indices[i];
            indices[2 * i] = self.part(start, axis, a);
            indices[2 * i + 1] = self.part(start, axis, b);
        }
    }

    /// Returns the values of the first `count` texels, or of the border outside. Inactive lanes
    /// have one too: whatever their coordinates, indices are inside or [`OUTSIDE`].
    #[inline(always)]
    fn values<const N: usize>(&self, places: &[L::U32; N], count: usize) -> [Given<L, T>; N] {
        let mut values = [Given::<L, T>::zero(self.m); N];
        if self.has_border || self.texels.config.color_space != ColorSpace::Linear {
            values_apart(self.m, self.texels, &places[..count], &mut values[..count]);
            return values;
        }
        for i in 0..count {
            values[i] = inside(self.m, self.texels, &places[i], ColorSpace::Linear);
        }
        values
    }
}

/// Implements [`Places::values`] for any texture, in a function that all filters share.
#[inline(never)]
fn values_apart<L: Lanes, T: Texel>(
    m: &Packet<L>,
    texels: &Texels<'_, T>,
    places: &[L::U32],
    values: &mut [Given<L, T>],
) {
    let l = m.lanes();
    l.enter_again(
        #[inline(always)]
        || {
            let border = T::Value::splat(m, texels.border());
            for (place, value) in places.iter().zip(values) {
                let is_outside = l.u32_compare(op::Eq, *place, l.u32(OUTSIDE));
                let place = l.u32_select(is_outside, l.u32(0), *place);
                let texel = inside(m, texels, &place, texels.config.color_space);
                *value = select(m, is_outside, border, texel);
            }
        },
    );
}

/// Returns the values of texels inside the texture.
#[inline(always)]
fn inside<L: Lanes, T: Texel>(
    m: &Packet<L>,
    texels: &Texels<'_, T>,
    places: &L::U32,
    space: ColorSpace,
) -> Given<L, T> {
    let texel = T::gather(
        m,
        #[inline(always)]
        |lane| texels.all[L::u32_lane(places, lane) as usize],
    );
    T::decode_on(m, texel, space)
}

/// Blends as [`Blend::blend`](super::Blend::blend).
#[inline(always)]
fn blend<M: Machine, V: Value<M>>(m: &M, a: V, b: V, share: M::F32) -> V {
    sum(m, a, way(m, b, a, share))
}

/// Blends as [`Blend::blend4`](super::Blend::blend4), with the neighbours in their order.
#[inline(always)]
fn blend4<M: Machine, V: Value<M>>(
    m: &M,
    &[first, second, third, fourth]: &[V; 4],
    &[w1, w3, w4]: &[M::F32; 3],
) -> V {
    let beside = sum(m, way(m, first, second, w1), way(m, third, second, w3));
    sum(m, second, sum(m, beside, way(m, fourth, second, w4)))
}

#[inline(always)]
fn sum<M: Machine, V: Value<M>>(m: &M, a: V, b: V) -> V {
    V::zip(
        m,
        a,
        b,
        &mut Floats(
            #[inline(always)]
            |m: &M, a, b| m.f32_binary(op::Add, a, b),
        ),
    )
}

/// Returns `(to - from) * w`.
#[inline(always)]
fn way<M: Machine, V: Value<M>>(m: &M, to: V, from: V, w: M::F32) -> V {
    V::zip(
        m,
        to,
        from,
        &mut Floats(
            #[inline(always)]
            |m: &M, a, b| m.f32_binary(op::Mul, m.f32_binary(op::Sub, a, b), w),
        ),
    )
}

/// Selects `a` where the condition is true, `b` elsewhere. Values of textures have floats only.
#[inline(always)]
fn select<M: Machine, V: Value<M>>(m: &M, condition: M::Bool, a: V, b: V) -> V {
    V::zip(
        m,
        a,
        b,
        &mut Floats(
            #[inline(always)]
            |m: &M, a, b| m.f32_select(condition, a, b),
        ),
    )
}
