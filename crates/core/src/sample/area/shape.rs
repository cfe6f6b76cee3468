//! Areas: boxes, circles and polygons, combined.

use alloc::{boxed::Box, vec::Vec};

use super::{
    Circle, Polygon, Region,
    steps::{State, Stepper, Steps},
};

/// A part of the plane.
///
/// ```
/// use strew_core::{Area, Circle, Polygon, Region};
///
/// let lake = Area::from(Circle::new([30.0, 30.0], 5.0)?);
/// let land = Area::from(Polygon::new(&[[[0.0, 0.0], [100.0, 0.0], [0.0, 100.0]]])?);
/// let dry = land.without([lake]);
/// assert!(dry.contains([10.0, 10.0]) && !dry.contains([30.0, 31.0]));
/// assert_eq!(dry.bounds(), Region::new([0.0, 0.0], [100.0, 100.0]).ok());
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Area {
    /// A half-open box.
    Region(Region),
    /// A disk without its rim.
    Circle(Circle),
    /// A polygon, holes included.
    Polygon(Polygon),
    /// The union of several areas.
    AnyOf(Vec<Area>),
    /// The intersection of several areas; the whole plane if there are none.
    AllOf(Vec<Area>),
    /// The complement of an area.
    Outside(Box<Area>),
}

impl From<Region> for Area {
    fn from(region: Region) -> Self {
        Self::Region(region)
    }
}

impl From<Circle> for Area {
    fn from(circle: Circle) -> Self {
        Self::Circle(circle)
    }
}

impl From<Polygon> for Area {
    fn from(polygon: Polygon) -> Self {
        Self::Polygon(polygon)
    }
}

