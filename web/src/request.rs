//! What a page is asked for, by the query of its address.

use raydsl::kernel::Variant;

use crate::subject::Subject;

/// What a page shows, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// The scene: `scene=landscape`, `head` or `cornell`; `detail=` is the number of its points or
    /// the side of its volume.
    pub subject: Subject,
    /// What runs the kernel: `variant=wgsl`, `packet4`, `packet8`, `packet16` or `scalar`.
    pub variant: Variant,
    /// Columns and rows: `size=WxH`.
    pub size: (u32, u32),
    /// Samples of each pixel after which the picture is done: `samples=`.
    pub samples: u32,
    /// Whether the picture is read back and drawn through a 2-D canvas, which every browser can
    /// show and a test can read: `readback`.
    pub is_readback: bool,
    /// Whether there is one picture of one ray a pixel that is submitted to the device, and not
    /// awaited: `submit`.
    pub is_submitted: bool,
    /// What goes wrong on purpose: `fault=shader`, `call` or `window`.
    pub fault: Option<Fault>,
}

/// What goes wrong on purpose, to see that the page says so.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// A kernel whose text the browser's compiler refuses.
    Shader,
    /// A call of the page itself that the device refuses.
    Call,
    /// A picture that is submitted into a buffer that is no more.
    Window,
}

/// Why a query says nothing that can be shown.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("?{name}={value}: {remedy}")]
pub struct RequestError {
    /// The parameter.
    pub name: String,
    /// What it was given.
    pub value: String,
    /// What may be given instead.
    pub remedy: &'static str,
}

/// The most columns or rows.
pub(crate) const LARGEST_SIDE: u32 = 4096;
/// The most samples of a pixel.
const MOST_SAMPLES: u32 = 65_536;
/// The points of a landscape unless asked for, and the most.
const POINTS: u32 = 200_000;
const MOST_POINTS: u32 = 4_000_000;
/// The side of a head unless asked for, and the longest.
const SIDE: u32 = 96;
const LONGEST_SIDE: u32 = 256;

impl Default for Request {
    fn default() -> Self {
        Self {
            subject: Subject::Landscape { points: POINTS },
            variant: Variant::Wgsl,
            size: (640, 400),
            samples: 256,
            is_readback: false,
            is_submitted: false,
            fault: None,
        }
    }
}

impl Request {
    /// Reads a query, with or without its question mark. Parameters that mean nothing here are
    /// another's.
    ///
    /// # Errors
    ///
    /// If a parameter has a value that cannot be shown.
    pub fn parse(query: &str) -> Result<Self, RequestError> {
        let mut request = Self::default();
        let (mut scene, mut detail) = ("landscape", None);
        for pair in query.trim_start_matches('?').split('&') {
            let (name, value) = pair.split_once('=').unwrap_or((pair, ""));
            let refuse = |remedy| {
                Err(RequestError { name: name.to_owned(), value: value.to_owned(), remedy })
            };
            match name {
                "scene" => scene = value,
                "detail" => detail = Some(value),
                "variant" => match Variant::from_name(value) {
                    Some(variant) => request.variant = variant,
                    None => return refuse("choose wgsl, packet4, packet8, packet16 or scalar"),
                },
                "size" => match size(value) {
                    Some(size) => request.size = size,
                    None => return refuse("give columns and rows from 1 to 4096, as in 640x400"),
                },
                "samples" => match number(value, 1, MOST_SAMPLES) {
                    Some(samples) => request.samples = samples,
                    None => return refuse("give a number from 1 to 65536"),
                },
                "readback" => request.is_readback = true,
                "submit" => request.is_submitted = true,
                "fault" => {
                    request.fault = Some(match value {
                        "shader" => Fault::Shader,
                        "call" => Fault::Call,
                        "window" => Fault::Window,
                        _ => return refuse("choose shader, call or window"),
                    });
                }
                _ => {}
            }
        }
        request.subject = subject(scene, detail)?;
        if request.is_submitted && request.variant != Variant::Wgsl {
            let (name, value) = ("variant".to_owned(), request.variant.name().to_owned());
            return Err(RequestError { name, value, remedy: "choose wgsl to submit pictures" });
        }
        Ok(request)
    }
}

fn subject(scene: &str, detail: Option<&str>) -> Result<Subject, RequestError> {
    let refuse = |name: &str, value: &str, remedy| RequestError {
        name: name.to_owned(),
        value: value.to_owned(),
        remedy,
    };
    let detail_of = |usual, least, most, remedy| match detail {
        None => Ok(usual),
        Some(text) => number(text, least, most).ok_or_else(|| refuse("detail", text, remedy)),
    };
    match scene {
        "landscape" => {
            let remedy = "give a number of points from 1 to 4000000";
            Ok(Subject::Landscape { points: detail_of(POINTS, 1, MOST_POINTS, remedy)? })
        }
        "head" => {
            let remedy = "give a side from 8 to 256 voxels";
            Ok(Subject::Head { side: detail_of(SIDE, 8, LONGEST_SIDE, remedy)? })
        }
        "cornell" => Ok(Subject::Cornell),
        _ => Err(refuse("scene", scene, "choose landscape, head or cornell")),
    }
}

fn number(text: &str, least: u32, most: u32) -> Option<u32> {
    text.parse().ok().filter(|n| (least..=most).contains(n))
}

fn size(text: &str) -> Option<(u32, u32)> {
    let (width, height) = text.split_once('x')?;
    Some((number(width, 1, LARGEST_SIDE)?, number(height, 1, LARGEST_SIDE)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empty_query_has_every_default() {
        assert_eq!(Request::parse(""), Ok(Request::default()));
        assert_eq!(Request::parse("?"), Ok(Request::default()));
        assert_eq!(Request::parse("?utm_source=mail&report"), Ok(Request::default()));
    }

    #[test]
    fn everything_can_be_asked_for() {
        let query =
            "?scene=head&detail=48&variant=packet4&size=32x18&samples=9&readback&fault=call";
        let expected = Request {
            subject: Subject::Head { side: 48 },
            variant: Variant::Packet4,
            size: (32, 18),
            samples: 9,
            is_readback: true,
            is_submitted: false,
            fault: Some(Fault::Call),
        };
        assert_eq!(Request::parse(query), Ok(expected));
        let submitted = Request { is_submitted: true, ..Request::default() };
        assert_eq!(Request::parse("submit"), Ok(submitted));
        let cornell = Request::parse("scene=cornell&detail=nothing");
        assert_eq!(cornell.map(|r| r.subject), Ok(Subject::Cornell));
    }

    #[test]
    fn what_cannot_be_shown_is_refused_with_a_remedy() {
        for query in [
            "scene=teapot",
            "scene=head&detail=7",
            "scene=head&detail=257",
            "detail=0",
            "detail=4000001",
            "detail=many",
            "variant=avx",
            "size=0x10",
            "size=4097x1",
            "size=10",
            "size=-1x5",
            "samples=0",
            "samples=65537",
            "samples=99999999999",
            "fault=mine",
            "submit&variant=packet4",
        ] {
            let error = Request::parse(query).expect_err(query).to_string();
            let last = query.rsplit('&').next().unwrap_or_default();
            assert!(error.starts_with(&format!("?{last}: ")), "{error}");
            assert!(error.contains("choose") || error.contains("give"), "{error}");
        }
    }
}
