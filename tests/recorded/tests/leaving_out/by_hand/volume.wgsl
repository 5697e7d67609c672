// A grid seen through a transfer function, by steps of equal length that skip empty macro-cells, as one
// would write it for this scene alone: the camera's ray has a known range, and light is in variables.

struct Knot { value: f32, extinction: f32, red: f32, green: f32, blue: f32 }
struct Job { size: vec2<u32>, first: vec2<u32>, count: vec2<u32>, base: u32, pad: u32 }

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<uniform> job: Job;
@group(0) @binding(3) var<storage, read_write> pixels: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> majorants: array<f32>;
@group(0) @binding(5) var<storage, read> voxels: array<f32>;
@group(0) @binding(6) var<storage, read> bins: array<u32>;
@group(0) @binding(7) var<storage, read> knots: array<Knot>;

const FAR = 340282346638528859811704183484516925440.0f;
const TINY = 1.1754944e-38f;

// Where the ray is among macro-cells; what stays the same is in `Line`.
struct Walk { cell: vec3<f32>, planes: vec3<f32>, enter: f32, leave: f32, is_last: bool }
struct Line {
    origin: vec3<f32>, direction: vec3<f32>, inverse: vec3<f32>,
    step: vec3<f32>, last: vec3<f32>, ahead: vec3<f32>, end: f32,
}

fn largest(v: vec3<f32>) -> f32 { return max(max(v.x, v.y), v.z); }

fn at_least(x: f32, size: f32) -> f32 {
    return select(x, select(size, -size, x < 0.0), abs(x) < size);
}

fn all_finite(v: vec3<f32>) -> bool {
    return all((bitcast<vec3<u32>>(v) & vec3(0x7fffffffu)) < vec3(0x7f800000u));
}

fn to_index(x: f32) -> u32 {
    if ((bitcast<u32>(x) & 0x7fffffffu) > 0x7f800000u) { return 0u; }
    return u32(clamp(x, 0.0, 4294967040.0));
}

fn index_of(at: vec3<f32>, steps: vec3<u32>) -> u32 {
    return to_index(at.x) * steps.x + to_index(at.y) * steps.y + to_index(at.z) * steps.z;
}

fn majorant(cell: vec3<f32>) -> f32 {
    return majorants[min(index_of(cell, params.volume_grid_macro_steps), max(params.len_of_volume_majorants, 1u) - 1u)];
}

fn voxel(i: u32) -> f32 { return voxels[min(i, max(params.len_of_volume_voxels, 1u) - 1u)]; }

fn knot(i: u32) -> Knot { return knots[min(i, max(params.len_of_volume_knots, 1u) - 1u)]; }

fn settle(line: Line, walk: ptr<function, Walk>) {
    let w = *walk;
    let distance = ((w.cell + line.ahead) * 8.0 - line.origin) * line.inverse;
    let never = (w.cell == line.last) | (line.step == vec3(0.0));
    let planes = select(distance, vec3(FAR), never);
    let xy = select(planes.x, planes.y, planes.y < planes.x);
    let nearest = select(xy, planes.z, planes.z < xy);
    let is_last = nearest >= line.end;
    var leave_at = line.end;
    if (!is_last) { leave_at = select(nearest, w.enter, nearest < w.enter); }
    *walk = Walk(w.cell, planes, w.enter, leave_at, is_last);
}

fn advance(line: Line, walk: ptr<function, Walk>) {
    let p = (*walk).planes;
    let is_x = p.x <= p.y && p.x <= p.z;
    let is_y = !is_x && p.y <= p.z;
    (*walk).cell += select(vec3(0.0), line.step, vec3(is_x, is_y, !(is_x || is_y)));
    (*walk).enter = (*walk).leave;
    settle(line, walk);
}

fn power_of_two(n: i32) -> f32 { return bitcast<f32>(bitcast<u32>(n + 127i) << 23u); }

fn scaled(x: f32, n: i32) -> f32 {
    let half = n >> 1u;
    return x * power_of_two(half) * power_of_two(n - half);
}

fn to_integer(x: f32) -> i32 {
    if ((bitcast<u32>(x) & 0x7fffffffu) > 0x7f800000u) { return 0i; }
    return i32(clamp(x, -2147483648.0, 2147483520.0));
}

fn exponential(x: f32) -> f32 {
    let low = select(x, -105.0, x < -105.0);
    let y = select(low, 90.0, 90.0 < low);
    let n = floor(y * 1.442695f + 0.5);
    let r = y - n * 0.69311523f - n * 3.1946183e-5f;
    let p = 0.49999994f + r * (0.16666517f + r * (0.041668102f + r * (0.008369193f + r * 0.0013838839f)));
    return scaled(1.0 + (r + r * r * p), to_integer(n));
}

