//! Small boxes with a cold plan, circles and polygons, compared with the bulk rate of a box.

use rounds::{Turns, cold_boxes, filling_area, giga, micros, sets, size, star};
use strew_core::{Area, Circle, Region};

mod rounds;

fn main() {
    let points = size(1e7f64, 1e4);
    let radius = (points / std::f64::consts::PI).sqrt();
    let [plain, warped] = sets();
    let square = Region::new([0.0; 2], [points.sqrt(); 2]).expect("ordered");
    let circle = Circle::new([0.0, 0.0], radius).expect("valid");
    let areas: [(&str, Area); 4] = [
        ("box", square.into()),
        ("circle", circle.into()),
        ("regular, 100 vertices", star(radius, 1.0).into()),
        ("star, 100 vertices", star(radius / 0.9, 0.8).into()),
    ];
    let mut turns = Turns::new(15);
    for (name, area) in &areas {
        turns.case(name, filling_area(&plain, area));
    }
    let bulk = turns.run();
    let over = |seconds| bulk["box"] / seconds;
    let title = format!("{points:e} points of f32, one core, plans included");
    bulk.print(title, &[("G points/s", &giga), ("÷ box", &over)]);
    let boxes = size(1000, 10);
    let times = Turns::new(15)
        .case("plain", cold_boxes(&plain, boxes))
        .case("warped", cold_boxes(&warped, boxes))
        .run();
    let bulk = 1e9 * bulk["box"];
    let title = format!("boxes of 1,000 points, each elsewhere; 1,000 points in bulk {bulk:.2} µs");
    times.print(title, &[("µs a box", &micros)]);
}
