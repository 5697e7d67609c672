//! Tests of the macros in process: golden expansions, one clear error for every mistake, and items
//! changed at random.
//!
//! `RAYDSL_BLESS=1` rewrites `golden/*.rs`; read the difference before committing it.

mod corpus;
mod diagnostics;
mod expansions;
mod mutations;
