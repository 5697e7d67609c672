//! Patterns, `match`, ranges of every kind, values of loops, arrays.

use raydsl::kernel;
use raydsl::prelude::*;

use super::Particle;

const LIMIT: u32 = 9;

#[kernel]
pub fn match_numbers(x: f32, n: u32) -> f32 {
    match n {
        0 => x,
        1 | 2 => -x,
        3..=5 => x * 2.0,
        LIMIT => 99.0,
        m if m > 15 && x > 0.0 => m as f32,
        k @ 6..=8 => x + k as f32,
        other => x * other as f32,
    }
}

#[kernel]
pub fn match_signed(i: i32, x: f32) -> i32 {
    let mut sum = 1i32;
    match i {
        i32::MIN..=-10 => sum = 5,
        -9 | -7 => {
            sum += 2;
            if x > 0.0 {
                return sum;
            }
        }
        -1 => sum -= 1,
        0..4 => {}
        _ => return 7,
    }
    sum * 2
}

#[kernel]
pub fn match_tuples(a: u32, b: u32, c: bool) -> u32 {
    let found = match (a % 3, b % 3) {
        (0, 0) => 10,
        (0, y) if y > 1 => 11,
        (1, y) if c => 20 + y,
        (x, 2) => 30 + x,
        (..) => 40u32,
    };
    match c {
        true => found,
        false => found + 100,
    }
}

#[kernel]
pub fn match_in_loops(x: f32, n: u32) -> f32 {
    let mut sum = 0.0;
    for i in 0..n {
        sum += match i % 4 {
            0 => continue,
            1 => x,
            2 if sum > 50.0 => break,
            _ => 0.5,
        };
    }
    sum
}

#[kernel]
pub fn tuples(x: f32, n: u32) -> f32 {
    let (a, b) = (x * 2.0, n + 1);
    let (mut c, (d, _)) = (a - 1.0, (b as f32, 3u32));
    let pair: (f32, u32) = if x > 0.0 { (c, 1) } else { (d, 2) };
    let mut swapped = (pair.1, pair.0);
    swapped.0 += b;
    c += swapped.1;
    let (a, c) = (c, a);
    a * c + swapped.0 as f32
}

#[kernel]
pub fn tuple_result(x: f32, n: u32) -> (u32, f32) {
    if x > 10.0 {
        return (0, x);
    }
    (n, -x)
}

#[kernel]
pub fn tuple_calls((x, n): (f32, u32), scale: f32) -> f32 {
    let (count, y) = tuple_result(x * scale, n);
    y + count as f32
}

#[kernel]
pub fn struct_patterns(p: Particle, x: f32) -> f32 {
    let Particle { position, mass: m, .. } = p;
    let Vec3 { x: px, .. } = position;
    match p {
        Particle { alive: true, hits: 0..=3, .. } => m + x,
        Particle { alive: false, mass, .. } => mass - px,
        _ => px * x,
    }
}

#[kernel]
pub fn inclusive_ranges(n: u32, i: i32) -> i32 {
    let mut sum = 0i32;
    for k in 1..=n {
        if k == 7 {
            continue;
        }
        sum += k as i32;
    }
    for k in i..=3 {
        sum -= k;
        if sum < -60 {
            break;
        }
    }
    for k in u32::MAX - 2..=u32::MAX {
        sum ^= (k & 7) as i32;
    }
    sum
}

#[kernel]
pub fn reversed_ranges(n: u32, x: f32) -> f32 {
    let mut sum = x;
    for k in (0..n).rev() {
        sum = sum * 0.5 + k as f32;
        if sum > 30.0 {
            continue;
        }
        sum += 1.0;
    }
    for k in (0u32..=3).rev() {
        sum -= k as f32 * 0.25;
    }
    for _ in (2..=n).rev().rev() {
        sum += 0.125;
    }
    sum
}

#[kernel]
pub fn loops_with_values(x: f32, n: u32) -> f32 {
    let mut i = 0u32;
    let first = loop {
        i += 1;
        if i as f32 * 3.0 > x {
            break i as f32;
        }
        if i > n {
            break -1.0;
        }
    };
    let outer = 'a: loop {
        loop {
            i += 1;
            if i % 5 == 0 {
                break 'a i;
            }
            if i > 12 {
                break;
            }
        }
        break 100;
    };
    first + outer as f32
}

#[kernel]
pub fn labelled_blocks(x: f32, n: u32) -> f32 {
    let mut sum = x;
    'outer: for i in 0..n {
        let y = 'pick: {
            if sum > 20.0 {
                break 'pick 1.0;
            }
            if i == 4 {
                continue 'outer;
            }
            if sum < -50.0 {
                break 'outer;
            }
            sum * 0.5
        };
        sum += y;
    }
    'done: {
        if sum > 5.0 {
            break 'done;
        }
        sum += 100.0;
    }
    sum
}

#[kernel]
pub fn array_elements(x: f32, n: u32, i: i32) -> f32 {
    let weights = [0.25, x, 1.5, -2.0];
    let mut counts = [0u32; 3];
    for k in 0..n {
        counts[(k % 3) as usize] += k;
    }
    counts[1] = counts[0] + 1;
    let mut table = [[x; 2], [1.0, 2.0]];
    table[(n & 1) as usize][(i & 1) as usize] *= 3.0;
    let [first, .., _] = [n, 1, 2];
    weights[(n % 4) as usize] + counts[(i & 1) as usize] as f32 + table[1][0] - table[0][1]
        + first as f32
}

#[kernel]
pub fn array_of_structs(p: Particle, n: u32) -> f32 {
    let mut all = [p, p.moved(vec3(1.0, 2.0, 3.0))];
    let i = n & 1;
    all[i as usize].mass += 1.5;
    all[i as usize].position.y = 4.0;
    if all[0].alive {
        all[(1 - i) as usize].hits = n;
    }
    let a = all[i as usize];
    let length = all[i as usize].position.length_squared();
    a.mass + a.position.dot(all[0].position) + all[1].hits as f32 + length
}
