#[derive(Clone)]
#[derive(Copy)]
#[repr(C)]
/// A sphere.
#[derive(Debug)]
pub struct ColorSphere {
    pub center: Vec3,
    radius: Unorm8,
    color: [Unorm8; 3],
}
///[`ColorSphere`] on a machine.
#[allow(missing_docs, reason = "the members are those of the struct")]
pub struct ColorSphereOn<__M: ::raydsl::__private::Machine> {
    pub center: <Vec3 as ::raydsl::__private::Type>::On<__M>,
    radius: <Unorm8 as ::raydsl::__private::Type>::On<__M>,
    color: <[Unorm8; 3] as ::raydsl::__private::Type>::On<__M>,
}
impl<__M: ::raydsl::__private::Machine> Clone for ColorSphereOn<__M> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}
impl<__M: ::raydsl::__private::Machine> Copy for ColorSphereOn<__M> {}
#[doc(hidden)]
impl ColorSphere {
    const __PLACES: ::raydsl::__private::Places<3usize> = ::raydsl::__private::Places::new(
        ::core::mem::size_of::<Self>(),
        [
            ::core::mem::offset_of!(Self, center),
            ::core::mem::offset_of!(Self, radius),
            ::core::mem::offset_of!(Self, color),
        ],
        [
            ::core::mem::size_of::<Vec3>(),
            ::core::mem::size_of::<Unorm8>(),
            ::core::mem::size_of::<[Unorm8; 3]>(),
        ],
        [
            <Vec3 as ::raydsl::__private::Type>::SCHEMA,
            <Unorm8 as ::raydsl::__private::Type>::SCHEMA,
            <[Unorm8; 3] as ::raydsl::__private::Type>::SCHEMA,
        ],
    );
}
impl<__M: ::raydsl::__private::Machine> ::raydsl::__private::Value<__M>
for ColorSphereOn<__M> {
    const SCHEMA: &'static ::raydsl::__private::Schema = <ColorSphere as ::raydsl::__private::Type>::SCHEMA;
    #[inline(always)]
    fn zero(m: &__M) -> Self {
        Self {
            center: ::raydsl::__private::Value::zero(m),
            radius: ::raydsl::__private::Value::zero(m),
            color: ::raydsl::__private::Value::zero(m),
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
            center: ::raydsl::__private::Value::zip(m, a.center, b.center, f),
            radius: ::raydsl::__private::Value::zip(m, a.radius, b.radius, f),
            color: ::raydsl::__private::Value::zip(m, a.color, b.color, f),
        }
    }
}
#[diagnostic::do_not_recommend]
impl<
    __M: ::raydsl::__private::Machine,
    __Right,
    __Via,
