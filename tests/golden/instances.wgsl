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

struct TraversalLevel {
    ray: Ray,
    place: u32,
    first: u32,
    bottom: u32,
}

struct InstanceTraversal {
    here: TraversalLevel,
    lower: vec3<f32>,
    upper: vec3<f32>,
    inverse: vec3<f32>,
    next: u32,
    last: u32,
    top: u32,
    level: u32,
    levels: array<TraversalLevel, 9>,
    nodes: array<u32, 128>,
    enters: array<f32, 128>,
}

struct NextPrimitive {
    ray: Ray,
    id: u32,
    inst: u32,
}

struct Mat3 {
    x_axis: vec3<f32>,
    y_axis: vec3<f32>,
    z_axis: vec3<f32>,
}

struct Affine3 {
    matrix3: Mat3,
    translation: vec3<f32>,
}

struct Place {
    to_object: Affine3,
    root: u32,
    first: u32,
    slack: f32,
    origin: f32,
    items: u32,
    count: u32,
}

struct Node {
    min: vec3<f32>,
    first: u32,
    max: vec3<f32>,
    count: u32,
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

struct Tuple {
    _0: u32,
    _1: vec3<f32>,
    _2: bool,
}

struct Tuple_1 {
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

struct StoredPlace {
    to_object_matrix3_x_axis_x: f32,
    to_object_matrix3_x_axis_y: f32,
    to_object_matrix3_x_axis_z: f32,
    to_object_matrix3_y_axis_x: f32,
    to_object_matrix3_y_axis_y: f32,
    to_object_matrix3_y_axis_z: f32,
    to_object_matrix3_z_axis_x: f32,
    to_object_matrix3_z_axis_y: f32,
    to_object_matrix3_z_axis_z: f32,
    to_object_translation_x: f32,
    to_object_translation_y: f32,
    to_object_translation_z: f32,
    root: u32,
    first: u32,
    slack: f32,
    origin: f32,
    items: u32,
    count: u32,
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
    arg1_x: f32,
    arg1_y: f32,
    arg1_z: f32,
    arg2: u32,
}

struct Params {
    lit_4097_0: f32,
    len_of_scene: u32,
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

@group(0) @binding(4) var<storage, read> scene: array<StoredTriangle>;

fn scene_at(i: u32) -> Triangle {
    let s = scene[i];
    return Triangle(vec3<f32>(s.v0_x, s.v0_y, s.v0_z), vec3<f32>(s.v1_x, s.v1_y, s.v1_z), vec3<f32>(s.v2_x, s.v2_y, s.v2_z));
}

/// The last element stands for those out of range.
fn scene_element(i: u32) -> Triangle {
    return scene_at(min(i, max(params.len_of_scene, 1u) - 1u));
}

@group(0) @binding(5) var<storage, read> scene_places: array<StoredPlace>;

fn scene_places_at(i: u32) -> Place {
    let s = scene_places[i];
    return Place(Affine3(Mat3(vec3<f32>(s.to_object_matrix3_x_axis_x, s.to_object_matrix3_x_axis_y, s.to_object_matrix3_x_axis_z), vec3<f32>(s.to_object_matrix3_y_axis_x, s.to_object_matrix3_y_axis_y, s.to_object_matrix3_y_axis_z), vec3<f32>(s.to_object_matrix3_z_axis_x, s.to_object_matrix3_z_axis_y, s.to_object_matrix3_z_axis_z)), vec3<f32>(s.to_object_translation_x, s.to_object_translation_y, s.to_object_translation_z)), s.root, s.first, s.slack, s.origin, s.items, s.count);
}

@group(0) @binding(6) var<storage, read> scene_nodes: array<Node>;

fn scene_nodes_at(i: u32) -> Node {
    return scene_nodes[i];
}

@group(0) @binding(7) var<storage, read> scene_ids: array<u32>;

fn scene_ids_at(i: u32) -> u32 {
    return scene_ids[i];
}

fn is_within(hit: Hit, ray: Ray) -> bool {
    return hit.is_hit && (hit.t >= ray.t_min && hit.t <= ray.t_max);
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
    var padding: f32 = max(slack * largest(reach), 1.1754944e-38f);
    let distant = abs(ray.origin);
    padding = padding + largest(distant) * origin;
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

/// Goes into what is placed if the ray, as it is seen there, may hit it.
fn scene_enter(w: ptr<function, InstanceTraversal>, index: u32, ray: Ray, limit: f32) {
    let place = scene_places_at(index);
    if (place.root == 4294967295u || !is_finite(ray)) {
        return;
    }
    let root = scene_nodes_at(place.root);
    let s = slabs(ray, root.min, root.max, place.slack, place.origin);
    let enter = enter_leave(s, root.min, root.max, ray.t_min, limit);
    if (!(enter.x <= enter.y)) {
        return;
    }
    (*w).levels[(*w).level] = (*w).here;
    (*w).level = (*w).level + 1u;
    (*w).here = TraversalLevel(ray, index, (*w).here.first + place.first, (*w).top);
    (*w).lower = s.lower;
    (*w).upper = s.upper;
    (*w).inverse = s.inverse;
    (*w).nodes[(*w).top] = place.root;
    (*w).enters[(*w).top] = enter.x;
    (*w).top = (*w).top + 1u;
}

/// A traversal that has yet to begin.
fn scene_begin(ray: Ray) -> InstanceTraversal {
    var w = InstanceTraversal();
    scene_enter(&w, 0u, ray, ray.t_max);
    return w;
}

fn transform_ray(ray: Ray, map: Affine3) -> Ray {
    return Ray(map.matrix3.x_axis * ray.origin.x + map.matrix3.y_axis * ray.origin.y + map.matrix3.z_axis * ray.origin.z + map.translation, map.matrix3.x_axis * ray.direction.x + map.matrix3.y_axis * ray.direction.y + map.matrix3.z_axis * ray.direction.z, ray.t_min, ray.t_max);
}

/// The next primitive that the ray may hit at or before `limit`; 4294967295u when none is left.
fn scene_next(w: ptr<function, InstanceTraversal>, limit: f32) -> NextPrimitive {
    loop {
        if ((*w).next < (*w).last) {
            let id = scene_ids_at((*w).next);
            (*w).next = (*w).next + 1u;
            if (id < 2147483648u) {
                return NextPrimitive((*w).here.ray, id, (*w).here.first);
            }
            let index = id & 2147483647u;
            let ray = transform_ray((*w).here.ray, scene_places_at(index).to_object);
            scene_enter(w, index, ray, limit);
        }
        // The next node on the stack that is not beyond the limit.
        var found = false;
        while ((*w).top > (*w).here.bottom && !found) {
            (*w).top = (*w).top - 1u;
            found = (*w).enters[(*w).top] <= limit;
        }
        if (!found) {
            if ((*w).level <= 1u) {
                break;
            }
            // Back to the group around.
            (*w).level = (*w).level - 1u;
            (*w).here = (*w).levels[(*w).level];
            let place = scene_places_at((*w).here.place);
            let root = scene_nodes_at(place.root);
            let s = slabs((*w).here.ray, root.min, root.max, place.slack, place.origin);
            (*w).lower = s.lower;
            (*w).upper = s.upper;
            (*w).inverse = s.inverse;
            continue;
        }
        var node = scene_nodes_at((*w).nodes[(*w).top]);
        let s = Slabs((*w).lower, (*w).upper, (*w).inverse);
        // Down to a leaf, the nearer child first.
        while (node.count == 0u) {
            let left = scene_nodes_at(node.first);
            let right = scene_nodes_at(node.first + 1u);
            let l = enter_leave(s, left.min, left.max, (*w).here.ray.t_min, limit);
            let r = enter_leave(s, right.min, right.max, (*w).here.ray.t_min, limit);
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
    return NextPrimitive((*w).here.ray, 4294967295u, 0u);
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

fn contract_precedes(hit: Hit, other: Hit) -> bool {
    var is_first: bool = hit.prim_id < other.prim_id;
    is_first = hit.inst_id < other.inst_id || (hit.inst_id == other.inst_id && is_first);
    return hit.t < other.t || (hit.t == other.t && is_first);
}

fn contract_is_before(hit: Hit, best: Hit) -> bool {
    return !best.is_hit || contract_precedes(hit, best);
}

fn closest_hit(ray: Ray) -> Hit {
    var best_is_hit: bool = false;
    var best_t: f32 = 0.0f;
    var best_prim_id: u32 = 0u;
    var best_inst_id: u32 = 0u;
    var best_u: f32 = 0.0f;
    var best_v: f32 = 0.0f;
    var traversal: InstanceTraversal = scene_begin(ray);
    loop {
        let next = scene_next(&traversal, select(ray.t_max, limit_behind(best_t, scene_places_at(0u).slack, ray.t_max), best_is_hit));
        if (!(next.id != 4294967295u)) { break; }
        let candidate = Triangle_intersect(scene_at(next.id), next.ray);
        if (is_within(candidate, next.ray)) {
            if (contract_is_before(Hit(candidate.is_hit, candidate.t, next.id, next.inst, candidate.u, candidate.v), Hit(best_is_hit, best_t, best_prim_id, best_inst_id, 0.0f, 0.0f))) {
                best_is_hit = candidate.is_hit;
                best_t = candidate.t;
                best_prim_id = next.id;
                best_inst_id = next.inst;
                best_u = candidate.u;
                best_v = candidate.v;
            }
        }
    }
    return Hit(best_is_hit, 0.0f, best_prim_id, best_inst_id, 0.0f, 0.0f);
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

fn normal(v0: vec3<f32>, v1: vec3<f32>, v2: vec3<f32>) -> vec3<f32> {
    return across(v1 - v0, v2 - v0);
}

fn Triangle_normal(self_: Triangle) -> vec3<f32> {
    return normal(self_.v0, self_.v1, self_.v2);
}

fn product(a: Affine3, b: Affine3) -> Affine3 {
    return Affine3(Mat3(a.matrix3.x_axis * b.matrix3.x_axis.x + a.matrix3.y_axis * b.matrix3.x_axis.y + a.matrix3.z_axis * b.matrix3.x_axis.z, a.matrix3.x_axis * b.matrix3.y_axis.x + a.matrix3.y_axis * b.matrix3.y_axis.y + a.matrix3.z_axis * b.matrix3.y_axis.z, a.matrix3.x_axis * b.matrix3.z_axis.x + a.matrix3.y_axis * b.matrix3.z_axis.y + a.matrix3.z_axis * b.matrix3.z_axis.z), a.matrix3.x_axis * b.translation.x + a.matrix3.y_axis * b.translation.y + a.matrix3.z_axis * b.translation.z + a.translation);
}

fn scene_to_object(inst: u32) -> Affine3 {
    var place = scene_places_at(0u);
    var map = place.to_object;
    var rest = inst;
    while (place.count > 0u) {
        // The last of its instances that begins at or before the one that is sought.
        var low = place.items;
        var high = place.items + place.count;
        while (high - low > 1u) {
            let middle = (low + high) / 2u;
            if (scene_places_at(middle).first <= rest) { low = middle; } else { high = middle; }
        }
        place = scene_places_at(low);
        rest = rest - place.first;
        map = product(place.to_object, map);
    }
    return map;
}

fn transform_normal_back(normal_: vec3<f32>, map: Affine3) -> vec3<f32> {
    let back = vec3<f32>(map.matrix3.x_axis.x, map.matrix3.y_axis.x, map.matrix3.z_axis.x) * normal_.x + vec3<f32>(map.matrix3.x_axis.y, map.matrix3.y_axis.y, map.matrix3.z_axis.y) * normal_.y + vec3<f32>(map.matrix3.x_axis.z, map.matrix3.y_axis.z, map.matrix3.z_axis.z) * normal_.z;
    let t = abs(back.x);
    let t_1 = abs(back.y);
    let t_2 = select(t, t_1, t < t_1);
    let t_3 = abs(back.z);
    let t_4 = back / select(t_2, t_3, t_2 < t_3);
    return t_4 * (1.0f / sqrt(t_4.x * t_4.x + t_4.y * t_4.y + t_4.z * t_4.z));
}

fn any_hit(ray: Ray) -> bool {
    var found: bool = false;
    var traversal: InstanceTraversal = scene_begin(ray);
    loop {
        let next = scene_next(&traversal, ray.t_max);
        if (!(next.id != 4294967295u)) { break; }
        let candidate = Triangle_intersect(scene_at(next.id), next.ray);
        if (is_within(candidate, next.ray)) {
            found = true;
            break;
        }
    }
    return found;
}

fn kernel(ray: Ray) -> Tuple {
    let hit = closest_hit(ray);
    let normal_ = Triangle_normal(scene_element(select(0u, hit.prim_id, hit.is_hit)));
    let normal__1 = transform_normal_back(normal_, scene_to_object(hit.inst_id));
    return Tuple(hit.inst_id, normal__1, any_hit(ray));
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
    outputs[index] = StoredTuple(result._0, result._1.x, result._1.y, result._1.z, (select(0u, 1u, result._2)));
}
