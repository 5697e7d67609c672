//! Transfer functions: colour and extinction of each value.

use std::sync::Arc;

use glam::{Vec2, Vec3};

use super::error::TransferError;
use super::integral::{TransferIntegral, integrals, mean_between};
use crate::machine::generic::{max, min};
use crate::machine::table_view;
use crate::machine::wgsl::BufferKey;
use crate::machine::{
    Capture, DescribedSlice, F, Lanes, Leaves, Machine, Margin, Method, Operation, Owner, Packet,
    Parameter, Recorder, Resource, Scalar, Schema, Slice, Table, TableView, Type as MachineType, U,
    Value, name, visit_value,
};
use crate::{Type, kernel};

/// Colour and extinction at a value; between two knots both are linear.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct TransferKnot {
    /// Value of the field.
    pub value: f32,
    /// Extinction: what is absorbed per length, not negative.
    pub extinction: f32,
    /// Source radiance: what a thick layer of this value looks like.
    pub color: Vec3,
}

/// Colour and extinction of one value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
pub struct TransferSample {
    /// Source radiance.
    pub color: Vec3,
    /// Extinction per length.
    pub extinction: f32,
}

/// A transfer function's numbers in kernels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
pub struct TransferLayout {
    /// Value at which the second bin begins; the first has all values below.
    pub first: f32,
    /// Bins per value.
    pub per_value: f32,
    /// Number of the last bin.
    pub last_bin: f32,
    /// Number of the last interval between two knots.
    pub last: u32,
}

/// Number of bins by which a kernel finds the interval of a value.
const BINS: usize = 1024;

/// Beyond this no value is told from a knot at an end.
pub(super) const FAR: f32 = f32::MAX / 4.0;

/// Extinction of opacity 1, times the unit distance.
const OPAQUE: f64 = 1e6;

/// Label up to which halves between two are exact.
const MOST_LABEL: u32 = 1 << 22;

/// Error of opacity, over the unit distance, of the linear pieces that stand for its logarithm.
const OPACITY_ERROR: f64 = 1.0 / 2048.0;

/// Transfer function: colour and extinction of a scalar field's values, piecewise linear.
///
/// Colour and opacity have knots of their own, uneven and independent. Below the first knot and
/// above the last one they are constant. Two knots of one value are a step.
///
/// Opacity is that of a layer as thick as the *unit distance*: a layer of thickness `d` has opacity
/// `1 - (1 - opacity)^(d / unit)`, whatever the step of an integrator. So extinction is
/// `-ln(1 - opacity) / unit`; between the knots of opacity it follows that curve by linear pieces
/// that differ in opacity by less than 0.0005. Opacity 1 is an extinction of `1e6 / unit`.
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl::volume::TransferFunction;
///
/// let colors = [(0.0, vec3(0.2, 0.0, 0.0)), (100.0, vec3(1.0, 1.0, 0.8))];
/// let function = TransferFunction::new(&colors, &[(20.0, 0.0), (80.0, 0.75)], 1.0)?;
/// assert_eq!(function.at(80.0).extinction, 4f32.ln());
/// assert_eq!(function.at(10.0).extinction, 0.0);
///
/// let red = kernel!(|value: f32| function.at(value).color.x);
/// assert_eq!(red.call((50.0,)), 0.6);
/// # Ok::<(), raydsl::volume::TransferError>(())
/// ```
///
/// A clone is the same data to a device: it is not uploaded again.
#[derive(Clone, Debug)]
pub struct TransferFunction {
    /// The first and the last one are far away, with what their neighbours have.
    knots: Vec<TransferKnot>,
    /// Interval of the value at which each bin begins, times 2, plus 1 if a knot may be in the bin.
    bins: Vec<u32>,
    integrals: Vec<TransferIntegral>,
    layout: TransferLayout,
    owner: Arc<Owner>,
}

impl PartialEq for TransferFunction {
    fn eq(&self, other: &Self) -> bool {
        self.knots == other.knots
    }
}

