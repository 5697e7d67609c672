//! Places in a source that can be mutated.

use std::ops::Range;

use proc_macro2::Span;
use quote::ToTokens;
use serde::{Deserialize, Serialize};
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{BinOp, Expr, UnOp};

/// A change of one expression.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) struct Site {
    /// The path below `raydsl/src`.
    pub(crate) file: String,
    pub(crate) line: usize,
    /// The bytes of the expression.
    pub(crate) start: usize,
    pub(crate) end: usize,
    /// What is changed, such as `< to <=`.
    pub(crate) change: String,
    /// The expression instead.
    pub(crate) mutated: String,
}

impl Site {
    pub(crate) fn bytes(&self) -> Range<usize> {
        self.start..self.end
    }

    /// Whether it is the body of a function, with its braces.
    pub(crate) fn is_body(&self) -> bool {
        self.change.starts_with("body")
    }
}

/// Returns the sites of a file, in order. Code of tests, constants and bodies of macros have none:
/// a constant cannot depend on the environment, and a macro's body is no expression yet.
pub(crate) fn sites(file: &str, text: &str) -> syn::Result<Vec<Site>> {
    let parsed = syn::parse_file(text)?;
    let mut finder = Finder { file, is_within: false, found: Vec::new() };
    finder.visit_file(&parsed);
    finder.found.sort();
    Ok(finder.found)
}

struct Finder<'a> {
    file: &'a str,
    /// Whether it is in the body of a function that runs.
    is_within: bool,
    found: Vec<Site>,
}

fn is_test(attrs: &[syn::Attribute]) -> bool {
    attrs.iter().any(|a| {
        let text = a.to_token_stream().to_string();
        text.contains("cfg (test)") || text == "# [test]"
    })
}

/// Whether a condition binds names, which an expression of its own could not.
fn has_let(e: &Expr) -> bool {
    match e {
        Expr::Let(_) => true,
        Expr::Binary(b) => has_let(&b.left) || has_let(&b.right),
        Expr::Paren(p) => has_let(&p.expr),
        _ => false,
    }
}

/// The other operators to try.
fn others(op: &BinOp) -> &'static [&'static str] {
    match op {
        BinOp::Add(_) => &["-"],
        BinOp::Sub(_) => &["+"],
        BinOp::Mul(_) => &["/"],
        BinOp::Div(_) => &["*"],
        BinOp::Rem(_) => &["/"],
        BinOp::And(_) => &["||"],
        BinOp::Or(_) => &["&&"],
        BinOp::BitAnd(_) => &["|"],
        BinOp::BitOr(_) | BinOp::BitXor(_) => &["&"],
        BinOp::Shl(_) => &[">>"],
        BinOp::Shr(_) => &["<<"],
        BinOp::Eq(_) => &["!="],
        BinOp::Ne(_) => &["=="],
        BinOp::Lt(_) => &["<=", ">="],
        BinOp::Le(_) => &["<", ">"],
        BinOp::Gt(_) => &[">=", "<="],
        BinOp::Ge(_) => &[">", "<"],
        BinOp::AddAssign(_) => &["-="],
        BinOp::SubAssign(_) => &["+="],
        BinOp::MulAssign(_) => &["/="],
        BinOp::DivAssign(_) => &["*="],
        BinOp::BitAndAssign(_) => &["|="],
        BinOp::BitOrAssign(_) => &["&="],
        BinOp::ShlAssign(_) => &[">>="],
        BinOp::ShrAssign(_) => &["<<="],
        _ => &[],
    }
}

/// The name with the opposite meaning.
fn opposite(name: &str) -> Option<&'static str> {
    Some(match name {
        "min" => "max",
        "max" => "min",
        "and" => "or",
        "or" => "and",
        "And" => "Or",
        "Or" => "And",
        _ => return None,
    })
}

/// Another number: 0 and 1 are swapped, others are one more. Fractions stay.
fn other_number(lit: &syn::Lit) -> Option<String> {
    match lit {
        syn::Lit::Int(i) => {
            let value: u64 = i.base10_parse().ok()?;
            (value <= 64)
                .then(|| format!("{}{}", if value == 1 { 0 } else { value + 1 }, i.suffix()))
        }
        syn::Lit::Float(f) => {
            let value: f64 = f.base10_parse().ok()?;
            let is_whole = value.fract() == 0.0 && value <= 64.0;
            let other = if value == 1.0 { 0.0 } else { value + 1.0 };
            is_whole.then(|| format!("{other:?}{}", f.suffix()))
        }
        _ => None,
    }
}

