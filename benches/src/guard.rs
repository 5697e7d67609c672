//! Looks at the machine code of packets: is it packed, and is every operation inlined?
//!
//! A lane operation that is not inlined is compiled for the plain target and called through memory:
//! correct, and 25 to 70 times slower. No test notices, so this program disassembles itself. It
//! inspects the functions with which `traverse_packet` enters a level, and those that they call on
//! purpose.

use std::collections::{BTreeMap, HashMap};
use std::env;
use std::ffi::OsStr;
use std::io;
use std::process::{Command, ExitCode};

/// Levels that are inspected: what their entry is called, and the registers they must multiply.
const LEVELS: [(&str, &str); 2] = [("vectorize_avx2", "%ymm"), ("vectorize_avx512", "%zmm")];
/// What enters them.
const TRAVERSALS: &str = "raydsl::bvh::traverse_packet::";
/// What traversals call on purpose: kernels with `#[inline(never)]`, the descent through instances,
/// and the traversals of wide trees. Each enters the level again and is inspected like them.
const APART: [&str; 5] = [
    "raydsl::machine::packet::apart",
    "raydsl::bvh::instances::packet_descent::",
    WALKS[0],
    WALKS[1],
    WALKS[2],
];
/// Of these, what the bench surely has at each level.
const WALKS: [&str; 3] = [
    "raydsl::bvh::wide::trace::each_part",
    "raydsl::bvh::wide::stream::trace_interleaved",
    "raydsl::bvh::wide::single::ask",
];
/// What the traversals of wide trees call once for hundreds of rays.
const ONCE: [&str; 5] = [
    "raydsl::bvh::wide::rays::Rays::gather",
    "raydsl::bvh::wide::rays::Rays::give_back",
    "raydsl::bvh::wide::entry::Entries::largest",
    "raydsl::geometry::aabb::Aabb::is_finite",
    "alloc::vec::Vec<T,A>::resize",
];
/// Single-ray traversal: scenes under an accelerator of the application's have no packets.
const ONE_BY_ONE: &str = "raydsl::bvh::traverse::";
/// The bench traverses triangles and spheres at each level.
const LEAST_FUNCTIONS: usize = 2;
/// The tests of two boxes alone take this many.
const LEAST_PRODUCTS: usize = 12;
/// Calls that stand in cold code: a panic's, what it drops, and a vector's that grows.
const COLD: [&str; 6] = [
    "alloc::raw_vec::",
    "core::panicking::",
    "core::slice::index::",
    "core::option::",
    "unwrap_failed",
    "_Unwind_Resume",
];
/// How the names of lane operations begin; they are called from nowhere at all.
const OPERATIONS: [&str; 3] =
    ["raydsl::machine::lanes::", "<raydsl::machine::lanes::", "<raydsl::machine::packet::"];
/// How those of `fearless_simd` end.
const KERNEL: &str = "__fearless_simd_kernel";

/// A function of the program.
#[derive(Default)]
struct Function {
    name: String,
    /// Where it goes: address and name.
    calls: Vec<(u64, String)>,
    /// Packed products, by the registers.
    products: HashMap<&'static str, usize>,
}

type Functions = BTreeMap<u64, Function>;

