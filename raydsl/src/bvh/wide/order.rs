//! Ray reordering: the rays of a query, sorted by direction, in portions.

use core::ops::Range;

use super::rays::{GROUP, Rays, lanes_mask, lanes_of, load, place, row};
use crate::bvh::packet_slabs::{abs, add, max, min, mul};
use crate::machine::{Lanes, op};

/// Quantisation steps of directions along each axis.
const STEPS: u32 = 8;
const KEYS: usize = (STEPS * STEPS * STEPS) as usize;

/// Maximum number of groups sorted at once, so that they stay in the L2 cache.
const MOST: usize = 256;
const _: () = assert!(MOST * GROUP <= 1 << 16, "a ray's index has 16 bits below its key");

/// Rays per portion, whose data fits into the L2 cache.
const SOME: usize = 512;

/// The order of rays.
#[derive(Clone, Copy, Debug)]
pub(super) enum Sequence {
    AsTheyCome,
    /// Along a Morton curve through the cube of directions, so that rays of an octant are
    /// consecutive.
    ByDirection,
}

/// The rays of a query in a sequence, in portions. Its memory is reused by the next query.
#[derive(Debug, Default)]
pub(super) struct Portions {
    order: Order,
    some: Rays,
}

impl Portions {
    /// Calls `find` with the active rays in portions, and copies the results back: the hits with
    /// `CLOSEST`, else whether there is any.
    #[inline(always)]
    pub(super) fn each<const CLOSEST: bool, R: Lanes>(
        &mut self,
        r: R,
        rays: &mut Rays,
        sequence: Sequence,
        mut find: impl FnMut(&mut Rays),
    ) {
        let Self { order, some } = self;
        let count = rays.masks.len();
        for first in (0..count).step_by(MOST) {
            let groups = first..(first + MOST).min(count);
            let places = match sequence {
                Sequence::AsTheyCome => order.as_they_come(rays, groups),
                Sequence::ByDirection => order.by_direction(r, rays, groups),
            };
            for places in places.chunks(SOME) {
                some.gather::<CLOSEST>(rays, places);
                find(some);
                some.give_back::<CLOSEST>(rays, places);
            }
        }
    }

    /// Returns whether any rays have been sorted.
    #[cfg(test)]
    pub(super) fn has_sorted(&self) -> bool {
        !self.order.keys.is_empty()
    }
}

/// Scratch memory of sorting.
#[derive(Debug, Default)]
pub(super) struct Order {
    /// For each ray, its key above its index.
    keys: Vec<u32>,
    /// The sorted places of the rays.
    places: Vec<u32>,
}

impl Order {
    /// Returns the places of the active rays of some groups.
    pub(super) fn as_they_come(&mut self, rays: &Rays, groups: Range<usize>) -> &[u32] {
        self.places.clear();
        for group in groups {
            let lanes = lanes_of(rays.masks[group].active);
            self.places.extend(lanes.map(|lane| place(GROUP * group + lane)));
        }
        &self.places
    }

    /// Returns the places of the active rays of some groups, sorted by direction.
    #[inline(always)]
    pub(super) fn by_direction<R: Lanes>(
        &mut self,
        r: R,
        rays: &Rays,
        groups: Range<usize>,
    ) -> &[u32] {
        self.keys.clear();
        let mut begins = [0u32; KEYS];
        // Compute keys and count the rays of each.
        let first = groups.start;
        for group in groups {
            let active = rays.masks[group].active;
            let mut keys = [0; GROUP];
            for from in (0..GROUP).step_by(R::N) {
                if active >> from & lanes_mask::<R>() != 0 {
                    r.u32_store(keys_of(r, rays, group, from), &mut keys[from..]);
                }
            }
            for lane in lanes_of(active) {
                let key = keys[lane] % KEYS as u32;
                begins[key as usize] += 1;
                self.keys.push(key << 16 | (GROUP * (group - first) + lane) as u32);
            }
        }
        // Turn counts into offsets.
        let mut begin = 0;
        for count in &mut begins {
            begin += core::mem::replace(count, begin);
        }
        // Place the rays in the order of their keys.
        self.places.resize(self.keys.len(), 0);
        for &key in &self.keys {
            let next = &mut begins[(key >> 16) as usize % KEYS];
            self.places[*next as usize] = place(GROUP * first + (key & 0xffff) as usize);
            *next += 1;
        }
        &self.places
    }
}

/// Computes Morton codes of directions, with three bits of each component.
#[inline(always)]
fn keys_of<R: Lanes>(r: R, rays: &Rays, group: usize, from: usize) -> R::U32 {
    let x = load(r, rays.row(group, row::DIRECTION), from);
    let y = load(r, rays.row(group, row::DIRECTION + 1), from);
    let z = load(r, rays.row(group, row::DIRECTION + 2), from);
    let largest = max(r, max(r, abs(r, x), abs(r, y)), abs(r, z));
    let half = r.f32(0.5 * STEPS as f32);
    let scale = r.f32_binary(op::Div, half, largest);
    let mut key = r.u32(0);
    for (axis, d) in [x, y, z].into_iter().enumerate() {
        let steps = min(r, add(r, mul(r, d, scale), half), r.f32(STEPS as f32 - 1.0));
        let steps = r.f32_to_u32(steps);
        for bit in 0..3u32 {
            let one = r.u32_binary(op::And, steps, r.u32(1 << bit));
            let up = r.u32_binary(op::Shl, one, r.u32(2 * bit + axis as u32));
            key = r.u32_binary(op::Or, key, up);
        }
    }
    key
}
