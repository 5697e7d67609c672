//! Parts of films: a window of the pixels and a range of the samples, rendered anywhere and joined
//! to the same bits.

mod bytes;
mod error;
mod extent;
mod tree;

use core::marker::PhantomData;

use glam::UVec2;

pub use self::error::PartError;
pub use self::extent::{FilmExtent, SAMPLE_BLOCK};
use self::tree::{Node, push};
use super::film_args::FilmArgs;
use super::moments::Sums;
use super::renderer::Effort;
use super::shot::Pass;
use super::store::Store;
use super::window::Windowed;
use super::{Film, Image, Moments, Radiance, Renderer, Sampling};
use crate::camera::Camera;
use crate::kernel::Kernel;

/// A part of a film: the moments of the pixels of a window, over a range of samples.
///
/// [`Renderer::render_part`] renders one, on any machine. Samples are summed in blocks of
/// [`SAMPLE_BLOCK`], and blocks in one fixed binary tree over their indices: of each two neighbours
/// that begin at an even index, then of each two pairs, and so on. A part has the sums of the largest
/// subtrees in its range. So whatever the division into parts and the order of joining, a film has
/// the same bits. (Pairwise summation also keeps rounding errors down: Higham, "The Accuracy of
/// Floating Point Summation", 1993.)
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl::render::{FilmExtent, FilmPart, PartError};
///
/// let camera = Pinhole::new(vec3(0.0, 0.0, 5.0), Vec3::ZERO, Vec3::Y, 1.0);
/// let noise = kernel!(|ray: Ray, sampler: Sampler| {
///     let mut sampler = sampler;
///     sampler.next_1d() + ray.direction.y
/// });
/// let (size, sampling) = (uvec2(20, 10), Sampling::new(200));
/// let render = |from: u32, to: u32, samples| -> Result<FilmPart, PartError> {
///     let extent = FilmExtent::new(size, uvec2(from, 0), uvec2(to - from, 10), samples)?;
///     Ok(TiledScheduler::new().render_part(&camera, &noise, &sampling, &extent))
/// };
/// let whole = render(0, 20, 0..200)?;
/// let left = render(0, 7, 0..64)?.join(render(0, 7, 64..200)?)?;
/// let right = render(7, 20, 0..128)?.join(render(7, 20, 128..200)?)?;
/// assert!(Film::from_parts(size, [&left, &right])? == Film::from_parts(size, [&whole])?);
/// # Ok::<(), PartError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct FilmPart {
    extent: FilmExtent,
    /// The largest subtrees of the range, in order.
    nodes: Vec<Node>,
}

impl FilmPart {
    /// Returns the pixels and the samples that it has.
    pub fn extent(&self) -> &FilmExtent {
        &self.extent
    }

    /// Returns this part with the samples of another one of the same window, which begin where
    /// those of this one end.
    ///
    /// # Errors
    ///
    /// [`PartError::Apart`] if the windows or the films differ, or the samples do not follow.
    pub fn join(self, next: Self) -> Result<Self, PartError> {
        let Some(extent) = self.extent.followed_by(&next.extent) else {
            return Err(PartError::Apart {
                first: Box::new(self.extent),
                next: Box::new(next.extent),
            });
        };
        let mut nodes = self.nodes;
        next.nodes.into_iter().for_each(|node| push(&mut nodes, node));
        Ok(Self { extent, nodes })
    }

    /// Returns the moments of each pixel over all samples, row by row from the bottom.
    fn sums(&self) -> Vec<Sums> {
        let Some((first, others)) = self.nodes.split_first() else { return Vec::new() };
        let mut sums = first.pixels.clone();
        for node in others {
            sums.iter_mut().zip(&node.pixels).for_each(|(sum, more)| sum.merge(more));
        }
        sums
    }
}

impl Film {
    /// Creates a film of `size` pixels from parts, which have all samples from the first on; pixels
    /// of which there is no part have no samples.
    ///
    /// Its means are those of [`accumulate`](Renderer::accumulate) to the last bits of `f64`: that
    /// adds one pass after the other.
    ///
    /// # Errors
    ///
    /// If a part is one of a film of another size, lacks the first samples, or has a pixel that
    /// another one has.
    pub fn from_parts<'a>(
        size: UVec2,
        parts: impl IntoIterator<Item = &'a FilmPart>,
    ) -> Result<Self, PartError> {
        let mut pixels = vec![Sums::default(); size.x as usize * size.y as usize];
        let mut samples = 0;
        for part in parts {
            let extent = part.extent();
            if extent.film() != size {
                return Err(PartError::OtherFilm { film: size, found: extent.film() });
            }
            if extent.samples().start != 0 {
                return Err(PartError::NoBeginning { first: extent.samples().start });
            }
            samples = samples.max(extent.samples().end);
            for (index, sums) in extent.pixel_indices().zip(part.sums()) {
                if pixels[index].count != 0 {
                    return Err(PartError::Overlap { pixel: extent.pixel(index) });
                }
                pixels[index] = sums;
            }
        }
        Ok(Self::of_store(Store::of_pixels(size.x, size.y, pixels, samples)))
    }
}

/// Renders a part of a film, block by block.
pub(super) fn render<T, C, A, R>(
    renderer: &T,
    camera: &C,
    kernel: &Kernel<'_, A, R>,
    sampling: &Sampling,
    extent: &FilmExtent,
) -> Result<FilmPart, T::Error>
where
    T: Renderer + ?Sized,
    C: Camera,
    A: FilmArgs,
    R: Radiance,
{
    let (film, size) = (extent.film(), extent.size());
    let mut image = Image::filled(size.x, size.y, Moments::none());
    let mut nodes = Vec::new();
    for block in extent.blocks() {
        let samples = extent.samples_of(block);
        let pass = Pass {
            rays: camera.begin_frame(film.x, film.y),
            kernel,
            sampling: *sampling,
            first: samples.start,
            count: samples.end - samples.start,
            allocation: None,
            kept: PhantomData::<fn()>,
        };
        let effort = Effort { samples: pass.count, is_even: true };
        let shot = Windowed { shot: pass, origin: extent.origin() };
        let _ = renderer.shoot(&shot, effort, &mut image, None)?;
        push(&mut nodes, Node::of_block(block, image.pixels()));
    }
    Ok(FilmPart { extent: extent.clone(), nodes })
}
