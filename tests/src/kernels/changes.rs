//! `&mut` parameters and receivers.

use raydsl::kernel;
use raydsl::prelude::*;

/// A small generator of random numbers (PCG, O'Neill 2014, with 32 bits of state).
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct Pcg {
    pub state: u32,
}

#[kernel]
impl Pcg {
    pub fn seeded(seed: u32) -> Self {
        Self { state: seed.wrapping_mul(747_796_405).wrapping_add(1) }
    }

    pub fn bits(&mut self) -> u32 {
        let old = self.state;
        self.state = old.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
        let word = ((old >> ((old >> 28) + 4)) ^ old).wrapping_mul(277_803_737);
        (word >> 22) ^ word
    }

    pub fn unit(&mut self) -> f32 {
        (self.bits() >> 8) as f32 / 16_777_216.0
    }

    pub fn skip(&mut self, n: u32) {
        for _ in 0..n {
            self.bits();
        }
    }
}

/// A state with parts that change by themselves.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct Walk {
    pub rng: Pcg,
    pub at: Vec2,
    pub counts: [u32; 2],
}

#[kernel]
impl Walk {
    pub fn step(&mut self, length: f32) -> bool {
        let x = self.rng.unit() - 0.5;
        self.at.x += x * length;
        add(&mut self.at.y, self.rng.unit() - 0.5);
        bump(&mut self.counts[0]);
        if x > 0.25 {
            bump(&mut self.counts[1]);
            return true;
        }
        false
    }
}

#[kernel]
pub fn add(x: &mut f32, y: f32) {
    *x += y;
}

#[kernel]
pub fn bump(n: &mut u32) -> u32 {
    if *n > 5 {
        *n = 0;
        return 100;
    }
    *n += 1;
    *n
}

/// Hands its own `&mut` on.
#[kernel]
pub fn bump_twice(n: &mut u32, limit: u32) -> u32 {
    let mut sum = bump(n);
    if sum < limit {
        sum += bump(n);
    }
    sum + *n
}

#[kernel]
pub fn exchange(a: &mut f32, b: &mut f32) {
    let old = *a;
    *a = *b;
    *b = old;
}

/// Leaves early, binds its parameter's name anew, and has no result.
#[kernel]
pub fn settle(x: &mut f32, limit: f32) {
    for i in 0u32..4 {
        if *x < limit {
            return;
        }
        *x *= 0.5;
        if i == 2 {
            let x = limit * 2.0;
            if x > 3.0 {
                return;
            }
        }
    }
    *x -= 1.0;
}

#[kernel]
pub fn random_sum(seed: u32, n: u32) -> f32 {
    let mut rng = Pcg::seeded(seed);
    let mut sum = 0.0;
    for i in 0..n {
        if i % 3 == 1 {
            continue;
        }
        if sum > 3.0 && rng.unit() < 0.5 {
            rng.skip(i);
            break;
        }
        sum += rng.unit();
    }
    sum + rng.unit()
}

#[kernel]
pub fn random_walk(walk: Walk, n: u32) -> Walk {
    let mut w = walk;
    for _ in 0..n {
        if w.step(2.0) {
            w.rng.skip(1);
        }
    }
    w.counts[1] += w.rng.bits() & 3;
    w
}

#[kernel]
pub fn changed_arguments(x: f32, y: f32, n: u32) -> f32 {
    let mut pair = (x, y);
    let (mut a, mut count) = (x * 2.0, n);
    if x < y {
        exchange(&mut pair.0, &mut a);
    }
    let first = bump_twice(&mut count, 7);
    add(&mut pair.1, first as f32);
    settle(&mut a, y);
    settle(&mut pair.0, 1.5);
    pair.0 - pair.1 * a + count as f32
}
