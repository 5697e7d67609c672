struct Mat4 {
    x_axis: vec4<f32>,
    y_axis: vec4<f32>,
    z_axis: vec4<f32>,
    w_axis: vec4<f32>,
}

struct Mat3 {
    x_axis: vec3<f32>,
    y_axis: vec3<f32>,
    z_axis: vec3<f32>,
}

struct Tuple {
    _0: Mat4,
    _1: Mat3,
    _2: vec3<f32>,
}

struct StoredTuple {
    arg0_x_axis: vec4<f32>,
    arg0_y_axis: vec4<f32>,
    arg0_z_axis: vec4<f32>,
    arg0_w_axis: vec4<f32>,
    arg1_x_axis: vec3<f32>,
    arg1_y_axis_x: f32,
    arg1_y_axis_y: f32,
    arg1_y_axis_z: f32,
    arg1_z_axis_x: f32,
    arg1_z_axis_y: f32,
    arg1_z_axis_z: f32,
    arg2_x: f32,
    arg2_y: f32,
    arg2_z: f32,
}

struct StoredVec3 {
    value_x: f32,
    value_y: f32,
    value_z: f32,
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

fn transforms(m: Mat4, n: Mat3, p: vec3<f32>) -> vec3<f32> {
    var turned_x_axis: vec3<f32> = n.x_axis * n.x_axis.x + n.y_axis * n.y_axis.x + n.z_axis * n.z_axis.x;
    var turned_y_axis: vec3<f32> = n.x_axis * n.x_axis.y + n.y_axis * n.y_axis.y + n.z_axis * n.z_axis.y;
    var turned_z_axis: vec3<f32> = n.x_axis * n.x_axis.z + n.y_axis * n.y_axis.z + n.z_axis * n.z_axis.z;
    turned_x_axis = turned_x_axis + p.zyx;
    if (turned_x_axis.x * (turned_y_axis.y * turned_z_axis.z - turned_z_axis.y * turned_y_axis.z) + turned_x_axis.y * (turned_y_axis.z * turned_z_axis.x - turned_z_axis.z * turned_y_axis.x) + turned_x_axis.z * (turned_y_axis.x * turned_z_axis.y - turned_z_axis.x * turned_y_axis.y) < 0.0f) {
        turned_x_axis = turned_x_axis * 0.5f;
        turned_y_axis = turned_y_axis * 0.5f;
        turned_z_axis = turned_z_axis * 0.5f;
    }
    let v = m.x_axis * p.x + m.y_axis * p.y + m.z_axis * p.z + m.w_axis * 1.0f;
    let t = m.w_axis.xyz + (m.x_axis.xyz * p.x + m.y_axis.xyz * p.y + m.z_axis.xyz * p.z);
    let t_1 = v.w > 0.0f;
    let t_2 = v.xyz / v.w;
    return turned_x_axis * t.x + turned_y_axis * t.y + turned_z_axis * t.z + vec3<f32>(select(v.z, t_2.x, t_1), select(v.y, t_2.y, t_1), select(v.x, t_2.z, t_1));
}

fn element(input: Tuple) -> vec3<f32> {
    return transforms(input._0, input._1, input._2);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<StoredVec3>;

fn load_input(i: u32) -> Tuple {
    let s = inputs[i];
    return Tuple(Mat4(s.arg0_x_axis, s.arg0_y_axis, s.arg0_z_axis, s.arg0_w_axis), Mat3(s.arg1_x_axis, vec3<f32>(s.arg1_y_axis_x, s.arg1_y_axis_y, s.arg1_y_axis_z), vec3<f32>(s.arg1_z_axis_x, s.arg1_z_axis_y, s.arg1_z_axis_z)), vec3<f32>(s.arg2_x, s.arg2_y, s.arg2_z));
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = StoredVec3(result.x, result.y, result.z);
}
