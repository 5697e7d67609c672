//! Primitives of the library and of a user.

mod own_shapes;
mod primitives;
mod shapes;
