//! From kernels to pictures.
//!
//! A [`Scheduler`] makes a frame (one ray through the middle of each pixel) or a pass (some samples
//! of each pixel, added to a [`Film`]); a camera gives the rays.

mod allocation;
mod display;
mod files;
mod film;
mod film_args;
mod fragment;
mod image;
mod moments;
mod pixel_sampler;
mod radiance;
mod scheduler;
mod shot;
mod simple;
mod tile;
mod tiled;
mod until;
mod watch;

pub use display::{Display, ToneMap, Transfer, filmic, reinhard};
pub use film::Film;
pub use film_args::FilmArgs;
pub use fragment::{Fragment, FragmentOn, composite, composite_reversed, over};
pub use image::{Image, Shaded, ShadedOn};
pub use moments::{Moments, MomentsOn};
pub use pixel_sampler::{PixelSampler, Sampling};
pub use radiance::Radiance;
#[cfg(feature = "gpu")]
pub(crate) use scheduler::Samples;
pub use scheduler::Scheduler;
#[doc(hidden)]
pub use shot::Body;
#[cfg(feature = "gpu")]
pub(crate) use shot::Frame;
pub(crate) use shot::Pass;
pub use shot::Shot;
pub(crate) use shot::places;
pub use simple::SimpleScheduler;
pub use tile::{Tile, Tiles};
pub use tiled::TiledScheduler;
pub use until::{
    Budget, Estimate, Metric, Outcome, Progress, ProgressObserver, REPLICATIONS, Reached, Target,
    Until, UntilError,
};
#[cfg(feature = "gpu")]
pub(crate) use until::{Renderer, run as run_until};
pub use watch::{Observer, Watch};
