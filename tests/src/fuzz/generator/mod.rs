//! Random well-typed kernels that terminate and do not panic.
//!
//! The grammar is the tables of templates below. In a template, a small letter in braces is any
//! expression of a type: `{f}` is an `f32`, `{u}` a `u32`, `{i}` an `i32`, `{b}` a `bool`, `{v}` a
//! `Vec3`, `{s}` and `{n}` the structs [`Small`](super::types::Small) and
//! [`Nested`](super::types::Nested). A capital letter is a name or member that nothing assigns, the
//! same one wherever it stands in the template: guards such as `{U} != 0 && a / {U} > b` need that.
//!
//! * **No panics**: sums of integers wrap, or have operands too small to overflow; shifts are by a
//!   masked amount; divisors are made odd, or guarded.
//! * **Every kernel ends**: loops count their rounds, and the product of the rounds of nested loops
//!   and calls is bounded (`WORK`).
//! * **One result**: nothing looks at what Rust leaves open, the sign and payload of a NaN.

use super::tree::{Block, Expr, Function, Kernel, Piece, Stmt, Ty};
use crate::rng::Rng;

/// How many operations one run of a kernel may take, about.
const WORK: usize = 6_000;
/// How many expressions the text of a function has, about: of `entry` and of others. Many small
/// kernels find more than a few large ones, and compile as fast.
const SIZE: [usize; 2] = [80, 25];

const F32: &[&str] = &[
    "({f} + {f})",
    "({f} + {f})",
    "({f} - {f})",
    "({f} - {f})",
    "({f} * {f})",
    "({f} * {f})",
    "({f} * 0.5)",
    "(2.0 * {f} - 1.25)",
    "({f} / {f})",
    "({f} / 3.0)",
    "(-{f})",
    "{f}.abs()",
    "{f}.floor()",
    "{f}.ceil()",
    "{f}.trunc()",
    "{f}.sqrt()",
    "{f}.abs().sqrt()",
    "{f}.min({f})",
    "{f}.max({f})",
    "{f}.clamp(-2.5, 4.0)",
    "min({f}, {f})",
    "max({f}, {f})",
    "clamp({f}, {f}, {f})",
    "{f}.copysign({i} as f32)",
    "{f}.recip()",
    "{f}.mul_add({f}, {f})",
    "({i} as f32)",
    "({u} as f32)",
    "({b} as u32 as f32)",
    "({f} as i32 as f32)",
    "f32::from_bits(0x3f80_0000 | ({u} >> 9))",
    "{v}.x",
    "{v}.y",
    "{v}.z",
    "{v}.dot({v})",
    "{v}.length()",
    "{v}.length_squared()",
    "{v}.min_element()",
    "{v}.max_element()",
    "{s}.y",
    "{n}.s.y",
    "{n}.v.z",
];

const U32: &[&str] = &[
    "{u}.wrapping_add({u})",
    "{u}.wrapping_sub({u})",
    "{u}.wrapping_mul({u})",
    "{u}.wrapping_mul(2654435761)",
    "({u} & {u})",
    "({u} | {u})",
    "({u} ^ {u})",
    "({u} & 15)",
    "(!{u})",
    "({u} << ({u} & 31))",
    "({u} >> ({u} & 31))",
    "({u} << ({i} & 31))",
    "({u} << 3)",
    "({u} >> 7)",
    "({u} / ({u} | 1))",
    "({u} % ({u} | 1))",
    "({u} / 7)",
    "({u} % 10)",
    "(1000 / ({u} | 1))",
    "{u}.min({u})",
    "{u}.max({u})",
    "(({u} & 0xffff) + ({u} & 0xffff))",
    "(({u} & 0xfff) * ({u} & 0xfff))",
    "(({u} | 0x8000_0000) - ({u} >> 1))",
    "(if {U} != 0 { {u} / {U} } else { {u} })",
    "(if {U} > 5 { {u} % {U} } else { {U} })",
    "({i} as u32)",
    "({f} as u32)",
    "({b} as u32)",
    "(({f}.to_bits() >> 23) & 255)",
    "{s}.m",
    "{n}.k",
    "{n}.s.m",
];

