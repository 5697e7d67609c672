//! What comes back of a pulse.

use raydsl::prelude::*;
use raydsl::{Type, kernel};

use super::scanner::Scanner;

/// The most returns of a pulse.
pub(crate) const ECHOES: usize = 5;

/// One return.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
pub(crate) struct Echo {
    /// Measured distance in metres.
    pub(crate) range: f32,
    /// Distance without noise.
    pub(crate) true_range: f32,
    /// Light that comes back, of what a white wall at the height of flight would send.
    pub(crate) intensity: f32,
    /// The triangle that was hit.
    pub(crate) prim_id: u32,
}

/// The returns of a pulse, from near to far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
pub(crate) struct Returns {
    /// How many there are.
    pub(crate) count: u32,
    /// The returns; those from `count` on are zeros.
    pub(crate) echoes: [Echo; ECHOES],
}

impl Returns {
    /// The returns that are there.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &Echo> {
        self.echoes.iter().take(self.count as usize)
    }
}

/// How surfaces take light from a beam and send it back.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub(crate) struct Surfaces {
    /// Triangles from this one on are tufts of leaves.
    pub(crate) first_leaf: u32,
    /// Share of a beam that a tuft stops.
    pub(crate) leaf_share: f32,
    /// Reflectances, of leaves and of all else.
    pub(crate) leaf_reflectance: f32,
    pub(crate) solid_reflectance: f32,
}

impl Surfaces {
    /// Surfaces as a laser of 1064 nm sees them.
    pub(crate) fn new(first_leaf: u32) -> Self {
        Self { first_leaf, leaf_share: 0.45, leaf_reflectance: 0.5, solid_reflectance: 0.3 }
    }
}

// ANCHOR: returns
/// What comes back of a pulse: a ray within the beam passes tufts of leaves, each of which stops a
/// share of the light, until it is stopped altogether.
#[kernel]
pub(crate) fn returns(
    land: &Bvh<'_, Triangle>,
    surfaces: Surfaces,
    scanner: Scanner,
    pulse: u32,
) -> Returns {
    let mut rng = Rng::new(uvec2(pulse, 0), 0, scanner.seed);
    let beam = scanner.beam(pulse);
    let ray = Ray::new(beam.origin, within(beam.axis, scanner.half_divergence, rng.next_2d()));
    let nothing = Echo { range: 0.0, true_range: 0.0, intensity: 0.0, prim_id: 0 };
    let mut echoes = [nothing; ECHOES];
    let mut count: u32 = 0;
    let mut light = 1.0;
    let mut last = -scanner.altitude;
    for hit in land.hits(ray) {
        let is_leaf = hit.prim_id >= surfaces.first_leaf;
        let share = if is_leaf { surfaces.leaf_share } else { 1.0 };
        let reflectance =
            if is_leaf { surfaces.leaf_reflectance } else { surfaces.solid_reflectance };
        let facet = land.primitive(hit);
        let normal = triangle::normal(ray, hit, facet.v0, facet.v1, facet.v2);
        let nearer = scanner.altitude / hit.t;
        let intensity =
            light * share * reflectance * normal.dot(ray.direction).abs() * nearer * nearer;
        light *= 1.0 - share;
        if intensity >= scanner.threshold && hit.t - last >= scanner.separation {
            let range = hit.t + scanner.noise * gaussian(rng.next_2d());
            echoes[count as usize] =
                Echo { range, true_range: hit.t, intensity, prim_id: hit.prim_id };
            count += 1;
            last = hit.t;
        }
        if count as usize == ECHOES || light < scanner.threshold {
            break;
        }
    }
    Returns { count, echoes }
}
// ANCHOR_END: returns

/// A direction within a Gaussian beam, as likely as light goes there.
#[kernel]
fn within(axis: Vec3, half_divergence: f32, u: Vec2) -> Vec3 {
    let aside = half_divergence * (-0.5 * log(1.0 - u.x)).sqrt();
    let around = sincos_2pi(u.y);
    let (x, y) = axis.any_orthonormal_pair();
    (axis + (x * around.cos + y * around.sin) * aside).normalize()
}

/// A number of the normal distribution (Box and Muller 1958).
#[kernel]
fn gaussian(u: Vec2) -> f32 {
    (-2.0 * log(1.0 - u.x)).sqrt() * sincos_2pi(u.y).cos
}

/// The root mean square of the differences between measured and true ranges, in metres; 0 without
/// returns.
pub(crate) fn range_error(measured: &[Returns]) -> f64 {
    let errors = measured.iter().flat_map(Returns::iter).map(|echo| {
        let error = f64::from(echo.range) - f64::from(echo.true_range);
        error * error
    });
    let (count, sum) = errors.fold((0u64, 0.0), |(n, sum), e| (n + 1, sum + e));
    (sum / count.max(1) as f64).sqrt()
}
