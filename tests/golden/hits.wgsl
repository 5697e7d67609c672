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

struct Slabs {
    lower: vec3<f32>,
    upper: vec3<f32>,
    inverse: vec3<f32>,
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

struct Node {
    min: vec3<f32>,
    first: u32,
    max: vec3<f32>,
    count: u32,
}

struct ColorSphere {
    center: vec3<f32>,
    radius: u32,
    color: array<u32, 3>,
}

struct Tuple {
    _0: Hit,
    _1: f32,
}

struct Tuple_1 {
    _0: u32,
    _1: f32,
}

struct Tuple_2 {
    _0: Ray,
}

struct StoredColorSphere {
    center: vec3<f32>,
    radius_color_0_color_1_color_2: u32,
}

struct StoredTuple_2 {
    arg0_origin: vec3<f32>,
    arg0_direction_x: f32,
    arg0_direction_y: f32,
    arg0_direction_z: f32,
    arg0_t_min: f32,
    arg0_t_max: f32,
}

struct StoredTuple_1 {
    arg0: u32,
    arg1: f32,
}

struct Params {
    lit_255_0: f32,
    len_of_bvh_nodes: u32,
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

@group(0) @binding(4) var<storage, read> bvh: array<StoredColorSphere>;

fn bvh_at(i: u32) -> ColorSphere {
    let s = bvh[i];
    return ColorSphere(s.center, s.radius_color_0_color_1_color_2 & 0xffu, array<u32, 3>((s.radius_color_0_color_1_color_2 >> 8u) & 0xffu, (s.radius_color_0_color_1_color_2 >> 16u) & 0xffu, (s.radius_color_0_color_1_color_2 >> 24u) & 0xffu));
}

@group(0) @binding(5) var<storage, read> bvh_nodes: array<Node>;

fn bvh_nodes_at(i: u32) -> Node {
    return bvh_nodes[i];
}

@group(0) @binding(6) var<storage, read> bvh_ids: array<u32>;

fn bvh_ids_at(i: u32) -> u32 {
    return bvh_ids[i];
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

fn are_finite(v: vec3<f32>) -> bool {
    return (bitcast<u32>(v.x) & 2147483647u) < 2139095040u && (bitcast<u32>(v.y) & 2147483647u) < 2139095040u && (bitcast<u32>(v.z) & 2147483647u) < 2139095040u;
}

fn is_finite(ray: Ray) -> bool {
    return are_finite(ray.origin) && are_finite(ray.direction);
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

/// A traversal that has yet to begin.
fn bvh_begin(ray: Ray) -> Traversal {
    var w = Traversal();
    if (params.len_of_bvh_nodes == 0u || !is_finite(ray)) {
        return w;
    }
    let node = bvh_nodes_at(0u);
    let s = slabs(ray, node.min, node.max, 9.536743e-7, 0.0);
    w.lower = s.lower;
    w.upper = s.upper;
    w.inverse = s.inverse;
    let enter = enter_leave(s, node.min, node.max, ray.t_min, ray.t_max);
    w.nodes[0] = 0u;
    w.enters[0] = enter.x;
    w.top = select(0u, 1u, enter.x <= enter.y);
    return w;
}

/// The next primitive that the ray may meet at or before `limit`; 4294967295u when none is left.
fn bvh_next(w: ptr<function, Traversal>, t_min: f32, limit: f32) -> u32 {
    loop {
        if ((*w).next < (*w).last) {
            (*w).next = (*w).next + 1u;
            return bvh_ids_at((*w).next - 1u);
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
        var node = bvh_nodes_at((*w).nodes[(*w).top]);
        let s = Slabs((*w).lower, (*w).upper, (*w).inverse);
        // Down to a leaf, the nearer child first.
        while (node.count == 0u) {
            let left = bvh_nodes_at(node.first);
            let right = bvh_nodes_at(node.first + 1u);
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

fn with_hit(found: array<Tuple, 4>, last: Hit, crossing: Tuple) -> array<Tuple, 4> {
    var all_0_0_is_hit: bool = found[0]._0.is_hit;
    var all_0_0_t: f32 = found[0]._0.t;
    var all_0_0_prim_id: u32 = found[0]._0.prim_id;
    var all_0_0_inst_id: u32 = found[0]._0.inst_id;
    var all_0_0_u: f32 = found[0]._0.u;
    var all_0_0_v: f32 = found[0]._0.v;
    var all_0_1: f32 = found[0]._1;
    var all_1_0_is_hit: bool = found[1]._0.is_hit;
    var all_1_0_t: f32 = found[1]._0.t;
    var all_1_0_prim_id: u32 = found[1]._0.prim_id;
    var all_1_0_inst_id: u32 = found[1]._0.inst_id;
    var all_1_0_u: f32 = found[1]._0.u;
    var all_1_0_v: f32 = found[1]._0.v;
    var all_1_1: f32 = found[1]._1;
    var all_2_0_is_hit: bool = found[2]._0.is_hit;
    var all_2_0_t: f32 = found[2]._0.t;
    var all_2_0_prim_id: u32 = found[2]._0.prim_id;
    var all_2_0_inst_id: u32 = found[2]._0.inst_id;
    var all_2_0_u: f32 = found[2]._0.u;
    var all_2_0_v: f32 = found[2]._0.v;
    var all_2_1: f32 = found[2]._1;
    var all_3_0_is_hit: bool = found[3]._0.is_hit;
    var all_3_0_t: f32 = found[3]._0.t;
    var all_3_0_prim_id: u32 = found[3]._0.prim_id;
    var all_3_0_inst_id: u32 = found[3]._0.inst_id;
    var all_3_0_u: f32 = found[3]._0.u;
    var all_3_0_v: f32 = found[3]._0.v;
    var all_3_1: f32 = found[3]._1;
    if (crossing._0.is_hit && ((!last.is_hit || is_before(last, crossing._0)) && !((found[0]._0.t == crossing._0.t && found[0]._0.prim_id == crossing._0.prim_id && found[0]._0.is_hit) || (found[1]._0.t == crossing._0.t && found[1]._0.prim_id == crossing._0.prim_id && found[1]._0.is_hit) || (found[2]._0.t == crossing._0.t && found[2]._0.prim_id == crossing._0.prim_id && found[2]._0.is_hit) || (found[3]._0.t == crossing._0.t && found[3]._0.prim_id == crossing._0.prim_id && found[3]._0.is_hit)) && is_before(crossing._0, found[3]._0))) {
        let t = is_before(crossing._0, found[0]._0);
        let t_1 = select(crossing._0.is_hit, found[0]._0.is_hit, t);
        let t_2 = select(crossing._0.t, found[0]._0.t, t);
        let t_3 = select(crossing._0.prim_id, found[0]._0.prim_id, t);
        let t_4 = select(crossing._0.inst_id, found[0]._0.inst_id, t);
        let t_5 = select(crossing._0.u, found[0]._0.u, t);
        let t_6 = select(crossing._0.v, found[0]._0.v, t);
        let t_7 = select(crossing._1, found[0]._1, t);
        let t_8 = t || is_before(crossing._0, found[1]._0);
        let t_9 = select(t_1, found[1]._0.is_hit, t_8);
        let t_10 = select(t_2, found[1]._0.t, t_8);
        let t_11 = select(t_3, found[1]._0.prim_id, t_8);
        let t_12 = select(t_4, found[1]._0.inst_id, t_8);
        let t_13 = select(t_5, found[1]._0.u, t_8);
        let t_14 = select(t_6, found[1]._0.v, t_8);
        let t_15 = select(t_7, found[1]._1, t_8);
        let t_16 = t_8 || is_before(crossing._0, found[2]._0);
        all_0_0_is_hit = select(found[0]._0.is_hit, crossing._0.is_hit, t);
        all_0_0_t = select(found[0]._0.t, crossing._0.t, t);
        all_0_0_prim_id = select(found[0]._0.prim_id, crossing._0.prim_id, t);
        all_0_0_inst_id = select(found[0]._0.inst_id, crossing._0.inst_id, t);
        all_0_0_u = select(found[0]._0.u, crossing._0.u, t);
        all_0_0_v = select(found[0]._0.v, crossing._0.v, t);
        all_0_1 = select(found[0]._1, crossing._1, t);
        all_1_0_is_hit = select(found[1]._0.is_hit, t_1, t_8);
        all_1_0_t = select(found[1]._0.t, t_2, t_8);
        all_1_0_prim_id = select(found[1]._0.prim_id, t_3, t_8);
        all_1_0_inst_id = select(found[1]._0.inst_id, t_4, t_8);
        all_1_0_u = select(found[1]._0.u, t_5, t_8);
        all_1_0_v = select(found[1]._0.v, t_6, t_8);
        all_1_1 = select(found[1]._1, t_7, t_8);
        all_2_0_is_hit = select(found[2]._0.is_hit, t_9, t_16);
        all_2_0_t = select(found[2]._0.t, t_10, t_16);
        all_2_0_prim_id = select(found[2]._0.prim_id, t_11, t_16);
        all_2_0_inst_id = select(found[2]._0.inst_id, t_12, t_16);
        all_2_0_u = select(found[2]._0.u, t_13, t_16);
        all_2_0_v = select(found[2]._0.v, t_14, t_16);
        all_2_1 = select(found[2]._1, t_15, t_16);
        all_3_0_is_hit = select(t_9, found[2]._0.is_hit, t_16);
        all_3_0_t = select(t_10, found[2]._0.t, t_16);
        all_3_0_prim_id = select(t_11, found[2]._0.prim_id, t_16);
        all_3_0_inst_id = select(t_12, found[2]._0.inst_id, t_16);
        all_3_0_u = select(t_13, found[2]._0.u, t_16);
        all_3_0_v = select(t_14, found[2]._0.v, t_16);
        all_3_1 = select(t_15, found[2]._1, t_16);
    }
    return array<Tuple, 4>(Tuple(Hit(all_0_0_is_hit, all_0_0_t, all_0_0_prim_id, all_0_0_inst_id, all_0_0_u, all_0_0_v), all_0_1), Tuple(Hit(all_1_0_is_hit, all_1_0_t, all_1_0_prim_id, all_1_0_inst_id, all_1_0_u, all_1_0_v), all_1_1), Tuple(Hit(all_2_0_is_hit, all_2_0_t, all_2_0_prim_id, all_2_0_inst_id, all_2_0_u, all_2_0_v), all_2_1), Tuple(Hit(all_3_0_is_hit, all_3_0_t, all_3_0_prim_id, all_3_0_inst_id, all_3_0_u, all_3_0_v), all_3_1));
}

fn behind(t: f32) -> f32 {
    let is_small = abs(t) < 1.1754944e-38f;
    let bits = bitcast<u32>(t);
    var value: u32;
    if (t > 0.0f) {
        value = bits + 1u;
    } else {
        value = bits - 1u;
    }
    let next = bitcast<f32>(value);
    return select(next, 1.1754944e-38f, is_small);
}

fn next_hits(ray: Ray, last: Hit) -> array<Tuple, 4> {
    var found_0_0_is_hit: bool = false;
    var found_0_0_t: f32 = 0.0f;
    var found_0_0_prim_id: u32 = 0u;
    var found_0_0_inst_id: u32 = 0u;
    var found_0_0_u: f32 = 0.0f;
    var found_0_0_v: f32 = 0.0f;
    var found_0_1: f32 = 0.0f;
    var found_1_0_is_hit: bool = false;
    var found_1_0_t: f32 = 0.0f;
    var found_1_0_prim_id: u32 = 0u;
    var found_1_0_inst_id: u32 = 0u;
    var found_1_0_u: f32 = 0.0f;
    var found_1_0_v: f32 = 0.0f;
    var found_1_1: f32 = 0.0f;
    var found_2_0_is_hit: bool = false;
    var found_2_0_t: f32 = 0.0f;
    var found_2_0_prim_id: u32 = 0u;
    var found_2_0_inst_id: u32 = 0u;
    var found_2_0_u: f32 = 0.0f;
    var found_2_0_v: f32 = 0.0f;
    var found_2_1: f32 = 0.0f;
    var found_3_0_is_hit: bool = false;
    var found_3_0_t: f32 = 0.0f;
    var found_3_0_prim_id: u32 = 0u;
    var found_3_0_inst_id: u32 = 0u;
    var found_3_0_u: f32 = 0.0f;
    var found_3_0_v: f32 = 0.0f;
    var found_3_1: f32 = 0.0f;
    var traversal: Traversal = bvh_begin(ray);
    loop {
        let id = bvh_next(&traversal, ray.t_min, select(ray.t_max, limit_behind(found_3_0_t, 9.536743e-7f, ray.t_max), found_3_0_is_hit));
        if (!(id != 4294967295u)) { break; }
        let candidate = ColorSphere_intersect(bvh_at(id), ray);
        if (is_within(candidate, ray)) {
            let found_0_0_is_hit_1 = found_0_0_is_hit;
            let found_0_0_t_1 = found_0_0_t;
            let found_0_0_prim_id_1 = found_0_0_prim_id;
            let found_0_0_inst_id_1 = found_0_0_inst_id;
            let found_0_0_u_1 = found_0_0_u;
            let found_0_0_v_1 = found_0_0_v;
            let found_0_1_1 = found_0_1;
            let found_1_0_is_hit_1 = found_1_0_is_hit;
            let found_1_0_t_1 = found_1_0_t;
            let found_1_0_prim_id_1 = found_1_0_prim_id;
            let found_1_0_inst_id_1 = found_1_0_inst_id;
            let found_1_0_u_1 = found_1_0_u;
            let found_1_0_v_1 = found_1_0_v;
            let found_1_1_1 = found_1_1;
            let found_2_0_is_hit_1 = found_2_0_is_hit;
            let found_2_0_t_1 = found_2_0_t;
            let found_2_0_prim_id_1 = found_2_0_prim_id;
            let found_2_0_inst_id_1 = found_2_0_inst_id;
            let found_2_0_u_1 = found_2_0_u;
            let found_2_0_v_1 = found_2_0_v;
            let found_2_1_1 = found_2_1;
            let found_3_0_is_hit_1 = found_3_0_is_hit;
            let found_3_0_t_1 = found_3_0_t;
            let found_3_0_prim_id_1 = found_3_0_prim_id;
            let found_3_0_inst_id_1 = found_3_0_inst_id;
            let found_3_0_u_1 = found_3_0_u;
            let found_3_0_v_1 = found_3_0_v;
            let t = with_hit(array<Tuple, 4>(Tuple(Hit(found_0_0_is_hit_1, found_0_0_t_1, found_0_0_prim_id_1, found_0_0_inst_id_1, found_0_0_u_1, found_0_0_v_1), found_0_1_1), Tuple(Hit(found_1_0_is_hit_1, found_1_0_t_1, found_1_0_prim_id_1, found_1_0_inst_id_1, found_1_0_u_1, found_1_0_v_1), found_1_1_1), Tuple(Hit(found_2_0_is_hit_1, found_2_0_t_1, found_2_0_prim_id_1, found_2_0_inst_id_1, found_2_0_u_1, found_2_0_v_1), found_2_1_1), Tuple(Hit(found_3_0_is_hit_1, found_3_0_t_1, found_3_0_prim_id_1, found_3_0_inst_id_1, found_3_0_u_1, found_3_0_v_1), found_3_1)), last, Tuple(Hit(candidate.is_hit, candidate.t, id, 0u, candidate.u, candidate.v), ray.t_min));
            found_0_0_is_hit = t[0]._0.is_hit;
            found_0_0_t = t[0]._0.t;
            found_0_0_prim_id = t[0]._0.prim_id;
            found_0_0_inst_id = t[0]._0.inst_id;
            found_0_0_u = t[0]._0.u;
            found_0_0_v = t[0]._0.v;
            found_0_1 = t[0]._1;
            found_1_0_is_hit = t[1]._0.is_hit;
            found_1_0_t = t[1]._0.t;
            found_1_0_prim_id = t[1]._0.prim_id;
            found_1_0_inst_id = t[1]._0.inst_id;
            found_1_0_u = t[1]._0.u;
            found_1_0_v = t[1]._0.v;
            found_1_1 = t[1]._1;
            found_2_0_is_hit = t[2]._0.is_hit;
            found_2_0_t = t[2]._0.t;
            found_2_0_prim_id = t[2]._0.prim_id;
            found_2_0_inst_id = t[2]._0.inst_id;
            found_2_0_u = t[2]._0.u;
            found_2_0_v = t[2]._0.v;
            found_2_1 = t[2]._1;
            found_3_0_is_hit = t[3]._0.is_hit;
            found_3_0_t = t[3]._0.t;
            found_3_0_prim_id = t[3]._0.prim_id;
            found_3_0_inst_id = t[3]._0.inst_id;
            found_3_0_u = t[3]._0.u;
            found_3_0_v = t[3]._0.v;
            found_3_1 = t[3]._1;
            var crossing_is_hit: bool = candidate.is_hit;
            var crossing_t: f32 = candidate.t;
            let crossing_prim_id = id;
            let crossing_inst_id = 0u;
            var crossing_u: f32 = candidate.u;
            var crossing_v: f32 = candidate.v;
            var left: u32 = 7u;
            while (left > 0u && (crossing_is_hit && is_before(Hit(false, crossing_t, crossing_prim_id, 0u, 0.0f, 0.0f), Hit(found_3_0_is_hit, found_3_0_t, found_3_0_prim_id, 0u, 0.0f, 0.0f)))) {
                let crossing_t_1 = crossing_t;
                let t_1 = behind(crossing_t_1);
                let t_2 = ColorSphere_intersect(bvh_at(crossing_prim_id), Ray(ray.origin, ray.direction, t_1, ray.t_max));
                let t_3 = is_within(Hit(t_2.is_hit, t_2.t, 0u, 0u, 0.0f, 0.0f), Ray(vec3<f32>(0.0f), vec3<f32>(0.0f), t_1, ray.t_max));
                let found_0_0_is_hit_2 = found_0_0_is_hit;
                let found_0_0_t_2 = found_0_0_t;
                let found_0_0_prim_id_2 = found_0_0_prim_id;
                let found_0_0_inst_id_2 = found_0_0_inst_id;
                let found_0_0_u_2 = found_0_0_u;
                let found_0_0_v_2 = found_0_0_v;
                let found_0_1_2 = found_0_1;
                let found_1_0_is_hit_2 = found_1_0_is_hit;
                let found_1_0_t_2 = found_1_0_t;
                let found_1_0_prim_id_2 = found_1_0_prim_id;
                let found_1_0_inst_id_2 = found_1_0_inst_id;
                let found_1_0_u_2 = found_1_0_u;
                let found_1_0_v_2 = found_1_0_v;
                let found_1_1_2 = found_1_1;
                let found_2_0_is_hit_2 = found_2_0_is_hit;
                let found_2_0_t_2 = found_2_0_t;
                let found_2_0_prim_id_2 = found_2_0_prim_id;
                let found_2_0_inst_id_2 = found_2_0_inst_id;
                let found_2_0_u_2 = found_2_0_u;
                let found_2_0_v_2 = found_2_0_v;
                let found_2_1_2 = found_2_1;
                let found_3_0_is_hit_2 = found_3_0_is_hit;
                let found_3_0_t_2 = found_3_0_t;
                let found_3_0_prim_id_2 = found_3_0_prim_id;
                let found_3_0_inst_id_2 = found_3_0_inst_id;
                let found_3_0_u_2 = found_3_0_u;
                let found_3_0_v_2 = found_3_0_v;
                let t_4 = with_hit(array<Tuple, 4>(Tuple(Hit(found_0_0_is_hit_2, found_0_0_t_2, found_0_0_prim_id_2, found_0_0_inst_id_2, found_0_0_u_2, found_0_0_v_2), found_0_1_2), Tuple(Hit(found_1_0_is_hit_2, found_1_0_t_2, found_1_0_prim_id_2, found_1_0_inst_id_2, found_1_0_u_2, found_1_0_v_2), found_1_1_2), Tuple(Hit(found_2_0_is_hit_2, found_2_0_t_2, found_2_0_prim_id_2, found_2_0_inst_id_2, found_2_0_u_2, found_2_0_v_2), found_2_1_2), Tuple(Hit(found_3_0_is_hit_2, found_3_0_t_2, found_3_0_prim_id_2, found_3_0_inst_id_2, found_3_0_u_2, found_3_0_v_2), found_3_1)), last, Tuple(Hit(t_3, t_2.t, crossing_prim_id, crossing_inst_id, t_2.u, t_2.v), t_1));
                found_0_0_is_hit = t_4[0]._0.is_hit;
                found_0_0_t = t_4[0]._0.t;
                found_0_0_prim_id = t_4[0]._0.prim_id;
                found_0_0_inst_id = t_4[0]._0.inst_id;
                found_0_0_u = t_4[0]._0.u;
                found_0_0_v = t_4[0]._0.v;
                found_0_1 = t_4[0]._1;
                found_1_0_is_hit = t_4[1]._0.is_hit;
                found_1_0_t = t_4[1]._0.t;
                found_1_0_prim_id = t_4[1]._0.prim_id;
                found_1_0_inst_id = t_4[1]._0.inst_id;
                found_1_0_u = t_4[1]._0.u;
                found_1_0_v = t_4[1]._0.v;
                found_1_1 = t_4[1]._1;
                found_2_0_is_hit = t_4[2]._0.is_hit;
                found_2_0_t = t_4[2]._0.t;
                found_2_0_prim_id = t_4[2]._0.prim_id;
                found_2_0_inst_id = t_4[2]._0.inst_id;
                found_2_0_u = t_4[2]._0.u;
                found_2_0_v = t_4[2]._0.v;
                found_2_1 = t_4[2]._1;
                found_3_0_is_hit = t_4[3]._0.is_hit;
                found_3_0_t = t_4[3]._0.t;
                found_3_0_prim_id = t_4[3]._0.prim_id;
                found_3_0_inst_id = t_4[3]._0.inst_id;
                found_3_0_u = t_4[3]._0.u;
                found_3_0_v = t_4[3]._0.v;
                found_3_1 = t_4[3]._1;
                crossing_is_hit = t_3;
                crossing_t = t_2.t;
                crossing_u = t_2.u;
                crossing_v = t_2.v;
                left = left - 1u;
            }
        }
    }
    return array<Tuple, 4>(Tuple(Hit(found_0_0_is_hit, found_0_0_t, found_0_0_prim_id, 0u, 0.0f, 0.0f), 0.0f), Tuple(Hit(found_1_0_is_hit, found_1_0_t, found_1_0_prim_id, 0u, 0.0f, 0.0f), 0.0f), Tuple(Hit(found_2_0_is_hit, found_2_0_t, found_2_0_prim_id, 0u, 0.0f, 0.0f), 0.0f), Tuple(Hit(found_3_0_is_hit, found_3_0_t, found_3_0_prim_id, 0u, 0.0f, 0.0f), 0.0f));
}

fn kernel(ray: Ray) -> Tuple_1 {
    var passed: u32 = 0u;
    var last: f32 = 0.0f;
    var pending_0_0_is_hit: bool = false;
    var pending_0_0_t: f32 = 0.0f;
    var pending_0_0_prim_id: u32 = 0u;
    var pending_1_0_is_hit: bool = false;
    var pending_1_0_t: f32 = 0.0f;
    var pending_1_0_prim_id: u32 = 0u;
    var pending_2_0_is_hit: bool = false;
    var pending_2_0_t: f32 = 0.0f;
    var pending_2_0_prim_id: u32 = 0u;
    var pending_3_0_is_hit: bool = false;
    var pending_3_0_t: f32 = 0.0f;
    var pending_3_0_prim_id: u32 = 0u;
    var last_0_is_hit: bool = false;
    var last_0_t: f32 = 0.0f;
    var last_0_prim_id: u32 = 0u;
    var has_more: bool = true;
    loop {
        if (!pending_0_0_is_hit && has_more) {
            let t = next_hits(ray, Hit(last_0_is_hit, last_0_t, last_0_prim_id, 0u, 0.0f, 0.0f));
            pending_0_0_is_hit = t[0]._0.is_hit;
            pending_0_0_t = t[0]._0.t;
            pending_0_0_prim_id = t[0]._0.prim_id;
            pending_1_0_is_hit = t[1]._0.is_hit;
            pending_1_0_t = t[1]._0.t;
            pending_1_0_prim_id = t[1]._0.prim_id;
            pending_2_0_is_hit = t[2]._0.is_hit;
            pending_2_0_t = t[2]._0.t;
            pending_2_0_prim_id = t[2]._0.prim_id;
            pending_3_0_is_hit = t[3]._0.is_hit;
            pending_3_0_t = t[3]._0.t;
            pending_3_0_prim_id = t[3]._0.prim_id;
            has_more = t[3]._0.is_hit;
        }
        let pending_0_0_is_hit_1 = pending_0_0_is_hit;
        last_0_is_hit = pending_0_0_is_hit_1;
        last_0_t = pending_0_0_t;
        last_0_prim_id = pending_0_0_prim_id;
        pending_0_0_is_hit = pending_1_0_is_hit;
        pending_0_0_t = pending_1_0_t;
        pending_0_0_prim_id = pending_1_0_prim_id;
        pending_1_0_is_hit = pending_2_0_is_hit;
        pending_1_0_t = pending_2_0_t;
        pending_1_0_prim_id = pending_2_0_prim_id;
        pending_2_0_is_hit = pending_3_0_is_hit;
        pending_2_0_t = pending_3_0_t;
        pending_2_0_prim_id = pending_3_0_prim_id;
        pending_3_0_is_hit = false;
        pending_3_0_t = 0.0f;
        pending_3_0_prim_id = 0u;
        if (!(pending_0_0_is_hit_1)) { break; }
        passed = passed + 1u;
        last = last_0_t;
        if (passed == 3u) {
            break;
        }
    }
    return Tuple_1(passed, last);
}

fn element(input: Tuple_2) -> Tuple_1 {
    return kernel(input._0);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple_2>;
@group(0) @binding(3) var<storage, read_write> outputs: array<StoredTuple_1>;

fn load_input(i: u32) -> Tuple_2 {
    let s = inputs[i];
    return Tuple_2(Ray(s.arg0_origin, vec3<f32>(s.arg0_direction_x, s.arg0_direction_y, s.arg0_direction_z), s.arg0_t_min, s.arg0_t_max));
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = StoredTuple_1(result._0, result._1);
}