> ::raydsl::__private::OpAdd<__M, __Right, __Via> for ColorSphereOn<__M>
where
    ColorSphere: ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("+") },
        __M,
        (__Right,),
        __Via,
        This = Self,
    >,
{
    type Output = <ColorSphere as ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("+") },
        __M,
        (__Right,),
        __Via,
    >>::Output;
    #[inline(always)]
    fn add(m: &__M, a: Self, b: __Right) -> Self::Output {
        <ColorSphere as ::raydsl::__private::HostMethod<
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
> ::raydsl::__private::OpSub<__M, __Right, __Via> for ColorSphereOn<__M>
where
    ColorSphere: ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("-") },
        __M,
        (__Right,),
        __Via,
        This = Self,
    >,
{
    type Output = <ColorSphere as ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("-") },
        __M,
        (__Right,),
        __Via,
    >>::Output;
    #[inline(always)]
    fn sub(m: &__M, a: Self, b: __Right) -> Self::Output {
        <ColorSphere as ::raydsl::__private::HostMethod<
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
> ::raydsl::__private::OpMul<__M, __Right, __Via> for ColorSphereOn<__M>
where
    ColorSphere: ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("*") },
        __M,
        (__Right,),
        __Via,
        This = Self,
    >,
{
    type Output = <ColorSphere as ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("*") },
        __M,
        (__Right,),
        __Via,
    >>::Output;
    #[inline(always)]
    fn mul(m: &__M, a: Self, b: __Right) -> Self::Output {
        <ColorSphere as ::raydsl::__private::HostMethod<
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
> ::raydsl::__private::OpDiv<__M, __Right, __Via> for ColorSphereOn<__M>
where
    ColorSphere: ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("/") },
        __M,
        (__Right,),
        __Via,
        This = Self,
    >,
{
    type Output = <ColorSphere as ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("/") },
        __M,
        (__Right,),
        __Via,
    >>::Output;
    #[inline(always)]
    fn div(m: &__M, a: Self, b: __Right) -> Self::Output {
        <ColorSphere as ::raydsl::__private::HostMethod<
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
> ::raydsl::__private::OpRem<__M, __Right, __Via> for ColorSphereOn<__M>
where
    ColorSphere: ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("%") },
        __M,
        (__Right,),
        __Via,
        This = Self,
    >,
{
    type Output = <ColorSphere as ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("%") },
        __M,
        (__Right,),
        __Via,
    >>::Output;
    #[inline(always)]
    fn rem(m: &__M, a: Self, b: __Right) -> Self::Output {
        <ColorSphere as ::raydsl::__private::HostMethod<
            { ::raydsl::__private::name("%") },
            __M,
            (__Right,),
            __Via,
        >>::call(a, m, (b,))
    }
}
#[diagnostic::do_not_recommend]
impl<__M: ::raydsl::__private::Machine> ::raydsl::__private::OpNeg<__M>
for ColorSphereOn<__M>
where
    ColorSphere: ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("-x") },
        __M,
        (),
        This = Self,
        Output = Self,
    >,
{
    #[inline(always)]
    fn neg(m: &__M, a: Self) -> Self {
        <ColorSphere as ::raydsl::__private::HostMethod<
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
> ::raydsl::__private::Assigned<__NAME, __M, __Right, __Via> for ColorSphereOn<__M>
where
    ColorSphere: ::raydsl::__private::HostMethod<
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
        <ColorSphere as ::raydsl::__private::HostMethod<
            __NAME,
            __M,
            (__Right,),
            __Via,
        >>::call_at(a, &variable, m, (b,));
        variable.get(m)
    }
}
impl<__M: ::raydsl::__private::Machine> ::raydsl::__private::RightOperand
for ColorSphereOn<__M> {
    type Host = ColorSphere;
}
#[diagnostic::do_not_recommend]
impl<__M: ::raydsl::__private::Machine> ::raydsl::__private::Inferred<__M>
for ColorSphereOn<__M> {
    type Host = ColorSphere;
    #[inline(always)]
    fn give(self, _: &__M) -> Self {
        self
    }
}
impl<__M: ::raydsl::__private::Machine> ::raydsl::__private::Twin<__M>
for ColorSphereOn<__M> {
    #[inline(always)]
    fn from_host(v: Self) -> Self {
        v
    }
}
#[diagnostic::do_not_recommend]
impl<__M: ::raydsl::__private::Machine> ::raydsl::__private::Varying<__M>
for ColorSphereOn<__M> {
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
> ::raydsl::__private::Method<__NAME, __M, __Args, __Via> for ColorSphereOn<__M>
where
    ColorSphere: ::raydsl::__private::HostMethod<
        __NAME,
        __M,
        __Args,
        __Via,
        This = Self,
    >,
{
    type Output = <ColorSphere as ::raydsl::__private::HostMethod<
        __NAME,
        __M,
        __Args,
        __Via,
    >>::Output;
    const IS_MUT: bool = <ColorSphere as ::raydsl::__private::HostMethod<
        __NAME,
        __M,
        __Args,
        __Via,
    >>::IS_MUT;
    #[inline(always)]
    fn call(self, m: &__M, args: __Args) -> Self::Output {
        <ColorSphere as ::raydsl::__private::HostMethod<
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
        <ColorSphere as ::raydsl::__private::HostMethod<
            __NAME,
            __M,
            __Args,
            __Via,
        >>::call_at(self, variable, m, args)
    }
}
#[diagnostic::do_not_recommend]
impl ::raydsl::__private::KernelType for ColorSphere {
    type Twin<__M: ::raydsl::__private::Machine> = <Self as ::raydsl::__private::Type>::On<
        __M,
    >;
    #[inline(always)]
    fn same<__M: ::raydsl::__private::Machine>(v: Self::Twin<__M>) -> Self::Twin<__M> {
        v
    }
}
#[diagnostic::do_not_recommend]
impl ::raydsl::__private::Type for ColorSphere {
    type On<__M: ::raydsl::__private::Machine> = ColorSphereOn<__M>;
    const SCHEMA: &'static ::raydsl::__private::Schema = &::raydsl::__private::Schema::Struct {
        name: "ColorSphere",
        fields: &[
            ::raydsl::__private::Field {
                name: "center",
                offset: Self::__PLACES.offsets[0usize],
                schema: <Vec3 as ::raydsl::__private::Type>::SCHEMA,
            },
            ::raydsl::__private::Field {
                name: "radius",
                offset: Self::__PLACES.offsets[1usize],
                schema: <Unorm8 as ::raydsl::__private::Type>::SCHEMA,
            },
            ::raydsl::__private::Field {
                name: "color",
                offset: Self::__PLACES.offsets[2usize],
                schema: <[Unorm8; 3] as ::raydsl::__private::Type>::SCHEMA,
            },
        ],
        size: Self::__PLACES.size,
    };
    #[inline(always)]
    fn splat<__M: ::raydsl::__private::Machine>(m: &__M, v: Self) -> ColorSphereOn<__M> {
        ColorSphereOn {
            center: ::raydsl::__private::Type::splat(m, v.center),
            radius: ::raydsl::__private::Type::splat(m, v.radius),
            color: ::raydsl::__private::Type::splat(m, v.color),
        }
    }
    #[inline(always)]
    fn from_lanes<__M: ::raydsl::__private::LaneMachine>(
        m: &__M,
        f: impl Fn(usize) -> Self + Copy,
    ) -> ColorSphereOn<__M> {
        ColorSphereOn {
            center: ::raydsl::__private::Type::from_lanes(
                m,
                #[inline(always)]
                |lane| f(lane).center,
            ),
            radius: ::raydsl::__private::Type::from_lanes(
                m,
                #[inline(always)]
                |lane| f(lane).radius,
            ),
            color: ::raydsl::__private::Type::from_lanes(
                m,
                #[inline(always)]
                |lane| f(lane).color,
            ),
        }
    }
    #[inline(always)]
    fn lane<__M: ::raydsl::__private::LaneMachine>(
        v: &ColorSphereOn<__M>,
        lane: usize,
    ) -> Self {
        Self {
            center: ::raydsl::__private::Type::lane(&v.center, lane),
            radius: ::raydsl::__private::Type::lane(&v.radius, lane),
            color: ::raydsl::__private::Type::lane(&v.color, lane),
        }
    }
    fn write(&self, out: &mut [u8]) {
        ::raydsl::__private::Type::write(
            &self.center,
            &mut out[Self::__PLACES.offsets[0usize]..],
        );
        ::raydsl::__private::Type::write(
            &self.radius,
            &mut out[Self::__PLACES.offsets[1usize]..],
        );
        ::raydsl::__private::Type::write(
            &self.color,
            &mut out[Self::__PLACES.offsets[2usize]..],
        );
    }
    fn read(bytes: &[u8]) -> Self {
        Self {
            center: ::raydsl::__private::Type::read(
                &bytes[Self::__PLACES.offsets[0usize]..],
            ),
            radius: ::raydsl::__private::Type::read(
                &bytes[Self::__PLACES.offsets[1usize]..],
            ),
            color: ::raydsl::__private::Type::read(
                &bytes[Self::__PLACES.offsets[2usize]..],
            ),
        }
    }
}
#[diagnostic::do_not_recommend]
impl<__M: ::raydsl::__private::Machine> ::raydsl::__private::Capture<__M>
for ColorSphere {
    type On<'c> = ColorSphereOn<__M>;
    #[inline(always)]
    fn capture(&self, m: &__M, name: &'static str) -> ColorSphereOn<__M> {
        ::raydsl::__private::Machine::capture(m, name, *self)
    }
    #[inline(always)]
    fn constant(&self, m: &__M) -> ColorSphereOn<__M> {
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
const _: () = ::core::assert!(
    ::core::mem::size_of:: < ColorSphere > () == ::core::mem::size_of:: < Vec3 > () +
    ::core::mem::size_of:: < Unorm8 > () + ::core::mem::size_of:: < [Unorm8; 3] > (),
    ::core::concat!("the primitive `", ::core::stringify!(ColorSphere),
    "` has gaps between its members\n",
    "  help: order them by size, or fill the gaps with members of your own",),
);
