//! The part of the page that runs in WebAssembly, on a worker.

mod fault;
mod painter;
mod picture;

use std::cell::Cell;

use raydsl_scenes::Pose;
use wasm_bindgen::prelude::*;
use web_sys::OffscreenCanvas;

use crate::Request;

#[wasm_bindgen]
extern "C" {
    /// What the worker's script does for a view.
    pub type Host;

    /// Hears what runs the kernel, by its name, once it is known.
    #[wasm_bindgen(method)]
    fn opened(this: &Host, machine: &str);

    /// Hears that a picture is shown: its samples, and the milliseconds of the last pass.
    #[wasm_bindgen(method)]
    fn shown(this: &Host, samples: u32, milliseconds: f64);

    /// Gets the light of a picture that has all its samples: four numbers a pixel, row by row from
    /// the bottom.
    #[wasm_bindgen(method)]
    fn finished(this: &Host, light: js_sys::Float32Array);

    /// Resolves once what a person did meanwhile is told to the view.
    #[wasm_bindgen(method, catch)]
    async fn turn(this: &Host) -> Result<JsValue, JsValue>;

    /// Resolves with the next that a person does.
    #[wasm_bindgen(method, catch)]
    async fn rest(this: &Host) -> Result<JsValue, JsValue>;
}

/// A scene on a canvas, better with every pass while nothing moves.
#[wasm_bindgen]
pub struct View {
    request: Request,
    canvas: OffscreenCanvas,
    host: Host,
    /// Where the camera is, and `None` until there is a scene.
    pose: Cell<Option<Pose>>,
}

#[wasm_bindgen]
impl View {
    /// Creates a view of what a query asks for; nothing happens before it runs.
    #[wasm_bindgen(constructor)]
    pub fn new(query: &str, canvas: OffscreenCanvas, host: Host) -> Result<Self, JsError> {
        console_error_panic_hook::set_once();
        let request = Request::parse(query)?;
        canvas.set_width(request.size.0);
        canvas.set_height(request.size.1);
        Ok(Self { request, canvas, host, pose: Cell::new(None) })
    }

    /// Makes the scene and shows it, as long as the worker lives: it ends with an error, or after a
    /// picture that is only submitted.
    pub async fn run(&self) -> Result<(), JsError> {
        self.request.subject.with_kernel(async |kernel, home| self.show(kernel, home).await).await?
    }

    /// Turns the camera around what it looks at, to the right and up, by degrees.
    pub fn orbit(&self, aside: f32, aloft: f32) {
        self.change(|pose| pose.orbit(aside, aloft));
    }

    /// Changes the distance from what the camera looks at, by a factor above 0.
    pub fn zoom(&self, factor: f32) {
        if factor.is_finite() && factor > 0.0 {
            self.change(|pose| pose.zoom(factor));
        }
    }

    fn change(&self, by: impl FnOnce(&mut Pose)) {
        let Some(before) = self.pose.get() else { return };
        let mut after = before;
        by(&mut after);
        if after.is_valid() {
            self.pose.set(Some(after));
        }
    }
}

/// Returns an error of the page's script, or of the browser.
fn thrown(error: &JsValue) -> JsError {
    let message = error.dyn_ref::<js_sys::Error>().map(|error| String::from(error.message()));
    JsError::new(&message.unwrap_or_else(|| format!("{error:?}")))
}
