//! Drawings of lines, symbols and text, and their SVG and PNG.

use core::fmt::Write;

/// Height of text, in units of the drawing.
pub(super) const FONT_SIZE: f64 = 15.0;

/// The width for a letter that texts have room for, in units of the drawing: digits are a twentieth
/// narrower, and words on average.
pub(super) const LETTER: f64 = 0.6 * FONT_SIZE;

/// The font of [`Drawing::png`]: the Latin letters of Noto Sans, under the SIL Open Font License.
#[cfg(feature = "png")]
const FONT: &[u8] = include_bytes!("../../fonts/NotoSans-Regular.ttf");

/// The most pixels of a PNG.
#[cfg(feature = "png")]
const MOST_PIXELS: u64 = 1 << 26;

/// A colour: red, green and blue.
pub type Color = [u8; 3];

/// The part of a text at its position.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Anchor {
    /// Its left end.
    Start,
    /// Its middle.
    Middle,
    /// Its right end.
    End,
}

/// The shape of a symbol.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "shapes are named")]
pub enum Symbol {
    Circle,
    Square,
    Up,
    Down,
    Diamond,
    Hexagon,
}

impl Symbol {
    /// Returns its corners, anticlockwise with y upwards, within the circle of radius 1.
    pub fn corners(self) -> Vec<(f64, f64)> {
        let (count, first) = match self {
            Self::Circle => (24, 0.0),
            Self::Square => (4, 0.125),
            Self::Up => (3, 0.25),
            Self::Down => (3, 0.75),
            Self::Diamond => (4, 0.25),
            Self::Hexagon => (6, 0.25),
        };
        let corner = |i: u32| {
            let turn = first + f64::from(i) / f64::from(count);
            let (sin, cos) = (turn * core::f64::consts::TAU).sin_cos();
            (cos, sin)
        };
        (0..count).map(corner).collect()
    }
}

/// An element of a drawing. Positions have x to the right and y downwards; lengths are pixels of
/// the SVG.
#[derive(Clone, Debug, PartialEq)]
pub enum Mark {
    /// A polyline.
    Line {
        /// The points.
        points: Vec<(f64, f64)>,
        /// The colour.
        color: Color,
        /// The line width.
        width: f64,
        /// The length of dashes and of the gaps between, if it is dashed.
        dash: Option<f64>,
    },
    /// A filled symbol.
    Symbol {
        /// The centre.
        at: (f64, f64),
        /// Its shape.
        symbol: Symbol,
        /// The colour.
        color: Color,
        /// The radius of its circumcircle.
        radius: f64,
    },
    /// Text, 15 high, whose letters are 9 wide at most on average.
    Text {
        /// The position of its [`Anchor`], at the middle of its height.
        at: (f64, f64),
        /// The text.
        text: String,
        /// The colour.
        color: Color,
        /// The part of the text at `at`.
        anchor: Anchor,
        /// Whether it runs upwards.
        is_turned: bool,
    },
}

/// A drawing on white.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// Width.
    pub width: u32,
    /// Height.
    pub height: u32,
    /// Its elements, from back to front.
    pub marks: Vec<Mark>,
}

/// The reason why there is no PNG of a drawing.
#[cfg(feature = "png")]
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PngError {
    /// A side has no pixels, or there are more than 2^26.
    #[error(
        "a picture of {width} by {height} pixels, not of 1 to 2^26; change the drawing's size or \
         the scale"
    )]
    Size {
        /// Columns.
        width: u64,
        /// Rows.
        height: u64,
    },
    /// The drawing cannot be drawn or encoded.
    #[error("cannot draw: {why}")]
    Drawing {
        /// The cause, of resvg.
        why: String,
    },
}

impl Drawing {
    /// Returns a PNG file of [`Self::svg`], with `scale` pixels for a unit of the drawing, by resvg
    /// with a font of this crate: none of the system's is asked for.
    ///
    /// # Errors
    ///
    /// If the picture has no pixels, or too many.
    #[cfg(feature = "png")]
    pub fn png(&self, scale: f32) -> Result<Vec<u8>, PngError> {
        use resvg::{tiny_skia, usvg};

        let mut options = usvg::Options::default();
        options.fontdb_mut().load_font_data(FONT.to_vec());
        let drawing = |why: &dyn core::fmt::Display| PngError::Drawing { why: why.to_string() };
        let size = [self.width, self.height].map(|n| (n as f32 * scale).round() as u64);
        let is_good = (1..=MOST_PIXELS).contains(&size[0].saturating_mul(size[1]));
        let [width, height] = size.map(|n| if is_good { n as u32 } else { 0 });
        let pixels = tiny_skia::Pixmap::new(width, height);
        let mut pixels = pixels.ok_or(PngError::Size { width: size[0], height: size[1] })?;
        let tree = usvg::Tree::from_str(&self.svg(), &options).map_err(|e| drawing(&e))?;
        let scaled = tiny_skia::Transform::from_scale(scale, scale);
        resvg::render(&tree, scaled, &mut pixels.as_mut());
        pixels.encode_png().map_err(|e| drawing(&e))
    }

