//! A chunked world around a moving camera, drawn in the terminal.
//!
//! Chunks are loaded as they come near and dropped as they fall behind. Whatever the path of the camera,
//! a chunk that comes back has the same trees and rocks.
//!
//! ```sh
//! cargo run --release -p strew-core --example world
//! ```

use std::{collections::BTreeMap, io::IsTerminal as _, thread, time::Duration};

use strew_core::{Error, Member, PointSet, Variants};

/// The side of a chunk in world units.
const CHUNK: f64 = 16.0;
/// The size of the view: a character is one unit wide and two high.
const VIEW: [i64; 2] = [72, 20];
const FRAMES: u32 = 60;

/// The objects of a chunk.
struct Chunk {
    rocks: Vec<Member>,
    trees: Vec<Member>,
}

struct World {
    rocks: PointSet,
    trees: PointSet,
    kinds: Variants,
    chunks: BTreeMap<[i64; 2], Chunk>,
    loaded: usize,
}

impl World {
    fn new() -> Result<Self, Error> {
        let rocks = PointSet::blue().spacing(9.0)?.seed(1);
        let trees = PointSet::blue().spacing(3.5)?.seed(2);
        Ok(Self {
            trees: trees.clear_of(&rocks, 2.5)?,
            rocks,
            kinds: "oak:3,birch:1".parse()?,
            chunks: BTreeMap::new(),
            loaded: 0,
        })
    }

    /// Loads the chunks that a view touches and drops all others.
    fn show(&mut self, corner: [i64; 2]) -> Result<(), Error> {
        let chunk = |v: i64| (v as f64 / CHUNK).floor() as i64;
        let [left, bottom] = corner.map(chunk);
        let [right, top] = [chunk(corner[0] + VIEW[0]), chunk(corner[1] + 2 * VIEW[1])];
        self.chunks
            .retain(|&[x, y], _| (left..=right).contains(&x) && (bottom..=top).contains(&y));
        for at in (bottom..=top).flat_map(|y| (left..=right).map(move |x| [x, y])) {
            if !self.chunks.contains_key(&at) {
                let rocks = self.rocks.chunk(CHUNK, at)?.iter().collect();
                let trees = self.trees.chunk(CHUNK, at)?.iter().collect();
                self.chunks.insert(at, Chunk { rocks, trees });
                self.loaded += 1;
            }
        }
        Ok(())
    }

    fn draw(&self, corner: [i64; 2]) -> String {
        let [width, height] = VIEW.map(|v| v as usize);
        let mut view = vec![vec![' '; width]; height];
        let mut put = |member: &Member, sign: char| {
            let [x, y] = member.at();
            let column = (x - corner[0] as f64).floor();
            let row = ((y - corner[1] as f64) / 2.0).floor();
            if (0.0..width as f64).contains(&column) && (0.0..height as f64).contains(&row) {
                view[height - 1 - row as usize][column as usize] = sign;
            }
        };
        for chunk in self.chunks.values() {
            for tree in &chunk.trees {
                let is_oak = tree.variant(&self.kinds) == "oak";
                put(tree, if is_oak { 'o' } else { 'i' });
            }
            chunk.rocks.iter().for_each(|rock| put(rock, '#'));
        }
        let lines = view.into_iter().map(|line| line.into_iter().collect());
        lines.collect::<Vec<String>>().join("\n")
    }
}

fn main() -> Result<(), Error> {
    let mut world = World::new()?;
    // Without a terminal only the last frame is printed.
    let is_live = std::io::stdout().is_terminal();
    for frame in 0..FRAMES {
        let angle = f64::from(frame) / 20.0;
        let corner = [(120.0 * angle.sin()) as i64, (90.0 * angle.cos()) as i64];
        world.show(corner)?;
        if is_live {
            println!("\x1b[2J\x1b[H{}", world.draw(corner));
            thread::sleep(Duration::from_millis(60));
        } else if frame + 1 == FRAMES {
            println!("{}", world.draw(corner));
        }
    }
    println!(
        "o oaks, i birches, # rocks; {} chunks loaded on the way, {} at the end",
        world.loaded,
        world.chunks.len()
    );
    Ok(())
}
