//! Bounding volume hierarchies over any primitive.
//!
//! **Closest hit is a function of the ray and the primitives, not of the tree**: of all primitives
//! whose `intersect` accepts, the one with the least `(t, id)`. Every traversal (one ray, packets,
//! WGSL, a plain loop over a slice) returns exactly that, bit for bit. What makes it so:
//!
//! * `intersect` sees the ray's own range, never the best `t` so far; the traversal alone
//!   compares, and of equal `t` keeps the smaller id.
//! * Boxes are widened, and nodes behind the best hit are culled, with an allowance of
//!   [`Primitive::SLACK`]: what rounding may do to a hit, it does to no visit.
//! * Every layout runs the same arithmetic on the same members of a primitive.

pub mod build;
mod node;
mod query;
pub(crate) mod slabs;
pub mod traverse;
pub(crate) mod traverse_packet;
mod view;

use core::sync::atomic::{AtomicU64, Ordering};

pub use build::{BuildConfig, BuildError, MAX_DEPTH};
pub use node::Node;
pub(crate) use query::closest_on;
pub use traverse::Cost;
pub(crate) use view::NODE_SCHEMA;
pub use view::On;

use crate::geometry::{Aabb, Hit, Kinds, Primitive, Ray};
use crate::machine::{Capture, Machine, Resource, Type, wgsl::BufferKey};

/// A number that no other owner of scene data has.
fn next_id() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(1);
    NEXT.fetch_add(1, Ordering::Relaxed)
}

/// A binary tree over primitives that the application owns.
///
/// ```
/// use raydsl::prelude::*;
///
/// let triangles = [Triangle { v0: vec3(0.0, 0.0, 1.0), v1: vec3(4.0, 0.0, 1.0), v2: vec3(0.0, 4.0, 1.0) }];
/// let bvh = Bvh::build(&triangles)?;
/// let hit = bvh.closest_hit(Ray::new(vec3(1.0, 1.0, 0.0), vec3(0.0, 0.0, 1.0)));
/// assert!(hit.is_hit && hit.t == 1.0 && hit.prim_id == 0);
/// # Ok::<(), raydsl::bvh::BuildError>(())
/// ```
#[derive(Debug)]
pub struct Bvh<'a, P> {
    prims: &'a [P],
    nodes: Vec<Node>,
    indices: Vec<u32>,
    id: u64,
    kinds: Kinds,
}

impl<'a, P: Primitive> Bvh<'a, P> {
    /// Builds a tree with the default configuration. No primitive at all is a valid scene.
    ///
    /// # Errors
    ///
    /// A primitive whose bounds are not finite, or more primitives than 32-bit indices can name.
    pub fn build(prims: &'a [P]) -> Result<Self, BuildError> {
        Self::build_with(prims, &BuildConfig::default())
    }

    /// Builds a tree.
    ///
    /// # Errors
    ///
    /// As [`Bvh::build`]; also a configuration out of its ranges.
    pub fn build_with(prims: &'a [P], config: &BuildConfig) -> Result<Self, BuildError> {
        let tree = build::build(|i| prims[i].get_bounds(), prims.len(), config)?;
        let kinds = Kinds::of(prims);
        Ok(Self { prims, nodes: tree.nodes, indices: tree.indices, id: next_id(), kinds })
    }

    /// The least `(t, id)` hit of `ray`.
    pub fn closest_hit(&self, ray: Ray) -> P::Hit {
        traverse::closest_hit(&self.view(), ray)
    }

    /// The least `(t, id)` hit of `ray`, and what it cost to find.
    pub fn closest_hit_with_cost(&self, ray: Ray) -> (P::Hit, Cost) {
        traverse::closest_hit_with_cost(&self.view(), ray)
    }

    /// Whether `ray` hits anything.
    pub fn any_hit(&self, ray: Ray) -> bool {
        traverse::any_hit(&self.view(), ray)
    }

    /// The least `(t, id)` hit of each of `N` rays, `ray(0)` to `ray(N - 1)`.
    ///
    /// What one query sees at once it can trace better than one ray after another; the results
    /// are those of [`Bvh::closest_hit`]. Inside a kernel `ray` is a closure of the kernel.
    pub fn closest_hit_each<const N: usize>(&self, ray: impl Fn(u32) -> Ray) -> [P::Hit; N] {
        core::array::from_fn(|i| self.closest_hit(ray(i as u32)))
    }

