/// Documented.
pub fn smooth(x: f32, n: u32) -> f32 {
    let t = clamp(x, 0.0, 1.0);
    t * t * (3.0 - 2.0 * t) + n as f32
}
///The kernel of [`smooth()`]: `Kernel::of::<smooth>()`.
#[allow(non_camel_case_types, reason = "it has the name of the function")]
pub enum smooth {}
impl smooth {
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
    pub fn on<__M: ::raydsl::__private::Machine>(
        __m: &__M,
        x: impl ::raydsl::__private::Coerce<
            __M,
            <f32 as ::raydsl::__private::Type>::On<__M>,
        >,
        n: impl ::raydsl::__private::Coerce<
            __M,
            <u32 as ::raydsl::__private::Type>::On<__M>,
        >,
    ) -> <f32 as ::raydsl::__private::Type>::On<__M> {
        use ::raydsl::__private::operations::*;
        static __INFO: ::raydsl::__private::KernelInfo = ::raydsl::__private::KernelInfo {
            name: "smooth",
            file: ::core::file!(),
            line: ::core::line!(),
            params: &["x", "n"],
            known: ::core::option::Option::None,
        };
        ::raydsl::__private::Machine::call(
            __m,
            &__INFO,
            (
                ::raydsl::__private::Coerce::<
                    __M,
                    <f32 as ::raydsl::__private::Type>::On<__M>,
                >::coerce(x, __m),
                ::raydsl::__private::Coerce::<
                    __M,
                    <u32 as ::raydsl::__private::Type>::On<__M>,
                >::coerce(n, __m),
            ),
            #[inline(always)]
            |
                __m: &__M,
                (
                    x,
                    n,
                ): (
                    <f32 as ::raydsl::__private::Type>::On<__M>,
                    <u32 as ::raydsl::__private::Type>::On<__M>,
                )|
            {
                let t = ::raydsl::__private::Machine::named(
                    __m,
                    "t",
                    clamp::on(
                        __m,
                        x,
                        ::raydsl::__private::literal(__m, 0.0f32, 0.0f64),
                        ::raydsl::__private::literal(__m, 1.0f32, 1.0f64),
                    ),
                );
                ::raydsl::__private::Coerce::<
                    __M,
                    <f32 as ::raydsl::__private::Type>::On<__M>,
                >::coerce(
                    ::raydsl::__private::OpAdd::add(
                        __m,
                        {
                            ::raydsl::__private::OpMul::mul(
                                __m,
                                { ::raydsl::__private::OpMul::mul(__m, { t }, { t }) },
                                {
                                    ::raydsl::__private::OpSub::sub(
                                        __m,
                                        { ::raydsl::__private::literal(__m, 3.0f32, 3.0f64) },
                                        {
                                            ::raydsl::__private::OpMul::mul(
                                                __m,
                                                { ::raydsl::__private::literal(__m, 2.0f32, 2.0f64) },
                                                { t },
                                            )
                                        },
                                    )
                                },
                            )
                        },
                        { ::raydsl::__private::cast::<_, _, f32>(__m, n) },
                    ),
                    __m,
                )
            },
        )
    }
}
#[diagnostic::do_not_recommend]
impl ::raydsl::__private::KernelFn for smooth {
    type Args = (f32, u32);
    type Output = f32;
    fn info() -> &'static ::raydsl::__private::KernelInfo {
        static __INFO: ::raydsl::__private::KernelInfo = ::raydsl::__private::KernelInfo {
            name: "smooth",
            file: ::core::file!(),
            line: ::core::line!(),
            params: &["x", "n"],
            known: ::core::option::Option::None,
        };
        &__INFO
    }
    #[inline]
    fn scalar(args: Self::Args) -> f32 {
        smooth(args.0, args.1)
    }
    #[inline(always)]
    fn lifted<__M: ::raydsl::__private::Machine>(
        m: &__M,
        args: <Self::Args as ::raydsl::__private::Type>::On<__M>,
    ) -> <f32 as ::raydsl::__private::Type>::On<__M> {
        Self::on(m, args.0, args.1)
    }
}
