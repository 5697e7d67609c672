//! The window: input becomes actions, and pictures become textures.

mod dialog;
mod handles;
mod input;
mod menu;
mod panels;
mod picture;
mod transfer;

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use eframe::egui;
use eframe::egui_wgpu::SurfaceErrorAction;
use raydsl_viewer::{Action, Config, Device, Next, Player, Session};

use picture::Shown;

/// The panels, in order.
pub(crate) const PANELS: [&str; 13] = [
    "open",
    "look",
    "statistics",
    "error",
    "transfer",
    "cuts",
    "pick",
    "views",
    "animation",
    "lanes",
    "log",
    "keys",
    "wgsl",
];

/// Those that are open at first.
const OPEN: [&str; 7] = ["open", "look", "statistics", "transfer", "cuts", "pick", "log"];

/// What a window begins with.
pub(crate) struct Options {
    /// Applied first.
    pub(crate) actions: Vec<Action>,
    /// Played then; the window closes at its end.
    pub(crate) player: Option<Player>,
    /// Where pictures are written.
    pub(crate) out: PathBuf,
}

/// The application.
pub(crate) struct Viewer {
    session: Session,
    /// A script, or an animation that was asked for in the window.
    player: Option<Player>,
    /// Whether a script chooses the size of the picture.
    is_played: bool,
    panels: BTreeSet<&'static str>,
    shown: Shown,
    /// What is typed into panels.
    texts: panels::Texts,
    transfer: transfer::Editor,
    dialog: dialog::Dialog,
    handles: handles::Handles,
    menu: menu::ShownMenu,
    screenshots: (Sender<Screenshot>, Receiver<Screenshot>),
    awaited_screenshots: usize,
    pictures: usize,
    device_errors: DeviceErrors,
    /// When this turn of the window began.
    began: Option<Instant>,
    /// The longest time between an event and the window's answer: that of one turn of the window.
    longest: Duration,
    /// Gets the session when the window closes.
    end: Sender<End>,
}

/// What became of a window that was closed.
pub(crate) struct End {
    pub(crate) log: Vec<String>,
    pub(crate) errors: usize,
}

struct Screenshot {
    name: String,
    image: Arc<egui::ColorImage>,
}

/// Opens a window and returns when it is closed.
pub(crate) fn run(options: Options) -> Result<End, String> {
    let (end, ended) = channel();
    let native = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("raydsl viewer")
            .with_inner_size([1280.0, 720.0])
            .with_min_inner_size([1.0, 1.0])
            .with_drag_and_drop(true),
        wgpu_options: wgpu_options(),
        ..Default::default()
    };
    let create: eframe::AppCreator<'_> =
        Box::new(move |cc| Ok(Box::new(Viewer::new(cc, options, end))));
    eframe::run_native("raydsl-viewer", native, create)
        .map_err(|e| format!("no window: {e}; --script works without one"))?;
    ended.recv().map_err(|_| "the window has ended early".to_owned())
}

/// The window's device has the limits of a kernel's own, as far as the adapter allows.
fn wgpu_options() -> eframe::egui_wgpu::WgpuConfiguration {
    let mut setup = eframe::egui_wgpu::WgpuSetupCreateNew::without_display_handle();
    setup.device_descriptor = Arc::new(|adapter| {
        let offered = adapter.limits();
        wgpu::DeviceDescriptor {
            label: Some("window"),
            required_features: adapter.features() & wgpu::Features::TIMESTAMP_QUERY,
            required_limits: wgpu::Limits {
                max_storage_buffer_binding_size: offered.max_storage_buffer_binding_size,
                max_buffer_size: offered.max_buffer_size,
                max_storage_buffers_per_shader_stage: offered.max_storage_buffers_per_shader_stage,
                ..wgpu::Limits::default().or_worse_values_from(&offered)
            },
            ..Default::default()
        }
    });
    eframe::egui_wgpu::WgpuConfiguration {
        wgpu_setup: setup.into(),
        on_surface_status: Arc::new(|status| match status {
            wgpu::CurrentSurfaceTexture::Occluded | wgpu::CurrentSurfaceTexture::Timeout => {
                SurfaceErrorAction::SkipFrame
            }
            wgpu::CurrentSurfaceTexture::Lost => SurfaceErrorAction::RecreateSurface,
            // Also where the surface could not be configured because kernels kept the device busy.
            _ => SurfaceErrorAction::Reconfigure,
        }),
        ..Default::default()
    }
}

/// What went wrong on the window's device, as far as nobody else handles it.
type DeviceErrors = Arc<Mutex<Vec<String>>>;

/// Keeps errors, at which wgpu would else end the program.
fn keep_errors(device: &wgpu::Device) -> DeviceErrors {
    let errors = DeviceErrors::default();
    let kept = errors.clone();
    device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
        let message = error.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
        // A surface is configured again with the next frame: nothing is lost.
        if !message.contains("Surface::configure") {
            kept.lock().unwrap_or_else(PoisonError::into_inner).push(message);
        }
    }));
    errors
}

