//! Elementary functions as known to machines: WGSL builtins and bounds.

use super::bounds;
use crate::machine::margin::Known;
use crate::machine::record::ir::{Expr, Id, Type};
use crate::machine::{KnownFunction, Machine, Margin, Recorder, op};

/// Elementary functions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Function {
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

impl KnownFunction for Function {
    fn record_builtin(&self, m: &Recorder, args: &[Id]) -> Option<Vec<Id>> {
        let of = |name, args: &[Id]| m.add(Expr::Builtin(name, args.to_vec()), Type::F32);
        let name = match self {
            Self::Sin => "sin",
            Self::Cos => "cos",
            Self::Tan => "tan",
            Self::Asin => "asin",
            Self::Acos => "acos",
            Self::Atan => "atan",
            Self::Atan2 => "atan2",
            Self::Exp => "exp",
            Self::Exp2 => "exp2",
            Self::Log => "log",
            Self::Log2 => "log2",
            Self::Pow => "pow",
            Self::SinCos2Pi => {
                let turn = m.f32(core::f32::consts::TAU);
                let angle = m.f32_binary(op::Mul, args[0], turn);
                return Some(vec![of("sin", &[angle]), of("cos", &[angle])]);
            }
            Self::Expm1 | Self::Log1p => return None,
        };
        Some(vec![of(name, args)])
    }

    fn bound(&self, m: &Margin, args: &[Known]) -> Option<Vec<Known>> {
        Some(bounds::of(m, *self, args))
    }
}
