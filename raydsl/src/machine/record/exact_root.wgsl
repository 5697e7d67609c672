/// Returns the square root, rounded to nearest where the device's own is up to 5 ulp off.
fn exact_root(a: f32) -> f32 {
    let x = bitcast<u32>(a);
    let exponent = x >> 23u;
    // 0, denormals, infinity, NaN and negative numbers have no rounding.
    if (exponent == 0u || exponent >= 255u) { return sqrt(a); }
    // A number in [1, 4) whose exponent differs by an even number.
    let odd = (exponent & 1u) ^ 1u;
    let m = bitcast<f32>((x & 0x7fffffu) | ((127u + odd) << 23u));
    let near = sqrt(m);
    let s = near + fma(-near, near, m) / (near + near);
    // What is left is exact, and says which of three neighbours is the nearest.
    let left = fma(-s, s, m);
    let above = bitcast<f32>(bitcast<u32>(s) + 1u);
    let below = bitcast<f32>(bitcast<u32>(s) - 1u);
    var nearest = s;
    if (left > (above - s) * s) { nearest = above; }
    if (left <= (below - s) * s) { nearest = below; }
    return bitcast<f32>(bitcast<u32>(nearest) + (((exponent - 127u - odd) >> 1u) << 23u));
}
