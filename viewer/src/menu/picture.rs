//! What is seen of a menu: buttons with letters, and the beam.

use raydsl::kernel;
use raydsl::prelude::*;

use font8x8::{BASIC_FONTS, UnicodeFonts};

use super::Menu;

/// The beam of a wand.
#[primitive(cylinder(p0, p1, radius))]
struct Beam {
    p0: Vec3,
    p1: Vec3,
    radius: f32,
}

/// What is written on a button, and how it is marked.
#[derive(Clone, Copy, Type)]
struct Label {
    /// The number of the first letter.
    first: u32,
    letters: u32,
    /// Width of a letter, as a share of the button's.
    wide: f32,
    color: Vec3,
}

/// Radius of the beam, and its length where it meets nothing, by the height that is seen.
const RADIUS: f32 = 0.006;
const LENGTH: f32 = 2.0;
/// Samples of a pixel.
const SAMPLES: u32 = 4;

/// The rows of letters, four of them in a word, from the top; the lowest bit is at the left.
fn glyph(letter: char) -> [u32; 2] {
    let rows = BASIC_FONTS.get(letter).unwrap_or_default();
    let word = |i: usize| u32::from_le_bytes([rows[i], rows[i + 1], rows[i + 2], rows[i + 3]]);
    [word(0), word(4)]
}

fn labels(menu: &Menu) -> (Vec<Label>, Vec<u32>) {
    let (mut labels, mut glyphs) = (Vec::new(), Vec::new());
    let pointed = menu.pointed();
    for (i, item) in menu.items.iter().enumerate() {
        let (first, letters) = (glyphs.len() as u32 / 2, item.label.chars().count() as u32);
        glyphs.extend(item.label.chars().flat_map(glyph));
        let wide = (0.92 / letters.max(1) as f32).min(0.075);
        let color = match (pointed == Some(i), item.is_chosen) {
            (true, _) => vec3(0.75, 0.3, 0.03),
            (false, true) => vec3(0.03, 0.2, 0.35),
            (false, false) => Vec3::splat(0.03),
        };
        labels.push(Label { first, letters, wide, color });
    }
    (labels, glyphs)
}

/// Whether there is a letter at `u` and `v` of a button, from its lower left corner.
#[kernel]
fn is_written(glyphs: &[u32], label: Label, u: f32, v: f32) -> bool {
    // Letters fill half of the height.
    let across = (u - 0.5) / label.wide + 0.5 * (label.letters as f32);
    let down = (0.75 - v) * 2.0;
    let is_outside = |at: f32, end: f32| at < 0.0 || at >= end;
    if is_outside(down, 1.0) || is_outside(across, label.letters as f32) {
        return false;
    }
    let letter = across.floor();
    let column = min(((across - letter) * 8.0) as u32, 7u32);
    let row = min((down * 8.0) as u32, 7u32);
    let word = glyphs[(2 * (label.first + (letter as u32)) + (row >> 2)) as usize];
    (word >> ((row & 3) * 8 + column)) & 1 == 1
}

fn beam(menu: &Menu) -> Vec<Beam> {
    let Some(ray) = menu.wand else { return Vec::new() };
    let hit = menu.buttons[..].closest_hit(ray);
    let length = if hit.is_hit { hit.t } else { menu.frame.length(LENGTH) };
    vec![Beam { p0: ray.origin, p1: ray.at(length), radius: menu.frame.length(RADIUS) }]
}

pub(super) fn of(menu: &Menu, camera: &Pinhole, (width, height): (u32, u32)) -> Image<Vec4> {
    let (labels, glyphs) = labels(menu);
    let beam = beam(menu);
    let (buttons, labels, glyphs, beam) = (&menu.buttons[..], &labels[..], &glyphs[..], &beam[..]);
    let kernel = kernel!(|ray: Ray| {
        let hit = buttons.closest_hit(ray);
        let mut color = vec4(0.0, 0.0, 0.0, 0.0);
        if hit.is_hit {
            let label = labels[hit.prim_id as usize];
            let plain = label.color * 0.85;
            color = vec4(plain.x, plain.y, plain.z, 0.85);
            if is_written(glyphs, label, hit.u, hit.v) {
                color = vec4(0.9, 0.9, 0.9, 1.0);
            }
        }
        let lit = beam.closest_hit(ray);
        if lit.is_hit && !(hit.is_hit && hit.t < lit.t) {
            color = vec4(1.0, 0.25, 0.05, 1.0);
        }
        color
    });
    let mut film = Film::new(width, height);
    let sampling = Sampling::new(SAMPLES);
    TiledScheduler::new().accumulate(camera, &kernel, &sampling, &mut film, SAMPLES);
    film.image()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_are_upright_and_not_mirrored() {
        let glyphs = glyph('L');
        let label = Label { first: 0, letters: 1, wide: 0.5, color: Vec3::ZERO };
        // An L fills its left and its bottom: the upper right is empty.
        let share = |range: [std::ops::Range<u32>; 2]| {
            let [columns, rows] = range;
            let mut found = 0;
            for (x, y) in rows.flat_map(|y| columns.clone().map(move |x| (x, y))) {
                let (u, v) =
                    (0.25 + 0.5 * (x as f32 + 0.5) / 8.0, 0.25 + 0.5 * (y as f32 + 0.5) / 8.0);
                found += u32::from(is_written(&glyphs, label, u, v));
            }
            found
        };
        assert_eq!(share([4..8, 4..8]), 0);
        assert!(share([0..4, 0..8]) > 10);
        assert!(share([4..8, 0..4]) > 3);
        assert!(!is_written(&glyphs, label, 0.1, 0.5));
    }
}
