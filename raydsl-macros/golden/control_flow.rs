fn walk(x: f32, n: u32) -> f32 {
    let mut sum = 0.0;
    'outer: for i in 0..n {
        while sum < x {
            sum += 1.0;
            if sum > 10.0 {
                break 'outer;
            } else if x < 0.0 && 1u32 / i > 0 {
                continue;
            }
            if i == 3 {
                return sum;
            }
            sum *= 2.0;
        }
    }
    let last;
    if sum > x {
        last = if x > 0.0 { x } else { -x };
    } else {
        last = 0.0;
    }
    sum + last
}
///The kernel of [`walk()`]: `Kernel::of::<walk>()`.
#[allow(non_camel_case_types, reason = "it has the name of the function")]
enum walk {}
impl walk {
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
            name: "walk",
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
                let __ret = ::raydsl::__private::Ret::<
                    <f32 as ::raydsl::__private::Type>::On<__M>,
                >::new(__m);
                'block_0: {
                    let sum = ::raydsl::__private::Var::new(
                        __m,
                        "sum",
                        ::raydsl::__private::Varying::varying(
                            ::raydsl::__private::literal(__m, 0.0f32, 0.0f64),
                            __m,
                        ),
                    );
                    {
                        let (__begin, __end) = ::raydsl::__private::range(
                            __m,
                            { 0 },
                            { n },
                        );
                        let __counter3 = ::raydsl::__private::Steps::new(
                            __m,
                            "i",
                            __begin,
                            0 as u32,
                        );
                        let __end = ::raydsl::__private::Stop::new(__m, __end);
                        let __repeat2 = ::raydsl::__private::Loop::new(__m);
                        loop {
                            if !__end.is_after(__m, &__repeat2, &__counter3) {
                                break;
                            }
                            ::raydsl::__private::here(
                                __m,
                                "loop",
                                ::core::file!(),
                                ::core::line!(),
                            );
                            let i = __counter3.get(__m);
                            {
                                let __repeat6 = ::raydsl::__private::Loop::new(__m);
                                loop {
                                    if !__repeat6
                                        .test(
                                            __m,
                                            ::raydsl::__private::OpCompare::compare(
                                                __m,
                                                ::raydsl::__private::op::Lt,
                                                { sum.get(__m) },
                                                { x },
                                            ),
                                        )
                                    {
                                        break;
                                    }
                                    ::raydsl::__private::here(
                                        __m,
                                        "loop",
                                        ::core::file!(),
                                        ::core::line!(),
                                    );
                                    'block_6: {
                                        {
                                            let __right = ::raydsl::__private::literal(
                                                __m,
                                                1.0f32,
                                                1.0f64,
                                            );
                                            sum.set(
                                                __m,
                                                ::raydsl::__private::Assigned::<
                                                    { ::raydsl::__private::name("+=") },
                                                    _,
                                                    _,
                                                    _,
                                                >::assigned(__m, sum.get(__m), __right),
                                            );
                                        }
                                        let __branch8 = ::raydsl::__private::Branch::new(
                                            __m,
                                            ::raydsl::__private::OpCompare::compare(
                                                __m,
                                                ::raydsl::__private::op::Gt,
                                                { sum.get(__m) },
                                                { ::raydsl::__private::literal(__m, 10.0f32, 10.0f64) },
                                            ),
                                        );
                                        if __branch8.then_small(__m) {
                                            ::raydsl::__private::here(
                                                __m,
                                                "if",
                                                ::core::file!(),
                                                ::core::line!(),
                                            );
                                            {
                                                __repeat2.leave(__m);
                                            }
                                        }
                                        if __branch8.otherwise(__m) {
                                            ::raydsl::__private::here(
                                                __m,
                                                "else",
                                                ::core::file!(),
                                                ::core::line!(),
                                            );
                                            let __branch10 = ::raydsl::__private::Branch::new(
                                                __m,
                                                {
                                                    let __value11 = ::raydsl::__private::Var::<
                                                        _,
                                                    >::declare(__m, "both");
                                                    let __branch12 = ::raydsl::__private::Branch::new(
                                                        __m,
                                                        ::raydsl::__private::OpCompare::compare(
                                                            __m,
                                                            ::raydsl::__private::op::Lt,
                                                            { x },
                                                            { ::raydsl::__private::literal(__m, 0.0f32, 0.0f64) },
                                                        ),
                                                    );
                                                    if __branch12.then(__m) {
                                                        ::raydsl::__private::here(
                                                            __m,
                                                            "if",
                                                            ::core::file!(),
                                                            ::core::line!(),
                                                        );
                                                        {
                                                            __value11
                                                                .set(
                                                                    __m,
                                                                    ::raydsl::__private::Varying::varying(
                                                                        ::raydsl::__private::OpCompare::compare(
                                                                            __m,
                                                                            ::raydsl::__private::op::Gt,
                                                                            {
                                                                                ::raydsl::__private::OpDiv::div(
                                                                                    __m,
                                                                                    { ::raydsl::__private::u32(__m, 1u32) },
                                                                                    { i },
                                                                                )
                                                                            },
                                                                            { 0 },
                                                                        ),
                                                                        __m,
                                                                    ),
                                                                );
                                                        }
                                                    }
                                                    if __branch12.otherwise_small(__m) {
                                                        ::raydsl::__private::here(
                                                            __m,
                                                            "else",
                                                            ::core::file!(),
                                                            ::core::line!(),
                                                        );
                                                        {
                                                            __value11
                                                                .set(
                                                                    __m,
                                                                    ::raydsl::__private::Varying::varying(false, __m),
                                                                );
                                                        }
                                                    }
                                                    __branch12.end(__m);
                                                    __value11.get(__m)
                                                },
                                            );
                                            if __branch10.then_small(__m) {
                                                ::raydsl::__private::here(
                                                    __m,
                                                    "if",
                                                    ::core::file!(),
                                                    ::core::line!(),
                                                );
                                                {
                                                    __repeat6.skip(__m);
                                                }
                                            }
                                            __branch10.end(__m);
                                        }
                                        __branch8.end(__m);
                                        if !::raydsl::__private::Machine::alive(__m) {
                                            break 'block_6;
                                        }
                                        let __branch16 = ::raydsl::__private::Branch::new(
                                            __m,
                                            ::raydsl::__private::OpCompare::compare(
                                                __m,
                                                ::raydsl::__private::op::Eq,
                                                { i },
                                                { 3 },
                                            ),
                                        );
                                        if __branch16.then_small(__m) {
                                            ::raydsl::__private::here(
                                                __m,
                                                "if",
                                                ::core::file!(),
                                                ::core::line!(),
                                            );
                                            {
                                                __ret
                                                    .give(
                                                        __m,
                                                        ::raydsl::__private::Coerce::coerce(sum.get(__m), __m),
                                                    );
                                            }
                                        }
                                        __branch16.end(__m);
                                        if !::raydsl::__private::Machine::alive(__m) {
                                            break 'block_6;
                                        }
                                        {
                                            let __right = ::raydsl::__private::literal(
                                                __m,
                                                2.0f32,
                                                2.0f64,
                                            );
                                            sum.set(
                                                __m,
                                                ::raydsl::__private::Assigned::<
                                                    { ::raydsl::__private::name("*=") },
                                                    _,
                                                    _,
                                                    _,
                                                >::assigned(__m, sum.get(__m), __right),
                                            );
                                        }
                                    }
                                    __repeat6.continuing(__m);
                                    if !__repeat6.again(__m) {
                                        break;
                                    }
                                }
                                __repeat6.end(__m);
                            }
                            __repeat2.continuing(__m);
                            __counter3.advance(__m);
                            if !__repeat2.again(__m) {
                                break;
                            }
                        }
                        __repeat2.end(__m);
                    }
                    if !::raydsl::__private::Machine::alive(__m) {
                        break 'block_0;
                    }
                    let last = ::raydsl::__private::Var::<_>::declare(__m, "last");
                    let __branch18 = ::raydsl::__private::Branch::new(
                        __m,
                        ::raydsl::__private::OpCompare::compare(
                            __m,
                            ::raydsl::__private::op::Gt,
                            { sum.get(__m) },
                            { x },
                        ),
                    );
                    if __branch18.then_small(__m) {
                        ::raydsl::__private::here(
                            __m,
                            "if",
                            ::core::file!(),
                            ::core::line!(),
                        );
                        {
                            {
                                let __right = ::raydsl::__private::choose::<
                                    _,
                                    _,
                                    _,
                                >(
                                    __m,
                                    "value",
                                    false,
                                    ::raydsl::__private::OpCompare::compare(
                                        __m,
                                        ::raydsl::__private::op::Gt,
                                        { x },
                                        { ::raydsl::__private::literal(__m, 0.0f32, 0.0f64) },
                                    ),
                                    #[inline(always)]
                                    || {
                                        let _ = &x;
                                        ::raydsl::__private::Varying::varying(x, __m)
                                    },
                                    #[inline(always)]
                                    || {
                                        let _ = &x;
                                        ::raydsl::__private::Varying::varying(
                                            ::raydsl::__private::OpNeg::neg(__m, x),
                                            __m,
                                        )
                                    },
                                );
                                last.set(
                                    __m,
                                    ::raydsl::__private::Coerce::coerce(__right, __m),
                                );
                            }
                        }
                    }
                    if __branch18.otherwise_small(__m) {
                        ::raydsl::__private::here(
                            __m,
                            "else",
                            ::core::file!(),
                            ::core::line!(),
                        );
                        {
                            {
                                let __right = ::raydsl::__private::literal(
                                    __m,
                                    0.0f32,
                                    0.0f64,
                                );
                                last.set(
                                    __m,
                                    ::raydsl::__private::Coerce::coerce(__right, __m),
                                );
                            }
                        }
                    }
                    __branch18.end(__m);
                    __ret
                        .give(
                            __m,
                            ::raydsl::__private::Coerce::coerce(
                                ::raydsl::__private::OpAdd::add(
                                    __m,
                                    { sum.get(__m) },
                                    { last.get(__m) },
                                ),
                                __m,
                            ),
                        );
                }
                __ret.take()
            },
        )
    }
}
#[diagnostic::do_not_recommend]
impl ::raydsl::__private::KernelFn for walk {
    type Args = (f32, u32);
    type Output = f32;
    fn info() -> &'static ::raydsl::__private::KernelInfo {
        static __INFO: ::raydsl::__private::KernelInfo = ::raydsl::__private::KernelInfo {
            name: "walk",
            file: ::core::file!(),
            line: ::core::line!(),
            params: &["x", "n"],
            known: ::core::option::Option::None,
        };
        &__INFO
    }
    #[inline]
    fn scalar(args: Self::Args) -> f32 {
        walk(args.0, args.1)
    }
    #[inline(always)]
    fn lifted<__M: ::raydsl::__private::Machine>(
        m: &__M,
        args: <Self::Args as ::raydsl::__private::Type>::On<__M>,
    ) -> <f32 as ::raydsl::__private::Type>::On<__M> {
        Self::on(m, args.0, args.1)
    }
}
