//! Queries in WGSL: the text around a primitive's recorded `intersect`.
//!
//! The contract is that of [`crate::bvh`]: the least `(t, id)` of all primitives whose
//! `intersect` accepts. Nodes are culled with the same robust slab test as on the CPU.

mod instances;
mod visit;

use std::borrow::Cow;

pub(crate) use instances::RecordedWalks;

use crate::bvh::{Cost, CountedHit, CountedHitOn, NODE_SCHEMA, SceneView, View, buffers};
use crate::geometry::{Hit, HitOn, HitRecord, Primitive, Ray, RayOn};
use crate::machine::record::ir::{self, Expr};
use crate::machine::record::{member_name, zero_value};
use crate::machine::wgsl::BufferKey;
use crate::machine::{B, Data, Recorder, Schema, Type, Value};

/// Whether a ray may hit anything: NaN and infinities are told by their bits, since WGSL lets an
/// implementation assume that there are none.
const FINITE: &str = "\
fn is_finite(v: vec3<f32>) -> bool {
    let exponent = bitcast<vec3<u32>>(v) & vec3<u32>(0x7f800000u);
    return all(exponent != vec3<u32>(0x7f800000u));
}
";

/// The slab test, shared by every tree.
const SLABS: &str = "\
/// Where a ray meets boxes: origins moved apart by the allowance for rounding, and finite
/// reciprocals of the direction.
struct Slabs {
    lower: vec3<f32>,
    upper: vec3<f32>,
    inverse: vec3<f32>,
}

fn finite_inverse(d: vec3<f32>) -> vec3<f32> {
    let a = abs(d);
    let largest = max(max(a.x, a.y), a.z);
    let least = max(largest * 8.6736174e-19, 1.1754944e-38);
    let safe = select(d, select(vec3<f32>(least), vec3<f32>(-least), d < vec3<f32>(0.0)), a < vec3<f32>(least));
    return 1.0 / safe;
}

fn slabs(ray: Ray, root: Node, slack: f32) -> Slabs {
    let reach = max(abs(root.min - ray.origin), abs(root.max - ray.origin));
    let pad = max(slack * max(max(reach.x, reach.y), reach.z), 1.1754944e-38) + abs(ray.origin) * 1.1920929e-7;
    return Slabs(ray.origin + pad, ray.origin - pad, finite_inverse(ray.direction));
}

/// The distances at which a ray enters and leaves a box.
fn enter_leave(s: Slabs, node: Node, t_min: f32, t_max: f32) -> vec2<f32> {
    let t0 = (node.min - s.lower) * s.inverse;
    let t1 = (node.max - s.upper) * s.inverse;
    let near = min(t0, t1);
    let far = max(t0, t1);
    return vec2<f32>(
        max(max(near.x, near.y), max(near.z, t_min)),
        min(min(far.x, far.y), min(far.z, t_max)),
    );
}
";

/// What the text of a query says of its scene: whatever the primitives are, the text is made in one
/// place.
pub(super) trait Described {
    /// The name of the buffer of primitives, which `m` gets.
    fn primitives(&self, m: &Recorder) -> String;
    fn slack(&self) -> f32;
    fn name(&self) -> Cow<'static, str>;
    fn key_of(&self, part: u32) -> BufferKey;
    fn is_list(&self) -> bool;
    fn has_tree(&self) -> bool;
    /// How many nodes and how many indices.
    fn tree_len(&self) -> (u64, u64);
    fn root_len(&self) -> u64;
    fn place_count(&self) -> u64;
}

impl<P: Primitive> Described for SceneView<'_, P> {
    fn primitives(&self, m: &Recorder) -> String {
        m.buffer_of(self)
    }
    fn slack(&self) -> f32 {
        P::SLACK
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
}

impl Recorder {
    /// `fn is_finite(v: vec3<f32>) -> bool`.
    pub(super) fn finite_function(&self) -> usize {
        self.text_function("is_finite".to_owned(), vec![], &|_| FINITE.to_owned())
    }

    /// Records `P::intersect`: the text before and behind its arguments, which gives a `Hit`.
    pub(super) fn intersect<P: Primitive>(&self, prims: &SceneView<'_, P>) -> (String, String) {
        let f = self.function_of(|m| {
            let prim = <P::On<Self>>::zero(m);
            P::intersect_among_on(m, prims.kinds(), prim, RayOn::zero(m), prims.shared())
        });
        let path = P::Hit::PATH.iter().map(|p| format!(".{}", member_name(p))).collect();
        (self.function_name(f), path)
    }

