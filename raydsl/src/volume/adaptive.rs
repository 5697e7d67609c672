//! Integration to a tolerance: steps as long as the error allows.

use glam::Vec3;

use super::along::{Passed, passed};
use super::cubic::{Cubic, Extremes, next_extreme};
use super::grid::GridLayout;
use super::integral::{MeanBetween, TransferPlace, mean_of_places, place_at};
use super::integrator::{
    Inside, Layer, VolumeIntegrator, inside, integrator, macro_walk, majorant_of,
};
use super::light::VolumeLight;
use super::transfer::TransferFunction;
use super::volume::{Volume, VolumeView};
use super::voxel::Voxel;
use crate::geometry::{Ray, RayOn};
use crate::machine::generic::{clamp, max, min};
use crate::machine::{Machine, On};
use crate::math::elementary::expm1;
use crate::{Type, kernel};

/// Integrates to a tolerance: each step is as long as its share of the error allows.
///
/// A step is taken as a whole and in two parts, by the means of the transfer function over the
/// values that it passes, as [`PreIntegrated`](super::PreIntegrated) does. Its error is their
/// difference and a bound on what colours within a part hide of one another; the parts are what
/// counts. A step whose error is above `tolerance` times its share of the ray's length in the grid
/// is taken again, shorter. Steps end at the borders of cells and where the value turns, so no
/// value between their ends is missed, wherever samples fall. (Novins and Arvo, "Controlled
/// Precision Volume Integration", 1992, bound the error by derivatives; this estimates it.)
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct Adaptive {
    /// Error of radiance and opacity along a ray that is aimed at, where colours are at most 1;
    /// above 0. It is estimated: few rays have a greater one, and hardly any more than a few times
    /// as great. Below some 1e-5 rounding is greater.
    pub tolerance: f32,
    /// Length of the first step in the world; above 0.
    pub start: f32,
    /// Transmittance below which the rest of a ray is left out.
    pub least: f32,
}

#[kernel]
impl Adaptive {
    /// Creates the integrator with this tolerance. It begins with whole cells, and leaves out what
    /// is behind a transmittance of a quarter of the tolerance.
    #[inline]
    pub fn new(tolerance: f32) -> Self {
        Self { tolerance, start: f32::MAX, least: 0.25 * tolerance }
    }

    /// Sets the length of the first step, in the world.
    #[inline]
    #[must_use]
    pub fn start(self, start: f32) -> Self {
        Self { start, ..self }
    }

    /// Sets the transmittance below which the rest of a ray is left out.
    #[inline]
    #[must_use]
    pub fn least(self, least: f32) -> Self {
        Self { least, ..self }
    }
}

/// Share of a cell below which a step is taken whatever its error, if it is thin.
const SHORTEST: f32 = 1.0 / 1024.0;

/// The same of a thick step, whose beginning hides its end: its colour is as wrong as colours differ
/// within it. Few are taken until no light is left.
const SHORTEST_THICK: f32 = 1.0 / 131_072.0;

/// Optical depth above which a step is thick.
const THICK: f32 = 1.0;

/// Difference of the values at both ends of a step, as a share of them, below which the step is
/// taken whatever its error: the values are rounded.
const NARROWEST: f32 = 1e-5;

/// Where a step is divided: not in the middle, about which values between two turns are symmetric.
const DIVISION: f32 = 0.381_966;

/// Error of a step that is rounding, as a share of its light.
const ROUNDING: f32 = 4e-7;

/// What a step adds, and the length of the next.
#[derive(Clone, Copy, Debug, Type)]
struct Tried {
    layer: Layer,
    is_good: bool,
    is_thick: bool,
    /// Factor of the step's length for the next one.
    factor: f32,
}

/// A part of a step.
#[derive(Clone, Copy, Debug, Type)]
struct Part {
    color: Vec3,
    opacity: f32,
    depth: f32,
    /// By how much its colour may be wrong, since its beginning hides its end.
    off: f32,
}

/// Returns a part over the values from `a` to `b`, `run` long in the world.
#[kernel]
#[inline]
fn part_of(function: &TransferFunction, a: TransferPlace, b: TransferPlace, run: f32) -> Part {
    let MeanBetween { mean, from, to } = mean_of_places(function, a, b);
    let depth = mean.extinction * run;
    // What is absorbed is by so much of the part before its middle, with linear colours.
    let shift = min(depth * (1.0 / 12.0), 0.5);
    let off = shift * (to - from).abs().max_element();
    Part { color: mean.color, opacity: -expm1(-depth), depth, off }
}

/// Tries a step over the values from `a` through `between` to `b`, `run` long in the world;
/// `allowed` is its error per unit of `layer.transmittance`.
#[kernel]
#[inline]
fn tried(
    layer: Layer,
    function: &TransferFunction,
    (a, between, b): (TransferPlace, TransferPlace, TransferPlace),
    run: f32,
    allowed: f32,
) -> Tried {
    let whole = part_of(function, a, b, run);
    let is_thick = whole.depth > THICK;
    let mut found = Tried { layer, is_good: true, is_thick, factor: 4.0 };
    if whole.depth > 0.0 {
        let near = part_of(function, a, between, run * DIVISION);
        let far = part_of(function, between, b, run * (1.0 - DIVISION));
        let behind = far.opacity * (1.0 - near.opacity);
        let opacity = near.opacity + behind;
        let radiance = near.color * near.opacity + far.color * behind;
        let off = max(
            (radiance - whole.color * whole.opacity).abs().max_element(),
            (opacity - whole.opacity).abs(),
        ) + (near.off * near.opacity + far.off * behind);
        let limit = max(allowed, ROUNDING * opacity);
        found.layer.add(near.color, near.opacity, near.depth);
        found.layer.add(far.color, far.opacity, far.depth);
        found.is_good = off <= limit;
        found.factor = clamp(0.9 * (limit / max(off, f32::MIN_POSITIVE)).sqrt(), 0.1, 4.0);
    }
    found
}

