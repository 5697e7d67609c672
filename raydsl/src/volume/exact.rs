//! The exact cell: the integral over a trilinear cell, piece by piece.

use super::cubic::{Cubic, Extremes, next_extreme, place_of};
use super::grid::GridLayout;
use super::integrator::{
    Inside, Layer, VolumeIntegrator, inside, integrator, lambert, macro_walk, majorant_of,
};
use super::light::{MOST_OPTICAL_DEPTH, VolumeLight};
use super::sample::{InCell, cell_at, gradient_in};
use super::transfer::{FAR, TransferFunction, TransferKnot};
use super::volume::{Volume, VolumeView};
use super::voxel::{Corners, Voxel};
use crate::geometry::{Ray, RayOn};
use crate::machine::functions::{vec2, vec3, vec4};
use crate::machine::generic::{clamp, length, max, min};
use crate::machine::margin::{Interval as Range, Known};
use crate::machine::{KnownFunction, Machine, Margin, On};
use crate::math::elementary::{exp, expm1};
use crate::{Type, kernel};
use glam::{Vec2, Vec3, vec2, vec3, vec4};

/// Integrates each cell of the grid exactly, whatever its optical depth: no step to choose.
///
/// Along a ray the value in a cell is a cubic. The cell is divided at the cubic's extreme places
/// and where it meets a knot of the transfer function; between those, extinction and colour are
/// cubics too. A piece's optical depth, its integral, is exact; its colour is a mean over the
/// piece, weighted by what is absorbed where, by Gauss's rule with four points and the collocation
/// matrix for the depth before each (Hairer, Nørsett and Wanner, "Solving Ordinary Differential
/// Equations I", II.7). Pieces of a depth above 0.5 are divided further, as long as light
/// passes.
///
/// So opacity is right to rounding, radiance is between the least and the greatest colour that the
/// ray meets; the rule is right to some 6e-6, and the reference in `f64` has the integral itself. Where
/// the function has a step, rounding moves its place. (Splitting at the knots: Weiss and Westermann, "Analytic Ray Splitting for Controlled
/// Precision DVR", 2021.)
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct ExactCell {
    /// Transmittance below which the rest of a ray is left out: at most this share of what is
    /// behind, whatever its radiance, is missing. 0 leaves nothing out.
    pub least: f32,
}

#[kernel]
impl ExactCell {
    /// Creates the integrator. It leaves out what is behind a transmittance of 0.001.
    #[inline]
    pub fn new() -> Self {
        Self { least: 0.001 }
    }

    /// Sets the transmittance below which the rest of a ray is left out.
    #[inline]
    #[must_use]
    pub fn least(self, least: f32) -> Self {
        Self { least }
    }
}

impl Default for ExactCell {
    fn default() -> Self {
        Self::new()
    }
}

/// [`ExactCell`] with shading by the gradient, as if borders in the volume were surfaces under a
/// light: colour is multiplied by `ambient + (1 - ambient) |cos|`, where `cos` is that of the angle
/// between gradient and light.
///
/// Where the value hardly changes there is no border: shading fades out with gradients shorter than
/// `edge`. (After Levoy, "Display of Surfaces from Volume Data", 1988.) It is computed once a cell.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct ShadedCell {
    /// As [`ExactCell::least`].
    pub least: f32,
    /// Share of light without a direction, from 0 to 1.
    pub ambient: f32,
    /// Length of a gradient, in values per length of the world, from which on shading is full;
    /// above 0. At 0 every gradient shades.
    pub edge: f32,
    /// Unit vector towards the light.
    pub to_light: Vec3,
}

#[kernel]
impl ShadedCell {
    /// Creates the integrator with a light in this direction, a unit vector, and 0.3 of ambient
    /// light.
    #[inline]
    pub fn new(to_light: Vec3, edge: f32) -> Self {
        Self { least: 0.001, ambient: 0.3, edge, to_light }
    }

    /// Sets the transmittance below which the rest of a ray is left out.
    #[inline]
    #[must_use]
    pub fn least(self, least: f32) -> Self {
        Self { least, ..self }
    }

