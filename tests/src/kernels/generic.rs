//! Type parameters, traits, enums, `usize`.

use raydsl::kernel;
use raydsl::prelude::*;

/// Something that shines on a point.
#[kernel]
pub trait Light {
    const FLOOR: f32;

    fn shine(&self, at: Vec3) -> f32;

    /// Written with what the trait has.
    fn twice(&self, at: Vec3) -> f32 {
        let one = self.shine(at);
        if one < Self::FLOOR {
            return Self::FLOOR;
        }
        one + self.shine(at * 0.5)
    }

    fn dimmed(self, by: f32) -> Self;

    fn dark() -> f32 {
        0.25
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct Spot {
    pub at: Vec3,
    pub power: f32,
}

#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct Sun {
    pub direction: Vec3,
}

#[kernel]
impl Light for Spot {
    const FLOOR: f32 = 0.125;

    fn shine(&self, at: Vec3) -> f32 {
        let way = at - self.at;
        self.power / (way.dot(way) + 1.0)
    }

    fn dimmed(self, by: f32) -> Self {
        Self { power: max(self.power - by, by), ..self }
    }
}

#[kernel]
impl Light for Sun {
    const FLOOR: f32 = 0.0;

    fn shine(&self, at: Vec3) -> f32 {
        let c = self.direction.dot(at);
        if c > 0.0 { c } else { Self::dark() }
    }

    fn twice(&self, at: Vec3) -> f32 {
        max(self.shine(at), 0.5)
    }

    fn dimmed(self, by: f32) -> Self {
        Sun { direction: self.direction * by }
    }
}

/// A light behind a filter; it is a light too.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct Filtered<L: Light> {
    pub light: L,
    pub share: f32,
}

#[kernel]
impl<L: Light> Light for Filtered<L> {
    const FLOOR: f32 = 0.5;

    fn shine(&self, at: Vec3) -> f32 {
        let light: L = self.light;
        min(light.shine(at), self.share)
    }

    fn dimmed(self, by: f32) -> Self {
        Self { share: self.share * by, ..self }
    }
}

#[kernel]
impl<L: Light> Filtered<L> {
    pub fn open(self) -> L {
        self.light
    }
}

#[kernel]
pub fn lit<L: Light>(light: &L, at: Vec3, steps: u32) -> f32 {
    let mut sum = 0.0;
    let mut now: L = *light;
    for i in 0..steps {
        if i == 3 {
            continue;
        }
        sum += now.twice(at * i as f32);
        now = now.dimmed(0.5);
    }
    sum + L::dark()
}

#[kernel]
pub fn lights(x: f32, y: f32, n: u32) -> f32 {
    let spot = Spot { at: vec3(x, 1.0, 0.0), power: 4.0 };
    let sun = Sun { direction: vec3(0.0, 0.5, y) };
    let at = vec3(y, x, 1.0);
    let filtered = Filtered::<Spot> { light: spot, share: 0.75 };
    let mut sum =
        lit(&spot, at, n % 6) + lit(&sun, at, n % 3) + lit::<Filtered<Spot>>(&filtered, at, 2);
    if x > y {
        sum += filtered.shine(at) + filtered.open().shine(at) + Sun::dark();
    }
    sum
}

/// A source of random numbers, whatever it is.
#[kernel]
pub trait Source {
    fn next(&mut self) -> u32;

    fn below(&mut self, n: u32) -> u32 {
        self.next() % n
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct Counter {
    pub n: u32,
}

#[kernel]
impl Source for Counter {
    fn next(&mut self) -> u32 {
        self.n = self.n.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        self.n >> 4
    }
}

#[kernel]
pub fn draw<S: Source>(source: &mut S, n: u32) -> u32 {
    let mut sum = 0u32;
    for _ in 0..n {
        let x = source.below(10);
        if x == 9 {
            return sum;
        }
        sum += x;
    }
    sum + source.next() % 3
}

#[kernel]
pub fn sources(seed: u32, n: u32) -> (u32, u32) {
    let mut counter = Counter { n: seed };
    let first = draw(&mut counter, n % 17);
    let mut other = Counter { n: counter.next() };
    (first + draw(&mut other, 4), counter.n)
}

#[kernel]
pub fn sum_of<const N: usize>(values: [f32; N], scale: f32) -> f32 {
    let mut sum = 0.0;
    for i in 0..N {
        sum += values[i];
    }
    if N > 2 { sum * scale } else { sum - N as f32 }
}

#[kernel]
pub fn constant_parameters(x: f32, y: f32) -> f32 {
    sum_of([x, y, x * 0.5], 2.0) + sum_of::<2>([y, x], 3.0)
}

/// What a surface is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Type)]
pub enum Matter {
    Matte,
    Mirror = 4,
    Glass,
}

#[kernel]
impl Matter {
    pub fn of(n: u32) -> Self {
        match n % 3 {
            0 => Self::Matte,
            1 => Matter::Mirror,
            _ => Self::Glass,
        }
    }

    pub fn albedo(self) -> f32 {
        match self {
            Matter::Matte => 0.5,
            Self::Mirror => 0.9,
            Matter::Glass => 0.0,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct Surface {
    pub roughness: f32,
    pub matter: Matter,
}

#[kernel]
pub fn enums(x: f32, n: u32) -> Surface {
    use Matter::{Glass, Mirror};
    let mut surface = Surface { roughness: x, matter: Matter::of(n) };
    for i in 0..n % 5 {
        surface.matter = match (surface.matter, i % 2 == 0) {
            (Matter::Matte, true) => Mirror,
            (Mirror, _) => Matter::Glass,
            (Matter::Glass, even) if even => Matter::Matte,
            (m, _) => m,
        };
        if surface.matter != Glass {
            surface.roughness += surface.matter.albedo() * surface.matter as u32 as f32;
        }
    }
    surface
}

#[kernel]
pub fn sizes(n: u32, k: i32) -> (u32, f32, i32) {
    let table = [3.0, 1.0, 4.0, 1.5];
    let len = table.len();
    let mut i = n as usize % len;
    let mut sum = table[i] + table[2];
    for j in 0..len {
        if j == 2 {
            continue;
        }
        i = (i + j).min(len - 1);
        sum += table[i] * j as f32;
    }
    let last: usize = 2usize + i;
    (last as u32, sum, (k & 3) as usize as i32 + i as i32)
}
