//! Texture lookups as operations, with their implementation on each machine.

use super::texel::{Texel, TexelValue};
use super::view::Texels;
use crate::machine::{Data, F, I, Lanes, Margin, On, Operation, Packet, Recorder, Scalar, U};

/// Looks up a texture at a position of `D` axes.
pub(super) struct Lookup<'t, 'a, T, const D: usize>(pub(super) &'t Texels<'a, T>);

impl<T: Texel, const D: usize> Operation for Lookup<'_, '_, T, D> {
    type Input = [f32; D];
    type Output = T::Value;

    #[inline(always)]
    fn on_scalar(&self, m: &Scalar, at: [F<Scalar>; D]) -> On<T::Value, Scalar> {
        self.0.by_kernels(m, &at)
    }

    #[inline(always)]
    fn on_packet<L: Lanes>(&self, m: &Packet<L>, at: [F<Packet<L>>; D]) -> On<T::Value, Packet<L>> {
        self.0.in_packet(m, &at)
    }

    fn on_recorder(&self, m: &Recorder, at: [F<Recorder>; D]) -> On<T::Value, Recorder> {
        sampled(m, self.0, &at, None).unwrap_or_else(|| self.0.by_kernels(m, &at))
    }

    #[inline(always)]
    fn on_margin(&self, m: &Margin, at: [F<Margin>; D]) -> On<T::Value, Margin> {
        self.0.by_kernels(m, &at)
    }
}

/// Looks up a texture at a position of `D` axes and a level of detail.
pub(super) struct LookupAtLevel<'t, 'a, T, const D: usize>(pub(super) &'t Texels<'a, T>);

impl<T: Texel, const D: usize> Operation for LookupAtLevel<'_, '_, T, D> {
    type Input = ([f32; D], f32);
    type Output = T::Value;

    #[inline(always)]
    fn on_scalar(
        &self,
        m: &Scalar,
        (at, level): ([F<Scalar>; D], F<Scalar>),
    ) -> On<T::Value, Scalar> {
        self.0.by_kernels_at_level(m, &at, level)
    }

    #[inline(always)]
    fn on_packet<L: Lanes>(
        &self,
        m: &Packet<L>,
        (at, level): ([F<Packet<L>>; D], F<Packet<L>>),
    ) -> On<T::Value, Packet<L>> {
        self.0.in_packet_at_level(m, &at, level)
    }

    fn on_recorder(
        &self,
        m: &Recorder,
        (at, level): ([F<Recorder>; D], F<Recorder>),
    ) -> On<T::Value, Recorder> {
        let found = sampled(m, self.0, &at, Some(level));
        found.unwrap_or_else(|| self.0.by_kernels_at_level(m, &at, level))
    }

    #[inline(always)]
    fn on_margin(
        &self,
        m: &Margin,
        (at, level): ([F<Margin>; D], F<Margin>),
    ) -> On<T::Value, Margin> {
        self.0.by_kernels_at_level(m, &at, level)
    }
}

/// Fetches a texel of a texture at a place of `D` axes and a level, never by a sampler.
pub(super) struct Fetch<'t, 'a, T, const D: usize>(pub(super) &'t Texels<'a, T>);

impl<T: Texel, const D: usize> Operation for Fetch<'_, '_, T, D> {
    type Input = ([i32; D], u32);
    type Output = T::Value;

    #[inline(always)]
    fn on_scalar(
        &self,
        m: &Scalar,
        (at, level): ([I<Scalar>; D], U<Scalar>),
    ) -> On<T::Value, Scalar> {
        self.0.fetched_by_kernels(m, &at, level)
    }

    #[inline(always)]
    fn on_packet<L: Lanes>(
        &self,
        m: &Packet<L>,
        (at, level): ([I<Packet<L>>; D], U<Packet<L>>),
    ) -> On<T::Value, Packet<L>> {
        self.0.fetched_in_packet(m, &at, level)
    }

    fn on_recorder(
        &self,
        m: &Recorder,
        (at, level): ([I<Recorder>; D], U<Recorder>),
    ) -> On<T::Value, Recorder> {
        self.0.fetched_by_kernels(m, &at, level)
    }

    #[inline(always)]
    fn on_margin(
        &self,
        m: &Margin,
        (at, level): ([I<Margin>; D], U<Margin>),
    ) -> On<T::Value, Margin> {
        self.0.exact().fetched_by_kernels(m, &at, level)
    }
}

/// Samples the texture with the device's sampler; `None` if no sampler reads these texels, or if
/// there are too many textures.
fn sampled<T: Texel, const D: usize>(
    m: &Recorder,
    texels: &Texels<'_, T>,
    at: &[F<Recorder>; D],
    level: Option<F<Recorder>>,
) -> Option<On<T::Value, Recorder>> {
    let (slice, layout) = (texels.slice(), texels.layout()?);
    let (at, level) = (at.map(|x| x.0), level.map(|level| level.0));
    let channels = m.sample(slice.key(), &slice.name(), &layout, &at, level)?;
    Some(T::Value::from_channels_on(m, &channels.map(F)))
}
