//! Pictures of an error that is asked for.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use raydsl::gpu::GpuError;
use raydsl::prelude::*;
use raydsl::render::{Budget, Metric, Outcome, ProgressObserver, Target, Until};

use super::Worker;
use crate::action::Goal;
use crate::link::{Event, Job};
use crate::subject::PictureKernel;

/// Samples of the pilot, which tells how many are needed: the pixels of a picture have about the same
/// variance.
const PILOT: u32 = 128;
/// The shortest and the longest time, which is as good as none at all.
const TIMES: (Duration, Duration) = (Duration::from_millis(1), Duration::from_secs(1 << 30));
/// The time between reports.
const BETWEEN: Duration = Duration::from_millis(50);

impl Worker<'_> {
    /// Renders until the error of a goal is reached. The film has no picture meanwhile: the samples that
    /// choose how many are needed are not those of the picture.
    pub(super) fn reach(
        &mut self,
        kernel: &PictureKernel<'_>,
        job: &Job,
        goal: Goal,
    ) -> Result<(), GpuError> {
        let look = &*job.look;
        let (camera, sampling) = (look.pose.camera(), Sampling::new(1));
        let target = Target::new(Metric::Rmse, f64::from(goal.error)).pilot(PILOT);
        let seconds =
            Duration::try_from_secs_f32(goal.seconds).unwrap_or(TIMES.1).clamp(TIMES.0, TIMES.1);
        let until = Until::new(target, Budget::of_time(seconds));
        let mut film = Film::new(look.size.0, look.size.1);
        let (link, number) = (self.link, job.number);
        let mut told: Option<Instant> = None;
        let observer: ProgressObserver<'_> = &mut |progress| {
            if told.is_none_or(|at| at.elapsed() > BETWEEN) {
                told = Some(Instant::now());
                link.send(Event::Nearer { number, progress: *progress });
            }
            // A question waits: the samples so far would be lost.
            if link.is_outdated(number) {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let film_of = &mut film;
        let reached = if look.variant == Variant::Wgsl {
            let device = self.device.scheduler()?;
            device.render_until_observed(&camera, kernel, &sampling, film_of, &until, observer)?
        } else {
            let tiled = TiledScheduler::new().variant(look.variant);
            tiled.render_until_observed(&camera, kernel, &sampling, film_of, &until, observer)?
        };
        if reached.outcome == Outcome::Stopped {
            return Ok(());
        }
        self.picture.is_settled = true;
        self.picture.samples = film.samples();
        if film.samples() > 0 {
            let ms = reached.elapsed.as_secs_f64() * 1e3 / f64::from(reached.spent.max(1));
            self.picture.error = Some(reached.estimate.error as f32);
            self.picture.ms = ms;
            let films = (film, None);
            self.show(look, &films, false, ms);
            self.picture.films = Some(films);
        }
        link.send(Event::Reached { number, reached });
        Ok(())
    }
}
