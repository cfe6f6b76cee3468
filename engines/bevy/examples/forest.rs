//! A camera that walks through a forest, and what is loaded around it, in a terminal: `cargo run --example forest`.

use bevy::prelude::*;
use strew_bevy::{
    Level, LevelChanged, Removed, Scatter, ScatterAnchor, ScatterChunk, ScatterPlugin, ScatterPoint,
};
use strew_core::{Kinds, PointSet};

fn plant(mut commands: Commands<'_, '_>) -> Result {
    let kinds = Kinds::even("birch:1,oak:3")?;
    let trees = PointSet::blue().spacing(4.0)?.seed(7).kinds(kinds)?;
    let levels = [Level::new(60.0, 1.0), Level::new(200.0, 0.25)];
    commands.spawn(Scatter::new(trees, 32.0, levels)?);
    commands.spawn(ScatterAnchor);
    Ok(())
}

/// Fells the first birch of each chunk that comes near.
fn fell(
    mut changes: MessageReader<'_, '_, LevelChanged>,
    chunks: Query<'_, '_, &Children>,
    trees: Query<'_, '_, &ScatterPoint>,
    mut removed: ResMut<'_, Removed>,
) {
    for change in changes.read().filter(|change| change.to == 0) {
        let Ok(children) = chunks.get(change.chunk) else {
            continue;
        };
        let mut trees = trees.iter_many(children).flatten();
        if let Some(birch) = trees.find(|tree| tree.kind == Some(0)) {
            removed.remove(change.scatter, birch.member.id());
        }
    }
}

fn main() {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin, ScatterPlugin));
    app.add_systems(Startup, plant)
        .add_systems(PostUpdate, fell);
    app.update();
    for step in 0..5 {
        let world = app.world_mut();
        let mut anchors = world.query_filtered::<&mut Transform, With<ScatterAnchor>>();
        for mut anchor in anchors.iter_mut(world) {
            anchor.translation.x = 100.0 * step as f32;
        }
        // A game draws these frames, and waits for none of them. In the second one the place has reached the scatter.
        app.update();
        loop {
            app.update();
            let world = app.world_mut();
            let mut chunks = world.query::<&ScatterChunk>();
            if chunks.iter(world).all(|chunk| chunk.level.is_some()) {
                break;
            }
            std::thread::yield_now();
        }
        let world = app.world_mut();
        let chunks = world.query::<&ScatterChunk>().iter(world).count();
        let trees = world.query::<&ScatterPoint>().iter(world).count();
        println!("x = {}: {trees} trees in {chunks} chunks", 100 * step);
    }
}
