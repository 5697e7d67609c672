//! Computed scaling: how long runs on many nodes would take, from reports of measured ones.
//!
//! The model takes the rate of a thread, the bytes and the fragments of a frame and the root's time
//! for a byte from reports; what it assumes of a cluster is in [`Cluster`]. Of films it takes
//! rendering, messages and the root's work to overlap as a whole, so that a run takes at least what is
//! computed: a rank that sends a part waits until the root receives it. The phases of a frame follow
//! each other.

use super::report::Report;

/// What is assumed of a cluster.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cluster {
    /// Threads of a node that render.
    pub threads: f64,
    /// Bytes that a node sends or receives in a second.
    pub bandwidth: f64,
    /// Seconds from the call that sends a message to its arrival.
    pub latency: f64,
}

impl Default for Cluster {
    fn default() -> Self {
        // 100 Gbit/s, as InfiniBand EDR.
        Self { threads: 64.0, bandwidth: 12.5e9, latency: 2e-6 }
    }
}

/// A row of a table: what takes how long on so many nodes, in seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Number of nodes.
    pub nodes: u32,
    /// The picture, or a frame.
    pub total: f64,
    /// Rendering alone, on all nodes.
    pub render: f64,
    /// What reaches the root, by its link.
    pub link: f64,
    /// What is computed of what was sent: joining by the root, or compositing by all.
    pub joining: f64,
    /// Messages, by their number.
    pub messages: f64,
    /// The time of one node for the same work, over that of all nodes together.
    pub efficiency: f64,
    /// What takes longest.
    pub limit: &'static str,
}

/// Strong scaling has one picture; in weak scaling the work grows with the nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scaling {
    /// The same picture or scene for all numbers of nodes.
    Strong,
    /// For each node as much as for one: samples of a film, points or voxels of a divided scene.
    Weak,
}

/// Numbers of nodes in tables.
pub const NODES: [u32; 6] = [1, 4, 16, 64, 256, 1024];

/// A film on many nodes: its picture, and what reports of films say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Film {
    /// Pixels of the picture.
    pub pixels: f64,
    /// Samples of each pixel, for one node where scaling is weak.
    pub samples: f64,
    /// Pixels of a window.
    pub window: f64,
    /// Blocks of 64 samples of a unit of work.
    pub blocks: f64,
    /// Samples that a thread renders in a second.
    pub rate: f64,
    /// Seconds of the root for a byte of a part.
    pub root: f64,
}

/// Returns the bytes of a pixel of a part: of one block, or of a greater power of two.
fn pixel_bytes(blocks: f64) -> f64 {
    if blocks > 1.0 { 64.0 } else { 32.0 }
}

impl Film {
    /// Takes rates from a report of a film; `None` if it is none, or nothing was sent.
    pub fn of(report: &Report) -> Option<Self> {
        let film = report.film.as_ref().filter(|film| film.part_bytes > 0)?;
        let pixels = f64::from(report.width) * f64::from(report.height);
        // Those of the root too.
        let units = (f64::from(film.samples) / (64.0 * f64::from(film.blocks))).ceil();
        let bytes = pixels * units * pixel_bytes(f64::from(film.blocks));
        Some(Self {
            pixels,
            samples: f64::from(film.samples),
            window: f64::from(film.tile).powi(2),
            blocks: f64::from(film.blocks),
            rate: report.rate_per_thread(),
            root: film.root_seconds / bytes,
        })
    }

    /// Computes a row.
    pub fn row(&self, cluster: &Cluster, scaling: Scaling, nodes: u32) -> Row {
        let n = f64::from(nodes);
        let samples = self.samples * if scaling == Scaling::Weak { n } else { 1.0 };
        let phases = self.phases(cluster, samples, n);
        let [render, link, joining, messages] = phases.map(|(_, seconds)| seconds);
        let (limit, total) = longest(&phases);
        let (_, by_one) = longest(&self.phases(cluster, samples, 1.0));
        let efficiency = by_one / (n * total);
        Row { nodes, total, render, link, joining, messages, efficiency, limit }
    }

