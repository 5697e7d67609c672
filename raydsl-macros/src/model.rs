//! Syntax tree of a kernel, between syn's syntax and the generated tokens.

mod facts;

use proc_macro2::{Ident, Span, TokenStream};

use crate::generics::Generics;

/// The most parameters of a kernel that runs by itself.
pub(crate) const MOST_OF_ENTRY: usize = 8;

/// The most parameters of a kernel that others call: its arguments on a machine are a tuple.
pub(crate) const MOST: usize = 16;

/// A function, method or closure to lift.
#[derive(Clone)]
pub(crate) struct Kernel {
    pub(crate) name: Ident,
    pub(crate) generics: Generics,
    pub(crate) params: Vec<Param>,
    /// The declared result; `None` is `()` for a function and inferred for a closure.
    pub(crate) result: Option<TokenStream>,
    pub(crate) body: Block,
    /// Whether it has `#[inline(never)]`.
    pub(crate) is_apart: bool,
    /// Whether it has `#[inline(always)]`.
    pub(crate) is_within: bool,
    /// The knowledge of machines about it beyond its code.
    pub(crate) known: Option<syn::Expr>,
    /// Whether it is an argument of a user's kernel, which takes it as an `Fn`: rustc knows that it
    /// changes nothing outside.
    pub(crate) is_fn: bool,
    /// Whether there is a mistake in its signature, so that it cannot be lifted.
    pub(crate) is_broken: bool,
}

/// A parameter. Shared references are dropped: values are copied.
#[derive(Clone)]
pub(crate) struct Param {
    pub(crate) name: Ident,
    pub(crate) ty: TokenStream,
    pub(crate) mutable: bool,
    /// Whether it is `&mut`: its final value is written back to the caller.
    pub(crate) by_mut: bool,
    /// Whether it is a slice or a tree, which kernels read in place.
    pub(crate) data: bool,
    /// Whether it is a reference to a type parameter that is a scene.
    pub(crate) scene: bool,
    /// Whether it is `#[host]`: known before the kernel runs.
    pub(crate) host: bool,
    /// What it takes and gives, if it is a closure.
    pub(crate) function: Option<Signature>,
}

/// The types of a closure that is a parameter, without references.
#[derive(Clone)]
pub(crate) struct Signature {
    pub(crate) params: Vec<TokenStream>,
    pub(crate) result: TokenStream,
}

#[derive(Clone)]
pub(crate) struct Block {
    pub(crate) stmts: Vec<Stmt>,
    pub(crate) tail: Option<Box<Expr>>,
}

#[derive(Clone)]
pub(crate) enum Stmt {
    Let(Let),
    Expr(Expr),
    /// `const` items and the like, copied as they are.
    Item(TokenStream),
}

#[derive(Clone)]
pub(crate) struct Let {
    /// Whether a pattern binds it: then a part of a reference is a reference.
    pub(crate) is_pattern: bool,
    /// Whether it is `#[host]`: known before the kernel runs.
    pub(crate) host: bool,
    /// `None` is the pattern `_`.
    pub(crate) name: Option<Ident>,
    pub(crate) mutable: bool,
    pub(crate) ty: Option<TokenStream>,
    pub(crate) init: Option<Expr>,
}

#[derive(Clone)]
pub(crate) struct Expr {
    pub(crate) kind: Kind,
    pub(crate) span: Span,
}