impl TransferFunction {
    /// Creates a function from knots `(value, colour)` and `(value, opacity)`, each sorted by
    /// value; opacities are from 0 to 1, of a layer of thickness `unit`.
    ///
    /// # Errors
    ///
    /// If there are no knots, they are not sorted, or one is out of range.
    pub fn new(
        colors: &[(f32, Vec3)],
        opacities: &[(f32, f32)],
        unit: f32,
    ) -> Result<Self, TransferError> {
        if !(unit > 0.0 && unit.is_finite()) {
            return Err(TransferError::UnitDistance(unit));
        }
        check("opacity", opacities, |a| (0.0..=1.0).contains(a))?;
        Self::from_extinction(colors, &extinctions(opacities, f64::from(unit)))
    }

    /// Creates a function from knots `(value, colour)` and `(value, extinction)`, each sorted by
    /// value; extinction is per length of the world, and linear between its knots.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn from_extinction(
        colors: &[(f32, Vec3)],
        extinctions: &[(f32, f32)],
    ) -> Result<Self, TransferError> {
        check("opacity", extinctions, |e| *e >= 0.0 && e.is_finite())?;
        check("colour", colors, |c| c.is_finite() && c.min_element() >= 0.0)?;
        let knots = merged(colors, extinctions);
        let (first, last) = (knots[1].value, knots[knots.len() - 2].value);
        let width = f64::from(last) - f64::from(first);
        let per_value = if width > 0.0 { (BINS as f64 / width) as f32 } else { 0.0 };
        let per_value = if per_value.is_finite() { per_value } else { 0.0 };
        let is_one = per_value == 0.0;
        // By rounding a value may be taken for one of a bin beside its own: each bin begins
        // somewhat early and ends somewhat late. No value from `first` on is in bin 0.
        let at = |bin: f64| (f64::from(first) + width * (bin - 1.0) / BINS as f64) as f32;
        let bin = |bin: usize| {
            let begin = if bin == 0 || is_one { -FAR } else { at(bin as f64 - 0.01).next_down() };
            let end = match bin {
                0 if !is_one => first.next_down(),
                BINS => FAR,
                bin => {
                    if is_one {
                        FAR
                    } else {
                        at(bin as f64 + 1.01).next_up()
                    }
                }
            };
            let [begin, end] = [begin, end].map(|value| interval(&knots, value) as u32);
            begin << 1 | u32::from(begin != end)
        };
        let bins = (0..=BINS).map(bin).collect();
        let last_bin = BINS as f32;
        let layout = TransferLayout { first, per_value, last_bin, last: knots.len() as u32 - 2 };
        let integrals = integrals(&knots);
        Ok(Self { knots, bins, integrals, layout, owner: Arc::new(Owner::new()) })
    }

    /// Creates the function of labels: `(label, colour, opacity)`, sorted by label; opacities are
    /// from 0 to 1, of a layer of thickness `unit`. Values within 0.5 of a label are that label;
    /// all others are empty.
    ///
    /// ```
    /// use raydsl::prelude::*;
    /// use raydsl::volume::TransferFunction;
    ///
    /// let organs = [(3, vec3(0.8, 0.1, 0.1), 0.5), (7, vec3(0.9, 0.9, 0.7), 1.0)];
    /// let function = TransferFunction::labels(&organs, 1.0)?;
    /// assert_eq!(function.at(3.0).color, vec3(0.8, 0.1, 0.1));
    /// assert_eq!(function.at(5.0).extinction, 0.0);
    /// # Ok::<(), raydsl::volume::TransferError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// If there are no labels, if they are not sorted, if one is above 2^22, or if a number is out
    /// of range.
    pub fn labels(labels: &[(u32, Vec3, f32)], unit: f32) -> Result<Self, TransferError> {
        let of = "labels";
        if labels.is_empty() {
            return Err(TransferError::NoKnots { of });
        }
        let (mut colors, mut opacities) = (Vec::new(), Vec::new());
        let mut before = None;
        for (index, &(label, color, opacity)) in labels.iter().enumerate() {
            let is_color = color.is_finite() && color.min_element() >= 0.0;
            if label > MOST_LABEL || !is_color || !(0.0..=1.0).contains(&opacity) {
                return Err(TransferError::OutOfRange { of, index });
            }
            if before.is_some_and(|before| before >= label) {
                return Err(TransferError::Unsorted { of, index });
            }
            let [low, high] = [-0.5, 0.5].map(|half| label as f32 + half);
            let is_next = before.is_some_and(|before| before + 1 == label);
            if !is_next {
                opacities.push((low, 0.0));
            } else {
                // The step down that the label before ends with.
                opacities.pop();
            }
            colors.extend([(low, color), (high, color)]);
            opacities.extend([(low, opacity), (high, opacity), (high, 0.0)]);
            before = Some(label);
        }
        Self::new(&colors, &opacities, unit)
    }

    /// Returns the knots of both, sorted by value.
    pub fn knots(&self) -> &[TransferKnot] {
        &self.knots[1..self.knots.len() - 1]
    }

    /// Returns the greatest extinction of the values from `range.x` to `range.y`; 0 if the first is
    /// greater.
    pub fn greatest_extinction(&self, range: Vec2) -> f32 {
        if range.x.partial_cmp(&range.y).is_none_or(core::cmp::Ordering::is_gt) {
            return 0.0;
        }
        let ends = self.at(range.x).extinction.max(self.at(range.y).extinction);
        let from = self.knots.partition_point(|k| k.value < range.x);
        let inside = self.knots[from..].iter().take_while(|k| k.value <= range.y);
        inside.fold(ends, |most, k| most.max(k.extinction))
    }

    fn key(&self, part: u32) -> BufferKey {
        BufferKey { id: self.owner.id(), version: 0, part }
    }

    /// Returns the view under a name.
    pub(super) fn named_view(&self, name: &'static str) -> TransferView<'_> {
        let slice = |part| Some(self.key(part));
        TransferView {
            knots: Slice::owned(&self.knots, slice(0), name).suffixed("knots"),
            bins: Slice::owned(&self.bins, slice(1), name).suffixed("bins"),
            integrals: Slice::owned(&self.integrals, slice(2), name).suffixed("integrals"),
            layout: self.layout,
            name,
        }
    }
}

