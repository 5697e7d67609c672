//! Rays of sound.

use raydsl::kernel::Kernel;
use raydsl::prelude::*;
use raydsl::{Type, kernel};

use super::bins::{Bins, faded};
use super::room::{Room, Wall};

/// Arrivals that a kernel returns at most; then its path is continued by another call.
pub(crate) const ARRIVALS: usize = 8;
/// Groups of rays, whose differences give the error.
pub(crate) const GROUPS: usize = 32;
/// Rays that are under way at a time.
const WAVE: u32 = 1 << 16;

/// Where a ray is, and what it has left.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
pub(crate) struct Path {
    /// Where it is.
    pub(crate) origin: Vec3,
    /// Where it goes, of unit length.
    pub(crate) direction: Vec3,
    /// Metres so far.
    pub(crate) travelled: f32,
    /// Share of its energy that walls have left; air is reckoned later.
    pub(crate) energy: f32,
}

/// A way through the receiver.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
pub(crate) struct Arrival {
    /// Metres from the source to where it begins.
    pub(crate) distance: f32,
    /// Metres within the receiver.
    pub(crate) chord: f32,
    /// Energy.
    pub(crate) energy: f32,
}

/// A part of a path.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
pub(crate) struct Flight {
    /// Where it ended.
    pub(crate) path: Path,
    /// Whether that is the end of the whole path.
    pub(crate) is_over: bool,
    /// Whether it left the room between two walls.
    pub(crate) is_lost: bool,
    /// How many arrivals there are.
    pub(crate) count: u32,
    /// The arrivals; those from `count` on are zeros.
    pub(crate) arrivals: [Arrival; ARRIVALS],
}

#[kernel]
impl Path {
    /// The path of a ray from the source, in a direction that its number chooses.
    pub(crate) fn emitted(source: Vec3, seed: u32, number: u32) -> Self {
        let mut rng = Rng::new(uvec2(number, 0), 0, seed);
        let direction = sample_uniform_sphere(rng.next_2d());
        Path { origin: source, direction, travelled: 0.0, energy: 1.0 }
    }
}

// ANCHOR: fly
/// Follows a path until it is `reach` metres long or has no room for further arrivals.
#[kernel]
pub(crate) fn fly(walls: &Bvh<'_, Wall>, receiver: Vec4, reach: f32, path: Path) -> Flight {
    let mut ray = Ray::new(path.origin, path.direction);
    let mut travelled = path.travelled;
    let mut energy = path.energy;
    let nothing = Arrival { distance: 0.0, chord: 0.0, energy: 0.0 };
    let mut arrivals = [nothing; ARRIVALS];
    let mut count: u32 = 0;
    let mut is_lost = false;
    while travelled < reach && (count as usize) < ARRIVALS {
        let hit = walls.closest_hit(ray);
        if !hit.is_hit {
            is_lost = true;
            break;
        }
        let heard = chord(ray, hit.t, receiver);
        if heard.y > heard.x {
            arrivals[count as usize] =
                Arrival { distance: travelled + heard.x, chord: heard.y - heard.x, energy };
            count += 1;
        }
        let wall = walls.primitive(hit);
        let point = rectangle::surface_point(ray, hit, wall.corner, wall.u_edge, wall.v_edge);
        let across = point.normal.dot(ray.direction);
        travelled += hit.t;
        energy *= 1.0 - wall.absorption;
        ray = point.ray((ray.direction - point.normal * (2.0 * across)).normalize());
    }
    let path = Path { origin: ray.origin, direction: ray.direction, travelled, energy };
    Flight { path, is_over: is_lost || travelled >= reach, is_lost, count, arrivals }
}

