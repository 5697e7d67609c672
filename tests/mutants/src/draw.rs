//! The draw: so many sites of each room, by a seed.

use std::collections::BTreeSet;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::rooms::{ROOMS, Room};
use crate::site::{Site, sites};

/// A mutant; its number is its place in the list.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Mutant {
    pub(crate) room: String,
    #[serde(flatten)]
    pub(crate) site: Site,
}

/// SplitMix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    }

    fn shuffle<T>(&mut self, items: &mut [T]) {
        for i in (1..items.len()).rev() {
            items.swap(i, (self.next() % (i as u64 + 1)) as usize);
        }
    }
}

/// Returns the Rust files of a room, without those of tests.
fn files(source: &Path, room: &Room) -> Vec<String> {
    let mut found = Vec::new();
    let mut rest: Vec<_> = room.sources.iter().map(|s| source.join(s)).collect();
    while let Some(path) = rest.pop() {
        if path.file_stem().is_some_and(|n| n == "tests") {
            continue;
        }
        if path.is_dir() {
            let entries = path.read_dir().expect("a folder of sources");
            rest.extend(entries.map(|e| e.expect("an entry of a folder").path()));
        } else if path.extension().is_some_and(|e| e == "rs") {
            let below = path.strip_prefix(source).expect("a file below the sources");
            found.push(below.to_str().expect("a name in UTF-8").to_owned());
        }
    }
    found.sort();
    found
}

/// Returns the sites of each room, in the order of files and lines.
pub(crate) fn all(source: &Path) -> Vec<(&'static Room, Vec<Site>)> {
    let of_file = |file: &String| {
        let text = std::fs::read_to_string(source.join(file)).expect("a source file");
        sites(file, &text).unwrap_or_else(|e| panic!("{file}: {e}"))
    };
    ROOMS
        .iter()
        .map(|room| (room, files(source, room).iter().flat_map(of_file).collect()))
        .collect()
}

/// Draws the mutants: each room's share, without those that rustc refused, in an order in which the
/// first few are a fair sample too. The draw of a room is the beginning of one permutation, so a refused
/// mutant changes no other.
pub(crate) fn draw(
    source: &Path,
    seed: u64,
    count: usize,
    refused: &BTreeSet<Site>,
) -> Vec<Mutant> {
    let shares: usize = ROOMS.iter().map(|r| r.share).sum();
    let mut drawn = Vec::new();
    for (i, (room, mut sites)) in all(source).into_iter().enumerate() {
        Random(seed ^ (i as u64 + 1) << 32).shuffle(&mut sites);
        let share = (count * room.share).div_ceil(shares);
        let viable = sites.into_iter().filter(|s| !refused.contains(s)).take(share);
        drawn.extend(viable.map(|site| Mutant { room: room.name.to_owned(), site }));
    }
    Random(seed).shuffle(&mut drawn);
    drawn.truncate(count);
    drawn
}
