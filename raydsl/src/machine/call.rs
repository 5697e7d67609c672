//! Kernels as functions of a machine.

use super::margin::Known;
use super::record::ir::Id;
use super::{Machine, Margin, Recorder, Type};

/// Where a kernel stands in the source, and the names of its parameters.
#[derive(Debug)]
pub struct KernelInfo {
    /// The function's name, or `Type_method`.
    pub name: &'static str,
    /// The file of its source.
    pub file: &'static str,
    /// The line of its source.
    pub line: u32,
    /// The parameters' names.
    pub params: &'static [&'static str],
    /// What machines know of it beyond its code.
    pub known: Option<KnownBy>,
}

/// A function of which machines know more than its code says: `sin` is in WGSL, and in std for
/// `f64`.
pub(crate) trait KnownFunction: core::fmt::Debug + Sync {
    /// Records what WGSL itself has for it, for code that need not be the same as on the CPU.
    fn record_builtin(&self, _m: &Recorder, _args: &[Id]) -> Option<Vec<Id>> {
        None
    }

    /// Its results in `f64`, with bounds of what rounding may do, if its code does not say them.
    fn bound(&self, _m: &Margin, _args: &[Known]) -> Option<Vec<Known>> {
        None
    }

    /// Whether it does not matter what `min` and `max` in it give for a NaN, so that WGSL's own
    /// serve.
    fn is_without_nan(&self) -> bool {
        false
    }
}

/// A function that is asked about numbers alone, or whose results for a NaN nobody uses.
#[derive(Debug)]
pub(crate) struct WithoutNan;

impl KnownFunction for WithoutNan {
    fn is_without_nan(&self) -> bool {
        true
    }
}

/// Who knows more of a kernel.
#[derive(Clone, Copy, Debug)]
pub struct KnownBy(pub(crate) &'static dyn KnownFunction);

/// A `#[kernel] fn`: its scalar source and its lifted body.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no kernel that runs by itself",
    label = "other kernels can call it",
    note = "a kernel that runs by itself is a `#[kernel] fn` with one parameter or more, none of them `&mut`, `#[host]`, a slice or a tree, and gives a value"
)]
pub trait KernelFn: 'static {
    /// The parameters, as a tuple.
    type Args: Type;
    /// The result.
    type Output: Type;

    /// Where it stands in the source.
    fn info() -> &'static KernelInfo;

    /// The user's own function.
    fn scalar(args: Self::Args) -> Self::Output;

    /// The lifted body on machine `m`.
    fn lifted<M: Machine>(
        m: &M,
        args: <Self::Args as Type>::On<M>,
    ) -> <Self::Output as Type>::On<M>;
}
