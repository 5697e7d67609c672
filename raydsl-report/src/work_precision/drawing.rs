//! Drawings of lines, symbols and text, and their SVG.

use core::fmt::Write;

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
    /// Text of a fixed pitch, each letter 8 wide.
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

impl Drawing {
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
                "<text x=\"{x:.1}\" y=\"{y:.1}\" font-family=\"monospace\" font-size=\"13\" \
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
