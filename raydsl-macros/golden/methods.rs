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
    Particle: ::raydsl::__private::Type,
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
        m: &__M,
        this: impl ::raydsl::__private::Coerce<
            __M,
            <Particle as ::raydsl::__private::Type>::On<__M>,
        >,
        by: impl ::raydsl::__private::Coerce<
            __M,
            <Vec3 as ::raydsl::__private::Type>::On<__M>,
        >,
    ) -> <Particle as ::raydsl::__private::Type>::On<__M> {
        use ::raydsl::__private::operations::*;
        static __INFO: ::raydsl::__private::KernelInfo = ::raydsl::__private::KernelInfo {
            name: "Particle_moved",
            file: ::core::file!(),
            line: ::core::line!(),
            params: &["self", "by"],
            known: ::core::option::Option::None,
        };
        ::raydsl::__private::Machine::call(
            m,
            &__INFO,
            (
                ::raydsl::__private::Coerce::<
                    __M,
                    <Particle as ::raydsl::__private::Type>::On<__M>,
                >::coerce(this, m),
                ::raydsl::__private::Coerce::<
                    __M,
                    <Vec3 as ::raydsl::__private::Type>::On<__M>,
                >::coerce(by, m),
            ),
            #[inline(always)]
            |
                m: &__M,
                (
                    this,
                    by,
                ): (
                    <Particle as ::raydsl::__private::Type>::On<__M>,
                    <Vec3 as ::raydsl::__private::Type>::On<__M>,
                )|
            {
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
                                    m,
                                    { this.position },
                                    { by },
                                ),
                                m,
                            ),
                            ..this
                        }
                    },
                    m,
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
        m: &__M,
    ) -> <Particle as ::raydsl::__private::Type>::On<__M> {
        use ::raydsl::__private::operations::*;
        static __INFO: ::raydsl::__private::KernelInfo = ::raydsl::__private::KernelInfo {
            name: "Particle_at_rest",
            file: ::core::file!(),
            line: ::core::line!(),
            params: &[],
            known: ::core::option::Option::None,
        };
        ::raydsl::__private::Machine::call(
            m,
            &__INFO,
            (),
            #[inline(always)]
            |m: &__M, (): ()| {
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
                                m,
                                ::raydsl::__private::literal(m, 0.0f32, 0.0f64),
                            )
                        },
                        m,
                        (
                            {
                                ::raydsl::__private::Capture::<
                                    __M,
                                >::constant(&Vec3::ZERO, m)
                            },
                        ),
                    ),
                    m,
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
    Particle: ::raydsl::__private::Type,
{
    type This = <Self as ::raydsl::__private::Type>::On<__M>;
    type Output = <Particle as ::raydsl::__private::Type>::On<__M>;
    #[inline(always)]
    fn call(
        this: <Self as ::raydsl::__private::Type>::On<__M>,
        m: &__M,
        (by,): (__A0,),
    ) -> <Self as ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("moved") },
        __M,
        (__A0,),
        (),
    >>::Output {
        <Particle>::moved_on(m, this, by)
    }
}
