//! The camera: world to view to screen.
//!
//! The world is right-handed, Y up, in metres; the character faces +Z. View space is x to the
//! viewer's right, y up and z the *depth*, positive away from the viewer (so it is left-handed). The
//! screen is in pixels, x to the right and y down, (0, 0) at the picture's upper left corner.

use glam::{Mat4, Quat, Vec2, Vec3, Vec4};
use portable_math::sin_cos_degrees;

/// The widest vertical field of view, in degrees (not itself allowed).
const MAX_FIELD_OF_VIEW_DEGREES: f32 = 170.0;
/// The largest picture side, in pixels.
const MAX_SIZE_PX: u32 = 16_384;

/// A camera that looks at a target from an angle and a distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrbitView {
    /// The point in the middle of the picture, in metres.
    pub target: Vec3,
    /// 0 looks at the face from +Z; positive moves the camera to the viewer's right, towards +X.
    pub yaw_degrees: f32,
    /// Positive looks from above; -90 to 90.
    pub pitch_degrees: f32,
    /// From the target to the camera, in metres, above 0.
    pub distance_m: f32,
    /// Between the picture's lower and upper edges; above 0 and below 170.
    pub vertical_fov_degrees: f32,
}

/// Why a camera or a direction was refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CameraError {
    /// The target is finite.
    #[error("the camera's target {0} is not finite")]
    Target(Vec3),
    /// A yaw is finite.
    #[error("the yaw of {0} degrees is not finite")]
    Yaw(f32),
    /// A pitch is from -90 to 90 degrees.
    #[error("the pitch of {0} degrees is not between -90 and 90")]
    Pitch(f32),
    /// The distance is above 0 and finite.
    #[error("the camera's distance of {0} m is not a finite number above 0")]
    Distance(f32),
    /// The vertical field of view is above 0 and below 170 degrees.
    #[error("the vertical field of view of {0} degrees is not above 0 and below 170")]
    FieldOfView(f32),
    /// A side of the picture is 1 to 16384 pixels.
    #[error("the picture's size of {} x {} pixels is not within 1 to 16384", .0[0], .0[1])]
    Size([u32; 2]),
    /// The near distance is above 0 and finite.
    #[error("the near distance of {0} m is not a finite number above 0")]
    Near(f32),
    /// A view is a rotation and a translation.
    #[error("the view matrix is not a rotation and a translation")]
    View,
    /// Each number is allowed, but together they exceed what a 32-bit number can hold.
    #[error("the camera's distance, field of view and near distance together are out of range")]
    Extreme,
}

/// A perspective camera. See the module's text for the spaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    eye: Vec3,
    right: Vec3,
    up: Vec3,
    /// The view axis, from the eye into the picture.
    forward: Vec3,
    size_px: [u32; 2],
    focal_px: f32,
    near_m: f32,
}

impl Camera {
    /// A camera that looks at a target, for a picture of `size_px` (width, height).
    ///
    /// `near_m` is the view depth from which things are seen, and also the depth below which sizes
    /// no longer grow ([`Self::px_per_metre`]).
    ///
    /// The axes are built from the angles, so that straight from above and below (pitch of 90 and
    /// -90 degrees) are views like any other.
    ///
    /// # Errors
    ///
    /// When a number is out of its range; see [`CameraError`].
    pub fn orbit(view: OrbitView, size_px: [u32; 2], near_m: f32) -> Result<Self, CameraError> {
        let positive = |value: f32| value.is_finite() && value > 0.0;
        let fov = view.vertical_fov_degrees;
        if !view.target.is_finite() {
            return Err(CameraError::Target(view.target));
        }
        if !positive(view.distance_m) {
            return Err(CameraError::Distance(view.distance_m));
        }
        if !positive(fov) || fov >= MAX_FIELD_OF_VIEW_DEGREES {
            return Err(CameraError::FieldOfView(fov));
        }
        if size_px.iter().any(|side| !(1..=MAX_SIZE_PX).contains(side)) {
            return Err(CameraError::Size(size_px));
        }
        if !positive(near_m) {
            return Err(CameraError::Near(near_m));
        }
        let [right, up, back] = axes(view.yaw_degrees, view.pitch_degrees)?;
        let (sin, cos) = sin_cos_degrees(f64::from(fov) / 2.0);
        let camera = Self {
            eye: view.target + back * view.distance_m,
            right,
            up,
            forward: -back,
            size_px,
            focal_px: (f64::from(size_px[1]) / 2.0 * cos / sin) as f32,
            near_m,
        };
        let finite = camera.eye.is_finite() && camera.px_per_metre(near_m).is_finite();
        finite.then_some(camera).ok_or(CameraError::Extreme)
    }