const I32: &[&str] = &[
    "{i}.wrapping_add({i})",
    "{i}.wrapping_sub({i})",
    "{i}.wrapping_mul({i})",
    "{i}.wrapping_mul(-1640531535)",
    "({i} & {i})",
    "({i} | {i})",
    "({i} ^ {i})",
    "({i} & 15)",
    "(!{i})",
    "(-({i} >> 1))",
    "({i} << ({u} & 31))",
    "({i} >> ({u} & 31))",
    "({i} >> ({i} & 31))",
    "({i} >> 4)",
    "({i} / (({i} & 255) | 1))",
    "({i} % (({i} & 255) | 1))",
    "({i} / 7)",
    "({i} % -10)",
    "{i}.min({i})",
    "{i}.max({i})",
    "(({i} & 0xffff) - ({i} & 0xffff))",
    "(({i} & 0xfff) * -(({i} & 0xfff)))",
    "(if {I} > 0 { {i} / {I} } else { {i} })",
    "(if {I} == 0 || {I} == -1 { {I} } else { {i} % {I} })",
    "({u} as i32)",
    "({f} as i32)",
    "({b} as i32)",
    "{s}.i",
    "{n}.s.i",
];

const BOOL: &[&str] = &[
    "({f} < {f})",
    "({f} <= {f})",
    "({f} > {f})",
    "({f} >= 0.5)",
    "({f} == {f})",
    "({f} != {f})",
    "({u} < {u})",
    "({u} >= {u})",
    "({u} == {u})",
    "({u} > 3)",
    "({u} % 3 == 0)",
    "({i} < {i})",
    "({i} <= {i})",
    "({i} != {i})",
    "({i} > -2)",
    "({b} == {b})",
    "({b} != {b})",
    "({b} < {b})",
    "({b} && {b})",
    "({b} && {b})",
    "({b} || {b})",
    "({b} || {b})",
    "({b} & {b})",
    "({b} | {b})",
    "({b} ^ {b})",
    "(!{b})",
    "({U} != 0 && {u} / {U} > {u})",
    "({U} == 0 || {u} % {U} < 2)",
    "({I} > 0 && {i} % {I} < 2)",
    "({U} < 1000 && {U} * {U} > {u})",
    "({U} > 0 && {b} && {U} - 1 < {u})",
    "(!({I} < 1 || 1000 / {I} < {i}) || {b})",
    "{s}.t",
    "{n}.s.t",
    "{s}.is_more({s})",
];

const VEC3: &[&str] = &[
    "vec3({f}, {f}, {f})",
    "Vec3::new({f}, {f}, {f})",
    "Vec3::splat({f})",
    "({v} + {v})",
    "({v} - {v})",
    "({v} * {v})",
    "({v} / {v})",
    "({v} * {f})",
    "({f} * {v})",
    "({v} / {f})",
    "(2.0 * {v})",
    "(-{v})",
    "{v}.cross({v})",
    "{v}.min({v})",
    "{v}.max({v})",
    "{v}.abs()",
    "{v}.floor()",
    "{v}.ceil()",
    "{v}.trunc()",
    "{v}.normalize()",
    "{v}.extend({f}).truncate()",
    "{n}.v",
];

const SMALL: &[&str] = &[
    "(Small { i: {i}, t: {b}, y: {f}, m: {u} })",
    "(Small { m: {u}, y: {f}, i: {i}, t: {b} })",
    "(Small { y: {f}, ..{s} })",
    "(Small { m: {u}, t: {b}, ..{s} })",
    "Small::of({u})",
    "{s}.chosen({s}, {f})",
    "{n}.s",
];

const NESTED: &[&str] = &[
    "(Nested { v: {v}, s: {s}, k: {u} })",
    "(Nested { s: {s}, ..{n} })",
    "(Nested { v: {v}, k: {u}, ..{n} })",
    "Nested::of({u})",
    "{n}.moved({v}, {u})",
];

const OUTCOME: &[&str] = &[
    "(Outcome { n: {n}, x: {f}, t: {b} })",
    "(Outcome { n: Nested { v: {v}, s: Small { i: {i}, t: {b}, y: {f}, m: {u} }, k: {u} }, x: {f}, t: {b} })",
];

