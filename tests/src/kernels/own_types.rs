//! Types of the user's own: operators, methods with names that numbers have, traits that share
//! names.

use core::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub};

use raydsl::kernel;
use raydsl::prelude::*;

/// A number and its derivative.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct Dual {
    pub x: f32,
    pub dx: f32,
}

#[kernel]
impl Add for Dual {
    type Output = Dual;

    fn add(self, o: Dual) -> Dual {
        Dual { x: self.x + o.x, dx: self.dx + o.dx }
    }
}

#[kernel]
impl Sub for Dual {
    type Output = Self;

    fn sub(self, o: Self) -> Self::Output {
        Self { x: self.x - o.x, dx: self.dx - o.dx }
    }
}

#[kernel]
impl Mul for Dual {
    type Output = Dual;

    fn mul(self, o: Self) -> Self {
        if o.x == 0.0 {
            return Self { x: 0.0, dx: self.x * o.dx };
        }
        Self { x: self.x * o.x, dx: self.x * o.dx }
    }
}

#[kernel]
impl Mul<f32> for Dual {
    type Output = Dual;

    fn mul(self, k: f32) -> Dual {
        Dual { x: self.x * k, dx: self.dx * k }
    }
}

#[kernel]
impl Mul<u32> for Dual {
    type Output = f32;

    fn mul(self, k: u32) -> f32 {
        self.x * k as f32
    }
}

#[kernel]
impl Mul<Dual> for f32 {
    type Output = Dual;

    fn mul(self, o: Dual) -> Dual {
        o * self
    }
}

#[kernel]
impl Div<f32> for Dual {
    type Output = Dual;

    fn div(self, k: f32) -> Dual {
        Dual { x: self.x / k, dx: self.dx / k }
    }
}

#[kernel]
impl Neg for Dual {
    type Output = Dual;

    fn neg(self) -> Dual {
        Dual { x: -self.x, dx: -self.dx }
    }
}

/// Another thing than `a = a + b`.
#[kernel]
impl AddAssign for Dual {
    fn add_assign(&mut self, o: Dual) {
        self.x += o.x;
        self.dx = o.x;
    }
}

#[kernel]
impl MulAssign<f32> for Dual {
    fn mul_assign(&mut self, k: f32) {
        *self = *self * k;
    }
}

/// The same of something generic.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub(super) struct Pair<T: Type> {
    pub first: T,
    pub second: f32,
}

#[kernel]
impl<T: Type> Add for Pair<T> {
    type Output = Pair<T>;

    fn add(self, o: Self) -> Self {
        Self { second: self.second + o.second, ..self }
    }
}

#[kernel]
pub fn own_operators(a: f32, b: f32) -> f32 {
    let s = Dual { x: a, dx: 1.0 };
    let t = s * s * 2.0 - -s / 4.0;
    let mut sum = 0.5 * t;
    let mut list = [s, t];
    if a > b {
        sum += t;
        list[1] += s;
    }
    sum *= b;
    list[(b > 0.0) as usize] *= 2.0;
    let pair = Pair::<Dual> { first: s, second: a } + Pair::<Dual> { first: t, second: b };
    let chosen = if a < b { sum + t } else { t - s };
    sum.x + sum.dx + list[1].dx + list[0].x + pair.first.dx + pair.second + chosen.x + t * 2
}

/// Methods that kernels refuse of numbers.
#[kernel]
impl Dual {
    pub fn exp(self) -> Self {
        let e = exp(self.x);
        Self { x: e, dx: e * self.dx }
    }

    pub fn sin(&self, scale: f32) -> f32 {
        sin(self.x * scale)
    }

    pub fn clone(&self) -> f32 {
        self.x * 0.5
    }

    pub fn len(&self) -> u32 {
        2
    }

