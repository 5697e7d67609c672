//! The picture in the middle of the window.

use std::sync::Arc;

use eframe::egui;
use eframe::egui_wgpu::RenderState;
use raydsl_viewer::{Action, Frame};

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
        if !self.is_played {
            self.fit(rect, ui.ctx().pixels_per_point(), actions);
        }
        if let Some(newest) = self.session.frame() {
            self.shown.take(ui, frame.wgpu_render_state(), newest);
        }
        let (width, height) = self.session.look().size;
        let place = fitted(rect, (width as f32, height as f32));
        let Some(id) = self.shown.id() else {
            let text = "Drop a file here, or type its name at the left.";
            let middle = egui::Align2::CENTER_CENTER;
            let font = egui::FontId::proportional(16.0);
            ui.painter().text(rect.center(), middle, text, font, egui::Color32::GRAY);
            return;
        };
        let whole = egui::Rect::from_min_max(egui::pos2(0.0, 0.0), egui::pos2(1.0, 1.0));
        ui.painter().image(id, place, whole, egui::Color32::WHITE);
        let pixel = |at: egui::Pos2| {
            let share = (at - place.min) / place.size();
            let inside = (0.0..1.0).contains(&share.x) && (0.0..1.0).contains(&share.y);
            let (x, y) = (share.x * width as f32, (1.0 - share.y) * height as f32);
            inside.then(|| ((x as u32).min(width - 1), (y as u32).min(height - 1)))
        };
        input::mouse(ui, &response, pixel, actions);
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

/// The largest place of a picture in a rectangle.
fn fitted(rect: egui::Rect, (width, height): (f32, f32)) -> egui::Rect {
    let scale = (rect.width() / width).min(rect.height() / height);
    egui::Rect::from_center_size(rect.center(), egui::vec2(width, height) * scale)
}
