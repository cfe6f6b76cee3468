//! The methods that lay a set into the world, the same in the plane and in space.

/// The methods that change the placement of a set, which has the fields `lattice` and `has_own_warp`. In the examples,
/// `$make` makes a set and `$origin` is the place of a chunk.
macro_rules! placing {
    ($Set:ty, $Table:ty, power: $power:literal, $dimensions:literal, $make:literal, $origin:literal) => {
        impl $Set {
            #[doc = concat!("Sets the mean spacing, in world units: density^−", $power, ".")]
            ///
            /// # Errors
            /// [`ErrorKind::Spacing`](crate::ErrorKind::Spacing) outside 10⁻¹⁰⁰ to 10¹⁰⁰.
            ///
            /// ```
            /// use strew_core::ErrorKind;
            ///
            #[doc = concat!("# let set = ", $make, ";")]
            /// // The points of a box with sides of 100 at spacing 2.
            #[doc = concat!("let count = set.clone().spacing(2.0)?.chunk(100.0, ", $origin, ")?.count();")]
            #[doc = concat!("let expected = 50f64.powi(", stringify!($dimensions), ");")]
            /// assert!((count as f64 / expected - 1.0).abs() < 0.01);
            /// assert_eq!(set.spacing(0.0).unwrap_err().kind(), ErrorKind::Spacing);
            /// # Ok::<(), strew_core::Error>(())
            /// ```
            pub fn spacing(self, spacing: f64) -> Result<Self, Error> {
                Ok(self.at_spacing(Spacing::new(spacing)?))
            }

            #[doc = concat!("Sets the density, in points per world unit to the power of ", stringify!($dimensions), ".")]
            ///
            /// # Errors
            /// [`ErrorKind::Density`](crate::ErrorKind::Density) outside 10⁻²⁰⁰ to 10²⁰⁰.
            pub fn density(self, density: f64) -> Result<Self, Error> {
                Ok(self.at_spacing(Spacing::of_density(density, $dimensions)?))
            }

            /// Sets the spacing at which no two points are nearer than `distance` world units, for the warp that
            /// the set has; so choose seed and warp first. It holds for reported `f64` coordinates out to
            /// [`LeastDistance::RANGE`](crate::LeastDistance::RANGE) times the distance from the origin.
            ///
            /// # Errors
            /// As [`LeastDistance::spacing_for`](crate::LeastDistance::spacing_for).
            ///
            /// ```
            /// use strew_core::ErrorKind;
            ///
            #[doc = concat!("# let set = ", $make, ";")]
            /// let set = set.seed(7).min_distance(2.0)?;
            /// assert!(set.least_distance() >= 2.0);
            /// assert_eq!(set.min_distance(-1.0).unwrap_err().kind(), ErrorKind::Distance);
            /// # Ok::<(), strew_core::Error>(())
            /// ```
            pub fn min_distance(self, distance: f64) -> Result<Self, Error> {
                let least = self.table_distance();
                let spacing = least.spacing_for(distance, self.placement().warp)?;
                Ok(self.at_spacing(spacing))
            }

            fn at_spacing(self, spacing: Spacing) -> Self {
                self.replaced(|placement| Placement {
                    spacing,
                    ..placement
                })
            }

            /// Sets the seed: the origin in the pattern, a symmetry by which the table is turned, and a warp. Seed 0 is
            /// the plain pattern, whose large windows show its quasi-periodic structure; every other seed warps the
            /// set, unless [`warp`](Self::warp) sets another strength.
            ///
            /// ```
            #[doc = concat!("# let set = ", $make, ";")]
            #[doc = concat!("let first = |seed| set.clone().seed(seed).chunk(8.0, ", $origin, ").map(|plan| plan.to_vec()[0]);")]
            /// assert_eq!(first(7)?, first(7)?);
            /// assert_ne!(first(7)?, first(8)?);
            /// # Ok::<(), strew_core::Error>(())
            /// ```
            #[must_use]
            pub fn seed(self, seed: u64) -> Self {
                let own = self.has_own_warp.then(|| self.placement().warp);
                let seed = Seed(seed);
                self.replaced(|placement| Placement {
                    seed,
                    warp: own.unwrap_or_else(|| Placement::default_warp(seed)),
                    ..placement
                })
            }

            /// Sets the strength of the warp, from 0 (off) to 2; 1 is the default of seeds other than 0.
            ///
            /// # Errors
            /// [`ErrorKind::Warp`](crate::ErrorKind::Warp) outside that range.
            ///
            /// ```
            #[doc = concat!("# let set = ", $make, ".seed(7);")]
            /// // Without warp, distances are guaranteed in full.
            /// assert!(set.clone().warp(0.0)?.least_distance() > set.least_distance());
            /// # Ok::<(), strew_core::Error>(())
            /// ```
            pub fn warp(mut self, strength: f64) -> Result<Self, Error> {
                let warp = Warp::new(strength)?;
                self.has_own_warp = true;
                Ok(self.replaced(|placement| placement.with_warp(warp)))
            }

            /// Keeps a share of the points, from 10⁻⁶ to 1: those of the lowest [ranks](Self::rank). Shares nest: a
            /// smaller one keeps a part of what a larger one keeps.
            ///
            /// # Errors
            /// [`ErrorKind::Keep`](crate::ErrorKind::Keep) outside that range.
            ///
            /// ```
            #[doc = concat!("# let all = ", $make, ".seed(7);")]
            #[doc = concat!("let half = all.clone().keep(0.5)?.chunk(20.0, ", $origin, ")?;")]
            /// for point in half.to_vec() {
            ///     assert!(all.rank(point.id) < 0.5 && all.point(point.id).is_some());
            /// }
            /// # Ok::<(), strew_core::Error>(())
            /// ```
            pub fn keep(self, share: f64) -> Result<Self, Error> {
                let keep = Keep::new(share)?;
                Ok(self.replaced(|placement| placement.with_keep(keep)))
            }

            /// Sets the number of steps by which points settle in a [field](Self::in_field) and where not all are
            /// [kept](Self::keep), 0 to 4; see [`Settle`](crate::Settle). Sets with all points take at most one, a smaller
            /// one; in space they stay.
            ///
            /// # Errors
            /// [`ErrorKind::Settle`](crate::ErrorKind::Settle) above 4.
            ///
            /// ```
            #[doc = concat!("let half = ", $make, ".seed(7).keep(0.5)?;")]
            /// let still = half.clone().settle(0)?;
            /// // The same points, some of them elsewhere.
            #[doc = concat!("let settled = half.chunk(20.0, ", $origin, ")?.to_vec();")]
            /// assert!(settled.iter().any(|point| still.point(point.id).map(|same| same.at()) != Some(point.at())));
            /// # Ok::<(), strew_core::Error>(())
            /// ```
            pub fn settle(self, steps: u32) -> Result<Self, Error> {
                let settle = crate::Settle::new(steps)?;
                Ok(self.replaced(|placement| placement.with_settle(settle)))
            }

            /// Sets the level of detail: the part of the set's points that answers have, those of lowest rank at each
            /// place. The others still exist: the points of a level are where they are among all points, so levels
            /// nest, and other sets keep clear of all of them. By default answers have all points.
            ///
            /// # Errors
            /// [`ErrorKind::Keep`](crate::ErrorKind::Keep) outside 10⁻⁶ to 1.
            ///
            /// ```
            #[doc = concat!("# let all = ", $make, ".seed(7).keep(0.5)?;")]
            /// let far = all.clone().lod(0.25)?;
            #[doc = concat!("for point in far.chunk(20.0, ", $origin, ")?.to_vec() {")]
            ///     assert_eq!(all.point(point.id).map(|same| same.at()), Some(point.at()));
            /// }
            /// # Ok::<(), strew_core::Error>(())
            /// ```
            pub fn lod(self, part: f64) -> Result<Self, Error> {
                let lod = Keep::new(part)?;
                Ok(self.replaced(|placement| placement.with_lod(lod)))
            }

            /// Sets spacing, seed, warp and share at once.
            #[must_use]
            pub fn placed(mut self, placement: Placement) -> Self {
                self.has_own_warp = true;
                self.replaced(|_| placement)
            }

            fn replaced(mut self, change: impl FnOnce(Placement) -> Placement) -> Self {
                let placement = change(self.lattice.placement);
                if placement != self.lattice.placement {
                    self.lattice = self.lattice.replaced(placement);
                }
                self
            }

            /// The table.
            #[must_use]
            pub const fn table(&self) -> &$Table {
                &self.lattice.table
            }

            /// Spacing, seed, warp and share.
            #[must_use]
            pub const fn placement(&self) -> Placement {
                self.lattice.placement
            }
        }
    };
}

pub(crate) use placing;
