//! What the library's queries do in trees with copies: boxes and primitives, not seconds.

use raydsl::bvh::Counts;
use raydsl::prelude::*;

use crate::own::{self, Tree};
use crate::rays::Workload;
use crate::row::Row;
use crate::{rounds, table};

/// Runs each wanted row once, with the widest packets and with single rays, and prints the counts
/// per ray.
pub(crate) fn print(name: &str, trees: &[Tree<'_>], work: &Workload, only: &[Row]) {
    println!("{name}: counts a ray; of boxes and primitives against registers of rays, a register");
    println!(
        "  {:<20}{:>8}{:>7}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}",
        "", "in", "rays a", "beams'", "beams'", "boxes", "prims", "own", "own", "nearer"
    );
    println!(
        "  {:<20}{:>8}{:>7}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}",
        "row", "beams", "beam", "nodes", "blocks", "x reg.", "x reg.", "nodes", "blocks", "hits"
    );
    let widest = format!("{} wide", Variant::widest().name());
    for mut contender in own::contenders(trees, work, 1, None) {
        let is_single = contender.row == Row::SingleClosest && contender.mode == "scalar wide";
        let is_compared = Row::COMPARED.contains(&contender.row);
        let is_packet =
            is_compared && contender.row != Row::SingleClosest && contender.mode == widest;
        if !table::is_wanted(only, contender.row) || !(is_single || is_packet) {
            continue;
        }
        let _ = Counts::take();
        (contender.run)();
        let counts = Counts::take();
        print_row(contender.row, counts, rounds::rays(contender.row, work) as f64);
    }
    println!();
}

fn print_row(row: Row, c: Counts, rays: f64) {
    let a_ray = |count: u64| count as f64 / rays;
    let in_beams = 100.0 * a_ray(c.beam_rays);
    let a_beam = c.beam_rays as f64 / c.beams.max(1) as f64;
    print!("  {:<20}{in_beams:>7.0}%{a_beam:>7.1}", row.name());
    let counts = [
        c.beam_nodes,
        c.beam_blocks,
        c.register_boxes,
        c.register_primitives,
        c.nodes,
        c.blocks,
        c.nearer,
    ];
    for count in counts {
        print!("{:>8.3}", a_ray(count));
    }
    println!();
}
