//! Queries in WGSL around a primitive's recorded `intersect`.
//!
//! The rules of [`contract`](crate::bvh::contract) are recorded as functions that the text calls.

mod instances;
mod text;
mod visit;
mod wide;

use std::borrow::Cow;

pub(crate) use instances::RecordedQueries;
use text::{Query, linear, traverse};
use wide::WideNames;

use crate::bvh::contract::{
    Padding, SlabsOn, enter_leave, is_before, is_finite, is_within, limit_behind, slabs,
};
use crate::bvh::wide::COMPRESSED_SCHEMA;
use crate::bvh::wide::device::WideBuffers;
use crate::bvh::{Cost, CountedHit, CountedHitOn, NODE_SCHEMA, SceneView, View, buffers};
use crate::geometry::{Hit, HitOn, HitRecord, Primitive, Ray, RayOn};
use crate::machine::record::ir::{self, Expr};
use crate::machine::record::{member_name, zero_value};
use crate::machine::wgsl::BufferKey;
use crate::machine::{B, Data, F, Machine, Recorder, Schema, Type, V3, Value};

/// Description of a scene for the text of a query, independent of the type of primitives.
pub(super) trait Described {
    /// Returns the name of the buffer of primitives, and adds the buffer to `m`.
    fn primitives(&self, m: &Recorder) -> String;
    fn slack(&self) -> f32;
    fn name(&self) -> Cow<'static, str>;
    fn key_of(&self, part: u32) -> BufferKey;
    fn is_list(&self) -> bool;
    fn has_tree(&self) -> bool;
    /// Returns the number of nodes and of indices.
    fn tree_len(&self) -> (u64, u64);
    fn root_len(&self) -> u64;
    fn place_count(&self) -> u64;
    /// Returns the buffers of wide trees, if all trees are wide.
    fn wide_buffers(&self) -> Option<WideBuffers>;
}

impl<P: Primitive> Described for SceneView<'_, P> {
    fn primitives(&self, m: &Recorder) -> String {
        m.buffer_of(self)
    }
    fn slack(&self) -> f32 {
        Padding::among::<P>(self.kinds()).slack
    }
    fn name(&self) -> Cow<'static, str> {
        Data::name(self)
    }
    fn key_of(&self, part: u32) -> BufferKey {
        View::key_of(self, part)
    }
    fn is_list(&self) -> bool {
        View::is_list(self)
    }
    fn has_tree(&self) -> bool {
        View::has_tree(self)
    }
    fn tree_len(&self) -> (u64, u64) {
        View::tree_len(self)
    }
    fn root_len(&self) -> u64 {
        View::root_len(self)
    }
    fn place_count(&self) -> u64 {
        self.placed().map_or(0, |placed| placed.place_count())
    }
    fn wide_buffers(&self) -> Option<WideBuffers> {
        View::wide_buffers(self)
    }
}

impl Recorder {
    /// Returns the name of the function that `call` records.
    pub(super) fn name_of<R: Value<Self>>(&self, call: impl FnOnce(&Self) -> R) -> String {
        self.function_name(self.function_of(call))
    }

    /// Returns the names of the rules that the text calls.
    pub(super) fn rules(&self) -> Rules {
        let zero = |m: &Self| F(m.f32(0.0));
        Rules {
            is_finite: self.name_of(|m| is_finite::on(m, RayOn::zero(m))),
            is_within: self.name_of(|m| is_within::on(m, HitOn::zero(m), RayOn::zero(m))),
            is_before: self.is_before_name(false),
            limit_behind: self.name_of(|m| limit_behind::on(m, zero(m), zero(m), zero(m))),
        }
    }

    pub(super) fn is_before_name(&self, is_placed: bool) -> String {
        self.name_of(|m| is_before::on(m, is_placed, HitOn::zero(m), HitOn::zero(m)))
    }

    /// Returns the names of the box tests.
    pub(super) fn box_tests(&self, is_placed: bool) -> BoxTests {
        let zero = |m: &Self| F(m.f32(0.0));
        BoxTests {
            slabs: self.name_of(|m| {
                let (ray, corner) = (RayOn::zero(m), V3::zero(m));
                slabs::on(m, is_placed, ray, corner, corner, zero(m), zero(m))
            }),
            enter_leave: self.name_of(|m| {
                let (prepared, corner) = (SlabsOn::zero(m), V3::zero(m));
                enter_leave::on(m, prepared, corner, corner, zero(m), zero(m))
            }),
        }
    }

