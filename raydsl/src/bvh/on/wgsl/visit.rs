//! Queries with kernel code per hit: the traversal is a struct that yields the next primitive, so
//! that the code stays in the kernel's own function.

use super::{BoxTests, Described};
use crate::bvh::contract::{Slabs, is_finite, is_within};
use crate::bvh::traverse::STACK;
use crate::bvh::{NODE_SCHEMA, RecordOn, SceneView};
use crate::geometry::{HitOn, HitRecord, Primitive, Ray, RayOn};
use crate::machine::record::from_template;
use crate::machine::record::ir::{Expr, Id, Type};
use crate::machine::{
    B, Branch, F, Field, Loop, Machine, Recorder, Schema, Type as HostType, U, Var, op,
};

/// Id that means that no primitive is left.
pub(super) const NONE: u32 = u32::MAX;

/// Traversal state.
pub(super) const TRAVERSAL: &Schema = &Schema::Struct {
    name: "Traversal",
    fields: &[
        Field { name: "lower", offset: 0, schema: &Schema::Vector(&Schema::F32, 3) },
        Field { name: "upper", offset: 16, schema: &Schema::Vector(&Schema::F32, 3) },
        Field { name: "inverse", offset: 32, schema: &Schema::Vector(&Schema::F32, 3) },
        Field { name: "top", offset: 48, schema: &Schema::U32 },
        Field { name: "next", offset: 52, schema: &Schema::U32 },
        Field { name: "last", offset: 56, schema: &Schema::U32 },
        Field {
            name: "nodes",
            offset: 60,
            schema: &Schema::Array { element: &Schema::U32, count: STACK, stride: 4 },
        },
        Field {
            name: "enters",
            offset: 60 + 4 * STACK,
            schema: &Schema::Array { element: &Schema::F32, count: STACK, stride: 4 },
        },
    ],
    size: 60 + 8 * STACK,
};

impl Recorder {
    /// Records a loop over the hits of `prims`.
    pub(in crate::bvh::on) fn visit_hits<P: Primitive>(
        &self,
        prims: &SceneView<'_, P>,
        ray: RayOn<Self>,
        limit: &impl Fn() -> F<Self>,
        meet: &impl Fn(HitOn<Self>, RecordOn<Self, P>) -> B<Self>,
    ) {
        if prims.placed().is_some() {
            self.visit_placed(prims, ray, limit, meet);
        } else if prims.is_list() {
            let roots = self.roots_buffer(prims);
            let call = |function, arguments| self.add(Expr::Call(function, arguments), Type::U32);
            let len = || call(self.len_of_buffer(&roots), vec![]);
            self.count(
                "tree",
                |tree| self.u32_compare(op::Lt, tree, len()),
                |tree, trees| {
                    let root = call(self.at_function(&roots, &Schema::U32), vec![tree]);
                    self.visit_tree(prims, Some((root, trees)), ray, limit, meet);
                },
            );
        } else if prims.has_tree() {
            self.visit_tree(prims, None, ray, limit, meet);
        } else {
            let goes_on = |id| {
                let within = self.u32_compare(op::Lt, id, self.len(prims).0);
                self.bool_binary(op::And, is_finite::on(self, ray).0, within)
            };
            self.count("id", goes_on, |id, ids| {
                self.ask(prims, ray, [U(id), U(self.u32(0))], meet, ids);
            });
        }
    }

    /// Records a loop that counts from 0.
    fn count(
        &self,
        name: &'static str,
        goes_on: impl Fn(Id) -> Id,
        body: impl Fn(Id, &Loop<Self>),
    ) {
        let counter = Var::new(self, name, U(self.u32(0)));
        let repeat = Loop::new(self);
        loop {
            repeat.test(self, B(goes_on(counter.get(self).0)));
            body(counter.get(self).0, &repeat);
            repeat.continuing(self);
            let next = self.u32_binary(op::WrappingAdd, counter.get(self).0, self.u32(1));
            counter.set(self, U(next));
            if !repeat.again(self) {
                break;
            }
        }
        repeat.end(self);
    }

