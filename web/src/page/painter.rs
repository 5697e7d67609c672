//! What runs the kernel, and how its light gets to the canvas.

use raydsl::gpu::{GpuError, GpuWindow};
use raydsl::prelude::*;
use raydsl::render::Display;
use raydsl_scenes::{Pose, Screen};
use wasm_bindgen::prelude::*;
use web_sys::{ImageData, OffscreenCanvas, OffscreenCanvasRenderingContext2d};

use super::thrown;
use crate::{PictureKernel, Request, SAMPLING};

/// A picture while the camera moves has this share of the columns and rows by packets.
const COARSE: u32 = 4;

/// A variant and a way to the canvas.
pub(super) struct Painter {
    gpu: Option<GpuScheduler>,
    variant: Variant,
    size: (u32, u32),
    target: Target,
}

/// The way to the canvas.
enum Target {
    /// Light stays on the device.
    Surface { surface: wgpu::Surface<'static>, screen: Screen },
    /// Pictures of the host.
    Pixels { context: OffscreenCanvasRenderingContext2d },
}

impl Painter {
    /// Opens what a request asks for.
    pub(super) async fn open(request: &Request, canvas: &OffscreenCanvas) -> Result<Self, JsError> {
        let &Request { variant, size, is_readback, .. } = request;
        let gpu = match variant {
            Variant::Wgsl => Some(GpuScheduler::open().await?),
            _ => None,
        };
        let target = match &gpu {
            Some(gpu) if !is_readback => surface(gpu, canvas, size)?,
            _ => pixels(canvas)?,
        };
        Ok(Self { gpu, variant, size, target })
    }

    /// Returns the name of what runs the kernel.
    pub(super) fn machine(&self) -> String {
        match &self.gpu {
            Some(gpu) => {
                // Browsers tell little of a card, and some not even its name.
                let info = gpu.context().adapter_info();
                let known = [&info.name, &info.driver, &info.driver_info];
                let known = known.into_iter().find(|text| !text.is_empty());
                format!("WebGPU: {}", known.map_or("a card without a name", String::as_str))
            }
            None => {
                let (isa, lanes) = self.variant.isa();
                format!("WebAssembly: {} by {isa}, {lanes} lanes", self.variant.name())
            }
        }
    }

    /// Returns the device, if there is one.
    pub(super) fn gpu(&self) -> Option<&GpuScheduler> {
        self.gpu.as_ref()
    }

    /// Adds samples to a film.
    pub(super) async fn add(
        &self,
        kernel: &PictureKernel<'_>,
        pose: &Pose,
        film: &mut Film,
        samples: u32,
    ) -> Result<(), GpuError> {
        let camera = pose.camera();
        match &self.gpu {
            Some(gpu) => {
                gpu.accumulate_async(&camera, kernel, &SAMPLING, film, samples).await?;
            }
            None => {
                let packets = TiledScheduler::new().variant(self.variant);
                packets.accumulate(&camera, kernel, &SAMPLING, film, samples);
            }
        }
        Ok(())
    }

