//! What a strip of the plane is along x: inside, outside, or not the same everywhere.

use alloc::{vec, vec::Vec};
use core::ops::Range;

use super::{
    Region,
    polygon::{Edge, is_odd},
};

/// What is known of a rectangle of the plane. Ordered, so that "any of" is the maximum and "all of"
/// the minimum.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::sample) enum State {
    /// Outside, all of it.
    Out,
    /// To be asked point by point.
    Test,
    /// Inside, all of it.
    In,
}

/// From where on which state holds.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Step {
    from: f64,
    state: State,
    near: Option<Near>,
}

/// Which edges of a polygon points have to be compared with, where that is known: some of a
/// [`Stepper`]'s.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::sample) struct Near {
    first: u32,
    end: u32,
    /// Whether points are inside that these edges are left of, or that are on no level with them.
    inside: bool,
}

/// An edge that reaches into a strip.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    /// From where to where, along x.
    pub(super) extent: [f64; 2],
    /// Whether it crosses the strip's lower side.
    pub(super) crosses: bool,
    pub(super) edge: Edge,
}

/// States along x, ascending, the first from −∞ on. At a step itself nothing is known: what uses
/// them keeps a distance.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::sample) struct Steps(Vec<Step>);

/// Steps of one strip after another, in the same memory.
#[derive(Clone, Debug, Default)]
pub(in crate::sample) struct Stepper {
    pub(in crate::sample) steps: Steps,
    /// Of the last polygon: its edges, from left to right.
    pub(super) edges: Vec<Reach>,
}

impl Stepper {
    /// Whether a point is inside of which it is known what it has to be compared with.
    #[inline]
    pub(in crate::sample) fn contains(&self, near: Near, p: [f64; 2]) -> bool {
        let edges = &self.edges[near.first as usize..near.end as usize];
        near.inside ^ is_odd(edges.iter().map(|reach| &reach.edge), p)
    }
}

impl Default for Steps {
    fn default() -> Self {
        Self::all(State::Out)
    }
}

impl Steps {
    /// One state everywhere.
    pub(in crate::sample) fn all(state: State) -> Self {
        Self(vec![Step {
            from: f64::NEG_INFINITY,
            state,
            near: None,
        }])
    }

    /// One state everywhere again.
    pub(in crate::sample) fn restart(&mut self, state: State) {
        self.0.clear();
        self.push(f64::NEG_INFINITY, state);
    }

    /// Adds a step, not below the last one.
    pub(super) fn push(&mut self, from: f64, state: State) {
        if self.0.last().is_none_or(|last| last.state != state) {
            let near = None;
            self.0.push(Step { from, state, near });
        }
    }

    /// After a step to points that have to be asked: only edges of these numbers matter there, and
    /// beyond them it is this state.
    pub(super) fn note(&mut self, edges: Range<usize>, inside: bool) {
        if let Some(last) = self.0.last_mut() {
            last.near = Some(Near {
                first: edges.start as u32,
                end: edges.end as u32,
                inside,
            });
        }
    }

    pub(super) fn set_region(&mut self, region: &Region, [y0, y1]: [f64; 2]) {
        let (min, max) = (region.min(), region.max());
        self.restart(State::Out);
        if region.is_empty() || y1 < min[1] || y0 >= max[1] {
            return;
        }
        let within = min[1] <= y0 && y1 < max[1];
        self.push(min[0], if within { State::In } else { State::Test });
        self.push(max[0], State::Out);
    }

    /// The states of a combination of two areas.
    pub(super) fn join(&self, other: &Self, join: fn(State, State) -> State) -> Self {
        let (mut a, mut b) = (self.0.as_slice(), other.0.as_slice());
        let mut state = [State::Out; 2];
        let mut joined = Self(Vec::with_capacity(a.len() + b.len()));
        while let Some(from) = match (a.first(), b.first()) {
            (Some(a), Some(b)) => Some(a.from.min(b.from)),
            (Some(step), None) | (None, Some(step)) => Some(step.from),
            (None, None) => None,
        } {
            for (steps, state) in [&mut a, &mut b].into_iter().zip(&mut state) {
                while let Some((first, rest)) = steps.split_first()
                    && first.from <= from
                {
                    *state = first.state;
                    *steps = rest;
                }
            }
            joined.push(from, join(state[0], state[1]));
        }
        joined
    }

    /// The states of everything outside.
    pub(super) fn invert(&mut self) {
        for step in &mut self.0 {
            step.state = match step.state {
                State::Out => State::In,
                State::Test => State::Test,
                State::In => State::Out,
            };
            if let Some(near) = &mut step.near {
                near.inside = !near.inside;
            }
        }
    }

    /// The stretches: from where to where which state holds, and what points are to be compared with
    /// if that is known.
    pub(in crate::sample) fn stretches(
        &self,
    ) -> impl Iterator<Item = (f64, f64, State, Option<Near>)> {
        let ends = self.0.iter().skip(1).map(|step| step.from);
        let ends = ends.chain([f64::INFINITY]);
        self.0
            .iter()
            .zip(ends)
            .map(|(step, end)| (step.from, end, step.state, step.near))
    }

    #[cfg(test)]
    pub(super) fn at(&self, x: f64) -> State {
        let after = self.0.partition_point(|step| step.from <= x);
        self.0[after - 1].state
    }
}
