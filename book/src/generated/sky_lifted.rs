impl sky {
    #[inline(always)]
    #[allow(
        unused,
        clippy::all,
        clippy::pedantic,
        clippy::nursery,
        non_snake_case,
        reason = "generated code"
    )]
    pub(self) fn on<M: Machine>(
        __m: &M,
        up: impl Coerce<M, <f32 as Type>::On<M>>,
        bands: impl Coerce<M, <u32 as Type>::On<M>>,
    ) -> <f32 as Type>::On<M> {
        use operations::*;
        static __INFO: KernelInfo = KernelInfo {
            name: "sky",
            file: "examples/first_kernel.rs",
            line: 45u32,
            params: &["up", "bands"],
            known: ::core::option::Option::None,
        };
        Machine::call(
            __m,
            &__INFO,
            (
                Coerce::<M, <f32 as Type>::On<M>>::coerce(up, __m),
                Coerce::<M, <u32 as Type>::On<M>>::coerce(bands, __m),
            ),
            #[inline(always)]
            |__m: &M, (up, bands): (<f32 as Type>::On<M>, <u32 as Type>::On<M>)| {
                let __ret = Ret::<<f32 as Type>::On<M>>::new(__m);
                'block_0: {
                    let edge =
                        Var::new(__m, "edge", Varying::varying(literal(__m, 1.0f32, 1.0f64), __m));
                    {
                        let (__begin, __end) = range(__m, { 0 }, { bands });
                        let __counter3 = Steps::new(__m, "i", __begin, 0 as u32);
                        let __end = Stop::new(__m, __end);
                        let __repeat2 = Loop::new(__m);
                        loop {
                            if !__end.is_after(__m, &__repeat2, &__counter3) {
                                break;
                            }
                            here(__m, "loop", "examples/first_kernel.rs", 48u32);
                            {
                                {
                                    let __right = literal(__m, 0.6f32, 0.6f64);
                                    edge.set(
                                        __m,
                                        Assigned::<{ name("*=") }, _, _, _>::assigned(
                                            __m,
                                            edge.get(__m),
                                            __right,
                                        ),
                                    );
                                }
                                let __branch6 = Branch::new(
                                    __m,
                                    OpCompare::compare(__m, op::Gt, { up }, { edge.get(__m) }),
                                );
                                if __branch6.then_small(__m) {
                                    here(__m, "if", "examples/first_kernel.rs", 50u32);
                                    {
                                        __ret.give(__m, Coerce::coerce(edge.get(__m), __m));
                                    }
                                }
                                __branch6.end(__m);
                            }
                            __repeat2.continuing(__m);
                            __counter3.advance(__m);
                            if !__repeat2.again(__m) {
                                break;
                            }
                        }
                        __repeat2.end(__m);
                    }
                    if !Machine::alive(__m) {
                        break 'block_0;
                    }
                    __ret.give(__m, Coerce::coerce(literal(__m, 0.0f32, 0.0f64), __m));
                }
                __ret.take()
            },
        )
    }
}
