//! Which elementary function a kernel is: machines may have better means than its polynomial.

use crate::machine::{KernelFn, KernelInfo};

/// An elementary function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Function {
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Atan2,
    Exp,
    Exp2,
    Expm1,
    Log,
    Log2,
    Log1p,
    Pow,
    SinCos2Pi,
}

/// The elementary function that a kernel is. A kernel of a user may have the same name, but stands
/// elsewhere.
pub(crate) fn function(info: &KernelInfo) -> Option<Function> {
    macro_rules! find {
        ($($name:ident $function:ident)+) => {
            match info.name {
                $(stringify!($name) => (Function::$function, <super::$name as KernelFn>::info()),)+
                _ => return None,
            }
        };
    }
    let (function, own) = find!(
        sin Sin cos Cos tan Tan asin Asin acos Acos atan Atan atan2 Atan2 exp Exp exp2 Exp2
        expm1 Expm1 log Log log2 Log2 log1p Log1p pow Pow sincos_2pi SinCos2Pi
    );
    (info.file == own.file && info.line == own.line).then_some(function)
}
