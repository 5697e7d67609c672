//! Module cache: a kernel is recorded once, and a program printed once.

use core::any::TypeId;
use std::collections::VecDeque;
use std::sync::Arc;

use super::ir::{SceneBuffer, Uniform};
use super::module::{self, Printed, window_count};
use super::{Description, Recording};
use crate::machine::wgsl::{Arithmetic, Limits, Module, Texture};

/// The capacity for kernels and for programs: the most recently used are kept.
const KEPT: usize = 64;

/// A program and its text.
struct Program {
    recording: Recording,
    limits: Limits,
    printed: Printed,
}

/// What identifies a kernel's recording.
pub(crate) struct Identity<'k> {
    /// Its number, which no other kernel has.
    pub(crate) number: u64,
    /// What it shares with kernels of the same code.
    pub(crate) code: TypeId,
    pub(crate) arithmetic: Arithmetic,
    /// Describes its captures.
    pub(crate) describe: &'k dyn Fn(&mut Description),
}

/// A kernel with its recording.
struct Known {
    /// Its number.
    kernel: u64,
    code: TypeId,
    arithmetic: Arithmetic,
    /// What decides what is recorded; `None` if that is not all described.
    facts: Option<Vec<u64>>,
    /// The frame around its body.
    frame: Frame,
    recording: Recording,
    program: Arc<Program>,
}

impl Recording {
    /// Returns whether both have the same text under `limits`: only the numbers in the uniform
    /// buffer and the data in the storage buffers may differ, but not the kinds of enums in the
    /// data, of which the text has the arms.
    fn has_same_program(&self, other: &Self, limits: &Limits) -> bool {
        let (a, b) = (&self.state, &other.state);
        let same_uniform = |(a, b): (&Uniform, &Uniform)| a.name == b.name && a.ty == b.ty;
        let same_buffer = |(a, b): (&SceneBuffer, &SceneBuffer)| {
            let windows = |of: &SceneBuffer| window_count(of, limits);
            a.name == b.name
                && a.schema == b.schema
                && a.kinds == b.kinds
                && windows(a) == windows(b)
        };
        let same_texture = |(a, b): (&Texture, &Texture)| a.name == b.name && a.layout == b.layout;
        (self.arithmetic, self.entry) == (other.arithmetic, other.entry)
            && (self.input, self.output) == (other.input, other.output)
            && a.before_body == b.before_body
            && a.functions == b.functions
            && (a.uniforms.len(), a.buffers.len(), a.textures.len())
                == (b.uniforms.len(), b.buffers.len(), b.textures.len())
            && a.uniforms.iter().zip(&b.uniforms).all(same_uniform)
            && a.buffers.iter().zip(&b.buffers).all(same_buffer)
            && a.textures.iter().zip(&b.textures).all(same_texture)
    }
}

impl Recording {
    /// Takes numbers and buffers from what another kernel of the same closure captures. Nothing
    /// changes if one of them is not found there, or needs another text under `limits`.
    fn adopt(&mut self, from: &Description, limits: &Limits) -> bool {
        let (source, own) = (from.m.state.borrow(), &mut self.state);
        let first = own.before_body;
        // Textures do not describe themselves.
        if !own.textures.is_empty() || own.is_renamed || source.is_renamed {
            return false;
        }
        let number = |u: &Uniform| {
            if u.is_constant {
                return Some(u.words.clone());
            }
            let found = source.uniforms.iter().find(|s| s.name == u.name && s.ty == u.ty);
            found.map(|s| s.words.clone())
        };
        let buffer = |b: &SceneBuffer| {
            let is_same = |s: &&SceneBuffer| {
                let windows = |of| window_count(of, limits);
                // Of kinds that were looked for the text has the arms.
                let same_kinds = b.kinds.is_none() || s.kinds == b.kinds;
                let is_one = s.name == b.name && s.schema == b.schema;
                is_one && same_kinds && windows(s) == windows(b)
            };
            source.buffers.iter().find(is_same).map(|s| (s.key, s.len))
        };
        let numbers: Option<Vec<_>> = own.uniforms[first.uniforms..].iter().map(number).collect();
        let buffers: Option<Vec<_>> = own.buffers[first.buffers..].iter().map(buffer).collect();
        let (Some(numbers), Some(buffers)) = (numbers, buffers) else { return false };
        for (u, words) in own.uniforms[first.uniforms..].iter_mut().zip(numbers) {
            u.words = words;
        }
        for (b, (key, len)) in own.buffers[first.buffers..].iter_mut().zip(buffers) {
            (b.key, b.len) = (key, len);
        }
        true
    }

