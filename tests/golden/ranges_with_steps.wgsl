struct Tuple {
    _0: f32,
    _1: u32,
}

struct StoredTuple {
    arg0: f32,
    arg1: u32,
}

struct Params {
    none: u32,
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

/// As Rust's `as`: out of range gives the nearest number, NaN gives 0.
fn saturate_u32(x: f32) -> u32 {
    if ((bitcast<u32>(x) & 0x7fffffffu) > 0x7f800000u) { return 0u; }
    if (x >= 4294967296.0) { return 4294967295u; }
    if (x <= 0.0) { return 0u; }
    return u32(x);
}

fn ranges_with_steps(a: f32, n: u32) -> u32 {
    let k = n % 40u;
    var sum: u32 = 0u;
    var i: u32 = 1u;
    var done: bool = false;
    loop {
        if (!(!done && i < k)) { break; }
        if (i == 7u && a > 0.0f) {
            continue;
        }
        sum = sum * 3u + i;
        continuing {
            done = k - i <= 3u;
            i = i + 3u;
        }
    }
    var i_1: u32 = 0u;
    var done_1: bool = false;
    loop {
        if (!(!done_1 && i_1 <= k)) { break; }
        sum = sum * 3u + i_1;
        continuing {
            done_1 = k - i_1 < 2u;
            i_1 = i_1 + 2u;
        }
    }
    var i_2: u32 = 4294967290u;
    var done_2: bool = false;
    loop {
        if (!(!done_2 && i_2 <= 4294967295u)) { break; }
        sum = sum * 3u + i_2;
        continuing {
            done_2 = 4294967295u - i_2 < 3u;
            i_2 = i_2 + 3u;
        }
    }
    let t = k + 4u;
    let t_1 = select(t, 1u, (t == 0u));
    var i_3: u32 = 4294967290u - k;
    var done_3: bool = false;
    loop {
        if (!(!done_3 && i_3 < 4294967295u)) { break; }
        sum = sum * 5u + i_3;
        continuing {
            done_3 = 4294967295u - i_3 <= t_1;
            i_3 = i_3 + t_1;
        }
    }
    let t_2 = bitcast<i32>(k);
    var i_1_1: i32 = -5i;
    var done_4: bool = false;
    loop {
        if (!(!done_4 && i_1_1 < t_2)) { break; }
        var i_4: i32 = i_1_1;
        i_4 = i_4 * 2i;
        sum = sum * 3u + bitcast<u32>(i_4);
        continuing {
            done_4 = bitcast<u32>(t_2) - bitcast<u32>(i_1_1) <= 2u;
            i_1_1 = bitcast<i32>(bitcast<u32>(i_1_1) + 2u);
        }
    }
    var i_2_1: u32 = 0u;
    for (; i_2_1 < 3u; i_2_1 = i_2_1 + 1u) {
        let x = select(select(1.0f, 2.5f, (i_2_1 >= 1u)), 4.0f, (i_2_1 >= 2u));
        sum = sum + saturate_u32(x);
    }
    return sum;
}

fn element(input: Tuple) -> u32 {
    return ranges_with_steps(input._0, input._1);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<u32>;

fn load_input(i: u32) -> Tuple {
    let s = inputs[i];
    return Tuple(s.arg0, s.arg1);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = result;
}
