//! Who is asked what, interleaved rounds of it, and what they say.

use raydsl_benches::clock::{median, spread};
use raydsl_benches::contest::{Cost, Outcome};
use raydsl_benches::table::Line;

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Query {
    /// The closest hits of a camera's rays.
    Primary,
    /// Whether shadow rays hit something within a tenth of the scene's diagonal.
    Shadow,
}

impl Query {
    pub(crate) const ALL: [Self; 2] = [Self::Primary, Self::Shadow];

    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Primary => "primary",
            Self::Shadow => "shadow_short",
        }
    }

    pub(crate) fn from_name(name: &str) -> Result<Self, String> {
        let query = Self::ALL.into_iter().find(|query| query.name() == name);
        query.ok_or_else(|| format!("one of {}", Self::ALL.map(Self::name).join(", ")))
    }
}

/// Runs a query once.
pub(crate) type Run<'a> = Box<dyn FnMut() -> Outcome + Send + 'a>;

/// One way to run one query.
pub(crate) struct Contender<'a> {
    pub(crate) query: Query,
    pub(crate) system: &'static str,
    pub(crate) mode: String,
    pub(crate) isa: &'static str,
    pub(crate) lanes: usize,
    pub(crate) cost: Cost,
    pub(crate) run: Run<'a>,
}

/// A contender, what it took in each round, and what it found in the last.
struct Record<'c, 'a> {
    contender: &'c mut Contender<'a>,
    seconds: Vec<f64>,
    outcome: Outcome,
}

/// Where lines are from.
#[derive(Clone, Copy)]
pub(crate) struct Place<'a> {
    pub(crate) scene: &'a str,
    pub(crate) threads: usize,
}

/// Runs every contender once a round: what the machine does meanwhile touches all alike. The lines are
/// in the order of the queries; `rays` says how many rays each has.
pub(crate) fn measure(
    place: Place<'_>,
    contenders: &mut [Contender<'_>],
    rounds: usize,
    rays: impl Fn(Query) -> usize,
) -> Vec<Line> {
    let record = |contender| Record { contender, seconds: Vec::new(), outcome: Outcome::default() };
    let mut records: Vec<Record<'_, '_>> = contenders.iter_mut().map(record).collect();
    // The first round warms up.
    for round in 0..=rounds {
        for record in &mut records {
            record.outcome = (record.contender.run)();
            if round > 0 {
                record.seconds.push(record.outcome.seconds);
            }
        }
    }
    let of_query = |query: Query| {
        let of_query: Vec<&Record<'_, '_>> =
            records.iter().filter(|record| record.contender.query == query).collect();
        lines(place, &of_query, rays(query))
    };
    Query::ALL.into_iter().flat_map(of_query).collect()
}

/// The figures of the records of one query beside Embree's best mode.
fn lines(place: Place<'_>, records: &[&Record<'_, '_>], rays: usize) -> Vec<Line> {
    let rivals = records.iter().filter(|record| record.contender.system == "embree");
    let rival = rivals.min_by(|a, b| median(&a.seconds).total_cmp(&median(&b.seconds)));
    let expected = rival.or(records.first()).map(|record| record.outcome).unwrap_or_default();
    let line = |record: &&Record<'_, '_>| {
        let rates: Vec<f64> = record.seconds.iter().map(|s| rays as f64 / s * 1e-6).collect();
        let ratio = |(a, b): (&f64, &f64)| a / b;
        let ratios: Option<Vec<f64>> =
            rival.map(|rival| rival.seconds.iter().zip(&record.seconds).map(ratio).collect());
        let Contender { query, system, mode, isa, lanes, cost, .. } = &*record.contender;
        Line {
            scene: place.scene.to_owned(),
            row: query.name(),
            system,
            mode: mode.clone(),
            isa,
            lanes: *lanes,
            rays,
            threads: place.threads,
            mrays_per_s: median(&rates),
            spread: spread(ratios.as_ref().unwrap_or(&rates)),
            ratio_to_embree: ratios.as_deref().map(median),
            ratio_to_robust: None,
            build_ms: cost.build_ms,
            bytes_per_primitive: cost.bytes_per_primitive,
            hits: record.outcome.hits,
            mean_t: record.outcome.mean(),
            status: if record.outcome.agrees(&expected, rays) { "ok" } else { "void" },
        }
    };
    records.iter().map(line).collect()
}
