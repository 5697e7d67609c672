//! Kernels whose variants once differed, or that once did not compile.

use raydsl::kernel;
use raydsl::prelude::*;

#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct Couple {
    pub x: f32,
    pub y: f32,
}

#[kernel]
impl Couple {
    pub fn step(&mut self) -> f32 {
        self.x += 1.0;
        self.x
    }

    /// Not the dot product of a vector: it has an effect.
    pub fn dot(&mut self) -> f32 {
        self.x += 10.0;
        self.y
    }

    /// The name of a function that it calls.
    pub fn length(&self) -> f32 {
        length(vec2(self.x, self.y))
    }
}

/// Names of a tuple that the patterns bind anew, in another order.
#[kernel]
pub fn permuted_names(a: f32, b: f32, n: u32) -> f32 {
    let first = match (a, b) {
        (b, a) if b > a => a * 10.0 + b,
        (x, a) => x - a,
    };
    let (t, u) = (n % 3, n % 5);
    let second = match ((t, u), n % 2) {
        ((u, t), 0) => u * 10 + t,
        ((u, t), _) => u + t * 10,
    };
    let p = Couple { x: a, y: b };
    let third = match p {
        Couple { x: p, y } if p > y => p,
        Couple { x, .. } => x * 0.5,
    };
    first + second as f32 + third
}

#[kernel]
pub fn swapped_by_assignment(a: f32, b: f32) -> f32 {
    let (mut x, mut y) = (a, b);
    let mut p = Couple { x: 1.0, y: 2.0 };
    (x, y) = (y, x);
    (p.x, _, p.y) = (x, 0.0, p.x);
    x * 2.0 - y + p.x + p.y
}

#[kernel]
pub fn changed_counters(a: f32, n: u32) -> u32 {
    let mut sum = 0u32;
    for mut i in 0..n % 20 {
        i *= 3;
        if a > 0.0 {
            i += 1;
        }
        sum += i;
    }
    sum
}

#[kernel]
pub fn add_to(x: f32, to: &mut f32) -> f32 {
    *to += x;
    // Not a product: a device may take a factor out of two of them.
    to.max(x)
}

/// What stands before a part that goes by `&mut` is evaluated before it.
#[kernel]
pub fn arguments_in_order(a: f32, b: f32) -> f32 {
    let mut s = Couple { x: a, y: b };
    let r = add_to(s.step(), &mut s.x);
    let mut t = Couple { x: b, y: a };
    let q = add_to(t.step() + s.step(), &mut t.y);
    r + q + s.x * 3.0 + t.y
}

/// Names of cheap operations on functions that are not.
pub mod own {
    use raydsl::kernel;

    #[kernel]
    pub fn clamp(n: u32) -> u32 {
        let mut k = n;
        let mut steps = 0u32;
        while k != 1 {
            k = if k % 2 == 0 { k / 2 } else { k * 3 + 1 };
            steps += 1;
        }
        steps
    }
}

#[kernel]
pub fn effects_in_arms(a: f32, n: u32) -> f32 {
    use own::clamp;
    let mut s = Couple { x: a, y: 1.0 };
    let r = if a > 2.0 { s.dot() } else { 0.0 };
    let steps = if n % 50 > 0 { clamp(n % 50) } else { 0 };
    let mut sum = r + s.x + steps as f32 + s.length();
    if a < 0.0 {
        sum += s.dot();
    }
    sum + s.x
}

/// Bare integers in inner choices.
#[kernel]
pub fn bare_integers(a: f32, n: u32) -> u32 {
    let inner = if a > 0.0 {
        match n % 4 {
            0 => 1,
            1 => 2,
            _ => 3,
        }
    } else {
        n / 3
    };
    let (x, k) = if a > 1.0 { (a, 1u32) } else { (-a, 2) };
    if x > 50.0 {
        return match n {
            0 => 7,
            _ => 8,
        };
    }
    let counts = [if n > 9 { 1 } else { 2 }, k];
    let last: u32 = if a > 1.0 {
        if a > 3.0 { 1 } else { inner }
    } else {
        counts[(x.abs() * 0.01) as usize % 2]
    };
    last
}

#[kernel]
pub fn trailing_points(a: f32) -> f32 {
    a * 2. + 1_000.
}

/// Variables with the names of the generated code's.
#[kernel]
pub fn names_of_generated_code(a: f32, b: f32) -> f32 {
    let mut result = Couple { x: a, y: b };
    let x = result.step();
    let mut part = [x, b];
    let old = add_to(1.0, &mut part[1]);
    let whole = add_to(old, &mut result.y);
    let m = 2.0;
    let right = m + whole;
    part[0] += right;
    result.x + part[0] + part[1]
}

#[kernel]
pub trait Lucky {
    fn number() -> f32;
}

#[kernel]
impl Lucky for Couple {
    fn number() -> f32 {
        7.0
    }
}

/// A type parameter that no argument has.
#[kernel]
pub fn lucky<T: Lucky>(x: f32) -> f32 {
    T::number() * x
}

#[kernel]
pub fn named_type_parameters(x: f32) -> f32 {
    lucky::<Couple>(x) + <Couple as Lucky>::number()
}

/// A loop over an array runs over a copy of it.
#[kernel]
pub fn changed_while_read(a: f32, n: u32) -> f32 {
    let mut list = [a, 1.0, 2.0, 3.0];
    let mut sum = 0.0;
    for v in list {
        sum += v;
        list[(n % 4) as usize] = sum;
    }
    'outer: for v in [a, sum] {
        for w in list {
            if w > v {
                continue 'outer;
            }
            sum += 1.0;
        }
    }
    sum
}

/// A truth value that is known before the kernel runs, as an index.
#[kernel]
pub fn known_truths(a: f32, n: u32) -> f32 {
    let weights = [a, 2.0, 3.0];
    weights[true as usize + (n > 3) as usize] + weights[false as usize]
}
