struct Counter {
    n: u32,
}

struct Tuple {
    _0: u32,
    _1: Counter,
}

struct Tuple_1 {
    _0: u32,
    _1: u32,
}

struct StoredTuple_1 {
    arg0: u32,
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

fn Counter_next(self_: Counter) -> Tuple {
    var self_n: u32 = self_.n;
    self_n = self_n * 1664525u + 1013904223u;
    return Tuple((self_n >> 4u), Counter(self_n));
}

fn Source_below(self_: Counter, n: u32) -> Tuple {
    var self_n: u32 = self_.n;
    let self_n_1 = self_n;
    let t = Counter_next(Counter(self_n_1));
    self_n = t._1.n;
    return Tuple(t._0 % n, Counter(self_n));
}

fn draw(source: Counter, n: u32) -> Tuple {
    var source_n: u32 = source.n;
    var sum: u32 = 0u;
    var i: u32 = 0u;
    for (; i < n; i = i + 1u) {
        let source_n_1 = source_n;
        let t = Source_below(Counter(source_n_1), 10u);
        source_n = t._1.n;
        if (t._0 == 9u) {
            return Tuple(sum, Counter(source_n));
        }
        sum = sum + t._0;
    }
    let source_n_2 = source_n;
    let t_1 = Counter_next(Counter(source_n_2));
    source_n = t_1._1.n;
    return Tuple(sum + t_1._0 % 3u, Counter(source_n));
}

fn sources(seed: u32, n: u32) -> Tuple_1 {
    var counter_n: u32 = seed;
    var source_n: u32 = counter_n;
    let source_n_2 = source_n;
    let t = draw(Counter(source_n_2), n % 17u);
    source_n = t._1.n;
    counter_n = source_n;
    let counter_n_1 = counter_n;
    let t_1 = Counter_next(Counter(counter_n_1));
    counter_n = t_1._1.n;
    var other_n: u32 = t_1._0;
    var source_n_1: u32 = other_n;
    let source_n_1_1 = source_n_1;
    let t_2 = draw(Counter(source_n_1_1), 4u);
    source_n_1 = t_2._1.n;
    other_n = source_n_1;
    return Tuple_1(t._0 + t_2._0, counter_n);
}

fn element(input: Tuple_1) -> Tuple_1 {
    return sources(input._0, input._1);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple_1>;
@group(0) @binding(3) var<storage, read_write> outputs: array<StoredTuple_1>;

fn load_input(i: u32) -> Tuple_1 {
    let s = inputs[i];
    return Tuple_1(s.arg0, s.arg1);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = StoredTuple_1(result._0, result._1);
}
