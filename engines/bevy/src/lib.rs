//! Scattered points of [Strew](strew_core) as entities of [Bevy](https://bevy.org), around a camera.
//!
//! A [`Scatter`] is a point set laid on the ground. The plugin keeps the chunks around each [`ScatterAnchor`] loaded:
//! their points are made in tasks, become entities a few in each frame, and go again beyond the radius. Far chunks
//! have fewer points, always some of those that they have from near. What was [removed](Removed) stays away,
//! however often its chunk is loaded.
//!
//! ```
//! use bevy::prelude::*;
//! use strew_bevy::{Level, Scatter, ScatterAnchor, ScatterPlugin, ScatterPoint};
//! use strew_core::PointSet;
//!
//! fn plant(mut commands: Commands) -> Result {
//!     let trees = PointSet::blue().spacing(4.0)?.seed(7);
//!     // All trees within 100 m, a quarter of them out to 300 m.
//!     let levels = [Level::new(100.0, 1.0), Level::new(300.0, 0.25)];
//!     commands.spawn(Scatter::new(trees, 32.0, levels)?);
//!     commands.spawn((ScatterAnchor, Transform::from_xyz(10.0, 2.0, -40.0)));
//!     Ok(())
//! }
//!
//! /// Dresses each new tree: in a game with a mesh and a material.
//! fn dress(mut trees: Query<(&ScatterPoint, &mut Transform), Added<ScatterPoint>>) {
//!     for (tree, mut transform) in &mut trees {
//!         transform.rotate_y(tree.member.angle() as f32);
//!         transform.scale *= tree.member.scale(0.8..=1.2) as f32;
//!     }
//! }
//!
//! let mut app = App::new();
//! // A game has `DefaultPlugins` in place of the first two.
//! app.add_plugins((MinimalPlugins, TransformPlugin, ScatterPlugin));
//! app.add_systems(Startup, plant).add_systems(PostUpdate, dress);
//! app.update();
//! ```
//!
//! Entities hang below each other: the scatter, its [chunks](ScatterChunk), their [points](ScatterPoint). Where a point
//! needs no entity of its own, [`Scatter::as_lists`] leaves a [`ScatterPoints`] at each chunk instead, for instanced
//! drawing. The crate draws nothing and needs no renderer. With one, each of the three needs a `Visibility`, or what is
//! below is not drawn: `app.register_required_components::<Scatter, Visibility>()`, and so for `ScatterChunk` and
//! `ScatterPoint`.
//!
//! The files: `chunk` has the components of chunks and points, `scatter` those that a game sets, `removed` the removals.
//! In each frame `around` finds the chunks to load, `make` makes their points, and `fill` turns these into entities.

mod around;
mod chunk;
mod fill;
mod make;
mod removed;
mod scatter;

use bevy_app::{App, Plugin, Update};
use bevy_ecs::prelude::*;

use chunk::Spent;

pub use chunk::{LevelChanged, ScatterChunk, ScatterPoint, ScatterPoints};
pub use removed::Removed;
pub use scatter::{Ground, Level, Scatter, ScatterAnchor, ScatterBudget, ScatterError};

/// Keeps the chunks around anchors loaded. It needs the `TaskPoolPlugin` and the `TransformPlugin` of Bevy, which
/// are among its default plugins.
///
/// ```
/// use bevy_app::{App, TaskPoolPlugin};
/// use strew_bevy::{Removed, ScatterPlugin};
///
/// let mut app = App::new();
/// app.add_plugins((TaskPoolPlugin::default(), ScatterPlugin));
/// assert!(app.world().contains_resource::<Removed>());
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct ScatterPlugin;

/// The systems of the plugin, in `Update`.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ScatterSystems;

impl Plugin for ScatterPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Removed>()
            .init_resource::<ScatterBudget>()
            .init_resource::<Spent>()
            .add_message::<LevelChanged>()
            .add_systems(
                Update,
                (
                    around::find_chunks,
                    make::begin,
                    make::finish,
                    removed::apply,
                    fill::fill,
                )
                    .chain()
                    .in_set(ScatterSystems),
            );
    }
}
