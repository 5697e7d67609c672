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
        m: &M,
        up: impl Coerce<M, <f32 as Type>::On<M>>,
        bands: impl Coerce<M, <u32 as Type>::On<M>>,
    ) -> <f32 as Type>::On<M> {
        use operations::*;
        static __INFO: KernelInfo = KernelInfo {
            name: "sky",
            file: "examples/first_kernel.rs",
            line: 45u32,
            params: &["up", "bands"],
        };
        Machine::call(
            m,
            &__INFO,
            (
                Coerce::<M, <f32 as Type>::On<M>>::coerce(up, m),
                Coerce::<M, <u32 as Type>::On<M>>::coerce(bands, m),
            ),
            #[inline(always)]
            |m: &M, (up, bands): (<f32 as Type>::On<M>, <u32 as Type>::On<M>)| {
                let ret = Ret::<<f32 as Type>::On<M>>::new(m);
                'block_0: {
                    let edge = Var::new(m, "edge", Varying::varying(literal(m, 1.0f32, 1.0f64), m));
                    {
                        let (begin, end) = range(m, { 0 }, { bands });
                        let counter_3 = Var::new(m, "i", begin);
                        let step_5 = ::core::cell::Cell::new(0 as u32);
                        let repeat_2 = Loop::new(m);
                        loop {
                            if !repeat_2.test(m, less(m, counter_3.get(m), end)) {
                                break;
                            }
                            {
                                {
                                    let right = literal(m, 0.6f32, 0.6f64);
                                    edge.set(
                                        m,
                                        Coerce::coerce(
                                            OpMul::mul(m, { edge.get(m) }, { right }),
                                            m,
                                        ),
                                    );
                                }
                                let branch_7 = Branch::new(
                                    m,
                                    OpCompare::compare(m, Compare::Gt, { up }, { edge.get(m) }),
                                );
                                if branch_7.then_small(m) {
                                    {
                                        ret.give(m, Coerce::coerce(edge.get(m), m));
                                    }
                                }
                                branch_7.end(m);
                            }
                            repeat_2.continuing(m);
                            counter_3.set(m, increment(m, counter_3.get(m)));
                            step_5.set(step_5.get().wrapping_add(1));
                            if !repeat_2.again(m) {
                                break;
                            }
                        }
                        repeat_2.end(m);
                    }
                    if !Machine::alive(m) {
                        break 'block_0;
                    }
                    ret.give(m, Coerce::coerce(literal(m, 0.0f32, 0.0f64), m));
                }
                ret.take()
            },
        )
    }
}
