//! The types of generated kernels, methods that they may call, and slices that they may read.

use raydsl::kernel;
use raydsl::machine::{Capture, KernelInfo, Machine, Recorder, Resource, Type};
use raydsl::prelude::*;

/// One member of each scalar type.
#[derive(Clone, Copy, Debug, Type)]
pub struct Small {
    /// A signed integer.
    pub i: i32,
    /// A truth value.
    pub t: bool,
    /// A float.
    pub y: f32,
    /// An unsigned integer.
    pub m: u32,
}

/// Members that have members.
#[derive(Clone, Copy, Debug, Type)]
pub struct Nested {
    /// A vector.
    pub v: Vec3,
    /// A struct.
    pub s: Small,
    /// An unsigned integer.
    pub k: u32,
}

/// An enum without fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Type)]
pub enum Kind {
    /// 0.
    Red,
    /// 4.
    Green = 4,
    /// 5.
    Blue,
}

/// An enum with fields, named and not, and one in it.
#[derive(Clone, Copy, Debug, Type)]
pub enum Shape {
    /// Two fields.
    Ball(f32, u32),
    /// Named fields.
    Block {
        /// A vector.
        low: Vec3,
        /// An enum.
        kind: Kind,
        /// A struct.
        inner: Small,
    },
    /// A field of the type of another variant's.
    Word(u32),
    /// No fields.
    Nothing,
}

/// What a generated kernel gives.
#[derive(Clone, Copy, Debug, Type)]
pub struct Outcome {
    /// Most of it.
    pub n: Nested,
    /// A float.
    pub x: f32,
    /// A truth value.
    pub t: bool,
    /// An enum.
    pub e: Kind,
    /// An array.
    pub c: [u32; 3],
    /// A vector of integers.
    pub j: IVec3,
}

#[kernel]
impl Small {
    /// One for each number.
    pub fn of(n: u32) -> Self {
        Self { i: (n & 7) as i32 - 3, t: (n & 1) != 0, y: (n & 15) as f32 * 0.5, m: n }
    }

    /// An early return and a member of the other.
    pub fn chosen(&self, other: Self, x: f32) -> Small {
        if self.y > x && !other.t {
            return other;
        }
        Self { y: x, ..*self }
    }

    /// A truth value of two.
    pub fn is_more(self, other: Small) -> bool {
        self.m > other.m || self.t && self.i < other.i
    }

    /// A tuple, early or late.
    pub fn parts(&self, n: u32) -> (f32, u32) {
        if self.t {
            return (self.y, n);
        }
        (0.5, self.m ^ n)
    }

    /// Changes one of two members.
    pub fn rise(&mut self, x: f32) {
        if self.y < x {
            self.y = x;
            return;
        }
        self.i = self.i.wrapping_add(1);
    }

    /// Changes a member and gives another value.
    pub fn fall(&mut self, n: u32) -> u32 {
        let old = self.m;
        self.m >>= 1;
        self.t = !self.t;
        old ^ n
    }
}

#[kernel]
impl Nested {
    /// One for each number.
    pub fn of(n: u32) -> Self {
        let x = (n & 31) as f32;
        Self { v: vec3(x, 0.5, -x), s: Small::of(n >> 1), k: n ^ 5 }
    }

    /// A loop in a method.
    pub fn moved(&self, by: Vec3, rounds: u32) -> Self {
        let mut v = self.v;
        for i in 0..rounds & 3 {
            if v.x > v.y {
                continue;
            }
            v += by * i as f32;
        }
        Nested { v, ..*self }
    }
}

#[kernel]
impl Kind {
    /// One for each number.
    pub fn of(n: u32) -> Self {
        match n % 3 {
            0 => Self::Red,
            1 => Kind::Green,
            _ => Self::Blue,
        }
    }

    /// Another one, or itself.
    pub fn next(self, n: u32) -> Self {
        match (self, n & 1 == 0) {
            (Kind::Red, true) => Kind::Green,
            (Self::Green, _) => Kind::Blue,
            (k, true) if n > 9 => k,
            _ => Kind::Red,
        }
    }

    /// A number for each.
    pub fn share(self) -> f32 {
        match self {
            Kind::Red => 0.5,
            Kind::Green => -2.0,
            Kind::Blue => 8.0,
        }
    }
}

