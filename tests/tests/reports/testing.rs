//! What `raydsl::testing` offers to users: it passes where variants agree, and says where not.

use raydsl::kernel::Lifted;
use raydsl::machine::{HostFact, KernelFn, KernelInfo, Rounding};
use raydsl::testing::variants_agree;

// ANCHOR: imports
use raydsl::prelude::*;
use raydsl::testing::run;
use raydsl::{assert_variants_agree, kernel, variant_test, wgsl_test};
// ANCHOR_END: imports

// ANCHOR: agree
#[kernel]
fn falloff(distance: f32, radius: f32) -> f32 {
    let x = distance / radius;
    if x < 1.0 {
        let y = 1.0 - x * x;
        return y * y;
    }
    0.0
}

#[test]
fn falloff_agrees() {
    let inputs: Vec<(f32, f32)> = (0..1000).map(|i| (i as f32 * 0.003, 2.0)).collect();
    assert_variants_agree!(falloff, &inputs);

    let gain = 0.25;
    let light = kernel!(|distance: f32| gain * falloff(distance, 1.5));
    let inputs: Vec<(f32,)> = inputs.iter().map(|(distance, _)| (*distance,)).collect();
    assert_variants_agree!(&light, &inputs);
}
// ANCHOR_END: agree

// ANCHOR: variants
#[variant_test]
fn light_ends_at_the_radius(variant: Variant) {
    let inputs = [(0.0, 2.0), (1.999, 2.0), (2.0, 2.0), (1e30, 2.0)];
    let found = run(&Kernel::of::<falloff>(), variant, &inputs);
    assert_eq!(found[0], 1.0);
    assert!(found[1] > 0.0);
    assert_eq!(found[2..], [0.0, 0.0]);
}

wgsl_test!(falloff);
// ANCHOR_END: variants

#[variant_test]
fn results_are_passed_on(variant: Variant) -> Result<(), String> {
    let found = run(&Kernel::of::<falloff>(), variant, &[(0.0, 1.0)]);
    if found == [1.0] { Ok(()) } else { Err(format!("{found:?}")) }
}

#[variant_test]
#[should_panic(expected = "it fails")]
fn attributes_go_to_the_tests(_: Variant) {
    panic!("it fails");
}

#[variant_test]
#[should_panic = "it fails"]
fn the_short_form_of_should_panic(_: Variant) {
    panic!("it fails");
}

/// A sum that devices may reorder, beside an integer.
#[kernel]
fn sum_and_side(x: f32, y: f32, z: f32) -> (f32, u32) {
    ((x * x + y * z) - 0.05, (x > 3.0) as u32)
}

#[kernel]
fn other_side(x: f32, y: f32, z: f32) -> (f32, u32) {
    ((x * x + y * z) - 0.05, (x > 3.1) as u32)
}

/// The device may round as WGSL allows, or as a test says.
#[test]
fn reordered_sums_agree() {
    let number = |i: i32| i as f32 * 0.125;
    let inputs: Vec<(f32, f32, f32)> =
        (1..2000).map(|i| (number(i), 0.9 * number(i), -number(i))).collect();
    assert_variants_agree!(sum_and_side, &inputs, Rounding::WGSL);
    assert_variants_agree!(sum_and_side, &inputs);
}

/// The table shows the number that rounding does not account for, not one before it that is merely
/// rounded, and what is allowed there.
#[test]
fn the_wrong_number_is_shown() -> Result<(), String> {
    if !raydsl::testing::can_run(Variant::Wgsl, "the_wrong_number_is_shown") {
        return Ok(());
    }
    static INFO: KernelInfo =
        KernelInfo { name: "side", file: "f.rs", line: 7, params: &[], known: None };
    let kernel = Kernel::scalar(&INFO, sum_and_side::scalar).lifted(
        Lifted {
            native4: Some(Box::new(sum_and_side::lifted)),
            native8: Some(Box::new(sum_and_side::lifted)),
            native16: Some(Box::new(sum_and_side::lifted)),
            recorder: Some(Box::new(other_side::lifted)),
            margin: Some(Box::new(sum_and_side::lifted)),
        },
        |_| {},
    );
    let inputs: Vec<(f32, f32, f32)> =
        (0..1000).map(|i| (2.0 + i as f32 * 0.0021, 0.9, 0.9)).collect();
    let table = variants_agree(&kernel, &inputs, Rounding::WGSL).err().ok_or("it agrees")?;
    let table = table.to_string();
    println!("{table}");
    let rows: Vec<Vec<&str>> = table
        .lines()
        .filter(|l| l.starts_with("wgsl "))
        .map(|l| l.split_whitespace().collect())
        .collect();
    assert_eq!(rows.len(), 10, "{table}");
    for row in rows {
        assert_eq!(row[2..8], ["1", "1", "(0x00000001)", "0", "(0x00000000)", "1"], "{table}");
    }
    Ok(())
}

