use raydsl::prelude::*;

fn main() {
    let name = String::from("wall");
    let k = kernel!(|x: f32| {
        x * name.len() as f32 //~ lifted
    });
    k.wgsl();
}
