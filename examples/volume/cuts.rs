//! What the volume is cut by.

use std::path::Path;

use raydsl::kernel;
use raydsl::prelude::*;
use raydsl::shading::Surface;
use raydsl::volume::check_closed;

use super::Failure;

// ANCHOR: tools
/// A ball that cuts.
#[primitive(sphere(center, radius))]
pub(crate) struct Ball {
    center: Vec3,
    radius: f32,
}

/// Half of space: all that is behind a plane.
#[primitive(plane(normal, offset))]
pub(crate) struct Half {
    normal: Vec3,
    offset: f32,
}
// ANCHOR_END: tools

macro_rules! surface {
    ($($tool:ident)+) => {
        $(
            #[kernel]
            impl Surface for $tool {
                fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
                    self.surface_point(ray, hit)
                }

                fn albedo(&self, _ray: Ray, _hit: Hit) -> Vec3 {
                    Vec3::ONE
                }
            }
        )+
    };
}

surface!(Ball Half);

// ANCHOR: scene
/// Everything that cuts, as one scene.
#[derive(Scene)]
pub(crate) struct Tools<'a> {
    balls: &'a [Ball],
    halves: &'a [Half],
    meshes: Bvh<'a, Triangle>,
}
// ANCHOR_END: scene

/// The tools of one side, before they are a scene.
#[derive(Default)]
pub(crate) struct Parts {
    balls: Vec<Ball>,
    halves: Vec<Half>,
    triangles: Vec<Triangle>,
}

impl Parts {
    pub(crate) fn is_empty(&self) -> bool {
        self.balls.is_empty() && self.halves.is_empty() && self.triangles.is_empty()
    }

    pub(crate) fn scene(&self) -> Result<Tools<'_>, Failure> {
        let meshes = Bvh::build(&self.triangles)?;
        Ok(Tools { balls: &self.balls, halves: &self.halves, meshes })
    }
}

/// What is cut away, and what is kept where anything is.
#[derive(Default)]
pub(crate) struct Cuts {
    pub(crate) away: Parts,
    pub(crate) kept: Parts,
}

impl Cuts {
    /// Adds a cut as it is written on the command line.
    pub(crate) fn add(&mut self, text: &str) -> Result<(), Failure> {
        let (parts, tool) = match text.strip_prefix('!') {
            Some(rest) => (&mut self.kept, rest),
            None => (&mut self.away, text),
        };
        let wrong = || {
            let forms = "sphere:X,Y,Z,R, plane:X,Y,Z,D or mesh:FILE";
            Failure::Usage(format!(
                "--cut {text}: write {forms}, with `!` before it for all but that"
            ))
        };
        match tool.split_once(':') {
            Some(("sphere", numbers)) => {
                let [x, y, z, radius] = four(numbers).ok_or_else(wrong)?;
                if radius <= 0.0 {
                    let message = format!("--cut {text}: the radius is above 0");
                    return Err(Failure::Usage(message));
                }
                parts.balls.push(Ball { center: vec3(x, y, z), radius });
            }
            Some(("plane", numbers)) => {
                let [x, y, z, offset] = four(numbers).ok_or_else(wrong)?;
                let normal = vec3(x, y, z);
                if normal == Vec3::ZERO {
                    let message = format!("--cut {text}: the plane's normal has a length");
                    return Err(Failure::Usage(message));
                }
                // Of two, a ray that goes from one half of space into the other's is misjudged.
                if !parts.halves.is_empty() {
                    let message = format!(
                        "--cut {text}: one plane can cut away and one, with `!` before it, can be kept; \
                         write a box as a mesh"
                    );
                    return Err(Failure::Usage(message));
                }
                parts.halves.push(Half { normal, offset });
            }
            Some(("mesh", file)) => {
                let found = triangles(Path::new(file))?;
                check_closed(found.iter().map(|t| [t.v0, t.v1, t.v2]))
                    .map_err(|e| Failure::Usage(format!("--cut {text}: {e}")))?;
                parts.triangles.extend(found);
            }
            _ => return Err(wrong()),
        }
        Ok(())
    }
}

fn four(text: &str) -> Option<[f32; 4]> {
    let all: Vec<f32> = text.split(',').map(|n| n.trim().parse().ok()).collect::<Option<_>>()?;
    let all: [f32; 4] = all.try_into().ok()?;
    all.iter().all(|n| n.is_finite()).then_some(all)
}

fn triangles(path: &Path) -> Result<Vec<Triangle>, Failure> {
    let mesh = raydsl_io::mesh::load(path)?;
    let corner = |i: u32| mesh.vertices[i as usize];
    let of = |t: &[u32; 3]| Triangle { v0: corner(t[0]), v1: corner(t[1]), v2: corner(t[2]) };
    Ok(mesh.triangles.iter().map(of).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cuts_are_read() {
        let mut cuts = Cuts::default();
        assert!(cuts.add("sphere:1,2,3,4").is_ok());
        assert!(cuts.add("!plane:0,0,1,-2.5").is_ok());
        assert_eq!((cuts.away.balls.len(), cuts.kept.halves.len()), (1, 1));
        for wrong in ["", "sphere", "sphere:1,2,3", "sphere:1,2,3,0", "plane:0,0,0,1", "cube:1"] {
            assert!(cuts.add(wrong).is_err(), "{wrong}");
        }
        // One plane on each side.
        assert!(cuts.add("!plane:0,1,0,1").is_err() && cuts.add("plane:0,1,0,1").is_ok());
    }
}
