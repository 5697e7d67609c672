//! Emission of expressions.

use std::collections::HashMap;

use proc_macro2::{Ident, Span, TokenStream};
use quote::{ToTokens, format_ident};

use crate::generics::Generics;
use crate::here::{At, quote_here as quote, word};

use super::{Binding, Dest, Emitter, SlotType, own, private};
use crate::model::{BinaryOp, Block, Expr, IntType, Kind};
use crate::parse::unraw;

impl Emitter<'_> {
    /// Emits a value, with a name for readers of generated code.
    pub(super) fn named_value(&mut self, e: &Expr, name: &str) -> TokenStream {
        let _at = At::new(e.span);
        self.structured(e, name, None).unwrap_or_else(|| self.plain_value(e))
    }

    /// Emits a value of the type `ty`, which is written in the source.
    pub(super) fn wanted(&mut self, e: &Expr, name: &str, ty: &TokenStream) -> TokenStream {
        let _at = At::new(e.span);
        let (p, m) = (private(), own("m"));
        match self.structured(e, name, Some(ty)) {
            Some(value) => quote!(#p::Coerce::coerce(#value, #m)),
            None if self.is_list(e) => self.coerced(e),
            // With its type a mistake in the value is not one of its type too.
            None => {
                let (value, machine, ty) = (self.value(e), self.machine.clone(), self.on(ty));
                quote!(#p::Coerce::<#machine, #ty>::coerce(#value, #m))
            }
        }
    }

    /// Returns whether elements become values of the machine one by one.
    fn is_list(&self, e: &Expr) -> bool {
        match &e.kind {
            Kind::Tuple(_) | Kind::Array(_) | Kind::Repeat { .. } => true,
            Kind::Name(name) => self.bare_elements(name).is_some(),
            _ => false,
        }
    }

    /// Emits a value of a known type. Elements of tuples and arrays become values of the machine
    /// one by one.
    pub(super) fn coerced(&mut self, e: &Expr) -> TokenStream {
        let _at = At::new(e.span);
        let (p, m) = (private(), own("m"));
        match &e.kind {
            Kind::Tuple(items) if !items.is_empty() => {
                let items: Vec<_> = items.iter().map(|e| self.coerced(e)).collect();
                quote!((#(#items,)*))
            }
            Kind::Array(items) => {
                let items: Vec<_> = items.iter().map(|e| self.coerced(e)).collect();
                quote!([#(#items,)*])
            }
            Kind::Repeat { value, len } => {
                let value = self.coerced(value);
                quote!([#value; #len])
            }
            _ if e.is_structured() => self.in_slot(e, "value", &quote!(_), SlotType::Written),
            Kind::Name(name) if self.bare_elements(name).is_some() => {
                let value = self.value(e);
                let (whole, count) = (own("whole"), self.bare_elements(name).unwrap_or_default());
                let items = (0..count).map(|i| {
                    let i = syn::Index::from(i);
                    quote!(#p::Coerce::coerce(#whole.#i, #m))
                });
                quote!({ let #whole = #value; (#(#items,)*) })
            }
            _ => {
                let value = self.value(e);
                quote!(#p::Coerce::coerce(#value, #m))
            }
        }
    }

    /// Returns the number of elements of a tuple with integers whose types are inferred.
    pub(super) fn bare_elements(&self, name: &Ident) -> Option<usize> {
        self.find(name)?.bare_elements
    }

    /// Emits the value of a control structure, through a variable.
    pub(super) fn structured(
        &mut self,
        e: &Expr,
        name: &str,
        ty: Option<&TokenStream>,
    ) -> Option<TokenStream> {
        if !e.is_structured() {
            return None;
        }
        let slot = match ty {
            Some(_) => SlotType::Written,
            None if e.has_typed_outcome() => SlotType::ByOthers,
            None => SlotType::ByAll,
        };
        let ty = ty.map(|t| self.on(t)).unwrap_or_else(|| quote!(_));
        Some(self.in_slot(e, name, &ty, slot))
    }

    /// Emits the value of a control structure of the type `ty`, which may be `_`.
    fn in_slot(&mut self, e: &Expr, name: &str, ty: &TokenStream, slot: SlotType) -> TokenStream {
        let (p, m) = (private(), own("m"));
        if e.is_selection() {
            return self.selection(e, name, ty, slot);
        }
        let var = self.fresh("value");
        // An expression that never has a value may have any type.
        let nothing = quote!(());
        let ty = if slot == SlotType::ByAll && e.has_no_outcome() { &nothing } else { ty };
        let code = self.into(e, &Dest::Slot { var: var.clone(), ty: slot });
        quote!({
            let #var = #p::Var::<#ty>::declare(#m, #name);
            #code
            #var.get(#m)
        })
    }

    /// Emits an `if` that only chooses between small values: both are evaluated, one is taken.
    fn selection(&mut self, e: &Expr, name: &str, ty: &TokenStream, slot: SlotType) -> TokenStream {
        let (p, m) = (private(), own("m"));
        let inner = match &e.kind {
            Kind::If { c, then, otherwise: Some(other), .. } => {
                then.free_value().map(|then| (&**c, then, &**other))
            }
            Kind::Block(b) => match b.free_value() {
                Some(inner) => return self.selection(inner, name, ty, slot),
                None => None,
            },
            _ => None,
        };
        let Some((c, then, other)) = inner else {
            let wanted =
                slot == SlotType::Written || slot == SlotType::ByOthers && !e.has_typed_outcome();
            if wanted {
                return self.coerced(e);
            }
            return self.varying(e, name);
        };
        let calls = then.may_act() || other.may_act();
        let c = self.host_value(c).unwrap_or_else(|| self.value(c));
        let has_type = |e: &Expr| slot == SlotType::ByAll || e.has_typed_outcome();
        let says_type = slot != SlotType::Written && has_type(then) && has_type(other);
        let then = self.selection(then, name, ty, slot);
        let other = self.selection(other, name, ty, slot);
        let other = if says_type { self.like_others(other) } else { other };
        let (seen, others) = (self.mentioned_in(&then), self.mentioned_in(&other));
        quote! {
            #p::choose::<_, #ty, _>(
                #m,
                #name,
                #calls,
                #c,
                #[inline(always)] || { #(let _ = &#seen;)* #then },
                #[inline(always)] || { #(let _ = &#others;)* #other },
            )
        }
    }

    pub(super) fn value(&mut self, e: &Expr) -> TokenStream {
        self.named_value(e, "value")
    }

    /// Emits a value as a variable has it: numbers of the host become numbers of the machine.
    pub(super) fn varying(&mut self, e: &Expr, name: &str) -> TokenStream {
        let (p, m) = (private(), own("m"));
        let value = self.with_bare(e).unwrap_or_else(|| self.named_value(e, name));
        quote!(#p::Varying::varying(#value, #m))
    }

    /// Emits a value that must have the type of others before it.
    pub(super) fn like_others(&self, value: TokenStream) -> TokenStream {
        let (p, m) = (private(), own("m"));
        if self.has_bare { quote!(#p::Coerce::coerce(#value, #m)) } else { value }
    }

    /// A tuple whose parts get names: integers without a suffix may become variables.
    pub(super) fn tuple(&mut self, e: &Expr) -> TokenStream {
        self.with_bare(e).unwrap_or_else(|| self.value(e))
    }

    /// An integer without a suffix, or a list or a tuple that has some: its type is inferred from
    /// what is done with it.
    pub(super) fn with_bare(&mut self, e: &Expr) -> Option<TokenStream> {
        let _at = At::new(e.span);
        let (p, m) = (private(), own("m"));
        if let Some(integer) = e.integer_tokens() {
            return Some(quote!(#p::bare(#m, #integer)));
        }
        let part = |this: &mut Self, e: &Expr| this.with_bare(e).unwrap_or_else(|| this.value(e));
        match &e.kind {
            Kind::Tuple(items) if items.iter().any(Expr::has_untyped_integer) => {
                let items: Vec<_> = items.iter().map(|e| part(self, e)).collect();
                Some(quote!((#(#items,)*)))
            }
            Kind::Array(items) if !items.is_empty() && !e.has_typed_item() => {
                let items: Vec<_> = items.iter().map(|e| part(self, e)).collect();
                Some(quote!([#(#items,)*]))
            }
            Kind::Repeat { value, len } => {
                let value = self.with_bare(value)?;
                Some(quote!([#value; #len]))
            }
            Kind::Name(name) if self.find(name).is_some_and(|local| local.literal) => {
                Some(quote!(#p::bare(#m, #name)))
            }
            _ => None,
        }
    }

    /// Emits a value that does not come from control flow.
    pub(super) fn plain_value(&mut self, e: &Expr) -> TokenStream {
        let (p, m) = (private(), own("m"));
        let span = e.span;
        if let Some(integer) = e.integer_tokens() {
            return integer;
        }
        match &e.kind {
            Kind::Float(lit) => {
                let exact = in_f64(lit);
                quote!(#p::literal(#m, #lit, #exact))
            }
            Kind::Int { tokens, suffix } => integer(tokens, *suffix),
            Kind::Bool(b) => quote!(#b),
            Kind::Name(name) => self.name(name),
            Kind::Path(path) => self.constant(path),
            Kind::Neg(a) => self.negated(a),
            Kind::Not(a) => {
                let a = self.value(a);
                quote!(#p::OpNot::not(#m, #a))
            }
            Kind::Binary { op, a, b } => {
                let (a, b) = (self.value(a), self.value(b));
                operator(*op, a, b)
            }
            Kind::Logic { and, a, b } => self.logic(*and, a, b, span),
            Kind::Compare { op, a, b } => self.comparison(op, a, b),
            Kind::Is { value, name, .. } => {
                let test = Ident::new(&unraw(&format!("__is_{name}")), name.span());
                self.of_variant(value, &test, &[])
            }
            Kind::OfVariant { value, method, args } => self.of_variant(value, method, args),
            Kind::NewVariant { ty, name } => self.new_variant(ty, name),
            Kind::Cast { value, ty } => {
                let value = self.value(value);
                quote!(#p::cast::<_, _, #ty>(#m, #value))
            }
            Kind::Call { path, args } => self.call(path, args, span),
            Kind::Associated { ty, name, args } => self.associated(ty, name, args),
            Kind::Method { receiver, name, turbofish, args } => {
                self.method(receiver, name, turbofish, args)
            }
            Kind::Deref(a) => self.value(a),
            Kind::Host(inner) => self.host_use(inner),
            // The arguments of calls handle the first two.
            Kind::RefMut(_) | Kind::Closure(_) | Kind::Error => quote!(::core::unreachable!()),
            Kind::Field { base, member } => {
                let base = self.value(base);
                quote!(#base.#member)
            }
            Kind::Index { base, index } => {
                let base = self.value(base);
                quote!(#p::at(#m, #base, #index))
            }
            Kind::Struct { path, fields, rest } => self.structure(path, fields, rest.as_deref()),
            Kind::Tuple(items) => {
                let items = self.values(items);
                quote!((#(#items,)*))
            }
            Kind::Element { base, index } => self.element(base, index),
            Kind::Array(items) => self.with_bare(e).unwrap_or_else(|| self.array(items)),
            Kind::Repeat { value, len } => {
                let value = self.value(value);
                quote!([#value; #len])
            }
            Kind::Block(b) => self.plain_block(b),
            _ => {
                let code = self.into(e, &Dest::None);
                quote!({ #code })
            }
        }
    }

    /// Emits a constant of the source.
    fn constant(&self, path: impl ToTokens) -> TokenStream {
        let (p, m, machine) = (private(), own("m"), &self.machine);
        quote!(#p::Capture::<#machine>::constant(&#path, #m))
    }

    fn negated(&mut self, a: &Expr) -> TokenStream {
        let (p, m) = (private(), own("m"));
        match &a.kind {
            Kind::Float(lit) => {
                let exact = in_f64(lit);
                quote!(#p::literal(#m, -#lit, -#exact))
            }
            _ => {
                let a = self.value(a);
                quote!(#p::OpNeg::neg(#m, #a))
            }
        }
    }

    fn comparison(&mut self, op: &str, a: &Expr, b: &Expr) -> TokenStream {
        let (p, m, op) = (private(), own("m"), word(op));
        let (a, b) = (self.value(a), self.value(b));
        quote!(#p::OpCompare::compare(#m, #p::op::#op, { #a }, { #b }))
    }

    /// Emits a computed element. An index that is the same for all rays is also passed as one
    /// number.
    fn element(&mut self, base: &Expr, index: &Expr) -> TokenStream {
        let (p, m) = (private(), own("m"));
        let step = self.in_step(index);
        let (base, index) = (self.value(base), self.value(index));
        let Some(step) = step else { return quote!(#p::element(#m, #base, #index)) };
        let seen = self.mentioned_in(&index);
        quote!(#p::element_in_step(
            #m,
            #base,
            #step,
            #[inline(always)] || { #(let _ = &#seen;)* #index },
        ))
    }

    /// Emits the elements of an array, one of which may determine the type of the others.
    fn array(&mut self, items: &[Expr]) -> TokenStream {
        let is_typed = items.iter().any(Expr::has_typed_outcome);
        let mut has_type = false;
        let items: Vec<_> = items
            .iter()
            .map(|e| {
                if is_typed && !e.has_typed_outcome() {
                    return self.coerced(e);
                }
                let value = self.value(e);
                if core::mem::replace(&mut has_type, true) {
                    self.like_others(value)
                } else {
                    value
                }
            })
            .collect();
        quote!([#(#items,)*])
    }

    /// Returns an index that is the same for all rays, as one number: uniform counters, and sums
    /// and products of them.
    fn in_step(&self, e: &Expr) -> Option<TokenStream> {
        let number = |e: &Expr| e.kind.int_tokens().map(|n| quote!((#n as u32)));
        match &e.kind {
            Kind::Name(name) => {
                let step = self.find(name)?.step.as_ref()?;
                Some(quote!(#step.bits()))
            }
            // A conversion through a float might change the number.
            Kind::Cast { value, ty } if ty.to_string() != "f32" => self.in_step(value),
            Kind::Binary { op, a, b } if matches!(op.symbol, "+" | "*") => {
                let (x, y) = (self.in_step(a), self.in_step(b));
                let (x, y) = match (x, y) {
                    (None, None) => return None,
                    (x, y) => (x.or_else(|| number(a))?, y.or_else(|| number(b))?),
                };
                let method = format_ident!("wrapping_{}", op.method);
                Some(quote!(u32::#method(#x, #y)))
            }
            _ => None,
        }
    }

    pub(super) fn values(&mut self, es: &[Expr]) -> Vec<TokenStream> {
        es.iter().map(|e| self.value(e)).collect()
    }

    pub(super) fn name(&mut self, name: &Ident) -> TokenStream {
        let (p, m) = (private(), own("m"));
        match self.lookup(name) {
            Some(Binding::Var | Binding::Mut) => {
                let local = self.local(name);
                quote!(#local.get(#m))
            }
            Some(Binding::Value) => {
                let local = self.local(name);
                quote!(#local)
            }
            Some(Binding::Host) => quote!(#p::HostUse::value(#name, #m)),
            Some(Binding::Function) => {
                self.errors.at(
                    name.span(),
                    format!("the closure `{name}` is no value of a kernel"),
                    &format!("call it, `{name}(x)`, or pass it to a kernel that takes one"),
                );
                quote!(::core::unreachable!())
            }
            None if self.is_constant(name) || !self.is_closure => self.constant(name),
            None if name == "self" => {
                self.errors.at(
                    name.span(),
                    "a kernel cannot capture `self`",
                    "name what it needs before it: `let bvh = &self.bvh;`",
                );
                quote!(::core::unreachable!())
            }
            None => {
                self.capture(name);
                quote!(#name)
            }
        }
    }

    /// Emits `&&` and `||`: both sides at once if the right one is harmless, else an `if`.
    pub(super) fn logic(&mut self, and: bool, a: &Expr, b: &Expr, span: Span) -> TokenStream {
        let (p, m) = (private(), own("m"));
        if b.is_total() {
            let (operator, method) = if and { ("OpAnd", "and") } else { ("OpOr", "or") };
            let (operator, method) = (word(operator), word(method));
            let may_overflow = b.may_overflow();
            let (a, b) = (self.value(a), self.value(b));
            if !may_overflow {
                return quote!(#p::#operator::#method(#m, #a, #b));
            }
            let left = own("left");
            return quote!({
                let #left = #a;
                #p::#operator::#method(#m, #left, #p::guarded(#m, #left, #and, || #b))
            });
        }
        let block = |e: &Expr| Block { stmts: vec![], tail: Some(Box::new(e.clone())) };
        let literal = Expr { kind: Kind::Bool(!and), span };
        let (then, other) = if and { (b, &literal) } else { (&literal, b) };
        let choice = Kind::If {
            coherent: false,
            c: Box::new(a.clone()),
            then: block(then),
            otherwise: Some(Box::new(Expr { kind: Kind::Block(block(other)), span })),
        };
        self.named_value(&Expr { kind: choice, span }, if and { "both" } else { "either" })
    }

    pub(super) fn structure(
        &mut self,
        path: &TokenStream,
        fields: &[(TokenStream, Expr)],
        rest: Option<&Expr>,
    ) -> TokenStream {
        let p = private();
        let path = self.without_self(path);
        let machine = &self.machine.clone();
        // An item within a function cannot use the function's parameters.
        let mentioned = self.generics.mentioned_in(&path);
        let Generics { bare, used, .. } = &mentioned;
        let members: Vec<TokenStream> = fields
            .iter()
            .map(|(member, e)| {
                let value = self.coerced(e);
                quote!(#member: #value)
            })
            .collect();
        let rest = rest.map(|e| {
            let value = self.value(e);
            quote!(..#value)
        });
        quote! {{
            type __Twin<M__, #bare> = <#path as #p::Type>::On<M__>;
            __Twin::<#machine, #used> { #(#members,)* #rest }
        }}
    }

    pub(super) fn plain_block(&mut self, b: &Block) -> TokenStream {
        self.scopes.push(HashMap::new());
        let mut out = TokenStream::new();
        for stmt in &b.stmts {
            out.extend(self.stmt(stmt));
        }
        let tail = b.tail.as_ref().map(|e| self.value(e));
        self.scopes.pop();
        quote!({ #out #tail })
    }
}

fn operator(op: BinaryOp, a: TokenStream, b: TokenStream) -> TokenStream {
    let (p, m) = (private(), own("m"));
    let (operator, method) = (word(op.operator), word(op.method));
    quote!(#p::#operator::#method(#m, { #a }, { #b }))
}

/// Emits an integer of the source; without a suffix its type is inferred.
fn integer(tokens: &TokenStream, suffix: Option<IntType>) -> TokenStream {
    let (p, m) = (private(), own("m"));
    match suffix {
        Some(IntType::I32) => quote!(#p::i32(#m, #tokens)),
        Some(IntType::U32) => quote!(#p::u32(#m, #tokens)),
        Some(IntType::Usize) => quote!(#p::usize(#m, #tokens)),
        None => tokens.clone(),
    }
}

/// Returns an `f32` literal with the suffix `f64`.
fn in_f64(lit: &TokenStream) -> TokenStream {
    let text = lit.to_string().replace('_', "");
    let digits = text.strip_suffix("f32").unwrap_or(&text);
    let span = lit.clone().into_iter().next().map_or_else(Span::call_site, |t| t.span());
    syn::LitFloat::new(&format!("{digits}f64"), span).to_token_stream()
}
