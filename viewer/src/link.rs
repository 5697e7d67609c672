//! What is between the session and the thread that loads and renders.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::Sender;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use raydsl::render::{Progress, Reached};
use raydsl_report::Utilisation;

use crate::action::Goal;
use crate::frame::Frame;
use crate::look::{Look, Sky};
use crate::subject::{Info, Picked};

/// What the thread of some data reports, in order.
#[derive(Clone, Debug)]
pub(crate) enum Event {
    /// How far loading is.
    Progress { what: &'static str, share: f32 },
    /// The data are there.
    Loaded(Box<Info>),
    /// The data cannot be loaded.
    Refused(String),
    /// The picture of a job, by its number, cannot be made.
    Failed { number: u64, message: String },
    /// The device does not make the picture of a job: another variant must.
    DeviceFailed { number: u64, message: String },
    /// What is in a pixel.
    Picked(Option<Picked>),
    /// The kernel's text, or why there is none.
    Wgsl(Result<String, String>),
    /// How many lanes of packets run, or why that is not known.
    Lanes(Result<Utilisation, String>),
    /// How far the picture of a job is from its goal.
    Nearer { number: u64, progress: Progress },
    /// What became of the goal of a job.
    Reached { number: u64, reached: Reached },
    /// The light of all directions from a file, or why there is none.
    Sky(Result<Sky, String>),
    /// The last event of a thread, with the message of its panic if there was one.
    Ended(Option<String>),
}

/// What a thread reports, with the number of its data in the session.
pub(crate) type Report = (u64, Event);

/// A question beside the picture, with the look that it is about: that of the job may be another by
/// the time of the answer.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Question {
    /// What is in a pixel?
    Pick { x: u32, y: u32, look: Arc<Look> },
    /// What is the kernel's text?
    Wgsl(Arc<Look>),
    /// How many lanes of packets run?
    Lanes(Arc<Look>),
}

/// A picture that is wanted.
#[derive(Clone, Debug)]
pub(crate) struct Job {
    /// Grows with every change of what is visible.
    pub(crate) number: u64,
    /// The number of the last change of the light: pictures that differ in nothing but the exposure
    /// share a film.
    pub(crate) light: u64,
    pub(crate) look: Arc<Look>,
    /// Samples of each pixel after which there is nothing to do.
    pub(crate) limit: u32,
    /// An error that is to be reached, in place of a number of samples.
    pub(crate) goal: Option<Goal>,
    /// The time that a coarse picture may take, which comes first; none is made without it.
    pub(crate) coarse: Option<Duration>,
}

#[derive(Debug, Default)]
struct Wanted {
    job: Option<Job>,
    questions: Vec<Question>,
}

/// A link between a session and the thread of some data. The session never waits for the thread: it
/// leaves what it wants here.
pub(crate) struct Link {
    events: Sender<Report>,
    /// The number of these data in the session.
    id: u64,
    wanted: Mutex<Wanted>,
    is_changed: Condvar,
    /// The number of the wanted job, and whether there are questions: cheap to look at for each
    /// tile.
    newest: AtomicU64,
    has_questions: AtomicBool,
    /// Read by loaders too, while they read files.
    is_closed: Arc<AtomicBool>,
    frame: Mutex<Option<Arc<Frame>>>,
    wake: Arc<dyn Fn() + Send + Sync>,
}

/// Locks what another thread may have left in a panic: the values are whole in any case.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Link {
    pub(crate) fn new(id: u64, events: Sender<Report>, wake: Arc<dyn Fn() + Send + Sync>) -> Self {
        Self {
            events,
            id,
            wanted: Mutex::default(),
            is_changed: Condvar::new(),
            newest: AtomicU64::new(0),
            has_questions: AtomicBool::new(false),
            is_closed: Arc::default(),
            frame: Mutex::new(None),
            wake,
        }
    }

    /// Tells the thread to end.
    pub(crate) fn close(&self) {
        self.is_closed.store(true, Ordering::Relaxed);
        let _wanted = lock(&self.wanted);
        self.is_changed.notify_all();
    }

    pub(crate) fn is_closed(&self) -> bool {
        self.is_closed.load(Ordering::Relaxed)
    }

    /// Returns what is set when the link is closed.
    pub(crate) fn closing(&self) -> &Arc<AtomicBool> {
        &self.is_closed
    }

    /// Leaves a job in place of the one before.
    pub(crate) fn want(&self, job: Job) {
        let mut wanted = lock(&self.wanted);
        self.newest.store(job.number, Ordering::Relaxed);
        wanted.job = Some(job);
        self.is_changed.notify_all();
    }

    /// Leaves a question.
    pub(crate) fn ask(&self, question: Question) {
        let mut wanted = lock(&self.wanted);
        wanted.questions.push(question);
        self.has_questions.store(true, Ordering::Relaxed);
        self.is_changed.notify_all();
    }

    /// Takes the newest picture, if there is one that was not taken yet.
    pub(crate) fn take_frame(&self) -> Option<Arc<Frame>> {
        lock(&self.frame).take()
    }

    /// Whether another picture than this is wanted by now, or none.
    pub(crate) fn is_outdated(&self, number: u64) -> bool {
        self.is_closed() || self.newest.load(Ordering::Relaxed) != number
    }

    pub(crate) fn has_questions(&self) -> bool {
        self.has_questions.load(Ordering::Relaxed)
    }

    pub(crate) fn take_questions(&self) -> Vec<Question> {
        let mut wanted = lock(&self.wanted);
        self.has_questions.store(false, Ordering::Relaxed);
        std::mem::take(&mut wanted.questions)
    }

    pub(crate) fn job(&self) -> Option<Job> {
        lock(&self.wanted).job.clone()
    }

    /// Waits until `is_idle` does not hold for what is wanted, or the link is closed.
    pub(crate) fn wait_while(&self, is_idle: impl Fn(&Job) -> bool) {
        let mut wanted = lock(&self.wanted);
        while !self.is_closed()
            && wanted.questions.is_empty()
            && wanted.job.as_ref().is_none_or(&is_idle)
        {
            wanted = self.is_changed.wait(wanted).unwrap_or_else(PoisonError::into_inner);
        }
    }

    pub(crate) fn publish(&self, frame: Frame) {
        *lock(&self.frame) = Some(Arc::new(frame));
        (self.wake)();
    }

    pub(crate) fn send(&self, event: Event) {
        // A session that is gone needs no report.
        let _ = self.events.send((self.id, event));
        (self.wake)();
    }
}
