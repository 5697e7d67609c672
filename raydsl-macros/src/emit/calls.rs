//! Emission of calls of kernels, associated functions and methods.

use proc_macro2::{Ident, Span, TokenStream};

use super::places::{change, is_part_of_element, part_of, plain_steps};
use super::{Binding, Emitter, own, private, shown};
use crate::here::{At, quote_here as quote, word};
use crate::model::{Expr, Kind, Place};
use crate::parse::unraw;
use crate::twin::kinds;

/// Returns the name of the lifted function or method.
fn lifted(name: &Ident) -> Ident {
    word(&unraw(&format!("{name}_on")))
}

impl Emitter<'_> {
    pub(super) fn call(&mut self, path: &TokenStream, args: &[Expr], span: Span) -> TokenStream {
        let m = own("m");
        if let Some((function, result)) = self.function_called(path) {
            let args: Vec<_> = args.iter().map(|e| self.coerced(e)).collect();
            let call = quote!(#function(#m, #(#args),*));
            let Some(result) = result else { return call };
            let (p, machine, result) = (private(), self.machine.clone(), self.on(&result));
            return quote!(#p::Coerce::<#machine, #result>::coerce(#call, #m));
        }
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
        // Explicit type parameters need not be inferred.
        let is_named = path.to_string().ends_with('>');
        let on = word(if is_named { "on_values" } else { "on" });
        args.around(quote!(#path::#on(#m, #(#values),*)))
    }

    /// Returns the closure that is called, if it is one, and the type that a parameter gives.
    pub(super) fn function_called(
        &self,
        path: &TokenStream,
    ) -> Option<(Ident, Option<TokenStream>)> {
        let name = syn::parse2::<Ident>(path.clone()).ok()?;
        let local = self.find(&name)?;
        (local.binding == Binding::Function).then(|| (name, local.gives.clone()))
    }

    pub(super) fn associated(
        &mut self,
        ty: &TokenStream,
        name: &Ident,
        args: &[Expr],
    ) -> TokenStream {
        let _at = At::new(name.span());
        let m = own("m");
        let bare = if name == "Some" { args.first().and_then(|e| self.with_bare(e)) } else { None };
        let function = lifted(name);
        let mut args = self.arguments(args);
        if let Some(bare) = bare {
            args.values = vec![bare];
        }
        let values = &args.values;
        let is_variant = name.to_string().starts_with(char::is_uppercase);
        let ty = if is_variant { self.enumeration(ty) } else { self.qualified(ty) };
        args.around(quote!(#ty::#function(#m, #(#values),*)))
    }

    fn qualified(&self, ty: &TokenStream) -> TokenStream {
        let ty = self.without_self(ty);
        quote!(<#ty>)
    }

    /// Emits the enum of a variant: its parameters are inferred, as in the source.
    fn enumeration(&self, ty: &TokenStream) -> TokenStream {
        if ty.to_string().contains('<') { self.qualified(ty) } else { self.without_self(ty) }
    }

    /// Emits a call of one of the methods that the derive writes for a variant.
    pub(super) fn of_variant(
        &mut self,
        value: &Expr,
        method: &Ident,
        args: &[Expr],
    ) -> TokenStream {
        let _at = At::new(method.span());
        let (m, kinds, method) = (own("m"), kinds(), lifted(method));
        let (value, args) = (self.value(value), self.arguments(args));
        let values = &args.values;
        args.around(quote!(#value.#kinds().#method(#m, #(#values),*)))
    }

    /// Emits a value of a variant whose fields are not set yet.
    pub(super) fn new_variant(&self, ty: &TokenStream, name: &Ident) -> TokenStream {
        let _at = At::new(name.span());
        let (m, ty) = (own("m"), self.enumeration(ty));
        let new = word(&unraw(&format!("__new_{name}_on")));
        quote!(#ty::#new(#m))
    }

    fn arguments(&mut self, args: &[Expr]) -> Arguments {
        let mut all = Arguments::default();
        // Reads before a call keep their order.
        let is_part = |e: &Expr| matches!(&e.kind, Kind::RefMut(p) if !p.steps.is_empty());
        let in_order = args.iter().any(is_part);
        for arg in args {
            if let Kind::RefMut(place) = &arg.kind {
                let variable = self.mut_argument(place, arg.span, &mut all);
                all.values.extend(variable);
                continue;
            }
            let value = match self.unread(arg) {
                Some(value) => value,
                None if in_order => {
                    let (value, ident) = (self.argument(arg), self.fresh("argument"));
                    all.before.extend(quote!(let #ident = #value;));
                    quote!(#ident)
                }
                None => self.argument(arg),
            };
            all.values.push(value);
        }
        all
    }

    /// Emits an argument; the function says which integers a tuple has.
    fn argument(&mut self, arg: &Expr) -> TokenStream {
        let has_bare = match &arg.kind {
            Kind::Tuple(items) => items.iter().any(Expr::has_untyped_integer),
            Kind::Name(name) => self.bare_elements(name).is_some(),
            _ => false,
        };
        if has_bare { self.coerced(arg) } else { self.value(arg) }
    }

    /// Emits an argument that no lane reads before the call.
    fn unread(&mut self, arg: &Expr) -> Option<TokenStream> {
        let (p, m) = (private(), own("m"));
        match &arg.kind {
            Kind::Closure(kernel) => Some(self.closure(kernel)),
            Kind::Name(name) if self.lookup(name) == Some(Binding::Function) => {
                Some(quote!(&#name))
            }
            Kind::Name(name) if self.lookup(name) == Some(Binding::Mut) && !self.is_outer(name) => {
                let local = self.local(name);
                Some(quote!(&#local))
            }
            // A number may be for a host parameter, and so may a constant.
            Kind::Int { tokens, .. } => Some(tokens.clone()),
            Kind::Name(name) if self.is_constant(name) => {
                Some(quote!(#p::Constant(&#name).give(#m)))
            }
            Kind::Name(name) if self.lookup(name) == Some(Binding::Host) => Some(quote!(#name)),
            Kind::Host(_) => self.host_value(arg),
            _ => None,
        }
    }

    /// Emits `&mut place`: the variable, or a copy of the part, written back behind the call.
    fn mut_argument(
        &mut self,
        place: &Place,
        span: Span,
        around: &mut Arguments,
    ) -> Option<TokenStream> {
        let local = self.local(&place.name);
        if self.is_outer(&place.name) {
            self.outside(&place.name);
            return None;
        }
        if self.lookup(&place.name).is_none() && self.is_closure {
            self.not_ours(&place.name);
        }
        let _at = At::new(span);
        let (p, m) = (private(), own("m"));
        let (part, whole) = (self.fresh("part"), own("whole"));
        let text = shown(&place.name);
        let Some(steps) = plain_steps(&place.steps) else {
            let (indices, steps) = self.parts(&place.steps);
            let (old, back) = (part_of(quote!(#local.get(#m)), &steps), quote!(#part.get(#m)));
            let change = change(quote!(#whole), &steps, &|_| back.clone(), 0);
            around.before.extend(quote! {
                #indices
                let #part = #p::Var::new(#m, #text, #old);
            });
            around.after.extend(quote!({
                let mut #whole = #local.get(#m);
                #change
                #local.set(#m, #whole);
            }));
            return Some(quote!(&#part));
        };
        if steps.is_empty() && self.find(&place.name).is_some_and(|local| local.bare) {
            // The function says which integer it is.
            around.before.extend(quote! {
                let #part = #p::Var::new(#m, #text, #p::Coerce::coerce(#local.get(#m), #m));
            });
            around.after.extend(quote!(#local.set(#m, #p::Coerce::coerce(#part.get(#m), #m));));
            return Some(quote!(&#part));
        }
        if steps.is_empty() {
            return Some(quote!(&#local));
        }
        around.before.extend(quote! {
            let #part = #p::Var::new(#m, #text, #local.get(#m) #steps);
        });
        around.after.extend(quote!({
            let mut #whole = #local.get(#m);
            #whole #steps = #part.get(#m);
            #local.set(#m, #whole);
        }));
        Some(quote!(&#part))
    }

    /// Emits a method call. A method that takes `&mut self` changes the variable, or the part of
    /// one, that it is called on; the methods' traits decide which methods do.
    pub(super) fn method(
        &mut self,
        receiver: &Expr,
        name: &Ident,
        turbofish: &[TokenStream],
        args: &[Expr],
    ) -> TokenStream {
        self.refuse(receiver, name);
        if let Some((generic, this)) = self.generic_receiver(receiver) {
            let function = lifted(name);
            let mut args = self.arguments(args);
            args.values.splice(0..0, numbers(turbofish));
            let (m, values) = (own("m"), &args.values);
            return args.around(quote!(<#generic>::#function(#m, #this, #(#values),*)));
        }
        let variable = self.variable_under(receiver);
        let mut value = self.value(receiver);
        let bare = args.first().filter(|_| name == "unwrap_or").and_then(|e| self.with_bare(e));
        let mut args = self.arguments(args);
        if let Some(bare) = bare {
            args.values = vec![bare];
        }
        if !args.before.is_empty() {
            let (first, before) = (self.fresh("receiver"), &args.before);
            args.before = quote!(let #first = #value; #before);
            value = quote!(#first);
        }
        args.values.splice(0..0, numbers(turbofish));
        let (machine, name) = (&self.machine, name.to_string());
        let call = MethodCall { machine, name, receiver: value, values: &args.values };
        args.around(match variable {
            Some((local, steps)) if steps.is_empty() => call.on_variable(&local),
            Some((local, steps)) => call.on_part(&local, &steps),
            None if self.is_part_of_what_stays(receiver) => call.on_element(),
            None => call.on_value(),
        })
    }

    /// Returns whether it is part of a value that a method cannot change, though rustc's methods
    /// could.
    fn is_part_of_what_stays(&self, e: &Expr) -> bool {
        is_part_of_element(e) || self.is_part_of_outer(e) || self.is_alias(e)
    }

    /// Returns a receiver whose type is a type parameter: its trait has the lifted method, which
    /// takes a variable for both `&mut self` and `&self`.
    fn generic_receiver(&mut self, receiver: &Expr) -> Option<(Ident, TokenStream)> {
        let name = match &receiver.kind {
            Kind::Name(name) => name,
            Kind::Deref(inner) => return self.generic_receiver(inner),
            Kind::Element { .. } | Kind::Index { .. } | Kind::Call { .. } => {
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
                Binding::Value | Binding::Host | Binding::Function => quote!(#ident),
                Binding::Var | Binding::Mut => quote!(&#ident),
            },
        ))
    }

    /// Returns whether it is a variable outside of the closure, or a part of one.
    fn is_part_of_outer(&self, e: &Expr) -> bool {
        match &e.kind {
            Kind::Name(name) => self.is_outer(name) && self.lookup(name) != Some(Binding::Value),
            Kind::Deref(base) | Kind::Field { base, .. } | Kind::Index { base, .. } => {
                self.is_part_of_outer(base)
            }
            _ => false,
        }
    }

    /// Returns the variable that `e` is, or is a part of, and the steps from it.
    pub(super) fn variable_under(&self, e: &Expr) -> Option<(Ident, TokenStream)> {
        match &e.kind {
            Kind::Name(name) if self.is_outer(name) => None,
            Kind::Name(name) => match self.lookup(name)? {
                Binding::Var | Binding::Mut => Some((self.local(name), TokenStream::new())),
                Binding::Value | Binding::Host | Binding::Function => None,
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

/// Returns the arguments behind `::` as values.
fn numbers(turbofish: &[TokenStream]) -> Vec<TokenStream> {
    turbofish.iter().map(|ty| quote!(<#ty as ::core::default::Default>::default())).collect()
}

/// The arguments of a call, and the code around it for parts of variables passed by `&mut`.
#[derive(Default)]
struct Arguments {
    before: TokenStream,
    values: Vec<TokenStream>,
    after: TokenStream,
}

impl Arguments {
    fn around(&self, call: TokenStream) -> TokenStream {
        let Self { before, after, .. } = self;
        if before.is_empty() {
            return call;
        }
        let result = own("result");
        quote!({ #before let #result = #call; #after #result })
    }
}

/// A method call whose receiver and arguments are emitted already.
struct MethodCall<'a> {
    machine: &'a TokenStream,
    name: String,
    receiver: TokenStream,
    values: &'a [TokenStream],
}

impl MethodCall<'_> {
    fn method(&self) -> TokenStream {
        let (p, Self { machine, name, .. }) = (private(), self);
        quote!(#p::Method::<{ #p::name(#name) }, #machine, _, _>)
    }

    fn on_value(&self) -> TokenStream {
        let (m, method, Self { receiver, values, .. }) = (own("m"), self.method(), self);
        quote!(#method::call({ #receiver }, #m, (#({ #values },)*)))
    }

    /// Emits a call on a computed element: an error if the method takes `&mut self`.
    fn on_element(&self) -> TokenStream {
        let (p, m, Self { machine, name, receiver, values }) = (private(), own("m"), self);
        quote!(#p::call_on_element::<{ #p::name(#name) }, #machine, _, _, _>(
            #m, #receiver, (#(#values,)*)
        ))
    }

    fn on_variable(&self, local: &Ident) -> TokenStream {
        let (m, method, Self { receiver, values, .. }) = (own("m"), self.method(), self);
        quote!(#method::call_at({ #receiver }, &#local, #m, (#({ #values },)*)))
    }

    /// Emits a call on a part: a method that takes `&mut self` gets a copy, written back behind it.
    fn on_part(&self, local: &Ident, steps: &TokenStream) -> TokenStream {
        let (p, m, method) = (private(), own("m"), self.method());
        let Self { machine, name, receiver, values } = self;
        let (old, list, part, whole) = (own("old"), own("args"), own("part"), own("whole"));
        let (result, shown) = (own("result"), shown(local));
        quote!({
            let (#old, #list) = (#receiver, (#(#values,)*));
            if #p::is_mut::<{ #p::name(#name) }, #machine, _, _, _>(#m, &#old, &#list) {
                let #part = #p::Var::new(#m, #shown, #old);
                let #result = #method::call_at(#old, &#part, #m, #list);
                let mut #whole = #local.get(#m);
                #whole #steps = #part.get(#m);
                #local.set(#m, #whole);
                #result
            } else {
                #method::call(#old, #m, #list)
            }
        })
    }
}
