//! Kernels that together use every form of the kernel language, and the table of them.

#![allow(missing_docs, reason = "the names say what each kernel is about")]
#![allow(clippy::all, reason = "every form is wanted, the clumsy ones too")]

mod changes;
mod generic;
mod kept;
mod own_types;
mod patterns;

use raydsl::kernel;
use raydsl::prelude::*;

pub use changes::*;
pub use generic::*;
pub use kept::*;
pub use own_types::*;
pub use patterns::*;

/// Calls `$use!` with a row for each kernel: its name, the numbers that it can take, and whether
/// WGSL gives the CPU's bits.
#[macro_export]
macro_rules! kernel_table {
    ($use:ident) => {
        $crate::small_kernel_table! { $use
            if_that_ends_lanes: Any SameIfFinite;
            store_before_if: Any SameIfFinite;
            for_with_continue: Tame Same;
            for_over_signed: Tame Same;
            loop_until: Tame Same;
            while_with_both: Tame Same;
            value_ifs: Any SameIfFinite;
            blocks_with_exits: Tame Same;
            tail_is_an_if: Any SameIfFinite;
            guarded_sum: Any Same;
            declared_later: Any SameIfFinite;
            struct_places: Tame Same;
            compound: Tame Same;
            shadowing: Any SameIfFinite;
            calls: Tame Same;
            struct_rest: Any SameIfFinite;
            struct_result: Any SameIfFinite;
            collatz: Tame Same;
            truth_variables: Tame Same;
            constants: Any SameIfFinite;
            vector_parts: Any SameIfFinite;
            cells_in_turn: Any SameIfFinite;
            small_vectors: Tame Same;
            constant_integers: Any Same;
            splats: Tame Same;
            newton: Tame Same;
            mandelbrot: Tame Same;
            match_numbers: Tame Same;
            match_signed: Tame Same;
            match_in_loops: Tame Same;
            tuples: Tame Same;
            tuple_result: Tame Same;
            tuple_calls: Tame Same;
            struct_patterns: Tame Same;
            inclusive_ranges: Tame Same;
            reversed_ranges: Tame Same;
            labelled_blocks: Tame Same;
            array_elements: Tame Same;
            random_sum: Any Same;
            random_walk: Tame Same;
            changed_arguments: Tame Same;
            lights: Tame Explained;
            sources: Any Same;
            constant_parameters: Any SameIfFinite;
            sizes: Any Same;
            permuted_names: Tame Explained;
            swapped_by_assignment: Any Explained;
            changed_counters: Any Same;
            arguments_in_order: Tame Explained;
            effects_in_arms: Tame Explained;
            bare_integers: Tame Same;
            trailing_points: Any SameIfFinite;
            names_of_generated_code: Tame Explained;
            changed_while_read: Tame Explained;
            known_truths: Any SameIfFinite;
            named_type_parameters: Any SameIfFinite;
            own_operators: Tame Explained;
            own_names: Tame Explained;
            names_of_two_traits: Tame Explained;
            exits_in_values: Tame Same;
            arms_that_return: Tame Same;
            generic_elements: Tame Explained;
            constant_arguments: Tame Explained;
            ranges_with_steps: Any Same;
        }
    };
}

/// [`kernel_table!`] with one or two kernels of each kind of statement and operation, and `$more`.
#[macro_export]
macro_rules! small_kernel_table {
    ($use:ident $($more:tt)*) => {
        $use! {
            else_arms: Tame Same;
            labelled: Tame Same;
            return_in_loops: Tame Same;
            early_returns: Any SameIfFinite;
            masked_division: Any Same;
            vector_places: Any SameIfFinite;
            calls_in_branches: Tame Same;
            methods: Tame Same;
            struct_branches: Tame Same;
            integers: Any Same;
            bits: Any Same;
            shifts: Any Same;
            signed: Any Same;
            hash: Any Same;
            from_float: Any Same;
            to_float: Any Same;
            truths: Any Same;
            clamped: Any SameIfFinite;
            float_methods: Any SameIfFinite;
            float_bits: Any Same;
            fused: Any Explained;
            vectors: Tame Same;
            transforms: Any SameIfFinite;
            unorms: Any Same;
            arrays: Any Same;
            match_tuples: Tame Same;
            loops_with_values: Tame Same;
            array_of_structs: Tame Same;
            enums: Tame Same;
            angles: Any Explained;
            growth: Any Explained;
            $($more)*
        }
    };
}

