// Paths among diffuse triangles and lamps of triangles, with a light sampled at each bounce, as one
// would write it for this scene alone: what a path carries is in variables, a hit is four numbers, and
// no normal, colour or random number is there that nothing reads. What only arithmetic is, such as the
// samples of a spherical triangle, has the operations of the library in the same order.

struct Node { low: vec3<f32>, first: u32, high: vec3<f32>, count: u32 }
struct Job { size: vec2<u32>, first: vec2<u32>, count: vec2<u32>, base: u32, pad: u32 }

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<uniform> job: Job;
@group(0) @binding(3) var<storage, read_write> pixels: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> corners: array<f32>;
@group(0) @binding(5) var<storage, read> nodes: array<Node>;
@group(0) @binding(6) var<storage, read> ids: array<u32>;
@group(0) @binding(7) var<storage, read> lamps: array<Lamp>;
@group(0) @binding(8) var<storage, read> cdf: array<f32>;

struct Lamp {
    ax: f32, ay: f32, az: f32, bx: f32, by: f32, bz: f32, cx: f32, cy: f32, cz: f32,
    red: f32, green: f32, blue: f32, is_two_sided: u32,
}
struct Corners { a: vec3<f32>, b: vec3<f32>, c: vec3<f32> }
struct Point { position: vec3<f32>, normal: vec3<f32>, error: f32 }
struct Sample { wi: vec3<f32>, point: Point, pdf: f32 }
struct Slabs { lower: vec3<f32>, upper: vec3<f32>, inverse: vec3<f32> }

const FAR = 340282346638528859811704183484516925440.0f;
const SLACK = 9.536743e-7f;
const TINY = 1.1754944e-38f;
const REFLECTANCE = 0.8f;
const MISS = vec4(0.0, -1.0, 0.0, 0.0);

fn dot3(a: vec3<f32>, b: vec3<f32>) -> f32 { return a.x * b.x + a.y * b.y + a.z * b.z; }
fn cross3(a: vec3<f32>, b: vec3<f32>) -> vec3<f32> { return a.yzx * b.zxy - b.yzx * a.zxy; }
fn unit(v: vec3<f32>) -> vec3<f32> { return v * (1.0 / sqrt(dot3(v, v))); }
fn length3(v: vec3<f32>) -> f32 { return sqrt(dot3(v, v)); }
fn least_of(a: f32, b: f32) -> f32 { return select(a, b, b < a); }
fn most_of(a: f32, b: f32) -> f32 { return select(a, b, a < b); }
fn largest(v: vec3<f32>) -> f32 { return max(max(v.x, v.y), v.z); }
fn size_of(v: vec3<f32>) -> f32 { return most_of(most_of(abs(v.x), abs(v.y)), abs(v.z)); }

// Random numbers: pcg4d of pixel, dimension and index.
fn crossed(v: vec4<u32>) -> vec4<u32> {
    let x = v.x + v.y * v.w;
    let y = v.y + v.z * x;
    let z = v.z + x * y;
    return vec4(x, y, z, v.w + y * z);
}
fn pcg4d(v: vec4<u32>) -> vec4<u32> {
    let m = crossed(v * 1664525u + 1013904223u);
    return crossed(m ^ (m >> vec4(16u)));
}
fn random(key: vec2<u32>, dimension: u32) -> vec2<f32> {
    return vec2<f32>(pcg4d(vec4(key, dimension, 0u)).xy >> vec2(8u)) * 5.9604645e-8f;
}
fn random3(key: vec2<u32>, dimension: u32) -> vec3<f32> {
    return vec3(random(key, dimension), random(key, dimension + 2u).x);
}

