//! What the host does while the device compiles.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use super::Timing;
use super::background::Outcome;
use crate::kernel::Kernel;
use crate::machine::Type;
use crate::render::{Effort, Image, Observer, Renderer, Scheduler, Shot, TiledScheduler};

/// The host ends a picture that it has within this time.
const SOON: Duration = Duration::from_millis(50);

/// Elements of a batch that the host does before it looks whether the device can go on.
const BATCH: usize = 1 << 16;

/// The host, at work until the device can go on.
pub(super) struct Meanwhile<'a> {
    host: &'a TiledScheduler,
    compiled: Outcome,
    start: Instant,
}

impl<'a> Meanwhile<'a> {
    pub(super) fn new(host: &'a TiledScheduler, compiled: Outcome) -> Self {
        Self { host, compiled, start: Instant::now() }
    }

    /// Returns the time since the host began.
    pub(super) fn timing(&self) -> Timing {
        Timing { wall_ms: self.start.elapsed().as_secs_f64() * 1e3, ..Timing::default() }
    }

    fn is_compiled(&self) -> bool {
        matches!(self.compiled.get(), Some(Ok(())))
    }

    /// Returns whether the device takes over a picture of which a share is done.
    fn is_handed_over(&self, share: f64) -> bool {
        self.is_compiled() && is_worth_it(self.start.elapsed(), share)
    }

    /// Renders a picture, and returns nothing if the device has to take over: it then begins anew.
    /// `image` has the result only when it is complete.
    pub(super) fn shoot<S: Shot>(
        &self,
        shot: &S,
        effort: Effort,
        image: &mut Image<S::Output>,
        observer: Observer<'_>,
    ) -> Option<ControlFlow<Timing, Timing>> {
        let mut made = image.clone();
        let mut is_handed_over = false;
        let mut watch = |share| {
            is_handed_over = self.is_handed_over(share);
            if is_handed_over {
                return ControlFlow::Break(());
            }
            observer(share)
        };
        let Ok(end) = self.host.shoot(shot, effort, &mut made, Some(&mut watch));
        match end {
            ControlFlow::Continue(()) => {
                *image = made;
                Some(ControlFlow::Continue(self.timing()))
            }
            ControlFlow::Break(()) if is_handed_over => None,
            ControlFlow::Break(()) => Some(ControlFlow::Break(self.timing())),
        }
    }

    /// Runs a kernel over a batch, and returns how many of its elements are done: the device does the
    /// others. Both slices have one length.
    pub(super) fn batch<A: Type, R: Type>(
        &self,
        kernel: &Kernel<'_, A, R>,
        inputs: &[A],
        outputs: &mut [R],
    ) -> usize {
        let mut done = 0;
        for (inputs, outputs) in inputs.chunks(BATCH).zip(outputs.chunks_mut(BATCH)) {
            if self.is_compiled() {
                break;
            }
            self.host.run_batch(kernel, inputs, outputs);
            done += inputs.len();
        }
        done
    }
}

