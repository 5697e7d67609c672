///[`Sample`] on machine `M`.
#[allow(missing_docs, reason = "the members are those of the struct")]
struct SampleOn<M: ::raydsl::__private::Machine> {
    value: <f32 as ::raydsl::__private::Type>::On<M>,
    count: <u32 as ::raydsl::__private::Type>::On<M>,
}
impl<M: ::raydsl::__private::Machine> Clone for SampleOn<M> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}
impl<M: ::raydsl::__private::Machine> Copy for SampleOn<M> {}
impl<M: ::raydsl::__private::Machine> ::raydsl::__private::Value<M> for SampleOn<M> {
    const SCHEMA: &'static ::raydsl::__private::Schema = &::raydsl::__private::Schema::Struct {
        name: "Sample",
        fields: &[
            ::raydsl::__private::Field {
                name: "value",
                offset: ::core::mem::offset_of!(Sample < >, value),
                schema: <f32 as ::raydsl::__private::Type>::SCHEMA,
            },
            ::raydsl::__private::Field {
                name: "count",
                offset: ::core::mem::offset_of!(Sample < >, count),
                schema: <u32 as ::raydsl::__private::Type>::SCHEMA,
            },
        ],
        size: ::core::mem::size_of::<Sample>(),
    };
    #[inline(always)]
    fn zero(m: &M) -> Self {
        Self {
            value: ::raydsl::__private::Value::zero(m),
            count: ::raydsl::__private::Value::zero(m),
        }
    }
    #[inline(always)]
    fn zip(
        m: &M,
        a: Self,
        b: Self,
        f: &mut impl ::raydsl::__private::Leaves<M>,
    ) -> Self {
        Self {
            value: ::raydsl::__private::Value::zip(m, a.value, b.value, f),
            count: ::raydsl::__private::Value::zip(m, a.count, b.count, f),
        }
    }
}
#[diagnostic::do_not_recommend]
impl<M: ::raydsl::__private::Machine, R, Via> ::raydsl::__private::OpAdd<M, R, Via>
for SampleOn<M>
where
    Sample: ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("+") },
        M,
        (R,),
        Via,
        This = Self,
    >,
{
    type Output = <Sample as ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("+") },
        M,
        (R,),
        Via,
    >>::Output;
    #[inline(always)]
    fn add(m: &M, a: Self, b: R) -> Self::Output {
        <Sample as ::raydsl::__private::HostMethod<
            { ::raydsl::__private::name("+") },
            M,
            (R,),
            Via,
        >>::call(a, m, (b,))
    }
}
#[diagnostic::do_not_recommend]
impl<M: ::raydsl::__private::Machine, R, Via> ::raydsl::__private::OpSub<M, R, Via>
for SampleOn<M>
where
    Sample: ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("-") },
        M,
        (R,),
        Via,
        This = Self,
    >,
{
    type Output = <Sample as ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("-") },
        M,
        (R,),
        Via,
    >>::Output;
    #[inline(always)]
    fn sub(m: &M, a: Self, b: R) -> Self::Output {
        <Sample as ::raydsl::__private::HostMethod<
            { ::raydsl::__private::name("-") },
            M,
            (R,),
            Via,
        >>::call(a, m, (b,))
    }
}
#[diagnostic::do_not_recommend]
impl<M: ::raydsl::__private::Machine, R, Via> ::raydsl::__private::OpMul<M, R, Via>
for SampleOn<M>
where
    Sample: ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("*") },
        M,
        (R,),
        Via,
        This = Self,
    >,
{
    type Output = <Sample as ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("*") },
        M,
        (R,),
        Via,
    >>::Output;
    #[inline(always)]
    fn mul(m: &M, a: Self, b: R) -> Self::Output {
        <Sample as ::raydsl::__private::HostMethod<
            { ::raydsl::__private::name("*") },
            M,
            (R,),
            Via,
        >>::call(a, m, (b,))
    }
}
#[diagnostic::do_not_recommend]
impl<M: ::raydsl::__private::Machine, R, Via> ::raydsl::__private::OpDiv<M, R, Via>
for SampleOn<M>
where
    Sample: ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("/") },
        M,
        (R,),
        Via,
        This = Self,
    >,
{
    type Output = <Sample as ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("/") },
        M,
        (R,),
        Via,
    >>::Output;
    #[inline(always)]
    fn div(m: &M, a: Self, b: R) -> Self::Output {
        <Sample as ::raydsl::__private::HostMethod<
            { ::raydsl::__private::name("/") },
            M,
            (R,),
            Via,
        >>::call(a, m, (b,))
    }
}
#[diagnostic::do_not_recommend]
impl<M: ::raydsl::__private::Machine, R, Via> ::raydsl::__private::OpRem<M, R, Via>
for SampleOn<M>
where
    Sample: ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("%") },
        M,
        (R,),
        Via,
        This = Self,
    >,
{
    type Output = <Sample as ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("%") },
        M,
        (R,),
        Via,
    >>::Output;
    #[inline(always)]
    fn rem(m: &M, a: Self, b: R) -> Self::Output {
        <Sample as ::raydsl::__private::HostMethod<
            { ::raydsl::__private::name("%") },
            M,
            (R,),
            Via,
        >>::call(a, m, (b,))
    }
}
#[diagnostic::do_not_recommend]
impl<M: ::raydsl::__private::Machine> ::raydsl::__private::OpNeg<M> for SampleOn<M>
where
    Sample: ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("-x") },
        M,
        (),
        This = Self,
        Output = Self,
    >,
{
    #[inline(always)]
    fn neg(m: &M, a: Self) -> Self {
        <Sample as ::raydsl::__private::HostMethod<
            { ::raydsl::__private::name("-x") },
            M,
            (),
        >>::call(a, m, ())
    }
}
#[diagnostic::do_not_recommend]
impl<
    const NAME: u64,
    M: ::raydsl::__private::Machine,
    R,
    Via,
