//! How many lanes run where: counted against what the source does.

#![allow(clippy::manual_is_multiple_of, reason = "what kernels are written in")]

use raydsl::prelude::*;
use raydsl_report::{Utilisation, utilisation};

// ANCHOR: kernel
/// How many steps a number takes to 1, by Collatz' rule.
#[raydsl::kernel]
fn steps(n: u32) -> u32 {
    let mut x = n;
    let mut count = 0u32;
    while x > 1 {
        if x % 2 == 0 {
            x /= 2;
        } else {
            x = 3 * x + 1;
        }
        count += 1;
    }
    count
}
// ANCHOR_END: kernel

const LANES: usize = 8;

/// The even and the odd numbers on the way.
fn even_and_odd(n: u32) -> [u64; 2] {
    let mut counts = [0; 2];
    let mut x = n;
    while x > 1 {
        counts[x as usize % 2] += 1;
        x = if x % 2 == 0 { x / 2 } else { 3 * x + 1 };
    }
    counts
}

fn find(found: &Utilisation, what: &str) -> Result<(u32, u64, u64), String> {
    let mut lines = found.lines.iter().filter(|l| l.place.what == what);
    let line = lines.next().ok_or_else(|| format!("no {what} in\n{found}"))?;
    assert!(lines.next().is_none(), "{what} twice in\n{found}");
    Ok((line.place.line, line.rounds, line.lanes))
}

#[test]
fn arms_and_rounds_are_counted() -> Result<(), String> {
    let numbers: Vec<u32> = (1..=100).collect();
    let inputs: Vec<(u32,)> = numbers.iter().map(|n| (*n,)).collect();
    let found = utilisation(&Kernel::counted_of::<steps>(), &inputs);
    println!("{found}");
    assert_eq!((found.kernel, found.lanes, found.packets), ("steps", LANES, 13));

    let lanes =
        numbers.iter().map(|n| even_and_odd(*n)).fold([0, 0], |[a, b], [c, d]| [a + c, b + d]);
    let rounds: u32 =
        numbers.chunks(LANES).map(|p| p.iter().map(|n| steps(*n)).max().unwrap_or(0)).sum();
    let (while_line, loop_rounds, loop_lanes) = find(&found, "loop")?;
    assert_eq!((loop_rounds, loop_lanes), (u64::from(rounds), lanes[0] + lanes[1]));
    let (if_line, if_rounds, if_lanes) = find(&found, "if")?;
    let (else_line, else_rounds, else_lanes) = find(&found, "else")?;
    assert_eq!([if_lanes, else_lanes], lanes);
    assert!(if_rounds <= loop_rounds && else_rounds <= loop_rounds);
    assert_eq!((if_line, else_line), (while_line + 1, while_line + 3));
    Ok(())
}

#[test]
fn the_table_shows_the_source() {
    let inputs: Vec<(u32,)> = (1..=100).map(|n| (n,)).collect();
    let table = utilisation(&Kernel::counted_of::<steps>(), &inputs).to_string();
    assert!(table.contains("`steps`: 13 packets of 8 lanes"), "{table}");
    assert!(table.contains("tests/tests/utilisation.rs"), "{table}");
    let row = table.lines().find(|l| l.contains(" loop ")).unwrap_or_default();
    assert!(row.ends_with("    while x > 1 {"), "{table}");
    assert!(table.lines().all(|l| l.chars().count() <= 100), "{table}");
}

/// A closure and its tree; the walk is the library's, and has no line.
#[test]
fn walks_of_trees_are_counted() -> Result<(), Box<dyn std::error::Error>> {
    let prims = raydsl_tests::scenes::triangles(500);
    let bvh = Bvh::build(&prims)?;
    let kernel = kernel!(counted |ray: Ray| {
        let hit = bvh.closest_hit(ray);
        if hit.is_hit { 1.0 / (1.0 + hit.t) } else { -1.0 }
    });
    let rays: Vec<(Ray,)> =
        raydsl_tests::scenes::random_rays(3, 1000).into_iter().map(|r| (r,)).collect();
    let hits = rays.iter().filter(|(r,)| kernel.call((*r,)) >= 0.0).count();
    let found = utilisation(&kernel, &rays);
    println!("{found}");
    let (_, nodes, lanes) = find(&found, "nodes of trees")?;
    assert!(nodes > 125 && lanes > nodes && lanes < nodes * LANES as u64, "{found}");
    let here = |what: &str| {
        let mine = found.lines.iter().filter(|l| l.place.file == file!());
        mine.filter(|l| l.place.what == what).map(|l| l.lanes).sum::<u64>()
    };
    assert_eq!([here("if"), here("else")], [hits as u64, 1000 - hits as u64], "{found}");
    Ok(())
}

/// Other threads and other packets are not counted.
#[test]
fn only_the_own_runs_count() {
    let inputs: Vec<(u32,)> = (1..=100).map(|n| (n,)).collect();
    let kernel = Kernel::counted_of::<steps>();
    let alone = utilisation(&kernel, &inputs);
    std::thread::scope(|scope| {
        scope.spawn(|| (0..100).for_each(|_| assert_eq!(utilisation(&kernel, &inputs), alone)));
        let mut found = vec![0; inputs.len()];
        (0..100).for_each(|_| kernel.run(Variant::Packet8, &inputs, &mut found));
    });
}
