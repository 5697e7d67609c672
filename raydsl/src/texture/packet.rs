//! Textures in packets. Filter, address modes and levels are decided once for a place, not for each
//! texel; and what reads a kind of textures is a function of its own, compiled once, however often
//! kernels call it.
//!
//! The arithmetic is that of the kernels in `filter` and `sample`, in the same order, so that its
//! results have the same bits.

use super::config::{Address, ColorSpace, Filter, LevelFilter};
use super::sample::{level_start, level_within, size_at};
use super::taps::{OUTSIDE, four, nearest_texel, pair};
use super::texel::Texel;
use super::view::Texels;
use crate::Type;
use crate::machine::{Entered, F, Lanes, Leaves, Machine, Packet, U, Value, X3, fill, op};

/// The machine that finds places: its kernels are inlined. Those that decode texels are not, which the
/// curve of sRGB makes long.
type Inner<L> = Packet<Entered<L>>;

/// What texels of type `T` give.
type Given<L, T> = <<T as Texel>::Value as Type>::On<Packet<L>>;

impl<T: Texel> Texels<'_, T> {
    /// What the texture has at places of `D` axes.
    #[inline(always)]
    pub(crate) fn in_packet<L: Lanes, const D: usize>(
        &self,
        m: &Packet<L>,
        at: &[F<Packet<L>>; D],
    ) -> Given<L, T> {
        filtered::<L, T, D>(m, self, &places(at), None)
    }

    /// The same at levels of detail.
    #[inline(always)]
    pub(crate) fn in_packet_at_level<L: Lanes, const D: usize>(
        &self,
        m: &Packet<L>,
        at: &[F<Packet<L>>; D],
        level: F<Packet<L>>,
    ) -> Given<L, T> {
        if self.has_levels() {
            leveled::<L, T, D>(m, self, &places(at), &level.0)
        } else {
            filtered::<L, T, D>(m, self, &places(at), None)
        }
    }
}

/// Coordinates; of axes that there are not, what is not read.
#[inline(always)]
fn places<L: Lanes, const D: usize>(at: &[F<Packet<L>>; D]) -> [L::F32; 3] {
    fill(
        #[inline(always)]
        |axis| at[axis.min(D - 1)].0,
    )
}

/// Where a level begins, and its size.
struct Extent<L: Lanes> {
    size: [L::U32; 3],
    first: L::U32,
}

/// What a level has at a place; level 0 if no other is given.
#[inline(always)]
fn filtered<L: Lanes, T: Texel, const D: usize>(
    m: &Packet<L>,
    texels: &Texels<'_, T>,
    at: &[L::F32; 3],
    extent: Option<&Extent<L>>,
) -> Given<L, T> {
    match texels.config.filter {
        Filter::Nearest => nearest::<L, T, D>(m, texels, at, extent),
        Filter::Linear => linear::<L, T, D>(m, texels, at, extent),
        Filter::BSpline | Filter::CatmullRom => cubic::<L, T, D>(m, texels, at, extent),
    }
}

/// What one level has, or two neighbours have, by the texture's [`LevelFilter`].
#[inline(never)]
fn leveled<L: Lanes, T: Texel, const D: usize>(
    m: &Packet<L>,
    texels: &Texels<'_, T>,
    at: &[L::F32; 3],
    level: &L::F32,
) -> Given<L, T> {
    let l = m.lanes();
    l.enter_again(
        #[inline(always)]
        || {
            let inner = &Packet::with_mask(Entered::new(l), m.active());
            let last = l.u32(texels.levels - 1);
            let place = level_within::on(inner, F(*level), U(last)).0;
            let at_level = |level| {
                let extent = Extent::of(inner, texels, level);
                filtered::<L, T, D>(m, texels, at, Some(&extent))
            };
            if texels.config.level_filter == LevelFilter::Nearest {
                let nearest = l.f32_unary(op::Floor, l.f32_binary(op::Add, place, l.f32(0.5)));
                return at_level(l.f32_to_u32(nearest));
            }
            let finer = l.f32_unary(op::Floor, place);
            let below = l.f32_to_u32(finer);
            let above = l.u32_binary(op::Add, below, l.u32(1));
            let above = l.u32_select(l.u32_compare(op::Lt, above, last), above, last);
            let share = l.f32_binary(op::Sub, place, finer);
            blend(m, at_level(below), at_level(above), share)
        },
    )
}

