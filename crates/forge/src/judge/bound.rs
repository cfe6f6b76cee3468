//! Bounds on figures, and the complaints about figures that miss them.

use std::fmt;

use strew_core::table::Figures;

use super::Figure;

/// A limit on a figure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bound {
    /// The figure.
    pub figure: Figure,
    /// The side of the limit on which the figure must stay.
    pub side: Side,
    /// The limit, which is itself allowed.
    pub limit: f64,
}

/// A side of a limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The limit and below.
    AtMost,
    /// The limit and above.
    AtLeast,
}

impl Bound {
    /// The bound `figure` ≤ `limit`.
    #[must_use]
    pub const fn at_most(figure: Figure, limit: f64) -> Self {
        Self {
            figure,
            side: Side::AtMost,
            limit,
        }
    }

    /// The bound `figure` ≥ `limit`.
    #[must_use]
    pub const fn at_least(figure: Figure, limit: f64) -> Self {
        Self {
            figure,
            side: Side::AtLeast,
            limit,
        }
    }

    /// Returns a complaint if these figures miss the bound or lack the figure.
    #[must_use]
    pub fn check(&self, figures: &Figures) -> Option<Complaint> {
        let value = figures.value(self.figure.name()).unwrap_or(f64::NAN);
        let holds = match self.side {
            Side::AtMost => value <= self.limit,
            Side::AtLeast => value >= self.limit,
        };
        (!holds).then(|| Complaint {
            subject: figures.subject.clone(),
            bound: *self,
            value,
        })
    }
}

/// A figure that missed its bound.
#[derive(Clone, Debug, PartialEq)]
pub struct Complaint {
    /// The point set that was measured.
    pub subject: String,
    /// The bound it missed.
    pub bound: Bound,
    /// The measured value; NaN if the figure is missing.
    pub value: f64,
}

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::AtMost => "at most",
            Self::AtLeast => "at least",
        })
    }
}

impl fmt::Display for Complaint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Bound {
            figure,
            side,
            limit,
        } = self.bound;
        let (name, subject, value) = (figure.name(), &self.subject, self.value);
        write!(
            f,
            "{name} on {subject} is {value}; it must be {side} {limit}"
        )
    }
}

/// Returns the complaints about a table, given its figures. Only figures of unseen point sets
/// count; without any, every bound is missed.
#[must_use]
pub fn complaints(bounds: &[Bound], figures: &[Figures]) -> Vec<Complaint> {
    let nothing = Figures {
        subject: "no unseen subject".into(),
        ..Figures::default()
    };
    let mut judged: Vec<&Figures> = figures.iter().filter(|f| !f.seen).collect();
    if judged.is_empty() {
        judged.push(&nothing);
    }
    let all = |figures| bounds.iter().filter_map(move |bound| bound.check(figures));
    judged.into_iter().flat_map(all).collect()
}

/// The gravest complaint about each figure, in words.
#[must_use]
pub fn gravest(complaints: &[Complaint]) -> Vec<String> {
    let excess = |c: &Complaint| (c.value - c.bound.limit).abs();
    let mut said: Vec<(&Complaint, usize)> = Vec::new();
    for complaint in complaints {
        let same = |(known, _): &&mut (&Complaint, usize)| known.bound == complaint.bound;
        match said.iter_mut().find(same) {
            None => said.push((complaint, 1)),
            Some((known, count)) => {
                *count += 1;
                if excess(complaint) > excess(known) || complaint.value.is_nan() {
                    *known = complaint;
                }
            }
        }
    }
    let words = |(complaint, count): (&Complaint, usize)| match count {
        1 => complaint.to_string(),
        _ => format!("{complaint} (missed on {count} point sets)"),
    };
    said.into_iter().map(words).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_complaint_names_figure_subject_value_and_limit() {
        let figures = Figures {
            subject: "twin 683/418".into(),
            seen: false,
            points: 70_225,
            values: vec![("low_power".into(), 3e-5), ("delta_min".into(), 0.62)],
        };
        let said = |bound: Bound| bound.check(&figures).map(|complaint| complaint.to_string());
        assert_eq!(said(Bound::at_least(Figure::DeltaMin, 0.62)), None);
        assert_eq!(said(Bound::at_most(Figure::LowPower, 3e-5)), None);
        let low = said(Bound::at_most(Figure::LowPower, 2e-5));
        let expected = "low_power on twin 683/418 is 0.00003; it must be at most 0.00002";
        assert_eq!(low.as_deref(), Some(expected));
        // A missing figure misses its bound.
        assert!(said(Bound::at_most(Figure::PeakPower, 9.0)).is_some());
    }

    #[test]
    fn without_unseen_figures_every_bound_is_missed() {
        let bounds = [Bound::at_most(Figure::LowPower, 1.0)];
        assert_eq!(complaints(&bounds, &[]).len(), 1);
        let seen = Figures {
            seen: true,
            values: vec![("low_power".into(), 0.0)],
            ..Figures::default()
        };
        assert_eq!(complaints(&bounds, std::slice::from_ref(&seen)).len(), 1);
        let unseen = Figures {
            seen: false,
            ..seen
        };
        assert!(complaints(&bounds, &[unseen]).is_empty());
    }
}
