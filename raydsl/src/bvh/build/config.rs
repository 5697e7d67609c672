//! Builder settings.

use super::error::BuildError;

/// Primitives per block of a wide tree.
pub(in crate::bvh) const BLOCK: usize = 8;

/// Cost of an empty slot in a block, where a primitive costs 1. With 1, blocks are fullest, and
/// rays a tenth slower in halls of large triangles; with 0, trees are a tenth larger.
const EMPTY_COST: f32 = 0.25;

/// Maximum number of bins per axis.
pub(super) const MAX_BINS: usize = 32;

/// Build quality: trades build time against traversal speed.
///
/// Hits are the same with each. All are deterministic: the same boxes make the same tree, whatever
/// the number of threads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum BuildQuality {
    /// Sorts primitives along a Morton curve and splits where the bits of their codes differ:
    /// Lauterbach et al., *Fast BVH construction on GPUs* (2009). For scenes that change from frame
    /// to frame.
    ///
    /// For a million primitives with two threads, it took less than half the time of
    /// [`BuildQuality::Balanced`]; for ten million, 0.64 of it. The expected cost of a ray was 6 %
    /// higher for small spheres all over a cube, and 21 % for the triangles of a hilly surface. It
    /// is several times as high if one primitive encloses all others: only centroids count, and the
    /// large box goes deep into the tree.
    Fast,
    /// Splits each node at the best of up to 32 planes per axis by the surface area heuristic:
    /// Wald, *On fast construction of SAH-based bounding volume hierarchies* (2007). The default.
    #[default]
    Balanced,
    /// As [`BuildQuality::Balanced`], but cuts primitives where that is cheaper: Stich, Friedrich
    /// and Dietrich, *Spatial splits in bounding volume hierarchies* (2009). For scenes that are
    /// built once and traced often, with primitives that are long, slanted or of very different
    /// sizes. A leaf then refers to part of a primitive, and a primitive may be in several leaves.
    ///
    /// On three architectural scenes of 66 to 331 thousand triangles, the expected cost of a ray
    /// was 5, 7 and 17 % lower than with [`BuildQuality::Balanced`], with 5 to 18 % more entries in
    /// leaves. Building took 5 to 18 times as long.
    Best,
}

impl BuildQuality {
    /// All qualities, fastest to build first.
    pub const ALL: [Self; 3] = [Self::Fast, Self::Balanced, Self::Best];

    /// Returns the name in tables: `fast`, `balanced`, `best`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Fast => "fast",
            Self::Balanced => "balanced",
            Self::Best => "best",
        }
    }
}

/// Traversal order of a wide tree for the rays of one query.
///
/// A query has the rays of a packet, of a gang, or of
/// [`RecordQuery::closest_hits`](crate::bvh::RecordQuery::closest_hits) and `any_hits`. Hits are the same
/// with each traversal. It has no effect on single rays of the host, binary trees, lists with such
/// a tree, instances, devices, and queries with a condition or for several hits.
///
/// [`Traversal::Auto`] was within 6 % of the best of the others for every kind of ray in three
/// architectural scenes, except bounces in one of them (9 %); a wrong choice is slower by factors.
/// Set another only if you know more about the rays than the library does, and have measured it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Traversal {
    /// Chooses by the kind of query, the number of rays, and their divergence; the default. Closest
    /// hits: rays form packets where twelve or more, or most of them, have directions in one octant
    /// that differ by no more than half of their length; others form streams. Any hits: rays are
    /// sorted if there are 512 or more and all are bounded; others form streams, and so do all rays to
    /// primitives that are not [short](crate::geometry::Primitive::IS_SHORT).
    #[default]
    Auto,
    /// Ray streams: up to 256 rays are interleaved, each with its own stack. For incoherent rays.
    Streams,
    /// Ray packets with interval culling: up to 64 consecutive rays with directions in one octant
    /// form a packet, however far they diverge, unless they begin behind their origin. In any-hit
    /// queries they leave it for a stream where 16 or fewer enter a box. For rays of one camera or
    /// one light.
    Packets,
    /// More than 16 rays, up to 4096 at once, are sorted by direction first. Any-hit queries
    /// continue as with [`Traversal::Packets`], closest-hit queries as with [`Traversal::Auto`].
    /// For many rays that begin near each other.
    ///
    /// In a list of trees, rays of closest-hit queries are sorted for all trees if it is set for
    /// one.
    Sorted,
}

impl Traversal {
    /// All traversals.
    pub const ALL: [Self; 4] = [Self::Auto, Self::Streams, Self::Packets, Self::Sorted];

    /// Returns the name in tables: `auto`, `streams`, `packets`, `sorted`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Streams => "streams",
            Self::Packets => "packets",
            Self::Sorted => "sorted",
        }
    }
}

impl From<BuildQuality> for BuildConfig {
    /// Returns the default settings with this quality.
    fn from(quality: BuildQuality) -> Self {
        Self { quality, ..Self::default() }
    }
}

