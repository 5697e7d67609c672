//! Printing of a value's scalars.

use core::fmt::Write as _;

use crate::machine::{Schema, Type};

/// One scalar of a value.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Leaf {
    /// Its path, as in `color.x`; empty for a value that is one scalar.
    pub(super) path: String,
    /// Its value.
    pub(super) number: Number,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Number {
    F32(f32),
    I32(i32),
    U32(u32),
    Bool(bool),
}

impl Number {
    /// Returns whether both compare equal: +0 equals -0, NaN equals NaN.
    pub(super) fn is_same(self, other: Self) -> bool {
        match (self, other) {
            (Self::F32(a), Self::F32(b)) => a == b || a.is_nan() && b.is_nan(),
            (a, b) => a == b,
        }
    }

    /// Prints the value and its bits.
    pub(super) fn with_bits(self) -> String {
        let bits = match self {
            Self::F32(v) => v.to_bits(),
            Self::I32(v) => v as u32,
            Self::U32(v) => v,
            Self::Bool(v) => return v.to_string(),
        };
        format!("{} (0x{bits:08x})", self.value())
    }

    fn value(self) -> String {
        match self {
            Self::F32(v) => format!("{v:?}"),
            Self::I32(v) => v.to_string(),
            Self::U32(v) => v.to_string(),
            Self::Bool(v) => v.to_string(),
        }
    }
}

/// Returns all scalars in order of declaration.
pub(super) fn leaves<T: Type>(v: &T) -> Vec<Leaf> {
    let bytes = bytes_of(v);
    let mut all = Vec::new();
    collect(T::SCHEMA, &bytes, "", &mut all);
    all
}

fn bytes_of<T: Type>(v: &T) -> Vec<u8> {
    let mut bytes = vec![0; T::SCHEMA.size()];
    v.write(&mut bytes);
    bytes
}

fn number(schema: &Schema, bytes: &[u8]) -> Number {
    let word = bytes.iter().take(schema.size()).rev().fold(0, |w, b| w << 8 | u32::from(*b));
    match schema {
        Schema::F32 => Number::F32(f32::from_bits(word)),
        Schema::I32 => Number::I32(word as i32),
        Schema::Bool => Number::Bool(word != 0),
        _ => Number::U32(word),
    }
}

/// Returns the name of a member; a tuple's members are numbers.
fn member(name: &str) -> &str {
    name.strip_prefix('_').filter(|n| n.parse::<u32>().is_ok()).unwrap_or(name)
}

fn collect(schema: &Schema, bytes: &[u8], path: &str, all: &mut Vec<Leaf>) {
    let below = |name: &str| match path {
        "" => name.to_owned(),
        path => format!("{path}.{name}"),
    };
    match schema {
        Schema::Host => {}
        Schema::Vector(element, n) => {
            for (i, name) in ["x", "y", "z", "w"].into_iter().enumerate().take(*n) {
                collect(element, &bytes[i * element.size()..], &below(name), all);
            }
        }
        Schema::Array { element, count, stride } => {
            for i in 0..*count {
                collect(element, &bytes[i * stride..], &format!("{path}[{i}]"), all);
            }
        }
        Schema::Struct { fields, .. } => {
            for f in *fields {
                collect(f.schema, &bytes[f.offset..], &below(member(f.name)), all);
            }
        }
        scalar => all.push(Leaf { path: path.to_owned(), number: number(scalar, bytes) }),
    }
}

/// Prints a value in one line, as in `(0.5, [1.0, 2.0, 3.0])`; its type need not be `Debug`.
pub(super) fn one_line<T: Type>(v: &T) -> String {
    let mut text = String::new();
    write_value(T::SCHEMA, &bytes_of(v), &mut text);
    text
}

fn write_value(schema: &Schema, bytes: &[u8], text: &mut String) {
    let mut list = |around: [char; 2], parts: &[(Option<&str>, &Schema, usize)]| {
        text.push(around[0]);
        for (i, (name, schema, at)) in parts.iter().enumerate() {
            text.push_str(if i > 0 { ", " } else { "" });
            if let Some(name) = name {
                let _ = write!(text, "{name}: ");
            }
            write_value(schema, &bytes[*at..], text);
        }
        text.push(around[1]);
    };
    match schema {
        Schema::Host => text.push('_'),
        Schema::Vector(element, n) => {
            let part = |i| (None, *element, i * element.size());
            list(['[', ']'], &(0..*n).map(part).collect::<Vec<_>>());
        }
        Schema::Array { element, count, stride } => {
            let part = |i| (None, *element, i * stride);
            list(['[', ']'], &(0..*count).map(part).collect::<Vec<_>>());
        }
        Schema::Struct { name: "Tuple", fields, .. } => {
            let parts: Vec<_> = fields.iter().map(|f| (None, f.schema, f.offset)).collect();
            list(['(', ')'], &parts);
        }
        Schema::Struct { fields, .. } => {
            let parts: Vec<_> = fields.iter().map(|f| (Some(f.name), f.schema, f.offset)).collect();
            list(['{', '}'], &parts);
        }
        scalar => text.push_str(&number(scalar, bytes).value()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Vec2, vec2};

    #[test]
    fn every_kind_of_value_is_shown() {
        let v = (1.5f32, -2i32, vec2(0.1, f32::NAN), [7u32, 8], true);
        assert_eq!(one_line(&v), "(1.5, -2, [0.1, NaN], [7, 8], true)");
        let paths: Vec<String> = leaves(&v).into_iter().map(|l| l.path).collect();
        assert_eq!(paths, ["0", "1", "2.x", "2.y", "3[0]", "3[1]", "4"]);
        let hit = crate::geometry::Hit::miss();
        assert!(one_line(&hit).starts_with("{is_hit: false, t: "), "{}", one_line(&hit));
        assert_eq!(leaves(&Vec2::ONE)[1].number.with_bits(), "1.0 (0x3f800000)");
    }
}
