//! Generated kernels as Rust source text.

use super::tree::{Block, Expr, Function, Head, Kernel, Mode, Param, Piece, Scene, Stmt};

/// The struct that some modules have, so that methods and traits are implemented for a type of
/// another crate too.
const OWN: &str = "
#[derive(Clone, Copy, Debug, Type)]
pub struct Own {
    pub a: f32,
    pub k: u32,
    pub p: Vec2,
    pub kind: Kind,
}

#[kernel]
impl Own {
    pub fn of(n: u32) -> Self {
        Own { a: (n & 7) as f32 * 0.25, k: n, p: vec2(1.0, (n & 3) as f32), kind: Kind::of(n) }
    }

    pub fn is_over(&self, x: f32) -> bool {
        self.a > x && self.kind != Kind::Red
    }

    pub fn raise(&mut self, n: u32) {
        self.k |= n;
        if self.k > 99 {
            return;
        }
        self.kind = self.kind.next(n);
    }
}
";

/// What `impl Weigh for Own` has beside the generated method.
const WEIGH: &str = "
    const FLOOR: f32 = 1.0;

    fn turned(self, n: u32) -> Self {
        Own { k: self.k ^ n, ..self }
    }

    fn made(n: u32) -> Self {
        Own::of(n)
    }

    fn push(&mut self, by: f32) {
        self.p.y = by;
    }

";

/// What functions take that read the scene.
const SLICES: [&str; 6] = [
    "floats: &[f32]",
    "words: &[u32]",
    "smalls: &[Small]",
    "shapes: &[Shape]",
    "scene: &[Wall]",
    "world: &World<'_>",
];

/// The module of a kernel.
pub fn kernel(k: &Kernel) -> String {
    let mut p = Printer::default();
    p.text("use raydsl::kernel;\nuse raydsl::prelude::*;\n");
    p.text("use raydsl_tests::fuzz::types::*;\n");
    if k.own {
        p.text(OWN);
    }
    for f in &k.functions {
        p.function(f);
    }
    if let Some(scene) = k.scene {
        p.text(&format!("\nraydsl_tests::scene_entry!({}, {});\n", scene.len, scene.count));
        if let (true, Some(entry)) = (scene.closure, k.functions.last()) {
            p.closure(entry, scene);
        }
    }
    p.out
}

fn param(p: &Param) -> String {
    let (name, ty) = (&p.name, p.ty.name());
    match (p.mode, name == "self") {
        (Mode::Value, true) => "self".to_owned(),
        (Mode::Mutable, true) => "mut self".to_owned(),
        (Mode::Shared, true) => "&self".to_owned(),
        (Mode::Changed, true) => "&mut self".to_owned(),
        (Mode::Value, false) => format!("{name}: {ty}"),
        (Mode::Mutable, false) => format!("mut {name}: {ty}"),
        (Mode::Shared, false) => format!("{name}: &{ty}"),
        (Mode::Changed, false) => format!("{name}: &mut {ty}"),
        (Mode::Host, _) => format!("#[host] {name}: {ty}"),
    }
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
        let mut params: Vec<String> = f.params.iter().map(param).collect();
        if f.head == Head::OfScene {
            params.insert(0, "scene: &S".to_owned());
        }
        if f.sliced {
            params.extend(SLICES.map(str::to_owned));
        }
        if f.sliced && f.name == "entry" {
            params.extend(["scale: f32".to_owned(), "#[host] count: u32".to_owned()]);
        }
        let (name, params, result) = (&f.name, params.join(", "), f.result.name());
        let coherent = if f.coherent { "#[coherent]\n" } else { "" };
        let generics = match f.head {
            Head::OfType => "<T: Weigh>",
            Head::OfCount => "<const N: usize>",
            Head::OfScene => "<S: RayQuery + ?Sized>",
            Head::Plain | Head::Method | Head::Weight => "",
        };
        match f.head {
            Head::Plain | Head::OfType | Head::OfCount | Head::OfScene => {
                self.text(&format!("\n#[kernel]\n{coherent}pub "));
            }
            Head::Method => self.text("\n#[kernel]\nimpl Own {\n    pub "),
            Head::Weight => self.text(&format!("\n#[kernel]\nimpl Weigh for Own {{{WEIGH}    ")),
        }
        let in_impl = matches!(f.head, Head::Method | Head::Weight);
        self.indent = usize::from(in_impl);
        self.text(&format!("fn {name}{generics}({params}) -> {result} "));
        self.block(&f.body);
        self.indent = 0;
        self.text(if in_impl { "\n}\n" } else { "\n" });
    }

    /// The same body as a closure that captures the scene.
    fn closure(&mut self, entry: &Function, scene: Scene) {
        let Scene { len, count, .. } = scene;
        self.text("\npub fn closure(run: raydsl_tests::fuzz::run::Use<'_>) {\n");
        self.text(&format!(
            "    let (floats, words) = (first(&FLOATS, {len}), first(&WORDS, {len}));\n"
        ));
        self.text(&format!(
            "    let (smalls, shapes) = (first(&SMALLS, {len}), first(&SHAPES, {len}));\n"
        ));
        self.text(&format!("    let (scene, world) = (first(&WALLS, {len}), &WORLD);\n"));
        self.text(&format!("    let (scale, count) = (SCALE, {count}u32);\n"));
        let params: Vec<String> = entry.params.iter().map(param).collect();
        self.text(&format!("    let kernel = kernel!(|{}| -> Outcome ", params.join(", ")));
        self.indent = 1;
        self.block(&entry.body);
        self.indent = 0;
        self.text(");\n    run(&kernel);\n}\n");
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
