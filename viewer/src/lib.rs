//! A viewer of points, surfaces and volumes.
//!
//! A [`Session`] is a viewer without a window: data, camera, look and a picture that gets better
//! while nothing changes. An [`Action`] is what a person may do; a [`Player`] plays a script of
//! them.

mod action;
mod data;
mod device;
mod edit;
mod frame;
mod link;
mod look;
mod pose;
mod present;
mod render;
mod script;
mod session;
mod subject;

pub use action::Action;
pub use device::Device;
pub use frame::{Difference, Frame};
pub use look::{CutObject, Kind, Knot, Look, Mode, PRESETS, Show, preset};
pub use pose::Pose;
pub use script::{Next, Player};
pub use session::{Config, Session};
pub use subject::{Info, Picked};
