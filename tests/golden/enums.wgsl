struct Surface {
    roughness: f32,
    matter: u32,
}

struct Tuple {
    _0: f32,
    _1: u32,
}

struct StoredTuple {
    arg0: f32,
    arg1: u32,
}

struct StoredSurface {
    roughness: f32,
    matter: u32,
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

fn Matter_of(n: u32) -> u32 {
    let value_1 = n % 3u;
    return select(select(5u, 4u, (value_1 == 1u)), 0u, (value_1 == 0u));
}

fn Matter_albedo(self_: u32) -> f32 {
    return select(select(0.0f, 0.9f, (self_ == 4u)), 0.5f, (self_ == 0u));
}

fn enums(x: f32, n: u32) -> Surface {
    var surface_roughness: f32 = x;
    var surface_matter: u32 = Matter_of(n);
    let t = n % 5u;
    var i: u32 = 0u;
    for (; i < t; i = i + 1u) {
        var value: u32;
        let value_2 = i % 2u == 0u;
        if (surface_matter == 0u && value_2) {
            value = 4u;
        } else if (surface_matter == 4u) {
            value = 5u;
        } else {
            var both: bool;
            if (surface_matter == 5u) {
                both = value_2;
            } else {
                both = false;
            }
            if (both) {
                value = 0u;
            } else {
                value = surface_matter;
            }
        }
        surface_matter = value;
        if (surface_matter != 5u) {
            surface_roughness = surface_roughness + Matter_albedo(surface_matter) * f32(surface_matter);
        }
    }
    return Surface(surface_roughness, surface_matter);
}

fn element(input: Tuple) -> Surface {
    return enums(input._0, input._1);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<StoredSurface>;

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
    outputs[index] = StoredSurface(result.roughness, (result.matter));
}
