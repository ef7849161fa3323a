//! What scenes and methods are called in rows.

/// Starts the names of our solver's rows; then the number of elements where that isn't the knob.
pub const OWN: &str = "inkstrand-";
/// Our solver and 20 elements that are so little bent that nothing shows but that their twist is solved.
pub const WITH_TWIST: &str = "inkstrand-twist";
/// Tetrahedra of springs.
pub const MASS_SPRING: &str = "mass-spring";
/// XPBD rods, one sweep a step; the knob is steps a frame.
pub const XPBD_STEPS: &str = "xpbd-steps";
/// XPBD rods; the knob is sweeps a step.
pub const XPBD_SWEEPS: &str = "xpbd-sweeps";
/// Starts the names of scenes of strands on a head that shakes, with nothing around them.
pub const MOTION: &str = "motion-";
/// Starts the names of scenes with everything.
pub const FULL: &str = "full-";
/// Starts the names of scenes of the same when all has come to rest.
pub const REST: &str = "rest-";
/// Ten thousand strands that are shown, of which some are simulated and carry the others.
pub const SHOWN: &str = "shown-10000x16";
/// Comes next where the hair is straight by nature.
pub const STRAIGHT: &str = "straight-";
/// Ends the names of scenes of 72 strands that one strand has too.
pub const MANY: &str = "-x72";
/// Starts the names of the rows of `MuJoCo`'s chain of ball joints.
pub const MUJOCO_CHAIN: &str = "mujoco-chain";
/// Starts the names of the scenes of a strand at rest; then Gamma.
pub const CANTILEVER: &str = "cantilever-";
/// Weight against stiffness of those scenes.
pub const GAMMAS: [f64; 4] = [1.0, 10.0, 100.0, 1000.0];