    /// Records `P::intersect`; returns the text before and after its arguments, which yields a
    /// `Hit`.
    pub(super) fn intersect<P: Primitive>(&self, prims: &SceneView<'_, P>) -> (String, String) {
        let f = self.function_of(|m| {
            let prim = <P::On<Self>>::zero(m);
            P::intersect_among_on(m, prims.kinds(), prim, RayOn::zero(m), prims.shared())
        });
        let path = P::Hit::PATH.iter().map(|p| format!(".{}", member_name(p))).collect();
        (self.function_name(f), path)
    }

    /// Returns the test of a candidate by the closest-hit query, and the statement that lowers the
    /// traversal's limit.
    fn closest_text(
        &self,
        prims: &dyn Described,
        searched: &Searched,
        (intersect, path): &(String, String),
    ) -> (String, String) {
        let Rules { is_within, is_before, limit_behind, .. } = self.rules();
        let Searched { primitive, id, .. } = searched;
        let candidate = format!("var candidate = {intersect}({primitive}, ray){path};");
        let test = match searched.structure {
            // Of the primitives of leaves few are hit, and of the others no id is read.
            Structure::Wide(_) => format!(
                "{candidate}\n\
                 if ({is_within}(candidate, ray)) {{\n    \
                 candidate.prim_id = {id};\n    \
                 if ({is_before}(candidate, best)) {{\n        \
                 best = candidate;\n        $lower\n    }}\n}}",
            ),
            _ => format!(
                "{candidate}\n\
                 candidate.prim_id = {id};\n\
                 if ({is_within}(candidate, ray) && {is_before}(candidate, best)) {{\n    \
                 best = candidate;\n    $lower\n}}",
            ),
        };
        (test, format!("limit = {limit_behind}(best.t, {:?}, ray.t_max);", prims.slack()))
    }

    /// Returns the least `(t, id)` hit of a ray.
    pub(in crate::bvh::on) fn closest_hit<P: Primitive>(
        &self,
        prims: &SceneView<'_, P>,
        ray: RayOn<Self>,
    ) -> HitOn<Self> {
        if let Some(placed) = prims.placed() {
            return (RecordedQueries::of(placed).closest_hit)(self, prims, ray);
        }
        let function = self.closest_hit_function(prims);
        self.call_query(function, ray, Hit::SCHEMA)
    }

    /// Returns the least `(t, id)` hit of a ray, with its cost in single-ray traversal.
    pub(in crate::bvh::on) fn closest_hit_with_cost<P: Primitive>(
        &self,
        prims: &SceneView<'_, P>,
        ray: RayOn<Self>,
    ) -> CountedHitOn<Self> {
        let function = match prims.placed() {
            Some(placed) => (RecordedQueries::of(placed).closest_hit_with_cost)(self, prims),
            None => self.closest_hit_with_cost_function(prims),
        };
        self.call_query(function, ray, CountedHit::SCHEMA)
    }

    /// Returns whether a ray hits anything.
    pub(in crate::bvh::on) fn any_hit<P: Primitive>(
        &self,
        prims: &SceneView<'_, P>,
        ray: RayOn<Self>,
    ) -> B<Self> {
        if let Some(placed) = prims.placed() {
            return (RecordedQueries::of(placed).any_hit)(self, prims, ray);
        }
        let function = self.any_hit_function(prims);
        self.call_query(function, ray, &Schema::Bool)
    }

    /// Calls the function of a query.
    fn call_query<V: Value<Self>>(
        &self,
        function: usize,
        ray: RayOn<Self>,
        schema: &'static Schema,
    ) -> V {
        let call = Expr::Call(function, vec![self.whole(ray)]);
        self.take_apart(self.add(call, ir::Type::of(schema)))
    }

    fn closest_hit_function<P: Primitive>(&self, prims: &SceneView<'_, P>) -> usize {
        let searched = self.searched(prims, true);
        let call = self.intersect(prims);
        self.closest_function(prims, &searched, &call, false)
    }

