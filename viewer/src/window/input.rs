//! Mouse and keys as actions.

use std::path::Path;

use eframe::egui::{self, Key, PointerButton, Response};
use raydsl::prelude::*;
use raydsl_viewer::{Action, Kind, Mode, Session, Show};

/// Degrees of a drag over the whole height.
const DEGREES: f32 = 180.0;
/// Share of the distance that a key moves in a second.
const SPEED: f32 = 0.7;

/// The keys, and what they do.
pub(crate) const KEYS: [(&str, &str); 14] = [
    ("drag", "turn around the middle"),
    ("right drag", "move sideways"),
    ("middle drag", "look around"),
    ("wheel", "nearer and farther"),
    ("click", "pick: what is there?"),
    ("W A S D Q E", "fly ahead, left, back, right, down, up"),
    ("arrows", "turn around the middle"),
    ("H", "see all"),
    ("M", "next mode"),
    ("1 2 3 4 5", "scalar, packets of 4, 8, 16, WGSL"),
    ("C", "cost as a heat map, and back"),
    ("[ and ]", "time step before and behind"),
    ("P, F12, F1", "write the picture, the window; keys"),
    ("Ctrl+Q", "quit"),
];

/// Files that were dropped on the window: the first is opened, and the others are time steps.
pub(crate) fn dropped(ctx: &egui::Context, actions: &mut Vec<Action>) {
    ctx.input(|input| {
        let mut files = input.raw.dropped_files.iter().map(|file| file.path().to_path_buf());
        actions.extend(files.next().map(Action::Open));
        actions.extend(files.map(Action::Add));
    });
}

/// What the mouse does over the picture; `pixel` gives the picture's pixel at a place.
pub(crate) fn mouse(
    ui: &egui::Ui,
    response: &Response,
    pixel: impl Fn(egui::Pos2) -> Option<(u32, u32)>,
    actions: &mut Vec<Action>,
) {
    let height = response.rect.height().max(1.0);
    let by = response.drag_delta() / height;
    if by != egui::Vec2::ZERO {
        let is_shifted = ui.input(|input| input.modifiers.shift);
        if response.dragged_by(PointerButton::Primary) && !is_shifted {
            actions.push(Action::Orbit(-by.x * DEGREES, by.y * DEGREES));
        } else if response.dragged_by(PointerButton::Middle) {
            actions.push(Action::Turn(-by.x * DEGREES / 3.0, -by.y * DEGREES / 3.0));
        } else {
            actions.push(Action::Fly(vec3(-by.x, by.y, 0.0)));
        }
    }
    if response.hovered() {
        let wheel = ui.input(|input| input.smooth_scroll_delta.y);
        if wheel != 0.0 {
            actions.push(Action::Zoom((-wheel / 400.0).exp().clamp(0.2, 5.0)));
        }
    }
    if response.clicked()
        && let Some((x, y)) = response.interact_pointer_pos().and_then(pixel)
    {
        actions.push(Action::Pick(x, y));
    }
}

/// What the keys do, unless a text is being typed; `pictures` counts those that were written.
pub(crate) fn keys(
    ui: &egui::Ui,
    session: &Session,
    pictures: &mut usize,
    actions: &mut Vec<Action>,
) {
    let is_command = ui.input(|input| input.modifiers.command);
    let pressed = |key| ui.input(|input| input.key_pressed(key));
    if is_command && pressed(Key::Q) {
        actions.push(Action::Quit);
    }
    if is_command || ui.ctx().egui_wants_keyboard_input() {
        return;
    }
    let (moved, turned) = ui.input(|input| {
        let axis = |more, less| {
            f32::from(u8::from(input.key_down(more))) - f32::from(u8::from(input.key_down(less)))
        };
        // A window that was idle would else jump.
        let time = input.stable_dt.min(0.1);
        let moved = vec3(axis(Key::D, Key::A), axis(Key::E, Key::Q), axis(Key::W, Key::S));
        let turned = (axis(Key::ArrowRight, Key::ArrowLeft), axis(Key::ArrowUp, Key::ArrowDown));
        (moved * SPEED * time, (turned.0 * 60.0 * time, turned.1 * 60.0 * time))
    });
    if moved != Vec3::ZERO {
        actions.push(Action::Fly(moved));
    }
    if turned != (0.0, 0.0) {
        actions.push(Action::Orbit(turned.0, turned.1));
    }
    if moved != Vec3::ZERO || turned != (0.0, 0.0) {
        ui.ctx().request_repaint();
    }
    for key in [Key::H, Key::M, Key::C, Key::OpenBracket, Key::CloseBracket, Key::P, Key::F12] {
        if pressed(key) {
            actions.extend(of_key(key, session, pictures));
        }
    }
    let digits = [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5];
    for (key, variant) in digits.into_iter().zip(Variant::ALL) {
        if pressed(key) {
            actions.push(Action::Variant(variant));
        }
    }
}

/// Returns the next number that no picture in the folder has.
fn free_number(out: &Path, before: usize) -> usize {
    let is_taken = |i: &usize| {
        ["picture", "window"].iter().any(|name| out.join(format!("{name}-{i}.png")).exists())
    };
    (before + 1..).find(|i| !is_taken(i)).unwrap_or(before)
}

fn of_key(key: Key, session: &Session, pictures: &mut usize) -> Option<Action> {
    let look = session.look();
    Some(match key {
        Key::H => Action::Home,
        Key::M => {
            let modes = Mode::of(session.info()?.kind);
            let at = modes.iter().position(|mode| *mode == look.mode).unwrap_or(0);
            Action::Mode(modes[(at + 1) % modes.len()])
        }
        Key::C if look.show == Show::Cost => Action::Show(Show::Picture),
        Key::C if session.info()?.kind == Kind::Volume => return None,
        Key::C => Action::Show(Show::Cost),
        Key::OpenBracket => Action::Step(session.steps().1.checked_sub(1)?),
        Key::CloseBracket => Action::Step(session.steps().1 + 1),
        key => {
            *pictures = free_number(session.out(), *pictures);
            if key == Key::P {
                Action::Picture(format!("picture-{pictures}.png"))
            } else {
                Action::Screenshot(format!("window-{pictures}.png"))
            }
        }
    })
}
