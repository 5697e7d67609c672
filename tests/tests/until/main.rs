//! Rendering until an error is reached: the claimed confidence holds, and budgets do.
//!
//! The cases have closed forms. `RAYDSL_TEST_SHARE=16 cargo test --test until -- --nocapture` runs
//! 1024 seeds of each and prints the tables of the book.

mod adaptive;
mod budgets;
mod certain;
mod coverage;
mod estimators;
mod media;
mod paths;

use raydsl::prelude::*;

fn camera() -> Pinhole {
    Pinhole::new(vec3(0.0, 0.0, 5.0), vec3(0.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), 1.0)
}