// Control flow.

#[kernel]
pub fn if_that_ends_lanes(x: f32, y: f32) -> f32 {
    if x < 0.0 {
        return -x;
    }
    let z = x * y;
    if z > 50.0 {
        return z - 50.0;
    }
    z + 1.0
}

#[kernel]
pub fn else_arms(x: f32, n: u32) -> f32 {
    let mut sum = 0.0;
    for i in 0..n {
        if x < i as f32 {
            sum += 1.0;
            if sum > 3.0 {
                break;
            } else {
                sum += 0.25;
            }
        } else if x > 10.0 {
            sum -= 0.125;
            continue;
        } else {
            sum += x;
        }
        sum *= 1.5;
    }
    sum
}

#[kernel]
pub fn labelled(x: f32, n: u32) -> f32 {
    let mut sum = 0.0;
    'outer: for i in 0..n {
        sum += 1.0;
        'middle: for j in 0..i {
            let mut k = 0u32;
            loop {
                k += 1;
                if k > 3 {
                    break;
                }
                if x < sum && j > 2 {
                    continue 'outer;
                }
                if x > 90.0 && i == 5 {
                    break 'outer;
                }
                if k == 2 && j == 3 {
                    continue 'middle;
                }
                if sum > 40.0 {
                    break 'middle;
                }
                sum += x * 0.125;
            }
            sum += 0.5;
        }
        sum += 0.25;
    }
    sum
}

#[kernel]
pub fn return_in_loops(x: f32, n: u32) -> f32 {
    let mut a = x;
    for i in 0..n {
        let mut j = 0u32;
        while j < i {
            a = a * 0.75 + 1.0;
            if a > 3.5 && j == 2 {
                return a;
            }
            for k in 0..j {
                if a < -2.0 {
                    return k as f32;
                }
                a += 0.125;
            }
            j += 1;
        }
    }
    a
}

#[kernel]
pub fn store_before_if(x: f32) -> f32 {
    let mut count = 0.0;
    let mut y = x;
    while y < 20.0 {
        count += 1.0;
        y = y + 1.5;
        if y > 10.0 {
            y = y * 1.5;
        }
        if count > 30.0 {
            break;
        }
    }
    count + y
}

#[kernel]
pub fn for_with_continue(n: u32, m: u32) -> u32 {
    let mut sum = 0u32;
    for i in 0..n {
        if i % 3 == 0 {
            continue;
        }
        sum = sum.wrapping_add(i);
        if (i & 1) != 0 {
            continue;
        }
        sum = sum.wrapping_mul(m);
    }
    sum
}

#[kernel]
pub fn for_over_signed(low: i32, high: i32) -> i32 {
    let mut sum = 0i32;
    for i in low..high {
        if i < -10 {
            continue;
        }
        sum = sum * 3 % 1000 + i;
    }
    for _ in -2..3i32 {
        sum += 1;
    }
    sum
}

#[kernel]
pub fn loop_until(x: f32) -> u32 {
    let mut n: u32 = 0;
    let mut y = x;
    loop {
        n += 1;
        y = y * 0.5 - 1.0;
        if y < -1.5 || n == 40 {
            break;
        }
        if n % 2 == 0 {
            continue;
        }
        y += 0.125;
    }
    n
}

