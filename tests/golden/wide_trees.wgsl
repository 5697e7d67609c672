struct Ray {
    origin: vec3<f32>,
    direction: vec3<f32>,
    t_min: f32,
    t_max: f32,
}

struct Hit {
    is_hit: bool,
    t: f32,
    prim_id: u32,
    inst_id: u32,
    u: f32,
    v: f32,
}

struct Slabs {
    lower: vec3<f32>,
    upper: vec3<f32>,
    inverse: vec3<f32>,
}

struct ColorSphere {
    center: vec3<f32>,
    radius: u32,
    color: array<u32, 3>,
}

struct CompressedNode {
    corner: vec3<f32>,
    exponents: u32,
    first_node: u32,
    first_leaf: u32,
    counts: u32,
    slots: u32,
    x: vec4<u32>,
    y: vec4<u32>,
    z: vec4<u32>,
}

struct Tuple {
    _0: u32,
    _1: bool,
}

struct Tuple_1 {
    _0: Ray,
}

struct StoredColorSphere {
    center: vec3<f32>,
    radius_color_0_color_1_color_2: u32,
}

struct StoredTuple_1 {
    arg0_origin: vec3<f32>,
    arg0_direction_x: f32,
    arg0_direction_y: f32,
    arg0_direction_z: f32,
    arg0_t_min: f32,
    arg0_t_max: f32,
}

struct StoredTuple {
    arg0: u32,
    arg1: u32,
}

struct Params {
    lit_255_0: f32,
    len_of_points_wide_nodes: u32,
    len_of_points_wide_roots: u32,
}

