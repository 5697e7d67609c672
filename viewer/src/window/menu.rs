//! The menu over the picture, with the mouse as its wand.

use eframe::egui::{self, Response, Ui};
use raydsl_viewer::{Action, Menu, Session, Wand};

use super::picture::Place;

/// The most pixels along a side of the menu's picture: it is made while the window waits.
const MOST_SIDE: u32 = 720;

/// The menu's picture, and what it is of.
#[derive(Default)]
pub(crate) struct ShownMenu {
    menu: Option<Menu>,
    texture: Option<egui::TextureHandle>,
    /// Where the mouse was when it last moved the wand.
    mouse: Option<egui::Pos2>,
}

impl ShownMenu {
    /// Shows the menu, if one is open.
    pub(crate) fn show(&mut self, session: &Session, ui: &Ui, place: &Place) {
        let Some(menu) = session.menu() else {
            *self = Self::default();
            return;
        };
        if self.menu.as_ref() != Some(&menu) {
            let image = pixels(&menu, session);
            let options = egui::TextureOptions::LINEAR;
            match &mut self.texture {
                Some(texture) => texture.set(image, options),
                None => self.texture = Some(ui.ctx().load_texture("menu", image, options)),
            }
            self.menu = Some(menu);
        }
        if let Some(texture) = &self.texture {
            let whole = egui::Rect::from_min_max(egui::pos2(0.0, 0.0), egui::pos2(1.0, 1.0));
            ui.painter().image(texture.id(), place.rect, whole, egui::Color32::WHITE);
        }
    }

    /// Points with the mouse; returns whether a click was one on an item.
    pub(crate) fn point(
        &mut self,
        response: &Response,
        place: &Place,
        actions: &mut Vec<Action>,
    ) -> bool {
        let Some(menu) = &self.menu else { return false };
        if let Some(at) = response.hover_pos()
            && self.mouse != Some(at)
        {
            self.mouse = Some(at);
            actions.push(Action::Wand(Wand::Pixel(place.pixel(at))));
        }
        let is_pressed = response.clicked() && menu.pointed().is_some();
        if is_pressed {
            actions.push(Action::Press);
        }
        is_pressed
    }
}

/// The pixels of a menu, from the top, in a picture that is no larger than needed.
fn pixels(menu: &Menu, session: &Session) -> egui::ColorImage {
    let look = session.look();
    let (width, height) = look.size;
    let scale = (MOST_SIDE as f32 / width.max(height) as f32).min(1.0);
    let side = |n: u32| ((n as f32 * scale).round() as u32).max(1);
    let image = menu.picture(&look.pose.camera(), (side(width), side(height)));
    let color = |pixel: &raydsl::prelude::Vec4| {
        let [r, g, b, alpha] = pixel.to_array();
        // Linear colours times alpha, as egui wants them.
        egui::Rgba::from_rgba_premultiplied(r, g, b, alpha).into()
    };
    let pixels = image.rows().rev().flatten().map(color).collect();
    egui::ColorImage::new([image.width() as usize, image.height() as usize], pixels)
}