#[kernel]
pub fn while_with_both(n: u32, x: f32) -> f32 {
    let mut i = 0u32;
    let mut y = x;
    while i < n && y * y < 500.0 || i < 2 {
        y = y + 1.25;
        i += 1;
    }
    y * i as f32
}

#[kernel]
pub fn early_returns(x: f32, y: f32) -> f32 {
    if x > y {
        if x > 10.0 {
            return 1.0;
        } else if y < -10.0 {
            return 2.0;
        }
    } else {
        if x < 0.0 {
            return x - y;
        } else {
            return x + y;
        }
    }
    x * 3.0
}

#[kernel]
pub fn value_ifs(x: f32, y: f32) -> f32 {
    let a = if x > 0.0 {
        let b = if y > 0.0 { x + y } else { x - y };
        b * 2.0
    } else if y > 10.0 {
        if x < -50.0 { 3.0 } else { y }
    } else {
        x * y
    };
    let c = 1.0 + if a > 5.0 { a } else { -a };
    c - if x == y { 1.0 } else { 0.5 }
}

#[kernel]
pub fn blocks_with_exits(x: f32, n: u32) -> f32 {
    let a = {
        let t = x * 2.0;
        t + 1.0
    };
    let mut sum = a;
    for i in 0..n {
        let step = {
            if sum > 30.0 {
                break;
            }
            let s = i as f32;
            if s == 3.0 {
                continue;
            }
            s * 0.5
        };
        let other = if step > 2.0 {
            if x < -20.0 {
                return -1.0;
            }
            step
        } else {
            1.0
        };
        sum += step + other;
    }
    sum
}

#[kernel]
pub fn tail_is_an_if(x: f32, y: f32) -> Vec3 {
    if x > y {
        vec3(x, y, 0.0)
    } else if x == y {
        Vec3::splat(x)
    } else {
        let v = vec3(y, x, 1.0);
        v * 2.0
    }
}

#[kernel]
pub fn masked_division(a: u32, b: u32) -> u32 {
    let mut r = 0u32;
    if b != 0 && a / b > 2 {
        r += 1;
    }
    if b == 0 || a % b == 0 {
        r += 2;
    }
    if b > 5 {
        r += 100 / b;
    }
    if !(b == 0 || a / b < 7) && a % b != 1 {
        r += 1000;
    }
    r
}

/// The right side of `&&` overflows where the left side is false.
#[kernel]
pub fn guarded_sum(a: u32, b: i32) -> u32 {
    let mut r = 0u32;
    if a > 0 && a - 1 < 10 {
        r += 1;
    }
    if a == 4294967295 || a + 1 > 100 {
        r += 2;
    }
    if b < 1000 && b > -1000 && b * b > 100 {
        r += 4;
    }
    if a < 32 && (1u32 << a) > 50 {
        r += 8;
    }
    r
}

#[kernel]
pub fn declared_later(x: f32, y: f32) -> f32 {
    let a;
    let b: f32;
    if x > 1.0 {
        a = x;
        b = y * 0.5;
    } else {
        a = y;
        b = 2.0;
    }
    a - b
}

// Places.

#[derive(Clone, Copy, Debug, Type)]
pub struct Particle {
    pub position: Vec3,
    pub mass: f32,
    pub alive: bool,
    pub hits: u32,
}

#[derive(Clone, Copy, Debug, Type)]
pub struct Pair {
    pub first: Particle,
    pub second: Particle,
    pub weight: i32,
}

#[kernel]
pub fn struct_places(p: Particle, x: f32) -> Particle {
    let mut q = p;
    q.position.x += x;
    q.position.z *= 2.0;
    if q.position.y > 0.0 {
        q.alive = !q.alive;
        q.hits += 1;
        q.position = q.position + vec3(1.0, 0.0, x);
    }
    if x > 10.0 {
        q = p;
        q.mass = -x;
    }
    q.mass -= 0.5;
    q
}