impl Area {
    /// The union of areas: a single area itself, and the empty area if there are none.
    ///
    /// ```
    /// use strew_core::{Area, Circle, PointSet, Table};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let set = PointSet::new(table);
    /// let [a, b] = [Circle::new([0.0, 0.0], 4.0)?, Circle::new([30.0, 5.0], 4.0)?];
    /// let both = Area::any_of([a.into(), b.into()]);
    /// assert_eq!(set.count(both)?, set.count(a)? + set.count(b)?);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn any_of(areas: impl IntoIterator<Item = Self>) -> Self {
        let mut areas: Vec<Self> = areas.into_iter().collect();
        match areas.pop() {
            Some(only) if areas.is_empty() => only,
            last => {
                areas.extend(last);
                Self::AnyOf(areas)
            }
        }
    }

    /// The intersection of two areas.
    ///
    /// ```
    /// use strew_core::{Area, Circle, Region};
    ///
    /// let view = Area::from(Region::new([0.0, 0.0], [10.0, 10.0])?);
    /// let lamp = Area::from(Circle::new([0.0, 0.0], 5.0)?);
    /// let lit = view.and(lamp);
    /// assert!(lit.contains([1.0, 1.0]) && !lit.contains([-1.0, 1.0]));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        match (self, other) {
            // A box again, which is counted in closed form.
            (Self::Region(a), Self::Region(b)) if a.as_chunk().or(b.as_chunk()).is_none() => {
                Self::Region(a.and(b))
            }
            (Self::Region(inner), Self::Region(outer))
            | (Self::Region(outer), Self::Region(inner))
                if outer.as_chunk().is_none() && outer.surrounds(&inner) =>
            {
                Self::Region(inner)
            }
            (Self::AllOf(mut areas), other) => {
                areas.push(other);
                Self::AllOf(areas)
            }
            (area, other) => Self::AllOf([area, other].into()),
        }
    }

    /// This area without others.
    ///
    /// ```
    /// use strew_core::{Area, Circle, PointSet, Table};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let disk = |radius| Circle::new([0.0, 0.0], radius).map(Area::from);
    /// let ring = disk(9.0)?.without([disk(6.0)?]);
    /// let set = PointSet::new(table);
    /// assert_eq!(set.count(ring)?, set.count(disk(9.0)?)? - set.count(disk(6.0)?)?);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn without(self, excluded: impl IntoIterator<Item = Self>) -> Self {
        let excluded: Vec<Self> = excluded.into_iter().collect();
        if excluded.is_empty() {
            return self;
        }
        self.and(Self::Outside(Box::new(Self::any_of(excluded))))
    }

    /// Whether a place lies inside.
    ///
    /// ```
    /// use strew_core::{Area, Circle};
    ///
    /// let pond = Area::from(Circle::new([0.0, 0.0], 5.0)?);
    /// let shore = Area::Outside(Box::new(pond));
    /// assert!(shore.contains([9.0, 0.0]) && !shore.contains([0.0, 0.0]));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn contains(&self, p: [f64; 2]) -> bool {
        match self {
            Self::Region(region) => region.contains(p),
            Self::Circle(circle) => circle.contains(p),
            Self::Polygon(polygon) => polygon.contains(p),
            Self::AnyOf(areas) => areas.iter().any(|area| area.contains(p)),
            Self::AllOf(areas) => areas.iter().all(|area| area.contains(p)),
            Self::Outside(area) => !area.contains(p),
        }
    }

    /// A box around the area, or `None` if it is unbounded. The box of an area that is plainly empty is
    /// empty.
    ///
    /// ```
    /// use strew_core::{Area, Region};
    ///
    /// let field = Area::from(Region::new([0.0, 0.0], [4.0, 2.0])?);
    /// assert_eq!(field.bounds(), Some(Region::new([0.0, 0.0], [4.0, 2.0])?));
    /// // Points can be requested in bounded areas only.
    /// assert_eq!(Area::Outside(Box::new(field)).bounds(), None);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn bounds(&self) -> Option<Region> {
        let corners = |area: &Self| area.bounds().map(|b| (b.min(), b.max()));
        let region = |(min, max): ([f64; 2], [f64; 2])| {
            let reversed = (0..2).any(|i| max[i] < min[i]);
            Region::new(min, if reversed { min } else { max }).ok()
        };
        let join = |mut a: [f64; 2], b: [f64; 2], pick: fn(f64, f64) -> f64| {
            (0..2).for_each(|i| a[i] = pick(a[i], b[i]));
            a
        };
        match self {
            Self::Region(region) => Some(*region),
            Self::Circle(circle) => circle.bounds(),
            Self::Polygon(polygon) => Some(polygon.bounds()),
            Self::AnyOf(areas) => {
                let mut all = areas.iter().map(corners);
                let Some(first) = all.next() else {
                    return Region::new([0.0; 2], [0.0; 2]).ok();
                };
                let hull = all.try_fold(first?, |(min, max), corners| {
                    let (low, high) = corners?;
                    Some((join(min, low, f64::min), join(max, high, f64::max)))
                });
                region(hull?)
            }
            Self::AllOf(areas) => {
                let common = areas
                    .iter()
                    .filter_map(corners)
                    .reduce(|(min, max), (low, high)| {
                        (join(min, low, f64::max), join(max, high, f64::min))
                    });
                region(common?)
            }
            Self::Outside(_) => None,
        }
    }

    /// The number of vertices of all polygons in the area.
    ///
    /// ```
    /// use strew_core::{Area, Circle, Polygon};
    ///
    /// let field = Area::from(Polygon::new(&[[[0.0, 0.0], [9.0, 0.0], [0.0, 9.0]]])?);
    /// let pond = Area::from(Circle::new([2.0, 2.0], 1.0)?);
    /// assert_eq!(field.without([pond]).vertices(), 3);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn vertices(&self) -> usize {
        match self {
            Self::Region(_) | Self::Circle(_) => 0,
            Self::Polygon(polygon) => polygon.vertices(),
            Self::AnyOf(areas) | Self::AllOf(areas) => areas.iter().map(Self::vertices).sum(),
            Self::Outside(area) => area.vertices(),
        }
    }

    /// The number of boxes, circles and edges that points are compared with.
    pub(crate) fn parts(&self) -> usize {
        match self {
            Self::Region(_) | Self::Circle(_) => 1,
            Self::Polygon(polygon) => polygon.sides().count(),
            Self::AnyOf(areas) | Self::AllOf(areas) => areas.iter().map(Self::parts).sum(),
            Self::Outside(area) => area.parts(),
        }
    }

    /// The area for points of a box, its upper sides included, reduced to what matters there.
    pub(crate) fn focus(&self, within: &Region) -> Self {
        let near =
            |areas: &[Self]| -> Vec<Self> { areas.iter().map(|area| area.focus(within)).collect() };
        match self {
            Self::Region(region) => match region.within(within) {
                Some(state) => Self::constant(state),
                None => Self::Region(*region),
            },
            Self::Circle(circle) => match circle.within(within) {
                Some(state) => Self::constant(state),
                None => Self::Circle(*circle),
            },
            Self::Polygon(polygon) => match polygon.focus(within) {
                Ok(state) => Self::constant(state),
                Err(near) => Self::Polygon(near),
            },
            Self::AnyOf(areas) => {
                let mut near = near(areas);
                if near.iter().any(|area| area.is_constant(true)) {
                    return Self::constant(true);
                }
                near.retain(|area| !area.is_constant(false));
                Self::any_of(near)
            }
            Self::AllOf(areas) => {
                let mut near = near(areas);
                if near.iter().any(|area| area.is_constant(false)) {
                    return Self::constant(false);
                }
                near.retain(|area| !area.is_constant(true));
                if near.len() == 1 {
                    near.remove(0)
                } else {
                    Self::AllOf(near)
                }
            }
            Self::Outside(area) => match area.focus(within) {
                Self::AllOf(all) if all.is_empty() => Self::constant(false),
                Self::AnyOf(none) if none.is_empty() => Self::constant(true),
                near => Self::Outside(Box::new(near)),
            },
        }
    }

    /// Whether this is the whole plane or nothing, as areas are that were reduced to where all or none of them is.
    pub(crate) fn is_all_or_nothing(&self) -> Option<bool> {
        let is = |state| self.is_constant(state).then_some(state);
        is(true).or_else(|| is(false))
    }

    /// The whole plane or nothing.
    const fn constant(state: bool) -> Self {
        if state {
            Self::AllOf(Vec::new())
        } else {
            Self::AnyOf(Vec::new())
        }
    }

    /// Whether the area is plainly the whole plane, or plainly nothing.
    const fn is_constant(&self, state: bool) -> bool {
        match self {
            Self::AllOf(areas) => state && areas.is_empty(),
            Self::AnyOf(areas) => !state && areas.is_empty(),
            _ => false,
        }
    }

    /// The states of a strip y₀ ≤ y ≤ y₁ along x. After [`focus`](Self::focus) they hold within the box.
    pub(crate) fn steps(&self, strip: [f64; 2], stepper: &mut Stepper) {
        match self {
            Self::Region(region) => stepper.steps.set_region(region, strip),
            Self::Circle(circle) => circle.steps(strip, &mut stepper.steps),
            Self::Polygon(polygon) => polygon.steps(strip, stepper),
            Self::AnyOf(areas) => {
                stepper.steps = joined(areas, strip, stepper, State::Out, State::max);
            }
            Self::AllOf(areas) => {
                stepper.steps = joined(areas, strip, stepper, State::In, State::min);
            }
            Self::Outside(area) => {
                area.steps(strip, stepper);
                stepper.steps.invert();
            }
        }
    }
}