#[kernel]
impl Shape {
    /// One for each number.
    pub fn of(n: u32) -> Self {
        match n % 4 {
            0 => Shape::Ball((n & 15) as f32 * 0.5, n),
            1 => Self::Block { kind: Kind::of(n >> 2), low: Vec3::X, inner: Small::of(n) },
            2 => Shape::Word(n ^ 9),
            _ => Shape::Nothing,
        }
    }

    /// A number for each, in a loop that changes the variant.
    pub fn walked(self, rounds: u32) -> f32 {
        let (mut shape, mut sum) = (self, 0.0);
        for i in 0..rounds & 3 {
            shape = match shape {
                Shape::Ball(r, n) if r < 2.0 => Shape::Word(n),
                Shape::Ball(r, _) => {
                    Shape::Block { low: Vec3::splat(r), kind: Kind::Blue, inner: Small::of(i) }
                }
                Shape::Block { low, inner: Small { m, t: true, .. }, .. } => Shape::Ball(low.x, m),
                Shape::Block { inner, kind, .. } => {
                    sum += kind.share();
                    Shape::Word(inner.m >> 1)
                }
                Shape::Word(0) => return sum,
                Shape::Word(n) => Shape::Ball((n & 7) as f32, n >> 1),
                Shape::Nothing => continue,
            };
            sum += shape.size();
        }
        sum
    }

    /// A number for each.
    pub fn size(&self) -> f32 {
        match *self {
            Shape::Ball(r, _) | Shape::Block { low: Vec3 { x: r, .. }, .. } => r,
            Shape::Word(n) => (n & 31) as f32,
            Shape::Nothing => -1.0,
        }
    }

    /// A word, where there is one.
    pub fn word(self) -> Option<u32> {
        if let Shape::Ball(_, n) | Shape::Word(n) = self {
            return Some(n);
        }
        None
    }
}

/// The smaller half of a number that is even.
#[kernel]
pub fn half(n: u32) -> Option<u32> {
    if n % 2 == 1 { None } else { Some(n / 2) }
}

/// The quarter of a number, less the half of another.
#[kernel]
pub fn quarter(n: u32, less: Option<u32>) -> Option<u32> {
    let quarter = half(if n > 3 { half(n) } else { Some(n) }?)?;
    Some(quarter.wrapping_sub(half(less?)?))
}

/// A number halved while it is even, at most so often; how often, where there is none.
#[kernel]
pub fn halved(first: Option<u32>, most: u32) -> Option<u32> {
    let Some(mut n) = first else {
        return Some(most);
    };
    let mut left = most & 7;
    while let Some(next) = half(n)
        && left > 0
    {
        n = next;
        left -= 1;
    }
    Some(n)
}

#[kernel]
impl Outcome {
    /// One for each number.
    pub fn of(n: u32) -> Self {
        let c = [n, 1, n >> 3];
        Self {
            n: Nested::of(n),
            x: n as f32,
            t: n > 3,
            e: Kind::of(n),
            c,
            j: ivec3(n as i32, -1, 0),
        }
    }
}

/// A trait with constants, a method with a body, and a function without a receiver.
#[kernel]
pub trait Weigh {
    /// The least weight.
    const FLOOR: f32;

    /// How much it weighs.
    fn weight(&self, by: f32) -> f32;

    /// Another one.
    fn turned(self, n: u32) -> Self;

    /// One for each number.
    fn made(n: u32) -> Self;

    /// Changes it.
    fn push(&mut self, by: f32);

    /// Written with what the trait has.
    fn twice(&self, by: f32) -> f32 {
        let once = self.weight(by);
        if once < Self::FLOOR {
            return Self::FLOOR;
        }
        once + self.weight(once)
    }
}

#[kernel]
impl Weigh for Small {
    const FLOOR: f32 = 0.5;

    fn weight(&self, by: f32) -> f32 {
        if self.t { self.y - by } else { by }
    }

    fn turned(self, n: u32) -> Self {
        Self { m: self.m ^ n, ..self }
    }

    fn made(n: u32) -> Self {
        Small::of(n)
    }

    fn push(&mut self, by: f32) {
        self.rise(by);
    }
}

