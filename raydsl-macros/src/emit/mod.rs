//! Lowering from the model to the lifted Rust: one small function per rule.
//!
//! The lifted body is generic over a machine `m`. Its control flow is real Rust control flow,
//! steered by the machine's hooks; see "How it works" in the book.

mod calls;
mod control;
mod for_loop;
mod host;
mod owner;
mod places;
mod values;

pub(crate) use host::raw_capture;

use std::collections::{BTreeSet, HashMap, HashSet};

use proc_macro2::{Delimiter, Ident, TokenStream, TokenTree};

use crate::diag::Errors;
use crate::generics::{Generics, identifiers};
use crate::here::{At, in_one_place, of_type, own, private_here as private, quote_here as quote};
use crate::model::{Block, Expr, Kernel, Kind, Param, is_constant};
use owner::Owner;

/// The binding of a name.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Binding {
    /// A value.
    Value,
    /// A variable, read and assigned through the machine.
    Var,
    /// A `&mut` parameter: a variable passed on to calls as it is.
    Mut,
    /// A value of the host.
    Host,
    /// A closure.
    Function,
}

/// A name in scope.
#[derive(Clone)]
struct Local {
    binding: Binding,
    /// The type parameter that is its type.
    generic: Option<Ident>,
    /// The type parameter that is the type of its elements.
    elements: Option<Ident>,
    /// Whether it is an alias: a `&mut` of the source, or a part of one, under another name.
    alias: bool,
    /// For a counter that is the same in all rays: the counter that it is a value of.
    step: Option<Ident>,
    /// The origin of its methods.
    owner: Owner,
    /// Whether it is an integer without a suffix, which stays a number of the host.
    literal: bool,
    /// Whether it is a variable that began as one: its type is inferred.
    bare: bool,
    /// The number of its elements, if it began as a tuple with integers without a suffix.
    bare_elements: Option<usize>,
    /// The type that it gives, if it is a parameter that is a closure.
    gives: Option<TokenStream>,
}

/// The destination of a control structure's value.
#[derive(Clone)]
enum Dest {
    /// None: it is a statement.
    None,
    /// A variable.
    Slot { var: Ident, ty: SlotType },
    /// The caller.
    Return,
}

/// The source of the type of a [`Dest::Slot`].
#[derive(Clone, Copy, PartialEq, Eq)]
enum SlotType {
    /// An annotation in the source.
    Written,
    /// An outcome other than bare integers.
    ByOthers,
    /// Every outcome.
    ByAll,
}

struct Loop {
    label: Option<String>,
    ident: Ident,
    /// The destination of the value of `break value`.
    dest: Dest,
}

/// Returns a name as shown in WGSL; names made up by the macro begin with `__`.
fn shown(name: &Ident) -> String {
    name.to_string().trim_start_matches("__").to_owned()
}

/// Emits the body of one kernel for one machine.
pub(crate) struct Emitter<'a> {
    /// The machine's type: a parameter `__M`, or a concrete one for closures.
    machine: TokenStream,
    /// The type that `Self` stands for.
    self_ty: Option<TokenStream>,
    kernel: &'a Kernel,
    is_closure: bool,
    /// The number of scopes around the closure being emitted; 0 outside of one.
    outer: usize,
    /// The type parameters in scope.
    generics: Generics,
    scopes: Vec<HashMap<String, Local>>,
    loops: Vec<Loop>,
    /// Free names of a closure, in order of first use.
    pub(crate) captures: Vec<Ident>,
    /// Those of them that are also needed as host values.
    pub(crate) host_captures: Vec<Ident>,
    /// Names of constants in a closure, by their spelling alone: a local may be spelled so too.
    pub(crate) constants: Vec<Ident>,
    /// The number of open loops, and of open conditions that are not the host's.
    varying: usize,
    /// The `&mut` parameters.
    changed: Vec<Ident>,
    /// Whether the type of an integer in the kernel is inferred: then values that must be of one type
    /// take that of the first.
    has_bare: bool,
    /// The variables of values that have had an outcome.
    given: HashSet<String>,
    next: usize,
    errors: &'a mut Errors,
}

