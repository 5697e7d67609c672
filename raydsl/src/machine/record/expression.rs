//! Printing of expressions, with the parentheses that WGSL requires.

use super::function::Text;
use super::ir::{Conversion, Expr, Id, Recorded, Type};
use super::names::{self, member_name};
use super::types::Names;
use crate::machine::wgsl::Quotients;
use crate::machine::{BoolBinary, F32Binary, F32Unary, IntBinary};

/// Operator precedence; an operand of lower precedence gets parentheses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Bind {
    Or,
    And,
    Compare,
    Sum,
    Product,
    Unary,
    Primary,
}

/// Prints a literal of type `f32`: without the suffix WGSL would evaluate two of them in `f64`.
fn f32_text(bits: u32) -> String {
    let v = f32::from_bits(bits);
    if v.abs() == f32::MAX {
        // Its shortest decimal is greater than it, and a strict WGSL parser rejects that.
        return format!("{v:.1}f");
    }
    format!("{v:?}f")
}

/// Prints the expressions of one function.
pub(super) struct Expressions<'a> {
    pub(super) function: &'a Recorded,
    /// The local names of expressions that have a `let`.
    pub(super) locals: &'a [Option<String>],
    pub(super) text: &'a Text<'a>,
}

impl Expressions<'_> {
    /// Prints `id` where any precedence is allowed.
    pub(super) fn any(&self, id: Id, names: &mut Names) -> String {
        self.expr(id, names).0
    }

    /// Prints `id` as an item of a list: comparisons and shifts there would parse as a template
    /// list.
    fn item(&self, id: Id, names: &mut Names) -> String {
        self.at_least(id, Bind::Sum, names)
    }

    /// Prints the definition of an expression that has a name.
    pub(super) fn definition(&self, id: Id, names: &mut Names) -> String {
        self.spell(id, names).0
    }

    fn at_least(&self, id: Id, bind: Bind, names: &mut Names) -> String {
        let (text, own) = self.expr(id, names);
        if own >= bind { text } else { format!("({text})") }
    }

    fn expr(&self, id: Id, names: &mut Names) -> (String, Bind) {
        match &self.locals[id.0 as usize] {
            Some(name) => (name.clone(), Bind::Primary),
            None => self.spell(id, names),
        }
    }

    fn spell(&self, id: Id, names: &mut Names) -> (String, Bind) {
        let node = &self.function.nodes[id.0 as usize];
        let primary = |text: String| (text, Bind::Primary);
        match &node.expr {
            Expr::F32(bits) if bits >> 31 == 1 => (f32_text(*bits), Bind::Unary),
            Expr::F32(bits) => primary(f32_text(*bits)),
            Expr::I32(i32::MIN) => primary("(-2147483647i - 1i)".to_owned()),
            Expr::I32(v) if *v < 0 => (format!("{v}i"), Bind::Unary),
            Expr::I32(v) => primary(format!("{v}i")),
            Expr::U32(v) => primary(format!("{v}u")),
            Expr::Bool(v) => primary(v.to_string()),
            Expr::Param(i) => primary(self.text.param(self.function, *i)),
            Expr::Uniform(i) => primary(format!("params.{}", self.text.uniform(*i))),
            Expr::Member(a, name) => primary(format!(
                "{}.{}",
                self.at_least(*a, Bind::Primary, names),
                member_name(name)
            )),
            Expr::Element(a, i) => {
                primary(format!("{}[{i}]", self.at_least(*a, Bind::Primary, names)))
            }
            Expr::Load(v) => primary(self.text.var(self.function, *v)),
            Expr::Address(v) => (format!("&{}", self.text.var(self.function, *v)), Bind::Unary),
            Expr::F32Unary(F32Unary::Neg, a) | Expr::Neg(a) => self.prefix("-", *a, names),
            Expr::Not(a) => self.prefix("!", *a, names),
            Expr::Complement(a) => self.prefix("~", *a, names),
            Expr::F32Unary(F32Unary::Sqrt, a) if names.quotients == Quotients::Corrected => {
                primary(self.corrected("exact_root", node.ty, &[*a], names))
            }
            Expr::F32Unary(op, a) => primary(format!("{}({})", op.wgsl(), self.any(*a, names))),
            Expr::U32Unary(op, a) => primary(format!("{}({})", op.wgsl(), self.any(*a, names))),
            Expr::F32Binary(F32Binary::Div, a, b)
                if names.quotients == Quotients::Corrected && !self.is_power_of_two(*b) =>
            {
                primary(self.corrected("exact_quotient", node.ty, &[*a, *b], names))
            }
            Expr::F32Binary(op, a, b) => self.f32_binary(*op, *a, *b, names),
            Expr::MulAdd(a, b, c) => {
                let [a, b, c] = [a, b, c].map(|x| self.item(*x, names));
                primary(format!("fma({a}, {b}, {c})"))
            }
            Expr::IntBinary(op, a, b) => self.int_binary(*op, *a, *b, names),
            Expr::BoolBinary(op, a, b) => self.bool_binary(*op, *a, *b, names),
            Expr::Compare(op, a, b) => {
                self.infix(op.wgsl(), Bind::Compare, (*a, Bind::Sum), (*b, Bind::Sum), names)
            }
            Expr::Select(c, a, b) => {
                let [c, a, b] = [c, a, b].map(|x| self.item(*x, names));
                primary(format!("select({b}, {a}, {c})"))
            }
            Expr::Convert(how, a) => primary(self.convert(*how, node.ty, *a, names)),
            Expr::Builtin(name, args) => {
                let args: Vec<String> = args.iter().map(|a| self.any(*a, names)).collect();
                primary(format!("{name}({})", args.join(", ")))
            }
            Expr::Call(f, args) => {
                let args: Vec<String> = args.iter().map(|a| self.item(*a, names)).collect();
                primary(format!("{}({})", self.text.function(*f), args.join(", ")))
            }
            Expr::Compose(parts) if let Some((a, swizzle)) = self.swizzle(parts, node.ty) => {
                primary(format!("{}.{swizzle}", self.at_least(a, Bind::Primary, names)))
            }
            Expr::Compose(parts) => {
                let ty = names.ty(node.ty);
                let same =
                    parts.iter().all(|p| *p == parts[0]) && matches!(node.ty, Type::Vector(..));
                let shown = if same { &parts[..1] } else { &parts[..] };
                let parts: Vec<String> = shown.iter().map(|p| self.item(*p, names)).collect();
                primary(format!("{ty}({})", parts.join(", ")))
            }
        }
    }

    /// Returns the vector that all `parts` are components of, and the swizzle.
    fn swizzle(&self, parts: &[Id], ty: Type) -> Option<(Id, String)> {
        let member = |id: &Id| match &self.function.nodes[id.0 as usize].expr {
            Expr::Member(a, name) if self.locals[id.0 as usize].is_none() => Some((*a, *name)),
            _ => None,
        };
        let (whole, _) = member(parts.first()?)?;
        let from = self.function.nodes[whole.0 as usize].ty;
        let are_vectors = matches!((ty, from), (Type::Vector(..), Type::Vector(..)));
        let names: Option<String> =
            parts.iter().map(|p| member(p).filter(|(a, _)| *a == whole).map(|(_, n)| n)).collect();
        Some((whole, names.filter(|_| are_vectors)?))
    }

    fn prefix(&self, symbol: &str, a: Id, names: &mut Names) -> (String, Bind) {
        (format!("{symbol}{}", self.at_least(a, Bind::Primary, names)), Bind::Unary)
    }

    fn infix(
        &self,
        symbol: &str,
        bind: Bind,
        (a, left): (Id, Bind),
        (b, right): (Id, Bind),
        names: &mut Names,
    ) -> (String, Bind) {
        let a = self.at_least(a, left, names);
        let b = self.at_least(b, right, names);
        (format!("{a} {symbol} {b}"), bind)
    }

    fn f32_binary(&self, op: F32Binary, a: Id, b: Id, names: &mut Names) -> (String, Bind) {
        let sum =
            |s, t: &mut Names| self.infix(s, Bind::Sum, (a, Bind::Sum), (b, Bind::Product), t);
        let product = |s, t: &mut Names| {
            self.infix(s, Bind::Product, (a, Bind::Product), (b, Bind::Unary), t)
        };
        let chosen = |less: bool, t: &mut Names| {
            if self.function.is_without_nan {
                let name = if less { "min" } else { "max" };
                let text = format!("{name}({}, {})", self.any(a, t), self.any(b, t));
                return (text, Bind::Primary);
            }
            let (a, b) = (self.at_least(a, Bind::Sum, t), self.at_least(b, Bind::Sum, t));
            let c = if less { format!("{b} < {a}") } else { format!("{a} < {b}") };
            (format!("select({a}, {b}, {c})"), Bind::Primary)
        };
        match op {
            F32Binary::Add => sum("+", names),
            F32Binary::Sub => sum("-", names),
            F32Binary::Mul => product("*", names),
            F32Binary::Div => product("/", names),
            F32Binary::Min => chosen(true, names),
            F32Binary::Max => chosen(false, names),
        }
    }

    /// Prints a call of the function that rounds an operation to nearest; a number becomes a vector
    /// beside one.
    fn corrected(&self, name: &'static str, ty: Type, args: &[Id], names: &mut Names) -> String {
        names.helper(name);
        let (name, count) = match ty {
            Type::Vector(_, n) => (names::of_vectors(name, n), n),
            _ => (name, 1),
        };
        names.helper(name);
        let ty = names.ty(ty);
        let argument = |id: &Id| {
            let text = self.item(*id, names);
            let is_vector = matches!(self.function.nodes[id.0 as usize].ty, Type::Vector(..));
            if count > 1 && !is_vector { format!("{ty}({text})") } else { text }
        };
        let args: Vec<String> = args.iter().map(argument).collect();
        format!("{name}({})", args.join(", "))
    }

    /// Returns whether an expression is the literal of a power of two: the device's quotient by it is
    /// exact.
    fn is_power_of_two(&self, id: Id) -> bool {
        matches!(
            self.function.nodes[id.0 as usize].expr,
            Expr::F32(bits) if bits & 0x7f_ffff == 0 && f32::from_bits(bits).is_normal()
        )
    }

    fn int_binary(&self, op: IntBinary, a: Id, b: Id, names: &mut Names) -> (String, Bind) {
        let sum =
            |s, t: &mut Names| self.infix(s, Bind::Sum, (a, Bind::Sum), (b, Bind::Product), t);
        let product = |s, t: &mut Names| {
            self.infix(s, Bind::Product, (a, Bind::Product), (b, Bind::Unary), t)
        };
        // WGSL does not mix bitwise operators with others without parentheses.
        let bits = |s, t: &mut Names| {
            let text = self.infix(s, Bind::Or, (a, Bind::Unary), (b, Bind::Unary), t).0;
            (text, Bind::Or)
        };
        match op {
            IntBinary::Add | IntBinary::WrappingAdd => sum("+", names),
            IntBinary::Sub | IntBinary::WrappingSub => sum("-", names),
            IntBinary::Mul | IntBinary::WrappingMul => product("*", names),
            IntBinary::Div => product("/", names),
            IntBinary::Rem => product("%", names),
            IntBinary::And => bits("&", names),
            IntBinary::Or => bits("|", names),
            IntBinary::Xor => bits("^", names),
            IntBinary::Shl => self.shift("<<", a, b, names),
            IntBinary::Shr => self.shift(">>", a, b, names),
        }
    }

    /// Prints a shift by the amount modulo 32.
    fn shift(&self, symbol: &str, a: Id, b: Id, names: &mut Names) -> (String, Bind) {
        let a = self.at_least(a, Bind::Unary, names);
        let amount = match self.function.nodes[b.0 as usize].expr {
            Expr::U32(n) => format!("{}u", n & 31),
            Expr::I32(n) => format!("{}u", n & 31),
            _ => match self.function.nodes[b.0 as usize].ty {
                Type::I32 => format!("(bitcast<u32>({}) & 31u)", self.any(b, names)),
                _ => format!("({} & 31u)", self.at_least(b, Bind::Unary, names)),
            },
        };
        (format!("{a} {symbol} {amount}"), Bind::Or)
    }

    fn bool_binary(&self, op: BoolBinary, a: Id, b: Id, names: &mut Names) -> (String, Bind) {
        match op {
            BoolBinary::And => {
                self.infix("&&", Bind::And, (a, Bind::And), (b, Bind::Compare), names)
            }
            // `&&` inside `||` needs parentheses in WGSL.
            BoolBinary::Or => {
                let is_or = matches!(
                    (&self.locals[a.0 as usize], &self.function.nodes[a.0 as usize].expr),
                    (None, Expr::BoolBinary(BoolBinary::Or, ..))
                );
                let left = if is_or { Bind::Or } else { Bind::Compare };
                self.infix("||", Bind::Or, (a, left), (b, Bind::Compare), names)
            }
            BoolBinary::Xor => {
                self.infix("!=", Bind::Compare, (a, Bind::Unary), (b, Bind::Unary), names)
            }
        }
    }

    fn convert(&self, how: Conversion, ty: Type, a: Id, names: &mut Names) -> String {
        let inner = self.any(a, names);
        match how {
            Conversion::To => format!("{}({inner})", names.ty(ty)),
            Conversion::Bits => format!("bitcast<{}>({inner})", names.ty(ty)),
            Conversion::Saturate => {
                let f = if ty == Type::I32 { "saturate_i32" } else { "saturate_u32" };
                names.helper(f);
                format!("{f}({inner})")
            }
        }
    }
}
