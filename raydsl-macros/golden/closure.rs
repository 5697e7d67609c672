fn main() {
    {
        static __INFO: ::raydsl::__private::KernelInfo = ::raydsl::__private::KernelInfo {
            name: "kernel",
            file: ::core::file!(),
            line: ::core::line!(),
            params: &["ray"],
            known: ::core::option::Option::None,
        };
        const _: ::core::option::Option<&str> = ::core::option_env!("RAYDSL_VARIANTS");
        let __scalar = |ray: Ray| {
            let hit = bvh.closest_hit(ray);
            if hit.is_hit { bvh.primitive(hit).rgb() } else { background }
        };
        let __scalar = ::raydsl::__private::Kernel::scalar(
            &__INFO,
            move |(ray,): (Ray,)| __scalar(ray),
        );
        let __captures = (&bvh, &background);
        #[allow(
            unused,
            clippy::all,
            clippy::pedantic,
            clippy::nursery,
            non_snake_case,
            reason = "generated code"
        )]
        let __native4 = move |
            __m: &_,
            (ray,): (<Ray as ::raydsl::__private::Type>::On<_>,)|
        {
            use ::raydsl::__private::operations::*;
            ::raydsl::__private::Machine::call(
                __m,
                &__INFO,
                (ray,),
                #[inline(always)]
                |__m: &_, (ray,): (<Ray as ::raydsl::__private::Type>::On<_>,)| {
                    let bvh = ::raydsl::__private::Capture::<
                        _,
                    >::capture({ __captures.0 }, __m, "bvh");
                    let background = ::raydsl::__private::Capture::<
                        _,
                    >::capture({ __captures.1 }, __m, "background");
                    let hit = ::raydsl::__private::Machine::named(
                        __m,
                        "hit",
                        ::raydsl::__private::Method::<
                            { ::raydsl::__private::name("closest_hit") },
                            _,
                            _,
                            _,
                        >::call({ bvh }, __m, ({ ray },)),
                    );
                    {
                        let __value1 = ::raydsl::__private::Var::<
                            _,
                        >::declare(__m, "result");
                        let __branch2 = ::raydsl::__private::Branch::new(
                            __m,
                            hit.is_hit,
                        );
                        if __branch2.then(__m) {
                            ::raydsl::__private::here(
                                __m,
                                "if",
                                ::core::file!(),
                                ::core::line!(),
                            );
                            {
                                __value1
                                    .set(
                                        __m,
                                        ::raydsl::__private::Varying::varying(
                                            ::raydsl::__private::Method::<
                                                { ::raydsl::__private::name("rgb") },
                                                _,
                                                _,
                                                _,
                                            >::call(
                                                {
                                                    ::raydsl::__private::Method::<
                                                        { ::raydsl::__private::name("primitive") },
                                                        _,
                                                        _,
                                                        _,
                                                    >::call({ bvh }, __m, ({ hit },))
                                                },
                                                __m,
                                                (),
                                            ),
                                            __m,
                                        ),
                                    );
                            }
                        }
                        if __branch2.otherwise_small(__m) {
                            ::raydsl::__private::here(
                                __m,
                                "else",
                                ::core::file!(),
                                ::core::line!(),
                            );
                            {
                                __value1
                                    .set(
                                        __m,
                                        ::raydsl::__private::Varying::varying(background, __m),
                                    );
                            }
                        }
                        __branch2.end(__m);
                        __value1.get(__m)
                    }
                },
            )
        };
        #[allow(
            unused,
            clippy::all,
            clippy::pedantic,
            clippy::nursery,
            non_snake_case,
            reason = "generated code"
        )]
        let __native8 = move |
            __m: &::raydsl::__private::Native8,
            (
                ray,
            ): (<Ray as ::raydsl::__private::Type>::On<::raydsl::__private::Native8>,)|
        {
            use ::raydsl::__private::operations::*;
            ::raydsl::__private::Machine::call(
                __m,
                &__INFO,
                (ray,),
                #[inline(always)]
                |
                    __m: &::raydsl::__private::Native8,
                    (
                        ray,
                    ): (
                        <Ray as ::raydsl::__private::Type>::On<
                            ::raydsl::__private::Native8,
                        >,
                    )|
                {
                    let bvh = ::raydsl::__private::Capture::<
                        ::raydsl::__private::Native8,
                    >::capture({ __captures.0 }, __m, "bvh");
                    let background = ::raydsl::__private::Capture::<
                        ::raydsl::__private::Native8,
                    >::capture({ __captures.1 }, __m, "background");
                    let hit = ::raydsl::__private::Machine::named(
                        __m,
                        "hit",
                        ::raydsl::__private::Method::<
                            { ::raydsl::__private::name("closest_hit") },
                            ::raydsl::__private::Native8,
                            _,
                            _,
                        >::call({ bvh }, __m, ({ ray },)),
                    );
                    {
                        let __value1 = ::raydsl::__private::Var::<
                            _,
                        >::declare(__m, "result");
                        let __branch2 = ::raydsl::__private::Branch::new(
                            __m,
                            hit.is_hit,
                        );
                        if __branch2.then(__m) {
                            ::raydsl::__private::here(
                                __m,
                                "if",
                                ::core::file!(),
                                ::core::line!(),
                            );
                            {
                                __value1
                                    .set(
                                        __m,
                                        ::raydsl::__private::Varying::varying(
                                            ::raydsl::__private::Method::<
                                                { ::raydsl::__private::name("rgb") },
                                                ::raydsl::__private::Native8,
                                                _,
                                                _,
                                            >::call(
                                                {
                                                    ::raydsl::__private::Method::<
                                                        { ::raydsl::__private::name("primitive") },
                                                        ::raydsl::__private::Native8,
                                                        _,
                                                        _,
                                                    >::call({ bvh }, __m, ({ hit },))
                                                },
                                                __m,
                                                (),
                                            ),
                                            __m,
                                        ),
                                    );
                            }
                        }
                        if __branch2.otherwise_small(__m) {
                            ::raydsl::__private::here(
                                __m,
                                "else",
                                ::core::file!(),
                                ::core::line!(),
                            );
                            {
                                __value1
                                    .set(
                                        __m,
                                        ::raydsl::__private::Varying::varying(background, __m),
                                    );
                            }
                        }
                        __branch2.end(__m);
                        __value1.get(__m)
                    }
                },
            )
        };
        #[allow(
            unused,
            clippy::all,
            clippy::pedantic,
            clippy::nursery,
            non_snake_case,
            reason = "generated code"
        )]
        let __native16 = move |
            __m: &::raydsl::__private::Native16,
            (
                ray,
            ): (<Ray as ::raydsl::__private::Type>::On<::raydsl::__private::Native16>,)|
        {
            use ::raydsl::__private::operations::*;
            ::raydsl::__private::Machine::call(
                __m,
                &__INFO,
                (ray,),
                #[inline(always)]
                |
                    __m: &::raydsl::__private::Native16,
                    (
                        ray,
                    ): (
                        <Ray as ::raydsl::__private::Type>::On<
                            ::raydsl::__private::Native16,
                        >,
                    )|
                {
                    let bvh = ::raydsl::__private::Capture::<
                        ::raydsl::__private::Native16,
                    >::capture({ __captures.0 }, __m, "bvh");
                    let background = ::raydsl::__private::Capture::<
                        ::raydsl::__private::Native16,
                    >::capture({ __captures.1 }, __m, "background");
                    let hit = ::raydsl::__private::Machine::named(
                        __m,
                        "hit",
                        ::raydsl::__private::Method::<
                            { ::raydsl::__private::name("closest_hit") },
                            ::raydsl::__private::Native16,
                            _,
                            _,
                        >::call({ bvh }, __m, ({ ray },)),
                    );
                    {
                        let __value1 = ::raydsl::__private::Var::<
                            _,
                        >::declare(__m, "result");
                        let __branch2 = ::raydsl::__private::Branch::new(
                            __m,
                            hit.is_hit,
                        );
                        if __branch2.then(__m) {
                            ::raydsl::__private::here(
                                __m,
                                "if",
                                ::core::file!(),
                                ::core::line!(),
                            );
                            {
                                __value1
                                    .set(
                                        __m,
                                        ::raydsl::__private::Varying::varying(
                                            ::raydsl::__private::Method::<
                                                { ::raydsl::__private::name("rgb") },
                                                ::raydsl::__private::Native16,
                                                _,
                                                _,
                                            >::call(
                                                {
                                                    ::raydsl::__private::Method::<
                                                        { ::raydsl::__private::name("primitive") },
                                                        ::raydsl::__private::Native16,
                                                        _,
                                                        _,
                                                    >::call({ bvh }, __m, ({ hit },))
                                                },
                                                __m,
                                                (),
                                            ),
                                            __m,
                                        ),
                                    );
                            }
                        }
                        if __branch2.otherwise_small(__m) {
                            ::raydsl::__private::here(
                                __m,
                                "else",
                                ::core::file!(),
                                ::core::line!(),
                            );
                            {
                                __value1
                                    .set(
                                        __m,
                                        ::raydsl::__private::Varying::varying(background, __m),
                                    );
                            }
                        }
                        __branch2.end(__m);
                        __value1.get(__m)
                    }
                },
            )
        };
        #[allow(
            unused,
            clippy::all,
            clippy::pedantic,
            clippy::nursery,
            non_snake_case,
            reason = "generated code"
        )]
        let __recorder = move |
            __m: &::raydsl::__private::Recorder,
            (
                ray,
            ): (<Ray as ::raydsl::__private::Type>::On<::raydsl::__private::Recorder>,)|
        {
            use ::raydsl::__private::operations::*;
            ::raydsl::__private::Machine::call(
                __m,
                &__INFO,
                (ray,),
                #[inline(always)]
                |
                    __m: &::raydsl::__private::Recorder,
                    (
                        ray,
                    ): (
                        <Ray as ::raydsl::__private::Type>::On<
                            ::raydsl::__private::Recorder,
                        >,
                    )|
                {
                    let bvh = ::raydsl::__private::Capture::<
                        ::raydsl::__private::Recorder,
                    >::capture({ __captures.0 }, __m, "bvh");
                    let background = ::raydsl::__private::Capture::<
                        ::raydsl::__private::Recorder,
                    >::capture({ __captures.1 }, __m, "background");
                    let hit = ::raydsl::__private::Machine::named(
                        __m,
                        "hit",
                        ::raydsl::__private::Method::<
                            { ::raydsl::__private::name("closest_hit") },
                            ::raydsl::__private::Recorder,
                            _,
                            _,
                        >::call({ bvh }, __m, ({ ray },)),
                    );
                    {
                        let __value1 = ::raydsl::__private::Var::<
                            _,
                        >::declare(__m, "result");
                        let __branch2 = ::raydsl::__private::Branch::new(
                            __m,
                            hit.is_hit,
                        );
                        if __branch2.then(__m) {
                            ::raydsl::__private::here(
                                __m,
                                "if",
                                ::core::file!(),
                                ::core::line!(),
                            );
                            {
                                __value1
                                    .set(
                                        __m,
                                        ::raydsl::__private::Varying::varying(
                                            ::raydsl::__private::Method::<
                                                { ::raydsl::__private::name("rgb") },
                                                ::raydsl::__private::Recorder,
                                                _,
                                                _,
                                            >::call(
                                                {
                                                    ::raydsl::__private::Method::<
                                                        { ::raydsl::__private::name("primitive") },
                                                        ::raydsl::__private::Recorder,
                                                        _,
                                                        _,
                                                    >::call({ bvh }, __m, ({ hit },))
                                                },
                                                __m,
                                                (),
                                            ),
                                            __m,
                                        ),
                                    );
                            }
                        }
                        if __branch2.otherwise_small(__m) {
                            ::raydsl::__private::here(
                                __m,
                                "else",
                                ::core::file!(),
                                ::core::line!(),
                            );
                            {
                                __value1
                                    .set(
                                        __m,
                                        ::raydsl::__private::Varying::varying(background, __m),
                                    );
                            }
                        }
                        __branch2.end(__m);
                        __value1.get(__m)
                    }
                },
            )
        };
        #[allow(
            unused,
            clippy::all,
            clippy::pedantic,
            clippy::nursery,
            non_snake_case,
            reason = "generated code"
        )]
        let __margin = move |
            __m: &::raydsl::__private::Margin,
            (
                ray,
            ): (<Ray as ::raydsl::__private::Type>::On<::raydsl::__private::Margin>,)|
        {
            use ::raydsl::__private::operations::*;
            ::raydsl::__private::Machine::call(
                __m,
                &__INFO,
                (ray,),
                #[inline(always)]
                |
                    __m: &::raydsl::__private::Margin,
                    (
                        ray,
                    ): (
                        <Ray as ::raydsl::__private::Type>::On<
                            ::raydsl::__private::Margin,
                        >,
                    )|
                {
                    let bvh = ::raydsl::__private::Capture::<
                        ::raydsl::__private::Margin,
                    >::capture({ __captures.0 }, __m, "bvh");
                    let background = ::raydsl::__private::Capture::<
                        ::raydsl::__private::Margin,
                    >::capture({ __captures.1 }, __m, "background");
                    let hit = ::raydsl::__private::Machine::named(
                        __m,
                        "hit",
                        ::raydsl::__private::Method::<
                            { ::raydsl::__private::name("closest_hit") },
                            ::raydsl::__private::Margin,
                            _,
                            _,
                        >::call({ bvh }, __m, ({ ray },)),
                    );
                    {
                        let __value1 = ::raydsl::__private::Var::<
                            _,
                        >::declare(__m, "result");
                        let __branch2 = ::raydsl::__private::Branch::new(
                            __m,
                            hit.is_hit,
                        );
                        if __branch2.then(__m) {
                            ::raydsl::__private::here(
                                __m,
                                "if",
                                ::core::file!(),
                                ::core::line!(),
                            );
                            {
                                __value1
                                    .set(
                                        __m,
                                        ::raydsl::__private::Varying::varying(
                                            ::raydsl::__private::Method::<
                                                { ::raydsl::__private::name("rgb") },
                                                ::raydsl::__private::Margin,
                                                _,
                                                _,
                                            >::call(
                                                {
                                                    ::raydsl::__private::Method::<
                                                        { ::raydsl::__private::name("primitive") },
                                                        ::raydsl::__private::Margin,
                                                        _,
                                                        _,
                                                    >::call({ bvh }, __m, ({ hit },))
                                                },
                                                __m,
                                                (),
                                            ),
                                            __m,
                                        ),
                                    );
                            }
                        }
                        if __branch2.otherwise_small(__m) {
                            ::raydsl::__private::here(
                                __m,
                                "else",
                                ::core::file!(),
                                ::core::line!(),
                            );
                            {
                                __value1
                                    .set(
                                        __m,
                                        ::raydsl::__private::Varying::varying(background, __m),
                                    );
                            }
                        }
                        __branch2.end(__m);
                        __value1.get(__m)
                    }
                },
            )
        };
        __scalar
            .lifted(
                ::raydsl::__private::Lifted {
                    native4: ::core::option::Option::Some(
                        ::std::boxed::Box::new(__native4)
                            as ::std::boxed::Box<
                                dyn Fn(&::raydsl::__private::Native4, _) -> _ + Send + Sync,
                            >,
                    ),
                    native8: ::core::option::Option::Some(
                        ::std::boxed::Box::new(__native8),
                    ),
                    native16: ::core::option::Option::Some(
                        ::std::boxed::Box::new(__native16),
                    ),
                    recorder: ::core::option::Option::Some(
                        ::std::boxed::Box::new(__recorder),
                    ),
                    margin: ::core::option::Option::Some(
                        ::std::boxed::Box::new(__margin),
                    ),
                },
                move |visit: &mut dyn FnMut(&dyn ::raydsl::__private::Resource)| {
                    ::raydsl::__private::Capture::<
                        ::raydsl::__private::Recorder,
                    >::resources({ __captures.0 }, "bvh", visit);
                    ::raydsl::__private::Capture::<
                        ::raydsl::__private::Recorder,
                    >::resources({ __captures.1 }, "background", visit);
                },
            )
    };
}