#[kernel]
fn mistaken(distance: f32, radius: f32) -> f32 {
    if distance > 2.0 { 0.125 } else { falloff(distance, radius) }
}

/// A kernel whose packets of 4 lanes, or whose WGSL, are another's.
fn broken(packet: bool, wgsl: bool) -> Kernel<'static, (f32, f32), f32> {
    static INFO: KernelInfo =
        KernelInfo { name: "broken", file: "f.rs", line: 7, params: &[], known: None };
    Kernel::scalar(&INFO, falloff::scalar).lifted(
        Lifted {
            native4: Some(if packet {
                Box::new(mistaken::lifted)
            } else {
                Box::new(falloff::lifted)
            }),
            native8: Some(Box::new(falloff::lifted)),
            native16: Some(Box::new(falloff::lifted)),
            recorder: Some(if wgsl {
                Box::new(mistaken::lifted)
            } else {
                Box::new(falloff::lifted)
            }),
            margin: Some(Box::new(falloff::lifted)),
        },
        move |visit| visit(&HostFact(wgsl.into())),
    )
}

fn inputs() -> Vec<(f32, f32)> {
    (0..1000).map(|i| (i as f32 * 0.003, 2.0)).collect()
}

#[test]
fn a_wrong_packet_is_shown() -> Result<(), String> {
    // Where a machine lacks packets of 8 lanes, those of 4 stand in.
    if !Variant::Packet8.is_native() {
        eprintln!("SKIPPED: this machine has no packets of 8 lanes");
        return Ok(());
    }
    let error =
        variants_agree(&broken(true, false), &inputs(), Rounding::WGSL).err().ok_or("it agrees")?;
    let table = error.to_string();
    println!("{table}");
    assert!(table.contains("`broken` (f.rs:7)"), "{table}");
    assert!(table.contains("333 of 1000 results have other bits"), "{table}");
    let rows: Vec<&str> = table.lines().filter(|l| l.starts_with("packet4 ")).collect();
    assert_eq!(rows.len(), 10, "{table}");
    let cells: Vec<&str> = rows[0].split_whitespace().collect();
    let expected = ["packet4", "667", "result", "0.0", "(0x00000000)", "0.125"];
    assert_eq!(cells[..6], expected, "{table}");
    assert!(rows[0].ends_with("(2.001, 2.0)"), "{table}");
    Ok(())
}

#[test]
fn wrong_wgsl_is_shown() -> Result<(), String> {
    if !raydsl::testing::can_run(Variant::Wgsl, "wrong_wgsl_is_shown") {
        return Ok(());
    }
    let error =
        variants_agree(&broken(false, true), &inputs(), Rounding::WGSL).err().ok_or("it agrees")?;
    let table = error.to_string();
    println!("{table}");
    assert!(table.contains("rounding does not account for 333 of 1000"), "{table}");
    assert_eq!(table.lines().filter(|l| l.starts_with("wgsl ")).count(), 10, "{table}");
    Ok(())
}

/// Both share the ten rows.
#[test]
#[should_panic(expected = "the variants of `broken` (f.rs:7) disagree")]
fn the_macro_panics() {
    assert_variants_agree!(&broken(true, true), &inputs());
}

#[test]
#[should_panic(expected = "without inputs nothing is compared")]
fn no_inputs_are_no_test() {
    assert_variants_agree!(falloff, &[]);
}

/// Without debug assertions packets and WGSL read the last element.
#[test]
fn an_index_out_of_range_is_found() -> Result<(), String> {
    let table = vec![0.5f32, 1.5, 2.5];
    let kernel = kernel!(|i: u32| table[i as usize * 2]);
    let (line, inputs) = (line!() - 1, [(0,), (1,), (2,)]);
    let error = variants_agree(&kernel, &inputs, Rounding::WGSL).err().ok_or("it agrees")?;
    let text = error.to_string();
    assert!(text.contains("the source panics for input 2, (2)"), "{text}");
    assert!(text.contains(&format!("testing.rs:{line}: index out of bounds")), "{text}");
    assert!(text.contains("the len is 3 but the index is 4"), "{text}");
    assert!(variants_agree(&kernel, &inputs[..2], Rounding::WGSL).is_ok());
    Ok(())
}
