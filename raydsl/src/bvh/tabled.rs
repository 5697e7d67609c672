//! A scene with tables: the view of a struct of scenes that has slices or textures besides.

use core::ops::Deref;

use super::RayQueryOn;
use super::carrier::carrier;
use crate::machine::{Leaves, Machine, Resource, Schema, TableView, Value};

/// View of a scene with tables: what `#[derive(RayQuery)]` makes of a struct that has members marked
/// `#[table]`. The members of `T` are read as its own.
#[derive(Clone, Copy, Debug)]
pub struct Tabled<S, T> {
    scene: S,
    tables: T,
}

impl<S, T> Tabled<S, T> {
    /// Joins a scene and tables.
    #[inline(always)]
    pub fn new(scene: S, tables: T) -> Self {
        Self { scene, tables }
    }

    /// Returns the scene.
    #[inline(always)]
    pub fn scene(self) -> S {
        self.scene
    }
}

impl<S, T> Deref for Tabled<S, T> {
    type Target = T;

    #[inline(always)]
    fn deref(&self) -> &T {
        &self.tables
    }
}

impl<S, T: TableView> Tabled<S, T> {
    fn data(&self, visit: &mut dyn FnMut(&dyn Resource)) {
        self.tables.resources(visit);
    }
}

carrier!([S: RayQueryOn, T: TableView] Tabled<S, T>, S, scene);

/// A host value on every machine.
impl<M: Machine, S: Value<M>, T: TableView> Value<M> for Tabled<S, T> {
    const SCHEMA: &'static Schema = &Schema::Host;

    fn zero(_: &M) -> Self {
        panic!("a kernel cannot choose between scenes: choose between what it reads from them")
    }

    #[inline(always)]
    fn zip(m: &M, a: Self, b: Self, f: &mut impl Leaves<M>) -> Self {
        assert!(
            a.tables.is_same(&b.tables),
            "a kernel cannot choose between scenes: choose between what it reads from them"
        );
        Self { scene: S::zip(m, a.scene, b.scene, f), ..a }
    }
}
