//! Curves in panels beside each other.

use raydsl_report::work_precision::{Anchor, Color, Drawing, Mark, Symbol};

pub(crate) const INK: Color = [40, 40, 44];
pub(crate) const ORANGE: Color = [230, 130, 20];
pub(crate) const BLUE: Color = [0, 114, 178];
pub(crate) const GREEN: Color = [0, 158, 115];
const GRID: Color = [226, 226, 230];

/// Width and height of a panel's plot, and the room beside and above it.
const PLOT: (f64, f64) = (330.0, 250.0);
const LEFT: f64 = 62.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 46.0;
const LINE: f64 = 19.0;

/// A curve, with its name in the legend.
pub(crate) struct Curve {
    pub(crate) name: String,
    pub(crate) points: Vec<(f64, f64)>,
    pub(crate) color: Color,
    pub(crate) width: f64,
    pub(crate) dash: Option<f64>,
    /// Whether points have symbols.
    pub(crate) is_marked: bool,
}

/// Curves over one pair of axes.
pub(crate) struct Panel {
    pub(crate) title: String,
    pub(crate) x_name: String,
    /// Ticks with their texts; the first and the last are the ends of the axis.
    pub(crate) xs: Vec<(f64, String)>,
    pub(crate) ys: Vec<(f64, String)>,
    pub(crate) curves: Vec<Curve>,
}

/// The drawing of panels from left to right.
pub(crate) fn drawing(panels: &[Panel]) -> Drawing {
    let wide = LEFT + PLOT.0 + 12.0;
    let mut marks = Vec::new();
    for (i, panel) in panels.iter().enumerate() {
        panel.draw(i as f64 * wide + LEFT, &mut marks);
    }
    let width = (panels.len() as f64 * wide) as u32;
    Drawing { width, height: (TOP + PLOT.1 + BOTTOM) as u32, marks }
}

impl Panel {
    fn draw(&self, left: f64, marks: &mut Vec<Mark>) {
        let (x_ends, y_ends) = (ends(&self.xs), ends(&self.ys));
        let share = |v: f64, (low, high): (f64, f64)| ((v - low) / (high - low)).clamp(0.0, 1.0);
        let place = |(x, y): (f64, f64)| {
            (left + PLOT.0 * share(x, x_ends), TOP + PLOT.1 * (1.0 - share(y, y_ends)))
        };
        for (x, name) in &self.xs {
            let ends = [(*x, y_ends.0), (*x, y_ends.1)].map(place);
            marks.push(text((ends[0].0, ends[0].1 + 12.0), name, Anchor::Middle, INK));
            marks.push(line(ends.to_vec(), GRID, 1.0, None));
        }
        for (y, name) in &self.ys {
            let ends = [(x_ends.0, *y), (x_ends.1, *y)].map(place);
            marks.push(text((left - 6.0, ends[0].1), name, Anchor::End, INK));
            marks.push(line(ends.to_vec(), GRID, 1.0, None));
        }
        let middle = left + 0.5 * PLOT.0;
        marks.push(text((middle, TOP + PLOT.1 + 32.0), &self.x_name, Anchor::Middle, INK));
        marks.push(text((left, TOP - 16.0), &self.title, Anchor::Start, INK));
        for (i, curve) in self.curves.iter().enumerate() {
            // What is outside of the axes would be a line along them.
            let is_shown = |p: &&(f64, f64)| p.1.is_finite() && p.1 >= y_ends.0 && p.0 <= x_ends.1;
            let points: Vec<_> = curve.points.iter().filter(is_shown).map(|p| place(*p)).collect();
            if curve.is_marked {
                let symbol = |at: &(f64, f64)| Mark::Symbol {
                    at: *at,
                    symbol: Symbol::Circle,
                    color: curve.color,
                    radius: 4.0,
                };
                marks.extend(points.iter().map(symbol));
            }
            marks.push(line(points, curve.color, curve.width, curve.dash));
            let right = (left + PLOT.0 - 4.0, TOP + 10.0 + LINE * i as f64);
            marks.push(text(right, &curve.name, Anchor::End, curve.color));
        }
    }
}

fn ends(ticks: &[(f64, String)]) -> (f64, f64) {
    let values = ticks.iter().map(|t| t.0);
    (values.clone().fold(f64::INFINITY, f64::min), values.fold(f64::NEG_INFINITY, f64::max))
}

fn line(points: Vec<(f64, f64)>, color: Color, width: f64, dash: Option<f64>) -> Mark {
    Mark::Line { points, color, width, dash }
}

fn text(at: (f64, f64), text: &str, anchor: Anchor, color: Color) -> Mark {
    Mark::Text { at, text: text.to_owned(), color, anchor, is_turned: false }
}
