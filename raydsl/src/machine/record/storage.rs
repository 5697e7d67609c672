//! Storage layout of values in buffers: the host's layout in WGSL.
//!
//! WGSL aligns a `vec3<f32>` to 16 bytes and has no byte type, so a struct of the host is described
//! word by word: a vector where its offset and the stride allow one, single numbers elsewhere, and
//! small members packed into a `u32`.

use core::fmt::Write;
use std::borrow::Cow;

use super::Recorder;
use super::ir::{Expr, Id, Type};
use super::names::member_name;
use super::types::Names;
use crate::machine::{Compare, Kinds, Schema};

const COMPONENTS: [&str; 4] = ["x", "y", "z", "w"];

/// A variable's part of a value: a scalar or a whole vector.
pub(super) struct Cell {
    pub(super) name: String,
    pub(super) ty: Type,
    /// The number of its leaves.
    pub(super) leaves: usize,
    /// The kinds of the enum, if it is the number of a variant.
    pub(super) kinds: Option<Kinds>,
}

/// Collects the variables that hold the value `name`, in the order of its leaves: `hit_t`, `color`.
pub(super) fn cells(name: &str, schema: &'static Schema, out: &mut Vec<Cell>) {
    match schema {
        Schema::Host => {}
        Schema::Array { element, count, .. } => {
            for i in 0..*count {
                cells(&format!("{name}_{i}"), element, out);
            }
        }
        Schema::Struct { fields, .. } => {
            for f in *fields {
                cells(&format!("{name}_{}", f.name.trim_start_matches('_')), f.schema, out);
            }
        }
        _ => {
            let kinds = match schema {
                Schema::Kind { count } => Some(Kinds::first(*count)),
                _ => None,
            };
            let (ty, leaves) = (Type::of(schema), schema.leaves());
            out.push(Cell { name: name.to_owned(), ty, leaves, kinds });
        }
    }
}

fn word(bytes: &[u8]) -> u32 {
    let mut w = [0; 4];
    let n = bytes.len().min(4);
    w[..n].copy_from_slice(&bytes[..n]);
    u32::from_le_bytes(w)
}

/// Adds a captured value to the uniform buffer and collects its leaves.
pub(super) fn uniforms(
    m: &Recorder,
    name: &str,
    schema: &'static Schema,
    bytes: &[u8],
    leaves: &mut Vec<Id>,
) {
    match schema {
        Schema::Host => {}
        Schema::Bool => {
            let u = m.captured_uniform(name, Type::U32, vec![u32::from(bytes[0])]);
            let zero = m.add(Expr::U32(0), Type::U32);
            leaves.push(m.add(Expr::Compare(Compare::Ne, u, zero), Type::Bool));
        }
        // A captured variant is known while the kernel is recorded: a `match` on it is decided.
        Schema::Kind { .. } => leaves.push(m.add(Expr::U32(word(&bytes[..4])), Type::U32)),
        Schema::F32 | Schema::I32 | Schema::U32 => {
            leaves.push(m.captured_uniform(name, Type::of(schema), vec![word(&bytes[..4])]));
        }
        Schema::Small { bytes: n } => {
            leaves.push(m.captured_uniform(name, Type::U32, vec![word(&bytes[..*n])]));
        }
        Schema::Vector(Schema::Bool, n) => {
            for (c, byte) in COMPONENTS.into_iter().zip(bytes.chunks_exact(1)).take(*n) {
                uniforms(m, &format!("{name}_{c}"), &Schema::Bool, byte, leaves);
            }
        }
        Schema::Vector(element, n) => {
            let words = bytes.chunks_exact(4).take(*n).map(word).collect();
            let v = m.captured_uniform(name, Type::of(schema), words);
            for c in COMPONENTS.into_iter().take(*n) {
                leaves.push(m.add(Expr::Member(v, c), Type::of(element)));
            }
        }
        Schema::Array { element, count, stride } => {
            for i in 0..*count {
                uniforms(m, &format!("{name}_{i}"), element, &bytes[i * stride..], leaves);
            }
        }
        Schema::Struct { fields, .. } => {
            for f in *fields {
                let name = format!("{name}_{}", f.name.trim_start_matches('_'));
                uniforms(m, &name, f.schema, &bytes[f.offset..], leaves);
            }
        }
    }
}

/// One leaf of a stored value.
struct Leaf {
    name: String,
    offset: usize,
    schema: &'static Schema,
}