/// Checks that knots are there, sorted, and in range.
fn check<T>(
    of: &'static str,
    knots: &[(f32, T)],
    is_good: impl Fn(&T) -> bool,
) -> Result<(), TransferError> {
    if knots.is_empty() {
        return Err(TransferError::NoKnots { of });
    }
    for (index, (value, what)) in knots.iter().enumerate() {
        if !(value.abs() <= FAR / 4.0 && is_good(what)) {
            return Err(TransferError::OutOfRange { of, index });
        }
        if index > 0 && *value < knots[index - 1].0 {
            return Err(TransferError::Unsorted { of, index });
        }
    }
    Ok(())
}

/// Returns the extinction of an opacity over a distance.
pub(super) fn extinction(opacity: f64, unit: f64) -> f64 {
    (-(-opacity).ln_1p()).min(OPAQUE) / unit
}

/// Returns knots of extinction whose linear pieces follow linear opacities.
fn extinctions(opacities: &[(f32, f32)], unit: f64) -> Vec<(f32, f32)> {
    let mut all = Vec::with_capacity(opacities.len());
    for (i, &(value, opacity)) in opacities.iter().enumerate() {
        if i > 0 {
            let (before, from) = opacities[i - 1];
            let ends =
                [(before, from), (value, opacity)].map(|(v, a)| (f64::from(v), f64::from(a)));
            for piece in pieces(ends) {
                refine(piece, unit, 16, &mut all);
                let (at, opacity) = piece[1];
                // Not where an `f32` is that of an end.
                if at as f32 > before && (at as f32) < value {
                    all.push((at as f32, extinction(opacity, unit) as f32));
                }
            }
        }
        all.push((value, extinction(f64::from(opacity), unit) as f32));
    }
    all
}

/// Divides what is between two knots of opacity into as few pieces as will do.
///
/// Extinction as a linear function of opacity `a`, over a piece of width `h`, is off in opacity by
/// `h² / (8 (1 - a))`. So pieces of equal error have equal differences of `sqrt(1 - a)`.
fn pieces([from, to]: [(f64, f64); 2]) -> impl Iterator<Item = [(f64, f64); 2]> {
    let [begin, end] = [from, to].map(|(_, opacity)| (1.0 - opacity).sqrt());
    // A little more than the estimate needs, which is right for narrow pieces only.
    let count = ((begin - end).abs() * (2.0 * OPACITY_ERROR).sqrt().recip() * 1.02).ceil();
    let at = move |i: f64| {
        let opacity = 1.0 - (begin + (end - begin) * i / count).powi(2);
        let share = (opacity - from.1) / (to.1 - from.1);
        (from.0 + (to.0 - from.0) * share, opacity)
    };
    let place = move |i: usize| match i {
        0 => from,
        i if i as f64 >= count => to,
        i => at(i as f64),
    };
    (0..count.max(1.0) as usize).map(move |i| [place(i), place(i + 1)])
}

