//! The parts of a film that have arrived, joined where they are neighbours.

use std::collections::BTreeMap;
use std::ops::Range;

use raydsl::prelude::*;
use raydsl::render::{FilmPart, PartError, SAMPLE_BLOCK};

use super::Job;
use super::division::{Window, windows};

/// The parts of all windows. Neither the order of arrival nor the division has an influence on the
/// bits of the film.
pub(super) struct Assembly {
    film: UVec2,
    samples: Range<u32>,
    /// For each window its parts by their first sample.
    windows: Vec<(Window, BTreeMap<u32, FilmPart>)>,
    /// The index of the window at an origin.
    indices: BTreeMap<(u32, u32), usize>,
    done: u64,
}

/// Why a part cannot be added.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(super) enum AddError {
    /// No window of the film is the part's.
    #[error("a part at {0} is of no window of this film")]
    NoWindow(UVec2),
    /// Its samples are there already, there are none such, or they end within a block: none could
    /// follow.
    #[error("samples {start} to {end} of the window at {origin} are none that are missing")]
    NotMissing {
        /// The lower left pixel.
        origin: UVec2,
        /// The first sample.
        start: u32,
        /// The one behind the last.
        end: u32,
    },
    /// It does not join its neighbours.
    #[error(transparent)]
    Part(#[from] PartError),
}

impl Assembly {
    pub(super) fn new(job: &Job) -> Self {
        let windows: Vec<_> = windows(job).into_iter().map(|w| (w, BTreeMap::new())).collect();
        let index =
            |(i, (window, _)): (usize, &(Window, _))| ((window.origin.y, window.origin.x), i);
        let indices = windows.iter().enumerate().map(index).collect();
        Self { film: job.film, samples: job.range(), windows, indices, done: 0 }
    }

    /// Adds a part, and joins it to its neighbours.
    pub(super) fn add(&mut self, part: FilmPart) -> Result<(), AddError> {
        let (origin, samples) = (part.extent().origin(), part.extent().samples());
        let index = self.indices.get(&(origin.y, origin.x)).copied();
        let (window, parts) = index
            .and_then(|index| self.windows.get_mut(index))
            .ok_or(AddError::NoWindow(origin))?;
        if window.size != part.extent().size() || self.film != part.extent().film() {
            return Err(AddError::NoWindow(origin));
        }
        let before = parts.range(..=samples.start).next_back();
        let starts_late = before.is_none_or(|(_, p)| p.extent().samples().end <= samples.start);
        let ends_early = parts.range(samples.start..).next().is_none_or(|(s, _)| *s >= samples.end);
        let ends_well = samples.end == self.samples.end
            || samples.end < self.samples.end && samples.end.is_multiple_of(SAMPLE_BLOCK);
        if !(starts_late && ends_early && ends_well) {
            return Err(AddError::NotMissing { origin, start: samples.start, end: samples.end });
        }
        self.done += part.extent().total_samples();

        // Join the parts at either side.
        let before = parts.range(..samples.start).next_back().map(|(first, _)| *first);
        let mut joined = part;
        if let Some(first) = before
            && parts[&first].extent().samples().end == samples.start
            && let Some(before) = parts.remove(&first)
        {
            joined = before.join(joined)?;
        }
        if let Some(after) = parts.remove(&samples.end) {
            joined = joined.join(after)?;
        }
        parts.insert(joined.extent().samples().start, joined);
        Ok(())
    }

    /// Returns the ranges of samples that each window lacks.
    pub(super) fn missing(&self) -> impl Iterator<Item = (Window, Vec<Range<u32>>)> {
        self.windows.iter().map(|(window, parts)| {
            let (mut next, mut gaps) = (self.samples.start, Vec::new());
            for part in parts.values() {
                let samples = part.extent().samples();
                if next < samples.start {
                    gaps.push(next..samples.start);
                }
                next = samples.end;
            }
            if next < self.samples.end {
                gaps.push(next..self.samples.end);
            }
            (*window, gaps)
        })
    }

    /// Returns the share of all samples that are there.
    pub(super) fn share(&self) -> f64 {
        let pixels = u64::from(self.film.x) * u64::from(self.film.y);
        self.done as f64 / (pixels * u64::from(self.samples.end)) as f64
    }