const fn templates(ty: Ty) -> &'static [&'static str] {
    match ty {
        Ty::F32 => F32,
        Ty::U32 => U32,
        Ty::I32 => I32,
        Ty::Bool => BOOL,
        Ty::Vec3 => VEC3,
        Ty::Small => SMALL,
        Ty::Nested => NESTED,
        Ty::Outcome => OUTCOME,
    }
}

/// Right sides of `place op= value`; `{p}` is the place. None of them may contain a block: it
/// could assign to the place.
const fn compound(ty: Ty) -> &'static [&'static str] {
    match ty {
        Ty::F32 => &["{p} += {f};", "{p} -= {f};", "{p} *= {f};", "{p} /= {f};", "{p} *= 0.5;"],
        Ty::U32 => &[
            "{p} |= {u};",
            "{p} &= {u};",
            "{p} ^= {u};",
            "{p} <<= {u} & 31;",
            "{p} >>= {u} & 31;",
            "{p} /= {u} | 1;",
            "{p} %= {u} | 1;",
            "{p} >>= 1; {p} += {u} >> 1;",
            "{p} &= 0xffff; {p} *= {u} & 0xffff;",
            "{p} |= 0x8000_0000; {p} -= {u} >> 1;",
        ],
        Ty::I32 => &[
            "{p} |= {i};",
            "{p} &= {i};",
            "{p} ^= {i};",
            "{p} <<= {u} & 31;",
            "{p} >>= {u} & 31;",
            "{p} /= {i} & 255 | 1;",
            "{p} %= {i} & 255 | 1;",
            "{p} >>= 1; {p} += {i} >> 1;",
            "{p} >>= 1; {p} -= {i} >> 1;",
            "{p} &= 0x7fff; {p} *= {i} & 0x7fff;",
        ],
        Ty::Bool => &["{p} |= {b};", "{p} &= {b};", "{p} ^= {b};"],
        Ty::Vec3 => &["{p} += {v};", "{p} -= {v};", "{p} *= {v};", "{p} /= {v};", "{p} *= {f};"],
        Ty::Small | Ty::Nested | Ty::Outcome => &[],
    }
}

const F32_LITERALS: &[&str] = &[
    "0.0f32",
    "1.0f32",
    "0.5f32",
    "2.0f32",
    "3.25f32",
    "100.0f32",
    "0.1f32",
    "1e10f32",
    "16777216.0f32",
    "(-1.0f32)",
    "(-0.75f32)",
    "(-8.0f32)",
    "(-0.0f32)",
    "f32::MAX",
];

const U32_LITERALS: &[&str] = &[
    "0u32",
    "1u32",
    "2u32",
    "3u32",
    "7u32",
    "13u32",
    "31u32",
    "0xffu32",
    "0x8000_0000u32",
    "4294967295u32",
    "u32::MAX",
];

const I32_LITERALS: &[&str] = &[
    "0i32",
    "1i32",
    "2i32",
    "5i32",
    "100i32",
    "(-1i32)",
    "(-2i32)",
    "(-77i32)",
    "2147483647i32",
    "(-2147483647i32)",
    "i32::MIN",
];

const fn literals(ty: Ty) -> &'static [&'static str] {
    match ty {
        Ty::F32 => F32_LITERALS,
        Ty::U32 => U32_LITERALS,
        Ty::I32 => I32_LITERALS,
        Ty::Bool => &["true", "false"],
        Ty::Vec3 => &["Vec3::X", "vec3(1.0, -2.0, 0.5)", "Vec3::splat(3.0)"],
        Ty::Small => &["Small::of(5u32)", "Small::of(0u32)"],
        Ty::Nested => &["Nested::of(9u32)", "Nested::of(2u32)"],
        Ty::Outcome => &["Outcome::of(7u32)", "Outcome::of(1u32)"],
    }
}