    /// What the least `(t, id)` hit does with a primitive that `call` meets, and the distance beyond
    /// which there is none.
    fn closest_text(
        &self,
        prims: &dyn Described,
        (intersect, path): &(String, String),
    ) -> (String, String) {
        let prims_name = prims.primitives(self);
        self.finite_function();
        let test = format!(
            "let candidate = {intersect}({prims_name}_at(id), ray){path};\n\
             if (candidate.is_hit && candidate.t >= ray.t_min && candidate.t <= ray.t_max\n    \
             && (!best.is_hit || candidate.t < best.t || (candidate.t == best.t && id < best.prim_id))) {{\n    \
             best = candidate;\n    best.prim_id = id;\n}}",
        );
        let limit = format!(
            "select(ray.t_max, min(best.t + abs(best.t) * {:?}, ray.t_max), best.is_hit)",
            prims.slack()
        );
        (test, limit)
    }

    /// The least `(t, id)` hit of a ray.
    pub(in crate::bvh::on) fn closest_hit<P: Primitive>(
        &self,
        prims: &SceneView<'_, P>,
        ray: RayOn<Self>,
    ) -> HitOn<Self> {
        if let Some(placed) = prims.placed() {
            return (RecordedWalks::of(placed).closest_hit)(self, prims, ray);
        }
        let function = self.closest_hit_function(prims);
        self.call_query(function, ray, Hit::SCHEMA)
    }

    /// The least `(t, id)` hit of a ray, and what it costs a ray that is alone.
    pub(in crate::bvh::on) fn closest_hit_with_cost<P: Primitive>(
        &self,
        prims: &SceneView<'_, P>,
        ray: RayOn<Self>,
    ) -> CountedHitOn<Self> {
        let function = match prims.placed() {
            Some(placed) => (RecordedWalks::of(placed).closest_hit_with_cost)(self, prims),
            None => self.closest_hit_with_cost_function(prims),
        };
        self.call_query(function, ray, CountedHit::SCHEMA)
    }