    /// Returns the text of an SVG file.
    pub fn svg(&self) -> String {
        let (w, h) = (self.width, self.height);
        let mut text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" \
             viewBox=\"0 0 {w} {h}\">\n<rect width=\"{w}\" height=\"{h}\" fill=\"#ffffff\"/>\n"
        );
        self.marks.iter().for_each(|mark| svg(&mut text, mark));
        text + "</svg>\n"
    }
}

fn svg(out: &mut String, mark: &Mark) {
    match mark {
        Mark::Line { points, color, width, dash } => {
            let dash = dash.map_or_else(String::new, |d| format!(" stroke-dasharray=\"{d} {d}\""));
            let _ = writeln!(
                out,
                "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" \
                 stroke-width=\"{width}\"{dash}/>",
                list(points.iter().copied()),
                hex(*color),
            );
        }
        Mark::Symbol { at, symbol, color, radius } => {
            let corners = symbol.corners().into_iter();
            let placed = corners.map(|(x, y)| (at.0 + radius * x, at.1 - radius * y));
            let _ = writeln!(
                out,
                "<polygon points=\"{}\" fill=\"{}\" stroke=\"#ffffff\" stroke-width=\"0.75\"/>",
                list(placed),
                hex(*color),
            );
        }
        Mark::Text { at: (x, y), text, color, anchor, is_turned } => {
            let anchor = match anchor {
                Anchor::Start => "start",
                Anchor::Middle => "middle",
                Anchor::End => "end",
            };
            let turn = if *is_turned {
                format!(" transform=\"rotate(-90 {x:.1} {y:.1})\"")
            } else {
                String::new()
            };
            let _ = writeln!(
                out,
                "<text x=\"{x:.1}\" y=\"{y:.1}\" font-family=\"Noto Sans, sans-serif\" font-size=\"{FONT_SIZE}\" \
                 dominant-baseline=\"central\" text-anchor=\"{anchor}\" \
                 fill=\"{}\"{turn}>{}</text>",
                hex(*color),
                escaped(text),
            );
        }
    }
}

fn list(points: impl Iterator<Item = (f64, f64)>) -> String {
    points.map(|(x, y)| format!("{x:.1},{y:.1}")).collect::<Vec<_>>().join(" ")
}

fn hex([r, g, b]: Color) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

fn escaped(text: &str) -> String {
    let one = |c: char| match c {
        '&' => "&amp;".to_owned(),
        '<' => "&lt;".to_owned(),
        '>' => "&gt;".to_owned(),
        '"' => "&quot;".to_owned(),
        // XML allows no other control characters.
        c if c.is_control() && !matches!(c, '\t' | '\n' | '\r') => "?".to_owned(),
        c => c.to_string(),
    };
    text.chars().map(one).collect()
}

#[cfg(all(test, feature = "png"))]
mod tests {
    use super::*;

    /// The share of pixels of a mark's picture that are dark.
    fn dark(mark: Mark) -> f64 {
        let drawing = Drawing { width: 40, height: 20, marks: vec![mark] };
        let file = drawing.png(2.0).expect("a small picture");
        let pixels = resvg::tiny_skia::Pixmap::decode_png(&file).expect("a picture");
        assert_eq!((pixels.width(), pixels.height()), (80, 40));
        let count = pixels.pixels().iter().filter(|p| p.red() < 128).count();
        count as f64 / 3200.0
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
        assert_eq!(dark(line(None)), 0.1);
        assert_eq!(dark(line(Some(5.0))), 0.05);
        let square = Mark::Symbol {
            at: (20.0, 10.0),
            symbol: Symbol::Square,
            color: black,
            radius: 2f64.sqrt() * 4.0,
        };
        let share = dark(square);
        assert!((0.06..=0.08).contains(&share), "{share}");
        let text = |text: &str, is_turned| Mark::Text {
            at: (20.0, 10.0),
            text: text.to_owned(),
            color: black,
            anchor: Anchor::Middle,
            is_turned,
        };
        let (upright, turned) = (dark(text("I", false)), dark(text("I", true)));
        assert!(upright > 0.005 && (upright - turned).abs() < 0.005, "{upright} {turned}");
        // The width of a letter is no less than that of digits.
        let digits = Mark::Text {
            at: (0.0, 10.0),
            text: "0000".to_owned(),
            color: black,
            anchor: Anchor::Start,
            is_turned: false,
        };
        let drawing = Drawing { width: 40, height: 20, marks: vec![digits] };
        let pixels = resvg::tiny_skia::Pixmap::decode_png(&drawing.png(2.0).expect("small"));
        let pixels = pixels.expect("a picture");
        let is_dark = |x: u32| (0..40).any(|y| pixels.pixel(x, y).is_some_and(|p| p.red() < 128));
        let last = (0..80).rev().find(|x| is_dark(*x)).expect("digits");
        assert!((60..(8.0 * LETTER) as u32).contains(&last), "{last}");
    }

    #[test]
    fn sizes_have_limits() {
        let drawing = |width, height| Drawing { width, height, marks: Vec::new() };
        for (width, height, scale) in [
            (0, 5, 1.0),
            (5, 5, 0.0),
            (5, 5, f32::NAN),
            (5, 5, -1.0),
            (9, 9, 1e9),
            (u32::MAX, 2, 1e3),
        ] {
            let found = drawing(width, height).png(scale);
            assert!(matches!(found, Err(PngError::Size { .. })), "{width} {height} {scale}");
        }
    }
}
