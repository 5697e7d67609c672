/// Returns a / b, rounded to nearest where the device's own quotient is up to 4 ulp off. Results that
/// are denormal are the device's.
fn exact_quotient(a: f32, b: f32) -> f32 {
    let x = bitcast<u32>(a);
    let y = bitcast<u32>(b);
    let of_a = (x >> 23u) & 255u;
    let of_b = (y >> 23u) & 255u;
    // 0, denormals, infinity and NaN have no rounding.
    if (of_a == 0u || of_b == 0u || of_a == 255u || of_b == 255u) { return a / b; }
    // Numbers in [1, 2), so that nothing underflows on the way.
    let m = bitcast<f32>((x & 0x7fffffu) | 0x3f800000u);
    let n = bitcast<f32>((y & 0x7fffffu) | 0x3f800000u);
    let near = m / n;
    let q = near + fma(-near, n, m) / n;
    // What is left is exact, and says which of three neighbours is the nearest.
    let left = fma(-q, n, m);
    let above = bitcast<f32>(bitcast<u32>(q) + 1u);
    let below = bitcast<f32>(bitcast<u32>(q) - 1u);
    var nearest = q;
    if (left + left > (above - q) * n) { nearest = above; }
    if (left + left < (below - q) * n) { nearest = below; }
    let sign = (x ^ y) & 0x80000000u;
    let bits = bitcast<u32>(nearest) + ((of_a - of_b) << 23u);
    let exponent = i32(bitcast<u32>(nearest) >> 23u) + i32(of_a) - i32(of_b);
    if (exponent <= 0) { return a / b; }
    if (exponent >= 255) { return bitcast<f32>(sign | 0x7f800000u); }
    return bitcast<f32>(sign | bits);
}
