//! Building the tree of lights.

use core::cmp::Ordering;
use core::f32::consts::{FRAC_PI_2, PI};

use glam::Vec3;

use super::cone::{Cone, angle_of, sin_cos};
use super::{LEAF, LEAST_EMITTED, LightNode};
use crate::light::LightExtent;

/// Levels below the root: as many as a trail has bits. 2^22 lights need 22.
const MOST_LEVELS: u32 = 31;

/// Trail of a light that the tree does not have.
pub(in crate::light) const NOT_IN_TREE: u32 = 1 << MOST_LEVELS;

/// Bins along an axis.
const BINS: usize = 12;

/// What part of the longest edge widens each edge of a box, so that lights on a line, whose box has no
/// area, are compared by its length.
const LEAST_EDGE: f32 = 1e-3;

/// Least square of the distance to several lights, in terms of that of the radius of the sphere around
/// them. The mean of `1 / d²` in the middle of a ball is three times that at its surface, and a ball
/// of the volume of a cube has half the squared radius of the sphere around that.
const AMONG_LIGHTS: f32 = 1.0 / 6.0;

/// A tree over some of the lights of a list.
#[derive(Debug, Default)]
pub(in crate::light) struct LightTree {
    /// The nodes, the root first; nothing without lights.
    pub(in crate::light) nodes: Vec<LightNode>,
    /// The way from the root to each light: a bit for each level, from the lowest on, 1 for the second
    /// child.
    pub(in crate::light) trails: Vec<u32>,
}

/// A light, or several, where the tree is built.
#[derive(Clone, Copy, Debug)]
pub(in crate::light) struct Lit {
    min: Vec3,
    max: Vec3,
    normals: Cone,
    /// Greatest angle to a normal under which light leaves, at most a right one.
    emitted: f32,
    /// Radiant intensity straight ahead.
    power: f64,
    /// Mean square of the radii of spheres around the lights, by power.
    near2: f64,
    /// The number of the light.
    light: u32,
}

impl Lit {
    /// Returns the light with this number, extent and power; `None` if the extent is not finite.
    pub(in crate::light) fn new(light: u32, extent: LightExtent, power: f32) -> Option<Self> {
        let LightExtent { min, max, axis, cos_normals, cos_emitted } = extent;
        let are_finite = min.is_finite() && max.is_finite() && axis.is_finite();
        if !(are_finite && cos_normals.is_finite() && cos_emitted.is_finite()) {
            return None;
        }
        let emitted = angle_of(cos_emitted);
        // What shines to the back as well is as good as wider normals.
        let angle = angle_of(cos_normals) + (emitted - FRAC_PI_2).max(0.0);
        let emitted = emitted.min(FRAC_PI_2);
        let normals = match axis.try_normalize() {
            Some(axis) if angle < PI - 1e-3 => Cone { axis, angle },
            _ => Cone::ALL,
        };
        let power = f64::from(power) / f64::from(normals.measure(emitted).max(1e-6));
        let lit = Self {
            min: min.min(max),
            max: min.max(max),
            normals,
            emitted,
            power,
            near2: 0.0,
            light,
        };
        Some(Self { near2: f64::from(lit.radius()).powi(2), ..lit })
    }

    fn union(self, other: Self) -> Self {
        let power = self.power + other.power;
        let share = if power > 0.0 { self.power / power } else { 0.5 };
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
            normals: self.normals.union(other.normals),
            emitted: self.emitted.max(other.emitted),
            power,
            near2: self.near2 * share + other.near2 * (1.0 - share),
            light: self.light.min(other.light),
        }
    }

    /// Halves are added, so that sums do not overflow.
    fn center(&self) -> Vec3 {
        self.min * 0.5 + self.max * 0.5
    }

    /// Returns how much light leaves, in how many directions, from how large a box: the surface area
    /// orientation heuristic. Lengths are in terms of `unit`.
    fn cost(&self, unit: f32) -> f64 {
        let size = (self.max * 0.5 - self.min * 0.5) * unit + Vec3::splat(LEAST_EDGE);
        let area = size.x * size.y + size.y * size.z + size.z * size.x;
        self.power * f64::from(self.normals.measure(self.emitted) * area)
    }

    /// Returns the radius of a sphere around the box.
    fn radius(&self) -> f32 {
        let center = self.center();
        let reach = (self.max - center).max(center - self.min);
        // Of the centre, and of what a kernel computes with it.
        let rounding = center.abs().max(reach).max_element() * 4e-7;
        reach.length() + rounding
    }

    fn node(&self, child: u32) -> LightNode {
        let radius = self.radius();
        let radius2 = (radius * radius).min(f32::MAX);
        let cone = self.normals;
        let (sin, cos) = if cone.angle < PI { sin_cos(cone.angle) } else { (0.0, -1.0) };
        let (_, cos_emitted) = sin_cos(self.emitted);
        LightNode {
            center: self.center(),
            radius2,
            near2: (radius2 * AMONG_LIGHTS).max(self.near2 as f32).min(f32::MAX),
            axis: cone.axis,
            cos_normals: cos,
            sin_normals: sin,
            cos_emitted: cos_emitted - LEAST_EMITTED,
            // Two of them add up to more than 0.
            power: (self.power as f32).max(f32::MIN_POSITIVE),
            child,
        }
    }
}