fn collect(name: &str, offset: usize, schema: &'static Schema, out: &mut Vec<Leaf>) {
    let join = |part: &str| {
        // A name must not begin with a digit or two underscores.
        let part = part.trim_start_matches('_');
        match (name, part.starts_with(|c: char| c.is_ascii_digit())) {
            ("", true) => format!("arg{part}"),
            ("", false) => part.to_owned(),
            _ => format!("{name}_{part}"),
        }
    };
    match schema {
        Schema::Host => {}
        Schema::Array { element, count, stride } => {
            for i in 0..*count {
                collect(&join(&i.to_string()), offset + i * stride, element, out);
            }
        }
        Schema::Struct { fields, .. } => {
            for f in *fields {
                collect(&join(f.name), offset + f.offset, f.schema, out);
            }
        }
        // A vector of bytes, stored like single truth values.
        Schema::Vector(Schema::Bool, n) => {
            for (i, c) in COMPONENTS.iter().enumerate().take(*n) {
                collect(&join(c), offset + i, &Schema::Bool, out);
            }
        }
        _ => out.push(Leaf {
            name: if name.is_empty() { "value".to_owned() } else { name.to_owned() },
            offset,
            schema,
        }),
    }
}

/// Returns the WGSL type of a member of whole words, and an empty string for others.
fn word_type(schema: &Schema) -> Cow<'static, str> {
    match schema {
        Schema::F32 => "f32".into(),
        Schema::I32 => "i32".into(),
        Schema::U32 | Schema::Kind { .. } => "u32".into(),
        Schema::Vector(Schema::Bool, _) => "".into(),
        Schema::Vector(element, n) => format!("vec{n}<{}>", word_type(element)).into(),
        _ => "".into(),
    }
}

/// A member of a stored struct.
struct Member {
    name: String,
    offset: usize,
    ty: Cow<'static, str>,
    size: usize,
}

/// The storage form of a type.
pub(super) struct Stored {
    members: Vec<Member>,
    leaves: Vec<Leaf>,
    /// Bytes from one element to the next, a multiple of 4.
    pub(super) stride: usize,
}

/// Returns the bytes of a stored value: the host's size rounded up to whole words.
pub(crate) fn stride(schema: &Schema) -> usize {
    schema.size().next_multiple_of(4).max(4)
}

impl Stored {
    pub(super) fn new(schema: &'static Schema) -> Self {
        let mut leaves = Vec::new();
        collect("", 0, schema, &mut leaves);
        leaves.sort_by_key(|l| l.offset);
        let stride = stride(schema);
        let mut stored = Self { members: Vec::new(), leaves, stride };
        stored.place();
        stored
    }

    /// Lays out the members, without a gap.
    fn place(&mut self) {
        let vectors_fit = |n: usize, offset: usize| {
            let align = if n == 2 { 8 } else { 16 };
            offset.is_multiple_of(align) && self.stride.is_multiple_of(align)
        };
        let mut members: Vec<Member> = Vec::new();
        for leaf in &self.leaves {
            match leaf.schema {
                Schema::Vector(_, n) if vectors_fit(*n, leaf.offset) => members.push(Member {
                    name: leaf.name.clone(),
                    offset: leaf.offset,
                    ty: word_type(leaf.schema),
                    size: 4 * n,
                }),
                Schema::Vector(element, n) => {
                    for (i, c) in COMPONENTS.iter().enumerate().take(*n) {
                        members.push(Member {
                            name: format!("{}_{c}", leaf.name),
                            offset: leaf.offset + 4 * i,
                            ty: word_type(element),
                            size: 4,
                        });
                    }
                }
                Schema::Bool | Schema::Small { .. } => place_small(&mut members, leaf),
                _ => members.push(Member {
                    name: leaf.name.clone(),
                    offset: leaf.offset,
                    ty: word_type(leaf.schema),
                    size: 4,
                }),
            }
        }
        self.members = fill_gaps(members, self.stride);
    }

    /// Returns the member that holds the byte at `offset`.
    fn member_at(&self, offset: usize) -> &Member {
        let at = self.members.partition_point(|m| m.offset <= offset);
        &self.members[at - 1]
    }

    /// Returns whether the value's own struct has the same layout.
    pub(super) fn is_value(&self, schema: &Schema) -> bool {
        let Schema::Struct { fields, .. } = schema else { return false };
        fields.len() == self.members.len()
            && fields.iter().zip(&self.members).all(|(f, m)| {
                let ty = word_type(f.schema);
                f.name == m.name && f.offset == m.offset && ty == m.ty
            })
    }

    /// Prints the declaration of the stored struct.
    pub(super) fn declaration(&self, name: &str) -> String {
        let mut text = format!("struct {name} {{\n");
        for m in &self.members {
            let _ = writeln!(text, "    {}: {},", member_name(&m.name), m.ty);
        }
        text + "}\n"
    }

    /// Prints the value in the stored struct `s`.
    pub(super) fn load(&self, schema: &'static Schema, s: &str, names: &mut Names) -> String {
        self.load_at(schema, 0, s, names)
    }

