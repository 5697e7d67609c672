//! Cameras that are kept, and pictures that follow each other.

use eframe::egui::{self, Ui};
use raydsl_viewer::{Action, Animation, Session, Way};

use super::Texts;

pub(super) fn views(session: &Session, texts: &mut Texts, ui: &mut Ui, actions: &mut Vec<Action>) {
    ui.horizontal(|ui| {
        let hint = egui::TextEdit::singleline(&mut texts.view).hint_text("name");
        ui.add(hint.desired_width(140.0));
        let name: String = texts.view.split_whitespace().collect::<Vec<_>>().join("-");
        if ui.button("Keep").clicked() && !name.is_empty() {
            actions.push(Action::SaveView(name));
        }
        if ui.button("Home").clicked() {
            actions.push(Action::Home);
        }
    });
    for name in session.views().keys() {
        ui.horizontal(|ui| {
            if ui.button(name).clicked() {
                actions.push(Action::View(name.clone()));
            }
            if ui.small_button("x").on_hover_text("forget it").clicked() {
                actions.push(Action::DropView(name.clone()));
            }
        });
    }
}

/// Writes pictures that follow each other.
pub(super) fn animation(
    session: &Session,
    is_playing: bool,
    texts: &mut Texts,
    ui: &mut Ui,
    actions: &mut Vec<Action>,
) {
    if is_playing {
        ui.horizontal(|ui| {
            ui.spinner();
            ui.label(format!("{} pictures", session.recorded().unwrap_or(0)));
            if ui.button("Stop").clicked() {
                actions.push(Action::Cancel);
            }
        });
        return;
    }
    ui.horizontal(|ui| {
        ui.add(egui::DragValue::new(&mut texts.frames).range(1..=10_000).suffix(" pictures"));
        ui.label("of");
        ui.add(egui::DragValue::new(&mut texts.samples).range(1..=65_536).suffix(" samples"));
    });
    ui.horizontal_wrapped(|ui| {
        let frames = texts.frames;
        for (way, name, hint) in [
            (Way::Turntable(frames), "Turntable", "once around the middle"),
            (Way::Views(frames), "Cameras", "along those that are kept"),
            (Way::Steps, "Time steps", "a picture for each"),
        ] {
            if ui.button(name).on_hover_text(hint).clicked() {
                let name = name.to_lowercase().replace(' ', "-");
                actions.push(Action::Animate(Animation { way, samples: texts.samples, name }));
            }
        }
    });
}
