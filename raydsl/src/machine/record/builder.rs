//! Construction of a function's intermediate representation.

use std::collections::HashMap;

use super::ir::{Expr, Id, Node, Recorded, Stmt, Type, VarId, Variable};
use super::kinds::Known;
use super::names::unique;
use super::settled::Declared;
use crate::machine::{KernelInfo, Kinds};

/// A function being recorded.
#[derive(Clone)]
pub(super) struct Builder {
    pub(super) function: Recorded,
    pub(super) blocks: Vec<(u32, Vec<Stmt>)>,
    pub(super) next_block: u32,
    pub(super) loops: Vec<LoopState>,
    pub(super) next_loop: u32,
    /// The trivial expressions: each is one node per type.
    trivial: HashMap<Expr, Vec<Id>>,
    /// The variable that holds the labelled loop being left.
    pub(super) leave: Option<VarId>,
    pub(super) known: Known,
    pub(super) declared: Declared,
}

#[derive(Clone, Default)]
pub(super) struct LoopState {
    pub(super) number: u32,
    /// Labelled exits that pass through this loop: the target loop, and whether it is `continue`.
    pub(super) passing: Vec<(u32, bool)>,
    /// The variables read in it and made right outside, with the fewest kinds that a read assumed.
    pub(super) assumed: HashMap<VarId, Kinds>,
}

impl Builder {
    pub(super) fn new(info: &'static KernelInfo) -> Self {
        Self {
            function: Recorded {
                source_name: info.name,
                name: info.name.to_owned(),
                file: info.file,
                line: info.line,
                is_without_nan: info.known.is_some_and(|known| known.0.is_without_nan()),
                params: Vec::new(),
                result: None,
                nodes: Vec::new(),
                vars: Vec::new(),
                body: Vec::new(),
            },
            blocks: vec![(0, Vec::new())],
            next_block: 1,
            loops: Vec::new(),
            next_loop: 1,
            trivial: HashMap::new(),
            leave: None,
            known: Known::default(),
            declared: Declared::default(),
        }
    }

    pub(super) fn block(&self) -> u32 {
        self.blocks.last().map_or(0, |b| b.0)
    }

    pub(super) fn push(&mut self, stmt: Stmt) {
        if let Some((_, block)) = self.blocks.last_mut() {
            block.push(stmt);
        }
    }

    pub(super) fn open_block(&mut self) {
        self.blocks.push((self.next_block, Vec::new()));
        self.next_block += 1;
    }

    pub(super) fn close_block(&mut self) -> Vec<Stmt> {
        self.blocks.pop().map(|b| b.1).unwrap_or_default()
    }

    pub(super) fn node(&mut self, id: Id) -> &mut Node {
        &mut self.function.nodes[id.0 as usize]
    }

    /// Records a use of `id`: its loads must not have changed, and it may be printed at its use
    /// only in its own block.
    pub(super) fn used(&mut self, id: Id) -> Vec<Id> {
        let here = self.block();
        // A part of a value is printed as the value and its member: the value must not be evaluated
        // again in an inner block.
        let mut whole = id;
        while let Expr::Member(a, _) | Expr::Element(a, _) =
            self.function.nodes[whole.0 as usize].expr
        {
            whole = a;
        }
        let node = &self.function.nodes[whole.0 as usize];
        let is_load = matches!(node.expr, Expr::Load(_));
        if !node.expr.is_trivial() && !is_load && node.block != here {
            self.node(whole).pinned = true;
        }
        if self.function.nodes[id.0 as usize].pinned {
            return Vec::new();
        }
        let loads = self.function.nodes[id.0 as usize].loads.clone();
        let mut fresh = Vec::new();
        for load in loads {
            let stale = match self.function.nodes[load.0 as usize].expr {
                Expr::Load(v) => {
                    let recorded = self.function.nodes[load.0 as usize].version;
                    self.function.vars[v.0 as usize].version != recorded
                }
                _ => false,
            };
            if stale {
                self.node(load).pinned = true;
            } else {
                fresh.push(load);
            }
        }
        fresh
    }

    pub(super) fn add(&mut self, expr: Expr, ty: Type) -> Id {
        let is_trivial = expr.is_trivial();
        if is_trivial
            && let Some(known) = self.trivial.get(&expr)
            && let Some(id) = known.iter().find(|id| self.function.nodes[id.0 as usize].ty == ty)
        {
            return *id;
        }
        let mut loads = Vec::new();
        for operand in expr.operands() {
            for load in self.used(operand) {
                if !loads.contains(&load) {
                    loads.push(load);
                }
            }
        }
        let id = Id(self.function.nodes.len() as u32);
        let version = match expr {
            Expr::Load(v) => {
                loads.push(id);
                self.function.vars[v.0 as usize].version
            }
            _ => 0,
        };
        if is_trivial {
            self.trivial.entry(expr.clone()).or_default().push(id);
        }
        let block = self.block();
        self.function.nodes.push(Node {
            expr,
            ty,
            name: None,
            pinned: false,
            block,
            loads,
            version,
        });
        if !is_trivial {
            self.push(Stmt::Let(id));
        }
        id
    }

    /// Returns whether a variable or a parameter has the name.
    pub(super) fn is_taken(&self, name: &str) -> bool {
        self.function.vars.iter().any(|v| v.name == name)
            || self.function.params.iter().any(|p| p.0 == name)
    }

    pub(super) fn new_var(&mut self, name: &str, ty: Type) -> VarId {
        let v = VarId(self.function.vars.len() as u32);
        let name = unique(name, |n| self.is_taken(n));
        self.function.vars.push(Variable { name, ty, version: 0 });
        v
    }

    pub(super) fn store(&mut self, v: VarId, value: Id) {
        let unchanged = matches!(self.function.nodes[value.0 as usize].expr, Expr::Load(w) if w == v)
            && self.function.nodes[value.0 as usize].version
                == self.function.vars[v.0 as usize].version;
        if unchanged {
            return;
        }
        self.used(value);
        self.store_kinds(v, value);
        self.settle(v, value);
        self.function.vars[v.0 as usize].version += 1;
        self.push(Stmt::Store(v, value));
    }
}
