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
///[`ColorSphere`] on machine `M`.
#[allow(missing_docs, reason = "the members are those of the struct")]
pub struct ColorSphereOn<M: ::raydsl::__private::Machine> {
    pub center: <Vec3 as ::raydsl::__private::Type>::On<M>,
    radius: <Unorm8 as ::raydsl::__private::Type>::On<M>,
    color: <[Unorm8; 3] as ::raydsl::__private::Type>::On<M>,
}
impl<M: ::raydsl::__private::Machine> Clone for ColorSphereOn<M> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}
impl<M: ::raydsl::__private::Machine> Copy for ColorSphereOn<M> {}
impl<M: ::raydsl::__private::Machine> ::raydsl::__private::Value<M>
for ColorSphereOn<M> {
    const SCHEMA: &'static ::raydsl::__private::Schema = &::raydsl::__private::Schema::Struct {
        name: "ColorSphere",
        fields: &[
            ::raydsl::__private::Field {
                name: "center",
                offset: ::core::mem::offset_of!(ColorSphere < >, center),
                schema: <Vec3 as ::raydsl::__private::Type>::SCHEMA,
            },
            ::raydsl::__private::Field {
                name: "radius",
                offset: ::core::mem::offset_of!(ColorSphere < >, radius),
                schema: <Unorm8 as ::raydsl::__private::Type>::SCHEMA,
            },
            ::raydsl::__private::Field {
                name: "color",
                offset: ::core::mem::offset_of!(ColorSphere < >, color),
                schema: <[Unorm8; 3] as ::raydsl::__private::Type>::SCHEMA,
            },
        ],
        size: ::core::mem::size_of::<ColorSphere>(),
    };
    #[inline(always)]
    fn zero(m: &M) -> Self {
        Self {
            center: ::raydsl::__private::Value::zero(m),
            radius: ::raydsl::__private::Value::zero(m),
            color: ::raydsl::__private::Value::zero(m),
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
            center: ::raydsl::__private::Value::zip(m, a.center, b.center, f),
            radius: ::raydsl::__private::Value::zip(m, a.radius, b.radius, f),
            color: ::raydsl::__private::Value::zip(m, a.color, b.color, f),
        }
    }
}
#[diagnostic::do_not_recommend]
impl<M: ::raydsl::__private::Machine, R, Via> ::raydsl::__private::OpAdd<M, R, Via>
for ColorSphereOn<M>
where
    ColorSphere: ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("+") },
        M,
        (R,),
        Via,
        This = Self,
    >,
{
    type Output = <ColorSphere as ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("+") },
        M,
        (R,),
        Via,
    >>::Output;
    #[inline(always)]
    fn add(m: &M, a: Self, b: R) -> Self::Output {
        <ColorSphere as ::raydsl::__private::HostMethod<
            { ::raydsl::__private::name("+") },
            M,
            (R,),
            Via,
        >>::call(a, m, (b,))
    }
}
#[diagnostic::do_not_recommend]
impl<M: ::raydsl::__private::Machine, R, Via> ::raydsl::__private::OpSub<M, R, Via>
for ColorSphereOn<M>
where
    ColorSphere: ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("-") },
        M,
        (R,),
        Via,
        This = Self,
    >,
{
    type Output = <ColorSphere as ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("-") },
        M,
        (R,),
        Via,
    >>::Output;
    #[inline(always)]
    fn sub(m: &M, a: Self, b: R) -> Self::Output {
        <ColorSphere as ::raydsl::__private::HostMethod<
            { ::raydsl::__private::name("-") },
            M,
            (R,),
            Via,
        >>::call(a, m, (b,))
    }
}
#[diagnostic::do_not_recommend]
impl<M: ::raydsl::__private::Machine, R, Via> ::raydsl::__private::OpMul<M, R, Via>
for ColorSphereOn<M>
where
    ColorSphere: ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("*") },
        M,
        (R,),
        Via,
        This = Self,
    >,
{
    type Output = <ColorSphere as ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("*") },
        M,
        (R,),
        Via,
    >>::Output;
    #[inline(always)]
    fn mul(m: &M, a: Self, b: R) -> Self::Output {
        <ColorSphere as ::raydsl::__private::HostMethod<
            { ::raydsl::__private::name("*") },
            M,
            (R,),
            Via,
        >>::call(a, m, (b,))
    }
}
#[diagnostic::do_not_recommend]
impl<M: ::raydsl::__private::Machine, R, Via> ::raydsl::__private::OpDiv<M, R, Via>
for ColorSphereOn<M>
where
    ColorSphere: ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("/") },
        M,
        (R,),
        Via,
        This = Self,
    >,
{
    type Output = <ColorSphere as ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("/") },
        M,
        (R,),
        Via,
    >>::Output;
    #[inline(always)]
    fn div(m: &M, a: Self, b: R) -> Self::Output {
        <ColorSphere as ::raydsl::__private::HostMethod<
            { ::raydsl::__private::name("/") },
            M,
            (R,),
            Via,
        >>::call(a, m, (b,))
    }
}
#[diagnostic::do_not_recommend]
impl<M: ::raydsl::__private::Machine, R, Via> ::raydsl::__private::OpRem<M, R, Via>
for ColorSphereOn<M>
where
    ColorSphere: ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("%") },
        M,
        (R,),
        Via,
        This = Self,
    >,
{
    type Output = <ColorSphere as ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("%") },
        M,
        (R,),
        Via,
    >>::Output;
    #[inline(always)]
    fn rem(m: &M, a: Self, b: R) -> Self::Output {
        <ColorSphere as ::raydsl::__private::HostMethod<
            { ::raydsl::__private::name("%") },
            M,
            (R,),
            Via,
        >>::call(a, m, (b,))
    }
}
#[diagnostic::do_not_recommend]
impl<M: ::raydsl::__private::Machine> ::raydsl::__private::OpNeg<M> for ColorSphereOn<M>
where
    ColorSphere: ::raydsl::__private::HostMethod<
        { ::raydsl::__private::name("-x") },
        M,
        (),
        This = Self,
        Output = Self,
    >,
{
    #[inline(always)]
    fn neg(m: &M, a: Self) -> Self {
        <ColorSphere as ::raydsl::__private::HostMethod<
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
> ::raydsl::__private::Assigned<NAME, M, R, Via> for ColorSphereOn<M>
where
    ColorSphere: ::raydsl::__private::HostMethod<
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
        <ColorSphere as ::raydsl::__private::HostMethod<
            NAME,
            M,
            (R,),
            Via,
        >>::call_at(a, &variable, m, (b,));
        variable.get(m)
    }
}
impl<M: ::raydsl::__private::Machine> ::raydsl::__private::RightOperand
for ColorSphereOn<M> {
    type Host = ColorSphere;
}
#[diagnostic::do_not_recommend]
impl<M: ::raydsl::__private::Machine> ::raydsl::__private::Inferred<M>
for ColorSphereOn<M> {
    type Host = ColorSphere;
    #[inline(always)]
    fn give(self, _: &M) -> Self {
        self
    }
}
impl<M: ::raydsl::__private::Machine> ::raydsl::__private::Twin<M> for ColorSphereOn<M> {
    #[inline(always)]
    fn from_host(v: Self) -> Self {
        v
    }
}
#[diagnostic::do_not_recommend]
impl<M: ::raydsl::__private::Machine> ::raydsl::__private::Varying<M>
for ColorSphereOn<M> {
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
> ::raydsl::__private::Method<NAME, M, A, Via> for ColorSphereOn<M>
where
    ColorSphere: ::raydsl::__private::HostMethod<NAME, M, A, Via, This = Self>,
{
    type Output = <ColorSphere as ::raydsl::__private::HostMethod<
        NAME,
        M,
        A,
        Via,
    >>::Output;
    const IS_MUT: bool = <ColorSphere as ::raydsl::__private::HostMethod<
        NAME,
        M,
        A,
        Via,
    >>::IS_MUT;
    #[inline(always)]
    fn call(self, m: &M, args: A) -> Self::Output {
        <ColorSphere as ::raydsl::__private::HostMethod<
            NAME,
            M,
            A,
            Via,
        >>::call(self, m, args)
    }
    #[inline(always)]
    fn call_at(
        self,
        variable: &::raydsl::__private::Var<Self>,
        m: &M,
        args: A,
    ) -> Self::Output {
        <ColorSphere as ::raydsl::__private::HostMethod<
            NAME,
            M,
            A,
            Via,
        >>::call_at(self, variable, m, args)
    }
}
#[diagnostic::do_not_recommend]
impl ::raydsl::__private::Type for ColorSphere {
    type On<M: ::raydsl::__private::Machine> = ColorSphereOn<M>;
    const SCHEMA: &'static ::raydsl::__private::Schema = &::raydsl::__private::Schema::Struct {
        name: "ColorSphere",
        fields: &[
            ::raydsl::__private::Field {
                name: "center",
                offset: ::core::mem::offset_of!(ColorSphere < >, center),
                schema: <Vec3 as ::raydsl::__private::Type>::SCHEMA,
            },
            ::raydsl::__private::Field {
                name: "radius",
                offset: ::core::mem::offset_of!(ColorSphere < >, radius),
                schema: <Unorm8 as ::raydsl::__private::Type>::SCHEMA,
            },
            ::raydsl::__private::Field {
                name: "color",
                offset: ::core::mem::offset_of!(ColorSphere < >, color),
                schema: <[Unorm8; 3] as ::raydsl::__private::Type>::SCHEMA,
            },
        ],
        size: ::core::mem::size_of::<ColorSphere>(),
    };
    #[inline(always)]
    fn splat<M: ::raydsl::__private::Machine>(m: &M, v: Self) -> ColorSphereOn<M> {
        ColorSphereOn {
            center: ::raydsl::__private::Type::splat(m, v.center),
            radius: ::raydsl::__private::Type::splat(m, v.radius),
            color: ::raydsl::__private::Type::splat(m, v.color),
        }
    }
    #[inline(always)]
    fn from_lanes<M: ::raydsl::__private::LaneMachine>(
        m: &M,
        f: &impl Fn(usize) -> Self,
    ) -> ColorSphereOn<M> {
        ColorSphereOn {
            center: ::raydsl::__private::Type::from_lanes(m, &|lane| f(lane).center),
            radius: ::raydsl::__private::Type::from_lanes(m, &|lane| f(lane).radius),
            color: ::raydsl::__private::Type::from_lanes(m, &|lane| f(lane).color),
        }
    }
    #[inline(always)]
    fn lane<M: ::raydsl::__private::LaneMachine>(
        v: &ColorSphereOn<M>,
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
            &mut out[::core::mem::offset_of!(ColorSphere < >, center)..],
        );
        ::raydsl::__private::Type::write(
            &self.radius,
            &mut out[::core::mem::offset_of!(ColorSphere < >, radius)..],
        );
        ::raydsl::__private::Type::write(
            &self.color,
            &mut out[::core::mem::offset_of!(ColorSphere < >, color)..],
        );
    }
    fn read(bytes: &[u8]) -> Self {
        Self {
            center: ::raydsl::__private::Type::read(
                &bytes[::core::mem::offset_of!(ColorSphere < >, center)..],
            ),
            radius: ::raydsl::__private::Type::read(
                &bytes[::core::mem::offset_of!(ColorSphere < >, radius)..],
            ),
            color: ::raydsl::__private::Type::read(
                &bytes[::core::mem::offset_of!(ColorSphere < >, color)..],
            ),
        }
    }
}
#[diagnostic::do_not_recommend]
impl<M: ::raydsl::__private::Machine> ::raydsl::__private::Capture<M> for ColorSphere {
    type On<'c> = ColorSphereOn<M>;
    #[inline(always)]
    fn capture(&self, m: &M, name: &'static str) -> ColorSphereOn<M> {
        ::raydsl::__private::Machine::capture(m, name, *self)
    }
    #[inline(always)]
    fn constant(&self, m: &M) -> ColorSphereOn<M> {
        ::raydsl::__private::Type::splat(m, *self)
    }
}
const _: () = assert!(
    ::core::mem::size_of:: < ColorSphere > () == 0 + ::core::mem::size_of:: < Vec3 > () +
    ::core::mem::size_of:: < Unorm8 > () + ::core::mem::size_of:: < [Unorm8; 3] > (),
    concat!("the primitive `", stringify!(ColorSphere),
    "` has gaps between its members: ",
    "order them by size, or fill the gaps with members of your own",),
);
