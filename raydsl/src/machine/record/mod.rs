//! The recorder: a machine that writes WGSL.
//!
//! Running a lifted body on the [`Recorder`] builds a small structured program; its values are
//! handles of expressions. Vectors and structs are split into scalars on the way and reassembled
//! where all parts come from one value, so the text reads like the source.

mod arithmetic;
mod builder;
#[cfg(feature = "gpu")]
mod cache;
mod carried;
mod data;
mod description;
mod expression;
mod function;
pub(crate) mod ir;
mod kinds;
mod lean;
mod machine;
mod module;
mod names;
mod needed;
mod restart;
mod settled;
mod storage;
mod text;
mod textures;
mod types;

use core::cell::RefCell;

#[cfg(feature = "gpu")]
pub(crate) use cache::{Frame, Identity, Modules};
pub use description::Description;
pub(crate) use names::member_name;
pub(crate) use storage::stride;
pub(crate) use text::from_template;
pub(crate) use types::zero_value;

use builder::{Builder, LoopState};
use ir::{Expr, Function, Id, Node, SceneBuffer, Stmt, Type, Uniform};
use names::{qualified, safe_name, unique};
use restart::Start;

use super::{Compare, KernelInfo, Kinds, Leaves, Schema, Value, wgsl};

/// Records a kernel as WGSL.
pub struct Recorder {
    arithmetic: wgsl::Arithmetic,
    state: RefCell<State>,
}

#[derive(Clone, Default)]
struct State {
    /// The functions being recorded, the innermost last.
    open: Vec<Builder>,
    functions: Vec<Function>,
    uniforms: Vec<Uniform>,
    buffers: Vec<SceneBuffer>,
    textures: Vec<wgsl::Texture>,
    /// The captures recorded before the body of a kernel was called.
    before_body: Captured,
    /// Whether a captured number or a buffer has another name than its own, which was taken.
    is_renamed: bool,
}

/// A number of uniforms and of buffers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Captured {
    uniforms: usize,
    buffers: usize,
}

impl State {
    /// Returns the names of types, including those in hand-written text.
    fn names(&self) -> types::Names {
        types::Names::new(self.functions.iter().flat_map(Function::named_types))
    }

    /// Returns whether a function, a buffer, or a function of a buffer has the name.
    fn is_taken(&self, name: &str) -> bool {
        self.functions.iter().any(|f| f.name() == name)
            || self.buffers.iter().any(|b| belongs_to(name, &b.name))
            || self.textures.iter().any(|t| belongs_to(name, &t.name))
    }

    /// Returns whether a buffer cannot have the name, because it or a derived name is taken.
    fn is_taken_for_buffer(&self, name: &str) -> bool {
        // The parameter of a buffer's functions would shadow a buffer of its name.
        name == "i"
            || self.is_taken(name)
            || self.functions.iter().any(|f| belongs_to(f.name(), name))
    }
}

/// Returns whether `name` is a buffer's, or that of one of its functions.
fn belongs_to(name: &str, buffer: &str) -> bool {
    const FUNCTIONS: [&str; 15] = [
        "_at",
        "_element",
        "_len",
        "_closest_hit",
        "_closer_hit",
        "_any_hit",
        "_any_hit_in",
        "_begin",
        "_next",
        "_enter",
        "_local_ray",
        "_to_object",
        "_sample",
        "_texture",
        "_sampler",
    ];
    name.strip_prefix(buffer).is_some_and(|rest| {
        rest.is_empty() || FUNCTIONS.contains(&rest) || rest.starts_with("_part")
    })
}

/// An `if` being recorded.
pub struct RecordedBranch {
    c: Id,
    then: RefCell<Option<Vec<Stmt>>>,
    /// How much was assumed before it.
    assumptions: usize,
}

/// A loop being recorded.
pub struct RecordedLoop {
    number: u32,
    body: RefCell<Option<Vec<Stmt>>>,
    continuing: RefCell<Option<Vec<Stmt>>>,
    /// What was recorded where its body begins, if there are kinds of enums to be assumed in it.
    start: Option<Start>,
}