    /// Returns the factor of colours in a cell with this gradient.
    #[inline]
    pub(super) fn shade(self, gradient: Vec3) -> f32 {
        // Divided first: squares of long gradients would be infinite, and of short ones vanish.
        let share = min(length(gradient / max(self.edge, f32::MIN_POSITIVE)), 1.0);
        1.0 + (lambert(gradient, self.to_light, self.ambient) - 1.0) * share
    }
}

/// Interval of the transfer function, with its ends.
#[derive(Clone, Copy, Debug, Type)]
pub(super) struct Interval {
    pub(super) index: u32,
    pub(super) below: TransferKnot,
    pub(super) above: TransferKnot,
}

#[kernel]
#[inline(always)]
pub(super) fn interval_at(function: &TransferFunction, index: u32) -> Interval {
    let below: TransferKnot = function.knot(index);
    let above: TransferKnot = function.knot(index + 1);
    Interval { index, below, above }
}

#[kernel]
impl Interval {
    /// Returns the interval above or below, with which it shares a knot.
    #[inline(always)]
    fn next(self, function: &TransferFunction, is_above: bool) -> Interval {
        let (below, above): (TransferKnot, TransferKnot) = (self.below, self.above);
        let index = if is_above { self.index + 1 } else { self.index - 1 };
        let knot: TransferKnot = function.knot(if is_above { index + 1 } else { index });
        Interval {
            index,
            below: if is_above { above } else { knot },
            above: if is_above { knot } else { below },
        }
    }
}

/// What a piece of a cell within one interval absorbs.
#[derive(Clone, Copy, Debug, Type)]
struct Absorbed {
    depth: f32,
    /// Mean place of the values between the interval's ends, weighted by what is absorbed.
    place: f32,
}

/// Integrates the piece of a cubic from `from` on, `width` wide, between two knots, whose values and
/// extinctions are given; `length` is that of the whole cell in the world.
#[kernel(known = AbsorbedBy)]
#[inline(always)]
#[expect(clippy::excessive_precision, reason = "the reference in `f64` has all digits")]
fn absorbed(
    cubic: Cubic,
    values: Vec2,
    extinctions: Vec2,
    from: f32,
    width: f32,
    length: f32,
) -> Absorbed {
    // A step is an interval of no width: a place in it is one of its ends.
    let per = 1.0 / max(values.y - values.x, f32::MIN_POSITIVE);
    // Places between the knots, at Gauss's four points.
    let pa = clamp((cubic.at(from + width * 0.069431844202973712) - values.x) * per, 0.0, 1.0);
    let pb = clamp((cubic.at(from + width * 0.33000947820757187) - values.x) * per, 0.0, 1.0);
    let pc = clamp((cubic.at(from + width * 0.66999052179242813) - values.x) * per, 0.0, 1.0);
    let pd = clamp((cubic.at(from + width * 0.93056815579702629) - values.x) * per, 0.0, 1.0);
    // Extinctions there, times the length.
    let run = width * length;
    let first = min(extinctions.x * run, MOST_OPTICAL_DEPTH);
    let more = min(extinctions.y * run, MOST_OPTICAL_DEPTH) - first;
    let (a, b, c, d) = (first + more * pa, first + more * pb, first + more * pc, first + more * pd);
    // Optical depths before each.
    let ta = a * 0.086963711284363464 - b * 0.026604180084998793 + c * 0.012627462689404725
        - d * 0.0035551496857956832;
    let tb = a * 0.18811811749986807 + b * 0.16303628871563654 - c * 0.027880428602470895
        + d * 0.0067355005945381555;
    let tc = a * 0.16719192197418877 + b * 0.35395300603374397 + c * 0.16303628871563654
        - d * 0.014190694931141143;
    let td = a * 0.17748257225452261
        + b * 0.31344511474186835
        + c * 0.35267675751627186
        + d * 0.086963711284363464;
    // What is absorbed around each. Of pieces too thick for the rule a depth may be far below 0.
    let wa = a * 0.17392742256872693 * exp(-max(ta, -1.0));
    let wb = b * 0.32607257743127307 * exp(-max(tb, -1.0));
    let wc = c * 0.32607257743127307 * exp(-max(tc, -1.0));
    let wd = d * 0.17392742256872693 * exp(-max(td, -1.0));
    let sum = (wa + wb) + (wc + wd);
    let mean = ((wa * pa + wb * pb) + (wc * pc + wd * pd)) / max(sum, f32::MIN_POSITIVE);
    Absorbed {
        depth: (a + d) * 0.17392742256872693 + (b + c) * 0.32607257743127307,
        // Of a piece so thick that no point gets light, the beginning is seen.
        place: if sum > f32::MIN_POSITIVE { clamp(mean, 0.0, 1.0) } else { pa },
    }
}