/// Inspects this program and prints its faults.
pub fn run() -> ExitCode {
    if !cfg!(target_arch = "x86_64") {
        eprintln!("GUARD SKIPPED: it knows the machine code of x86-64 only");
        return ExitCode::SUCCESS;
    }
    let text = match env::current_exe().and_then(|exe| disassemble(exe.as_os_str())) {
        Ok(text) => text,
        Err(error) => {
            eprintln!("GUARD SKIPPED: no objdump on this machine ({error}); install binutils");
            return ExitCode::SUCCESS;
        }
    };
    let faults = inspect(&parse(&text));
    for fault in &faults {
        eprintln!("GUARD: {fault}");
    }
    if faults.is_empty() {
        println!("guard: packets are packed and nothing in them is called");
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

fn disassemble(program: &OsStr) -> io::Result<String> {
    let output =
        Command::new("objdump").args(["-d", "-C", "--no-show-raw-insn"]).arg(program).output()?;
    if !output.status.success() {
        return Err(io::Error::other(String::from_utf8_lossy(&output.stderr).into_owned()));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// Reads what objdump prints.
fn parse(text: &str) -> Functions {
    let mut functions = Functions::new();
    let mut current = Function::default();
    let mut start = 0;
    for line in text.lines() {
        if let Some((address, name)) = header(line) {
            functions.insert(start, std::mem::take(&mut current));
            start = address;
            current.name = name.to_owned();
        } else if let Some((_, code)) = line.split_once(":\t") {
            read_instruction(&mut current, code.trim());
        }
    }
    functions.insert(start, current);
    functions
}

/// `00000000000894c0 <name>:`
fn header(line: &str) -> Option<(u64, &str)> {
    let (address, name) = line.strip_suffix(">:")?.split_once(" <")?;
    Some((u64::from_str_radix(address, 16).ok()?, name))
}

fn read_instruction(function: &mut Function, code: &str) {
    let (mnemonic, operands) = code.split_once(char::is_whitespace).unwrap_or((code, ""));
    match mnemonic {
        "call" | "callq" | "jmp" | "jmpq" => function.calls.extend(target(operands)),
        "vmulps" => {
            for (_, register) in LEVELS.iter().filter(|(_, r)| operands.contains(r)) {
                *function.products.entry(register).or_default() += 1;
            }
        }
        _ => {}
    }
}

/// `894c0 <name>`, or `894c0 <name+0x12>` for a jump inside a function. Calls through a register
/// have no target; they are the vtables of kernels, or functions of other libraries.
fn target(operands: &str) -> Option<(u64, String)> {
    let (address, name) = operands.trim().split_once(" <")?;
    let address = u64::from_str_radix(address, 16).ok()?;
    let name = name.strip_suffix('>')?;
    let is_inside =
        name.rsplit_once("+0x").is_some_and(|(_, n)| u64::from_str_radix(n, 16).is_ok());
    (!is_inside).then(|| (address, name.to_owned()))
}

fn inspect(functions: &Functions) -> Vec<String> {
    let mut faults = Vec::new();
    for function in functions.values() {
        for (_, callee) in &function.calls {
            if is_operation(callee) {
                faults.push(format!("{} calls {callee}", function.name));
            }
        }
    }
    for (level, register) in LEVELS {
        let traversals = entries(functions, &[TRAVERSALS], level);
        let apart = entries(functions, &APART, level);
        let (count, calls) = (traversals.len(), apart.len());
        println!("guard: {count} traversals and {calls} functions that they call enter {level}");
        if count < LEAST_FUNCTIONS {
            faults.push(format!("{count} traversals enter {level}, not {LEAST_FUNCTIONS}"));
        }
        let missing = WALKS.iter().filter(|walk| entries(functions, &[**walk], level).is_empty());
        faults.extend(missing.map(|walk| format!("no {walk} enters {level}")));
        // Where one ray is tested against eight primitives, wider registers are used by half.
        let narrower: &[&str] = if register == "%zmm" { &["%ymm", "%zmm"] } else { &[register] };
        let traversals = traversals.iter().map(|(at, f)| inspect_entry(*at, f, &[register]));
        let apart = apart.iter().map(|(at, f)| inspect_entry(*at, f, narrower));
        faults.extend(traversals.chain(apart).flatten());
    }
    faults
}

fn is_operation(name: &str) -> bool {
    name.ends_with(KERNEL) || OPERATIONS.iter().any(|o| name.starts_with(o))
}

/// The functions of the level that functions with such names enter.
fn entries<'f>(
    functions: &'f Functions,
    outer: &[&str],
    level: &str,
) -> BTreeMap<u64, &'f Function> {
    let outer = functions.values().filter(|f| outer.iter().any(|o| f.name.starts_with(o)));
    let callees = outer.flat_map(|f| &f.calls).filter(|(_, name)| name.ends_with(level));
    callees.filter_map(|(at, _)| Some((*at, functions.get(at)?))).collect()
}

fn inspect_entry(at: u64, function: &Function, registers: &[&str]) -> Vec<String> {
    let of = |register: &&str| function.products.get(register).copied().unwrap_or_default();
    let products: usize = registers.iter().map(of).sum();
    let few = (products < LEAST_PRODUCTS).then(|| {
        let registers = registers.join(" and ");
        format!("{at:x}: {products} packed products in {registers}, not {LEAST_PRODUCTS}")
    });
    let hot = function.calls.iter().filter(|(_, name)| !may_be_called(name));
    hot.map(|(_, name)| format!("{at:x}: a traversal calls {name}")).chain(few).collect()
}

fn may_be_called(name: &str) -> bool {
    COLD.iter().any(|c| name.contains(c))
        || APART.iter().any(|a| name.contains(a))
        || ONCE.contains(&name)
        || name.starts_with(ONE_BY_ONE)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn listing(product: &str, callee: &str) -> String {
        let walks = WALKS.iter().zip([0x10000, 0x20000, 0x30000]);
        let walks = walks.map(|(walk, first)| functions(first, walk, product, callee));
        functions(0x1000, TRAVERSALS, product, callee) + &walks.collect::<String>()
    }

    /// What `outer` enters at each level, from `first` on.
    fn functions(first: usize, outer: &str, product: &str, callee: &str) -> String {
        let mut text = String::new();
        let name = format!("{outer}closest_hit");
        for (i, (level, register)) in LEVELS.iter().enumerate() {
            for n in 0..LEAST_FUNCTIONS {
                let outer = first + 0x100 * i + 16 * n;
                let inner = outer + 0x1000;
                text += &format!("{outer:016x} <{name}>:\n");
                text += &format!("  {outer:x}:\tcall   {inner:x} <Simd::{level}>\n\n");
                text += &format!("{inner:016x} <Simd::{level}>:\n");
                let line = format!("  {inner:x}:\t{product} {register}1,{register}2,{register}3\n");
                text += &line.repeat(LEAST_PRODUCTS);
                text += &format!("  {inner:x}:\tjne    {inner:x} <Simd::{level}+0x4>\n");
                text += &format!("  {inner:x}:\tcall   99 <{callee}>\n\n");
            }
        }
        text
    }

    const PANIC: &str = "core::panicking::panic_bounds_check";

    #[test]
    fn packed_code_passes() {
        assert_eq!(inspect(&parse(&listing("vmulps", PANIC))), Vec::<String>::new());
    }

    /// Kernels apart may be called; their own code is inspected too.
    #[test]
    fn functions_apart_are_inspected() {
        let traversals = listing("vmulps", APART[0]);
        let faults = |product, callee| {
            let apart = functions(0x8000, APART[0], product, callee);
            inspect(&parse(&(traversals.clone() + &apart))).len()
        };
        assert_eq!(faults("vmulps", PANIC), 0);
        assert_eq!(faults("vmulss", PANIC), 4);
        assert_eq!(faults("vmulps", "core::array::try_map"), 4);
    }

    #[test]
    fn scalar_products_and_calls_are_found() {
        assert_eq!(inspect(&parse(&listing("vmulss", PANIC))).len(), 16);
        assert_eq!(inspect(&parse(&listing("vmulps", "core::array::try_map"))).len(), 16);
        let operation = "Simd::add_f32x8::kernel::__fearless_simd_kernel";
        assert_eq!(inspect(&parse(&listing("vmulps", operation))).len(), 32);
        let traversals = functions(0x1000, TRAVERSALS, "vmulps", PANIC);
        assert_eq!(inspect(&parse(&traversals)).len(), 6, "three walks at two levels");
        assert_eq!(inspect(&parse("")).len(), 8);
    }
}
