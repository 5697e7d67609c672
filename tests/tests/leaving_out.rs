//! What a scene does not use leaves no trace in its generated code.

/// A program; what stands behind its name is in one of the two only.
macro_rules! program {
    ($name:ident $($extra:item)*) => {
        mod $name {
            use raydsl::kernel;
            use raydsl::prelude::*;

            $($extra)*

            #[derive(Clone, Copy, Debug, Type)]
            pub(crate) struct Material {
                pub(crate) color: Vec3,
                pub(crate) kind: Kind,
            }

            #[derive(Clone, Copy, Debug, PartialEq, Type)]
            pub(crate) enum Kind {
                Matte,
                Mirror,
            }

            #[kernel]
            impl Material {
                pub(crate) fn shade(&self, cos: f32) -> Vec3 {
                    match self.kind {
                        Kind::Matte => self.color * cos,
                        Kind::Mirror => self.color,
                    }
                }
            }

            pub(crate) fn wgsl() -> Vec<String> {
                let triangles = [Triangle { v0: Vec3::ZERO, v1: Vec3::X, v2: Vec3::Y }; 3];
                let material = Material { color: Vec3::ONE, kind: Kind::Matte };
                let palette = vec![material; 2];
                let Ok(bvh) = Bvh::build(&triangles) else { return Vec::new() };
                let scene = kernel!(|ray: Ray| {
                    let hit = bvh.closest_hit(ray);
                    if !hit.is_hit {
                        return Vec3::ZERO;
                    }
                    palette[hit.prim_id as usize % palette.len()].shade(hit.u) + material.color
                });
                let plain = kernel!(|x: f32| sin(x) * material.color.x);
                vec![scene.wgsl(), plain.wgsl()]
            }
        }
    };
}

program!(small);
program!(large
    #[derive(Clone, Copy, Debug, Type)]
    pub(crate) struct Unused {
        pub(crate) at: Mat4,
        pub(crate) list: [UVec3; 4],
    }

    #[kernel]
    pub(crate) trait Glow {
        fn glow(&self, x: f32) -> f32;
    }

    #[kernel]
    impl Glow for Unused {
        fn glow(&self, x: f32) -> f32 {
            exp(x) * self.at.x_axis.x
        }
    }

    #[kernel]
    pub(crate) fn unused(x: f32) -> f32 {
        let y = tan(x) + pow(x, 2.5);
        if y > 0.25 { y } else { x }
    }

    #[primitive]
    #[derive(Debug)]
    pub(crate) struct Ball {
        pub(crate) center: Vec3,
        pub(crate) radius: f32,
    }

    #[primitive]
    impl Ball {
        pub(crate) fn intersect(&self, ray: Ray) -> Hit {
            sphere::intersect(ray, self.center, self.radius)
        }

        pub(crate) fn get_bounds(&self) -> Aabb {
            Aabb::from_sphere(self.center, self.radius)
        }
    }

    pub(crate) fn also() -> f32 {
        let unused = Unused { at: Mat4::IDENTITY, list: [UVec3::ONE; 4] };
        let ball = Ball { center: Vec3::ZERO, radius: 1.0 };
        let k = kernel!(|x: f32| unused.glow(x) + ball.radius + unused.list[1].x as f32);
        k.call((1.0,)) + self::unused(0.5)
    }
);

#[test]
fn an_unused_item_changes_nothing() {
    assert!(large::also().is_finite());
    let (small, large) = (small::wgsl(), large::wgsl());
    assert_eq!(small.len(), 2);
    assert_eq!(small, large);
}

#[test]
fn a_plain_kernel_carries_no_rays() {
    let text = &small::wgsl()[1];
    for word in ["Ray", "Hit", "Node", "stack", "Material", "exp", "len_of"] {
        assert!(!text.contains(word), "{word}\n{text}");
    }
    let scene = &small::wgsl()[0];
    assert!(!scene.contains("sin(") && scene.contains("palette_element"), "{scene}");
    assert!(scene.contains("fn Material_shade"), "{scene}");
}
