//! The walk over a plan: bands of columns, rows within a band, columns within a row. `flat` has what differs
//! in small warped boxes, `graded` what differs in a field.

mod few;
mod flat;
pub(super) mod graded;

use alloc::{boxed::Box, sync::Arc};
use core::ops::Range;

use few::Few;
pub(crate) use few::find_few;
use graded::Constant;

use super::{
    place::Place,
    sifting::Sifting,
    template::{Check, Kept, Part, Templates, displaced, sift, write_row},
    tile::{Tile, bands},
    window::Window,
};
use crate::{
    pattern::Axis,
    sample::{
        cursor::Cursor,
        field::FieldRows,
        kernel::{Backend, Format, Geometry, Row, compiled},
        lattice::{
            BAND_WIDTH, Columns, Flat, Inside, Listed, Patch, PointId, Span, clip_to_band, places,
        },
        scope::{Corner, Scope},
        sieve::Scale,
    },
};

/// The number of lattice rows from which a band keeps its templates.
const TALL: i64 = 512;

/// The points of a plan, or of one of its tiles, in order, in blocks of any size.
///
/// It owns all it needs, so it can move between threads from block to block.
///
/// ```
/// use strew_core::{PointSet, Table};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let plan = PointSet::new(table).chunk(10.0, [0, 0])?;
/// let (mut blocks, mut block) = (plan.blocks_f32(), [[0.0; 2]; 512]);
/// assert_eq!(blocks.fill(&mut block) as u128, plan.count());
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Blocks<F: Format> {
    scope: Arc<Scope>,
    /// What the walk covers of the scope; `None` for a tile.
    window: Option<Window>,
    format: F,
    /// The bands still to come.
    bands: Range<i64>,
    /// The current band.
    band: i64,
    /// The rows of every band.
    rows: Range<i64>,
    at: Place,
    /// The number of points still to come.
    left: u128,
    sieve: Option<Sifting>,
    columns: Columns,
    /// The columns that lie inside whatever their displacement, as places in the lists.
    inner: [Range<usize>; 4],
    /// All columns of the band.
    listed: Listed,
    templates: Templates<F>,
    patch: Patch,
    /// The scope's spans in the patch.
    piece: [Span; 2],
    base: [f64; 2],
    backend: Backend,
    /// The points of some rows of a warped patch, and those inside.
    flat: (Flat, Inside),
    /// The points of some rows in a field.
    graded: Option<Box<FieldRows>>,
    /// The points of a small plan that were kept when they were counted, and the number of the next.
    kept: Option<(Arc<Few>, usize)>,
    /// The last rows of a band in which a field is constant.
    constant: Option<Box<Constant<F>>>,
}

impl<F: Format> Blocks<F> {
    /// The points of a window.
    pub(crate) fn of_window(scope: Arc<Scope>, window: Window) -> Self {
        let (bands, rows) = (bands(&scope), scope.y.all.clone());
        let bands = match window.start {
            Some(at) => at.x.div_euclid(BAND_WIDTH)..bands.end,
            None => bands,
        };
        let mut blocks = Self::new(scope, Some(window), bands, rows);
        if let Some(at) = window.start
            && blocks.next_band()
            && blocks.rows.contains(&at.y)
        {
            blocks.at = Place {
                from: Some(at.x),
                ..Place::row(at.y)
            };
            blocks.next_patch();
        }
        blocks
    }

    /// The points of a tile.
    pub(crate) fn of_tile(scope: Arc<Scope>, tile: &Tile) -> Self {
        Self::new(scope, None, tile.band..tile.band + 1, tile.rows.clone())
    }

