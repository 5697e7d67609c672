//! Lanes whose instruction set is a value, not a type.
//!
//! A kernel is compiled once a width for them, whatever the number of levels, and runs each
//! operation of each level as a call. Production packets inline theirs: a kernel that is compiled
//! for every level and width takes thirteen times as long.

use raydsl::__at_run_time as at_run_time;
use raydsl::machine::{BoolBinary, Compare, F32Binary, F32Unary, Gang, IntBinary, Lanes, One, Op};

/// `N` lanes of the level behind the reference. It may have fewer: then the upper lanes hold
/// nothing, and must not run.
#[derive(Clone, Copy)]
pub struct RunTime<const N: usize>(&'static dyn Table<N>);

impl<const N: usize> RunTime<N> {
    /// The operations of `lanes`.
    pub fn new<L: Lanes>(lanes: L) -> Self {
        assert!(L::N <= N, "{} lanes do not fit {N}", L::N);
        Self(Box::leak(Box::new(lanes)))
    }
}

/// As `RunTime<16>`, with its registers in a table of the thread: what a kernel holds are their
/// numbers. It runs slower, and a kernel takes a third of the time to compile.
#[derive(Clone, Copy)]
pub struct Numbered(RunTime<16>);

impl Numbered {
    /// The operations of `lanes`.
    pub fn new<L: Lanes>(lanes: L) -> Self {
        Self(RunTime::new(lanes))
    }

    /// Forgets all registers: those that a kernel still holds must not be used.
    pub fn forget() {
        REGISTERS.with_borrow_mut(Vec::clear);
    }
}

/// A register of a [`Numbered`] machine.
#[derive(Clone, Copy, Debug)]
pub struct Register(u32);

thread_local! {
    static REGISTERS: std::cell::RefCell<Vec<[u32; 16]>> = const { std::cell::RefCell::new(Vec::new()) };
}

/// What a [`Numbered`] machine has in place of a value.
pub trait Kept: Sized {
    /// The number of a register, or the value itself.
    type Place;
    /// Puts it into a register.
    fn keep(self) -> Self::Place;
    /// Takes it out again.
    fn find(place: Self::Place) -> Self;
}

macro_rules! kept {
    ($($scalar:ty: |$a:ident| $to:expr, |$b:ident| $from:expr;)+) => {
        $(
            impl Kept for [$scalar; 16] {
                type Place = Register;
                fn keep(self) -> Register {
                    REGISTERS.with_borrow_mut(|all| {
                        all.push(self.map(|$a| $to));
                        Register(all.len() as u32 - 1)
                    })
                }
                fn find(place: Register) -> Self {
                    REGISTERS.with_borrow(|all| all[place.0 as usize].map(|$b| $from))
                }
            }
        )+
    };
}

kept! {
    f32: |a| a.to_bits(), |b| f32::from_bits(b);
    i32: |a| a as u32, |b| b as i32;
    u32: |a| a, |b| b;
}

/// A mask, one bit a lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bits(u64);

/// What a register of `L` is outside the level.
trait Held<L: Lanes>: Sized {
    type Register;
    fn load(self, lanes: L) -> Self::Register;
    fn store(register: Self::Register, lanes: L) -> Self;
}

macro_rules! held {
    ($($scalar:ty: $register:ident $from_fn:ident $lane:ident;)+) => {
        $(
            impl<L: Lanes, const N: usize> Held<L> for [$scalar; N] {
                type Register = L::$register;
                #[inline(always)]
                fn load(self, lanes: L) -> L::$register {
                    lanes.$from_fn(|i| self[i])
                }
                #[inline(always)]
                fn store(register: L::$register, _: L) -> Self {
                    let mut all = [Default::default(); N];
                    all.iter_mut().take(L::N).enumerate().for_each(|(i, v)| *v = L::$lane(&register, i));
                    all
                }
            }
        )+
    };
}

held! {
    f32: F32 f32_from_fn f32_lane;
    i32: I32 i32_from_fn i32_lane;
    u32: U32 u32_from_fn u32_lane;
}

impl Kept for Bits {
    type Place = Self;
    fn keep(self) -> Self {
        self
    }
    fn find(place: Self) -> Self {
        place
    }
}

impl<L: Lanes> Held<L> for Bits {
    type Register = L::Mask;
    #[inline(always)]
    fn load(self, lanes: L) -> L::Mask {
        lanes.mask_from_bits(self.0)
    }
    #[inline(always)]
    fn store(register: L::Mask, lanes: L) -> Self {
        Self(lanes.bits(register))
    }
}

macro_rules! held_as_it_is {
    ($($t:ty),+) => {
        $(
            impl<L: Lanes> Held<L> for $t {
                type Register = Self;
                #[inline(always)]
                fn load(self, _: L) -> Self {
                    self
                }
                #[inline(always)]
                fn store(register: Self, _: L) -> Self {
                    register
                }
            }

            impl Kept for $t {
                type Place = Self;
                fn keep(self) -> Self {
                    self
                }
                fn find(place: Self) -> Self {
                    place
                }
            }
        )+
    };
}

held_as_it_is!(f32, i32, u32, u64, bool, &'static str);

macro_rules! operations {
    (
        $($name:ident($($a:ident: $t:ty),*) -> $r:ty;)+
        $(@$kind:ident: $op_name:ident($($b:ident: $op_t:ty),*) -> $op_r:ty;)+
    ) => {
        trait Table<const N: usize>: Send + Sync {
            $(fn $name(&self, $($a: $t),*) -> $r;)+
            $(fn $op_name(&self, op: $kind, $($b: $op_t),*) -> $op_r;)+
        }

        impl<L: Lanes, const N: usize> Table<N> for L {
            $(
                fn $name(&self, $($a: $t),*) -> $r {
                    let lanes = *self;
                    lanes.vectorize(
                        #[inline(always)]
                        || {
                            $(let $a = Held::<L>::load($a, lanes);)*
                            <$r as Held<L>>::store(Lanes::$name(lanes, $($a),*), lanes)
                        },
                    )
                }
            )+
            $(
                fn $op_name(&self, op: $kind, $($b: $op_t),*) -> $op_r {
                    let lanes = *self;
                    lanes.vectorize(
                        #[inline(always)]
                        || {
                            $(let $b = Held::<L>::load($b, lanes);)*
                            let all = at_run_time!($kind op, |op| {
                                Lanes::$op_name(lanes, op, $($b),*)
                            });
                            <$op_r as Held<L>>::store(all, lanes)
                        },
                    )
                }
            )+
        }

        // SAFETY: each operation is that of an array of numbers.
        unsafe impl<const N: usize> Lanes for RunTime<N> {
            const N: usize = N;
            type F32 = [f32; N];
            type I32 = [i32; N];
            type U32 = [u32; N];
            type Mask = Bits;
            type Eight = Gang<One, 8>;

            fn eight(self) -> Gang<One, 8> {
                Gang(One)
            }
            /// A kernel that calls another does not contain it.
            #[inline(never)]
            fn vectorize<R>(self, f: impl FnOnce() -> R) -> R {
                f()
            }
            $(
                fn $name(self, $($a: $t),*) -> $r {
                    self.0.$name($($a),*)
                }
            )+
            $(
                fn $op_name<O: Op<$kind>>(self, _: O, $($b: $op_t),*) -> $op_r {
                    self.0.$op_name(O::OP, $($b),*)
                }
            )+
            fn f32_from_fn(self, f: impl FnMut(usize) -> f32) -> [f32; N] {
                std::array::from_fn(f)
            }
            fn i32_from_fn(self, f: impl FnMut(usize) -> i32) -> [i32; N] {
                std::array::from_fn(f)
            }
            fn u32_from_fn(self, f: impl FnMut(usize) -> u32) -> [u32; N] {
                std::array::from_fn(f)
            }
            fn f32_lane(a: &[f32; N], lane: usize) -> f32 {
                a[lane]
            }
            fn i32_lane(a: &[i32; N], lane: usize) -> i32 {
                a[lane]
            }
            fn u32_lane(a: &[u32; N], lane: usize) -> u32 {
                a[lane]
            }
            fn mask_lane(a: &Bits, lane: usize) -> bool {
                a.0 >> lane & 1 != 0
            }
        }

        const _: () = {
            const N: usize = 16;

            // SAFETY: each operation is that of the lanes within.
            unsafe impl Lanes for Numbered {
                const N: usize = N;
                type F32 = Register;
                type I32 = Register;
                type U32 = Register;
                type Mask = Bits;
                type Eight = Gang<One, 8>;

                fn eight(self) -> Gang<One, 8> {
                    Gang(One)
                }
                #[inline(never)]
                fn vectorize<R>(self, f: impl FnOnce() -> R) -> R {
                    f()
                }
                $(
                    #[inline(never)]
                    fn $name(self, $($a: <$t as Kept>::Place),*) -> <$r as Kept>::Place {
                        $(let $a = <$t as Kept>::find($a);)*
                        Kept::keep(self.0.$name($($a),*))
                    }
                )+
                $(
                    #[inline(never)]
                    fn $op_name<O: Op<$kind>>(
                        self,
                        op: O,
                        $($b: <$op_t as Kept>::Place),*
                    ) -> <$op_r as Kept>::Place {
                        $(let $b = <$op_t as Kept>::find($b);)*
                        Kept::keep(self.0.$op_name(op, $($b),*))
                    }
                )+
                fn f32_from_fn(self, f: impl FnMut(usize) -> f32) -> Register {
                    std::array::from_fn::<f32, N, _>(f).keep()
                }
                fn i32_from_fn(self, f: impl FnMut(usize) -> i32) -> Register {
                    std::array::from_fn::<i32, N, _>(f).keep()
                }
                fn u32_from_fn(self, f: impl FnMut(usize) -> u32) -> Register {
                    std::array::from_fn::<u32, N, _>(f).keep()
                }
                fn f32_lane(a: &Register, lane: usize) -> f32 {
                    f32::from_bits(Self::u32_lane(a, lane))
                }
                fn i32_lane(a: &Register, lane: usize) -> i32 {
                    Self::u32_lane(a, lane) as i32
                }
                #[inline(never)]
                fn u32_lane(a: &Register, lane: usize) -> u32 {
                    REGISTERS.with_borrow(|all| all[a.0 as usize][lane])
                }
                fn mask_lane(a: &Bits, lane: usize) -> bool {
                    a.0 >> lane & 1 != 0
                }
            }
        };
    };
}

operations! {
    isa() -> &'static str;
    f32(v: f32) -> [f32; N];
    i32(v: i32) -> [i32; N];
    u32(v: u32) -> [u32; N];
    mask(v: bool) -> Bits;
    f32_mul_add(a: [f32; N], b: [f32; N], c: [f32; N]) -> [f32; N];
    mask_not(a: Bits) -> Bits;
    f32_select(c: Bits, a: [f32; N], b: [f32; N]) -> [f32; N];
    i32_select(c: Bits, a: [i32; N], b: [i32; N]) -> [i32; N];
    u32_select(c: Bits, a: [u32; N], b: [u32; N]) -> [u32; N];
    any(a: Bits) -> bool;
    bits(a: Bits) -> u64;
    mask_from_bits(bits: u64) -> Bits;
    f32_to_i32(a: [f32; N]) -> [i32; N];
    f32_to_u32(a: [f32; N]) -> [u32; N];
    i32_to_f32(a: [i32; N]) -> [f32; N];
    u32_to_f32(a: [u32; N]) -> [f32; N];
    i32_to_u32(a: [i32; N]) -> [u32; N];
    u32_to_i32(a: [u32; N]) -> [i32; N];
    f32_to_bits(a: [f32; N]) -> [u32; N];
    f32_from_bits(a: [u32; N]) -> [f32; N];
    @F32Unary: f32_unary(a: [f32; N]) -> [f32; N];
    @F32Binary: f32_binary(a: [f32; N], b: [f32; N]) -> [f32; N];
    @IntBinary: i32_binary(a: [i32; N], b: [i32; N]) -> [i32; N];
    @IntBinary: u32_binary(a: [u32; N], b: [u32; N]) -> [u32; N];
    @BoolBinary: mask_binary(a: Bits, b: Bits) -> Bits;
    @Compare: f32_compare(a: [f32; N], b: [f32; N]) -> Bits;
    @Compare: i32_compare(a: [i32; N], b: [i32; N]) -> Bits;
    @Compare: u32_compare(a: [u32; N], b: [u32; N]) -> Bits;
}