/// What [`absorbed()`] stands for: the integrals themselves.
#[derive(Debug)]
struct AbsorbedBy;

/// Gauss's rule with eight points on -1 to 1: places and weights of the positive half.
const GAUSS: [[f64; 2]; 4] = [
    [0.183_434_642_495_649_8, 0.362_683_783_378_362],
    [0.525_532_409_916_329, 0.313_706_645_877_887_3],
    [0.796_666_477_413_626_7, 0.222_381_034_453_374_5],
    [0.960_289_856_497_536_3, 0.101_228_536_290_376_3],
];

/// Parts of a piece to which that rule is applied.
const PARTS: u32 = 4;

/// Optical depth behind which nothing is seen: less than 1e-17 is transmitted.
const OPAQUE: f64 = 40.0;

impl KnownFunction for AbsorbedBy {
    fn bound(&self, m: &Margin, args: &[Known]) -> Option<Vec<Known>> {
        let [cubic @ .., below, above, first, last, from, width, length] = args else {
            return None;
        };
        let [c0, c1, c2, c3] = cubic else { return None };
        // The place between the knots, and the depth before, as polynomials of a share of the piece.
        let (x, w) = (from.value, width.value);
        // A step is an interval of no width, which has no places: it is taken for its beginning.
        let span = above.value - below.value;
        let is_wide = span >= f64::from(f32::MIN_POSITIVE);
        let per = if is_wide { 1.0 / span } else { 0.0 };
        let p = [
            (c0.value + x * (c1.value + x * (c2.value + x * c3.value)) - below.value) * per,
            (c1.value + x * (2.0 * c2.value + x * (3.0 * c3.value))) * w * per,
            (c2.value + x * (3.0 * c3.value)) * w * w * per,
            c3.value * w * w * w * per,
        ];
        let place = |u: f64| p[0] + u * (p[1] + u * (p[2] + u * p[3]));
        let most = f64::from(MOST_OPTICAL_DEPTH);
        let run = w * length.value;
        let begin = (first.value * run).min(most);
        let more = (last.value * run).min(most) - begin;
        let before = |u: f64| {
            u * (begin + more * (p[0] + u * (p[1] / 2.0 + u * (p[2] / 3.0 + u * (p[3] / 4.0)))))
        };
        let depth = before(1.0);
        // Behind the end no light is left.
        let mut end = 1.0;
        if depth > OPAQUE {
            let mut low = 0.0;
            for _ in 0..60 {
                let middle = 0.5 * (low + end);
                if before(middle) > OPAQUE { end = middle } else { low = middle }
            }
        }
        // What is absorbed, and where on the mean.
        let (mut sum, mut weighted) = (0.0, 0.0);
        for part in 0..PARTS {
            for (at, weight) in GAUSS.iter().flat_map(|[at, weight]| [(-at, weight), (*at, weight)])
            {
                let u = end * (f64::from(part) + 0.5 + 0.5 * at) / f64::from(PARTS);
                let absorbed = weight * (begin + more * place(u)) * (-before(u)).exp();
                sum += absorbed;
                weighted += absorbed * place(u);
            }
        }
        let mean = if sum > f64::MIN_POSITIVE { weighted / sum } else { place(0.0) };

        // How far the values of any variant may be from these, as shares of the interval.
        let rounding = 16.0 * m.rounding().sum;
        let wide = |v: &Known| v.range.high - v.range.low;
        let size = |v: &Known| v.range.magnitude();
        let off: f64 =
            cubic.iter().chain([below, above]).map(|v| wide(v) + rounding * size(v)).sum();
        let steep = size(c1) + 2.0 * size(c2) + 3.0 * size(c3);
        let gap = span.abs() - wide(below) - wide(above);
        let off = 2.0 * (off + steep * (wide(from) + wide(width))) / gap.max(0.0) + rounding;
        // A gap of nothing says nothing.
        let off = if off < 1.0 && is_wide { off } else { 1.0 };
        let ends = [place(0.0), place(1.0)].map(|p| p.clamp(0.0, 1.0));
        let (low, high) = (ends[0].min(ends[1]) - off, ends[0].max(ends[1]) + off);
        let long = size(width) * size(length);
        let short = (width.range.low * length.range.low).max(0.0);
        let thick = size(first).max(size(last));
        let slack = thick * long * (off + rounding)
            + (wide(first) + wide(last)) * long
            + thick * (long - short);
        let nan = args.iter().any(|v| v.range.nan || v.range.is_nan())
            || !(depth.is_finite() && mean.is_finite() && slack.is_finite());
        let range = |low: f64, high: f64| Range::new(low.max(0.0), high, nan);
        Some(vec![
            m.bounded(depth, range(depth - slack, depth + slack)),
            m.bounded(mean.clamp(0.0, 1.0), range(low, high.min(1.0))),
        ])
    }
}

