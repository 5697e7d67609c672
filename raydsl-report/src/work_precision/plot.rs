//! The work-precision diagram.

use super::Measured;
use super::case::{Backend, Order};
use super::curve::{Curve, Point, Status};
use super::drawing::{Anchor, Color, Drawing, FONT_SIZE, LETTER, Mark, Symbol};
use raydsl::kernel::Variant;

/// The colours of methods, chosen for colour-blind readers. (Okabe and Ito, "Color Universal
/// Design", 2008.)
const COLORS: [Color; 7] = [
    [213, 94, 0],
    [0, 114, 178],
    [0, 158, 115],
    [204, 121, 167],
    [230, 159, 0],
    [86, 180, 233],
    [0, 0, 0],
];
const INK: Color = [40, 40, 44];
const GRID: Color = [226, 226, 230];
const FLOOR: Color = [110, 110, 116];

const WIDTH: u32 = 1000;
const HEIGHT: u32 = 460;
/// Both panels: their left edges, width, top and bottom.
const LEFTS: [f64; 2] = [84.0, 456.0];
const PANEL: f64 = 310.0;
const TOP: f64 = 56.0;
const BOTTOM: f64 = 400.0;
const LEGEND: f64 = LEFTS[1] + PANEL + 22.0;
/// The height of a line of the legend.
const LINE: f64 = 20.0;
/// The most labels of an axis.
const LABELS: i32 = 7;
/// The most curves of a panel.
const CURVES: usize = 12;

/// The distance between a text and an axis.
const MARGIN: f64 = 3.0;
/// The radius of symbols.
const RADIUS: f64 = 4.5;
/// Half the length of the cap at the end of a bar.
const CAP: f64 = 3.0;
/// The quantiles of all runs at the ends of bars.
const BAR: [f64; 2] = [0.1, 0.9];

/// The distance in decades from the least error within which a floor is on the plot.
const REACH: f64 = 2.0;

fn symbol(backend: Backend) -> Symbol {
    match backend {
        Backend::Variant(Variant::Scalar) => Symbol::Circle,
        Backend::Variant(Variant::Packet4) => Symbol::Down,
        Backend::Variant(Variant::Packet8) => Symbol::Square,
        Backend::Variant(Variant::Packet16) => Symbol::Up,
        Backend::Variant(Variant::Wgsl) => Symbol::Diamond,
        Backend::F64 => Symbol::Hexagon,
    }
}

impl Measured {
    /// Returns the diagram, with logarithmic axes: at the left the root of the mean square error
    /// over the time of a run, for each method (a colour) and backend (a symbol). Symbols are at
    /// the medians of the repetitions; bars span the 10 % to 90 % quantiles. At the right the same
    /// over the work, independent of the machine, with triangles of the theoretical orders. Points
    /// at a floor are dotted. Of more than twelve curves it has those of the first backend and of the
    /// quickest, and the legend says so. A floor two decades or more below all errors is noted above the
    /// panels.
    ///
    /// The work is the first of these that was counted for every point: the kernels' own counts,
    /// texture fetches, tests of nodes and primitives, rays, samples; the knob if all points have the
    /// same.
    pub fn plot(&self) -> Drawing {
        let mut plot = Plot { case: self, marks: Vec::new(), methods: methods(self) };
        let (shown, others) = shown(self);
        let title = format!("{}, reference: {}", self.name, self.kind.meaning());
        plot.text((LEFTS[0], 18.0), &title, Anchor::Start);
        let (ys, floors, below) = plot.heights(&shown);
        if !below.is_empty() {
            plot.colored((LEFTS[0], 40.0), &below, Anchor::Start, FLOOR);
        }
        let unit = unit(&firsts(&shown), &self.knob);
        for (i, curves) in [&shown, &firsts(&shown)].into_iter().enumerate() {
            let x: fn(&Point) -> f64 = if i == 0 { Point::t_median } else { unit.of };
            let points = curves.iter().flat_map(|c| c.points.iter().filter(|p| ran(p)));
            let ends = |p: &Point| {
                let [low, high] = BAR.map(|share| if i == 0 { p.t_quantile(share) } else { x(p) });
                [low, x(p), high]
            };
            let axes = Axes { left: LEFTS[i], xs: decades(points.flat_map(ends)), ys };
            plot.axes(&axes, ["seconds (median)", unit.name][i]);
            floors.iter().for_each(|(name, floor)| plot.floor(&axes, name, *floor));
            if i == 1 {
                curves.iter().enumerate().for_each(|(k, c)| plot.triangle(&axes, c, x, k));
            }
            curves.iter().for_each(|curve| plot.curve(&axes, curve, x, i == 0));
        }
        let bottom = plot.legend(&shown, others);
        let height = HEIGHT.max(bottom.ceil() as u32);
        Drawing { width: WIDTH, height, marks: plot.marks }
    }
}

