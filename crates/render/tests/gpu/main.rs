//! The GPU backend: on wgpu's `noop` device, which validates all and draws nothing, and on whatever Vulkan, Metal or
//! DirectX driver there is.

#![allow(clippy::print_stderr, reason = "what is skipped is said")]

mod agree;
mod brushes;
mod decals;
mod faults;
mod inputs;
mod meshes;
mod prelude;
mod samples;
mod scene;
mod small_device;
mod textures;
mod warm;
