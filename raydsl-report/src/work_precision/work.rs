//! Work of computations, in units independent of the machine.

use core::ops::Add;

use raydsl::bvh::Cost;

/// The work of a computation, in units independent of the machine. Units that were not counted are
/// `None`.
///
/// ```
/// use raydsl_report::work_precision::Work;
///
/// let ray = Work { rays: Some(1), nodes: Some(12), primitives: Some(3), ..Work::default() };
/// let look_up = Work { texture_fetches: Some(2), ..Work::default() };
/// let both = ray + ray + look_up;
/// assert_eq!((both.rays, both.nodes, both.texture_fetches), (Some(2), Some(24), Some(2)));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Work {
    /// Rays that were traced.
    pub rays: Option<u64>,
    /// Nodes of trees whose box was tested.
    pub nodes: Option<u64>,
    /// Primitives that were intersected.
    pub primitives: Option<u64>,
    /// Calls of a texture's filter, regardless of the number of texels read.
    pub texture_fetches: Option<u64>,
}

impl Work {
    /// Counted work of 0 in each unit: for kernels that trace no rays and look nothing up.
    pub const NOTHING: Self =
        Self { rays: Some(0), nodes: Some(0), primitives: Some(0), texture_fetches: Some(0) };

    /// Returns whether nothing was counted.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// Converts the cost of one ray in its tree.
impl From<Cost> for Work {
    fn from(cost: Cost) -> Self {
        let (nodes, primitives) = (u64::from(cost.nodes), u64::from(cost.primitives));
        let (nodes, primitives) = (Some(nodes), Some(primitives));
        Self { rays: Some(1), nodes, primitives, texture_fetches: None }
    }
}

/// Adds unit by unit; a unit counted in only one of them keeps that count.
impl Add for Work {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            rays: sum(self.rays, other.rays),
            nodes: sum(self.nodes, other.nodes),
            primitives: sum(self.primitives, other.primitives),
            texture_fetches: sum(self.texture_fetches, other.texture_fetches),
        }
    }
}

fn sum(a: Option<u64>, b: Option<u64>) -> Option<u64> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.saturating_add(b)),
        (one, other) => one.or(other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_counted_stays_unknown() {
        let ray = Work::from(Cost { nodes: 5, primitives: 2 });
        let all = ray + Work::default() + ray + Work { texture_fetches: Some(0), ..ray };
        let expected =
            Work { rays: Some(3), nodes: Some(15), primitives: Some(6), texture_fetches: Some(0) };
        assert_eq!(all, expected);
        assert_eq!((ray.texture_fetches, ray.is_empty()), (None, false));
        assert!((Work::default() + Work::default()).is_empty());
        assert!(!Work::NOTHING.is_empty() && ray + Work::NOTHING != ray);
        let most = Work { rays: Some(u64::MAX), ..ray };
        assert_eq!((most + ray).rays, Some(u64::MAX));
    }
}
