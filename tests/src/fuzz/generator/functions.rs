//! Kernels, and the functions that they call.

use super::scope::{Callable, Var};
use super::{Generator, SIZE, Traits, WORK};
use crate::fuzz::tree::{Function, Head, Kernel, Mode, Param, Scene, Ty};
use crate::rng::Rng;

/// What is to be generated.
struct Plan {
    name: String,
    head: Head,
    sliced: bool,
    params: Vec<Param>,
    result: Ty,
    limit: usize,
}

/// The kernel of a seed.
pub fn kernel(seed: u64) -> Kernel {
    let mut rng = Rng::new(seed);
    // Neighbouring seeds are neighbouring states of the generator's counter.
    let mut rng = Rng::new(rng.bits() ^ seed.rotate_left(32));
    let floats = rng.below(3) != 0;
    let scene = (rng.below(4) == 0).then(|| Scene {
        len: 1 + rng.below(9),
        count: rng.below(4) as u32,
        closure: rng.below(8) == 0,
    });
    let traits = Traits { floats, own: floats && rng.below(5) == 0, scene: scene.is_some() };
    let mut callable = Vec::new();
    let mut functions = Vec::new();
    if traits.own && rng.below(2) == 0 {
        functions.push(function(&mut rng, traits, &mut callable, weight()));
    }
    for i in 0..rng.below(3) {
        let plan = helper(&mut rng, traits, i);
        functions.push(function(&mut rng, traits, &mut callable, plan));
    }
    functions.push(function(&mut rng, traits, &mut callable, entry(traits)));
    Kernel { seed, own: traits.own, scene, functions }
}

fn param(name: &str, ty: Ty, mode: Mode) -> Param {
    Param { name: name.to_owned(), ty, mode }
}

fn entry(traits: Traits) -> Plan {
    let params = [("x", Ty::F32), ("v", Ty::Vec3), ("n", Ty::U32), ("s", Ty::Small)];
    Plan {
        name: "entry".to_owned(),
        head: Head::Plain,
        sliced: traits.scene,
        params: params.map(|(name, ty)| param(name, ty, Mode::Value)).into(),
        result: Ty::Outcome,
        limit: WORK,
    }
}

/// The method that the trait asks for.
fn weight() -> Plan {
    Plan {
        name: "weight".to_owned(),
        head: Head::Weight,
        sliced: false,
        params: vec![param("self", Ty::Own, Mode::Shared), param("by", Ty::F32, Mode::Value)],
        result: Ty::F32,
        limit: WORK / 50,
    }
}

fn helper(rng: &mut Rng, traits: Traits, number: usize) -> Plan {
    let head = match rng.below(10) {
        0 | 1 if traits.floats => Head::OfType,
        2 if traits.floats => Head::OfCount,
        6 | 7 if traits.floats && traits.scene => Head::OfScene,
        3..6 if traits.own => Head::Method,
        _ => Head::Plain,
    };
    let mut params = Vec::new();
    match head {
        Head::OfType => {
            let mode = rng.pick(&[Mode::Value, Mode::Shared, Mode::Mutable]);
            params.push(param("p0", Ty::Any, mode));
        }
        Head::OfCount => params.push(param("p0", Ty::List, Mode::Value)),
        Head::Method => {
            let mode = rng.pick(&[Mode::Value, Mode::Shared, Mode::Changed]);
            params.push(param("self", Ty::Own, mode));
        }
        Head::Plain | Head::OfScene | Head::Weight => {}
    }
    let borrows = params.iter().any(|p| p.mode == Mode::Shared);
    let least = usize::from(params.is_empty());
    for _ in 0..least + rng.below(3) {
        let name = format!("p{}", params.len());
        let ty = helper_type(rng, traits);
        let mode = match rng.below(12) {
            0 | 1 => Mode::Mutable,
            2 if head == Head::Plain => Mode::Shared,
            3 if head == Head::Plain => Mode::Host,
            _ => Mode::Value,
        };
        let ty = if mode == Mode::Host { Ty::U32 } else { ty };
        params.push(param(&name, ty, mode));
    }
    // Last, for what stands before may read the same variable.
    let borrows = borrows || params.iter().any(|p| p.mode == Mode::Shared);
    if !borrows && head != Head::Method && rng.below(3) == 0 {
        for _ in 0..1 + rng.below(2) {
            let name = format!("p{}", params.len());
            params.push(param(&name, helper_type(rng, traits), Mode::Changed));
        }
    }
    let result = helper_type(rng, traits);
    let sliced = traits.scene && head == Head::Plain && rng.below(2) == 0;
    Plan { name: format!("fun{number}"), head, sliced, params, result, limit: WORK / 50 }
}

fn helper_type(rng: &mut Rng, traits: Traits) -> Ty {
    const NUMBERS: &[Ty] = &[Ty::U32, Ty::U32, Ty::I32, Ty::Bool, Ty::IVec3, Ty::Kind, Ty::Counts];
    const ALL: &[Ty] = &[
        Ty::F32,
        Ty::F32,
        Ty::U32,
        Ty::I32,
        Ty::Bool,
        Ty::Vec2,
        Ty::Vec3,
        Ty::Vec4,
        Ty::IVec3,
        Ty::UVec2,
        Ty::Kind,
        Ty::Pair,
        Ty::Row,
        Ty::Small,
        Ty::Nested,
    ];
    if traits.own && rng.below(6) == 0 {
        return Ty::Own;
    }
    rng.pick(if traits.floats { ALL } else { NUMBERS })
}

fn function(rng: &mut Rng, traits: Traits, callable: &mut Vec<Callable>, plan: Plan) -> Function {
    let Plan { name, head, sliced, mut params, result, limit } = plan;
    for p in params.iter_mut().filter(|p| p.mode == Mode::Value && p.name != "self") {
        if rng.below(5) == 0 {
            p.mode = Mode::Mutable;
        }
    }
    let mut g = Generator {
        rng,
        traits,
        head,
        sliced,
        entry: name == "entry",
        callable,
        vars: params.iter().map(Var::of).collect(),
        around: vec![],
        result,
        work: 0,
        rounds: 1,
        limit,
        size: SIZE[usize::from(result != Ty::Outcome)],
        nest: 0,
        counters: 0,
        plain: false,
    };
    let statements = 2 + g.rng.below(5);
    let body = g.block(Some(result), false, statements);
    let coherent = matches!(head, Head::Plain) && name != "entry" && g.chance(10);
    let work = g.work;
    let called = params.clone();
    callable.push(Callable { name: name.clone(), head, sliced, params: called, result, work });
    Function { name, head, coherent, sliced, params, result, body }
}