    /// Whether a ray hits anything.
    pub(in crate::bvh::on) fn any_hit<P: Primitive>(
        &self,
        prims: &SceneView<'_, P>,
        ray: RayOn<Self>,
    ) -> B<Self> {
        if let Some(placed) = prims.placed() {
            return (RecordedWalks::of(placed).any_hit)(self, prims, ray);
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
        self.buffer_of(prims);
        let call = self.intersect(prims);
        self.closest_function(prims, &call)
    }

    fn closest_function(&self, prims: &dyn Described, call: &(String, String)) -> usize {
        let prims_name = prims.primitives(self);
        let (test, limit) = self.closest_text(prims, call);
        let miss = zero_value(Hit::SCHEMA);
        let query = Query {
            result: "Hit",
            declare: &format!("var best = {miss};"),
            limit: &limit,
            test: &test,
            give: "best",
            slack: prims.slack(),
            counts: false,
        };
        if !prims.is_list() {
            return self.query_function(prims, format!("{prims_name}_closest_hit"), &query);
        }
        // One tree after another, each with the best hit so far.
        let each = Query { declare: "var best = before;", ..query };
        let each =
            self.tree_function(prims, format!("{prims_name}_closer_hit"), ", before: Hit", &each);
        self.list_function(prims, format!("{prims_name}_closest_hit"), &query, &|roots| {
            format!(
                "    var best = {miss};\n    \
                 for (var i = 0u; i < params.len_of_{roots}; i = i + 1u) {{\n        \
                 best = {each}(ray, {roots}_at(i), best);\n    }}\n    return best;\n"
            )
        })
    }

    /// The least `(t, id)` hit, with the nodes and primitives that are tested for it.
    fn closest_hit_with_cost_function<P: Primitive>(&self, prims: &SceneView<'_, P>) -> usize {
        self.buffer_of(prims);
        let call = self.intersect(prims);
        self.closest_with_cost_function(prims, &call)
    }

    fn closest_with_cost_function(&self, prims: &dyn Described, call: &(String, String)) -> usize {
        let prims_name = prims.primitives(self);
        let (test, limit) = self.closest_text(prims, call);
        let test = format!("cost.primitives = cost.primitives + 1u;\n{test}");
        let before = zero_value(CountedHit::SCHEMA);
        let declare = |before: &str| format!("var best = {before}.hit;\nvar cost = {before}.cost;");
        let query = Query {
            result: "CountedHit",
            declare: &declare(&before),
            limit: &limit,
            test: &test,
            give: "CountedHit(best, cost)",
            slack: prims.slack(),
            counts: true,
        };
        let name = format!("{prims_name}_closest_hit_with_cost");
        if !prims.is_list() {
            return self.query_function(prims, name, &query);
        }
        // One tree after another, each with the best hit so far, and with what that cost.
        let each = Query { declare: &declare("before"), ..query };
        let each_name = format!("{prims_name}_closer_hit_with_cost");
        let each = self.tree_function(prims, each_name, ", before: CountedHit", &each);
        self.list_function(prims, name, &query, &|roots| {
            format!(
                "    var best = {before};\n    \
                 for (var i = 0u; i < params.len_of_{roots}; i = i + 1u) {{\n        \
                 best = {each}(ray, {roots}_at(i), best);\n    }}\n    return best;\n"
            )
        })
    }

    fn any_hit_function<P: Primitive>(&self, prims: &SceneView<'_, P>) -> usize {
        self.buffer_of(prims);
        let call = self.intersect(prims);
        self.any_function(prims, &call)
    }

    fn any_function(&self, prims: &dyn Described, (intersect, path): &(String, String)) -> usize {
        let prims_name = prims.primitives(self);
        self.finite_function();
        let test = format!(
            "let candidate = {intersect}({prims_name}_at(id), ray){path};\n\
             if (candidate.is_hit && candidate.t >= ray.t_min && candidate.t <= ray.t_max) {{\n    \
             return true;\n}}",
        );
        let query = Query {
            result: "bool",
            declare: "",
            limit: "ray.t_max",
            test: &test,
            give: "false",
            slack: prims.slack(),
            counts: false,
        };
        if !prims.is_list() {
            return self.query_function(prims, format!("{prims_name}_any_hit"), &query);
        }
        let each = self.tree_function(prims, format!("{prims_name}_any_hit_in"), "", &query);
        self.list_function(prims, format!("{prims_name}_any_hit"), &query, &|roots| {
            format!(
                "    for (var i = 0u; i < params.len_of_{roots}; i = i + 1u) {{\n        \
                 if ({each}(ray, {roots}_at(i))) {{\n            return true;\n        }}\n    }}\n    \
                 return false;\n"
            )
        })
    }

    /// The function of a query of a slice, or of one tree.
    fn query_function(&self, prims: &dyn Described, name: String, query: &Query<'_>) -> usize {
        let (prims_name, tree) = (prims.primitives(self), self.tree(prims));
        self.text_function(name, types_of(query), &|name| match &tree {
            None => linear(name, query, &prims_name),
            Some(tree) => walk(name, "ray: Ray", ["0u", "ray.t_max"], query, tree),
        })
    }

    /// The function of a query of the tree at one of the roots: its name.
    fn tree_function(
        &self,
        prims: &dyn Described,
        name: String,
        more: &str,
        query: &Query<'_>,
    ) -> String {
        let Some(tree) = self.tree(prims) else { unreachable!("a list has trees") };
        let parameters = format!("ray: Ray, first: u32{more}");
        let function = self.text_function(name, types_of(query), &|name| {
            walk(name, &parameters, ["first", query.limit], query, &tree)
        });
        self.function_name(function)
    }

    /// The function of a query of a list, which asks one tree after another.
    fn list_function(
        &self,
        prims: &dyn Described,
        name: String,
        query: &Query<'_>,
        body: &dyn Fn(&str) -> String,
    ) -> usize {
        let roots = self.roots_buffer(prims);
        let result = query.result;
        self.text_function(name, types_of(query), &|name| {
            format!("fn {name}(ray: Ray) -> {result} {{\n{}}}\n", body(&roots))
        })
    }

    /// Where the roots of a list are among its nodes.
    pub(super) fn roots_buffer(&self, prims: &dyn Described) -> String {
        let name = format!("{}_roots", prims.name());
        self.buffer(prims.key_of(buffers::ROOTS), &name, &Schema::U32, prims.root_len())
    }

    /// The buffers of a tree, or of all trees of a list: nodes and index list. `None` for a slice.
    pub(super) fn tree(&self, prims: &dyn Described) -> Option<TreeNames> {
        if !prims.has_tree() {
            return None;
        }
        let name = prims.name();
        let (node_count, index_count) = prims.tree_len();
        let (nodes, indices) = (prims.key_of(buffers::NODES), prims.key_of(buffers::INDICES));
        let nodes = self.buffer(nodes, &format!("{name}_nodes"), NODE_SCHEMA, node_count);
        let indices = self.buffer(indices, &format!("{name}_ids"), &Schema::U32, index_count);
        self.text_function("slabs".to_owned(), vec![Ray::SCHEMA, NODE_SCHEMA], &|_| {
            SLABS.to_owned()
        });
        Some(TreeNames { nodes, indices })
    }
}

/// The types that the text of a query names.
fn types_of(query: &Query<'_>) -> Vec<&'static Schema> {
    let counted = query.counts.then_some([Cost::SCHEMA, CountedHit::SCHEMA]);
    [Ray::SCHEMA, Hit::SCHEMA, NODE_SCHEMA]
        .into_iter()
        .chain(counted.into_iter().flatten())
        .collect()
}

/// The names of a tree's buffers.
pub(super) struct TreeNames {
    pub(super) nodes: String,
    pub(super) indices: String,
}

fn indent(text: &str, by: usize) -> String {
    let pad = " ".repeat(by);
    text.lines().map(|l| format!("{pad}{l}\n")).collect()
}

/// What a query does with the primitives that it meets.
#[derive(Clone, Copy)]
struct Query<'a> {
    result: &'a str,
    declare: &'a str,
    /// No node beyond this distance is worth a visit.
    limit: &'a str,
    test: &'a str,
    give: &'a str,
    slack: f32,
    /// Whether the tests of nodes are counted, in `cost.nodes`.
    counts: bool,
}

impl Query<'_> {
    /// The line that counts `n` tests of nodes.
    fn count(&self, n: u32, indent: usize) -> String {
        if !self.counts {
            return String::new();
        }
        format!("{:indent$}cost.nodes = cost.nodes + {n}u;\n", "")
    }
}

