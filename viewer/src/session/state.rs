//! What a session tells.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use raydsl_report::Utilisation;
use raydsl_scenes::Pose;

use super::Session;
use crate::device::Device;
use crate::frame::Frame;
use crate::look::Look;
use crate::subject::{Info, Picked};

impl Session {
    /// Returns what is looked at, and how.
    pub fn look(&self) -> &Look {
        &self.look
    }

    /// Returns what is known of the data, if any are open.
    pub fn info(&self) -> Option<&Info> {
        self.info.as_ref()
    }

    /// Returns the newest picture.
    pub fn frame(&self) -> Option<&Arc<Frame>> {
        self.frame.as_ref()
    }

    /// Returns the number of changes so far of what is visible.
    pub fn number(&self) -> u64 {
        self.number
    }

    /// Returns the part of loading that is done, from 0 to 1, if data are loading.
    pub fn progress(&self) -> Option<(&'static str, f32)> {
        self.progress
    }

    /// Returns the files that are time steps, and the number of the one that is shown.
    pub fn steps(&self) -> (&[PathBuf], usize) {
        (&self.files, self.step)
    }

    /// Returns the folder of pictures.
    pub fn out(&self) -> &Path {
        &self.config.out
    }

    /// Returns the kept cameras by name.
    pub fn views(&self) -> &BTreeMap<String, Pose> {
        &self.views
    }

    /// Returns a line for everything that happened.
    pub fn log(&self) -> &[String] {
        self.log.lines()
    }

    /// Returns how many lines of the log are errors.
    pub fn errors(&self) -> usize {
        self.log.errors()
    }

    /// Returns what was in the pixel that was asked about last: nothing before the first answer.
    pub fn picked(&self) -> Option<Option<&Picked>> {
        self.picked.as_ref().map(Option::as_ref)
    }

    /// Returns the kernel's text, if it was asked for.
    pub fn wgsl(&self) -> Option<&str> {
        self.wgsl.as_deref()
    }

    /// Returns how many lanes of packets run, if that was asked for.
    pub fn lanes(&self) -> Option<&Utilisation> {
        self.lanes.as_ref()
    }

    /// Returns the device of the WGSL variant.
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// Returns whether the picture shows the last change, at full size, with as many samples.
    pub fn has(&self, samples: u32) -> bool {
        let is_there =
            |f: &Arc<Frame>| f.number == self.number && !f.is_coarse && f.samples >= samples.max(1);
        self.frame.as_ref().is_some_and(is_there)
    }

    /// Returns whether the picture of the last change cannot be made, or there are no data.
    pub fn is_stuck(&self) -> bool {
        self.current.is_none() || self.failed == Some(self.number)
    }

    /// Returns whether a question about the picture is not answered yet, or a file of light not read.
    pub fn is_asking(&self) -> bool {
        (self.questions > 0 && self.current.is_some()) || self.pending_sky.is_some()
    }
}