/// Depth of a piece up to which the rule of four points is right to 6e-6, however extinction and
/// colour run; of unit depth it is off by 8e-5 where extinction falls and colour rises.
const MOST_DEPTH: f32 = 0.5;

/// Transmittance below which a thick piece is not divided any more.
const DARK: f32 = 1e-9;

/// Returns the width of a piece from `from` on, at most `width`, whose depth is at most
/// [`MOST_DEPTH`].
#[kernel]
#[inline(always)]
fn thin_width(cubic: Cubic, interval: Interval, from: f32, width: f32, length: f32) -> f32 {
    let Interval { below, above, .. } = interval;
    let rise = above.extinction - below.extinction;
    let per = rise / max(above.value - below.value, f32::MIN_POSITIVE);
    // An infinite slope times no difference would be no number.
    let per = clamp(per, -MOST_OPTICAL_DEPTH, MOST_OPTICAL_DEPTH);
    let begin = max(below.extinction + per * (cubic.at(from) - below.value), 0.0) * length;
    let growth = cubic.steepest(from, from + width) * per.abs() * length;
    let root = (begin * begin + 2.0 * growth * MOST_DEPTH).sqrt();
    // The whole rest of the piece, or a width of its own, so that the loop ends.
    min(max(2.0 * MOST_DEPTH / max(begin + root, 1e-30), 1e-6), width)
}

/// Beyond this there are no knots but the far ones, behind which there is no interval.
const NO_KNOT: f32 = 0.5 * FAR;

/// A piece of a cell, within one interval, over which the value is monotone.
#[derive(Clone, Copy, Debug, Type)]
struct Piece {
    /// Where it ends.
    end: f32,
    /// The value there.
    last: f32,
    /// Whether the value leaves the interval there, and which way.
    crosses: bool,
    is_rising: bool,
}

/// Returns the piece that begins at `x`, where the value is `value`.
#[kernel]
#[inline(always)]
fn piece_from(cubic: Cubic, extremes: Extremes, interval: Interval, x: f32, value: f32) -> Piece {
    // The value is monotone up to the next extreme place.
    let stop = next_extreme(extremes, x);
    let at_stop = cubic.at(stop);
    let is_rising = at_stop > value;
    let bound = if is_rising { interval.above.value } else { interval.below.value };
    let is_beyond = if is_rising { at_stop > bound } else { at_stop < bound };
    let crosses = is_beyond & (bound.abs() < NO_KNOT);
    let is_behind = if is_rising { value >= bound } else { value <= bound };
    let mut end = stop;
    if crosses {
        end = if is_behind { x } else { min(max(place_of(cubic, bound, x, stop), x), stop) };
    }
    Piece { end, last: if crosses { bound } else { at_stop }, crosses, is_rising }
}

