//! What a kernel may call, and what it may not: one table.

use crate::model::BinaryOp;

macro_rules! operators {
    ($($name:ident = $operator:literal $method:literal $trap:literal $overflow:literal;)+) => {
        $(
            pub(crate) const $name: BinaryOp = BinaryOp {
                operator: $operator,
                method: $method,
                may_trap: $trap,
                may_overflow: $overflow,
            };
        )+
    };
}

// The last two columns: `may_trap`, `may_overflow`. `+`, `-`, `*` and shifts are errors on overflow
// where debug assertions are on; the packet machine masks those checks itself, so evaluating them
// under a narrowed mask is safe. Division is not: its lanes must run.
operators! {
    ADD = "OpAdd" "add" false true;
    SUB = "OpSub" "sub" false true;
    MUL = "OpMul" "mul" false true;
    DIV = "OpDiv" "div" true true;
    REM = "OpRem" "rem" true true;
    BIT_AND = "OpBitAnd" "bit_and" false false;
    BIT_OR = "OpBitOr" "bit_or" false false;
    BIT_XOR = "OpBitXor" "bit_xor" false false;
    SHL = "OpShl" "shl" false true;
    SHR = "OpShr" "shr" false true;
}

/// Elementary functions: std's differ from one machine to the next, so variants could not agree.
/// The second column is what the prelude has instead, if anything.
const ELEMENTARY: &[(&str, &str)] = &[
    ("sin", "sin(x)"),
    ("cos", "cos(x)"),
    ("tan", "tan(x)"),
    ("asin", "asin(x)"),
    ("acos", "acos(x)"),
    ("atan", "atan(x)"),
    ("atan2", "atan2(y, x)"),
    ("sin_cos", "sincos_2pi(u)"),
    ("exp", "exp(x)"),
    ("exp2", "exp2(x)"),
    ("exp_m1", "expm1(x)"),
    ("ln", "log(x)"),
    ("ln_1p", "log1p(x)"),
    ("log2", "log2(x)"),
    ("powf", "pow(x, y)"),
    ("powi", "pow(x, y)"),
    ("log", ""),
    ("log10", ""),
    ("hypot", ""),
    ("cbrt", ""),
    ("sinh", ""),
    ("cosh", ""),
    ("tanh", ""),
];

/// Other methods that kernels cannot have, with what to write instead.
const DENIED: &[(&str, &str)] = &[
    ("unwrap", "a value with a flag: kernels have no Option"),
    ("expect", "a value with a flag: kernels have no Option"),
    ("to_string", "nothing: kernels have no strings"),
    ("clone", "the value itself: kernel types are Copy"),
    ("iter", "a `for` over a range"),
    ("len", "a captured `u32`"),
];

/// What is wrong with the method `name` and what to write instead, if kernels cannot have it.
pub(crate) fn denied(name: &str) -> Option<(String, String)> {
    if let Some((_, ours)) = ELEMENTARY.iter().find(|e| e.0 == name) {
        let help = if ours.is_empty() {
            "compute it outside the kernel and capture the result".to_owned()
        } else {
            format!("write `{ours}`, the function of raydsl's prelude")
        };
        return Some((format!("`{name}` of std differs from one machine to the next"), help));
    }
    let (_, instead) = DENIED.iter().find(|d| d.0 == name)?;
    Some((format!("a kernel has no `{name}`"), format!("write {instead}")))
}