impl<L: Lanes> Extent<L> {
    #[inline(always)]
    fn of<T: Texel>(m: &Inner<L>, texels: &Texels<'_, T>, level: L::U32) -> Self {
        let l = m.lanes();
        let [w, h, d] = texels.size;
        let size = [l.u32(w), l.u32(h), l.u32(d)];
        let of_level = fill(
            #[inline(always)]
            |axis| size_at::on(m, U(size[axis]), U(level)).0,
        );
        let [x, y, z] = size;
        let first = level_start::on(m, X3 { x: U(x), y: U(y), z: U(z) }, U(level));
        Self { size: of_level, first: first.0 }
    }
}

/// Runs a filter as a function of its own, on the level of an extent.
#[inline(always)]
fn entered<L: Lanes, T: Texel>(
    m: &Packet<L>,
    texels: &Texels<'_, T>,
    extent: Option<&Extent<L>>,
    filter: impl FnOnce(&Grid<'_, L, T>) -> Given<L, T>,
) -> Given<L, T> {
    if texels.all.is_empty() {
        return Value::zero(m);
    }
    m.lanes().enter_again(
        #[inline(always)]
        || filter(&Grid::of(m, texels, extent)),
    )
}

#[inline(never)]
fn nearest<L: Lanes, T: Texel, const D: usize>(
    m: &Packet<L>,
    texels: &Texels<'_, T>,
    at: &[L::F32; 3],
    extent: Option<&Extent<L>>,
) -> Given<L, T> {
    entered(
        m,
        texels,
        extent,
        #[inline(always)]
        |grid| nearest_of::<L, T, D>(grid, at),
    )
}

#[inline(always)]
fn nearest_of<L: Lanes, T: Texel, const D: usize>(
    grid: &Grid<'_, L, T>,
    at: &[L::F32; 3],
) -> Given<L, T> {
    let mut index = grid.first;
    for axis in (0..D).rev() {
        let (size, address) = grid.axis(axis);
        index =
            grid.part(index, axis, nearest_texel::on(&grid.inner, F(at[axis]), U(size), address).0);
    }
    let [value] = grid.values(&[index], 1);
    value
}

#[inline(never)]
fn linear<L: Lanes, T: Texel, const D: usize>(
    m: &Packet<L>,
    texels: &Texels<'_, T>,
    at: &[L::F32; 3],
    extent: Option<&Extent<L>>,
) -> Given<L, T> {
    entered(
        m,
        texels,
        extent,
        #[inline(always)]
        |grid| linear_of::<L, T, D>(grid, at),
    )
}

#[inline(always)]
fn linear_of<L: Lanes, T: Texel, const D: usize>(
    grid: &Grid<'_, L, T>,
    at: &[L::F32; 3],
) -> Given<L, T> {
    let l = grid.m.lanes();
    let (mut taps, mut shares) = ([[l.u32(0); 2]; 3], [l.f32(0.0); 3]);
    for axis in 0..D {
        let (size, address) = grid.axis(axis);
        let found = pair::on(&grid.inner, F(at[axis]), U(size), address);
        (taps[axis], shares[axis]) = ([found.first.0, found.second.0], found.share.0);
    }
    // No loop over axes, so that each is one of a known length.
    let mut indices = [grid.first; 8];
    if const { D > 2 } {
        grid.split(2, &taps[2], &mut indices, 1);
    }
    if const { D > 1 } {
        grid.split(1, &taps[1], &mut indices, D - 1);
    }
    grid.split(0, &taps[0], &mut indices, 1 << (D - 1));
    let mut values = grid.values(&indices, 1 << D);
    join(grid.m, shares[0], &mut values, 1 << (D - 1));
    if const { D > 1 } {
        join(grid.m, shares[1], &mut values, D - 1);
    }
    if const { D > 2 } {
        join(grid.m, shares[2], &mut values, 1);
    }
    values[0]
}

/// Makes one value of each two, of which the second has a share.
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
    at: &[L::F32; 3],
    extent: Option<&Extent<L>>,
) -> Given<L, T> {
    entered(
        m,
        texels,
        extent,
        #[inline(always)]
        |grid| cubic_of::<L, T, D>(grid, at),
    )
}