    fn new(scope: Arc<Scope>, window: Option<Window>, bands: Range<i64>, rows: Range<i64>) -> Self {
        let begins_within = window.is_some_and(|window| window.start.is_some());
        let kept = match &scope.sieve {
            Some(_) => Kept::All,
            None if begins_within => Kept::Places,
            None => Kept::Columns,
        };
        let Corner {
            first, gap, extent, ..
        } = scope.corner;
        let format = F::new(&Geometry {
            step: scope.lattice.step,
            first,
            gap,
            extent,
        });
        let patch = Patch::new(&scope.lattice, bands.start, rows.start, &scope.x, &scope.y);
        let is_tall = rows.end - rows.start >= TALL;
        Self {
            base: format.base(patch.origin()),
            piece: [scope.x.clone(), scope.y.clone()],
            format,
            band: bands.start,
            bands,
            at: Place::row(rows.end),
            rows,
            left: window.map_or(u128::MAX, |window| window.count),
            sieve: scope.sieve.as_ref().map(Sifting::new),
            columns: Columns::default(),
            inner: [const { 0..0 }; 4],
            listed: Listed::default(),
            templates: Templates::new(&scope.lattice, is_tall, kept),
            patch,
            backend: Backend::best(),
            flat: Default::default(),
            graded: scope.lattice.grade.as_ref().map(|_| Box::default()),
            kept: None,
            constant: None,
            scope,
            window,
        }
    }

    /// Fills rows by a backend other than the machine's best. The points have the same bits.
    ///
    /// ```
    /// use strew_core::{Backend, PointSet, Table};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let plan = PointSet::new(table).chunk(10.0, [0, 0])?;
    /// let mut block = [[0.0; 2]; 50];
    /// plan.blocks_f64().with_backend(Backend::Scalar).fill(&mut block);
    /// assert_eq!(block[49], plan.to_vec()[49].at());
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn with_backend(self, backend: Backend) -> Self {
        match self.window {
            // Points that were kept were found by the best one.
            Some(window) if self.kept.is_some() && self.left == window.count => Self {
                backend,
                ..Self::of_window(self.scope, window)
            },
            _ => Self { backend, ..self },
        }
    }

    /// Writes the next points into `out`. Returns the number written; fewer than `out` holds, down to 0,
    /// only at the end.
    ///
    /// ```
    /// use strew_core::{PointSet, Region, Table};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let plan = PointSet::new(table).within(Region::new([0.0, 0.0], [100.0, 50.0])?)?;
    /// let (mut blocks, mut block, mut total) = (plan.blocks_f64(), [[0.0; 2]; 512], 0);
    /// while let filled @ 1.. = blocks.fill(&mut block) {
    ///     total += filled;
    /// }
    /// assert_eq!(total as u128, plan.count());
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn fill(&mut self, out: &mut [F::Item]) -> usize {
        let most = usize::try_from(self.left).map_or(out.len(), |left| left.min(out.len()));
        let out = &mut out[..most];
        let mut filled = self.write_kept(out);
        while filled < out.len() {
            if self.has_found() {
                filled += self.write_found(&mut out[filled..]);
                continue;
            }
            if self.has_constant() {
                filled += self.fill_constant(&mut out[filled..]);
                continue;
            }
            if self.at.y == self.rows.end && !self.next_band() {
                break;
            }
            if !self.has_constant() && self.needs_patch() {
                self.next_patch();
            }
            if self.has_constant() {
                continue;
            }
            let end = self.rows.end.min(self.patch.end());
            let out = &mut out[filled..];
            filled += if self.graded.is_some() {
                self.find(end, out.len());
                0
            } else if self.sieve.as_ref().is_some_and(|sieve| sieve.is_cut) {
                self.fill_sifted(end, out)
            } else if self.patch.is_warped() && self.templates.are_short() && self.at.is_fresh() {
                self.fill_flat(end, out)
            } else {
                self.fill_rows(end, out)
            };
        }
        self.left -= filled as u128;
        filled
    }