/// The members of a type, with their types.
const fn members(ty: Ty) -> &'static [(&'static str, Ty)] {
    match ty {
        Ty::Vec3 => &[("x", Ty::F32), ("y", Ty::F32), ("z", Ty::F32)],
        Ty::Small => &[("i", Ty::I32), ("t", Ty::Bool), ("y", Ty::F32), ("m", Ty::U32)],
        Ty::Nested => &[("v", Ty::Vec3), ("s", Ty::Small), ("k", Ty::U32)],
        Ty::Outcome => &[("n", Ty::Nested), ("x", Ty::F32), ("t", Ty::Bool)],
        Ty::F32 | Ty::U32 | Ty::I32 | Ty::Bool => &[],
    }
}

/// Names of variables. Some are words of WGSL, some could be those of lifted code.
const NAMES: &[&str] = &[
    "a", "b", "c", "d", "e", "sum", "m", "params", "args", "result", "branch", "out", "array",
    "texture", "discard", "sampler", "var", "dot", "abs", "select", "function", "active", "u", "f",
    "i", "value", "lanes", "filter", "private",
];

/// The kernel of a seed.
pub fn kernel(seed: u64) -> Kernel {
    let mut rng = Rng::new(seed);
    // Neighbouring seeds are neighbouring states of the generator's counter.
    let mut rng = Rng::new(rng.bits() ^ seed.rotate_left(32));
    let floats = rng.below(3) != 0;
    let mut callable = Vec::new();
    let mut functions = Vec::new();
    for i in 0..rng.below(3) {
        let types = types(floats);
        let params = (0..1 + rng.below(3)).map(|i| (format!("p{i}"), rng.pick(types))).collect();
        let (name, result) = (format!("f{i}"), rng.pick(types));
        functions.push(function(&mut rng, floats, &mut callable, name, params, result, WORK / 50));
    }
    let params = [("x", Ty::F32), ("v", Ty::Vec3), ("n", Ty::U32), ("s", Ty::Small)];
    let params = params.map(|(name, ty)| (name.to_owned(), ty)).into();
    let entry = "entry".to_owned();
    let entry = function(&mut rng, floats, &mut callable, entry, params, Ty::Outcome, WORK);
    functions.push(entry);
    Kernel { seed, functions }
}

/// The types of variables.
const fn types(floats: bool) -> &'static [Ty] {
    if floats {
        &[Ty::F32, Ty::F32, Ty::U32, Ty::I32, Ty::Bool, Ty::Vec3, Ty::Small, Ty::Nested]
    } else {
        &[Ty::U32, Ty::I32, Ty::Bool]
    }
}

fn function(
    rng: &mut Rng,
    floats: bool,
    callable: &mut Vec<Callable>,
    name: String,
    params: Vec<(String, Ty)>,
    result: Ty,
    limit: usize,
) -> Function {
    let vars = params.iter().map(|(name, ty)| Var { name: name.clone(), ty: *ty, mutable: false });
    let mut g = Generator {
        rng,
        floats,
        callable,
        vars: vars.collect(),
        loops: vec![],
        result,
        work: 0,
        rounds: 1,
        limit,
        size: SIZE[usize::from(result != Ty::Outcome)],
        nest: 0,
        counters: 0,
        plain: false,
    };
    let mut named = params.clone();
    for (var, (name, _)) in g.vars.iter_mut().zip(&mut named) {
        if g.rng.below(5) == 0 {
            var.mutable = true;
            *name = format!("mut {name}");
        }
    }
    let statements = 2 + g.rng.below(5);
    let body = g.block(Some(result), statements);
    let work = g.work;
    let types = params.iter().map(|(_, ty)| *ty).collect();
    callable.push(Callable { name: name.clone(), params: types, result, work });
    Function { name, params: named, result, body }
}

struct Var {
    name: String,
    ty: Ty,
    mutable: bool,
}

struct Callable {
    name: String,
    params: Vec<Ty>,
    result: Ty,
    work: usize,
}

