///[`Sample`] on a machine.
#[allow(missing_docs, reason = "the members are those of the struct")]
struct SampleOn<__M: ::raydsl::__private::Machine> {
    value: <f32 as ::raydsl::__private::Type>::On<__M>,
    count: <u32 as ::raydsl::__private::Type>::On<__M>,
}
impl<__M: ::raydsl::__private::Machine> Clone for SampleOn<__M> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}
impl<__M: ::raydsl::__private::Machine> Copy for SampleOn<__M> {}
#[doc(hidden)]
impl Sample {
    const __PLACES: ::raydsl::__private::Places<2usize> = ::raydsl::__private::Places::new(
        ::core::mem::size_of::<Self>(),
        [::core::mem::offset_of!(Self, value), ::core::mem::offset_of!(Self, count)],
        [::core::mem::size_of::<f32>(), ::core::mem::size_of::<u32>()],
        [
            <f32 as ::raydsl::__private::Type>::SCHEMA,
            <u32 as ::raydsl::__private::Type>::SCHEMA,
        ],
    );
}
impl<__M: ::raydsl::__private::Machine> ::raydsl::__private::Value<__M>
for SampleOn<__M> {
    const SCHEMA: &'static ::raydsl::__private::Schema = <Sample as ::raydsl::__private::Type>::SCHEMA;
    #[inline(always)]
    fn zero(m: &__M) -> Self {
        Self {
            value: ::raydsl::__private::Value::zero(m),
            count: ::raydsl::__private::Value::zero(m),
        }
    }
    #[inline(always)]
    fn zip(
        m: &__M,
        a: Self,
        b: Self,
        f: &mut impl ::raydsl::__private::Leaves<__M>,
    ) -> Self {
        Self {
            value: ::raydsl::__private::Value::zip(m, a.value, b.value, f),
            count: ::raydsl::__private::Value::zip(m, a.count, b.count, f),
        }
    }
}
#[diagnostic::do_not_recommend]
impl<
    __M: ::raydsl::__private::Machine,
    __Right,
    __Via,
> ::raydsl::__private::OpAdd<__M, __Right, __Via> for SampleOn<__M>
where
    Sample: ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("+") },
        __M,
        (__Right,),
        __Via,
        This = Self,
    >,
{
    type Output = <Sample as ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("+") },
        __M,
        (__Right,),
        __Via,
    >>::Output;
    #[inline(always)]
    fn add(m: &__M, a: Self, b: __Right) -> Self::Output {
        <Sample as ::raydsl::__private::HostMethod<
            { ::raydsl::__private::name("+") },
            __M,
            (__Right,),
            __Via,
        >>::call(a, m, (b,))
    }
}
#[diagnostic::do_not_recommend]
impl<
    __M: ::raydsl::__private::Machine,
    __Right,
    __Via,
> ::raydsl::__private::OpSub<__M, __Right, __Via> for SampleOn<__M>
where
    Sample: ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("-") },
        __M,
        (__Right,),
        __Via,
        This = Self,
    >,
{
    type Output = <Sample as ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("-") },
        __M,
        (__Right,),
        __Via,
    >>::Output;
    #[inline(always)]
    fn sub(m: &__M, a: Self, b: __Right) -> Self::Output {
        <Sample as ::raydsl::__private::HostMethod<
            { ::raydsl::__private::name("-") },
            __M,
            (__Right,),
            __Via,
        >>::call(a, m, (b,))
    }
}
#[diagnostic::do_not_recommend]
impl<
    __M: ::raydsl::__private::Machine,
    __Right,
    __Via,
> ::raydsl::__private::OpMul<__M, __Right, __Via> for SampleOn<__M>
where
    Sample: ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("*") },
        __M,
        (__Right,),
        __Via,
        This = Self,
    >,
{
    type Output = <Sample as ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("*") },
        __M,
        (__Right,),
        __Via,
    >>::Output;
    #[inline(always)]
    fn mul(m: &__M, a: Self, b: __Right) -> Self::Output {
        <Sample as ::raydsl::__private::HostMethod<
            { ::raydsl::__private::name("*") },
            __M,
            (__Right,),
            __Via,
        >>::call(a, m, (b,))
    }
}
#[diagnostic::do_not_recommend]
impl<
    __M: ::raydsl::__private::Machine,
    __Right,
    __Via,
