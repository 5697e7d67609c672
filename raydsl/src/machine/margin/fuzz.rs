//! Fuzz test of the machine's operations: the `f32` result of a random program lies within an
//! outcome.

use super::*;
use crate::__at_run_time as at_run_time;
use crate::math::elementary as math;
use crate::math::exact::lost_by_cross;

/// The number of programs, unless `RAYDSL_MARGIN_FUZZ` gives another.
const PROGRAMS: u32 = 200_000;

/// Numbers most likely to break arithmetic.
const SPECIAL: [f32; 32] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    2.0,
    3.0,
    f32::NAN,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::MAX,
    f32::MIN,
    f32::MIN_POSITIVE,
    -f32::MIN_POSITIVE,
    1e-45,
    -1e-45,
    1e-40,
    1e-30,
    1e30,
    16_777_216.0,
    16_777_218.0,
    8_388_607.5,
    1.5,
    2.5,
    0.499_999_97,
    2_147_483_648.0,
    4_294_967_296.0,
    1e-20,
    1e20,
    0.1,
    0.7,
    1.1,
];

/// The `SplitMix64` generator.
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(from.len())]
    }

    fn number(&mut self) -> f32 {
        match self.below(4) {
            0 => self.pick(&SPECIAL),
            1 => f32::from_bits(self.bits() as u32),
            2 => (self.below(33) as f32 - 16.0) * 0.5,
            _ => ((self.bits() >> 40) as f32 / 16_777_216.0 - 0.5) * 20.0,
        }
    }
}

/// One operation on earlier values, given by their indices.
#[derive(Clone, Copy, Debug)]
enum Op {
    Number(f32),
    Unary(F32Unary, usize),
    Binary(F32Binary, [usize; 2]),
    MulAdd([usize; 3]),
    Select(Compare, [usize; 4]),
    /// A selection by two comparisons.
    SelectBoth(BoolBinary, [usize; 4]),
    ToI32(usize),
    ToU32(usize),
    /// 1 if comparing the value's size with infinity succeeds, else 0.
    Beside(Compare, usize),
    /// The bits, moved by some steps.
    Bits(usize, u32),
    CopySign([usize; 2]),
    Elementary(usize, [usize; 2]),
    /// The rounding error of a cross product of vectors of one number each.
    LostByCross([usize; 4]),
}

impl Op {
    /// Returns a random operation on some of `len` values.
    fn random(r: &mut Random, len: usize) -> Self {
        let [a, b, c, d] = core::array::from_fn(|_| r.below(len));
        match r.below(22) {
            0 => Self::Number(r.number()),
            1..=3 => Self::Unary(r.pick(F32Unary::ALL), a),
            4..=10 => Self::Binary(r.pick(F32Binary::ALL), [a, b]),
            11 => Self::MulAdd([a, b, c]),
            12 => Self::Select(r.pick(Compare::ALL), [a, b, c, d]),
            13 => Self::SelectBoth(r.pick(&[BoolBinary::And, BoolBinary::Or]), [a, b, c, d]),
            14 => Self::ToI32(a),
            15 => Self::ToU32(a),
            16 => Self::Bits(a, (r.below(5) as u32).wrapping_sub(2)),
            17 => Self::CopySign([a, b]),
            18 => Self::Beside(r.pick(Compare::ALL), a),
            19 => Self::LostByCross([a, b, c, d]),
            _ => Self::Elementary(r.below(15), [a, b]),
        }
    }

    fn run<M: Machine>(self, m: &M, v: &[M::F32]) -> M::F32 {
        match self {
            Self::Number(n) => m.f32(n),
            Self::Unary(op, a) => at_run_time!(F32Unary op, |op| m.f32_unary(op, v[a])),
            Self::Binary(op, [a, b]) => {
                at_run_time!(F32Binary op, |op| m.f32_binary(op, v[a], v[b]))
            }
            Self::MulAdd([a, b, c]) => m.f32_mul_add(v[a], v[b], v[c]),
            Self::Select(op, [a, b, c, d]) => {
                let chosen = at_run_time!(Compare op, |op| m.f32_compare(op, v[a], v[b]));
                m.f32_select(chosen, v[c], v[d])
            }
            Self::SelectBoth(op, [a, b, c, d]) => {
                let less = m.f32_compare(op::Lt, v[a], v[b]);
                let more = m.f32_compare(op::Ge, v[c], v[d]);
                let both = at_run_time!(BoolBinary op, |op| m.bool_binary(op, less, more));
                m.f32_select(both, v[a], v[c])
            }
            Self::ToI32(a) => m.i32_to_f32(m.f32_to_i32(v[a])),
            Self::ToU32(a) => m.u32_to_f32(m.f32_to_u32(v[a])),
            Self::Beside(op, a) => {
                let beside = at_run_time!(Compare op, |op| m.f32_beside_infinity(op, v[a]));
                m.u32_to_f32(m.bool_to_u32(beside))
            }
            Self::Bits(a, steps) => {
                let bits = m.f32_to_bits(v[a]);
                m.f32_from_bits(m.u32_binary(op::WrappingAdd, bits, m.u32(steps)))
            }
            Self::CopySign([a, b]) => m.f32_copysign(v[a], v[b]),
            Self::Elementary(k, [a, b]) => elementary(m, k, F(v[a]), F(v[b])).0,
            Self::LostByCross([a, b, c, d]) => {
                let [a, b, c, d] = [a, b, c, d].map(|i| F(v[i]));
                let (left, right) = (X3 { x: a, y: b, z: c }, X3 { x: d, y: a, z: b });
                let lost = lost_by_cross::on(m, left, right);
                m.f32_binary(op::Add, lost.most.x.0, lost.rest.y.0)
            }
        }
    }
}

