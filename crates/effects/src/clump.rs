//! The clump: size profile, normal and basic colour of a strand, shared by all layers
//! (`shaders/clump.wgsl`).

effects::effect!("clump");
