//! Methods of scenes in kernels: queries, and properties of a hit.

use super::ray_query::primitive_at;
use super::{Joined, PrimitiveScene, RayQueryOn, RecordQuery, SceneView};
use crate::geometry::{HitOn, Primitive, RayOn, SharedViews};
use crate::machine::{A3, B, Machine, Method, On, Slice, V3, Value, name};

/// Implements the queries of a type that has a view.
macro_rules! queries {
    ([$($g:tt)*] $t:ty, $view:ty, |$this:ident| $scene:expr) => {
        const _: () = {
            use $crate::bvh::ray_query::{any_hit_each, closest_hit_each};
            use $crate::bvh::traverse::CostOn;
            use $crate::bvh::{RayQueryOn, methods::ViewRecordOn};
            use $crate::geometry::{HitOn, RayOn, transform_normal_back};
            use $crate::machine::{A3, B, Coerce, Const, Machine, Method, U, V3, name};

            $crate::bvh::methods::queries! {
                @each [$($g)*] $t, |$this| $scene;
                "closest_hit", [],
                |m, scene, (ray): (RayOn<M>)| -> ViewRecordOn<$view, M> {
                    let [hit] = RayQueryOn::closest_hits(scene, m, [ray]);
                    hit
                }
                "closest_hit_with_cost", [],
                |m, scene, (ray): (RayOn<M>)| -> (ViewRecordOn<$view, M>, CostOn<M>) {
                    RayQueryOn::closest_hit_with_cost(scene, m, ray)
                }
                "any_hit", [],
                |m, scene, (ray): (RayOn<M>)| -> B<M> {
                    let [is_hit] = RayQueryOn::any_hits(scene, m, [ray]);
                    is_hit
                }
                "hits", [],
                |m, scene, (ray): (RayOn<M>)| -> <$view as RayQueryOn>::Hits<M> {
                    RayQueryOn::hits(scene, m, ray)
                }
                "closest_hit_where", [R: Coerce<M, B<M>>, G: Fn(&M, ViewRecordOn<$view, M>) -> R],
                |m, scene, (ray, accept): (RayOn<M>, G)| -> ViewRecordOn<$view, M> {
                    let accept = |record| accept(m, record).coerce(m);
                    RayQueryOn::closest_hit_where(scene, m, ray, accept)
                }
                "any_hit_where", [R: Coerce<M, B<M>>, G: Fn(&M, ViewRecordOn<$view, M>) -> R],
                |m, scene, (ray, accept): (RayOn<M>, G)| -> B<M> {
                    let accept = |record| accept(m, record).coerce(m);
                    RayQueryOn::any_hit_where(scene, m, ray, accept)
                }
                "multi_hit", [const N: usize],
                |m, scene, (_n, ray): (Const<N>, RayOn<M>)| -> [ViewRecordOn<$view, M>; N] {
                    RayQueryOn::multi_hit_where(scene, m, ray, |_| B(m.bool(true)))
                }
                "multi_hit_where",
                [R: Coerce<M, B<M>>, G: Fn(&M, ViewRecordOn<$view, M>) -> R, const N: usize],
                |m, scene, (_n, ray, accept): (Const<N>, RayOn<M>, G)|
                    -> [ViewRecordOn<$view, M>; N]
                {
                    let accept = |record| accept(m, record).coerce(m);
                    RayQueryOn::multi_hit_where(scene, m, ray, accept)
                }
                "multi_hit_by",
                [R: Coerce<M, B<M>>, G: Fn(&M, HitOn<M>, HitOn<M>) -> R, const N: usize],
                |m, scene, (_n, ray, is_closer): (Const<N>, RayOn<M>, G)|
                    -> [ViewRecordOn<$view, M>; N]
                {
                    let is_closer = |a, b| is_closer(m, a, b).coerce(m);
                    RayQueryOn::multi_hit_by(scene, m, ray, is_closer)
                }
                "any_hit_each", [R: Coerce<M, RayOn<M>>, G: Fn(&M, U<M>) -> R, const N: usize],
                |m, scene, (_n, ray): (Const<N>, G)| -> [B<M>; N] { any_hit_each(m, scene, ray) }
                "closest_hit_each", [R: Coerce<M, RayOn<M>>, G: Fn(&M, U<M>) -> R, const N: usize],
                |m, scene, (_n, ray): (Const<N>, G)| -> [ViewRecordOn<$view, M>; N] {
                    closest_hit_each(m, scene, ray)
                }
                "to_object", [],
                |m, scene, (hit): (HitOn<M>)| -> A3<M> {
                    RayQueryOn::to_object(scene, m, hit.inst_id)
                }
                "local_ray", [],
                |m, scene, (ray, hit): (RayOn<M>, HitOn<M>)| -> RayOn<M> {
                    RayQueryOn::local_ray(scene, m, ray, hit.inst_id)
                }
                "normal_in_scene", [],
                |m, scene, (hit, normal): (HitOn<M>, V3<M>)| -> V3<M> {
                    let to_object = RayQueryOn::to_object(scene, m, hit.inst_id);
                    transform_normal_back::on(m, normal, to_object)
                }
            }
        };
    };
    (
        @each [$($g:tt)*] $t:ty, |$this:ident| $scene:expr;
        $(
            $name:literal, [$($own:tt)*],
            |$m:ident, $s:ident, ($($arg:ident),+): ($($arg_ty:ty),+)| -> $out:ty $body:block
        )+
    ) => {
        $crate::bvh::methods::queries! { @paired [$($g)*] [$t] [|$this| $scene] $(
            { $name, [$($own)*], |$m, $s, ($($arg),+): ($($arg_ty),+)| -> $out $body }
        )+ }
    };
    (@paired $g:tt $t:tt $scene:tt $($query:tt)+) => {
        $($crate::bvh::methods::queries! { @one $g $t $scene $query })+
    };
    (
        @one [$($g:tt)*] [$t:ty] [|$this:ident| $scene:expr]
        {
            $name:literal, [$($own:tt)*],
            |$m:ident, $s:ident, ($($arg:ident),+): ($($arg_ty:ty),+)| -> $out:ty $body:block
        }
    ) => {
        #[diagnostic::do_not_recommend]
        impl<$($g)*, M: Machine, $($own)*> Method<{ name($name) }, M, ($($arg_ty,)+)> for $t {
            type Output = $out;

            #[inline(always)]
            fn call(self, $m: &M, ($($arg,)+): ($($arg_ty,)+)) -> $out {
                let $this = self;
                let $s = $scene;
                $body
            }
        }
    };
}

