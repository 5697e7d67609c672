//! Do the variants agree, and what does each cost?
//!
//! [`explain`] says which differences rounding accounts for. [`compare`] runs a kernel in any set
//! of variants and says where they differ from the scalar one, in bits: the yardstick is the user's
//! own function.
//!
//! [`work_precision`] measures error against run time of any computation by several methods.

mod accuracy;
mod agreement;
mod comparison;
mod explain;
mod json;
#[cfg(feature = "image")]
mod pictures;
mod table;
mod timing;
mod utilisation;
pub mod work_precision;

pub use accuracy::Accuracy;
pub(crate) use agreement::differing;
pub use agreement::{Agreement, BUCKETS};
pub use comparison::{Compare, Comparison, Missing, Row, Verdict, compare};
pub use explain::{Cause, Explanation, Sample, explain};
pub use json::SceneInfo;
#[cfg(feature = "image")]
pub use pictures::WriteError;
pub use timing::Times;
pub use utilisation::{LineCount, Utilisation, utilisation};

/// How many inputs a sample has, unless it is told otherwise.
const SAMPLES: usize = 4096;
