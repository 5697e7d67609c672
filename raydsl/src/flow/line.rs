//! Lines that were followed, on the host.

use glam::Vec3;

use super::follow::{FlowEnd, FlowPoint, FlowSteps};

/// A streamline: the points at which its steps end, and a curve of order 4 between them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Streamline {
    points: Vec<FlowPoint>,
    /// Why it ends at its first point and at its last one.
    ends: [Option<FlowEnd>; 2],
    attempts: u32,
}

impl Streamline {
    /// Adds what a call of the kernel returns.
    pub(super) fn add(&mut self, steps: &FlowSteps) {
        if self.points.is_empty() && steps.state.end != FlowEnd::NoField {
            self.points.push(steps.state.first_point());
        }
        self.points.extend(&steps.points[..steps.count as usize]);
        self.attempts = steps.state.attempts;
        self.ends[1] = Some(steps.state.end);
    }

    /// Joins a line that was followed backwards and one that was followed forwards, at their seed.
    pub(super) fn joined(back: Self, forth: Self) -> Self {
        let (mut points, mut before) = (Vec::new(), Vec3::ZERO);
        for point in back.points.iter().rev() {
            // A bend belongs to the part behind its point, which is now the part before.
            points.push(FlowPoint { bend: before, ..*point });
            before = point.bend;
        }
        points.extend(forth.points.iter().skip(usize::from(!points.is_empty())));
        // The first point after the seed has its own bend: it is the end of a step forwards.
        Self {
            points,
            ends: [back.ends[1], forth.ends[1]],
            attempts: back.attempts + forth.attempts,
        }
    }

    /// Returns the ends of the steps, the seed among them, in the order of time; those of a line that
    /// was followed backwards alone are from the seed on, against time. There is none if the field has
    /// no value at the seed.
    pub fn points(&self) -> &[FlowPoint] {
        &self.points
    }

    /// Returns why the line ends at its last point.
    pub fn end(&self) -> FlowEnd {
        self.ends[1].unwrap_or_default()
    }

    /// Returns why it ends at its first point, if it was followed both ways.
    pub fn begin(&self) -> Option<FlowEnd> {
        self.ends[0]
    }

    /// Returns the number of steps that were tried.
    pub fn attempts(&self) -> u32 {
        self.attempts
    }

    /// Returns the point at a time, or `None` if the line does not have it. Its error is of the
    /// order of that of the steps.
    pub fn at(&self, time: f32) -> Option<FlowPoint> {
        let is_backwards = self.points.last()?.time < self.points.first()?.time;
        let sign = if is_backwards { -1.0 } else { 1.0 };
        let next = self.points.partition_point(|p| p.time * sign < time * sign);
        let to = self.points.get(next)?;
        if to.time == time {
            return Some(*to);
        }
        let from = self.points.get(next.checked_sub(1)?)?;
        Some(between(from, to, (time - from.time) / (to.time - from.time)))
    }

    /// Returns points on the line between which it turns by about `angle`, in radians, or less, and all
    /// ends of steps: corners of a polygon that looks round. At most 64 are in one step.
    pub fn polygon(&self, angle: f32) -> Vec<FlowPoint> {
        let mut all: Vec<FlowPoint> = self.points.first().copied().into_iter().collect();
        for pair in self.points.windows(2) {
            let [from, to] = [&pair[0], &pair[1]];
            // The turn is measured in both halves: a step may turn there and back.
            let middle = between(from, to, 0.5);
            let turn = from.velocity.angle_between(middle.velocity)
                + middle.velocity.angle_between(to.velocity);
            let parts = (turn / angle.max(1e-3)).ceil().clamp(1.0, 64.0) as u32;
            all.extend((1..parts).map(|i| between(from, to, i as f32 / parts as f32)));
            all.push(*to);
        }
        all
    }
}

/// Returns the point at a share of a step's time: its cubic of Hermite, and the term of order 4; its
/// length is on the cubic of the lengths and speeds at both ends.
fn between(from: &FlowPoint, to: &FlowPoint, share: f32) -> FlowPoint {
    let (x, y) = (share, 1.0 - share);
    let time = to.time - from.time;
    let (a, b) = (from.velocity * time, to.velocity * time);
    let moved = to.at - from.at;
    // Displacement, and its derivative by the share.
    let (p, q) = (a - moved, moved - b);
    // The term counts along the line as it was followed.
    let bend = to.bend;
    let at = from.at + moved * x + (p * y + q * x) * (x * y) + bend * (x * x * y * y);
    let slope =
        moved + (p * y + q * x) * (y - x) + (q - p) * (x * y) + bend * (2.0 * x * y * (y - x));
    // Length and time have the same sign, so the slope of the length by time is the speed.
    let (u, v) = (from.velocity.length() * time, to.velocity.length() * time);
    let way = to.length - from.length;
    FlowPoint {
        at,
        velocity: if time == 0.0 { from.velocity } else { slope / time },
        time: from.time + time * x,
        length: from.length + way * x + ((u - way) * y + (way - v) * x) * (x * y),
        bend: Vec3::ZERO,
    }
}
