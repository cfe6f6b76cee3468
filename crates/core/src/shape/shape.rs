//! Shapes: boxes, balls and what polygons bound, combined.

use alloc::{boxed::Box, vec::Vec};

use super::{
    Ball, Chunk, Polygon, Region,
    steps::{State, Stepper, Steps},
};

/// A part of the plane ([`Area`]) or of space ([`Volume`](crate::space::Volume)).
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
pub enum Shape<const D: usize, P> {
    /// A half-open box.
    Region(Region<D>),
    /// A disk without its rim, or a ball without its surface.
    Ball(Ball<D>),
    /// A [`Polygon`] or a [`Prism`](crate::space::Prism).
    Outlined(P),
    /// The union of several shapes.
    AnyOf(Vec<Self>),
    /// The intersection of several shapes; everything if there are none.
    AllOf(Vec<Self>),
    /// The complement of a shape.
    Outside(Box<Self>),
}

/// A part of the plane: boxes, circles and polygons, combined.
pub type Area = Shape<2, Polygon>;

/// A shape with an outline of polygons: a [`Polygon`] in the plane, a [`Prism`](crate::space::Prism) in space.
pub trait Outlined<const D: usize>: Clone {
    /// Whether a place lies inside.
    fn contains(&self, p: [f64; D]) -> bool;
    /// A box around it.
    fn bounds(&self) -> Region<D>;
    /// The number of vertices.
    fn vertices(&self) -> usize;
    /// Looks at the points of a box, its upper sides included: `Ok` if all of them are inside, or all outside; else the
    /// part of the outline that decides.
    fn focus(&self, within: &Region<D>) -> Result<bool, Self>;
}

impl Outlined<2> for Polygon {
    fn contains(&self, p: [f64; 2]) -> bool {
        self.contains(p)
    }

    fn bounds(&self) -> Region {
        self.bounds()
    }

    fn vertices(&self) -> usize {
        self.vertices()
    }

    fn focus(&self, within: &Region) -> Result<bool, Self> {
        self.focus(within)
    }
}

impl<const D: usize, P> From<Region<D>> for Shape<D, P> {
    fn from(region: Region<D>) -> Self {
        Self::Region(region)
    }
}

impl<const D: usize, P> From<Ball<D>> for Shape<D, P> {
    fn from(ball: Ball<D>) -> Self {
        Self::Ball(ball)
    }
}

impl From<Polygon> for Area {
    fn from(polygon: Polygon) -> Self {
        Self::Outlined(polygon)
    }
}

impl<const D: usize, P: Outlined<D>> Shape<D, P> {
    /// The union of shapes: a single one itself, and nothing if there are none.
    #[must_use]
    pub fn any_of(shapes: impl IntoIterator<Item = Self>) -> Self {
        Self::only_or(shapes.into_iter().collect(), Self::AnyOf)
    }

    /// A single shape itself, or several together.
    fn only_or(mut shapes: Vec<Self>, together: fn(Vec<Self>) -> Self) -> Self {
        match shapes.pop() {
            Some(only) if shapes.is_empty() => only,
            last => {
                shapes.extend(last);
                together(shapes)
            }
        }
    }