/// A cell on the way through it, step by step. Walks advance it in the same loop as their cells, so that
/// rays of a packet do not wait in each cell for the one that takes the most steps there.
#[derive(Clone, Copy, Debug, Type)]
struct CellSteps {
    /// The value along the ray.
    cubic: Cubic,
    extremes: Extremes,
    /// Length in the world.
    length: f32,
    /// Error for the whole cell.
    allowed: f32,
    /// What is behind, from 0 to 1; the cell is through at 1.
    x: f32,
    /// The value there.
    at: TransferPlace,
    /// Share of the cell at which the next step is taken whatever its error, if it is thin.
    shortest: f32,
}

#[kernel]
impl CellSteps {
    /// Returns a cell that is through.
    #[inline(always)]
    fn none(function: &TransferFunction) -> CellSteps {
        CellSteps {
            cubic: Cubic { c0: 0.0, c1: 0.0, c2: 0.0, c3: 0.0 },
            extremes: Extremes { first: 2.0, second: 2.0 },
            length: 0.0,
            allowed: 0.0,
            x: 1.0,
            at: place_at(function, 0.0),
            shortest: SHORTEST,
        }
    }

    /// Returns a cell that the ray enters, whose value is `cubic` over `length`; `allowed` is the error
    /// for all of it.
    #[inline(always)]
    fn of(function: &TransferFunction, cubic: Cubic, length: f32, allowed: f32) -> CellSteps {
        CellSteps {
            cubic,
            extremes: cubic.extremes(),
            length,
            allowed,
            x: 0.0,
            at: place_at(function, cubic.c0),
            shortest: SHORTEST,
        }
    }

    /// Tries the next step; `width` is its length in the world, and becomes that of the one after it.
    #[inline(always)]
    fn advance(&mut self, layer: &mut Layer, width: &mut f32, function: &TransferFunction) {
        let x = self.x;
        // The value is monotone up to the next extreme place.
        let stop = next_extreme(self.extremes, x);
        // A NaN, of a cell without length, becomes the shortest.
        let share = max(self.shortest, min(*width / self.length, 1.0));
        let end = min(x + share, stop);
        let step = end - x;
        let cubic: Cubic = self.cubic;
        let before: TransferPlace = self.at;
        let between = place_at(function, cubic.at(x + step * DIVISION));
        let behind = place_at(function, cubic.at(end));
        let (value, last) = (before.value, behind.value);
        let limit = self.allowed * step / max(layer.transmittance, f32::MIN_POSITIVE);
        let found = tried(*layer, function, (before, between, behind), step * self.length, limit);
        let next = step * self.length * found.factor;
        let is_narrow = (last - value).abs() <= NARROWEST * max(last.abs(), value.abs());
        let least = if found.is_thick { SHORTEST_THICK } else { SHORTEST };
        if found.is_good | is_narrow | (share <= least) {
            self.shortest = SHORTEST;
            *layer = found.layer;
            self.x = end;
            self.at = behind;
            // A step that the cell ended says nothing against longer ones.
            *width = if end == stop { max(*width, next) } else { next };
        } else {
            // Taken at its shortest, were it not thick.
            self.shortest = if share <= SHORTEST { SHORTEST_THICK } else { SHORTEST };
            *width = next;
        }
    }
}

#[kernel]
#[inline(never)]
fn adaptive<T: Voxel>(
    this: Adaptive,
    volume: &Volume<'_, T>,
    ray: Ray,
    light: VolumeLight,
) -> VolumeLight {
    let part: Inside = inside(volume.grid(), ray);
    let layout: GridLayout = volume.grid().layout();
    let mut width = this.start;
    let mut light = light;
    let mut walk = macro_walk(volume.grid(), part);
    while walk.is_inside && light.transmittance() >= this.least {
        if majorant_of(volume, walk.cell) > 0.0 {
            let before = light.transmittance();
            let mut layer = Layer::new();
            let mut cells = walk.cells_of(layout.last_macro, layout.last_cell, -layout.low.floor());
            let mut steps = CellSteps::none(volume.transfer());
            while steps.x < 1.0 || (cells.is_inside && layer.transmittance * before >= this.least) {
                let is_in_cell = steps.x < 1.0;
                if !is_in_cell {
                    let (enter, leave) = (cells.enter, cells.leave);
                    let Passed { cubic, cell, .. } =
                        passed(volume.grid(), part, cells.cell, enter, leave);
                    if cell.is_whole {
                        let allowed = this.tolerance * ((leave - enter) / part.end) / before;
                        let length = (leave - enter) * part.scale;
                        steps = CellSteps::of(volume.transfer(), cubic, length, allowed);
                    }
                    cells.advance();
                }
                if steps.x < 1.0 {
                    steps.advance(&mut layer, &mut width, volume.transfer());
                }
            }
            light = light.then(layer.radiance, layer.depth);
        }
        walk.advance();
    }
    light
}

integrator!(Adaptive, adaptive);
