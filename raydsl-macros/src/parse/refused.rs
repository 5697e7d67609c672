//! Refusal of constructs that no kernel has, recognised by their syntax.

use proc_macro2::Ident;
use quote::ToTokens;
use syn::spanned::Spanned;

use super::Parser;
use super::expression::inside_parens;
use crate::model::Kind;
use crate::ops;

/// Methods of iterators, and of arrays with closures.
const OF_ITERATORS: &[&str] = &[
    "all",
    "any",
    "chain",
    "cloned",
    "collect",
    "copied",
    "count",
    "enumerate",
    "filter",
    "filter_map",
    "find",
    "flat_map",
    "fold",
    "for_each",
    "iter",
    "last",
    "map",
    "max",
    "max_by",
    "min",
    "min_by",
    "nth",
    "position",
    "product",
    "reduce",
    "rev",
    "scan",
    "skip",
    "step_by",
    "sum",
    "take",
    "take_while",
    "windows",
    "zip",
];

/// Returns whether it is a variant of `Result`.
pub(super) fn is_absent(name: &Ident) -> bool {
    ["Ok", "Err"].iter().any(|n| name == n)
}

/// Returns whether `e` is made by methods of iterators: `list.iter()`, `(0..n).map(..)`.
fn is_iterator(e: &syn::Expr) -> bool {
    match inside_parens(e) {
        syn::Expr::Range(_) => true,
        syn::Expr::MethodCall(c) => {
            let begins = ["iter", "iter_mut", "into_iter"].iter().any(|n| c.method == n);
            begins && c.args.is_empty() || is_of_iterators(&c.method) && is_iterator(&c.receiver)
        }
        _ => false,
    }
}

/// Returns whether it is a function of the prelude that returns a struct where std returns a tuple.
pub(super) fn gives_struct(value: &Kind) -> bool {
    matches!(value, Kind::Call { path, .. } if path.to_string() == "sincos_2pi")
}

fn is_of_iterators(method: &Ident) -> bool {
    OF_ITERATORS.iter().any(|n| method == n)
}

fn is_closure(e: &syn::Expr) -> bool {
    matches!(e, syn::Expr::Closure(_))
}

impl Parser<'_> {
    /// Refuses `Ok(x)` and `Err(e)`.
    pub(super) fn absent(&mut self, name: &Ident) -> Kind {
        let help = ops::refused_type("Result").unwrap_or_default();
        self.error(name.span(), "a kernel has no `Result`", help)
    }

    /// Refuses `values.iter().sum()` and `values.map(|x| ..)`: the mistake is not in the arguments.
    pub(super) fn refused_iteration(&mut self, c: &syn::ExprMethodCall) -> Option<Kind> {
        let takes_closure = c.args.iter().any(is_closure);
        if !is_of_iterators(&c.method) || !(takes_closure || is_iterator(&c.receiver)) {
            return None;
        }
        let what = format!("a kernel has no `{}` of iterators and arrays", c.method);
        let help = match c.method.to_string().as_str() {
            "sum" => "write a `for`: `let mut sum = 0.0; for x in list.iter() { sum += x; }`",
            "map" => {
                "write a `for` that assigns each element: \
                 `for i in 0..a.len() { a[i] = b[i] * 2.0; }`"
            }
            _ => "write a `for` with a variable: `for x in list.iter() { best = best.max(*x); }`",
        };
        Some(self.error(c.method.span(), what, help))
    }

    /// Refuses a function of std.
    pub(super) fn refused_call(&mut self, c: &syn::ExprCall) -> Option<Kind> {
        let syn::Expr::Path(path) = &*c.func else { return None };
        if path.qself.is_some() {
            return None;
        }
        let segments: Vec<&Ident> = path.path.segments.iter().map(|s| &s.ident).collect();
        let (last, init) = segments.split_last()?;
        let (what, help) = match init {
            [.., owner]
                if ops::is_of_library(&owner.to_string())
                    && ops::is_plain_method(&last.to_string())
                    && !c.args.is_empty() =>
            {
                let mut args = c.args.iter().map(|e| self.expr(e));
                let receiver = Box::new(args.next()?);
                let (name, turbofish, args) = ((*last).clone(), vec![], args.collect());
                return Some(Kind::Method { receiver, name, turbofish, args });
            }
            [.., owner] if ops::is_of_library(&owner.to_string()) => {
                let help = ops::method_of_library(&last.to_string())?;
                (format!("a kernel has no `{owner}::{last}`"), help)
            }
            [.., module] if *module == "mem" && *last == "swap" && c.args.len() == 2 => {
                return Some(self.exchange(c));
            }
            [first, ..] if *first == "std" || *first == "core" => {
                let path = path.to_token_stream().to_string().replace(' ', "");
                (format!("a kernel has no `{path}`"), ops::instead_of_std(&last.to_string()))
            }
            _ => return None,
        };
        c.args.iter().for_each(|e| drop(self.expr(e)));
        Some(self.error(last.span(), what, &help))
    }

    /// Refuses an expression of a form that kernels do not have.
    pub(super) fn unsupported(&mut self, e: &syn::Expr) -> Kind {
        let (what, help) = match e {
            syn::Expr::Closure(_) => (
                "closures but as arguments and in a `let`",
                "write `let f = |x: f32| x * x;`, and `f(x)`",
            ),
            syn::Expr::Reference(_) => {
                ("`&mut` outside the arguments of a call", "write the variable itself")
            }
            syn::Expr::Range(_) => ("ranges outside `for`", "write `for i in a..b`"),
            syn::Expr::Let(_) => {
                ("`let` within a condition but beside `&&`", "write an `if let` for each")
            }
            syn::Expr::Unsafe(_) => ("`unsafe`", "write safe code"),
            syn::Expr::Await(_) | syn::Expr::Async(_) => ("`async`", "write plain code"),
            _ => ("this expression", "write it with the operations of the kernel language"),
        };
        self.error(e.span(), format!("a kernel has no {what}"), help)
    }

    /// Refuses a call of a macro.
    pub(super) fn macro_call(&mut self, m: &syn::Macro) -> Kind {
        let name = m.path.segments.last().map(|s| s.ident.to_string()).unwrap_or_default();
        let help = match name.as_str() {
            "vec" => "kernels have no heap: use a struct or a vector",
            "println" | "print" | "eprintln" | "dbg" => "return the value and print it outside",
            "assert" | "debug_assert" | "panic" | "todo" | "unreachable" => {
                "a kernel cannot stop: return a value that says what happened"
            }
            _ => "write out what it stands for: the macro cannot see inside another macro",
        };
        self.error(m.path.span(), format!("a kernel cannot call the macro `{name}!`"), help)
    }
}
