//! Ambient occlusion: camera rays, and eight shadow rays from what they meet, in the library's
//! kernels and in what others ask single rays or packets; the same rays in the same rounds.
//!
//! (The workload of Zellmann and others' Visionaray: an image of 1024 by 1024 pixels, eight rays
//! with a density of the cosine, which end after a tenth of the scene's diagonal or never.)
//!
//! The library's kernels make rays while they ask. The other systems find theirs made, in the
//! cache and in their own layout, and are charged for the time that the library's widest packets
//! take to make them.

mod contender;
#[cfg(feature = "counts")]
mod counts;
mod cwbvh;
mod embree;
mod own;
mod rays;
mod rounds;
mod row;
mod table;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use raydsl::prelude::*;
use raydsl_benches::clock::median;
use raydsl_benches::contest::{Cost, parse_size, parse_traversal};
use raydsl_benches::device;
use raydsl_benches::scenes::{self, Scene};
use raydsl_benches::table::{Line, finish, print};

use rays::Workload;
use rounds::Record;
use row::Row;

/// Measures primary, shadow and bounce rays beside Embree and obvhs.
#[derive(Parser)]
struct Args {
    /// Writes the figures to this file.
    #[arg(long)]
    json: Option<PathBuf>,
    /// Only the scenes whose names contain one of these words; or a file, .tri, .obj or .ply.
    #[arg(long)]
    scene: Vec<String>,
    /// Numbers of threads, each measured on its own.
    #[arg(long, value_delimiter = ',', default_value = "1",
          value_parser = clap::value_parser!(u16).range(1..))]
    threads: Vec<u16>,
    /// Rounds; each builds every tree, if builds are wanted, and measures every mode of every row,
    /// once.
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u16).range(1..))]
    rounds: u16,
    /// Width and height of the film, a multiple of 16.
    #[arg(long, default_value = "1024", value_parser = parse_size)]
    size: u32,
    /// Only these rows.
    #[arg(long, value_delimiter = ',', value_parser = Row::from_name)]
    only: Vec<Row>,
    /// How rays go through trees with copies; each is a mode of its own.
    #[arg(long, value_delimiter = ',', default_value = "auto", value_parser = parse_traversal)]
    traversal: Vec<Traversal>,
    /// Measures WGSL, too, on this machine's device and by its clock.
    #[arg(long)]
    device: bool,
    /// Measures Embree with its robust flag, too, in a second column: the mode that promises what the
    /// library promises, that no ray is lost between triangles.
    #[arg(long)]
    robust: bool,
    /// Lets the device's driver fuse and move operations: what exactness costs.
    #[arg(long, requires = "device")]
    fused: bool,
    /// Counts the queries' work once, without measuring times; needs the feature `counts`.
    #[arg(long, conflicts_with_all = ["json", "threads", "rounds", "traversal"])]
    counts: bool,
    /// Cargo says so.
    #[arg(long, hide = true)]
    bench: bool,
}

fn main() -> ExitCode {
    let args = Args::parse();
    if args.counts {
        return count(&args);
    }
    let device = match device::open(args.device, args.fused) {
        Ok(device) => device,
        Err(error) => {
            eprintln!("ao: {error}");
            return ExitCode::FAILURE;
        }
    };
    let mut lines = Vec::new();
    for (name, scene) in all_scenes(&args.scene) {
        for threads in args.threads.iter().map(|&threads| threads.into()) {
            match &scene {
                Ok(scene) => lines.extend(measure(&args, &name, scene, threads, device.as_ref())),
                Err(_) => lines.extend(table::without_scene(&name, threads, &args.only)),
            }
        }
        if let Err(error) = scene {
            eprintln!("skipped {name}: {error}");
        }
    }
    finish(&lines, args.json.as_deref())
}

/// Counts what queries do, where that is compiled in.
#[cfg(not(feature = "counts"))]
fn count(_: &Args) -> ExitCode {
    eprintln!("--counts needs the feature: `cargo bench -p raydsl-benches --features counts ...`");
    ExitCode::FAILURE
}

#[cfg(feature = "counts")]
fn count(args: &Args) -> ExitCode {
    let mut done = ExitCode::FAILURE;
    for (name, scene) in all_scenes(&args.scene) {
        match scene {
            Ok(scene) => {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
                pool.expect("a thread can be started").install(|| {
                    let trees = own::trees(&scene.prims, 1, &[Traversal::Auto]);
                    let work = Workload::new(&trees[0].bvh, scene.camera, args.size);
                    counts::print(&name, &trees, &work, &args.only);
                });
                done = ExitCode::SUCCESS;
            }
            Err(error) => eprintln!("skipped {name}: {error}"),
        }
    }
    done
}

