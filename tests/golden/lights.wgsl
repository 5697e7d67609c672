struct Spot {
    at: vec3<f32>,
    power: f32,
}

struct Sun {
    direction: vec3<f32>,
}

struct Filtered {
    light: Spot,
    share: f32,
}

struct Tuple {
    _0: f32,
    _1: f32,
    _2: u32,
}

struct StoredTuple {
    arg0: f32,
    arg1: f32,
    arg2: u32,
}

struct Params {
    lit_1_0: f32,
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

fn Spot_shine(self_: Spot, at: vec3<f32>) -> f32 {
    let way = at - self_.at;
    return self_.power / (way.x * way.x + way.y * way.y + way.z * way.z + params.lit_1_0);
}

fn Light_dark() -> f32 {
    return 0.25f;
}

fn Light_twice(self_: Spot, at: vec3<f32>) -> f32 {
    let one = Spot_shine(self_, at);
    if (one < 0.125f) {
        return 0.125f;
    }
    return one + Spot_shine(self_, at * 0.5f);
}

fn Spot_dimmed(self_: Spot, by: f32) -> Spot {
    let t = self_.power - by;
    return Spot(vec3<f32>(0.0f), select(t, by, t < by));
}

fn lit(light: Spot, at: vec3<f32>, steps: u32) -> f32 {
    var sum: f32 = 0.0f;
    let now_at = light.at;
    var now_power: f32 = light.power;
    var i: u32 = 0u;
    for (; i < steps; i = i + 1u) {
        if (i == 3u) {
            continue;
        }
        sum = sum + Light_twice(Spot(now_at, now_power), at * f32(i));
        now_power = Spot_dimmed(Spot(vec3<f32>(0.0f), now_power), 0.5f).power;
    }
    return sum + Light_dark();
}

fn Sun_shine(self_: Sun, at: vec3<f32>) -> f32 {
    let c = self_.direction.x * at.x + self_.direction.y * at.y + self_.direction.z * at.z;
    var result: f32;
    if (c > 0.0f) {
        result = c;
    } else {
        result = Light_dark();
    }
    return result;
}

fn Sun_twice(self_: Sun, at: vec3<f32>) -> f32 {
    let t = Sun_shine(self_, at);
    return select(t, 0.5f, t < 0.5f);
}

fn Sun_dimmed(self_: Sun, by: f32) -> Sun {
    return Sun(self_.direction * by);
}

fn generic_lit(light: Sun, at: vec3<f32>, steps: u32) -> f32 {
    var sum: f32 = 0.0f;
    var now_direction: vec3<f32> = light.direction;
    var i: u32 = 0u;
    for (; i < steps; i = i + 1u) {
        if (i == 3u) {
            continue;
        }
        sum = sum + Sun_twice(Sun(now_direction), at * f32(i));
        now_direction = Sun_dimmed(Sun(now_direction), 0.5f).direction;
    }
    return sum + Light_dark();
}

fn Filtered_shine(self_: Filtered, at: vec3<f32>) -> f32 {
    let t = Spot_shine(self_.light, at);
    return select(t, self_.share, self_.share < t);
}

fn generic_Light_twice(self_: Filtered, at: vec3<f32>) -> f32 {
    let one = Filtered_shine(self_, at);
    if (one < 0.5f) {
        return 0.5f;
    }
    return one + Filtered_shine(self_, at * 0.5f);
}

fn Filtered_dimmed(self_: Filtered, by: f32) -> Filtered {
    return Filtered(Spot(vec3<f32>(0.0f), 0.0f), self_.share * by);
}

fn generic_lit_1(light: Filtered, at: vec3<f32>, steps: u32) -> f32 {
    var sum: f32 = 0.0f;
    let now_light_at = light.light.at;
    let now_light_power = light.light.power;
    var now_share: f32 = light.share;
    var i: u32 = 0u;
    for (; i < steps; i = i + 1u) {
        if (i == 3u) {
            continue;
        }
        sum = sum + generic_Light_twice(Filtered(Spot(now_light_at, now_light_power), now_share), at * f32(i));
        now_share = Filtered_dimmed(Filtered(Spot(vec3<f32>(0.0f), 0.0f), now_share), 0.5f).share;
    }
    return sum + Light_dark();
}

fn Filtered_open(self_: Filtered) -> Spot {
    return self_.light;
}

fn lights(x: f32, y: f32, n: u32) -> f32 {
    var sum: f32 = lit(Spot(vec3<f32>(x, 1.0f, 0.0f), 4.0f), vec3<f32>(y, x, 1.0f), n % 6u) + generic_lit(Sun(vec3<f32>(0.0f, 0.5f, y)), vec3<f32>(y, x, 1.0f), n % 3u) + generic_lit_1(Filtered(Spot(vec3<f32>(x, 1.0f, 0.0f), 4.0f), 0.75f), vec3<f32>(y, x, 1.0f), 2u);
    if (x > y) {
        sum = sum + (Filtered_shine(Filtered(Spot(vec3<f32>(x, 1.0f, 0.0f), 4.0f), 0.75f), vec3<f32>(y, x, 1.0f)) + Spot_shine(Filtered_open(Filtered(Spot(vec3<f32>(x, 1.0f, 0.0f), 4.0f), 0.0f)), vec3<f32>(y, x, 1.0f)) + Light_dark());
    }
    return sum;
}

fn element(input: Tuple) -> f32 {
    return lights(input._0, input._1, input._2);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<f32>;

fn load_input(i: u32) -> Tuple {
    let s = inputs[i];
    return Tuple(s.arg0, s.arg1, s.arg2);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = result;
}