    /// Whether each of `N` rays, `ray(0)` to `ray(N - 1)`, hits anything.
    ///
    /// ```
    /// use raydsl::prelude::*;
    ///
    /// let triangles = [Triangle { v0: vec3(0.0, 0.0, 1.0), v1: vec3(4.0, 0.0, 1.0), v2: vec3(0.0, 4.0, 1.0) }];
    /// let bvh = Bvh::build(&triangles)?;
    /// let up = vec3(0.0, 0.0, 1.0);
    /// let visible = kernel!(|x: f32, y: f32| {
    ///     let hits = bvh.any_hit_each::<4>(|i: u32| Ray::new(vec3(x + i as f32, y, 0.0), up));
    ///     let mut count = 0u32;
    ///     for hit in 0..4usize {
    ///         count += hits[hit] as u32;
    ///     }
    ///     count
    /// });
    /// assert_eq!(visible.call((0.5, 0.5)), 4);
    /// # Ok::<(), raydsl::bvh::BuildError>(())
    /// ```
    pub fn any_hit_each<const N: usize>(&self, ray: impl Fn(u32) -> Ray) -> [bool; N] {
        core::array::from_fn(|i| self.any_hit(ray(i as u32)))
    }

    /// The least `(t, id)` hit of `ray` that `accept` accepts: leaves with holes, sides that are not
    /// seen. `accept` is asked about some of the hits, in any order. Inside a kernel it is a closure of
    /// the kernel, which may read what stands around it.
    pub fn closest_hit_where(&self, ray: Ray, accept: impl Fn(Hit) -> bool) -> P::Hit {
        traverse::closest_hit_where(&self.view(), ray, accept)
    }

    /// Whether `ray` has a hit that `accept` accepts.
    pub fn any_hit_where(&self, ray: Ray, accept: impl Fn(Hit) -> bool) -> bool {
        traverse::any_hit_where(&self.view(), ray, accept)
    }

    /// The `N` least `(t, id)` hits of `ray`, in order, with misses behind them. Each primitive gives
    /// the hit of its `intersect`, so a sphere is there once.
    ///
    /// ```
    /// use raydsl::prelude::*;
    ///
    /// let v = |x, y, z| vec3(x, y, z);
    /// let slabs = [3.0, 1.0, 2.0].map(|z| Triangle { v0: v(0.0, 0.0, z), v1: v(4.0, 0.0, z), v2: v(0.0, 4.0, z) });
    /// let bvh = Bvh::build(&slabs)?;
    /// let depths = kernel!(|ray: Ray| {
    ///     let hits = bvh.multi_hit::<2>(ray);
    ///     (hits[0].t, hits[1].t, hits[1].prim_id)
    /// });
    /// assert_eq!(depths.call((Ray::new(v(1.0, 1.0, 0.0), Vec3::Z),)), (1.0, 2.0, 2));
    /// # Ok::<(), raydsl::bvh::BuildError>(())
    /// ```
    pub fn multi_hit<const N: usize>(&self, ray: Ray) -> [Hit; N] {
        self.multi_hit_where(ray, |_| true)
    }

    /// The `N` least `(t, id)` hits of `ray` that `accept` accepts, in order.
    pub fn multi_hit_where<const N: usize>(
        &self,
        ray: Ray,
        accept: impl Fn(Hit) -> bool,
    ) -> [Hit; N] {
        traverse::multi_hit_where(&self.view(), ray, accept)
    }

    /// The primitive that was hit; the first one for a miss, so that code need not branch.
    ///
    /// # Panics
    ///
    /// If the tree is empty.
    pub fn primitive(&self, hit: Hit) -> P {
        self.view().get(if hit.is_hit { hit.prim_id } else { 0 })
    }

    /// The primitives, as the application owns them.
    pub fn primitives(&self) -> &'a [P] {
        self.prims
    }

    /// The nodes; the root is the first, children are adjacent.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The index list that leaves refer to.
    pub fn indices(&self) -> &[u32] {
        &self.indices
    }

    /// A box around everything; empty without primitives.
    pub fn bounds(&self) -> Aabb {
        self.nodes.first().map_or(Aabb::EMPTY, Node::bounds)
    }

    /// Bytes of the tree itself; the primitives are the application's.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.nodes[..]) + size_of_val(&self.indices[..])
    }

    /// The view that kernels work on.
    pub fn view(&self) -> On<'_, P> {
        On::tree(self.prims, &self.nodes, &self.indices, self.id, self.kinds)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, P: Primitive> Capture<M> for Bvh<'_, P> {
    type On<'c>
        = On<'c, P>
    where
        Self: 'c;

    #[inline(always)]
    fn capture<'c>(&'c self, _: &M, name: &'static str) -> On<'c, P> {
        self.view().named(name)
    }

    #[inline(always)]
    fn constant<'c>(&'c self, _: &M) -> On<'c, P> {
        self.view()
    }

    fn resources(&self, visit: &mut dyn FnMut(&dyn Resource)) {
        visit(&self.view());
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, P: Type> Capture<M> for [P] {
    type On<'c>
        = On<'c, P>
    where
        Self: 'c;

    #[inline(always)]
    fn capture<'c>(&'c self, _: &M, name: &'static str) -> On<'c, P> {
        On::slice(self).named(name)
    }

    #[inline(always)]
    fn constant<'c>(&'c self, _: &M) -> On<'c, P> {
        On::slice(self)
    }

    fn resources(&self, visit: &mut dyn FnMut(&dyn Resource)) {
        visit(&On::slice(self));
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, P: Type> Capture<M> for Vec<P> {
    type On<'c>
        = On<'c, P>
    where
        Self: 'c;

    #[inline(always)]
    fn capture<'c>(&'c self, m: &M, name: &'static str) -> On<'c, P> {
        self.as_slice().capture(m, name)
    }

    #[inline(always)]
    fn constant<'c>(&'c self, m: &M) -> On<'c, P> {
        self.as_slice().constant(m)
    }

    fn resources(&self, visit: &mut dyn FnMut(&dyn Resource)) {
        Capture::<M>::resources(self.as_slice(), visit);
    }
}

