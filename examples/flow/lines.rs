//! Streamlines through a field, and what their colours show.

use raydsl::flow::{Arrow, Capsule, FlowError, FlowPoint, FlowSettings, FlowState, FlowSteps};
use raydsl::flow::{Streamline, Ways, streamlines};
use raydsl::kernel::Kernel;
use raydsl::prelude::*;

use super::args::Args;

/// What is shown: parts of tubes and arrows with a value each, which colours stand for.
pub(crate) struct Shown {
    pub(crate) tubes: Vec<Capsule>,
    pub(crate) arrows: Vec<Arrow>,
    /// What the values are, for the legend.
    pub(crate) title: String,
    pub(crate) bounds: Aabb,
}

impl Shown {
    /// The least and the greatest value.
    pub(crate) fn range(&self) -> (f32, f32) {
        let of_tubes = self.tubes.iter().flat_map(|c| [c.value0, c.value1]);
        let all = of_tubes.chain(self.arrows.iter().map(|a| a.value));
        let (low, high) = all
            .filter(|v| v.is_finite())
            .fold((f32::INFINITY, f32::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
        if low < high { (low, high) } else { (low.min(0.0), low.max(0.0) + 1.0) }
    }
}

/// A field in a box, on the host.
pub(crate) struct Field<'a> {
    pub(crate) bounds: Aabb,
    /// The velocity at a place.
    pub(crate) velocity: &'a dyn Fn(Vec3) -> Option<Vec3>,
    /// What colours show at a point, and its name.
    pub(crate) value: &'a dyn Fn(&FlowPoint) -> f32,
    pub(crate) title: String,
}

/// Tolerance and limits by the arguments, for a field of this extent.
pub(crate) fn settings(args: &Args, extent: f32) -> Result<FlowSettings, FlowError> {
    let tolerance = args.tolerance.unwrap_or(1e-5 * extent);
    FlowSettings::new(tolerance, extent / 30.0)?.max_length(args.length.unwrap_or(extent))
}

/// Radius of tubes.
pub(crate) fn radius(args: &Args, extent: f32) -> f32 {
    args.radius.unwrap_or(extent / 200.0)
}

/// Places where the field has a value, evenly over its box: an R₃ sequence, whose points keep their
/// distance from one another (Roberts, 2018).
fn seeds(field: &Field<'_>, count: u32) -> Vec<Vec3> {
    let steps = vec3(0.819_172_5, 0.671_043_6, 0.549_700_5);
    let place = |i: u32| (steps * i as f32 + 0.5).fract();
    let at = |i: u32| field.bounds.min + field.bounds.size() * place(i);
    let all = (0..count.saturating_mul(100)).map(at);
    all.filter(|p| (field.velocity)(*p).is_some()).take(count as usize).collect()
}

/// Follows lines through a field and makes tubes of them, and arrows where they are asked for.
pub(crate) fn through(
    args: &Args,
    field: &Field<'_>,
    kernel: &Kernel<'_, (FlowState,), FlowSteps>,
) -> Shown {
    let extent = field.bounds.size().max_element();
    let seeds = seeds(field, args.lines);
    let start = std::time::Instant::now();
    // ANCHOR: streamlines
    let lines = streamlines(&TiledScheduler::new(), kernel, &seeds, Ways::Both);
    let radius = radius(args, extent);
    let tubes = lines.iter().flat_map(|line| {
        // Corners of less than five degrees look round.
        Capsule::chain(&line.polygon(0.08), radius, |point| (field.value)(point))
    });
    let tubes: Vec<Capsule> = tubes.collect();
    // ANCHOR_END: streamlines
    println!(
        "{} lines with {} steps of {} tried, followed in {:.0} ms; {} parts of tubes",
        lines.len(),
        lines.iter().map(|l| l.points().len().saturating_sub(1)).sum::<usize>(),
        lines.iter().map(Streamline::attempts).sum::<u32>(),
        start.elapsed().as_secs_f64() * 1e3,
        tubes.len()
    );
    let arrows = args.arrows.map_or_else(Vec::new, |along| arrows(field, along));
    Shown { tubes, arrows, title: field.title.clone(), bounds: field.bounds }
}

/// Arrows on a regular grid, so many along its longest side; the longest fills its place.
fn arrows(field: &Field<'_>, along: u32) -> Vec<Arrow> {
    let size = field.bounds.size();
    let step = size.max_element() / along as f32;
    let count = (size / step).ceil().max(Vec3::ONE);
    let [nx, ny, nz] = count.to_array().map(|n| n as u32);
    let place = |i: u32| uvec3(i % nx, i / nx % ny, i / (nx * ny)).as_vec3() + 0.5;
    let found: Vec<FlowPoint> = (0..nx * ny * nz)
        .filter_map(|i| {
            let at = field.bounds.min + place(i) * size / count;
            let velocity = (field.velocity)(at)?;
            Some(FlowPoint { at, velocity, ..FlowPoint::default() })
        })
        .collect();
    let most = found.iter().map(|p| p.velocity.length()).fold(f32::MIN_POSITIVE, f32::max);
    let arrow = |p: &FlowPoint| Arrow::at(p.at, p.velocity * (step / most), (field.value)(p));
    found.iter().map(arrow).collect()
}
