//! What rays meet: queries in every variant, level and width, beside loops in plain Rust.

mod boxes;
mod contract;
mod edges;
mod facts;
mod gangs;
mod hits;
mod leaves;
mod levels;
mod origins;
mod queries;
mod rays;
