struct Table {
    values: array<u32, 4>,
    colors: array<u32, 3>,
    flag: bool,
}

struct Tuple {
    _0: Table,
    _1: u32,
}

struct StoredTuple {
    arg0_values_0: u32,
    arg0_values_1: u32,
    arg0_values_2: u32,
    arg0_values_3: u32,
    arg0_colors_0_arg0_colors_1_arg0_colors_2_arg0_flag: u32,
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

fn arrays(t: Table, n: u32) -> u32 {
    var r: u32 = t.values[0] ^ t.values[3];
    if (n > t.values[1]) {
        r = r ^ t.colors[2];
    }
    return select(~r, r, t.flag);
}

fn element(input: Tuple) -> u32 {
    return arrays(input._0, input._1);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<u32>;

fn load_input(i: u32) -> Tuple {
    let s = inputs[i];
    return Tuple(Table(array<u32, 4>(s.arg0_values_0, s.arg0_values_1, s.arg0_values_2, s.arg0_values_3), array<u32, 3>(s.arg0_colors_0_arg0_colors_1_arg0_colors_2_arg0_flag & 0xffu, (s.arg0_colors_0_arg0_colors_1_arg0_colors_2_arg0_flag >> 8u) & 0xffu, (s.arg0_colors_0_arg0_colors_1_arg0_colors_2_arg0_flag >> 16u) & 0xffu), ((s.arg0_colors_0_arg0_colors_1_arg0_colors_2_arg0_flag >> 24u) & 0xffu) != 0u), s.arg1);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = result;
}
