#![doc = include_str!("../README.md")]

mod accuracy;
mod comparison;
mod json;
#[cfg(feature = "image")]
mod pictures;
mod table;
mod timing;
mod utilisation;
pub mod work_precision;

pub use accuracy::Accuracy;
pub use comparison::{Compare, Comparison, Missing, Row, Verdict, compare};
pub use json::SceneInfo;
#[cfg(feature = "image")]
pub use pictures::WriteError;
pub use timing::Times;
pub use utilisation::{LineCount, Utilisation, utilisation};
