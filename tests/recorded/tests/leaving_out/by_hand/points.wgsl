// Coloured spheres in a tree, one ray for each pixel, as one would write it for this scene alone: the
// range of a camera's ray is known, a hit is a distance and a number, and nothing is passed in structs.

struct Sphere { center: vec3<f32>, radius_and_color: u32 }
struct Node { low: vec3<f32>, first: u32, high: vec3<f32>, count: u32 }
struct Pixel { red: f32, green: f32, blue: f32, depth: f32, id: u32 }
struct Job { size: vec2<u32>, first: vec2<u32>, count: vec2<u32>, base: u32, pad: u32 }

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<uniform> job: Job;
@group(0) @binding(3) var<storage, read_write> pixels: array<Pixel>;
@group(0) @binding(4) var<storage, read> spheres: array<Sphere>;
@group(0) @binding(5) var<storage, read> nodes: array<Node>;
@group(0) @binding(6) var<storage, read> ids: array<u32>;

const FAR = 340282346638528859811704183484516925440.0f;
const SLACK = 9.536743e-7f;

struct Slabs { lower: vec3<f32>, upper: vec3<f32>, inverse: vec3<f32> }

fn largest(v: vec3<f32>) -> f32 { return max(max(v.x, v.y), v.z); }

fn all_finite(v: vec3<f32>) -> bool {
    return all((bitcast<vec3<u32>>(v) & vec3(0x7fffffffu)) < vec3(0x7f800000u));
}

fn at_least(x: f32, size: f32) -> f32 {
    return select(x, select(size, -size, x < 0.0), abs(x) < size);
}

fn span(s: Slabs, node: Node, limit: f32) -> vec2<f32> {
    let a = (node.low - s.lower) * s.inverse;
    let b = (node.high - s.upper) * s.inverse;
    let near = min(a, b);
    let far = max(a, b);
    return vec2(max(max(near.x, near.y), max(0.0, near.z)), min(min(far.x, far.y), min(limit, far.z)));
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let to = params.camera_corner + params.camera_right * (f32(at.x) + 0.5) + params.camera_up * (f32(at.y) + 0.5);
    let d = to * (1.0 / sqrt(to.x * to.x + to.y * to.y + to.z * to.z));
    let o = params.camera_origin;
    var best_t = FAR;
    var best = 0xffffffffu;
    if (params.len_of_bvh_nodes > 0u && all_finite(o) && all_finite(d)) {
        var node = nodes[0];
        let padding = abs(o) * 1.1920929e-7f
            + max(SLACK * largest(max(abs(node.low - o), abs(node.high - o))), 1.1754944e-38f);
        let least = max(largest(abs(d)) * 8.6736174e-19f, 1.1754944e-38f);
        let inverse = 1.0 / vec3(at_least(d.x, least), at_least(d.y, least), at_least(d.z, least));
        let s = Slabs(o + padding, o - padding, inverse);
        let per_d2 = 1.0 / (d.x * d.x + d.y * d.y + d.z * d.z);
        var stack: array<u32, 64>;
        var stack_t: array<f32, 64>;
        var top = 0u;
        var limit = FAR;
        let root = span(s, node, limit);
        var is_open = root.x <= root.y;
        while (is_open) {
            if (node.count > 0u) {
                for (var i = node.first; i < node.first + node.count; i++) {
                    let k = ids[i];
                    let sphere = spheres[k];
                    let radius = f32(sphere.radius_and_color & 0xffu) / 255.0;
                    let f = sphere.center - o;
                    let closest = (f.x * d.x + f.y * d.y + f.z * d.z) * per_d2;
                    let aside = f - d * closest;
                    let distance = sqrt(aside.x * aside.x + aside.y * aside.y + aside.z * aside.z);
                    let radicand = (radius - distance) * (radius + distance);
                    let half = sqrt(radicand * per_d2);
                    let near = closest - half;
                    let t = select(near, closest + half, near < 0.0);
                    if (radicand >= 0.0 && radius > 0.0 && t >= 0.0
                        && (t < best_t || (t == best_t && k < best))) {
                        best_t = t;
                        best = k;
                        limit = t + t * SLACK;
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
            is_open = false;
            while (top > 0u && !is_open) {
                top--;
                is_open = stack_t[top] <= limit;
            }
            if (is_open) { node = nodes[stack[top]]; }
        }
    }
    var color = params.background;
    var depth = 0.0;
    if (best != 0xffffffffu) {
        color = vec3<f32>((vec3(spheres[best].radius_and_color) >> vec3(8u, 16u, 24u)) & vec3(0xffu)) / 255.0;
        depth = best_t;
    } else {
        best = 0u;
    }
    pixels[at.y * job.size.x + at.x - job.base] = Pixel(color.x, color.y, color.z, depth, best);
}
