//! The panels beside the picture.

mod cameras;
mod data;
mod fields;
mod look;
mod numbers;
mod texts;

use eframe::egui::{self, Ui};
use raydsl_viewer::Action;

use super::{PANELS, Viewer};
pub(crate) use texts::Texts;

/// The panels at the left, above those at the right.
const LEFT: usize = 5;

/// Shows all panels, at both sides of the picture.
pub(crate) fn show(viewer: &mut Viewer, ui: &mut Ui, actions: &mut Vec<Action>) {
    // A window of a few pixels has no room beside the picture.
    if ui.available_width() > 700.0 {
        let (left, right) = PANELS.split_at(LEFT);
        let panel = egui::Panel::left("left").default_size(270.0);
        panel.show(ui, |ui| column(viewer, left, ui, actions));
        let panel = egui::Panel::right("right").default_size(230.0);
        panel.show(ui, |ui| column(viewer, right, ui, actions));
    }
    if ui.input(|input| input.key_pressed(egui::Key::F1)) {
        let is_open = viewer.panels.contains("keys");
        actions.push(Action::Panel("keys".to_owned(), !is_open));
    }
}

fn column(viewer: &mut Viewer, names: &[&str], ui: &mut Ui, actions: &mut Vec<Action>) {
    egui::ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
        for name in names {
            let is_open = viewer.panels.contains(name);
            let header = egui::CollapsingHeader::new(title(name)).open(Some(is_open));
            let response = header.show(ui, |ui| body(viewer, name, ui, actions));
            if response.header_response.clicked() {
                actions.push(Action::Panel((*name).to_owned(), !is_open));
            }
        }
    });
}

fn title(name: &str) -> &'static str {
    match name {
        "open" => "Data",
        "look" => "Mode and variant",
        "statistics" => "Statistics",
        "error" => "Error to reach",
        "transfer" => "Transfer function",
        "cuts" => "Cut objects",
        "pick" => "Pick",
        "views" => "Cameras",
        "animation" => "Animation",
        "lanes" => "Lanes",
        "log" => "Log",
        "keys" => "Keys",
        _ => "WGSL",
    }
}

fn body(viewer: &mut Viewer, name: &str, ui: &mut Ui, actions: &mut Vec<Action>) {
    let is_animating = viewer.is_animating();
    let (session, texts) = (&viewer.session, &mut viewer.texts);
    match name {
        "open" => data::show(session, texts, &mut viewer.dialog, ui, actions),
        "look" => look::show(session, ui, actions),
        "statistics" => numbers::statistics(session, viewer.longest, ui),
        "error" => numbers::error(session, texts, ui, actions),
        "transfer" => viewer.transfer.show(session, ui, actions),
        "cuts" => fields::cuts(session, ui, actions),
        "pick" => fields::pick(session, ui),
        "views" => cameras::views(session, texts, ui, actions),
        "animation" => cameras::animation(session, is_animating, texts, ui, actions),
        "lanes" => numbers::lanes(session, ui, actions),
        "log" => texts::log(session, ui),
        "keys" => texts::keys(ui),
        _ => texts::wgsl(session, ui, actions),
    }
}