// Triangles.
fn triangle(k: u32) -> Corners {
    let i = 9u * k;
    return Corners(
        vec3(corners[i], corners[i + 1u], corners[i + 2u]),
        vec3(corners[i + 3u], corners[i + 4u], corners[i + 5u]),
        vec3(corners[i + 6u], corners[i + 7u], corners[i + 8u]),
    );
}
fn kept(a: vec3<f32>) -> vec3<f32> { return select(a, vec3(FAR), vec3(FAR) < a); }
fn upper_half(a: vec3<f32>) -> vec3<f32> {
    let wide = a * 4097.0;
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
    return a - (difference + part) + (part - b);
}
fn exact_cross(a: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    let lost = lost_by_product(a.yzx, b.zxy);
    let lost_too = lost_by_product(a.zxy, b.yzx);
    return kept(kept(cross3(a, b)) + (lost - lost_too)) + lost_by_difference(lost, lost_too);
}
fn is_line(t: Corners) -> bool {
    let lost = abs(lost_by_difference(t.b, t.a)) + abs(lost_by_difference(t.c, t.a))
        + abs(exact_cross(t.b - t.a, t.c - t.a));
    return lost.x + lost.y + lost.z == 0.0;
}
fn is_inside(s: vec3<f32>) -> bool {
    return least_of(least_of(s.x, s.y), s.z) >= 0.0 || most_of(most_of(s.x, s.y), s.z) <= 0.0;
}
fn axis_last(v: vec3<f32>, k: u32) -> vec3<f32> {
    return vec3(
        select(v.x, v.z, k == 0u), select(v.y, v.z, k == 1u), select(select(v.z, v.y, k == 1u), v.x, k == 0u),
    );
}
// Returns whether the ray hits a triangle (1 or 0), the distance, and the weights of b and c.
fn intersect(o: vec3<f32>, d: vec3<f32>, t_max: f32, t: Corners) -> vec4<f32> {
    let size = abs(d);
    let k = select(select(2u, 1u, size.y > size.z), 0u, size.x > size.y && size.x > size.z);
    let e = axis_last(d, k);
    let a = axis_last(t.a - o, k);
    let b = axis_last(t.b - o, k);
    let c = axis_last(t.c - o, k);
    let slope = e.xy / e.z;
    let p = a.xy - slope * a.z;
    let q = b.xy - slope * b.z;
    let r = c.xy - slope * c.z;
    var sides = vec3(q.y * r.x - q.x * r.y, r.y * p.x - r.x * p.y, p.y * q.x - p.x * q.y);
    let low = vec2(least_of(least_of(p.x, q.x), r.x), least_of(least_of(p.y, q.y), r.y));
    let high = vec2(most_of(most_of(p.x, q.x), r.x), most_of(most_of(p.y, q.y), r.y));
    if (!is_inside(sides) || !(low.x <= 0.0 && high.x >= 0.0 && low.y <= 0.0 && high.y >= 0.0)) { return MISS; }
    var sum = sides.x + sides.y + sides.z;
    let near = least_of(least_of(a.z, b.z), c.z);
    let far = most_of(most_of(a.z, b.z), c.z);
    let products = abs(r.x * q.y) + abs(p.x * r.y) + abs(q.x * p.y);
    if (2.0 * abs(sum) <= products * ((far - near) / most_of(abs(near), abs(far)))) {
        let scale = select(1.0, 1.1529215e18f, products < 8.6736174e-19f);
        sides = exact_cross(vec3(p.y, q.y, r.y) * scale, vec3(p.x, q.x, r.x) * scale);
        sum = select(0.0, sides.x + sides.y + sides.z, is_inside(sides));
    }
    if (sum == 0.0) { return MISS; }
    let w = sides / sum;
    let distance = (w.x * a.z + w.y * b.z + w.z * c.z) * (1.0 / e.z);
    if (all(cross3(t.b - t.a, t.c - t.a) == vec3(0.0)) && is_line(t)) { return MISS; }
    return vec4(select(0.0, 1.0, distance >= 0.0 && distance <= t_max), distance, w.y, w.z);
}

