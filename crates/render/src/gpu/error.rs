//! What can go wrong on a graphics card.

use crate::check::DrawError;
use crate::frame::FrameError;
use crate::samples::SampleCountError;

/// Why a graphics card drew nothing. All of these leave the CPU's rasteriser as a way out.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// No driver, or none of the kind that was asked for.
    #[error("there is no graphics card to draw on{}", if *.software { "" } else { " (software drivers are not counted)" })]
    NoAdapter {
        /// Whether software drivers were looked for too.
        software: bool,
    },
    /// The driver gives no device.
    #[error("the graphics card \"{adapter}\" can't be used: {message}")]
    NoDevice {
        /// The card's name.
        adapter: String,
        /// The driver's own words.
        message: String,
    },
    /// The device can do less than what is needed for any frame.
    #[error("the graphics card has a limit of {has} for {what}, where {needs} are needed")]
    Limit {
        /// The limit.
        what: &'static str,
        /// Its value.
        has: u64,
        /// What is needed.
        needs: u64,
    },
    /// The frame has more of something than the device can hold in one piece.
    #[error(
        "the frame's {what} take {bytes} bytes, where the graphics card allows {most} in one piece"
    )]
    TooLarge {
        /// Of what there is too much.
        what: &'static str,
        /// Its size.
        bytes: u64,
        /// The device's limit.
        most: u64,
    },
    /// A driver, or wgpu before it, refuses a shader.
    #[error("the graphics card's driver refuses the shader of {name}: {message}")]
    Shader {
        /// Whose it is: a layer's effect, or a pass.
        name: String,
        /// The reason.
        message: String,
    },
    /// A drawing of strokes has what is drawn of frames alone: layers that paint samples, or passes.
    #[error("{0} is drawn by the CPU alone")]
    Unsupported(String),
    /// There is no memory left.
    #[error("the graphics card has no memory left")]
    Memory,
    /// The device went away: unplugged, reset by its driver, or taken by the system.
    #[error("the graphics card was lost: {0}")]
    Lost(String),
    /// wgpu refuses what it is asked to do: a fault of this program.
    #[error("the graphics card refuses to draw: {0}")]
    Refused(String),
    /// A pass shows samples as they are, or one value a pixel.
    #[error(
        "the render pass has {pass} samples, where {prepared} are prepared: it must have as many, or 1"
    )]
    PassSamples {
        /// The pass's.
        pass: u32,
        /// The frame's.
        prepared: u32,
    },
    /// There is no such pass.
    #[error("the render pass can't be as it is said to be: {message}")]
    PassFormat {
        /// What cannot be.
        message: String,
    },
    /// The drawing is invalid.
    #[error(transparent)]
    Draw(#[from] DrawError),
    /// The frame is invalid.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// No such number of samples.
    #[error(transparent)]
    Samples(#[from] SampleCountError),
}

impl From<wgpu::Error> for GpuError {
    fn from(error: wgpu::Error) -> Self {
        match error {
            wgpu::Error::OutOfMemory { .. } => Self::Memory,
            other => Self::Refused(other.to_string()),
        }
    }
}
