//! Rendering of pictures with kernels.
//!
//! A [`Renderer`], a [`Scheduler`] of the CPU or a device, renders a frame (one ray through the
//! centre of each pixel) or a pass (some samples of each pixel, added to a [`Film`]); a camera
//! generates the rays.

mod allocation;
mod channels;
mod display;
mod files;
mod film;
mod film_args;
mod fragment;
mod image;
mod moments;
mod part;
#[cfg(feature = "gpu")]
mod passes;
mod pixel_sampler;
mod radiance;
mod recorded;
mod reference;
mod renderer;
mod scheduler;
mod shot;
mod simple;
mod steps;
mod store;
mod tile;
mod tiled;
mod until;
mod watch;
mod window;

pub use channels::Kept;
pub use display::{Display, ToneMap, Transfer, filmic, reinhard};
pub use film::Film;
pub use film_args::FilmArgs;
pub use fragment::{Fragment, FragmentOn, composite, composite_reversed, over};
pub use image::{Image, Shaded, ShadedOn};
pub use moments::{Moments, MomentsOn};
pub use part::{FilmExtent, FilmPart, PartError, SAMPLE_BLOCK};
#[cfg(feature = "gpu")]
pub(crate) use passes::passes;
pub use pixel_sampler::{PixelSampler, Sampling};
pub use radiance::Radiance;
#[cfg(feature = "gpu")]
pub(crate) use recorded::recorded;
#[doc(hidden)]
pub use reference::outcomes_of_frame;
pub use renderer::Renderer;
#[cfg(feature = "gpu")]
pub(crate) use renderer::timing_of;
#[doc(hidden)]
pub use renderer::{Effort, Pace};
pub use scheduler::Scheduler;
#[doc(hidden)]
pub use shot::Body;
#[cfg(feature = "gpu")]
pub(crate) use shot::Frame;
pub use shot::Shot;
pub use simple::SimpleScheduler;
pub use tile::{Tile, Tiles};
pub use tiled::TiledScheduler;
pub use until::{
    Budget, Estimate, Metric, Outcome, Progress, ProgressObserver, REPLICATIONS, Reached, Target,
    Until, UntilError,
};
pub use watch::{Observer, Watch};
