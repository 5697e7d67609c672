//! The command line.

use std::path::PathBuf;

use clap::Parser;
use raydsl::prelude::Variant;

use crate::measure::Run;
use crate::row::{Group, Row};

/// Measures the library at what is hard, in every variant.
#[derive(Parser)]
pub(crate) struct Args {
    /// Inputs of each row, as in 1e8; rows that cost more take fewer.
    #[arg(long, default_value = "1e5", value_parser = count)]
    count: u64,
    /// The largest number of inputs in WGSL.
    #[arg(long, default_value = "1e6", value_parser = count)]
    count_wgsl: u64,
    /// Only rows whose `group/name` contains one of these words.
    #[arg(long, value_delimiter = ',')]
    only: Vec<String>,
    /// Only these variants.
    #[arg(long, value_delimiter = ',', value_parser = ["scalar", "packet4", "packet8", "packet16", "wgsl", "f64"])]
    variants: Vec<String>,
    /// Writes a list of `{"row", "variant", "count", "worst", "bound", "verdict"}` to this file.
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    /// Writes the tables in Markdown, with an anchor for each group, to this file.
    #[arg(long, value_name = "FILE")]
    pub(crate) book: Option<PathBuf>,
    /// Prints the rows' names and measures nothing.
    #[arg(long)]
    pub(crate) list: bool,
}

/// Every kind of packets.
const PACKETS: [Variant; 3] = [Variant::Packet4, Variant::Packet8, Variant::Packet16];

impl Args {
    pub(crate) fn wants(&self, group: &str, row: &Row) -> bool {
        let path = format!("{group}/{}", row.name);
        self.only.is_empty() || self.only.iter().any(|word| path.contains(word.as_str()))
    }

    /// What the row is measured with.
    pub(crate) fn run(&self, group: &Group, row: &Row) -> Run {
        let has = |name: &str| self.variants.is_empty() || self.variants.iter().any(|v| v == name);
        Run {
            seed: raydsl_tests::rng::Rng::of(&row.path(group)).bits(),
            unit: row.unit,
            count: ((self.count as f64 * row.share) as u64).max(1),
            scalar: has("scalar"),
            packets: PACKETS.into_iter().filter(|v| has(v.name())).collect(),
            wgsl: has("wgsl"),
            most_in_wgsl: self.count_wgsl,
            f64: has("f64"),
        }
    }
}

/// A positive whole number, with or without an exponent.
fn count(text: &str) -> Result<u64, String> {
    match text.parse::<f64>() {
        Ok(n) if (1.0..=1e12).contains(&n) && n.fract() == 0.0 => Ok(n as u64),
        _ => Err("write a whole number from 1 to 1e12, as in 1e8".to_owned()),
    }
}
