//! Mouse and keys as actions.

use std::path::{Path, PathBuf};

use eframe::egui::{self, Key, PointerButton, Response};
use raydsl::prelude::*;
use raydsl_viewer::{Action, CutObject, Kind, Mode, Session, Show};

use super::picture::Place;

/// Degrees of a drag over the whole height.
const DEGREES: f32 = 180.0;
/// Share of the distance that a key moves in a second.
const SPEED: f32 = 0.7;

/// The keys, and what they do.
pub(crate) const KEYS: [(&str, &str); 18] = [
    ("drag", "turn around the middle"),
    ("right drag", "move sideways"),
    ("middle drag", "look around"),
    ("wheel", "nearer and farther"),
    ("click", "pick: what is there?"),
    ("B", "cut a ball out of a volume or cells"),
    ("drag a ring", "move a cut object"),
    ("O", "choose files"),
    ("V", "menu; the mouse points, a click chooses"),
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

/// The ball that is cut out at first, from the near side.
pub(crate) const BALL: CutObject = CutObject::Ball { center: vec3(0.65, 0.75, 0.7), radius: 0.3 };

/// Returns what a file is opened by: data, light for the surface that is open, or the transfer function
/// of what is open.
pub(crate) fn opened(session: &Session, path: PathBuf) -> Action {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let kind = session.info().map(|info| info.kind);
    match extension.as_str() {
        "json" => Action::Transfer(path),
        "exr" | "hdr" if kind == Some(Kind::Surface) => Action::Environment(Some(path)),
        _ => Action::Open(path),
    }
}

/// Returns what several files are opened by: the first is opened, and other data are time steps.
pub(crate) fn opened_all(
    session: &Session,
    paths: impl IntoIterator<Item = PathBuf>,
) -> Vec<Action> {
    let mut has_opened = false;
    let action = |path: PathBuf| match opened(session, path) {
        Action::Open(path) if has_opened => Action::Add(path),
        action => {
            has_opened |= matches!(action, Action::Open(_));
            action
        }
    };
    paths.into_iter().map(action).collect()
}

/// Files that were dropped on the window.
pub(crate) fn dropped(ctx: &egui::Context, session: &Session, actions: &mut Vec<Action>) {
    let paths: Vec<PathBuf> = ctx.input(|input| {
        input.raw.dropped_files.iter().map(|file| file.path().to_path_buf()).collect()
    });
    actions.extend(opened_all(session, paths));
}

/// What the mouse does over the picture.
pub(crate) fn mouse(ui: &egui::Ui, response: &Response, place: &Place, actions: &mut Vec<Action>) {
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
        && let Some((x, y)) = response.interact_pointer_pos().and_then(|at| place.whole_pixel(at))
    {
        actions.push(Action::Pick(x, y));
    }
}

/// Whether the key is pressed that opens the dialog of files.
pub(crate) fn is_choosing_files(ui: &egui::Ui) -> bool {
    !ui.ctx().egui_wants_keyboard_input()
        && ui.input(|input| !input.modifiers.command && input.key_pressed(Key::O))
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
    for key in ACTING {
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

/// The keys of [`of_key`].
const ACTING: [Key; 9] =
    [Key::H, Key::M, Key::C, Key::B, Key::V, Key::OpenBracket, Key::CloseBracket, Key::P, Key::F12];

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
        Key::C if session.info()?.kind.is_field() => return None,
        Key::C => Action::Show(Show::Cost),
        Key::B if session.info()?.kind.is_field() => Action::AddCut(BALL),
        Key::B => return None,
        Key::V => Action::Menu(session.menu().is_none()),
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
