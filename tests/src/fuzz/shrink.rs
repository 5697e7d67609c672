//! Smaller kernels from one that fails.

use super::tree::{Block, Expr, Function, Head, Kernel, Piece, Ty};

/// Kernels that are each smaller than `kernel` by one cut: a statement gone, an expression that
/// is one of its parts or plain, a function that nothing calls gone. They all compile.
pub fn cuts(kernel: &Kernel) -> Vec<Kernel> {
    let mut all = Vec::new();
    loop {
        let mut cut = kernel.clone();
        let mut cutter = Cutter { left: all.len() };
        if !cutter.kernel(&mut cut) {
            return all;
        }
        all.push(cut);
    }
}

/// Makes the cut with the number `left` on its way through the tree.
struct Cutter {
    left: usize,
}

impl Cutter {
    /// Whether the cut is to be made here.
    const fn here(&mut self) -> bool {
        match self.left.checked_sub(1) {
            Some(left) => {
                self.left = left;
                false
            }
            None => true,
        }
    }

    fn kernel(&mut self, k: &mut Kernel) -> bool {
        for i in 0..k.functions.len().saturating_sub(1) {
            let name = &k.functions[i].name;
            if !k.functions.iter().any(|f| calls(&f.body, name)) && self.here() {
                k.functions.remove(i);
                return true;
            }
        }
        if k.own && !needs_own(k) && self.here() {
            k.own = false;
            return true;
        }
        if let Some(scene) = &mut k.scene
            && scene.closure
            && self.here()
        {
            scene.closure = false;
            return true;
        }
        k.functions.iter_mut().rev().any(|f: &mut Function| self.block(&mut f.body))
    }

    fn block(&mut self, b: &mut Block) -> bool {
        for i in (0..b.stmts.len()).rev() {
            if b.stmts[i].removable && self.here() {
                b.stmts.remove(i);
                return true;
            }
        }
        b.stmts.iter_mut().any(|s| self.pieces(&mut s.pieces))
            || b.tail.as_mut().is_some_and(|e| self.expr(e))
    }

    fn expr(&mut self, e: &mut Expr) -> bool {
        let plain = Expr::text(e.ty, e.ty.plain());
        if e.pieces.iter().any(|p| !matches!(p, Piece::Text(_))) {
            if self.here() {
                *e = plain;
                return true;
            }
            let part = |p: &Piece| match p {
                Piece::Expr(part) if part.ty == e.ty => Some(part.clone()),
                _ => None,
            };
            let parts: Vec<Expr> = e.pieces.iter().filter_map(part).collect();
            for part in parts {
                if self.here() {
                    *e = part;
                    return true;
                }
            }
        }
        self.pieces(&mut e.pieces)
    }

    fn pieces(&mut self, pieces: &mut [Piece]) -> bool {
        pieces.iter_mut().any(|p| match p {
            Piece::Text(_) => false,
            Piece::Expr(e) => self.expr(e),
            Piece::Block(b) => self.block(b),
        })
    }
}

/// Whether the text of a block has a word of a function's name in it.
fn calls(b: &Block, name: &str) -> bool {
    let in_tail = b.tail.as_ref().is_some_and(|e| calls_in(&e.pieces, name));
    in_tail || b.stmts.iter().any(|s| calls_in(&s.pieces, name))
}

fn calls_in(pieces: &[Piece], name: &str) -> bool {
    pieces.iter().any(|p| match p {
        Piece::Text(text) => text.contains(name),
        Piece::Expr(e) => calls_in(&e.pieces, name),
        Piece::Block(b) => calls(b, name),
    })
}

/// Whether the struct `Own` is in use; its own methods are a use.
fn needs_own(k: &Kernel) -> bool {
    k.functions.iter().any(|f| {
        let of_own = f.result == Ty::Own || f.params.iter().any(|p| p.ty == Ty::Own);
        of_own || matches!(f.head, Head::Method | Head::Weight) || calls(&f.body, "Own")
    })
}
