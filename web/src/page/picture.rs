//! The loop of a view: a pass, a picture, what a person did.

use raydsl::prelude::*;
use raydsl_scenes::Pose;
use wasm_bindgen::prelude::*;

use super::painter::Painter;
use super::{View, fault, thrown};
use crate::{PictureKernel, next_pass};

impl View {
    /// Shows a kernel from a camera on, until an error, or once if the picture is submitted.
    pub(super) async fn show(&self, kernel: &PictureKernel<'_>, home: Pose) -> Result<(), JsError> {
        let mut painter = Painter::open(&self.request, &self.canvas).await?;
        self.host.opened(&painter.machine());
        if let Some((fault, gpu)) = self.request.fault.zip(painter.gpu()) {
            fault::commit(fault, gpu).await?;
        }
        if self.request.is_submitted {
            let begin = js_sys::Date::now();
            let light = painter.submit(kernel, &home).await?;
            painter.show(&light)?;
            self.host.shown(1, js_sys::Date::now() - begin);
            return self.finish(&painter, &light).await;
        }
        let (width, height) = self.request.size;
        let mut film = Film::new(width, height);
        let mut pose = home;
        let mut is_finished = false;
        self.pose.set(Some(pose));
        loop {
            let begin = js_sys::Date::now();
            if let Some(moved) = self.pose.get().filter(|moved| *moved != pose) {
                pose = moved;
                film.clear();
                is_finished = false;
                // While a person moves the camera, a picture of one ray a pixel is enough.
                painter.glance(kernel, &pose).await?;
                self.host.shown(0, js_sys::Date::now() - begin);
            } else if film.samples() < self.request.samples {
                let samples = next_pass(film.samples(), self.request.samples);
                painter.add(kernel, &pose, &mut film, samples).await?;
                painter.show(&film.image())?;
                self.host.shown(film.samples(), js_sys::Date::now() - begin);
            } else if !is_finished {
                self.finish(&painter, &film.image()).await?;
                is_finished = true;
            } else {
                self.host.rest().await.map_err(|error| thrown(&error))?;
            }
            self.host.turn().await.map_err(|error| thrown(&error))?;
        }
    }

    /// Tells the light of a picture, once the device has no error to tell.
    async fn finish(&self, painter: &Painter, light: &Image<Vec4>) -> Result<(), JsError> {
        if let Some(gpu) = painter.gpu() {
            gpu.context().settle().await?;
        }
        let numbers: &[f32] = bytemuck::cast_slice(light.pixels());
        self.host.finished(js_sys::Float32Array::from(numbers));
        Ok(())
    }
}