/// Returns the names of methods in order; their indices choose colours.
fn methods(case: &Measured) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for curve in &case.curves {
        if !names.contains(&curve.method.name) {
            names.push(curve.method.name.clone());
        }
    }
    names
}

fn ran(point: &Point) -> bool {
    !point.repetitions.is_empty() && error(point).is_finite()
}

/// Returns the drawn error of a point: the median of its runs.
fn error(point: &Point) -> f64 {
    point.rmse_quantile(0.5)
}

/// The unit of the right panel's axis.
struct Unit<'c> {
    name: &'c str,
    /// Returns the work of one run of a point; 0 if unknown.
    of: fn(&Point) -> f64,
}

/// Returns the first unit that is known for every point and not the same for all, the most
/// informative first.
fn unit<'c>(curves: &[&Curve], knob: &'c str) -> Unit<'c> {
    let units = [
        Unit { name: "counted in all", of: |p| float(p.repetitions[0].counted) },
        Unit { name: "texture fetches in all", of: |p| float(p.work().texture_fetches) },
        Unit { name: "tests of nodes and primitives in all", of: |p| float(tests(p)) },
        Unit { name: "rays in all", of: |p| float(p.work().rays) },
        Unit { name: "samples in all", of: |p| p.samples() as f64 },
    ];
    let points = || curves.iter().flat_map(|c| c.points.iter().filter(|p| ran(p)));
    let numbers = |unit: &Unit<'_>| points().map(unit.of).collect::<Vec<f64>>();
    let says_something = |unit: &Unit<'_>| {
        let numbers = numbers(unit);
        let differ = numbers.iter().any(|n| *n != numbers[0]) || numbers.len() < 2;
        differ && numbers.iter().all(|n| *n > 0.0)
    };
    let of_knob = Unit { name: knob, of: |p| f64::from(p.knob) };
    units.into_iter().find(says_something).unwrap_or(of_knob)
}

fn float(count: Option<u64>) -> f64 {
    count.unwrap_or(0) as f64
}

fn tests(point: &Point) -> Option<u64> {
    let work = point.work();
    work.nodes.zip(work.primitives).map(|(nodes, primitives)| nodes + primitives)
}

/// Returns the curves of the plot, and the number of others.
fn shown(case: &Measured) -> (Vec<&Curve>, usize) {
    let all: Vec<&Curve> = case.curves.iter().filter(|c| c.points.iter().any(ran)).collect();
    if all.len() <= CURVES {
        return (all, 0);
    }
    let quickest = quickest(&all);
    let is_kept = |c: &Curve| c.backend == all[0].backend || Some(c.backend) == quickest;
    let kept: Vec<&Curve> = all.iter().copied().filter(|c| is_kept(c)).collect();
    let others = all.len() - kept.len();
    (kept, others)
}

/// Returns the backend with the greatest speed-up over the first, on average over methods.
fn quickest(curves: &[&Curve]) -> Option<Backend> {
    let mean = |backend: Backend| {
        let of_it = curves.iter().filter(|c| c.backend == backend);
        let logs: Vec<f64> = of_it.filter_map(|c| c.speedup).map(|s| s.ratio.ln()).collect();
        if logs.is_empty() { 0.0 } else { logs.iter().sum::<f64>() / logs.len() as f64 }
    };
    curves.iter().map(|c| c.backend).max_by(|a, b| mean(*a).total_cmp(&mean(*b)))
}

/// Returns the first backend of each method: the others take the same samples.
fn firsts<'c>(curves: &[&'c Curve]) -> Vec<&'c Curve> {
    let is_first = |i: usize| curves[..i].iter().all(|c| c.method != curves[i].method);
    (0..curves.len()).filter(|i| is_first(*i)).map(|i| curves[i]).collect()
}

/// Returns the whole powers of ten around positive numbers; one decade if there is none.
fn decades(values: impl Iterator<Item = f64>) -> (i32, i32) {
    let logs = values.filter(|v| *v > 0.0 && v.is_finite()).map(f64::log10);
    let (low, high) =
        logs.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    if low > high {
        return (-1, 0);
    }
    let (low, high) = (low.floor() as i32, high.ceil() as i32);
    (low, high.max(low + 1))
}

