//! Results of ray-primitive intersection.

use crate::machine::{Branch, Machine, Scalar, Value, Var};
use crate::{Type, kernel};

/// Result of an intersection; a miss is a value too, with `is_hit == false`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct Hit {
    /// Whether there is a hit; the other members are meaningless without one.
    pub is_hit: bool,
    /// Distance along the ray in lengths of its direction.
    pub t: f32,
    /// Primitive id: the index in the application's array, counted through all arrays of a list.
    /// Set by traversal.
    pub prim_id: u32,
    /// Instance id, see [`Instances`](crate::bvh::Instances); 0 where there are none. Set by
    /// traversal.
    pub inst_id: u32,
    /// First surface coordinate: the barycentric weight of a triangle's second vertex.
    pub u: f32,
    /// Second surface coordinate: the barycentric weight of a triangle's third vertex.
    pub v: f32,
}

#[kernel]
impl Hit {
    /// Creates a hit at distance `t` if `is_hit`, else a miss.
    pub const fn new(is_hit: bool, t: f32) -> Self {
        Self { is_hit, t, prim_id: 0, inst_id: 0, u: 0.0, v: 0.0 }
    }

    /// Returns a miss.
    pub const fn miss() -> Self {
        Self::new(false, 0.0)
    }
}

/// Result of a primitive's `intersect`: [`Hit`], or a user-defined struct with a `Hit` in it.
///
/// `#[derive(HitRecord)]` implements it for a struct with one member of the type `Hit`. Traversal
/// compares the hits alone; the rest is computed once, for the closest one.
///
/// ```
/// use raydsl::prelude::*;
///
/// #[derive(Clone, Copy, Type, HitRecord)]
/// struct ColorHit {
///     hit: Hit,
///     color: Vec3,
/// }
///
/// #[primitive]
/// struct Ball {
///     center: Vec3,
///     radius: f32,
/// }
///
/// #[primitive]
/// impl Ball {
///     fn intersect(&self, ray: Ray) -> ColorHit {
///         let hit = sphere::intersect(ray, self.center, self.radius);
///         ColorHit { hit, color: vec3(0.5, hit.t, 0.5) }
///     }
///     fn get_bounds(&self) -> Aabb {
///         Aabb::from_sphere(self.center, self.radius)
///     }
/// }
///
/// let balls = [Ball { center: vec3(0.0, 0.0, 5.0), radius: 1.0 }];
/// let bvh = Bvh::build(&balls)?;
/// let found = bvh.closest_hit(Ray::new(Vec3::ZERO, Vec3::Z));
/// assert!(found.hit.is_hit && found.color == vec3(0.5, 4.0, 0.5));
/// # Ok::<(), raydsl::bvh::BuildError>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a hit record",
    label = "`intersect` gives a `Hit`, or a struct that has one in it",
    note = "write `#[derive(Clone, Copy, Type, HitRecord)]` on a struct with a member `hit: Hit`"
)]
pub trait HitRecord: Type {
    /// Path of members to the hit, as named in WGSL.
    #[doc(hidden)]
    const PATH: &'static [&'static str];

    /// Returns the hit in the record.
    fn hit(&self) -> Hit;

    /// Replaces the hit in the record.
    fn with_hit(self, hit: Hit) -> Self;

    /// Completes the record of `hit`; `again` intersects once more.
    #[doc(hidden)]
    #[inline(always)]
    fn complete(hit: Hit, again: impl FnOnce() -> Self) -> Self {
        if hit.is_hit { again().with_hit(hit) } else { nothing::<Self>().with_hit(hit) }
    }

    /// Lifted form of `hit`.
    #[doc(hidden)]
    fn hit_on<M: Machine>(record: Self::On<M>) -> HitOn<M>;

    /// Lifted form of `with_hit`.
    #[doc(hidden)]
    fn with_hit_on<M: Machine>(record: Self::On<M>, hit: HitOn<M>) -> Self::On<M>;

    /// Lifted form of `complete`.
    #[doc(hidden)]
    #[inline(always)]
    fn complete_on<M: Machine>(
        m: &M,
        hit: HitOn<M>,
        again: impl FnOnce() -> Self::On<M>,
    ) -> Self::On<M> {
        let missed = Self::with_hit_on(Value::zero(m), hit);
        let record = Var::<Self::On<M>>::new(m, "found", missed);
        let branch = Branch::new(m, hit.is_hit);
        if branch.then(m) {
            record.set(m, Self::with_hit_on(again(), hit));
        }
        branch.end(m);
        record.get(m)
    }
}

/// Returns a record of zeros.
fn nothing<R: Type>() -> R {
    let m = Scalar::default();
    R::lane::<Scalar>(&Value::zero(&m), 0)
}

impl HitRecord for Hit {
    const PATH: &'static [&'static str] = &[];

    #[inline(always)]
    fn hit(&self) -> Hit {
        *self
    }

    #[inline(always)]
    fn with_hit(self, hit: Hit) -> Self {
        hit
    }

    #[inline(always)]
    fn complete(hit: Hit, _: impl FnOnce() -> Self) -> Self {
        hit
    }

    #[inline(always)]
    fn hit_on<M: Machine>(record: HitOn<M>) -> HitOn<M> {
        record
    }

    #[inline(always)]
    fn with_hit_on<M: Machine>(_: HitOn<M>, hit: HitOn<M>) -> HitOn<M> {
        hit
    }

    #[inline(always)]
    fn complete_on<M: Machine>(_: &M, hit: HitOn<M>, _: impl FnOnce() -> HitOn<M>) -> HitOn<M> {
        hit
    }
}