    /// The intersection of two shapes.
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
            (Self::AllOf(mut shapes), other) => {
                shapes.push(other);
                Self::AllOf(shapes)
            }
            (shape, other) => Self::AllOf([shape, other].into()),
        }
    }

    /// This shape without others.
    #[must_use]
    pub fn without(self, excluded: impl IntoIterator<Item = Self>) -> Self {
        let excluded: Vec<Self> = excluded.into_iter().collect();
        if excluded.is_empty() {
            return self;
        }
        self.and(Self::Outside(Box::new(Self::any_of(excluded))))
    }

    /// Whether a place lies inside.
    #[must_use]
    pub fn contains(&self, p: [f64; D]) -> bool {
        match self {
            Self::Region(region) => region.contains(p),
            Self::Ball(ball) => ball.contains(p),
            Self::Outlined(part) => part.contains(p),
            Self::AnyOf(shapes) => shapes.iter().any(|shape| shape.contains(p)),
            Self::AllOf(shapes) => shapes.iter().all(|shape| shape.contains(p)),
            Self::Outside(shape) => !shape.contains(p),
        }
    }

    /// A box around the shape, or `None` if it is unbounded. The box of a shape that is plainly empty is empty.
    #[must_use]
    pub fn bounds(&self) -> Option<Region<D>> {
        match self {
            Self::Region(region) => Some(*region),
            Self::Ball(ball) => ball.bounds(),
            Self::Outlined(part) => Some(part.bounds()),
            Self::AnyOf(shapes) => {
                let mut all = shapes.iter().map(Self::bounds);
                let Some(first) = all.next() else {
                    return Some(Region::between([0.0; D], [0.0; D]));
                };
                all.try_fold(first?, |all, bounds| Some(all.around(&bounds?)))
            }
            Self::AllOf(shapes) => {
                let bounded = shapes.iter().filter_map(Self::bounds);
                bounded.reduce(|all, bounds| all.and(bounds))
            }
            Self::Outside(_) => None,
        }
    }

    /// The number of vertices of all polygons in the shape.
    #[must_use]
    pub fn vertices(&self) -> usize {
        match self {
            Self::Region(_) | Self::Ball(_) => 0,
            Self::Outlined(part) => part.vertices(),
            Self::AnyOf(shapes) | Self::AllOf(shapes) => shapes.iter().map(Self::vertices).sum(),
            Self::Outside(shape) => shape.vertices(),
        }
    }

    /// The chunks of which this is the intersection with [`beside_chunks`](Self::beside_chunks). Membership of a chunk
    /// is exact, which reported coordinates cannot decide, so integers decide these and coordinates the rest.
    pub(crate) fn chunks(&self) -> Vec<Chunk<D>> {
        match self {
            Self::Region(region) => region.as_chunk().into_iter().collect(),
            Self::AllOf(shapes) => shapes.iter().flat_map(Self::chunks).collect(),
            _ => Vec::new(),
        }
    }

    /// The shape without the restriction to its [`chunks`](Self::chunks); `None` if nothing else restricts it.
    pub(crate) fn beside_chunks(&self) -> Option<Self> {
        match self {
            Self::Region(region) if region.as_chunk().is_some() => None,
            Self::AllOf(shapes) => {
                let rest: Vec<Self> = shapes.iter().filter_map(Self::beside_chunks).collect();
                (!rest.is_empty()).then(|| Self::only_or(rest, Self::AllOf))
            }
            other => Some(other.clone()),
        }
    }

    /// The shape for points of a box, its upper sides included, reduced to what matters there.
    pub(crate) fn focus(&self, within: &Region<D>) -> Self {
        let focused = match self {
            Self::Region(region) => region.within(within).ok_or_else(|| self.clone()),
            Self::Ball(ball) => ball.within(within).ok_or_else(|| self.clone()),
            Self::Outlined(part) => part.focus(within).map_err(Self::Outlined),
            Self::AnyOf(shapes) => return Self::joined(shapes, within, false),
            Self::AllOf(shapes) => return Self::joined(shapes, within, true),
            Self::Outside(shape) => {
                let near = shape.focus(within);
                let state = near.is_all_or_nothing().map(|state| !state);
                state.ok_or_else(|| Self::Outside(Box::new(near)))
            }
        };
        focused.map_or_else(|near| near, Self::constant)
    }

    /// The intersection (`is_all`) or union of shapes in a box.
    fn joined(shapes: &[Self], within: &Region<D>, is_all: bool) -> Self {
        let mut near = Vec::with_capacity(shapes.len());
        for shape in shapes {
            let shape = shape.focus(within);
            match shape.is_all_or_nothing() {
                Some(state) if state != is_all => return Self::constant(state),
                Some(_) => {}
                None => near.push(shape),
            }
        }
        Self::only_or(near, if is_all { Self::AllOf } else { Self::AnyOf })
    }

    /// Whether this is everything or nothing, as shapes are that were reduced to where all or none of them is.
    pub(crate) const fn is_all_or_nothing(&self) -> Option<bool> {
        match self {
            Self::AllOf(shapes) if shapes.is_empty() => Some(true),
            Self::AnyOf(shapes) if shapes.is_empty() => Some(false),
            _ => None,
        }
    }

    /// Everything or nothing.
    const fn constant(state: bool) -> Self {
        if state {
            Self::AllOf(Vec::new())
        } else {
            Self::AnyOf(Vec::new())
        }
    }
}

