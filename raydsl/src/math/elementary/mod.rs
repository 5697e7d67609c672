//! Elementary functions: `sin`, `exp`, `pow` and their like, one source for every variant.
//!
//! std's functions of these names call the platform's library and differ between machines. These
//! are kernels like any other: made of `+ - * /`, `sqrt`, `floor`, comparisons and integer
//! operations, so scalars and packets of every width return the same bits. In WGSL they are the
//! same operations; a driver may change results by a few ulp.
//!
//! Errors are given in ulp, the distance of neighbouring results, against `f64`: the largest one
//! found among every seventh of all 2^32 bit patterns, or 600 million pairs. None is above 4.
//! Denormal arguments and results are as accurate as others on the CPU; a GPU may flush them to 0.
//! A NaN returns a NaN, with the exceptions that [`pow()`] names.
//!
//! Where one `f32` is not precise enough, a value is the sum of two, the upper with 12 bits:
//! products of such heads are exact. Heads are cut by a bit mask, never by the customary
//! `a - (a - b)`, which drivers simplify. The range reductions are those of Cody and Waite,
//! "Software Manual for the Elementary Functions" (1980), and of Payne and Hanek, "Radian reduction
//! for trigonometric functions" (1983); see Muller, "Elementary Functions" (2016), chapter 11. The
//! coefficients are minimax fits of the relative error (Remez' exchange), rounded to `f32` one
//! after another, with a new fit of the rest after each.

mod bounds;
mod exponential;
mod function;
mod inverse;
mod logarithm;
mod parts;
mod power;
mod trigonometric;

pub use exponential::{exp, exp2, expm1};
pub use inverse::{acos, asin, atan, atan2};
pub use logarithm::{log, log1p, log2};
pub use power::pow;
pub use trigonometric::{SinCos, SinCosOn, cos, sin, sincos_2pi, tan};
