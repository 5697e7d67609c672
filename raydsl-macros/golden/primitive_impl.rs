impl ColorSphere {
    const SLACK: f32 = sphere::SLACK;
    fn intersect(&self, ray: Ray) -> Hit {
        sphere::intersect(ray, self.center, self.radius.to_f32())
    }
    fn get_bounds(&self) -> Aabb {
        Aabb::from_sphere(self.center, self.radius.to_f32())
    }
}
impl ColorSphere
where
    for<'__t> ColorSphere: ::raydsl::__private::Stated<'__t>,
{
    #[doc(hidden)]
    #[inline(always)]
    #[allow(
        unused,
        clippy::all,
        clippy::pedantic,
        clippy::nursery,
        non_snake_case,
        reason = "generated code"
    )]
    fn intersect_on<__M: ::raydsl::__private::Machine>(
        __m: &__M,
        __this: impl ::raydsl::__private::Coerce<
            __M,
            <ColorSphere as ::raydsl::__private::Type>::On<__M>,
        >,
        ray: impl ::raydsl::__private::Coerce<
            __M,
            <Ray as ::raydsl::__private::Type>::On<__M>,
        >,
    ) -> <Hit as ::raydsl::__private::Type>::On<__M>
    where
        (): ::raydsl::__private::Coerce<__M, ()>,
        ((),): ::raydsl::__private::Coerce<__M, ((),)>,
    {
        use ::raydsl::__private::operations::*;
        static __INFO: ::raydsl::__private::KernelInfo = ::raydsl::__private::KernelInfo {
            name: "ColorSphere_intersect",
            file: ::core::file!(),
            line: ::core::line!(),
            params: &["self", "ray"],
            known: ::core::option::Option::None,
        };
        ::raydsl::__private::Machine::call(
            __m,
            &__INFO,
            (
                ::raydsl::__private::Coerce::<
                    __M,
                    <ColorSphere as ::raydsl::__private::Type>::On<__M>,
                >::coerce(__this, __m),
                ::raydsl::__private::Coerce::<
                    __M,
                    <Ray as ::raydsl::__private::Type>::On<__M>,
                >::coerce(ray, __m),
            ),
            #[inline(always)]
            |
                __m: &__M,
                (
                    __this,
                    ray,
                ): (
                    <ColorSphere as ::raydsl::__private::Type>::On<__M>,
                    <Ray as ::raydsl::__private::Type>::On<__M>,
                )|
            {
                let __this = <ColorSphere as ::raydsl::__private::KernelType>::same::<
                    __M,
                >(__this);
                ::raydsl::__private::Coerce::<
                    __M,
                    <Hit as ::raydsl::__private::Type>::On<__M>,
                >::coerce(
                    sphere::intersect::on(
                        __m,
                        ray,
                        __this.center,
                        ::raydsl::__private::Method::<
                            { ::raydsl::__private::name("to_f32") },
                            __M,
                            _,
                            _,
                        >::call({ __this.radius }, __m, ()),
                    ),
                    __m,
                )
            },
        )
    }
}
#[allow(
    unused,
    clippy::all,
    clippy::pedantic,
    clippy::nursery,
    non_snake_case,
    reason = "generated code"
)]
#[diagnostic::do_not_recommend]
impl<
    __M: ::raydsl::__private::Machine,
    __A0: ::raydsl::__private::Coerce<__M, <Ray as ::raydsl::__private::Type>::On<__M>>,
> ::raydsl::__private::HostMethod<
    { ::raydsl::__private::name("intersect") },
    __M,
    (__A0,),
    (),
> for ColorSphere
where
    for<'__t> ColorSphere: ::raydsl::__private::Stated<'__t>,
{
    type This = <Self as ::raydsl::__private::Type>::On<__M>;
    type Output = <Hit as ::raydsl::__private::Type>::On<__M>;
    #[inline(always)]
    fn call(
        __this: <Self as ::raydsl::__private::Type>::On<__M>,
        __m: &__M,
        (ray,): (__A0,),
    ) -> <Self as ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("intersect") },
        __M,
        (__A0,),
        (),
    >>::Output {
        <ColorSphere>::intersect_on(__m, __this, ray)
    }
}
impl ::raydsl::__private::Primitive for ColorSphere {
    type Hit = Hit;
    type Shared = ();
    type SharedOr<__T: ::raydsl::__private::Shared> = __T;
    #[inline(always)]
    fn map_shared<
        '__a,
        __T: ::raydsl::__private::Shared,
        __U: ::raydsl::__private::Shared,
    >(
        all: <__T as ::raydsl::__private::Shared>::Views<'__a>,
        other: impl FnOnce(__T::Views<'__a>) -> __U::Views<'__a>,
    ) -> <__U as ::raydsl::__private::Shared>::Views<'__a> {
        other(all)
    }
    const SLACK: f32 = <ColorSphere>::SLACK;
    #[inline(always)]
    fn intersect(
        &self,
        ray: ::raydsl::__private::Ray,
        shared: <() as ::raydsl::__private::Shared>::Slices<'_>,
    ) -> Hit {
        <ColorSphere>::intersect(self, ray)
    }
    fn get_bounds(
        &self,
        shared: <() as ::raydsl::__private::Shared>::Slices<'_>,
    ) -> ::raydsl::__private::Aabb {
        <ColorSphere>::get_bounds(self)
    }
    #[inline(always)]
    fn intersect_on<__M: ::raydsl::__private::Machine>(
        m: &__M,
        prim: <Self as ::raydsl::__private::Type>::On<__M>,
        ray: ::raydsl::__private::RayOn<__M>,
        shared: <() as ::raydsl::__private::Shared>::Views<'_>,
    ) -> <Hit as ::raydsl::__private::Type>::On<__M> {
        <ColorSphere>::intersect_on(m, prim, ray)
    }
}