struct Generator<'a> {
    rng: &'a mut Rng,
    /// Whether there are floats, or integers and truth values only.
    floats: bool,
    callable: &'a [Callable],
    /// What is in scope, the innermost last.
    vars: Vec<Var>,
    /// The labels of the loops around, the innermost last.
    loops: Vec<Option<String>>,
    /// The type of `return`.
    result: Ty,
    /// How many operations a run takes so far.
    work: usize,
    /// How often what is generated now is run.
    rounds: usize,
    limit: usize,
    /// How many more expressions the text should have.
    size: usize,
    /// How many statements stand around.
    nest: usize,
    counters: usize,
    /// Whether expressions may not contain blocks.
    plain: bool,
}

impl Generator<'_> {
    fn chance(&mut self, percent: usize) -> bool {
        self.rng.below(100) < percent
    }

    // Expressions.

    fn is_full(&self) -> bool {
        self.size == 0 || self.work > self.limit
    }

    fn expr(&mut self, ty: Ty, depth: usize) -> Expr {
        self.work += self.rounds;
        self.size = self.size.saturating_sub(1);
        let is_float = matches!(ty, Ty::F32 | Ty::Vec3 | Ty::Small | Ty::Nested);
        if depth == 0 || self.is_full() || is_float && !self.floats {
            return self.leaf(ty);
        }
        match self.rng.below(100) {
            0..20 => self.leaf(ty),
            20..30 => self.call(ty, depth).unwrap_or_else(|| self.leaf(ty)),
            30..38 if !self.plain && self.nest < 4 => self.value_if(ty),
            38..40 if !self.plain && self.nest < 4 => self.value_block(ty),
            _ => {
                let template = self.template(templates(ty));
                Expr { ty, pieces: self.fill(template, "", depth - 1) }
            }
        }
    }

    /// One of these; a kernel without floats takes those without.
    fn template(&mut self, from: &[&'static str]) -> &'static str {
        loop {
            let template = self.rng.pick(from);
            let floats = ["{f}", "{v}", "{s}", "{n}"].iter().any(|t| template.contains(t));
            if self.floats || !floats || std::ptr::eq(from, OUTCOME) {
                return template;
            }
        }
    }

    fn fill(&mut self, template: &str, place: &str, depth: usize) -> Vec<Piece> {
        let mut pieces = Vec::new();
        let mut fixed: Vec<(char, String)> = Vec::new();
        let mut rest = template;
        while let Some(at) = rest.find('{') {
            let letter = rest[at + 1..].chars().next().unwrap_or(' ');
            if rest.get(at + 2..at + 3) != Some("}") {
                // A brace of Rust.
                pieces.push(Piece::Text(rest[..=at].to_owned()));
                rest = &rest[at + 1..];
                continue;
            }
            pieces.push(Piece::Text(rest[..at].to_owned()));
            rest = &rest[at + 3..];
            let piece = match letter {
                'p' => Piece::Text(place.to_owned()),
                'f' => Piece::Expr(self.expr(Ty::F32, depth)),
                'u' => Piece::Expr(self.expr(Ty::U32, depth)),
                'i' => Piece::Expr(self.expr(Ty::I32, depth)),
                'b' => Piece::Expr(self.expr(Ty::Bool, depth)),
                'v' => Piece::Expr(self.expr(Ty::Vec3, depth)),
                's' => Piece::Expr(self.expr(Ty::Small, depth)),
                'n' => Piece::Expr(self.expr(Ty::Nested, depth)),
                _ => Piece::Text(self.fixed(letter, &mut fixed)),
            };
            pieces.push(piece);
        }
        pieces.push(Piece::Text(rest.to_owned()));
        pieces
    }

    /// What a capital letter stands for.
    fn fixed(&mut self, letter: char, fixed: &mut Vec<(char, String)>) -> String {
        if let Some((_, text)) = fixed.iter().find(|(l, _)| *l == letter) {
            return text.clone();
        }
        let ty = if letter == 'U' { Ty::U32 } else { Ty::I32 };
        let places = self.places(|var| !var.mutable);
        let of_type: Vec<&String> = places.iter().filter(|p| p.1 == ty).map(|p| &p.0).collect();
        let text = match of_type.len() {
            0 => if ty == Ty::U32 { "7u32" } else { "9i32" }.to_owned(),
            n => of_type[self.rng.below(n)].clone(),
        };
        fixed.push((letter, text.clone()));
        text
    }

    /// The variables that are in scope, and their members.
    fn places(&self, takes: impl Fn(&Var) -> bool) -> Vec<(String, Ty)> {
        let mut all = Vec::new();
        for (i, var) in self.vars.iter().enumerate() {
            let shadowed = self.vars[i + 1..].iter().any(|later| later.name == var.name);
            if !shadowed && takes(var) {
                all.push((var.name.clone(), var.ty));
            }
        }
        let mut i = 0;
        while i < all.len() {
            let (text, ty) = all[i].clone();
            all.extend(members(ty).iter().map(|(name, ty)| (format!("{text}.{name}"), *ty)));
            i += 1;
        }
        all
    }

    fn leaf(&mut self, ty: Ty) -> Expr {
        let places = self.places(|_| true);
        let of_type: Vec<&String> = places.iter().filter(|p| p.1 == ty).map(|p| &p.0).collect();
        let text = if !of_type.is_empty() && self.rng.below(5) != 0 {
            of_type[self.rng.below(of_type.len())].clone()
        } else {
            self.rng.pick(literals(ty)).to_owned()
        };
        Expr::text(ty, text)
    }

    fn call(&mut self, ty: Ty, depth: usize) -> Option<Expr> {
        let left = self.limit.saturating_sub(self.work) / self.rounds;
        let fits = |f: &&Callable| f.result == ty && f.work < left;
        let of_type: Vec<&Callable> = self.callable.iter().filter(fits).collect();
        if of_type.is_empty() {
            return None;
        }
        let f = of_type[self.rng.below(of_type.len())];
        self.work += f.work * self.rounds;
        let mut pieces = vec![Piece::Text(format!("{}(", f.name))];
        for (i, ty) in f.params.iter().enumerate() {
            if i > 0 {
                pieces.push(Piece::Text(", ".to_owned()));
            }
            pieces.push(Piece::Expr(self.expr(*ty, depth - 1)));
        }
        pieces.push(Piece::Text(")".to_owned()));
        Some(Expr { ty, pieces })
    }

    fn value_if(&mut self, ty: Ty) -> Expr {
        let mut pieces = vec![Piece::Text("(".to_owned())];
        self.arms(Some(ty), &mut pieces);
        pieces.push(Piece::Text(")".to_owned()));
        Expr { ty, pieces }
    }

    fn value_block(&mut self, ty: Ty) -> Expr {
        let block = self.inner_block(Some(ty));
        let text = |t: &str| Piece::Text(t.to_owned());
        Expr { ty, pieces: vec![text("("), Piece::Block(block), text(")")] }
    }

    // Statements.

    /// A block in a block.
    fn inner_block(&mut self, ty: Option<Ty>) -> Block {
        self.nest += 1;
        let statements = match ty {
            Some(_) => self.rng.below(3),
            None => 1 + self.rng.below(3),
        };
        let block = self.block(ty, statements);
        self.nest -= 1;
        block
    }

    fn block(&mut self, ty: Option<Ty>, statements: usize) -> Block {
        let scope = self.vars.len();
        let mut stmts: Vec<Stmt> = (0..statements).map(|_| self.stmt()).collect();
        // A block that leaves the function or a loop.
        if ty.is_none() && self.chance(15) {
            stmts.push(self.exit());
        }
        if self.nest == 0 {
            // However long the statements are, the result depends on several of them.
            self.size += 12;
        }
        let tail = ty.map(|ty| Box::new(self.expr(ty, if self.nest == 0 { 3 } else { 2 })));
        self.vars.truncate(scope);
        Block { stmts, tail }
    }

    fn stmt(&mut self) -> Stmt {
        let may_nest = self.nest < 4 && !self.is_full();
        match self.rng.below(100) {
            0..25 => self.binding(),
            25..45 => self.assignment().unwrap_or_else(|| self.binding()),
            45..57 => self.compound().unwrap_or_else(|| self.binding()),
            57..72 if may_nest => self.conditional(),
            72..86 if may_nest && self.rounds < self.limit / 20 => self.repetition(),
            86..92 => self.guarded_exit(),
            92..95 => self.declared_later(),
            95..97 if may_nest => {
                let block = self.inner_block(None);
                Stmt { pieces: vec![Piece::Block(block)], removable: true }
            }
            97..98 => self.ignored(),
            _ => self.binding(),
        }
    }

    fn any_type(&mut self) -> Ty {
        self.rng.pick(types(self.floats))
    }

    fn new_name(&mut self) -> String {
        // Shadows a variable, now and then; several words are in use twice by chance.
        match self.rng.below(3) {
            0 => self.rng.pick(NAMES).to_owned(),
            1 => format!("a{}", self.rng.below(100)),
            _ => format!("{}_{}", self.rng.pick(NAMES), self.rng.below(10)),
        }
    }

    fn binding(&mut self) -> Stmt {
        let ty = self.any_type();
        let (name, mutable) = (self.new_name(), self.chance(60));
        let value = self.expr(ty, 3);
        let keyword = if mutable { "let mut" } else { "let" };
        let head = match self.rng.below(3) {
            0 => format!("{keyword} {name}: {} = ", ty.name()),
            _ => format!("{keyword} {name} = "),
        };
        self.vars.push(Var { name, ty, mutable });
        Stmt { pieces: around(head, value, ";"), removable: false }
    }

    fn declared_later(&mut self) -> Stmt {
        let ty = self.any_type();
        // The condition must not see it, so it shadows nothing.
        let name = format!("later{}", self.counters);
        self.counters += 1;
        let condition = self.expr(Ty::Bool, 2);
        let (first, second) = (self.expr(ty, 2), self.expr(ty, 2));
        let mut pieces = around(format!("let {name}: {}; if ", ty.name()), condition, " {");
        pieces.extend(around(format!(" {name} = "), first, "; } else {"));
        pieces.extend(around(format!(" {name} = "), second, "; }"));
        self.vars.push(Var { name, ty, mutable: false });
        Stmt { pieces, removable: false }
    }

    fn target(&mut self) -> Option<(String, Ty)> {
        let places = self.places(|var| var.mutable);
        (!places.is_empty()).then(|| places[self.rng.below(places.len())].clone())
    }

    fn assignment(&mut self) -> Option<Stmt> {
        let (place, ty) = self.target()?;
        let value = self.expr(ty, 3);
        Some(Stmt { pieces: around(format!("{place} = "), value, ";"), removable: true })
    }

    fn compound(&mut self) -> Option<Stmt> {
        let (place, ty) = self.target()?;
        let from = compound(ty);
        if from.is_empty() {
            return None;
        }
        let template = self.rng.pick(from);
        let pieces = self.plainly(|g| g.fill(template, &place, 2));
        Some(Stmt { pieces, removable: true })
    }

    /// Without blocks in expressions.
    fn plainly<R>(&mut self, f: impl FnOnce(&mut Self) -> R) -> R {
        let old = std::mem::replace(&mut self.plain, true);
        let result = f(self);
        self.plain = old;
        result
    }

    fn ignored(&mut self) -> Stmt {
        let ty = self.any_type();
        let value = self.expr(ty, 2);
        Stmt { pieces: around("let _ = ".to_owned(), value, ";"), removable: true }
    }

    fn conditional(&mut self) -> Stmt {
        let mut pieces = Vec::new();
        self.arms(None, &mut pieces);
        Stmt { pieces, removable: true }
    }

    /// `if c { } else if d { } else { }`; an `if` without a value may have no `else`.
    fn arms(&mut self, ty: Option<Ty>, pieces: &mut Vec<Piece>) {
        let mut word = "if ";
        loop {
            let condition = self.expr(Ty::Bool, 3);
            pieces.extend(around(word.to_owned(), condition, " "));
            pieces.push(Piece::Block(self.inner_block(ty)));
            word = " else if ";
            if self.rng.below(5) != 0 {
                break;
            }
        }
        if ty.is_some() || self.chance(50) {
            pieces.push(Piece::Text(" else ".to_owned()));
            // The last arm of an `if` with a value may leave instead.
            let leaves = ty.is_some() && self.chance(15);
            let mut block = self.inner_block(if leaves { None } else { ty });
            if leaves {
                block.stmts.push(Stmt { removable: false, ..self.exit() });
            }
            pieces.push(Piece::Block(block));
        }
    }

    fn guarded_exit(&mut self) -> Stmt {
        let condition = self.expr(Ty::Bool, 2);
        let mut pieces = around("if ".to_owned(), condition, " ");
        let exit = self.exit();
        pieces.push(Piece::Block(Block { stmts: vec![exit], tail: None }));
        Stmt { pieces, removable: true }
    }

    fn exit(&mut self) -> Stmt {
        let kind = self.rng.below(4);
        if self.loops.is_empty() || kind == 0 {
            let value = self.expr(self.result, 2);
            return Stmt { pieces: around("return ".to_owned(), value, ";"), removable: true };
        }
        let word = if kind == 1 { "continue" } else { "break" };
        let labels: Vec<&String> = self.loops.iter().flatten().collect();
        let text = if !labels.is_empty() && self.rng.below(2) == 0 {
            format!("{word} '{};", labels[self.rng.below(labels.len())])
        } else {
            format!("{word};")
        };
        Stmt { pieces: vec![Piece::Text(text)], removable: true }
    }

    fn repetition(&mut self) -> Stmt {
        let number = self.counters;
        self.counters += 1;
        let rounds = 1 + self.rng.below(6);
        let label = self.chance(40).then(|| format!("l{number}"));
        let prefix = label.as_ref().map(|l| format!("'{l}: ")).unwrap_or_default();
        let (counter, scope) = (format!("count{number}"), self.vars.len());
        // A counter that nothing else may assign or shadow, stepped before anything can leave.
        let step = |text: String| Stmt { pieces: vec![Piece::Text(text)], removable: false };
        let mut first = Vec::new();
        let mut pieces = Vec::new();
        let text = |t: String| Piece::Text(t);
        match self.rng.below(4) {
            0 => {
                first.push(step(format!("{counter} += 1;")));
                first.push(step(format!("if {counter} > {rounds} {{ break; }}")));
                pieces.push(text(format!("let mut {counter} = 0u32; {prefix}loop ")));
            }
            1 => {
                first.push(step(format!("{counter} += 1;")));
                let head =
                    format!("let mut {counter}: u32 = 0; {prefix}while {counter} < {rounds}");
                if self.chance(70) {
                    let condition = self.plainly(|g| g.expr(Ty::Bool, 2));
                    pieces.extend(around(format!("{head} && "), condition, " "));
                } else {
                    pieces.push(text(format!("{head} ")));
                }
            }
            2 => {
                let name = if self.chance(20) { "_".to_owned() } else { self.new_name() };
                let end = self.expr(Ty::U32, 2);
                pieces.extend(around(
                    format!("{prefix}for {name} in 0..("),
                    end,
                    &format!(" % {}) ", rounds + 1),
                ));
                self.loop_variable(name, Ty::U32);
            }
            _ => {
                let name = if self.chance(20) { "_".to_owned() } else { self.new_name() };
                let start = self.rng.below(9) as i32 - 4;
                if self.chance(50) {
                    let end = start + rounds as i32 - 1;
                    pieces.push(text(format!("{prefix}for {name} in {start}..{end}i32 ")));
                } else {
                    let start = self.expr(Ty::I32, 2);
                    pieces.extend(around(format!("{prefix}for {name} in ("), start, " & 3)..5 "));
                }
                self.loop_variable(name, Ty::I32);
            }
        }
        let outer = self.rounds;
        self.rounds *= rounds.max(5);
        self.loops.push(label);
        let mut block = self.inner_block(None);
        self.loops.pop();
        self.rounds = outer;
        self.vars.truncate(scope);
        block.stmts.splice(0..0, first);
        pieces.push(Piece::Block(block));
        Stmt { pieces, removable: true }
    }

    fn loop_variable(&mut self, name: String, ty: Ty) {
        if name != "_" {
            self.vars.push(Var { name, ty, mutable: false });
        }
    }
}

fn around(before: String, e: Expr, after: &str) -> Vec<Piece> {
    vec![Piece::Text(before), Piece::Expr(e), Piece::Text(after.to_owned())]
}
