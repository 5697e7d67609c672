//! Intermediate representation: functions of structured statements over a table of expressions.
//!
//! **A function** has parameters, variables, a table of nodes, and a body. A [`Node`] is an
//! expression over earlier nodes, identified by its [`Id`]; nodes are immutable but for the
//! printer's flags. Vectors and structs are split into scalars as values of the machine and
//! reassembled where all parts come from one value. Trivial expressions (numbers, parameters,
//! members) are shared: one node wherever they occur.
//!
//! **Evaluation.** Every node that is not trivial has a [`Stmt::Let`] where it was recorded: there
//! it is evaluated, once, in the order of the statements. Expressions have no side effects, except
//! an [`Expr::Call`] of a function that takes an [`Expr::Address`] and may change that variable. So
//! a printer may write a node in place of its name wherever the result is the same:
//!
//! * It is *pinned* if it is used in another block than its own, where it might be evaluated more
//!   often or under another condition.
//! * A [`Expr::Load`] is the value of a variable at its place. Variables count their stores in
//!   `version`, and a loop counts as a store to every variable, since its body may run again. A use
//!   of a load whose version has passed pins the load.
//! * Otherwise it is printed at its use, if there is one use, and gets a `let` if there are more.
//!
//! **Control flow** is structured. [`Stmt::If`] and [`Stmt::Loop`] have blocks;
//! [`Stmt::BreakUnless`], [`Stmt::Break`] and [`Stmt::Continue`] apply to the innermost loop, whose
//! `continuing` block runs before every further iteration, after a `Continue` too. An exit through
//! several loops is a number in the variable `leave`, tested behind each of them. [`Stmt::Return`]
//! leaves the function.
//!
//! **Arithmetic** is that of the scalar source, operation by operation: floats follow IEEE 754
//! where the device does; `wrapping_` operations of integers wrap, and so do those that would
//! panic; a quotient by 0 and shifts beyond the width are defined as in the book, "Numerical
//! guarantees"; conversions saturate. `min` and `max` are `if b < a { b } else { a }` and its like,
//! also for a NaN, unless the function is without any (`KnownFunction::is_without_nan`). Operations
//! on numbers alone are folded while recording.
//!
//! **Data**: captured numbers are members of the uniform buffer ([`Expr::Uniform`]), scenes and
//! slices are read by functions over their storage buffers. Both may change without a new program;
//! the program itself depends on host values, and on the kinds and layouts of the captures.

use crate::machine::{
    BoolBinary, Compare, F32Binary, F32Unary, IntBinary, Kinds, Schema, U32Unary, wgsl::BufferKey,
};

/// An expression of the function being recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Id(pub(super) u32);

/// A variable of the function being recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct VarId(pub(super) u32);

/// The component type of a vector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scalar {
    F32,
    I32,
    U32,
    Bool,
}

impl Scalar {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::I32 => "i32",
            Self::U32 => "u32",
            Self::Bool => "bool",
        }
    }
}

/// The type of an expression.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Type {
    F32,
    I32,
    U32,
    Bool,
    Vector(Scalar, usize),
    Of(&'static Schema),
}

impl Type {
    pub(crate) fn of(schema: &'static Schema) -> Self {
        match schema {
            Schema::F32 => Self::F32,
            Schema::I32 => Self::I32,
            Schema::U32 | Schema::Small { .. } | Schema::Kind { .. } => Self::U32,
            Schema::Bool => Self::Bool,
            Schema::Vector(element, n) => Self::of(element).times(*n),
            _ => Self::Of(schema),
        }
    }

    /// Returns the vector type of `n` such scalars.
    pub(super) fn times(self, n: usize) -> Self {
        match self {
            Self::I32 => Self::Vector(Scalar::I32, n),
            Self::U32 => Self::Vector(Scalar::U32, n),
            Self::Bool => Self::Vector(Scalar::Bool, n),
            _ => Self::Vector(Scalar::F32, n),
        }
    }

    /// Returns the component type of a vector.
    pub(super) fn component(self) -> Self {
        match self {
            Self::Vector(Scalar::F32, _) => Self::F32,
            Self::Vector(Scalar::I32, _) => Self::I32,
            Self::Vector(Scalar::U32, _) => Self::U32,
            Self::Vector(Scalar::Bool, _) => Self::Bool,
            other => other,
        }
    }
}

impl PartialEq for Type {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Of(a), Self::Of(b)) => a == b,
            (Self::Vector(s, a), Self::Vector(t, b)) => s == t && a == b,
            _ => core::mem::discriminant(self) == core::mem::discriminant(other),
        }
    }
}

/// A conversion between scalar types.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Conversion {
    /// `T(x)`.
    To,
    /// `bitcast<T>(x)`.
    Bits,
    /// A float to an integer: saturates, NaN gives 0, as Rust's `as`.
    Saturate,
}

