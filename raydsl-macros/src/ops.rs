//! Table of the operations that a kernel may call, and those it may not.

use crate::model::BinaryOp;

macro_rules! operators {
    ($(
        $name:ident = $symbol:literal $operator:literal $method:literal
            $trap:literal $overflow:literal;
    )+) => {
        $(
            pub(crate) const $name: BinaryOp = BinaryOp {
                symbol: $symbol,
                operator: $operator,
                method: $method,
                may_trap: $trap,
                may_overflow: $overflow,
            };
        )+
    };
}

// The last two columns: `may_trap`, `may_overflow`. `+`, `-`, `*` and shifts are errors on overflow
// with debug assertions; the packet machine masks those checks itself, so evaluating them under a
// narrowed mask is safe. Division is not: its lanes must run.
operators! {
    ADD = "+" "OpAdd" "add" false true;
    SUB = "-" "OpSub" "sub" false true;
    MUL = "*" "OpMul" "mul" false true;
    DIV = "/" "OpDiv" "div" true true;
    REM = "%" "OpRem" "rem" true true;
    BIT_AND = "&" "OpBitAnd" "bit_and" false false;
    BIT_OR = "|" "OpBitOr" "bit_or" false false;
    BIT_XOR = "^" "OpBitXor" "bit_xor" false false;
    SHL = "<<" "OpShl" "shl" false true;
    SHR = ">>" "OpShr" "shr" false true;
}

/// An operator that a user's type may have.
pub(crate) struct Overloaded {
    /// Its trait in the runtime; without `Op` it is std's.
    pub(crate) operator: &'static str,
    pub(crate) method: &'static str,
    /// The function of the trait `AddAssign` and its like.
    pub(crate) assigning: &'static str,
    pub(crate) symbol: &'static str,
}

macro_rules! overloaded {
    ($($op:ident $assigning:literal),+) => {
        &[$(Overloaded {
            operator: $op.operator,
            method: $op.method,
            assigning: $assigning,
            symbol: $op.symbol,
        }),+]
    };
}

pub(crate) const OVERLOADED: &[Overloaded] = overloaded![
    ADD "add_assign", SUB "sub_assign", MUL "mul_assign", DIV "div_assign", REM "rem_assign"
];

/// Returns the hash of a text (FNV-1a, 64 bits), to form a name.
pub(crate) fn hash(text: &str) -> u64 {
    let step = |hash: u64, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    text.bytes().fold(0xcbf2_9ce4_8422_2325, step)
}

/// Elementary functions: std's differ between platforms, so variants could not agree. The second
/// column is the prelude's replacement, if there is one.
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

/// Other methods that kernels cannot have, with their replacements.
const DENIED: &[(&str, &str)] = &[
    ("unwrap", "`unwrap_or(x)`, or `if let Some(x) = ..`: a kernel cannot stop"),
    ("expect", "`unwrap_or(x)`, or `if let Some(x) = ..`: a kernel cannot stop"),
    ("to_string", "nothing: kernels have no strings"),
    ("clone", "the value itself: kernel types are Copy"),
    ("iter", "`for x in list.iter()`, or a `for` over a range"),
];

/// Methods of arrays, slices and lists that kernels do not have, with their replacements.
const OF_LISTS: &[(&[&str], &str)] = &[
    (&["fill"], "a new array: `xs = [0.0; 4];`"),
    (
        &["sort", "sort_by", "sort_by_key", "sort_unstable", "sort_unstable_by", "reverse"],
        "a loop with `xs.swap(i, j)`",
    ),
    (
        &["contains", "starts_with", "binary_search", "position"],
        "a `for` with a variable: `for x in xs.iter() { found |= *x == y; }`",
    ),
    (&["first"], "`xs[0]`"),
    (&["last"], "`xs[xs.len() - 1]`"),
    (&["get", "get_mut"], "`if i < xs.len() { xs[i] } else { .. }`"),
    (&["push", "pop", "insert", "remove", "clear"], "an array and a count: `xs[n] = x; n += 1;`"),
    (&["iter_mut"], "a `for` over the indices: `for i in 0..xs.len() { xs[i] += 1.0; }`"),
    (&["chunks", "windows", "split_at", "concat", "to_vec"], "a `for` over the indices"),
];

/// Types of Rust that no kernel has, with their replacements.
const REFUSED_TYPES: &[(&[&str], &str)] = &[
    (&["f64"], "compute in `f32`; `Kernel::reference` gives the result in `f64`"),
    (
        &["u8", "i8", "u16", "i16", "u64", "i64", "u128", "i128", "isize"],
        "use `u32`, `i32` or `usize`, which has 32 bits in a kernel; for small members of structs \
         there are `Unorm8` and `Unorm16`",
    ),
    (&["Result"], "give a value that says what happened, as `Hit` has `is_hit`"),
    (&["String", "str", "char"], "keep text outside the kernel"),
    (&["Vec", "Box", "HashMap"], "capture a slice or take one as `&[f32]`: kernels have no heap"),
];

/// Returns the replacement of the type `name`, if no kernel has it.
pub(crate) fn refused_type(name: &str) -> Option<&'static str> {
    REFUSED_TYPES.iter().find(|r| r.0.contains(&name)).map(|r| r.1)
}

/// A method of a library type that kernels cannot have.
pub(crate) struct Denied {
    pub(crate) what: String,
    pub(crate) help: String,
    /// Whether rustc refuses it if the macro does not know the receiver's type.
    pub(crate) seen_by_type: bool,
}

