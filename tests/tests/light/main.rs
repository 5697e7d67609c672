//! What light does: lights and their choice, BSDFs, integrators of surfaces.

mod bsdfs;
mod integrators;
mod light_transport;
mod light_tree;
mod lights;
