//! The picture in the middle of the window.

use std::sync::Arc;

use eframe::egui;
use eframe::egui_wgpu::RenderState;
use raydsl::prelude::*;
use raydsl_viewer::{Action, Frame};

use super::dialog::Ask;
use super::{Viewer, input};

/// The most pixels along a side of a picture that is as large as its place.
const MOST_SIDE: usize = 8192;

/// The picture as a texture.
#[derive(Default)]
pub(crate) struct Shown {
    /// What is in the texture.
    frame: Option<Arc<Frame>>,
    /// A texture of the host's pixels.
    host: Option<egui::TextureHandle>,
    /// One of the device's, with what egui calls it.
    device: Option<(wgpu::Texture, egui::TextureId)>,
}

impl Shown {
    /// Takes a frame, unless it is the one that is shown.
    fn take(&mut self, ctx: &egui::Context, state: Option<&RenderState>, frame: &Arc<Frame>) {
        if self.frame.as_ref().is_some_and(|shown| Arc::ptr_eq(shown, frame)) {
            return;
        }
        self.frame = Some(frame.clone());
        match (&frame.texture, state) {
            (Some(texture), Some(state)) => self.take_texture(state, texture),
            (Some(_), None) => {}
            (None, _) => {
                self.free_texture(state);
                let image = pixels(frame, ctx.input(|input| input.max_texture_side));
                let options = egui::TextureOptions::LINEAR;
                match &mut self.host {
                    Some(host) => host.set(image, options),
                    None => self.host = Some(ctx.load_texture("picture", image, options)),
                }
            }
        }
    }

    /// Gives the device's texture back: egui keeps what is registered until it is told not to.
    fn free_texture(&mut self, state: Option<&RenderState>) {
        if let (Some((_, id)), Some(state)) = (self.device.take(), state) {
            state.renderer.write().free_texture(&id);
        }
    }

    fn take_texture(&mut self, state: &RenderState, texture: &wgpu::Texture) {
        let view = texture.create_view(&Default::default());
        let filter = wgpu::FilterMode::Linear;
        let mut renderer = state.renderer.write();
        let id = match &self.device {
            Some((_, id)) => {
                renderer.update_egui_texture_from_wgpu_texture(&state.device, &view, filter, *id);
                *id
            }
            None => renderer.register_native_texture(&state.device, &view, filter),
        };
        self.device = Some((texture.clone(), id));
    }

    fn id(&self) -> Option<egui::TextureId> {
        let device = self.device.as_ref().map(|(_, id)| *id);
        device.or_else(|| self.host.as_ref().map(egui::TextureHandle::id))
    }
}

impl Viewer {
    /// Shows the picture in what the panels leave, and takes its input.
    pub(crate) fn show_picture(
        &mut self,
        ui: &mut egui::Ui,
        frame: &eframe::Frame,
        actions: &mut Vec<Action>,
    ) {
        let rect = ui.available_rect_before_wrap();
        let response = ui.allocate_rect(rect, egui::Sense::click_and_drag());
        ui.painter().rect_filled(rect, 0.0, egui::Color32::from_gray(12));
        input::keys(ui, &self.session, &mut self.pictures, actions);
        if input::is_choosing_files(ui) {
            self.dialog.open(Ask::Files, ui.ctx());
        }
        if !self.is_played && self.player.is_none() {
            self.fit(rect, ui.ctx(), actions);
        }
        if let Some(newest) = self.session.frame() {
            self.shown.take(ui.ctx(), frame.wgpu_render_state(), newest);
        }
        let (width, height) = self.session.look().size;
        let place = fitted(rect, (width as f32, height as f32));
        let Some(id) = self.shown.id() else {
            let text = "Drop a file here, choose one (O), or type its name at the left.";
            let middle = egui::Align2::CENTER_CENTER;
            let font = egui::FontId::proportional(16.0);
            ui.painter().text(rect.center(), middle, text, font, egui::Color32::GRAY);
            return;
        };
        let whole = egui::Rect::from_min_max(egui::pos2(0.0, 0.0), egui::pos2(1.0, 1.0));
        ui.painter().image(id, place, whole, egui::Color32::WHITE);
        let place = Place { rect: place, size: (width, height) };
        self.menu.show(&self.session, ui, &place);
        let is_dragging = self.handles.show(&self.session, ui, &response, &place, actions);
        // A script has its own wand.
        let is_choosing = !self.is_played && self.menu.point(&response, &place, actions);
        if !is_dragging && !is_choosing {
            input::mouse(ui, &response, &place, actions);
        }
    }

    /// Makes the picture as large as its place, and as a texture may be.
    fn fit(&self, rect: egui::Rect, ctx: &egui::Context, actions: &mut Vec<Action>) {
        let scale = ctx.pixels_per_point();
        let most = ctx.input(|input| input.max_texture_side).clamp(1, MOST_SIDE) as u32;
        let side = |length: f32| ((length * scale).round() as u32).clamp(1, most);
        let size = (side(rect.width()), side(rect.height()));
        if size != self.session.look().size {
            actions.push(Action::Size(size.0, size.1));
        }
    }
}

/// Where a picture is on the screen, and how many pixels it has.
pub(crate) struct Place {
    pub(crate) rect: egui::Rect,
    size: (u32, u32),
}