/// The steps of several areas together, joined by halves: n areas take O(n log n).
fn joined(
    areas: &[Area],
    strip: [f64; 2],
    stepper: &mut Stepper,
    empty: State,
    join: fn(State, State) -> State,
) -> Steps {
    match areas {
        [] => Steps::all(empty),
        [area] => {
            area.steps(strip, stepper);
            core::mem::take(&mut stepper.steps)
        }
        areas => {
            let (first, second) = areas.split_at(areas.len() / 2);
            let [first, second] =
                [first, second].map(|half| joined(half, strip, stepper, empty, join));
            first.join(&second, join)
        }
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use proptest::prelude::*;

    use super::*;

    fn coordinate() -> impl Strategy<Value = f64> {
        prop_oneof![(-4i8..=4).prop_map(f64::from), -4.0..4.0f64]
    }

    fn point() -> impl Strategy<Value = [f64; 2]> {
        [coordinate(), coordinate()]
    }

    fn any_area() -> impl Strategy<Value = Area> {
        let region = (point(), point()).prop_map(|(a, b)| {
            let pick = |f: fn(f64, f64) -> f64| [f(a[0], b[0]), f(a[1], b[1])];
            Area::from(Region::new(pick(f64::min), pick(f64::max)).expect("ordered"))
        });
        let circle = (point(), 0.1..4.0f64)
            .prop_map(|(center, radius)| Area::from(Circle::new(center, radius).expect("valid")));
        let ring = || {
            prop::collection::vec(point(), 3..7)
                .prop_filter("different", |ring| Polygon::new(&[ring]).is_ok())
        };
        let polygon = prop::collection::vec(ring(), 1..3)
            .prop_map(|rings| Area::from(Polygon::new(&rings).expect("valid")));
        prop_oneof![region, circle, polygon].prop_recursive(3, 8, 3, |inner| {
            prop_oneof![
                prop::collection::vec(inner.clone(), 1..3).prop_map(Area::any_of),
                (inner.clone(), inner.clone()).prop_map(|(a, b)| a.and(b)),
                (inner.clone(), inner).prop_map(|(a, b)| a.without([b])),
            ]
        })
    }

    proptest! {
        #[test]
        fn steps_and_focus_never_contradict_membership(
            area in any_area(), y0 in coordinate(), height in 0.0..2.0f64,
            ends in (coordinate(), coordinate()),
            probes in prop::collection::vec((-5.0..5.0f64, 0.0..=1.0f64), 40),
            exact in prop::collection::vec((coordinate(), 0.0..=1.0f64), 20),
        ) {
            let (strip, original) = ([y0, y0 + height], area.clone());
            let (left, right) = (ends.0.min(ends.1), ends.0.max(ends.1));
            let wide = Region::between([left - 1.0, y0 - 0.5], [right, strip[1]]);
            let within = Region::between([left, y0], [right, strip[1]]);
            let focused = area.focus(&wide).focus(&within);
            let everywhere = Region::between([f64::NEG_INFINITY, y0], [f64::INFINITY, strip[1]]);
            let whole = area.focus(&everywhere);
            let mut stepper = Stepper::default();
            for (area, looked_at) in [(&area, [-9.0, 9.0]), (&focused, [left, right]), (&whole, [-9.0, 9.0])] {
                area.steps(strip, &mut stepper);
                let steps = &stepper.steps;
                for &(x, part) in probes.iter().chain(&exact) {
                    let x = x.clamp(looked_at[0], looked_at[1]);
                    let p = [x, (y0 + part * height).min(strip[1])];
                    let inside = original.contains(p);
                    prop_assert_eq!(area.contains(p), inside, "{:?} {:?}", p, area);
                    // At a step itself both sides are undecided.
                    let nearby = [x - 1e-9, x + 1e-9].map(|x| steps.at(x));
                    if nearby == [State::In; 2] {
                        prop_assert!(inside, "{p:?} {area:?}");
                    } else if nearby == [State::Out; 2] {
                        prop_assert!(!inside, "{p:?} {area:?}");
                    }
                }
            }
            if let Some(bounds) = area.bounds() {
                for p in [[y0, y0], [y0, 0.5], [0.25, y0]] {
                    prop_assert!(!area.contains(p) || bounds.contains(p), "{p:?} {area:?}");
                }
            }
        }
    }

    #[test]
    fn combinations_of_nothing() {
        let nothing = Area::any_of(vec![]);
        assert!(!nothing.contains([0.0, 0.0]));
        assert_eq!(nothing.bounds().map(|b| b.is_empty()), Some(true));
        let square = Area::from(Region::new([0.0; 2], [1.0; 2]).expect("valid"));
        assert_eq!(square.clone().without(vec![]), square);
        assert_eq!(Area::Outside(Box::new(square)).bounds(), None);
    }
}
