//! Items that a program declares and its kernels do not use change no byte of their text.

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
    use raydsl::bsdf::{Bsdf, BsdfSample};
    use raydsl::light::{Light, LightExtent, LightSample};
    use raydsl::texture::AsTextureRef;
    use raydsl::volume::{
        ExactCell, Grid, GridConfig, TransferFunction, Volume, VolumeLight,
    };

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

    #[kernel]
    impl Bsdf for Unused {
        fn eval(&self, wo: Vec3, wi: Vec3) -> Vec3 {
            self.at.x_axis.truncate() * (wo.z * wi.z)
        }

        fn sample(&self, wo: Vec3, u: Vec3) -> BsdfSample {
            let wi = sample_cosine_hemisphere(vec2(u.x, u.y));
            BsdfSample::of(wi, Unused::eval(self, wo, wi), Unused::pdf(self, wo, wi))
        }

        fn pdf(&self, _wo: Vec3, wi: Vec3) -> f32 {
            cosine_hemisphere_pdf(wi.z)
        }
    }

    #[derive(Clone, Copy, Debug, Type)]
    pub(crate) struct Lantern {
        pub(crate) at: Vec3,
    }

    #[kernel]
    impl Light for Lantern {
        fn sample(&self, from: Vec3, _u: Vec2) -> LightSample {
            let way = self.at - from;
            LightSample::distant(normalize(way), Vec3::ONE, 1.0, true)
        }

        fn power(&self, radius: f32) -> f32 {
            radius * self.at.x
        }

        fn extent(&self) -> LightExtent {
            let (axis, zero) = (Vec3::Y, Vec3::ZERO);
            LightExtent { min: zero, max: zero, axis, cos_normals: 1.0, cos_emitted: 1.0 }
        }
    }

    #[kernel]
    pub(crate) fn unused_queries(
        bvh: &Bvh<'_, Ball>,
        picture: &TextureRef2<'_, f32>,
        volume: &Volume<'_, f32>,
        exact: ExactCell,
        ray: Ray,
    ) -> f32 {
        let hits = bvh.multi_hit_by::<2>(ray, |a: Hit, b: Hit| a.t > b.t);
        let light = volume.integrate(&exact, ray, VolumeLight::new());
        tex2(picture, vec2(hits[0].t, hits[1].t)) + light.opacity()
    }

    pub(crate) fn unused_data(ball: Ball, ray: Ray) -> Result<f32, Box<dyn std::error::Error>> {
        let (balls, texels, voxels) = ([ball], [0.5f32; 4], [1.0f32; 8]);
        let bvh = Bvh::build(&balls)?;
        let picture = Texture2::new(&texels, [2, 2], TextureConfig::new())?;
        let grid = Grid::new(&voxels[..], uvec3(2, 2, 2), GridConfig::new())?;
        let function = TransferFunction::from_extinction(&[(0.0, Vec3::ONE)], &[(0.0, 2.0)])?;
        let volume = Volume::new(&grid, function);
        let exact = ExactCell::new();
        Ok(self::unused_queries(&bvh, &picture.as_texture_ref(), &volume, exact, ray))
    }

    pub(crate) fn also() -> f32 {
        let unused = Unused { at: Mat4::IDENTITY, list: [UVec3::ONE; 4] };
        let ball = Ball { center: Vec3::ZERO, radius: 1.0 };
        let k = kernel!(|x: f32| unused.glow(x) + ball.radius + unused.list[1].x as f32);
        let lantern = Lantern { at: Vec3::ZERO };
        let lit = lantern.sample(Vec3::Y, Vec2::ZERO).pdf + unused.pdf(Vec3::Z, Vec3::Z);
        let seen = unused_data(ball, Ray::new(Vec3::ZERO, Vec3::Z)).unwrap_or(f32::NAN);
        k.call((1.0,)) + self::unused(0.5) + lit + seen
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

/// An enum of primitives, of one kind or of several. The others are no larger, which storage would
/// show.
macro_rules! primitives {
    ($name:ident { $($kind:ident),+ }) => {
        mod $name {
            use raydsl::kernel;
            use raydsl::prelude::*;

            #[primitive(sphere(center, radius))]
            #[derive(Debug)]
            #[allow(dead_code, reason = "a kind in one of the two alone")]
            pub(crate) struct Ball {
                pub(crate) center: Vec3,
                pub(crate) radius: f32,
            }

            #[primitive(rectangle(corner, u_edge, v_edge))]
            #[derive(Debug)]
            #[allow(dead_code, reason = "a kind in one of the two alone")]
            pub(crate) struct Panel {
                pub(crate) corner: Vec3,
                pub(crate) u_edge: Vec3,
                pub(crate) v_edge: Vec3,
            }

            #[primitive(normal)]
            #[derive(Debug)]
            #[allow(dead_code, reason = "a kind in one of the two alone")]
            pub(crate) enum Shape {
                $($kind($kind)),+
            }

            /// The texts of queries in a tree, in a slice, and of a method.
            pub(crate) fn wgsl() -> Vec<String> {
                let facet = Triangle { v0: Vec3::ZERO, v1: Vec3::X, v2: Vec3::Y };
                let shapes: Vec<_> = (0..9).map(|_| Shape::Triangle(facet)).collect();
                let few = &shapes[..2];
                let Ok(bvh) = Bvh::build(&shapes) else { return Vec::new() };
                let tree = kernel!(|ray: Ray| (bvh.closest_hit(ray), bvh.any_hit(ray)));
                let slice = kernel!(|ray: Ray| few.closest_hit(ray).t);
                let crossings = kernel!(|ray: Ray| {
                    let mut sum = 0.0;
                    for hit in bvh.hits(ray) {
                        sum += hit.t;
                    }
                    sum
                });
                let normal = kernel!(|ray: Ray| {
                    let hit = bvh.closest_hit(ray);
                    bvh.primitive(hit).normal(ray, hit)
                });
                vec![tree.wgsl(), slice.wgsl(), crossings.wgsl(), normal.wgsl()]
            }
        }
    };
}

primitives!(alone { Triangle });
primitives!(among { Triangle, Ball, Panel });

#[test]
fn a_kind_that_no_primitive_has_changes_nothing() {
    let (alone, among) = (alone::wgsl(), among::wgsl());
    assert_eq!(alone.len(), 4);
    for (alone, among) in alone.iter().zip(&among) {
        assert_eq!(alone, among);
    }
}
