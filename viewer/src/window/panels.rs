//! The panels beside the picture.

use eframe::egui::{self, RichText, Ui};
use raydsl::prelude::*;
use raydsl_viewer::{Action, CutObject, Kind, Mode, PRESETS, Session, Show};

use super::{PANELS, Viewer, input};

/// What is typed into panels.
#[derive(Default)]
pub(crate) struct Texts {
    path: String,
    view: String,
}

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
        "transfer" => "Transfer function",
        "cuts" => "Cut objects",
        "pick" => "Pick",
        "views" => "Cameras",
        "log" => "Log",
        "keys" => "Keys",
        _ => "WGSL",
    }
}

fn body(viewer: &mut Viewer, name: &str, ui: &mut Ui, actions: &mut Vec<Action>) {
    let session = &viewer.session;
    match name {
        "open" => data(session, &mut viewer.texts, ui, actions),
        "look" => look(session, ui, actions),
        "statistics" => statistics(session, viewer.longest, ui),
        "transfer" => viewer.transfer.show(session, ui, actions),
        "cuts" => cuts(session, ui, actions),
        "pick" => pick(session, ui),
        "views" => views(session, &mut viewer.texts, ui, actions),
        "log" => log(session, ui),
        "keys" => keys(ui),
        _ => wgsl(session, ui, actions),
    }
}

fn data(session: &Session, texts: &mut Texts, ui: &mut Ui, actions: &mut Vec<Action>) {
    ui.horizontal(|ui| {
        let hint = egui::TextEdit::singleline(&mut texts.path).hint_text("file, or drop it here");
        let response = ui.add(hint.desired_width(190.0));
        let is_entered =
            response.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
        if (ui.button("Open").clicked() || is_entered) && !texts.path.trim().is_empty() {
            actions.push(Action::Open(texts.path.trim().into()));
        }
    });
    if let Some(info) = session.info() {
        ui.label(RichText::new(&info.name).strong());
        ui.label(&info.size);
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

fn look(session: &Session, ui: &mut Ui, actions: &mut Vec<Action>) {
    let look = session.look();
    if let Some(info) = session.info() {
        ui.horizontal_wrapped(|ui| {
            for mode in Mode::of(info.kind) {
                if ui.selectable_label(look.mode == *mode, mode.name()).clicked() {
                    actions.push(Action::Mode(*mode));
                }
            }
        });
    }
    ui.separator();
    ui.horizontal_wrapped(|ui| {
        for variant in Variant::ALL {
            if ui.selectable_label(look.variant == variant, variant.name()).clicked() {
                actions.push(Action::Variant(variant));
            }
        }
    });
    ui.separator();
    ui.horizontal_wrapped(|ui| {
        let is_volume = session.info().is_some_and(|info| info.kind == Kind::Volume);
        for (show, name) in [(Show::Picture, "picture"), (Show::Cost, "cost")] {
            if show == Show::Cost && is_volume {
                continue;
            }
            if ui.selectable_label(look.show == show, name).clicked() {
                actions.push(Action::Show(show));
            }
        }
        for other in Variant::ALL.into_iter().filter(|v| *v != look.variant) {
            let show = Show::Difference(other);
            let name = format!("- {}", other.name());
            let hint = "how much that variant differs";
            if ui.selectable_label(look.show == show, name).on_hover_text(hint).clicked() {
                actions.push(Action::Show(show));
            }
        }
    });
    let mut exposure = look.exposure;
    if ui.add(egui::Slider::new(&mut exposure, -6.0..=6.0).text("exposure")).changed() {
        actions.push(Action::Exposure(exposure));
    }
}

fn statistics(session: &Session, longest: std::time::Duration, ui: &mut Ui) {
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

fn cuts(session: &Session, ui: &mut Ui, actions: &mut Vec<Action>) {
    if session.info().is_none_or(|info| info.kind != Kind::Volume) {
        ui.label("Volumes can be cut open.");
        return;
    }
    ui.horizontal(|ui| {
        if ui.button("Add a ball").clicked() {
            let (center, radius) = (vec3(0.65, 0.75, 0.7), 0.3);
            actions.push(Action::AddCut(CutObject::Ball { center, radius }));
        }
        if ui.button("Add a half").clicked() {
            let (through, normal) = (Vec3::splat(0.5), -Vec3::Y);
            actions.push(Action::AddCut(CutObject::Half { through, normal }));
        }
    });
    for (i, cut) in session.look().cuts.iter().enumerate() {
        let (name, place) = match cut {
            CutObject::Ball { center, .. } => ("ball", *center),
            CutObject::Half { through, .. } => ("half", *through),
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

fn pick(session: &Session, ui: &mut Ui) {
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

fn views(session: &Session, texts: &mut Texts, ui: &mut Ui, actions: &mut Vec<Action>) {
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

fn log(session: &Session, ui: &mut Ui) {
    let lines = session.log();
    for line in &lines[lines.len().saturating_sub(8)..] {
        let text = RichText::new(line).small();
        let is_error = line.starts_with("error: ");
        ui.label(if is_error { text.color(ui.visuals().error_fg_color) } else { text });
    }
}

fn keys(ui: &mut Ui) {
    egui::Grid::new("keys").num_columns(2).show(ui, |ui| {
        for (key, what) in input::KEYS {
            ui.label(RichText::new(key).small().strong());
            ui.label(RichText::new(what).small());
            ui.end_row();
        }
    });
}

fn wgsl(session: &Session, ui: &mut Ui, actions: &mut Vec<Action>) {
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

/// The buttons of ready-made transfer functions.
pub(crate) fn presets(ui: &mut Ui, actions: &mut Vec<Action>) {
    ui.horizontal(|ui| {
        for name in PRESETS {
            if ui.button(name).clicked() {
                actions.push(Action::Preset(name.to_owned()));
            }
        }
    });
}
