//! Generated kernels as Rust source text.

use super::tree::{Block, Expr, Function, Kernel, Piece, Stmt};

/// The module of a kernel.
pub fn kernel(k: &Kernel) -> String {
    let mut p = Printer::default();
    p.text("use raydsl::kernel;\nuse raydsl::prelude::*;\n");
    p.text("use raydsl_tests::fuzz::types::*;\n");
    for f in &k.functions {
        p.function(f);
    }
    p.out
}

#[derive(Default)]
struct Printer {
    out: String,
    indent: usize,
}

impl Printer {
    fn text(&mut self, text: &str) {
        self.out.push_str(text);
    }

    fn line(&mut self) {
        self.out.push('\n');
        self.out.extend(std::iter::repeat_n(' ', 4 * self.indent));
    }

    fn function(&mut self, f: &Function) {
        let params: Vec<String> =
            f.params.iter().map(|(name, ty)| format!("{name}: {}", ty.name())).collect();
        let (params, result) = (params.join(", "), f.result.name());
        self.text(&format!("\n#[kernel]\npub fn {}({params}) -> {result} ", f.name));
        self.block(&f.body);
        self.text("\n");
    }

    fn block(&mut self, b: &Block) {
        if b.stmts.is_empty() && b.tail.is_none() {
            return self.text("{}");
        }
        self.text("{");
        self.indent += 1;
        for s in &b.stmts {
            self.line();
            self.stmt(s);
        }
        if let Some(tail) = &b.tail {
            self.line();
            self.expr(tail);
        }
        self.indent -= 1;
        self.line();
        self.text("}");
    }

    fn stmt(&mut self, s: &Stmt) {
        self.pieces(&s.pieces);
    }

    fn expr(&mut self, e: &Expr) {
        self.pieces(&e.pieces);
    }

    fn pieces(&mut self, pieces: &[Piece]) {
        for piece in pieces {
            match piece {
                Piece::Text(text) => self.text(text),
                Piece::Expr(e) => self.expr(e),
                Piece::Block(b) => self.block(b),
            }
        }
    }
}