/// Returns whether the label of a power of ten is written: of many powers, every second or third.
fn is_labelled(exponent: i32, (low, high): (i32, i32)) -> bool {
    let every = (high - low) / LABELS + 1;
    (exponent - low) % every == 0
}

struct Axes {
    left: f64,
    xs: (i32, i32),
    ys: (i32, i32),
}

impl Axes {
    fn place(&self, x: f64, y: f64) -> (f64, f64) {
        let share = |v: f64, (low, high): (i32, i32)| {
            let log = v.max(f64::MIN_POSITIVE).log10();
            ((log - f64::from(low)) / f64::from(high - low)).clamp(0.0, 1.0)
        };
        let height = BOTTOM - TOP;
        (self.left + PANEL * share(x, self.xs), BOTTOM - height * share(y, self.ys))
    }

    /// Returns the first position at which the whole text is in the panel; if there is none, the
    /// last, moved inside.
    fn first_inside<const N: usize>(
        &self,
        places: [((f64, f64), Anchor); N],
        text: &str,
    ) -> ((f64, f64), Anchor) {
        let length = LETTER * text.chars().count() as f64;
        // The required shift.
        let shift = |((x, y), anchor): ((f64, f64), Anchor)| {
            let left = match anchor {
                Anchor::Start => x,
                Anchor::Middle => x - 0.5 * length,
                Anchor::End => x - length,
            };
            let (least, most) = (self.left + MARGIN, self.left + PANEL - MARGIN - length);
            let half = 0.5 * FONT_SIZE;
            let height = y.clamp(TOP + half, BOTTOM - MARGIN - half);
            (left.clamp(least, most) - left, height - y)
        };
        let inside = places.into_iter().find(|place| shift(*place) == (0.0, 0.0));
        inside.unwrap_or_else(|| {
            let ((x, y), anchor) = places[N - 1];
            let (right, down) = shift(places[N - 1]);
            ((x + right, y + down), anchor)
        })
    }
}

fn mean(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    (0.5 * (a.0 + b.0), 0.5 * (a.1 + b.1))
}

struct Plot<'c> {
    case: &'c Measured,
    marks: Vec<Mark>,
    methods: Vec<String>,
}

