//! The window and its loop.

use crate::Options;
use embed_wgpu::view::Orbit;
use embed_wgpu::{Demo, Outcome, Shown, device};
use std::sync::Arc;
use std::time::Instant;
use winit::application::ApplicationHandler;
use winit::dpi::{PhysicalPosition, PhysicalSize};
use winit::event::{ElementState, KeyEvent, MouseButton, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop};
use winit::keyboard::{Key, NamedKey};
use winit::window::{Window, WindowId};

/// Shows the scene until its window is closed.
///
/// # Errors
///
/// When there is no screen or no graphics card, or drawing fails.
pub fn run(options: Options) -> Outcome {
    let events = EventLoop::new()?;
    let mut app = App {
        options,
        viewer: None,
        failure: None,
    };
    events.run_app(&mut app)?;
    app.failure.map_or(Ok(()), Err)
}

/// What winit talks to.
struct App {
    options: Options,
    /// There once the window is.
    viewer: Option<Viewer>,
    /// Why the loop was left.
    failure: Option<Box<dyn std::error::Error>>,
}

impl ApplicationHandler for App {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.viewer.is_some() {
            return;
        }
        match Viewer::open(events, &self.options) {
            Ok(viewer) => self.viewer = Some(viewer),
            Err(error) => self.fail(events, error),
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(viewer) = &mut self.viewer else {
            return;
        };
        match event {
            WindowEvent::CloseRequested | WindowEvent::Destroyed => events.exit(),
            WindowEvent::Resized(size) => viewer.resize(size),
            WindowEvent::Occluded(is_hidden) => viewer.is_hidden = is_hidden,
            WindowEvent::CursorMoved { position, .. } => viewer.point(position),
            WindowEvent::MouseInput {
                state,
                button: MouseButton::Left,
                ..
            } => viewer.is_dragged = state == ElementState::Pressed,
            WindowEvent::KeyboardInput { event, .. } => viewer.press(&event, events),
            WindowEvent::RedrawRequested => {
                if let Err(error) = viewer.draw() {
                    self.fail(events, error);
                }
            }
            _ => {}
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        let is_seen = self.viewer.as_ref().is_some_and(Viewer::is_seen);
        if let (Some(viewer), true) = (&self.viewer, is_seen) {
            viewer.window.request_redraw();
        }
        // A window that nobody sees takes no time at all.
        events.set_control_flow(if is_seen {
            ControlFlow::Poll
        } else {
            ControlFlow::Wait
        });
    }
}

impl App {
    fn fail(&mut self, events: &ActiveEventLoop, error: Box<dyn std::error::Error>) {
        self.failure = Some(error);
        events.exit();
    }
}

/// The window, with what is shown in it.
struct Viewer {
    window: Arc<Window>,
    /// As winit last said, pixels.
    size: PhysicalSize<u32>,
    instance: wgpu::Instance,
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
    demo: Demo,
    orbit: Orbit,
    /// Seconds in the scene.
    time: f32,
    is_stopped: bool,
    last_draw: Option<Instant>,
    pointer: Option<PhysicalPosition<f64>>,
    is_dragged: bool,
    is_hidden: bool,
}

/// Most seconds that the scene goes on in a frame: a slow machine shows it slowly, in place of simulating for longer
/// and longer.
const LONGEST_STEP: f32 = 0.1;

impl Viewer {
    fn open(events: &ActiveEventLoop, options: &Options) -> Outcome<Self> {
        let [width, height] = options.size;
        let wanted = Window::default_attributes()
            .with_title("inkstrand in a wgpu program")
            .with_inner_size(PhysicalSize::new(width, height));
        let window = Arc::new(events.create_window(wanted)?);
        let display = Box::new(events.owned_display_handle());
        let instance =
            wgpu::Instance::new(wgpu::InstanceDescriptor::new_with_display_handle(display));
        let surface = instance
            .create_surface(Arc::clone(&window))
            .map_err(|error| format!("no graphics driver draws into windows here: {error}"))?;
        let (adapter, gpu) = device::open(&instance, Some(&surface))?;

        let size = window.inner_size();
        let mut config = surface
            .get_default_config(&adapter, size.width.max(1), size.height.max(1))
            .ok_or("the graphics card can't show pictures in this window")?;
        // Colours are linear in shaders: a format that stores them as sRGB blends and resolves them rightly.
        let formats = surface.get_capabilities(&adapter).formats;
        if let Some(srgb) = formats.into_iter().find(wgpu::TextureFormat::is_srgb) {
            config.format = srgb;
        }
        config.present_mode = wgpu::PresentMode::AutoVsync;
        let demo = options.demo(gpu, config.format)?;
        let mut viewer = Self {
            window,
            size,
            instance,
            surface,
            config,
            demo,
            orbit: Orbit::START,
            time: 0.0,
            is_stopped: false,
            last_draw: None,
            pointer: None,
            is_dragged: false,
            is_hidden: false,
        };
        viewer.configure();
        Ok(viewer)
    }