/// What a kernel asks of a slice of primitives, without a tree: every primitive is tested.
///
/// With a few dozen primitives this is faster than a tree.
pub trait Slice<P: Primitive> {
    /// The least `(t, id)` hit of `ray`.
    fn closest_hit(&self, ray: Ray) -> P::Hit;
    /// Whether `ray` hits anything.
    fn any_hit(&self, ray: Ray) -> bool;
    /// The least `(t, id)` hit of each of `N` rays.
    fn closest_hit_each<const N: usize>(&self, ray: impl Fn(u32) -> Ray) -> [P::Hit; N];
    /// Whether each of `N` rays hits anything.
    fn any_hit_each<const N: usize>(&self, ray: impl Fn(u32) -> Ray) -> [bool; N];
    /// The least `(t, id)` hit of `ray` that `accept` accepts.
    fn closest_hit_where(&self, ray: Ray, accept: impl Fn(Hit) -> bool) -> P::Hit;
    /// Whether `ray` has a hit that `accept` accepts.
    fn any_hit_where(&self, ray: Ray, accept: impl Fn(Hit) -> bool) -> bool;
    /// The `N` least `(t, id)` hits of `ray`, in order, with misses behind them.
    fn multi_hit<const N: usize>(&self, ray: Ray) -> [Hit; N];
    /// Those that `accept` accepts.
    fn multi_hit_where<const N: usize>(&self, ray: Ray, accept: impl Fn(Hit) -> bool) -> [Hit; N];
    /// The primitive that was hit; the first one for a miss.
    fn primitive(&self, hit: Hit) -> P;
}

impl<P: Primitive> Slice<P> for [P] {
    fn closest_hit(&self, ray: Ray) -> P::Hit {
        traverse::closest_hit(&On::slice(self), ray)
    }

    fn any_hit(&self, ray: Ray) -> bool {
        traverse::any_hit(&On::slice(self), ray)
    }

    fn closest_hit_each<const N: usize>(&self, ray: impl Fn(u32) -> Ray) -> [P::Hit; N] {
        core::array::from_fn(|i| self.closest_hit(ray(i as u32)))
    }

    fn any_hit_each<const N: usize>(&self, ray: impl Fn(u32) -> Ray) -> [bool; N] {
        core::array::from_fn(|i| self.any_hit(ray(i as u32)))
    }

    fn closest_hit_where(&self, ray: Ray, accept: impl Fn(Hit) -> bool) -> P::Hit {
        traverse::closest_hit_where(&On::slice(self), ray, accept)
    }

    fn any_hit_where(&self, ray: Ray, accept: impl Fn(Hit) -> bool) -> bool {
        traverse::any_hit_where(&On::slice(self), ray, accept)
    }

    fn multi_hit<const N: usize>(&self, ray: Ray) -> [Hit; N] {
        self.multi_hit_where(ray, |_| true)
    }

    fn multi_hit_where<const N: usize>(&self, ray: Ray, accept: impl Fn(Hit) -> bool) -> [Hit; N] {
        traverse::multi_hit_where(&On::slice(self), ray, accept)
    }

    fn primitive(&self, hit: Hit) -> P {
        On::slice(self).get(if hit.is_hit { hit.prim_id } else { 0 })
    }
}

/// The key of a slice: the address and length of borrowed data name it while the borrow lasts.
pub(crate) fn slice_key<P>(prims: &[P]) -> BufferKey {
    let address = prims.as_ptr() as usize as u64;
    BufferKey { id: address | 1 << 63, version: prims.len() as u32, part: size_of::<P>() as u32 }
}

/// The bytes of primitives in the host's layout.
fn bytes_of<P: Type>(prims: &[P]) -> Vec<u8> {
    let stride = crate::machine::stride(P::SCHEMA);
    let mut bytes = vec![0; stride * prims.len()];
    for (p, out) in prims.iter().zip(bytes.chunks_exact_mut(stride)) {
        p.write(out);
    }
    bytes
}

/// Whether a key names a slice rather than a tree.
#[cfg(feature = "gpu")]
pub(crate) fn is_slice_key(key: BufferKey) -> bool {
    key.id >> 63 == 1
}
