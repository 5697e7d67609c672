//! What the twins of a type look like: names, members, offsets.

/// The structure of a [`Type`](super::Type), as the recorder and the GPU need to know it.
///
/// *Value* structure is how a kernel sees it (an 8-bit unorm is a `u32` in WGSL), *storage* is how
/// it lies in the host's memory (one byte); both are described at once.
#[derive(Debug, PartialEq)]
pub enum Schema {
    /// `f32`.
    F32,
    /// `i32`.
    I32,
    /// `u32`.
    U32,
    /// `bool`: a byte in memory.
    Bool,
    /// An unsigned number of 1 or 2 bytes in memory, `u32` in a kernel.
    Small {
        /// Bytes in memory: 1 or 2.
        bytes: usize,
    },
    /// A vector of glam's: that many scalars (the first part) without a gap.
    Vector(&'static Schema, usize),
    /// `[T; N]`.
    Array {
        /// The element.
        element: &'static Schema,
        /// How many.
        count: usize,
        /// Bytes from one to the next.
        stride: usize,
    },
    /// A struct or tuple.
    Struct {
        /// The struct's name.
        name: &'static str,
        /// Its members in order of declaration.
        fields: &'static [Field],
        /// Bytes from one to the next in an array.
        size: usize,
    },
    /// A value of the host that leaves no trace in generated code.
    Host,
}

/// A member of a struct.
#[derive(Debug, PartialEq)]
pub struct Field {
    /// The member's name.
    pub name: &'static str,
    /// Its distance in bytes from the start of the struct.
    pub offset: usize,
    /// Its structure.
    pub schema: &'static Schema,
}

impl Schema {
    /// How many scalars a value has.
    pub const fn leaves(&self) -> usize {
        match self {
            Self::F32 | Self::I32 | Self::U32 | Self::Bool | Self::Small { .. } => 1,
            Self::Vector(_, n) => *n,
            Self::Array { element, count, .. } => element.leaves() * *count,
            Self::Struct { fields, .. } => {
                let (mut sum, mut i) = (0, 0);
                while i < fields.len() {
                    sum += fields[i].schema.leaves();
                    i += 1;
                }
                sum
            }
            Self::Host => 0,
        }
    }

    /// Bytes of one value in the host's memory, padding at the end included.
    pub const fn size(&self) -> usize {
        match self {
            Self::F32 | Self::I32 | Self::U32 => 4,
            Self::Bool => 1,
            Self::Small { bytes } => *bytes,
            Self::Vector(element, n) => element.size() * *n,
            Self::Array { count, stride, .. } => *count * *stride,
            Self::Struct { size, .. } => *size,
            Self::Host => 0,
        }
    }
}