#[kernel]
impl Weigh for Nested {
    const FLOOR: f32 = -4.0;

    fn weight(&self, by: f32) -> f32 {
        let mut sum = by;
        for i in 0..self.k & 3 {
            sum += self.v.y * i as f32;
        }
        sum
    }

    fn turned(self, n: u32) -> Self {
        Nested { v: self.v.zxy(), k: n, ..self }
    }

    fn made(n: u32) -> Self {
        Nested::of(n)
    }

    fn push(&mut self, by: f32) {
        self.v.x = by;
        self.s.rise(by);
    }

    fn twice(&self, by: f32) -> f32 {
        self.v.x - by
    }
}

/// The other way round, with another number.
#[kernel]
pub fn swapped((x, n): (f32, u32), y: f32) -> (f32, u32) {
    let (a, b) = (x as u32, n as f32);
    if b > y {
        return (b, a);
    }
    (y, n)
}

/// Adds, and gives the old value.
#[kernel]
pub fn add_to(n: u32, to: &mut u32) -> u32 {
    let old = *to;
    *to = old.wrapping_add(n);
    old
}

/// Calls a closure in a loop that it may end.
#[kernel]
pub fn swept(f: impl Fn(f32, u32) -> f32, from: f32, rounds: u32) -> f32 {
    let mut x = from;
    for i in 0..rounds & 3 {
        let next = f(x, i);
        if next == x {
            return f(next, rounds);
        }
        x = next;
    }
    x
}

/// Calls a closure in one of two arms, and changes another number.
#[kernel]
pub fn found<F>(is_found: F, n: u32) -> u32
where
    F: Fn(u32, Kind) -> bool,
{
    let mut tries = 0u32;
    for i in 0..3u32 {
        if is_found(n.wrapping_add(i), Kind::Blue) {
            return i;
        }
        add_to(i, &mut tries);
    }
    if is_found(tries, Kind::Red) { n } else { tries }
}

/// Passes a closure on, in one that calls it.
#[kernel]
pub fn refined(s: Small, f: &impl Fn(Small) -> Small) -> Small {
    let y = swept(|x, i| f(Small { y: x, m: i, ..s }).y, s.y, s.m);
    f(Small { y, ..s })
}

/// A slice of numbers.
pub static FLOATS: [f32; 9] = [0.5, -1.0, 2.0, 8.25, -0.125, 3.0, 1.0, 1e6, -7.5];
/// A slice of integers.
pub static WORDS: [u32; 7] = [3, 0, 0xffff_ffff, 17, 8, 0x8000_0000, 1];
/// A slice of structs.
pub static SMALLS: [Small; 3] = [
    Small { i: -3, t: true, y: 1.5, m: 2 },
    Small { i: 9, t: false, y: -0.5, m: 0xffff_0000 },
    Small { i: 0, t: true, y: 4.0, m: 12 },
];
/// A slice of enums: the first ones are of few kinds.
pub static SHAPES: [Shape; 6] = [
    Shape::Word(6),
    Shape::Word(0),
    Shape::Ball(2.5, 9),
    Shape::Ball(-0.5, 0xffff_ffff),
    Shape::Block {
        low: Vec3::new(1.0, -2.0, 0.25),
        kind: Kind::Green,
        inner: Small { i: 2, t: true, y: 0.5, m: 5 },
    },
    Shape::Nothing,
];
/// A square across the z axis: where a ray of simple numbers hits it is exact.
#[primitive]
pub struct Wall {
    /// Its place on the z axis.
    pub z: f32,
    /// Its corner.
    pub low: Vec2,
    /// The length of its edges.
    pub size: f32,
}

#[primitive]
impl Wall {
    const MAX_CROSSINGS: u32 = 1;

    fn intersect(&self, ray: Ray) -> Hit {
        let t = (self.z - ray.origin.z) / ray.direction.z;
        let at = vec2(ray.origin.x + ray.direction.x * t, ray.origin.y + ray.direction.y * t);
        let is_inside = at.x >= self.low.x
            && at.y >= self.low.y
            && at.x <= self.low.x + self.size
            && at.y <= self.low.y + self.size;
        Hit { u: at.x, v: at.y, ..Hit::new(is_inside && ray.direction.z != 0.0, t) }
    }

