//! Space divided by planes: a k-d tree whose leaves are the parts of ranks.

use glam::Vec3;

/// Why space cannot be divided into so many parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DivideError {
    /// There are fewer cells or points than parts.
    #[error("{parts} parts of {items} {what}: choose fewer --parts or --ranks")]
    TooMany {
        /// The parts.
        parts: u32,
        /// Cells along an axis, or points.
        items: u64,
        /// `cells` or `points`.
        what: &'static str,
    },
}

/// A box between planes, infinite where there is none: points with `low <= p < high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Region {
    pub(crate) low: Vec3,
    pub(crate) high: Vec3,
}

impl Region {
    /// All of space.
    pub(crate) const ALL: Self = Self { low: Vec3::NEG_INFINITY, high: Vec3::INFINITY };

    /// Returns whether a point is in it. Of the regions of a division, each point is in one.
    pub(crate) fn contains(&self, p: Vec3) -> bool {
        self.low.cmple(p).all() && p.cmplt(self.high).all()
    }

    /// Returns both sides of a plane.
    fn cut(self, axis: usize, at: f32) -> [Self; 2] {
        let (mut below, mut above) = (self, self);
        below.high[axis] = at;
        above.low[axis] = at;
        [below, above]
    }
}

/// A tree of planes. Its leaves are regions, numbered from 0.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Division {
    regions: Vec<Region>,
    root: Node,
}

#[derive(Clone, Debug, PartialEq)]
enum Node {
    Leaf(usize),
    Plane { axis: usize, sides: Box<[Node; 2]> },
}

/// What a division cuts: cells of a grid, or a sample of points.
pub(crate) trait Cut: Sized {
    /// Cuts it so that `first` of `parts` parts are below the plane; returns the axis, the plane's
    /// coordinate and both sides.
    fn cut(self, first: u32, parts: u32) -> Result<(usize, f32, [Self; 2]), DivideError>;
}

impl Division {
    /// Divides space into `parts` regions, halves of halves.
    pub(crate) fn new(whole: impl Cut, parts: u32) -> Result<Self, DivideError> {
        let mut regions = Vec::new();
        let root = divide(whole, parts, Region::ALL, &mut regions)?;
        Ok(Self { regions, root })
    }

    /// Returns the regions, in the order of their numbers.
    pub(crate) fn regions(&self) -> &[Region] {
        &self.regions
    }

    /// Returns for each region its place in the order in which rays of this direction pass regions.
    /// It depends on the signs alone: of two sides of a plane, a ray that crosses it is first in the
    /// one that its direction comes from.
    pub(crate) fn visibility(&self, direction: Vec3) -> Vec<u32> {
        let mut places = vec![0; self.regions.len()];
        let mut next = 0;
        visit(&self.root, direction, &mut |leaf| {
            places[leaf] = next;
            next += 1;
        });
        places
    }
}

fn divide(
    items: impl Cut,
    parts: u32,
    region: Region,
    regions: &mut Vec<Region>,
) -> Result<Node, DivideError> {
    if parts <= 1 {
        regions.push(region);
        return Ok(Node::Leaf(regions.len() - 1));
    }
    let first = parts / 2;
    let (axis, at, [below, above]) = items.cut(first, parts)?;
    let [low, high] = region.cut(axis, at);
    let below = divide(below, first, low, regions)?;
    let above = divide(above, parts - first, high, regions)?;
    Ok(Node::Plane { axis, sides: Box::new([below, above]) })
}

fn visit(node: &Node, direction: Vec3, leaf: &mut impl FnMut(usize)) {
    match node {
        Node::Leaf(number) => leaf(*number),
        Node::Plane { axis, sides } => {
            let [below, above] = &**sides;
            let is_rising = direction[*axis] > 0.0;
            let (first, then) = if is_rising { (below, above) } else { (above, below) };
            visit(first, direction, leaf);
            visit(then, direction, leaf);
        }
    }
}

#[cfg(test)]
mod tests {
    use raydsl::prelude::*;

    use super::*;

    /// The unit cube, cut along its longest axis.
    struct Cube(Vec3, Vec3);

    impl Cut for Cube {
        fn cut(self, first: u32, parts: u32) -> Result<(usize, f32, [Self; 2]), DivideError> {
            let Self(low, high) = self;
            let axis = (high - low).max_position();
            let at = low[axis] + (high[axis] - low[axis]) * first as f32 / parts as f32;
            let (mut top, mut bottom) = (high, low);
            (top[axis], bottom[axis]) = (at, at);
            Ok((axis, at, [Self(low, top), Self(bottom, high)]))
        }
    }

    #[test]
    fn each_point_is_in_one_region() {
        let mut rng = Rng::new(UVec2::ZERO, 1, 2);
        for parts in [1, 2, 3, 5, 8, 13] {
            let division = Division::new(Cube(Vec3::ZERO, Vec3::ONE), parts).expect("a cube");
            assert_eq!(division.regions().len(), parts as usize);
            let planes: Vec<f32> = division
                .regions()
                .iter()
                .flat_map(|region| region.low.to_array())
                .filter(|c| c.is_finite())
                .collect();
            for i in 0..500 {
                let mut p = rng.next_3d() * 1.2 - 0.1;
                // Some of them are on planes.
                if let Some(plane) = planes.get(i % (planes.len() + 1)) {
                    p[i % 3] = *plane;
                }
                let count = division.regions().iter().filter(|r| r.contains(p)).count();
                assert_eq!(count, 1, "{p} in {parts} parts");
            }
        }
    }

    /// The order by signs is that of the places where rays are.
    #[test]
    fn rays_pass_regions_in_the_order_of_visibility() {
        let mut rng = Rng::new(UVec2::ZERO, 5, 6);
        for parts in [2, 3, 7, 16] {
            let division = Division::new(Cube(Vec3::ZERO, Vec3::ONE), parts).expect("a cube");
            for _ in 0..200 {
                let origin = rng.next_3d() * 3.0 - 1.0;
                let direction = rng.next_3d() - rng.next_3d();
                let places = division.visibility(direction);
                let mut sorted = places.clone();
                sorted.sort_unstable();
                assert!(sorted.into_iter().eq(0..parts));
                let mut last = 0;
                for step in 0..1000 {
                    let p = origin + direction * (step as f32 * 0.01);
                    let at = division.regions().iter().position(|r| r.contains(p));
                    let place = places[at.expect("each point is in a region")];
                    assert!(place >= last, "{origin} {direction} in {parts} parts");
                    last = place;
                }
            }
        }
    }
}