    /// Returns how long rendering, the root's link, joining and messages take, which overlap.
    fn phases(&self, cluster: &Cluster, samples: f64, n: f64) -> [(&'static str, f64); 4] {
        let unit_samples = 64.0 * self.blocks;
        let units = (self.pixels / self.window).ceil() * (samples / unit_samples).ceil();
        let node_rate = self.rate * cluster.threads;
        // The last units are not divided.
        let unit = self.window * unit_samples.min(samples) / node_rate;
        let render = (units / n).ceil() * unit;
        let pixel = pixel_bytes(self.blocks);
        let bytes = units * self.window * pixel * (n - 1.0) / n;
        let link = bytes / cluster.bandwidth;
        // Its own parts are joined too.
        let joining = units * self.window * pixel * self.root;
        let messages = 2.0 * units * (n - 1.0) / n * cluster.latency;
        [
            ("rendering", render),
            ("the root's link", link),
            ("joining by the root", joining),
            ("messages to the root", messages),
        ]
    }
}

/// Frames of a divided scene on many nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frames {
    /// Pixels of the picture.
    pub pixels: f64,
    /// Fragments of a picture of one part, for each pixel.
    pub fragments: f64,
    /// The power of the number of parts with which fragments grow.
    pub growth: f64,
    /// Bytes of a fragment.
    pub bytes: f64,
    /// Seconds of a thread for a pixel of one part.
    pub render: f64,
    /// The power of the number of parts with which the work of rendering one scene grows.
    pub overhead: f64,
    /// Seconds of a thread for compositing a fragment.
    pub composite: f64,
}

/// The bytes of a pixel that the root gathers.
const GATHERED: f64 = 12.0;

impl Frames {
    /// Takes rates from two reports of frames: of one part, and of more. `None` if they are others.
    pub fn of(one: &Report, more: &Report, bytes: f64) -> Option<Self> {
        let (a, b) = (one.divided.as_ref()?, more.divided.as_ref()?);
        if one.frames == 0 || more.frames == 0 || a.parts >= b.parts || a.fragments_per_frame <= 0.0
        {
            return None;
        }
        let pixels = f64::from(one.width) * f64::from(one.height);
        let ratio = b.fragments_per_frame / a.fragments_per_frame;
        let parts = f64::from(b.parts) / f64::from(a.parts);
        let each = |seconds: f64| seconds / f64::from(one.frames);
        let cpu = |report: &Report| {
            let all: f64 = report.ranks.iter().map(|rank| rank.cpu_seconds).sum();
            all / f64::from(report.frames)
        };
        Some(Self {
            pixels,
            fragments: a.fragments_per_frame / pixels,
            growth: ratio.ln() / parts.ln(),
            bytes,
            render: cpu(one) / pixels,
            overhead: ((cpu(more) / cpu(one)).ln() / parts.ln()).max(0.0),
            composite: each(a.composite_cpu_seconds) / a.fragments_per_frame,
        })
    }

    /// Computes a row. A scene that is divided takes more work than as a whole, by what was measured;
    /// in weak scaling, a ray's work in each part is that in the whole of one node.
    pub fn row(&self, cluster: &Cluster, scaling: Scaling, nodes: u32) -> Row {
        let n = f64::from(nodes);
        // Parts in front of each other.
        let layers = n.powf(self.growth);
        let fragments = self.pixels * self.fragments * layers;
        let one_node = self.pixels * self.render / cluster.threads;
        let work = match scaling {
            Scaling::Strong => n.powf(self.overhead),
            Scaling::Weak => layers,
        };
        let render = one_node * work / n;
        let exchanged = fragments / n * self.bytes * (n - 1.0) / n / cluster.bandwidth;
        let gathered = self.pixels * GATHERED * (n - 1.0) / n / cluster.bandwidth;
        let joining = fragments / n * self.composite / cluster.threads;
        // To each other rank of the exchange, and the root's of gathering.
        let messages = 2.0 * (n - 1.0) * cluster.latency;
        let link = exchanged + gathered;
        let total = render + link + joining + messages;
        // One node has the scene as a whole where that is one and the same; where it grows, one node
        // would render and composite the same parts, if it had the memory.
        let by_one = match scaling {
            Scaling::Strong => {
                one_node + self.pixels * self.fragments * self.composite / cluster.threads
            }
            Scaling::Weak => n * (render + joining),
        };
        let parts = [
            ("rendering", render),
            ("exchanging fragments", exchanged),
            ("gathering the picture", gathered),
            ("compositing", joining),
            ("messages to each other", messages),
        ];
        let (limit, _) = longest(&parts);
        Row {
            nodes,
            total,
            render,
            link,
            joining,
            messages,
            efficiency: by_one / (n * total),
            limit,
        }
    }
}