    /// Returns whether both are one program with the same numbers and data.
    fn is_same(&self, other: &Self, limits: &Limits) -> bool {
        let (a, b) = (&self.state, &other.state);
        let same_words = |(a, b): (&Uniform, &Uniform)| a.words == b.words;
        let same_data = |(a, b): (&SceneBuffer, &SceneBuffer)| (a.key, a.len) == (b.key, b.len);
        self.has_same_program(other, limits)
            && a.uniforms.iter().zip(&b.uniforms).all(same_words)
            && a.buffers.iter().zip(&b.buffers).all(same_data)
    }
}

/// The recording around a kernel's body, without the body. It contains whatever may differ between
/// two runs of a kernel, and is small beside it.
pub(crate) struct Frame(Recording);

impl Frame {
    /// Creates a frame from `recording`, which called [`Recorder::begin_body`] in place of the
    /// body.
    pub(crate) fn new(recording: Recording) -> Self {
        Self(recording)
    }

    /// Makes `recording`, of the body in such a frame, begin with the captures of this one.
    fn enter(&self, recording: &mut Recording) {
        let (from, to) = (&self.0.state, &mut recording.state);
        let count = from.before_body;
        to.uniforms[..count.uniforms].clone_from_slice(&from.uniforms[..count.uniforms]);
        to.buffers[..count.buffers].clone_from_slice(&from.buffers[..count.buffers]);
    }
}

/// The modules of kernels that ran before, on one device.
///
/// The program of a kernel depends on its code, on its captures, which stay the same while it
/// lives, and on host values in the frame around it. Kernels of one program, such as those of one
/// closure made anew for each picture, share one text.
#[derive(Default)]
pub(crate) struct Modules {
    known: VecDeque<Known>,
    programs: VecDeque<Arc<Program>>,
    recorded: u64,
    printed: u64,
}

impl Modules {
    /// Returns the number of kernels recorded so far.
    pub(crate) fn recorded(&self) -> u64 {
        self.recorded
    }

    /// Returns the number of programs printed so far.
    pub(crate) fn printed(&self) -> u64 {
        self.printed
    }

    /// Returns the module of a kernel in a frame; `record` records both, unless a kernel is known of
    /// the same code, whose captures differ in numbers and buffers alone. The limits are the
    /// device's.
    pub(crate) fn get(
        &mut self,
        limits: Limits,
        identity: &Identity<'_>,
        frame: Frame,
        record: impl Fn() -> Recording,
    ) -> Module {
        let is_in_frame =
            |k: &Known| k.program.limits == limits && k.frame.0.has_same_program(&frame.0, &limits);
        let is_same = |k: &Known| k.kernel == identity.number && is_in_frame(k);
        let at = self.known.iter().position(is_same);
        if let Some(mut known) = at.and_then(|at| self.known.remove(at)) {
            frame.enter(&mut known.recording);
            let module = known.program.printed.of(&known.recording, &limits);
            self.known.push_back(known);
            return module;
        }
        let Identity { number: kernel, code, arithmetic, describe } = *identity;
        let mut captures = Description::default();
        describe(&mut captures);
        let facts = captures.closed_facts().map(<[u64]>::to_vec);
        let is_alike = |k: &Known| {
            let same_code = k.code == code && k.arithmetic == arithmetic;
            same_code && facts.is_some() && k.facts == facts && is_in_frame(k)
        };
        let takes = |k: &mut Known| is_alike(k) && k.recording.adopt(&captures, &limits);
        let at = self.known.iter_mut().position(takes);
        if let Some(mut known) = at.and_then(|at| self.known.remove(at)) {
            frame.enter(&mut known.recording);
            debug_assert!(
                known.recording.is_same(&record(), &limits),
                "captures of a kernel are not fully described: it has other facts"
            );
            let module = known.program.printed.of(&known.recording, &limits);
            // The other kernel may be gone; if not, it takes it back in the same way.
            self.known.push_back(Known { kernel, ..known });
            return module;
        }
        self.recorded += 1;
        let recording = record();
        let program = self.program(limits, &recording);
        let module = program.printed.of(&recording, &limits);
        keep(&mut self.known, Known { kernel, code, arithmetic, facts, frame, recording, program });
        module
    }

    /// Returns the program of a recording, printed if it is new.
    fn program(&mut self, limits: Limits, recording: &Recording) -> Arc<Program> {
        let is_same = |p: &Arc<Program>| {
            p.limits == limits && p.recording.has_same_program(recording, &limits)
        };
        let at = self.programs.iter().position(is_same);
        let program = at.and_then(|at| self.programs.remove(at)).unwrap_or_else(|| {
            self.printed += 1;
            let printed = module::module(recording, &limits);
            Arc::new(Program { recording: recording.clone(), limits, printed })
        });
        keep(&mut self.programs, Arc::clone(&program));
        program
    }
}

/// Adds the newest element, evicting the oldest if there are too many.
fn keep<T>(all: &mut VecDeque<T>, newest: T) {
    if all.len() == KEPT {
        all.pop_front();
    }
    all.push_back(newest);
}
