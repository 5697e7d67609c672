//! 16-bit floats: IEEE 754's `binary16`.

use super::code::code;
use crate::kernel;
use crate::machine::{
    Capture, F, LaneMachine, Leaves, Machine, Method, Resource, Schema, Type, U, Value, Varying,
    name, visit_value,
};

code!(
    /// 16-bit float (`binary16`): 11 significant bits, up to 65504, in steps of 2^-24 near 0.
    ///
    /// For storage only; kernels compute with the exact `f32` of [`to_f32`](F16::to_f32). Two are
    /// compared by their code.
    #[derive(PartialEq, Eq, Hash)]
    F16, F16On, u16, &Schema::Small { bytes: 2 }
);

/// Decodes a code; all but its lowest 16 bits are 0.
#[kernel]
pub(crate) fn half_to_f32(bits: u32) -> f32 {
    let sign = (bits & 0x8000) << 16;
    let size = bits & 0x7fff;
    // Shift fraction and exponent up, and increase the exponent's bias from 15 to 127.
    let normal = (size << 13) + 0x3800_0000;
    // Infinity and NaN have the largest exponent there too.
    let finite_or_not = if size < 0x7c00 { normal } else { normal + 0x3800_0000 };
    // Without an exponent it is a multiple of 2^-24.
    let subnormal = (size as f32 * 5.9604645e-8).to_bits();
    let magnitude = if size < 0x400 { subnormal } else { finite_or_not };
    f32::from_bits(magnitude | sign)
}

impl F16 {
    /// Encodes `v` as the nearest number; ties go to the even code. Beyond 65520 it is infinite,
    /// and NaN stays NaN.
    pub fn new(v: f32) -> Self {
        let sign = (v.to_bits() >> 16 & 0x8000) as u16;
        Self(sign | size_of_half(v.abs()))
    }

    /// Returns the number, exactly.
    #[inline]
    pub fn to_f32(self) -> f32 {
        half_to_f32(u32::from(self.0))
    }
}

impl From<f32> for F16 {
    fn from(v: f32) -> Self {
        Self::new(v)
    }
}

/// Returns the code of a number without a sign.
fn size_of_half(v: f32) -> u16 {
    if v.is_nan() {
        return 0x7e00;
    }
    if v >= 65520.0 {
        return 0x7c00;
    }
    // Below 2^-14 the steps are 2^-24; the product only changes the exponent, so it is exact.
    if v < 6.103_515_6e-5 {
        return (v * 16_777_216.0).round_ties_even() as u16;
    }
    // Rounding may carry into the exponent, as it should.
    let bits = v.to_bits();
    let rounded = bits + 0xfff + (bits >> 13 & 1);
    ((rounded - 0x3800_0000) >> 13) as u16
}

#[diagnostic::do_not_recommend]
impl<M: Machine> Method<{ name("to_f32") }, M, ()> for F16On<M> {
    type Output = F<M>;

    #[inline(always)]
    fn call(self, m: &M, (): ()) -> F<M> {
        half_to_f32::on(m, self.bits)
    }
}
