//! Chunks and points around anchors, compared with the point set itself, without a window.

mod game;

use std::collections::{HashMap, HashSet};

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::prelude::{GlobalTransform, Transform};
use game::{CHUNK, Game, forest, scatter};
use strew_bevy::{
    Ground, Level, LevelChanged, Removed, Scatter, ScatterAnchor, ScatterChunk, ScatterPoint,
    ScatterPoints,
};
use strew_core::PointId;

const PATH: [[f64; 2]; 6] = [
    [3.0, -5.0],
    [11.0, -5.0],
    [40.0, 20.0],
    [150.0, -90.0],
    [-3000.5, 12.25],
    [3.0, -5.0],
];

#[test]
fn entities_along_a_path_are_the_points_of_the_set() {
    let mut game = Game::new(scatter());
    for place in PATH {
        game.wait_at(place);
    }
    // Each change begins where the one before it ended.
    let mut last: HashMap<Entity, usize> = HashMap::new();
    for change in &game.changes {
        assert_eq!(change.scatter, game.scatter);
        assert_eq!(last.insert(change.chunk, change.to), change.from);
    }
    let is_nearer = |change: &LevelChanged| change.from.is_some_and(|from| from > change.to);
    let is_farther = |change: &LevelChanged| change.from.is_some_and(|from| from < change.to);
    assert!(game.changes.iter().any(is_nearer) && game.changes.iter().any(is_farther));
    // Without an anchor nothing stays.
    let anchor = game.anchor;
    assert!(game.app.world_mut().despawn(anchor));
    game.until("nothing is left", |game| {
        game.all::<ScatterChunk>().is_empty()
    });
    assert!(game.all::<ScatterPoint>().is_empty());
    assert_eq!(game.all::<Transform>().len(), 1, "the scatter itself");
}

#[test]
fn points_keep_their_entities_from_level_to_level() {
    let mut game = Game::new(scatter());
    game.wait_at([8.0, 8.0]);
    let near: HashMap<PointId, Entity> = game
        .all::<ScatterPoint>()
        .into_iter()
        .map(|(entity, point)| (point.member.id(), entity))
        .collect();
    game.wait_at([48.0, 8.0]);
    let chunks: HashMap<Entity, ScatterChunk> = game.all::<ScatterChunk>().into_iter().collect();
    let (mut stayed, mut all) = (0, 0);
    for (entity, point) in game.all::<ScatterPoint>() {
        let parent = game.app.world().get::<ChildOf>(entity).expect("a chunk");
        let chunk = chunks[&parent.parent()];
        if chunk.at == [0, 0] {
            assert!(chunk.level > Some(0));
            all += 1;
            stayed += usize::from(near.get(&point.member.id()) == Some(&entity));
        }
    }
    // The chunk had all of its points and has a part of them, none of which was made anew.
    assert!(all > 0 && stayed == all, "{stayed} of {all}");
}

#[test]
fn what_was_removed_stays_away_until_it_is_restored() {
    let mut game = Game::new(scatter());
    game.wait_at([8.0, 8.0]);
    let near = forest().nearest([8.0, 8.0], 5).expect("near");
    let felled: Vec<PointId> = near.iter().map(|tree| tree.member.id()).collect();
    let scatter = game.scatter;
    let mut removed = game.app.world_mut().resource_mut::<Removed>();
    removed.extend(scatter, felled.iter().copied());
    game.until("they are gone", |game| game.is_right([8.0, 8.0]));
    for place in [[900.0, 0.0], [8.0, 8.0]] {
        game.wait_at(place);
    }
    let shown = |game: &mut Game| -> HashSet<PointId> {
        let all = game.all::<ScatterPoint>().into_iter();
        all.map(|(_, point)| point.member.id()).collect()
    };
    assert!(shown(&mut game).is_disjoint(&felled.iter().copied().collect()));
    let mut removed = game.app.world_mut().resource_mut::<Removed>();
    assert_eq!(removed.ids(scatter).count(), 5);
    let id = felled[0];
    assert!(removed.restore(scatter, id) && !removed.restore(scatter, id));
    game.until("one is back", |game| shown(game).contains(&id));
    assert!(game.is_right([8.0, 8.0]));
}

