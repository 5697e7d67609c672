//! Tests of the macros in process: golden expansions, and one clear error for every mistake.
//!
//! `RAYDSL_BLESS=1` rewrites `golden/*.rs`; read the difference before committing it.

mod diagnostics;
mod expansions;