/// The scenes that words name, and those of files; or why one is not there.
fn all_scenes(words: &[String]) -> Vec<(String, Result<Scene<Triangle>, String>)> {
    let (files, words): (Vec<&String>, Vec<&String>) =
        words.iter().partition(|word| Path::new(word).extension().is_some());
    let is_wanted = |name: &str| {
        let is_named = words.iter().any(|word| name.contains(word.as_str()));
        is_named || words.is_empty() && files.is_empty()
    };
    let mut all = Vec::new();
    type Make = fn() -> Scene<Triangle>;
    let procedural = [("colonnade", scenes::colonnade as Make), ("grove", scenes::grove)];
    let wanted = procedural.into_iter().filter(|(name, _)| is_wanted(name));
    all.extend(wanted.map(|(name, make)| (name.to_owned(), Ok(make()))));
    let data = std::env::var_os("RAYDSL_DATA");
    for name in scenes::FILES.into_iter().filter(|name| is_wanted(name)) {
        let scene = match &data {
            Some(data) => scenes::file(data.as_ref(), name).map_err(|error| error.to_string()),
            None => Err("RAYDSL_DATA names no folder".to_owned()),
        };
        all.push((name.to_owned(), scene));
    }
    for file in files {
        let name = Path::new(file).file_stem().unwrap_or_default().to_string_lossy();
        let scene = scenes::mesh(file.as_ref()).map_err(|error| error.to_string());
        all.push((name.into_owned(), scene));
    }
    all
}

/// What all systems built.
struct Trees<'a> {
    own: Vec<own::Tree<'a>>,
    cwbvh: cwbvh::Tree,
    embree: Vec<embree::Tree<'a>>,
}

impl Trees<'_> {
    /// Builds every tree once a round. The last ones, with the medians of their times, and what the
    /// rounds gave; without rounds each tree is built once, and there are no records.
    fn of_rounds(rounds: usize, build: impl Fn() -> Self) -> (Self, Vec<Record>) {
        // The first round warms up.
        let mut trees = build();
        let mut seconds = vec![Vec::new(); trees.builds().len()];
        for _ in 0..rounds {
            drop(trees);
            trees = build();
            for (seconds, (.., cost)) in seconds.iter_mut().zip(trees.builds()) {
                seconds.push(1e-3 * cost.build_ms);
            }
        }
        let mut records = Vec::new();
        if rounds > 0 {
            for (seconds, (system, mode, cost)) in seconds.into_iter().zip(trees.builds()) {
                cost.build_ms = 1e3 * median(&seconds);
                records.push(Record::of_build(system, mode, *cost, seconds));
            }
        }
        (trees, records)
    }

    /// Whose each tree is, its name, and what it cost.
    fn builds(&mut self) -> Vec<(&'static str, String, &mut Cost)> {
        let own = self.own.iter_mut().map(|tree| ("raydsl", tree.name(), &mut tree.cost));
        let cwbvh = ("obvhs", "cwbvh".to_owned(), &mut self.cwbvh.cost);
        let embree = self.embree.iter_mut();
        let embree = embree.map(|tree| (tree.system, tree.name().to_owned(), &mut tree.cost));
        own.chain([cwbvh]).chain(embree).collect()
    }
}

/// Measures one scene on so many threads.
fn measure(
    args: &Args,
    name: &str,
    scene: &Scene<Triangle>,
    threads: usize,
    gpu: Option<&GpuScheduler>,
) -> Vec<Line> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.expect("threads can be started");
    pool.install(|| {
        let device = embree::Device::load(&scene.prims, threads);
        let build = || Trees {
            own: own::trees(&scene.prims, threads, &args.traversal),
            cwbvh: cwbvh::Tree::new(&scene.prims, threads),
            embree: device.as_ref().map_or_else(Vec::new, |device| device.trees(args.robust)),
        };
        let is_build_wanted = table::is_wanted(&args.only, Row::Build);
        let rounds = if is_build_wanted { args.rounds.into() } else { 0 };
        let (Trees { own, cwbvh, embree }, builds) = Trees::of_rounds(rounds, build);
        let work = Workload::new(&own[0].bvh, scene.camera, args.size);
        println!(
            "{name}: {} triangles, {} of {} camera rays meet something, threads: {threads}\n",
            scene.prims.len(),
            work.places.len(),
            work.primary.len()
        );
        let mut contenders = own::contenders(&own, &work, threads, gpu);
        contenders.extend(embree::contenders(&embree, &work, threads));
        contenders.extend(cwbvh::contenders(&cwbvh, &work, threads));
        let wanted = |row: Row| {
            Row::COMPARED
                .into_iter()
                .filter(|r| table::is_wanted(&args.only, *r))
                .any(|r| row.serves(r))
        };
        contenders.retain(|contender| wanted(contender.row));
        let mut records = rounds::run(&mut contenders, args.rounds.into());
        records.extend(builds);
        let lines = table::lines(name, threads, &work, &records, &args.only);
        print(&lines);
        if let Some(ratio) = rounds::frame_over_parts(&records) {
            println!("the frame's ratio over that of its parts: {ratio:.2}\n");
        }
        lines
    })
}
