//! Kernels as functions of a machine.

use super::{Machine, Type};

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
}

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