    /// A camera as programs with matrices of their own have it: `view_from_world` is a rotation and a translation
    /// into a right-handed view space whose x runs right, y up and z towards the viewer, as glam's `camera::rh::view::look_at_mat4` makes it. The
    /// picture's middle lies on the view axis, and its pixels are square.
    ///
    /// # Errors
    ///
    /// When the matrix is something else, or a number is out of its range; see [`CameraError`].
    pub fn from_view(
        view_from_world: Mat4,
        vertical_fov_degrees: f32,
        size_px: [u32; 2],
        near_m: f32,
    ) -> Result<Self, CameraError> {
        let [right, up, back] = [0, 1, 2].map(|i| view_from_world.row(i).truncate());
        let is_rigid = view_from_world.is_finite()
            && view_from_world.row(3) == Vec4::W
            && [right, up, back]
                .iter()
                .all(|axis| (axis.length() - 1.0).abs() < 1e-3)
            && right.cross(up).distance(back) < 1e-3;
        if !is_rigid {
            return Err(CameraError::View);
        }
        let shift = view_from_world.w_axis.truncate();
        let eye = -(right * shift.x + up * shift.y + back * shift.z);
        let level = OrbitView {
            target: eye,
            yaw_degrees: 0.0,
            pitch_degrees: 0.0,
            distance_m: 1.0,
            vertical_fov_degrees,
        };
        Ok(Self {
            eye,
            right,
            up,
            forward: -back,
            ..Self::orbit(level, size_px, near_m)?
        })
    }

    /// The same camera in the coordinates of something that stands in the world turned by `rotation` and then moved by
    /// `translation` (m): it sees a point of that as this one sees the placed point.
    #[must_use]
    pub fn seen_from(&self, rotation: Quat, translation: Vec3) -> Self {
        let back = rotation.inverse();
        Self {
            eye: back * (self.eye - translation),
            right: back * self.right,
            up: back * self.up,
            forward: back * self.forward,
            ..*self
        }
    }

    /// The camera's place in the world, in metres.
    #[inline]
    #[must_use]
    pub fn eye(&self) -> Vec3 {
        self.eye
    }

    /// The picture's width and height, in pixels.
    #[inline]
    #[must_use]
    pub fn size_px(&self) -> [u32; 2] {
        self.size_px
    }

    /// The view depth from which things are seen, in metres.
    #[inline]
    #[must_use]
    pub fn near_m(&self) -> f32 {
        self.near_m
    }

    /// The distance from the eye to the picture plane, in pixels.
    #[inline]
    #[must_use]
    pub fn focal_px(&self) -> f32 {
        self.focal_px
    }

    /// A point of the world in view space, in metres: right, up, depth.
    #[inline]
    #[must_use]
    pub fn view_from_world(&self, point: Vec3) -> Vec3 {
        self.view_from_world_direction(point - self.eye)
    }

    /// A direction of the world in view space: right, up, depth. Lengths stay.
    #[inline]
    #[must_use]
    pub fn view_from_world_direction(&self, direction: Vec3) -> Vec3 {
        Vec3::new(
            self.right.dot(direction),
            self.up.dot(direction),
            self.forward.dot(direction),
        )
    }

    /// A point of view space (right, up, depth, in metres) in the world: for a light that is fixed
    /// to the camera.
    #[inline]
    #[must_use]
    pub fn world_from_view(&self, point: Vec3) -> Vec3 {
        self.eye + self.world_from_view_direction(point)
    }

    /// A direction of view space (right, up, depth) in the world. Lengths stay.
    #[inline]
    #[must_use]
    pub fn world_from_view_direction(&self, direction: Vec3) -> Vec3 {
        self.right * direction.x + self.up * direction.y + self.forward * direction.z
    }

    /// The view depth of a point of the world: metres along the view axis, negative behind the eye.
    #[inline]
    #[must_use]
    pub fn depth(&self, point: Vec3) -> f32 {
        self.forward.dot(point - self.eye)
    }

    /// A point of view space on the screen, in pixels. The view axis meets the screen in the
    /// picture's centre.
    ///
    /// Meant for depths from [`Self::near_m`] on: at depth 0 there is no such point, and behind the
    /// eye it is the mirrored one.
    #[inline]
    #[must_use]
    pub fn project(&self, view: Vec3) -> Vec2 {
        let [width, height] = self.size_px.map(|side| side as f32);
        let scale = self.focal_px / view.z;
        Vec2::new(width / 2.0 + view.x * scale, height / 2.0 - view.y * scale)
    }

    /// Pixels that a metre across the view axis takes at this view depth (m).
    ///
    /// Nearer than [`Self::near_m`] it no longer grows: a disc around a visible joint stays finite.
    #[inline]
    #[must_use]
    pub fn px_per_metre(&self, depth: f32) -> f32 {
        self.focal_px / depth.max(self.near_m)
    }
}

