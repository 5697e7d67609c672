//! What makes a type a primitive.

use super::{Aabb, Hit, HitOn, Ray, RayOn};
use crate::machine::{Machine, Type};

/// Something that rays meet; `#[primitive]` writes this from one definition of `intersect`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a primitive",
    note = "write `#[primitive]` on the struct, and on an impl with `intersect` and `get_bounds`"
)]
pub trait Primitive: Type + Send + Sync {
    /// How far an accepted hit may lie from the exact one, relative to the distance between the
    /// ray's origin and the farthest corner of the scene: the error of `t`, and by how much the
    /// ray may pass beside [`Primitive::get_bounds`].
    ///
    /// Traversal widens boxes and distances by it, so that hits never depend on the tree. The
    /// default suits a careful `intersect` of a few dozen operations.
    const SLACK: f32 = 1.0 / 65536.0;

    /// Where `ray` meets the primitive. It sees the ray's own `t_min` and `t_max` and need not
    /// heed them: traversal compares.
    fn intersect(&self, ray: Ray) -> Hit;

    /// A box around the whole primitive.
    fn get_bounds(&self) -> Aabb;

    /// `intersect`, lifted.
    #[doc(hidden)]
    fn intersect_on<M: Machine>(m: &M, prim: Self::On<M>, ray: RayOn<M>) -> HitOn<M>;
}
