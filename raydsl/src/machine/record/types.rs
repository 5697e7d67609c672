//! Types of the generated text, declared on demand.

use core::fmt::Write;

use super::ir::Type;
use super::names::{member_name, safe_name, unique};
use crate::machine::Schema;
use crate::machine::wgsl::Quotients;

/// The names of types, declared on demand.
#[derive(Default)]
pub(super) struct Names {
    structs: Vec<(String, &'static Schema)>,
    /// The names that the text uses.
    used: Vec<String>,
    pub(super) helpers: Vec<&'static str>,
    /// How quotients and square roots are printed.
    pub(super) quotients: Quotients,
    /// The storage structs: the name of each and its declaration.
    stored: Vec<(String, String)>,
}

/// Returns whether both are the same type to a kernel, regardless of their memory layout.
fn same_type(a: &Schema, b: &Schema) -> bool {
    match (a, b) {
        (Schema::Struct { name: n, fields: f, .. }, Schema::Struct { name: m, fields: g, .. }) => {
            n == m
                && f.len() == g.len()
                && f.iter().zip(*g).all(|(x, y)| x.name == y.name && same_type(x.schema, y.schema))
        }
        (
            Schema::Array { element: a, count: n, .. },
            Schema::Array { element: b, count: m, .. },
        ) => n == m && same_type(a, b),
        _ => a == b,
    }
}

impl Names {
    /// Reserves the type names that hand-written text uses: a user's type of the same name gets
    /// another.
    pub(super) fn new(named: impl Iterator<Item = &'static Schema>) -> Self {
        let mut names = Self::default();
        for schema in named {
            if let Schema::Struct { name, .. } = schema
                && !names.structs.iter().any(|(known, _)| known == name)
            {
                names.structs.push(((*name).to_owned(), schema));
            }
        }
        names
    }

    pub(super) fn helper(&mut self, name: &'static str) {
        if !self.helpers.contains(&name) {
            self.helpers.push(name);
        }
    }

    /// Returns the type as WGSL.
    pub(super) fn ty(&mut self, ty: Type) -> String {
        match ty {
            Type::F32 => "f32".to_owned(),
            Type::I32 => "i32".to_owned(),
            Type::U32 => "u32".to_owned(),
            Type::Bool => "bool".to_owned(),
            Type::Vector(of, n) => format!("vec{n}<{}>", of.name()),
            Type::Of(Schema::Array { element, count, .. }) => {
                format!("array<{}, {count}>", self.ty(Type::of(element)))
            }
            Type::Of(schema) => self.struct_name(schema),
        }
    }

    fn struct_name(&mut self, schema: &'static Schema) -> String {
        let known = self.structs.iter().find(|(_, s)| same_type(s, schema)).map(|s| s.0.clone());
        if let Some(name) = &known
            && self.used.contains(name)
        {
            return name.clone();
        }
        let Schema::Struct { name, fields, .. } = schema else { return "u32".to_owned() };
        // Declares the members' types first: a struct is declared after all it needs.
        for f in fields.iter().filter(|f| f.schema.leaves() > 0) {
            self.ty(Type::of(f.schema));
        }
        let name = known.unwrap_or_else(|| {
            let taken = |n: &str| self.structs.iter().any(|(m, _)| m == n);
            let name = unique(&safe_name(name), taken);
            self.structs.push((name.clone(), schema));
            name
        });
        self.used.push(name.clone());
        name
    }

    /// Returns the name of a stored struct, declared once; two layouts of one type have two names.
    pub(super) fn stored(&mut self, name: &str, declare: impl Fn(&str) -> String) -> String {
        let mut candidate = name.to_owned();
        let mut n = 0;
        loop {
            match self.stored.iter().find(|(known, _)| *known == candidate) {
                Some((known, text)) if *text == declare(known) => return candidate,
                Some(_) => {
                    n += 1;
                    candidate = format!("{name}_{n}");
                }
                None => break,
            }
        }
        self.stored.push((candidate.clone(), declare(&candidate)));
        candidate
    }

    /// Returns the declarations of the stored structs.
    pub(super) fn stored_declarations(&self) -> String {
        self.stored.iter().map(|(_, text)| format!("{text}\n")).collect()
    }

    pub(super) fn declarations(&mut self) -> String {
        let mut text = String::new();
        let schema_of =
            |name: &String| self.structs.iter().find(|(n, _)| n == name).map(|(_, schema)| *schema);
        let used: Vec<_> =
            self.used.iter().filter_map(|n| Some((n.clone(), schema_of(n)?))).collect();
        for (name, schema) in used {
            let Schema::Struct { fields, .. } = schema else { continue };
            let _ = writeln!(text, "struct {name} {{");
            for f in fields.iter().filter(|f| f.schema.leaves() > 0) {
                let _ =
                    writeln!(text, "    {}: {},", member_name(f.name), self.ty(Type::of(f.schema)));
            }
            text += "}\n\n";
        }
        text
    }
}

/// Returns the zero value of a struct, as an expression.
pub(crate) fn zero_value(schema: &'static Schema) -> String {
    match schema {
        Schema::Struct { name, .. } => format!("{}()", safe_name(name)),
        _ => "0".to_owned(),
    }
}
