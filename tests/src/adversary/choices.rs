//! Choices that bytes make.

use raydsl::prelude::*;

/// Bytes that are used up by choosing; afterwards the first of everything is chosen.
#[derive(Debug)]
pub struct Choices<'a> {
    bytes: &'a [u8],
}

impl<'a> Choices<'a> {
    /// The choices of these bytes.
    pub const fn new(bytes: &'a [u8]) -> Self {
        Self { bytes }
    }

    fn byte(&mut self) -> u8 {
        match self.bytes.split_first() {
            Some((byte, rest)) => {
                self.bytes = rest;
                *byte
            }
            None => 0,
        }
    }

    /// A number in `0..n`; 0 if there is none.
    pub fn below(&mut self, n: usize) -> usize {
        let wide = u16::from_le_bytes([self.byte(), if n > 256 { self.byte() } else { 0 }]);
        usize::from(wide) % n.max(1)
    }

    /// One of these.
    pub fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(from.len())]
    }

    /// A number in `-1..=1`; every third one is a multiple of a quarter, which others are too.
    pub fn number(&mut self) -> f32 {
        let fine = i16::from_le_bytes([self.byte(), self.byte()]);
        match fine.rem_euclid(3) {
            0 => f32::from(fine >> 13) * 0.25,
            _ => f32::from(fine) / 32768.0,
        }
    }

    /// A point of the cube `-1..=1`.
    pub fn point(&mut self) -> Vec3 {
        vec3(self.number(), self.number(), self.number())
    }

    /// A direction along an axis.
    pub fn axis(&mut self) -> Vec3 {
        self.pick(&[Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z])
    }

    /// A transform: with an inverse, mostly.
    pub fn map(&mut self) -> Affine3 {
        let scale = self.pick(&[1.0, 1e-3, 50.0, 1e6]);
        let matrix3 = match self.below(4) {
            0 => Mat3::IDENTITY,
            1 => Mat3::from_diagonal(self.point()),
            _ => Mat3::from_cols(self.point(), self.point(), self.point()),
        };
        Affine3 { matrix3: matrix3 * scale, translation: self.point() * self.pick(&[1.0, 100.0]) }
    }
}
