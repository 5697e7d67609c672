#![doc = include_str!("../README.md")]
// On docs.rs, whose compiler is a nightly, items tell the feature that they need.
#![cfg_attr(docsrs, feature(doc_cfg))]

mod accuracy;
mod comparison;
mod json;
mod legend;
#[cfg(feature = "image")]
mod pictures;
#[cfg(feature = "program")]
mod program;
mod table;
mod ticks;
mod timing;
mod utilisation;
pub mod work_precision;

pub use accuracy::Accuracy;
pub use comparison::{Compare, Comparison, Missing, Row, Verdict, compare};
pub use json::SceneInfo;
pub use legend::{Legend, Side};
#[cfg(feature = "image")]
pub use pictures::WriteError;
#[cfg(feature = "program")]
pub use program::{InvalidProgram, Program, ProgramSize};
pub use ticks::Ticks;
pub use timing::Times;
pub use utilisation::{LineCount, Utilisation, utilisation};
