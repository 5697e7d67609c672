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
    pub(self) fn on<__M: Machine>(
        m: &__M,
        up: impl Coerce<__M, <f32 as Type>::On<__M>>,
        bands: impl Coerce<__M, <u32 as Type>::On<__M>>,
    ) -> <f32 as Type>::On<__M> {
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
                Coerce::<__M, <f32 as Type>::On<__M>>::coerce(up, m),
                Coerce::<__M, <u32 as Type>::On<__M>>::coerce(bands, m),
            ),
            #[inline(always)]
            |m: &__M, (up, bands): (<f32 as Type>::On<__M>, <u32 as Type>::On<__M>)| {
                let ret = Ret::<<f32 as Type>::On<__M>>::new(m);
                'block_0: {
                    let edge = Var::new(m, "edge", Varying::varying(f32(m, 1.0f32), m));
                    {
                        let (begin, end) = range(m, 0, bands);
                        let counter_3 = Var::new(m, "i", begin);
                        let repeat_2 = Loop::new(m);
                        loop {
                            if !repeat_2.test(m, less(m, counter_3.get(m), end)) {
                                break;
                            }
                            here(m, "loop", "examples/first_kernel.rs", 48u32);
                            {
                                {
                                    let right = f32(m, 0.6f32);
                                    edge.set(
                                        m,
                                        Coerce::coerce(OpMul::mul(m, edge.get(m), right), m),
                                    );
                                }
                                let branch_6 = Branch::new(
                                    m,
                                    OpCompare::compare(m, Compare::Gt, up, edge.get(m)),
                                );
                                if branch_6.then(m) {
                                    here(m, "if", "examples/first_kernel.rs", 50u32);
                                    {
                                        ret.give(m, Coerce::coerce(edge.get(m), m));
                                    }
                                }
                                branch_6.end(m);
                            }
                            repeat_2.continuing(m);
                            counter_3.set(m, increment(m, counter_3.get(m)));
                            if !repeat_2.again(m) {
                                break;
                            }
                        }
                        repeat_2.end(m);
                    }
                    if !Machine::alive(m) {
                        break 'block_0;
                    }
                    ret.give(m, Coerce::coerce(f32(m, 0.0f32), m));
                }
                ret.take()
            },
        )
    }
}