/// The record of a hit of a scene on a machine.
pub(crate) type ViewRecordOn<V, M> = On<<V as RayQueryOn>::Hit, M>;

pub(crate) use queries;

queries!(['a, P: Primitive] SceneView<'a, P>, SceneView<'a, P>, |view| view);
queries! {
    ['a, P: Primitive<Shared = ()>] Slice<'a, P>, SceneView<'a, P>, |prims| SceneView::slice(prims)
}
queries! {
    [S: RayQueryOn, T: RayQueryOn<Hit = S::Hit>] Joined<S, T>, Joined<S, T>, |scenes| scenes
}
queries!(['s, S: RecordQuery + ?Sized] &'s S, S::View<'s>, |scene| scene.view());

/// Implements what scenes of primitives of one type have besides.
macro_rules! primitives {
    ([$($g:tt)*] $t:ty, $p:ty, |$this:ident| $view:expr) => {
        #[diagnostic::do_not_recommend]
        impl<'a, $($g)*, M: Machine> Method<{ name("primitive") }, M, (HitOn<M>,)> for $t {
            type Output = On<$p, M>;

            #[inline(always)]
            fn call(self, m: &M, (hit,): (HitOn<M>,)) -> On<$p, M> {
                let $this = self;
                primitive_at(m, &$view, hit)
            }
        }

        #[diagnostic::do_not_recommend]
        impl<'a, $($g)*, M: Machine> Method<{ name("shared") }, M, ()> for $t {
            type Output = SharedViews<'a, $p>;

            #[inline(always)]
            fn call(self, _: &M, (): ()) -> Self::Output {
                let $this = self;
                SceneView::shared(&$view)
            }
        }
    };
}

primitives!([P: Primitive] SceneView<'a, P>, P, |view| view);
primitives!([P: Primitive<Shared = ()>] Slice<'a, P>, P, |prims| SceneView::slice(prims));
primitives!([S: PrimitiveScene + ?Sized] &'a S, S::Primitive, |scene| scene.primitives_view());

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