    /// The place after the points written so far, found without counting. `None` for a tile, whose
    /// place in the order is unknown, and for a plan without points, which has no place to resume from.
    ///
    /// Its lattice address lies after that of the last point written, and may lie before that of the
    /// next.
    ///
    /// ```
    /// use strew_core::{PointSet, Region, Table};
    ///
    /// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let (set, region) = (PointSet::new(table), Region::chunk(10.0, [0, 0])?);
    /// let (mut blocks, mut block) = (set.within(region)?.blocks_f64(), [[0.0; 2]; 40]);
    /// blocks.fill(&mut block);
    /// let cursor = blocks.cursor().expect("not a tile");
    /// assert_eq!(set.resume(region, cursor)?.offset(), 40);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn cursor(&self) -> Option<Cursor> {
        let window = self.window.filter(|window| window.count > 0)?;
        let at = if let Some(within) = self.constant_place() {
            within
        } else if self.kept.is_some() {
            self.kept_place()?
        } else if let Some(next) = self.next_found() {
            next
        } else if self.at.y == self.rows.end {
            PointId {
                x: self.bands.start * BAND_WIDTH,
                y: self.rows.start,
            }
        } else {
            PointId {
                x: self.column(),
                y: self.at.y,
            }
        };
        Some(Cursor {
            offset: window.offset + (window.count - self.left),
            total: window.total,
            at,
        })
    }

    /// The lattice column at which the current row goes on.
    fn column(&self) -> i64 {
        let start = self.band * BAND_WIDTH;
        if self.at.done == 0 {
            return self.at.from.unwrap_or(start);
        }
        let lattice = &self.scope.lattice;
        let column = lattice.row(self.at.y).and_then(|(class, block)| {
            let (vectors, keeps) = (lattice.vectors(block), lattice.keeps(block));
            let columns = self.columns.of(class).iter().filter(|line| keeps(line));
            self.templates
                .column(&self.patch, columns, vectors, self.at.done)
        });
        column.unwrap_or(start + BAND_WIDTH)
    }

    /// Moves to the first row of the next band.
    fn next_band(&mut self) -> bool {
        let Some(band) = self.bands.next() else {
            return false;
        };
        let Scope { lattice, x, .. } = &*self.scope;
        let columns = clip_to_band(band, &x.all);
        self.columns.list(lattice, columns.clone());
        self.inner = self.columns.places(&x.inner);
        self.listed = self.columns.part(columns.clone());
        if let (Some(sieve), Some(sifting)) = (&self.scope.sieve, &mut self.sieve) {
            sifting.band.aim(sieve.area(), &self.rows, &columns);
            sifting.prefix.update(&columns, &self.columns);
        }
        self.templates.clear();
        self.band = band;
        self.at = Place::row(self.rows.start);
        self.next_patch();
        true
    }

    /// Moves to the patch of the current row.
    fn next_patch(&mut self) {
        if self.graded.is_some() {
            self.skip_empty();
            if self.at.y == self.rows.end || self.has_constant() {
                return;
            }
        }
        let Scope { lattice, x, y, .. } = &*self.scope;
        self.patch = Patch::new(lattice, self.band, self.at.y, x, y);
        self.base = self.format.base(self.patch.origin());
        let rows = self.at.y..self.patch.end().min(self.rows.end);
        let columns = clip_to_band(self.band, &x.all);
        if self.patch.is_warped() {
            self.piece = Span::of_piece(lattice, [x, y], [columns.clone(), rows.clone()]);
        }
        if let Some(sifting) = &mut self.sieve {
            if self.patch.is_warped() {
                sifting
                    .patch
                    .set_reach([0, 1].map(|axis| self.piece[axis].reach));
            }
            if sifting.next_patch(&rows, &columns) {
                self.at = Place::row(rows.end);
            }
        }
    }

    /// Writes points of the patch's rows up to `end`, or as many as there is room for.
    fn fill_rows(&mut self, end: i64, out: &mut [F::Item]) -> usize {
        let lattice = &self.scope.lattice;
        let [x, span] = &self.piece;
        let (format, patch, base, by) = (&self.format, &self.patch, self.base, self.backend);
        let is_split = patch.is_warped() && !patch.columns_are_inner;
        let is_direct = self.templates.are_plain() && !patch.is_warped();
        let is_flat = self.templates.are_short() && patch.is_warped();
        let mut filled = 0;
        while self.at.y < end && filled < out.len() {
            if is_flat && self.at.is_fresh() {
                // Only a row that was begun is finished here.
                break;
            }
            let y = self.at.y;
            let line = lattice.row(y).filter(|_| span.all.contains(&y));
            let Some((class, block)) = line else {
                self.at.next_row();
                continue;
            };
            let row = Row {
                base,
                y: patch.relative(Axis::Y, y),
                lattice: y,
            };
            let is_inner = span.inner.contains(&y);
            let columns = self.columns.of_row(lattice, class, block);
            let vectors = lattice.vectors(block);
            let inner = if lattice.has_all() {
                self.inner[class.ordinal()].clone()
            } else {
                places(columns, &x.inner)
            };
            let out = &mut out[filled..];
            if is_direct && self.at.done == 0 && columns.len() <= out.len() {
                filled += compiled(self.backend, || {
                    let (columns, vectors) = ((columns, inner), (vectors, is_inner));
                    write_row(format, patch, row, columns, vectors, out)
                });
                self.at.next_row();
                continue;
            }
            let template = self
                .templates
                .get(class, block, self.at.done > 0, |template, kept| {
                    template.make((format, base), patch, (columns, inner), vectors, kept, by);
                });
            if let Some(from) = self.at.from.take() {
                self.at.done = template.columns_before(from);
            }
            let part = if !is_inner {
                Part {
                    columns: self.at.done..template.len(),
                    check: Check::Bounds,
                }
            } else if is_split {
                template.next_part(self.at.done, x)
            } else {
                Part {
                    columns: self.at.done..template.len(),
                    check: Check::Nothing,
                }
            };
            let progress = template.fill(format, patch, row, part, self.backend, out);
            filled += progress.written;
            self.at.done += progress.done;
            if self.at.done == template.len() {
                self.at.next_row();
            }
        }
        filled
    }

    /// Writes points of a patch that the sieve cuts, up to row `end`, or as many as there is room for.
    fn fill_sifted(&mut self, end: i64, out: &mut [F::Item]) -> usize {
        let Scope { lattice, x, .. } = &*self.scope;
        let Some(sifting) = &mut self.sieve else {
            return 0;
        };
        let (format, patch, base, by) = (&self.format, &self.patch, self.base, self.backend);
        let range = clip_to_band(self.band, &x.all);
        let scale = Scale::new(lattice, patch);
        let mut filled = 0;
        while self.at.y < end && filled < out.len() {
            let y = self.at.y;
            let Some((class, block)) = lattice.row(y) else {
                self.at.next_row();
                continue;
            };
            if sifting.next_strip(y, end, &range) {
                self.at = Place::row(sifting.runs_end);
                continue;
            }
            let columns = self.columns.of_row(lattice, class, block);
            let vectors = lattice.vectors(block);
            let template = self
                .templates
                .get(class, block, self.at.done > 0, |template, kept| {
                    let all = 0..columns.len();
                    template.make((format, base), patch, (columns, all), vectors, kept, by);
                });
            if let Some(from) = self.at.from.take() {
                let from = from.clamp(range.start, range.end);
                self.at.done = if lattice.has_all() {
                    sifting.prefix.before(class, from)
                } else {
                    columns.partition_point(|line| line.at < from)
                };
            }
            let row = Row {
                base,
                y: patch.relative(Axis::Y, y),
                lattice: y,
            };
            for run in &sifting.runs {
                let places = sifting.prefix.places(lattice, class, columns, &run.columns);
                let part = places.start.max(self.at.done)..places.end;
                if part.is_empty() {
                    continue;
                }
                let (start, out) = (part.start, &mut out[filled..]);
                let progress = if run.passes {
                    let part = Part {
                        columns: part,
                        check: Check::Nothing,
                    };
                    template.fill(format, patch, row, part, self.backend, out)
                } else {
                    let columns = displaced(patch, &columns[part], vectors);
                    let passes = |x, place| {
                        let id = PointId { x, y };
                        patch.holds(place) && sifting.patch.passes(run, id, scale.world(place))
                    };
                    sift(format, row, columns, (|p| patch.place(p), passes), out)
                };
                filled += progress.written;
                self.at.done = start + progress.done;
                if self.at.done < places.end {
                    return filled;
                }
            }
            self.at.next_row();
        }
        filled
    }
}