> ::raydsl::__private::OpDiv<__M, __Right, __Via> for SampleOn<__M>
where
    Sample: ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("/") },
        __M,
        (__Right,),
        __Via,
        This = Self,
    >,
{
    type Output = <Sample as ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("/") },
        __M,
        (__Right,),
        __Via,
    >>::Output;
    #[inline(always)]
    fn div(m: &__M, a: Self, b: __Right) -> Self::Output {
        <Sample as ::raydsl::__private::HostMethod<
            { ::raydsl::__private::name("/") },
            __M,
            (__Right,),
            __Via,
        >>::call(a, m, (b,))
    }
}
#[diagnostic::do_not_recommend]
impl<
    __M: ::raydsl::__private::Machine,
    __Right,
    __Via,
> ::raydsl::__private::OpRem<__M, __Right, __Via> for SampleOn<__M>
where
    Sample: ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("%") },
        __M,
        (__Right,),
        __Via,
        This = Self,
    >,
{
    type Output = <Sample as ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("%") },
        __M,
        (__Right,),
        __Via,
    >>::Output;
    #[inline(always)]
    fn rem(m: &__M, a: Self, b: __Right) -> Self::Output {
        <Sample as ::raydsl::__private::HostMethod<
            { ::raydsl::__private::name("%") },
            __M,
            (__Right,),
            __Via,
        >>::call(a, m, (b,))
    }
}
#[diagnostic::do_not_recommend]
impl<__M: ::raydsl::__private::Machine> ::raydsl::__private::OpNeg<__M> for SampleOn<__M>
where
    Sample: ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("-x") },
        __M,
        (),
        This = Self,
        Output = Self,
    >,
{
    #[inline(always)]
    fn neg(m: &__M, a: Self) -> Self {
        <Sample as ::raydsl::__private::HostMethod<
            { ::raydsl::__private::name("-x") },
            __M,
            (),
        >>::call(a, m, ())
    }
}
#[diagnostic::do_not_recommend]
impl<
    const __NAME: u64,
    __M: ::raydsl::__private::Machine,
    __Right,
    __Via,
> ::raydsl::__private::Assigned<__NAME, __M, __Right, __Via> for SampleOn<__M>
where
    Sample: ::raydsl::__private::HostMethod<
        __NAME,
        __M,
        (__Right,),
        __Via,
        This = Self,
        Output = (),
    >,
{
    #[inline(always)]
    fn assigned(m: &__M, a: Self, b: __Right) -> Self {
        let variable = ::raydsl::__private::Var::new(m, "self", a);
        <Sample as ::raydsl::__private::HostMethod<
            __NAME,
            __M,
            (__Right,),
            __Via,
        >>::call_at(a, &variable, m, (b,));
        variable.get(m)
    }
}
impl<__M: ::raydsl::__private::Machine> ::raydsl::__private::RightOperand
for SampleOn<__M> {
    type Host = Sample;
}
#[diagnostic::do_not_recommend]
impl<__M: ::raydsl::__private::Machine> ::raydsl::__private::Inferred<__M>
for SampleOn<__M> {
    type Host = Sample;
    #[inline(always)]
    fn give(self, _: &__M) -> Self {
        self
    }
}
impl<__M: ::raydsl::__private::Machine> ::raydsl::__private::Twin<__M>
for SampleOn<__M> {
    #[inline(always)]
    fn from_host(v: Self) -> Self {
        v
    }
}
#[diagnostic::do_not_recommend]
impl<__M: ::raydsl::__private::Machine> ::raydsl::__private::Varying<__M>
for SampleOn<__M> {
    type Value = Self;
    #[inline(always)]
    fn varying(self, _: &__M) -> Self {
        self
    }
}
impl<
    const __NAME: u64,
    __M: ::raydsl::__private::Machine,
    __Args,
    __Via,
