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
    /// `usize`.
    Size,
    Vec2,
    Vec3,
    Vec4,
    IVec3,
    UVec2,
    BVec3,
    Kind,
    /// An enum with fields.
    Shape,
    /// `Option<u32>`.
    Maybe,
    /// `(f32, u32)`.
    Pair,
    /// `[f32; 4]`.
    Row,
    /// `[u32; 3]`.
    Counts,
    /// `[Small; 2]`.
    Both,
    Small,
    Nested,
    /// A struct of the module.
    Own,
    /// A type parameter.
    Any,
    /// `[f32; N]` with a constant parameter.
    List,
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
            Self::Size => "usize",
            Self::Vec2 => "Vec2",
            Self::Vec3 => "Vec3",
            Self::Vec4 => "Vec4",
            Self::IVec3 => "IVec3",
            Self::UVec2 => "UVec2",
            Self::BVec3 => "BVec3",
            Self::Kind => "Kind",
            Self::Shape => "Shape",
            Self::Maybe => "Option<u32>",
            Self::Pair => "(f32, u32)",
            Self::Row => "[f32; 4]",
            Self::Counts => "[u32; 3]",
            Self::Both => "[Small; 2]",
            Self::Small => "Small",
            Self::Nested => "Nested",
            Self::Own => "Own",
            Self::Any => "T",
            Self::List => "[f32; N]",
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
            Self::Size => "1usize",
            Self::Vec2 => "Vec2::X",
            Self::Vec3 => "Vec3::X",
            Self::Vec4 => "Vec4::X",
            Self::IVec3 => "IVec3::X",
            Self::UVec2 => "UVec2::X",
            Self::BVec3 => "BVec3::splat(true)",
            Self::Kind => "Kind::Red",
            Self::Shape => "Shape::Nothing",
            Self::Maybe => "Some(1u32)",
            Self::Pair => "(1.0f32, 1u32)",
            Self::Row => "[1.0f32; 4]",
            Self::Counts => "[1u32; 3]",
            Self::Both => "[Small::of(1u32); 2]",
            Self::Small => "Small::of(1u32)",
            Self::Nested => "Nested::of(1u32)",
            Self::Own => "Own::of(1u32)",
            Self::Any => "T::made(1u32)",
            Self::List => "[1.0f32; N]",
            Self::Outcome => "Outcome::of(1u32)",
        }
    }

    /// Whether there are floats in it.
    pub const fn has_floats(self) -> bool {
        !matches!(
            self,
            Self::U32
                | Self::I32
                | Self::Bool
                | Self::Size
                | Self::IVec3
                | Self::UVec2
                | Self::BVec3
                | Self::Kind
                | Self::Maybe
                | Self::Counts
        )
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

/// How a parameter is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// `p: T`.
    Value,
    /// `mut p: T`.
    Mutable,
    /// `p: &T`.
    Shared,
    /// `p: &mut T`.
    Changed,
    /// `#[host] p: T`.
    Host,
}

/// A parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Param {
    /// Its name; `self` is a receiver.
    pub name: String,
    /// Its type.
    pub ty: Ty,
    /// How it is taken.
    pub mode: Mode,
}

/// What kind of function it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Head {
    /// `fn f(..)`.
    Plain,
    /// `fn f<T: Weigh>(..)`.
    OfType,
    /// `fn f<const N: usize>(..)`.
    OfCount,
    /// `fn f<S: RayQuery + ?Sized>(scene: &S, ..)`.
    OfScene,
    /// A method of `Own`.
    Method,
    /// The method `weight` of `impl Weigh for Own`.
    Weight,
}

/// A `#[kernel] fn`.
#[derive(Clone, Debug, PartialEq)]
pub struct Function {
    /// Its name.
    pub name: String,
    /// What kind it is.
    pub head: Head,
    /// Whether it is `#[coherent]`.
    pub coherent: bool,
    /// Whether it takes the slices of the scene too.
    pub sliced: bool,
    /// Its parameters.
    pub params: Vec<Param>,
    /// The type of its result.
    pub result: Ty,
    /// Its body.
    pub body: Block,
}

/// The slices and numbers that a kernel reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scene {
    /// Elements of the slices, at most.
    pub len: usize,
    /// A number of the host.
    pub count: u32,
    /// Whether there is a closure too that captures them.
    pub closure: bool,
}

/// A kernel: the function `entry`, which comes last, and those that it may call.
#[derive(Clone, Debug, PartialEq)]
pub struct Kernel {
    /// The seed that gave it.
    pub seed: u64,
    /// Whether it has the struct `Own`.
    pub own: bool,
    /// What else it reads.
    pub scene: Option<Scene>,
    /// Each calls only earlier ones.
    pub functions: Vec<Function>,
}
