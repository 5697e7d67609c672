// Ambient occlusion of triangles by two rays, reduced by a program: the generated text without all that
// the pictures of its tests do not need (../occlusion.rs says which, ../reduce.rs how). Names are the
// generated ones.

struct PinholeRays {
    origin: vec3<f32>,
    corner: vec3<f32>,
    right: vec3<f32>,
    up: vec3<f32>,
}

struct Ray {
    origin: vec3<f32>,
    direction: vec3<f32>,
    t_min: f32,
    t_max: f32,
}

struct Sampler {
    key: vec2<u32>,
    index: u32,
    dimension: u32,
}

struct Hit {
    is_hit: bool,
    t: f32,
    prim_id: u32,
    u: f32,
    v: f32,
}

struct Lost {
    most: vec3<f32>,
    rest: vec3<f32>,
}

struct Face {
    v0: vec3<f32>,
    v1: vec3<f32>,
    v2: vec3<f32>,
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

struct SurfacePoint {
    position: vec3<f32>,
    normal: vec3<f32>,
    error: f32,
}

struct Frame {
    x: vec3<f32>,
    y: vec3<f32>,
    z: vec3<f32>,
}

struct Tuple {
    _0: vec2<f32>,
    _1: Sampler,
}

struct SinCos {
    sin: f32,
    cos: f32,
}

struct StoredFace {
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

struct StoredVec4 {
    value: vec4<f32>,
}

struct Job {
    size: vec2<u32>,
    first: vec2<u32>,
    count: vec2<u32>,
    base: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<uniform> job: Job;
@group(0) @binding(4) var<storage, read> bvh: array<StoredFace>;
fn bvh_at(i: u32) -> Face {
    let s = bvh[i];
    return Face(vec3<f32>(s.v0_x, s.v0_y, s.v0_z), vec3<f32>(s.v1_x, s.v1_y, s.v1_z), vec3<f32>(s.v2_x, s.v2_y, s.v2_z));
}

fn bvh_element(i: u32) -> Face {
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

fn saturate_u32(x: f32) -> u32 {
    return u32(x);
}

fn pixel_centre(pixel_: vec2<u32>) -> vec2<f32> {
    return vec2<f32>(f32(pixel_.x), f32(pixel_.y)) + params.lit_0_5;
}

fn PinholeRays_primary_ray(self_: PinholeRays, x: f32, y: f32) -> Ray {
    let t = self_.corner + self_.right * x + self_.up * y;
    let direction = t * (1.0f / sqrt(t.x * t.x + t.y * t.y + t.z * t.z));
    return Ray(self_.origin, direction, 0.0f, 340282346638528859811704183484516925440.0f);
}

fn congruent(x: u32) -> u32 {
    return x * 1664525u + 1013904223u;
}

fn crossed(v: vec4<u32>) -> vec4<u32> {
    let x = v.x + v.y * v.w;
    let y = v.y + v.z * x;
    let z = v.z + x * y;
    let w = v.w + y * z;
    return vec4<u32>(x, y, z, w);
}

fn pcg4d(v: vec4<u32>) -> vec4<u32> {
    let x = congruent(v.x);
    let y = congruent(v.y);
    let z = congruent(v.z);
    let w = congruent(v.w);
    let mixed = crossed(vec4<u32>(x, y, z, w));
    return crossed(vec4<u32>((mixed.x ^ (mixed.x >> 16u)), (mixed.y ^ (mixed.y >> 16u)), (mixed.z ^ (mixed.z >> 16u)), (mixed.w ^ (mixed.w >> 16u))));
}

fn Sampler_new(pixel_: vec2<u32>, seed: u32, index: u32) -> Sampler {
    let words = pcg4d(vec4<u32>(pixel_.x, pixel_.y, seed, 1398893936u));
    return Sampler(words.xy, index, 0u);
}

fn sampler_of(pixel_: vec2<u32>) -> Sampler {
    return Sampler_new(pixel_, 0u, 0u);
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
    return Hit(is_hit, t, 0u, 0.0f, 0.0f);
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
        scale = 1.1529215e18f;
        sides = exact_cross(vec3<f32>(a_y, b_y, c_y) * scale, vec3<f32>(a_x, b_x, c_x) * scale);
        sum = select(0.0f, sides.x + sides.y + sides.z, is_inside(sides));
    }
    let u = sides.x / sum;
    let v = sides.y / sum;
    let w = sides.z / sum;
    let t_8 = (u * a.z + v * b.z + w * c.z) * (1.0f / d.z);
    var both: bool;
    both = is_line(v0, v1, v2);
    let is_surface = !both;
    let is_hit = is_surface && t_8 >= ray.t_min && t_8 <= ray.t_max;
    let t_11 = Hit_new(is_hit, t_8);
    return Hit(t_11.is_hit, t_11.t, t_11.prim_id, v, w);
}

fn Face_intersect(self_: Face, ray: Ray) -> Hit {
    return intersect(ray, self_.v0, self_.v1, self_.v2);
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

fn slabs(ray: Ray, low: vec3<f32>, high: vec3<f32>, slack: f32) -> Slabs {
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
    let s = slabs(ray, node.min, node.max, 9.536743e-7);
    let root = enter_leave(s, node.min, node.max, ray.t_min, limit);
    if (!(root.x <= root.y)) {
        return best;
    }
    loop {
        if (node.count > 0u) {
            for (var i = node.first; i < node.first + node.count; i = i + 1u) {
                let id = bvh_ids_at(i);
                var candidate = Face_intersect(bvh_at(id), ray);
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
                if (left_first) {
                    node = left;
                } else {
                    node = right;
                }
                continue;
            }
            if (hit_left) {
                node = left;
                continue;
            }
            if (hit_right) {
                node = right;
                continue;
            }
        }
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

fn near_largest(v: vec3<f32>) -> f32 {
    let t = abs(v.x);
    let t_1 = abs(v.y);
    let t_2 = select(t, t_1, t < t_1);
    let t_3 = abs(v.z);
    return select(t_2, t_3, t_2 < t_3);
}

fn across(a: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    let t = a / near_largest(a);
    let t_1 = b / near_largest(b);
    let t_2 = t.y * t_1.z - t_1.y * t.z;
    let t_3 = t.z * t_1.x - t_1.z * t.x;
    let t_4 = t.x * t_1.y - t_1.x * t.y;
    return vec3<f32>(t_2, t_3, t_4) * (1.0f / sqrt(t_2 * t_2 + t_3 * t_3 + t_4 * t_4));
}

fn rounded_point(position: vec3<f32>, normal: vec3<f32>, own_error: f32) -> SurfacePoint {
    let t = abs(normal);
    let t_1 = abs(position);
    let of_coordinates = (t.x * t_1.x + t.y * t_1.y + t.z * t_1.z) * params.lit_1_7881393em7;
    return SurfacePoint(position, normal, of_coordinates + own_error);
}

fn weighted(b1: f32, b2: f32, v0: vec3<f32>, v1: vec3<f32>, v2: vec3<f32>) -> SurfacePoint {
    let parts_1 = v1 - v0;
    let e2 = v2 - v0;
    let t = near_largest(parts_1);
    let t_1 = near_largest(e2);
    let t_2 = select(t, t_1, t < t_1);
    let t_3 = near_largest(e2 - parts_1);
    let size = select(t_2, t_3, t_2 < t_3);
    return rounded_point(v0 + (parts_1 * b1 + e2 * b2), across(parts_1, e2), size * 4.7683716e-7f);
}

fn surface_point(hit: Hit, v0: vec3<f32>, v1: vec3<f32>, v2: vec3<f32>) -> SurfacePoint {
    return weighted(hit.u, hit.v, v0, v1, v2);
}

fn Face_surface_point(self_: Face, hit: Hit) -> SurfacePoint {
    return surface_point(hit, self_.v0, self_.v1, self_.v2);
}

fn Face_surface(self_: Face, hit: Hit) -> SurfacePoint {
    return Face_surface_point(self_, hit);
}

fn facing(point: SurfacePoint, direction: vec3<f32>) -> SurfacePoint {
    let is_behind = point.normal.x * direction.x + point.normal.y * direction.y + point.normal.z * direction.z > 0.0f;
    let normal = select(point.normal, -point.normal, is_behind);
    return SurfacePoint(point.position, normal, point.error);
}

fn Frame_around(z: vec3<f32>) -> Frame {
    let sign_ = select(1.0f, -1.0f, (z.z < 0.0f));
    let a = -1.0f / (sign_ + z.z);
    let b = z.x * z.y * a;
    return Frame(vec3<f32>(params.lit_1_0 + sign_ * (z.x * z.x * a), sign_ * b, -sign_ * z.x), vec3<f32>(b, sign_ + z.y * z.y * a, -z.y), z);
}

fn offset_origin(position: vec3<f32>, normal: vec3<f32>, error: f32, direction: vec3<f32>) -> vec3<f32> {
    let shift = select(error, -error, (normal.x * direction.x + normal.y * direction.y + normal.z * direction.z < 0.0f));
    return position + normal * shift;
}

fn SurfacePoint_ray(self_: SurfacePoint, direction: vec3<f32>) -> Ray {
    let origin = offset_origin(self_.position, self_.normal, self_.error, direction);
    return Ray(origin, direction, 0.0f, 340282346638528859811704183484516925440.0f);
}

fn words_of(key: vec2<u32>, index: u32, dimension: u32) -> vec4<u32> {
    return pcg4d(vec4<u32>(key.x, key.y, dimension, index));
}

fn unit_f32(bits: u32) -> f32 {
    return f32(bits >> 8u) * 5.9604645e-8f;
}

fn unit_square(words: vec4<u32>) -> vec2<f32> {
    return vec2<f32>(unit_f32(words.x), unit_f32(words.y));
}

fn random_point(key: vec2<u32>, index: u32, dimension: u32) -> vec2<f32> {
    return unit_square(words_of(key, index, dimension));
}

fn Sampler_next_2d(self_: Sampler) -> Tuple {
    let self_key = self_.key;
    let self_index = self_.index;
    var self_dimension: u32 = self_.dimension;
    let dimension = self_dimension;
    self_dimension = dimension + 2u;
    return Tuple(random_point(self_key, self_index, dimension), Sampler(vec2<u32>(0u), 0u, self_dimension));
}

fn turned(x: f32, sign_: u32) -> f32 {
    return bitcast<f32>(bitcast<u32>(x) ^ (sign_ & 2147483648u));
}

fn sincos_2pi(u: f32) -> SinCos {
    let a = abs(u);
    let turn = a - floor(a);
    let n = floor(4.0f * turn + params.lit_0_5);
    let r = turn - 0.25f * n;
    let z = r * r;
    let s = r * (params.lit_6_2831855 + z * (params.lit_m41_341873 + z * (params.lit_81_62744 + z * params.lit_m76_8646)));
    let c = params.lit_1_0 + z * (params.lit_m19_739208 + z * (params.lit_64_93914 + z * (params.lit_m85_42312 + z * params.lit_58_561153)));
    let quarters = saturate_u32(n);
    let is_odd = (quarters & 1u) != 0u;
    let sin = select(s, c, is_odd);
    let cos = select(c, s, is_odd);
    let sin_1 = turned(sin, (quarters << 30u)) + params.lit_0_0;
    let cos_1 = turned(cos, ((quarters + 1u) << 30u)) + params.lit_0_0;
    return SinCos(turned(sin_1, bitcast<u32>(u)), cos_1);
}

fn sample_concentric_disk(u: vec2<f32>) -> vec2<f32> {
    let x = 2.0f * u.x - params.lit_1_0;
    let y = 2.0f * u.y - params.lit_1_0;
    let is_wide = abs(x) > abs(y);
    let radius = select(y, x, is_wide);
    let other = select(x, y, is_wide);
    var share: f32;
    share = other / radius;
    let around = sincos_2pi(0.125f * share);
    let along = radius * around.cos;
    let aside = radius * around.sin;
    var result: vec2<f32>;
    if (is_wide) {
        result = vec2<f32>(along, aside);
    } else {
        result = vec2<f32>(aside, along);
    }
    return result;
}

fn concentric_radius(u: vec2<f32>) -> f32 {
    let t = abs(2.0f * u.x - params.lit_1_0);
    let t_1 = abs(2.0f * u.y - params.lit_1_0);
    return select(t, t_1, t < t_1);
}

fn sample_cosine_hemisphere(u: vec2<f32>) -> vec3<f32> {
    let p = sample_concentric_disk(u);
    let radius = concentric_radius(u);
    let z = sqrt((params.lit_1_0 - radius) * (params.lit_1_0 + radius));
    return vec3<f32>(p.x, p.y, z);
}

fn Frame_to_world(self_: Frame, v: vec3<f32>) -> vec3<f32> {
    return self_.x * v.x + self_.y * v.y + self_.z * v.z;
}

fn bvh_any_hit(ray: Ray) -> bool {
    let limit = ray.t_max;
    var stack: array<u32, 64>;
    var top = 0u;
    var node = bvh_nodes_at(0u);
    let s = slabs(ray, node.min, node.max, 9.536743e-7);
    let root = enter_leave(s, node.min, node.max, ray.t_min, limit);
    if (!(root.x <= root.y)) {
        return false;
    }
    loop {
        if (node.count > 0u) {
            for (var i = node.first; i < node.first + node.count; i = i + 1u) {
                let id = bvh_ids_at(i);
                if (is_within(Face_intersect(bvh_at(id), ray), ray)) {
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
                if (left_first) {
                    node = left;
                } else {
                    node = right;
                }
                continue;
            }
            if (hit_left) {
                node = left;
                continue;
            }
            if (hit_right) {
                node = right;
                continue;
            }
        }
        if (top == 0u) {
            break;
        }
        top = top - 1u;
        node = bvh_nodes_at(stack[top]);
    }
    return false;
}

fn ambient_occlusion(radius: f32, ray: Ray, sampler_: Sampler) -> vec4<f32> {
    let hit = bvh_closest_hit(ray);
    if (!hit.is_hit) {
        return vec4<f32>(0.0f);
    }
    let point = facing(Face_surface(bvh_element(select(0u, hit.prim_id, hit.is_hit)), hit), ray.direction);
    let frame = Frame_around(point.normal);
    let sampler_key = sampler_.key;
    let sampler_index = sampler_.index;
    var sampler_dimension: u32 = sampler_.dimension;
    let t = SurfacePoint_ray(point, point.normal);
    var rays_0_origin: vec3<f32> = t.origin;
    var rays_0_direction: vec3<f32> = t.direction;
    var rays_0_t_min: f32 = t.t_min;
    var rays_0_t_max: f32 = t.t_max;
    var rays_1_origin: vec3<f32> = t.origin;
    var rays_1_direction: vec3<f32> = t.direction;
    var rays_1_t_min: f32 = t.t_min;
    var rays_1_t_max: f32 = t.t_max;
    var i: u32 = 0u;
    for (; i < 2u; i = i + 1u) {
        let sampler_key_1 = sampler_key;
        let sampler_index_1 = sampler_index;
        let sampler_dimension_1 = sampler_dimension;
        let t_1 = Sampler_next_2d(Sampler(sampler_key_1, sampler_index_1, sampler_dimension_1));
        sampler_dimension = t_1._1.dimension;
        let direction = sample_cosine_hemisphere(t_1._0);
        let t_2 = SurfacePoint_ray(point, Frame_to_world(frame, direction));
        let t_3 = i == 0u;
        let t_4 = i >= 1u;
        rays_0_direction = vec3<f32>(select(rays_0_direction.x, t_2.direction.x, t_3), select(rays_0_direction.y, t_2.direction.y, t_3), select(rays_0_direction.z, t_2.direction.z, t_3));
        rays_0_t_max = select(rays_0_t_max, radius, t_3);
        rays_1_direction = vec3<f32>(select(rays_1_direction.x, t_2.direction.x, t_4), select(rays_1_direction.y, t_2.direction.y, t_4), select(rays_1_direction.z, t_2.direction.z, t_4));
        rays_1_t_max = select(rays_1_t_max, radius, t_4);
    }
    var each_0: bool = false;
    var each_1: bool = false;
    var i_1: u32 = 0u;
    for (; i_1 < 2u; i_1 = i_1 + 1u) {
        let t_5 = i_1 >= 1u;
        let t_6 = bvh_any_hit(Ray(vec3<f32>(select(rays_0_origin.x, rays_1_origin.x, t_5), select(rays_0_origin.y, rays_1_origin.y, t_5), select(rays_0_origin.z, rays_1_origin.z, t_5)), vec3<f32>(select(rays_0_direction.x, rays_1_direction.x, t_5), select(rays_0_direction.y, rays_1_direction.y, t_5), select(rays_0_direction.z, rays_1_direction.z, t_5)), select(rays_0_t_min, rays_1_t_min, t_5), select(rays_0_t_max, rays_1_t_max, t_5)));
        each_0 = select(each_0, t_6, (i_1 == 0u));
        each_1 = select(each_1, t_6, (i_1 >= 1u));
    }
    let each_0_1 = each_0;
    let each_1_1 = each_1;
    var open: f32 = 0.0f;
    var i_1_1: u32 = 0u;
    for (; i_1_1 < 2u; i_1_1 = i_1_1 + 1u) {
        let is_closed = select(each_0_1, each_1_1, (i_1_1 >= 1u));
        open = open + select(1.0f, 0.0f, is_closed);
    }
    let light = open / 2.0f;
    return vec4<f32>(light, light, light, 1.0f);
}

fn open_sky(ray: Ray, pixel_: vec2<u32>) -> vec4<f32> {
    return ambient_occlusion(1.0f, ray, sampler_of(pixel_));
}

fn kernel(ray: Ray, pixel_: vec2<u32>) -> vec4<f32> {
    return open_sky(ray, pixel_);
}

fn pixel(x: u32, y: u32) -> vec4<f32> {
    let t = pixel_centre(vec2<u32>(x, y));
    return kernel(PinholeRays_primary_ray(PinholeRays(params.camera_origin, params.camera_corner, params.camera_right, params.camera_up), t.x, t.y), vec2<u32>(x, y));
}

@group(0) @binding(3) var<storage, read_write> outputs: array<StoredVec4>;
@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) {
        return;
    }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = pixel(at.x, at.y);
    outputs[index] = StoredVec4(vec4<f32>(result.x, result.y, result.z, result.w));
}
