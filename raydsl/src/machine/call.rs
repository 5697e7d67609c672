//! Kernels as functions generic over the machine.

use super::margin::Known;
use super::record::ir::Id;
use super::{Machine, Margin, Recorder, Type};

/// The source location of a kernel and the names of its parameters.
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
    /// Knowledge about the function beyond its code.
    pub known: Option<KnownBy>,
}

/// A function about which machines know more than its code says: `sin` is a builtin of WGSL, and in
/// std for `f64`.
pub(crate) trait KnownFunction: core::fmt::Debug + Sync {
    /// Records a call of WGSL's builtin, for code that need not give the same bits as the CPU.
    fn record_builtin(&self, _m: &Recorder, _args: &[Id]) -> Option<Vec<Id>> {
        None
    }

    /// Returns the results in `f64` with bounds on their rounding errors, or `None` if its code
    /// gives them.
    fn bound(&self, _m: &Margin, _args: &[Known]) -> Option<Vec<Known>> {
        None
    }

    /// Returns whether the results of `min` and `max` for a NaN are irrelevant in it, so that
    /// WGSL's own serve.
    fn is_without_nan(&self) -> bool {
        false
    }
}

/// A function called with numbers only, or whose results for a NaN nobody uses.
#[derive(Debug)]
pub(crate) struct WithoutNan;

impl KnownFunction for WithoutNan {
    fn is_without_nan(&self) -> bool {
        true
    }
}

/// The `KnownFunction` of a kernel.
#[derive(Clone, Copy, Debug)]
pub struct KnownBy(pub(crate) &'static dyn KnownFunction);

/// A `#[kernel] fn`: its scalar source and its lifted body.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no kernel that runs by itself",
    label = "other kernels can call it",
    note = "a kernel that runs by itself is a `#[kernel] fn` with one to eight parameters, none of them `&mut`, `#[host]`, a slice, a tree or a closure, and gives a value"
)]
pub trait KernelFn: 'static {
    /// The parameter types, as a tuple.
    type Args: Type;
    /// The result type.
    type Output: Type;

    /// Returns its source location and parameter names.
    fn info() -> &'static KernelInfo;

    /// Calls the user's own function.
    fn scalar(args: Self::Args) -> Self::Output;

    /// Runs the lifted body on machine `m`.
    fn lifted<M: Machine>(
        m: &M,
        args: <Self::Args as Type>::On<M>,
    ) -> <Self::Output as Type>::On<M>;
}