impl LightTree {
    /// Builds a tree over `lights`, which have powers, of a list of `count`.
    pub(in crate::light) fn new(mut lights: Vec<Lit>, count: usize) -> Self {
        let mut tree = Self { nodes: Vec::new(), trails: vec![NOT_IN_TREE; count] };
        if lights.is_empty() {
            return tree;
        }
        let sum: f64 = lights.iter().map(|l| l.power).sum();
        lights.iter_mut().for_each(|l| l.power /= sum);
        tree.nodes.reserve_exact(2 * lights.len() - 1);
        tree.nodes.push(LightNode::default());
        tree.subtree(&mut lights, 0, 0, 0);
        tree
    }

    /// Builds the node `at`, to which `trail` leads in `level` steps, and what is below it.
    fn subtree(&mut self, lights: &mut [Lit], at: usize, level: u32, trail: u32) -> Lit {
        if let [light] = *lights {
            self.trails[light.light as usize] = trail;
            self.nodes[at] = light.node(light.light | LEAF);
            return light;
        }
        let middle = split(lights, MOST_LEVELS - level - 1);
        let (one, two) = lights.split_at_mut(middle);
        let first = self.nodes.len();
        self.nodes.extend([LightNode::default(); 2]);
        let one = self.subtree(one, first, level + 1, trail);
        let two = self.subtree(two, first + 1, level + 1, trail | 1 << level);
        let both = one.union(two);
        self.nodes[at] = both.node(first as u32);
        both
    }
}

/// Box around centres.
fn span(lights: &[Lit]) -> (Vec3, Vec3) {
    let first = lights[0].center();
    lights.iter().fold((first, first), |(lo, hi), l| (lo.min(l.center()), hi.max(l.center())))
}

/// Divides lights in two and returns the number of the first ones. Each side fits a tree with
/// `levels` levels.
fn split(lights: &mut [Lit], levels: u32) -> usize {
    let (lo, hi) = span(lights);
    let half = hi * 0.5 - lo * 0.5;
    let axis = half.max_position();
    if lights.len() > 2
        && let Some(plane) = plane(lights, lo, half)
    {
        let middle = partition(lights, |l| plane.bin_of(l) < plane.bin);
        let most = middle.max(lights.len() - middle);
        if middle > 0 && middle < lights.len() && most as u64 <= 1 << levels {
            return middle;
        }
    }
    let middle = lights.len() / 2;
    let order = |a: &Lit, b: &Lit| -> Ordering {
        let (x, y) = (a.center()[axis], b.center()[axis]);
        x.total_cmp(&y).then(a.light.cmp(&b.light))
    };
    lights.select_nth_unstable_by(middle, order);
    middle
}

/// Moves the lights with a property to the front, and returns their number.
fn partition(lights: &mut [Lit], is_first: impl Fn(&Lit) -> bool) -> usize {
    let mut middle = 0;
    for i in 0..lights.len() {
        if is_first(&lights[i]) {
            lights.swap(i, middle);
            middle += 1;
        }
    }
    middle
}

/// A plane between bins.
#[derive(Clone, Copy, Debug)]
struct Plane {
    axis: usize,
    /// Bins below this one are on the first side.
    bin: usize,
    from: f32,
    scale: f32,
}

impl Plane {
    fn bin_of(&self, light: &Lit) -> usize {
        // Half of the coordinates, so that differences do not overflow.
        let along = light.center()[self.axis] * 0.5 - self.from;
        ((along * self.scale) as usize).min(BINS - 1)
    }
}

/// Returns the best plane between bins; `None` if all centres coincide.
fn plane(lights: &[Lit], lo: Vec3, half: Vec3) -> Option<Plane> {
    let bounds = lights.iter().fold((lo, lo), |(a, b), l| (a.min(l.min), b.max(l.max)));
    let size = bounds.1 * 0.5 - bounds.0 * 0.5;
    let longest = size.max_element();
    let unit = 1.0 / longest;
    let mut best: Option<(f64, Plane)> = None;
    for axis in 0..3 {
        let scale = BINS as f32 / half[axis];
        if !(half[axis] > 0.0 && scale.is_finite() && unit.is_finite()) {
            continue;
        }
        let plane = Plane { axis, bin: 0, from: lo[axis] * 0.5, scale };
        let mut bins: [Option<Lit>; BINS] = [None; BINS];
        for light in lights {
            let bin = &mut bins[plane.bin_of(light)];
            *bin = join(*bin, Some(*light));
        }
        // Long thin boxes are divided across.
        let regular = f64::from(longest / size[axis]);
        let mut above: [f64; BINS] = [0.0; BINS];
        let mut all = None;
        for i in (1..BINS).rev() {
            all = join(all, bins[i]);
            above[i] = all.map_or(0.0, |l| l.cost(unit));
        }
        let mut below = None;
        for bin in 1..BINS {
            let is_new = bins[bin - 1].is_some();
            below = join(below, bins[bin - 1]);
            if !is_new || above[bin] == 0.0 {
                continue;
            }
            let cost = regular * (below.map_or(0.0, |l| l.cost(unit)) + above[bin]);
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, Plane { bin, ..plane }));
            }
        }
    }
    best.map(|(_, plane)| plane)
}