impl Area {
    /// The number of boxes, circles and edges that points are compared with.
    pub(crate) fn parts(&self) -> usize {
        match self {
            Self::Region(_) | Self::Ball(_) => 1,
            Self::Outlined(polygon) => polygon.sides().count(),
            Self::AnyOf(areas) | Self::AllOf(areas) => areas.iter().map(Self::parts).sum(),
            Self::Outside(area) => area.parts(),
        }
    }

    /// The states of a strip y₀ ≤ y ≤ y₁ along x. After [`focus`](Self::focus) they hold within the box.
    pub(crate) fn steps(&self, strip: [f64; 2], stepper: &mut Stepper) {
        match self {
            Self::Region(region) => stepper.steps.set_region(region, strip),
            Self::Ball(circle) => circle.steps(strip, &mut stepper.steps),
            Self::Outlined(polygon) => polygon.steps(strip, stepper),
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
pub(super) mod tests {
    use alloc::vec;

    use proptest::prelude::*;

    use super::*;
    fn coordinate() -> impl Strategy<Value = f64> {
        prop_oneof![(-4i8..=4).prop_map(f64::from), -4.0..4.0f64]
    }

    pub fn place<const D: usize>() -> impl Strategy<Value = [f64; D]> {
        proptest::array::UniformArrayStrategy::new(coordinate())
    }

    pub fn any_box<const D: usize>() -> impl Strategy<Value = Region<D>> {
        (place(), place()).prop_map(|(a, b): ([f64; D], [f64; D])| {
            let pick = |f: fn(f64, f64) -> f64| core::array::from_fn(|i| f(a[i], b[i]));
            Region::new(pick(f64::min), pick(f64::max)).expect("ordered")
        })
    }

    pub fn any_polygon() -> impl Strategy<Value = Polygon> {
        let rings = prop::collection::vec(prop::collection::vec(place(), 3..7), 1..3);
        rings.prop_filter_map("different", |rings| Polygon::new(&rings).ok())
    }

    /// Boxes, balls, other shapes, and their combinations.
    pub fn any_shape<const D: usize, P: Clone + core::fmt::Debug + Outlined<D> + 'static>(
        other: impl Strategy<Value = Shape<D, P>> + 'static,
    ) -> impl Strategy<Value = Shape<D, P>> {
        let ball = (place(), 0.1..4.0f64)
            .prop_map(|(center, radius)| Ball::new(center, radius).expect("valid").into());
        prop_oneof![any_box().prop_map(Shape::from), ball, other].prop_recursive(3, 8, 3, |inner| {
            prop_oneof![
                prop::collection::vec(inner.clone(), 1..3).prop_map(Shape::any_of),
                (inner.clone(), inner.clone()).prop_map(|(a, b)| a.and(b)),
                (inner.clone(), inner).prop_map(|(a, b)| a.without([b])),
            ]
        })
    }

    proptest! {
        #[test]
        fn steps_and_focus_never_contradict_membership(
            area in any_shape(any_polygon().prop_map(Area::from)), y0 in coordinate(), height in 0.0..2.0f64,
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
        assert_eq!(Area::Outside(Box::new(square.clone())).bounds(), None);
        let triangle = Polygon::new(&[[[0.0, 0.0], [9.0, 0.0], [0.0, 9.0]]]).expect("valid");
        assert_eq!(Area::from(triangle).without([square]).vertices(), 3);
    }
}
