//! The two kernels that other kernel languages were measured with: random rays against spheres held
//! in a buffer, and the same with eight rays of ambient occlusion for each hit.

use raydsl::kernel;
use raydsl::prelude::*;

#[derive(Clone, Copy, Debug, Type)]
#[repr(C)]
pub struct Ball {
    pub center: Vec3,
    pub radius: f32,
}

#[derive(Clone, Copy, Debug, PartialEq, Type)]
#[repr(C)]
pub struct Found {
    pub t: f32,
    pub id: u32,
}

#[kernel]
pub fn closest(balls: &[Ball], o: Vec3, d: Vec3) -> Found {
    let mut best = Found { t: 1e30, id: 0xffff_ffff };
    for (i, ball) in balls.iter().enumerate() {
        let f = o - ball.center;
        let b = f.dot(d);
        let l = f - d * b;
        let h = ball.radius * ball.radius - l.dot(l);
        if h < 0.0 {
            continue;
        }
        let t = -b - h.sqrt();
        if t > 1e-3 && t < best.t {
            best = Found { t, id: i as u32 };
        }
    }
    best
}

#[kernel]
fn is_blocked(balls: &[Ball], o: Vec3, d: Vec3) -> bool {
    for ball in balls {
        let f = o - ball.center;
        let b = f.dot(d);
        let l = f - d * b;
        let h = ball.radius * ball.radius - l.dot(l);
        if h >= 0.0 && -b - h.sqrt() > 1e-3 {
            return true;
        }
    }
    false
}

#[kernel]
fn random(state: &mut u32) -> f32 {
    *state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    (*state >> 8) as f32 / 16_777_216.0
}

#[kernel]
pub fn occluded(balls: &[Ball], o: Vec3, d: Vec3, seed: u32) -> f32 {
    let hit = closest(balls, o, d);
    if hit.t >= 1e30 {
        return -1.0;
    }
    let p = o + d * hit.t;
    let n = (p - balls[hit.id as usize].center).normalize();
    let mut state = seed;
    let mut open = 0.0;
    for _ in 0u32..8 {
        let around = sincos_2pi(random(&mut state));
        let z = 1.0 - 2.0 * random(&mut state);
        let r = max(1.0 - z * z, 0.0).sqrt();
        let way = (n + vec3(r * around.cos, r * around.sin, z)).normalize();
        if !is_blocked(balls, p, way) {
            open += 0.125;
        }
    }
    open
}