    pub fn iter(&mut self) -> f32 {
        self.x += 1.0;
        self.x
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct Holder {
    pub dual: Dual,
}

#[kernel]
pub fn own_names(a: f32, b: f32) -> f32 {
    let mut s = Dual { x: a * 0.125, dx: b };
    let h = Holder { dual: s };
    let e = s.exp();
    let first = e.dx + h.dual.exp().x + h.dual.sin(0.5) + s.clone();
    let second = Dual::iter(&mut s) + s.iter() + Dual::clone(&h.dual) + Dual::sin(&s, 2.0);
    first + second + s.x * s.len() as f32
}

#[kernel]
pub trait Near {
    fn part(&self, k: f32) -> f32;
}

#[kernel]
pub trait Far {
    fn part(&self, k: f32) -> f32;
}

#[kernel]
pub trait Blend<T: Type> {
    fn blend(&self, with: T) -> f32;
}

#[kernel]
impl Near for Dual {
    fn part(&self, k: f32) -> f32 {
        self.x + k
    }
}

#[kernel]
impl Far for Dual {
    fn part(&self, k: f32) -> f32 {
        self.dx - k
    }
}

#[kernel]
impl Blend<f32> for Dual {
    fn blend(&self, with: f32) -> f32 {
        self.x - with
    }
}

#[kernel]
impl Blend<u32> for Dual {
    fn blend(&self, with: u32) -> f32 {
        self.dx + with as f32
    }
}

#[kernel]
pub fn own_far<F: Far>(f: F, k: f32) -> f32 {
    f.part(k)
}

#[kernel]
pub fn names_of_two_traits(a: f32, n: u32) -> f32 {
    let s = Dual { x: a, dx: a - 2.0 };
    let parts = <Dual as Near>::part(&s, 2.0) + <Dual as Far>::part(&s, 1.0);
    parts + own_far(s, a) + s.blend(a * 0.5) + s.blend(n % 8)
}

/// What stands behind an exit says what type a block has.
#[allow(unreachable_code, unused_variables, reason = "it is what the kernel is about")]
#[kernel]
pub fn exits_in_values(a: f32, n: u32) -> f32 {
    let x = {
        let z = a + 1.0;
        if n % 3 == 0 {
            return z;
        }
        if n % 3 == 1 {
            let y = {
                return z * 2.0;
                let k = 2.0;
                k
            };
            y
        } else {
            z + 3.0
        }
    };
    if x > 4.0 {
        let _never = if a < 9.0 { return x } else { return a };
    }
    x - 0.5
}

/// Both arms leave: nothing is behind them.
#[kernel]
pub fn arms_that_return(a: f32, n: u32) -> f32 {
    if n == 3 {
        return a;
    }
    if a > 2.0 {
        let mut sum = a;
        for i in 0..n % 5 {
            sum += i as f32;
        }
        sum
    } else {
        a - 1.0
    }
}

#[kernel]
fn last_part<F: Far>(all: [F; 3], n: u32) -> f32 {
    let mut sum = all[1].part(0.5);
    for one in all {
        sum += one.part(2.0);
    }
    let one = all[n as usize % 3];
    sum + one.part(1.0)
}

#[kernel]
pub fn generic_elements(a: f32, n: u32) -> f32 {
    let s = Dual { x: a, dx: a * 0.5 };
    last_part([s, Dual { x: 1.0, dx: 2.0 }, Dual { x: a, dx: 4.0 }], n)
}

const ROUNDS: u32 = 3;
const RATIO: f32 = 1.625;

#[kernel]
fn powers(x: f32, #[host] n: u32) -> f32 {
    let mut product = 1.0;
    for _ in 0..n {
        product *= x;
    }
    product
}

#[kernel]
fn weighed(x: f32, n: u32) -> f32 {
    x * n as f32
}

/// A constant where a number of the host is wanted, and where it is not.
#[kernel]
pub fn constant_arguments(a: f32, n: u32) -> f32 {
    powers(a, ROUNDS) + weighed(RATIO, ROUNDS) + weighed(a, max(n % 16, ROUNDS))
}

#[kernel]
pub fn ranges_with_steps(a: f32, n: u32) -> u32 {
    let k = n % 40;
    let mut sum = 0u32;
    for i in (1..k).step_by(3) {
        if i == 7 && a > 0.0 {
            continue;
        }
        sum = sum.wrapping_mul(3).wrapping_add(i);
    }
    for i in (0..=k).step_by(2) {
        sum = sum.wrapping_mul(3).wrapping_add(i);
    }
    // The last steps would go beyond the type.
    for i in (4_294_967_290u32..=4_294_967_295).step_by(3) {
        sum = sum.wrapping_mul(3).wrapping_add(i);
    }
    for i in (4_294_967_290 - k..4_294_967_295).step_by(k as usize + 4) {
        sum = sum.wrapping_mul(5).wrapping_add(i);
    }
    for mut i in (-5..k as i32).step_by(2) {
        i *= 2;
        sum = sum.wrapping_mul(3).wrapping_add(i as u32);
    }
    for x in [1.0, 2.5, 4.0].into_iter() {
        sum = sum.wrapping_add(x as u32);
    }
    sum
}