#[test]
fn lists_have_the_same_points_with_places_and_kinds() {
    let hills = |[x, y]: [f64; 2]| (0.1 * x - 0.2 * y) as f32;
    let mut game = Game::new(scatter().as_lists().at_height(hills));
    for place in PATH {
        game.wait_at(place);
    }
    assert!(game.all::<ScatterPoint>().is_empty());
    let forest = forest();
    let felled = forest.nearest([3.0, -5.0], 1).expect("near")[0].member.id();
    let scatter = game.scatter;
    let mut removed = game.app.world_mut().resource_mut::<Removed>();
    removed.remove(scatter, felled);
    game.until("one is gone", |game| game.is_right([3.0, -5.0]));
    let mut seen = 0;
    for (chunk, ScatterPoints(points)) in game.all::<ScatterPoints>() {
        let at = game.app.world().get::<GlobalTransform>(chunk);
        let corner = at.expect("a place").translation();
        for point in points {
            let ScatterPoint { member, offset, .. } = point;
            assert_eq!(point.kind, forest.kind_of(member.id()));
            let [x, y] = member.at();
            let place = Vec3::new(x as f32, hills([x, y]), -y as f32);
            assert!((corner + offset).distance(place) < 1e-4);
            seen += 1;
        }
    }
    assert!(seen > 500, "{seen}");
}

#[test]
fn entities_lie_where_their_points_are_in_two_dimensions_too() {
    for ground in [Ground::Xz, Ground::Xy] {
        let levels = [Level::new(20.0, 1.0)];
        let scatter = Scatter::new(forest(), CHUNK, levels).expect("valid");
        let mut game = Game::new(scatter.on(ground));
        game.move_to(Vec3::new(4.0, 4.0, -4.0));
        game.until("some points", |game| game.all::<ScatterPoint>().len() > 100);
        // Places in the world follow at the end of the frame in which entities come.
        game.app.update();
        for (entity, ScatterPoint { member, .. }) in game.all::<ScatterPoint>() {
            let at = game.app.world().get::<GlobalTransform>(entity);
            let [x, y] = member.at().map(|v| v as f32);
            let place = match ground {
                Ground::Xz => Vec3::new(x, 0.0, -y),
                Ground::Xy => Vec3::new(x, y, 0.0),
            };
            assert!(at.expect("a place").translation().distance(place) < 1e-4);
        }
    }
}

#[test]
fn another_scatter_replaces_the_chunks_and_its_end_takes_them_along() {
    let mut game = Game::new(scatter());
    game.wait_at([8.0, 8.0]);
    let chunks = |game: &mut Game| -> HashSet<Entity> {
        let all = game.all::<ScatterChunk>().into_iter();
        all.map(|(chunk, _)| chunk).collect()
    };
    let old = chunks(&mut game);
    let entity = game.scatter;
    game.app.world_mut().entity_mut(entity).insert(scatter());
    game.app.update();
    game.until("other chunks", |game| game.is_right([8.0, 8.0]));
    assert!(chunks(&mut game).is_disjoint(&old));
    assert!(game.app.world_mut().despawn(entity));
    assert!(chunks(&mut game).is_empty() && game.all::<ScatterPoint>().is_empty());
}

#[test]
fn two_anchors_have_the_chunks_of_both() {
    let mut game = Game::new(scatter());
    let other = Transform::from_xyz(300.0, 0.0, 0.0);
    game.app.world_mut().spawn((ScatterAnchor, other));
    game.move_to(Vec3::ZERO);
    let levels = |game: &mut Game| -> HashMap<[i64; 2], Option<usize>> {
        let all = game.all::<ScatterChunk>().into_iter();
        all.map(|(_, chunk)| (chunk.at, chunk.level)).collect()
    };
    game.until("both", |game| {
        let levels = levels(game);
        let is_nearest = |at| levels.get(&at) == Some(&Some(0));
        is_nearest([0, 0]) && is_nearest([18, 0]) && levels.values().all(Option::is_some)
    });
    assert!(!levels(&mut game).contains_key(&[9, 0]));
}
