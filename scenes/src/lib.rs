//! Scenes made in code, a camera that turns around them, and the screen that shows them: what the
//! examples, the viewer and the page in a browser share.
//!
//! Nothing here needs a file or a window, so that a page can have all of it.

pub mod cloud;
pub mod cornell;
pub mod head;
pub mod points;
mod pose;
#[cfg(feature = "screen")]
mod screen;

pub use pose::Pose;
#[cfg(feature = "screen")]
pub use screen::Screen;
