//! A share of the program `campaign`: every row in every variant, with few inputs.

use std::process::Command;

/// Inputs of each row.
const COUNT: usize = 10_000;

#[test]
fn every_bound_holds() -> std::io::Result<()> {
    let count = raydsl_tests::scaled(COUNT);
    let output = Command::new(env!("CARGO_BIN_EXE_campaign"))
        .args(["--count", &count.to_string()])
        .output()?;
    let (table, said) =
        (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{table}\n{said}");
    Ok(())
}
