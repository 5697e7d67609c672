//! Interval culling: bounds of a ray packet, which one box test culls for all of its rays.
//!
//! Origins and inverse directions become intervals. The beam enters a box where the first of its
//! rays may enter it, and leaves where the last one may leave: the test of one ray, with different
//! values for near and far planes. (Reshetov, Soupikov and Hurley, "Multi-Level Ray Tracing
//! Algorithm", ACM Transactions on Graphics 24(3), 2005.)

use glam::Vec3;

use super::octant::Octant;
use super::rays::{GROUP, HUGE, Rays, lanes_mask, load, row};
use super::step::Slabs;
use crate::bvh::contract::{Padding, ULP, finite_inverse};
use crate::geometry::{Aabb, Ray};
use crate::machine::{Lanes, op};

/// The interval bounds of rays whose directions lie in one octant.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beam {
    pub(super) side: [usize; 3],
    near: [[f32; 2]; 3],
    far: [[f32; 2]; 3],
    t_min: f32,
    /// The distance beyond which nodes are culled for all of the rays.
    pub(super) limit: f32,
}

impl Slabs for &Beam {
    #[inline(always)]
    fn side(self, axis: usize) -> usize {
        self.side[axis]
    }
    #[inline(always)]
    fn near(self, axis: usize) -> [f32; 2] {
        self.near[axis]
    }
    #[inline(always)]
    fn far(self, axis: usize) -> [f32; 2] {
        self.far[axis]
    }
    #[inline(always)]
    fn t_min(self) -> f32 {
        self.t_min
    }
    #[inline(always)]
    fn limit(self) -> f32 {
        self.limit
    }
}

/// The range of one component over some rays.
pub(super) struct Extent {
    pub(super) least: f32,
    pub(super) greatest: f32,
}

/// The range of one component, lane by lane.
#[derive(Clone, Copy)]
pub(super) struct Extents<E: Lanes> {
    least: E::F32,
    greatest: E::F32,
}

impl<E: Lanes> Extents<E> {
    /// Returns empty ranges.
    #[inline(always)]
    pub(super) fn none(e: E) -> Self {
        Self { least: e.f32(f32::INFINITY), greatest: e.f32(f32::NEG_INFINITY) }
    }

    /// Extends the ranges by the active lanes of `v`; NaNs are ignored.
    #[inline(always)]
    pub(super) fn add(&mut self, e: E, v: E::F32, active: E::Mask) {
        self.least = e.f32_binary(op::Min, self.least, e.f32_select(active, v, self.least));
        self.greatest =
            e.f32_binary(op::Max, self.greatest, e.f32_select(active, v, self.greatest));
    }

    /// Reduces the ranges of all lanes to one.
    #[inline(always)]
    pub(super) fn extent(self, e: E) -> Extent {
        const { assert!(E::N == 8) };
        let (mut low, mut high) = ([0.0; 8], [0.0; 8]);
        e.f32_store(self.least, &mut low);
        e.f32_store(self.greatest, &mut high);
        Extent { least: fold(low, less), greatest: fold(high, more) }
    }
}

/// Computes the range of a row over the rays of an octant.
#[inline(always)]
pub(super) fn extent<E: Lanes>(e: E, rays: &Rays, octant: &Octant, row: usize) -> Extent {
    let mut extents = Extents::none(e);
    for (group, members) in octant.groups() {
        for from in (0..GROUP).step_by(E::N) {
            let active = members >> from & lanes_mask::<E>();
            if active != 0 {
                let active = e.mask_from_bits(active.into());
                extents.add(e, load(e, rays.row(group, row), from), active);
            }
        }
    }
    extents.extent(e)
}

#[inline(always)]
fn vector<E: Lanes>(e: E, rays: &Rays, octant: &Octant, row: usize) -> [Extent; 3] {
    [
        extent(e, rays, octant, row),
        extent(e, rays, octant, row + 1),
        extent(e, rays, octant, row + 2),
    ]
}

#[inline(always)]
fn less(a: f32, b: f32) -> f32 {
    if b < a { b } else { a }
}

#[inline(always)]
fn more(a: f32, b: f32) -> f32 {
    if a < b { b } else { a }
}

