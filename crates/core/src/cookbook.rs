//! Recipes for common tasks. Each is a program that runs.
//!
//! Debug builds of a game compile its dependencies without optimization. Two lines each in its `Cargo.toml` (that of the
//! workspace) compile this crate and the one that checks tables with it:
//!
//! ```toml
//! [profile.dev.package.strew-core]
//! opt-level = 3
//!
//! [profile.dev.package.blake3]
//! opt-level = 3
//! ```
//!
//! | of a debug build, processor time | without | with | release |
//! |---|---|---|---|
//! | a chunk of 1,000 points | 0.54 ms | 0.03 ms | 0.02 ms |
//! | a chunk of 800 points that keep clear of another set | 1.3 ms | 0.07 ms | 0.06 ms |
//! | the first [`PointSet::blue`](crate::PointSet) | 36 ms | 1 ms | 1 ms |
//!
//! - [Chunks of a game world](#chunks-of-a-game-world)
//! - [Ids that persist](#ids-that-persist)
//! - [The nearest points](#the-nearest-points)
//! - [An exact number of points](#an-exact-number-of-points)
//! - [A least distance](#a-least-distance)
//! - [Attributes](#attributes)
//! - [Kinds that are evenly spread](#kinds-that-are-evenly-spread)
//! - [One kind alone](#one-kind-alone)
//! - [Joint kinds](#joint-kinds)
//! - [Layers that keep clear of each other](#layers-that-keep-clear-of-each-other)
//! - [Density that varies](#density-that-varies)
//! - [A polygon with holes](#a-polygon-with-holes)
//! - [Levels of detail](#levels-of-detail)
//! - [Pages](#pages)
//! - [Many points, fast](#many-points-fast)
//! - [Parallel filling](#parallel-filling)
//! - [Another noise profile](#another-noise-profile)
//!
//! # Chunks of a game world
//!
//! Ask for one chunk at a time, in any order and as often as you like. Chunks are half-open: neighbors
//! share no point and lose none, and a chunk is the same whenever it is loaded.
//!
#![cfg_attr(feature = "tables", doc = "```")]
#![cfg_attr(not(feature = "tables"), doc = "```ignore")]
//! use strew_core::PointSet;
//!
//! let trees = PointSet::blue().spacing(4.0)?.seed(7);
//! let (size, camera) = (64.0, [1000.0, -250.0]);
//! let [column, row] = camera.map(|v: f64| (v / size).floor() as i64);
//! for y in row - 1..=row + 1 {
//!     for x in column - 1..=column + 1 {
//!         for tree in trees.chunk(size, [x, y])? {
//!             let [tx, ty] = tree.at();
//!             // Offsets from the corner fit `f32`, however far out the chunk lies.
//!             let _near = [(tx - x as f64 * size) as f32, (ty - y as f64 * size) as f32];
//!         }
//!     }
//! }
//! # Ok::<(), strew_core::Error>(())
//! ```
//!
//! # Ids that persist
//!
//! An id is a lattice address. It finds its point again, so a saved game keeps ids and nothing else. Ids
//! belong to a set: another spacing, seed or table has other points under them.
//!
#![cfg_attr(feature = "tables", doc = "```")]
#![cfg_attr(not(feature = "tables"), doc = "```ignore")]
//! use std::collections::HashSet;
//! use strew_core::{PointId, PointSet};
//!
//! let trees = PointSet::blue().spacing(4.0)?.seed(7);
//! let mut felled: HashSet<PointId> = HashSet::new();
//! let tree = trees.nearest([10.0, 3.0], 1)?[0].member;
//! felled.insert(tree.id());
//!
//! let saved = tree.id().to_string();
//! let id: PointId = saved.parse()?;
//! assert_eq!(trees.point(id), Some(tree));
//! let standing = trees.chunk(64.0, [0, 0])?.into_iter().filter(|tree| !felled.contains(&tree.id()));
//! assert_eq!(standing.count(), trees.chunk(64.0, [0, 0])?.iter().len() - 1);
//! # Ok::<(), strew_core::Error>(())
//! ```
//!
//! # The nearest points
//!
#![cfg_attr(feature = "tables", doc = "```")]
#![cfg_attr(not(feature = "tables"), doc = "```ignore")]
//! use strew_core::PointSet;
//!
//! let wells = PointSet::blue().spacing(500.0)?.seed(3);
//! for near in wells.nearest([1234.5, -99.0], 3)? {
//!     println!("{} is {:.1} m away", near.member.id(), near.distance);
//! }
//! // All within a radius, at most 100.
//! let around = wells.around([1234.5, -99.0], 900.0, 100)?;
//! assert!(around.is_sorted_by_key(|near| near.distance));
//! # Ok::<(), strew_core::Error>(())
//! ```
//!
//! # An exact number of points
//!
//! The number of points in an area is known before any is made. To place a given number, let the spacing
//! follow from it.
//!
#![cfg_attr(feature = "tables", doc = "```")]
#![cfg_attr(not(feature = "tables"), doc = "```ignore")]
//! use strew_core::{Circle, PointSet};
//!
//! let samples = PointSet::blue().seed(5);
//! let disk = Circle::new([0.0, 0.0], 1.0)?;
//! let plan = samples.exactly(256, disk)?;
//! assert_eq!(plan.to_vec().len(), 256);
//! println!("mean spacing {}", plan.placement().spacing.get());
//! # Ok::<(), strew_core::Error>(())
//! ```
//!
//! # A least distance
//!
//! A distance that no two points undercut, anywhere. The profile `spaced` has more points for the same
//! distance than `blue`.
//!
#![cfg_attr(feature = "tables", doc = "```")]
#![cfg_attr(not(feature = "tables"), doc = "```ignore")]
//! use strew_core::PointSet;
//!
//! let posts = PointSet::blue().seed(1).min_distance(2.0)?;
//! let near = posts.nearest([50.0, 50.0], 2)?;
//! let [a, b] = [near[0].member.at(), near[1].member.at()];
//! assert!((a[0] - b[0]).hypot(a[1] - b[1]) >= 2.0);
//! # Ok::<(), strew_core::Error>(())
//! ```
//!
//! # Attributes
//!
//! A rotation, a scale, a kind and further random numbers for each point. They depend on the id and the
//! seed alone, so the same tree looks the same in every query.
//!
#![cfg_attr(feature = "tables", doc = "```")]
#![cfg_attr(not(feature = "tables"), doc = "```ignore")]
//! use strew_core::{PointSet, Variants};
//!
//! let trees = PointSet::blue().spacing(4.0)?.seed(7);
//! let kinds: Variants = "oak:3,birch:1".parse()?;
//! for tree in trees.chunk(64.0, [0, 0])? {
//!     let (angle, scale) = (tree.angle(), tree.scale(0.8..=1.2));
//!     let is_old = tree.uniform(1) < 0.1;
//!     let _ = (angle, scale, tree.variant(&kinds), is_old);
//! }
//! # Ok::<(), strew_core::Error>(())
//! ```
//!
//! As columns, for many points at once: [`Attributes`](crate::Attributes).
//!
//! # Kinds that are evenly spread
//!
//! Variants by chance clump and leave gaps. Of *even* kinds each is spread evenly among points that stay where they are.
//! The features `even-1-1`, `even-1-3`, `even-1-1-2` and `even-1-3-10` of this crate build in the labels for these
//! ratios, 50 kB each; those of other ratios are in tables of `strew forge mix --shares 1:4`, which
//! [`Table::from_bytes`](crate::Table::from_bytes) reads.
//!
#![cfg_attr(feature = "even-1-3", doc = "```")]
#![cfg_attr(not(feature = "even-1-3"), doc = "```ignore")]
//! use strew_core::{Kinds, PointSet, Region};
//!
//! let trees = PointSet::blue().spacing(2.0)?.seed(7);
//! let forest = trees.kinds(Kinds::even("birch:1,oak:3")?)?;
//! for tree in forest.chunk(64.0, [3, -2])? {
//!     let name = forest.kind_name(tree.id()).expect("each tree has a kind");
//!     println!("{name} at {:?}", tree.at());
//! }
//! // The number of each, without making any of them.
//! let counts = forest.kind_counts(Region::chunk(64.0, [3, -2])?)?;
//! let names = forest.named_kinds().expect("they have names").names();
//! for (name, count) in names.zip(counts) {
//!     println!("{count} × {name}");
//! }
//! # assert_eq!(forest.kind_counts(Region::new([0.0, 0.0], [2e3, 2e3])?)?, [249978, 750029]);
//! # Ok::<(), strew_core::Error>(())
//! ```
//!
//! # One kind alone
//!
//! The points of one kind are a set like any other, and chunks of birches and of oaks fit together. A renderer that draws
//! each kind with a mesh of its own requests them kind by kind.
//!
#![cfg_attr(feature = "even-1-3", doc = "```")]
#![cfg_attr(not(feature = "even-1-3"), doc = "```ignore")]
//! use strew_core::{Kinds, PointSet};
//!
//! let trees = PointSet::blue().spacing(2.0)?.seed(7);
//! let forest = trees.kinds(Kinds::even("birch:1,oak:3")?)?;
//! let birches = forest.clone().only("birch")?;
//! let tree = birches.nearest([10.0, 3.0], 1)?[0].member;
//! assert_eq!(forest.kind_name(tree.id()), Some("birch"));
//! // No two birches are nearer than this, and farther apart than any two trees.
//! assert!(birches.least_distance() > forest.least_distance());
//! # Ok::<(), strew_core::Error>(())
//! ```
//!
//! # Joint kinds
//!
//! Where each kind matters as much as all of them together, a table of its own has points that were moved for it: each
//! kind is nearly as blue as a set of its own. The features are `joint-1-1`, `joint-1-3`, `joint-1-1-2` and
//! `joint-1-3-10`, 0.19 MB each.
//!
#![cfg_attr(feature = "joint-1-3", doc = "```")]
#![cfg_attr(not(feature = "joint-1-3"), doc = "```ignore")]
//! use strew_core::{Kinds, PointSet};
//!
//! let kinds = Kinds::joint("red:1,green:3")?;
//! let cells = PointSet::blue().spacing(0.5)?.seed(3).kinds(kinds)?;
//! let red = cells.clone().only("red")?;
//! assert!(red.chunk(10.0, [0, 0])?.count() < cells.chunk(10.0, [0, 0])?.count());
//! # Ok::<(), strew_core::Error>(())
//! ```
//!
//! # Layers that keep clear of each other
//!
//! Rocks first, then trees at least 3 m from any rock, then grass that avoids both. Whether a point stays
//! is decided by its surroundings in the unbounded plane, so chunks agree.
//!
#![cfg_attr(feature = "tables", doc = "```")]
#![cfg_attr(not(feature = "tables"), doc = "```ignore")]
//! use strew_core::PointSet;
//!
//! let rocks = PointSet::blue().spacing(20.0)?.seed(1);
//! let trees = PointSet::blue().spacing(5.0)?.seed(2).clear_of(&rocks, 3.0)?;
//! let grass = PointSet::blue().spacing(1.0)?.seed(3).clear_of(&rocks, 1.5)?.clear_of(&trees, 0.6)?;
//! for blade in grass.chunk(8.0, [5, 5])? {
//!     assert!(rocks.nearest(blade.at(), 1)?[0].distance >= 1.5);
//! }
//! # Ok::<(), strew_core::Error>(())
//! ```
//!
//! # A polygon with holes
//!
#![cfg_attr(feature = "tables", doc = "```")]
#![cfg_attr(not(feature = "tables"), doc = "```ignore")]
//! use strew_core::{Area, Circle, PointSet, Polygon};
//!
//! let meadow = Polygon::new(&[[[0.0, 0.0], [90.0, 10.0], [60.0, 80.0]]])?;
//! let pond = Circle::new([50.0, 30.0], 8.0)?;
//! let dry = Area::from(meadow).without([pond.into()]);
//! let flowers = PointSet::blue().spacing(0.5)?.seed(4);
//! println!("{} flowers", flowers.count(dry.clone())?);
//! assert!(flowers.within(dry)?.iter().all(|flower| !pond.contains(flower.at())));
//! # Ok::<(), strew_core::Error>(())
//! ```
//!
//! # Levels of detail
//!
//! Each point has a rank in [0, 1). A level of detail has those of lowest rank, which are evenly spread. They stay where
//! they are among all points and levels nest, so nothing jumps when the level changes.
//!
#![cfg_attr(feature = "tables", doc = "```")]
#![cfg_attr(not(feature = "tables"), doc = "```ignore")]
//! use strew_core::PointSet;
//!
//! let near = PointSet::blue().spacing(4.0)?.seed(7);
//! let far = near.clone().lod(0.25)?;
//! for tree in far.chunk(256.0, [0, 0])? {
//!     assert_eq!(near.point(tree.id()), Some(tree));
//!     assert!(near.rank(tree.id()) < 0.25);
//! }
//! # Ok::<(), strew_core::Error>(())
//! ```
//!
//! # Density that varies
//!
//! A field says which share of the points stays at each place. Those that are left do not move.
//!
#![cfg_attr(feature = "tables", doc = "```")]
#![cfg_attr(not(feature = "tables"), doc = "```ignore")]
//! use strew_core::{PointSet, Region};
//!
//! // Trees thin out within 30 units of a road along the x axis.
//! let forest = PointSet::blue().spacing(4.0)?.seed(7);
//! let forest = forest.in_field(|[_, y]: [f64; 2]| (y.abs() / 30.0).min(1.0));
//! let near = forest.count(Region::new([0.0, 0.0], [200.0, 15.0])?)?;
//! let far = forest.count(Region::new([0.0, 30.0], [200.0, 45.0])?)?;
//! assert!(3 * near < far);
//! # Ok::<(), strew_core::Error>(())
//! ```
//!
//! # Pages
//!
//! Points have a fixed order, so a part of them is well defined. A cursor resumes without counting.
//!
#![cfg_attr(feature = "tables", doc = "```")]
#![cfg_attr(not(feature = "tables"), doc = "```ignore")]
//! use strew_core::{PointSet, Region};
//!
//! let set = PointSet::blue().seed(7);
//! let region = Region::new([0.0, 0.0], [100.0, 100.0])?;
//! let mut page = set.within(region)?.window(0, Some(1000));
//! let mut seen = 0;
//! loop {
//!     seen += page.to_vec().len();
//!     let Some(cursor) = page.next_cursor() else { break };
//!     page = set.resume(region, cursor)?.window(0, Some(1000));
//! }
//! assert_eq!(seen as u128, set.count(region)?);
//! # Ok::<(), strew_core::Error>(())
//! ```
//!
//! # Many points, fast
//!
//! Blocks in a buffer of your own are the fastest way: a billion points take half a second on one core.
//! Coordinates come as `f32` from the region's corner, as `f64`, or with ids.
//!
#![cfg_attr(feature = "tables", doc = "```")]
#![cfg_attr(not(feature = "tables"), doc = "```ignore")]
//! use strew_core::{PointSet, Region};
//!
//! let plan = PointSet::blue().within(Region::new([0.0, 0.0], [300.0, 300.0])?)?;
//! let (mut blocks, mut block) = (plan.blocks_f32(), vec![[0f32; 2]; 4096]);
//! loop {
//!     let filled = blocks.fill(&mut block);
//!     for [_x, _y] in &block[..filled] {}
//!     if filled < block.len() {
//!         break;
//!     }
//! }
//! # Ok::<(), strew_core::Error>(())
//! ```
//!
//! # Parallel filling
//!
//! Tiles are filled independently; this uses [rayon](https://docs.rs/rayon). One tile after another, the
//! points have the order of the plan, with any number of threads.
//!
#![cfg_attr(feature = "tables", doc = "```")]
#![cfg_attr(not(feature = "tables"), doc = "```ignore")]
//! use rayon::prelude::*;
//! use strew_core::{F32, PointSet, Region};
//!
//! let plan = PointSet::blue().within(Region::new([0.0, 0.0], [500.0, 500.0])?)?;
//! let tiles: Vec<_> = plan.tiles(1 << 16).collect();
//! let parts: Vec<Vec<[f32; 2]>> = tiles
//!     .par_iter()
//!     .map(|tile| {
//!         let mut part = vec![[0.0; 2]; 1 << 16];
//!         let filled = plan.tile_blocks::<F32>(tile).fill(&mut part);
//!         part.truncate(filled);
//!         part
//!     })
//!     .collect();
//! let points: usize = parts.iter().map(Vec::len).sum();
//! assert_eq!(points as u128, plan.count());
//! # Ok::<(), strew_core::Error>(())
//! ```
//!
//! # Another noise profile
//!
//! The crate embeds one table. Others lie in the repository's folder `tables`, and `strew forge` makes
//! more.
//!
//! ```no_run
//! use strew_core::{PointSet, Table};
//!
//! let file = std::fs::read("tables/spaced-5-sqrt3-over-2-m.strew")?;
//! let posts = PointSet::new(Table::from_bytes(&file)?).min_distance(2.0)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
