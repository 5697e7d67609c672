//! Numbers with few bits, and elementary functions.

mod elementary;
mod unorm;

pub use elementary::{
    SinCos, SinCosOn, acos, asin, atan, atan2, cos, exp, exp2, expm1, log, log1p, log2, pow, sin,
    sincos_2pi, tan,
};
pub use unorm::{Unorm8, Unorm8On, Unorm16, Unorm16On, Unorm32, Unorm32On};
