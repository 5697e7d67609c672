//! Emission of assignments to variables and their parts.

use proc_macro2::{Ident, TokenStream};

use super::{Binding, Emitter, own, private};
use crate::here::quote_here as quote;
use crate::model::{BinaryOp, Expr, Kind, Place, Step};

impl Emitter<'_> {
    /// Reports an assignment to a variable of the code around a closure.
    pub(super) fn not_ours(&mut self, name: &Ident) {
        self.errors.at(
            name.span(),
            format!("a kernel cannot assign to `{name}`, which belongs to the code around it"),
            "return the new value, or declare the variable inside the kernel",
        );
    }

    /// Reports an assignment to a variable of the kernel around a nested closure.
    pub(super) fn outside(&mut self, name: &Ident) {
        if self.kernel.is_fn {
            return;
        }
        self.errors.at(
            name.span(),
            format!("a closure may read `{name}`, which lies outside of it, but not change it"),
            "return the new value",
        );
    }

    pub(super) fn assign(
        &mut self,
        place: &Place,
        op: Option<BinaryOp>,
        value: &Expr,
    ) -> TokenStream {
        let name = &place.name;
        if self.lookup(name) == Some(Binding::Host) && !self.is_outer(name) {
            return self.host_assign(name, op.map(|op| op.symbol), value);
        }
        if self.may_assign(name) {
            self.assign_variable(place, op, value)
        } else {
            TokenStream::new()
        }
    }

    /// Returns whether it is a variable of the kernel; mistakes that rustc accepts are reported.
    fn may_assign(&mut self, name: &Ident) -> bool {
        if self.is_outer(name) {
            self.outside(name);
            return false;
        }
        match self.lookup(name) {
            Some(Binding::Var | Binding::Mut) => return true,
            Some(Binding::Value) if self.find(name).is_some_and(|l| l.alias) => self.errors.at(
                name.span(),
                format!("a kernel cannot assign through `{name}`, a second name"),
                "assign to the `&mut` parameter itself: `s.x = ...`",
            ),
            None if self.is_closure => self.not_ours(name),
            // rustc reports the others, in the user's own function.
            Some(_) | None => {}
        }
        false
    }

    fn assign_variable(
        &mut self,
        place: &Place,
        op: Option<BinaryOp>,
        value: &Expr,
    ) -> TokenStream {
        let (p, m) = (private(), own("m"));
        // The right side first: it may read the place.
        let right = own("right");
        let is_list = matches!(value.kind, Kind::Tuple(_) | Kind::Array(_) | Kind::Repeat { .. });
        let value = if op.is_none() && is_list { self.coerced(value) } else { self.value(value) };
        let (indices, steps) = self.parts(&place.steps);
        let new = |old: TokenStream| match op {
            Some(op) => {
                let name = format!("{}=", op.symbol);
                quote!(#p::Assigned::<{ #p::name(#name) }, _, _, _>::assigned(#m, #old, #right))
            }
            None if is_list => quote!(#right),
            None => quote!(#p::Coerce::coerce(#right, #m)),
        };
        let local = self.local(&place.name);
        if steps.is_empty() {
            let new = new(quote!(#local.get(#m)));
            return quote!({ let #right = #value; #local.set(#m, #new); });
        }
        let whole = own("whole");
        let change = change(quote!(#whole), &steps, &new, 0);
        quote!({
            let #right = #value;
            #indices
            let mut #whole = #local.get(#m);
            #change
            #local.set(#m, #whole);
        })
    }

    /// Emits the evaluation of a place's computed indices, and returns its steps with them.
    pub(super) fn parts(&mut self, steps: &[Step]) -> (TokenStream, Vec<Part>) {
        let mut indices = TokenStream::new();
        let mut part = |step: &Step| match step {
            Step::Member(member) => Part::Plain(quote!(.#member)),
            Step::Element(index) => Part::Plain(quote!([#index])),
            Step::Computed(e) => {
                let (index, value) = (self.fresh("index"), self.value(e));
                indices.extend(quote!(let #index = #value;));
                Part::Computed(index)
            }
        };
        let parts = steps.iter().map(&mut part).collect();
        (indices, parts)
    }
}

/// Returns whether it is a computed element of an array, or a part of one.
pub(super) fn is_part_of_element(e: &Expr) -> bool {
    match &e.kind {
        Kind::Element { .. } => true,
        Kind::Field { base, .. } | Kind::Index { base, .. } => is_part_of_element(base),
        _ => false,
    }
}

/// Returns the steps of a place if none is computed.
pub(super) fn plain_steps(steps: &[Step]) -> Option<TokenStream> {
    steps
        .iter()
        .map(|s| match s {
            Step::Member(member) => Some(quote!(.#member)),
            Step::Element(index) => Some(quote!([#index])),
            Step::Computed(_) => None,
        })
        .collect()
}

/// A step of a place, with computed indices already evaluated.
pub(super) enum Part {
    Plain(TokenStream),
    Computed(Ident),
}

/// Emits a change of the part of `place` at the end of `steps` to `new` of its old value.
pub(super) fn change(
    place: TokenStream,
    steps: &[Part],
    new: &dyn Fn(TokenStream) -> TokenStream,
    depth: usize,
) -> TokenStream {
    let (p, m, element) = (private(), own("m"), own(&format!("element_{depth}")));
    match steps.split_first() {
        None => {
            let value = new(place.clone());
            quote!(#place = #value;)
        }
        Some((Part::Plain(step), rest)) => change(quote!(#place #step), rest, new, depth),
        Some((Part::Computed(i), rest)) => {
            let inside = change(quote!(#element), rest, new, depth + 1);
            quote!({
                let mut #element = #p::element(#m, #place, #i);
                #inside
                #place = #p::with_element(#m, #place, #i, #element);
            })
        }
    }
}

/// Emits the part of `place` at the end of `steps`.
pub(super) fn part_of(place: TokenStream, steps: &[Part]) -> TokenStream {
    let (p, m) = (private(), own("m"));
    steps.iter().fold(place, |place, step| match step {
        Part::Plain(step) => quote!(#place #step),
        Part::Computed(i) => quote!(#p::element(#m, #place, #i)),
    })
}