/// A cell on the way through it, piece by piece.
///
/// The walk through a grid advances it in the same loop as its cells: were it a loop of its own, all rays
/// of a packet would wait in each cell for the one that meets the most knots there.
#[derive(Clone, Copy, Debug, Type)]
pub(super) struct CellPieces {
    /// The value along the ray.
    cubic: Cubic,
    extremes: Extremes,
    /// Length in the world.
    length: f32,
    /// What is behind, from 0 to 1; the cell is through at 1.
    pub(super) x: f32,
    /// The value there.
    value: f32,
    piece: Piece,
    /// Whether part of the piece is behind.
    is_begun: bool,
}

#[kernel]
impl CellPieces {
    /// Returns a cell that is through.
    #[inline(always)]
    pub(super) fn none() -> CellPieces {
        CellPieces {
            cubic: Cubic { c0: 0.0, c1: 0.0, c2: 0.0, c3: 0.0 },
            extremes: Extremes { first: 2.0, second: 2.0 },
            length: 0.0,
            x: 1.0,
            value: 0.0,
            piece: Piece { end: 1.0, last: 0.0, crosses: false, is_rising: false },
            is_begun: false,
        }
    }

    /// Returns a cell that the ray enters, whose value is `cubic` over `length`.
    #[inline(always)]
    pub(super) fn of(cubic: Cubic, length: f32) -> CellPieces {
        CellPieces {
            cubic,
            extremes: cubic.extremes(),
            length,
            x: 0.0,
            value: cubic.c0,
            piece: Piece { end: 0.0, last: 0.0, crosses: false, is_rising: false },
            is_begun: false,
        }
    }

    /// Adds the next piece, or, of a thick one, its next part. `interval` is that of the value, and
    /// becomes that of the value behind it.
    #[inline(always)]
    pub(super) fn advance(
        &mut self,
        layer: &mut Layer,
        interval: &mut Interval,
        function: &TransferFunction,
    ) {
        if !self.is_begun {
            self.piece = piece_from(self.cubic, self.extremes, *interval, self.x, self.value);
        }
        let piece: Piece = self.piece;
        self.is_begun = false;
        let Interval { below, above, .. } = *interval;
        if below.extinction + above.extinction > 0.0 && self.x < piece.end {
            let (values, extinctions) =
                (vec2(below.value, above.value), vec2(below.extinction, above.extinction));
            let mut width = piece.end - self.x;
            let mut found = absorbed(self.cubic, values, extinctions, self.x, width, self.length);
            if found.depth > MOST_DEPTH && layer.transmittance > DARK {
                width = thin_width(self.cubic, *interval, self.x, width, self.length);
                self.is_begun = self.x + width < piece.end;
                found = absorbed(self.cubic, values, extinctions, self.x, width, self.length);
            }
            let color = below.color + (above.color - below.color) * found.place;
            layer.add(color, -expm1(-found.depth), found.depth);
            self.x += width;
        }
        if !self.is_begun {
            self.x = piece.end;
            self.value = piece.last;
            if piece.crosses {
                *interval = interval.next(function, piece.is_rising);
            }
        }
    }
}

/// Returns whether all values of a cell are in an interval without extinction, as in most cells
/// where a function is a narrow peak. The value at its upper end is behind a step there.
#[kernel]
#[inline(always)]
fn is_clear(corners: Corners, interval: Interval, layout: GridLayout) -> bool {
    let Interval { below, above, .. } = interval;
    let (low, high) = (min(corners.near, corners.far), max(corners.near, corners.far));
    let a = min(min(low.x, low.y), min(low.z, low.w)) * layout.scale + layout.offset;
    let b = max(max(high.x, high.y), max(high.z, high.w)) * layout.scale + layout.offset;
    (below.extinction + above.extinction == 0.0)
        & (min(a, b) >= below.value)
        & (max(a, b) < above.value)
}

