//! Do the variants agree, and what does each cost?
//!
//! [`compare`] runs a kernel in any set of variants and says where they differ from the scalar
//! one, in bits: the yardstick is the user's own function.

mod agreement;
mod comparison;
mod json;
#[cfg(feature = "image")]
mod pictures;
mod table;
mod timing;

pub use agreement::{Agreement, BUCKETS};
pub use comparison::{Compare, Comparison, Row, compare};
pub use json::SceneInfo;
#[cfg(feature = "image")]
pub use pictures::WriteError;
pub use timing::Times;