fn exponential_minus_1(x: f32) -> f32 {
    let low = select(x, -18.0, x < -18.0);
    let y = select(low, 90.0, 90.0 < low);
    let n = floor(y * 1.442695f + 0.5);
    let r = y - n * 0.69311523f - n * 3.1946183e-5f;
    let q = 0.04166649f + r * (0.008333206f + r * (0.0013932673f + r * 0.0001994595f));
    let e = r + r * r * (0.5 + r * (0.16666667f + r * q));
    let whole = to_integer(n);
    let rest = 1.0 - power_of_two(-min(whole, 60i));
    return bitcast<f32>((bitcast<u32>(scaled(e + rest, whole)) & 0x7fffffffu) | (bitcast<u32>(x) & 0x80000000u));
}

fn logarithm_of_1_plus(x: f32) -> f32 {
    let y = 1.0 + x;
    if (!(x > -1.0 && x <= FAR)) {
        return select(select(y, params.nan, y < 0.0), params.infinity, y == 0.0);
    }
    let k = bitcast<i32>(bitcast<u32>(y) - 1060439283u) >> 23u;
    let scale = power_of_two(2i - k);
    let f = x * scale * 0.25 + (scale * 0.25 - 1.0);
    let s = f / (2.0 + f);
    let half = 0.5 * f * f;
    let z = s * s;
    let rest = z * (0.66666776f + z * (0.39977568f + z * 0.2987146f));
    let small = s * (half + rest) + f32(k) * 3.1946183e-5f;
    let v = f32(k) * 0.69311523f + (f - (half - small));
    return bitcast<f32>((bitcast<u32>(v) & 0x7fffffffu) | (bitcast<u32>(x) & 0x80000000u));
}

// The value of the grid at a place.
fn value_at(at: vec3<f32>) -> f32 {
    let above = select(vec3(0.0), at, vec3(0.0) < at);
    let most = params.volume_grid_last_cell + 0.5;
    let cell = floor(select(above, most, most < above));
    let apart = select(vec3(0.0), at - cell, vec3(0.0) < at - cell);
    let p = select(apart, vec3(1.0), vec3(1.0) < apart);
    let steps = params.volume_grid_steps;
    let i = index_of(cell, steps);
    let j = i + steps.z;
    let a0 = voxel(i);
    let b0 = voxel(i + steps.y);
    let c0 = voxel(j);
    let d0 = voxel(j + steps.y);
    let a = a0 + (voxel(i + steps.x) - a0) * p.x;
    let b = b0 + (voxel(i + steps.y + steps.x) - b0) * p.x;
    let c = c0 + (voxel(j + steps.x) - c0) * p.x;
    let d = d0 + (voxel(j + steps.y + steps.x) - d0) * p.x;
    let ab = a + (b - a) * p.y;
    let cd = c + (d - c) * p.y;
    return (ab + (cd - ab) * p.z) * params.volume_grid_scale + params.volume_grid_offset;
}

// Colour and extinction of a value.
fn seen(value: f32) -> vec4<f32> {
    let x = (value - params.volume_transfer_first) * params.volume_transfer_per_value + 1.0;
    let low = select(x, 0.0, x < 0.0);
    let most = params.volume_transfer_last_bin;
    let bin = bins[min(to_index(select(low, most, most < low)), max(params.len_of_volume_bins, 1u) - 1u)];
    var i = bin >> 1u;
    if ((bin & 1u) != 0u) {
        while (i < params.volume_transfer_last && value >= knot(i + 1u).value) { i++; }
    }
    let a = knot(i);
    let b = knot(i + 1u);
    let t = (value - a.value) / (b.value - a.value);
    let above = select(t, 0.0, t < 0.0);
    let share = select(above, 1.0, 1.0 < above);
    let extinction = a.extinction + (b.extinction - a.extinction) * share;
    if (extinction > 0.0) {
        let color = vec3(a.red, a.green, a.blue);
        return vec4(color + (vec3(b.red, b.green, b.blue) - color) * share, extinction);
    }
    return vec4(0.0, 0.0, 0.0, extinction);
}