#[kernel]
pub fn vector_places(v: Vec3, x: f32) -> Vec3 {
    let mut w = v;
    w.x = x;
    w.y += v.z;
    if w.y > 3.0 {
        w *= 2.0;
        w.z = w.x - w.z;
    }
    w -= vec3(0.25, x, 0.5);
    w /= 3.0;
    w
}

#[kernel]
pub fn compound(a: u32, b: i32, x: f32) -> f32 {
    let mut n = a;
    n += 7;
    n *= 3;
    n -= 2;
    n /= 4;
    n %= 11;
    n |= 0x50;
    n &= 0x7e;
    n ^= 0x0f;
    n <<= 3;
    n >>= 1;
    let mut i = b;
    i *= -2;
    i -= 5;
    let mut y = x;
    y /= 7.0;
    y *= y;
    y -= n as f32;
    y + i as f32
}

#[kernel]
pub fn shadowing(x: f32, y: f32) -> f32 {
    let x = x + 1.0;
    let mut y = y * x;
    if x > 3.0 {
        let x = y - 1.0;
        let mut y = x * 0.5;
        y += 1.0;
        if y > x {
            let x = 2.0;
            y = y * x;
        }
        return y + x;
    }
    y += x;
    let y = y - 0.5;
    let x = if y > 0.0 { x } else { -x };
    x * y
}

// Calls.

#[kernel]
pub fn half(x: f32) -> f32 {
    x * 0.5
}

#[kernel]
pub fn first_below(x: f32, limit: f32) -> f32 {
    let mut y = x;
    for _ in 0..40u32 {
        if y < limit {
            return y;
        }
        y = half(y) - 1.0;
    }
    limit
}

#[kernel]
pub fn deeper(x: f32, n: u32) -> f32 {
    if n % 2 == 0 {
        return first_below(x, 3.0);
    }
    half(first_below(x * 2.0, half(x)))
}

#[kernel]
pub fn calls(x: f32, n: u32) -> f32 {
    deeper(x, n) + deeper(half(x), n + 1)
}

#[kernel]
pub fn calls_in_branches(x: f32, n: u32) -> f32 {
    let mut sum = 0.0;
    for i in 0..n {
        sum += if x > i as f32 {
            if deeper(x, i) > 1.0 {
                continue;
            }
            half(sum)
        } else if first_below(x, sum) < -20.0 {
            return sum;
        } else {
            deeper(sum, i)
        };
    }
    sum
}

#[kernel]
impl Particle {
    pub fn moved(&self, by: Vec3) -> Self {
        Self { position: self.position + by, ..*self }
    }

    pub fn is_heavy(&self, limit: f32) -> bool {
        self.mass > limit && self.alive
    }

    pub fn heavier(self, other: Self) -> Particle {
        if other.is_heavy(self.mass) {
            return other;
        }
        self
    }

    pub fn at_rest(mass: f32) -> Self {
        Particle { position: vec3(0.0, 0.0, 0.0), mass, alive: true, hits: 0 }
    }
}

#[kernel]
pub fn methods(p: Particle, q: Particle, x: f32) -> Particle {
    let mut r = p.moved(vec3(x, 0.0, 1.0));
    if r.is_heavy(x) {
        r = r.heavier(q.moved(p.position));
    } else {
        r = Particle::at_rest(x).heavier(r);
    }
    r
}

#[kernel]
pub fn struct_rest(p: Particle, x: f32) -> Particle {
    let light = Particle { mass: x, ..p };
    let dead = Particle { alive: false, hits: light.hits | 1, ..light };
    if x > 0.0 { Particle { position: dead.position * x, ..dead } } else { dead }
}

#[kernel]
pub fn struct_result(x: f32, n: u32) -> Pair {
    let first = Particle { position: vec3(x, 1.0, 2.0), mass: x, alive: x > 0.0, hits: n };
    let second = Particle { position: -first.position, hits: !n, ..first };
    Pair { first, second, weight: n as i32 }
}

