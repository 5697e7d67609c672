//! Scenes of every kind: trees, lists, instances and accelerators of an application.

mod accelerators;
mod any_scene;
mod attributes;
mod instances;
mod scenes;
