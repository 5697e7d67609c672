//! The device of the WGSL variant, made when it is first needed.

use std::sync::{Arc, Mutex, PoisonError};

use raydsl::gpu::{Context, GpuError};
use raydsl::prelude::*;

use crate::look::Look;
use crate::present::Presenter;
use crate::subject::PictureKernel;

#[derive(Debug, Default)]
struct State {
    /// The window's own, which kernels share as long as it works.
    given: Option<(wgpu::Device, wgpu::Queue)>,
    made: Option<Schedulers>,
    presenter: Option<Presenter>,
}

/// Renderers of one device.
#[derive(Clone, Debug)]
struct Schedulers {
    /// All of whose pictures are the device's.
    patient: Arc<GpuScheduler>,
    /// One that does not wait for a compiler: until it is done, packets draw.
    eager: Arc<GpuScheduler>,
}

/// A device that threads share. After it is lost, the next use makes another one.
#[derive(Debug, Default)]
pub struct Device {
    state: Mutex<State>,
    /// Held while a renderer is made, which takes long: panels ask for the state meanwhile.
    making: Mutex<()>,
}

impl Device {
    /// Uses a device of the application.
    pub fn of_window(device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let state = State { given: Some((device, queue)), made: None, presenter: None };
        Self { state: Mutex::new(state), making: Mutex::default() }
    }

    fn state(&self) -> std::sync::MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns the renderer, which is made first if there is none.
    pub(crate) fn scheduler(&self) -> Result<Arc<GpuScheduler>, GpuError> {
        Ok(self.schedulers()?.patient)
    }

    /// Returns one that draws by packets until a kernel is compiled.
    pub(crate) fn eager_scheduler(&self) -> Result<Arc<GpuScheduler>, GpuError> {
        Ok(self.schedulers()?.eager)
    }

    fn schedulers(&self) -> Result<Schedulers, GpuError> {
        let _making = self.making.lock().unwrap_or_else(PoisonError::into_inner);
        let (given, made) = {
            let state = self.state();
            (state.given.clone(), state.made.clone())
        };
        if let Some(made) = made {
            return Ok(made);
        }
        let context = Arc::new(match given {
            Some((device, queue)) => Context::from_wgpu(None, device, queue),
            None => Context::new()?,
        });
        let eager = GpuScheduler::with_context(Arc::clone(&context));
        let made = Schedulers {
            patient: Arc::new(GpuScheduler::with_context(context)),
            eager: Arc::new(eager.while_compiling(TiledScheduler::new())),
        };
        self.state().made = Some(made.clone());
        Ok(made)
    }

    /// Returns whether the device is the window's, which can show a texture of it.
    pub(crate) fn is_of_window(&self) -> bool {
        self.state().given.is_some()
    }

    /// Returns whether [`Device::frame`] has nothing to compile, and begins to compile if it has.
    pub(crate) fn is_ready(
        &self,
        kernel: &PictureKernel<'_>,
        look: &Look,
    ) -> Result<bool, GpuError> {
        self.eager_scheduler()?.prepare_frame(&look.pose.camera(), kernel)
    }

    /// Renders a picture with one ray for each pixel, which stays on the device.
    pub(crate) fn frame(
        &self,
        kernel: &PictureKernel<'_>,
        look: &Look,
        size: (u32, u32),
    ) -> Result<wgpu::Texture, GpuError> {
        let scheduler = self.scheduler()?;
        let context = scheduler.context();
        // Taken out, so that nobody waits for the lock while the device computes.
        let kept = self.state().presenter.take();
        let mut presenter =
            kept.unwrap_or_else(|| Presenter::new(context.device(), context.queue()));
        let window = presenter.window(size);
        let camera = look.pose.camera();
        scheduler.frame_into(&camera, kernel, size, &window)?;
        let texture = presenter.show(&window, size, look.exposure);
        self.state().presenter = Some(presenter);
        Ok(texture)
    }

    /// Forgets a device that is lost.
    pub(crate) fn forget(&self) {
        // Dropped once nobody waits for the lock: a thread may still compile.
        let lost = std::mem::take(&mut *self.state());
        drop(lost);
    }

    /// Returns the adapter's name, once the device is made.
    pub fn name(&self) -> Option<String> {
        self.state().made.as_ref().map(|made| made.patient.context().adapter_name())
    }

    /// Returns how many kernels were recorded, printed as WGSL and compiled so far.
    pub fn counts(&self) -> Option<[u64; 3]> {
        let state = self.state();
        let context = state.made.as_ref()?.patient.context();
        Some([context.recorded(), context.printed(), context.compiled()])
    }

    /// Destroys the device, as a driver does that resets the card, to see what happens then.
    pub fn destroy(&self) {
        if let Some(made) = &self.state().made {
            made.patient.context().device().destroy();
        }
    }
}
