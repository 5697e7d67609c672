//! Queries of several rays at once: a closure of the kernel gives ray `i`.

use super::{Coerce, Machine, Method, U, fill, name};
use crate::bvh::{self, SceneView};
use crate::geometry::{Primitive, RayOn};
use crate::machine::B;

/// A number between `::<` and `>`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Const<const N: usize>;

#[diagnostic::do_not_recommend]
impl<M, P, R, G, const N: usize> Method<{ name("any_hit_each") }, M, (Const<N>, G)>
    for SceneView<'_, P>
where
    M: Machine,
    P: Primitive,
    R: Coerce<M, RayOn<M>>,
    G: Fn(&M, U<M>) -> R,
{
    type Output = [B<M>; N];

    #[inline(always)]
    fn call(self, m: &M, (_, ray): (Const<N>, G)) -> [B<M>; N] {
        if M::RUNS {
            return m.any_hits(&self, &rays(m, ray));
        }
        m.each(
            #[inline(always)]
            |i| m.any_hit(&self, ray(m, i).coerce(m)),
        )
    }
}

#[diagnostic::do_not_recommend]
impl<M, P, R, G, const N: usize> Method<{ name("closest_hit_each") }, M, (Const<N>, G)>
    for SceneView<'_, P>
where
    M: Machine,
    P: Primitive,
    R: Coerce<M, RayOn<M>>,
    G: Fn(&M, U<M>) -> R,
{
    type Output = [bvh::RecordOn<M, P>; N];

    #[inline(always)]
    fn call(self, m: &M, (_, ray): (Const<N>, G)) -> Self::Output {
        if M::RUNS {
            let rays: [RayOn<M>; N] = rays(m, ray);
            let hits = m.closest_hits(&self, &rays);
            return fill(
                #[inline(always)]
                |i| bvh::record_on(m, &self, rays[i], hits[i]),
            );
        }
        m.each(
            #[inline(always)]
            |i| bvh::closest_on(m, &self, ray(m, i).coerce(m)),
        )
    }
}

/// All rays, before any of them is asked about.
#[inline(always)]
fn rays<M: Machine, R: Coerce<M, RayOn<M>>, const N: usize>(
    m: &M,
    ray: impl Fn(&M, U<M>) -> R,
) -> [RayOn<M>; N] {
    fill(
        #[inline(always)]
        |i| ray(m, U(m.u32(i as u32))).coerce(m),
    )
}