fn longest(parts: &[(&'static str, f64)]) -> (&'static str, f64) {
    let longer = |a: (&'static str, f64), b: &(&'static str, f64)| if b.1 > a.1 { *b } else { a };
    parts.iter().fold(("nothing", 0.0), longer)
}

/// Returns rows as a table of Markdown.
pub fn table(rows: &[Row]) -> String {
    let mut text = String::from(
        "| nodes | total | rendering | link | joining | messages | efficiency | what takes longest |\n\
         |---:|---:|---:|---:|---:|---:|---:|---|\n",
    );
    for row in rows {
        let [total, render, link, joining, messages] =
            [row.total, row.render, row.link, row.joining, row.messages].map(seconds);
        text += &format!(
            "| {} | {total} | {render} | {link} | {joining} | {messages} | {:.0} % | {} |\n",
            row.nodes,
            100.0 * row.efficiency,
            row.limit
        );
    }
    text
}

/// Returns a time with three digits.
fn seconds(time: f64) -> String {
    let (value, unit) = match time {
        t if t >= 0.9995 => (t, "s"),
        t if t >= 0.9995e-3 => (1e3 * t, "ms"),
        t => (1e6 * t, "us"),
    };
    let decimals = match value {
        v if v >= 99.95 => 0,
        v if v >= 9.995 => 1,
        _ => 2,
    };
    format!("{value:.decimals$} {unit}")
}

#[cfg(test)]
mod tests {
    use super::*;

    const CLUSTER: Cluster = Cluster { threads: 10.0, bandwidth: 1e9, latency: 1e-6 };

    fn film() -> Film {
        let (pixels, window) = (64.0 * 64.0 * 100.0, 64.0 * 64.0);
        Film { pixels, samples: 640.0, window, blocks: 1.0, rate: 1e6, root: 1e-10 }
    }

    #[test]
    fn one_node_renders_and_sends_nothing() {
        let row = film().row(&CLUSTER, Scaling::Strong, 1);
        let expected = film().pixels * 640.0 / 1e7;
        assert!((row.total / expected - 1.0).abs() < 1e-12 && (row.efficiency - 1.0).abs() < 1e-12);
        assert_eq!((row.link, row.messages, row.limit), (0.0, 0.0, "rendering"));
    }

    #[test]
    fn a_film_is_not_divided_below_its_units() {
        // 1,000 units: 1,024 nodes take as long as 1,000.
        let row = film().row(&CLUSTER, Scaling::Strong, 1024);
        assert!((row.render - 64.0 * 4096.0 / 1e7).abs() < 1e-12);
        assert!(row.efficiency < 1.0);
        // What the root receives does not depend on how many send it, all of it but its own.
        let link = 1000.0 * 4096.0 * 32.0 / 1e9;
        assert!((row.link / link - 1.0).abs() < 1e-2 && row.limit == "the root's link");
    }

    /// 101 windows are no multiple of any number of nodes: the last units are not divided.
    #[test]
    fn efficiency_is_speedup_over_nodes() {
        let film = Film { pixels: 64.0 * 64.0 * 100.5, ..film() };
        let rows = NODES.map(|nodes| film.row(&CLUSTER, Scaling::Strong, nodes));
        for row in rows {
            let speedup = rows[0].total / row.total;
            assert!((row.efficiency * f64::from(row.nodes) / speedup - 1.0).abs() < 1e-12);
        }
        assert!((rows[0].efficiency - 1.0).abs() < 1e-12);
    }

    #[test]
    fn weak_scaling_of_films_ends_at_the_root() {
        let rows = NODES.map(|nodes| film().row(&CLUSTER, Scaling::Weak, nodes));
        assert!(rows.windows(2).all(|pair| pair[1].efficiency <= pair[0].efficiency + 1e-12));
        assert!((rows[1].efficiency - 1.0).abs() < 1e-12);
        assert_eq!(rows[5].limit, "the root's link");
    }

    #[test]
    fn frames_gather_a_picture_of_one_size() {
        let frames = Frames {
            pixels: 1e6,
            fragments: 0.5,
            growth: 1.0 / 3.0,
            bytes: 16.0,
            render: 1e-6,
            overhead: 0.1,
            composite: 1e-7,
        };
        let rows = NODES.map(|nodes| frames.row(&CLUSTER, Scaling::Strong, nodes));
        assert!(rows.windows(2).all(|pair| pair[1].efficiency < pair[0].efficiency));
        for row in rows {
            let speedup = rows[0].total / row.total;
            assert!((row.efficiency * f64::from(row.nodes) / speedup - 1.0).abs() < 1e-12);
        }
        let weak = NODES.map(|nodes| frames.row(&CLUSTER, Scaling::Weak, nodes).efficiency);
        assert!((weak[0] - 1.0).abs() < 1e-12 && weak.iter().all(|e| *e <= 1.0 + 1e-12));
        // 12 MB by a link of 1 GB/s, and fragments of ten parts one behind another.
        let last = rows[5];
        let exchanged = 0.5e6 * 1024f64.powf(1.0 / 3.0) / 1024.0 * 16.0 / 1e9;
        assert!((last.link / (12e-3 + exchanged) - 1.0).abs() < 1e-2);
        assert_eq!(last.limit, "gathering the picture");
        let times = [0.0, 1.234e-6, 0.99949e-3, 12.345e-3, 0.9996, 123.456];
        let shown = ["0.00 us", "1.23 us", "999 us", "12.3 ms", "1.00 s", "123 s"];
        assert_eq!(times.map(seconds), shown);
        let text = table(&rows);
        assert_eq!(text.lines().count(), 2 + NODES.len());
        assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
    }
}
