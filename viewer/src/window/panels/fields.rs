//! Cuts and picks.

use eframe::egui::{self, Ui};
use raydsl::prelude::*;
use raydsl_viewer::{Action, CutObject, Session};

use crate::window::input::BALL;

pub(super) fn cuts(session: &Session, ui: &mut Ui, actions: &mut Vec<Action>) {
    if session.info().is_none_or(|info| !info.kind.is_field()) {
        ui.label("Volumes and cells can be cut open.");
        return;
    }
    ui.horizontal(|ui| {
        if ui.button("Add a ball").clicked() {
            actions.push(Action::AddCut(BALL));
        }
        if ui.button("Add a half").clicked() {
            let (through, normal) = (Vec3::splat(0.5), -Vec3::Y);
            actions.push(Action::AddCut(CutObject::Half { through, normal }));
        }
    });
    for (i, cut) in session.look().cuts.iter().enumerate() {
        let place = cut.place();
        let name = match cut {
            CutObject::Ball { .. } => "ball",
            CutObject::Half { .. } => "half",
        };
        ui.horizontal(|ui| {
            ui.label(format!("{i} {name}"));
            let mut moved = place;
            for axis in 0..3 {
                ui.add(egui::DragValue::new(&mut moved[axis]).speed(0.005).max_decimals(3));
            }
            if moved != place {
                actions.push(Action::MoveCut(i, moved - place));
            }
            if ui.small_button("x").on_hover_text("remove it").clicked() {
                actions.push(Action::RemoveCut(i));
            }
        });
    }
}

pub(super) fn pick(session: &Session, ui: &mut Ui) {
    match session.picked() {
        None => ui.label("Click into the picture."),
        Some(None) => ui.label("There is nothing."),
        Some(Some(picked)) => {
            ui.monospace(format!("number {}", picked.id));
            let Vec3 { x, y, z } = picked.position;
            ui.monospace(format!("at {x:.3}, {y:.3}, {z:.3}"));
            ui.monospace(&picked.value)
        }
    };
}