#[inline(always)]
fn cubic_of<L: Lanes, T: Texel, const D: usize>(
    grid: &Grid<'_, L, T>,
    at: &[L::F32; 3],
) -> Given<L, T> {
    let (m, l) = (grid.m, grid.m.lanes());
    let filter = grid.texels.config.filter;
    let mut weights = [[l.f32(0.0); 3]; D];
    let mut places = [[l.u32(0); 4]; D];
    for axis in 0..D {
        let (size, address) = grid.axis(axis);
        let taps = four::on(&grid.inner, F(at[axis]), U(size), address, filter);
        weights[axis] = [taps.w1.0, taps.w3.0, taps.w4.0];
        places[axis] = [taps.first.0, taps.second.0, taps.third.0, taps.fourth.0];
    }
    // The rows along the first axis.
    let mut rows = [grid.first; 16];
    for axis in (1..D).rev() {
        for i in (0..1 << (2 * (D - 1 - axis))).rev() {
            let start = rows[i];
            for k in 0..4 {
                rows[4 * i + k] = grid.part(start, axis, places[axis][k]);
            }
        }
    }
    let mut values = [Given::<L, T>::zero(m); 16];
    for i in 0..1 << (2 * (D - 1)) {
        let taps = fill(
            #[inline(always)]
            |k| grid.part(rows[i], 0, places[0][k]),
        );
        values[i] = blend4(m, &grid.values(&taps, 4), &weights[0]);
    }
    for (axis, weights) in weights.iter().enumerate().skip(1) {
        for i in 0..1 << (2 * (D - 1 - axis)) {
            let taps = fill(
                #[inline(always)]
                |k| values[4 * i + k],
            );
            values[i] = blend4(m, &taps, weights);
        }
    }
    values[0]
}

/// A level of a texture, and where its texels are.
struct Grid<'t, L: Lanes, T: Texel> {
    m: &'t Packet<L>,
    inner: Inner<L>,
    texels: &'t Texels<'t, T>,
    size: [L::U32; 3],
    first: L::U32,
    /// From a texel to the next along each axis.
    steps: [L::U32; 3],
    /// Whether a place may have none.
    has_border: bool,
    border: Given<L, T>,
}