    /// Records a loop over the hits of a tree: the one at `root`, within a loop over all trees, or
    /// the only one.
    fn visit_tree<P: Primitive>(
        &self,
        prims: &SceneView<'_, P>,
        root: Option<(Id, &Loop<Self>)>,
        ray: RayOn<Self>,
        limit: &impl Fn() -> F<Self>,
        meet: &impl Fn(HitOn<Self>, RecordOn<Self, P>) -> B<Self>,
    ) {
        let (start, next) = self.traverse_functions(prims);
        let arguments = [self.whole(ray)].into_iter().chain(root.map(|r| r.0)).collect();
        let start = self.add(Expr::Call(start, arguments), Type::Of(TRAVERSAL));
        let traversal = self.declare("traversal", start, TRAVERSAL);
        let repeat = Loop::new(self);
        loop {
            let traversal = self.add(Expr::Address(traversal), Type::Of(TRAVERSAL));
            let arguments = vec![traversal, ray.t_min.0, limit().0];
            let id = self.add(Expr::Call(next, arguments), Type::U32);
            self.pin(id, "id");
            repeat.test(self, B(self.u32_compare(op::Ne, id, self.u32(NONE))));
            let names = [U(id), U(self.u32(0))];
            self.ask(prims, ray, names, meet, root.map_or(&repeat, |r| r.1));
            repeat.continuing(self);
            if !repeat.again(self) {
                break;
            }
        }
        repeat.end(self);
    }

    /// Intersects one primitive of an instance, and passes a hit to `meet`.
    pub(super) fn ask<P: Primitive>(
        &self,
        prims: &SceneView<'_, P>,
        ray: RayOn<Self>,
        [id, inst]: [U<Self>; 2],
        meet: &impl Fn(HitOn<Self>, RecordOn<Self, P>) -> B<Self>,
        repeat: &Loop<Self>,
    ) {
        let prim = self.fetch(prims, id);
        let found = P::intersect_among_on(self, prims.kinds(), prim, ray, prims.shared());
        let found = self.named("candidate", found);
        let hit = HitOn { prim_id: id, inst_id: inst, ..P::Hit::hit_on(found) };
        let is_met = Branch::new(self, is_within::on(self, P::Hit::hit_on(found), ray));
        if is_met.then(self) {
            let stops =
                Branch::new(self, B(self.bool_not(meet(hit, P::Hit::with_hit_on(found, hit)).0)));
            if stops.then(self) {
                repeat.leave(self);
            }
            stops.end(self);
        }
        is_met.end(self);
    }

    /// Returns `fn bvh_begin(ray: Ray, ..) -> Traversal` and `fn bvh_next(..) -> u32`.
    fn traverse_functions(&self, prims: &dyn Described) -> (usize, usize) {
        let name = prims.primitives(self);
        let Some(tree) = self.tree(prims) else { unreachable!("only trees are traversed") };
        let (nodes, ids, slack) = (&tree.nodes, &tree.indices, prims.slack());
        let (is_finite, boxes) = (&tree.rules.is_finite, &tree.boxes);
        let BoxTests { slabs, enter_leave } = boxes;
        let (parameter, first) =
            if prims.is_list() { (", first: u32", "first") } else { ("", "0u") };
        let start = self.text_function(
            format!("{name}_begin"),
            vec![<Ray as HostType>::SCHEMA, TRAVERSAL, NODE_SCHEMA],
            &|name| {
                from_template(
                    include_str!("tree_begin.wgsl"),
                    &[
                        ("name", name),
                        ("parameter", parameter),
                        ("first", first),
                        ("nodes", nodes),
                        ("slack", &format!("{slack:?}")),
                        ("is_finite", is_finite),
                        ("slabs", slabs),
                        ("enter_leave", enter_leave),
                    ],
                )
            },
        );
        let next = self.text_function(
            format!("{name}_next"),
            vec![TRAVERSAL, NODE_SCHEMA, <Slabs as HostType>::SCHEMA],
            &|name| {
                from_template(
                    include_str!("tree_next.wgsl"),
                    &[
                        ("name", name),
                        ("nodes", nodes),
                        ("ids", ids),
                        ("NONE", &NONE.to_string()),
                        ("enter_leave", enter_leave),
                    ],
                )
            },
        );
        (start, next)
    }
}
