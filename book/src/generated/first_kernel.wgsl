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

struct Node {
    min: vec3<f32>,
    first: u32,
    max: vec3<f32>,
    count: u32,
}

struct Shaded {
    color: vec3<f32>,
    depth: f32,
    id: u32,
}

struct Tuple {
    _0: Ray,
}

struct StoredColorSphere {
    center: vec3<f32>,
    radius_color_0_color_1_color_2: u32,
}

struct StoredTuple {
    arg0_origin: vec3<f32>,
    arg0_direction_x: f32,
    arg0_direction_y: f32,
    arg0_direction_z: f32,
    arg0_t_min: f32,
    arg0_t_max: f32,
}

struct StoredShaded {
    color_x: f32,
    color_y: f32,
    color_z: f32,
    depth: f32,
    id: u32,
}

struct Params {
    sun: vec3<f32>,
    background: vec3<f32>,
    lit_255_0: f32,
    lit_0_001: f32,
    lit_0_75: f32,
    lit_0_7: f32,
    lit_0_6: f32,
    lit_1_0: f32,
    len_of_bvh: u32,
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

/// The last element stands for those out of range.
fn bvh_element(i: u32) -> ColorSphere {
    return bvh_at(min(i, max(params.len_of_bvh, 1u) - 1u));
}

@group(0) @binding(5) var<storage, read> bvh_nodes: array<Node>;

fn bvh_nodes_at(i: u32) -> Node {
    return bvh_nodes[i];
}

@group(0) @binding(6) var<storage, read> bvh_ids: array<u32>;

fn bvh_ids_at(i: u32) -> u32 {
    return bvh_ids[i];
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

fn bvh_closest_hit(ray: Ray) -> Hit {
    var best = Hit();
    var limit = ray.t_max;
    if (params.len_of_bvh_nodes == 0u || !is_finite(ray)) {
        return best;
    }
    var stack: array<u32, 64>;
    var stack_t: array<f32, 64>;
    var top = 0u;
    var node = bvh_nodes_at(0u);
    let s = slabs(ray, node.min, node.max, 9.536743e-7, 0.0);
    let root = enter_leave(s, node.min, node.max, ray.t_min, limit);
    if (!(root.x <= root.y)) {
        return best;
    }
    loop {
        if (node.count > 0u) {
            for (var i = node.first; i < node.first + node.count; i = i + 1u) {
                let id = bvh_ids_at(i);
                var candidate = ColorSphere_intersect(bvh_at(id), ray);
                candidate.prim_id = id;
                if (is_within(candidate, ray) && is_before(candidate, best)) {
                    best = candidate;
                    limit = limit_behind(best.t, 9.536743e-7, ray.t_max);
                }
            }
        } else {
            let left = bvh_nodes_at(node.first);
            let right = bvh_nodes_at(node.first + 1u);
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
        node = bvh_nodes_at(stack[top]);
    }
    return best;
}

fn Ray_at(self_: Ray, t: f32) -> vec3<f32> {
    return self_.origin + self_.direction * t;
}

fn bvh_any_hit(ray: Ray) -> bool {
    let limit = ray.t_max;
    if (params.len_of_bvh_nodes == 0u || !is_finite(ray)) {
        return false;
    }
    var stack: array<u32, 64>;
    var top = 0u;
    var node = bvh_nodes_at(0u);
    let s = slabs(ray, node.min, node.max, 9.536743e-7, 0.0);
    let root = enter_leave(s, node.min, node.max, ray.t_min, limit);
    if (!(root.x <= root.y)) {
        return false;
    }
    loop {
        if (node.count > 0u) {
            for (var i = node.first; i < node.first + node.count; i = i + 1u) {
                let id = bvh_ids_at(i);
                if (is_within(ColorSphere_intersect(bvh_at(id), ray), ray)) {
                    return true;
                }
            }
        } else {
            let left = bvh_nodes_at(node.first);
            let right = bvh_nodes_at(node.first + 1u);
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
        node = bvh_nodes_at(stack[top]);
    }
    return false;
}

fn ColorSphere_rgb(self_: ColorSphere) -> vec3<f32> {
    return vec3<f32>(f32(self_.color[0]) / params.lit_255_0, f32(self_.color[1]) / params.lit_255_0, f32(self_.color[2]) / params.lit_255_0);
}

fn sky(up: f32, bands: u32) -> f32 {
    var edge: f32 = 1.0f;
    var i: u32 = 0u;
    for (; i < bands; i = i + 1u) {
        edge = edge * params.lit_0_6;
        if (up > edge) {
            return edge;
        }
    }
    return 0.0f;
}

fn kernel(ray: Ray) -> Shaded {
    let hit = bvh_closest_hit(ray);
    var color: vec3<f32>;
    if (hit.is_hit) {
        let sphere = bvh_element(select(0u, hit.prim_id, hit.is_hit));
        let t = Ray_at(ray, hit.t) - sphere.center;
        let normal = t * (1.0f / sqrt(t.x * t.x + t.y * t.y + t.z * t.z));
        let shadow = Ray_at(ray, hit.t) + normal * params.lit_0_001;
        var light: f32 = 0.25f;
        var both: bool;
        if (normal.x * params.sun.x + normal.y * params.sun.y + normal.z * params.sun.z > 0.0f) {
            both = !bvh_any_hit(Ray(shadow, params.sun, 0.0f, 340282346638528859811704183484516925440.0f));
        } else {
            both = false;
        }
        if (both) {
            light = light + params.lit_0_75 * (normal.x * params.sun.x + normal.y * params.sun.y + normal.z * params.sun.z);
        }
        color = ColorSphere_rgb(sphere) * light;
    } else {
        color = params.background * (params.lit_1_0 - 0.5f * sky(ray.direction.y + params.lit_0_7, 8u));
    }
    return Shaded(color, hit.t, hit.prim_id);
}

fn element(input: Tuple) -> Shaded {
    return kernel(input._0);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<StoredShaded>;

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
    outputs[index] = StoredShaded(result.color.x, result.color.y, result.color.z, result.depth, result.id);
}
