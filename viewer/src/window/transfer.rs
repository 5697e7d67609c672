//! The editor of a volume's transfer function, over the histogram.

use eframe::egui::{self, Color32, Pos2, Rect, Sense, Stroke, Ui};
use raydsl::prelude::*;
use raydsl_viewer::{Action, Info, Knot, PRESETS, Session};

/// The editor: which knot is being moved or coloured.
#[derive(Default)]
pub(crate) struct Editor {
    chosen: Option<usize>,
}

/// Pixels around a knot where the mouse takes it.
const REACH: f32 = 10.0;

impl Editor {
    /// Shows the editor.
    pub(crate) fn show(&mut self, session: &Session, ui: &mut Ui, actions: &mut Vec<Action>) {
        let info = session.info().filter(|info| info.kind.is_field());
        let Some(info) = info else {
            ui.label("Volumes and cells have one.");
            return;
        };
        let knots = &session.look().knots;
        let size = egui::vec2(ui.available_width().max(40.0), 130.0);
        let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
        draw(ui, rect, info, knots, self.chosen);
        let place = |k: &Knot| rect.lerp_inside(egui::vec2(k.at, 1.0 - k.opacity));
        let nearest = |at: Pos2| {
            let distance = |i: &usize| place(&knots[*i]).distance(at);
            let found = (0..knots.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
            found.filter(|i| distance(i) < REACH)
        };
        let here = |at: Pos2| {
            let share = (at - rect.min) / rect.size();
            (share.x.clamp(0.0, 1.0), (1.0 - share.y).clamp(0.0, 1.0))
        };
        let pressed = ui.input(|input| input.pointer.press_origin());
        if response.drag_started() {
            self.chosen = pressed.and_then(nearest);
        }
        if let (Some(i), Some(at)) = (self.chosen, response.interact_pointer_pos())
            && response.dragged()
            && let Some(knot) = knots.get(i)
        {
            actions.push(Action::SetKnot(i, moved(knots, i, *knot, here(at))));
        }
        if let Some(at) = response.interact_pointer_pos() {
            if response.clicked() {
                self.chosen = nearest(at);
                if self.chosen.is_none() {
                    let (at, opacity) = here(at);
                    actions.push(Action::AddKnot(Knot { at, opacity, color: color_at(knots, at) }));
                }
            } else if response.secondary_clicked()
                && let Some(i) = nearest(at)
            {
                self.chosen = None;
                actions.push(Action::RemoveKnot(i));
            }
        }
        self.color(knots, ui, actions);
        presets(ui, actions);
    }

    /// Shows the colour of the chosen knot.
    fn color(&mut self, knots: &[Knot], ui: &mut Ui, actions: &mut Vec<Action>) {
        let chosen = self.chosen.and_then(|i| Some((i, *knots.get(i)?)));
        let Some((i, knot)) = chosen else {
            ui.small("Click adds a knot, dragging moves it, the right button removes it.");
            return;
        };
        ui.horizontal(|ui| {
            let mut color = knot.color.to_array();
            let button = egui::color_picker::color_edit_button_rgb(ui, &mut color);
            if button.changed() {
                let color = Vec3::from_array(color).clamp(Vec3::ZERO, Vec3::ONE);
                actions.push(Action::SetKnot(i, Knot { color, ..knot }));
            }
            ui.monospace(format!("knot {i}: {:.3}, opacity {:.3}", knot.at, knot.opacity));
        });
    }
}

/// A knot at another place, between its neighbours: their numbers stay.
fn moved(knots: &[Knot], i: usize, knot: Knot, (at, opacity): (f32, f32)) -> Knot {
    let low = if i > 0 { knots[i - 1].at } else { 0.0 };
    let high = knots.get(i + 1).map_or(1.0, |next| next.at);
    Knot { at: at.clamp(low, high.max(low)), opacity, color: knot.color }
}

/// The colour between the neighbours of a place.
fn color_at(knots: &[Knot], at: f32) -> Vec3 {
    let after = knots.iter().position(|k| k.at >= at);
    match after {
        None => knots.last().map_or(Vec3::ONE, |k| k.color),
        Some(0) => knots[0].color,
        Some(i) => {
            let (a, b) = (knots[i - 1], knots[i]);
            let share = if b.at > a.at { (at - a.at) / (b.at - a.at) } else { 0.0 };
            a.color.lerp(b.color, share)
        }
    }
}

fn shown(color: Vec3) -> Color32 {
    let byte = |c: f32| (linear_to_srgb(c.clamp(0.0, 1.0)) * 255.0 + 0.5) as u8;
    Color32::from_rgb(byte(color.x), byte(color.y), byte(color.z))
}

fn draw(ui: &Ui, rect: Rect, info: &Info, knots: &[Knot], chosen: Option<usize>) {
    let painter = ui.painter_at(rect.expand(6.0));
    painter.rect_filled(rect, 2.0, Color32::from_gray(18));
    // The logarithm: most voxels are air.
    let most = info.histogram.iter().copied().max().unwrap_or(1).max(1) as f32;
    let width = rect.width() / info.histogram.len().max(1) as f32;
    for (i, count) in info.histogram.iter().enumerate() {
        let share = (*count as f32).ln_1p() / most.ln_1p();
        let left = rect.left() + i as f32 * width;
        let min = egui::pos2(left, rect.bottom() - share * rect.height());
        let bar = Rect::from_min_max(min, egui::pos2(left + width, rect.bottom()));
        let color = shown(color_at(knots, (i as f32 + 0.5) / info.histogram.len() as f32));
        painter.rect_filled(bar, 0.0, color.gamma_multiply(0.45));
    }
    let place = |k: &Knot| rect.lerp_inside(egui::vec2(k.at, 1.0 - k.opacity));
    let mut line: Vec<Pos2> = knots.iter().map(place).collect();
    if let (Some(first), Some(last)) = (line.first().copied(), line.last().copied()) {
        line.insert(0, egui::pos2(rect.left(), first.y));
        line.push(egui::pos2(rect.right(), last.y));
    }
    painter.line(line, Stroke::new(1.5, Color32::WHITE));
    for (i, knot) in knots.iter().enumerate() {
        let radius = if chosen == Some(i) { 6.0 } else { 4.5 };
        painter.circle(place(knot), radius, shown(knot.color), Stroke::new(1.0, Color32::WHITE));
    }
}

/// The buttons of ready-made transfer functions.
fn presets(ui: &mut Ui, actions: &mut Vec<Action>) {
    ui.horizontal(|ui| {
        for name in PRESETS {
            if ui.button(name).clicked() {
                actions.push(Action::Preset(name.to_owned()));
            }
        }
    });
}