/// Integrates cell by cell; `shade` returns a factor for the colours of a cell, seen from its
/// middle.
#[kernel]
#[inline]
fn through_cells<T: Voxel, F: Fn(InCell) -> f32>(
    volume: &Volume<'_, T>,
    ray: Ray,
    least: f32,
    light: VolumeLight,
    shade: F,
) -> VolumeLight {
    let part: Inside = inside(volume.grid(), ray);
    let layout: GridLayout = volume.grid().layout();
    let (zero, one) = (vec3(0.0, 0.0, 0.0), vec3(1.0, 1.0, 1.0));
    let mut light = light;
    let mut interval = interval_at(volume.transfer(), 0u32);
    let corners = Corners { near: vec4(0.0, 0.0, 0.0, 0.0), far: vec4(0.0, 0.0, 0.0, 0.0) };
    let mut walk = macro_walk(volume.grid(), part);
    while walk.is_inside && light.transmittance() >= least {
        if majorant_of(volume, walk.cell) > 0.0 {
            let enough = least / max(light.transmittance(), f32::MIN_POSITIVE);
            let mut layer = Layer::new();
            let mut cells = walk.cells_of(layout.last_macro, layout.last_cell, -layout.low.floor());
            let mut pieces = CellPieces::none();
            let (mut radiance, mut depth) = (layer.radiance, layer.depth);
            let mut seen = InCell { corners, place: zero, is_whole: false };
            while pieces.x < 1.0 || (cells.is_inside && layer.transmittance >= enough) {
                let is_in_cell = pieces.x < 1.0;
                if !is_in_cell {
                    let cell = clamp(cells.cell, zero, layout.last_cell);
                    let found = cell_at(volume.grid(), cell);
                    if found.is_whole && !is_clear(found.corners, interval, layout) {
                        let from = part.origin + part.direction * cells.enter - cell;
                        let to = part.origin + part.direction * cells.leave - cell;
                        let (from, to) = (clamp(from, zero, one), clamp(to, zero, one));
                        let cubic = Cubic::through(found.corners, from, to);
                        let cubic = cubic.rescaled(layout.scale, layout.offset);
                        let length = (cells.leave - cells.enter) * part.scale;
                        // At a step the value is behind it, as for the function itself.
                        if cubic.c0 < interval.below.value || cubic.c0 >= interval.above.value {
                            let index: u32 = volume.transfer().interval(cubic.c0);
                            interval = interval_at(volume.transfer(), index);
                        }
                        pieces = CellPieces::of(cubic, length);
                        radiance = layer.radiance;
                        depth = layer.depth;
                        seen = InCell { place: (from + to) * 0.5, ..found };
                    }
                    cells.advance();
                }
                if pieces.x < 1.0 {
                    pieces.advance(&mut layer, &mut interval, volume.transfer());
                    let is_in_cell = pieces.x < 1.0;
                    if !is_in_cell && layer.depth > depth {
                        let factor = shade(seen);
                        layer.radiance = radiance + (layer.radiance - radiance) * factor;
                    }
                }
            }
            light = light.then(layer.radiance, layer.depth);
        }
        walk.advance();
    }
    light
}

#[kernel]
#[inline(never)]
fn exact_cell<T: Voxel>(
    this: ExactCell,
    volume: &Volume<'_, T>,
    ray: Ray,
    light: VolumeLight,
) -> VolumeLight {
    through_cells(volume, ray, this.least, light, |_cell: InCell| 1.0)
}

integrator!(ExactCell, exact_cell);

#[kernel]
#[inline(never)]
fn shaded_cell<T: Voxel>(
    this: ShadedCell,
    volume: &Volume<'_, T>,
    ray: Ray,
    light: VolumeLight,
) -> VolumeLight {
    let shade = |cell: InCell| this.shade(gradient_in(volume.grid(), cell));
    through_cells(volume, ray, this.least, light, shade)
}

integrator!(ShadedCell, shaded_cell);