#[kernel]
pub fn struct_branches(a: Pair, x: f32) -> Pair {
    let mut p = a;
    for i in 0u32..3 {
        let chosen = if x > i as f32 { p.first } else { p.second };
        if chosen.mass > 5.0 {
            p.second = chosen.moved(vec3(1.0, 1.0, x));
            p.weight += 1;
        } else {
            p.first.hits += i;
            p = Pair { first: p.second, second: p.first, ..p };
        }
        if p.first.alive && p.second.alive {
            return p;
        }
    }
    p
}

// Integers.

#[kernel]
pub fn integers(a: u32, b: u32) -> u32 {
    let sum = a.wrapping_add(b).wrapping_sub(17);
    let product = sum.wrapping_mul(2654435761);
    let d = if b == 0 { 1u32 } else { b };
    let q = product / d;
    let r = product % d;
    q.min(r.wrapping_mul(3)).max(5).wrapping_add(a / 7 + b % 10)
}

#[kernel]
pub fn bits(a: u32, b: u32, c: i32) -> u32 {
    let x = (a & b) | (!a & 0x0f0f_0f0f);
    let y = a ^ b ^ x;
    let z = !c & 255 | c ^ -1;
    y ^ (z as u32)
}

#[kernel]
pub fn shifts(a: u32, n: u32, b: i32) -> u32 {
    let s = n & 31;
    let left = a << s;
    let right = a >> s;
    let arithmetic = b >> s;
    let fixed = (a << 5) ^ (a >> 27) ^ ((b << 3) as u32);
    left ^ right ^ fixed ^ (arithmetic as u32)
}

#[kernel]
pub fn signed(a: i32, b: i32) -> i32 {
    let d = if b == 0 || b == -1 { 3i32 } else { b };
    let q = a / d;
    let r = a % d;
    let n = if a > -1000 && a < 1000 { -a } else { a };
    q.wrapping_add(r.wrapping_mul(31)).wrapping_sub(n).max(-2000000000).min(b.wrapping_add(n))
}

#[kernel]
pub fn hash(x: u32) -> u32 {
    let mut h = x;
    h = (h ^ (h >> 16)).wrapping_mul(0x7feb_352d);
    h = (h ^ (h >> 15)).wrapping_mul(0x846c_a68b);
    h ^ (h >> 16)
}

#[kernel]
pub fn collatz(n: u32, limit: u32) -> u32 {
    let mut x = n + 1;
    let mut steps = 0u32;
    while x != 1 {
        if x % 2 == 0 {
            x /= 2;
        } else {
            x = x * 3 + 1;
        }
        steps += 1;
        if steps >= limit {
            return limit;
        }
    }
    steps
}

#[derive(Clone, Copy, Debug, Type)]
pub struct Casts {
    pub i: i32,
    pub u: u32,
    pub back: f32,
    pub wrapped: u32,
}

#[kernel]
pub fn from_float(x: f32) -> Casts {
    let i = x as i32;
    let u = x as u32;
    Casts { i, u, back: i as f32, wrapped: i as u32 }
}

#[kernel]
pub fn to_float(a: i32, b: u32) -> Vec4 {
    vec4(a as f32, b as f32, (a as u32) as f32, (b as i32) as f32)
}

#[kernel]
pub fn truths(a: u32, x: f32) -> u32 {
    let p = x > 0.0;
    let q = a % 2 == 1;
    let n = (p as u32) + (q as u32) * 2;
    let m = (p && q) as u32 * 4 + (p || !q) as u32 * 8 + (p ^ q) as u32 * 16;
    let k = (p == q) as i32 * 32 + (p != (a > 7)) as i32 * 64 + (p & q | !p) as i32 * 128;
    n + m + k as u32
}

