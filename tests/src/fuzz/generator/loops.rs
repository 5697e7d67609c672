//! Loops that count, and loops over elements.

use super::scope::{Exit, Var};
use super::{Generator, around, text};
use crate::fuzz::tree::{Piece, Stmt, Ty};

/// What a loop has around its block.
struct Head {
    pieces: Vec<Piece>,
    /// Statements in front of the others of the block.
    first: Vec<Stmt>,
    /// What the block sees.
    vars: Vec<Var>,
    rounds: usize,
}

impl Generator<'_> {
    pub(super) fn repetition(&mut self) -> Stmt {
        let number = self.number();
        let label = self.chance(40).then(|| format!("l{number}"));
        let prefix = label.as_ref().map(|l| format!("'{l}: ")).unwrap_or_default();
        let counter = format!("count{number}");
        let rounds = 1 + self.rng.below(6);
        let head = match self.rng.below(8) {
            0 => endless(&prefix, &counter, rounds),
            1 => self.conditioned(&prefix, &counter, rounds),
            2 => self.counted(&prefix, rounds),
            3 => self.signed(&prefix, rounds),
            4 => self.backwards(&prefix),
            5 => self.hosted(&prefix),
            _ => self.over_elements(&prefix),
        };
        let (outer, scope) = (self.rounds, self.vars.len());
        self.rounds *= head.rounds;
        self.vars.extend(head.vars);
        self.around.push(Exit { label, is_loop: true, value: None });
        let mut block = self.inner_block(None);
        self.around.pop();
        self.rounds = outer;
        self.vars.truncate(scope);
        block.stmts.splice(0..0, head.first);
        let mut pieces = head.pieces;
        pieces.push(Piece::Block(block));
        Stmt { pieces, removable: true }
    }

    fn conditioned(&mut self, prefix: &str, counter: &str, rounds: usize) -> Head {
        let head = format!("let mut {counter}: u32 = 0; {prefix}while {counter} < {rounds}");
        let pieces = if self.chance(70) {
            let condition = self.plainly(|g| g.expr(Ty::Bool, 2));
            around(format!("{head} && "), condition, " ")
        } else {
            vec![text(format!("{head} "))]
        };
        Head { pieces, first: vec![step(format!("{counter} += 1;"))], vars: vec![], rounds }
    }

    fn counted(&mut self, prefix: &str, rounds: usize) -> Head {
        let (name, vars) = self.loop_variable(Ty::U32);
        let end = self.expr(Ty::U32, 2);
        let head = format!("{prefix}for {name} in 0..(");
        let after = format!(" % {}) ", rounds + 1);
        Head { pieces: around(head, end, &after), first: vec![], vars, rounds }
    }

    fn signed(&mut self, prefix: &str, rounds: usize) -> Head {
        let (name, vars) = self.loop_variable(Ty::I32);
        let start = self.rng.below(9) as i32 - 4;
        let pieces = if self.chance(50) {
            let end = start + rounds as i32 - 1;
            let dots = if self.chance(50) { "..=" } else { ".." };
            vec![text(format!("{prefix}for {name} in {start}{dots}{end}i32 "))]
        } else {
            let start = self.expr(Ty::I32, 2);
            around(format!("{prefix}for {name} in ("), start, " & 3)..5 ")
        };
        Head { pieces, first: vec![], vars, rounds: rounds.max(5) }
    }

    fn backwards(&mut self, prefix: &str) -> Head {
        let (name, vars) = self.loop_variable(Ty::U32);
        let end = self.expr(Ty::U32, 2);
        let (dots, rev) =
            (self.rng.pick(&["..", "..="]), self.rng.pick(&[".rev()", ".rev().rev()"]));
        let head = format!("{prefix}for {name} in (1{dots}(");
        Head { pieces: around(head, end, &format!(" & 3)){rev} ")), first: vec![], vars, rounds: 3 }
    }

    /// A bound of the host, in steps of all lanes.
    fn hosted(&mut self, prefix: &str) -> Head {
        let (name, vars) = self.loop_variable(Ty::U32);
        let end = self.host_value();
        let pieces = vec![text(format!("{prefix}for {name} in 0..{end} "))];
        Head { pieces, first: vec![], vars, rounds: 3 }
    }

    fn over_elements(&mut self, prefix: &str) -> Head {
        let (list, element, rounds) = self.list();
        // The name `_` binds nothing.
        let (name, mut vars) = self.loop_variable(element);
        let (pattern, list) = match list {
            List::Value(pieces) => (name, pieces),
            List::Borrowed(text) => {
                let by_pattern = !matches!(element, Ty::Small | Ty::Shape) && self.chance(40);
                vars.iter_mut().for_each(|v| v.reference = !by_pattern);
                let name = if by_pattern { format!("&{name}") } else { name };
                (name, vec![Piece::Text(text)])
            }
        };
        let counts =
            matches!(&list[..], [Piece::Text(t)] if t.ends_with(".iter()")) && self.chance(40);
        let (pattern, after) = if counts {
            let index = format!("at{}", self.number());
            vars.push(Var::new(index.clone(), Ty::Size, false));
            (format!("({index}, {pattern})"), ".enumerate() ")
        } else {
            (pattern, " ")
        };
        let mut pieces = vec![text(format!("{prefix}for {pattern} in "))];
        pieces.extend(list);
        pieces.push(text(after));
        Head { pieces, first: vec![], vars, rounds }
    }

    /// Something with elements, their type, and how many there are at most.
    fn list(&mut self) -> (List, Ty, usize) {
        let floats = self.traits.floats;
        if self.sliced && self.chance(60) {
            let lists = [
                ("words", Ty::U32, 7),
                ("floats", Ty::F32, 9),
                ("smalls", Ty::Small, 3),
                ("shapes", Ty::Shape, 6),
            ];
            let (name, ty, len) = lists[if floats { self.rng.below(lists.len()) } else { 0 }];
            let list = if self.chance(70) { format!("{name}.iter()") } else { name.to_owned() };
            return (List::Borrowed(list), ty, len);
        }
        let kinds = [(Ty::Counts, Ty::U32, 3), (Ty::Row, Ty::F32, 4), (Ty::Both, Ty::Small, 2)];
        let (ty, element, len) = kinds[if floats { self.rng.below(3) } else { 0 }];
        // A borrowed array cannot be assigned meanwhile.
        let fixed = self.place_of(ty, |var| !var.mutable);
        match fixed {
            Some(place) if self.chance(60) => {
                let text = place.text;
                let list =
                    if self.chance(70) { format!("{text}.iter()") } else { format!("&{text}") };
                (List::Borrowed(list), element, len)
            }
            _ => match self.place_of(ty, |var| !var.reference) {
                Some(place) => (List::Value(vec![text(place.text)]), element, len),
                None => {
                    let [a, b] = [self.expr(element, 2), self.expr(element, 2)];
                    let mut pieces = around("[", a, ", ");
                    pieces.extend(around("", b, "]"));
                    (List::Value(pieces), element, 2)
                }
            },
        }
    }

    /// A name, and the variable for it.
    fn loop_variable(&mut self, ty: Ty) -> (String, Vec<Var>) {
        if self.chance(20) {
            return ("_".to_owned(), vec![]);
        }
        let name = self.new_name();
        (name.clone(), vec![Var::new(name, ty, false)])
    }
}

/// What a loop over elements goes through.
enum List {
    Value(Vec<Piece>),
    Borrowed(String),
}

/// A counter that nothing else may assign or shadow, stepped before anything can leave.
fn step(line: String) -> Stmt {
    Stmt { pieces: vec![text(line)], removable: false }
}

fn endless(prefix: &str, counter: &str, rounds: usize) -> Head {
    let leave = format!("if {counter} > {rounds} {{ break; }}");
    let first = vec![step(format!("{counter} += 1;")), step(leave)];
    let head = format!("let mut {counter} = 0u32; {prefix}loop ");
    Head { pieces: vec![text(head)], first, vars: vec![], rounds: rounds + 1 }
}