impl Viewer {
    fn new(cc: &eframe::CreationContext<'_>, options: Options, end: Sender<End>) -> Self {
        let ctx = cc.egui_ctx.clone();
        let device = match &cc.wgpu_render_state {
            Some(state) => Device::of_window(state.device.clone(), state.queue.clone()),
            None => Device::default(),
        };
        let state = cc.wgpu_render_state.as_ref();
        let device_errors = state.map(|state| keep_errors(&state.device)).unwrap_or_default();
        // A script makes the same pictures as without a window.
        let config = match options.player {
            Some(_) => Config::scripted(&options.out),
            None => Config::interactive(&options.out),
        };
        let mut session = Session::new(config, device, move || ctx.request_repaint());
        if let Err(message) = session.keep_log(&options.out.join("log.txt")) {
            session.refuse(&message);
        }
        for action in &options.actions {
            // A refusal is in the log.
            let _ = session.apply(action);
        }
        Self {
            session,
            is_played: options.player.is_some(),
            player: options.player,
            panels: OPEN.into(),
            shown: Shown::default(),
            texts: Default::default(),
            transfer: Default::default(),
            dialog: Default::default(),
            handles: Default::default(),
            menu: Default::default(),
            screenshots: channel(),
            awaited_screenshots: 0,
            pictures: 0,
            device_errors,
            began: None,
            longest: Duration::ZERO,
            end,
        }
    }

    /// Returns whether an animation plays; a script plays too, but may take no pictures.
    fn is_animating(&self) -> bool {
        self.player.is_some() && (!self.is_played || self.session.recorded().is_some())
    }

    /// Does what an action asks for, of the window or of the session.
    fn apply(&mut self, ctx: &egui::Context, action: &Action) {
        match action {
            Action::Panel(name, is_open) => match PANELS.iter().find(|panel| *panel == name) {
                Some(panel) if *is_open => {
                    self.panels.insert(panel);
                    // Without data there is no text, which the log says.
                    let _ = match *panel {
                        "wgsl" => self.session.apply_wgsl(),
                        "lanes" => self.session.apply_lanes(),
                        _ => Ok(()),
                    };
                }
                Some(panel) => {
                    self.panels.remove(panel);
                }
                None => self.session.refuse(&format!("{action}: choose from {PANELS:?}")),
            },
            Action::Screenshot(name) => {
                let (name, sender, again) = (name.clone(), self.screenshots.0.clone(), ctx.clone());
                self.awaited_screenshots += 1;
                ctx.request_screenshot(move |image| {
                    // A window that is gone needs none.
                    let _ = sender.send(Screenshot { name, image });
                    again.request_repaint();
                });
            }
            Action::Animate(_) if self.player.is_none() => {
                self.player = Some(Player::of(action.clone()));
            }
            Action::Cancel
                if !self.is_played
                    && let Some(player) = self.player.take() =>
            {
                player.cancel(&mut self.session);
            }
            // The mouse points at the menu that it sees; a key may have closed it in the same turn.
            Action::Wand(_) | Action::Press if self.session.menu().is_none() => {}
            Action::Quit => ctx.send_viewport_cmd(egui::ViewportCommand::Close),
            action => {
                let _ = self.session.apply(action);
            }
        }
    }

    /// Writes screenshots that have arrived.
    fn take_screenshots(&mut self) {
        while let Ok(Screenshot { name, image }) = self.screenshots.1.try_recv() {
            self.awaited_screenshots -= 1;
            let [width, height] = image.size.map(|n| n as u32);
            let rgba = image.pixels.iter().flat_map(|p| p.to_array()).collect();
            self.session.write_pixels(&name, rgba, (width, height));
        }
    }

    /// Opens what was chosen in a dialog.
    fn take_chosen(&mut self, actions: &mut Vec<Action>) {
        match self.dialog.take() {
            Some(chosen) if chosen.is_empty() => {
                self.session.note("no file was chosen: type its name, or drop it".to_owned());
            }
            Some(chosen) => actions.extend(input::opened_all(&self.session, chosen)),
            None => {}
        }
    }

    /// Plays what can be played of a script.
    fn play(&mut self, ctx: &egui::Context) {
        // Panels slide: a screenshot is one of the window at rest.
        while self.awaited_screenshots == 0
            && let Some(player) = &mut self.player
        {
            match player.step(&mut self.session) {
                Next::Waits => break,
                Next::Asks(action) => self.apply(ctx, &action),
                Next::Done => {
                    self.player = None;
                    if self.is_played {
                        ctx.send_viewport_cmd(egui::ViewportCommand::Close);
                    }
                }
            }
        }
    }
}

impl eframe::App for Viewer {
    fn logic(&mut self, ctx: &egui::Context, _frame: &mut eframe::Frame) {
        self.began = Some(Instant::now());
        self.session.poll();
        self.take_screenshots();
        let errors = {
            let mut errors = self.device_errors.lock().unwrap_or_else(PoisonError::into_inner);
            std::mem::take(&mut *errors)
        };
        errors.iter().for_each(|error| self.session.refuse(error));
        if self.player.is_some() {
            self.play(ctx);
            ctx.request_repaint_after(Duration::from_millis(10));
        }
    }

    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        let begin = self.began.take().unwrap_or_else(Instant::now);
        let ctx = ui.ctx().clone();
        let mut actions = Vec::new();
        input::dropped(&ctx, &self.session, &mut actions);
        self.take_chosen(&mut actions);
        panels::show(self, ui, &mut actions);
        self.show_picture(ui, frame, &mut actions);
        if self.player.is_some() {
            actions.retain(Player::leaves_room_for);
        }
        for action in &actions {
            self.apply(&ctx, action);
        }
        self.longest = self.longest.max(begin.elapsed());
    }

    fn on_exit(&mut self) {
        self.session.close();
        let longest = self.longest.as_secs_f64() * 1e3;
        self.session.note(format!("longest turn {longest:.1} ms"));
        let (log, errors) = (self.session.log().to_vec(), self.session.errors());
        // Whoever opened the window waits for it.
        let _ = self.end.send(End { log, errors });
    }
}
