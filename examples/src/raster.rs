//! Drawings as pictures of pixels.

use font8x8::UnicodeFonts;
use image::{Rgb, RgbImage};
use raydsl_report::work_precision::{Anchor, Color, Drawing, Mark};

/// The pixels of a drawing, `scale` for each of its units; letters are 8 units wide.
pub fn raster(drawing: &Drawing, scale: u32) -> RgbImage {
    let white = Rgb([255, 255, 255]);
    let size = (drawing.width * scale, drawing.height * scale);
    let mut canvas = Canvas { image: RgbImage::from_pixel(size.0, size.1, white), scale };
    drawing.marks.iter().for_each(|mark| canvas.draw(mark));
    canvas.image
}

struct Canvas {
    image: RgbImage,
    scale: u32,
}

type Point = (f64, f64);

impl Canvas {
    fn draw(&mut self, mark: &Mark) {
        match mark {
            Mark::Line { points, color, width, dash } => {
                let mut gone = 0.0;
                for ends in points.windows(2) {
                    gone = self.dashes((ends[0], ends[1]), gone, *color, *width, *dash);
                }
            }
            Mark::Symbol { at, symbol, color, radius } => {
                let corners = symbol.corners().into_iter();
                let ring = |r: f64| move |(x, y): Point| (at.0 + r * x, at.1 - r * y);
                let outer: Vec<Point> = corners.clone().map(ring(radius + 0.75)).collect();
                let inner: Vec<Point> = corners.map(ring(*radius)).collect();
                self.polygon(&outer, [255, 255, 255]);
                self.polygon(&inner, *color);
            }
            Mark::Text { at, text, color, anchor, is_turned } => {
                self.text(*at, text, *color, *anchor, *is_turned);
            }
        }
    }

    /// A line, of which `gone` units were drawn before; gives how many are now.
    fn dashes(
        &mut self,
        (a, b): (Point, Point),
        gone: f64,
        color: Color,
        width: f64,
        dash: Option<f64>,
    ) -> f64 {
        let length = (b.0 - a.0).hypot(b.1 - a.1);
        let Some(dash) = dash.filter(|d| *d > 0.0) else {
            self.segment(a, b, color, width);
            return gone + length;
        };
        let at = |t: f64| {
            let share = if length > 0.0 { t / length } else { 0.0 };
            (a.0 + share * (b.0 - a.0), a.1 + share * (b.1 - a.1))
        };
        // Every second dash is a gap.
        let mut t = -(gone % (2.0 * dash));
        while t < length {
            if t + dash > 0.0 {
                self.segment(at(t.max(0.0)), at((t + dash).min(length)), color, width);
            }
            t += 2.0 * dash;
        }
        gone + length
    }

    fn segment(&mut self, a: Point, b: Point, color: Color, width: f64) {
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        let square = dx * dx + dy * dy;
        self.fill(&[a, b], 0.5 * width + 1.0, color, |p| {
            let along = (p.0 - a.0) * dx + (p.1 - a.1) * dy;
            let share = if square > 0.0 { (along / square).clamp(0.0, 1.0) } else { 0.0 };
            (p.0 - a.0 - share * dx).hypot(p.1 - a.1 - share * dy) - 0.5 * width
        });
    }

    /// A convex polygon, its corners anticlockwise with y upwards.
    fn polygon(&mut self, corners: &[Point], color: Color) {
        self.fill(corners, 1.0, color, |p| {
            let outside = |i: usize| {
                let (a, b) = (corners[i], corners[(i + 1) % corners.len()]);
                let (dx, dy) = (b.0 - a.0, b.1 - a.1);
                ((p.1 - a.1) * dx - (p.0 - a.0) * dy) / dx.hypot(dy)
            };
            (0..corners.len()).map(outside).fold(f64::NEG_INFINITY, f64::max)
        });
    }