    /// A window that is minimised has no size on some systems, and is hidden on others.
    fn is_seen(&self) -> bool {
        !self.is_hidden && self.size.width > 0 && self.size.height > 0
    }

    fn resize(&mut self, size: PhysicalSize<u32>) {
        self.size = size;
        self.configure();
    }

    /// Gives the surface the window's size.
    fn configure(&mut self) {
        if self.size.width > 0 && self.size.height > 0 {
            let gpu = self.demo.gpu();
            let most = gpu.device.limits().max_texture_dimension_2d;
            self.config.width = self.size.width.min(most);
            self.config.height = self.size.height.min(most);
            self.surface.configure(&gpu.device, &self.config);
        }
    }

    fn point(&mut self, position: PhysicalPosition<f64>) {
        if let (Some(before), true) = (self.pointer, self.is_dragged) {
            let radians = |pixels: f64| (0.008 * pixels) as f32;
            self.orbit.turn(
                radians(before.x - position.x),
                radians(position.y - before.y),
            );
        }
        self.pointer = Some(position);
    }

    fn press(&mut self, key: &KeyEvent, events: &ActiveEventLoop) {
        if !key.state.is_pressed() || key.repeat {
            return;
        }
        match key.logical_key {
            Key::Named(NamedKey::Escape) => events.exit(),
            Key::Named(NamedKey::Space) => self.is_stopped = !self.is_stopped,
            _ => {}
        }
    }

    fn draw(&mut self) -> Outcome {
        if !self.is_seen() {
            return Ok(());
        }
        let (target, is_outdated) = match self.surface.get_current_texture() {
            wgpu::CurrentSurfaceTexture::Success(target) => (target, false),
            wgpu::CurrentSurfaceTexture::Suboptimal(target) => (target, true),
            wgpu::CurrentSurfaceTexture::Outdated => {
                self.configure();
                return Ok(());
            }
            wgpu::CurrentSurfaceTexture::Lost => {
                self.surface = self.instance.create_surface(Arc::clone(&self.window))?;
                self.configure();
                return Ok(());
            }
            wgpu::CurrentSurfaceTexture::Timeout | wgpu::CurrentSurfaceTexture::Occluded => {
                return Ok(());
            }
            wgpu::CurrentSurfaceTexture::Validation => return Ok(self.demo.gpu().check()?),
        };
        self.advance();
        let size_px = [self.config.width, self.config.height];
        let view = self.demo.view(self.orbit, size_px);
        self.demo
            .draw(&target.texture, self.time, &view, Shown::ALL)?;
        self.window.pre_present_notify();
        self.demo.gpu().queue.present(target);
        if is_outdated {
            self.configure();
        }
        Ok(())
    }

    /// Lets the time since the last frame pass.
    fn advance(&mut self) {
        let now = Instant::now();
        let passed = (self.last_draw.replace(now))
            .map_or(0.0, |before| now.duration_since(before).as_secs_f32());
        if !self.is_stopped {
            let step = passed.min(LONGEST_STEP);
            self.time += step;
            if !self.is_dragged {
                self.orbit = self.orbit.after(step);
            }
        }
    }
}