/// Returns whether the device should begin a picture anew of which the host has done a share in some
/// time: less than half is lost then, and nothing where the rest takes no time.
fn is_worth_it(elapsed: Duration, share: f64) -> bool {
    let left = elapsed.as_secs_f64() * (1.0 / share.max(1e-9) - 1.0);
    share < 0.5 && left > SOON.as_secs_f64()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{Camera, Pinhole};
    use crate::gpu::GpuError;
    use crate::kernel;
    use crate::prelude::*;
    use crate::render::Frame;

    const SIZE: (u32, u32) = (40, 30);

    /// A host that began so long ago.
    fn begun(host: &TiledScheduler, ago: Duration) -> (Meanwhile<'_>, Outcome) {
        let compiled = Outcome::default();
        let meanwhile = Meanwhile::new(host, Outcome::clone(&compiled));
        let start = meanwhile.start.checked_sub(ago).unwrap_or(meanwhile.start);
        (Meanwhile { start, ..meanwhile }, compiled)
    }

    /// Tiles follow each other: an observer sees small steps.
    #[cfg(feature = "parallel")]
    fn on_one_thread<T: Send>(work: impl FnOnce() -> T + Send) -> T {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
        pool.expect("a thread can be started").install(work)
    }
    #[cfg(not(feature = "parallel"))]
    fn on_one_thread<T>(work: impl FnOnce() -> T) -> T {
        work()
    }

    /// Renders a frame; the device is ready, or refuses the kernel, when a share of it is done.
    fn render(
        from: f64,
        outcome: Result<(), GpuError>,
        stop: bool,
    ) -> (Option<ControlFlow<(), ()>>, Image<f32>) {
        let host = TiledScheduler::new().tile(4);
        let (meanwhile, compiled) = begun(&host, Duration::from_secs(10));
        let camera = Pinhole::new(vec3(0.0, 0.0, 5.0), Vec3::ZERO, Vec3::Y, 1.0);
        let sky = kernel!(|ray: Ray| ray.direction.y);
        let shot = Frame { rays: camera.begin_frame(SIZE.0, SIZE.1), kernel: &sky };
        let mut image = Image::filled(SIZE.0, SIZE.1, -7.0);
        let end = on_one_thread(|| {
            meanwhile.shoot(&shot, Effort::ONE, &mut image, &mut |share| {
                if share >= from {
                    let _ = compiled.set(outcome.clone());
                    if stop {
                        return ControlFlow::Break(());
                    }
                }
                ControlFlow::Continue(())
            })
        });
        let end = end.map(|end| match end {
            ControlFlow::Continue(_) => ControlFlow::Continue(()),
            ControlFlow::Break(_) => ControlFlow::Break(()),
        });
        (end, image)
    }

    #[test]
    fn the_device_takes_over_before_the_half() {
        let untouched = Image::filled(SIZE.0, SIZE.1, -7.0);
        let (end, image) = render(0.1, Ok(()), false);
        assert_eq!((end, &image), (None, &untouched));
        // Whoever stops it has nothing.
        let (end, image) = render(0.1, Ok(()), true);
        assert_eq!((end, &image), (Some(ControlFlow::Break(())), &untouched));
        let refused = Err(GpuError::PipelineFailed { message: String::new() });
        for (from, outcome) in [(0.6, Ok(())), (0.1, refused), (2.0, Ok(()))] {
            let (end, image) = render(from, outcome.clone(), false);
            assert_eq!(end, Some(ControlFlow::Continue(())), "{from}, {outcome:?}");
            assert!(image.pixels().iter().all(|y| *y != -7.0), "all pixels are rendered");
        }
    }

    #[test]
    fn what_is_done_soon_is_not_handed_over() {
        let elapsed = Duration::from_millis(20);
        assert!(!is_worth_it(elapsed, 0.4), "30 ms are left");
        assert!(is_worth_it(elapsed, 0.1), "180 ms are left");
        assert!(is_worth_it(elapsed, 0.0));
        assert!(!is_worth_it(Duration::from_secs(100), 0.5), "half would be lost");
    }

    #[test]
    fn of_a_batch_the_device_does_the_rest() {
        let host = TiledScheduler::new();
        let twice = kernel!(|x: f32| x + x);
        let inputs = vec![(1.5f32,); BATCH + 10];
        for (outcome, expected) in [(None, BATCH + 10), (Some(Ok(())), 0)] {
            let (meanwhile, compiled) = begun(&host, Duration::ZERO);
            outcome.into_iter().for_each(|outcome| assert_eq!(compiled.set(outcome), Ok(())));
            let mut outputs = vec![0.0; inputs.len()];
            assert_eq!(meanwhile.batch(&twice, &inputs, &mut outputs), expected);
            assert!(outputs[..expected].iter().all(|y| *y == 3.0));
            assert!(outputs[expected..].iter().all(|y| *y == 0.0));
        }
    }
}
