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
        let scalar = |ray: Ray| {
            let hit = bvh.closest_hit(ray);
            if hit.is_hit { bvh.primitive(hit).rgb() } else { background }
        };
        let scalar = ::raydsl::__private::Kernel::scalar(
            &__INFO,
            move |(ray,): (Ray,)| scalar(ray),
        );
        let captures = (&bvh, &background);
        #[allow(
            unused,
            clippy::all,
            clippy::pedantic,
            clippy::nursery,
            non_snake_case,
            reason = "generated code"
        )]
        let native4 = move |m: &_, (ray,): (<Ray as ::raydsl::__private::Type>::On<_>,)| {
            use ::raydsl::__private::operations::*;
            ::raydsl::__private::Machine::call(
                m,
                &__INFO,
                (ray,),
                #[inline(always)]
                |m: &_, (ray,): (<Ray as ::raydsl::__private::Type>::On<_>,)| {
                    let bvh = ::raydsl::__private::Capture::<
                        _,
                    >::capture({ captures.0 }, m, "bvh");
                    let background = ::raydsl::__private::Capture::<
                        _,
                    >::capture({ captures.1 }, m, "background");
                    let hit = ::raydsl::__private::Machine::named(
                        m,
                        "hit",
                        ::raydsl::__private::Method::<
                            { ::raydsl::__private::name("closest_hit") },
                            _,
                            _,
                            _,
                        >::call({ bvh }, m, ({ ray },)),
                    );
                    {
                        let value_1 = ::raydsl::__private::Var::<
                            _,
                        >::declare(m, "result");
                        let branch_2 = ::raydsl::__private::Branch::new(m, hit.is_hit);
                        if branch_2.then(m) {
                            ::raydsl::__private::here(
                                m,
                                "if",
                                ::core::file!(),
                                ::core::line!(),
                            );
                            {
                                value_1
                                    .set(
                                        m,
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
                                                    >::call({ bvh }, m, ({ hit },))
                                                },
                                                m,
                                                (),
                                            ),
                                            m,
                                        ),
                                    );
                            }
                        }
                        if branch_2.otherwise_small(m) {
                            ::raydsl::__private::here(
                                m,
                                "else",
                                ::core::file!(),
                                ::core::line!(),
                            );
                            {
                                value_1
                                    .set(
                                        m,
                                        ::raydsl::__private::Varying::varying(background, m),
                                    );
                            }
                        }
                        branch_2.end(m);
                        value_1.get(m)
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
        let native8 = move |
            m: &::raydsl::__private::Native8,
            (
                ray,
            ): (<Ray as ::raydsl::__private::Type>::On<::raydsl::__private::Native8>,)|
        {
            use ::raydsl::__private::operations::*;
            ::raydsl::__private::Machine::call(
                m,
                &__INFO,
                (ray,),
                #[inline(always)]
                |
                    m: &::raydsl::__private::Native8,
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
                    >::capture({ captures.0 }, m, "bvh");
                    let background = ::raydsl::__private::Capture::<
                        ::raydsl::__private::Native8,
                    >::capture({ captures.1 }, m, "background");
                    let hit = ::raydsl::__private::Machine::named(
                        m,
                        "hit",
                        ::raydsl::__private::Method::<
                            { ::raydsl::__private::name("closest_hit") },
                            ::raydsl::__private::Native8,
                            _,
                            _,
                        >::call({ bvh }, m, ({ ray },)),
                    );
                    {
                        let value_1 = ::raydsl::__private::Var::<
                            _,
                        >::declare(m, "result");
                        let branch_2 = ::raydsl::__private::Branch::new(m, hit.is_hit);
                        if branch_2.then(m) {
                            ::raydsl::__private::here(
                                m,
                                "if",
                                ::core::file!(),
                                ::core::line!(),
                            );
                            {
                                value_1
                                    .set(
                                        m,
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
                                                    >::call({ bvh }, m, ({ hit },))
                                                },
                                                m,
                                                (),
                                            ),
                                            m,
                                        ),
                                    );
                            }
                        }
                        if branch_2.otherwise_small(m) {
                            ::raydsl::__private::here(
                                m,
                                "else",
                                ::core::file!(),
                                ::core::line!(),
                            );
                            {
                                value_1
                                    .set(
                                        m,
                                        ::raydsl::__private::Varying::varying(background, m),
                                    );
                            }
                        }
                        branch_2.end(m);
                        value_1.get(m)
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
        let native16 = move |
            m: &::raydsl::__private::Native16,
            (
                ray,
            ): (<Ray as ::raydsl::__private::Type>::On<::raydsl::__private::Native16>,)|
        {
            use ::raydsl::__private::operations::*;
            ::raydsl::__private::Machine::call(
                m,
                &__INFO,
                (ray,),
                #[inline(always)]
                |
                    m: &::raydsl::__private::Native16,
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
                    >::capture({ captures.0 }, m, "bvh");
                    let background = ::raydsl::__private::Capture::<
                        ::raydsl::__private::Native16,
                    >::capture({ captures.1 }, m, "background");
                    let hit = ::raydsl::__private::Machine::named(
                        m,
                        "hit",
                        ::raydsl::__private::Method::<
                            { ::raydsl::__private::name("closest_hit") },
                            ::raydsl::__private::Native16,
                            _,
                            _,
                        >::call({ bvh }, m, ({ ray },)),
                    );
                    {
                        let value_1 = ::raydsl::__private::Var::<
                            _,
                        >::declare(m, "result");
                        let branch_2 = ::raydsl::__private::Branch::new(m, hit.is_hit);
                        if branch_2.then(m) {
                            ::raydsl::__private::here(
                                m,
                                "if",
                                ::core::file!(),
                                ::core::line!(),
                            );
                            {
                                value_1
                                    .set(
                                        m,
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
                                                    >::call({ bvh }, m, ({ hit },))
                                                },
                                                m,
                                                (),
                                            ),
                                            m,
                                        ),
                                    );
                            }
                        }
                        if branch_2.otherwise_small(m) {
                            ::raydsl::__private::here(
                                m,
                                "else",
                                ::core::file!(),
                                ::core::line!(),
                            );
                            {
                                value_1
                                    .set(
                                        m,
                                        ::raydsl::__private::Varying::varying(background, m),
                                    );
                            }
                        }
                        branch_2.end(m);
                        value_1.get(m)
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
        let recorder = move |
            m: &::raydsl::__private::Recorder,
            (
                ray,
            ): (<Ray as ::raydsl::__private::Type>::On<::raydsl::__private::Recorder>,)|
        {
            use ::raydsl::__private::operations::*;
            ::raydsl::__private::Machine::call(
                m,
                &__INFO,
                (ray,),
                #[inline(always)]
                |
                    m: &::raydsl::__private::Recorder,
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
                    >::capture({ captures.0 }, m, "bvh");
                    let background = ::raydsl::__private::Capture::<
                        ::raydsl::__private::Recorder,
                    >::capture({ captures.1 }, m, "background");
                    let hit = ::raydsl::__private::Machine::named(
                        m,
                        "hit",
                        ::raydsl::__private::Method::<
                            { ::raydsl::__private::name("closest_hit") },
                            ::raydsl::__private::Recorder,
                            _,
                            _,
                        >::call({ bvh }, m, ({ ray },)),
                    );
                    {
                        let value_1 = ::raydsl::__private::Var::<
                            _,
                        >::declare(m, "result");
                        let branch_2 = ::raydsl::__private::Branch::new(m, hit.is_hit);
                        if branch_2.then(m) {
                            ::raydsl::__private::here(
                                m,
                                "if",
                                ::core::file!(),
                                ::core::line!(),
                            );
                            {
                                value_1
                                    .set(
                                        m,
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
                                                    >::call({ bvh }, m, ({ hit },))
                                                },
                                                m,
                                                (),
                                            ),
                                            m,
                                        ),
                                    );
                            }
                        }
                        if branch_2.otherwise_small(m) {
                            ::raydsl::__private::here(
                                m,
                                "else",
                                ::core::file!(),
                                ::core::line!(),
                            );
                            {
                                value_1
                                    .set(
                                        m,
                                        ::raydsl::__private::Varying::varying(background, m),
                                    );
                            }
                        }
                        branch_2.end(m);
                        value_1.get(m)
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
        let margin = move |
            m: &::raydsl::__private::Margin,
            (
                ray,
            ): (<Ray as ::raydsl::__private::Type>::On<::raydsl::__private::Margin>,)|
        {
            use ::raydsl::__private::operations::*;
            ::raydsl::__private::Machine::call(
                m,
                &__INFO,
                (ray,),
                #[inline(always)]
                |
                    m: &::raydsl::__private::Margin,
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
                    >::capture({ captures.0 }, m, "bvh");
                    let background = ::raydsl::__private::Capture::<
                        ::raydsl::__private::Margin,
                    >::capture({ captures.1 }, m, "background");
                    let hit = ::raydsl::__private::Machine::named(
                        m,
                        "hit",
                        ::raydsl::__private::Method::<
                            { ::raydsl::__private::name("closest_hit") },
                            ::raydsl::__private::Margin,
                            _,
                            _,
                        >::call({ bvh }, m, ({ ray },)),
                    );
                    {
                        let value_1 = ::raydsl::__private::Var::<
                            _,
                        >::declare(m, "result");
                        let branch_2 = ::raydsl::__private::Branch::new(m, hit.is_hit);
                        if branch_2.then(m) {
                            ::raydsl::__private::here(
                                m,
                                "if",
                                ::core::file!(),
                                ::core::line!(),
                            );
                            {
                                value_1
                                    .set(
                                        m,
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
                                                    >::call({ bvh }, m, ({ hit },))
                                                },
                                                m,
                                                (),
                                            ),
                                            m,
                                        ),
                                    );
                            }
                        }
                        if branch_2.otherwise_small(m) {
                            ::raydsl::__private::here(
                                m,
                                "else",
                                ::core::file!(),
                                ::core::line!(),
                            );
                            {
                                value_1
                                    .set(
                                        m,
                                        ::raydsl::__private::Varying::varying(background, m),
                                    );
                            }
                        }
                        branch_2.end(m);
                        value_1.get(m)
                    }
                },
            )
        };
        scalar
            .lifted(
                ::raydsl::__private::Lifted {
                    native4: ::core::option::Option::Some(
                        ::std::boxed::Box::new(native4)
                            as ::std::boxed::Box<
                                dyn Fn(&::raydsl::__private::Native4, _) -> _ + Send + Sync,
                            >,
                    ),
                    native8: ::core::option::Option::Some(
                        ::std::boxed::Box::new(native8),
                    ),
                    native16: ::core::option::Option::Some(
                        ::std::boxed::Box::new(native16),
                    ),
                    recorder: ::core::option::Option::Some(
                        ::std::boxed::Box::new(recorder),
                    ),
                    margin: ::core::option::Option::Some(::std::boxed::Box::new(margin)),
                },
                move |visit: &mut dyn FnMut(&dyn ::raydsl::__private::Resource)| {
                    ::raydsl::__private::Capture::<
                        ::raydsl::__private::Recorder,
                    >::resources({ captures.0 }, visit);
                    ::raydsl::__private::Capture::<
                        ::raydsl::__private::Recorder,
                    >::resources({ captures.1 }, visit);
                },
            )
    };
}