/// Returns `L` of `[L]` and `[L; N]`.
fn element_type(ty: &TokenStream) -> Option<TokenStream> {
    let Some(TokenTree::Group(g)) = ty.clone().into_iter().next() else { return None };
    let is_semicolon = |t: &TokenTree| matches!(t, TokenTree::Punct(p) if p.as_char() == ';');
    let inside = g.stream().into_iter().take_while(|t| !is_semicolon(t)).collect();
    (g.delimiter() == Delimiter::Bracket).then_some(inside)
}

impl<'a> Emitter<'a> {
    pub(crate) fn new(
        kernel: &'a Kernel,
        machine: TokenStream,
        self_ty: Option<TokenStream>,
        is_closure: bool,
        errors: &'a mut Errors,
    ) -> Self {
        Self {
            machine,
            self_ty,
            kernel,
            is_closure,
            outer: 0,
            generics: kernel.generics.clone(),
            scopes: vec![HashMap::new()],
            loops: vec![],
            captures: vec![],
            host_captures: vec![],
            constants: vec![],
            varying: 0,
            changed: vec![],
            has_bare: kernel.body.has_bare_integer(),
            given: HashSet::new(),
            next: 0,
            errors,
        }
    }

    /// Returns whether mistakes were found.
    pub(crate) fn has_errors(&self) -> bool {
        !self.errors.is_empty()
    }

    /// Adds the type parameters of the item around the kernel.
    pub(crate) fn with_generics(mut self, around: &Generics) -> Self {
        self.generics.extend(around);
        self
    }

