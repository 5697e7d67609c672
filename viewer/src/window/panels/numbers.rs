//! Times, errors and lanes.

use eframe::egui::{self, RichText, Ui};
use raydsl_viewer::{Action, Goal, Session};

use super::Texts;

pub(super) fn statistics(session: &Session, longest: std::time::Duration, ui: &mut Ui) {
    let row = |ui: &mut Ui, name: &str, value: String| {
        ui.label(name);
        ui.monospace(value);
        ui.end_row();
    };
    egui::Grid::new("statistics").num_columns(2).show(ui, |ui| {
        let (isa, lanes) = session.look().variant.isa();
        row(ui, "runs on", format!("{isa}, {lanes} lanes"));
        if let Some(frame) = session.frame() {
            let coarse = if frame.is_coarse { ", coarse" } else { "" };
            row(ui, "size", format!("{} x {}{coarse}", frame.size.0, frame.size.1));
            row(ui, "samples", format!("{}", frame.samples));
            row(ui, "a sample", format!("{:.1} ms", frame.ms));
            row(ui, "since change", format!("{:.0} ms", frame.age_ms));
            let error = frame.error.map_or("of 2 samples on".to_owned(), |e| format!("{e:.5}"));
            row(ui, "error", error);
            if let Some(found) = frame.difference {
                row(ui, "differ at most", format!("{:e}", found.most));
                row(ui, "in pixels", format!("{}", found.pixels));
            }
        }
        row(ui, "longest turn", format!("{:.1} ms", longest.as_secs_f64() * 1e3));
        if let Some(name) = session.device().name() {
            row(ui, "device", name.chars().take(20).collect());
        }
        if let Some([recorded, printed, compiled]) = session.device().counts() {
            row(ui, "kernels", format!("{recorded} recorded"));
            row(ui, "", format!("{printed} printed, {compiled} compiled"));
        }
    });
}

/// Asks for an error, and shows how far away it is.
pub(super) fn error(session: &Session, texts: &mut Texts, ui: &mut Ui, actions: &mut Vec<Action>) {
    ui.horizontal(|ui| {
        let Goal { error, seconds } = &mut texts.goal;
        let value = egui::DragValue::new(error).range(1e-6..=1.0).speed(1e-4).max_decimals(6);
        ui.add(value).on_hover_text("root mean squared, of 1");
        ui.label("within");
        ui.add(egui::DragValue::new(seconds).range(1.0..=86400.0).suffix(" s"));
        if ui.button("Render").clicked() {
            actions.push(Action::Until(Some(texts.goal)));
        }
    });
    if session.is_aiming() {
        ui.horizontal(|ui| {
            let nearer = session.nearer();
            let found = nearer.map(|progress| progress.estimate.error).filter(|e| e.is_finite());
            // Errors fall with the root of the samples: the share of the work that is done.
            let goal = session.goal().map_or(0.0, |goal| f64::from(goal.error));
            let share = found.map_or(0.0, |error| (goal / error).powi(2).min(1.0));
            let text = found.map_or("taking samples".to_owned(), |error| format!("{error:.5}"));
            ui.add(egui::ProgressBar::new(share as f32).desired_width(150.0).text(text));
            if let Some(progress) = nearer {
                ui.label(format!("{:.0} s left", progress.time_left.as_secs_f64()));
            }
            if ui.button("Stop").clicked() {
                actions.push(Action::Until(None));
            }
        });
    }
    if let Some(reached) = session.reached() {
        let estimate = reached.estimate;
        ui.monospace(format!("{:.5}, at most {:.5}", estimate.error, estimate.high));
        let seconds = reached.elapsed.as_secs_f64();
        ui.monospace(format!("{} samples, {seconds:.1} s", reached.samples));
        ui.label(session.outcome().unwrap_or_default());
    }
}

/// Shows where packets run with few lanes.
pub(super) fn lanes(session: &Session, ui: &mut Ui, actions: &mut Vec<Action>) {
    let Some(found) = session.lanes() else {
        if ui.button("Count the lanes of this picture").clicked() {
            actions.push(Action::Panel("lanes".to_owned(), true));
        }
        return;
    };
    ui.label(format!("{} packets of {} lanes", found.packets, found.lanes));
    // Where most lanes idle is what matters.
    let mut lines: Vec<_> = found.lines.iter().collect();
    let idle = |line: &raydsl_report::LineCount| line.rounds * found.lanes as u64 - line.lanes;
    lines.sort_by_key(|line| std::cmp::Reverse(idle(line)));
    egui::ScrollArea::vertical().max_height(220.0).id_salt("lanes").show(ui, |ui| {
        for line in lines {
            let share = found.share(line) as f32;
            let place = line.place;
            let name = match place.file.rsplit('/').next() {
                Some("") | None => place.what.to_owned(),
                Some(file) => format!("{file}:{} {}", place.line, place.what),
            };
            let bar = egui::ProgressBar::new(share).desired_width(190.0);
            let text = RichText::new(format!("{:.0} %  {name}", 100.0 * share)).small();
            ui.add(bar.text(text)).on_hover_text(format!("{} rounds", line.rounds));
        }
    });
}
