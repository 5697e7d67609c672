struct Hit {
    is_hit: bool,
    t: f32,
    prim_id: u32,
    inst_id: u32,
    u: f32,
    v: f32,
}

struct Ray {
    origin: vec3<f32>,
    direction: vec3<f32>,
    t_min: f32,
    t_max: f32,
}

struct Lost {
    most: vec3<f32>,
    rest: vec3<f32>,
}

struct IndexedTriangle {
    vertices: array<u32, 3>,
}

struct Slabs {
    lower: vec3<f32>,
    upper: vec3<f32>,
    inverse: vec3<f32>,
}

struct Node {
    min: vec3<f32>,
    first: u32,
    max: vec3<f32>,
    count: u32,
}

struct Traversal {
    lower: vec3<f32>,
    upper: vec3<f32>,
    inverse: vec3<f32>,
    top: u32,
    next: u32,
    last: u32,
    nodes: array<u32, 64>,
    enters: array<f32, 64>,
}

struct Tuple {
    _0: f32,
    _1: f32,
    _2: bool,
}

struct Tuple_1 {
    _0: Ray,
}

struct StoredIndexedTriangle {
    vertices_0: u32,
    vertices_1: u32,
    vertices_2: u32,
}

struct StoredVec3 {
    value_x: f32,
    value_y: f32,
    value_z: f32,
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
    arg0: f32,
    arg1: f32,
    arg2: u32,
}