fn linear(name: &str, query: &Query<'_>, prims: &str) -> String {
    let Query { result, declare, test, give, .. } = query;
    let declare = indent(declare, 4);
    let test = indent(test, 8);
    format!(
        "fn {name}(ray: Ray) -> {result} {{\n{declare}    \
         if (!(is_finite(ray.origin) && is_finite(ray.direction))) {{\n        \
         return {give};\n    }}\n    \
         for (var id = 0u; id < params.len_of_{prims}; id = id + 1u) {{\n{test}    }}\n    \
         return {give};\n}}\n"
    )
}

/// Depth-first from the node `first`, which the ray must enter before `end`; the nearer child
/// first, the farther one on a stack with its distance.
fn walk(
    name: &str,
    parameters: &str,
    [first, end]: [&str; 2],
    query: &Query<'_>,
    tree: &TreeNames,
) -> String {
    let Query { result, declare, limit, test, give, slack, .. } = query;
    let (root_count, child_count) = (query.count(1, 4), query.count(2, 12));
    let TreeNames { nodes, indices } = tree;
    let declare = indent(declare, 4);
    let test = indent(test, 16);
    format!(
        "\
fn {name}({parameters}) -> {result} {{
{declare}    if (params.len_of_{nodes} == 0u || !(is_finite(ray.origin) && is_finite(ray.direction))) {{
        return {give};
    }}
    var stack: array<u32, 64>;
    var stack_t: array<f32, 64>;
    var top = 0u;
    var node = {nodes}_at({first});
    let s = slabs(ray, node, {slack:?});
{root_count}    let root = enter_leave(s, node, ray.t_min, {end});
    if (!(root.x <= root.y)) {{
        return {give};
    }}
    loop {{
        if (node.count > 0u) {{
            for (var i = node.first; i < node.first + node.count; i = i + 1u) {{
                let id = {indices}_at(i);
{test}            }}
        }} else {{
            let left = {nodes}_at(node.first);
            let right = {nodes}_at(node.first + 1u);
            let limit = {limit};
{child_count}            let l = enter_leave(s, left, ray.t_min, limit);
            let r = enter_leave(s, right, ray.t_min, limit);
            let hit_left = l.x <= l.y;
            let hit_right = r.x <= r.y;
            if (hit_left && hit_right) {{
                let left_first = l.x <= r.x;
                stack[top] = select(node.first, node.first + 1u, left_first);
                stack_t[top] = select(l.x, r.x, left_first);
                top = top + 1u;
                if (left_first) {{ node = left; }} else {{ node = right; }}
                continue;
            }}
            if (hit_left) {{ node = left; continue; }}
            if (hit_right) {{ node = right; continue; }}
        }}
        // The next node on the stack that is not behind the best hit.
        var found = false;
        while (top > 0u && !found) {{
            top = top - 1u;
            found = stack_t[top] <= {limit};
        }}
        if (!found) {{
            break;
        }}
        node = {nodes}_at(stack[top]);
    }}
    return {give};
}}
"
    )
}
