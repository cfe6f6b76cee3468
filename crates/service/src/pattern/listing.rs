//! The occurrences of an arrangement, one after another, as text.
//!
//! They are counted before the first is made, and a list that ends at its limit knows the place of the next one
//! without making those before it.

use std::{io::Write as _, ops::Range, sync::Arc};

use crate::access::Caller;
use bytes::Bytes;
use strew_core::{PointId, pattern::Arrangement};
use strew_encode::{Json, write_number};
use strew_error::{Error, integer::Long};
use strew_plan::Placed;

use super::{ArrangementQuery, Facts, List};
use crate::{Permit, Record, Service};

/// Occurrences that are about to be listed: how many there are is known.
#[derive(Debug)]
pub struct Listing {
    found: Arrangement,
    grid: [Range<i64>; 2],
    from: (i64, i64),
    placed: Option<Arc<Placed>>,
    pub count: u64,
    /// The place of the one after them.
    pub next: Option<(i64, i64)>,
}

struct Occurrence {
    /// The column and the row of its first point.
    at: (i64, i64),
    /// The displaced places of its points, the first one first; none if they are not wanted.
    places: Vec<[f64; 2]>,
}

impl Listing {
    pub fn new(query: &ArrangementQuery, placed: Option<Placed>, most: u64) -> Result<Self, Error> {
        let found = query.found.clone();
        let grid = query.grid.clone().unwrap_or([0..0, 0..0]);
        let [x, y] = &grid;
        let from = query.from.unwrap_or((x.start, y.start));
        let before = found.count_before(x.clone(), y.clone(), from);
        let rest = found.count(x.clone(), y.clone()) - before;
        let listed = rest.min(query.limit.map_or(u128::MAX, u128::from));
        let each = placed.as_ref().map_or(1, |_| 1 + found.offsets().len());
        let points = listed.saturating_mul(each as u128);
        if points > u128::from(most) {
            let (count, limit) = (points, most);
            return Err(Error::TooManyPoints { count, limit });
        }
        let next = (listed < rest).then(|| found.nth(x.clone(), y.clone(), before + listed));
        Ok(Self {
            from,
            placed: placed.map(Arc::new),
            // At most `most`.
            count: u64::try_from(listed).unwrap_or(u64::MAX),
            next: next.flatten(),
            found,
            grid,
        })
    }

    /// The number of points of an occurrence, of those that are looked up.
    fn each(&self) -> usize {
        self.placed
            .as_ref()
            .map_or(1, |_| 1 + self.found.offsets().len())
    }

    pub fn cursor(&self) -> Option<String> {
        self.next.map(|(x, y)| format!("{x}:{y}"))
    }

    fn occurrences(self) -> Occurrences {
        const POINTS: usize = 4096;
        let batch = (POINTS / self.each()).max(1);
        let [x, y] = self.grid;
        let all = self.found.occurrences_from(x, y, self.from);
        // A list that is held in memory has this many items at most.
        let count = usize::try_from(self.count).unwrap_or(usize::MAX);
        Occurrences {
            rest: Box::new(all.take(count)),
            offsets: self.found.offsets().to_vec(),
            placed: self.placed,
            record: Record::current(),
            batch,
        }
    }

    pub fn text(self, list: List, facts: &Facts) -> Text {
        let columns = if self.placed.is_some() {
            self.found.offsets().len() + 1
        } else {
            0
        };
        let next = self.cursor();
        let head = match list {
            List::NdJson => vec![],
            List::Csv => {
                let places = (0..columns).map(|i| format!(",x{i},y{i}"));
                format!("column,row{}\n", places.collect::<String>()).into_bytes()
            }
            List::Json => {
                let head =
                    serde_json::json!({ "arrangement": facts, "listed": self.count, "next": next });
                let mut head = head.to_string().into_bytes();
                head.pop();
                head.extend_from_slice(b",\"occurrences\":[");
                head
            }
        };
        Text {
            list,
            head,
            is_first: true,
            is_over: false,
            occurrences: self.occurrences(),
        }
    }
}

