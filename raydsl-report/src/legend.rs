//! Legends: which colours stand for which values.

use font8x8::{BASIC_FONTS, LATIN_FONTS, UnicodeFonts};
use glam::Vec3;
use raydsl::prelude::{Image, Shaded};

use crate::ticks::Ticks;

/// Dots of a letter along each axis.
const LETTER: u32 = 8;
/// Dots between parts of a legend.
const GAP: u32 = 4;
/// Width of the bar, in dots.
const BAR: u32 = 10;
/// Length of a tick, in dots.
const TICK: u32 = 3;
/// What is left of the picture behind a legend.
const DIMMED: f32 = 0.35;

/// Says at which side of a picture a legend stands; it fills most of the height.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Side {
    /// At the left.
    Left,
    /// At the right.
    #[default]
    Right,
}

/// A bar of colours with a title and the values at round places, drawn into a picture.
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl_report::Legend;
///
/// let mut image = Image::new(320, 200);
/// let grey = |value: f32| Vec3::splat(value / 3.0);
/// Legend::new("speed, m/s", 0.0, 3.0).draw(&mut image, grey);
/// assert!(image.pixels().iter().any(|p| p.color == Vec3::ONE));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Legend {
    title: String,
    low: f32,
    high: f32,
    side: Side,
    scale: Option<u32>,
}

impl Legend {
    /// Creates the legend of values from `low`, at the bottom, to `high`.
    pub fn new(title: impl Into<String>, low: f32, high: f32) -> Self {
        Self { title: title.into(), low, high, side: Side::default(), scale: None }
    }

    /// Sets the side of the picture; the right one unless set.
    #[must_use]
    pub fn side(self, side: Side) -> Self {
        Self { side, ..self }
    }

    /// Sets the number of pixels of each dot of a letter; one for each 400 rows of the picture
    /// unless set.
    #[must_use]
    pub fn scale(self, scale: u32) -> Self {
        Self { scale: Some(scale.max(1)), ..self }
    }

    /// Draws it; `color` returns the colour of a value. What does not fit is left out, as are
    /// letters without a glyph, and values that are not finite have no tick. Depths and ids stay.
    pub fn draw(&self, image: &mut Image<Shaded>, color: impl Fn(f32) -> Vec3) {
        let scale = self.scale.unwrap_or(image.height() / 400).clamp(1, image.height().max(1));
        let mut canvas = Canvas { image, scale };
        let (columns, rows) = canvas.dots();
        let ticks = Ticks::new(self.low.into(), self.high.into(), rows as usize / 50);
        let labels: Vec<(f32, String)> = ticks.iter().map(|v| (v as f32, ticks.label(v))).collect();
        let widest = labels.iter().map(|(_, text)| width_of(text)).max().unwrap_or(0);
        let body = BAR + TICK + GAP / 2 + widest;
        let width = body.max(width_of(&self.title)) + 2 * GAP;
        let height = (rows * 7 / 10).max((LETTER + GAP) * 4).min(rows);
        let left = match self.side {
            Side::Left => GAP,
            Side::Right => columns.saturating_sub(width + GAP),
        };
        let top = (rows - height) / 2;
        canvas.dim(left, top, width, height);
        canvas.text(left + GAP, top + GAP, &self.title);

        // Half a letter is left above and below the bar, for the labels at its ends.
        let first = top + 2 * GAP + LETTER + LETTER / 2;
        let last = (top + height).saturating_sub(GAP + LETTER / 2);
        let bar = last.saturating_sub(first).max(1);
        let value_at = |share: f32| self.low + (self.high - self.low) * share;
        for row in 0..bar * scale {
            let share = 1.0 - (row as f32 + 0.5) / (bar * scale) as f32;
            let color = color(value_at(share));
            for x in 0..BAR * scale {
                canvas.pixel((left + GAP) * scale + x, first * scale + row, color);
            }
        }
        for (value, label) in &labels {
            let share = (value - self.low) / (self.high - self.low);
            let row = first + ((1.0 - share.clamp(0.0, 1.0)) * (bar - 1) as f32).round() as u32;
            let right = left + GAP + BAR;
            (right..right + TICK).for_each(|x| canvas.dot(x, row, Vec3::ONE));
            canvas.text(right + TICK + GAP / 2, row.saturating_sub(LETTER / 2 - 1), label);
        }
    }
}

fn width_of(text: &str) -> u32 {
    text.chars().count() as u32 * LETTER
}

/// A picture in dots of `scale` pixels, from its upper left corner.
struct Canvas<'a> {
    image: &'a mut Image<Shaded>,
    scale: u32,
}