impl Plot<'_> {
    fn line(&mut self, points: &[(f64, f64)], color: Color, width: f64, dash: Option<f64>) {
        self.marks.push(Mark::Line { points: points.to_vec(), color, width, dash });
    }

    fn text(&mut self, at: (f64, f64), text: &str, anchor: Anchor) {
        self.colored(at, text, anchor, INK);
    }

    fn colored(&mut self, at: (f64, f64), text: &str, anchor: Anchor, color: Color) {
        let text = text.to_owned();
        self.marks.push(Mark::Text { at, text, color, anchor, is_turned: false });
    }

    fn color(&self, curve: &Curve) -> Color {
        let at = self.methods.iter().position(|m| *m == curve.method.name).unwrap_or(0);
        COLORS[at % COLORS.len()]
    }

    /// Returns the decades of errors, the floors within them, and a note of those below.
    fn heights(&self, curves: &[&Curve]) -> ((i32, i32), Vec<(&'static str, f64)>, String) {
        let points = curves.iter().flat_map(|c| c.points.iter().filter(|p| ran(p)));
        let ends = |p: &Point| [BAR[0], 0.5, BAR[1]].map(|share| p.rmse_quantile(share));
        let errors: Vec<f64> = points.flat_map(ends).collect();
        let positive = errors.iter().copied().filter(|e| *e > 0.0);
        let least = positive.fold(f64::INFINITY, f64::min);
        let all =
            [("f32 floor", self.case.rounding_floor), ("reference floor", self.case.uncertainty)];
        let is_near = |f: f64| !least.is_finite() || f * 10f64.powf(REACH) >= least;
        let (floors, below): (Vec<_>, Vec<_>) =
            all.into_iter().filter(|f| f.1 > 0.0).partition(|f| is_near(f.1));
        let note = |(name, floor): (&str, f64)| format!("{name}: {floor:.1e}, below the picture");
        let below: Vec<String> = below.into_iter().map(note).collect();
        (decades(errors.into_iter().chain(floors.iter().map(|f| f.1))), floors, below.join("; "))
    }

    fn axes(&mut self, axes: &Axes, label: &str) {
        let ends = |a: (i32, i32)| (10f64.powi(a.0), 10f64.powi(a.1));
        let ((x0, x1), (y0, y1)) = (ends(axes.xs), ends(axes.ys));
        for e in axes.xs.0..=axes.xs.1 {
            let x = 10f64.powi(e);
            self.line(&[axes.place(x, y0), axes.place(x, y1)], GRID, 1.0, None);
            if is_labelled(e, axes.xs) {
                self.text((axes.place(x, y0).0, BOTTOM + 16.0), &format!("1e{e}"), Anchor::Middle);
            }
        }
        for e in axes.ys.0..=axes.ys.1 {
            let y = 10f64.powi(e);
            self.line(&[axes.place(x0, y), axes.place(x1, y)], GRID, 1.0, None);
            if is_labelled(e, axes.ys) {
                self.text((axes.left - 8.0, axes.place(x0, y).1), &format!("1e{e}"), Anchor::End);
            }
        }
        let corners = [(x0, y1), (x0, y0), (x1, y0)].map(|(x, y)| axes.place(x, y));
        self.line(&corners, INK, 1.25, None);
        self.text((axes.left + PANEL / 2.0, BOTTOM + 40.0), label, Anchor::Middle);
        // The panels have one scale of errors.
        if axes.left > LEFTS[0] {
            return;
        }
        self.marks.push(Mark::Text {
            at: (axes.left - 64.0, 0.5 * (TOP + BOTTOM)),
            text: "root of the mean square error (median)".to_owned(),
            color: INK,
            anchor: Anchor::Middle,
            is_turned: true,
        });
    }

    fn floor(&mut self, axes: &Axes, name: &str, floor: f64) {
        let (x0, x1) = (10f64.powi(axes.xs.0), 10f64.powi(axes.xs.1));
        let ends = [axes.place(x0, floor), axes.place(x1, floor)];
        self.line(&ends, FLOOR, 1.25, Some(2.0));
        let at = (ends[1].0 - 4.0, ends[1].1 - 0.6 * FONT_SIZE);
        self.colored(at, name, Anchor::End, FLOOR);
    }

    fn curve(&mut self, axes: &Axes, curve: &Curve, x: fn(&Point) -> f64, has_times: bool) {
        let color = self.color(curve);
        let mut points: Vec<&Point> = curve.points.iter().filter(|p| ran(p)).collect();
        points.sort_by(|a, b| x(a).total_cmp(&x(b)));
        let place = |p: &Point| axes.place(x(p), error(p));
        for pair in points.windows(2) {
            let is_good = pair.iter().all(|p| p.status() == Status::Ok);
            let dash = (!is_good).then_some(3.0);
            self.line(&[place(pair[0]), place(pair[1])], color, 1.5, dash);
        }
        let shape = symbol(curve.backend);
        for point in points {
            self.bars(axes, point, x(point), has_times, color);
            self.marks.push(Mark::Symbol {
                at: place(point),
                symbol: shape,
                color,
                radius: RADIUS,
            });
        }
    }

    /// Draws the bars from the 10 % to the 90 % quantile of the runs: of the error, and of the time
    /// if the axis is time.
    fn bars(&mut self, axes: &Axes, point: &Point, x: f64, has_times: bool, color: Color) {
        let [low, high] = BAR.map(|share| axes.place(x, point.rmse_quantile(share)));
        self.bar(low, high, color);
        if has_times {
            let [low, high] = BAR.map(|share| axes.place(point.t_quantile(share), error(point)));
            self.bar(low, high, color);
        }
    }

    /// Draws a line with a cap at each end, unless the symbol would hide it.
    fn bar(&mut self, a: (f64, f64), b: (f64, f64), color: Color) {
        let length = (b.0 - a.0).hypot(b.1 - a.1);
        if length <= 2.0 * RADIUS {
            return;
        }
        self.line(&[a, b], color, 1.0, None);
        let across = ((b.1 - a.1) / length * CAP, (b.0 - a.0) / length * CAP);
        for end in [a, b] {
            let ends = [-1.0, 1.0].map(|s| (end.0 + s * across.0, end.1 + s * across.1));
            self.line(&ends, color, 1.0, None);
        }
    }

    /// Draws the theoretical order of a method: the first method's above its curve, the others'
    /// below theirs, each at another position.
    fn triangle(&mut self, axes: &Axes, curve: &Curve, x: fn(&Point) -> f64, k: usize) {
        let points: Vec<&Point> = curve.points.iter().filter(|p| ran(p)).collect();
        let (Some(order), true) = (curve.expected.map(drawn), points.len() > 1) else { return };
        let is_above = k == 0;
        let first = (points.len() - 2).min(k.max(1) - usize::from(!is_above));
        let (a, b) = (points[first], points[first + 1]);
        let (x0, x1) = (x(a), x(b));
        let y0 = if is_above { 1.6 } else { 0.55 } * error(a);
        // Orders are powers of the knob, whatever the axis counts.
        let y1 = y0 * (f64::from(b.knob) / f64::from(a.knob)).powf(order);
        let (low, high) = (10f64.powi(axes.ys.0), 10f64.powi(axes.ys.1));
        let is_inside = y1 > low && y0 < high;
        if !is_inside {
            return;
        }
        let right_angle = if is_above { (x1, y0) } else { (x0, y1) };
        let color = self.color(curve);
        let corners = [(x0, y0), (x1, y1), right_angle, (x0, y0)].map(|(x, y)| axes.place(x, y));
        self.line(&corners, color, 1.0, None);
        let text = format!("{order:.2}");
        // Beside the vertical leg, or if that is too near to an axis, along the horizontal one.
        let ((upright, level), middle) = (corners[2], mean(corners[0], corners[1]));
        let (aside, anchor) = if is_above { (4.0, Anchor::Start) } else { (-4.0, Anchor::End) };
        let beyond = if is_above { -0.6 } else { 0.6 } * FONT_SIZE;
        let places =
            [((upright + aside, middle.1), anchor), ((middle.0, level + beyond), Anchor::Middle)];
        let (at, anchor) = axes.first_inside(places, &text);
        self.colored(at, &text, anchor, color);
    }

    /// Draws the legend: the colour of each method, with its order, and the symbol of each backend.
    /// Returns where it ends.
    fn legend(&mut self, curves: &[&Curve], others: usize) -> f64 {
        let mut y = TOP + 0.5 * FONT_SIZE;
        for curve in firsts(curves) {
            let color = self.color(curve);
            self.line(&[(LEGEND, y), (LEGEND + 20.0, y)], color, 2.5, None);
            let name: String = curve.method.name.chars().take(16).collect();
            self.text((LEGEND + 28.0, y), &name, Anchor::Start);
            let order = curve.fit.map_or_else(String::new, |f| {
                // Not `-0`.
                format!("order {:.2} ± {:.2}", round(f.order), 0.5 * (f.high - f.low))
            });
            self.text((LEGEND + 28.0, y + LINE), &order, Anchor::Start);
            y += 2.0 * LINE + 4.0;
        }
        let mut backends: Vec<Backend> = Vec::new();
        for curve in curves {
            if !backends.contains(&curve.backend) {
                backends.push(curve.backend);
            }
        }
        for backend in backends {
            let at = (LEGEND + 10.0, y);
            self.marks.push(Mark::Symbol { at, symbol: symbol(backend), color: INK, radius: 5.0 });
            self.text((LEGEND + 28.0, y), backend.name(), Anchor::Start);
            y += LINE;
        }
        if others > 0 {
            self.text((LEGEND, y + 4.0), &format!("{others} curves more in"), Anchor::Start);
            self.text((LEGEND, y + 4.0 + LINE), "the table", Anchor::Start);
            y += 2.0 * LINE + 4.0;
        }
        y
    }
}

