//! The program's own camera: it goes round the head.

use glam::camera::rh::{proj::directx, view::look_at_mat4};
use glam::{Mat4, Quat, Vec3};
use render::gpu::PassDepth;
use std::f32::consts::TAU;
use stroke_path::{Camera, CameraError};

/// The depth buffer's format.
pub const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// How depths are stored. inkstrand does with either, and with any other perspective projection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthRange {
    /// 0 near, 1 far.
    Forward,
    /// 1 near, 0 infinitely far: exact at any distance, and so what most engines use.
    Reversed,
}

impl DepthRange {
    /// What of two depths is in front.
    #[must_use]
    pub fn compare(self) -> wgpu::CompareFunction {
        match self {
            Self::Forward => wgpu::CompareFunction::Less,
            Self::Reversed => wgpu::CompareFunction::Greater,
        }
    }

    /// The depth of what is infinitely far.
    #[must_use]
    pub fn farthest(self) -> f32 {
        match self {
            Self::Forward => 1.0,
            Self::Reversed => 0.0,
        }
    }
}

/// Where the eye is on its way around the head.
#[derive(Clone, Copy, Debug)]
pub struct Orbit {
    /// Radians; 0 looks at the face, positive goes to the viewer's right.
    pub yaw: f32,
    /// Radians; positive looks from above.
    pub pitch: f32,
}

impl Orbit {
    /// A place to begin at.
    pub const START: Self = Self {
        yaw: 0.45,
        pitch: 0.16,
    };

    /// How fast it goes round by itself, radians a second.
    const SPEED: f32 = 0.1;

    /// Where it is so many seconds later.
    #[must_use]
    pub fn after(mut self, seconds: f32) -> Self {
        self.turn(Self::SPEED * seconds, 0.0);
        self
    }

    /// Goes on by those angles. Stops before straight above and below, where `look_at` has no answer.
    pub fn turn(&mut self, yaw: f32, pitch: f32) {
        self.yaw = (self.yaw + yaw) % TAU;
        self.pitch = (self.pitch + pitch).clamp(-1.4, 1.4);
    }
}

/// The matrices of a picture.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// Width and height, pixels.
    pub size_px: [u32; 2],
    /// View space is right-handed: x right, y up, z towards the viewer.
    pub view_from_world: Mat4,
    /// The perspective.
    pub clip_from_view: Mat4,
    /// How its depths are stored.
    pub depth: DepthRange,
    near_m: f32,
}

impl View {
    const VERTICAL_FOV_DEGREES: f32 = 30.0;

    /// The eye looks at the middle of a scene around that head.
    #[must_use]
    pub fn of(head: render::Head, orbit: Orbit, size_px: [u32; 2], depth: DepthRange) -> Self {
        let target = head.center - 0.95 * head.height_m * Vec3::Y;
        let back = Quat::from_rotation_y(orbit.yaw) * Quat::from_rotation_x(-orbit.pitch) * Vec3::Z;
        let eye = target + 7.2 * head.height_m * back;
        let (near_m, far_m) = (0.1 * head.height_m, 40.0 * head.height_m);
        let fov = Self::VERTICAL_FOV_DEGREES.to_radians();
        let aspect = size_px[0] as f32 / size_px[1] as f32;
        Self {
            size_px,
            view_from_world: look_at_mat4(eye, target, Vec3::Y),
            clip_from_view: match depth {
                DepthRange::Forward => directx::perspective(fov, aspect, near_m, far_m),
                DepthRange::Reversed => directx::perspective_infinite_reverse(fov, aspect, near_m),
            },
            depth,
            near_m,
        }
    }

    /// The same camera for inkstrand.
    ///
    /// # Errors
    ///
    /// When `view_from_world` is more than a rotation and a translation.
    pub fn as_inkstrand_sees_it(&self) -> Result<Camera, CameraError> {
        Camera::from_view(
            self.view_from_world,
            Self::VERTICAL_FOV_DEGREES,
            self.size_px,
            self.near_m,
        )
    }

    /// The same depths for inkstrand.
    #[must_use]
    pub fn pass_depth(&self) -> PassDepth {
        PassDepth::of_projection(self.clip_from_view, DEPTH_FORMAT, self.depth.compare())
    }
}
