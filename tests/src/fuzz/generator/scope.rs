//! What is in scope: variables with their members, functions, loops that can be left.

use super::Generator;
use super::vocabulary::{NAMES, members};
use crate::fuzz::tree::{Head, Mode, Param, Ty};

/// A variable.
#[derive(Clone)]
pub(super) struct Var {
    pub(super) name: String,
    pub(super) ty: Ty,
    pub(super) mutable: bool,
    /// Whether it is a reference.
    pub(super) reference: bool,
    /// Whether it is a value of the host.
    pub(super) host: bool,
}

impl Var {
    pub(super) fn new(name: String, ty: Ty, mutable: bool) -> Self {
        Self { name, ty, mutable, reference: false, host: false }
    }

    pub(super) fn of(p: &Param) -> Self {
        let mutable = matches!(p.mode, Mode::Mutable | Mode::Changed);
        let reference = matches!(p.mode, Mode::Shared | Mode::Changed);
        Self { name: p.name.clone(), ty: p.ty, mutable, reference, host: p.mode == Mode::Host }
    }
}

/// A function that may be called.
pub(super) struct Callable {
    pub(super) name: String,
    pub(super) head: Head,
    pub(super) sliced: bool,
    pub(super) params: Vec<Param>,
    pub(super) result: Ty,
    pub(super) work: usize,
}

/// A loop or a labelled block.
pub(super) struct Exit {
    pub(super) label: Option<String>,
    pub(super) is_loop: bool,
    /// What `break` takes along.
    pub(super) value: Option<Ty>,
}

/// A variable or a member of one.
#[derive(Clone)]
pub(super) struct Place {
    pub(super) text: String,
    pub(super) ty: Ty,
    /// The name of the variable.
    pub(super) root: String,
    /// Whether it is a variable that is a reference.
    pub(super) reference: bool,
}

impl Generator<'_> {
    /// The variables that are in scope, and their members.
    pub(super) fn places(&self, takes: impl Fn(&Var) -> bool) -> Vec<Place> {
        let mut all = Vec::new();
        for (i, var) in self.vars.iter().enumerate() {
            let shadowed = self.vars[i + 1..].iter().any(|later| later.name == var.name);
            if !shadowed && takes(var) {
                let name = &var.name;
                let text = if var.reference { format!("(*{name})") } else { name.clone() };
                let reference = var.reference;
                all.push(Place { text, ty: var.ty, root: name.clone(), reference });
            }
        }
        let mut i = 0;
        while i < all.len() {
            let Place { text, ty, root, reference } = all[i].clone();
            let text = if reference { &root } else { &text };
            for (name, ty) in members(ty) {
                let (text, root) = (format!("{text}.{name}"), root.clone());
                all.push(Place { text, ty: *ty, root, reference: false });
            }
            i += 1;
        }
        all
    }

    /// One of the places of a type.
    pub(super) fn place_of(&mut self, ty: Ty, takes: impl Fn(&Var) -> bool) -> Option<Place> {
        let mut places = self.places(takes);
        places.retain(|p| p.ty == ty);
        (!places.is_empty()).then(|| places.swap_remove(self.rng.below(places.len())))
    }

    /// A place that can be assigned.
    pub(super) fn target(&mut self) -> Option<Place> {
        let mut places = self.places(|var| var.mutable && !var.host);
        (!places.is_empty()).then(|| places.swap_remove(self.rng.below(places.len())))
    }

    /// A name for a variable. It shadows another, now and then; several words are in use twice by
    /// chance.
    pub(super) fn new_name(&mut self) -> String {
        match self.rng.below(3) {
            0 => self.rng.pick(NAMES).to_owned(),
            1 => format!("a{}", self.rng.below(100)),
            _ => format!("{}_{}", self.rng.pick(NAMES), self.rng.below(10)),
        }
    }

    /// `mut name` or `name` for a pattern, and its variable.
    pub(super) fn new_binding(&mut self, ty: Ty) -> (String, Var) {
        let (name, mutable) = (self.new_name(), self.chance(60));
        let text = if mutable { format!("mut {name}") } else { name.clone() };
        (text, Var::new(name, ty, mutable))
    }
}