    /// Returns the function of the least `(t, id)` hit, which may count tested nodes and primitives.
    fn closest_function(
        &self,
        prims: &dyn Described,
        searched: &Searched,
        call: &(String, String),
        counts: bool,
    ) -> usize {
        let (mut test, lower) = self.closest_text(prims, searched, call);
        let of = &searched.name;
        let (schema, result, give, ending) = match counts {
            false => (Hit::SCHEMA, "Hit", "best", ""),
            true => (CountedHit::SCHEMA, "CountedHit", "CountedHit(best, cost)", "_with_cost"),
        };
        let miss = zero_value(schema);
        let declare = |before: &str| match counts {
            false => format!("var best = {before};"),
            true => format!("var best = {before}.hit;\nvar cost = {before}.cost;"),
        };
        if counts {
            test = format!("cost.primitives = cost.primitives + 1u;\n{test}");
        }
        let query = Query {
            result,
            declare: &declare(&miss),
            lower: &lower,
            test: &test,
            give,
            slack: prims.slack(),
            counts,
            continues: false,
        };
        let name = format!("{of}_closest_hit{ending}");
        if !prims.is_list() {
            return self.query_function(searched, name, &query);
        }
        // Query the trees in order, each with what was found so far.
        let each = Query { declare: &declare("before"), continues: true, ..query };
        let each_name = format!("{of}_closer_hit{ending}");
        let each = self.tree_function(searched, each_name, &format!(", before: {result}"), &each);
        self.list_function((prims, searched), name, &query, &|roots| {
            format!(
                "    var best = {miss};\n    \
                 for (var i = 0u; i < params.len_of_{roots}; i = i + 1u) {{\n        \
                 best = {each}(ray, {roots}_at(i), best);\n    }}\n    return best;\n"
            )
        })
    }

    /// Returns the function of the least `(t, id)` hit that counts tested nodes and primitives.
    fn closest_hit_with_cost_function<P: Primitive>(&self, prims: &SceneView<'_, P>) -> usize {
        // A wide tree has other nodes: what is counted are those of the binary one.
        let searched = self.searched(prims, false);
        let call = self.intersect(prims);
        self.closest_function(prims, &searched, &call, true)
    }

    fn any_hit_function<P: Primitive>(&self, prims: &SceneView<'_, P>) -> usize {
        let searched = self.searched(prims, true);
        let call = self.intersect(prims);
        self.any_function(prims, &searched, &call)
    }

    fn any_function(
        &self,
        prims: &dyn Described,
        searched: &Searched,
        (intersect, path): &(String, String),
    ) -> usize {
        let Searched { name: of, primitive, .. } = searched;
        let is_within = self.rules().is_within;
        let test = format!(
            "if ({is_within}({intersect}({primitive}, ray){path}, ray)) {{\n    \
             return true;\n}}",
        );
        let query = Query {
            result: "bool",
            declare: "",
            lower: "",
            test: &test,
            give: "false",
            slack: prims.slack(),
            counts: false,
            continues: false,
        };
        if !prims.is_list() {
            return self.query_function(searched, format!("{of}_any_hit"), &query);
        }
        let each = self.tree_function(searched, format!("{of}_any_hit_in"), "", &query);
        self.list_function((prims, searched), format!("{of}_any_hit"), &query, &|roots| {
            format!(
                "    for (var i = 0u; i < params.len_of_{roots}; i = i + 1u) {{\n        \
                 if ({each}(ray, {roots}_at(i))) {{\n            return true;\n        }}\n    }}\n    \
                 return false;\n"
            )
        })
    }

    /// Returns the function of a query of a slice, or of one tree.
    fn query_function(&self, searched: &Searched, name: String, query: &Query<'_>) -> usize {
        let is_finite = self.rules().is_finite;
        let structure = &searched.structure;
        self.text_function(name, types_of(query, structure), &|name| match structure {
            Structure::Nothing => linear(name, query, &searched.name, &is_finite),
            Structure::Binary(tree) => traverse(name, "ray: Ray", "0u", query, tree),
            Structure::Wide(tree) => tree.traverse(name, "ray: Ray", "0u", query),
        })
    }

    /// Returns the name of the function of a query of the tree at one of the roots.
    fn tree_function(
        &self,
        searched: &Searched,
        name: String,
        more: &str,
        query: &Query<'_>,
    ) -> String {
        let parameters = format!("ray: Ray, first: u32{more}");
        let structure = &searched.structure;
        let function =
            self.text_function(name, types_of(query, structure), &|name| match structure {
                Structure::Nothing => unreachable!("a list has trees"),
                Structure::Binary(tree) => traverse(name, &parameters, "first", query, tree),
                Structure::Wide(tree) => tree.traverse(name, &parameters, "first", query),
            });
        self.function_name(function)
    }