struct Params {
    lit_4097_0: f32,
    len_of_meshes_nodes: u32,
    len_of_meshes_shared: u32,
    len_of_meshes_roots: u32,
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

@group(0) @binding(4) var<storage, read> meshes: array<StoredIndexedTriangle>;

fn meshes_at(i: u32) -> IndexedTriangle {
    let s = meshes[i];
    return IndexedTriangle(array<u32, 3>(s.vertices_0, s.vertices_1, s.vertices_2));
}

@group(0) @binding(5) var<storage, read> meshes_nodes: array<Node>;

fn meshes_nodes_at(i: u32) -> Node {
    return meshes_nodes[i];
}

@group(0) @binding(6) var<storage, read> meshes_ids: array<u32>;

fn meshes_ids_at(i: u32) -> u32 {
    return meshes_ids[i];
}

@group(0) @binding(7) var<storage, read> meshes_shared: array<StoredVec3>;

fn meshes_shared_at(i: u32) -> vec3<f32> {
    let s = meshes_shared[i];
    return vec3<f32>(s.value_x, s.value_y, s.value_z);
}

/// The last element stands for those out of range.
fn meshes_shared_element(i: u32) -> vec3<f32> {
    return meshes_shared_at(min(i, max(params.len_of_meshes_shared, 1u) - 1u));
}

@group(0) @binding(8) var<storage, read> meshes_roots: array<u32>;

fn meshes_roots_at(i: u32) -> u32 {
    return meshes_roots[i];
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

fn axis_last(v: vec3<f32>, k: u32) -> vec3<f32> {
    let x = select(v.x, v.z, (k == 0u));
    let y = select(v.y, v.z, (k == 1u));
    let z = select(select(v.z, v.y, (k == 1u)), v.x, (k == 0u));
    return vec3<f32>(x, y, z);
}

fn is_inside(sides: vec3<f32>) -> bool {
    let t = select(sides.x, sides.y, sides.y < sides.x);
    let least = select(t, sides.z, sides.z < t);
    let t_1 = select(sides.x, sides.y, sides.x < sides.y);
    let greatest = select(t_1, sides.z, t_1 < sides.z);
    return least >= 0.0f || greatest <= 0.0f;
}

fn Hit_new(is_hit: bool, t: f32) -> Hit {
    return Hit(is_hit, t, 0u, 0u, 0.0f, 0.0f);
}

fn Hit_miss() -> Hit {
    return Hit_new(false, 0.0f);
}

fn kept(a: vec3<f32>) -> vec3<f32> {
    let t = vec3<f32>(340282346638528859811704183484516925440.0f);
    return select(a, t, t < a);
}

fn upper_half(a: vec3<f32>) -> vec3<f32> {
    let wide = a * params.lit_4097_0;
    return wide - kept(wide - a);
}

fn lost_by_product(a: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    let a_high = upper_half(a);
    let b_high = upper_half(b);
    let a_low = a - a_high;
    let b_low = b - b_high;
    return a_high * b_high - a * b + a_high * b_low + a_low * b_high + a_low * b_low;
}

fn lost_by_difference(a: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    let difference = kept(a - b);
    let part = kept(a - difference);
    let rest = difference + part;
    return a - rest + (part - b);
}

fn lost_by_cross(a: vec3<f32>, b: vec3<f32>) -> Lost {
    let lost = lost_by_product(a.yzx, b.zxy);
    let lost_too = lost_by_product(a.zxy, b.yzx);
    return Lost(lost - lost_too, lost_by_difference(lost, lost_too));
}

fn exact_cross(a: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    let lost = lost_by_cross(a, b);
    return kept(kept(vec3<f32>(a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y)) + lost.most) + lost.rest;
}

fn is_line(v0: vec3<f32>, v1: vec3<f32>, v2: vec3<f32>) -> bool {
    let lost = abs(lost_by_difference(v1, v0)) + abs(lost_by_difference(v2, v0));
    let lost_1 = lost + abs(exact_cross(v1 - v0, v2 - v0));
    return lost_1.x + lost_1.y + lost_1.z == 0.0f;
}

fn intersect(ray: Ray, v0: vec3<f32>, v1: vec3<f32>, v2: vec3<f32>) -> Hit {
    let ax = abs(ray.direction.x);
    let ay = abs(ray.direction.y);
    let az = abs(ray.direction.z);
    let k = select(select(2u, 1u, (ay > az)), 0u, (ax > ay && ax > az));
    let d = axis_last(ray.direction, k);
    let a = axis_last(v0 - ray.origin, k);
    let b = axis_last(v1 - ray.origin, k);
    let c = axis_last(v2 - ray.origin, k);
    let sx = d.x / d.z;
    let sy = d.y / d.z;
    let a_x = a.x - sx * a.z;
    let a_y = a.y - sy * a.z;
    let b_x = b.x - sx * b.z;
    let b_y = b.y - sy * b.z;
    let c_x = c.x - sx * c.z;
    let c_y = c.y - sy * c.z;
    var sides: vec3<f32> = vec3<f32>(b_y * c_x - b_x * c_y, c_y * a_x - c_x * a_y, a_y * b_x - a_x * b_y);
    if (!is_inside(sides)) {
        return Hit_miss();
    }
    let t = select(a_x, b_x, b_x < a_x);
    let left = select(t, c_x, c_x < t);
    let t_1 = select(a_x, b_x, a_x < b_x);
    let right = select(t_1, c_x, t_1 < c_x);
    let t_2 = select(a_y, b_y, b_y < a_y);
    let low = select(t_2, c_y, c_y < t_2);
    let t_3 = select(a_y, b_y, a_y < b_y);
    let high = select(t_3, c_y, t_3 < c_y);
    let between = left <= 0.0f && right >= 0.0f && low <= 0.0f && high >= 0.0f;
    if (!between) {
        return Hit_miss();
    }
    var sum: f32 = sides.x + sides.y + sides.z;
    let t_4 = select(a.z, b.z, b.z < a.z);
    let near = select(t_4, c.z, c.z < t_4);
    let t_5 = select(a.z, b.z, a.z < b.z);
    let far = select(t_5, c.z, t_5 < c.z);
    let products = abs(c_x * b_y) + abs(a_x * c_y) + abs(b_x * a_y);
    let t_6 = abs(near);
    let t_7 = abs(far);
    if (2.0f * abs(sum) <= products * ((far - near) / select(t_6, t_7, t_6 < t_7))) {
        var scale: f32;
        if (products < 8.6736174e-19f) {
            scale = 1.1529215e18f;
        } else {
            scale = 1.0f;
        }
        sides = exact_cross(vec3<f32>(a_y, b_y, c_y) * scale, vec3<f32>(a_x, b_x, c_x) * scale);
        sum = select(0.0f, sides.x + sides.y + sides.z, is_inside(sides));
    }
    if (sum == 0.0f) {
        return Hit_miss();
    }
    let u = sides.x / sum;
    let v = sides.y / sum;
    let w = sides.z / sum;
    let t_8 = (u * a.z + v * b.z + w * c.z) * (1.0f / d.z);
    let t_9 = v1 - v0;
    let t_10 = v2 - v0;
    let is_flat = t_9.y * t_10.z - t_10.y * t_9.z == 0.0f && t_9.z * t_10.x - t_10.z * t_9.x == 0.0f && t_9.x * t_10.y - t_10.x * t_9.y == 0.0f;
    var both: bool;
    if (is_flat) {
        both = is_line(v0, v1, v2);
    } else {
        both = false;
    }
    let is_surface = !both;
    let is_hit = is_surface && t_8 >= ray.t_min && t_8 <= ray.t_max;
    let t_11 = Hit_new(is_hit, t_8);
    return Hit(t_11.is_hit, t_11.t, t_11.prim_id, t_11.inst_id, v, w);
}

fn IndexedTriangle_intersect(self_: IndexedTriangle, ray: Ray) -> Hit {
    return intersect(ray, meshes_shared_element(self_.vertices[0]), meshes_shared_element(self_.vertices[1]), meshes_shared_element(self_.vertices[2]));
}

fn are_finite(v: vec3<f32>) -> bool {
    return (bitcast<u32>(v.x) & 2147483647u) < 2139095040u && (bitcast<u32>(v.y) & 2147483647u) < 2139095040u && (bitcast<u32>(v.z) & 2147483647u) < 2139095040u;
}

fn is_finite(ray: Ray) -> bool {
    return are_finite(ray.origin) && are_finite(ray.direction);
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

fn meshes_closer_hit(ray: Ray, first: u32, before: Hit) -> Hit {
    var best = before;
    var limit = ray.t_max;
    if (best.is_hit) {
        limit = limit_behind(best.t, 9.536743e-7, ray.t_max);
    }
    if (params.len_of_meshes_nodes == 0u || !is_finite(ray)) {
        return best;
    }
    var stack: array<u32, 64>;
    var stack_t: array<f32, 64>;
    var top = 0u;
    var node = meshes_nodes_at(first);
    let s = slabs(ray, node.min, node.max, 9.536743e-7, 0.0);
    let root = enter_leave(s, node.min, node.max, ray.t_min, limit);
    if (!(root.x <= root.y)) {
        return best;
    }
    loop {
        if (node.count > 0u) {
            for (var i = node.first; i < node.first + node.count; i = i + 1u) {
                let id = meshes_ids_at(i);
                var candidate = IndexedTriangle_intersect(meshes_at(id), ray);
                candidate.prim_id = id;
                if (is_within(candidate, ray) && is_before(candidate, best)) {
                    best = candidate;
                    limit = limit_behind(best.t, 9.536743e-7, ray.t_max);
                }
            }
        } else {
            let left = meshes_nodes_at(node.first);
            let right = meshes_nodes_at(node.first + 1u);
            let l = enter_leave(s, left.min, left.max, ray.t_min, limit);
            let r = enter_leave(s, right.min, right.max, ray.t_min, limit);
            let hit_left = l.x <= l.y;
            let hit_right = r.x <= r.y;
            if (hit_left && hit_right) {
                let left_first = l.x <= r.x;
                stack[top] = select(node.first, node.first + 1u, left_first);
                stack_t[top] = select(l.x, r.x, left_first);
                top = top + 1u;
                if (left_first) { node = left; } else { node = right; }
                continue;
            }
            if (hit_left) { node = left; continue; }
            if (hit_right) { node = right; continue; }
        }
        // The next node on the stack that is not beyond the limit.
        var found = false;
        while (top > 0u && !found) {
            top = top - 1u;
            found = stack_t[top] <= limit;
        }
        if (!found) {
            break;
        }
        node = meshes_nodes_at(stack[top]);
    }
    return best;
}

fn meshes_closest_hit(ray: Ray) -> Hit {
    var best = Hit();
    for (var i = 0u; i < params.len_of_meshes_roots; i = i + 1u) {
        best = meshes_closer_hit(ray, meshes_roots_at(i), best);
    }
    return best;
}

fn meshes_roots_len() -> u32 {
    return params.len_of_meshes_roots;
}

/// A traversal that has yet to begin.
fn meshes_begin(ray: Ray, first: u32) -> Traversal {
    var w = Traversal();
    if (params.len_of_meshes_nodes == 0u || !is_finite(ray)) {
        return w;
    }
    let node = meshes_nodes_at(first);
    let s = slabs(ray, node.min, node.max, 9.536743e-7, 0.0);
    w.lower = s.lower;
    w.upper = s.upper;
    w.inverse = s.inverse;
    let enter = enter_leave(s, node.min, node.max, ray.t_min, ray.t_max);
    w.nodes[0] = first;
    w.enters[0] = enter.x;
    w.top = select(0u, 1u, enter.x <= enter.y);
    return w;
}

/// The next primitive that the ray may meet at or before `limit`; 4294967295u when none is left.
fn meshes_next(w: ptr<function, Traversal>, t_min: f32, limit: f32) -> u32 {
    loop {
        if ((*w).next < (*w).last) {
            (*w).next = (*w).next + 1u;
            return meshes_ids_at((*w).next - 1u);
        }
        // The next node on the stack that is not beyond the limit.
        var found = false;
        while ((*w).top > 0u && !found) {
            (*w).top = (*w).top - 1u;
            found = (*w).enters[(*w).top] <= limit;
        }
        if (!found) {
            break;
        }
        var node = meshes_nodes_at((*w).nodes[(*w).top]);
        let s = Slabs((*w).lower, (*w).upper, (*w).inverse);
        // Down to a leaf, the nearer child first.
        while (node.count == 0u) {
            let left = meshes_nodes_at(node.first);
            let right = meshes_nodes_at(node.first + 1u);
            let l = enter_leave(s, left.min, left.max, t_min, limit);
            let r = enter_leave(s, right.min, right.max, t_min, limit);
            let hit_left = l.x <= l.y;
            let hit_right = r.x <= r.y;
            if (!hit_left && !hit_right) {
                break;
            }
            let left_first = hit_left && (!hit_right || l.x <= r.x);
            if (hit_left && hit_right) {
                (*w).nodes[(*w).top] = select(node.first, node.first + 1u, left_first);
                (*w).enters[(*w).top] = select(l.x, r.x, left_first);
                (*w).top = (*w).top + 1u;
            }
            if (left_first) { node = left; } else { node = right; }
        }
        (*w).next = node.first;
        (*w).last = node.first + node.count;
    }
    return 4294967295u;
}

fn meshes_any_hit_in(ray: Ray, first: u32) -> bool {
    let limit = ray.t_max;
    if (params.len_of_meshes_nodes == 0u || !is_finite(ray)) {
        return false;
    }
    var stack: array<u32, 64>;
    var top = 0u;
    var node = meshes_nodes_at(first);
    let s = slabs(ray, node.min, node.max, 9.536743e-7, 0.0);
    let root = enter_leave(s, node.min, node.max, ray.t_min, limit);
    if (!(root.x <= root.y)) {
        return false;
    }
    loop {
        if (node.count > 0u) {
            for (var i = node.first; i < node.first + node.count; i = i + 1u) {
                let id = meshes_ids_at(i);
                if (is_within(IndexedTriangle_intersect(meshes_at(id), ray), ray)) {
                    return true;
                }
            }
        } else {
            let left = meshes_nodes_at(node.first);
            let right = meshes_nodes_at(node.first + 1u);
            let l = enter_leave(s, left.min, left.max, ray.t_min, limit);
            let r = enter_leave(s, right.min, right.max, ray.t_min, limit);
            let hit_left = l.x <= l.y;
            let hit_right = r.x <= r.y;
            if (hit_left && hit_right) {
                let left_first = l.x <= r.x;
                stack[top] = select(node.first, node.first + 1u, left_first);
                top = top + 1u;
                if (left_first) { node = left; } else { node = right; }
                continue;
            }
            if (hit_left) { node = left; continue; }
            if (hit_right) { node = right; continue; }
        }
        if (top == 0u) {
            break;
        }
        top = top - 1u;
        node = meshes_nodes_at(stack[top]);
    }
    return false;
}

fn meshes_any_hit(ray: Ray) -> bool {
    for (var i = 0u; i < params.len_of_meshes_roots; i = i + 1u) {
        if (meshes_any_hit_in(ray, meshes_roots_at(i))) {
            return true;
        }
    }
    return false;
}

fn kernel(ray: Ray) -> Tuple {
    let near = meshes_closest_hit(ray);
    var hits_0_is_hit: bool = false;
    var hits_0_t: f32 = 0.0f;
    var hits_0_prim_id: u32 = 0u;
    var hits_0_u: f32 = 0.0f;
    var hits_0_v: f32 = 0.0f;
    var tree: u32 = 0u;
    for (; tree < meshes_roots_len(); tree = tree + 1u) {
        var traversal: Traversal = meshes_begin(ray, meshes_roots_at(tree));
        loop {
            let id = meshes_next(&traversal, ray.t_min, ray.t_max);
            if (!(id != 4294967295u)) { break; }
            let candidate = IndexedTriangle_intersect(meshes_at(id), ray);
            if (is_within(candidate, ray)) {
                var is_first: bool = true;
                if (hits_0_is_hit) {
                    let t = candidate.t > hits_0_t;
                    is_first = select(is_before(Hit(candidate.is_hit, candidate.t, id, 0u, candidate.u, candidate.v), Hit(hits_0_is_hit, hits_0_t, hits_0_prim_id, 0u, 0.0f, 0.0f)), t, (t != (hits_0_t > candidate.t)));
                }
                if (is_first && !(hits_0_prim_id == id && hits_0_is_hit)) {
                    hits_0_is_hit = candidate.is_hit;
                    hits_0_t = candidate.t;
                    hits_0_prim_id = id;
                    hits_0_u = candidate.u;
                    hits_0_v = candidate.v;
                }
            }
        }
    }
    return Tuple(near.t, hits_0_t, meshes_any_hit(ray));
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
    outputs[index] = StoredTuple(result._0, result._1, (select(0u, 1u, result._2)));
}