fn elementary<M: Machine>(m: &M, k: usize, a: F<M>, b: F<M>) -> F<M> {
    match k {
        0 => math::sin::on(m, a),
        1 => math::cos::on(m, a),
        2 => math::tan::on(m, a),
        3 => math::asin::on(m, a),
        4 => math::acos::on(m, a),
        5 => math::atan::on(m, a),
        6 => math::exp::on(m, a),
        7 => math::exp2::on(m, a),
        8 => math::expm1::on(m, a),
        9 => math::log::on(m, a),
        10 => math::log2::on(m, a),
        11 => math::log1p::on(m, a),
        12 => math::atan2::on(m, a, b),
        13 => math::pow::on(m, a, b),
        _ => math::sincos_2pi::on(m, a).sin,
    }
}

/// Returns every value of a program, its inputs first.
fn run<M: Machine>(m: &M, inputs: &[f32], program: &[Op]) -> Vec<M::F32> {
    let mut values: Vec<M::F32> = inputs.iter().map(|x| m.f32(*x)).collect();
    for op in program {
        values.push(op.run(m, &values));
    }
    values
}

/// Returns whether a result lies within an outcome, including the signs of zeros: a leaf's own
/// comparison treats both as equal.
fn is_within(outcomes: &Outcomes, result: f32) -> bool {
    outcomes.iter().any(|leaves| match leaves {
        [Leaf::Float { low, high, may_be_nan, .. }] => {
            let v = f64::from(result);
            let between = low.total_cmp(&v).is_le() && high.total_cmp(&v).is_ge();
            if v.is_nan() { *may_be_nan } else { between }
        }
        _ => false,
    })
}

/// Tests sums in the order of the source, used twice, against another order in `f32` with products
/// fused or not.
#[test]
fn sums_in_any_order_stay_within_their_outcomes() {
    let mut r = Random(11);
    let mut wrong = 0;
    for _ in 0..PROGRAMS / 10 {
        let terms: Vec<[f32; 2]> = (0..2 + r.below(6))
            .map(|_| [r.number(), if r.below(2) == 0 { 1.0 } else { r.number() }])
            .filter(|t| t.iter().all(|v| v.abs() < 1e9 && (*v == 0.0 || v.abs() > 1e-9)))
            .collect();
        let sum = |m: &Margin| {
            let term = |[a, b]: [f32; 2]| {
                let (a, is_product) = (m.f32(a), b != 1.0);
                if is_product { m.f32_binary(op::Mul, a, m.f32(b)) } else { a }
            };
            let add = |a, b| m.f32_binary(op::Add, a, b);
            let first = terms.iter().map(|t| term(*t)).reduce(add);
            let first = first.unwrap_or_else(|| m.f32(0.0));
            let all = add(first, m.f32(0.3));
            F::<Margin>(m.f32_binary(op::Sub, all, first))
        };
        let outcomes = Outcomes::of(Rounding::WGSL, 64, sum);
        let first = added(&mut r, &terms);
        let last = [0.3, 1.0];
        let all = added(&mut r, &[&terms[..], &[last]].concat());
        if !outcomes.contains(all - first) {
            wrong += 1;
            println!("{terms:?}: {all} - {first} not in {outcomes:?}");
        }
    }
    assert_eq!(wrong, 0);
}

/// Returns the sum of products in any order.
fn added(r: &mut Random, terms: &[[f32; 2]]) -> f32 {
    match terms {
        [] => 0.0,
        [[a, b]] => a * b,
        _ => {
            let mut terms = terms.to_vec();
            for i in 0..terms.len() {
                let j = r.below(terms.len());
                terms.swap(i, j);
            }
            let (left, right) = terms.split_at(1 + r.below(terms.len() - 1));
            match (left, r.below(2)) {
                ([[a, b]], 0) => a.mul_add(*b, added(r, right)),
                _ => added(r, left) + added(r, right),
            }
        }
    }
}

#[test]
fn random_programs_stay_within_their_outcomes() {
    let programs = std::env::var("RAYDSL_MARGIN_FUZZ").ok().and_then(|n| n.parse().ok());
    let programs = programs.unwrap_or(PROGRAMS);
    let mut r = Random(7);
    let (mut wrong, mut complete, mut narrow) = (0, 0, 0);
    for _ in 0..programs {
        let inputs = [r.number(), r.number(), r.number()];
        let len = 2 + r.below(9);
        let program: Vec<Op> = (0..len).map(|i| Op::random(&mut r, inputs.len() + i)).collect();
        let values = run(&Scalar::default(), &inputs, &program);
        let last = |m: &Margin| F::<Margin>(run(m, &inputs, &program)[values.len() - 1]);
        let outcomes = Outcomes::of(Rounding::IEEE, 64, last);
        let result = values[values.len() - 1];
        if !outcomes.is_complete() {
            continue;
        }
        let device = Outcomes::of(Rounding::WGSL, 64, last);
        if device.is_complete() && !device.contains(result) {
            wrong += 1;
            println!("{inputs:?} {program:?}\n gives {values:?}, on a device {device:?}\n");
        }
        complete += 1;
        narrow += u32::from(outcomes.iter().all(|o| {
            matches!(o, [Leaf::Float { low, high, .. }] if high - low <= 1e-3 * high.abs() || low > high)
        }));
        if !is_within(&outcomes, result) {
            wrong += 1;
            if wrong <= 8 {
                println!("{inputs:?} {program:?}\n gives {values:?}, not in {outcomes:?}\n");
            }
        }
    }
    println!("{wrong} of {programs} are wrong, {complete} were followed, {narrow} are narrow");
    assert_eq!(wrong, 0);
    assert!(complete * 100 > programs * 95 && narrow * 2 > programs, "these prove little");
}
