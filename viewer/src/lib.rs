//! A viewer of points, surfaces, volumes and cells.
//!
//! A [`Session`] is a viewer without a window: data, camera, look and a picture that gets better
//! while nothing changes. An [`Action`] is what a person may do; a [`Player`] plays a script of
//! them.

mod action;
mod animation;
mod data;
mod device;
mod edit;
mod film;
mod frame;
mod link;
mod look;
mod menu;
mod paraview;
mod present;
mod render;
mod script;
mod session;
mod subject;
mod wand;

pub use action::{Action, Goal};
pub use animation::{Animation, Way};
pub use device::Device;
pub use frame::{Difference, Frame};
pub use look::{CutObject, Kind, Knot, Look, Mode, PRESETS, Show, Sky, preset};
pub use menu::{Button, Item, Menu};
pub use raydsl_scenes::Pose;
pub use script::{Next, Player};
pub use session::{Config, Session};
pub use subject::{Info, Picked};
pub use wand::Wand;