#[kernel]
pub fn truth_variables(x: f32, n: u32) -> bool {
    let mut seen = false;
    let mut done: bool = x < -50.0;
    for i in 0..n {
        if x < i as f32 {
            seen = true;
        }
        done = done || (seen && i > 6);
        if done {
            break;
        }
    }
    seen != done
}

// Numbers.

#[kernel]
pub fn clamped(x: f32, y: f32, z: f32) -> Vec4 {
    let low = min(y, z);
    let high = max(y, z);
    vec4(clamp(x, low, high), x.min(y), z.max(x), min(max(x, 0.0), 1.0))
}

#[kernel]
pub fn float_methods(x: f32, y: f32) -> Vec4 {
    let root = (x * x + y * y).sqrt();
    let parts = x.floor() + y.ceil() - x.trunc();
    vec4(root, parts, x.abs() / (y.abs() + 1.0), x.copysign(y) + y.recip())
}

#[kernel]
pub fn float_bits(x: f32, n: u32) -> u32 {
    let exponent = (x.to_bits() >> 23) & 255;
    let unit = f32::from_bits(0x3f80_0000 | (n >> 9)) - 1.0;
    exponent ^ unit.to_bits()
}

#[kernel]
pub fn fused(x: f32, y: f32, z: f32) -> f32 {
    x.mul_add(y, z)
}

/// A constant of the module.
pub const SCALE: f32 = 0.625;

#[kernel]
pub fn constants(x: f32) -> f32 {
    const LOCAL: f32 = 3.5;
    let v = Vec3::new(x, SCALE, LOCAL) + Vec3::X;
    if x > LOCAL { v.x * SCALE } else { min(x, f32::MAX) + v.z * core::f32::consts::PI }
}

#[derive(Clone, Copy, Debug, Type)]
pub struct Products {
    pub cross: Vec3,
    pub unit: Vec3,
    pub dot: f32,
    pub length: f32,
    pub least: Vec3,
    pub scaled: Vec3,
}

#[kernel]
pub fn vectors(a: Vec3, b: Vec3, x: f32) -> Products {
    let shifted = a + vec3(100.5, 0.0, 0.25);
    Products {
        cross: a.cross(b),
        unit: shifted.normalize(),
        dot: a.dot(b) - a.length_squared(),
        length: (a - b).length(),
        least: a.min(b).max(-a).abs(),
        scaled: x * a - b / 3.0 + a * b - 2.0 * b,
    }
}

#[kernel]
pub fn vector_parts(a: Vec3, b: Vec3) -> Vec3 {
    let v = a.floor() + b.ceil() - a.trunc();
    let w = vec3(a.min_element(), b.max_element(), v.z);
    if w.x > w.y { -w } else { w.extend(1.0).truncate() + b.abs() }
}

/// A cell of a grid that repeats in all directions.
#[derive(Clone, Copy, Debug, Type)]
#[repr(C)]
pub struct Cell {
    pub at: IVec3,
    pub inside: BVec3,
    pub seed: UVec2,
}

/// Integer vectors and masks as variables, members, arguments of a loop and of a branch.
#[kernel]
pub fn cells_in_turn(p: Vec3, cell: Cell, n: u32) -> Cell {
    let mut at = p.clamp(Vec3::splat(-1e6), Vec3::splat(1e6)).floor().as_ivec3() & 0xfff;
    let mut seed = cell.seed ^ uvec2(n, 0x9e37);
    for i in 0..(n & 3) {
        seed = seed.wrapping_mul(UVec2::splat(747_796_405)).yx();
        at.z += (seed.x >> 28) as i32;
        if any(at.cmpgt(ivec3(300, 200, 100))) {
            at = at.zxy() % 100 - i as i32;
        }
    }
    let inside = cell.inside & at.cmplt(IVec3::splat(64));
    let at = IVec3::select(inside, at, -at / 2);
    Cell { at: select(all(inside), at, at + IVec3::ONE), inside, seed }
}

