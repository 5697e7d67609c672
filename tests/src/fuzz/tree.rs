//! What a generated kernel is made of.
//!
//! The tree knows types and blocks, not the syntax of every construct: an expression or a
//! statement is text with expressions and blocks in it. That is all that printing and shrinking
//! need, and a new construct of the language is one line in the generator's tables.

/// The types of generated expressions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names are those of the types")]
pub enum Ty {
    F32,
    U32,
    I32,
    Bool,
    Vec3,
    Small,
    Nested,
    Outcome,
}

impl Ty {
    /// Its name in Rust.
    pub const fn name(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::U32 => "u32",
            Self::I32 => "i32",
            Self::Bool => "bool",
            Self::Vec3 => "Vec3",
            Self::Small => "Small",
            Self::Nested => "Nested",
            Self::Outcome => "Outcome",
        }
    }

    /// The plainest expression of the type, which shrinking tries in place of others.
    pub const fn plain(self) -> &'static str {
        match self {
            Self::F32 => "1.0f32",
            Self::U32 => "1u32",
            Self::I32 => "1i32",
            Self::Bool => "true",
            Self::Vec3 => "Vec3::X",
            Self::Small => "Small::of(1u32)",
            Self::Nested => "Nested::of(1u32)",
            Self::Outcome => "Outcome::of(1u32)",
        }
    }
}

/// A part of an expression or a statement.
#[derive(Clone, Debug, PartialEq)]
pub enum Piece {
    /// Rust text.
    Text(String),
    /// An expression.
    Expr(Expr),
    /// A block with its braces.
    Block(Block),
}

/// An expression. Its text needs no parentheses around it, wherever it stands.
#[derive(Clone, Debug, PartialEq)]
pub struct Expr {
    /// Its type.
    pub ty: Ty,
    /// Its parts.
    pub pieces: Vec<Piece>,
}

impl Expr {
    /// An expression without others in it.
    pub fn text(ty: Ty, text: impl Into<String>) -> Self {
        Self { ty, pieces: vec![Piece::Text(text.into())] }
    }
}

/// A statement.
#[derive(Clone, Debug, PartialEq)]
pub struct Stmt {
    /// Its parts.
    pub pieces: Vec<Piece>,
    /// Whether the kernel still compiles and ends without it.
    pub removable: bool,
}

/// Statements, and the value of the block if it has one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Block {
    /// The statements.
    pub stmts: Vec<Stmt>,
    /// The value.
    pub tail: Option<Box<Expr>>,
}

/// A `#[kernel] fn`.
#[derive(Clone, Debug, PartialEq)]
pub struct Function {
    /// Its name.
    pub name: String,
    /// The names and types of its parameters; some are `mut`.
    pub params: Vec<(String, Ty)>,
    /// The type of its result.
    pub result: Ty,
    /// Its body.
    pub body: Block,
}

/// A kernel: the function `entry`, which comes last, and those that it may call.
#[derive(Clone, Debug, PartialEq)]
pub struct Kernel {
    /// The seed that gave it.
    pub seed: u64,
    /// Each calls only earlier ones.
    pub functions: Vec<Function>,
}
