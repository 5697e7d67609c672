//! From the model to the lifted Rust: one small function a rule.
//!
//! The lifted body is generic over a machine `m`. Its control flow is real Rust control flow,
//! steered by the machine's hooks; see "How it works" in the book.

use std::collections::HashMap;

use proc_macro2::{Ident, Span, TokenStream};
use quote::{format_ident, quote, quote_spanned};

use crate::diag::Errors;
use crate::model::{
    BinaryOp, Block, Expr, IntType, Kernel, Kind, Let, Param, Place, Range, Step, Stmt,
};

/// What a name stands for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Binding {
    /// A value.
    Value,
    /// A variable: it is read and assigned through the machine.
    Var,
    /// A `&mut` parameter: a variable that calls are given as it is.
    Mut,
}

/// Where the value of a control structure goes.
#[derive(Clone)]
enum Dest {
    /// Nowhere: it is a statement.
    None,
    /// To a variable.
    Slot { var: Ident, ty: SlotType },
    /// To the caller.
    Return,
}

/// What is known of the type of a [`Dest::Slot`].
#[derive(Clone, Copy, PartialEq, Eq)]
enum SlotType {
    /// It is written in the source.
    Written,
    /// Other outcomes than bare integers say it.
    ByOthers,
    /// Each outcome says it.
    ByAll,
}

struct Loop {
    label: Option<String>,
    ident: Ident,
    /// Where `break value` sends the value.
    dest: Dest,
}

/// How a name is shown in WGSL; those that the macro makes up begin with `__`.
fn shown(name: &Ident) -> String {
    name.to_string().trim_start_matches("__").to_owned()
}

/// Writes the body of one kernel for one machine.
pub(crate) struct Emitter<'a> {
    /// The machine's type: a parameter `__M`, or a concrete one for closures.
    machine: TokenStream,
    /// The type that `Self` stands for.
    self_ty: Option<TokenStream>,
    kernel: &'a Kernel,
    is_closure: bool,
    scopes: Vec<HashMap<String, Binding>>,
    loops: Vec<Loop>,
    /// Free names of a closure, in order of first use.
    pub(crate) captures: Vec<Ident>,
    /// The `&mut` parameters.
    changed: Vec<Ident>,
    next: usize,
    errors: &'a mut Errors,
}

fn private() -> TokenStream {
    quote!(::raydsl::__private)
}

