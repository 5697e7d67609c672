//! What is open, and what may be.

use eframe::egui::{self, RichText, Ui};
use raydsl_viewer::{Action, Session};

use super::Texts;
use crate::window::dialog::{Ask, Dialog};
use crate::window::input::opened;

pub(super) fn show(
    session: &Session,
    texts: &mut Texts,
    dialog: &mut Dialog,
    ui: &mut Ui,
    actions: &mut Vec<Action>,
) {
    ui.horizontal(|ui| {
        let hint = egui::TextEdit::singleline(&mut texts.path).hint_text("file, or drop it here");
        let response = ui.add(hint.desired_width(190.0));
        let is_entered =
            response.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
        if (ui.button("Open").clicked() || is_entered) && !texts.path.trim().is_empty() {
            actions.push(opened(session, texts.path.trim().into()));
        }
    });
    ui.horizontal(|ui| {
        for (ask, name) in [(Ask::Files, "Choose files"), (Ask::Folder, "Choose a folder")] {
            if ui.add_enabled(!dialog.is_open(), egui::Button::new(name)).clicked() {
                dialog.open(ask, ui.ctx());
            }
        }
    });
    if let Some(info) = session.info() {
        ui.label(RichText::new(&info.name).strong());
        ui.label(&info.size);
    }
    if let Some(sky) = &session.look().sky {
        ui.horizontal(|ui| {
            let name = sky.path().file_name().unwrap_or_default().to_string_lossy();
            ui.label(format!("lit by {name}"));
            if ui.small_button("x").on_hover_text("the light of the file alone").clicked() {
                actions.push(Action::Environment(None));
            }
        });
    }
    if let Some((what, share)) = session.progress() {
        ui.horizontal(|ui| {
            ui.add(egui::ProgressBar::new(share).desired_width(190.0).text(what));
            if ui.button("Cancel").clicked() {
                actions.push(Action::Cancel);
            }
        });
    }
    let (files, step) = session.steps();
    if files.len() > 1 {
        let mut chosen = step;
        let slider = egui::Slider::new(&mut chosen, 0..=files.len() - 1).text("time step");
        if ui.add(slider).changed() {
            actions.push(Action::Step(chosen));
        }
    }
}