impl<'t, L: Lanes, T: Texel> Grid<'t, L, T> {
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
        let border = T::Value::splat(m, texels.border());
        let inner = Packet::with_mask(Entered::new(l), m.active());
        let has_border = texels.has_border();
        Self { m, inner, texels, size, first, steps, has_border, border }
    }

    /// The size and the address mode of an axis.
    #[inline(always)]
    fn axis(&self, axis: usize) -> (L::U32, Address) {
        (self.size[axis], self.texels.config.address[axis])
    }

    /// The first texel of part `i` along an axis of what begins at `first`.
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

    /// Makes two places of each along an axis: neighbours along the first one follow each other.
    #[inline(always)]
    fn split(&self, axis: usize, &[a, b]: &[L::U32; 2], indices: &mut [L::U32; 8], count: usize) {
        for i in (0..count).rev() {
            let start = indices[i];
            indices[2 * i] = self.part(start, axis, a);
            indices[2 * i + 1] = self.part(start, axis, b);
        }
    }

    /// The values of the first `count` texels, or of the border where there is none. Lanes that do not
    /// run have one too: whatever their coordinates are, places are inside or [`OUTSIDE`].
    #[inline(always)]
    fn values<const N: usize>(&self, places: &[L::U32; N], count: usize) -> [Given<L, T>; N] {
        let mut values = [Given::<L, T>::zero(self.m); N];
        if self.has_border || self.texels.config.color_space != ColorSpace::Linear {
            self.values_apart(&places[..count], &mut values[..count]);
            return values;
        }
        for i in 0..count {
            values[i] = self.inside(&places[i], ColorSpace::Linear);
        }
        values
    }

    /// [`values`](Self::values) of any texture, in a function that all filters share.
    #[inline(never)]
    fn values_apart(&self, places: &[L::U32], values: &mut [Given<L, T>]) {
        let (m, l) = (self.m, self.m.lanes());
        l.enter_again(
            #[inline(always)]
            || {
                for (place, value) in places.iter().zip(values) {
                    let is_outside = l.u32_compare(op::Eq, *place, l.u32(OUTSIDE));
                    let inside = l.u32_select(is_outside, l.u32(0), *place);
                    let texel = self.inside(&inside, self.texels.config.color_space);
                    *value = Value::zip(m, self.border, texel, &mut Select(is_outside));
                }
            },
        );
    }

    /// The values of texels that there are.
    #[inline(always)]
    fn inside(&self, places: &L::U32, space: ColorSpace) -> Given<L, T> {
        let all = self.texels.all;
        let texel = T::gather(
            self.m,
            #[inline(always)]
            |lane| all[L::u32_lane(places, lane) as usize],
        );
        T::decode_on(self.m, texel, space)
    }
}

/// [`Blend::blend`](super::Blend::blend).
#[inline(always)]
fn blend<M: Machine, V: Value<M>>(m: &M, a: V, b: V, share: M::F32) -> V {
    V::zip(m, a, V::zip(m, b, a, &mut Way::<M>(share)), &mut Sum)
}

/// [`Blend::blend4`](super::Blend::blend4) of neighbours in their order.
#[inline(always)]
fn blend4<M: Machine, V: Value<M>>(
    m: &M,
    &[first, second, third, fourth]: &[V; 4],
    &[w1, w3, w4]: &[M::F32; 3],
) -> V {
    let way = |to, weight| V::zip(m, to, second, &mut Way(weight));
    let sum = V::zip(m, way(first, w1), way(third, w3), &mut Sum);
    V::zip(m, second, V::zip(m, sum, way(fourth, w4), &mut Sum), &mut Sum)
}

/// `(a - b) * w`.
struct Way<M: Machine>(M::F32);

/// `a + b`.
struct Sum;

/// `a` where it is true, `b` elsewhere.
struct Select<M: Machine>(M::Bool);

/// How floats of a texture's values are put together; it has no other leaves.
macro_rules! leaves {
    ($($name:ty, |$this:ident, $m:ident, $a:ident, $b:ident| $e:expr;)+) => {
        $(
            impl<M: Machine> Leaves<M> for $name {
                #[inline(always)]
                fn f32(&mut self, $m: &M, $a: M::F32, $b: M::F32) -> M::F32 {
                    let $this = &*self;
                    $e
                }
                #[inline(always)]
                fn i32(&mut self, _: &M, a: M::I32, _: M::I32) -> M::I32 {
                    a
                }
                #[inline(always)]
                fn u32(&mut self, _: &M, a: M::U32, _: M::U32) -> M::U32 {
                    a
                }
                #[inline(always)]
                fn bool(&mut self, _: &M, a: M::Bool, _: M::Bool) -> M::Bool {
                    a
                }
            }
        )+
    };
}

leaves! {
    Way<M>, |this, m, a, b| m.f32_binary(op::Mul, m.f32_binary(op::Sub, a, b), this.0);
    Sum, |_this, m, a, b| m.f32_binary(op::Add, a, b);
    Select<M>, |this, m, a, b| m.f32_select(this.0, a, b);
}