impl Default for Recorder {
    fn default() -> Self {
        Self { arithmetic: wgsl::Arithmetic::Strict, state: RefCell::new(State::default()) }
    }
}

impl Recorder {
    fn builder<R>(&self, f: impl FnOnce(&mut Builder) -> R) -> R {
        let mut state = self.state.borrow_mut();
        let builder = state.open.last_mut().expect("values exist only inside a kernel");
        f(builder)
    }

    /// Adds an expression to the function being recorded.
    pub(crate) fn add(&self, expr: Expr, ty: Type) -> Id {
        self.builder(|b| b.add(expr, ty))
    }

    fn node(&self, id: Id) -> Node {
        self.builder(|b| b.node(id).clone())
    }

    /// Collects the parts of a structured expression, as leaves in order.
    fn parts(&self, schema: &'static Schema, id: Id, out: &mut Vec<Id>) {
        match schema {
            Schema::Vector(element, n) => {
                for c in ["x", "y", "z", "w"].into_iter().take(*n) {
                    out.push(self.add(Expr::Member(id, c), Type::of(element)));
                }
            }
            Schema::Array { element, count, .. } => {
                for i in 0..*count {
                    let e = self.add(Expr::Element(id, i), Type::of(element));
                    self.parts(element, e, out);
                }
            }
            Schema::Struct { fields, .. } => {
                for f in fields.iter().filter(|f| f.schema.leaves() > 0) {
                    let e = self.add(Expr::Member(id, f.name), Type::of(f.schema));
                    self.parts(f.schema, e, out);
                }
            }
            Schema::Host => {}
            _ => out.push(id),
        }
    }

    /// Returns the twin whose leaves are the parts of `id`.
    pub(crate) fn take_apart<V: Value<Self>>(&self, id: Id) -> V {
        self.of_leaves(&self.all_parts(V::SCHEMA, id))
    }

    /// Returns the leaves of a structured expression.
    fn all_parts(&self, schema: &'static Schema, id: Id) -> Vec<Id> {
        let mut leaves = Vec::with_capacity(schema.leaves());
        self.parts(schema, id, &mut leaves);
        self.builder(|b| b.know(schema, &leaves, &[]));
        leaves
    }

    fn of_leaves<V: Value<Self>>(&self, leaves: &[Id]) -> V {
        self.with_leaves(V::zero(self), leaves)
    }

    fn leaves_of<V: Value<Self>>(&self, v: V) -> Vec<Id> {
        struct Collect(Vec<Id>);
        impl Leaves<Recorder> for Collect {
            fn f32(&mut self, _: &Recorder, a: Id, _: Id) -> Id {
                self.0.push(a);
                a
            }
            fn i32(&mut self, _: &Recorder, a: Id, _: Id) -> Id {
                self.0.push(a);
                a
            }
            fn u32(&mut self, _: &Recorder, a: Id, _: Id) -> Id {
                self.0.push(a);
                a
            }
            fn bool(&mut self, _: &Recorder, a: Id, _: Id) -> Id {
                self.0.push(a);
                a
            }
        }
        let mut collect = Collect(Vec::with_capacity(V::SCHEMA.leaves()));
        V::zip(self, v, v, &mut collect);
        collect.0
    }

    /// Returns the expression of a whole value: the one that all its leaves are parts of, else a
    /// new one.
    pub(crate) fn put_together(
        &self,
        schema: &'static Schema,
        leaves: &mut std::vec::IntoIter<Id>,
    ) -> Id {
        match schema {
            Schema::Vector(_, n) => {
                let parts: Vec<Id> = leaves.by_ref().take(*n).collect();
                self.vector(&parts)
            }
            Schema::Array { element, count, .. } => {
                let parts: Vec<Id> =
                    (0..*count).map(|_| self.put_together(element, leaves)).collect();
                let whole = |i: usize, e: &Expr| match e {
                    Expr::Element(a, j) if *j == i => Some(*a),
                    _ => None,
                };
                self.whole_or_new(Type::of(schema), parts, whole)
            }
            Schema::Struct { fields, .. } => {
                let fields: Vec<_> = fields.iter().filter(|f| f.schema.leaves() > 0).collect();
                let parts: Vec<Id> =
                    fields.iter().map(|f| self.put_together(f.schema, leaves)).collect();
                let whole = |i: usize, e: &Expr| match e {
                    Expr::Member(a, name) if *name == fields[i].name => Some(*a),
                    _ => None,
                };
                self.whole_or_new(Type::of(schema), parts, whole)
            }
            _ => leaves.next().expect("one leaf for each scalar of the schema"),
        }
    }