fn join(one: Option<Lit>, other: Option<Lit>) -> Option<Lit> {
    match (one, other) {
        (Some(a), Some(b)) => Some(a.union(b)),
        (a, b) => a.or(b),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::elementary::atan2;
    use crate::sampling::Rng;

    fn random_lights(count: u32, extent: impl Fn(&mut Rng, u32) -> LightExtent) -> Vec<Lit> {
        let mut random = Rng::new(glam::UVec2::ZERO, 0, 9);
        let lit = |i| Lit::new(i, extent(&mut random, i), 1.0).expect("finite");
        (0..count).map(lit).collect()
    }

    /// Follows each trail, and checks what contains what.
    fn assert_is_tree(tree: &LightTree, lights: &[Lit]) {
        assert_eq!(tree.nodes.len(), (2 * lights.len()).saturating_sub(1));
        for light in lights {
            let (mut trail, mut at) = (tree.trails[light.light as usize], 0);
            assert!(trail < NOT_IN_TREE);
            loop {
                let node = tree.nodes[at];
                let reach = (light.max - node.center).max(node.center - light.min);
                let is_exact = node.radius2.is_normal() && node.radius2 < f32::MAX;
                assert!(reach.length_squared() <= node.radius2 || !is_exact, "{node:?} {light:?}");
                let angle = atan2(node.sin_normals, node.cos_normals);
                let between = node.axis.angle_between(light.normals.axis);
                let needed = between + light.normals.angle;
                assert!(needed.min(PI) <= angle + 5e-4 || node.cos_normals == -1.0);
                assert!(node.power > 0.0 && node.power <= 1.000_01);
                if node.child >= LEAF {
                    assert_eq!(node.child, light.light | LEAF);
                    break;
                }
                at = (node.child + (trail & 1)) as usize;
                trail >>= 1;
            }
        }
    }

    fn point(position: Vec3) -> LightExtent {
        let axis = Vec3::Z;
        LightExtent { min: position, max: position, axis, cos_normals: -1.0, cos_emitted: 0.0 }
    }

    #[test]
    fn every_light_is_at_the_end_of_its_trail() {
        for count in [0, 1, 2, 3, 100, 5000] {
            let lights = random_lights(count, |random, _| {
                let min = random.next_3d() * 10.0;
                let axis = random.next_3d() - 0.5;
                let cos_normals = 1.0 - 2.0 * random.next_f32();
                let max = min + random.next_3d();
                LightExtent { min, max, axis, cos_normals, cos_emitted: 0.5 - random.next_f32() }
            });
            assert_is_tree(&LightTree::new(lights.clone(), count as usize), &lights);
        }
    }

    /// All in one place, on a line, at distances of many orders of magnitude, and close to the largest
    /// numbers.
    #[test]
    fn no_arrangement_is_too_deep() {
        let powers = |_: &mut Rng, i: u32| point(Vec3::X * 1.01f32.powi(8 * i as i32 - 8000));
        let huge = |random: &mut Rng, _: u32| point((random.next_3d() * 2.0 - 1.0) * 3e38);
        for lights in [
            random_lights(3000, |_, _| point(Vec3::ONE)),
            random_lights(3000, |_, i| point(Vec3::Y * i as f32)),
            random_lights(2000, powers),
            random_lights(1000, huge),
            random_lights(1000, |_, i| point(Vec3::Z * f32::from_bits(i))),
        ] {
            assert_is_tree(&LightTree::new(lights.clone(), lights.len()), &lights);
        }
    }

    #[test]
    fn extents_without_numbers_are_refused() {
        let good = point(Vec3::ZERO);
        assert!(Lit::new(0, good, 1.0).is_some());
        for bad in [
            LightExtent { min: Vec3::splat(f32::NEG_INFINITY), ..good },
            LightExtent { max: Vec3::new(0.0, f32::NAN, 0.0), ..good },
            LightExtent { axis: Vec3::NAN, ..good },
            LightExtent { cos_normals: f32::NAN, ..good },
            LightExtent { cos_emitted: f32::NAN, ..good },
        ] {
            assert!(Lit::new(0, bad, 1.0).is_none());
        }
        // An axis of no length says nothing.
        let any = Lit::new(0, LightExtent { axis: Vec3::ZERO, cos_normals: 1.0, ..good }, 1.0);
        assert_eq!(any.map(|l| l.normals), Some(Cone::ALL));
    }
}