/// Returns the problem and the remedy of the method `name`, if kernels cannot have it.
pub(crate) fn denied(name: &str) -> Option<Denied> {
    if let Some((_, ours)) = ELEMENTARY.iter().find(|e| e.0 == name) {
        let help = if ours.is_empty() {
            "compute it outside the kernel and capture the result".to_owned()
        } else {
            format!("write `{ours}`, the function of raydsl's prelude")
        };
        let what = format!("`{name}` of std differs from one machine to the next");
        return Some(Denied { what, help, seen_by_type: true });
    }
    if let Some((_, instead)) = OF_LISTS.iter().find(|l| l.0.contains(&name)) {
        let what = format!("a kernel has no `{name}` of arrays and slices");
        return Some(Denied { what, help: format!("write {instead}"), seen_by_type: true });
    }
    let (_, instead) = DENIED.iter().find(|d| d.0 == name)?;
    let what = format!("a kernel has no `{name}`");
    Some(Denied { what, help: format!("write {instead}"), seen_by_type: false })
}

/// Types of Rust and glam that kernels have.
pub(crate) const LIBRARY: &[&str] = &[
    "f32", "i32", "u32", "usize", "bool", "Vec2", "Vec3", "Vec4", "IVec2", "IVec3", "IVec4",
    "UVec2", "UVec3", "UVec4", "BVec2", "BVec3", "BVec4", "Mat3", "Mat4", "Affine3", "Ray", "Hit",
];

/// Returns whether the type is one of Rust's or glam's.
pub(crate) fn is_of_library(name: &str) -> bool {
    LIBRARY.contains(&name)
}

/// Types whose data kernels read in place: trees, lists of trees, textures.
const DATA: &[&str] = &[
    "Bvh",
    "BvhList",
    "Instances",
    "Accelerated",
    "Texture",
    "Texture1",
    "Texture2",
    "Texture3",
    "TextureRef",
    "TextureRef1",
    "TextureRef2",
    "TextureRef3",
    "Texels",
    "TransferFunction",
    "Environment",
];

/// Returns whether kernels read the type's data in place.
pub(crate) fn is_data(name: &str) -> bool {
    DATA.contains(&name)
}

/// Methods of Rust's and glam's types that take a second value.
const OF_TWO: &[&str] = &[
    "min",
    "max",
    "copysign",
    "rem_euclid",
    "wrapping_add",
    "wrapping_sub",
    "wrapping_mul",
    "saturating_sub",
    "dot",
    "cross",
    "distance",
];

/// Methods of Rust's and glam's types that take the value alone.
const OF_ONE: &[&str] = &[
    "abs",
    "sqrt",
    "floor",
    "ceil",
    "trunc",
    "round",
    "fract",
    "signum",
    "recip",
    "to_bits",
    "to_radians",
    "to_degrees",
    "is_nan",
    "is_finite",
    "count_ones",
    "leading_zeros",
    "length",
    "length_squared",
    "normalize",
];

/// Returns whether `f32::name(..)` is the method `name` of its first argument.
pub(crate) fn is_plain_method(name: &str) -> bool {
    matches!(name, "clamp" | "mul_add") || OF_TWO.contains(&name) || OF_ONE.contains(&name)
}

/// Returns the replacement of `f32::name(..)`, if `name` is a method.
pub(crate) fn method_of_library(name: &str) -> Option<String> {
    if let Some((_, ours)) = ELEMENTARY.iter().find(|e| e.0 == name && !e.1.is_empty()) {
        return Some(format!("write `{ours}`, the function of raydsl's prelude"));
    }
    let call = match name {
        "clamp" => "x.clamp(low, high)".to_owned(),
        "mul_add" => "x.mul_add(a, b)".to_owned(),
        _ if OF_TWO.contains(&name) => format!("a.{name}(b)"),
        _ if OF_ONE.contains(&name) => format!("x.{name}()"),
        _ => return None,
    };
    Some(format!("write `{call}`"))
}

/// Returns the replacement of a function of std.
pub(crate) fn instead_of_std(name: &str) -> String {
    match name {
        "min" | "max" => format!("write `{name}(a, b)`, the function of raydsl's prelude"),
        "replace" | "take" => "copy the value to a variable, and assign the new one".to_owned(),
        _ => "write it with the functions of raydsl's prelude, or as a `#[kernel] fn`".to_owned(),
    }
}

/// Functions of the prelude that packets run in a few operations, and their number.
const CHEAP_FUNCTIONS: &[(&str, u32)] =
    &[("min", 2), ("max", 2), ("clamp", 4), ("select", 1), ("vec2", 0), ("vec3", 0), ("vec4", 0)];

/// Methods of numbers and vectors that packets run in a few operations, and their number.
const CHEAP_METHODS: &[(&str, u32)] = &[
    ("abs", 1),
    ("sqrt", 12),
    ("floor", 1),
    ("ceil", 1),
    ("trunc", 1),
    ("min", 3),
    ("max", 3),
    ("clamp", 4),
    ("copysign", 3),
    ("to_bits", 0),
    ("mul_add", 1),
    ("dot", 5),
    ("length_squared", 5),
    ("wrapping_add", 1),
    ("wrapping_sub", 1),
    ("wrapping_mul", 2),
];

/// Returns the cost of a call of a prelude function, if it is small.
pub(crate) fn cheap_function(name: &str) -> Option<u32> {
    CHEAP_FUNCTIONS.iter().find(|f| f.0 == name).map(|f| f.1)
}

/// Returns the cost of a method, if it is small.
pub(crate) fn cheap_method(name: &str) -> Option<u32> {
    CHEAP_METHODS.iter().find(|f| f.0 == name).map(|f| f.1)
}