    /// Returns the function of a query of a list, tree by tree.
    fn list_function(
        &self,
        (prims, searched): (&dyn Described, &Searched),
        name: String,
        query: &Query<'_>,
        body: &dyn Fn(&str) -> String,
    ) -> usize {
        let roots = match &searched.structure {
            Structure::Wide(WideNames { roots: Some(roots), .. }) => roots.clone(),
            _ => self.roots_buffer(prims),
        };
        let result = query.result;
        self.text_function(name, types_of(query, &searched.structure), &|name| {
            format!("fn {name}(ray: Ray) -> {result} {{\n{}}}\n", body(&roots))
        })
    }

    /// Returns what a query of a slice, of a tree or of a list searches, and adds its buffers.
    fn searched(&self, prims: &dyn Described, may_be_wide: bool) -> Searched {
        if may_be_wide && let Some(wide) = self.wide(prims) {
            let WideNames { leaves, ids, .. } = &wide;
            return Searched {
                name: leaves.clone(),
                primitive: format!("{leaves}_at(i)"),
                id: format!("{ids}_at(i)"),
                structure: Structure::Wide(wide),
            };
        }
        let name = prims.primitives(self);
        Searched {
            primitive: format!("{name}_at(id)"),
            name,
            id: "id".to_owned(),
            structure: self.tree(prims).map_or(Structure::Nothing, Structure::Binary),
        }
    }

    /// Returns the buffer of the root indices of a list.
    pub(super) fn roots_buffer(&self, prims: &dyn Described) -> String {
        let name = format!("{}_roots", prims.name());
        self.buffer(prims.key_of(buffers::ROOTS), &name, &Schema::U32, prims.root_len())
    }

    /// Returns the buffers of a tree, or of all trees of a list: nodes and index list. `None` for a
    /// slice.
    pub(super) fn tree(&self, prims: &dyn Described) -> Option<TreeNames> {
        if !prims.has_tree() {
            return None;
        }
        let name = prims.name();
        let (node_count, index_count) = prims.tree_len();
        let (nodes, indices) = (prims.key_of(buffers::NODES), prims.key_of(buffers::INDICES));
        let nodes = self.buffer(nodes, &format!("{name}_nodes"), NODE_SCHEMA, node_count);
        let indices = self.buffer(indices, &format!("{name}_ids"), &Schema::U32, index_count);
        Some(TreeNames {
            nodes,
            indices,
            rules: self.rules(),
            boxes: self.box_tests(prims.place_count() > 0),
        })
    }
}

/// Returns the types that the text of a query names.
fn types_of(query: &Query<'_>, structure: &Structure) -> Vec<&'static Schema> {
    let counted = query.counts.then_some([Cost::SCHEMA, CountedHit::SCHEMA]);
    let node = match structure {
        Structure::Nothing => None,
        Structure::Binary(_) => Some(NODE_SCHEMA),
        Structure::Wide(_) => Some(COMPRESSED_SCHEMA),
    };
    [Ray::SCHEMA, Hit::SCHEMA]
        .into_iter()
        .chain(node)
        .chain(counted.into_iter().flatten())
        .collect()
}

/// What a query searches.
struct Searched {
    /// The prefix of its functions' names: the name of the buffer of primitives that it reads.
    name: String,
    /// The text of a candidate primitive, and of its id.
    primitive: String,
    id: String,
    structure: Structure,
}

/// How candidates are found.
enum Structure {
    /// All primitives are candidates.
    Nothing,
    Binary(TreeNames),
    Wide(WideNames),
}

/// Names of a tree's buffers, and of the functions that its traversals call.
pub(super) struct TreeNames {
    pub(super) nodes: String,
    pub(super) indices: String,
    pub(super) rules: Rules,
    pub(super) boxes: BoxTests,
}

/// Names of the functions of the [`contract`](crate::bvh::contract).
pub(super) struct Rules {
    pub(super) is_finite: String,
    pub(super) is_within: String,
    /// For hits without instances.
    pub(super) is_before: String,
    pub(super) limit_behind: String,
}

/// Names of the box tests.
pub(super) struct BoxTests {
    pub(super) slabs: String,
    pub(super) enter_leave: String,
}
