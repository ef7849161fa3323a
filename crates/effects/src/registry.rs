//! The registry: which effects a program has. Registration is explicit.

use crate::effect::{AnyEffect, Erased, StrokeEffect};
use crate::mesh_effect::{MeshEffect, OnMeshes};
use std::collections::BTreeMap;
use std::marker::PhantomData;
use std::sync::Arc;

/// The effects of a program, by id.
#[derive(Clone, Default)]
pub struct Registry {
    effects: BTreeMap<&'static str, Arc<dyn AnyEffect>>,
}

/// Why an effect was not registered.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RegistryError {
    /// Two effects claim one id.
    #[error("there is already an effect `{id}`")]
    Duplicate {
        /// The id.
        id: &'static str,
    },
    /// An id is `vendor.name` in lower case.
    #[error("the effect's id `{id}` is not `vendor.name` in lower case letters, digits and dashes")]
    Id {
        /// The id.
        id: &'static str,
    },
}

impl Registry {
    /// No effects.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds an effect.
    ///
    /// # Errors
    ///
    /// When there is one of that id, or the id is not `vendor.name`.
    pub fn register<E: StrokeEffect>(&mut self) -> Result<(), RegistryError> {
        let word = |part: &str| {
            !part.is_empty()
                && part
                    .bytes()
                    .all(|b| b.is_ascii_lowercase() || b.is_ascii_digit() || b == b'-')
        };
        if !E::ID
            .split_once('.')
            .is_some_and(|(vendor, name)| word(vendor) && word(name))
        {
            return Err(RegistryError::Id { id: E::ID });
        }
        if self.effects.contains_key(E::ID) {
            return Err(RegistryError::Duplicate { id: E::ID });
        }
        self.effects
            .insert(E::ID, Arc::new(Erased::<E>(PhantomData)));
        Ok(())
    }

    /// Adds an effect that paints meshes.
    ///
    /// # Errors
    ///
    /// When there is an effect of that id, or the id is not `vendor.name`.
    pub fn register_mesh<E: MeshEffect>(&mut self) -> Result<(), RegistryError> {
        self.register::<OnMeshes<E>>()
    }

    /// The effect of this id.
    #[must_use]
    pub fn get(&self, id: &str) -> Option<&dyn AnyEffect> {
        self.effects.get(id).map(AsRef::as_ref)
    }

    /// All effects, sorted by id.
    pub fn iter(&self) -> impl Iterator<Item = &dyn AnyEffect> {
        self.effects.values().map(AsRef::as_ref)
    }
}
