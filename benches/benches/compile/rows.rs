//! Measures cases, and prints a row for each measure.

use std::path::Path;

use raydsl_benches::clock::{median, spread};
use serde::Serialize;

use super::cases::{COPIES, Case, Measure, SCALAR, WHILE_EDITING};
use super::project::{Order, Profile, Project};
use super::rustc::Times;

/// One measure of one case.
#[derive(Serialize)]
pub(crate) struct Row {
    case: String,
    /// How it was compiled.
    command: String,
    /// Which copies it has, as `RAYDSL_VARIANTS` names them, or `all`.
    variants: &'static str,
    /// Seconds that the processors were busy, the median of all runs; of systems that do not say
    /// it, none.
    cpu_s: Option<f64>,
    /// Thousand millions of rustc's instructions, the median, where they are counted.
    instructions: Option<f64>,
    /// These, or else the CPU seconds, less those of the scalar function alone.
    over_scalar: Option<f64>,
    /// The interquartile range of the runs, as a share; of the wall seconds if there is nothing else.
    spread: f64,
    /// Seconds of the day, the median.
    wall_s: f64,
    /// How often it was compiled.
    runs: usize,
    /// Bytes of the program, if there is one.
    bytes: Option<usize>,
}

/// The rows so far.
pub(crate) struct Rows {
    project: Project,
    runs: usize,
    /// Whether the table has instructions, not seconds.
    counts: bool,
    rows: Vec<Row>,
    /// Whether the library's macros read `RAYDSL_VARIANTS`, if that is known.
    has_variants: Option<bool>,
}

/// All copies.
const ALL: &str = "all";

/// With the profile for an edit loop, for the first time.
const FROM_SCRATCH: &str = "edit loop: from scratch";

impl Rows {
    /// No rows, of programs that depend on the library in a workspace.
    pub(crate) fn new(
        library: &Path,
        runs: usize,
        is_kept: bool,
        counts: bool,
    ) -> Result<Self, String> {
        let project = Project::new(library, is_kept, counts)?;
        println!("{} in {}", library.display(), project.folder().display());
        let unit = if counts { "1e9 ins" } else { "CPU s" };
        println!(
            "{:<14}{:<38}{:<10}{unit:>8}{:>13}{:>8}{:>8}{:>11}",
            "case", "command", "variants", "over scalar", "spread", "wall s", "bytes"
        );
        Ok(Self { project, runs, counts, rows: Vec::new(), has_variants: None })
    }

    /// The rows.
    pub(crate) fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Only whether a case compiles.
    pub(crate) fn check(&mut self, case: &Case) -> Result<(), String> {
        self.compile(case, Measure::Check, None, None).map(|_| ())
    }

    /// All measures of a case.
    pub(crate) fn measure(&mut self, case: &Case) -> Result<(), String> {
        for &measure in &case.measures {
            if measure == Measure::Edit {
                self.edit(case, None)?;
                if self.has_variants()? {
                    self.edit(case, Some(WHILE_EDITING))?;
                }
            } else {
                self.compile(case, measure, None, None)?;
            }
        }
        if case.by_copy && self.has_variants()? {
            let base = self.compile(case, Measure::Release, Some(SCALAR), None)?;
            for copy in COPIES {
                self.compile(case, Measure::Release, Some(copy), base)?;
            }
        }
        Ok(())
    }

    /// Compiles a program as often as it shall be, and prints the row: its seconds of the
    /// processors. `base` are those without the copy.
    fn compile(
        &mut self,
        case: &Case,
        measure: Measure,
        variants: Option<&'static str>,
        base: Option<f64>,
    ) -> Result<Option<f64>, String> {
        let order = order(case, measure, variants);
        self.prepare(order.profile)?;
        let times = (0..self.runs).map(|_| self.project.build(order));
        let times = times.collect::<Result<Vec<Times>, String>>()?;
        let has_program = measure == Measure::Release;
        let program = has_program.then(|| self.project.executable(&case.name, order.profile));
        let bytes = program.transpose()?.map(|program| program.len());
        Ok(self.add(&case.name, measure.name(), variants, &times, base, bytes))
    }

