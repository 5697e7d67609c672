//! Frame times of the viewer at 960 x 540: while the camera moves, and until it is sharp again.
//!
//! `cargo run --release -p raydsl-viewer --example frame_times -- [FILE ...]` prints a table;
//! without a file it takes 2 million points and a head.

use std::time::{Duration, Instant};

use raydsl::prelude::*;
use raydsl_viewer::{Action, Config, Device, Mode, Session};

const SIZE: (u32, u32) = (960, 540);
/// The time between two steps of the camera.
const STEP: Duration = Duration::from_millis(16);
/// How long the camera moves.
const MOVES: Duration = Duration::from_secs(3);

/// Waits until something holds; says whether it ever did.
fn until(session: &mut Session, seconds: f32, holds: impl Fn(&Session) -> bool) -> bool {
    let start = Instant::now();
    while start.elapsed().as_secs_f32() < seconds {
        session.poll();
        if holds(session) {
            return true;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    false
}

/// What was seen while the camera moved, and then.
struct Row {
    pictures: usize,
    /// The pictures' median size.
    size: (u32, u32),
    longest_call: Duration,
    sharp: Option<Duration>,
    /// Kernels that were recorded, printed and compiled meanwhile.
    made: u64,
}

fn measure(session: &mut Session) -> Row {
    // What is compiled once is not counted, nor is the first guess of the speed.
    until(session, 60.0, |session| session.has(1));
    let (mut sizes, mut longest_call) = (Vec::new(), Duration::ZERO);
    let made = |session: &Session| session.device().counts().map_or(0, |c| c.iter().sum::<u64>());
    let before = made(session);
    let start = Instant::now();
    while start.elapsed() < MOVES {
        let call = Instant::now();
        session.apply(&Action::Orbit(1.0, 0.0)).expect("a camera turns");
        let before = session.frame().cloned();
        session.poll();
        let frame = session.frame().expect("there was one");
        if before.is_none_or(|before| !std::sync::Arc::ptr_eq(&before, frame)) {
            sizes.push(frame.size);
        }
        longest_call = longest_call.max(call.elapsed());
        std::thread::sleep(STEP.saturating_sub(call.elapsed()));
    }
    let rest = Instant::now();
    let is_sharp = until(session, 20.0, |session| session.has(1));
    sizes.sort_unstable();
    let size = sizes.get(sizes.len() / 2).copied().unwrap_or((0, 0));
    let sharp = is_sharp.then(|| rest.elapsed());
    Row { pictures: sizes.len(), size, longest_call, sharp, made: made(session) - before }
}

fn main() -> Result<(), String> {
    let mut files: Vec<String> = std::env::args().skip(1).collect();
    if files.is_empty() {
        files = ["landscape:2000000", "head:192"].map(str::to_owned).to_vec();
    }
    println!(
        "| data | mode | variant | pictures/s | their size | sharp after ms | call ms | made |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for file in files {
        let mut session = Session::new(Config::interactive("out"), Device::default(), || {});
        session.apply(&Action::Size(SIZE.0, SIZE.1))?;
        session.apply(&Action::Open(file.clone().into()))?;
        if !until(&mut session, 120.0, |s| s.info().is_some() || s.errors() > 0) {
            return Err(format!("{file} takes too long"));
        }
        let Some(info) = session.info().cloned() else { return Err(session.log().join("\n")) };
        for mode in Mode::of(info.kind) {
            for variant in [Variant::widest(), Variant::Wgsl] {
                session.apply(&Action::Mode(*mode))?;
                session.apply(&Action::Variant(variant))?;
                let row = measure(&mut session);
                let rate = row.pictures as f64 / MOVES.as_secs_f64();
                let sharp = row.sharp.map_or("-".to_owned(), |t| format!("{}", t.as_millis()));
                let call = row.longest_call.as_secs_f64() * 1e3;
                let (name, (w, h), made) = (&info.name, row.size, row.made);
                let (mode, variant) = (mode.name(), variant.name());
                let what = format!("| {name} | {mode} | {variant} | {rate:.1} | {w} x {h}");
                println!("{what} | {sharp} | {call:.1} | {made} |");
            }
        }
        session.close();
    }
    Ok(())
}
