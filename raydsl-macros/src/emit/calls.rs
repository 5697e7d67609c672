//! Calls of kernels, associated functions and methods.

use proc_macro2::{Ident, Span, TokenStream};

use super::places::{is_part_of_element, plain_steps};
use super::{Binding, Emitter, own, private, shown};
use crate::here::{At, quote_here as quote, word};
use crate::model::{Expr, Kind};

impl Emitter<'_> {
    pub(super) fn call(&mut self, path: &TokenStream, args: &[Expr], span: Span) -> TokenStream {
        let m = own("m");
        let is_method = self.kernel.params.first().is_some_and(|p| p.name == "self");
        if self.kernel.name == path.to_string() && !self.is_closure && !is_method {
            self.errors.at(
                span,
                format!("the kernel `{path}` calls itself"),
                "write a loop: a GPU has no recursion",
            );
            return quote!(::core::unreachable!());
        }
        let args = self.arguments(args);
        let values = &args.values;
        // Type parameters that are named need not be inferred.
        let is_named = path.to_string().ends_with('>');
        let on = word(if is_named { "on_values" } else { "on" });
        args.around(quote!(#path::#on(#m, #(#values),*)))
    }

    pub(super) fn associated(
        &mut self,
        ty: &TokenStream,
        name: &Ident,
        args: &[Expr],
    ) -> TokenStream {
        let _at = At::new(name.span());
        let m = own("m");
        let ty = self.without_self(ty);
        let name = word(&format!("{name}_on"));
        let args = self.arguments(args);
        let values = &args.values;
        args.around(quote!(<#ty>::#name(#m, #(#values),*)))
    }

    fn arguments(&mut self, args: &[Expr]) -> Arguments {
        let (p, m) = (private(), own("m"));
        let mut all = Arguments::default();
        // What is read before a call is read in order.
        let is_part = |e: &Expr| matches!(&e.kind, Kind::RefMut(p) if !p.steps.is_empty());
        let in_order = args.iter().any(is_part);
        for arg in args {
            let value = match &arg.kind {
                Kind::Closure(kernel) => self.closure(kernel),
                Kind::RefMut(place) => {
                    let local = self.local(&place.name);
                    if self.is_outer(&place.name) {
                        self.outside(&place.name);
                        continue;
                    }
                    if self.lookup(&place.name).is_none() && self.is_closure {
                        self.not_ours(&place.name);
                    }
                    let Some(steps) = plain_steps(&place.steps) else {
                        self.errors.at(
                            arg.span,
                            "a kernel has no `&mut` to a computed element",
                            "copy the element to a variable, and assign it back after the call",
                        );
                        continue;
                    };
                    if steps.is_empty() {
                        quote!(&#local)
                    } else {
                        let (part, whole) = (self.fresh("part"), own("whole"));
                        let text = shown(&place.name);
                        all.before.extend(quote! {
                            let #part = #p::Var::new(#m, #text, #local.get(#m) #steps);
                        });
                        all.after.extend(quote!({
                            let mut #whole = #local.get(#m);
                            #whole #steps = #part.get(#m);
                            #local.set(#m, #whole);
                        }));
                        quote!(&#part)
                    }
                }
                Kind::Name(name)
                    if self.lookup(name) == Some(Binding::Mut) && !self.is_outer(name) =>
                {
                    let local = self.local(name);
                    quote!(&#local)
                }
                // A number may be for a parameter of the host, and so may a constant.
                Kind::Int { tokens, .. } => tokens.clone(),
                Kind::Name(name) if self.is_constant(name) => {
                    quote!(#p::Constant(&#name).give(#m))
                }
                Kind::Name(name) if self.lookup(name) == Some(Binding::Host) => quote!(#name),
                Kind::Host(_) if self.host_value(arg).is_some() => {
                    self.host_value(arg).unwrap_or_default()
                }
                _ => {
                    let value = self.value(arg);
                    if in_order {
                        let ident = self.fresh("argument");
                        all.before.extend(quote!(let #ident = #value;));
                        quote!(#ident)
                    } else {
                        value
                    }
                }
            };
            all.values.push(value);
        }
        all
    }

    /// A method that takes `&mut self` changes the variable, or the part of one, that it is
    /// called on; which methods do is for their traits to say.
    pub(super) fn method(
        &mut self,
        receiver: &Expr,
        name: &Ident,
        turbofish: &[TokenStream],
        args: &[Expr],
    ) -> TokenStream {
        let (p, m) = (private(), own("m"));
        self.refuse(receiver, name);
        if let Some((generic, this)) = self.generic_receiver(receiver) {
            let function = word(&format!("{name}_on"));
            let args = self.arguments(args);
            let (m, values) = (own("m"), &args.values);
            return args.around(quote!(<#generic>::#function(#m, #this, #(#values),*)
            ));
        }
        let text = name.to_string();
        let machine = self.machine.clone();
        let method = quote!(#p::Method::<{ #p::name(#text) }, #machine, _, _>);
        let variable = self.variable_under(receiver);
        let mut value = self.value(receiver);
        let mut args = self.arguments(args);
        if !args.before.is_empty() {
            let (first, before) = (self.fresh("receiver"), &args.before);
            args.before = quote!(let #first = #value; #before);
            value = quote!(#first);
        }
        let generic =
            turbofish.iter().map(|ty| quote!(<#ty as ::core::default::Default>::default()));
        args.values.splice(0..0, generic);
        let values = &args.values;
        let Some((local, steps)) = variable else {
            if is_part_of_element(receiver)
                || self.is_part_of_outer(receiver)
                || self.is_alias(receiver)
            {
                return args.around(
                    quote!(#p::call_on_element::<{ #p::name(#text) }, #machine, _, _, _>(
                            #m, #value, (#(#values,)*)
                        )
                    ),
                );
            }
            return args.around(quote!(#method::call({ #value }, #m, (#({ #values },)*))));
        };
        if steps.is_empty() {
            return args
                .around(quote!(#method::call_at({ #value }, &#local, #m, (#({ #values },)*))
                ));
        }
        let (old, list, part, whole) = (own("old"), own("args"), own("part"), own("whole"));
        let result = own("result");
        let shown = shown(&local);
        args.around(quote!({
            let (#old, #list) = (#value, (#(#values,)*));
            if #p::is_mut::<{ #p::name(#text) }, #machine, _, _, _>(#m, &#old, &#list) {
                let #part = #p::Var::new(#m, #shown, #old);
                let #result = #method::call_at(#old, &#part, #m, #list);
                let mut #whole = #local.get(#m);
                #whole #steps = #part.get(#m);
                #local.set(#m, #whole);
                #result
            } else {
                #method::call(#old, #m, #list)
            }
        }))
    }

    /// A receiver whose type is a type parameter: its trait has the lifted method, which takes a
    /// variable for `&mut self` and for `&self` alike.
    fn generic_receiver(&mut self, receiver: &Expr) -> Option<(Ident, TokenStream)> {
        let name = match &receiver.kind {
            Kind::Name(name) => name,
            Kind::Deref(inner) => return self.generic_receiver(inner),
            Kind::Element { .. } | Kind::Index { .. } => {
                let generic = self.generic_of(receiver).0?;
                return Some((generic, self.value(receiver)));
            }
            _ => return None,
        };
        let local = self.find(name)?;
        let generic = local.generic.clone()?;
        let ident = self.local(name);
        Some((
            generic,
            match local.binding {
                Binding::Value | Binding::Host => quote!(#ident),
                Binding::Var | Binding::Mut => quote!(&#ident),
            },
        ))
    }

    /// Whether it is a variable outside of the closure, or a part of one.
    fn is_part_of_outer(&self, e: &Expr) -> bool {
        match &e.kind {
            Kind::Name(name) => self.is_outer(name) && self.lookup(name) != Some(Binding::Value),
            Kind::Deref(base) | Kind::Field { base, .. } | Kind::Index { base, .. } => {
                self.is_part_of_outer(base)
            }
            _ => false,
        }
    }

    /// The variable that `e` is, or is a part of, and the steps from it.
    pub(super) fn variable_under(&self, e: &Expr) -> Option<(Ident, TokenStream)> {
        match &e.kind {
            Kind::Name(name) if self.is_outer(name) => None,
            Kind::Name(name) => match self.lookup(name)? {
                Binding::Var | Binding::Mut => Some((self.local(name), TokenStream::new())),
                Binding::Value | Binding::Host => None,
            },
            Kind::Deref(a) => self.variable_under(a),
            Kind::Field { base, member } => {
                let (local, steps) = self.variable_under(base)?;
                Some((local, quote!(#steps.#member)))
            }
            Kind::Index { base, index } => {
                let (local, steps) = self.variable_under(base)?;
                Some((local, quote!(#steps[#index])))
            }
            _ => None,
        }
    }
}

/// The arguments of a call, and what stands around it for parts of variables that go by `&mut`.
#[derive(Default)]
struct Arguments {
    before: TokenStream,
    values: Vec<TokenStream>,
    after: TokenStream,
}

impl Arguments {
    pub(super) fn around(&self, call: TokenStream) -> TokenStream {
        let Self { before, after, .. } = self;
        if before.is_empty() {
            return call;
        }
        let result = own("result");
        quote!({ #before let #result = #call; #after #result })
    }
}
