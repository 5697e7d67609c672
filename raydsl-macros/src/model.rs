//! A kernel as the macro understands it: syn's syntax is behind us, tokens are still to come.

use proc_macro2::{Ident, Span, TokenStream};

/// A function, method or closure to lift.
pub(crate) struct Kernel {
    pub(crate) name: Ident,
    pub(crate) params: Vec<Param>,
    /// The declared result; `None` is `()` for a function and inferred for a closure.
    pub(crate) result: Option<TokenStream>,
    pub(crate) body: Block,
}

/// A parameter. References are dropped: values are copied.
pub(crate) struct Param {
    pub(crate) name: Ident,
    pub(crate) ty: TokenStream,
    pub(crate) mutable: bool,
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
        args: Vec<Expr>,
    },
    Field {
        base: Box<Expr>,
        member: TokenStream,
    },
    /// An element of an array at a place that the source names.
    Index {
        base: Box<Expr>,
        index: TokenStream,
    },
    Struct {
        path: TokenStream,
        fields: Vec<(TokenStream, Expr)>,
        rest: Option<Box<Expr>>,
    },
    Tuple(Vec<Expr>),
    If {
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
        start: Box<Expr>,
        end: Box<Expr>,
        body: Block,
    },
    Block(Block),
    Break(Option<String>),
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

/// A variable, or a member of one.
#[derive(Clone)]
pub(crate) struct Place {
    pub(crate) name: Ident,
    pub(crate) members: Vec<TokenStream>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum IntType {
    I32,
    U32,
}

/// The binary operators of arithmetic, by the name of their trait and method.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct BinaryOp {
    pub(crate) operator: &'static str,
    pub(crate) method: &'static str,
    /// Whether dead lanes could make it trap.
    pub(crate) may_trap: bool,
    /// Whether integers may overflow in it: an error in running lanes, where it is checked.
    pub(crate) may_overflow: bool,
}

impl Kind {
    /// Every expression directly under this one.
    pub(crate) fn children(&self) -> Vec<&Expr> {
        match self {
            Self::Float(_)
            | Self::Int { .. }
            | Self::Bool(_)
            | Self::Name(_)
            | Self::Path(_)
            | Self::Break(_)
            | Self::Continue(_)
            | Self::Return(None)
            | Self::Error => vec![],
            Self::Neg(a) | Self::Not(a) | Self::Return(Some(a)) => vec![a],
            Self::Cast { value, .. } => vec![value],
            Self::Field { base, .. } | Self::Index { base, .. } => vec![base],
            Self::Assign { value, .. } | Self::OpAssign { value, .. } => vec![value],
            Self::Binary { a, b, .. } | Self::Logic { a, b, .. } | Self::Compare { a, b, .. } => {
                vec![a, b]
            }
            Self::Call { args, .. } | Self::Associated { args, .. } | Self::Tuple(args) => {
                args.iter().collect()
            }
            Self::Method { receiver, args, .. } => {
                core::iter::once(&**receiver).chain(args).collect()
            }
            Self::Struct { fields, rest, .. } => {
                fields.iter().map(|f| &f.1).chain(rest.as_deref()).collect()
            }
            Self::If { c, then, otherwise } => {
                let mut all = vec![&**c];
                all.extend(then.children());
                all.extend(otherwise.as_deref());
                all
            }
            Self::While { c, body, .. } => {
                let mut all = vec![&**c];
                all.extend(body.children());
                all
            }
            Self::For { start, end, body, .. } => {
                let mut all = vec![&**start, &**end];
                all.extend(body.children());
                all
            }
            Self::Loop { body, .. } | Self::Block(body) => body.children(),
        }
    }
}

impl Block {
    pub(crate) fn children(&self) -> Vec<&Expr> {
        let stmts = self.stmts.iter().filter_map(|s| match s {
            Stmt::Let(l) => l.init.as_ref(),
            Stmt::Expr(e) => Some(e),
            Stmt::Item(_) => None,
        });
        stmts.chain(self.tail.as_deref()).collect()
    }
}

impl Expr {
    /// Whether running it can take lanes out of the code that follows.
    pub(crate) fn ends_lanes(&self) -> bool {
        self.ends(&mut Vec::new(), 0)
    }

    fn ends<'a>(&'a self, inside: &mut Vec<Option<&'a str>>, loops: usize) -> bool {
        match &self.kind {
            Kind::Return(_) => true,
            Kind::Break(label) | Kind::Continue(label) => match label {
                None => loops == 0,
                Some(l) => !inside.iter().flatten().any(|x| x == l),
            },
            Kind::While { label, .. } | Kind::Loop { label, .. } | Kind::For { label, .. } => {
                inside.push(label.as_deref());
                let ends = self.kind.children().iter().any(|e| e.ends(inside, loops + 1));
                inside.pop();
                ends
            }
            kind => kind.children().iter().any(|e| e.ends(inside, loops)),
        }
    }

    /// Whether no lane goes on behind it.
    pub(crate) fn diverges(&self) -> bool {
        matches!(self.kind, Kind::Return(_) | Kind::Break(_) | Kind::Continue(_))
    }

    /// Whether it may be evaluated where the source would not: it has no effect and cannot trap.
    pub(crate) fn is_total(&self) -> bool {
        let this = match &self.kind {
            Kind::Binary { op, .. } => !op.may_trap,
            Kind::Call { .. }
            | Kind::Associated { .. }
            | Kind::Method { .. }
            | Kind::If { .. }
            | Kind::While { .. }
            | Kind::Loop { .. }
            | Kind::For { .. }
            | Kind::Block(_)
            | Kind::Break(_)
            | Kind::Continue(_)
            | Kind::Return(_)
            | Kind::Assign { .. }
            | Kind::OpAssign { .. } => false,
            _ => true,
        };
        this && self.kind.children().iter().all(|e| e.is_total())
    }
}

impl Expr {
    /// Whether it has arithmetic that is an error where an integer overflows.
    pub(crate) fn may_overflow(&self) -> bool {
        let this = match &self.kind {
            Kind::Binary { op, .. } => op.may_overflow,
            Kind::Neg(a) => !matches!(a.kind, Kind::Float(_) | Kind::Int { .. }),
            _ => false,
        };
        this || self.kind.children().iter().any(|e| e.may_overflow())
    }
}

impl Stmt {
    pub(crate) fn ends_lanes(&self) -> bool {
        match self {
            Self::Let(l) => l.init.as_ref().is_some_and(Expr::ends_lanes),
            Self::Expr(e) => e.ends_lanes(),
            Self::Item(_) => false,
        }
    }
}

impl Block {
    pub(crate) fn ends_lanes(&self) -> bool {
        self.children().iter().any(|e| e.ends_lanes())
    }

    /// Whether the function returns from within the block.
    pub(crate) fn returns(&self) -> bool {
        fn returns(e: &Expr) -> bool {
            matches!(e.kind, Kind::Return(_)) || e.kind.children().into_iter().any(returns)
        }
        self.children().into_iter().any(returns)
    }
}