    pub(crate) fn vector(&self, parts: &[Id]) -> Id {
        let whole = |i: usize, e: &Expr| match e {
            Expr::Member(a, name) if *name == ["x", "y", "z", "w"][i] => Some(*a),
            _ => None,
        };
        let ty = self.node(parts[0]).ty.times(parts.len());
        self.whole_or_new(ty, parts.to_vec(), whole)
    }

    fn whole_or_new(
        &self,
        ty: Type,
        parts: Vec<Id>,
        whole: impl Fn(usize, &Expr) -> Option<Id>,
    ) -> Id {
        let existing = self.builder(|b| {
            let mut candidates = parts.iter().enumerate().map(|(i, p)| whole(i, &b.node(*p).expr));
            let first = candidates.next()??;
            let all = candidates.all(|c| c == Some(first));
            (all && b.node(first).ty == ty).then_some(first)
        });
        existing.unwrap_or_else(|| self.add(Expr::Compose(parts), ty))
    }

    /// Returns the expressions of a tuple's elements that have any leaves.
    fn arguments(&self, schema: &'static Schema, leaves: Vec<Id>) -> Vec<Id> {
        let mut leaves = leaves.into_iter();
        let Schema::Struct { fields, .. } = schema else { return Vec::new() };
        fields
            .iter()
            .filter(|f| f.schema.leaves() > 0)
            .map(|f| self.put_together(f.schema, &mut leaves))
            .collect()
    }

    /// Begins a function whose parameters are the tuple `A` and returns the parameters.
    fn begin<A: Value<Self>>(&self, info: &'static KernelInfo, host: A) -> A {
        self.with_leaves(host, &self.begin_function(info, A::SCHEMA, &[]))
    }

    /// Begins a function with the parameters of a tuple, among which there are enums of these kinds,
    /// and returns their leaves.
    fn begin_function(
        &self,
        info: &'static KernelInfo,
        tuple: &'static Schema,
        kinds: &[Kinds],
    ) -> Vec<Id> {
        let mut state = self.state.borrow_mut();
        let depth = state
            .open
            .iter()
            .filter(|b| {
                b.function.source_name == info.name
                    && b.function.line == info.line
                    && b.function.file == info.file
            })
            .count();
        assert!(
            depth < 8,
            "the kernel `{}` ({}:{}) calls itself; WGSL has no recursion: write a loop",
            info.name,
            info.file,
            info.line,
        );
        state.open.push(Builder::new(info));
        drop(state);
        let mut leaves = Vec::new();
        let Schema::Struct { fields, .. } = tuple else { return leaves };
        for (i, f) in fields.iter().enumerate().filter(|(_, f)| f.schema.leaves() > 0) {
            let name = info.params.get(i).copied().unwrap_or(f.name);
            let n = self.builder(|b| {
                let taken = |n: &str| b.function.params.iter().any(|p| p.0 == n);
                let name = unique(&safe_name(name.trim_start_matches("__")), taken);
                b.function.params.push((name, Type::of(f.schema)));
                b.function.params.len() - 1
            });
            let id = self.add(Expr::Param(n), Type::of(f.schema));
            self.parts(f.schema, id, &mut leaves);
        }
        self.builder(|b| b.know(tuple, &leaves, kinds));
        leaves
    }

