//! Streamlines through a field, and what their colours show.

use raydsl::flow::{Arrow, Capsule, FlowError, FlowPoint, FlowSettings, FlowState, FlowSteps};
use raydsl::flow::{Streamline, Ways, streamlines};
use raydsl::kernel::Kernel;
use raydsl::prelude::*;

use super::Failure;
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

/// The place in a box of a number of an R₃ sequence, whose points keep their distance from one another
/// (Roberts, 2018): in integers, so that they do however many there are.
pub(crate) fn place(i: u32, bounds: Aabb) -> Vec3 {
    // 2^32 times the first powers of 1 / x, where x^4 = x + 1.
    let steps = uvec3(0xd1b5_4a33, 0xabc9_8389, 0x8cb9_2ba7);
    let share = steps.wrapping_mul(UVec3::splat(i)).wrapping_add(UVec3::splat(1 << 31));
    bounds.min + bounds.size() * (share >> 8u32).as_vec3() / (1u32 << 24) as f32
}

/// Places where the field has a value, evenly over its box.
fn seeds(field: &Field<'_>, count: u32) -> Vec<Vec3> {
    let at = |i: u32| place(i, field.bounds);
    let all = (0..count.saturating_mul(100)).map(at);
    all.filter(|p| (field.velocity)(*p).is_some()).take(count as usize).collect()
}

/// Follows lines through a field and makes tubes of them, and arrows where they are asked for.
///
/// # Errors
///
/// If the field has a value nowhere.
pub(crate) fn through(
    args: &Args,
    field: &Field<'_>,
    kernel: &Kernel<'_, (FlowState,), FlowSteps>,
) -> Result<Shown, Failure> {
    let extent = field.bounds.size().max_element();
    let seeds = seeds(field, args.lines);
    if seeds.is_empty() {
        let message = "no place was found where the field has a value: check the array of vectors";
        return Err(Failure::Usage(message.to_owned()));
    }
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
    Ok(Shown { tubes, arrows, title: field.title.clone(), bounds: field.bounds })
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_keep_apart() {
        let unit = Aabb::new(Vec3::ZERO, Vec3::ONE);
        // Far along the sequence, too, where a product of floats has no digits left.
        for first in [0, 30_000_000, u32::MAX - 1000] {
            let all: Vec<Vec3> = (0..1000).map(|i| place(first + i, unit)).collect();
            assert!(all.iter().all(|p| p.cmpge(Vec3::ZERO).all() && p.cmplt(Vec3::ONE).all()));
            let nearest = |i: usize| {
                let others = all[..i].iter().map(|p| p.distance(all[i]));
                others.fold(f32::INFINITY, f32::min)
            };
            let least = (1..1000).map(nearest).fold(f32::INFINITY, f32::min);
            // On a regular grid of as many it is 0.1.
            assert!(least > 0.04, "{least}");
        }
    }
}
