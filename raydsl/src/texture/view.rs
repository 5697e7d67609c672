//! View of a texture in kernels: a host value on every machine.
//!
//! Texels are read in place. Filter, address modes and colour space are known while a kernel is
//! recorded; sizes and the border are captured where they are used, so they are numbers of the
//! uniform block.

use glam::{UVec2, UVec3, Vec4};

use super::config::{Address, Filter, Filtering, LevelFilter, TextureConfig};
use super::texel::{Texel, TexelValue};
use crate::Type;
use crate::machine::wgsl::BufferKey;
use crate::machine::{Leaves, Machine, Method, Parameter, Schema, Slice, U, Value, X2, X3, name};

/// Texels of a texture and their settings, whatever its dimension.
#[derive(Debug)]
pub struct Texels<'a, T> {
    pub(super) all: &'a [T],
    /// 1 for missing axes.
    pub(super) size: [u32; 3],
    pub(super) levels: u32,
    /// Missing axes are clamped.
    pub(super) config: TextureConfig,
    /// Device key of the texels, if their owner is known.
    pub(super) key: Option<BufferKey>,
    /// Name in the source.
    pub(super) name: &'static str,
}

impl<T> Clone for Texels<'_, T> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Texels<'_, T> {}

impl<'a, T> Texels<'a, T> {
    #[inline(always)]
    pub(crate) fn slice(&self) -> Slice<'a, T> {
        Slice::owned(self.all, self.key, self.name)
    }

    /// Returns the texels as they are read from a buffer, whatever a sampler makes of them.
    pub(super) fn exact(&self) -> Self {
        let config = TextureConfig { filtering: Filtering::Exact, ..self.config };
        Self { config, ..*self }
    }
}

/// Size in the uniform block: `tiles_size`.
#[derive(Clone, Copy, Type)]
struct Extent<S: Type> {
    size: S,
}

/// Border in the uniform block: `tiles_border`.
#[derive(Clone, Copy, Type)]
struct Border<V: TexelValue> {
    border: V,
}

/// Last level in the uniform block: `tiles_last_level`.
#[derive(Clone, Copy, Type)]
struct Levels {
    last_level: u32,
}

/// Defines methods of kernels: `name(self, arguments) -> type on the host, type on a machine`.
macro_rules! methods {
    ($(
        $(#[$doc:meta])*
        $name:ident ($this:ident) -> $host:ty { $e:expr }
        on ($m:ident) -> $twin:ty { $on:expr }
    )+) => {
        impl<T: Texel> Texels<'_, T> {
            $(
                $(#[$doc])*
                #[inline(always)]
                pub(super) fn $name(&self) -> $host {
                    let $this = self;
                    $e
                }
            )+
        }
        $(
            #[diagnostic::do_not_recommend]
            impl<M: Machine, T: Texel> Method<{ name(stringify!($name)) }, M, ()>
                for Texels<'_, T>
            {
                type Output = $twin;

                #[inline(always)]
                fn call(self, $m: &M, (): ()) -> $twin {
                    let $this = self;
                    $on
                }
            }
        )+
    };
}

/// Defines methods whose result is known while a kernel is recorded.
macro_rules! known {
    ($($(#[$doc:meta])* $name:ident ($this:ident) -> $host:ty { $e:expr })+) => {
        methods! {
            $($(#[$doc])* $name ($this) -> $host { $e } on (_m) -> $host { $e })+
        }
    };
}

known! {
    /// Returns whether a texel may be the border.
    has_border(t) -> bool { t.config.address.contains(&Address::Border) }
    has_levels(t) -> bool { t.levels > 1 }
    blends_levels(t) -> bool { t.config.level_filter == LevelFilter::Linear }
    is_nearest(t) -> bool { t.config.filter == Filter::Nearest }
    is_linear(t) -> bool { t.config.filter == Filter::Linear }
    filter(t) -> Filter { t.config.filter }
    address_u(t) -> Address { t.config.address[0] }
    address_v(t) -> Address { t.config.address[1] }
    address_w(t) -> Address { t.config.address[2] }
}

methods! {
    size1(t) -> u32 { t.size[0] }
    on(m) -> U<M> { m.capture(t.name, Extent { size: t.size[0] }).size }

    size2(t) -> UVec2 { UVec2::new(t.size[0], t.size[1]) }
    on(m) -> X2<U<M>> { m.capture(t.name, Extent { size: t.size2() }).size }

    size3(t) -> UVec3 { UVec3::from(t.size) }
    on(m) -> X3<U<M>> { m.capture(t.name, Extent { size: t.size3() }).size }

    last_level(t) -> u32 { t.levels - 1 }
    on(m) -> U<M> { m.capture(t.name, Levels { last_level: t.levels - 1 }).last_level }

    zero_value(_t) -> T::Value { T::Value::from_channels([0.0; 4]) }
    on(m) -> <T::Value as Type>::On<M> { Value::zero(m) }

    border(t) -> T::Value { T::Value::from_channels(t.config.border.to_array()) }
    on(m) -> <T::Value as Type>::On<M> { m.capture(t.name, Border { border: t.border() }).border }
}

impl<T: Texel> Texels<'_, T> {
    /// Returns the value of texel `i`, which must exist.
    #[inline(always)]
    pub(super) fn value(&self, i: u32) -> T::Value {
        self.all[i as usize].decode(self.config.color_space)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, T: Texel> Method<{ name("value") }, M, (U<M>,)> for Texels<'_, T> {
    type Output = <T::Value as Type>::On<M>;

    #[inline(always)]
    fn call(self, m: &M, (i,): (U<M>,)) -> Self::Output {
        let texel = m.fetch(&self.slice(), i);
        self.as_read(m, T::decode_on(m, texel, self.config.color_space))
    }
}

/// Returns whether two configurations are the same, including borders of NaN.
fn is_same_config(a: &TextureConfig, b: &TextureConfig) -> bool {
    let bits = |config: &TextureConfig| config.border.to_array().map(f32::to_bits);
    let rest = |config: &TextureConfig| TextureConfig { border: Vec4::ZERO, ..*config };
    bits(a) == bits(b) && rest(a) == rest(b)
}

impl<T: Type> Parameter for Texels<'_, T> {
    type On<'a, M: Machine> = Texels<'a, T>;
}

impl<M: Machine, T> Value<M> for Texels<'_, T> {
    const SCHEMA: &'static Schema = &Schema::Host;

    #[inline(always)]
    fn zero(_: &M) -> Self {
        let config = TextureConfig::default();
        Self { all: &[], size: [1; 3], levels: 1, config, key: None, name: "texture" }
    }

    #[inline(always)]
    fn zip(_: &M, a: Self, b: Self, _: &mut impl Leaves<M>) -> Self {
        // An empty texture is the zero value of a declared variable.
        if a.all.is_empty() {
            return b;
        }
        let is_same = || {
            core::ptr::eq(a.all, b.all) && a.size == b.size && is_same_config(&a.config, &b.config)
        };
        assert!(
            b.all.is_empty() || is_same(),
            "a kernel cannot choose between two textures by a value of its rays: choose between \
             what it reads from them, or by a captured `bool`"
        );
        a
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_border_of_nan_is_the_same_border() {
        let nan = TextureConfig::new().border(Vec4::NAN);
        assert!(is_same_config(&nan, &nan));
        assert!(!is_same_config(&nan, &nan.border(Vec4::ZERO)));
        assert!(!is_same_config(&nan, &nan.filter(Filter::Nearest)));
    }
}