// The tree.
fn all_finite(v: vec3<f32>) -> bool {
    return all((bitcast<vec3<u32>>(v) & vec3(0x7fffffffu)) < vec3(0x7f800000u));
}
fn at_least(x: f32, size: f32) -> f32 { return select(x, select(size, -size, x < 0.0), abs(x) < size); }
fn slabs(o: vec3<f32>, d: vec3<f32>, root: Node) -> Slabs {
    let padding = abs(o) * 1.1920929e-7f + max(SLACK * largest(max(abs(root.low - o), abs(root.high - o))), TINY);
    let least = max(largest(abs(d)) * 8.6736174e-19f, TINY);
    let inverse = 1.0 / vec3(at_least(d.x, least), at_least(d.y, least), at_least(d.z, least));
    return Slabs(o + padding, o - padding, inverse);
}
fn span(s: Slabs, node: Node, limit: f32) -> vec2<f32> {
    let a = (node.low - s.lower) * s.inverse;
    let b = (node.high - s.upper) * s.inverse;
    let near = min(a, b);
    let far = max(a, b);
    return vec2(max(max(near.x, near.y), max(0.0, near.z)), min(min(far.x, far.y), min(limit, far.z)));
}
struct Found { id: u32, t: f32, weights: vec2<f32> }
const NOTHING = 0xffffffffu;
fn closest(o: vec3<f32>, d: vec3<f32>) -> Found {
    var best = Found(NOTHING, FAR, vec2(0.0));
    if (params.len_of_scene_nodes == 0u || !all_finite(o) || !all_finite(d)) { return best; }
    var node = nodes[0];
    let s = slabs(o, d, node);
    var limit = FAR;
    let root = span(s, node, limit);
    if (!(root.x <= root.y)) { return best; }
    var stack: array<u32, 64>;
    var stack_t: array<f32, 64>;
    var top = 0u;
    loop {
        if (node.count > 0u) {
            for (var i = node.first; i < node.first + node.count; i++) {
                let k = ids[i];
                let hit = intersect(o, d, FAR, triangle(k));
                if (hit.x > 0.0 && (hit.y < best.t || (hit.y == best.t && k < best.id))) {
                    best = Found(k, hit.y, hit.zw);
                    limit = hit.y + hit.y * SLACK;
                }
            }
        } else {
            let left = nodes[node.first];
            let right = nodes[node.first + 1u];
            let l = span(s, left, limit);
            let r = span(s, right, limit);
            let hit_left = l.x <= l.y;
            let hit_right = r.x <= r.y;
            if (hit_left && hit_right) {
                let left_first = l.x <= r.x;
                stack[top] = select(node.first, node.first + 1u, left_first);
                stack_t[top] = select(l.x, r.x, left_first);
                top++;
                if (left_first) { node = left; } else { node = right; }
                continue;
            }
            if (hit_left) { node = left; continue; }
            if (hit_right) { node = right; continue; }
        }
        var is_open = false;
        while (top > 0u && !is_open) {
            top--;
            is_open = stack_t[top] <= limit;
        }
        if (!is_open) { break; }
        node = nodes[stack[top]];
    }
    return best;
}
fn is_occluded(o: vec3<f32>, d: vec3<f32>) -> bool {
    if (params.len_of_scene_nodes == 0u || !all_finite(o) || !all_finite(d)) { return false; }
    var node = nodes[0];
    let s = slabs(o, d, node);
    let root = span(s, node, 1.0);
    if (!(root.x <= root.y)) { return false; }
    var stack: array<u32, 64>;
    var top = 0u;
    loop {
        if (node.count > 0u) {
            for (var i = node.first; i < node.first + node.count; i++) {
                if (intersect(o, d, 1.0, triangle(ids[i])).x > 0.0) { return true; }
            }
        } else {
            let left = nodes[node.first];
            let right = nodes[node.first + 1u];
            let l = span(s, left, 1.0);
            let r = span(s, right, 1.0);
            let hit_left = l.x <= l.y;
            let hit_right = r.x <= r.y;
            if (hit_left && hit_right) {
                let left_first = l.x <= r.x;
                stack[top] = select(node.first, node.first + 1u, left_first);
                top++;
                if (left_first) { node = left; } else { node = right; }
                continue;
            }
            if (hit_left) { node = left; continue; }
            if (hit_right) { node = right; continue; }
        }
        if (top == 0u) { break; }
        top--;
        node = nodes[stack[top]];
    }
    return false;
}