/// The unit vector from a target towards a light (or a camera) at these angles, in the world.
///
/// The angles are [`OrbitView`]'s: yaw 0 is +Z, yaw 90 is +X, pitch 90 is +Y. For a light that is
/// fixed to the camera, the result's x and y are view space's and its z is minus view space's.
///
/// # Errors
///
/// When the yaw is not finite, or the pitch is not from -90 to 90 degrees.
pub fn direction_from_angles(yaw_degrees: f32, pitch_degrees: f32) -> Result<Vec3, CameraError> {
    Ok(axes(yaw_degrees, pitch_degrees)?[2])
}

/// The viewer's right, up and back (from the target towards the camera), as unit vectors.
fn axes(yaw_degrees: f32, pitch_degrees: f32) -> Result<[Vec3; 3], CameraError> {
    if !yaw_degrees.is_finite() {
        return Err(CameraError::Yaw(yaw_degrees));
    }
    if !(-90.0..=90.0).contains(&pitch_degrees) {
        return Err(CameraError::Pitch(pitch_degrees));
    }
    let (yaw_sin, yaw_cos) = sin_cos_degrees(f64::from(yaw_degrees));
    let (pitch_sin, pitch_cos) = sin_cos_degrees(f64::from(pitch_degrees));
    let vector = |x: f64, y: f64, z: f64| Vec3::new(x as f32, y as f32, z as f32);
    Ok([
        vector(yaw_cos, 0.0, -yaw_sin),
        vector(-yaw_sin * pitch_sin, pitch_cos, -yaw_cos * pitch_sin),
        vector(yaw_sin * pitch_cos, pitch_sin, yaw_cos * pitch_cos),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const FRONT: OrbitView = OrbitView {
        target: Vec3::ZERO,
        yaw_degrees: 0.0,
        pitch_degrees: 0.0,
        distance_m: 2.0,
        vertical_fov_degrees: 90.0,
    };

    fn camera(view: OrbitView) -> Camera {
        Camera::orbit(view, [200, 100], 0.1).unwrap()
    }

    fn on_screen(camera: &Camera, point: Vec3) -> Vec2 {
        camera.project(camera.view_from_world(point))
    }

    fn at_angles(yaw_degrees: f32, pitch_degrees: f32) -> Camera {
        camera(OrbitView {
            yaw_degrees,
            pitch_degrees,
            ..FRONT
        })
    }

    #[test]
    fn known_projections() {
        let camera = camera(FRONT);
        assert_eq!(camera.eye(), Vec3::new(0.0, 0.0, 2.0));
        // 90 degrees over 100 pixels: half the height away.
        assert!((camera.focal_px() - 50.0).abs() < 1e-4);
        assert_eq!(on_screen(&camera, Vec3::ZERO), Vec2::new(100.0, 50.0));
        // +X is to the right of the picture, +Y above; a metre at 2 m is 25 pixels.
        let corner = on_screen(&camera, Vec3::new(1.0, 2.0, 0.0));
        assert!(corner.distance(Vec2::new(125.0, 0.0)) < 1e-3, "{corner}");
        assert_eq!(camera.depth(Vec3::new(5.0, 5.0, -1.0)), 3.0);
        assert_eq!(camera.depth(Vec3::new(0.0, 0.0, 3.0)), -1.0);
    }

    #[test]
    fn positive_yaw_moves_the_camera_to_the_viewers_right() {
        let camera = at_angles(30.0, 0.0);
        let expected = Vec3::new(1.0, 0.0, 3.0_f32.sqrt());
        assert!(camera.eye().distance(expected) < 1e-6);
        // The nose, in front of the centre, then points to the left of the picture.
        assert!(on_screen(&camera, Vec3::Z * 0.1).x < 100.0);
        assert_eq!(direction_from_angles(90.0, 0.0), Ok(Vec3::X));
    }

    #[test]
    fn positive_pitch_looks_from_above() {
        let camera = at_angles(0.0, 30.0);
        assert!((camera.eye().y - 1.0).abs() < 1e-6);
        assert!(on_screen(&camera, Vec3::Z * 0.1).y > 50.0);
        assert_eq!(direction_from_angles(123.0, 90.0), Ok(Vec3::Y));
    }

    #[test]
    fn straight_from_above_and_below_keeps_the_yaw() {
        // From above the face points down the picture, from below up it.
        let above = on_screen(&at_angles(0.0, 90.0), Vec3::Z);
        assert!(above.distance(Vec2::new(100.0, 75.0)) < 1e-4, "{above}");
        let below = on_screen(&at_angles(0.0, -90.0), Vec3::Z);
        assert!(below.distance(Vec2::new(100.0, 25.0)) < 1e-4, "{below}");
        // A quarter turn of yaw takes it to the left.
        let turned = on_screen(&at_angles(90.0, 90.0), Vec3::Z);
        assert!(turned.distance(Vec2::new(75.0, 50.0)) < 1e-4, "{turned}");
    }

    #[test]
    fn sizes_are_clamped_at_the_near_distance() {
        let camera = camera(FRONT);
        assert!((camera.px_per_metre(2.0) - 25.0).abs() < 1e-4);
        assert_eq!(camera.px_per_metre(0.05), camera.px_per_metre(0.1));
        assert_eq!(camera.px_per_metre(-7.0), camera.px_per_metre(0.1));
    }

    #[test]
    fn bad_numbers_are_refused() {
        let size = [64, 64];
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let refused = |change: fn(&mut OrbitView, f32)| {
                let mut view = FRONT;
                change(&mut view, bad);
                assert!(Camera::orbit(view, size, 0.1).is_err(), "{view:?}");
            };
            refused(|view, bad| view.target.y = bad);
            refused(|view, bad| view.yaw_degrees = bad);
            refused(|view, bad| view.pitch_degrees = bad);
            refused(|view, bad| view.distance_m = bad);
            refused(|view, bad| view.vertical_fov_degrees = bad);
            assert!(Camera::orbit(FRONT, size, bad).is_err());
            assert!(direction_from_angles(bad, 0.0).is_err());
            assert!(direction_from_angles(0.0, bad).is_err());
        }
        for distance_m in [0.0, -1.0] {
            let view = OrbitView {
                distance_m,
                ..FRONT
            };
            let refused = Err(CameraError::Distance(distance_m));
            assert_eq!(Camera::orbit(view, size, 0.1), refused);
        }
        for vertical_fov_degrees in [0.0, -30.0, 170.0] {
            let view = OrbitView {
                vertical_fov_degrees,
                ..FRONT
            };
            let refused = Err(CameraError::FieldOfView(vertical_fov_degrees));
            assert_eq!(Camera::orbit(view, size, 0.1), refused);
        }
        for size in [[0, 64], [64, 0], [16_385, 1], [1, u32::MAX]] {
            assert_eq!(
                Camera::orbit(FRONT, size, 0.1),
                Err(CameraError::Size(size))
            );
        }
        assert_eq!(Camera::orbit(FRONT, size, 0.0), Err(CameraError::Near(0.0)));
        assert_eq!(
            direction_from_angles(0.0, 90.1),
            Err(CameraError::Pitch(90.1))
        );
        assert_eq!(
            Camera::orbit(FRONT, size, f32::MIN_POSITIVE),
            Err(CameraError::Extreme)
        );
    }

    proptest! {
        #[test]
        fn views_are_rigid_and_go_back(
            yaw in -400.0..400.0_f32,
            pitch in -90.0..=90.0_f32,
            point in prop::array::uniform3(-3.0..3.0_f32),
        ) {
            let camera = at_angles(yaw, pitch);
            let point = Vec3::from(point);
            let view = camera.view_from_world(point);
            prop_assert_eq!(view.z, camera.depth(point));
            prop_assert!((view.length() - point.distance(camera.eye())).abs() < 1e-5);
            prop_assert!(camera.world_from_view(view).distance(point) < 1e-5);
            let handedness = camera.right.cross(camera.up).dot(-camera.forward);
            prop_assert!((handedness - 1.0).abs() < 1e-6);
            prop_assert!(on_screen(&camera, Vec3::ZERO).distance(Vec2::new(100.0, 50.0)) < 1e-4);
            let direction = direction_from_angles(yaw, pitch).unwrap();
            prop_assert!((camera.eye() / 2.0).distance(direction) < 1e-6);
        }

        #[test]
        fn no_number_makes_a_camera_that_is_not_finite(
            target in prop::array::uniform3(any::<f32>()),
            angles in prop::array::uniform2(any::<f32>()),
            sizes in prop::array::uniform3(any::<f32>()),
        ) {
            let [distance_m, vertical_fov_degrees, near_m] = sizes;
            let view = OrbitView {
                target: Vec3::from(target),
                yaw_degrees: angles[0],
                pitch_degrees: angles[1] % 90.0,
                distance_m: distance_m.abs(),
                vertical_fov_degrees: vertical_fov_degrees.abs() % 170.0,
            };
            if let Ok(camera) = Camera::orbit(view, [640, 480], near_m.abs()) {
                prop_assert!(camera.eye().is_finite());
                prop_assert!(camera.focal_px().is_finite() && camera.focal_px() > 0.0);
                prop_assert!(camera.px_per_metre(0.0).is_finite());
            }
        }
    }
}
