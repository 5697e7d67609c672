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
        m: &__M,
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
            m,
            &__INFO,
            (
                ::raydsl::__private::Coerce::<
                    __M,
                    <f32 as ::raydsl::__private::Type>::On<__M>,
                >::coerce(x, m),
                ::raydsl::__private::Coerce::<
                    __M,
                    <u32 as ::raydsl::__private::Type>::On<__M>,
                >::coerce(n, m),
            ),
            #[inline(always)]
            |
                m: &__M,
                (
                    x,
                    n,
                ): (
                    <f32 as ::raydsl::__private::Type>::On<__M>,
                    <u32 as ::raydsl::__private::Type>::On<__M>,
                )|
            {
                let ret = ::raydsl::__private::Ret::<
                    <f32 as ::raydsl::__private::Type>::On<__M>,
                >::new(m);
                'block_0: {
                    let sum = ::raydsl::__private::Var::new(
                        m,
                        "sum",
                        ::raydsl::__private::Varying::varying(
                            ::raydsl::__private::literal(m, 0.0f32, 0.0f64),
                            m,
                        ),
                    );
                    {
                        let (begin, end) = ::raydsl::__private::range(m, { 0 }, { n });
                        let counter_3 = ::raydsl::__private::Steps::new(
                            m,
                            "i",
                            begin,
                            0 as u32,
                        );
                        let end = ::raydsl::__private::Stop::new(m, end);
                        let repeat_2 = ::raydsl::__private::Loop::new(m);
                        loop {
                            if !end.is_after(m, &repeat_2, &counter_3) {
                                break;
                            }
                            ::raydsl::__private::here(
                                m,
                                "loop",
                                ::core::file!(),
                                ::core::line!(),
                            );
                            let i = counter_3.get(m);
                            {
                                let repeat_6 = ::raydsl::__private::Loop::new(m);
                                loop {
                                    if !repeat_6
                                        .test(
                                            m,
                                            ::raydsl::__private::OpCompare::compare(
                                                m,
                                                ::raydsl::__private::op::Lt,
                                                { sum.get(m) },
                                                { x },
                                            ),
                                        )
                                    {
                                        break;
                                    }
                                    ::raydsl::__private::here(
                                        m,
                                        "loop",
                                        ::core::file!(),
                                        ::core::line!(),
                                    );
                                    'block_6: {
                                        {
                                            let right = ::raydsl::__private::literal(m, 1.0f32, 1.0f64);
                                            sum.set(
                                                m,
                                                ::raydsl::__private::Assigned::<
                                                    { ::raydsl::__private::name("+=") },
                                                    _,
                                                    _,
                                                    _,
                                                >::assigned(m, sum.get(m), right),
                                            );
                                        }
                                        let branch_8 = ::raydsl::__private::Branch::new(
                                            m,
                                            ::raydsl::__private::OpCompare::compare(
                                                m,
                                                ::raydsl::__private::op::Gt,
                                                { sum.get(m) },
                                                { ::raydsl::__private::literal(m, 10.0f32, 10.0f64) },
                                            ),
                                        );
                                        if branch_8.then_small(m) {
                                            ::raydsl::__private::here(
                                                m,
                                                "if",
                                                ::core::file!(),
                                                ::core::line!(),
                                            );
                                            {
                                                repeat_2.leave(m);
                                            }
                                        }
                                        if branch_8.otherwise(m) {
                                            ::raydsl::__private::here(
                                                m,
                                                "else",
                                                ::core::file!(),
                                                ::core::line!(),
                                            );
                                            let branch_10 = ::raydsl::__private::Branch::new(
                                                m,
                                                {
                                                    let value_11 = ::raydsl::__private::Var::<
                                                        _,
                                                    >::declare(m, "both");
                                                    let branch_12 = ::raydsl::__private::Branch::new(
                                                        m,
                                                        ::raydsl::__private::OpCompare::compare(
                                                            m,
                                                            ::raydsl::__private::op::Lt,
                                                            { x },
                                                            { ::raydsl::__private::literal(m, 0.0f32, 0.0f64) },
                                                        ),
                                                    );
                                                    if branch_12.then(m) {
                                                        ::raydsl::__private::here(
                                                            m,
                                                            "if",
                                                            ::core::file!(),
                                                            ::core::line!(),
                                                        );
                                                        {
                                                            value_11
                                                                .set(
                                                                    m,
                                                                    ::raydsl::__private::Varying::varying(
                                                                        ::raydsl::__private::OpCompare::compare(
                                                                            m,
                                                                            ::raydsl::__private::op::Gt,
                                                                            {
                                                                                ::raydsl::__private::OpDiv::div(
                                                                                    m,
                                                                                    { ::raydsl::__private::u32(m, 1u32) },
                                                                                    { i },
                                                                                )
                                                                            },
                                                                            { 0 },
                                                                        ),
                                                                        m,
                                                                    ),
                                                                );
                                                        }
                                                    }
                                                    if branch_12.otherwise_small(m) {
                                                        ::raydsl::__private::here(
                                                            m,
                                                            "else",
                                                            ::core::file!(),
                                                            ::core::line!(),
                                                        );
                                                        {
                                                            value_11
                                                                .set(m, ::raydsl::__private::Varying::varying(false, m));
                                                        }
                                                    }
                                                    branch_12.end(m);
                                                    value_11.get(m)
                                                },
                                            );
                                            if branch_10.then_small(m) {
                                                ::raydsl::__private::here(
                                                    m,
                                                    "if",
                                                    ::core::file!(),
                                                    ::core::line!(),
                                                );
                                                {
                                                    repeat_6.skip(m);
                                                }
                                            }
                                            branch_10.end(m);
                                        }
                                        branch_8.end(m);
                                        if !::raydsl::__private::Machine::alive(m) {
                                            break 'block_6;
                                        }
                                        let branch_16 = ::raydsl::__private::Branch::new(
                                            m,
                                            ::raydsl::__private::OpCompare::compare(
                                                m,
                                                ::raydsl::__private::op::Eq,
                                                { i },
                                                { 3 },
                                            ),
                                        );
                                        if branch_16.then_small(m) {
                                            ::raydsl::__private::here(
                                                m,
                                                "if",
                                                ::core::file!(),
                                                ::core::line!(),
                                            );
                                            {
                                                ret.give(
                                                    m,
                                                    ::raydsl::__private::Coerce::coerce(sum.get(m), m),
                                                );
                                            }
                                        }
                                        branch_16.end(m);
                                        if !::raydsl::__private::Machine::alive(m) {
                                            break 'block_6;
                                        }
                                        {
                                            let right = ::raydsl::__private::literal(m, 2.0f32, 2.0f64);
                                            sum.set(
                                                m,
                                                ::raydsl::__private::Assigned::<
                                                    { ::raydsl::__private::name("*=") },
                                                    _,
                                                    _,
                                                    _,
                                                >::assigned(m, sum.get(m), right),
                                            );
                                        }
                                    }
                                    repeat_6.continuing(m);
                                    if !repeat_6.again(m) {
                                        break;
                                    }
                                }
                                repeat_6.end(m);
                            }
                            repeat_2.continuing(m);
                            counter_3.advance(m);
                            if !repeat_2.again(m) {
                                break;
                            }
                        }
                        repeat_2.end(m);
                    }
                    if !::raydsl::__private::Machine::alive(m) {
                        break 'block_0;
                    }
                    let last = ::raydsl::__private::Var::<_>::declare(m, "last");
                    let branch_18 = ::raydsl::__private::Branch::new(
                        m,
                        ::raydsl::__private::OpCompare::compare(
                            m,
                            ::raydsl::__private::op::Gt,
                            { sum.get(m) },
                            { x },
                        ),
                    );
                    if branch_18.then_small(m) {
                        ::raydsl::__private::here(
                            m,
                            "if",
                            ::core::file!(),
                            ::core::line!(),
                        );
                        {
                            {
                                let right = ::raydsl::__private::choose::<
                                    _,
                                    _,
                                    _,
                                >(
                                    m,
                                    "value",
                                    false,
                                    ::raydsl::__private::OpCompare::compare(
                                        m,
                                        ::raydsl::__private::op::Gt,
                                        { x },
                                        { ::raydsl::__private::literal(m, 0.0f32, 0.0f64) },
                                    ),
                                    #[inline(always)]
                                    || {
                                        let _ = &x;
                                        ::raydsl::__private::Varying::varying(x, m)
                                    },
                                    #[inline(always)]
                                    || {
                                        let _ = &x;
                                        ::raydsl::__private::Varying::varying(
                                            ::raydsl::__private::OpNeg::neg(m, x),
                                            m,
                                        )
                                    },
                                );
                                last.set(m, ::raydsl::__private::Coerce::coerce(right, m));
                            }
                        }
                    }
                    if branch_18.otherwise_small(m) {
                        ::raydsl::__private::here(
                            m,
                            "else",
                            ::core::file!(),
                            ::core::line!(),
                        );
                        {
                            {
                                let right = ::raydsl::__private::literal(m, 0.0f32, 0.0f64);
                                last.set(m, ::raydsl::__private::Coerce::coerce(right, m));
                            }
                        }
                    }
                    branch_18.end(m);
                    ret.give(
                        m,
                        ::raydsl::__private::Coerce::coerce(
                            ::raydsl::__private::OpAdd::add(
                                m,
                                { sum.get(m) },
                                { last.get(m) },
                            ),
                            m,
                        ),
                    );
                }
                ret.take()
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
