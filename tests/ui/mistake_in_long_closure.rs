use raydsl::prelude::*;

// A long closure is not lifted for a machine that rustc infers: that would take it long. So each of
// the five copies has the error.
fn main() {
    let k = kernel!(|a: Vec3, b: Vec3| {
        let v0 = a + b;
        let v1 = (v0 * 1.5 + a.cross(v0)).normalize() - b * a.dot(v0);
        let v2 = (v1 * 2.5 + a.cross(v1)).normalize() - b * a.dot(v1);
        let v3 = (v2 * 3.5 + a.cross(v2)).normalize() - b * a.dot(v2);
        let v4 = (v3 * 4.5 + a.cross(v3)).normalize() - b * a.dot(v3);
        let v5 = (v4 * 5.5 + a.cross(v4)).normalize() - b * a.dot(v4);
        let v6 = (v5 * 6.5 + a.cross(v5)).normalize() - b * a.dot(v5);
        let v7 = (v6 * 7.5 + a.cross(v6)).normalize() - b * a.dot(v6);
        let v8 = (v7 * 8.5 + a.cross(v7)).normalize() - b * a.dot(v7);
        let v9 = (v8 * 9.5 + a.cross(v8)).normalize() - b * a.dot(v8);
        let v10 = (v9 * 10.5 + a.cross(v9)).normalize() - b * a.dot(v9);
        let v11 = (v10 * 11.5 + a.cross(v10)).normalize() - b * a.dot(v10);
        let v12 = (v11 * 12.5 + a.cross(v11)).normalize() - b * a.dot(v11);
        let v13 = (v12 * 13.5 + a.cross(v12)).normalize() - b * a.dot(v12);
        let v14 = (v13 * 14.5 + a.cross(v13)).normalize() - b * a.dot(v13);
        v14.x % v13.y //~ lifted 5
    });
    k.wgsl();
}
