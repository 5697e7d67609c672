//! Operations as types, to select each at compile time.
//!
//! A kernel is inlined whole before an optimiser sees it: if operations were values, the code of
//! all of them would be compiled at every use, only to be thrown away.

/// One of the operations of `Kind`.
pub trait Op<Kind>: Copy + 'static {
    /// The operation as a value.
    const OP: Kind;
}

/// Matches on an operation known at compile time: only the arm taken is compiled.
macro_rules! known {
    ($op:path; $($pattern:pat => $result:expr,)+) => {
        $(if const { matches!($op, $pattern) } { $result } else)+ { unreachable!() }
    };
}
pub(crate) use known;

/// Matches on an operation known at run time only: `$known` is the type of that operation in
/// `$result`. For tests.
#[doc(hidden)]
#[macro_export]
macro_rules! __at_run_time {
    (F32Unary $($rest:tt)+) => {
        $crate::__at_run_time!(@F32Unary Neg Abs Sqrt Floor Ceil Trunc; $($rest)+)
    };
    (F32Binary $($rest:tt)+) => {
        $crate::__at_run_time!(@F32Binary Add Sub Mul Div Min Max; $($rest)+)
    };
    (IntBinary $($rest:tt)+) => {
        $crate::__at_run_time!(
            @IntBinary Add Sub Mul Div Rem And Or Xor Shl Shr WrappingAdd WrappingSub WrappingMul;
            $($rest)+
        )
    };
    (BoolBinary $($rest:tt)+) => { $crate::__at_run_time!(@BoolBinary And Or Xor; $($rest)+) };
    (Compare $($rest:tt)+) => { $crate::__at_run_time!(@Compare Eq Ne Lt Le Gt Ge; $($rest)+) };
    (@$kind:ident $($name:ident)+; $op:expr, |$known:ident| $result:expr) => {
        match $op {
            $($crate::machine::$kind::$name => {
                let $known = $crate::machine::op::$name;
                $result
            })+
        }
    };
}

/// Declares kinds of operations: an enum of each, whose variants are types as well.
macro_rules! kinds {
    ($($(#[$about:meta])* $kind:ident { $($(#[$doc:meta])* $name:ident,)+ })+) => {
        $(
            $(#[$about])*
            #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
            #[expect(missing_docs, reason = "the names are those of operators and methods")]
            pub enum $kind {
                $($(#[$doc])* $name,)+
            }

            impl $kind {
                /// All operations of the kind.
                pub const ALL: &[Self] = &[$(Self::$name,)+];
            }

            $(
                impl Op<$kind> for $name {
                    const OP: $kind = $kind::$name;
                }
            )+
        )+
    };
}

kinds! {
    /// An operation on one `f32`.
    F32Unary { Neg, Abs, Sqrt, Floor, Ceil, Trunc, }

    /// An operation on two `f32`.
    F32Binary {
        Add,
        Sub,
        Mul,
        Div,
        /// `if b < a { b } else { a }`
        Min,
        /// `if a < b { b } else { a }`
        Max,
    }

    /// An operation on two integers of one type.
    ///
    /// `Add`, `Sub`, `Mul`, `Shl`, `Shr`, `Div` and `Rem` are Rust's operators: where Rust would
    /// panic, a packet built with debug assertions panics too, naming the lane. Without them every
    /// machine gives one result: sums wrap, a shift uses its amount modulo 32, `x / 0` is `x` and
    /// `x % 0` is 0 (the rules of WGSL).
    IntBinary {
        Add,
        Sub,
        Mul,
        Div,
        Rem,
        And,
        Or,
        Xor,
        Shl,
        Shr,
        WrappingAdd,
        WrappingSub,
        WrappingMul,
    }

    /// An operation on the bits of one integer.
    U32Unary { CountOnes, LeadingZeros, TrailingZeros, ReverseBits, }

    /// A comparison; with a NaN operand only `Ne` holds.
    Compare { Eq, Ne, Lt, Le, Gt, Ge, }

    /// An operation on two truth values.
    BoolBinary { And, Or, Xor, }
}

macro_rules! types {
    ($($name:ident)+) => {
        $(
            #[doc = concat!("The operation `", stringify!($name), "`.")]
            #[derive(Clone, Copy, Debug)]
            pub struct $name;
        )+
    };
}

types! {
    Neg Abs Sqrt Floor Ceil Trunc
    Add Sub Mul Div Rem Min Max
    And Or Xor Shl Shr
    WrappingAdd WrappingSub WrappingMul
    CountOnes LeadingZeros TrailingZeros ReverseBits
    Eq Ne Lt Le Gt Ge
}

impl F32Unary {
    /// Applies the operation.
    pub(super) fn of(self, a: f32) -> f32 {
        match self {
            Self::Neg => -a,
            Self::Abs => a.abs(),
            Self::Sqrt => a.sqrt(),
            Self::Floor => a.floor(),
            Self::Ceil => a.ceil(),
            Self::Trunc => a.trunc(),
        }
    }

    /// Returns the operation's name in WGSL.
    pub(super) fn wgsl(self) -> &'static str {
        match self {
            Self::Neg => "-",
            Self::Abs => "abs",
            Self::Sqrt => "sqrt",
            Self::Floor => "floor",
            Self::Ceil => "ceil",
            Self::Trunc => "trunc",
        }
    }
}

impl F32Binary {
    /// Applies the operation.
    pub(super) fn of(self, a: f32, b: f32) -> f32 {
        match self {
            Self::Add => a + b,
            Self::Sub => a - b,
            Self::Mul => a * b,
            Self::Div => a / b,
            Self::Min if b < a => b,
            Self::Max if a < b => b,
            Self::Min | Self::Max => a,
        }
    }
}

impl U32Unary {
    /// Applies the operation.
    pub(super) fn of(self, a: u32) -> u32 {
        match self {
            Self::CountOnes => a.count_ones(),
            Self::LeadingZeros => a.leading_zeros(),
            Self::TrailingZeros => a.trailing_zeros(),
            Self::ReverseBits => a.reverse_bits(),
        }
    }

    /// Returns the operation's name in WGSL.
    pub(super) fn wgsl(self) -> &'static str {
        match self {
            Self::CountOnes => "countOneBits",
            Self::LeadingZeros => "countLeadingZeros",
            Self::TrailingZeros => "countTrailingZeros",
            Self::ReverseBits => "reverseBits",
        }
    }
}

impl Compare {
    /// Applies the comparison.
    pub(super) fn of<T: PartialOrd>(self, a: T, b: T) -> bool {
        match self {
            Self::Eq => a == b,
            Self::Ne => a != b,
            Self::Lt => a < b,
            Self::Le => a <= b,
            Self::Gt => a > b,
            Self::Ge => a >= b,
        }
    }

    /// Returns the operator in WGSL.
    pub(super) fn wgsl(self) -> &'static str {
        match self {
            Self::Eq => "==",
            Self::Ne => "!=",
            Self::Lt => "<",
            Self::Le => "<=",
            Self::Gt => ">",
            Self::Ge => ">=",
        }
    }
}

impl BoolBinary {
    /// Applies the operation.
    pub(super) fn of(self, a: bool, b: bool) -> bool {
        match self {
            Self::And => a & b,
            Self::Or => a | b,
            Self::Xor => a ^ b,
        }
    }
}
