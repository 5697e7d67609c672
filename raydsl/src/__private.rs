//! The only names that generated code uses. Not for people: anything here may change.

pub use crate::bvh::{Joined, RayQueryOn, RecordQuery, SceneArgument, Tabled};
pub use crate::geometry::{
    Aabb, Hit, HitOn, HitRecord, Kinds, Lacking, Primitive, Ray, RayOn, Several, Shared,
    SurfacePointOn, shared_among, shared_of_kind, shared_views,
};
pub use crate::kernel::{Counting, Kernel, Lifted, Native4, Native8, Native16};
pub use crate::machine::lifted::*;
pub use crate::machine::{
    B, Capture, Compare, ConstantFact, F, Field, KernelFn, KernelInfo, Lanes, Machine, Margin, Op,
    Recorder, Resource, Schema, Slice, Table, TableView, Type, Value, VisitConstant, op,
    visit_host, visit_known, visit_value,
};
pub use crate::shading::{Asked, Scene};

/// Traits of associated functions.
pub mod operations {
    pub use crate::machine::functions::{
        Affine3Functions as _, F32Functions as _, Mat3Functions as _, Mat4Functions as _,
        Vec2New as _, Vec3New as _, Vec4New as _, VectorFunctions as _,
    };
    pub use crate::machine::lifted::GiveConstant as _;
}

/// What the crate `raydsl-report` uses besides.
pub mod report {
    pub use crate::render::outcomes_of_frame;
    pub use crate::testing::{OutcomesOf, SAMPLES, causes, sampled, spread};
}
