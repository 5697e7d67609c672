fn push(p: &Particle, mut by: Vec3) -> Particle {
    let mut q = *p;
    by.x = -by.x;
    q.position.y += by.y;
    q = Particle { mass: 1.0, ..q };
    q
}
///The kernel of [`push()`]: `Kernel::of::<push>()`.
#[allow(non_camel_case_types, reason = "it has the name of the function")]
enum push {}
impl push {
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
    pub(self) fn on<__M: ::raydsl::__private::Machine>(
        __m: &__M,
        p: impl ::raydsl::__private::Coerce<
            __M,
            <Particle as ::raydsl::__private::Type>::On<__M>,
        >,
        by: impl ::raydsl::__private::Coerce<
            __M,
            <Vec3 as ::raydsl::__private::Type>::On<__M>,
        >,
    ) -> <Particle as ::raydsl::__private::Type>::On<__M>
    where
        for<'__t> Particle: ::raydsl::__private::Stated<'__t>,
        (): ::raydsl::__private::Coerce<__M, ()>,
        ((),): ::raydsl::__private::Coerce<__M, ((),)>,
    {
        use ::raydsl::__private::operations::*;
        static __INFO: ::raydsl::__private::KernelInfo = ::raydsl::__private::KernelInfo {
            name: "push",
            file: ::core::file!(),
            line: ::core::line!(),
            params: &["p", "by"],
            known: ::core::option::Option::None,
        };
        ::raydsl::__private::Machine::call(
            __m,
            &__INFO,
            (
                ::raydsl::__private::Coerce::<
                    __M,
                    <Particle as ::raydsl::__private::Type>::On<__M>,
                >::coerce(p, __m),
                ::raydsl::__private::Coerce::<
                    __M,
                    <Vec3 as ::raydsl::__private::Type>::On<__M>,
                >::coerce(by, __m),
            ),
            #[inline(always)]
            |
                __m: &__M,
                (
                    p,
                    by,
                ): (
                    <Particle as ::raydsl::__private::Type>::On<__M>,
                    <Vec3 as ::raydsl::__private::Type>::On<__M>,
                )|
            {
                let p = <Particle as ::raydsl::__private::KernelType>::same::<__M>(p);
                let by = ::raydsl::__private::Var::new(__m, "by", by);
                let q = ::raydsl::__private::Var::new(
                    __m,
                    "q",
                    ::raydsl::__private::Varying::varying(p, __m),
                );
                {
                    let __right = ::raydsl::__private::OpNeg::neg(__m, by.get(__m).x);
                    let mut __whole = by.get(__m);
                    __whole.x = ::raydsl::__private::Coerce::coerce(__right, __m);
                    by.set(__m, __whole);
                }
                {
                    let __right = by.get(__m).y;
                    let mut __whole = q.get(__m);
                    __whole.position.y = ::raydsl::__private::Assigned::<
                        { ::raydsl::__private::name("+=") },
                        _,
                        _,
                        _,
                    >::assigned(__m, __whole.position.y, __right);
                    q.set(__m, __whole);
                }
                {
                    let __right = {
                        type __Twin<M__> = <Particle as ::raydsl::__private::Type>::On<
                            M__,
                        >;
                        __Twin::<__M> {
                            mass: ::raydsl::__private::Coerce::coerce(
                                ::raydsl::__private::literal(__m, 1.0f32, 1.0f64),
                                __m,
                            ),
                            ..q.get(__m)
                        }
                    };
                    q.set(__m, ::raydsl::__private::Coerce::coerce(__right, __m));
                }
                ::raydsl::__private::Coerce::<
                    __M,
                    <Particle as ::raydsl::__private::Type>::On<__M>,
                >::coerce(q.get(__m), __m)
            },
        )
    }
}
#[diagnostic::do_not_recommend]
impl ::raydsl::__private::KernelFn for push
where
    for<'__t> Particle: ::raydsl::__private::Stated<'__t>,
{
    type Args = (Particle, Vec3);
    type Output = Particle;
    fn info() -> &'static ::raydsl::__private::KernelInfo {
        static __INFO: ::raydsl::__private::KernelInfo = ::raydsl::__private::KernelInfo {
            name: "push",
            file: ::core::file!(),
            line: ::core::line!(),
            params: &["p", "by"],
            known: ::core::option::Option::None,
        };
        &__INFO
    }
    #[inline]
    fn scalar(args: Self::Args) -> Particle {
        push(&args.0, args.1)
    }
    #[inline(always)]
    fn lifted<__M: ::raydsl::__private::Machine>(
        m: &__M,
        args: <Self::Args as ::raydsl::__private::Type>::On<__M>,
    ) -> <Particle as ::raydsl::__private::Type>::On<__M> {
        Self::on(m, args.0, args.1)
    }
}
