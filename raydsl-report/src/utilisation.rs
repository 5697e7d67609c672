//! SIMD utilisation: running lanes of packets, line by line.

use core::fmt;
use std::collections::HashMap;
use std::path::Path;

use raydsl::kernel::CountedKernel;
use raydsl::machine::{Count, Place, Type};

/// The running lanes at each arm of an `if`, in each iteration of a loop, and in traversals of
/// trees.
///
/// `Display` prints a table with the lines of the source, where their file is found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Utilisation {
    /// The kernel's name.
    pub kernel: &'static str,
    /// The number of lanes in a packet.
    pub lanes: usize,
    /// The number of packets that ran.
    pub packets: u64,
    /// The places that packets passed, ordered by file and line.
    pub lines: Vec<LineCount>,
}

/// The counts at one place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LineCount {
    /// The place. The file is empty for traversals of trees, which are not lines of the user's.
    pub place: Place,
    /// The number of packets that passed.
    pub rounds: u64,
    /// The number of running lanes, summed over the rounds.
    pub lanes: u64,
}

impl LineCount {
    /// Returns the mean number of running lanes.
    pub fn mean_lanes(&self) -> f64 {
        self.lanes as f64 / self.rounds.max(1) as f64
    }
}

impl Utilisation {
    /// Returns the share of a packet's lanes that ran at a place, from 0 to 1.
    pub fn share(&self, line: &LineCount) -> f64 {
        line.mean_lanes() / self.lanes as f64
    }
}

/// Runs a kernel over `inputs` in packets of 8 lanes, and counts the running lanes.
///
/// Packets cost as much with few running lanes as with all: rays diverge there. Inputs are put into
/// packets in order, so group them as the program would. Calls of other kernels count at the lines
/// of those kernels.
///
/// It is slow, and needs a copy of the kernel that counts, which is compiled only on request:
/// `kernel!(counted |ray: Ray| ..)`, or [`Kernel::counted_of`](raydsl::kernel::Kernel::counted_of).
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl_report::utilisation;
///
/// let kernel = kernel!(counted |n: u32| {
///     let mut sum = 0u32;
///     for i in 0..n {
///         sum += i;
///     }
///     sum
/// });
/// let inputs: Vec<(u32,)> = (0..8).map(|n| (n,)).collect();
/// let found = utilisation(&kernel, &inputs);
/// println!("{found}");
/// // One packet, seven rounds: 7 lanes run in the first one, 1 in the last.
/// let line = &found.lines[0];
/// assert_eq!((line.place.what, line.rounds, line.lanes), ("loop", 7, 28));
/// assert_eq!(line.mean_lanes(), 4.0);
/// ```
pub fn utilisation<A: Type, R: Type>(
    kernel: &CountedKernel<'_, A, R>,
    inputs: &[A],
) -> Utilisation {
    let lanes = CountedKernel::<A, R>::LANES;
    let line = |(place, count): (Place, Count)| LineCount {
        place,
        rounds: count.rounds,
        lanes: count.lanes,
    };
    Utilisation {
        kernel: kernel.info().name,
        lanes,
        packets: inputs.len().div_ceil(lanes) as u64,
        lines: kernel.count(inputs).into_iter().map(line).collect(),
    }
}

impl fmt::Display for Utilisation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "`{}`: {} packets of {} lanes", self.kernel, self.packets, self.lanes)?;
        let mut sources = Sources::default();
        let mut file = None;
        for line in &self.lines {
            let at = line.place;
            if file != Some(at.file) {
                file = Some(at.file);
                let name = if at.file.is_empty() { "in the library" } else { at.file };
                writeln!(
                    f,
                    "{name}\n{:>5} {:>4} {:>10} {:>5} {:>4}",
                    "line", "", "rounds", "lanes", "%"
                )?;
            }
            let (mean, percent) = (line.mean_lanes(), 100.0 * self.share(line));
            if at.file.is_empty() {
                let row =
                    format!("{:>5} {:>4} {:>10} {mean:>5.2} {percent:>4.0}", "", "", line.rounds);
                writeln!(f, "{row}  {}", at.what)?;
                continue;
            }
            let text = shortened(sources.line(at.file, at.line));
            let row = format!(
                "{:>5} {:>4} {:>10} {mean:>5.2} {percent:>4.0}",
                at.line, at.what, line.rounds
            );
            writeln!(f, "{}", format!("{row}  {text}").trim_end())?;
        }
        Ok(())
    }
}

/// Returns the part of a line that fits in a table of 100 columns.
fn shortened(line: &str) -> String {
    const ROOM: usize = 66;
    let line = line.trim_end();
    if line.chars().count() <= ROOM {
        return line.to_owned();
    }
    line.chars().take(ROOM - 3).chain("...".chars()).collect()
}

/// Source files by name, each read once.
#[derive(Default)]
struct Sources(HashMap<&'static str, Vec<String>>);

impl Sources {
    /// Returns a line of a file; empty if the file is not found.
    fn line(&mut self, file: &'static str, line: u32) -> &str {
        let lines = self.0.entry(file).or_insert_with(|| read(Path::new(file)));
        (line as usize).checked_sub(1).and_then(|i| lines.get(i)).map_or("", String::as_str)
    }
}

/// Returns the lines of a file, given relative to the working directory or to a folder around it:
/// tests run in their package, but names start at the workspace.
fn read(file: &Path) -> Vec<String> {
    let here = std::env::current_dir().unwrap_or_default();
    let text = here.ancestors().find_map(|folder| std::fs::read_to_string(folder.join(file)).ok());
    text.unwrap_or_default().lines().map(str::to_owned).collect()
}