/// Appends knots between two of opacity, until linear extinction is near enough.
fn refine([from, to]: [(f64, f64); 2], unit: f64, depth: u32, all: &mut Vec<(f32, f32)>) {
    let ends = [extinction(from.1, unit), extinction(to.1, unit)];
    let error = |share: f64| {
        let opacity = from.1 + (to.1 - from.1) * share;
        let linear = ends[0] + (ends[1] - ends[0]) * share;
        (-(-linear * unit).exp_m1() - opacity).abs()
    };
    // Next to opacity 1 the error is greatest beside an end.
    let inner = (1..16).map(|i| f64::from(i) / 16.0);
    let shares = inner.chain([1.0 / 256.0, 255.0 / 256.0]);
    let worst = shares.map(error).fold(0.0, f64::max);
    let middle = ((from.0 + to.0) * 0.5, (from.1 + to.1) * 0.5);
    let is_between = (middle.0 as f32) > from.0 as f32 && (middle.0 as f32) < to.0 as f32;
    if depth == 0 || worst <= OPACITY_ERROR || !is_between {
        return;
    }
    refine([from, middle], unit, depth - 1, all);
    all.push((middle.0 as f32, extinction(middle.1, unit) as f32));
    refine([middle, to], unit, depth - 1, all);
}

/// Returns the knots of both functions, each with the other's value there, between two far ones.
fn merged(colors: &[(f32, Vec3)], extinctions: &[(f32, f32)]) -> Vec<TransferKnot> {
    let mut values: Vec<f32> = colors.iter().map(|k| k.0).collect();
    values.extend(extinctions.iter().map(|k| k.0));
    values.sort_by(f32::total_cmp);
    values.dedup();
    let mut knots = Vec::with_capacity(values.len() + 2);
    for value in values {
        let sides = |side| TransferKnot {
            value,
            extinction: linear(extinctions, value, side, |a, b, w| a + (b - a) * w),
            color: linear(colors, value, side, |a, b, w| a + (b - a) * w),
        };
        let [below, above] = [Side::Below, Side::Above].map(sides);
        knots.push(below);
        if below != above {
            knots.push(above);
        }
    }
    let (first, last) = (knots[0], knots[knots.len() - 1]);
    knots.insert(0, TransferKnot { value: -FAR, ..first });
    knots.push(TransferKnot { value: FAR, ..last });
    knots
}

/// Which side of a step.
#[derive(Clone, Copy, PartialEq)]
enum Side {
    Below,
    Above,
}

/// Returns the linear interpolation of knots, on one side of a step.
fn linear<T: Copy>(
    knots: &[(f32, T)],
    value: f32,
    side: Side,
    between: impl Fn(T, T, f32) -> T,
) -> T {
    let next = match side {
        Side::Below => knots.partition_point(|k| k.0 < value),
        Side::Above => knots.partition_point(|k| k.0 <= value),
    };
    let (Some(b), Some(a)) = (knots.get(next), next.checked_sub(1).map(|i| &knots[i])) else {
        return knots[next.min(knots.len() - 1)].1;
    };
    let share = (f64::from(value) - f64::from(a.0)) / (f64::from(b.0) - f64::from(a.0));
    match share {
        0.0 => a.1,
        1.0 => b.1,
        share => between(a.1, b.1, share as f32),
    }
}

/// Returns the interval with a value: that of the last knot that is not above it.
fn interval(knots: &[TransferKnot], value: f32) -> usize {
    knots.partition_point(|k| k.value <= value).saturating_sub(1).min(knots.len() - 2)
}

