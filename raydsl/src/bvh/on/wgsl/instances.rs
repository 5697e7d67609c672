//! Traversal of instances in WGSL.
//!
//! One traversal visits groups and trees alike: all nodes lie in one buffer, and leaves hold
//! primitive ids or indices into the table of places. It returns the next primitive, as traversal
//! of a tree does, together with the ray in the space of its tree.

use super::visit::NONE;
use super::{BoxTests, Described, Rules, TreeNames};
use crate::bvh::contract::Slabs;
use crate::bvh::{
    Cost, CountedHit, IS_INSTANCE, MAX_LEVELS, NODE_SCHEMA, PLACE_SCHEMA, RecordOn, STACK,
    SceneView,
};
use crate::bvh::{Placed, View, any_where, buffers, closest_where};
use crate::geometry::{Hit, HitOn, Primitive, Ray, RayOn, Shared, transform_ray};
use crate::machine::record::ir::{Expr, Type};
use crate::machine::record::{from_template, zero_value};
use crate::machine::wgsl::BufferKey;
use crate::machine::{
    A3, B, Data, F, Field, KernelInfo, Loop, Machine, Recorder, Schema, Type as HostType, U, Value,
    op,
};

static CLOSEST: KernelInfo =
    KernelInfo { name: "closest_hit", file: file!(), line: line!(), params: &["ray"], known: None };
static ANY: KernelInfo =
    KernelInfo { name: "any_hit", file: file!(), line: line!(), params: &["ray"], known: None };

/// Number of saved levels: the groups, and the level around the outermost.
const LEVELS: usize = MAX_LEVELS + 1;

/// State of a traversal on one level.
pub(super) const LEVEL: &Schema = &Schema::Struct {
    name: "TraversalLevel",
    fields: &[
        Field { name: "ray", offset: 0, schema: Ray::SCHEMA },
        Field { name: "place", offset: 32, schema: &Schema::U32 },
        Field { name: "first", offset: 36, schema: &Schema::U32 },
        Field { name: "bottom", offset: 40, schema: &Schema::U32 },
    ],
    size: 44,
};

/// Members of the traversal state.
const TRAVERSAL: [Field; 11] = [
    Field { name: "here", offset: 0, schema: LEVEL },
    Field { name: "lower", offset: 44, schema: &Schema::Vector(&Schema::F32, 3) },
    Field { name: "upper", offset: 56, schema: &Schema::Vector(&Schema::F32, 3) },
    Field { name: "inverse", offset: 68, schema: &Schema::Vector(&Schema::F32, 3) },
    Field { name: "next", offset: 80, schema: &Schema::U32 },
    Field { name: "last", offset: 84, schema: &Schema::U32 },
    Field { name: "top", offset: 88, schema: &Schema::U32 },
    Field { name: "level", offset: 92, schema: &Schema::U32 },
    Field {
        name: "levels",
        offset: 96,
        schema: &Schema::Array { element: LEVEL, count: LEVELS, stride: 44 },
    },
    Field {
        name: "nodes",
        offset: 96 + 44 * LEVELS,
        schema: &Schema::Array { element: &Schema::U32, count: STACK, stride: 4 },
    },
    Field {
        name: "enters",
        offset: 96 + 44 * LEVELS + 4 * STACK,
        schema: &Schema::Array { element: &Schema::F32, count: STACK, stride: 4 },
    },
];
const TRAVERSAL_SIZE: usize = 96 + 44 * LEVELS + 8 * STACK;

/// Traversal state.
pub(super) const DESCENT: &Schema =
    &Schema::Struct { name: "InstanceTraversal", fields: &TRAVERSAL, size: TRAVERSAL_SIZE };

/// Traversal state with a count of tested nodes.
const COUNTED_DESCENT: &Schema = &Schema::Struct {
    name: "CountedInstanceTraversal",
    fields: &{
        let [a, b, c, d, e, f, g, h, i, j, k] = TRAVERSAL;
        let tested = Field { name: "tested", offset: TRAVERSAL_SIZE, schema: &Schema::U32 };
        [a, b, c, d, e, f, g, h, i, j, k, tested]
    },
    size: TRAVERSAL_SIZE + 4,
};

/// Kind of traversal: plain, or counting tested nodes.
#[derive(Clone, Copy, PartialEq)]
enum Traversal {
    Plain,
    Counted,
}