    /// Returns `host` with its leaves replaced; host values in it stay.
    fn with_leaves<V: Value<Self>>(&self, host: V, leaves: &[Id]) -> V {
        struct Replace<'a>(core::slice::Iter<'a, Id>);
        impl Replace<'_> {
            fn next(&mut self) -> Id {
                *self.0.next().expect("one leaf for each scalar of the schema")
            }
        }
        impl Leaves<Recorder> for Replace<'_> {
            fn f32(&mut self, _: &Recorder, _: Id, _: Id) -> Id {
                self.next()
            }
            fn i32(&mut self, _: &Recorder, _: Id, _: Id) -> Id {
                self.next()
            }
            fn u32(&mut self, _: &Recorder, _: Id, _: Id) -> Id {
                self.next()
            }
            fn bool(&mut self, _: &Recorder, _: Id, _: Id) -> Id {
                self.next()
            }
        }
        V::zip(self, host, host, &mut Replace(leaves.iter()))
    }

    /// Ends the function being recorded with `result` and returns its index, or that of an equal
    /// function.
    fn end<R: Value<Self>>(&self, result: R) -> usize {
        self.end_function(R::SCHEMA, self.leaves_of(result)).0
    }

    /// Ends the function being recorded and returns its index and the kinds of enums in its results.
    fn end_function(&self, schema: &'static Schema, result: Vec<Id>) -> (usize, Vec<Kinds>) {
        let returned = self.builder(|b| b.blocks.last().is_some_and(|b| always_returns(&b.1)));
        if !result.is_empty() {
            if !returned {
                self.give_leaves(schema, result);
            }
            self.builder(|b| b.function.result = Some(Type::of(schema)));
        }
        let mut state = self.state.borrow_mut();
        let mut builder = state.open.pop().expect("begin and end come in pairs");
        builder.function.body = builder.close_block();
        let kinds = builder.returned_kinds();
        builder.remove_settled();
        let mut function = builder.function;
        let same = state
            .functions
            .iter()
            .position(|f| matches!(f, Function::Recorded(f) if f.same_code(&function)));
        if let Some(i) = same {
            return (i, kinds);
        }
        let plain = safe_name(function.source_name);
        function.name = if state.is_taken(&plain) {
            unique(&qualified(&plain, function.file), |n| state.is_taken(n))
        } else {
            plain
        };
        state.functions.push(Function::Recorded(function));
        (state.functions.len() - 1, kinds)
    }

    fn give_leaves(&self, schema: &'static Schema, leaves: Vec<Id>) {
        self.builder(|b| b.return_kinds(schema, &leaves));
        let id = self.put_together(schema, &mut leaves.into_iter());
        self.builder(|b| {
            b.used(id);
            b.push(Stmt::Return(Some(id)));
        });
    }

    /// Marks the start of a kernel's body, whose captures are the same in every frame.
    pub(crate) fn begin_body(&self) {
        let mut state = self.state.borrow_mut();
        state.before_body =
            Captured { uniforms: state.uniforms.len(), buffers: state.buffers.len() };
    }

    /// Returns a captured number of the uniform buffer, not shared with another frame's number that
    /// is equal now.
    fn captured_uniform(&self, name: &str, ty: Type, words: Vec<u32>) -> Id {
        let first = self.state.borrow().before_body.uniforms;
        self.uniform_since(first, name, ty, words, false)
    }

    /// Returns a constant in the uniform buffer.
    fn uniform(&self, name: &str, ty: Type, words: Vec<u32>) -> Id {
        self.uniform_since(0, name, ty, words, true)
    }

    /// Returns a number of the uniform buffer: an existing one, from index `first` on, or a new
    /// one.
    fn uniform_since(
        &self,
        first: usize,
        name: &str,
        ty: Type,
        words: Vec<u32>,
        is_constant: bool,
    ) -> Id {
        let n = {
            let mut state = self.state.borrow_mut();
            let same = state.uniforms.iter().skip(first).position(|u| {
                let same_name = u.name == name && u.is_constant == is_constant;
                same_name && u.ty == ty && u.words == words
            });
            same.map(|i| first + i).unwrap_or_else(|| {
                let taken = |n: &str| state.uniforms.iter().any(|u| u.name == n);
                // The lengths of buffers are in the same uniform buffer.
                let prefix = if name.starts_with("len_of_") { "captured_" } else { "" };
                let own = safe_name(&format!("{prefix}{name}"));
                let name = unique(&own, taken);
                state.is_renamed |= !is_constant && name != own;
                state.uniforms.push(Uniform { name, ty, words, is_constant });
                state.uniforms.len() - 1
            })
        };
        self.add(Expr::Uniform(n), ty)
    }

    /// Returns the name of a buffer of the scene; the same key is the same buffer.
    pub(crate) fn buffer(
        &self,
        key: wgsl::BufferKey,
        name: &str,
        schema: &'static Schema,
        len: u64,
    ) -> String {
        let mut state = self.state.borrow_mut();
        // In another frame the body's buffer may be another than the frame's.
        let own = &state.buffers[state.before_body.buffers..];
        if let Some(b) = own.iter().find(|b| b.key == key && b.schema == schema) {
            return b.name.clone();
        }
        let own = safe_name(name);
        let name = unique(&own, |n| state.is_taken_for_buffer(n));
        state.is_renamed |= name != own;
        state.buffers.push(SceneBuffer { key, name: name.clone(), schema, len, kinds: None });
        name
    }
}

