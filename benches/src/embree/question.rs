//! Rays that are asked in every way that Embree has.

use raydsl::prelude::*;

use super::{Coherence, Lanes, RayHits, Rays, Scene, Width};
use crate::clock::seconds_on;
use crate::contest::{Outcome, in_parts};

/// How many rays are asked at once, and what Embree is told of them. Of single rays it does not
/// want to know.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mode {
    /// 1, 8 or 16.
    pub lanes: usize,
    /// The flag.
    pub coherence: Coherence,
}

impl Mode {
    /// One ray at a time.
    pub const SINGLE: Self = Self::new(1, Coherence::Incoherent);
    /// Every mode.
    pub const ALL: [Self; 5] = [
        Self::SINGLE,
        Self::new(8, Coherence::Incoherent),
        Self::new(8, Coherence::Coherent),
        Self::new(16, Coherence::Incoherent),
        Self::new(16, Coherence::Coherent),
    ];

    const fn new(lanes: usize, coherence: Coherence) -> Self {
        Self { lanes, coherence }
    }

    /// `1`, `16 coherent` and the like.
    pub fn name(self) -> String {
        let flag = match (self.lanes, self.coherence) {
            (1, _) => "",
            (_, Coherence::Incoherent) => " incoherent",
            (_, Coherence::Coherent) => " coherent",
        };
        format!("{}{flag}", self.lanes)
    }
}

/// What some rays are asked.
#[derive(Clone, Copy)]
pub struct Question<'a> {
    /// The rays.
    pub rays: &'a [Ray],
    /// Whether they want to know what is closest, or if there is anything.
    pub is_closest: bool,
    /// Where they end.
    pub t_max: f32,
    /// The threads that ask.
    pub threads: usize,
}

impl Question<'_> {
    /// Asks in some mode.
    pub fn ask(self, scene: &Scene<'_>, mode: Mode) -> Outcome {
        match mode.lanes {
            1 => self.of_width::<1>(scene, mode.coherence),
            8 => self.of_width::<8>(scene, mode.coherence),
            _ => self.of_width::<16>(scene, mode.coherence),
        }
    }

    fn of_width<const N: usize>(self, scene: &Scene<'_>, coherence: Coherence) -> Outcome
    where
        Lanes<N>: Width,
        RayHits<N>: Send,
        Rays<N>: Send,
    {
        match self.is_closest {
            true => self.closest::<N>(scene, coherence),
            false => self.any::<N>(scene, coherence),
        }
    }

    fn closest<const N: usize>(self, scene: &Scene<'_>, coherence: Coherence) -> Outcome
    where
        Lanes<N>: Width,
        RayHits<N>: Send,
    {
        in_parts(self.rays, self.threads, |packets: &mut Vec<RayHits<N>>, part| {
            packets.clear();
            packets.extend(part.chunks(N).map(|rays| RayHits::of(self.ending(rays))));
            let ask = || scene.intersect(packets, coherence);
            let ((), seconds) = seconds_on(self.threads, ask);
            let distances = || packets.iter().flat_map(RayHits::distances).map(f64::from);
            Outcome { seconds, hits: distances().count(), distance: distances().sum() }
        })
    }

    fn any<const N: usize>(self, scene: &Scene<'_>, coherence: Coherence) -> Outcome
    where
        Lanes<N>: Width,
        Rays<N>: Send,
    {
        in_parts(self.rays, self.threads, |packets: &mut Vec<Rays<N>>, part| {
            packets.clear();
            packets.extend(part.chunks(N).map(|rays| Rays::of(self.ending(rays))));
            let ask = || scene.occluded(packets, coherence);
            let ((), seconds) = seconds_on(self.threads, ask);
            let hits = packets.iter().map(Rays::occluded).sum();
            Outcome { seconds, hits, distance: 0.0 }
        })
    }

    fn ending(self, rays: &[Ray]) -> impl Iterator<Item = Ray> {
        rays.iter().map(move |ray| ray.with_range(0.0, self.t_max))
    }
}
