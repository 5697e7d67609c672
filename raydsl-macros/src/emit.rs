//! From the model to the lifted Rust: one small function a rule.
//!
//! The lifted body is generic over a machine `m`. Its control flow is real Rust control flow,
//! steered by the machine's hooks; see "How it works" in the book.

use std::collections::HashMap;

use proc_macro2::{Ident, Span, TokenStream};
use quote::{format_ident, quote, quote_spanned};

use crate::diag::Errors;
use crate::model::{BinaryOp, Block, Expr, IntType, Kernel, Kind, Let, Place, Stmt};

/// What a name stands for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Binding {
    /// A value.
    Value,
    /// A variable: it is read and assigned through the machine.
    Var,
}

/// Where the value of a control structure goes.
#[derive(Clone)]
enum Dest {
    /// Nowhere: it is a statement.
    None,
    /// To a variable; whether its type is written in the source.
    Slot { var: Ident, typed: bool },
    /// To the caller.
    Return,
}

struct Loop {
    label: Option<String>,
    ident: Ident,
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
            let binding = if param.mutable { Binding::Var } else { Binding::Value };
            if param.mutable {
                prologue.extend(quote!(let #name = #p::Var::new(#m, #text, #name);));
            }
            self.bind(&param.name, binding);
        }
        let kernel = self.kernel;
        let body = if kernel.body.returns() {
            let ty = kernel.result.as_ref().map(|t| self.on(t)).unwrap_or_else(|| self.no_result());
            let ret = own("ret");
            let block = self.block(&kernel.body, &Dest::Return);
            quote!(let #ret = #p::Ret::<#ty>::new(#m); #block #ret.take())
        } else {
            self.plain_body(&kernel.body)
        };
        quote!(#prologue #body)
    }

    /// The result type where none is written: inferred for a closure, `()` for a function.
    fn no_result(&self) -> TokenStream {
        if self.is_closure { quote!(_) } else { quote!(()) }
    }

    fn plain_body(&mut self, block: &Block) -> TokenStream {
        let (p, m) = (private(), own("m"));
        let result = self.kernel.result.clone();
        let mut out = TokenStream::new();
        for stmt in &block.stmts {
            out.extend(self.stmt(stmt));
        }
        let Some(tail) = &block.tail else { return out };
        let value = match &result {
            Some(ty) => self.value_of_type(tail, "result", ty),
            None => self.named_value(tail, "result"),
        };
        match result {
            Some(_) => quote!(#out #p::Coerce::coerce(#value, #m)),
            None => quote!(#out #value),
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
        let text = name.to_string();
        let ty = l.ty.as_ref().map(|t| self.on(t));
        let Some(init) = &l.init else {
            self.bind(name, Binding::Var);
            let ty = ty.unwrap_or_else(|| quote!(_));
            return quote!(let #name = #p::Var::<#ty>::declare(#m, #text););
        };
        let value = match &l.ty {
            Some(ty) => self.value_of_type(init, &text, ty),
            None => self.named_value(init, &text),
        };
        let binding = if l.mutable { Binding::Var } else { Binding::Value };
        self.bind(name, binding);
        match (l.mutable, ty) {
            (true, Some(ty)) => {
                quote!(let #name = #p::Var::<#ty>::new(#m, #text, #p::Coerce::coerce(#value, #m));)
            }
            (true, None) => {
                quote!(let #name = #p::Var::new(#m, #text, #p::Varying::varying(#value, #m));)
            }
            (false, Some(ty)) => quote! {
                let #name: #ty = #p::Machine::named(#m, #text, #p::Coerce::coerce(#value, #m));
            },
            (false, None) => quote!(let #name = #p::Machine::named(#m, #text, #value);),
        }
    }

    /// Evaluates `e` and sends its value to `dest`.
    fn into(&mut self, e: &Expr, dest: &Dest) -> TokenStream {
        match &e.kind {
            Kind::If { c, then, otherwise } => self.branch(c, then, otherwise.as_deref(), dest),
            Kind::Block(b) => self.block(b, dest),
            Kind::While { label, c, body } => self.while_loop(label.clone(), Some(c), body),
            Kind::Loop { label, body } => self.while_loop(label.clone(), None, body),
            Kind::For { label, var, start, end, body } => {
                self.for_loop(label.clone(), var.as_ref(), start, end, body)
            }
            Kind::Break(label) => self.exit(label.as_deref(), "leave"),
            Kind::Continue(label) => self.exit(label.as_deref(), "skip"),
            Kind::Return(value) => self.return_stmt(value.as_deref()),
            Kind::Assign { place, value } => self.assign(place, None, value),
            Kind::OpAssign { op, place, value } => self.assign(place, Some(*op), value),
            _ => self.send(e, dest),
        }
    }

    fn send(&mut self, e: &Expr, dest: &Dest) -> TokenStream {
        let (p, m) = (private(), own("m"));
        let value = self.value(e);
        match dest {
            Dest::None => quote!(#value;),
            Dest::Slot { var, typed: true } => {
                quote!(#var.set(#m, #p::Coerce::coerce(#value, #m));)
            }
            Dest::Slot { var, typed: false } => {
                quote!(#var.set(#m, #p::Varying::varying(#value, #m));)
            }
            Dest::Return => self.give(value),
        }
    }

    fn give(&mut self, value: TokenStream) -> TokenStream {
        let (p, m, ret) = (private(), own("m"), own("ret"));
        if self.kernel.result.is_some() {
            quote!(#ret.give(#m, #p::Coerce::coerce(#value, #m));)
        } else if self.is_closure {
            quote!(#ret.give(#m, #p::Varying::varying(#value, #m));)
        } else {
            quote!(#ret.give(#m, #value);)
        }
    }

    fn return_stmt(&mut self, value: Option<&Expr>) -> TokenStream {
        match value {
            Some(e) => self.into(e, &Dest::Return),
            None => self.give(quote!(())),
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

    fn while_loop(&mut self, label: Option<String>, c: Option<&Expr>, body: &Block) -> TokenStream {
        let (p, m) = (private(), own("m"));
        let ident = self.fresh("repeat");
        let test = c.map(|c| {
            let c = self.value(c);
            quote!(if !#ident.test(#m, #c) { break; })
        });
        self.loops.push(Loop { label, ident: ident.clone() });
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
        start: &Expr,
        end: &Expr,
        body: &Block,
    ) -> TokenStream {
        let (p, m) = (private(), own("m"));
        let (ident, counter) = (self.fresh("repeat"), self.fresh("counter"));
        let (begin, stop) = (own("begin"), own("end"));
        let text = var.map(ToString::to_string).unwrap_or_else(|| "i".to_owned());
        let (start, end) = (self.value(start), self.value(end));
        self.scopes.push(HashMap::new());
        let bound = var.map(|v| {
            self.bind(v, Binding::Value);
            quote!(let #v = #counter.get(#m);)
        });
        self.loops.push(Loop { label, ident: ident.clone() });
        let body = self.block(body, &Dest::None);
        self.loops.pop();
        self.scopes.pop();
        quote! {{
            let (#begin, #stop) = #p::range(#m, #start, #end);
            let #counter = #p::Var::new(#m, #text, #begin);
            let #ident = #p::Loop::new(#m);
            loop {
                if !#ident.test(#m, #p::less(#m, #counter.get(#m), #stop)) { break; }
                #bound
                #body
                #ident.continuing(#m);
                #counter.set(#m, #p::increment(#m, #counter.get(#m)));
                if !#ident.again(#m) { break; }
            }
            #ident.end(#m);
        }}
    }

    fn exit(&mut self, label: Option<&str>, how: &str) -> TokenStream {
        let found = match label {
            None => self.loops.last(),
            Some(l) => self.loops.iter().rev().find(|x| x.label.as_deref() == Some(l)),
        };
        // A label that does not exist is rustc's to report, in the user's own function.
        let Some(Loop { ident, .. }) = found else { return TokenStream::new() };
        let (m, how) = (own("m"), format_ident!("{how}"));
        quote!(#ident.#how(#m);)
    }

    fn assign(&mut self, place: &Place, op: Option<BinaryOp>, value: &Expr) -> TokenStream {
        let (p, m) = (private(), own("m"));
        let name = &place.name;
        match self.lookup(name) {
            Some(Binding::Var) => {}
            // rustc reports it in the user's own function.
            Some(Binding::Value) => return TokenStream::new(),
            None => {
                if self.is_closure {
                    self.errors.at(
                        name.span(),
                        format!("a kernel cannot assign to `{name}`, which belongs to the code around it"),
                        "return the new value, or declare the variable inside the kernel",
                    );
                }
                return TokenStream::new();
            }
        }
        // The right side first: it may read the place.
        let value = self.value(value);
        let members = &place.members;
        let (whole, right) = (own("whole"), own("right"));
        let old = quote!(#whole #(.#members)*);
        let new = match op {
            Some(op) => operator(op, quote!(#m), old.clone(), quote!(#right)),
            None => quote!(#right),
        };
        let store = if members.is_empty() {
            quote!(#name.set(#m, #p::Coerce::coerce(#new, #m));)
        } else {
            quote! {
                #old = #p::Coerce::coerce(#new, #m);
                #name.set(#m, #whole);
            }
        };
        let snapshot = if members.is_empty() && op.is_none() {
            TokenStream::new()
        } else {
            quote!(#[allow(unused_mut)] let mut #whole = #name.get(#m);)
        };
        quote!({ let #right = #value; #snapshot #store })
    }

    // Expressions.

    /// A value, with a name for those who read generated code.
    fn named_value(&mut self, e: &Expr, name: &str) -> TokenStream {
        self.structured(e, name, None).unwrap_or_else(|| self.value(e))
    }

    /// A value whose type is written in the source.
    fn value_of_type(&mut self, e: &Expr, name: &str, ty: &TokenStream) -> TokenStream {
        self.structured(e, name, Some(ty)).unwrap_or_else(|| self.value(e))
    }

    /// The value of a control structure goes through a variable.
    fn structured(
        &mut self,
        e: &Expr,
        name: &str,
        ty: Option<&TokenStream>,
    ) -> Option<TokenStream> {
        let needs = match &e.kind {
            Kind::If { .. } => true,
            Kind::Block(b) => b.ends_lanes(),
            _ => false,
        };
        if !needs {
            return None;
        }
        let (p, m) = (private(), own("m"));
        let var = self.fresh("value");
        let typed = ty.is_some();
        let ty = ty.map(|t| self.on(t)).unwrap_or_else(|| quote!(_));
        let code = self.into(e, &Dest::Slot { var: var.clone(), typed });
        Some(quote!({
            let #var = #p::Var::<#ty>::declare(#m, #name);
            #code
            #var.get(#m)
        }))
    }

    fn value(&mut self, e: &Expr) -> TokenStream {
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
                let args = self.values(args);
                quote_spanned!(span=> <#ty>::#name(#m, #(#args),*))
            }
            Kind::Method { receiver, name, args } => {
                let receiver = self.value(receiver);
                let args = self.values(args);
                let text = name.to_string();
                let machine = &self.machine;
                quote_spanned!(name.span()=>
                    #p::Method::<{ #p::name(#text) }, #machine, _>::call(
                        #receiver, #m, (#(#args,)*)
                    )
                )
            }
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
            Kind::If { .. } => self.named_value(e, "value"),
            Kind::Block(b) if !b.ends_lanes() => self.plain_block(b),
            Kind::Block(_) => self.named_value(e, "value"),
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
            Some(Binding::Var) => {
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
        let args = self.values(args);
        quote_spanned!(span=> #path::on(#m, #(#args),*))
    }

    fn structure(
        &mut self,
        path: &TokenStream,
        fields: &[(TokenStream, Expr)],
        rest: Option<&Expr>,
    ) -> TokenStream {
        let (p, m) = (private(), own("m"));
        let path = self.without_self(path);
        let machine = &self.machine.clone();
        let members: Vec<TokenStream> = fields
            .iter()
            .map(|(member, e)| {
                let value = self.value(e);
                quote!(#member: #p::Coerce::coerce(#value, #m))
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

fn operator(op: BinaryOp, m: TokenStream, a: TokenStream, b: TokenStream) -> TokenStream {
    let p = private();
    let (operator, method) = (format_ident!("{}", op.operator), format_ident!("{}", op.method));
    quote!(#p::#operator::#method(#m, #a, #b))
}