#[derive(Clone)]
pub(crate) enum Kind {
    /// A literal with `.` or the suffix `f32`.
    Float(TokenStream),
    /// An integer; with a suffix its type is known.
    Int {
        tokens: TokenStream,
        suffix: Option<IntType>,
    },
    Bool(bool),
    /// A single name: a local, a capture, or a constant.
    Name(Ident),
    /// A path of several segments that is a value: a constant.
    Path(TokenStream),
    Neg(Box<Expr>),
    Not(Box<Expr>),
    Binary {
        op: BinaryOp,
        a: Box<Expr>,
        b: Box<Expr>,
    },
    /// `&&` or `||`.
    Logic {
        and: bool,
        a: Box<Expr>,
        b: Box<Expr>,
    },
    Compare {
        op: &'static str,
        a: Box<Expr>,
        b: Box<Expr>,
    },
    Cast {
        value: Box<Expr>,
        ty: TokenStream,
    },
    /// Whether a value is of a variant without fields, which `path` names.
    Is {
        value: Box<Expr>,
        path: TokenStream,
        name: Ident,
    },
    /// A call of one of the methods that the derive of an enum writes for a variant: whether a value is of
    /// it, a field, or the value with another field.
    OfVariant {
        value: Box<Expr>,
        method: Ident,
        args: Vec<Expr>,
    },
    /// A value of a variant with named fields, before they are set.
    NewVariant {
        ty: TokenStream,
        name: Ident,
    },
    /// `*x`: the value of a `&mut` parameter.
    Deref(Box<Expr>),
    /// `&mut place`, as an argument.
    RefMut(Place),
    /// A call of a kernel by its path.
    Call {
        path: TokenStream,
        args: Vec<Expr>,
    },
    /// A call of `Type::function`.
    Associated {
        ty: TokenStream,
        name: Ident,
        args: Vec<Expr>,
    },
    Method {
        receiver: Box<Expr>,
        name: Ident,
        /// The arguments behind `::`, as types.
        turbofish: Vec<TokenStream>,
        args: Vec<Expr>,
    },
    /// `host(x)`.
    Host(Box<Expr>),
    /// A closure as an argument of an operation: it runs where the operation calls it.
    Closure(Box<Kernel>),
    Field {
        base: Box<Expr>,
        member: TokenStream,
    },
    /// An element of an array at an index written in the source.
    Index {
        base: Box<Expr>,
        index: TokenStream,
    },
    /// An element of an array at a computed index.
    Element {
        base: Box<Expr>,
        index: Box<Expr>,
    },
    Array(Vec<Expr>),
    Repeat {
        value: Box<Expr>,
        len: TokenStream,
    },
    Struct {
        path: TokenStream,
        fields: Vec<(TokenStream, Expr)>,
        rest: Option<Box<Expr>>,
    },
    Tuple(Vec<Expr>),
    If {
        /// Whether it is `#[coherent]`: the rays mostly agree, so its arms are tested.
        coherent: bool,
        c: Box<Expr>,
        then: Block,
        otherwise: Option<Box<Expr>>,
    },
    While {
        label: Option<String>,
        c: Box<Expr>,
        body: Block,
    },
    Loop {
        label: Option<String>,
        body: Block,
    },
    For {
        label: Option<String>,
        var: Option<Ident>,
        range: Range,
        body: Block,
    },
    /// A loop over a cursor: its body binds the items by this name.
    ForItems {
        label: Option<String>,
        item: Ident,
        items: Box<Expr>,
        body: Block,
    },
    Block(Block),
    Break(Option<String>, Option<Box<Expr>>),
    Continue(Option<String>),
    Return(Option<Box<Expr>>),
    Assign {
        place: Place,
        value: Box<Expr>,
    },
    OpAssign {
        op: BinaryOp,
        place: Place,
        value: Box<Expr>,
    },
    /// A mistake that has been reported.
    Error,
}

/// The range of a `for`.
#[derive(Clone)]
pub(crate) struct Range {
    pub(crate) start: Box<Expr>,
    pub(crate) end: Box<Expr>,
    pub(crate) inclusive: bool,
    pub(crate) reversed: bool,
    /// `.step_by(n)`: a `usize`.
    pub(crate) step: Option<Box<Expr>>,
}

/// A variable, or a part of one.
#[derive(Clone)]
pub(crate) struct Place {
    pub(crate) name: Ident,
    pub(crate) steps: Vec<Step>,
}

/// A step from a value to a part of it.
#[derive(Clone)]
pub(crate) enum Step {
    /// A member of a struct or a tuple.
    Member(TokenStream),
    /// An element at an index written in the source.
    Element(TokenStream),
    /// An element at a computed index.
    Computed(Expr),
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum IntType {
    I32,
    U32,
    Usize,
}

/// A binary arithmetic operator, with the names of its trait and method.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct BinaryOp {
    /// The operator in the source.
    pub(crate) symbol: &'static str,
    pub(crate) operator: &'static str,
    pub(crate) method: &'static str,
    /// Whether inactive lanes could make it trap.
    pub(crate) may_trap: bool,
    /// Whether it may overflow integers: an error in running lanes, where it is checked.
    pub(crate) may_overflow: bool,
}

/// Returns whether a name is a constant's, by rustc's naming convention.
pub(crate) fn is_constant(name: &Ident) -> bool {
    name.to_string().starts_with(|c: char| c.is_ascii_uppercase())
}

impl Param {
    /// Whether it has no written type, as in the closure `|x| x * x`.
    pub(crate) fn is_inferred(&self) -> bool {
        self.ty.to_string() == "_"
    }
}

impl Kernel {
    /// Whether it takes a closure. Its body is then a part of the caller's, whose variables the
    /// closure may read.
    pub(crate) fn takes_function(&self) -> bool {
        self.params.iter().any(|p| p.function.is_some())
    }

    /// Whether the result of a closure may be an integer whose type is inferred: then it is that of
    /// the source.
    pub(crate) fn gives_bare_integer(&self) -> bool {
        self.result.is_none() && self.body.has_bare_integer()
    }
}