/// An identifier that cannot meet one of the user's.
fn own(name: &str) -> Ident {
    Ident::new(name, Span::mixed_site())
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
            scopes: vec![HashMap::new()],
            loops: vec![],
            captures: vec![],
            changed: vec![],
            next: 0,
            errors,
        }
    }

    /// The twin of `ty`.
    pub(crate) fn on(&self, ty: &TokenStream) -> TokenStream {
        let (p, machine) = (private(), &self.machine);
        let ty = self.without_self(ty);
        quote!(<#ty as #p::Type>::On<#machine>)
    }

    fn without_self(&self, ty: &TokenStream) -> TokenStream {
        match &self.self_ty {
            Some(s) if ty.to_string() == "Self" => s.clone(),
            _ => ty.clone(),
        }
    }

    /// The statements and the value of the body; parameters are bound already.
    pub(crate) fn body(&mut self) -> TokenStream {
        let (p, m) = (private(), own("m"));
        let mut prologue = TokenStream::new();
        for param in &self.kernel.params {
            let name = self.local(&param.name);
            let text = param.name.to_string();
            let binding = match param {
                Param { by_mut: true, .. } => Binding::Mut,
                Param { mutable: true, .. } => Binding::Var,
                _ => Binding::Value,
            };
            if binding != Binding::Value {
                prologue.extend(quote!(let #name = #p::Var::new(#m, #text, #name);));
            }
            self.bind(&param.name, binding);
        }
        // The user may bind their names anew.
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
        // Lanes that come to the end without a `return` give what they changed.
        let end = (!changing.is_empty() && kernel.result.is_none()).then(|| {
            let all = self.with_changed(quote!(()));
            quote!(#ret.give(#m, #all);)
        });
        quote!(#prologue let #ret = #p::Ret::<#ty>::new(#m); #block #end #ret.take())
    }

    /// The result, and beside it what became of the `&mut` parameters.
    fn with_changed(&self, result: TokenStream) -> TokenStream {
        let (m, changed) = (own("m"), &self.changed);
        if changed.is_empty() { result } else { quote!((#result, #(#changed.get(#m),)*)) }
    }

    /// The result type where none is written: inferred for a closure, `()` for a function.
    fn no_result(&self) -> TokenStream {
        if self.is_closure { quote!(_) } else { quote!(()) }
    }

    fn plain_body(&mut self, block: &Block) -> TokenStream {
        let result = self.kernel.result.clone();
        let mut out = TokenStream::new();
        for stmt in &block.stmts {
            out.extend(self.stmt(stmt));
        }
        let Some(tail) = &block.tail else { return out };
        match &result {
            Some(ty) => {
                let value = self.wanted(tail, "result", ty);
                quote!(#out #value)
            }
            None => {
                let value = self.named_value(tail, "result");
                quote!(#out #value)
            }
        }
    }

    // Scopes.

    fn bind(&mut self, name: &Ident, binding: Binding) {
        if let Some(scope) = self.scopes.last_mut() {
            scope.insert(name.to_string(), binding);
        }
    }

    fn lookup(&self, name: &Ident) -> Option<Binding> {
        let name = name.to_string();
        self.scopes.iter().rev().find_map(|s| s.get(&name).copied())
    }

    /// `self` cannot be the name of a local.
    fn local(&self, name: &Ident) -> Ident {
        if name == "self" { Ident::new("this", Span::mixed_site()) } else { name.clone() }
    }

    fn fresh(&mut self, name: &str) -> Ident {
        self.next += 1;
        own(&format!("{name}_{}", self.next))
    }

    // Statements.

    /// A block whose value goes to `dest`, with the checks that leave it once no lane is left.
    fn block(&mut self, block: &Block, dest: &Dest) -> TokenStream {
        self.scopes.push(HashMap::new());
        let (p, m) = (private(), own("m"));
        let label = self.next;
        self.next += 1;
        let label = syn::Lifetime::new(&format!("'block_{label}"), Span::mixed_site());
        let mut out = TokenStream::new();
        let mut checked = false;
        let mut ended = false;
        for (i, stmt) in block.stmts.iter().enumerate() {
            out.extend(self.stmt(stmt));
            if matches!(stmt, Stmt::Expr(e) if e.diverges()) {
                // What follows is never reached; rustc says so for the user's own function.
                ended = true;
                break;
            }
            let more = i + 1 < block.stmts.len() || block.tail.is_some();
            if stmt.ends_lanes() && more {
                out.extend(quote!(if !#p::Machine::alive(#m) { break #label; }));
                checked = true;
            }
        }
        if let (Some(tail), false) = (&block.tail, ended) {
            out.extend(self.into(tail, dest));
        }
        self.scopes.pop();
        if checked { quote!(#label: { #out }) } else { quote!({ #out }) }
    }

    fn stmt(&mut self, stmt: &Stmt) -> TokenStream {
        match stmt {
            Stmt::Let(l) => self.let_stmt(l),
            Stmt::Expr(e) => self.into(e, &Dest::None),
            Stmt::Item(item) => item.clone(),
        }
    }

    fn let_stmt(&mut self, l: &Let) -> TokenStream {
        let (p, m) = (private(), own("m"));
        let Some(name) = &l.name else {
            let value = l.init.as_ref().map(|e| self.value(e));
            return quote!(let _ = #value;);
        };
        let text = shown(name);
        let ty = l.ty.as_ref().map(|t| self.on(t));
        let Some(init) = &l.init else {
            self.bind(name, Binding::Var);
            let ty = ty.unwrap_or_else(|| quote!(_));
            return quote!(let #name = #p::Var::<#ty>::declare(#m, #text););
        };
        let value = match &l.ty {
            Some(ty) => self.wanted(init, &text, ty),
            None => self.named_value(init, &text),
        };
        let binding = if l.mutable { Binding::Var } else { Binding::Value };
        self.bind(name, binding);
        match (l.mutable, ty) {
            (true, Some(ty)) => quote!(let #name = #p::Var::<#ty>::new(#m, #text, #value);),
            (true, None) => {
                quote!(let #name = #p::Var::new(#m, #text, #p::Varying::varying(#value, #m));)
            }
            (false, Some(ty)) => {
                quote!(let #name: #ty = #p::Machine::named(#m, #text, #value);)
            }
            (false, None) => quote!(let #name = #p::Machine::named(#m, #text, #value);),
        }
    }

    /// Evaluates `e` and sends its value to `dest`.
    fn into(&mut self, e: &Expr, dest: &Dest) -> TokenStream {
        match &e.kind {
            Kind::If { c, then, otherwise } => self.branch(c, then, otherwise.as_deref(), dest),
            Kind::Block(b) => self.block(b, dest),
            Kind::While { label, c, body } => {
                self.while_loop(label.clone(), Some(c), body, &Dest::None)
            }
            Kind::Loop { label, body } => self.while_loop(label.clone(), None, body, dest),
            Kind::For { label, var, range, body } => {
                self.for_loop(label.clone(), var.as_ref(), range, body)
            }
            Kind::Break(label, value) => self.exit(label.as_deref(), "leave", value.as_deref()),
            Kind::Continue(label) => self.exit(label.as_deref(), "skip", None),
            Kind::Return(value) => self.return_stmt(value.as_deref()),
            Kind::Assign { place, value } => self.assign(place, None, value),
            Kind::OpAssign { op, place, value } => self.assign(place, Some(*op), value),
            _ => self.send(e, dest),
        }
    }

    fn send(&mut self, e: &Expr, dest: &Dest) -> TokenStream {
        let (p, m) = (private(), own("m"));
        match dest {
            Dest::None => {
                let value = self.value(e);
                quote!(#value;)
            }
            Dest::Slot { var, ty }
                if *ty == SlotType::Written
                    || *ty == SlotType::ByOthers && e.is_untyped_integer() =>
            {
                let value = self.coerced(e);
                quote!(#var.set(#m, #value);)
            }
            Dest::Slot { var, .. } => {
                let value = self.value(e);
                quote!(#var.set(#m, #p::Varying::varying(#value, #m));)
            }
            Dest::Return => self.give(e),
        }
    }

    fn give(&mut self, e: &Expr) -> TokenStream {
        let (p, m, ret) = (private(), own("m"), own("ret"));
        let value = if self.kernel.result.is_some() {
            self.coerced(e)
        } else {
            let value = self.value(e);
            if self.is_closure { quote!(#p::Varying::varying(#value, #m)) } else { value }
        };
        let all = self.with_changed(value);
        quote!(#ret.give(#m, #all);)
    }

    fn return_stmt(&mut self, value: Option<&Expr>) -> TokenStream {
        match value {
            Some(e) => self.into(e, &Dest::Return),
            None => {
                let (m, ret) = (own("m"), own("ret"));
                let all = self.with_changed(quote!(()));
                quote!(#ret.give(#m, #all);)
            }
        }
    }

    fn branch(
        &mut self,
        c: &Expr,
        then: &Block,
        otherwise: Option<&Expr>,
        dest: &Dest,
    ) -> TokenStream {
        let (p, m) = (private(), own("m"));
        let branch = self.fresh("branch");
        let c = self.value(c);
        let then = self.block(then, dest);
        let other = otherwise.map(|e| {
            let arm = self.into(e, dest);
            quote!(if #branch.otherwise(#m) { #arm })
        });
        quote! {
            let #branch = #p::Branch::new(#m, #c);
            if #branch.then(#m) { #then }
            #other
            #branch.end(#m);
        }
    }

    fn while_loop(
        &mut self,
        label: Option<String>,
        c: Option<&Expr>,
        body: &Block,
        dest: &Dest,
    ) -> TokenStream {
        let (p, m) = (private(), own("m"));
        let ident = self.fresh("repeat");
        let test = c.map(|c| {
            let c = self.value(c);
            quote!(if !#ident.test(#m, #c) { break; })
        });
        self.loops.push(Loop { label, ident: ident.clone(), dest: dest.clone() });
        let body = self.block(body, &Dest::None);
        self.loops.pop();
        quote! {
            let #ident = #p::Loop::new(#m);
            loop {
                #test
                #body
                #ident.continuing(#m);
                if !#ident.again(#m) { break; }
            }
            #ident.end(#m);
        }
    }

    fn for_loop(
        &mut self,
        label: Option<String>,
        var: Option<&Ident>,
        range: &Range,
        body: &Block,
    ) -> TokenStream {
        let (p, m) = (private(), own("m"));
        let (ident, counter, done) =
            (self.fresh("repeat"), self.fresh("counter"), self.fresh("done"));
        let (begin, stop) = (own("begin"), own("end"));
        let text = var.map(ToString::to_string).unwrap_or_else(|| "i".to_owned());
        let (start, end) = (self.value(&range.start), self.value(&range.end));
        let now = quote!(#counter.get(#m));
        // `[low, high)` or `[low, high]`, upwards from `low` or downwards from `high`.
        let (low, high) = if range.reversed {
            (quote!(#begin), now.clone())
        } else {
            (now.clone(), quote!(#stop))
        };
        let (first, last) = if range.reversed { (&stop, &begin) } else { (&begin, &stop) };
        let step =
            Ident::new(if range.reversed { "decrement" } else { "increment" }, Span::call_site());
        let one_down = range.reversed && !range.inclusive;
        let item = if one_down { quote!(#p::decrement(#m, #now)) } else { now.clone() };
        // The last number of an inclusive range may be the last of its type.
        let (declare, test, note) = if range.inclusive {
            (
                quote!(let #done = #p::Var::new(#m, "done", #p::Varying::varying(false, #m));),
                quote!(#p::goes_on(#m, #done.get(#m), #low, #high)),
                quote!(#done.set(#m, #p::equal(#m, #now, #last));),
            )
        } else {
            (quote!(), quote!(#p::less(#m, #low, #high)), quote!())
        };
        self.scopes.push(HashMap::new());
        let bound = var.map(|v| {
            self.bind(v, Binding::Value);
            quote!(let #v = #item;)
        });
        self.loops.push(Loop { label, ident: ident.clone(), dest: Dest::None });
        let body = self.block(body, &Dest::None);
        self.loops.pop();
        self.scopes.pop();
        quote! {{
            let (#begin, #stop) = #p::range(#m, #start, #end);
            let #counter = #p::Var::new(#m, #text, #first);
            #declare
            let #ident = #p::Loop::new(#m);
            loop {
                if !#ident.test(#m, #test) { break; }
                #bound
                #body
                #ident.continuing(#m);
                #note
                #counter.set(#m, #p::#step(#m, #now));
                if !#ident.again(#m) { break; }
            }
            #ident.end(#m);
        }}
    }

    fn exit(&mut self, label: Option<&str>, how: &str, value: Option<&Expr>) -> TokenStream {
        let mut loops = self.loops.iter().rev();
        let found = match label {
            None => loops.next(),
            Some(l) => loops.find(|x| x.label.as_deref() == Some(l)),
        };
        // A label that does not exist is rustc's to report, in the user's own function.
        let Some(Loop { ident, dest, .. }) = found else { return TokenStream::new() };
        let (m, how) = (own("m"), format_ident!("{how}"));
        let (ident, dest) = (ident.clone(), dest.clone());
        let value = value.map(|e| self.into(e, &dest));
        quote!(#value #ident.#how(#m);)
    }

    /// A variable of the code around a closure.
    fn not_ours(&mut self, name: &Ident) {
        self.errors.at(
            name.span(),
            format!("a kernel cannot assign to `{name}`, which belongs to the code around it"),
            "return the new value, or declare the variable inside the kernel",
        );
    }

    fn assign(&mut self, place: &Place, op: Option<BinaryOp>, value: &Expr) -> TokenStream {
        let (p, m) = (private(), own("m"));
        let name = &place.name;
        match self.lookup(name) {
            Some(Binding::Var | Binding::Mut) => {}
            // rustc reports it in the user's own function.
            Some(Binding::Value) => return TokenStream::new(),
            None => {
                if self.is_closure {
                    self.not_ours(name);
                }
                return TokenStream::new();
            }
        }
        // The right side first: it may read the place.
        let right = own("right");
        let is_list = matches!(value.kind, Kind::Tuple(_) | Kind::Array(_) | Kind::Repeat { .. });
        let value = if op.is_none() && is_list { self.coerced(value) } else { self.value(value) };
        let mut indices = TokenStream::new();
        let mut steps = Vec::new();
        for step in &place.steps {
            steps.push(match step {
                Step::Member(member) => Part::Plain(quote!(.#member)),
                Step::Element(index) => Part::Plain(quote!([#index])),
                Step::Computed(e) => {
                    let (index, value) = (self.fresh("index"), self.value(e));
                    indices.extend(quote!(let #index = #value;));
                    Part::Computed(index)
                }
            });
        }
        let new = |old: TokenStream| match op {
            Some(op) => {
                let new = operator(op, quote!(#m), old, quote!(#right));
                quote!(#p::Coerce::coerce(#new, #m))
            }
            None if is_list => quote!(#right),
            None => quote!(#p::Coerce::coerce(#right, #m)),
        };
        let local = self.local(name);
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

    // Expressions.

    /// A value, with a name for those who read generated code.
    fn named_value(&mut self, e: &Expr, name: &str) -> TokenStream {
        self.structured(e, name, None).unwrap_or_else(|| self.plain_value(e))
    }

    /// A value of the type `ty`, which is written in the source.
    fn wanted(&mut self, e: &Expr, name: &str, ty: &TokenStream) -> TokenStream {
        let (p, m) = (private(), own("m"));
        match self.structured(e, name, Some(ty)) {
            Some(value) => quote!(#p::Coerce::coerce(#value, #m)),
            None => self.coerced(e),
        }
    }

    /// A value where its type is known. Elements of tuples and arrays become values of the machine
    /// one by one.
    fn coerced(&mut self, e: &Expr) -> TokenStream {
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
            _ => {
                let value = self.value(e);
                quote!(#p::Coerce::coerce(#value, #m))
            }
        }
    }

    /// The value of a control structure goes through a variable.
    fn structured(
        &mut self,
        e: &Expr,
        name: &str,
        ty: Option<&TokenStream>,
    ) -> Option<TokenStream> {
        if !e.is_structured() {
            return None;
        }
        let (p, m) = (private(), own("m"));
        let var = self.fresh("value");
        let slot = match ty {
            Some(_) => SlotType::Written,
            None if e.has_typed_outcome() => SlotType::ByOthers,
            None => SlotType::ByAll,
        };
        let ty = ty.map(|t| self.on(t)).unwrap_or_else(|| quote!(_));
        let code = self.into(e, &Dest::Slot { var: var.clone(), ty: slot });
        Some(quote!({
            let #var = #p::Var::<#ty>::declare(#m, #name);
            #code
            #var.get(#m)
        }))
    }

    fn value(&mut self, e: &Expr) -> TokenStream {
        self.named_value(e, "value")
    }

    fn plain_value(&mut self, e: &Expr) -> TokenStream {
        let (p, m) = (private(), own("m"));
        let span = e.span;
        match &e.kind {
            Kind::Float(lit) => quote!(#p::f32(#m, #lit)),
            Kind::Int { tokens, suffix } => match suffix {
                Some(IntType::I32) => quote!(#p::i32(#m, #tokens)),
                Some(IntType::U32) => quote!(#p::u32(#m, #tokens)),
                None => tokens.clone(),
            },
            Kind::Bool(b) => quote!(#b),
            Kind::Name(name) => self.name(name),
            Kind::Path(path) => {
                let machine = &self.machine;
                quote_spanned!(span=> #p::Capture::<#machine>::constant(&#path, #m))
            }
            Kind::Neg(a) => match &a.kind {
                Kind::Float(lit) => quote!(#p::f32(#m, -#lit)),
                Kind::Int { tokens, suffix: None } => quote!((-#tokens)),
                _ => {
                    let a = self.value(a);
                    quote_spanned!(span=> #p::OpNeg::neg(#m, #a))
                }
            },
            Kind::Not(a) => {
                let a = self.value(a);
                quote_spanned!(span=> #p::OpNot::not(#m, #a))
            }
            Kind::Binary { op, a, b } => {
                let (a, b) = (self.value(a), self.value(b));
                operator(*op, quote_spanned!(span=> #m), a, b)
            }
            Kind::Logic { and, a, b } => self.logic(*and, a, b, span),
            Kind::Compare { op, a, b } => {
                let op = Ident::new(op, span);
                let (a, b) = (self.value(a), self.value(b));
                quote_spanned!(span=> #p::OpCompare::compare(#m, #p::Compare::#op, #a, #b))
            }
            Kind::Cast { value, ty } => {
                let value = self.value(value);
                quote_spanned!(span=> #p::cast::<_, _, #ty>(#m, #value))
            }
            Kind::Call { path, args } => self.call(path, args, span),
            Kind::Associated { ty, name, args } => {
                let ty = self.without_self(ty);
                let name = format_ident!("{name}_on");
                let args = self.arguments(args);
                let values = &args.values;
                args.around(quote_spanned!(span=> <#ty>::#name(#m, #(#values),*)))
            }
            Kind::Method { receiver, name, args } => self.method(receiver, name, args),
            Kind::Deref(a) => self.value(a),
            Kind::RefMut(_) => quote!(::core::unreachable!()),
            Kind::Field { base, member } => {
                let base = self.value(base);
                quote_spanned!(span=> #base.#member)
            }
            Kind::Index { base, index } => {
                let base = self.value(base);
                quote_spanned!(span=> #base[#index])
            }
            Kind::Struct { path, fields, rest } => self.structure(path, fields, rest.as_deref()),
            Kind::Tuple(items) => {
                let items = self.values(items);
                quote!((#(#items,)*))
            }
            Kind::Element { base, index } => {
                let (base, index) = (self.value(base), self.value(index));
                quote_spanned!(span=> #p::element(#m, #base, #index))
            }
            Kind::Array(items) => {
                let is_typed = items.iter().any(|e| !e.is_untyped_integer());
                let items: Vec<_> = items
                    .iter()
                    .map(|e| {
                        if is_typed && e.is_untyped_integer() {
                            self.coerced(e)
                        } else {
                            self.value(e)
                        }
                    })
                    .collect();
                quote!([#(#items,)*])
            }
            Kind::Repeat { value, len } => {
                let value = self.value(value);
                quote!([#value; #len])
            }
            Kind::Block(b) => self.plain_block(b),
            Kind::Error => quote!(::core::unreachable!()),
            _ => {
                let code = self.into(e, &Dest::None);
                quote!({ #code })
            }
        }
    }

    fn values(&mut self, es: &[Expr]) -> Vec<TokenStream> {
        es.iter().map(|e| self.value(e)).collect()
    }

    fn name(&mut self, name: &Ident) -> TokenStream {
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
            None => {
                let machine = &self.machine;
                let is_constant = name.to_string().starts_with(|c: char| c.is_ascii_uppercase());
                if is_constant || !self.is_closure {
                    return quote_spanned!(name.span()=> #p::Capture::<#machine>::constant(&#name, #m));
                }
                if name == "self" {
                    self.errors.at(
                        name.span(),
                        "a kernel cannot capture `self`",
                        "name what it needs before it: `let bvh = &self.bvh;`",
                    );
                    return quote!(::core::unreachable!());
                }
                if !self.captures.contains(name) {
                    self.captures.push(name.clone());
                }
                quote!(#name)
            }
        }
    }

    /// `&&` and `||`: both sides at once where the right one is harmless, else an `if`.
    fn logic(&mut self, and: bool, a: &Expr, b: &Expr, span: Span) -> TokenStream {
        let (p, m) = (private(), own("m"));
        if b.is_total() {
            let (operator, method) = if and { ("OpAnd", "and") } else { ("OpOr", "or") };
            let (operator, method) = (format_ident!("{operator}"), format_ident!("{method}"));
            let may_overflow = b.may_overflow();
            let (a, b) = (self.value(a), self.value(b));
            if !may_overflow {
                return quote_spanned!(span=> #p::#operator::#method(#m, #a, #b));
            }
            let left = own("left");
            return quote_spanned!(span=> {
                let #left = #a;
                #p::#operator::#method(#m, #left, #p::guarded(#m, #left, #and, || #b))
            });
        }
        let block = |e: &Expr| Block { stmts: vec![], tail: Some(Box::new(e.clone())) };
        let literal = Expr { kind: Kind::Bool(!and), span };
        let (then, other) = if and { (b, &literal) } else { (&literal, b) };
        let choice = Kind::If {
            c: Box::new(a.clone()),
            then: block(then),
            otherwise: Some(Box::new(Expr { kind: Kind::Block(block(other)), span })),
        };
        self.named_value(&Expr { kind: choice, span }, if and { "both" } else { "either" })
    }

    fn call(&mut self, path: &TokenStream, args: &[Expr], span: Span) -> TokenStream {
        let m = own("m");
        if self.kernel.name == path.to_string() && !self.is_closure {
            self.errors.at(
                span,
                format!("the kernel `{path}` calls itself"),
                "write a loop: a GPU has no recursion",
            );
            return quote!(::core::unreachable!());
        }
        let args = self.arguments(args);
        let values = &args.values;
        args.around(quote_spanned!(span=> #path::on(#m, #(#values),*)))
    }

    fn arguments(&mut self, args: &[Expr]) -> Arguments {
        let (p, m) = (private(), own("m"));
        let mut all = Arguments::default();
        for arg in args {
            let value = match &arg.kind {
                Kind::RefMut(place) => {
                    let local = self.local(&place.name);
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
                Kind::Name(name) if self.lookup(name) == Some(Binding::Mut) => {
                    let local = self.local(name);
                    quote!(&#local)
                }
                _ => self.value(arg),
            };
            all.values.push(value);
        }
        all
    }

    /// A method that takes `&mut self` changes the variable, or the part of one, that it is
    /// called on; which methods do is for their traits to say.
    fn method(&mut self, receiver: &Expr, name: &Ident, args: &[Expr]) -> TokenStream {
        let (p, m) = (private(), own("m"));
        let text = name.to_string();
        let machine = self.machine.clone();
        // What is wrong with the call is shown at its name.
        let at = quote_spanned!(name.span()=> ::raydsl::__private);
        let method = quote_spanned!(name.span()=> #at::Method::<{ #at::name(#text) }, #machine, _>);
        let variable = self.variable_under(receiver);
        let value = self.value(receiver);
        let args = self.arguments(args);
        let values = &args.values;
        let Some((local, steps)) = variable else {
            if is_part_of_element(receiver) {
                return args.around(quote_spanned!(name.span()=>
                    #p::call_on_element::<{ #p::name(#text) }, #machine, _, _>(
                        #m, #value, (#(#values,)*)
                    )
                ));
            }
            return args
                .around(quote_spanned!(name.span()=> #method::call(#value, #m, (#(#values,)*))));
        };
        if steps.is_empty() {
            return args.around(quote_spanned!(name.span()=>
                #method::call_at(#value, &#local, #m, (#(#values,)*))
            ));
        }
        let (old, list, part, whole) = (own("old"), own("args"), own("part"), own("whole"));
        let shown = shown(&local);
        args.around(quote_spanned!(name.span()=> {
            let (#old, #list) = (#value, (#(#values,)*));
            if #p::is_mut::<{ #p::name(#text) }, #machine, _, _>(#m, &#old, &#list) {
                let #part = #p::Var::new(#m, #shown, #old);
                let result = #method::call_at(#old, &#part, #m, #list);
                let mut #whole = #local.get(#m);
                #whole #steps = #part.get(#m);
                #local.set(#m, #whole);
                result
            } else {
                #method::call(#old, #m, #list)
            }
        }))
    }

    /// The variable that `e` is, or is a part of, and the steps from it.
    fn variable_under(&self, e: &Expr) -> Option<(Ident, TokenStream)> {
        match &e.kind {
            Kind::Name(name) => match self.lookup(name)? {
                Binding::Var | Binding::Mut => Some((self.local(name), TokenStream::new())),
                Binding::Value => None,
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

    fn structure(
        &mut self,
        path: &TokenStream,
        fields: &[(TokenStream, Expr)],
        rest: Option<&Expr>,
    ) -> TokenStream {
        let p = private();
        let path = self.without_self(path);
        let machine = &self.machine.clone();
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
            type __Twin<M__> = <#path as #p::Type>::On<M__>;
            __Twin::<#machine> { #(#members,)* #rest }
        }}
    }

    fn plain_block(&mut self, b: &Block) -> TokenStream {
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

/// The arguments of a call, and what stands around it for parts of variables that go by `&mut`.
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

/// Whether it is a computed element of an array, or a part of one.
fn is_part_of_element(e: &Expr) -> bool {
    match &e.kind {
        Kind::Element { .. } => true,
        Kind::Field { base, .. } | Kind::Index { base, .. } => is_part_of_element(base),
        _ => false,
    }
}

/// The steps of a place none of which is computed.
fn plain_steps(steps: &[Step]) -> Option<TokenStream> {
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
enum Part {
    Plain(TokenStream),
    Computed(Ident),
}

/// Changes the part of `place` at the end of `steps` to what `new` makes of its old value.
fn change(
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

fn operator(op: BinaryOp, m: TokenStream, a: TokenStream, b: TokenStream) -> TokenStream {
    let p = private();
    let (operator, method) = (format_ident!("{}", op.operator), format_ident!("{}", op.method));
    quote!(#p::#operator::#method(#m, #a, #b))
}
