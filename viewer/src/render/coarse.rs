//! Pictures of fewer pixels, while something changes.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use raydsl::gpu::GpuError;
use raydsl::prelude::*;

use super::Worker;
use super::picture::milliseconds;
use crate::frame::Frame;
use crate::link::Job;
use crate::look::Show;
use crate::subject::PictureKernel;

/// Pixels a second that are assumed before any were measured.
const FIRST_RATE: f64 = 3e5;
/// The least share of columns and rows of a coarse picture.
const COARSEST: f64 = 1.0 / 16.0;

impl Worker<'_> {
    /// Makes a picture of as many pixels as the time allows. While the camera moves, a change
    /// follows another faster than pictures: this one is shown even if it is outdated, unless it
    /// takes too long.
    pub(super) fn coarse(
        &mut self,
        kernel: &PictureKernel<'_>,
        job: &Job,
        budget: Duration,
    ) -> Result<(), GpuError> {
        let look = &*job.look;
        let speed = (look.mode, look.variant, look.show == Show::Picture);
        let rate = self.rates.get(&speed).copied().unwrap_or(FIRST_RATE);
        let pixels = f64::from(look.size.0) * f64::from(look.size.1);
        let scale = (rate * budget.as_secs_f64() / pixels).sqrt().clamp(COARSEST, 1.0);
        let side = |n: u32| ((f64::from(n) * scale).round() as u32).clamp(1, n);
        let (width, height) = (side(look.size.0), side(look.size.1));
        let start = Instant::now();
        let is_shown_there = look.variant == Variant::Wgsl
            && look.show == Show::Picture
            && self.device.is_of_window();
        let share = if is_shown_there && self.device.is_ready(kernel, look)? {
            let texture = self.device.frame(kernel, look, (width, height))?;
            self.show_on_device(texture, start.elapsed());
            1.0
        } else {
            self.coarse_on_host(kernel, job, (width, height), budget)?
        };
        self.picture.is_coarse_due = false;
        let done = share * f64::from(width) * f64::from(height);
        let done = done.max(1.0) / start.elapsed().as_secs_f64();
        let known = self.rates.entry(speed).or_insert(done);
        // Slower is believed at once, and faster by half: a picture that is late is not seen.
        *known = if done < *known { done } else { 0.5 * (*known + done) };
        Ok(())
    }

    /// Returns the share of the picture that was made; if it is not all, nothing is shown.
    fn coarse_on_host(
        &mut self,
        kernel: &PictureKernel<'_>,
        job: &Job,
        (width, height): (u32, u32),
        budget: Duration,
    ) -> Result<f64, GpuError> {
        let (look, link, start) = (&*job.look, self.link, Instant::now());
        let other = matches!(look.show, Show::Difference(_)).then(|| Film::new(width, height));
        let mut films = (Film::new(width, height), other);
        let (mut share, patience) = (0.0, budget * (2 << self.late.min(5)));
        let is_complete = self.add(kernel, job, &mut films, 1, &mut |made| {
            share = made;
            let is_late = link.is_outdated(job.number) && start.elapsed() > patience;
            if is_late || link.is_closed() {
                return ControlFlow::Break(());
            }
            ControlFlow::Continue(())
        })?;
        if is_complete {
            self.show(look, &films, true, milliseconds(start.elapsed(), 1));
            share = 1.0;
        }
        self.late = if is_complete { 0 } else { self.late + 1 };
        Ok(share)
    }

    fn show_on_device(&mut self, texture: wgpu::Texture, took: Duration) {
        self.link.publish(Frame {
            number: self.picture.number,
            size: (texture.width(), texture.height()),
            is_coarse: true,
            samples: 0,
            rgba: Vec::new(),
            texture: Some(texture),
            ms: milliseconds(took, 1),
            age_ms: self.picture.since.elapsed().as_secs_f64() * 1e3,
            error: None,
            difference: None,
        });
    }
}
