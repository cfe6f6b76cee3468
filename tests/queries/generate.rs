//! Random queries, as JSON.

use serde_json::{Value, json};
use strew::service::Key;

/// Numbers that follow from one number (splitmix64).
pub struct Dice(u64);

impl Dice {
    pub fn new(number: u64) -> Self {
        Self(number)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// An integer from 0 to below `end`.
    pub fn below(&mut self, end: u64) -> u64 {
        self.next() % end.max(1)
    }

    /// A number from `min` to `max`.
    fn within(&mut self, min: f64, max: f64) -> f64 {
        min + (max - min) * (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// True once in `times`.
    pub fn once_in(&mut self, times: u64) -> bool {
        self.below(times) == 0
    }
}

/// Where regions lie: around a center, a few spacings wide.
struct Ground {
    center: [f64; 2],
    size: f64,
}

impl Ground {
    /// A place, sometimes one of few, so that edges meet.
    fn place(&self, dice: &mut Dice) -> [f64; 2] {
        self.center.map(|center| {
            let step = if dice.once_in(2) {
                dice.below(9) as f64 / 4.0 - 1.0
            } else {
                dice.within(-1.0, 1.0)
            };
            center + step * self.size
        })
    }
}

fn bbox(dice: &mut Dice, ground: &Ground) -> Value {
    let (a, b) = (ground.place(dice), ground.place(dice));
    let least = ground.size / 16.0;
    let [x, y] = [0, 1].map(|i| {
        let (low, high) = (a[i].min(b[i]), a[i].max(b[i]));
        [low, high.max(low + least)]
    });
    json!({ "bbox": [x[0], y[0], x[1], y[1]] })
}

/// A star around a place, which may cross itself, with a hole in it.
fn rings(dice: &mut Dice, ground: &Ground) -> Value {
    let [x, y] = ground.place(dice);
    let corners = 3 + dice.below(6);
    let is_wild = dice.once_in(4);
    let ring: Vec<[f64; 2]> = (0..corners)
        .map(|i| {
            let turn = if is_wild {
                dice.within(0.0, 1.0)
            } else {
                i as f64 / corners as f64
            };
            let (sin, cos) = (turn * std::f64::consts::TAU).sin_cos();
            let radius = dice.within(0.3, 1.0) * ground.size;
            [x + radius * cos, y + radius * sin]
        })
        .collect();
    let scale = dice.within(0.1, 0.6);
    let hole: Vec<[f64; 2]> = ring
        .iter()
        .map(|p| [x + (p[0] - x) * scale, y + (p[1] - y) * scale])
        .collect();
    if dice.once_in(2) {
        json!([ring, hole])
    } else {
        json!([ring])
    }
}

fn region(dice: &mut Dice, ground: &Ground, depth: u32) -> Value {
    match dice.below(if depth < 2 { 7 } else { 5 }) {
        0 => bbox(dice, ground),
        1 => {
            let center = ground.place(dice);
            let radius = ground.size * dice.within(0.1, 1.0);
            json!({ "circle": { "center": center, "radius": radius } })
        }
        2 => json!({ "polygon": { "type": "Polygon", "coordinates": rings(dice, ground) } }),
        3 => {
            let polygons: Vec<Value> = (0..=dice.below(3)).map(|_| rings(dice, ground)).collect();
            json!({ "polygon": { "type": "MultiPolygon", "coordinates": polygons } })
        }
        4 => {
            let size = ground.size * dice.within(0.5, 1.5);
            let [x, y] = ground.center.map(|c| (c / size).floor() as i64);
            json!({ "chunk": { "size": size, "x": x, "y": y } })
        }
        _ => {
            let mut some = |most| -> Vec<Value> {
                (0..=dice.below(most))
                    .map(|_| region(dice, ground, depth + 1))
                    .collect()
            };
            let include = some(3);
            let exclude = some(2);
            json!({ "include": include, "exclude": exclude })
        }
    }
}

fn set(dice: &mut Dice, keys: &[Key], promising: &[bool], spacing: f64, counts: bool) -> Value {
    let at = dice.below(keys.len() as u64) as usize;
    let key = &keys[at];
    let mut set = json!({
        "profile": *key.profile,
        "alpha": key.alpha.to_string(),
        "map": key.size.to_string(),
    });
    let spacing = spacing * dice.within(0.7, 1.5);
    match dice.below(10) {
        0 => set["density"] = json!(1.0 / (spacing * spacing)),
        1 if promising[at] => set["min_distance"] = json!(spacing * 0.6),
        2 if counts => set["count"] = json!(1 + dice.below(120)),
        _ => set["spacing"] = json!(spacing),
    }
    match dice.below(3) {
        0 => {}
        1 => set["seed"] = json!(1 + dice.below(5)),
        _ => set["seed"] = json!(dice.next()),
    }
    match dice.below(6) {
        0 => set["warp"] = json!("off"),
        1 => set["warp"] = json!("on"),
        2 => set["warp"] = json!(dice.within(0.0, 2.0)),
        _ => {}
    }
    if dice.once_in(4) {
        set["keep"] = json!(dice.within(0.2, 1.0));
    }
    if dice.once_in(5) {
        set["attributes"] = json!(["rank", "angle"]);
    }
    set
}

/// A query.
pub fn query(dice: &mut Dice, keys: &[Key], promising: &[bool]) -> Value {
    let spacing = 10f64.powf(dice.within(-3.0, 3.0));
    let far = if dice.once_in(3) { 1e7 } else { 30.0 };
    let ground = Ground {
        center: [0; 2].map(|_| dice.within(-far, far) * spacing),
        size: spacing * dice.within(1.5, 6.0),
    };
    let region = region(dice, &ground, 0);
    if dice.below(3) > 0 {
        let mut body = set(dice, keys, promising, spacing, true);
        body["region"] = region;
        return body;
    }
    let names = ["trees", "bushes", "rocks", "grass"];
    let number = 1 + dice.below(names.len() as u64) as usize;
    let mut layers = vec![];
    for (i, name) in names[..number].iter().enumerate() {
        let mut clear_of = serde_json::Map::new();
        for earlier in &names[..i] {
            if dice.once_in(3) {
                let distance = spacing * dice.within(0.2, 1.2);
                clear_of.insert((*earlier).into(), json!(distance));
            }
        }
        let mut layer = set(dice, keys, promising, spacing, clear_of.is_empty());
        layer["name"] = json!(name);
        if !clear_of.is_empty() {
            layer["clear_of"] = Value::Object(clear_of);
        }
        // A count in a region of its own may have nowhere to go.
        if layer.get("count").is_none() && dice.once_in(3) {
            layer["region"] = self::region(dice, &ground, 1);
        }
        layers.push(layer);
    }
    json!({ "region": region, "layers": layers })
}