    /// Compiles a program, and again with another number; prints a row for each.
    fn edit(&mut self, case: &Case, variants: Option<&'static str>) -> Result<(), String> {
        let [before, after] = case.edit.ok_or("no edit is known of it")?;
        if case.source.matches(before).count() != 1 {
            return Err(format!("`{before}` is not there once"));
        }
        let edited = case.source.replace(before, after);
        let order = order(case, Measure::Edit, variants);
        self.prepare(order.profile)?;
        let (mut first, mut again) = (Vec::new(), Vec::new());
        for _ in 0..self.runs {
            self.project.forget(order.profile)?;
            first.push(self.project.build(order)?);
            again.push(self.project.build(Order { source: &edited, ..order })?);
        }
        self.add(&case.name, FROM_SCRATCH.to_owned(), variants, &first, None, None);
        self.add(&case.name, Measure::Edit.name(), variants, &again, None, None);
        Ok(())
    }

    /// Compiles the dependencies, once a profile.
    fn prepare(&mut self, profile: Profile) -> Result<(), String> {
        if let Some(times) = self.project.prepare(profile)? {
            let command = match profile {
                Profile::Check => Measure::Check.name(),
                Profile::Release => Measure::Release.name(),
                Profile::Edit => FROM_SCRATCH.to_owned(),
            };
            self.add("dependencies", command, None, &[times], None, None);
        }
        Ok(())
    }

    /// Whether `RAYDSL_VARIANTS` makes a difference: a program with the scalar function alone is
    /// another one than that with all copies.
    fn has_variants(&mut self) -> Result<bool, String> {
        if let Some(known) = self.has_variants {
            return Ok(known);
        }
        self.prepare(Profile::Release)?;
        let source = include_str!("programs/empty.rs");
        let whole = Order {
            name: "variants",
            source,
            profile: Profile::Release,
            options: "",
            variants: None,
        };
        let mut sizes = [0; 2];
        for (size, variants) in sizes.iter_mut().zip([None, Some(SCALAR)]) {
            self.project.build(Order { variants, ..whole })?;
            *size = self.project.executable(whole.name, whole.profile)?.len();
        }
        let has = sizes[0] != sizes[1];
        if !has {
            println!("left out: rows by copy, since this library does not know RAYDSL_VARIANTS");
        }
        self.has_variants = Some(has);
        Ok(has)
    }

    /// Adds a row and prints it.
    fn add(
        &mut self,
        case: &str,
        command: String,
        variants: Option<&'static str>,
        times: &[Times],
        base: Option<f64>,
        bytes: Option<usize>,
    ) -> Option<f64> {
        let wall: Vec<f64> = times.iter().map(|t| t.wall).collect();
        let instructions: Option<Vec<f64>> = times.iter().map(|t| t.instructions).collect();
        // Those of a program that simulates a processor say nothing.
        let cpu: Option<Vec<f64>> = times.iter().map(|t| t.cpu).collect();
        let cpu = cpu.filter(|_| instructions.is_none());
        let figures = instructions.as_ref().or(cpu.as_ref());
        let figure = figures.map(|figures| median(figures));
        let row = Row {
            case: case.to_owned(),
            command,
            variants: variants.unwrap_or(ALL),
            cpu_s: cpu.as_deref().map(median),
            instructions: instructions.as_deref().map(median),
            over_scalar: figure.zip(base).map(|(figure, base)| figure - base),
            spread: spread(figures.unwrap_or(&wall)),
            wall_s: median(&wall),
            runs: times.len(),
            bytes,
        };
        print(&row, self.counts);
        self.rows.push(row);
        figure
    }
}

fn order<'a>(case: &'a Case, measure: Measure, variants: Option<&'a str>) -> Order<'a> {
    let (profile, options) = match measure {
        Measure::Check => (Profile::Check, ""),
        Measure::Release => (Profile::Release, ""),
        Measure::ReleaseWith(options) => (Profile::Release, options),
        Measure::Edit => (Profile::Edit, ""),
    };
    Order { name: &case.name, source: &case.source, profile, options, variants }
}

fn print(row: &Row, counts: bool) {
    let Row { case, command, variants, spread, wall_s, runs, bytes, .. } = row;
    let bytes = bytes.map_or("-".to_owned(), |bytes| bytes.to_string());
    let digits = |s: Option<f64>| s.map_or("-".to_owned(), |s| format!("{s:.2}"));
    let figure = digits(if counts { row.instructions } else { row.cpu_s });
    let over_scalar = digits(row.over_scalar);
    let spread = if *runs > 1 { format!("{:.1}%", 100.0 * spread) } else { "-".to_owned() };
    print!("{case:<14}{command:<38}{variants:<10}{figure:>8}");
    println!("{over_scalar:>13}{spread:>8}{wall_s:>8.2}{bytes:>11}");
}
