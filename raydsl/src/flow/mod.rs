//! Flow: streamlines through vector fields by an adaptive integrator, and shapes that show them.
//!
//! A field is a closure of a kernel: of a place it returns the velocity there, or `None` where the
//! field is not defined. [`trace()`] follows a line through it, a few steps for each call;
//! [`streamlines()`] calls it until every line has come to its end. [`Capsule`] and [`Arrow`] are
//! primitives for what is found: tubes along lines, and glyphs.
//!
//! ```
//! use raydsl::flow::{FlowEnd, FlowSettings, FlowState, Ways, streamlines, trace};
//! use raydsl::prelude::*;
//!
//! let settings = FlowSettings::new(1e-5, 0.5)?.max_time(3.0)?;
//! let vortex = kernel!(|state: FlowState| {
//!     trace(|p: Vec3| Some(vec3(-p.y, p.x, 0.0)), state, settings)
//! });
//! let lines = streamlines(&TiledScheduler::new(), &vortex, &[Vec3::X], Ways::Forwards);
//! let last = lines[0].points().last().expect("the seed at least");
//! assert!(last.at.distance(vec3(3f32.cos(), 3f32.sin(), 0.0)) < 1e-4);
//! assert_eq!(lines[0].end(), FlowEnd::Time);
//! # Ok::<(), raydsl::flow::FlowError>(())
//! ```

mod arrow;
mod capsule;
mod dormand_prince;
mod follow;
mod line;
mod run;
mod settings;

pub use arrow::Arrow;
pub use capsule::Capsule;
pub use follow::{FlowEnd, FlowPoint, FlowState, FlowSteps, STEPS_PER_CALL, TRIES_PER_CALL, trace};
pub use line::Streamline;
pub use run::{Ways, streamlines};
pub use settings::{FlowError, FlowSettings, MAX_ATTEMPTS};