impl Traversal {
    /// Returns the schema of its state.
    fn schema(self) -> &'static Schema {
        match self {
            Self::Plain => DESCENT,
            Self::Counted => COUNTED_DESCENT,
        }
    }

    /// Returns the name of its type, and the suffix of its function names.
    fn names(self) -> [&'static str; 2] {
        match self {
            Self::Plain => ["InstanceTraversal", ""],
            Self::Counted => ["CountedInstanceTraversal", "_with_cost"],
        }
    }

    /// Returns the statement that counts `n` node tests.
    fn count(self, n: u32) -> String {
        match self {
            Self::Plain => String::new(),
            Self::Counted => format!("(*w).tested = (*w).tested + {n}u;"),
        }
    }
}

/// Candidate primitive that the ray may hit.
pub(super) const CANDIDATE: &Schema = &Schema::Struct {
    name: "NextPrimitive",
    fields: &[
        Field { name: "ray", offset: 0, schema: Ray::SCHEMA },
        Field { name: "id", offset: 32, schema: &Schema::U32 },
        Field { name: "inst", offset: 36, schema: &Schema::U32 },
    ],
    size: 40,
};

/// Recorded traversals of scenes of instances. Only constructors of such scenes refer to it: other
/// programs do not compile it.
pub(crate) struct RecordedQueries<P: Primitive> {
    pub(super) closest_hit: fn(&Recorder, &SceneView<'_, P>, RayOn<Recorder>) -> HitOn<Recorder>,
    /// The counting variant.
    pub(super) closest_hit_with_cost: fn(&Recorder, &SceneView<'_, P>) -> usize,
    pub(super) any_hit: fn(&Recorder, &SceneView<'_, P>, RayOn<Recorder>) -> B<Recorder>,
}

impl<P: Primitive> RecordedQueries<P> {
    pub(crate) const NEW: Self = Self {
        closest_hit: Recorder::closest_placed_hit::<P>,
        closest_hit_with_cost: Recorder::closest_placed_hit_with_cost::<P>,
        any_hit: Recorder::any_placed_hit::<P>,
    };

    pub(super) fn of<'a>(placed: &Placed<'a, P, P::Shared>) -> &'a Self {
        let found = placed.queries.iter().find_map(|queries| queries.downcast_ref());
        found.expect("instances know how they are recorded")
    }
}

impl Recorder {
    /// Returns the least `(t, inst_id, prim_id)` hit, from a WGSL function of its own.
    pub(super) fn closest_placed_hit<P: Primitive>(
        &self,
        prims: &SceneView<'_, P>,
        ray: RayOn<Self>,
    ) -> HitOn<Self> {
        self.call(&CLOSEST, (ray,), |m, (ray,)| closest_where(m, prims, ray, &|_| B(m.bool(true))))
    }

    /// Returns whether there is a hit, from a WGSL function of its own.
    pub(super) fn any_placed_hit<P: Primitive>(
        &self,
        prims: &SceneView<'_, P>,
        ray: RayOn<Self>,
    ) -> B<Self> {
        self.call(&ANY, (ray,), |m, (ray,)| any_where(m, prims, ray, &|_| B(m.bool(true))))
    }

    /// Returns the function of the least `(t, inst_id, prim_id)` hit that counts tested nodes and
    /// primitives.
    pub(super) fn closest_placed_hit_with_cost<P: Primitive>(
        &self,
        prims: &SceneView<'_, P>,
    ) -> usize {
        self.buffer_of(prims);
        let call = self.intersect(prims);
        self.placed_with_cost_function(prims, &call)
    }

    fn placed_with_cost_function(
        &self,
        prims: &dyn Described,
        (intersect, path): &(String, String),
    ) -> usize {
        let prims_name = prims.primitives(self);
        let (start, next) = self.descent_functions(prims, Traversal::Counted);
        let (start, next) = (self.function_name(start), self.function_name(next));
        let (_, places) = self.places_of(prims);
        let zero = zero_value(CountedHit::SCHEMA);
        let Rules { is_within, limit_behind, .. } = self.rules();
        let is_before = self.is_before_name(true);
        let types = vec![Ray::SCHEMA, Hit::SCHEMA, Cost::SCHEMA, CountedHit::SCHEMA];
        self.text_function(format!("{prims_name}_closest_hit_with_cost"), types, &|name| {
            from_template(
                include_str!("placed_closest_with_cost.wgsl"),
                &[
                    ("name", name),
                    ("places", &places),
                    ("zero", &zero),
                    ("start", &start),
                    ("next", &next),
                    ("NONE", &NONE.to_string()),
                    ("intersect", intersect),
                    ("prims_name", &prims_name),
                    ("path", path),
                    ("is_within", &is_within),
                    ("is_before", &is_before),
                    ("limit_behind", &limit_behind),
                ],
            )
        })
    }

