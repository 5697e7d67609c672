//! Numbers as colours, with a legend.

use std::path::Path;

use font8x8::UnicodeFonts;
use image::{ImageError, Rgb, RgbImage};

const BAR_WIDTH: u32 = 24;
const MARGIN: u32 = 16;
/// Room for the labels beside the bar.
const LABELS: u32 = 88;
/// Room for a title above a map.
const TITLE: u32 = 32;

/// A grid of numbers, shown with the colour map "turbo"; row 0 is the bottom one.
#[derive(Clone, Debug)]
pub struct HeatMap {
    /// What the numbers count, for the legend.
    pub title: String,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// One number for each pixel, row by row from the bottom.
    pub values: Vec<f32>,
}

impl HeatMap {
    /// The number that is shown at the top of the scale: 99.5 % of the pixels lie below it, so
    /// that a few extreme ones do not hide the rest.
    pub fn top(&self) -> f32 {
        let mut sorted = self.values.clone();
        sorted.sort_by(f32::total_cmp);
        let at = (sorted.len() as f64 * 0.995) as usize;
        sorted.get(at.min(sorted.len().saturating_sub(1))).copied().unwrap_or(1.0).max(1.0)
    }

    /// The mean number.
    pub fn mean(&self) -> f64 {
        let sum: f64 = self.values.iter().map(|v| f64::from(*v)).sum();
        sum / self.values.len().max(1) as f64
    }

    /// The picture, the legend at its right.
    pub fn to_image(&self) -> RgbImage {
        let top = self.top();
        let mut image = canvas(self.width + MARGIN + BAR_WIDTH + LABELS, self.height.max(64));
        self.paint(&mut image, (0, 0), top);
        legend(&mut image, self.width + MARGIN, top);
        write(&mut image, self.width + MARGIN, MARGIN / 2, &self.title);
        image
    }

    /// Several maps under their titles, on one scale; the legend is at the right.
    pub fn side_by_side(maps: &[Self]) -> RgbImage {
        let top = maps.iter().map(Self::top).fold(1.0, f32::max);
        let height = maps.iter().map(|map| map.height).max().unwrap_or(0).max(64);
        let width: u32 = maps.iter().map(|map| map.width + MARGIN).sum();
        let mut image = canvas(width + BAR_WIDTH + LABELS, height + TITLE);
        let mut left = 0;
        for map in maps {
            map.paint(&mut image, (left, TITLE), top);
            write(&mut image, left + 8, TITLE / 2 - 4, &map.title);
            left += map.width + MARGIN;
        }
        legend(&mut image, left, top);
        image
    }

    /// Writes the picture.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub fn write_png(&self, path: &Path) -> Result<(), ImageError> {
        self.to_image().save(path)
    }

    /// The map alone, its upper left corner at (`x`, `y`).
    fn paint(&self, image: &mut RgbImage, (x, y): (u32, u32), top: f32) {
        for (i, v) in self.values.iter().enumerate() {
            let (column, row) = (i as u32 % self.width, i as u32 / self.width);
            image.put_pixel(x + column, y + self.height - 1 - row, color(*v / top));
        }
    }
}

fn canvas(width: u32, height: u32) -> RgbImage {
    RgbImage::from_pixel(width, height, Rgb([18, 18, 22]))
}

/// The scale at `left`, over the whole height.
fn legend(image: &mut RgbImage, left: u32, top: f32) {
    let height = image.height();
    let (first, last) = (2 * MARGIN, height - MARGIN);
    for y in first..last {
        let v = (last - 1 - y) as f32 / (last - first).max(2) as f32;
        for x in left..left + BAR_WIDTH {
            image.put_pixel(x, y, color(v));
        }
    }
    for i in 0..=4u32 {
        let y = first + (last - first - 1) * (4 - i) / 4;
        let label = format!("{:.0}", top * i as f32 / 4.0);
        let label = if i == 4 { format!("{label}+") } else { label };
        write(image, left + BAR_WIDTH + 6, y.saturating_sub(4).min(height - 9), &label);
    }
}

fn color(v: f32) -> Rgb<u8> {
    let c = colorous::TURBO.eval_continuous(f64::from(v.clamp(0.0, 1.0)));
    Rgb([c.r, c.g, c.b])
}

/// Writes `text` with its upper left corner at (`x`, `y`); what does not fit is left out.
pub fn write(image: &mut RgbImage, x: u32, y: u32, text: &str) {
    for (i, c) in text.chars().enumerate() {
        let Some(glyph) = font8x8::BASIC_FONTS.get(c) else { continue };
        for (row, bits) in glyph.iter().enumerate() {
            for column in (0..8).filter(|b| bits >> b & 1 != 0) {
                let (px, py) = (x + 8 * i as u32 + column, y + row as u32);
                if px < image.width() && py < image.height() {
                    image.put_pixel(px, py, Rgb([235, 235, 235]));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maps_beside_each_other_have_one_scale() {
        let map = |v: f32, width| HeatMap {
            title: "a".to_owned(),
            width,
            height: 70,
            values: vec![v; 70 * width as usize],
        };
        let image = HeatMap::side_by_side(&[map(5.0, 30), map(10.0, 40)]);
        assert_eq!(image.height(), 70 + TITLE);
        assert_eq!(*image.get_pixel(0, TITLE), color(0.5));
        assert_eq!(*image.get_pixel(30 + MARGIN, TITLE), color(1.0));
        assert!(HeatMap::side_by_side(&[]).height() > 64);
    }

    #[test]
    fn extremes_saturate_and_the_legend_stands_beside_the_picture() {
        let mut values = vec![10.0; 64 * 64];
        values[0] = 1e6;
        let map = HeatMap { title: "nodes".to_owned(), width: 64, height: 64, values };
        assert_eq!(map.top(), 10.0);
        let image = map.to_image();
        assert_eq!(image.height(), 64);
        assert_eq!(*image.get_pixel(0, 63), color(1.0));
        assert!(image.width() > 64 + BAR_WIDTH);
    }
}
