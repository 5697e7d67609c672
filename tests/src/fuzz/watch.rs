//! A lane that notices floats that WGSL need not treat as Rust does.

use std::cell::Cell;

use raydsl::machine::{BoolBinary, Compare, F32Binary, F32Unary, Gang, IntBinary, Lanes, One, Op};

thread_local! {
    static LOOSE: Cell<bool> = const { Cell::new(false) };
}

/// Whether `f` meets an operation on floats that WGSL leaves open, on the lanes of [`Watch`].
///
/// It leaves open what happens to numbers that are subnormal or not finite, the sign of a product
/// that is a zero, and where a fused product is rounded; and a driver may reorder what is not exact.
pub fn is_loose(f: impl FnOnce()) -> bool {
    LOOSE.set(false);
    f();
    LOOSE.get()
}

/// [`One`] lane under watch.
#[derive(Clone, Copy, Debug)]
pub struct Watch;

fn see(x: f32) -> f32 {
    if !x.is_finite() || x.is_subnormal() {
        LOOSE.set(true);
    }
    x
}

/// `found` stands for the exact result `exact`, of which `f64` may have rounded a part away.
fn see_exact(found: f32, exact: f64, is_exact: bool) -> f32 {
    if !is_exact || f64::from(found) != exact {
        LOOSE.set(true);
    }
    see(found)
}

/// Whether a sum in `f64` loses nothing (Knuth's two-sum).
fn is_exact_sum(a: f64, b: f64) -> bool {
    let sum = a + b;
    let other = sum - a;
    (a - (sum - other)) + (b - other) == 0.0
}

macro_rules! as_one {
    (operations $($name:ident: $kind:ident($($a:ident: $t:ty),*) -> $r:ty;)+) => {
        $(
            fn $name<O: Op<$kind>>(self, op: O, $($a: $t),*) -> $r {
                One.$name(op, $($a),*)
            }
        )+
    };
    ($($name:ident($($a:ident: $t:ty),*) -> $r:ty;)+) => {
        $(
            fn $name(self, $($a: $t),*) -> $r {
                One.$name($($a),*)
            }
        )+
    };
}

// SAFETY: each operation is that of the lanes within.
unsafe impl Lanes for Watch {
    const N: usize = 1;
    type F32 = f32;
    type I32 = i32;
    type U32 = u32;
    type Mask = bool;
    type Eight = Gang<Self, 8>;

    fn eight(self) -> Gang<Self, 8> {
        Gang(self)
    }

    fn vectorize<R>(self, f: impl FnOnce() -> R) -> R {
        f()
    }

    fn f32_unary<O: Op<F32Unary>>(self, op: O, a: f32) -> f32 {
        let found = One.f32_unary(op, see(a));
        match O::OP {
            F32Unary::Sqrt => see_exact(found * found, f64::from(a), true),
            _ => found,
        };
        see(found)
    }

    fn f32_binary<O: Op<F32Binary>>(self, op: O, a: f32, b: f32) -> f32 {
        let found = One.f32_binary(op, see(a), see(b));
        let (x, y) = (f64::from(a), f64::from(b));
        match O::OP {
            F32Binary::Add => see_exact(found, x + y, is_exact_sum(x, y)),
            F32Binary::Sub => see_exact(found, x - y, is_exact_sum(x, -y)),
            F32Binary::Mul => {
                // Devices make 0 of what is multiplied by 0, whatever its sign.
                if found == 0.0 && found.is_sign_negative() {
                    LOOSE.set(true);
                }
                see_exact(found, x * y, true)
            }
            F32Binary::Div => {
                see_exact(a, f64::from(found) * y, true);
                see(found)
            }
            F32Binary::Min | F32Binary::Max => found,
        }
    }

    fn f32_mul_add(self, a: f32, b: f32, c: f32) -> f32 {
        LOOSE.set(true);
        One.f32_mul_add(a, b, c)
    }

    fn f32_compare<O: Op<Compare>>(self, op: O, a: f32, b: f32) -> bool {
        One.f32_compare(op, see(a), see(b))
    }

    fn f32_to_i32(self, a: f32) -> i32 {
        One.f32_to_i32(see(a))
    }

    fn f32_to_u32(self, a: f32) -> u32 {
        One.f32_to_u32(see(a))
    }

    fn f32_to_bits(self, a: f32) -> u32 {
        One.f32_to_bits(see(a))
    }

    fn f32_from_bits(self, a: u32) -> f32 {
        see(One.f32_from_bits(a))
    }

    as_one! {
        operations
        i32_binary: IntBinary(a: i32, b: i32) -> i32;
        u32_binary: IntBinary(a: u32, b: u32) -> u32;
        mask_binary: BoolBinary(a: bool, b: bool) -> bool;
        i32_compare: Compare(a: i32, b: i32) -> bool;
        u32_compare: Compare(a: u32, b: u32) -> bool;
    }

    as_one! {
        isa() -> &'static str;
        f32(v: f32) -> f32;
        i32(v: i32) -> i32;
        u32(v: u32) -> u32;
        mask(v: bool) -> bool;
        mask_not(a: bool) -> bool;
        f32_select(c: bool, a: f32, b: f32) -> f32;
        i32_select(c: bool, a: i32, b: i32) -> i32;
        u32_select(c: bool, a: u32, b: u32) -> u32;
        any(a: bool) -> bool;
        bits(a: bool) -> u64;
        mask_from_bits(bits: u64) -> bool;
        i32_to_f32(a: i32) -> f32;
        u32_to_f32(a: u32) -> f32;
        i32_to_u32(a: i32) -> u32;
        u32_to_i32(a: u32) -> i32;
        f32_from_fn(f: impl FnMut(usize) -> f32) -> f32;
        i32_from_fn(f: impl FnMut(usize) -> i32) -> i32;
        u32_from_fn(f: impl FnMut(usize) -> u32) -> u32;
    }

    fn f32_lane(a: &f32, lane: usize) -> f32 {
        One::f32_lane(a, lane)
    }
    fn i32_lane(a: &i32, lane: usize) -> i32 {
        One::i32_lane(a, lane)
    }
    fn u32_lane(a: &u32, lane: usize) -> u32 {
        One::u32_lane(a, lane)
    }
    fn mask_lane(a: &bool, lane: usize) -> bool {
        One::mask_lane(a, lane)
    }
}