// Points of surfaces.
fn across(a: vec3<f32>, b: vec3<f32>) -> vec3<f32> { return unit(cross3(a / size_of(a), b / size_of(b))); }
fn point_of(t: Corners, w: vec2<f32>) -> Point {
    let e1 = t.b - t.a;
    let e2 = t.c - t.a;
    let size = most_of(most_of(size_of(e1), size_of(e2)), size_of(e2 - e1));
    let position = t.a + (e1 * w.x + e2 * w.y);
    let normal = across(e1, e2);
    return Point(position, normal, dot3(abs(normal), abs(position)) * 1.7881393e-7f + size * 4.7683716e-7f);
}
fn offset(p: Point, direction: vec3<f32>) -> vec3<f32> {
    return p.position + p.normal * select(p.error, -p.error, dot3(p.normal, direction) < 0.0);
}
fn around(z: vec3<f32>) -> mat3x3<f32> {
    let sign_ = select(1.0, -1.0, z.z < 0.0);
    let a = -1.0 / (sign_ + z.z);
    let b = z.x * z.y * a;
    return mat3x3(
        vec3(1.0 + sign_ * (z.x * z.x * a), sign_ * b, -sign_ * z.x), vec3(b, sign_ + z.y * z.y * a, -z.y), z,
    );
}
fn to_world(f: mat3x3<f32>, v: vec3<f32>) -> vec3<f32> { return f[0] * v.x + f[1] * v.y + f[2] * v.z; }
fn to_local(f: mat3x3<f32>, v: vec3<f32>) -> vec3<f32> { return vec3(dot3(f[0], v), dot3(f[1], v), dot3(f[2], v)); }
// The frame of shading around a normal, which is bent until it faces the viewer.
fn shading_frame(normal: vec3<f32>, to_viewer: vec3<f32>) -> mat3x3<f32> {
    let tangent = around(normal)[0];
    let side = select(1.0, -1.0, dot3(normal, to_viewer) < 0.0);
    let cos = dot3(normal, to_viewer) * side;
    let z = select(normal, unit(normal + to_viewer * (side * (0.001f - cos))), cos < 0.001f);
    let along = tangent - z * dot3(z, tangent);
    let squared = dot3(along, along);
    var x = around(z)[0];
    if (squared > 1e-12f) { x = along / sqrt(squared); }
    x = unit(x - z * dot3(z, x));
    return mat3x3(x, cross3(z, x), z);
}

// Elementary functions.
fn turned(x: f32, sign_: u32) -> f32 { return bitcast<f32>(bitcast<u32>(x) ^ (sign_ & 0x80000000u)); }
fn angle_of(y: f32, x: f32) -> f32 {
    let width = abs(x);
    let height = abs(y);
    var long = most_of(width, height);
    var short = least_of(width, height);
    if (long > FAR || long == 0.0) {
        short = select(0.0, 1.0, short > FAR);
        long = 1.0;
    }
    let scale = select(select(1.0, 0.25, long > 1e19f), 16777216.0, long < 7.888609e-31f);
    long *= scale;
    short *= scale;
    let is_middle = short > 0.41421357f * long;
    let q = select(short, short - long, is_middle) / select(long, short + long, is_middle);
    let is_high = height > width;
    let is_left = (bitcast<u32>(x) >> 31u) != 0u;
    var k = u32(is_middle);
    k = select(k, 2u - k, is_high);
    k = select(k, 4u - k, is_left);
    let r = turned(q, (u32(is_high) ^ u32(is_left)) << 31u);
    let z = r * r;
    let p = -0.14244422f + z * (0.10599357f + z * -0.060903553f);
    let rest = r * z * (-0.33333316f + z * (0.1999853f + z * p));
    let angle = f32(k) * 0.78515625f + (r + (rest + f32(k) * 0.0002419134f));
    let is_nan = (bitcast<u32>(x) & 0x7fffffffu) > 0x7f800000u || (bitcast<u32>(y) & 0x7fffffffu) > 0x7f800000u;
    let signed = bitcast<f32>((bitcast<u32>(angle) & 0x7fffffffu) | (bitcast<u32>(y) & 0x80000000u));
    return select(signed, params.nan, is_nan);
}
// Sine and cosine of a part of a turn.
fn circle(u: f32) -> vec2<f32> {
    let turn = abs(u) - floor(abs(u));
    let n = floor(4.0 * turn + 0.5);
    let r = turn - 0.25 * n;
    let z = r * r;
    let s = r * (6.2831855f + z * (-41.341873f + z * (81.62744f + z * -76.8646f)));
    let c = 1.0 + z * (-19.739208f + z * (64.93914f + z * (-85.42312f + z * 58.561153f)));
    let quarters = u32(clamp(n, 0.0, 4.0));
    let is_odd = (quarters & 1u) != 0u;
    let sin = turned(select(s, c, is_odd), quarters << 30u) + 0.0;
    let cos = turned(select(c, s, is_odd), (quarters + 1u) << 30u) + 0.0;
    return vec2(turned(sin, bitcast<u32>(u)), cos);
}

