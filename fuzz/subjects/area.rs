//! Areas, from bytes: boxes, disks, polygons and combinations of them, anywhere on the plane, the edge of
//! the coordinates' range included. A plan is compared with a test of every point of the box around.

use strew_core::{
    Area, Circle, Keep, Placement, Plan, Point, PointSet, Polygon, Region, Seed, Spacing, Warp,
};

/// The widest and highest area that is listed, in mean spacings.
const MOST_SPACINGS: f64 = 60.0;
/// The most parts of an area.
const MOST_PARTS: usize = 8;
/// The most corners of a ring.
const MOST_CORNERS: usize = 12;

/// Bytes, taken one after another; zeros when they are used up.
struct Tape<'a>(&'a [u8]);

impl Tape<'_> {
    fn byte(&mut self) -> u8 {
        let Some((&first, rest)) = self.0.split_first() else {
            return 0;
        };
        self.0 = rest;
        first
    }

    fn bits(&mut self) -> u64 {
        (0..8).fold(0, |bits, _| bits << 8 | u64::from(self.byte()))
    }

    /// A place near the center: any number at all, or one of few, so that edges and corners meet.
    fn place(&mut self, center: f64, step: f64) -> f64 {
        match self.byte() {
            255 => f64::from_bits(self.bits()),
            254 => f64::from(self.byte()),
            byte if byte % 2 == 0 => center + f64::from(byte as i8 / 8) * step,
            byte => center + (f64::from(byte as i8) + f64::from(self.byte()) / 256.0) / 8.0 * step,
        }
    }
}

/// Where areas lie.
struct Ground {
    center: [f64; 2],
    step: f64,
}

impl Ground {
    fn point(&self, tape: &mut Tape<'_>) -> [f64; 2] {
        self.center.map(|center| tape.place(center, self.step))
    }
}

fn area(tape: &mut Tape<'_>, ground: &Ground) -> Option<Area> {
    let mut parts: Vec<Area> = vec![];
    for _ in 0..1 + usize::from(tape.byte()) % MOST_PARTS {
        let part = match tape.byte() % 6 {
            0 => {
                let (a, b) = (ground.point(tape), ground.point(tape));
                let min = [0, 1].map(|i| a[i].min(b[i]));
                Region::new(min, [0, 1].map(|i| a[i].max(b[i])))
                    .ok()?
                    .into()
            }
            1 => {
                let center = ground.point(tape);
                let radius = f64::from(tape.byte()) / 8.0 * ground.step;
                Circle::new(center, radius).ok()?.into()
            }
            2 | 3 => {
                let rings: Vec<Vec<[f64; 2]>> = (0..1 + tape.byte() % 3)
                    .map(|_| {
                        let corners = 3 + usize::from(tape.byte()) % MOST_CORNERS;
                        (0..corners).map(|_| ground.point(tape)).collect()
                    })
                    .collect();
                Polygon::new(&rings).ok()?.into()
            }
            4 => parts.pop()?.and(parts.pop()?),
            _ => parts.pop()?.without(parts.pop()),
        };
        parts.push(part);
    }
    Some(Area::any_of(parts))
}

fn set(tape: &mut Tape<'_>) -> Option<(PointSet, Ground)> {
    let spacing = match tape.byte() {
        255 => f64::from_bits(tape.bits()),
        byte => 2f64.powi(i32::from(byte as i8) / 4),
    };
    let spacing = Spacing::new(spacing).ok()?;
    let warp = match tape.byte() {
        0..128 => Warp::OFF,
        byte => Warp::new(f64::from(byte - 128) / 64.0).ok()?,
    };
    let keep = match tape.byte() {
        0..192 => Keep::ALL,
        byte => Keep::new(f64::from(byte - 191) / 64.0).ok()?,
    };
    let seed = Seed(u64::from(tape.byte()));
    let placement = Placement::new(spacing, seed)
        .with_warp(warp)
        .with_keep(keep);
    let set = PointSet::blue().placed(placement);
    let limit = set.limit();
    let center = [0, 1].map(|_| match tape.byte() {
        byte @ 0..100 => f64::from(byte as i8) * spacing.get(),
        byte @ 100..130 => f64::from(byte as i8) / 128.0 * limit,
        byte @ 130..160 => limit - f64::from(byte - 130) * spacing.get(),
        byte @ 160..190 => f64::from(byte - 160) * spacing.get() - limit,
        byte => limit / f64::from(u32::from(byte - 189)).exp2(),
    });
    let step = spacing.get();
    Some((set, Ground { center, step }))
}

fn list(plan: &Plan) -> Vec<Point> {
    let points = plan.to_vec();
    assert_eq!(points.len() as u128, plan.count());
    points
}

pub fn run(data: &[u8]) {
    let mut tape = Tape(data);
    let Some((set, ground)) = set(&mut tape) else {
        return;
    };
    let Some(area) = area(&mut tape, &ground) else {
        return;
    };
    let Some(bounds) = area.bounds() else { return };
    let extent = [0, 1].map(|i| (bounds.max()[i] - bounds.min()[i]) / ground.step);
    if extent.iter().any(|&e| e.is_nan() || e > MOST_SPACINGS) {
        return;
    }
    let placement = set.placement();
    let (around, plan) = (set.within(bounds), set.within(area.clone()));
    let (Ok(around), Ok(plan)) = (around, plan) else {
        return;
    };
    let mut expected = list(&around);
    expected.retain(|p| area.contains(p.at()));
    let points = list(&plan);
    assert_eq!(points, expected, "{placement:?} {area:?}");

    // A window of it, and the points from its cursor on.
    let offset = usize::from(tape.byte()).min(points.len());
    let limit = usize::from(tape.byte());
    let window = plan.window(offset as u128, Some(limit as u128));
    let end = points.len().min(offset + limit);
    assert_eq!(list(&window), points[offset..end], "{placement:?} {area:?}");
    if let Some(cursor) = window.next_cursor() {
        let resumed = set.resume(area.clone(), cursor).expect("planned before");
        assert_eq!(list(&resumed), points[end..], "{placement:?} {area:?}");
    }
}