impl Canvas<'_> {
    fn dots(&self) -> (u32, u32) {
        (self.image.width() / self.scale, self.image.height() / self.scale)
    }

    /// The pixel in a column, and a row from the top.
    fn at(&mut self, x: u32, y: u32) -> Option<&mut Vec3> {
        let (width, height) = (self.image.width(), self.image.height());
        let row = height.checked_sub(y + 1).filter(|_| x < width)?;
        let index = row as usize * width as usize + x as usize;
        self.image.pixels_mut().get_mut(index).map(|p| &mut p.color)
    }

    fn pixel(&mut self, x: u32, y: u32, color: Vec3) {
        if let Some(pixel) = self.at(x, y) {
            *pixel = color;
        }
    }

    fn dot(&mut self, x: u32, y: u32, color: Vec3) {
        let scale = self.scale;
        for (i, j) in (0..scale * scale).map(|k| (k % scale, k / scale)) {
            self.pixel(x * scale + i, y * scale + j, color);
        }
    }

    /// Darkens a rectangle.
    fn dim(&mut self, left: u32, top: u32, width: u32, height: u32) {
        let scale = self.scale;
        for y in top * scale..(top + height) * scale {
            for x in left * scale..(left + width) * scale {
                if let Some(pixel) = self.at(x, y) {
                    *pixel = pixel.clamp(Vec3::ZERO, Vec3::ONE) * DIMMED;
                }
            }
        }
    }

    /// Writes a text in white, its upper left corner at a dot.
    fn text(&mut self, left: u32, top: u32, text: &str) {
        for (i, letter) in text.chars().enumerate() {
            let glyph = BASIC_FONTS.get(letter).or_else(|| LATIN_FONTS.get(letter));
            let Some(glyph) = glyph else { continue };
            for (row, bits) in (0..LETTER).zip(glyph) {
                for column in (0..LETTER).filter(|b| bits >> b & 1 != 0) {
                    self.dot(left + i as u32 * LETTER + column, top + row, Vec3::ONE);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RED: fn(f32) -> Vec3 = |_| Vec3::X;

    fn drawn(legend: &Legend, width: u32, height: u32) -> Image {
        let gray = Shaded { color: Vec3::splat(0.5), depth: 3.0, id: 7 };
        let mut image = Image::filled(width, height, gray);
        legend.draw(&mut image, RED);
        assert!(image.pixels().iter().all(|p| p.depth == 3.0 && p.id == 7));
        image
    }

    /// The columns and rows of a colour.
    fn places(image: &Image, color: Vec3) -> Vec<(u32, u32)> {
        let all =
            (0..image.width() * image.height()).map(|i| (i % image.width(), i / image.width()));
        all.filter(|(x, y)| image.get(*x, *y).is_some_and(|p| p.color == color)).collect()
    }

    #[test]
    fn a_bar_stands_on_its_side() {
        let legend = Legend::new("t", -1.0, 1.0);
        for side in [Side::Left, Side::Right] {
            let image = drawn(&legend.clone().side(side), 400, 300);
            let bar = places(&image, Vec3::X);
            assert_eq!(bar.iter().map(|p| p.0).max(), bar.iter().map(|p| p.0).min().map(|x| x + 9));
            assert!(bar.iter().all(|(x, _)| (*x < 200) == (side == Side::Left)));
            assert!(bar.len() > 10 * 150 && places(&image, Vec3::ONE).len() > 100);
        }
        // Twice as large.
        let large = drawn(&legend.scale(2), 400, 300);
        assert_eq!(places(&large, Vec3::X).len() % 20, 0);
    }

    /// The colour of a value is where its tick is: between the green half and the blue one is that of 0.
    #[test]
    fn values_are_where_their_ticks_are() {
        let mut image = Image::new(300, 400);
        let step = |v: f32| if v > 0.0 { Vec3::Y } else { Vec3::Z };
        Legend::new("", -4.0, 4.0).scale(1).draw(&mut image, step);
        let (upper, lower) = (places(&image, Vec3::Y), places(&image, Vec3::Z));
        let edge = upper.iter().map(|p| p.1).min().expect("an upper half");
        assert_eq!(lower.iter().map(|p| p.1).max(), Some(edge - 1));
        let right = upper.iter().map(|p| p.0).max().expect("a bar") + 1;
        let tick = |y: u32| image.get(right, y).is_some_and(|p| p.color == Vec3::ONE);
        assert!((edge - 2..=edge + 1).any(tick), "there is a tick at 0");
        assert_eq!((0..400).filter(|y| tick(*y)).count(), 9);
    }

    #[test]
    fn small_pictures_and_odd_values_are_no_trouble() {
        for (width, height) in [(1, 1), (5, 80), (80, 5), (30, 30)] {
            let legend = Legend::new("a long title", 0.0, 1.0);
            drawn(&legend, width, height);
            drawn(&legend.scale(u32::MAX), width, height);
        }
        for (low, high) in [(f32::NAN, 1.0), (0.0, f32::INFINITY), (2.0, 2.0), (3.0, -3.0)] {
            drawn(&Legend::new("äöü 温度", low, high), 300, 200);
        }
    }
}