> ::raydsl::__private::Method<__NAME, __M, __Args, __Via> for SampleOn<__M>
where
    Sample: ::raydsl::__private::HostMethod<__NAME, __M, __Args, __Via, This = Self>,
{
    type Output = <Sample as ::raydsl::__private::HostMethod<
        __NAME,
        __M,
        __Args,
        __Via,
    >>::Output;
    const IS_MUT: bool = <Sample as ::raydsl::__private::HostMethod<
        __NAME,
        __M,
        __Args,
        __Via,
    >>::IS_MUT;
    #[inline(always)]
    fn call(self, m: &__M, args: __Args) -> Self::Output {
        <Sample as ::raydsl::__private::HostMethod<
            __NAME,
            __M,
            __Args,
            __Via,
        >>::call(self, m, args)
    }
    #[inline(always)]
    fn call_at(
        self,
        variable: &::raydsl::__private::Var<Self>,
        m: &__M,
        args: __Args,
    ) -> Self::Output {
        <Sample as ::raydsl::__private::HostMethod<
            __NAME,
            __M,
            __Args,
            __Via,
        >>::call_at(self, variable, m, args)
    }
}
#[diagnostic::do_not_recommend]
impl ::raydsl::__private::KernelType for Sample {
    type Twin<__M: ::raydsl::__private::Machine> = <Self as ::raydsl::__private::Type>::On<
        __M,
    >;
    #[inline(always)]
    fn same<__M: ::raydsl::__private::Machine>(v: Self::Twin<__M>) -> Self::Twin<__M> {
        v
    }
}
#[diagnostic::do_not_recommend]
impl ::raydsl::__private::Type for Sample {
    type On<__M: ::raydsl::__private::Machine> = SampleOn<__M>;
    const SCHEMA: &'static ::raydsl::__private::Schema = &::raydsl::__private::Schema::Struct {
        name: "Sample",
        fields: &[
            ::raydsl::__private::Field {
                name: "value",
                offset: Self::__PLACES.offsets[0usize],
                schema: <f32 as ::raydsl::__private::Type>::SCHEMA,
            },
            ::raydsl::__private::Field {
                name: "count",
                offset: Self::__PLACES.offsets[1usize],
                schema: <u32 as ::raydsl::__private::Type>::SCHEMA,
            },
        ],
        size: Self::__PLACES.size,
    };
    #[inline(always)]
    fn splat<__M: ::raydsl::__private::Machine>(m: &__M, v: Self) -> SampleOn<__M> {
        SampleOn {
            value: ::raydsl::__private::Type::splat(m, v.value),
            count: ::raydsl::__private::Type::splat(m, v.count),
        }
    }
    #[inline(always)]
    fn from_lanes<__M: ::raydsl::__private::LaneMachine>(
        m: &__M,
        f: impl Fn(usize) -> Self + Copy,
    ) -> SampleOn<__M> {
        SampleOn {
            value: ::raydsl::__private::Type::from_lanes(
                m,
                #[inline(always)]
                |lane| f(lane).value,
            ),
            count: ::raydsl::__private::Type::from_lanes(
                m,
                #[inline(always)]
                |lane| f(lane).count,
            ),
        }
    }
    #[inline(always)]
    fn lane<__M: ::raydsl::__private::LaneMachine>(
        v: &SampleOn<__M>,
        lane: usize,
    ) -> Self {
        Self {
            value: ::raydsl::__private::Type::lane(&v.value, lane),
            count: ::raydsl::__private::Type::lane(&v.count, lane),
        }
    }
    fn write(&self, out: &mut [u8]) {
        ::raydsl::__private::Type::write(
            &self.value,
            &mut out[Self::__PLACES.offsets[0usize]..],
        );
        ::raydsl::__private::Type::write(
            &self.count,
            &mut out[Self::__PLACES.offsets[1usize]..],
        );
    }
    fn read(bytes: &[u8]) -> Self {
        Self {
            value: ::raydsl::__private::Type::read(
                &bytes[Self::__PLACES.offsets[0usize]..],
            ),
            count: ::raydsl::__private::Type::read(
                &bytes[Self::__PLACES.offsets[1usize]..],
            ),
        }
    }
}
#[diagnostic::do_not_recommend]
impl<__M: ::raydsl::__private::Machine> ::raydsl::__private::Capture<__M> for Sample {
    type On<'c> = SampleOn<__M>;
    #[inline(always)]
    fn capture(&self, m: &__M, name: &'static str) -> SampleOn<__M> {
        ::raydsl::__private::Machine::capture(m, name, *self)
    }
    #[inline(always)]
    fn constant(&self, m: &__M) -> SampleOn<__M> {
        ::raydsl::__private::Type::splat(m, *self)
    }
    fn resources(
        &self,
        name: &'static str,
        visit: &mut dyn ::core::ops::FnMut(&dyn ::raydsl::__private::Resource),
    ) {
        ::raydsl::__private::visit_value(*self, name, visit);
    }
}