impl Finder<'_> {
    fn add(&mut self, span: Span, change: String, mutated: String) {
        let (bytes, line) = (span.byte_range(), span.start().line);
        let (file, start, end) = (self.file.to_owned(), bytes.start, bytes.end);
        self.found.push(Site { file, line, start, end, change, mutated });
    }

    /// Visits the body of a function, which may be called at run time only.
    fn body(&mut self, attrs: &[syn::Attribute], sig: &syn::Signature, block: &syn::Block) {
        if is_test(attrs) || sig.constness.is_some() {
            return;
        }
        if matches!(&sig.output, syn::ReturnType::Type(_, ty) if ty.to_token_stream().to_string() == "bool")
        {
            for value in ["true", "false"] {
                self.add(block.span(), format!("body to {value}"), value.to_owned());
            }
        }
        let around = core::mem::replace(&mut self.is_within, true);
        self.visit_block(block);
        self.is_within = around;
    }

    fn binary(&mut self, b: &syn::ExprBinary) {
        if has_let(&b.left) || has_let(&b.right) {
            return;
        }
        let op = b.op.to_token_stream();
        let (left, right) = (b.left.to_token_stream(), b.right.to_token_stream());
        for other in others(&b.op) {
            let is_assignment =
                other.ends_with('=') && !matches!(*other, "==" | "!=" | "<=" | ">=");
            let mutated = if is_assignment {
                format!("{left} {other} {right}")
            } else {
                format!("({left}) {other} ({right})")
            };
            self.add(b.span(), format!("{op} to {other}"), mutated);
        }
    }

    /// `a.min(b)`, `mask.and(a, b)`, `mask_not(a)`, and operations that are arguments.
    fn method(&mut self, c: &syn::ExprMethodCall) {
        let name = c.method.to_string();
        if let Some(other) = opposite(&name) {
            let mut call = c.clone();
            call.method = syn::Ident::new(other, c.method.span());
            self.add(c.span(), format!("{name} to {other}"), call.to_token_stream().to_string());
        }
        if name == "mask_not" && c.args.len() == 1 {
            self.add(c.span(), "mask_not removed".into(), c.args[0].to_token_stream().to_string());
        }
        if let Some(Expr::Path(p)) = c.args.first()
            && let Some(last) = p.path.segments.last()
            && matches!(last.ident.to_string().as_str(), "And" | "Or")
        {
            let (from, mut call) = (last.ident.to_string(), c.clone());
            let to = opposite(&from).unwrap_or_default();
            if let Some(Expr::Path(p)) = call.args.first_mut()
                && let Some(last) = p.path.segments.last_mut()
            {
                last.ident = syn::Ident::new(to, last.ident.span());
            }
            self.add(c.span(), format!("{from} to {to}"), call.to_token_stream().to_string());
        }
    }

    fn call(&mut self, c: &syn::ExprCall) {
        let Expr::Path(p) = &*c.func else { return };
        let Some(last) = p.path.segments.last() else { return };
        let name = last.ident.to_string();
        let Some(other) = opposite(&name).filter(|_| c.args.len() == 2) else { return };
        let mut call = c.clone();
        if let Expr::Path(p) = &mut *call.func
            && let Some(last) = p.path.segments.last_mut()
        {
            last.ident = syn::Ident::new(other, last.ident.span());
        }
        self.add(c.span(), format!("{name} to {other}"), call.to_token_stream().to_string());
    }
}