#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Expr {
    /// The bits of an `f32`, so that equal programs compare equal.
    F32(u32),
    I32(i32),
    U32(u32),
    Bool(bool),
    Param(usize),
    Uniform(usize),
    Member(Id, &'static str),
    Element(Id, usize),
    Load(VarId),
    /// A pointer to a variable, for functions that change it.
    Address(VarId),
    F32Unary(F32Unary, Id),
    F32Binary(F32Binary, Id, Id),
    MulAdd(Id, Id, Id),
    U32Unary(U32Unary, Id),
    IntBinary(IntBinary, Id, Id),
    BoolBinary(BoolBinary, Id, Id),
    Neg(Id),
    Not(Id),
    Complement(Id),
    Compare(Compare, Id, Id),
    Select(Id, Id, Id),
    Convert(Conversion, Id),
    Call(usize, Vec<Id>),
    /// A builtin function of WGSL.
    Builtin(&'static str, Vec<Id>),
    Compose(Vec<Id>),
}

impl Expr {
    /// Returns whether it is too short to need a name.
    pub(super) fn is_trivial(&self) -> bool {
        matches!(
            self,
            Self::F32(_)
                | Self::I32(_)
                | Self::U32(_)
                | Self::Bool(_)
                | Self::Param(_)
                | Self::Uniform(_)
                | Self::Address(_)
                | Self::Member(..)
                | Self::Element(..)
        )
    }

    /// Returns its operands, in order.
    pub(super) fn operands(&self) -> impl Iterator<Item = Id> + '_ {
        let (few, many): ([Option<Id>; 3], &[Id]) = match self {
            Self::F32(_)
            | Self::I32(_)
            | Self::U32(_)
            | Self::Bool(_)
            | Self::Param(_)
            | Self::Uniform(_)
            | Self::Address(_)
            | Self::Load(_) => ([None; 3], &[]),
            Self::Member(a, _)
            | Self::Element(a, _)
            | Self::F32Unary(_, a)
            | Self::U32Unary(_, a)
            | Self::Neg(a)
            | Self::Not(a)
            | Self::Complement(a)
            | Self::Convert(_, a) => ([Some(*a), None, None], &[]),
            Self::F32Binary(_, a, b)
            | Self::IntBinary(_, a, b)
            | Self::BoolBinary(_, a, b)
            | Self::Compare(_, a, b) => ([Some(*a), Some(*b), None], &[]),
            Self::MulAdd(a, b, c) | Self::Select(a, b, c) => ([Some(*a), Some(*b), Some(*c)], &[]),
            Self::Call(_, args) | Self::Builtin(_, args) | Self::Compose(args) => ([None; 3], args),
        };
        few.into_iter().flatten().chain(many.iter().copied())
    }
}

/// An expression with the printer's data.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Node {
    pub(super) expr: Expr,
    pub(super) ty: Type,
    /// Its name in the source.
    pub(super) name: Option<&'static str>,
    /// Whether it must be evaluated where it was recorded, not at its use.
    pub(super) pinned: bool,
    /// The block in which it was recorded.
    pub(super) block: u32,
    /// The loads under it that would be repeated if it was printed at its use.
    pub(super) loads: Vec<Id>,
    /// For a load: the variable's version when it was recorded.
    pub(super) version: u32,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Stmt {
    /// The place where an expression was recorded.
    Let(Id),
    Var(VarId, Option<Id>),
    Store(VarId, Id),
    If {
        c: Id,
        then: Vec<Stmt>,
        otherwise: Vec<Stmt>,
    },
    Loop {
        body: Vec<Stmt>,
        continuing: Vec<Stmt>,
    },
    BreakUnless(Id),
    Break,
    Continue,
    Return(Option<Id>),
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Variable {
    pub(super) name: String,
    pub(super) ty: Type,
    /// The version, which grows with every store and at the start of every loop.
    pub(super) version: u32,
}

/// A function, recorded or written by hand.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Function {
    Recorded(Recorded),
    /// WGSL text, with the types that it names.
    Text {
        name: String,
        text: String,
        types: Vec<&'static Schema>,
    },
}

impl Function {
    /// Returns whether it is the library's text; a user's function may have any name.
    pub(super) fn is_text(&self) -> bool {
        matches!(self, Self::Text { .. })
    }

    /// Returns the types that its text refers to by name.
    pub(super) fn named_types(&self) -> impl Iterator<Item = &'static Schema> + '_ {
        let types = match self {
            Self::Text { text, types, .. } if !text.is_empty() => &types[..],
            _ => &[],
        };
        types.iter().copied()
    }

    pub(super) fn name(&self) -> &str {
        match self {
            Self::Recorded(f) => &f.name,
            Self::Text { name, .. } => name,
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Recorded {
    /// The name in the source; `name` may differ where several kernels share it.
    pub(super) source_name: &'static str,
    pub(super) name: String,
    /// Its source location.
    pub(super) file: &'static str,
    pub(super) line: u32,
    /// Whether `min` and `max` in it are WGSL's own; see `KnownFunction::is_without_nan`.
    pub(super) is_without_nan: bool,
    pub(super) params: Vec<(String, Type)>,
    pub(super) result: Option<Type>,
    pub(super) nodes: Vec<Node>,
    pub(super) vars: Vec<Variable>,
    pub(super) body: Vec<Stmt>,
}

impl Recorded {
    /// Returns whether both functions are equal but for the name.
    pub(super) fn same_code(&self, other: &Self) -> bool {
        self.source_name == other.source_name
            && self.params == other.params
            && self.result == other.result
            && self.vars == other.vars
            && self.body == other.body
            && self.nodes == other.nodes
    }
}

/// A member of the uniform buffer.
#[derive(Clone, Debug)]
pub(super) struct Uniform {
    pub(super) name: String,
    pub(super) ty: Type,
    /// The value as four-byte words.
    pub(super) words: Vec<u32>,
    /// Whether it is a constant of the source, and no captured number.
    pub(super) is_constant: bool,
}

/// A buffer of the scene.
#[derive(Clone, Debug)]
pub(super) struct SceneBuffer {
    pub(super) key: BufferKey,
    pub(super) name: String,
    pub(super) schema: &'static Schema,
    pub(super) len: u64,
    /// The kinds of each number of an enum's variant in it, once they were asked for.
    pub(super) kinds: Option<Vec<Kinds>>,
}