    /// Returns whether every sample is there.
    pub(super) fn is_whole(&self) -> bool {
        self.missing().all(|(_, gaps)| gaps.is_empty())
    }

    /// Returns all parts.
    pub(super) fn parts(&self) -> impl Iterator<Item = &FilmPart> {
        self.windows.iter().flat_map(|(_, parts)| parts.values())
    }

    /// Returns the film of the samples that follow the first without a gap.
    pub(super) fn film(&self) -> Result<Film, PartError> {
        let first = |part: &&FilmPart| part.extent().samples().start == 0;
        Film::from_parts(self.film, self.parts().filter(first))
    }
}

#[cfg(test)]
mod tests {
    use raydsl::render::FilmExtent;

    use super::*;

    fn part(job: &Job, window: Window, samples: Range<u32>) -> FilmPart {
        let camera = Pinhole::new(vec3(0.0, 0.0, 5.0), Vec3::ZERO, Vec3::Y, 1.0);
        let noise = kernel!(|_ray: Ray, sampler: Sampler| {
            let mut sampler = sampler;
            sampler.next_1d()
        });
        let extent = FilmExtent::new(job.film, window.origin, window.size, samples);
        let sampling = Sampling::new(job.samples);
        let scheduler = TiledScheduler::new();
        scheduler.render_part(&camera, &noise, &sampling, &extent.expect("a part of the job"))
    }

    #[test]
    fn the_order_of_arrival_has_no_influence() {
        let job = Job {
            film: uvec2(11, 5),
            samples: 300,
            tile: 8,
            blocks: 1,
            description: String::new(),
        };
        let whole = Film::from_parts(
            job.film,
            &[part(&job, Window { origin: UVec2::ZERO, size: job.film }, 0..300)],
        );
        let whole = whole.expect("one part");
        let cuts = [0, 64, 192, 256, 300];
        let units: Vec<(Window, Range<u32>)> = windows(&job)
            .into_iter()
            .flat_map(|window| cuts.windows(2).map(move |w| (window, w[0]..w[1])))
            .collect();
        let mut rng = Rng::new(UVec2::ZERO, 3, 4);
        for _ in 0..20 {
            let (mut left, mut assembly) = (units.clone(), Assembly::new(&job));
            while !left.is_empty() {
                assert!(!assembly.is_whole() && assembly.share() < 1.0);
                let i = (rng.next_f32() * left.len() as f32) as usize % left.len();
                let (window, samples) = left.swap_remove(i);
                assembly.add(part(&job, window, samples.clone())).expect("missing");
                let again = assembly.add(part(&job, window, samples));
                assert!(matches!(again, Err(AddError::NotMissing { .. })));
                let missing: u64 = assembly
                    .missing()
                    .map(|(w, gaps)| {
                        let samples: usize = gaps.iter().map(|gap| gap.len()).sum();
                        u64::from(w.size.x * w.size.y) * samples as u64
                    })
                    .sum();
                let expected = 1.0 - missing as f64 / (11.0 * 5.0 * 300.0);
                assert!((assembly.share() - expected).abs() < 1e-12);
            }
            assert!(assembly.is_whole() && assembly.share() == 1.0);
            assert_eq!(assembly.parts().count(), 2);
            assert!(assembly.film().expect("whole") == whole);
        }
    }

    #[test]
    fn parts_of_other_films_are_refused() {
        let job = Job {
            film: uvec2(11, 5),
            samples: 100,
            tile: 8,
            blocks: 1,
            description: String::new(),
        };
        let mut assembly = Assembly::new(&job);
        let other = Job { film: uvec2(12, 5), ..job.clone() };
        for (job, window, samples) in [
            (&other, Window { origin: UVec2::ZERO, size: uvec2(8, 5) }, 0..64),
            (&job, Window { origin: UVec2::ZERO, size: uvec2(7, 5) }, 0..64),
            (&job, Window { origin: uvec2(1, 0), size: uvec2(8, 5) }, 0..64),
            (&job, Window { origin: UVec2::ZERO, size: uvec2(8, 5) }, 64..128),
            (&job, Window { origin: UVec2::ZERO, size: uvec2(8, 5) }, 0..50),
        ] {
            assert!(assembly.add(part(job, window, samples)).is_err());
        }
        assert_eq!(assembly.parts().count(), 0);
    }
}