    /// Records a loop over the hits of a scene of instances.
    pub(super) fn visit_placed<P: Primitive>(
        &self,
        prims: &SceneView<'_, P>,
        ray: RayOn<Self>,
        limit: &impl Fn() -> F<Self>,
        meet: &impl Fn(HitOn<Self>, RecordOn<Self, P>) -> B<Self>,
    ) {
        let (start, next) = self.descent_functions(prims, Traversal::Plain);
        let start = self.add(Expr::Call(start, vec![self.whole(ray)]), Type::Of(DESCENT));
        let traversal = self.declare("traversal", start, DESCENT);
        let repeat = Loop::new(self);
        loop {
            let traversal = self.add(Expr::Address(traversal), Type::Of(DESCENT));
            let found = self.add(Expr::Call(next, vec![traversal, limit().0]), Type::Of(CANDIDATE));
            self.pin(found, "next");
            let member = |name, ty| self.add(Expr::Member(found, name), ty);
            let (id, inst) = (member("id", Type::U32), member("inst", Type::U32));
            repeat.test(self, B(self.u32_compare(op::Ne, id, self.u32(NONE))));
            let local: RayOn<Self> = self.take_apart(member("ray", Type::of(Ray::SCHEMA)));
            self.ask(prims, local, [U(id), U(inst)], meet, &repeat);
            repeat.continuing(self);
            if !repeat.again(self) {
                break;
            }
        }
        repeat.end(self);
    }

    /// Returns `fn scene_places_at(i: u32) -> Place`, and the name of its buffer.
    fn places<T: HostType, S: Shared>(&self, scene: &View<'_, T, S>) -> (usize, String) {
        let len = scene.placed().map_or(0, |placed| placed.place_count());
        self.places_buffer(&Data::name(scene), scene.key_of(buffers::PLACES), len)
    }

    fn places_buffer(&self, scene: &str, key: BufferKey, len: u64) -> (usize, String) {
        let buffer = self.buffer(key, &format!("{scene}_places"), PLACE_SCHEMA, len);
        (self.at_function(&buffer, PLACE_SCHEMA), buffer)
    }

    fn places_of(&self, prims: &dyn Described) -> (usize, String) {
        self.places_buffer(&prims.name(), prims.key_of(buffers::PLACES), prims.place_count())
    }

    /// Returns the padding of the whole scene. It is a buffer value: it changes when instances
    /// move.
    pub(in crate::bvh::on) fn slack_of_places<P: Primitive>(
        &self,
        prims: &SceneView<'_, P>,
    ) -> F<Self> {
        let (at, _) = self.places(prims);
        let scene = self.add(Expr::Call(at, vec![self.u32(0)]), Type::Of(PLACE_SCHEMA));
        F(self.add(Expr::Member(scene, "slack"), Type::F32))
    }

    /// Returns the name of the function that transforms a ray to an object.
    fn transform_function(&self) -> String {
        let function = self.function_of(|m| {
            transform_ray::on(m, RayOn::zero(m), <A3<Self> as Value<Self>>::zero(m))
        });
        self.function_name(function)
    }

    /// Returns the ray in the space of an instance's tree.
    pub(in crate::bvh::on) fn local_ray_of<T: HostType, S: Shared>(
        &self,
        scene: &View<'_, T, S>,
        inst: U<Self>,
        ray: RayOn<Self>,
    ) -> RayOn<Self> {
        let transform = self.transform_function();
        let body = format!("ray = {transform}(ray, place.to_object);");
        let ray = self.whole(ray);
        let text = LevelsText {
            parameters: "inst: u32, of_scene: Ray",
            result: "Ray",
            variable: "ray",
            from: "of_scene",
            body: &body,
        };
        let function = self.levels_function(scene, "_local_ray", Ray::SCHEMA, &text);
        self.take_apart(self.add(Expr::Call(function, vec![inst.0, ray]), Type::of(Ray::SCHEMA)))
    }

    /// Returns the transform from the space of the scene to that of an instance's tree.
    pub(in crate::bvh::on) fn to_object_of<T: HostType, S: Shared>(
        &self,
        scene: &View<'_, T, S>,
        inst: U<Self>,
    ) -> A3<Self> {
        let schema: &'static Schema = <A3<Self> as Value<Self>>::SCHEMA;
        let product = self.function_of(|m| {
            let zero = <A3<Self> as Value<Self>>::zero(m);
            product::on(m, zero, zero)
        });
        let product = self.function_name(product);
        let body = format!("map = {product}(place.to_object, map);");
        let text = LevelsText {
            parameters: "inst: u32",
            result: "Affine3",
            variable: "map",
            from: "place.to_object",
            body: &body,
        };
        let function = self.levels_function(scene, "_to_object", schema, &text);
        self.take_apart(self.add(Expr::Call(function, vec![inst.0]), Type::of(schema)))
    }