/// Where a ray enters and leaves a ball in front of a wall; the first is not less than the second if
/// it does not.
#[kernel]
fn chord(ray: Ray, wall: f32, ball: Vec4) -> Vec2 {
    let to_center = ball.truncate() - ray.origin;
    let nearest = to_center.dot(ray.direction);
    let aside = (to_center - ray.direction * nearest).length();
    let half = max((ball.w - aside) * (ball.w + aside), 0.0).sqrt();
    vec2(max(nearest - half, 0.0), min(nearest + half, wall))
}
// ANCHOR_END: fly

/// What rays brought to the receiver.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Heard {
    /// The response as each group of rays estimates it, energy per square metre in each bin.
    pub(crate) groups: Vec<Vec<f64>>,
    /// Rays that left the room.
    pub(crate) lost: u32,
}

impl Heard {
    /// The response.
    pub(crate) fn response(&self) -> Vec<f64> {
        let bins = self.groups[0].len();
        let mean = |i: usize| self.groups.iter().map(|g| g[i]).sum::<f64>() / GROUPS as f64;
        (0..bins).map(mean).collect()
    }

    /// The standard error of the sum of some bins.
    pub(crate) fn standard_error(&self, bins: std::ops::Range<usize>) -> f64 {
        let sums: Vec<f64> =
            self.groups.iter().map(|g| g[bins.clone()].iter().sum::<f64>()).collect();
        let mean = sums.iter().sum::<f64>() / GROUPS as f64;
        let square = sums.iter().map(|s| (s - mean).powi(2)).sum::<f64>();
        (square / (GROUPS * (GROUPS - 1)) as f64).sqrt()
    }
}

// ANCHOR: trace
/// Sends rays, rounded up to a multiple of the number of groups, and adds up what is heard: a ray
/// with the share `w` of all energy that is in the receiver for `s` metres adds `w s` to the energy
/// per square metre times the receiver's volume. (The mean of the flow over a volume is the length
/// of all ways in it: the track-length estimator of particle transport.)
pub(crate) fn trace(
    room: &Room,
    bins: Bins,
    (rays, seed): (u32, u32),
    kernel: &Kernel<'_, (Path,), Flight>,
) -> Heard {
    let groups = GROUPS as u32;
    let rays = rays.div_ceil(groups) * groups;
    let mut heard = Heard { groups: vec![vec![0.0; bins.count]; GROUPS], lost: 0 };
    let share = f64::from(groups) / (f64::from(rays) * room.ball_volume());
    for first in (0..rays).step_by(WAVE as usize) {
        let mut numbers: Vec<u32> = (first..rays.min(first + WAVE)).collect();
        let start = |&number: &u32| (Path::emitted(room.source.as_vec3(), seed, number),);
        let mut paths: Vec<(Path,)> = numbers.iter().map(start).collect();
        while !paths.is_empty() {
            let mut flights = vec![Flight::default(); paths.len()];
            TiledScheduler::new().batch(kernel, &paths, &mut flights);
            for (number, flight) in numbers.iter().zip(&flights) {
                let group = &mut heard.groups[(number % groups) as usize];
                flight.arrivals().for_each(|arrival| add(group, room.air, bins, share, arrival));
                heard.lost += u32::from(flight.is_lost);
            }
            let mut more = flights.iter().map(|f| !f.is_over);
            numbers.retain(|_| more.next() == Some(true));
            paths = flights.iter().filter(|f| !f.is_over).map(|f| (f.path,)).collect();
        }
    }
    heard
}
// ANCHOR_END: trace

impl Flight {
    fn arrivals(&self) -> impl Iterator<Item = &Arrival> {
        self.arrivals.iter().take(self.count as usize)
    }
}

/// Adds an arrival to the bins that it lasts for.
fn add(into: &mut [f64], air: f64, bins: Bins, share: f64, arrival: &Arrival) {
    let from = f64::from(arrival.distance);
    let energy = share * f64::from(arrival.energy);
    for (i, low, high) in bins.parts(from, from + f64::from(arrival.chord)) {
        into[i] += energy * faded(air, low, high);
    }
}
