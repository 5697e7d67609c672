#[allow(dead_code, reason = "only tests call it")]
/// Kernels agree.
fn agrees(variant: Variant) -> Result<(), Error> {
    check(variant)
}
#[ignore = "slow"]
#[test]
fn agrees_scalar() -> Result<(), Error> {
    let variant = ::raydsl::kernel::Variant::Scalar;
    if ::raydsl::testing::can_run(variant, ::core::stringify!(agrees_scalar)) {
        agrees(variant)
    } else {
        ::core::result::Result::Ok(())
    }
}
#[ignore = "slow"]
#[test]
fn agrees_packet4() -> Result<(), Error> {
    let variant = ::raydsl::kernel::Variant::Packet4;
    if ::raydsl::testing::can_run(variant, ::core::stringify!(agrees_packet4)) {
        agrees(variant)
    } else {
        ::core::result::Result::Ok(())
    }
}
#[ignore = "slow"]
#[test]
fn agrees_packet8() -> Result<(), Error> {
    let variant = ::raydsl::kernel::Variant::Packet8;
    if ::raydsl::testing::can_run(variant, ::core::stringify!(agrees_packet8)) {
        agrees(variant)
    } else {
        ::core::result::Result::Ok(())
    }
}
#[ignore = "slow"]
#[test]
fn agrees_packet16() -> Result<(), Error> {
    let variant = ::raydsl::kernel::Variant::Packet16;
    if ::raydsl::testing::can_run(variant, ::core::stringify!(agrees_packet16)) {
        agrees(variant)
    } else {
        ::core::result::Result::Ok(())
    }
}
#[ignore = "slow"]
#[test]
fn agrees_wgsl() -> Result<(), Error> {
    let variant = ::raydsl::kernel::Variant::Wgsl;
    if ::raydsl::testing::can_run(variant, ::core::stringify!(agrees_wgsl)) {
        agrees(variant)
    } else {
        ::core::result::Result::Ok(())
    }
}
#[allow(dead_code, reason = "only tests call it")]
fn panics(variant: Variant) {
    check(variant);
}
#[should_panic(expected = "too far")]
#[test]
fn panics_scalar() {
    let variant = ::raydsl::kernel::Variant::Scalar;
    if ::raydsl::testing::can_run(variant, ::core::stringify!(panics_scalar)) {
        panics(variant)
    } else {
        ::core::panic!("{}", "too far")
    }
}
#[should_panic(expected = "too far")]
#[test]
fn panics_packet4() {
    let variant = ::raydsl::kernel::Variant::Packet4;
    if ::raydsl::testing::can_run(variant, ::core::stringify!(panics_packet4)) {
        panics(variant)
    } else {
        ::core::panic!("{}", "too far")
    }
}
#[should_panic(expected = "too far")]
#[test]
fn panics_packet8() {
    let variant = ::raydsl::kernel::Variant::Packet8;
    if ::raydsl::testing::can_run(variant, ::core::stringify!(panics_packet8)) {
        panics(variant)
    } else {
        ::core::panic!("{}", "too far")
    }
}
#[should_panic(expected = "too far")]
#[test]
fn panics_packet16() {
    let variant = ::raydsl::kernel::Variant::Packet16;
    if ::raydsl::testing::can_run(variant, ::core::stringify!(panics_packet16)) {
        panics(variant)
    } else {
        ::core::panic!("{}", "too far")
    }
}
#[should_panic(expected = "too far")]
#[test]
fn panics_wgsl() {
    let variant = ::raydsl::kernel::Variant::Wgsl;
    if ::raydsl::testing::can_run(variant, ::core::stringify!(panics_wgsl)) {
        panics(variant)
    } else {
        ::core::panic!("{}", "too far")
    }
}
::raydsl::__wgsl_test!(sky_has_valid_wgsl, scene::sky);
