use raydsl::kernel;
use raydsl::prelude::*;

use core::ops::Add;

#[derive(Clone, Copy, Type)]
struct Spectrum {
    red: f32,
}

impl Add for Spectrum {
    type Output = Spectrum;

    fn add(self, o: Spectrum) -> Spectrum {
        Spectrum { red: self.red + o.red }
    }
}

#[kernel]
fn twice(red: f32) -> f32 {
    let s = Spectrum { red };
    (s + s).red //~ lifted
}

fn main() {}