impl Place {
    /// Returns a place of the picture in pixels from the lower left; it may be outside.
    pub(crate) fn pixel(&self, at: egui::Pos2) -> Vec2 {
        let share = (at - self.rect.min) / self.rect.size();
        vec2(share.x, 1.0 - share.y) * vec2(self.size.0 as f32, self.size.1 as f32)
    }

    /// Returns the pixel at a place, if there is one.
    pub(crate) fn whole_pixel(&self, at: egui::Pos2) -> Option<(u32, u32)> {
        let Vec2 { x, y } = self.pixel(at).floor();
        let is_inside = x >= 0.0 && y >= 0.0 && x < self.size.0 as f32 && y < self.size.1 as f32;
        is_inside.then_some((x as u32, y as u32))
    }

    /// Returns where a place of the picture is on the screen.
    pub(crate) fn screen(&self, pixel: Vec2) -> egui::Pos2 {
        let (width, height) = (self.size.0 as f32, self.size.1 as f32);
        self.rect.lerp_inside(egui::vec2(pixel.x / width, 1.0 - pixel.y / height))
    }
}

/// The largest place of a picture in a rectangle.
fn fitted(rect: egui::Rect, (width, height): (f32, f32)) -> egui::Rect {
    let scale = (rect.width() / width).min(rect.height() / height);
    egui::Rect::from_center_size(rect.center(), egui::vec2(width, height) * scale)
}

/// The pixels of a frame, fewer of them where a side is longer than that of a texture may be: a script
/// may ask for pictures that are larger than what the window's device can show.
fn pixels(frame: &Frame, most: usize) -> egui::ColorImage {
    let (width, height) = frame.size;
    let longest = width.max(height) as usize;
    let image = image::ImageBuffer::<image::Rgba<u8>, _>::from_raw(width, height, &frame.rgba[..]);
    if let Some(image) = image.filter(|_| longest > most) {
        let side = |n: u32| ((n as usize * most / longest) as u32).max(1);
        let small = image::imageops::thumbnail(&image, side(width), side(height));
        let size = [small.width() as usize, small.height() as usize];
        return egui::ColorImage::from_rgba_unmultiplied(size, &small);
    }
    egui::ColorImage::from_rgba_unmultiplied([width as usize, height as usize], &frame.rgba)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::window::wgpu_options;

    /// A frame whose columns are black and white in turns.
    fn frame(width: u32, height: u32) -> Frame {
        let pixel = |x: u32| if x.is_multiple_of(2) { [0, 0, 0, 255] } else { [255u8; 4] };
        Frame {
            number: 1,
            size: (width, height),
            is_coarse: false,
            samples: 1,
            rgba: (0..height).flat_map(|_| (0..width).flat_map(pixel)).collect(),
            texture: None,
            ms: 1.0,
            age_ms: 1.0,
            error: None,
            difference: None,
        }
    }

    #[test]
    fn pictures_larger_than_a_texture_are_shown_smaller() {
        let ctx = egui::Context::default();
        let most = ctx.input(|input| input.max_texture_side);
        let side = most as u32;
        let mut shown = Shown::default();
        for (size, expected) in [
            ((side, 3), [most, 3]),
            ((2 * side, 8), [most, 4]),
            ((2, 4 * side), [1, most]),
            ((side + 1, 1), [most, 1]),
        ] {
            shown.take(&ctx, None, &Arc::new(frame(size.0, size.1)));
            let host = shown.host.as_ref().expect("it has pixels");
            assert_eq!(host.size(), expected, "{size:?}");
        }
        let image = pixels(&frame(8, 4), 4);
        assert_eq!((image.size, image.pixels.len()), ([4, 2], 8));
        let is_grey = |c: &egui::Color32| c.r().abs_diff(127) <= 1 && c.a() == 255;
        assert!(image.pixels.iter().all(is_grey), "means of black and white: {image:?}");
    }

    /// A renderer of egui without a window, if there is a device.
    fn renderer() -> Option<RenderState> {
        let config = wgpu_options();
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let made = RenderState::create(&config, &instance, None, Default::default());
        match pollster::block_on(made) {
            Ok(state) => Some(state),
            Err(error) => {
                let is_required = std::env::var("RAYDSL_REQUIRE_GPU").is_ok_and(|v| v == "1");
                assert!(!is_required, "RAYDSL_REQUIRE_GPU=1, but {error}");
                None
            }
        }
    }

    #[test]
    fn textures_of_the_device_are_given_back() {
        let Some(state) = renderer() else { return };
        let on_device = || {
            let texture = state.device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d { width: 4, height: 4, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: wgpu::TextureFormat::Rgba8Unorm,
                usage: wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            });
            Arc::new(Frame { texture: Some(texture), rgba: Vec::new(), ..frame(4, 4) })
        };
        let (ctx, mut shown) = (egui::Context::default(), Shown::default());
        let mut ids = Vec::new();
        for _ in 0..3 {
            for _ in 0..2 {
                shown.take(&ctx, Some(&state), &on_device());
                ids.extend(shown.id());
            }
            shown.take(&ctx, Some(&state), &Arc::new(frame(4, 4)));
            assert_eq!(shown.id(), shown.host.as_ref().map(egui::TextureHandle::id));
            let renderer = state.renderer.read();
            assert!(ids.iter().all(|id| renderer.texture(id).is_none()), "one is kept: {ids:?}");
        }
        assert_eq!(ids.len(), 6);
    }
}