// Lamps.
fn spanned(a: vec3<f32>, b: vec3<f32>) -> f32 {
    let of_a = size_of(a);
    let of_b = size_of(b);
    if (of_a > 0.0 && of_b > 0.0) { return length3(cross3(a / of_a, b / of_b)) * of_a * of_b; }
    return 0.0;
}
fn pdf_by_area(p: Point, area: f32, from_: vec3<f32>) -> f32 {
    let way = p.position - from_;
    let cosine = abs(dot3(way, p.normal));
    let pdf = dot3(way, way) * length3(way) / (area * cosine);
    return select(0.0, pdf, area > 0.0 && cosine > 0.0 && pdf < 1e30f);
}
fn volume_of(t: Corners, p: vec3<f32>) -> f32 { return abs(dot3(p, cross3(t.b - t.a, t.c - t.a))); }
fn solid_angle(from_: vec3<f32>, t: Corners) -> f32 {
    let a = t.a - from_;
    let b = t.b - from_;
    let c = t.c - from_;
    let l = vec3(length3(a), length3(b), length3(c));
    let base = l.x * l.y * l.z + dot3(a, b) * l.z + dot3(a, c) * l.y + dot3(b, c) * l.x;
    return 2.0 * angle_of(volume_of(t, a), base);
}
fn is_beside(from_: vec3<f32>, t: Corners) -> bool {
    let n = cross3(t.b - t.a, t.c - t.a);
    return abs(dot3(n, t.a - from_)) > 1e-6f * length3(n) * (length3(from_) + length3(t.a));
}
fn lamp_pdf(from_: vec3<f32>, at: Point, t: Corners) -> f32 {
    let by_area = pdf_by_area(at, 0.5 * spanned(t.b - t.a, t.c - t.a), from_);
    let angle = solid_angle(from_, t);
    var by_angle = 0.15915494f;
    if (!(angle > 6.2f)) { by_angle = 1.0 / angle; }
    return select(0.0, select(by_area, by_angle, angle > 0.0001f), is_beside(from_, t));
}
fn spherical_sample(u: vec2<f32>, from_: vec3<f32>, t: Corners) -> vec3<f32> {
    let pa = t.a - from_;
    let pb = t.b - from_;
    let pc = t.c - from_;
    let l = vec3(length3(pa), length3(pb), length3(pc));
    let a = pa / l.x;
    let b = pb / l.y;
    let c = pc / l.z;
    let volume = volume_of(t, pa) / (l.x * l.y * l.z);
    let ab = dot3(a, b);
    let ac = dot3(a, c);
    let bc = dot3(b, c);
    let angle = 2.0 * angle_of(volume, 1.0 + ab + (ac + bc));
    let half = circle(0.5 * angle * u.x * 0.15915494f);
    let shift = a * (volume * half.y - (ac + bc) * half.x) + c * ((1.0 + ab) * half.x);
    let squared = most_of(dot3(shift, shift), TINY);
    let cut = shift * (2.0 * dot3(a, shift) / squared) - a;
    let cos_side = dot3(b, cut);
    let cos = 1.0 + (cos_side - 1.0) * u.y;
    let sine2 = (1.0 - cos_side) * (1.0 + cos_side);
    let left = (1.0 - cos) * (1.0 + cos);
    let ratio = sqrt(select(left, 0.0, left < 0.0) / select(sine2, TINY, sine2 < TINY));
    let share = select(u.y, ratio, sine2 > 0.0);
    let bounded = select(cos_side, -1.0, cos_side < -1.0);
    return unit(b * (cos - share * select(bounded, 1.0, 1.0 < bounded)) + cut * share);
}
// The weights of the point of a triangle's plane that is seen in a direction.
fn on_plane(from_: vec3<f32>, wi: vec3<f32>, t: Corners) -> vec2<f32> {
    let e1 = t.b - t.a;
    let e2 = t.c - t.a;
    let c = cross3(e1, e2);
    let squared = dot3(c, c);
    let n = c / select(squared, TINY, squared < TINY);
    let facing = dot3(c, wi);
    var distance = 0.0;
    if (facing != 0.0) { distance = dot3(c, t.a - from_) / facing; }
    let p = from_ + wi * distance - t.a;
    return vec2(dot3(n, cross3(p, e2)), dot3(n, cross3(e1, p)));
}
fn sample_lamp(from_: vec3<f32>, u: vec2<f32>, t: Corners) -> Sample {
    let angle = solid_angle(from_, t);
    let is_seen = is_beside(from_, t);
    if (angle <= 0.0001f || !is_seen) {
        // By area.
        let is_low = u.y < u.x;
        let least = 0.5 * select(u.x, u.y, is_low);
        let p = point_of(t, vec2(select(least, u.x - least, is_low), select(u.y - least, least, is_low)));
        let area = 0.5 * spanned(t.b - t.a, t.c - t.a);
        let way = p.position - from_;
        let squared = dot3(way, way);
        if (!(is_seen && squared > 1e-30f && area > 0.0)) { return Sample(vec3(0.0, 0.0, 1.0), p, 0.0); }
        return Sample(way / sqrt(squared), p, pdf_by_area(p, area, from_));
    }
    var wi: vec3<f32>;
    var pdf = 1.0 / angle;
    if (angle > 6.2f) {
        // From so near that it is half of all directions.
        let c = cross3(t.b - t.a, t.c - t.a);
        let squared = dot3(c, c);
        let n = c / sqrt(select(squared, TINY, squared < TINY));
        let away = select(n, -n, dot3(n, t.a - from_) < 0.0);
        let r2 = u.x * (2.0 - u.x);
        let r = sqrt(select(r2, 0.0, r2 < 0.0));
        let turn = circle(u.y);
        wi = to_world(around(away), vec3(r * turn.y, r * turn.x, 1.0 - u.x));
        let b = on_plane(from_, wi, t);
        pdf = select(0.0, 0.15915494f, b.x >= 0.0 && b.y >= 0.0 && b.x + b.y <= 1.0);
    } else {
        wi = spherical_sample(u, from_, t);
    }
    let b = on_plane(from_, wi, t);
    let w = select(b, vec2(0.0), b < vec2(0.0));
    let sum = w.x + w.y;
    return Sample(wi, point_of(t, w / select(sum, 1.0, sum < 1.0)), pdf);
}
// The weight of one strategy against another. (Veach 1997)
fn power(a: f32, b: f32) -> f32 {
    if (a > b) {
        let r = b / a;
        return 1.0 / (1.0 + r * r);
    }
    var r = 0.0;
    if (a != 0.0) { r = a / b; }
    return r * r / (1.0 + r * r);
}
fn lamp_at(i: u32) -> Lamp { return lamps[min(i, max(params.len_of_lights, 1u) - 1u)]; }
fn cdf_at(i: u32) -> f32 { return cdf[min(i, max(params.len_of_lights_cdf, 1u) - 1u)]; }
fn corners_of(l: Lamp) -> Corners {
    return Corners(vec3(l.ax, l.ay, l.az), vec3(l.bx, l.by, l.bz), vec3(l.cx, l.cy, l.cz));
}
// The light of a lamp towards a direction.
fn emitted(l: Lamp, normal: vec3<f32>, out: vec3<f32>) -> vec3<f32> {
    let is_lit = (l.is_two_sided & 0xffu) != 0u || dot3(normal, out) > 0.0;
    return select(vec3(0.0), vec3(l.red, l.green, l.blue), is_lit);
}
fn chosen(u: f32) -> u32 {
    var low = 0u;
    var high = params.len_of_lights_cdf - 1u;
    while (low + 1u < high) {
        let middle = (low + high) / 2u;
        if (cdf_at(middle) <= u) { low = middle; } else { high = middle; }
    }
    return low;
}
fn chance(i: u32) -> f32 { return cdf_at(i + 1u) - cdf_at(i); }
fn cosine_pdf(wo: vec3<f32>, wi: vec3<f32>) -> f32 {
    return select(0.0, abs(wi.z) * 0.31830987f, wo.z * wi.z > 0.0);
}
fn cosine_sample(wo: vec3<f32>, u: vec2<f32>) -> vec3<f32> {
    let c = 2.0 * u - 1.0;
    let is_wide = abs(c.x) > abs(c.y);
    let radius = select(c.y, c.x, is_wide);
    var share = 0.0;
    if (radius != 0.0) { share = select(c.x, c.y, is_wide) / radius; }
    let turn = radius * circle(0.125 * share);
    let most = most_of(abs(c.x), abs(c.y));
    let z = sqrt((1.0 - most) * (1.0 + most));
    return vec3(select(turn, turn.yx, is_wide), select(z, -z, wo.z < 0.0));
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let pixel = job.first + id.xy;
    let to = params.camera_corner + params.camera_right * (f32(pixel.x) + 0.5)
        + params.camera_up * (f32(pixel.y) + 0.5);
    var d = unit(to);
    var o = params.camera_origin;
    let key = pcg4d(vec4(pixel, 0u, 1398893936u)).xy;
    var from_ = o;
    var pdf = FAR;
    var throughput = vec3(1.0);
    var color = vec4(0.0);
    var dimension = 0u;
    for (var bounce = 0u; ; bounce++) {
        let ahead = unit(d);
        let hit = closest(o, d);
        if (hit.id == NOTHING) { break; }
        color.w = 1.0;
        let at = point_of(triangle(hit.id), hit.weights);
        let frame = shading_frame(at.normal, -ahead);
        let wo = to_local(frame, -ahead);
        if (hit.id == 1u && params.lights_lights_count > 0u) {
            let lamp = lamp_at(0u);
            let rival = lamp_pdf(from_, at, corners_of(lamp)) * chance(0u);
            color += vec4(throughput * (emitted(lamp, at.normal, -ahead) * power(pdf, rival)), 0.0);
        }
        if (bounce == params.limits_bounces) { break; }

        // Light of a lamp.
        let u = random3(key, dimension);
        let i = chosen(u.z);
        let lamp = lamp_at(i);
        let lit = sample_lamp(at.position, u.xy, corners_of(lamp));
        let light = emitted(lamp, lit.point.normal, -lit.wi);
        let wi = to_local(frame, lit.wi);
        let light_pdf = lit.pdf * chance(i);
        if (light_pdf > 0.0 && dot3(at.normal, lit.wi) * wi.z > 0.0) {
            let own_pdf = cosine_pdf(wo, wi);
            let scattered = REFLECTANCE * own_pdf * light;
            if (any(scattered > vec3(0.0))) {
                let way = lit.point.position - at.position;
                let origin = offset(at, way);
                let error = lit.point.error + length3(way) * 9.536743e-7f;
                let end = offset(Point(lit.point.position, lit.point.normal, error), -way);
                if (!is_occluded(origin, end - origin)) {
                    color += vec4(throughput * (scattered * (power(light_pdf, own_pdf) / light_pdf)), 0.0);
                }
            }
        }

        // The next direction.
        let next = cosine_sample(wo, random(key, dimension + 3u));
        pdf = cosine_pdf(wo, next);
        d = to_world(frame, next);
        throughput *= select(0.0, REFLECTANCE, pdf > 0.0);
        let brightest = most_of(throughput.x, most_of(throughput.y, throughput.z));
        var survival = select(1.0, 0.0, brightest <= 0.0);
        if (bounce >= params.limits_roulette) {
            let going_on = select(0.95f, brightest, brightest < 0.95f);
            survival = select(0.0, going_on, random(key, dimension + 6u).x < going_on);
        }
        dimension += 7u;
        if (survival <= 0.0 || !(dot3(at.normal, d) * next.z > 0.0)) { break; }
        throughput /= survival;
        o = offset(at, d);
        from_ = at.position;
    }
    pixels[pixel.y * job.size.x + pixel.x - job.base] = color;
}