/// View of a [`TransferFunction`] in kernels: a host value on every machine.
#[derive(Clone, Copy, Debug)]
pub struct TransferView<'a> {
    knots: Slice<'a, TransferKnot>,
    bins: Slice<'a, u32>,
    integrals: Slice<'a, TransferIntegral>,
    layout: TransferLayout,
    name: &'static str,
}

table_view!([] TransferFunction, TransferView, "transfer", "transfer functions");

impl TableView for TransferView<'_> {
    fn resources(&self, visit: &mut dyn FnMut(&dyn Resource)) {
        visit(&DescribedSlice(self.knots));
        visit(&DescribedSlice(self.bins));
        visit(&DescribedSlice(self.integrals));
        visit_value(InUniforms { transfer: self.layout }, self.name, visit);
    }

    fn is_same(&self, other: &Self) -> bool {
        core::ptr::eq(self.knots.elements(), other.knots.elements())
    }
}

/// Layout in the uniform block: `function_transfer`.
#[derive(Clone, Copy, Type)]
struct InUniforms {
    transfer: TransferLayout,
}

/// What the kernels of this module read from a transfer function.
impl TransferFunction {
    #[inline(always)]
    pub(super) fn layout(&self) -> TransferLayout {
        self.layout
    }

    #[inline(always)]
    pub(super) fn knot(&self, i: u32) -> TransferKnot {
        self.knots[i as usize]
    }

    #[inline(always)]
    pub(super) fn bin(&self, i: u32) -> u32 {
        self.bins[i as usize]
    }

    #[inline(always)]
    pub(super) fn integral(&self, i: u32) -> TransferIntegral {
        self.integrals[i as usize]
    }

    #[inline(always)]
    pub(super) fn interval(&self, value: f32) -> u32 {
        interval_by_bins(self, value)
    }

    /// Returns colour and extinction of a value. A NaN is the least value.
    #[inline]
    pub fn at(&self, value: f32) -> TransferSample {
        sample_of(self, value)
    }

