fn gap(line: Line, major: f32, minor: f32, s: f32) -> vec3<f32> {
    let aside = line.aside + line.step * s;
    let t = sqrt(aside.x * aside.x + aside.y * aside.y + aside.z * aside.z);
    let radius = select(t, 1e-12f, t < 1e-12f);
    let x = radius - major;
    let y = line.height.x + line.height.y * s;
    let distance = sqrt(x * x + y * y);
    let growth = s - major * (aside.x * line.step.x + aside.y * line.step.y + aside.z * line.step.z) / radius;
    return vec3<f32>((distance - minor) * (distance + minor), 2.0f * growth, radius);
}

fn root(line: Line, major: f32, minor: f32, low: f32, high: f32, sign_: f32, is_convex: bool) -> Root {
    var s: f32 = select(high, low, is_convex);
    var is_met: bool = false;
    var i: u32 = 0u;
    for (; i < 40u; i = i + 1u) {
        let s_1 = s;
        let g = gap(line, major, minor, s_1);
        if (sign_ * g.y >= 0.0f) {
            is_met = !is_convex && i > 0u;
            break;
        }
        let step_ = g.x / g.y;
        s = s - step_;
        if (s < low - params.lit_4em6 || s > high + params.lit_4em6) {
            break;
        }
        let bend = params.lit_1_0 + line.moment / (g.z * g.z * g.z);
        var both: bool;
        if (step_ * step_ * bend < params.lit_0_001 * minor * abs(g.y)) {
            both = abs(step_) < params.lit_0_1 * g.z;
        } else {
            both = false;
        }
        if (both) {
            is_met = true;
            break;
        }
    }
    if (is_met) {
        var i_1: u32 = 0u;
        for (; i_1 < 2u; i_1 = i_1 + 1u) {
            let g_1 = gap(line, major, minor, s);
            let t = g_1.x / g_1.y;
            let t_1 = params.lit_m0_001 * minor;
            let t_2 = params.lit_0_001 * minor;
            let t_3 = select(t, t_1, t < t_1);
            s = s - select(t_3, t_2, t_2 < t_3);
        }
    }
    return Root(is_met, s);
}

fn Torus_intersect(self_: Torus, ray: Ray) -> Hit {
    let reach = self_.major + self_.minor;
    let t = abs(ray.direction);
    let t_1 = select(t.z, t.y, t.z < t.y);
    let scale = select(t_1, t.x, t_1 < t.x);
    let t_2 = ray.direction / scale;
    let length_ = sqrt(t_2.x * t_2.x + t_2.y * t_2.y + t_2.z * t_2.z);
    let d = ray.direction / scale / length_;
    let offset = ray.origin - self_.center;
    let first = -(offset.x * d.x + offset.y * d.y + offset.z * d.z);
    let t_3 = offset + d * first;
    let rest = -(t_3.x * d.x + t_3.y * d.y + t_3.z * d.z);
    let near = (offset + d * first + d * rest) / reach;
    let along = first + rest;
    let square = params.lit_1_00001 - (near.x * near.x + near.y * near.y + near.z * near.z);
    if (!(square >= 0.0f && self_.minor > 0.0f && self_.minor < self_.major)) {
        return Hit_miss();
    }
    let half = sqrt(square);
    let major = self_.major / reach;
    let minor = self_.minor / reach;
    let t_4 = near.x * self_.axis.x + near.y * self_.axis.y + near.z * self_.axis.z;
    let t_5 = d.x * self_.axis.x + d.y * self_.axis.y + d.z * self_.axis.z;
    let aside = near - self_.axis * t_4;
    let step_ = d - self_.axis * t_5;
    let t_6 = aside.y * step_.z - step_.y * aside.z;
    let t_7 = aside.z * step_.x - step_.z * aside.x;
    let t_8 = aside.x * step_.y - step_.x * aside.y;
    let turn = t_6 * t_6 + t_7 * t_7 + t_8 * t_8;
    let moment = major * turn;
    var from_: f32 = half;
    var to: f32 = half;
    let slant = step_.x * step_.x + step_.y * step_.y + step_.z * step_.z;
    if (slant > 1e-6f) {
        let middle = -(aside.x * step_.x + aside.y * step_.y + aside.z * step_.z) / slant;
        let bend = pow_(moment, 0.6666667f) - turn / slant;
        let t_9 = sqrt(select(bend, 0.0f, bend < 0.0f) / slant);
        let width = select(t_9, 0.0001f, t_9 < 0.0001f);
        from_ = middle - width;
        to = middle + width;
    }
    var s: f32 = -half;
    var sign_: f32 = 1.0f;
    var part: u32 = 0u;
    var i: u32 = 0u;
    for (; i < 7u; i = i + 1u) {
        let part_end = select(select(half, to, (part == 1u)), from_, (part == 0u));
        let t_10 = select(part_end, s, part_end < s);
        let end = select(t_10, half, half < t_10);
        let sign__1 = sign_;
        let is_convex = (part == 1u) != (sign__1 > 0.0f);
        let sign__2 = sign_;
        let root_ = root(Line(vec2<f32>(t_4, t_5), aside, step_, moment), major, minor, s, end, sign__2, is_convex);
        let t_11 = (along + root_.s * reach) / length_ / scale;
        if (root_.is_met && t_11 >= ray.t_min) {
            return Hit_new(true, t_11);
        }
        if (root_.is_met) {
            sign_ = -sign_;
            let t_12 = select(root_.s, s, root_.s < s);
            s = select(t_12, end, end < t_12);
        } else {
            part = part + 1u;
            s = end;
        }
        if (part == 3u) {
            break;
        }
    }
    return Hit_miss();
}
