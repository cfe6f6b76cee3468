//! Random queries of all kinds, as JSON.

use serde_json::{Value, json};
use strew_catalog::Key;
use strew_testkit::random::SplitMix;

/// Where regions are: around a center, a few spacings wide.
struct Ground {
    center: [f64; 2],
    size: f64,
}

impl Ground {
    /// A random place. Half of the coordinates are one of nine, so that edges coincide.
    fn place(&self, random: &mut SplitMix) -> [f64; 2] {
        self.center.map(|center| {
            let step = if random.once_in(2) {
                random.below(9) as f64 / 4.0 - 1.0
            } else {
                random.within(-1.0, 1.0)
            };
            center + step * self.size
        })
    }
}

fn bbox(random: &mut SplitMix, ground: &Ground) -> Value {
    let (a, b) = (ground.place(random), ground.place(random));
    let least = ground.size / 16.0;
    let [x, y] = [0, 1].map(|i| {
        let (low, high) = (a[i].min(b[i]), a[i].max(b[i]));
        [low, high.max(low + least)]
    });
    json!({ "bbox": [x[0], y[0], x[1], y[1]] })
}

/// The rings of a star around a random place. It may cross itself and may have a hole.
fn rings(random: &mut SplitMix, ground: &Ground) -> Value {
    let [x, y] = ground.place(random);
    let corners = 3 + random.below(6);
    let is_wild = random.once_in(4);
    let ring: Vec<[f64; 2]> = (0..corners)
        .map(|i| {
            let turn = if is_wild {
                random.within(0.0, 1.0)
            } else {
                i as f64 / corners as f64
            };
            let (sin, cos) = (turn * std::f64::consts::TAU).sin_cos();
            let radius = random.within(0.3, 1.0) * ground.size;
            [x + radius * cos, y + radius * sin]
        })
        .collect();
    let scale = random.within(0.1, 0.6);
    let hole: Vec<[f64; 2]> = ring
        .iter()
        .map(|p| [x + (p[0] - x) * scale, y + (p[1] - y) * scale])
        .collect();
    if random.once_in(2) {
        json!([ring, hole])
    } else {
        json!([ring])
    }
}

fn region(random: &mut SplitMix, ground: &Ground, depth: u32) -> Value {
    match random.below(if depth < 2 { 7 } else { 5 }) {
        0 => bbox(random, ground),
        1 => {
            let center = ground.place(random);
            let radius = ground.size * random.within(0.1, 1.0);
            json!({ "circle": { "center": center, "radius": radius } })
        }
        2 => json!({ "polygon": { "type": "Polygon", "coordinates": rings(random, ground) } }),
        3 => {
            let polygons: Vec<Value> = (0..=random.below(3))
                .map(|_| rings(random, ground))
                .collect();
            json!({ "polygon": { "type": "MultiPolygon", "coordinates": polygons } })
        }
        4 => {
            let size = ground.size * random.within(0.5, 1.5);
            let [x, y] = ground.center.map(|c| (c / size).floor() as i64);
            json!({ "chunk": { "size": size, "x": x, "y": y } })
        }
        _ => {
            let mut some = |most| -> Vec<Value> {
                (0..=random.below(most))
                    .map(|_| region(random, ground, depth + 1))
                    .collect()
            };
            let include = some(3);
            let exclude = some(2);
            json!({ "include": include, "exclude": exclude })
        }
    }
}

fn set(
    random: &mut SplitMix,
    keys: &[Key],
    promising: &[bool],
    spacing: f64,
    counts: bool,
) -> Value {
    let at = random.below(keys.len() as u64) as usize;
    let key = &keys[at];
    let mut set = json!({
        "profile": *key.profile,
        "alpha": key.alpha.to_string(),
        "map": key.size.to_string(),
    });
    let spacing = spacing * random.within(0.7, 1.5);
    match random.below(10) {
        0 => set["density"] = json!(1.0 / (spacing * spacing)),
        1 if promising[at] => set["min_distance"] = json!(spacing * 0.6),
        2 if counts => {
            let most = if random.once_in(16) { 5000 } else { 120 };
            set["count"] = json!(1 + random.below(most));
        }
        _ => set["spacing"] = json!(spacing),
    }
    match random.below(3) {
        0 => {}
        1 => set["seed"] = json!(1 + random.below(5)),
        _ => set["seed"] = json!(random.bits()),
    }
    match random.below(6) {
        0 => set["warp"] = json!("off"),
        1 => set["warp"] = json!("on"),
        2 => set["warp"] = json!(random.within(0.0, 2.0)),
        _ => {}
    }
    if random.once_in(4) {
        set["keep"] = json!(random.within(0.2, 1.0));
    }
    if random.once_in(5) {
        set["attributes"] = json!(["rank", "angle"]);
    }
    set
}

/// A random query on one of the tables `keys`; `promising` decides which of them guarantee a distance.
pub fn query(random: &mut SplitMix, keys: &[Key], promising: &[bool]) -> Value {
    let spacing = 10f64.powf(random.within(-3.0, 3.0));
    let far = if random.once_in(3) { 1e7 } else { 30.0 };
    let ground = Ground {
        center: [0; 2].map(|_| random.within(-far, far) * spacing),
        size: spacing * random.within(1.5, 6.0),
    };
    let region = region(random, &ground, 0);
    if random.below(3) > 0 {
        let mut body = set(random, keys, promising, spacing, true);
        body["region"] = region;
        return body;
    }
    let names = ["trees", "bushes", "rocks", "grass"];
    let number = 1 + random.below(names.len() as u64) as usize;
    let mut layers = vec![];
    for (i, name) in names[..number].iter().enumerate() {
        let mut clear_of = serde_json::Map::new();
        for earlier in &names[..i] {
            if random.once_in(3) {
                let distance = spacing * random.within(0.2, 1.2);
                clear_of.insert((*earlier).into(), json!(distance));
            }
        }
        let mut layer = set(random, keys, promising, spacing, clear_of.is_empty());
        layer["name"] = json!(name);
        if !clear_of.is_empty() {
            layer["clear_of"] = Value::Object(clear_of);
        }
        // A count may be too large for a region of its own.
        if layer.get("count").is_none() && random.once_in(3) {
            layer["region"] = self::region(random, &ground, 1);
        }
        layers.push(layer);
    }
    json!({ "region": region, "layers": layers })
}
