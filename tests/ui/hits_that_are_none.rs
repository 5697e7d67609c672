use raydsl::kernel;
use raydsl::prelude::*;

#[derive(Clone, Copy, Type)]
struct Counter {
    count: u32,
}

#[kernel]
impl Counter {
    fn hits(self, ray: Ray) -> [f32; 2] {
        [ray.t_min, self.count as f32]
    }
}

#[kernel]
fn shade(counter: Counter, ray: Ray) -> f32 {
    let mut sum = 0.0;
    for t in counter.hits(ray) { //~ lifted
        sum += t;
    }
    sum
}

fn main() {}
