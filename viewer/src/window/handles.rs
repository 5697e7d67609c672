//! Handles of cut objects in the picture, dragged by the mouse.

use eframe::egui::{self, Color32, PointerButton, Response, Stroke, Ui};
use raydsl::prelude::*;
use raydsl_viewer::{Action, CutObject, Session};

use super::picture::Place;

/// Distance from a handle at which the mouse takes it.
const REACH: f32 = 12.0;

/// The handle that is dragged.
#[derive(Default)]
pub(crate) struct Handles {
    dragged: Option<usize>,
}

impl Handles {
    /// Draws the handles, and moves the one that is dragged; returns whether one is.
    pub(crate) fn show(
        &mut self,
        session: &Session,
        ui: &Ui,
        response: &Response,
        place: &Place,
        actions: &mut Vec<Action>,
    ) -> bool {
        let handles = handles(session, place);
        let nearest = |at: egui::Pos2| {
            let near = handles.iter().filter(|(_, handle)| handle.distance(at) < REACH);
            near.min_by(|a, b| a.1.distance(at).total_cmp(&b.1.distance(at))).map(|(i, _)| *i)
        };
        if response.drag_started_by(PointerButton::Primary) {
            self.dragged = ui.input(|input| input.pointer.press_origin()).and_then(nearest);
        }
        if !response.dragged() {
            self.dragged = None;
        }
        let hovered = response.hover_pos().and_then(nearest);
        for (i, at) in &handles {
            let is_near = self.dragged.or(hovered) == Some(*i);
            let color = if is_near { Color32::from_rgb(255, 170, 60) } else { Color32::WHITE };
            let painter = ui.painter_at(response.rect);
            painter.circle(*at, 5.0, color.gamma_multiply(0.35), Stroke::new(1.5, color));
            if is_near && let Some(cut) = session.look().cuts.get(*i) {
                let name = match cut {
                    CutObject::Ball { .. } => "ball",
                    CutObject::Half { .. } => "half",
                };
                let (side, font) = (egui::Align2::LEFT_CENTER, egui::FontId::proportional(12.0));
                painter.text(*at + egui::vec2(9.0, 0.0), side, format!("{i} {name}"), font, color);
            }
        }
        if let Some(i) = self.dragged
            && let Some(at) = response.interact_pointer_pos()
            && response.drag_delta() != egui::Vec2::ZERO
        {
            actions.push(Action::DragCut(i, place.pixel(at)));
        }
        self.dragged.is_some()
    }
}

/// Where the handles of cut objects are on the screen.
fn handles(session: &Session, place: &Place) -> Vec<(usize, egui::Pos2)> {
    let (Some(info), look) = (session.info(), session.look()) else { return Vec::new() };
    let seen = |cut: &CutObject| {
        let point: Vec3 = info.bounds.min + cut.place() * info.bounds.size();
        look.pose.seen(look.size, point).map(|pixel| place.screen(pixel))
    };
    let cuts = look.cuts.iter().enumerate();
    cuts.filter_map(|(i, cut)| Some((i, seen(cut)?))).collect()
}
