// All public names of the library, of which the program uses no more than without them.

#[allow(unused_imports, reason = "names that nothing uses are what is measured")]
mod every_name {
    pub(crate) use raydsl::prelude::*;

    pub(crate) mod bsdf {
        pub(crate) use raydsl::bsdf::*;
    }
    pub(crate) mod camera {
        pub(crate) use raydsl::camera::*;
    }
    pub(crate) mod flow {
        pub(crate) use raydsl::flow::*;
    }
    pub(crate) mod integrators {
        pub(crate) use raydsl::integrators::*;
    }
    pub(crate) mod light {
        pub(crate) use raydsl::light::*;
    }
    pub(crate) mod render {
        pub(crate) use raydsl::render::*;
    }
    pub(crate) mod texture {
        pub(crate) use raydsl::texture::*;
    }
    pub(crate) mod volume {
        pub(crate) use raydsl::volume::*;
    }
}
