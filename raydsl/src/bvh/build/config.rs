//! The builder's settings.

use super::error::BuildError;

/// The most bins an axis can have.
pub(super) const MAX_BINS: usize = 32;

/// How a tree is built: how long that may take against how fast rays then are.
///
/// Hits are the same with each. Both are deterministic: the same boxes make the same tree, whatever
/// the number of threads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum BuildQuality {
    /// Primitives are sorted along a curve through space, and split where the bits of their places
    /// on it differ: Lauterbach et al., *Fast BVH construction on GPUs* (2009). For scenes that
    /// change from frame to frame.
    ///
    /// Of a million primitives, with two threads, it took less than half the time of
    /// [`BuildQuality::Balanced`]. The expected cost of a ray was 6 % higher for small spheres all
    /// over a cube, and 21 % for the triangles of a hilly surface. It is several times as high if
    /// one primitive encloses all others: only centroids count, and the large box goes deep into
    /// the tree.
    Fast,
    /// Each node is split at the best of up to 32 planes an axis by the surface area heuristic:
    /// Wald, *On fast construction of SAH-based bounding volume hierarchies* (2007). The default.
    #[default]
    Balanced,
}

/// Settings of the builder; the defaults suit triangles and spheres.
///
/// Only the ratio of the two costs matters. It decides when a small node stays a leaf: the
/// estimated cost of a leaf of `n` primitives is `intersection_cost * n`, that of splitting it
/// `traversal_cost` plus the cost of the children weighted by their share of its surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BuildConfig {
    /// How the tree is built; default [`BuildQuality::Balanced`].
    pub quality: BuildQuality,
    /// The most primitives a leaf may hold, `1..=256`; default 4.
    ///
    /// An upper limit only: the costs decide what becomes a leaf. Against 4, on three scenes of
    /// 66 to 331 thousand triangles, the expected cost of a ray is 0 to 1 % lower with 8 or 16 and
    /// the tree 1 to 6 % smaller, while 2 costs 1 to 2 % and 1 costs 10 to 13 % and twice the
    /// nodes. Primitives that nothing tells apart fill leaves up to the limit, which is why it
    /// should not be large.
    pub max_leaf_size: u32,
    /// The bins along each axis of a large node, `2..=32`; default 32.
    ///
    /// Small nodes use fewer, `4 + n / 20`, since they have few primitives to tell apart; that is
    /// why 32 take no longer than 16. The expected cost of a ray was 1 to 9 % lower.
    /// [`BuildQuality::Fast`] has no bins.
    pub bins: u32,
    /// Cost of visiting an inner node, `0.0..=1e6`; default 1.
    pub traversal_cost: f32,
    /// Cost of testing one primitive, `1e-6..=1e6`; default 1.
    pub intersection_cost: f32,
}

impl Default for BuildConfig {
    fn default() -> Self {
        Self {
            quality: BuildQuality::Balanced,
            max_leaf_size: 4,
            bins: 32,
            traversal_cost: 1.0,
            intersection_cost: 1.0,
        }
    }
}

impl BuildConfig {
    /// Checks every field against its range.
    pub(super) fn check(&self) -> Result<(), BuildError> {
        let require = |ok: bool, field, value: f64, range| {
            if ok { Ok(()) } else { Err(BuildError::InvalidConfig { field, value, range }) }
        };
        let Self { quality: _, max_leaf_size, bins, traversal_cost, intersection_cost } = *self;
        let leaf_ok = (1..=256).contains(&max_leaf_size);
        require(leaf_ok, "max_leaf_size", max_leaf_size.into(), "1..=256")?;
        let bins_ok = (2..=MAX_BINS as u32).contains(&bins);
        require(bins_ok, "bins", bins.into(), "2..=32")?;
        // A range contains no NaN.
        let traversal_ok = (0.0..=1e6).contains(&traversal_cost);
        require(traversal_ok, "traversal_cost", traversal_cost.into(), "0.0..=1e6")?;
        let intersection_ok = (1e-6..=1e6).contains(&intersection_cost);
        require(intersection_ok, "intersection_cost", intersection_cost.into(), "1e-6..=1e6")
    }
}