    /// Returns a picture of one ray a pixel that is submitted and not awaited, with another one
    /// right behind it: the device must keep them apart.
    pub(super) async fn submit(
        &self,
        kernel: &PictureKernel<'_>,
        pose: &Pose,
    ) -> Result<Image<Vec4>, JsError> {
        let gpu = self.gpu.as_ref().ok_or_else(|| JsError::new("only a device has a queue"))?;
        let (width, height) = self.size;
        let light = vec![Vec4::ZERO; width as usize * height as usize];
        let window = || {
            let size = size_of_val(light.as_slice()) as u64;
            let buffer = gpu.context().device().create_buffer(&wgpu::BufferDescriptor {
                label: Some("light"),
                size,
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
            GpuWindow { buffer, offset: 0, size }
        };
        let (first, second) = (window(), window());
        let mut aside = *pose;
        aside.orbit(90.0, 0.0);
        gpu.frame_into(&pose.camera(), kernel, self.size, &first)?;
        gpu.frame_into(&aside.camera(), kernel, self.size, &second)?;
        // A kernel that is submitted later finds the light there, in place of what the host has.
        let _light = gpu.with_gpu(&light, first)?;
        let read = kernel!(|i: u32| light[i as usize]);
        let indices: Vec<(u32,)> = (0..width * height).map(|i| (i,)).collect();
        let mut picture = Image::filled(width, height, Vec4::ZERO);
        gpu.batch_async(&read, &indices, picture.pixels_mut()).await?;
        Ok(picture)
    }

    /// Shows light.
    pub(super) fn show(&mut self, light: &Image<Vec4>) -> Result<(), JsError> {
        match &mut self.target {
            Target::Pixels { context } => draw(context, light),
            Target::Surface { surface, screen } => {
                let Some(gpu) = &self.gpu else { return Ok(()) };
                let window = screen.window(self.size);
                let bytes: &[u8] = bytemuck::cast_slice(light.pixels());
                let queue = gpu.context().queue();
                queue.write_buffer(&window.buffer, window.offset, bytes);
                present(queue, surface, |picture| screen.show(&window, self.size, 0.0, picture))
            }
        }
    }

    /// Shows a picture of one ray a pixel: on a device of all pixels, and nothing is read back if
    /// the light can stay there.
    pub(super) async fn glance(
        &mut self,
        kernel: &PictureKernel<'_>,
        pose: &Pose,
    ) -> Result<(), JsError> {
        let (camera, size) = (pose.camera(), self.size);
        match (&self.gpu, &mut self.target) {
            (Some(gpu), Target::Surface { surface, screen }) => {
                let window = screen.window(size);
                gpu.frame_into_async(&camera, kernel, size, &window).await?;
                let queue = gpu.context().queue();
                present(queue, surface, |picture| screen.show(&window, size, 0.0, picture))
            }
            (Some(gpu), Target::Pixels { context }) => {
                let mut light = Image::filled(size.0, size.1, Vec4::ZERO);
                gpu.frame_async(&camera, kernel, &mut light).await?;
                draw(context, &light)
            }
            (None, Target::Pixels { context }) => {
                let mut coarse =
                    Image::filled(size.0.div_ceil(COARSE), size.1.div_ceil(COARSE), Vec4::ZERO);
                let packets = TiledScheduler::new().variant(self.variant);
                packets.frame(&camera, kernel, &mut coarse);
                let pixel = |x: u32, y: u32| {
                    coarse.get(x / COARSE, y / COARSE).copied().unwrap_or(Vec4::ZERO)
                };
                draw(context, &Image::from_fn(size.0, size.1, pixel))
            }
            (None, Target::Surface { .. }) => Ok(()),
        }
    }
}

/// Returns the canvas as a surface of a device.
fn surface(
    gpu: &GpuScheduler,
    canvas: &OffscreenCanvas,
    (width, height): (u32, u32),
) -> Result<Target, JsError> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let surface = instance.create_surface(wgpu::SurfaceTarget::OffscreenCanvas(canvas.clone()))?;
    // Every browser presents this format, if not always as the fastest one.
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let context = gpu.context();
    surface.configure(
        context.device(),
        &wgpu::SurfaceConfiguration {
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
            format,
            color_space: wgpu::SurfaceColorSpace::Auto,
            width,
            height,
            present_mode: wgpu::PresentMode::Fifo,
            desired_maximum_frame_latency: 2,
            alpha_mode: wgpu::CompositeAlphaMode::Opaque,
            view_formats: Vec::new(),
        },
    );
    let screen = Screen::new(context.device(), context.queue(), format);
    Ok(Target::Surface { surface, screen })
}

/// Returns the canvas for pictures of the host.
fn pixels(canvas: &OffscreenCanvas) -> Result<Target, JsError> {
    let context = canvas.get_context("2d").map_err(|error| thrown(&error))?;
    let context = context.and_then(|context| context.dyn_into().ok());
    let context = context.ok_or_else(|| JsError::new("the canvas gives no 2-D context"))?;
    Ok(Target::Pixels { context })
}

/// Presents what `show` draws.
fn present(
    queue: &wgpu::Queue,
    surface: &wgpu::Surface<'_>,
    show: impl FnOnce(&wgpu::TextureView),
) -> Result<(), JsError> {
    use wgpu::CurrentSurfaceTexture as Current;
    match surface.get_current_texture() {
        Current::Success(texture) | Current::Suboptimal(texture) => {
            show(&texture.texture.create_view(&Default::default()));
            queue.present(texture);
            Ok(())
        }
        // The page is behind another one: the next picture will do.
        Current::Timeout | Current::Occluded => Ok(()),
        other => Err(JsError::new(&format!("the canvas gives no texture: {other:?}"))),
    }
}

/// Draws light, whose row 0 is at the bottom.
fn draw(context: &OffscreenCanvasRenderingContext2d, light: &Image<Vec4>) -> Result<(), JsError> {
    let shown = Display::new().show(light);
    let rows = shown.pixels().chunks_exact(light.width() as usize).rev();
    // A canvas would show the page behind a pixel that is not opaque.
    let opaque = |[r, g, b, _]: &[Unorm8; 4]| [r.to_bits(), g.to_bits(), b.to_bits(), 255];
    let bytes: Vec<u8> = rows.flatten().flat_map(opaque).collect();
    let data = ImageData::new_with_u8_clamped_array_and_sh(
        wasm_bindgen::Clamped(&bytes),
        light.width(),
        light.height(),
    );
    let data = data.map_err(|error| thrown(&error))?;
    context.put_image_data(&data, 0.0, 0.0).map_err(|error| thrown(&error))
}