/// Returns a number with two digits behind the point, 0 without a sign.
fn round(number: f64) -> f64 {
    (100.0 * number).round() / 100.0 + 0.0
}

/// Returns the order of a triangle: the middle of a range, or its end.
fn drawn(order: Order) -> f64 {
    if order.steepest.is_finite() {
        0.5 * (order.steepest + order.flattest)
    } else {
        order.flattest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_stay_in_their_panel() {
        let axes = Axes { left: 100.0, xs: (0, 1), ys: (0, 1) };
        let (beside, below) = (((300.0, 200.0), Anchor::End), ((320.0, 250.0), Anchor::Middle));
        assert_eq!(axes.first_inside([beside, below], "-0.50"), beside);
        // Its left end would be at 95.
        let near = ((140.0, 200.0), Anchor::End);
        assert_eq!(axes.first_inside([near, below], "-0.50"), below);
        let corner = ((110.0, BOTTOM), Anchor::Middle);
        let moved = (100.0 + MARGIN + 2.5 * LETTER, BOTTOM - MARGIN - 0.5 * FONT_SIZE);
        let moved = (moved, Anchor::Middle);
        assert_eq!(axes.first_inside([near, corner], "-0.50"), moved);
    }

    #[test]
    fn decades_hold_all_numbers() {
        assert_eq!(decades([0.002, 0.5].into_iter()), (-3, 0));
        assert_eq!(decades([1.0].into_iter()), (0, 1));
        assert_eq!(decades([f64::NAN, 0.0, -1.0, f64::INFINITY].into_iter()), (-1, 0));
    }
}
