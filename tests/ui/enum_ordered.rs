use raydsl::kernel;
use raydsl::prelude::*;

#[derive(Clone, Copy, PartialEq, PartialOrd, Type)]
enum Level {
    Low(f32),
    High(f32),
}

#[kernel]
fn is_lower(a: Level, b: Level) -> bool {
    if a < b { true } else { false } //~ lifted
}

fn main() {}
