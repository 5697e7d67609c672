use raydsl::kernel;
use raydsl::prelude::*;

#[primitive]
struct Disk; //~ macro

fn main() {}