> ::raydsl::__private::Assigned<NAME, M, R, Via> for SampleOn<M>
where
    Sample: ::raydsl::__private::HostMethod<
        NAME,
        M,
        (R,),
        Via,
        This = Self,
        Output = (),
    >,
{
    #[inline(always)]
    fn assigned(m: &M, a: Self, b: R) -> Self {
        let variable = ::raydsl::__private::Var::new(m, "self", a);
        <Sample as ::raydsl::__private::HostMethod<
            NAME,
            M,
            (R,),
            Via,
        >>::call_at(a, &variable, m, (b,));
        variable.get(m)
    }
}
impl<M: ::raydsl::__private::Machine> ::raydsl::__private::RightOperand for SampleOn<M> {
    type Host = Sample;
}
#[diagnostic::do_not_recommend]
impl<M: ::raydsl::__private::Machine> ::raydsl::__private::Inferred<M> for SampleOn<M> {
    type Host = Sample;
    #[inline(always)]
    fn give(self, _: &M) -> Self {
        self
    }
}
impl<M: ::raydsl::__private::Machine> ::raydsl::__private::Twin<M> for SampleOn<M> {
    #[inline(always)]
    fn from_host(v: Self) -> Self {
        v
    }
}
#[diagnostic::do_not_recommend]
impl<M: ::raydsl::__private::Machine> ::raydsl::__private::Varying<M> for SampleOn<M> {
    type Value = Self;
    #[inline(always)]
    fn varying(self, _: &M) -> Self {
        self
    }
}
impl<
    const NAME: u64,
    M: ::raydsl::__private::Machine,
    A,
    Via,
