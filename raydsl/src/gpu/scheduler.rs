//! Runs kernels on a device.

use std::borrow::Cow;

use super::{Context, GpuError, Timing};
use crate::camera::{Camera, CameraRays};
use crate::geometry::Ray;
use crate::kernel::Kernel;
use crate::machine::wgsl::{BufferKey, Module};
use crate::machine::{F, F32Binary, Machine, Recorder, Type, U, stride};
use crate::render::Image;

/// Runs the WGSL variant of kernels: pictures and batches.
///
/// Trees are uploaded once and kept; text is compiled once and kept. The numbers that a kernel
/// captures are in a uniform block, so that new numbers compile nothing.
#[derive(Debug)]
pub struct GpuScheduler {
    context: Context,
}

impl GpuScheduler {
    /// Takes the best adapter of this machine.
    ///
    /// # Errors
    ///
    /// If there is none, or it gives no device.
    pub fn new() -> Result<Self, GpuError> {
        Ok(Self::with_context(Context::new()?))
    }

    /// Takes a context, for example of the application's own device and queue.
    pub fn with_context(context: Context) -> Self {
        Self { context }
    }

    /// The device with its caches.
    pub fn context(&self) -> &Context {
        &self.context
    }

    /// Renders a frame: `image`'s size is the film's.
    ///
    /// # Errors
    ///
    /// If the device refuses or is lost; what came through before is in `image`.
    pub fn frame<C: Camera, R: Type>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, (Ray,), R>,
        image: &mut Image<R>,
    ) -> Result<Timing, GpuError> {
        let size = [image.width(), image.height()];
        let rays = camera.begin_frame(size[0], size[1]);
        let recording = kernel.record_grid(|m, x, y| {
            let centre = |n: U<Recorder>| {
                let n = m.u32_to_f32(n.0);
                F(m.f32_binary(F32Binary::Add, n, m.f32(0.5)))
            };
            (C::Rays::primary_ray_on(m, rays.on(m), centre(x), centre(y)),)
        });
        let module = recording.module(&self.context.limits());
        self.run(kernel, &module, &[], size, image.pixels_mut())
    }

    /// Runs a kernel over `inputs`; `outputs` has the same length.
    ///
    /// # Errors
    ///
    /// If the lengths differ, or the device refuses or is lost.
    pub fn batch<A: Type, R: Type>(
        &self,
        kernel: &Kernel<'_, A, R>,
        inputs: &[A],
        outputs: &mut [R],
    ) -> Result<Timing, GpuError> {
        let module = kernel.record().module(&self.context.limits());
        let each = stride(A::SCHEMA);
        let mut bytes = vec![0; each * inputs.len()];
        for (a, out) in inputs.iter().zip(bytes.chunks_exact_mut(each)) {
            a.write(out);
        }
        let count = u32::try_from(inputs.len())
            .map_err(|_| GpuError::GridTooLarge { size: [u32::MAX, 1] })?;
        self.run(kernel, &module, &bytes, [count, 1], outputs)
    }

    fn run<A: Type, R: Type>(
        &self,
        kernel: &Kernel<'_, A, R>,
        module: &Module,
        inputs: &[u8],
        size: [u32; 2],
        outputs: &mut [R],
    ) -> Result<Timing, GpuError> {
        self.context.forget_gone();
        let each = stride(R::SCHEMA);
        let mut bytes = vec![0; each * outputs.len()];
        let timing = self.context.run(
            module,
            &|key| bytes_of(kernel, key).map(Cow::Owned),
            inputs,
            size,
            &mut bytes,
        );
        // The address of a slice names its data only while it is borrowed.
        for b in module.buffers.iter().filter(|b| crate::bvh::is_slice_key(b.key)) {
            self.context.forget(b.key.id);
        }
        for (out, bytes) in outputs.iter_mut().zip(bytes.chunks_exact(each)) {
            *out = R::read(bytes);
        }
        timing
    }
}

/// The bytes of a buffer, made only where the device does not have them yet.
fn bytes_of<A: Type, R: Type>(kernel: &Kernel<'_, A, R>, key: BufferKey) -> Option<Vec<u8>> {
    let mut found = None;
    kernel.resources(&mut |resource| {
        if found.is_none() {
            found = resource.bytes(key).map(Cow::into_owned);
        }
    });
    found
}