/// Matrices as arguments and variables, their columns as members.
#[kernel]
pub fn transforms(m: Mat4, n: Mat3, p: Vec3) -> Vec3 {
    let mut turned = n * n.transpose();
    turned.x_axis += p.zyx();
    if determinant(turned) < 0.0 {
        turned = turned * 0.5;
    }
    let v = m * p.extend(1.0);
    turned * transform_point(m, p) + select(v.w > 0.0, v.xyz() / v.w, v.zyx())
}

#[kernel]
pub fn small_vectors(a: Vec2, b: Vec4, x: f32) -> Vec4 {
    let c = vec2(x, 2.0) * a + Vec2::splat(0.5);
    let d = c.normalize() - a / 7.0;
    let e = b * x - vec4(d.x, d.y, c.dot(a), c.length());
    e + Vec4::new(a.x, a.y, b.z, b.w) * 0.25
}

#[derive(Clone, Copy, Debug, Type)]
pub struct Codes {
    pub a: Unorm8,
    pub b: Unorm8,
    pub c: Unorm16,
    pub d: Unorm32,
}

#[kernel]
pub fn unorms(c: Codes) -> Vec4 {
    vec4(c.a.to_f32(), c.b.to_f32(), c.c.to_f32(), c.d.to_f32())
}

#[derive(Clone, Copy, Debug, Type)]
pub struct Table {
    pub values: [u32; 4],
    pub colors: [Unorm8; 3],
    pub flag: bool,
}

#[kernel]
pub fn arrays(t: Table, n: u32) -> u32 {
    let mut r = t.values[0] ^ t.values[3];
    if n > t.values[1] {
        r = r ^ t.colors[2].to_bits() as u32;
    }
    if t.flag { r } else { !r }
}

/// WGSL refuses constant expressions that overflow.
#[kernel]
pub fn constant_integers(n: u32, i: i32) -> u32 {
    let a = 4294967295u32 << 3;
    let b = (5u32 as i32) << 31;
    let c = ((13u32 < 2) as u32 | 0xff) << 30;
    let d = -(i32::MIN >> 1);
    let e = f32::from_bits(0x7f80_0000) > n as f32;
    (n | a) ^ (c >> 1) ^ ((i & b & d) as u32) ^ (e as u32)
}

/// Both sides of an operator are one number in all components, and one is a literal.
#[kernel]
pub fn splats(x: f32, y: f32) -> Vec3 {
    let a = Vec3::splat(3.0) * x;
    let b = Vec3::splat(x - y) + Vec3::splat(0.25);
    a + y / Vec3::splat(3.0) - b
}

#[kernel]
pub fn newton(x: f32) -> f32 {
    let a = x.abs() + 0.5;
    let mut y = a;
    let mut last = 0.0;
    while (y - last).abs() > 0.0001 * y {
        last = y;
        y = (y + a / y) * 0.5;
    }
    y
}

#[kernel]
pub fn mandelbrot(x: f32, y: f32) -> u32 {
    let cx = x * 0.03;
    let cy = y * 0.03;
    let mut zx = 0.0;
    let mut zy = 0.0;
    for i in 0..50u32 {
        let xx = zx * zx;
        let yy = zy * zy;
        if xx + yy > 4.0 {
            return i;
        }
        zy = 2.0 * zx * zy + cy;
        zx = xx - yy + cx;
    }
    50
}

// Elementary functions; `tests/elementary.rs` looks at each of them.

#[kernel]
pub fn angles(x: f32, y: f32) -> Vec4 {
    let turn = sincos_2pi(x * 0.01);
    vec4(sin(x), turn.cos, atan2(y, x), acos(turn.sin))
}

#[kernel]
pub fn growth(x: f32, y: f32) -> Vec4 {
    let z = if x > 0.0 { log(x) } else { expm1(x) };
    vec4(exp(y), z, pow(x, y), log2(x.abs()))
}