    /// Returns the type of a parameter in lifted code.
    pub(crate) fn param(&self, param: &Param) -> TokenStream {
        if param.scene {
            let ty = &param.ty;
            return quote!(&#ty);
        }
        if !param.data {
            return self.on(&param.ty);
        }
        let _at = of_type(&param.ty);
        let (p, machine) = (private(), &self.machine);
        let ty = in_one_place(self.without_self(&param.ty));
        quote!(<#ty as #p::Parameter>::On<'__a, #machine>)
    }

    /// Returns the twin of `ty`.
    pub(crate) fn on(&self, ty: &TokenStream) -> TokenStream {
        let _at = of_type(ty);
        let (p, machine) = (private(), &self.machine);
        let ty = in_one_place(self.without_self(ty));
        quote!(<#ty as #p::Type>::On<#machine>)
    }

    fn without_self(&self, ty: &TokenStream) -> TokenStream {
        match &self.self_ty {
            Some(s) if ty.to_string() == "Self" => s.clone(),
            _ => ty.clone(),
        }
    }

    /// Emits the statements and the value of the body; parameters are already bound.
    pub(crate) fn body(&mut self) -> TokenStream {
        let (p, m) = (private(), own("m"));
        let mut prologue = TokenStream::new();
        for param in &self.kernel.params {
            let _at = At::new(param.name.span());
            let name = self.local(&param.name);
            let text = param.name.to_string();
            let binding = match param {
                Param { function: Some(_), .. } => Binding::Function,
                Param { host: true, .. } => Binding::Host,
                Param { by_mut: true, .. } => Binding::Mut,
                Param { mutable: true, .. } => Binding::Var,
                _ => Binding::Value,
            };
            if matches!(binding, Binding::Var | Binding::Mut) {
                prologue.extend(quote!(let #name = #p::Var::new(#m, #text, #name);));
            }
            let ty = (!param.is_inferred() && param.function.is_none()).then_some(&param.ty);
            self.bind_typed(&param.name, binding, ty);
            if let (Some(local), Some(f)) = (self.newest(&param.name), &param.function) {
                local.gives = Some(f.result.clone());
            }
        }
        // The user may rebind their names.
        let changing: Vec<&Param> = self.kernel.params.iter().filter(|p| p.by_mut).collect();
        for (i, param) in changing.iter().enumerate() {
            let (alias, name) = (own(&format!("changed_{i}")), self.local(&param.name));
            prologue.extend(quote!(let #alias = &#name;));
            self.changed.push(alias);
        }
        let kernel = self.kernel;
        if !kernel.body.returns() {
            let body = self.plain_body(&kernel.body);
            if self.changed.is_empty() {
                return quote!(#prologue #body);
            }
            let result = own("result");
            let all = self.with_changed(quote!(#result));
            return quote!(#prologue let #result = { #body }; #all);
        }
        let ty = kernel.result.as_ref().map(|t| self.on(t)).unwrap_or_else(|| self.no_result());
        let ty = if changing.is_empty() {
            ty
        } else {
            let types = changing.iter().map(|p| self.on(&p.ty));
            quote!((#ty, #(#types,)*))
        };
        let ret = own("ret");
        let block = self.block(&kernel.body, &Dest::Return);
        // Lanes that reach the end without a `return` return their changed parameters.
        let end = (!changing.is_empty() && kernel.result.is_none()).then(|| {
            let all = self.with_changed(quote!(()));
            quote!(#ret.give(#m, #all);)
        });
        quote!(#prologue let #ret = #p::Ret::<#ty>::new(#m); #block #end #ret.take())
    }

    /// Emits the result, and beside it the final values of the `&mut` parameters.
    fn with_changed(&self, result: TokenStream) -> TokenStream {
        let (m, changed) = (own("m"), &self.changed);
        if changed.is_empty() { result } else { quote!((#result, #(#changed.get(#m),)*)) }
    }

    /// Returns the result type if none is written: inferred for a closure, `()` for a function.
    fn no_result(&self) -> TokenStream {
        if self.is_inferred() { quote!(_) } else { quote!(()) }
    }

    /// Returns whether a result type that is not written is that of the body.
    fn is_inferred(&self) -> bool {
        self.is_closure || self.outer > 0
    }

    /// Returns whether the result of the closure may be an integer without a type of its own: then it has
    /// that of the source's closure.
    fn gives_bare(&self) -> bool {
        self.is_closure && self.outer == 0 && self.kernel.gives_bare_integer()
    }

    /// Emits a closure as an argument. It may read the surrounding variables.
    fn closure(&mut self, kernel: &Kernel) -> TokenStream {
        let m = own("m");
        let mut inner = Emitter {
            machine: self.machine.clone(),
            self_ty: self.self_ty.clone(),
            kernel,
            is_closure: self.is_closure,
            outer: self.scopes.len(),
            generics: self.generics.clone(),
            scopes: self.scopes.clone(),
            loops: vec![],
            captures: core::mem::take(&mut self.captures),
            host_captures: core::mem::take(&mut self.host_captures),
            constants: core::mem::take(&mut self.constants),
            varying: 1,
            changed: vec![],
            has_bare: self.has_bare || kernel.body.has_bare_integer(),
            given: HashSet::new(),
            next: self.next,
            errors: self.errors,
        };
        inner.scopes.push(HashMap::new());
        let body = inner.body();
        let on = |p: &Param| if p.is_inferred() { p.ty.clone() } else { inner.on(&p.ty) };
        let types: Vec<_> = kernel.params.iter().map(on).collect();
        let result = kernel.result.as_ref().map(|ty| inner.on(ty));
        let result = result.map(|ty| quote!(-> #ty));
        let constants = core::mem::take(&mut inner.constants);
        let (captures, host_captures, next) = (
            core::mem::take(&mut inner.captures),
            core::mem::take(&mut inner.host_captures),
            inner.next,
        );
        (self.captures, self.host_captures, self.next) = (captures, host_captures, next);
        self.constants = constants;
        let names = kernel.params.iter().map(|p| &p.name);
        let machine = &self.machine;
        let seen = self.mentioned_in(&body);
        quote! {
            #[inline(always)]
            |#m: &#machine, #(#names: #types),*| #result {
                #(let _ = &#seen;)*
                #body
            }
        }
    }

    /// Records that the closure captures `name`.
    fn capture(&mut self, name: &Ident) {
        if !self.captures.contains(name) {
            self.captures.push(name.clone());
        }
    }

    /// Returns the locals in scope that `code` mentions. A closure refers to each as a whole: rustc
    /// 1.95 cannot see that members captured one by one are `Copy`.
    fn mentioned_in(&self, code: &TokenStream) -> Vec<Ident> {
        let names = self.scopes.iter().flat_map(HashMap::keys);
        let mut names: BTreeSet<&str> = names.map(String::as_str).collect();
        if names.remove("self") {
            names.insert("__this");
        }
        let mut found: Vec<Ident> = Vec::new();
        identifiers(code, &mut |ident| {
            // Uses the tokens of the source: a new name would not have their hygiene.
            if names.remove(ident.to_string().as_str()) {
                found.push(ident);
            }
        });
        found
    }

    /// Returns whether a closure can read the variable, but not change it.
    fn is_outer(&self, name: &Ident) -> bool {
        let name = name.to_string();
        let found = self.scopes.iter().rposition(|s| s.contains_key(&name));
        found.is_some_and(|at| at < self.outer)
    }

    fn plain_body(&mut self, block: &Block) -> TokenStream {
        let result = self.kernel.result.clone();
        let mut out = TokenStream::new();
        for stmt in &block.stmts {
            out.extend(self.stmt(stmt));
        }
        let Some(tail) = &block.tail else {
            // A missing result is reported by rustc, in the user's own function.
            let end = result.map(|_| quote!(::core::unreachable!()));
            return quote!(#out #end);
        };
        match &result {
            Some(ty) => {
                let value = self.wanted(tail, "result", ty);
                quote!(#out #value)
            }
            None => {
                let value = if self.gives_bare() {
                    self.coerced(tail)
                } else {
                    self.named_value(tail, "result")
                };
                quote!(#out #value)
            }
        }
    }

    // Scopes.

    fn bind(&mut self, name: &Ident, binding: Binding) {
        self.bind_typed(name, binding, None);
    }

    /// Binds a name; of its type only a type parameter matters.
    fn bind_typed(&mut self, name: &Ident, binding: Binding, ty: Option<&TokenStream>) {
        let owner = ty.map_or(Owner::Unknown, Owner::of_type);
        let (generic, elements) = ty.map_or((None, None), |ty| self.generics_in(ty));
        let local = Local {
            binding,
            generic,
            elements,
            alias: false,
            step: None,
            owner,
            literal: false,
            bare: false,
            bare_elements: None,
            gives: None,
        };
        if let Some(scope) = self.scopes.last_mut() {
            scope.insert(name.to_string(), local);
        }
    }

    /// Returns the type parameter that a type is, and that of its elements.
    fn generics_in(&self, ty: &TokenStream) -> (Option<Ident>, Option<Ident>) {
        let parameter = |ty: &TokenStream| {
            let ty = ty.to_string();
            self.generics.types.iter().find(|g| **g == ty).cloned()
        };
        (parameter(ty), element_type(ty).and_then(|ty| parameter(&ty)))
    }

    /// Returns a name of the innermost scope.
    fn newest(&mut self, name: &Ident) -> Option<&mut Local> {
        self.scopes.last_mut()?.get_mut(&name.to_string())
    }

    /// Returns whether it is a `&mut` parameter, another name of one, or a part of one.
    fn is_alias(&self, e: &Expr) -> bool {
        match &e.kind {
            Kind::Name(name) => {
                self.find(name).is_some_and(|l| l.alias || l.binding == Binding::Mut)
            }
            Kind::Field { base, .. } | Kind::Index { base, .. } => self.is_alias(base),
            _ => false,
        }
    }

    /// Binds the counter of a loop.
    fn bind_counter(&mut self, name: &Ident, step: Option<Ident>) {
        self.bind(name, Binding::Value);
        if let Some(local) = self.newest(name) {
            (local.owner, local.step) = (Owner::Library, step);
        }
    }

    fn lookup(&self, name: &Ident) -> Option<Binding> {
        self.find(name).map(|l| l.binding)
    }

    fn find(&self, name: &Ident) -> Option<&Local> {
        let name = name.to_string();
        self.scopes.iter().rev().find_map(|s| s.get(&name))
    }

    /// Returns whether it is a constant of the source.
    fn is_constant(&mut self, name: &Ident) -> bool {
        let is_constant = is_constant(name) && self.lookup(name).is_none();
        if is_constant && self.is_closure && !self.constants.contains(name) {
            self.constants.push(name.clone());
        }
        is_constant
    }

    /// Returns the local of a name: `self` cannot be one.
    fn local(&self, name: &Ident) -> Ident {
        if name == "self" { own("this") } else { name.clone() }
    }

    /// Returns a local of the macro's own that no other is named like; the parser's end in `_1`.
    fn fresh(&mut self, name: &str) -> Ident {
        self.next += 1;
        own(&format!("{name}{}", self.next))
    }
}
