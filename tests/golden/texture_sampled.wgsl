struct Pair {
    first: u32,
    second: u32,
    share: f32,
}

struct Tuple {
    _0: vec2<f32>,
    _1: f32,
}

struct StoredTuple {
    arg0_x: f32,
    arg0_y: f32,
    arg1: f32,
}

struct StoredVec4 {
    value: vec4<f32>,
}

struct Params {
    relief_size: u32,
    lit_0_5: f32,
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

@group(0) @binding(4) var<storage, read> relief: array<f32>;

fn relief_at(i: u32) -> f32 {
    return relief[i];
}

@group(0) @binding(5) var tiles_texture: texture_2d<f32>;
@group(0) @binding(6) var tiles_sampler: sampler;

/// As Rust's `as`: out of range gives the nearest number, NaN gives 0.
fn saturate_i32(x: f32) -> i32 {
    if ((bitcast<u32>(x) & 0x7fffffffu) > 0x7f800000u) { return 0i; }
    if (x >= 2147483648.0) { return 2147483647i; }
    if (x < -2147483648.0) { return (-2147483647i - 1i); }
    return i32(x);
}

fn tiles_sample(at: vec2<f32>, level: f32) -> vec4<f32> {
    return textureSampleLevel(tiles_texture, tiles_sampler, at, level);
}

fn reduced(x: f32) -> f32 {
    let c = select(0.0f, x, ((bitcast<u32>(x) & 2147483647u) < 2139095040u));
    return c - floor(c);
}

fn texel_at(i: i32, n: i32) -> u32 {
    let last = n - 1i;
    let j = select(i, i + n, (i < 0i));
    let k = select(j, j - n, (j > last));
    let t = select(k, 0i, (k < 0i));
    return bitcast<u32>(select(t, last, (last < t)));
}

fn pair(x: f32, size: u32) -> Pair {
    let n = bitcast<i32>(size);
    let place = reduced(x) * f32(size) - params.lit_0_5;
    let below = floor(place);
    let i = saturate_i32(below);
    return Pair(texel_at(i, n), texel_at(i + 1i, n), place - below);
}

fn texel(row: u32, i: u32) -> f32 {
    return relief_at(row + i);
}

fn f32_blend(self_: f32, to: f32, w: f32) -> f32 {
    return self_ + (to - self_) * w;
}

fn linear_row(row: u32, x: Pair) -> f32 {
    let a = texel(row, x.first);
    let b = texel(row, x.second);
    return f32_blend(a, b, x.share);
}

fn filter1(size: u32, first: u32, x: f32) -> f32 {
    return linear_row(first, pair(x, size));
}

fn tex1(u: f32) -> f32 {
    return filter1(params.relief_size, 0u, u);
}

fn kernel(uv: vec2<f32>, level: f32) -> vec4<f32> {
    return tiles_sample(uv, level) * tex1(uv.x);
}

fn element(input: Tuple) -> vec4<f32> {
    return kernel(input._0, input._1);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<StoredVec4>;

fn load_input(i: u32) -> Tuple {
    let s = inputs[i];
    return Tuple(vec2<f32>(s.arg0_x, s.arg0_y), s.arg1);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = StoredVec4(vec4<f32>(result.x, result.y, result.z, result.w));
}