    fn load_at(
        &self,
        schema: &'static Schema,
        offset: usize,
        s: &str,
        names: &mut Names,
    ) -> String {
        let member = |offset| format!("{s}.{}", member_name(&self.member_at(offset).name));
        let list = |items: Vec<String>| items.join(", ");
        match schema {
            Schema::Host => String::new(),
            Schema::F32 | Schema::I32 | Schema::U32 | Schema::Kind { .. } => member(offset),
            Schema::Vector(element, n)
                if element.size() == 4 && self.member_at(offset).size == 4 * n =>
            {
                member(offset)
            }
            Schema::Vector(element, n) => {
                let parts = (0..*n)
                    .map(|i| self.load_at(element, offset + element.size() * i, s, names))
                    .collect();
                format!("{}({})", names.ty(Type::of(schema)), list(parts))
            }
            Schema::Small { bytes } => {
                let mask = if *bytes == 1 { "0xffu" } else { "0xffffu" };
                format!("{} & {mask}", self.shifted(offset, s))
            }
            Schema::Bool => format!("({} & 0xffu) != 0u", self.shifted(offset, s)),
            Schema::Array { element, count, stride } => {
                let parts = (0..*count)
                    .map(|i| self.load_at(element, offset + i * stride, s, names))
                    .collect();
                format!("{}({})", names.ty(Type::of(schema)), list(parts))
            }
            Schema::Struct { fields, .. } => {
                let parts = fields
                    .iter()
                    .filter(|f| f.schema.leaves() > 0)
                    .map(|f| self.load_at(f.schema, offset + f.offset, s, names))
                    .collect();
                format!("{}({})", names.ty(Type::of(schema)), list(parts))
            }
        }
    }

    /// Prints the word with the byte at `offset`, shifted to its low end.
    fn shifted(&self, offset: usize, s: &str) -> String {
        let m = self.member_at(offset);
        match 8 * (offset - m.offset) {
            0 => format!("{s}.{}", member_name(&m.name)),
            n => format!("({s}.{} >> {n}u)", member_name(&m.name)),
        }
    }

    /// Prints the stored struct `name` of the value `v`.
    pub(super) fn store(&self, schema: &'static Schema, name: &str, v: &str) -> String {
        let mut values = Vec::new();
        leaf_values(schema, 0, v, &mut values);
        let parts: Vec<String> = self
            .members
            .iter()
            .map(|m| {
                let inside =
                    values.iter().filter(|(o, _, _)| (m.offset..m.offset + m.size).contains(o));
                let parts: Vec<String> = inside
                    .map(|(o, small, text)| match (small, 8 * (o - m.offset)) {
                        (false, _) => text.clone(),
                        (true, 0) => format!("({text})"),
                        (true, n) => format!("(({text}) << {n}u)"),
                    })
                    .collect();
                match parts.len() {
                    0 => "0u".to_owned(),
                    _ if m.size > 4 => format!("{}({})", m.ty, parts.join(", ")),
                    _ => parts.join(" | "),
                }
            })
            .collect();
        format!("{name}({})", parts.join(", "))
    }
}

/// Adds a small leaf to its word.
fn place_small(members: &mut Vec<Member>, leaf: &Leaf) {
    let word = leaf.offset & !3;
    match members.last_mut() {
        Some(last) if last.offset == word && last.ty == "u32" => {
            last.name = format!("{}_{}", last.name, leaf.name);
        }
        _ => members.push(Member {
            name: leaf.name.clone(),
            offset: word,
            ty: "u32".into(),
            size: 4,
        }),
    }
}

fn fill_gaps(members: Vec<Member>, stride: usize) -> Vec<Member> {
    let mut filled: Vec<Member> = Vec::new();
    let mut next = 0;
    let pad = |next: &mut usize, until: usize, filled: &mut Vec<Member>| {
        while *next < until {
            filled.push(Member {
                name: format!("pad_{next}"),
                offset: *next,
                ty: "u32".into(),
                size: 4,
            });
            *next += 4;
        }
    };
    for m in members {
        pad(&mut next, m.offset, &mut filled);
        next = m.offset + m.size;
        filled.push(m);
    }
    pad(&mut next, stride, &mut filled);
    filled
}

/// Collects every scalar of the value `v`: its offset, whether it is smaller than a word, its text.
fn leaf_values(
    schema: &'static Schema,
    offset: usize,
    v: &str,
    out: &mut Vec<(usize, bool, String)>,
) {
    match schema {
        Schema::Host => {}
        Schema::F32 | Schema::I32 | Schema::U32 | Schema::Kind { .. } => {
            out.push((offset, false, v.to_owned()));
        }
        Schema::Small { .. } => out.push((offset, true, v.to_owned())),
        Schema::Bool => out.push((offset, true, format!("select(0u, 1u, {v})"))),
        Schema::Vector(element, n) => {
            for (i, c) in COMPONENTS.iter().enumerate().take(*n) {
                leaf_values(element, offset + element.size() * i, &format!("{v}.{c}"), out);
            }
        }
        Schema::Array { element, count, stride } => {
            for i in 0..*count {
                leaf_values(element, offset + i * stride, &format!("{v}[{i}]"), out);
            }
        }
        Schema::Struct { fields, .. } => {
            for f in *fields {
                let member = format!("{v}.{}", member_name(f.name));
                leaf_values(f.schema, offset + f.offset, &member, out);
            }
        }
    }
}
