//! Views of scenes that carry more data: their queries are those of the scene within.

/// Implements what a view of a scene has for a struct with such a view in one of its members:
/// `carrier!([generics] Type, View, member)`. The struct is a host value on every machine; it has a
/// method `data(&self, visit)` that visits what it carries besides.
macro_rules! carrier {
    ([$($g:tt)*] $t:ty, $view:ty, $member:ident) => {
        impl<$($g)*> $crate::bvh::RayQueryOn for $t {
            type Hit = <$view as $crate::bvh::RayQueryOn>::Hit;
            type Hits<M: $crate::machine::Machine> =
                <$view as $crate::bvh::RayQueryOn>::Hits<M>;

            fn inst_count(self) -> u32 {
                self.$member.inst_count()
            }

            #[inline(always)]
            fn named(self, name: &'static str) -> Self {
                Self { $member: $crate::bvh::RayQueryOn::named(self.$member, name), ..self }
            }

            fn resources(&self, visit: &mut dyn FnMut(&dyn $crate::machine::Resource)) {
                self.data(visit);
                $crate::bvh::RayQueryOn::resources(&self.$member, visit);
            }

            #[inline(always)]
            fn closest_hits<M: $crate::machine::Machine, const N: usize>(
                self,
                m: &M,
                rays: [$crate::geometry::RayOn<M>; N],
            ) -> [<Self::Hit as $crate::machine::Type>::On<M>; N] {
                $crate::bvh::RayQueryOn::closest_hits(self.$member, m, rays)
            }

            #[inline(always)]
            fn any_hits<M: $crate::machine::Machine, const N: usize>(
                self,
                m: &M,
                rays: [$crate::geometry::RayOn<M>; N],
            ) -> [$crate::machine::B<M>; N] {
                $crate::bvh::RayQueryOn::any_hits(self.$member, m, rays)
            }

            #[inline(always)]
            fn closest_hit_with_cost<M: $crate::machine::Machine>(
                self,
                m: &M,
                ray: $crate::geometry::RayOn<M>,
            ) -> (<Self::Hit as $crate::machine::Type>::On<M>, $crate::bvh::traverse::CostOn<M>) {
                $crate::bvh::RayQueryOn::closest_hit_with_cost(self.$member, m, ray)
            }

            #[inline(always)]
            fn closest_hit_where<M: $crate::machine::Machine>(
                self,
                m: &M,
                ray: $crate::geometry::RayOn<M>, accept: impl Fn(<Self::Hit as $crate::machine::Type>::On<M>) -> $crate::machine::B<M>,
            ) -> <Self::Hit as $crate::machine::Type>::On<M> {
                $crate::bvh::RayQueryOn::closest_hit_where(self.$member, m, ray, accept)
            }

            #[inline(always)]
            fn any_hit_where<M: $crate::machine::Machine>(
                self,
                m: &M,
                ray: $crate::geometry::RayOn<M>, accept: impl Fn(<Self::Hit as $crate::machine::Type>::On<M>) -> $crate::machine::B<M>,
            ) -> $crate::machine::B<M> {
                $crate::bvh::RayQueryOn::any_hit_where(self.$member, m, ray, accept)
            }

            #[inline(always)]
            fn multi_hit_where<M: $crate::machine::Machine, const N: usize>(
                self,
                m: &M,
                ray: $crate::geometry::RayOn<M>, accept: impl Fn(<Self::Hit as $crate::machine::Type>::On<M>) -> $crate::machine::B<M>,
            ) -> [<Self::Hit as $crate::machine::Type>::On<M>; N] {
                $crate::bvh::RayQueryOn::multi_hit_where(self.$member, m, ray, accept)
            }

            #[inline(always)]
            fn multi_hit_by<M: $crate::machine::Machine, const N: usize>(
                self,
                m: &M,
                ray: $crate::geometry::RayOn<M>, is_closer: impl Fn($crate::geometry::HitOn<M>, $crate::geometry::HitOn<M>) -> $crate::machine::B<M>,
            ) -> [<Self::Hit as $crate::machine::Type>::On<M>; N] {
                $crate::bvh::RayQueryOn::multi_hit_by(self.$member, m, ray, is_closer)
            }

            #[inline(always)]
            fn hits<M: $crate::machine::Machine>(
                self,
                m: &M,
                ray: $crate::geometry::RayOn<M>,
            ) -> Self::Hits<M> {
                $crate::bvh::RayQueryOn::hits(self.$member, m, ray)
            }

            #[inline(always)]
            fn to_object<M: $crate::machine::Machine>(
                self,
                m: &M,
                inst: $crate::machine::U<M>,
            ) -> $crate::machine::A3<M> {
                $crate::bvh::RayQueryOn::to_object(self.$member, m, inst)
            }

            #[inline(always)]
            fn local_ray<M: $crate::machine::Machine>(
                self,
                m: &M,
                ray: $crate::geometry::RayOn<M>, inst: $crate::machine::U<M>,
            ) -> $crate::geometry::RayOn<M> {
                $crate::bvh::RayQueryOn::local_ray(self.$member, m, ray, inst)
            }

            fn closest_hit_of(self, ray: $crate::geometry::Ray) -> Self::Hit {
                $crate::bvh::RayQueryOn::closest_hit_of(self.$member, ray)
            }

            fn any_hit_of(self, ray: $crate::geometry::Ray) -> bool {
                $crate::bvh::RayQueryOn::any_hit_of(self.$member, ray)
            }

            fn closest_hits_of(self, rays: &[$crate::geometry::Ray]) -> Vec<Self::Hit> {
                $crate::bvh::RayQueryOn::closest_hits_of(self.$member, rays)
            }

            fn any_hits_of(self, rays: &[$crate::geometry::Ray]) -> Vec<bool> {
                $crate::bvh::RayQueryOn::any_hits_of(self.$member, rays)
            }

            fn closest_hit_with_cost_of(self, ray: $crate::geometry::Ray) -> (Self::Hit, $crate::bvh::Cost) {
                $crate::bvh::RayQueryOn::closest_hit_with_cost_of(self.$member, ray)
            }

            fn any_hit_with_cost_of(self, ray: $crate::geometry::Ray) -> (bool, $crate::bvh::Cost) {
                $crate::bvh::RayQueryOn::any_hit_with_cost_of(self.$member, ray)
            }
        }

        impl<$($g)*> $crate::bvh::RayQuery for $t {
            type Hit = <$view as $crate::bvh::RayQueryOn>::Hit;
            type View<'v>
                = Self
            where
                Self: 'v;

            #[inline(always)]
            fn view(&self) -> Self {
                *self
            }
        }

        $crate::bvh::query_on::argument_itself!([$($g)*] $t);
        $crate::bvh::methods::queries!([$($g)*] $t, $t, |view| view);
    };
}

pub(crate) use carrier;