impl<'ast> Visit<'ast> for Finder<'_> {
    fn visit_item_mod(&mut self, m: &'ast syn::ItemMod) {
        if !is_test(&m.attrs) {
            visit::visit_item_mod(self, m);
        }
    }

    fn visit_item_impl(&mut self, i: &'ast syn::ItemImpl) {
        if !is_test(&i.attrs) {
            visit::visit_item_impl(self, i);
        }
    }

    fn visit_item_fn(&mut self, f: &'ast syn::ItemFn) {
        self.body(&f.attrs, &f.sig, &f.block);
    }

    fn visit_impl_item_fn(&mut self, f: &'ast syn::ImplItemFn) {
        self.body(&f.attrs, &f.sig, &f.block);
    }

    fn visit_trait_item_fn(&mut self, f: &'ast syn::TraitItemFn) {
        if let Some(block) = &f.default {
            self.body(&f.attrs, &f.sig, block);
        }
    }

    // Not evaluated when the program runs.
    fn visit_item_const(&mut self, _: &'ast syn::ItemConst) {}
    fn visit_item_static(&mut self, _: &'ast syn::ItemStatic) {}
    fn visit_expr_const(&mut self, _: &'ast syn::ExprConst) {}
    fn visit_type(&mut self, _: &'ast syn::Type) {}
    fn visit_pat(&mut self, _: &'ast syn::Pat) {}
    fn visit_attribute(&mut self, _: &'ast syn::Attribute) {}
    fn visit_path_arguments(&mut self, _: &'ast syn::PathArguments) {}
    fn visit_expr_repeat(&mut self, r: &'ast syn::ExprRepeat) {
        self.visit_expr(&r.expr);
    }

    // An element of an array at an index of the source is a part, as a member is.
    fn visit_expr_index(&mut self, i: &'ast syn::ExprIndex) {
        self.visit_expr(&i.expr);
        if !matches!(&*i.index, Expr::Lit(_)) {
            self.visit_expr(&i.index);
        }
    }

    fn visit_expr(&mut self, e: &'ast Expr) {
        if self.is_within {
            match e {
                Expr::Binary(b) => self.binary(b),
                Expr::MethodCall(c) => self.method(c),
                Expr::Call(c) => self.call(c),
                Expr::Unary(u) if matches!(u.op, UnOp::Neg(_) | UnOp::Not(_)) => {
                    let op = u.op.to_token_stream();
                    self.add(
                        u.span(),
                        format!("{op} removed"),
                        format!("({})", u.expr.to_token_stream()),
                    );
                }
                Expr::Lit(l) => {
                    if let Some(other) = other_number(&l.lit) {
                        let change = format!("{} to {other}", l.lit.to_token_stream());
                        self.add(l.span(), change, other);
                    }
                }
                _ => {}
            }
        }
        visit::visit_expr(self, e);
    }
}

#[cfg(test)]
mod tests {
    use super::sites;

    fn changes(text: &str) -> Vec<(String, String)> {
        let found = sites("f.rs", text).unwrap();
        found.into_iter().map(|s| (text[s.bytes()].to_owned(), s.mutated)).collect()
    }

    fn has(text: &str, from: &str, to: &str) -> bool {
        changes(text).contains(&(from.to_owned(), to.to_owned()))
    }

    #[test]
    fn operators_have_others() {
        let text = "fn f(a: f32, b: f32) -> f32 { if a < b { a + b } else { -a.min(b) } }";
        assert!(has(text, "a < b", "(a) <= (b)"));
        assert!(has(text, "a < b", "(a) >= (b)"));
        assert!(has(text, "a + b", "(a) - (b)"));
        assert!(has(text, "-a.min(b)", "(a . min (b))"));
        assert!(has(text, "a.min(b)", "a . max (b)"));
    }

    #[test]
    fn numbers_are_off_by_one() {
        let text = "fn f() -> usize { let a = 1.0; let b = 2u32; let c = 0.5; x[0] + y[i + 3] }";
        assert!(has(text, "1.0", "0.0"));
        assert!(has(text, "2u32", "3u32"));
        assert!(has(text, "3", "4"));
        let none = ["0.5", "0"];
        assert!(changes(text).iter().all(|(from, _)| !none.contains(&from.as_str())));
    }

    #[test]
    fn functions_of_truth_have_two_results() {
        let text = "fn f(a: bool) -> bool { !a }";
        assert!(has(text, "{ !a }", "true") && has(text, "{ !a }", "false"));
        assert!(has(text, "!a", "(a)"));
    }

    #[test]
    fn what_is_fixed_at_compile_time_has_none() {
        let fixed =
            "const A: u32 = 1 + 2; const fn f() -> u32 { 1 + 2 } static B: [u8; 2] = [1; 2];
            fn g() { const C: u32 = 3; match x { 1 => {} 2..4 => {} _ => {} } let _: [u8; 2]; }
            #[cfg(test)] mod tests { fn f() -> u32 { 1 + 2 } }";
        assert_eq!(changes(fixed), []);
        assert_eq!(changes("fn f() { if let Some(a) = b && c {} }"), []);
    }

    #[test]
    fn masks_have_their_operators() {
        let text = "fn f(&self) -> M { self.and(self.lanes.mask_not(c), self.lanes.mask_binary(op::Or, a, b)) }";
        let found = changes(text);
        assert_eq!(found.len(), 3, "{found:?}");
    }
}
