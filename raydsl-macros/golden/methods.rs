impl Particle {
    pub fn moved(&self, by: Vec3) -> Self {
        Self {
            position: self.position + by,
            ..*self
        }
    }
    fn at_rest() -> Particle {
        Particle::new(0.0).moved(Vec3::ZERO)
    }
}
impl Particle
where
    for<'__t> Particle: ::raydsl::__private::Stated<'__t>,
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
    pub fn moved_on<__M: ::raydsl::__private::Machine>(
        __m: &__M,
        __this: impl ::raydsl::__private::Coerce<
            __M,
            <Particle as ::raydsl::__private::Type>::On<__M>,
        >,
        by: impl ::raydsl::__private::Coerce<
            __M,
            <Vec3 as ::raydsl::__private::Type>::On<__M>,
        >,
    ) -> <Particle as ::raydsl::__private::Type>::On<__M>
    where
        (): ::raydsl::__private::Coerce<__M, ()>,
        ((),): ::raydsl::__private::Coerce<__M, ((),)>,
    {
        use ::raydsl::__private::operations::*;
        static __INFO: ::raydsl::__private::KernelInfo = ::raydsl::__private::KernelInfo {
            name: "Particle_moved",
            file: ::core::file!(),
            line: ::core::line!(),
            params: &["self", "by"],
            known: ::core::option::Option::None,
        };
        ::raydsl::__private::Machine::call(
            __m,
            &__INFO,
            (
                ::raydsl::__private::Coerce::<
                    __M,
                    <Particle as ::raydsl::__private::Type>::On<__M>,
                >::coerce(__this, __m),
                ::raydsl::__private::Coerce::<
                    __M,
                    <Vec3 as ::raydsl::__private::Type>::On<__M>,
                >::coerce(by, __m),
            ),
            #[inline(always)]
            |
                __m: &__M,
                (
                    __this,
                    by,
                ): (
                    <Particle as ::raydsl::__private::Type>::On<__M>,
                    <Vec3 as ::raydsl::__private::Type>::On<__M>,
                )|
            {
                let __this = <Particle as ::raydsl::__private::KernelType>::same::<
                    __M,
                >(__this);
                ::raydsl::__private::Coerce::<
                    __M,
                    <Particle as ::raydsl::__private::Type>::On<__M>,
                >::coerce(
                    {
                        type __Twin<M__> = <Particle as ::raydsl::__private::Type>::On<
                            M__,
                        >;
                        __Twin::<__M> {
                            position: ::raydsl::__private::Coerce::coerce(
                                ::raydsl::__private::OpAdd::add(
                                    __m,
                                    { __this.position },
                                    { by },
                                ),
                                __m,
                            ),
                            ..__this
                        }
                    },
                    __m,
                )
            },
        )
    }
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
    fn at_rest_on<__M: ::raydsl::__private::Machine>(
        __m: &__M,
    ) -> <Particle as ::raydsl::__private::Type>::On<__M>
    where
        (): ::raydsl::__private::Coerce<__M, ()>,
        ((),): ::raydsl::__private::Coerce<__M, ((),)>,
    {
        use ::raydsl::__private::operations::*;
        static __INFO: ::raydsl::__private::KernelInfo = ::raydsl::__private::KernelInfo {
            name: "Particle_at_rest",
            file: ::core::file!(),
            line: ::core::line!(),
            params: &[],
            known: ::core::option::Option::None,
        };
        ::raydsl::__private::Machine::call(
            __m,
            &__INFO,
            (),
            #[inline(always)]
            |__m: &__M, (): ()| {
                let _ = <Particle as ::raydsl::__private::KernelType>::same::<__M>;
                ::raydsl::__private::Coerce::<
                    __M,
                    <Particle as ::raydsl::__private::Type>::On<__M>,
                >::coerce(
                    ::raydsl::__private::Method::<
                        { ::raydsl::__private::name("moved") },
                        __M,
                        _,
                        _,
                    >::call(
                        {
                            <Particle>::new_on(
                                __m,
                                ::raydsl::__private::literal(__m, 0.0f32, 0.0f64),
                            )
                        },
                        __m,
                        (
                            {
                                ::raydsl::__private::Capture::<
                                    __M,
                                >::constant(&Vec3::ZERO, __m)
                            },
                        ),
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
    __A0: ::raydsl::__private::Coerce<__M, <Vec3 as ::raydsl::__private::Type>::On<__M>>,
> ::raydsl::__private::HostMethod<
    { ::raydsl::__private::name("moved") },
    __M,
    (__A0,),
    (),
> for Particle
where
    for<'__t> Particle: ::raydsl::__private::Stated<'__t>,
{
    type This = <Self as ::raydsl::__private::Type>::On<__M>;
    type Output = <Particle as ::raydsl::__private::Type>::On<__M>;
    #[inline(always)]
    fn call(
        __this: <Self as ::raydsl::__private::Type>::On<__M>,
        __m: &__M,
        (by,): (__A0,),
    ) -> <Self as ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("moved") },
        __M,
        (__A0,),
        (),
    >>::Output {
        <Particle>::moved_on(__m, __this, by)
    }
}