    /// Covers the pixels near the box of `points`, as far as they are inside: `distance`
    /// is negative there.
    fn fill(
        &mut self,
        points: &[Point],
        margin: f64,
        color: Color,
        distance: impl Fn(Point) -> f64,
    ) {
        let scale = f64::from(self.scale);
        let bound = |of: fn(&Point) -> f64, size: u32| {
            let low = points.iter().map(of).fold(f64::INFINITY, f64::min) - margin;
            let high = points.iter().map(of).fold(f64::NEG_INFINITY, f64::max) + margin;
            let pixel = |v: f64| (v * scale).clamp(0.0, f64::from(size)) as u32;
            pixel(low)..pixel(high.max(low) + 1.0)
        };
        let (columns, rows) =
            (bound(|p| p.0, self.image.width()), bound(|p| p.1, self.image.height()));
        for y in rows {
            for x in columns.clone() {
                let middle = |c: u32| (f64::from(c) + 0.5) / scale;
                let cover = (0.5 - scale * distance((middle(x), middle(y)))).clamp(0.0, 1.0);
                self.blend(x, y, color, cover);
            }
        }
    }

    fn blend(&mut self, x: u32, y: u32, color: Color, cover: f64) {
        if x >= self.image.width() || y >= self.image.height() || cover <= 0.0 {
            return;
        }
        let pixel = self.image.get_pixel_mut(x, y);
        for (old, new) in pixel.0.iter_mut().zip(color) {
            *old = (f64::from(*old) + cover * (f64::from(new) - f64::from(*old))).round() as u8;
        }
    }

    fn text(&mut self, at: Point, text: &str, color: Color, anchor: Anchor, is_turned: bool) {
        let length = 8.0 * text.chars().count() as f64;
        let first = match anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => -0.5 * length,
            Anchor::End => -length,
        };
        let scale = self.scale;
        let pixels = |v: f64| (v * f64::from(scale)).round() as i64;
        for (i, c) in text.chars().enumerate() {
            let Some(glyph) = font8x8::BASIC_FONTS.get(c) else { continue };
            let left = first + 8.0 * i as f64;
            for (row, bits) in glyph.iter().enumerate() {
                for column in (0..8).filter(|b| bits >> b & 1 != 0) {
                    let (right, down) = (left + f64::from(column), row as f64 - 4.0);
                    // Turned, the text's right is up and its down is right.
                    let (x, y) = if is_turned {
                        (at.0 + down, at.1 - right - 1.0)
                    } else {
                        (at.0 + right, at.1 + down)
                    };
                    self.block((pixels(x), pixels(y)), color);
                }
            }
        }
    }

    /// A dot of a letter.
    fn block(&mut self, (x, y): (i64, i64), color: Color) {
        for j in 0..i64::from(self.scale) {
            for i in 0..i64::from(self.scale) {
                if let (Ok(x), Ok(y)) = (u32::try_from(x + i), u32::try_from(y + j)) {
                    self.blend(x, y, color, 1.0);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use raydsl_report::work_precision::Symbol;

    fn drawn(mark: Mark) -> RgbImage {
        raster(&Drawing { width: 40, height: 20, marks: vec![mark] }, 2)
    }

    fn dark(image: &RgbImage) -> usize {
        image.pixels().filter(|p| p.0[0] < 128).count()
    }

    #[test]
    fn marks_cover_what_they_should() {
        let black = [0, 0, 0];
        let line = |dash| Mark::Line {
            points: vec![(0.0, 10.0), (40.0, 10.0)],
            color: black,
            width: 2.0,
            dash,
        };
        assert_eq!(dark(&drawn(line(None))), 80 * 4);
        let dashed = dark(&drawn(line(Some(5.0))));
        assert!((130..230).contains(&dashed), "{dashed}");
        let square = Mark::Symbol {
            at: (20.0, 10.0),
            symbol: Symbol::Square,
            color: black,
            radius: 2f64.sqrt() * 4.0,
        };
        assert_eq!(dark(&drawn(square)), 16 * 16);
        let text = |is_turned| Mark::Text {
            at: (20.0, 10.0),
            text: "I".to_owned(),
            color: black,
            anchor: Anchor::Middle,
            is_turned,
        };
        let upright = dark(&drawn(text(false)));
        assert!(upright > 40 && upright == dark(&drawn(text(true))), "{upright}");
        // What lies outside is left out.
        let far = [(-1e9, -1e9), (1e9, 1e9)];
        let beyond = Mark::Line { points: far.to_vec(), color: black, width: 1.0, dash: None };
        assert!(dark(&drawn(beyond)) > 0);
    }
}