    /// Returns the mean of extinction over all values between two, each as frequent as any other,
    /// and that of colour, weighted by extinction: what a thin layer has whose value runs evenly
    /// from one to the other. Knots between them count, however narrow their peaks. Right to
    /// rounding, but for some 2^-48 of the function's whole integral, over the values' difference.
    #[inline]
    pub fn between(&self, a: f32, b: f32) -> TransferSample {
        mean_between(self, a, b)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine> Method<{ name("layout") }, M, ()> for TransferView<'_> {
    type Output = <TransferLayout as MachineType>::On<M>;

    #[inline(always)]
    fn call(self, m: &M, (): ()) -> Self::Output {
        m.capture(self.name, InUniforms { transfer: self.layout }).transfer
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine> Method<{ name("knot") }, M, (U<M>,)> for TransferView<'_> {
    type Output = <TransferKnot as MachineType>::On<M>;

    #[inline(always)]
    fn call(self, m: &M, (i,): (U<M>,)) -> Self::Output {
        m.element(&self.knots, i)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine> Method<{ name("bin") }, M, (U<M>,)> for TransferView<'_> {
    type Output = U<M>;

    #[inline(always)]
    fn call(self, m: &M, (i,): (U<M>,)) -> U<M> {
        m.element(&self.bins, i)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine> Method<{ name("integral") }, M, (U<M>,)> for TransferView<'_> {
    type Output = <TransferIntegral as MachineType>::On<M>;

    #[inline(always)]
    fn call(self, m: &M, (i,): (U<M>,)) -> Self::Output {
        m.element(&self.integrals, i)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine> Method<{ name("between") }, M, (F<M>, F<M>)> for TransferView<'_> {
    type Output = <TransferSample as MachineType>::On<M>;

    #[inline(always)]
    fn call(self, m: &M, (a, b): (F<M>, F<M>)) -> Self::Output {
        mean_between::on(m, self, a, b)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine> Method<{ name("interval") }, M, (F<M>,)> for TransferView<'_> {
    type Output = U<M>;

    #[inline(always)]
    fn call(self, m: &M, (value,): (F<M>,)) -> U<M> {
        m.perform(&FindInterval(self), value)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine> Method<{ name("at") }, M, (F<M>,)> for TransferView<'_> {
    type Output = <TransferSample as MachineType>::On<M>;

    #[inline(always)]
    fn call(self, m: &M, (value,): (F<M>,)) -> Self::Output {
        sample_of::on(m, self, value)
    }
}

/// Finds the interval with a value: the number of its lower knot.
struct FindInterval<'a>(TransferView<'a>);

impl Operation for FindInterval<'_> {
    type Input = f32;
    type Output = u32;

    #[inline(always)]
    fn on_scalar(&self, m: &Scalar, value: F<Scalar>) -> U<Scalar> {
        interval_by_bins::on(m, self.0, value)
    }

    #[inline(always)]
    fn on_packet<L: Lanes>(&self, m: &Packet<L>, value: F<Packet<L>>) -> U<Packet<L>> {
        interval_by_bins::on(m, self.0, value)
    }

    fn on_recorder(&self, m: &Recorder, value: F<Recorder>) -> U<Recorder> {
        interval_by_bins::on(m, self.0, value)
    }

    /// Compares with knots alone: which bin a value is in leaves no trace in the result.
    fn on_margin(&self, m: &Margin, value: F<Margin>) -> U<Margin> {
        interval_by_search::on(m, self.0, value)
    }
}

#[kernel]
#[inline(always)]
fn interval_by_bins(function: &TransferFunction, value: f32) -> u32 {
    let TransferLayout { first, per_value, last_bin, last } = function.layout();
    // A NaN becomes 0.
    let place = min(max(0.0, (value - first) * per_value + 1.0), last_bin);
    let bin: u32 = function.bin(place as u32);
    let mut i = bin >> 1;
    if bin & 1 != 0 {
        // A bin may have several knots.
        let mut next: TransferKnot = function.knot(i + 1);
        while i < last && value >= next.value {
            i += 1;
            next = function.knot(i + 1);
        }
    }
    i
}

#[kernel]
#[inline]
#[allow(
    dead_code,
    reason = "its lifted form gives bounds on rounding; it is a source for no other"
)]
fn interval_by_search(function: &TransferFunction, value: f32) -> u32 {
    let (mut first, mut end) = (0u32, function.layout().last + 1);
    while first + 1 < end {
        let middle = (first + end) / 2;
        let knot: TransferKnot = function.knot(middle);
        if value >= knot.value {
            first = middle;
        } else {
            end = middle;
        }
    }
    first
}

/// Returns the share of the way from one value to another, from 0 to 1. A NaN becomes 0.
#[kernel]
#[inline(always)]
pub(super) fn share_of(value: f32, from: f32, to: f32) -> f32 {
    min(max(0.0, (value - from) / (to - from)), 1.0)
}

/// Returns colour and extinction of a value.
#[kernel]
#[inline(always)]
fn sample_of(function: &TransferFunction, value: f32) -> TransferSample {
    let i: u32 = function.interval(value);
    sample_between(function.knot(i), function.knot(i + 1), value)
}

/// Returns colour and extinction of a value between two knots.
#[kernel]
#[inline]
pub(super) fn sample_between(a: TransferKnot, b: TransferKnot, value: f32) -> TransferSample {
    let share = share_of(value, a.value, b.value);
    let extinction = a.extinction + (b.extinction - a.extinction) * share;
    TransferSample { color: a.color + (b.color - a.color) * share, extinction }
}

/// Returns colour and extinction of a value; black where there is no extinction, as of most values:
/// only behind that test are colours fetched.
#[kernel]
#[inline(always)]
pub(super) fn seen_sample_of(function: &TransferFunction, value: f32) -> TransferSample {
    let i: u32 = function.interval(value);
    let a: TransferKnot = function.knot(i);
    let b: TransferKnot = function.knot(i + 1);
    let share = share_of(value, a.value, b.value);
    let extinction = a.extinction + (b.extinction - a.extinction) * share;
    let mut color = Vec3::ZERO;
    if extinction > 0.0 {
        let a: TransferKnot = function.knot(i);
        let b: TransferKnot = function.knot(i + 1);
        color = a.color + (b.color - a.color) * share;
    }
    TransferSample { color, extinction }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec2;

    const WHITE: [(f32, Vec3); 1] = [(0.0, Vec3::ONE)];

    #[test]
    fn knots_are_checked() {
        let error = |colors: &[(f32, Vec3)], opacities: &[(f32, f32)]| {
            TransferFunction::new(colors, opacities, 1.0).map(|_| ()).expect_err("a bad function")
        };
        assert_eq!(error(&[], &[(0.0, 0.0)]), TransferError::NoKnots { of: "colour" });
        assert_eq!(error(&WHITE, &[]), TransferError::NoKnots { of: "opacity" });
        let of = "opacity";
        let unsorted = [(1.0, 0.0), (0.0, 0.0)];
        assert_eq!(error(&WHITE, &unsorted), TransferError::Unsorted { of, index: 1 });
        for bad in [(0.0, 1.5), (0.0, -0.1), (f32::NAN, 0.0), (0.0, f32::NAN), (f32::MAX, 0.0)] {
            let found = error(&WHITE, &[(-1.0, 0.5), bad]);
            assert_eq!(found, TransferError::OutOfRange { of, index: 1 });
        }
        let unit = TransferFunction::new(&WHITE, &[(0.0, 0.0)], 0.0).map(|_| ());
        assert_eq!(unit, Err(TransferError::UnitDistance(0.0)));
    }

    #[test]
    fn linear_extinction_follows_opacity() {
        let ramp = TransferFunction::new(&WHITE, &[(10.0, 0.0), (20.0, 1.0)], 2.0);
        let ramp = ramp.expect("a function");
        let mut worst = 0.0f64;
        for i in 0..=10_000 {
            let value = 10.0 + i as f32 * 1e-3;
            let opacity = -(-2.0 * f64::from(ramp.at(value).extinction)).exp_m1();
            worst = worst.max((opacity - f64::from(value - 10.0) * 0.1).abs());
        }
        assert!(worst < 5.5e-4, "{worst}");
        assert_eq!(ramp.at(20.0).extinction, 5e5);
        assert!(ramp.knots().len() < 80, "{}", ramp.knots().len());
    }

    #[test]
    fn steps_have_two_sides() {
        let colors = [(1.0, Vec3::X), (1.0, Vec3::Y), (2.0, Vec3::Z)];
        let step = TransferFunction::from_extinction(&colors, &[(0.0, 1.0), (2.0, 3.0)]);
        let step = step.expect("a function");
        assert_eq!(step.at(0.999).color, Vec3::X);
        assert_eq!(step.at(1.0).color, Vec3::Y);
        assert_eq!(step.at(1.0).extinction, 2.0);
        assert_eq!(step.at(9.0).color, Vec3::Z);
        assert_eq!(step.at(-9.0).extinction, 1.0);
        assert_eq!(step.knots().len(), 4);
    }

    #[test]
    fn the_greatest_extinction_is_at_a_knot_or_an_end() {
        let hat = [(0.0, 0.0), (1.0, 5.0), (3.0, 1.0)];
        let hat = TransferFunction::from_extinction(&WHITE, &hat).expect("a function");
        for (range, most) in [
            (vec2(0.0, 3.0), 5.0),
            (vec2(0.0, 0.5), 2.5),
            (vec2(2.0, 3.0), 3.0),
            (vec2(1.0, 1.0), 5.0),
            (vec2(-5.0, -1.0), 0.0),
            (vec2(3.0, 9.0), 1.0),
            (vec2(1.0, 0.0), 0.0),
        ] {
            assert_eq!(hat.greatest_extinction(range), most, "{range}");
        }
    }

    #[test]
    fn one_knot_and_narrow_ranges() {
        let one = TransferFunction::from_extinction(&WHITE, &[(5.0, 2.0)]).expect("a function");
        for value in [-1e30, 0.0, 5.0, 1e30] {
            assert_eq!(one.at(value), TransferSample { color: Vec3::ONE, extinction: 2.0 });
        }
        let narrow = [(1.0, 0.0), (1.0f32.next_up(), 1.0)];
        let narrow = TransferFunction::from_extinction(&WHITE, &narrow).expect("a function");
        assert_eq!(narrow.at(1.0).extinction, 0.0);
        assert_eq!(narrow.at(1.0f32.next_up()).extinction, 1.0);
        assert_eq!(narrow.at(0.0).extinction, 0.0);
    }
}
