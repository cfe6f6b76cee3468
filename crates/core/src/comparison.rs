//! Strew compared with other ways to place points.
//!
//! | | here | Poisson-disk libraries | Wang tiles | jittered grids |
//! |---|---|---|---|---|
//! | a far-away region alone | yes | no: all of a region at once | yes | yes |
//! | unbounded | yes | no | yes, from few tiles that repeat | yes |
//! | neighboring regions fit | exactly | no | yes | yes |
//! | exact count before the first point | yes | no | no | without jitter across cells, yes |
//! | a point by id, the nearest points | yes | if all points are kept | by building it on top | yes |
//! | exactly N points; at least d apart | yes; yes | no; yes | no; yes | no; no |
//! | dimensions | 2 | 2 and more | 2 | any |
//! | memory | a table: 0.2 MB, the smallest 35 kB | all points | megabytes of tiles | none |
//!
//! # Noise
//!
//! Windows of 300 × 300 mean spacings. *Low power* is the mean power below ν = 0.5 (white noise: 1), δ_min
//! and δ_avg are the least and the mean distance to the nearest neighbor in units of the hexagonal lattice,
//! the anisotropy is 0 dB for a set without preferred directions, and the peak is that of the tallest
//! single mode (`cargo run --release -p strew-forge --example study -- comparison`):
//!
//! | | low power | δ_min | δ_avg | anisotropy, dB | peak |
//! |---|---|---|---|---|---|
//! | [`PointSet::blue`](crate::PointSet::blue), seed 7 | 3.4e-6 | 0.614 | 0.813 | 0.00 | 22 |
//! | [`fast_poisson`](https://docs.rs/fast_poisson) | 0.080 | 0.738 | 0.798 | −0.02 | 19 |
//! | jittered grid | 0.32 | 0.024 | 0.585 | −0.06 | 14 |
//! | a toroidal tile of 5,041 blue points, repeated | 8.3e-6 | 0.666 | 0.812 | 2.84 | 41 |
//! | random points | 1.0 | 0.001 | 0.465 | −0.04 | 18 |
//!
//! # Speed
//!
//! On one core, into a reused block (`cargo bench -p strew-core --bench others`; ratios hold on other
//! machines, absolute times do not):
//!
//! | | points per second | time of a box here ÷ time of this |
//! |---|---|---|
//! | a box here, `f32` | 1.8 G | 1 |
//! | the published AA row scanner, our implementation | 0.38 G | 0.21 |
//! | a hashed jittered grid | 0.45 G | 0.25 |
//! | a prepared tile with a spatial grid, repeated | 1.6 G | 0.9 |
//! | `fast_poisson` | 48 k | 0.00003 |
//!
//! # What others are better at
//!
//! **Poisson-disk libraries** ([`fast_poisson`](https://docs.rs/fast_poisson),
//! `scipy.stats.qmc.PoissonDisk`) work in three and more dimensions, and their disks are maximal: no
//! further point fits in. A radius that varies is a parameter of some. Choose them for a small, bounded
//! domain whose points are made once.
//!
//! **Wang tiles** (Cohen, Shade, Hiller, Deussen 2003; Kopf, Cohen-Or, Deussen, Lischinski 2006) hold
//! whatever is put into them: points of any kind, textures, hand-placed scenes. Their recursive form varies
//! the density. The price is the making of the tiles, their memory, and noise that shows the tiles' size.
//!
//! **Jittered grids** need one hash a point and a few lines of code, in any dimension. Choose them where
//! clumps and gaps do not matter.
//!
//! **A repeated tile** is as fast and needs no mathematics. Its spectrum consists of the peaks of the
//! repetition, which show as soon as a few tiles are in view.
