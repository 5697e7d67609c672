//! The only names that generated code uses. Not for people: anything here may change.

pub use crate::geometry::{Aabb, Hit, HitOn, HitRecord, Kinds, Primitive, Ray, RayOn};
pub use crate::kernel::{Counting, Kernel, Lifted, Native4, Native8, Native16};
pub use crate::machine::{
    Assigned, B, Branch, Capture, Coerce, Compare, Const, Cursor, Field, HostMethod, Inferred,
    KernelFn, KernelInfo, KnownBy, LaneMachine, Leaves, Loop, Machine, Margin, Method, Op, OpAdd,
    OpAnd, OpBitAnd, OpBitOr, OpBitXor, OpCast, OpCompare, OpDiv, OpMul, OpNeg, OpNot, OpOr, OpRem,
    OpShl, OpShr, OpSub, Parameter, Recorder, Resource, Ret, RightOperand, Schema, Slice, Steps,
    Stop, Through, Twin, Type, Value, Var, Varying, call_on_element, decrement, host_of_words,
    increment, is_kind, is_mut, name, of_kind, of_words, op, to_words, to_words_on,
};

/// Traits of associated functions.
pub mod operations {
    pub use crate::machine::functions::{
        Affine3Functions as _, F32Functions as _, Mat3Functions as _, Mat4Functions as _,
        Vec2New as _, Vec3New as _, Vec4New as _, VectorFunctions as _,
    };
    pub use crate::machine::host::GiveConstant as _;
}

pub use crate::machine::host::{Constant, HostCapture, HostUse};
pub use crate::machine::index::with_element;
pub use crate::machine::lowered::*;

/// What the crate `raydsl-report` uses besides.
pub mod report {
    pub use crate::testing::{OutcomesOf, SAMPLES, causes, sampled, spread};
}