#[inline(always)]
fn fold([a, b, c, d, e, f, g, h]: [f32; 8], of: impl Fn(f32, f32) -> f32) -> f32 {
    of(of(of(a, b), of(c, d)), of(of(e, f), of(g, h)))
}

impl Beam {
    /// Computes the beam of the rays of an octant; none if they diverge by more than `most`, or if
    /// one of them begins behind its origin.
    #[inline(always)]
    pub(super) fn of<E: Lanes>(
        e: E,
        rays: &Rays,
        octant: &Octant,
        most: f32,
        root: &Aabb,
        padding: Padding,
    ) -> Option<Self> {
        let t_min = extent(e, rays, octant, row::T_MIN).least;
        let origins = vector(e, rays, octant, row::ORIGIN);
        let inverses = vector(e, rays, octant, row::INVERSE);
        let (mut largest, mut spread) = (0.0f32, 0.0f32);
        for Extent { least, greatest } in &inverses {
            let (a, b) = (1.0 / least, 1.0 / greatest);
            largest = largest.max(a.abs()).max(b.abs());
            spread = spread.max((a - b).abs());
        }
        // A negative `t_min` would need the bounds of near and far planes exchanged.
        if t_min < 0.0 || spread > most * largest {
            return None;
        }
        let limit = extent(e, rays, octant, row::LIMIT).greatest;
        Some(Self::new(&origins, &inverses, [t_min, limit], pad(&origins, root, padding)))
    }

    /// Computes the beam of one ray, up to a limit; none if products may overflow.
    #[inline(always)]
    pub(super) fn of_one(ray: &Ray, limit: f32, root: &Aabb, padding: Padding) -> Option<Self> {
        let inverse = finite_inverse(ray.direction);
        let span = root.min.abs().max(root.max.abs()).max_element();
        let is_tame = (inverse.abs() * (ray.origin.abs() + span)).cmplt(Vec3::splat(HUGE));
        let point = |v: Vec3| v.to_array().map(|v| Extent { least: v, greatest: v });
        let (origins, inverses) = (point(ray.origin), point(inverse));
        let pad = pad(&origins, root, padding);
        is_tame.all().then(|| Self::new(&origins, &inverses, [ray.t_min, limit], pad))
    }

    #[inline(always)]
    fn new(
        origins: &[Extent; 3],
        inverses: &[Extent; 3],
        [t_min, limit]: [f32; 2],
        pad: f32,
    ) -> Self {
        let mut beam = Self { side: [0; 3], near: [[0.0; 2]; 3], far: [[0.0; 2]; 3], t_min, limit };
        for axis in 0..3 {
            let (o, i) = (&origins[axis], &inverses[axis]);
            let is_up = i.least > 0.0;
            beam.side[axis] = usize::from(!is_up);
            // The lower bound of the near distance is that of the closest origin and the fastest
            // direction; the upper bound of the far distance that of the opposite ones.
            let (first, fast) = if is_up { (o.greatest, i.least) } else { (o.least, i.greatest) };
            let (last, slow) = if is_up { (o.least, i.greatest) } else { (o.greatest, i.least) };
            beam.near[axis] = [fast, -(first * fast) - fast.abs() * pad];
            beam.far[axis] = [slow, -(last * slow) + slow.abs() * pad];
        }
        beam
    }
}

/// Returns the padding of boxes for rays with these origins.
#[inline(always)]
pub(super) fn pad(origins: &[Extent; 3], root: &Aabb, padding: Padding) -> f32 {
    let (low, high) = (root.min.to_array(), root.max.to_array());
    let (mut reach, mut largest) = (0.0f32, 0.0f32);
    for (axis, o) in origins.iter().enumerate() {
        reach = reach.max((o.greatest - low[axis]).abs()).max((high[axis] - o.least).abs());
        reach = reach.max((o.least - low[axis]).abs()).max((high[axis] - o.greatest).abs());
        largest = largest.max(o.least.abs()).max(o.greatest.abs());
    }
    let pad = (padding.slack + 4.0 * ULP) * reach + (padding.origin + 8.0 * ULP) * largest;
    pad.max(f32::MIN_POSITIVE)
}