/// Settings of the builder; the defaults suit triangles and spheres.
///
/// Only the ratio of the two costs matters. It decides when a small node stays a leaf: a leaf of
/// `n` primitives costs `intersection_cost * n`, an inner node `traversal_cost` plus the costs of
/// the children weighted by their share of its surface area. In a wide tree an empty slot of a
/// block costs a quarter of a primitive, and [`BuildQuality::Fast`] and [`BuildQuality::Balanced`]
/// never split eight primitives or fewer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BuildConfig {
    /// Build quality; default [`BuildQuality::Balanced`].
    pub quality: BuildQuality,
    /// Traversal of a wide tree, changed later by
    /// [`Bvh::set_traversal`](crate::bvh::Bvh::set_traversal); default [`Traversal::Auto`].
    pub traversal: Traversal,
    /// Minimum number of primitives for which [`Bvh::build_wide`](crate::bvh::Bvh::build_wide)
    /// makes a wide tree instead of a binary one. Default 64: in rooms of `12 k^2` triangles,
    /// incoherent rays in packets of 16 find the closest hit 0.5 times as fast in a wide tree of 12
    /// triangles as in a binary one, 0.9 times of 48, 1.2 times of 108 and 3 times of 7,000. Camera
    /// rays gain at none of these sizes.
    pub min_wide_size: u32,
    /// Maximum number of primitives per leaf, `1..=256`; default 4. In a wide tree it is always 8.
    ///
    /// An upper limit only: the costs decide whether a node becomes a leaf. Against 4, on three
    /// scenes of 66 to 331 thousand triangles, the expected cost of a ray is 0 to 1 % lower with 8
    /// or 16 and the tree 1 to 6 % smaller, while 2 costs 1 to 2 % and 1 costs 10 to 13 % and twice
    /// the nodes. Primitives with coincident centroids fill leaves up to the limit, so it should
    /// not be large.
    pub max_leaf_size: u32,
    /// Number of bins along each axis of a large node, `2..=32`; default 32.
    ///
    /// Small nodes use fewer, `4 + n / 20`, since they have few primitives to separate; thus 32
    /// take no longer than 16. The expected cost of a ray was 1 to 9 % lower.
    /// [`BuildQuality::Fast`] has no bins.
    pub bins: u32,
    /// Cost of traversing an inner node, `0.0..=1e6`; default 1.
    pub traversal_cost: f32,
    /// Cost of intersecting one primitive, `1e-6..=1e6`; default 1.
    pub intersection_cost: f32,
    /// Maximum growth of the index list by [`BuildQuality::Best`], relative to the number of
    /// primitives, `0.0..=4.0`; default 0.3: at most 30 % more entries than primitives. The other
    /// qualities have one entry for each.
    ///
    /// Each subtree gets its share by the number of its primitives and cannot pass on the unused
    /// rest. With 0 nothing is cut, and the tree is that of [`BuildQuality::Balanced`].
    pub max_duplication: f32,
    /// Minimum overlap of two children for which [`BuildQuality::Best`] looks for a spatial split,
    /// as a share of the surface area of the whole scene, `0.0..=1.0`; default 1e-5, as the paper
    /// recommends. A larger one builds faster, and cuts near the root alone.
    pub min_overlap: f32,
}

impl Default for BuildConfig {
    fn default() -> Self {
        Self {
            quality: BuildQuality::Balanced,
            traversal: Traversal::Auto,
            min_wide_size: 64,
            max_leaf_size: 4,
            bins: 32,
            traversal_cost: 1.0,
            intersection_cost: 1.0,
            max_duplication: 0.3,
            min_overlap: 1e-5,
        }
    }
}

/// Settings of one build.
#[derive(Clone, Copy, Debug)]
pub(in crate::bvh) struct Settings {
    pub(in crate::bvh) config: BuildConfig,
    /// Whether the leaves become blocks of a wide tree.
    pub(in crate::bvh) is_wide: bool,
}

impl core::ops::Deref for Settings {
    type Target = BuildConfig;

    fn deref(&self) -> &BuildConfig {
        &self.config
    }
}

impl Settings {
    /// Returns the maximum number of primitives per leaf.
    pub(super) fn leaf_size(&self) -> usize {
        if self.is_wide { BLOCK } else { self.max_leaf_size as usize }
    }

    /// Returns whether `count` primitives form a leaf regardless of the cost of a split.
    pub(super) fn is_block(&self, count: usize) -> bool {
        self.is_wide && count <= BLOCK
    }

    /// Returns the cost of testing `count` primitives, in units of one primitive. A partly filled
    /// block takes as long as a full one; but splitting for full blocks makes larger boxes.
    pub(super) fn test_cost(&self, count: usize) -> f32 {
        if !self.is_wide {
            return count as f32;
        }
        let empty = count.next_multiple_of(BLOCK) - count;
        count as f32 + EMPTY_COST * empty as f32
    }
}

impl BuildConfig {
    /// Validates every field against its range.
    pub(super) fn check(&self) -> Result<(), BuildError> {
        let require = |ok: bool, field, value: f64, range| {
            if ok { Ok(()) } else { Err(BuildError::InvalidConfig { field, value, range }) }
        };
        let Self { quality: _, max_leaf_size, bins, traversal_cost, intersection_cost, .. } = *self;
        let Self { max_duplication, min_overlap, .. } = *self;
        let leaf_ok = (1..=256).contains(&max_leaf_size);
        require(leaf_ok, "max_leaf_size", max_leaf_size.into(), "1..=256")?;
        let bins_ok = (2..=MAX_BINS as u32).contains(&bins);
        require(bins_ok, "bins", bins.into(), "2..=32")?;
        // A range contains no NaN.
        let traversal_ok = (0.0..=1e6).contains(&traversal_cost);
        require(traversal_ok, "traversal_cost", traversal_cost.into(), "0.0..=1e6")?;
        let intersection_ok = (1e-6..=1e6).contains(&intersection_cost);
        require(intersection_ok, "intersection_cost", intersection_cost.into(), "1e-6..=1e6")?;
        let duplication_ok = (0.0..=4.0).contains(&max_duplication);
        require(duplication_ok, "max_duplication", max_duplication.into(), "0.0..=4.0")?;
        let overlap_ok = (0.0..=1.0).contains(&min_overlap);
        require(overlap_ok, "min_overlap", min_overlap.into(), "0.0..=1.0")
    }
}
