//! Views of scenes that carry more data: their queries are those of the scene within.

/// Implements what a view of a scene has for a struct with such a view in one of its members:
/// `carrier!([generics] Type, View, member)`. The struct is a host value on every machine; it has a
/// method `data(&self, visit)` that visits what it carries besides.
macro_rules! carrier {
    ([$($g:tt)*] $t:ty, $view:ty, $member:ident) => {
        const _: () = {
            use $crate::bvh::traverse::CostOn;
            use $crate::bvh::{Cost, RecordQuery, RayQueryOn};
            use $crate::geometry::{HitOn, Ray, RayOn};
            use $crate::machine::{A3, B, Machine, On, Resource, U};

            impl<$($g)*> RayQueryOn for $t {
                type Hit = <$view as RayQueryOn>::Hit;
                type Hits<M: Machine> =
                    <$view as RayQueryOn>::Hits<M>;

                fn inst_count(self) -> u32 {
                    self.$member.inst_count()
                }

                #[inline(always)]
                fn named(self, name: &'static str) -> Self {
                    Self { $member: RayQueryOn::named(self.$member, name), ..self }
                }

                fn resources(&self, visit: &mut dyn FnMut(&dyn Resource)) {
                    self.data(visit);
                    RayQueryOn::resources(&self.$member, visit);
                }

                #[inline(always)]
                fn closest_hits<M: Machine, const N: usize>(
                    self,
                    m: &M,
                    rays: [RayOn<M>; N],
                ) -> [On<Self::Hit, M>; N] {
                    RayQueryOn::closest_hits(self.$member, m, rays)
                }

                #[inline(always)]
                fn any_hits<M: Machine, const N: usize>(
                    self,
                    m: &M,
                    rays: [RayOn<M>; N],
                ) -> [B<M>; N] {
                    RayQueryOn::any_hits(self.$member, m, rays)
                }

                #[inline(always)]
                fn closest_hit_with_cost<M: Machine>(
                    self,
                    m: &M,
                    ray: RayOn<M>,
                ) -> (On<Self::Hit, M>, CostOn<M>) {
                    RayQueryOn::closest_hit_with_cost(self.$member, m, ray)
                }

                #[inline(always)]
                fn closest_hit_where<M: Machine>(
                    self,
                    m: &M,
                    ray: RayOn<M>,
                    accept: impl Fn(On<Self::Hit, M>) -> B<M>,
                ) -> On<Self::Hit, M> {
                    RayQueryOn::closest_hit_where(self.$member, m, ray, accept)
                }

                #[inline(always)]
                fn any_hit_where<M: Machine>(
                    self,
                    m: &M,
                    ray: RayOn<M>,
                    accept: impl Fn(On<Self::Hit, M>) -> B<M>,
                ) -> B<M> {
                    RayQueryOn::any_hit_where(self.$member, m, ray, accept)
                }

                #[inline(always)]
                fn multi_hit_where<M: Machine, const N: usize>(
                    self,
                    m: &M,
                    ray: RayOn<M>,
                    accept: impl Fn(On<Self::Hit, M>) -> B<M>,
                ) -> [On<Self::Hit, M>; N] {
                    RayQueryOn::multi_hit_where(self.$member, m, ray, accept)
                }

                #[inline(always)]
                fn multi_hit_by<M: Machine, const N: usize>(
                    self,
                    m: &M,
                    ray: RayOn<M>,
                    is_closer: impl Fn(HitOn<M>, HitOn<M>) -> B<M>,
                ) -> [On<Self::Hit, M>; N] {
                    RayQueryOn::multi_hit_by(self.$member, m, ray, is_closer)
                }

                #[inline(always)]
                fn hits<M: Machine>(
                    self,
                    m: &M,
                    ray: RayOn<M>,
                ) -> Self::Hits<M> {
                    RayQueryOn::hits(self.$member, m, ray)
                }

                #[inline(always)]
                fn to_object<M: Machine>(
                    self,
                    m: &M,
                    inst: U<M>,
                ) -> A3<M> {
                    RayQueryOn::to_object(self.$member, m, inst)
                }

                #[inline(always)]
                fn local_ray<M: Machine>(
                    self,
                    m: &M,
                    ray: RayOn<M>,
                    inst: U<M>,
                ) -> RayOn<M> {
                    RayQueryOn::local_ray(self.$member, m, ray, inst)
                }

                fn closest_hit_of(self, ray: Ray) -> Self::Hit {
                    RayQueryOn::closest_hit_of(self.$member, ray)
                }

                fn any_hit_of(self, ray: Ray) -> bool {
                    RayQueryOn::any_hit_of(self.$member, ray)
                }

                fn closest_hits_of(self, rays: &[Ray]) -> Vec<Self::Hit> {
                    RayQueryOn::closest_hits_of(self.$member, rays)
                }

                fn any_hits_of(self, rays: &[Ray]) -> Vec<bool> {
                    RayQueryOn::any_hits_of(self.$member, rays)
                }

                fn closest_hit_with_cost_of(self, ray: Ray) -> (Self::Hit, Cost) {
                    RayQueryOn::closest_hit_with_cost_of(self.$member, ray)
                }

                fn any_hit_with_cost_of(self, ray: Ray) -> (bool, Cost) {
                    RayQueryOn::any_hit_with_cost_of(self.$member, ray)
                }
            }

            impl<$($g)*> RecordQuery for $t {
                type Hit = <$view as RayQueryOn>::Hit;
                type View<'v>
                    = Self
                where
                    Self: 'v;

                #[inline(always)]
                fn view(&self) -> Self {
                    *self
                }
            }
        };

        $crate::bvh::query_on::argument_itself!([$($g)*] $t);
        $crate::bvh::methods::queries!([$($g)*] $t, $t, |view| view);
    };
}

pub(crate) use carrier;
