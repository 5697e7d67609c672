//! The picture in the middle of the window.

use std::sync::Arc;

use eframe::egui;
use eframe::egui_wgpu::RenderState;
use raydsl::prelude::*;
use raydsl_viewer::{Action, Frame};

use super::dialog::Ask;
use super::{Viewer, input};

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
    fn take(&mut self, ui: &egui::Ui, state: Option<&RenderState>, frame: &Arc<Frame>) {
        if self.frame.as_ref().is_some_and(|shown| Arc::ptr_eq(shown, frame)) {
            return;
        }
        self.frame = Some(frame.clone());
        match (&frame.texture, state) {
            (Some(texture), Some(state)) => self.take_texture(state, texture),
            (Some(_), None) => {}
            (None, _) => {
                self.device = None;
                let size = [frame.size.0 as usize, frame.size.1 as usize];
                let image = egui::ColorImage::from_rgba_unmultiplied(size, &frame.rgba);
                let options = egui::TextureOptions::LINEAR;
                match &mut self.host {
                    Some(host) => host.set(image, options),
                    None => self.host = Some(ui.ctx().load_texture("picture", image, options)),
                }
            }
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
            self.fit(rect, ui.ctx().pixels_per_point(), actions);
        }
        if let Some(newest) = self.session.frame() {
            self.shown.take(ui, frame.wgpu_render_state(), newest);
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

    /// Makes the picture as large as its place.
    fn fit(&self, rect: egui::Rect, scale: f32, actions: &mut Vec<Action>) {
        let side = |length: f32| ((length * scale).round() as u32).clamp(1, 8192);
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