fn kept(a: vec4<f32>) -> vec4<f32> { return select(a, vec4(FAR), vec4(FAR) < a); }

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let pixel = job.first + id.xy;
    let to = params.camera_corner + params.camera_right * (f32(pixel.x) + 0.5)
        + params.camera_up * (f32(pixel.y) + 0.5);
    let world = to * (1.0 / sqrt(to.x * to.x + to.y * to.y + to.z * to.z));
    let x_axis = params.volume_grid_to_voxels_matrix3_x_axis;
    let y_axis = params.volume_grid_to_voxels_matrix3_y_axis;
    let z_axis = params.volume_grid_to_voxels_matrix3_z_axis;
    let eye = params.camera_origin;
    let o = x_axis * eye.x + y_axis * eye.y + z_axis * eye.z + params.volume_grid_to_voxels_translation;
    let d = x_axis * world.x + y_axis * world.y + z_axis * world.z;

    // The part of the ray in the grid.
    let least = max(largest(abs(d)) * 8.6736174e-19f, TINY);
    let inverse = 1.0 / vec3(at_least(d.x, least), at_least(d.y, least), at_least(d.z, least));
    let is_parallel = abs(d) < vec3(least);
    let low = params.volume_grid_low;
    let high = params.volume_grid_high;
    let a = (low - o) * inverse;
    let b = (high - o) * inverse;
    let near = select(min(a, b), vec3(-FAR), is_parallel);
    let far = select(max(a, b), vec3(FAR), is_parallel);
    let enter = max(max(near.x, near.y), max(0.0, near.z));
    let leave_at = min(min(far.x, far.y), min(FAR, far.z));
    let is_beside = any(is_parallel & ((o < low) | (o > high)));
    let is_met = all(low <= high) && all_finite(o) && all_finite(d) && !is_beside && enter < leave_at;
    let start = select(0.0, enter, is_met);
    let end = select(0.0, leave_at - enter, is_met);
    let scale = sqrt(world.x * world.x + world.y * world.y + world.z * world.z);
    let origin = o + d * start;

    let wanted = ceil(end * scale / params.euler_step);
    let at_least_one = select(wanted, 1.0, wanted < 1.0);
    let count = select(at_least_one, 16777216.0, 16777216.0 < at_least_one);
    let width = end / count;

    let up = d > vec3(0.0);
    let last = params.volume_grid_last_macro;
    let line = Line(
        origin, d, inverse,
        select(select(vec3(0.0), vec3(-1.0), d < vec3(0.0)), vec3(1.0), up),
        select(vec3(0.0), last, up), select(vec3(0.0), vec3(1.0), up), end,
    );
    let first = origin / 8.0;
    let above = select(first, vec3(0.0), first < vec3(0.0));
    let most = last + 0.5;
    var walk = Walk(floor(select(above, most, most < above)), vec3(0.0), 0.0, 0.0, false);
    settle(line, &walk);
    var is_inside = 0.0 < end;

    var light = vec4(0.0); // radiance and depth
    var rest = vec4(0.0); // what rounding has lost of them
    var i = 0u;
    while (is_inside && exponential(-light.w) >= params.euler_least) {
        while (is_inside && majorant(walk.cell) <= 0.0) {
            is_inside = !walk.is_last;
            advance(line, &walk);
        }
        let from_ = walk.enter;
        var until = walk.enter;
        var passed = 0u;
        while (is_inside && passed < 8u && majorant(walk.cell) > 0.0) {
            until = walk.leave;
            passed++;
            is_inside = !walk.is_last;
            advance(line, &walk);
        }
        if (passed > 0u) {
            i = max(i, to_index(from_ / width));
            let steps = until / width;
            let stop = to_index(ceil(select(steps, count, count < steps)));
            let transmitted = exponential(-light.w);
            let enough = params.euler_least / transmitted;
            var radiance = vec3(0.0);
            var transmittance = 1.0;
            var depth = 0.0;
            while (i < stop && transmittance >= enough) {
                let begin = f32(i) * width;
                let finish = f32(i + 1u) * width;
                let sample = seen(value_at(origin + d * ((begin + finish) * 0.5)));
                let opaque = sample.w * ((finish - begin) * scale);
                let opacity = select(opaque, 0.9999999f, 0.9999999f < opaque);
                radiance += sample.xyz * (transmittance * opacity);
                transmittance *= 1.0 - opacity;
                depth -= logarithm_of_1_plus(-opacity);
                i++;
            }
            let arriving = vec4(radiance * transmitted, select(depth, 1e30f, 1e30f < depth)) + rest;
            let total = light + arriving;
            let sum = kept(total);
            let part = kept(sum - light);
            rest = light - (sum - part) + (arriving - part);
            light = total;
        }
    }
    pixels[pixel.y * job.size.x + pixel.x - job.base] = vec4(light.xyz, -exponential_minus_1(-light.w));
}
