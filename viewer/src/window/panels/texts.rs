//! Text: the log, the keys, the kernel.

use eframe::egui::{self, RichText, Ui};
use raydsl_viewer::{Action, Goal, Session};

use crate::window::input;

/// What is typed into panels.
pub(crate) struct Texts {
    pub(super) path: String,
    pub(super) view: String,
    pub(super) goal: Goal,
    /// Pictures of an animation, and their samples.
    pub(super) frames: u32,
    pub(super) samples: u32,
}

impl Default for Texts {
    fn default() -> Self {
        let goal = Goal { error: 0.01, seconds: 60.0 };
        Self { path: String::new(), view: String::new(), goal, frames: 72, samples: 4 }
    }
}

pub(super) fn log(session: &Session, ui: &mut Ui) {
    let lines = session.log();
    for line in &lines[lines.len().saturating_sub(8)..] {
        let text = RichText::new(line).small();
        let is_error = line.starts_with("error: ");
        ui.label(if is_error { text.color(ui.visuals().error_fg_color) } else { text });
    }
}

pub(super) fn keys(ui: &mut Ui) {
    egui::Grid::new("keys").num_columns(2).show(ui, |ui| {
        for (key, what) in input::KEYS {
            ui.label(RichText::new(key).small().strong());
            ui.label(RichText::new(what).small());
            ui.end_row();
        }
    });
}

pub(super) fn wgsl(session: &Session, ui: &mut Ui, actions: &mut Vec<Action>) {
    let Some(text) = session.wgsl() else {
        if ui.button("Print the kernel of this picture").clicked() {
            actions.push(Action::Panel("wgsl".to_owned(), true));
        }
        return;
    };
    let lines: Vec<&str> = text.lines().collect();
    ui.label(format!("{} lines", lines.len()));
    let height = ui.text_style_height(&egui::TextStyle::Monospace);
    let area = egui::ScrollArea::both().max_height(400.0).auto_shrink([false, false]);
    area.show_rows(ui, height, lines.len(), |ui, rows| {
        for line in &lines[rows] {
            let label = egui::Label::new(RichText::new(*line).monospace().small());
            ui.add(label.wrap_mode(egui::TextWrapMode::Extend));
        }
    });
}