struct Job {
    size: vec2<u32>,
    first: vec2<u32>,
    count: vec2<u32>,
    base: u32,
    pad: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<uniform> job: Job;

@group(0) @binding(4) var<storage, read> points_wide_nodes: array<CompressedNode>;

fn points_wide_nodes_at(i: u32) -> CompressedNode {
    return points_wide_nodes[i];
}

@group(0) @binding(5) var<storage, read> points_leaves: array<StoredColorSphere>;

fn points_leaves_at(i: u32) -> ColorSphere {
    let s = points_leaves[i];
    return ColorSphere(s.center, s.radius_color_0_color_1_color_2 & 0xffu, array<u32, 3>((s.radius_color_0_color_1_color_2 >> 8u) & 0xffu, (s.radius_color_0_color_1_color_2 >> 16u) & 0xffu, (s.radius_color_0_color_1_color_2 >> 24u) & 0xffu));
}

@group(0) @binding(6) var<storage, read> points_leaf_ids: array<u32>;

fn points_leaf_ids_at(i: u32) -> u32 {
    return points_leaf_ids[i];
}

@group(0) @binding(7) var<storage, read> points_wide_roots: array<u32>;

fn points_wide_roots_at(i: u32) -> u32 {
    return points_wide_roots[i];
}

fn are_finite(v: vec3<f32>) -> bool {
    return (bitcast<u32>(v.x) & 2147483647u) < 2139095040u && (bitcast<u32>(v.y) & 2147483647u) < 2139095040u && (bitcast<u32>(v.z) & 2147483647u) < 2139095040u;
}

fn is_finite(ray: Ray) -> bool {
    return are_finite(ray.origin) && are_finite(ray.direction);
}

fn is_within(hit: Hit, ray: Ray) -> bool {
    return hit.is_hit && (hit.t >= ray.t_min && hit.t <= ray.t_max);
}

fn precedes(hit: Hit, other: Hit) -> bool {
    let is_first = hit.prim_id < other.prim_id;
    return hit.t < other.t || (hit.t == other.t && is_first);
}

fn is_before(hit: Hit, best: Hit) -> bool {
    return !best.is_hit || precedes(hit, best);
}

fn limit_behind(t: f32, slack: f32, t_max: f32) -> f32 {
    let t_1 = t + abs(t) * slack;
    return select(t_max, t_1, t_1 < t_max);
}

fn largest(v: vec3<f32>) -> f32 {
    return max(max(v.x, v.y), v.z);
}

fn negligible(d: vec3<f32>) -> f32 {
    return max(largest(abs(d)) * 8.6736174e-19f, 1.1754944e-38f);
}

fn at_least(x: f32, size: f32) -> f32 {
    let signed = select(size, -size, (x < 0.0f));
    return select(x, signed, (abs(x) < size));
}

fn finite_inverse(d: vec3<f32>) -> vec3<f32> {
    let least = negligible(d);
    return 1.0f / vec3<f32>(at_least(d.x, least), at_least(d.y, least), at_least(d.z, least));
}

fn slabs(ray: Ray, low: vec3<f32>, high: vec3<f32>, slack: f32, origin: f32) -> Slabs {
    let reach = max(abs(low - ray.origin), abs(high - ray.origin));
    let padding = max(slack * largest(reach), 1.1754944e-38f);
    let distant = abs(ray.origin);
    let padding_1 = distant * 1.1920929e-7f + padding;
    return Slabs(ray.origin + padding_1, ray.origin - padding_1, finite_inverse(ray.direction));
}

fn overlap(near: vec3<f32>, far: vec3<f32>, t_min: f32, t_max: f32) -> vec2<f32> {
    return vec2<f32>(max(max(near.x, near.y), max(t_min, near.z)), min(min(far.x, far.y), min(t_max, far.z)));
}

fn enter_leave(s: Slabs, low: vec3<f32>, high: vec3<f32>, t_min: f32, t_max: f32) -> vec2<f32> {
    let a = (low - s.lower) * s.inverse;
    let b = (high - s.upper) * s.inverse;
    return overlap(min(a, b), max(a, b), t_min, t_max);
}

fn cell_sizes(exponents: u32) -> vec3<f32> {
    return vec3<f32>(bitcast<f32>((exponents & 255u) << 23u), bitcast<f32>(((exponents >> 8u) & 255u) << 23u), bitcast<f32>(((exponents >> 16u) & 255u) << 23u));
}

fn Hit_new(is_hit: bool, t: f32) -> Hit {
    return Hit(is_hit, t, 0u, 0u, 0.0f, 0.0f);
}

fn intersect(ray: Ray, center: vec3<f32>, radius: f32) -> Hit {
    let f = center - ray.origin;
    let per_d2 = 1.0f / (ray.direction.x * ray.direction.x + ray.direction.y * ray.direction.y + ray.direction.z * ray.direction.z);
    let closest = (f.x * ray.direction.x + f.y * ray.direction.y + f.z * ray.direction.z) * per_d2;
    let aside = f - ray.direction * closest;
    let distance = sqrt(aside.x * aside.x + aside.y * aside.y + aside.z * aside.z);
    let radicand = (radius - distance) * (radius + distance);
    let half = sqrt(radicand * per_d2);
    let near = closest - half;
    let far = closest + half;
    let t = select(near, far, (near < ray.t_min));
    let is_hit = radicand >= 0.0f && radius > 0.0f && t >= ray.t_min && t <= ray.t_max;
    return Hit_new(is_hit, t);
}

fn ColorSphere_intersect(self_: ColorSphere, ray: Ray) -> Hit {
    return intersect(ray, self_.center, f32(self_.radius) / params.lit_255_0);
}

fn points_leaves_closer_hit(ray: Ray, first: u32, before: Hit) -> Hit {
    var best = before;
    var limit = ray.t_max;
    if (best.is_hit) {
        limit = limit_behind(best.t, 9.536743e-7, ray.t_max);
    }
    if (params.len_of_points_wide_nodes == 0u || !is_finite(ray)) {
        return best;
    }
    var stack: array<vec2<u32>, 8>;
    var top = 0u;
    var node = points_wide_nodes_at(first);
    let s = slabs(ray, node.corner, node.corner + 255.0 * cell_sizes(node.exponents), 9.536743e-7, 0.0);
    // Slots in the order in which the ray is likely to enter them: `i ^ octant` for i from 0 on.
    let backward = select(vec3<u32>(0u), vec3<u32>(1u, 2u, 4u), ray.direction < vec3<f32>(0.0));
    let octant = backward.x | backward.y | backward.z;
    loop {
        // In bits, the children that the ray enters, in its order (`slot ^ octant`): nodes, and above
        // them leaves.
        var found = 0u;
        let cells = cell_sizes(node.exponents);
        for (var slot = 0u; slot < 8u; slot = slot + 1u) {
            // The planes of four boxes are bytes of a word.
            let is_second = slot > 3u;
            let x = select(node.x.xz, node.x.yw, is_second);
            let y = select(node.y.xz, node.y.yw, is_second);
            let z = select(node.z.xz, node.z.yw, is_second);
            let shift = vec3<u32>(8u * (slot & 3u));
            // CPUs, as of lavapipe, convert signed integers faster.
            let lower = vec3<i32>((vec3<u32>(x.x, y.x, z.x) >> shift) & vec3<u32>(255u));
            let upper = vec3<i32>((vec3<u32>(x.y, y.y, z.y) >> shift) & vec3<u32>(255u));
            let low = node.corner + vec3<f32>(lower) * cells;
            let high = node.corner + vec3<f32>(upper) * cells;
            let e = enter_leave(s, low, high, ray.t_min, limit);
            let bits = ((node.slots >> slot) & 0x101u) << (slot ^ octant);
            found = found | select(0u, bits, e.x <= e.y);
        }
        let inner = found & 255u;
        var leaves = found >> 8u;
        while (leaves != 0u) {
            let slot = firstTrailingBit(leaves) ^ octant;
            leaves = leaves & (leaves - 1u);
            // The sum of the counts of the slots before.
            let before = node.counts & ((1u << (4u * slot)) - 1u);
            let pairs = (before & 0x0f0f0f0fu) + ((before >> 4u) & 0x0f0f0f0fu);
            let begin = node.first_leaf + ((pairs * 0x01010101u) >> 24u);
            let end = begin + ((node.counts >> (4u * slot)) & 15u);
            for (var i = begin; i < end; i = i + 1u) {
                var candidate = ColorSphere_intersect(points_leaves_at(i), ray);
                if (is_within(candidate, ray)) {
                    candidate.prim_id = points_leaf_ids_at(i);
                    if (is_before(candidate, best)) {
                        best = candidate;
                        limit = limit_behind(best.t, 9.536743e-7, ray.t_max);
                    }
                }
            }
        }
        // The children that are left of a node: the first of them all, and in bits those that the ray
        // enters and, above, all slots of nodes.
        var group = vec2<u32>(node.first_node, inner | (node.slots << 8u));
        if (inner == 0u) {
            if (top == 0u) {
                break;
            }
            top = top - 1u;
            group = stack[top];
        }
        let slot = firstTrailingBit(group.y) ^ octant;
        group.y = group.y & (group.y - 1u);
        if ((group.y & 255u) != 0u) {
            stack[top] = group;
            top = top + 1u;
        }
        node = points_wide_nodes_at(group.x + countOneBits((group.y >> 8u) & ((1u << slot) - 1u)));
    }
    return best;
}

fn points_leaves_closest_hit(ray: Ray) -> Hit {
    var best = Hit();
    for (var i = 0u; i < params.len_of_points_wide_roots; i = i + 1u) {
        best = points_leaves_closer_hit(ray, points_wide_roots_at(i), best);
    }
    return best;
}

fn Ray_at(self_: Ray, t: f32) -> vec3<f32> {
    return self_.origin + self_.direction * t;
}

fn Ray_new(origin: vec3<f32>, direction: vec3<f32>) -> Ray {
    return Ray(origin, direction, 0.0f, 340282346638528859811704183484516925440.0f);
}

fn points_leaves_any_hit_in(ray: Ray, first: u32) -> bool {
    let limit = ray.t_max;
    if (params.len_of_points_wide_nodes == 0u || !is_finite(ray)) {
        return false;
    }
    var stack: array<vec2<u32>, 8>;
    var top = 0u;
    var node = points_wide_nodes_at(first);
    let s = slabs(ray, node.corner, node.corner + 255.0 * cell_sizes(node.exponents), 9.536743e-7, 0.0);
    // Slots in the order in which the ray is likely to enter them: `i ^ octant` for i from 0 on.
    let backward = select(vec3<u32>(0u), vec3<u32>(1u, 2u, 4u), ray.direction < vec3<f32>(0.0));
    let octant = backward.x | backward.y | backward.z;
    loop {
        // In bits, the children that the ray enters, in its order (`slot ^ octant`): nodes, and above
        // them leaves.
        var found = 0u;
        let cells = cell_sizes(node.exponents);
        for (var slot = 0u; slot < 8u; slot = slot + 1u) {
            // The planes of four boxes are bytes of a word.
            let is_second = slot > 3u;
            let x = select(node.x.xz, node.x.yw, is_second);
            let y = select(node.y.xz, node.y.yw, is_second);
            let z = select(node.z.xz, node.z.yw, is_second);
            let shift = vec3<u32>(8u * (slot & 3u));
            // CPUs, as of lavapipe, convert signed integers faster.
            let lower = vec3<i32>((vec3<u32>(x.x, y.x, z.x) >> shift) & vec3<u32>(255u));
            let upper = vec3<i32>((vec3<u32>(x.y, y.y, z.y) >> shift) & vec3<u32>(255u));
            let low = node.corner + vec3<f32>(lower) * cells;
            let high = node.corner + vec3<f32>(upper) * cells;
            let e = enter_leave(s, low, high, ray.t_min, limit);
            let bits = ((node.slots >> slot) & 0x101u) << (slot ^ octant);
            found = found | select(0u, bits, e.x <= e.y);
        }
        let inner = found & 255u;
        var leaves = found >> 8u;
        while (leaves != 0u) {
            let slot = firstTrailingBit(leaves) ^ octant;
            leaves = leaves & (leaves - 1u);
            // The sum of the counts of the slots before.
            let before = node.counts & ((1u << (4u * slot)) - 1u);
            let pairs = (before & 0x0f0f0f0fu) + ((before >> 4u) & 0x0f0f0f0fu);
            let begin = node.first_leaf + ((pairs * 0x01010101u) >> 24u);
            let end = begin + ((node.counts >> (4u * slot)) & 15u);
            for (var i = begin; i < end; i = i + 1u) {
                if (is_within(ColorSphere_intersect(points_leaves_at(i), ray), ray)) {
                    return true;
                }
            }
        }
        // The children that are left of a node: the first of them all, and in bits those that the ray
        // enters and, above, all slots of nodes.
        var group = vec2<u32>(node.first_node, inner | (node.slots << 8u));
        if (inner == 0u) {
            if (top == 0u) {
                break;
            }
            top = top - 1u;
            group = stack[top];
        }
        let slot = firstTrailingBit(group.y) ^ octant;
        group.y = group.y & (group.y - 1u);
        if ((group.y & 255u) != 0u) {
            stack[top] = group;
            top = top + 1u;
        }
        node = points_wide_nodes_at(group.x + countOneBits((group.y >> 8u) & ((1u << slot) - 1u)));
    }
    return false;
}

fn points_leaves_any_hit(ray: Ray) -> bool {
    for (var i = 0u; i < params.len_of_points_wide_roots; i = i + 1u) {
        if (points_leaves_any_hit_in(ray, points_wide_roots_at(i))) {
            return true;
        }
    }
    return false;
}

fn kernel(ray: Ray) -> Tuple {
    let hit = points_leaves_closest_hit(ray);
    let up = Ray_new(Ray_at(ray, hit.t), vec3<f32>(0.0f, 1.0f, 0.0f));
    var both: bool;
    if (hit.is_hit) {
        both = points_leaves_any_hit(up);
    } else {
        both = false;
    }
    return Tuple(hit.prim_id, both);
}

fn element(input: Tuple_1) -> Tuple {
    return kernel(input._0);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple_1>;
@group(0) @binding(3) var<storage, read_write> outputs: array<StoredTuple>;

fn load_input(i: u32) -> Tuple_1 {
    let s = inputs[i];
    return Tuple_1(Ray(s.arg0_origin, vec3<f32>(s.arg0_direction_x, s.arg0_direction_y, s.arg0_direction_z), s.arg0_t_min, s.arg0_t_max));
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = StoredTuple(result._0, (select(0u, 1u, result._1)));
}
