//! The tables of a campaign.

use crate::build::mutants;
use crate::campaign::{Fate, verdicts};
use crate::folder::Folder;
use crate::rooms::ROOMS;

/// Prints how many mutants of each room were killed and by what, and those that were not.
pub(crate) fn print(folder: &Folder) {
    let (mutants, verdicts) = (mutants(folder), verdicts(folder));
    let count = |room: Option<&str>, fates: &[Fate]| {
        let of_room = |i: usize| room.is_none_or(|room| mutants[i].room == room);
        verdicts.values().filter(|v| of_room(v.mutant) && fates.contains(&v.fate)).count()
    };
    println!("| room | mutants | a test fails | too slow | ended | survive | not reached |");
    println!("|---|---|---|---|---|---|---|");
    let fates = [Fate::Failed, Fate::Late, Fate::Crashed, Fate::Survived, Fate::Unreached];
    let rooms = ROOMS.iter().map(|r| Some(r.name)).chain([None]);
    for room in rooms {
        let cells: Vec<String> = [count(room, &fates)]
            .into_iter()
            .chain(fates.iter().map(|f| count(room, &[*f])))
            .map(|n| n.to_string())
            .collect();
        println!("| {} | {} |", room.unwrap_or("all"), cells.join(" | "));
    }
    println!();
    for v in verdicts.values().filter(|v| v.is_alive()) {
        let site = &mutants[v.mutant].site;
        let what = if v.fate == Fate::Survived {
            format!("{} tests", v.tests)
        } else {
            "not reached".into()
        };
        println!("| {} | `{}:{}` | {} | {what} |", v.mutant, site.file, site.line, site.change);
    }
}
