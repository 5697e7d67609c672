//! Modes, variants and what is shown.

use eframe::egui::{self, Ui};
use raydsl::prelude::*;
use raydsl_viewer::{Action, Mode, Session, Show};

pub(super) fn show(session: &Session, ui: &mut Ui, actions: &mut Vec<Action>) {
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
        let is_field = session.info().is_some_and(|info| info.kind.is_field());
        for (show, name) in [(Show::Picture, "picture"), (Show::Cost, "cost")] {
            if show == Show::Cost && is_field {
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
