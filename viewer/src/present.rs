//! From light in a buffer of a device to a texture that a window shows: nothing is read back.

use raydsl::gpu::GpuWindow;
use raydsl_scenes::Screen;

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// The screen, and the device that makes textures for it.
#[derive(Debug)]
pub(crate) struct Presenter {
    device: wgpu::Device,
    screen: Screen,
}

impl Presenter {
    pub(crate) fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        Self { device: device.clone(), screen: Screen::new(device, queue, FORMAT) }
    }

    /// Returns a window of a buffer for the light of a frame, which is kept for the next one.
    pub(crate) fn window(&mut self, size: (u32, u32)) -> GpuWindow {
        self.screen.window(size)
    }

    /// Returns a texture that shows the light of a window.
    pub(crate) fn show(
        &self,
        light: &GpuWindow,
        (width, height): (u32, u32),
        exposure: f32,
    ) -> wgpu::Texture {
        let texture = self.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("shown light"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        self.screen.show(
            light,
            (width, height),
            exposure,
            &texture.create_view(&Default::default()),
        );
        texture
    }
}
