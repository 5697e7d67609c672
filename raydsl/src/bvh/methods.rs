//! Methods of scenes in kernels: queries, and properties of a hit.

use glam::Affine3;

use super::hits::HitsOn;
use super::on::{AnyHits, ClosestHits, LocalRay, ToObject};
use super::query::{
    any_where, closest_on, closest_where, closest_with_cost_on, multi_by, multi_where, record_on,
};
use super::traverse::CostOn;
use super::{RecordOn, SceneView};
use crate::geometry::{HitOn, Primitive, RayOn, transform_normal_back};
use crate::machine::{
    A3, B, Coerce, Const, Machine, Method, Slice, Type, U, V3, Value, fill, name,
};

#[diagnostic::do_not_recommend]
impl<M: Machine, P: Primitive> Method<{ name("closest_hit") }, M, (RayOn<M>,)>
    for SceneView<'_, P>
{
    type Output = RecordOn<M, P>;

    #[inline(always)]
    fn call(self, m: &M, (ray,): (RayOn<M>,)) -> Self::Output {
        closest_on(m, &self, ray)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, P: Primitive> Method<{ name("closest_hit_with_cost") }, M, (RayOn<M>,)>
    for SceneView<'_, P>
{
    type Output = (RecordOn<M, P>, CostOn<M>);

    #[inline(always)]
    fn call(self, m: &M, (ray,): (RayOn<M>,)) -> Self::Output {
        closest_with_cost_on(m, &self, ray)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, P: Primitive> Method<{ name("any_hit") }, M, (RayOn<M>,)> for SceneView<'_, P> {
    type Output = B<M>;

    #[inline(always)]
    fn call(self, m: &M, (ray,): (RayOn<M>,)) -> B<M> {
        let [is_hit] = m.perform(&AnyHits(&self), [ray]);
        is_hit
    }
}

#[diagnostic::do_not_recommend]
impl<'a, M: Machine, P: Primitive> Method<{ name("hits") }, M, (RayOn<M>,)> for SceneView<'a, P> {
    type Output = HitsOn<'a, M, P>;

    #[inline(always)]
    fn call(self, _: &M, (ray,): (RayOn<M>,)) -> HitsOn<'a, M, P> {
        HitsOn { scene: self, ray }
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, P: Primitive, const N: usize>
    Method<{ name("multi_hit") }, M, (Const<N>, RayOn<M>)> for SceneView<'_, P>
{
    type Output = [RecordOn<M, P>; N];

    #[inline(always)]
    fn call(self, m: &M, (_, ray): (Const<N>, RayOn<M>)) -> [RecordOn<M, P>; N] {
        multi_where(m, &self, ray, &|_| B(m.bool(true)))
    }
}

#[diagnostic::do_not_recommend]
impl<M, P, R, G> Method<{ name("closest_hit_where") }, M, (RayOn<M>, G)> for SceneView<'_, P>
where
    M: Machine,
    P: Primitive,
    R: Coerce<M, B<M>>,
    G: Fn(&M, RecordOn<M, P>) -> R,
{
    type Output = RecordOn<M, P>;

    #[inline(always)]
    fn call(self, m: &M, (ray, accept): (RayOn<M>, G)) -> Self::Output {
        let hit = closest_where(m, &self, ray, &|record| accept(m, record).coerce(m));
        record_on(m, &self, ray, hit)
    }
}

#[diagnostic::do_not_recommend]
impl<M, P, R, G> Method<{ name("any_hit_where") }, M, (RayOn<M>, G)> for SceneView<'_, P>
where
    M: Machine,
    P: Primitive,
    R: Coerce<M, B<M>>,
    G: Fn(&M, RecordOn<M, P>) -> R,
{
    type Output = B<M>;

    #[inline(always)]
    fn call(self, m: &M, (ray, accept): (RayOn<M>, G)) -> B<M> {
        any_where(m, &self, ray, &|record| accept(m, record).coerce(m))
    }
}

#[diagnostic::do_not_recommend]
impl<M, P, R, G, const N: usize> Method<{ name("multi_hit_where") }, M, (Const<N>, RayOn<M>, G)>
    for SceneView<'_, P>
where
    M: Machine,
    P: Primitive,
    R: Coerce<M, B<M>>,
    G: Fn(&M, RecordOn<M, P>) -> R,
{
    type Output = [RecordOn<M, P>; N];

    #[inline(always)]
    fn call(self, m: &M, (_, ray, accept): (Const<N>, RayOn<M>, G)) -> [RecordOn<M, P>; N] {
        multi_where(m, &self, ray, &|record| accept(m, record).coerce(m))
    }
}

#[diagnostic::do_not_recommend]
impl<M, P, R, G, const N: usize> Method<{ name("multi_hit_by") }, M, (Const<N>, RayOn<M>, G)>
    for SceneView<'_, P>
where
    M: Machine,
    P: Primitive,
    R: Coerce<M, B<M>>,
    G: Fn(&M, HitOn<M>, HitOn<M>) -> R,
{
    type Output = [RecordOn<M, P>; N];

    #[inline(always)]
    fn call(self, m: &M, (_, ray, is_closer): (Const<N>, RayOn<M>, G)) -> [RecordOn<M, P>; N] {
        multi_by(m, &self, ray, &|a, b| is_closer(m, a, b).coerce(m))
    }
}

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
            return m.perform(&AnyHits(&self), rays(m, ray));
        }
        m.each(
            #[inline(always)]
            |i| {
                let [is_hit] = m.perform(&AnyHits(&self), [ray(m, i).coerce(m)]);
                is_hit
            },
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
    type Output = [RecordOn<M, P>; N];

    #[inline(always)]
    fn call(self, m: &M, (_, ray): (Const<N>, G)) -> Self::Output {
        if M::RUNS {
            let rays: [RayOn<M>; N] = rays(m, ray);
            let hits = m.perform(&ClosestHits(&self), rays);
            return fill(
                #[inline(always)]
                |i| record_on(m, &self, rays[i], hits[i]),
            );
        }
        m.each(
            #[inline(always)]
            |i| closest_on(m, &self, ray(m, i).coerce(m)),
        )
    }
}

/// Evaluates all rays before the query.
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

/// Queries of a captured array. It is a value of the kernel, but rays need primitives in memory.
pub struct PrimitivesOfValue<M>(core::marker::PhantomData<M>);

const _: () = {
    #[diagnostic::on_unimplemented(
        message = "rays do not meet the primitives of a captured array",
        label = "an array is a value of the kernel, and a slice lies in memory",
        note = "capture a slice of it: `let shapes = &shapes[..];` before the kernel"
    )]
    pub trait InMemory {}

    macro_rules! queries {
        ($($name:literal -> $out:ty;)+) => {
            $(
                impl<M: Machine, A, V: Value<M>, const N: usize>
                    Method<{ name($name) }, M, A> for [V; N]
                where
                    PrimitivesOfValue<M>: InMemory,
                {
                    type Output = $out;

                    fn call(self, _: &M, _: A) -> $out {
                        unreachable!()
                    }
                }
            )+
        };
    }

    queries! {
        "closest_hit" -> HitOn<M>;
        "closest_hit_each" -> [HitOn<M>; 1];
        "closest_hit_where" -> HitOn<M>;
        "closest_hit_with_cost" -> HitOn<M>;
        "any_hit" -> B<M>;
        "any_hit_each" -> [B<M>; 1];
        "any_hit_where" -> B<M>;
        "hits" -> ();
        "multi_hit" -> [HitOn<M>; 1];
        "multi_hit_by" -> [HitOn<M>; 1];
        "multi_hit_where" -> [HitOn<M>; 1];
        "primitive" -> V;
        "to_object" -> A3<M>;
        "local_ray" -> RayOn<M>;
        "normal_in_scene" -> V3<M>;
    }
};

#[diagnostic::do_not_recommend]
impl<M: Machine, P: Primitive> Method<{ name("primitive") }, M, (HitOn<M>,)> for SceneView<'_, P> {
    type Output = P::On<M>;

    #[inline(always)]
    fn call(self, m: &M, (hit,): (HitOn<M>,)) -> P::On<M> {
        let id = m.u32_select(hit.is_hit.0, hit.prim_id.0, m.u32(0));
        // The hit may belong to another scene.
        m.element(&self, U(id))
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, P: Primitive> Method<{ name("to_object") }, M, (HitOn<M>,)> for SceneView<'_, P> {
    type Output = A3<M>;

    #[inline(always)]
    fn call(self, m: &M, (hit,): (HitOn<M>,)) -> A3<M> {
        match self.placed() {
            Some(_) => m.perform(&ToObject(&self), hit.inst_id),
            None => Affine3::splat(m, Affine3::IDENTITY),
        }
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, P: Primitive> Method<{ name("local_ray") }, M, (RayOn<M>, HitOn<M>)>
    for SceneView<'_, P>
{
    type Output = RayOn<M>;

    #[inline(always)]
    fn call(self, m: &M, (ray, hit): (RayOn<M>, HitOn<M>)) -> RayOn<M> {
        match self.placed() {
            Some(_) => m.perform(&LocalRay(&self), (ray, hit.inst_id)),
            None => ray,
        }
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, P: Primitive> Method<{ name("normal_in_scene") }, M, (HitOn<M>, V3<M>)>
    for SceneView<'_, P>
{
    type Output = V3<M>;

    #[inline(always)]
    fn call(self, m: &M, (hit, normal): (HitOn<M>, V3<M>)) -> V3<M> {
        let map = Method::<{ name("to_object") }, M, (HitOn<M>,)>::call(self, m, (hit,));
        transform_normal_back::on(m, normal, map)
    }
}

#[diagnostic::do_not_recommend]
impl<'a, M: Machine, P: Primitive> Method<{ name("shared") }, M, ()> for SceneView<'a, P> {
    type Output = Slice<'a, P::Shared>;

    #[inline(always)]
    fn call(self, _: &M, (): ()) -> Slice<'a, P::Shared> {
        SceneView::shared(&self)
    }
}

/// Implements the methods for slices of primitives, which are scenes too.
macro_rules! of_slices {
    ($($name:literal)+) => {
        $(
            #[diagnostic::do_not_recommend]
            impl<'a, M: Machine, P: Primitive<Shared = ()>, A> Method<{ name($name) }, M, A>
                for Slice<'a, P>
            where
                SceneView<'a, P>: Method<{ name($name) }, M, A>,
            {
                type Output = <SceneView<'a, P> as Method<{ name($name) }, M, A>>::Output;

                #[inline(always)]
                fn call(self, m: &M, args: A) -> Self::Output {
                    SceneView::slice(self).call(m, args)
                }
            }
        )+
    };
}

of_slices! {
    "closest_hit" "closest_hit_each" "closest_hit_where" "closest_hit_with_cost"
    "any_hit" "any_hit_each" "any_hit_where"
    "hits" "multi_hit" "multi_hit_by" "multi_hit_where"
    "primitive" "local_ray" "to_object" "normal_in_scene" "shared"
}
