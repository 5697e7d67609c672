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
                        let counter_3 = Steps::new(m, "i", begin, 0 as u32);
                        let end = Stop::new(m, end);
                        let repeat_2 = Loop::new(m);
                        loop {
                            if !end.is_after(m, &repeat_2, &counter_3) {
                                break;
                            }
                            here(m, "loop", "examples/first_kernel.rs", 48u32);
                            {
                                {
                                    let right = literal(m, 0.6f32, 0.6f64);
                                    edge.set(
                                        m,
                                        Assigned::<{ name("*=") }, _, _, _>::assigned(
                                            m,
                                            edge.get(m),
                                            right,
                                        ),
                                    );
                                }
                                let branch_6 = Branch::new(
                                    m,
                                    OpCompare::compare(m, Compare::Gt, { up }, { edge.get(m) }),
                                );
                                if branch_6.then_small(m) {
                                    here(m, "if", "examples/first_kernel.rs", 50u32);
                                    {
                                        ret.give(m, Coerce::coerce(edge.get(m), m));
                                    }
                                }
                                branch_6.end(m);
                            }
                            repeat_2.continuing(m);
                            counter_3.advance(m);
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