    /// Returns a function that descends to an instance and runs `body` with the `place` on each
    /// level.
    fn levels_function<T: HostType, S: Shared>(
        &self,
        scene: &View<'_, T, S>,
        suffix: &str,
        result: &'static Schema,
        text: &LevelsText<'_>,
    ) -> usize {
        let LevelsText { parameters, result: name_of_result, variable, from, body } = text;
        let (_, places) = self.places(scene);
        let name = format!("{}{suffix}", self.buffer_of(scene));
        let types = vec![PLACE_SCHEMA, result];
        self.text_function(name, types, &|name| {
            from_template(
                include_str!("placed_levels.wgsl"),
                &[
                    ("name", name),
                    ("parameters", parameters),
                    ("name_of_result", name_of_result),
                    ("variable", variable),
                    ("from", from),
                    ("body", body),
                    ("places", &places),
                ],
            )
        })
    }

    /// Returns `fn scene_begin(ray: Ray) -> InstanceTraversal` and `fn scene_next(..) -> NextPrimitive`.
    fn descent_functions(&self, prims: &dyn Described, traversal: Traversal) -> (usize, usize) {
        let name = prims.primitives(self);
        let (_, places) = self.places_of(prims);
        let Some(tree) = self.tree(prims) else { unreachable!("instances are of trees") };
        let transform = self.transform_function();
        let [traversal_type, suffix] = traversal.names();
        let types = || {
            vec![
                Ray::SCHEMA,
                LEVEL,
                traversal.schema(),
                CANDIDATE,
                PLACE_SCHEMA,
                NODE_SCHEMA,
                Slabs::SCHEMA,
            ]
        };
        let enter = self.text_function(format!("{name}_enter{suffix}"), types(), &|name| {
            enter_text(name, &places, &tree, traversal)
        });
        let enter = self.function_name(enter);
        let start = self.text_function(format!("{name}_begin{suffix}"), types(), &|name| {
            from_template(
                include_str!("placed_begin.wgsl"),
                &[("name", name), ("traversal_type", traversal_type), ("enter", &enter)],
            )
        });
        let next = self.text_function(format!("{name}_next{suffix}"), types(), &|name| {
            next_text(name, &places, &tree, [&enter, &transform], traversal)
        });
        (start, next)
    }
}

/// Text of a function that follows the levels of an instance.
struct LevelsText<'a> {
    parameters: &'a str,
    result: &'a str,
    /// Result variable, and its initial value.
    variable: &'a str,
    from: &'a str,
    /// Statement run with the `place` on each level.
    body: &'a str,
}

fn enter_text(name: &str, places: &str, tree: &TreeNames, traversal: Traversal) -> String {
    let [traversal_type, _] = traversal.names();
    let TreeNames { nodes, rules, boxes, .. } = tree;
    let BoxTests { slabs, enter_leave } = boxes;
    from_template(
        include_str!("placed_enter.wgsl"),
        &[
            ("name", name),
            ("traversal_type", traversal_type),
            ("places", places),
            ("nodes", nodes),
            ("NONE", &NONE.to_string()),
            ("is_finite", &rules.is_finite),
            ("slabs", slabs),
            ("enter_leave", enter_leave),
            ("root_count", &traversal.count(1)),
        ],
    )
}

fn next_text(
    name: &str,
    places: &str,
    tree: &TreeNames,
    [enter, transform]: [&str; 2],
    traversal: Traversal,
) -> String {
    let [traversal_type, _] = traversal.names();
    let TreeNames { nodes, indices: ids, boxes: BoxTests { slabs, enter_leave }, .. } = tree;
    from_template(
        include_str!("placed_next.wgsl"),
        &[
            ("name", name),
            ("traversal_type", traversal_type),
            ("places", places),
            ("nodes", nodes),
            ("ids", ids),
            ("IS_INSTANCE", &IS_INSTANCE.to_string()),
            ("number", &(!IS_INSTANCE).to_string()),
            ("NONE", &NONE.to_string()),
            ("transform", transform),
            ("enter", enter),
            ("slabs", slabs),
            ("enter_leave", enter_leave),
            ("child_count", &traversal.count(2)),
        ],
    )
}

/// Composes two maps: `a` after `b`.
#[crate::kernel]
fn product(a: glam::Affine3, b: glam::Affine3) -> glam::Affine3 {
    a * b
}