    fn get_bounds(&self) -> Aabb {
        let corner = self.low + Vec2::splat(self.size);
        Aabb { min: self.low.extend(self.z), max: corner.extend(self.z) }
    }
}

/// Two scenes as one.
#[derive(RayQuery)]
pub struct World<'a> {
    /// The first.
    pub near: &'a [Wall],
    /// The second.
    pub far: &'a [Wall],
}

/// A slice that is a scene: two of its walls are at one distance.
pub static WALLS: [Wall; 5] = [
    Wall { z: 2.0, low: Vec2::new(-4.0, -4.0), size: 8.0 },
    Wall { z: 1.0, low: Vec2::new(0.0, -2.0), size: 2.0 },
    Wall { z: 2.0, low: Vec2::new(-1.0, -1.0), size: 16.0 },
    Wall { z: -0.5, low: Vec2::new(-8.0, -8.0), size: 9.0 },
    Wall { z: 4.0, low: Vec2::new(-100.0, -100.0), size: 200.0 },
];
/// A scene of two, which share walls.
pub static WORLD: World<'static> = World { near: WALLS.split_at(3).0, far: WALLS.split_at(2).1 };
/// A number of the scene.
pub const SCALE: f32 = 0.75;

/// The first `len` elements, or all.
pub fn first<T>(list: &'static [T], len: usize) -> &'static [T] {
    &list[..len.min(list.len())]
}

/// Shows the slices of scenes of every length.
pub fn resources(visit: &mut dyn FnMut(&dyn Resource)) {
    for len in 1..=FLOATS.len() {
        Capture::<Recorder>::resources(first(&FLOATS, len), "list", visit);
        Capture::<Recorder>::resources(first(&WORDS, len), "list", visit);
        Capture::<Recorder>::resources(first(&SMALLS, len), "list", visit);
        Capture::<Recorder>::resources(first(&SHAPES, len), "list", visit);
        Capture::<Recorder>::resources(first(&WALLS, len), "list", visit);
    }
    Capture::<Recorder>::resources(&WORLD, "world", visit);
}

/// What stands for a slice on a machine.
pub fn on<'a, M: Machine, T: Type>(
    m: &M,
    list: &'a [T],
    name: &'static str,
) -> <[T] as Capture<M>>::On<'a>
where
    [T]: Capture<M>,
{
    <[T] as Capture<M>>::capture(list, m, name)
}

/// Of kernels that are not named.
pub static INFO: KernelInfo =
    KernelInfo { name: "function", file: file!(), line: line!(), params: &[], known: None };

/// `Entry`: the kernel `entry` of the module with the slices of a scene, as a function of the rest.
#[macro_export]
macro_rules! scene_entry {
    ($len:literal, $count:literal) => {
        pub enum Entry {}

        impl raydsl::machine::KernelFn for Entry {
            type Args = $crate::fuzz::run::Args;
            type Output = Outcome;

            fn info() -> &'static raydsl::machine::KernelInfo {
                &INFO
            }

            fn scalar((x, v, n, s): Self::Args) -> Outcome {
                let (floats, words) = (first(&FLOATS, $len), first(&WORDS, $len));
                let (smalls, shapes) = (first(&SMALLS, $len), first(&SHAPES, $len));
                let (scene, world) = (first(&WALLS, $len), &WORLD);
                entry(x, v, n, s, floats, words, smalls, shapes, scene, world, SCALE, $count)
            }

            fn lifted<M: raydsl::machine::Machine>(
                m: &M,
                (x, v, n, s): <Self::Args as Type>::On<M>,
            ) -> <Outcome as Type>::On<M> {
                let floats = on(m, first(&FLOATS, $len), "floats");
                let words = on(m, first(&WORDS, $len), "words");
                let smalls = on(m, first(&SMALLS, $len), "smalls");
                let shapes = on(m, first(&SHAPES, $len), "shapes");
                let scene = on(m, first(&WALLS, $len), "scene");
                let world = raydsl::machine::Capture::<M>::capture(&WORLD, m, "world");
                let scale = raydsl::machine::Capture::<M>::capture(&SCALE, m, "scale");
                entry::on(m, x, v, n, s, floats, words, smalls, shapes, scene, world, scale, $count)
            }
        }
    };
}