> ::raydsl::__private::Method<NAME, M, A, Via> for SampleOn<M>
where
    Sample: ::raydsl::__private::HostMethod<NAME, M, A, Via, This = Self>,
{
    type Output = <Sample as ::raydsl::__private::HostMethod<NAME, M, A, Via>>::Output;
    const IS_MUT: bool = <Sample as ::raydsl::__private::HostMethod<
        NAME,
        M,
        A,
        Via,
    >>::IS_MUT;
    #[inline(always)]
    fn call(self, m: &M, args: A) -> Self::Output {
        <Sample as ::raydsl::__private::HostMethod<NAME, M, A, Via>>::call(self, m, args)
    }
    #[inline(always)]
    fn call_at(
        self,
        variable: &::raydsl::__private::Var<Self>,
        m: &M,
        args: A,
    ) -> Self::Output {
        <Sample as ::raydsl::__private::HostMethod<
            NAME,
            M,
            A,
            Via,
        >>::call_at(self, variable, m, args)
    }
}
#[diagnostic::do_not_recommend]
impl ::raydsl::__private::Type for Sample {
    type On<M: ::raydsl::__private::Machine> = SampleOn<M>;
    const SCHEMA: &'static ::raydsl::__private::Schema = &::raydsl::__private::Schema::Struct {
        name: "Sample",
        fields: &[
            ::raydsl::__private::Field {
                name: "value",
                offset: ::core::mem::offset_of!(Sample < >, value),
                schema: <f32 as ::raydsl::__private::Type>::SCHEMA,
            },
            ::raydsl::__private::Field {
                name: "count",
                offset: ::core::mem::offset_of!(Sample < >, count),
                schema: <u32 as ::raydsl::__private::Type>::SCHEMA,
            },
        ],
        size: ::core::mem::size_of::<Sample>(),
    };
    #[inline(always)]
    fn splat<M: ::raydsl::__private::Machine>(m: &M, v: Self) -> SampleOn<M> {
        SampleOn {
            value: ::raydsl::__private::Type::splat(m, v.value),
            count: ::raydsl::__private::Type::splat(m, v.count),
        }
    }
    #[inline(always)]
    fn from_lanes<M: ::raydsl::__private::LaneMachine>(
        m: &M,
        f: &impl Fn(usize) -> Self,
    ) -> SampleOn<M> {
        SampleOn {
            value: ::raydsl::__private::Type::from_lanes(m, &|lane| f(lane).value),
            count: ::raydsl::__private::Type::from_lanes(m, &|lane| f(lane).count),
        }
    }
    #[inline(always)]
    fn lane<M: ::raydsl::__private::LaneMachine>(v: &SampleOn<M>, lane: usize) -> Self {
        Self {
            value: ::raydsl::__private::Type::lane(&v.value, lane),
            count: ::raydsl::__private::Type::lane(&v.count, lane),
        }
    }
    fn write(&self, out: &mut [u8]) {
        ::raydsl::__private::Type::write(
            &self.value,
            &mut out[::core::mem::offset_of!(Sample < >, value)..],
        );
        ::raydsl::__private::Type::write(
            &self.count,
            &mut out[::core::mem::offset_of!(Sample < >, count)..],
        );
    }
    fn read(bytes: &[u8]) -> Self {
        Self {
            value: ::raydsl::__private::Type::read(
                &bytes[::core::mem::offset_of!(Sample < >, value)..],
            ),
            count: ::raydsl::__private::Type::read(
                &bytes[::core::mem::offset_of!(Sample < >, count)..],
            ),
        }
    }
}
#[diagnostic::do_not_recommend]
impl<M: ::raydsl::__private::Machine> ::raydsl::__private::Capture<M> for Sample {
    type On<'c> = SampleOn<M>;
    #[inline(always)]
    fn capture(&self, m: &M, name: &'static str) -> SampleOn<M> {
        ::raydsl::__private::Machine::capture(m, name, *self)
    }
    #[inline(always)]
    fn constant(&self, m: &M) -> SampleOn<M> {
        ::raydsl::__private::Type::splat(m, *self)
    }
}