/// A recorded kernel, ready to be printed for the limits of a device.
#[derive(Clone)]
pub struct Recording {
    state: State,
    arithmetic: wgsl::Arithmetic,
    entry: usize,
    /// The layout of an invocation's input; `None` for a grid of pixels.
    input: Option<&'static Schema>,
    output: &'static Schema,
}

impl Recording {
    /// Records a kernel that takes each pixel's coordinates.
    pub fn grid<R: super::Type>(
        arithmetic: wgsl::Arithmetic,
        kernel: impl FnOnce(&Recorder, super::U<Recorder>, super::U<Recorder>) -> R::On<Recorder>,
    ) -> Self {
        static INFO: KernelInfo = KernelInfo {
            name: "pixel",
            file: file!(),
            line: line!(),
            params: &["x", "y"],
            known: None,
        };
        Self::record(arithmetic, &INFO, None, R::SCHEMA, |m, (x, y)| kernel(m, x, y))
    }

    /// Records a kernel that takes the elements of an input buffer.
    pub fn batch<A: super::Type, R: super::Type>(
        arithmetic: wgsl::Arithmetic,
        kernel: impl FnOnce(&Recorder, A::On<Recorder>) -> R::On<Recorder>,
    ) -> Self {
        static INFO: KernelInfo = KernelInfo {
            name: "element",
            file: file!(),
            line: line!(),
            params: &["input"],
            known: None,
        };
        Self::record(arithmetic, &INFO, Some(A::SCHEMA), R::SCHEMA, |m, (a,)| kernel(m, a))
    }

    fn record<A: Value<Recorder>, R: Value<Recorder>>(
        arithmetic: wgsl::Arithmetic,
        info: &'static KernelInfo,
        input: Option<&'static Schema>,
        output: &'static Schema,
        kernel: impl FnOnce(&Recorder, A) -> R,
    ) -> Self {
        let m = Recorder { arithmetic, ..Recorder::default() };
        // Zeroes need a function to be recorded in while the parameters are made.
        m.state.borrow_mut().open.push(Builder::new(info));
        let zero = A::zero(&m);
        m.state.borrow_mut().open.clear();
        let params = m.begin(info, zero);
        let result = kernel(&m, params);
        let entry = m.end(result);
        Self { state: m.state.into_inner(), arithmetic, entry, input, output }
    }

    /// Returns the names of all recorded functions with the source file of each; those that are the
    /// library's text, such as traversals, have none. Functions that nothing calls are not printed.
    pub fn functions(&self) -> impl Iterator<Item = (&str, Option<&'static str>)> {
        self.state.functions.iter().map(|function| match function {
            Function::Recorded(f) => (f.name.as_str(), Some(f.file)),
            Function::Text { name, .. } => (name.as_str(), None),
        })
    }

    /// Returns the module, with scene buffers split into windows according to `limits`.
    pub fn module(&self, limits: &wgsl::Limits) -> wgsl::Module {
        module::module(self, limits).module
    }
}

/// Returns whether every path through the statements returns.
fn always_returns(block: &[Stmt]) -> bool {
    match block.last() {
        Some(Stmt::Return(_)) => true,
        Some(Stmt::If { then, otherwise, .. }) => always_returns(then) && always_returns(otherwise),
        _ => false,
    }
}
