//! Kernels whose rays part ways, each twice: as the branch policy has them, and with a test before
//! every arm.

#![allow(missing_docs, reason = "the names say what each kernel does")]

pub mod spheres;

use raydsl::kernel;
use raydsl::prelude::*;

/// A kernel, and the same with every arm tested.
macro_rules! both {
    ($($name:ident $tested:ident $params:tt -> f32 $body:tt)+) => {
        $(
            #[kernel]
            pub fn $name $params -> f32 $body

            #[kernel]
            #[coherent]
            pub fn $tested $params -> f32 $body
        )+
    };
}

both! {
    // Escape time: rays leave a short loop at different rounds.
    mandelbrot mandelbrot_tested (x: f32, y: f32, n: u32) -> f32 {
        let c = vec2(x * 1.5 - 0.5, y * 1.2);
        let mut z = c;
        let mut steps = 0.0;
        for i in 0u32..96 {
            let (xx, yy) = (z.x * z.x, z.y * z.y);
            if xx + yy > 4.0 {
                break;
            }
            z = vec2(xx - yy + c.x, 2.0 * z.x * z.y + c.y);
            if i & 3 == n & 3 {
                steps += 0.5;
            }
            steps += 1.0;
        }
        steps
    }

    // Whole numbers: halve or triple until one is left.
    collatz collatz_tested (x: f32, y: f32, n: u32) -> f32 {
        let mut k = (n & 0xffff) + 1;
        let mut steps = 0u32;
        let mut largest = k;
        while k != 1 && steps < 200 {
            if k & 1 == 0 {
                k >>= 1;
            } else {
                k = 3 * k + 1;
            }
            if k > largest {
                largest = k;
            }
            steps += 1;
        }
        steps as f32 + largest as f32 * 1e-6 + x - y
    }

    // Sphere tracing of a cut and rounded block on a floor.
    march march_tested (x: f32, y: f32, n: u32) -> f32 {
        let direction = vec3(x, y - 0.2, 1.5).normalize();
        let mut at = vec3(0.0, 0.6, -2.0);
        let mut way = 0.0;
        for _ in 0u32..80 {
            let q = vec3(at.x.abs() - 0.5, at.y.abs() - 0.5, at.z.abs() - 0.5);
            let outside = vec3(max(q.x, 0.0), max(q.y, 0.0), max(q.z, 0.0)).length();
            let inside = min(max(q.x, max(q.y, q.z)), 0.0);
            let mut d = outside + inside - 0.05;
            let hole = 0.62 - at.length();
            if hole > d {
                d = hole;
            }
            let floor = at.y + 0.8;
            if floor < d {
                d = floor;
            }
            if d < 1e-4 {
                return way;
            }
            way += d;
            if way > 20.0 {
                return -1.0;
            }
            at += direction * d;
        }
        way + (n & 1) as f32
    }

    // A walk that turns at random.
    walk walk_tested (x: f32, y: f32, n: u32) -> f32 {
        let mut state = n.wrapping_mul(747_796_405).wrapping_add(1);
        let mut at = vec2(x, y);
        let mut heading = vec2(1.0, 0.0);
        for i in 0u32..64 {
            state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
            let bits = (state >> 22) ^ state;
            if bits & 3 == 0 {
                heading = vec2(heading.y, -heading.x);
            } else if bits & 3 == 1 {
                heading = vec2(-heading.y, heading.x);
            }
            if bits & 0x70 == 0 {
                continue;
            }
            at += heading * 0.1;
            if at.length_squared() > 4.0 {
                at *= 0.5;
                if i > 50 {
                    break;
                }
            }
        }
        at.x + at.y
    }

    // Curves in pieces: the transfer functions of displays.
    curves curves_tested (x: f32, y: f32, n: u32) -> f32 {
        let mut sum = 0.0;
        for i in 0u32..32 {
            let v = (x + i as f32 * 0.043).abs();
            let u = v - v.floor();
            let linear = if u <= 0.04045 { u * 0.0773994 } else { u * (u * (u * 0.305306 + 0.682171) + 0.012522) };
            let toe = if linear < 0.18 { linear * 1.2 } else { linear - 0.03 };
            let shoulder = if toe > 0.8 { 0.8 + (toe - 0.8) * 0.25 } else if toe > 0.6 { toe * 0.98 } else { toe };
            sum += if i & 1 == n & 1 { shoulder } else { -y * shoulder };
        }
        sum
    }

    // A beam through glass plates: refraction, total reflection, Fresnel's equations.
    glass glass_tested (x: f32, y: f32, n: u32) -> f32 {
        let mut direction = vec3(x, y, 1.0).normalize();
        let mut weight = 1.0;
        for i in 0u32..24 {
            let normal = if (i + n) & 1 == 0 { vec3(0.0, 0.0, -1.0) } else { vec3(0.6, 0.0, -0.8) };
            let cos = direction.dot(normal);
            let entering = cos < 0.0;
            let eta = if entering { 1.0 / 1.5 } else { 1.5 };
            let facing = if entering { normal } else { -normal };
            let c = cos.abs();
            let k = 1.0 - eta * eta * (1.0 - c * c);
            if k < 0.0 {
                direction += facing * (2.0 * c);
                continue;
            }
            let t = k.sqrt();
            let parallel = (eta * c - t) / (eta * c + t);
            let vertical = (c - eta * t) / (c + eta * t);
            let reflected = 0.5 * (parallel * parallel + vertical * vertical);
            if reflected > 0.2 {
                weight *= reflected;
                direction += facing * (2.0 * c);
            } else {
                weight *= 1.0 - reflected;
                direction = direction * eta + facing * (eta * c - t);
            }
            if weight < 0.01 {
                return weight;
            }
        }
        weight + direction.x
    }
}
