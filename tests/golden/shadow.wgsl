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

struct Lost {
    most: vec3<f32>,
    rest: vec3<f32>,
}

struct Triangle {
    v0: vec3<f32>,
    v1: vec3<f32>,
    v2: vec3<f32>,
}

struct Node {
    min: vec3<f32>,
    first: u32,
    max: vec3<f32>,
    count: u32,
}

struct Tuple {
    _0: Ray,
}

struct StoredTriangle {
    v0_x: f32,
    v0_y: f32,
    v0_z: f32,
    v1_x: f32,
    v1_y: f32,
    v1_z: f32,
    v2_x: f32,
    v2_y: f32,
    v2_z: f32,
}

struct StoredTuple {
    arg0_origin: vec3<f32>,
    arg0_direction_x: f32,
    arg0_direction_y: f32,
    arg0_direction_z: f32,
    arg0_t_min: f32,
    arg0_t_max: f32,
}

struct Params {
    light: vec3<f32>,
    lit_4097_0: f32,
    len_of_walls_nodes: u32,
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

@group(0) @binding(4) var<storage, read> walls: array<StoredTriangle>;

fn walls_at(i: u32) -> Triangle {
    let s = walls[i];
    return Triangle(vec3<f32>(s.v0_x, s.v0_y, s.v0_z), vec3<f32>(s.v1_x, s.v1_y, s.v1_z), vec3<f32>(s.v2_x, s.v2_y, s.v2_z));
}

@group(0) @binding(5) var<storage, read> walls_nodes: array<Node>;

fn walls_nodes_at(i: u32) -> Node {
    return walls_nodes[i];
}

@group(0) @binding(6) var<storage, read> walls_ids: array<u32>;

fn walls_ids_at(i: u32) -> u32 {
    return walls_ids[i];
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

fn Triangle_intersect(self_: Triangle, ray: Ray) -> Hit {
    return intersect(ray, self_.v0, self_.v1, self_.v2);
}

fn walls_closest_hit(ray: Ray) -> Hit {
    var best = Hit();
    var limit = ray.t_max;
    if (params.len_of_walls_nodes == 0u || !is_finite(ray)) {
        return best;
    }
    var stack: array<u32, 64>;
    var stack_t: array<f32, 64>;
    var top = 0u;
    var node = walls_nodes_at(0u);
    let s = slabs(ray, node.min, node.max, 9.536743e-7, 0.0);
    let root = enter_leave(s, node.min, node.max, ray.t_min, limit);
    if (!(root.x <= root.y)) {
        return best;
    }
    loop {
        if (node.count > 0u) {
            for (var i = node.first; i < node.first + node.count; i = i + 1u) {
                let id = walls_ids_at(i);
                var candidate = Triangle_intersect(walls_at(id), ray);
                candidate.prim_id = id;
                if (is_within(candidate, ray) && is_before(candidate, best)) {
                    best = candidate;
                    limit = limit_behind(best.t, 9.536743e-7, ray.t_max);
                }
            }
        } else {
            let left = walls_nodes_at(node.first);
            let right = walls_nodes_at(node.first + 1u);
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
        node = walls_nodes_at(stack[top]);
    }
    return best;
}

fn Ray_at(self_: Ray, t: f32) -> vec3<f32> {
    return self_.origin + self_.direction * t;
}

fn walls_any_hit(ray: Ray) -> bool {
    let limit = ray.t_max;
    if (params.len_of_walls_nodes == 0u || !is_finite(ray)) {
        return false;
    }
    var stack: array<u32, 64>;
    var top = 0u;
    var node = walls_nodes_at(0u);
    let s = slabs(ray, node.min, node.max, 9.536743e-7, 0.0);
    let root = enter_leave(s, node.min, node.max, ray.t_min, limit);
    if (!(root.x <= root.y)) {
        return false;
    }
    loop {
        if (node.count > 0u) {
            for (var i = node.first; i < node.first + node.count; i = i + 1u) {
                let id = walls_ids_at(i);
                if (is_within(Triangle_intersect(walls_at(id), ray), ray)) {
                    return true;
                }
            }
        } else {
            let left = walls_nodes_at(node.first);
            let right = walls_nodes_at(node.first + 1u);
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
        node = walls_nodes_at(stack[top]);
    }
    return false;
}

fn kernel(ray: Ray) -> f32 {
    let hit = walls_closest_hit(ray);
    var lit: f32 = 0.0f;
    if (hit.is_hit) {
        let at = Ray_at(ray, hit.t);
        if (!walls_any_hit(Ray(at, params.light - at, 0.001f, 1.0f))) {
            let t = params.light - at;
            lit = 1.0f / (t.x * t.x + t.y * t.y + t.z * t.z);
        }
    }
    return lit;
}

fn element(input: Tuple) -> f32 {
    return kernel(input._0);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<f32>;

fn load_input(i: u32) -> Tuple {
    let s = inputs[i];
    return Tuple(Ray(s.arg0_origin, vec3<f32>(s.arg0_direction_x, s.arg0_direction_y, s.arg0_direction_z), s.arg0_t_min, s.arg0_t_max));
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = result;
}
