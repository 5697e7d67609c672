use raydsl::kernel;
use raydsl::prelude::*;

use core::ops::Add;

#[derive(Clone, Copy, Type)]
struct Spectrum {
    red: f32,
}

#[kernel]
impl Add<&Spectrum> for Spectrum { //~ macro
    type Output = Spectrum;

    fn add(self, o: &Spectrum) -> Spectrum {
        Spectrum { red: self.red + o.red }
    }
}

fn main() {}
