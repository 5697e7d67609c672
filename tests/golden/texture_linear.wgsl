struct Pair {
    first: u32,
    second: u32,
    share: f32,
}

struct Tuple {
    _0: vec2<f32>,
}

struct StoredArray {
    arg0_arg1_arg2_arg3: u32,
}

struct StoredTuple {
    arg0: vec2<f32>,
}

struct StoredVec4 {
    value: vec4<f32>,
}

struct Params {
    tiles_size: vec2<u32>,
    lit_0_5: f32,
    lit_255_0: f32,
    tiles_border: vec4<f32>,
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

@group(0) @binding(4) var<storage, read> tiles: array<StoredArray>;

fn tiles_at(i: u32) -> array<u32, 4> {
    let s = tiles[i];
    return array<u32, 4>(s.arg0_arg1_arg2_arg3 & 0xffu, (s.arg0_arg1_arg2_arg3 >> 8u) & 0xffu, (s.arg0_arg1_arg2_arg3 >> 16u) & 0xffu, (s.arg0_arg1_arg2_arg3 >> 24u) & 0xffu);
}

/// As Rust's `as`: out of range gives the nearest number, NaN gives 0.
fn saturate_i32(x: f32) -> i32 {
    if ((bitcast<u32>(x) & 0x7fffffffu) > 0x7f800000u) { return 0i; }
    if (x >= 2147483648.0) { return 2147483647i; }
    if (x < -2147483648.0) { return (-2147483647i - 1i); }
    return i32(x);
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

fn taps_reduced(x: f32) -> f32 {
    let t = select(-2.0f, x, -2.0f < x);
    return select(t, 3.0f, 3.0f < t);
}

fn taps_texel_at(i: i32, n: i32) -> u32 {
    return select(4294967295u, bitcast<u32>(i), (i >= 0i && i < n));
}

fn taps_pair(x: f32, size: u32) -> Pair {
    let n = bitcast<i32>(size);
    let place = taps_reduced(x) * f32(size) - params.lit_0_5;
    let below = floor(place);
    let i = saturate_i32(below);
    return Pair(taps_texel_at(i, n), taps_texel_at(i + 1i, n), place - below);
}

fn part(first: u32, size: u32, i: u32) -> u32 {
    let start = first + i * size;
    return select(start, 4294967295u, (i == 4294967295u || first == 4294967295u));
}

fn Vec4_blend(self_: vec4<f32>, to: vec4<f32>, w: f32) -> vec4<f32> {
    return self_ + (to - self_) * w;
}

fn texel(row: u32, i: u32) -> vec4<f32> {
    var result: vec4<f32>;
    let is_outside = row == 4294967295u || i == 4294967295u;
    let t = tiles_at(select(row + i, 0u, is_outside));
    let t_1 = f32(t[0]) / params.lit_255_0;
    let t_2 = f32(t[1]) / params.lit_255_0;
    let t_3 = f32(t[2]) / params.lit_255_0;
    let t_4 = f32(t[3]) / params.lit_255_0;
    if (is_outside) {
        result = params.tiles_border;
    } else {
        result = vec4<f32>(t_1, t_2, t_3, t_4);
    }
    return result;
}

fn linear_row(row: u32, x: Pair) -> vec4<f32> {
    let a = texel(row, x.first);
    let b = texel(row, x.second);
    return Vec4_blend(a, b, x.share);
}

fn linear_image(first: u32, width: u32, x: Pair, y: Pair) -> vec4<f32> {
    let a = linear_row(part(first, width, y.first), x);
    let b = linear_row(part(first, width, y.second), x);
    return Vec4_blend(a, b, y.share);
}

fn filter2(size: vec2<u32>, first: u32, uv: vec2<f32>) -> vec4<f32> {
    let x = pair(uv.x, size.x);
    let y = taps_pair(uv.y, size.y);
    return linear_image(first, size.x, x, y);
}

fn tex2(uv: vec2<f32>) -> vec4<f32> {
    return filter2(params.tiles_size, 0u, uv);
}

fn kernel(uv: vec2<f32>) -> vec4<f32> {
    return tex2(uv);
}

fn element(input: Tuple) -> vec4<f32> {
    return kernel(input._0);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<StoredVec4>;

fn load_input(i: u32) -> Tuple {
    let s = inputs[i];
    return Tuple(s.arg0);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = StoredVec4(vec4<f32>(result.x, result.y, result.z, result.w));
}
