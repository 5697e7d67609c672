//! Elementary functions, unorms, margins, fast arithmetic and the reference in `f64`.

mod elementary;
mod fast;
mod margin;
mod reference;
mod unorm;
