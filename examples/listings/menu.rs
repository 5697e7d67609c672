//! A menu in space, picked with a wand: no tree, no picture, no triangle.

use raydsl::prelude::*;

// ANCHOR: button
/// A button: its corners, anticlockwise.
#[primitive(quad(v0, v1, v2, v3))]
#[derive(Debug)]
pub(crate) struct Button {
    v0: Vec3,
    v1: Vec3,
    v2: Vec3,
    v3: Vec3,
}
// ANCHOR_END: button

/// Buttons below each other, on a panel two units ahead.
pub(crate) fn menu(count: u32) -> Vec<Button> {
    let at = |x: f32, y: f32| vec3(x, y, 2.0);
    let button = |i: u32| {
        let top = 1.0 - 0.3 * i as f32;
        let (low, high) = (top - 0.2, top);
        Button { v0: at(-1.0, low), v1: at(1.0, low), v2: at(1.0, high), v3: at(-1.0, high) }
    };
    (0..count).map(button).collect()
}

// ANCHOR: pick
/// The button that the wand points at.
pub(crate) fn picked(menu: &[Button], wand: Ray) -> Option<u32> {
    let hit = menu.closest_hit(wand);
    hit.is_hit.then_some(hit.prim_id)
}
// ANCHOR_END: pick