/// The occurrences of a list in batches, made when they are taken.
struct Occurrences {
    rest: Box<dyn Iterator<Item = (i64, i64)> + Send>,
    offsets: Vec<(i64, i64)>,
    placed: Option<Arc<Placed>>,
    record: Option<Arc<Record>>,
    batch: usize,
}

impl Occurrences {
    fn occurrence(&self, (x, y): (i64, i64)) -> Result<Occurrence, Error> {
        let Some(placed) = &self.placed else {
            return Ok(Occurrence {
                at: (x, y),
                places: vec![],
            });
        };
        let all = [(0, 0)].iter().chain(&self.offsets);
        let place = |&(i, j): &(i64, i64)| {
            let id = PointId { x: x + i, y: y + j };
            let member = placed.points.point(id);
            let member = member.ok_or(Error::Internal("a point of an occurrence is missing"))?;
            Ok(member.at())
        };
        Ok(Occurrence {
            at: (x, y),
            places: all.map(place).collect::<Result<_, Error>>()?,
        })
    }
}

impl Iterator for Occurrences {
    type Item = Result<Vec<Occurrence>, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        let places: Vec<_> = self.rest.by_ref().take(self.batch).collect();
        if places.is_empty() {
            return None;
        }
        if let Some(record) = &self.record {
            let each = self.placed.as_ref().map_or(1, |_| 1 + self.offsets.len());
            record.made((places.len() * each) as u64);
        }
        let all = places.into_iter().map(|place| self.occurrence(place));
        Some(all.collect())
    }
}

pub struct Text {
    list: List,
    head: Vec<u8>,
    is_first: bool,
    is_over: bool,
    occurrences: Occurrences,
}

impl Iterator for Text {
    type Item = Result<Bytes, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.is_over {
            return None;
        }
        let mut text = std::mem::take(&mut self.head);
        match self.occurrences.next() {
            Some(Ok(batch)) => batch.iter().for_each(|one| self.write(one, &mut text)),
            Some(Err(error)) => {
                self.is_over = true;
                return Some(Err(error));
            }
            None => {
                self.is_over = true;
                if self.list == List::Json {
                    text.extend_from_slice(b"]}\n");
                }
            }
        }
        (!text.is_empty()).then(|| Ok(text.into()))
    }
}

impl Text {
    fn write(&mut self, one: &Occurrence, text: &mut Vec<u8>) {
        let (x, y) = one.at;
        if self.list == List::Csv {
            // Writing to a vector cannot fail.
            let _ = write!(text, "{x},{y}");
            for value in one.places.as_flattened() {
                text.push(b',');
                write_number(*value, text);
            }
            text.push(b'\n');
            return;
        }
        if self.list == List::Json && !std::mem::take(&mut self.is_first) {
            text.push(b',');
        }
        let [x, y] = [x, y].map(|number| Json::of(&Long(number)));
        let _ = write!(text, "{{\"at\":[{},{}]", x.text(), y.text());
        for (i, [x, y]) in one.places.iter().enumerate() {
            let start: &[u8] = if i == 0 { b",\"places\":[[" } else { b",[" };
            text.extend_from_slice(start);
            write_number(*x, text);
            text.push(b',');
            write_number(*y, text);
            text.push(b']');
        }
        if !one.places.is_empty() {
            text.push(b']');
        }
        text.push(b'}');
        if self.list == List::NdJson {
            text.push(b'\n');
        }
    }
}

impl Service {
    /// Admits a caller and counts the occurrences that are to be listed, charging their points.
    pub async fn list(
        &self,
        caller: &Caller,
        query: &ArrangementQuery,
    ) -> Result<(Permit, Listing), Error> {
        let permit = self.admit(caller, 0)?;
        let placed = match &query.set {
            Some(set) => Some(self.place(caller, set.clone()).await?),
            None => None,
        };
        let most = caller.max_points(self.limits().max_points);
        let listing = Listing::new(query, placed, most)?;
        let points = u128::from(listing.count) * listing.each() as u128;
        caller.charge(points)?;
        let points = u64::try_from(points).unwrap_or(u64::MAX);
        Record::promise(self.points_in_flight(), points);
        Ok((permit, listing))
    }
}
