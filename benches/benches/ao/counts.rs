//! What the library's queries do in trees with copies: boxes and primitives, not seconds.

use raydsl::bvh::{Cost, Counts, Node};
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
    print_on_device(trees, work, only);
    println!();
}

/// Prints what rays read on a device, each for itself, in binary and in wide trees.
fn print_on_device(trees: &[Tree<'_>], work: &Workload, only: &[Row]) {
    println!("  a ray on a device reads{:>28}{:>8}{:>8}", "nodes", "prims", "bytes");
    let is_wanted = |row: &Row| table::is_wanted(only, *row);
    for row in [Row::Primary, Row::AoShort, Row::Bounce].into_iter().filter(is_wanted) {
        let short = |ray: &Ray| ray.with_range(ray.t_min, work.short);
        let (rays, is_any): (Vec<Ray>, _) = match row {
            Row::Primary => (work.primary.clone(), false),
            Row::AoShort => (work.shadow.iter().map(short).collect(), true),
            _ => (work.shadow.clone(), false),
        };
        for tree in trees {
            let bvh = &tree.bvh;
            let binary = rays.iter().map(|ray| match is_any {
                true => bvh.any_hit_with_cost(*ray).1,
                false => bvh.closest_hit_with_cost(*ray).1,
            });
            // Each primitive is found through its id.
            let triangle = size_of::<Triangle>() as u64;
            let binary = sum(binary, size_of::<Node>() as u64, triangle + 4);
            print_counts(row, &format!("{} binary", tree.name()), binary, rays.len());
            let wide = rays.iter().filter_map(|ray| bvh.hit_on_device(*ray, is_any));
            let wide = sum(wide.map(|found| found.1), WIDE_NODE, triangle);
            if bvh.is_wide() {
                print_counts(row, &tree.name(), wide, rays.len());
            }
        }
    }
}

/// Bytes of a wide tree's node on a device.
const WIDE_NODE: u64 = 80;

/// Returns the sums of nodes, of primitives and of bytes.
fn sum(costs: impl Iterator<Item = Cost>, of_node: u64, of_primitive: u64) -> [u64; 3] {
    costs.fold([0; 3], |[nodes, prims, bytes], cost| {
        let (n, p) = (u64::from(cost.nodes), u64::from(cost.primitives));
        [nodes + n, prims + p, bytes + n * of_node + p * of_primitive]
    })
}

fn print_counts(row: Row, tree: &str, counts: [u64; 3], rays: usize) {
    let [nodes, primitives, bytes] = counts.map(|count| count as f64 / rays as f64);
    println!("  {:<20}{tree:<24}{nodes:>8.1}{primitives:>8.1}{bytes:>8.0}", row.name());
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
