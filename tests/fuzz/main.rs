//! A short pass of the fuzzed subjects (`fuzz/`): their seeds, what once went wrong, and changes of
//! both that follow from a number, so that every run is the same.

#[path = "../../fuzz/subjects/mod.rs"]
mod subjects;

use std::{fs, path::Path};

use subjects::SUBJECTS;

/// How many changed inputs of a subject are tried.
const CHANGED: u64 = 1500;

/// Numbers that follow from one number (splitmix64).
struct Dice(u64);

impl Dice {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % end.max(1) as u64) as usize
    }

    /// An input with a few bytes changed, cut out, put in, or taken from another one.
    fn changed(&mut self, inputs: &[Vec<u8>]) -> Vec<u8> {
        let mut bytes = inputs[self.below(inputs.len())].clone();
        for _ in 0..=self.below(4) {
            let at = self.below(bytes.len() + 1);
            let end = bytes.len().min(at + self.below(9));
            match self.below(4) {
                0 if at < bytes.len() => bytes[at] = self.below(256) as u8,
                1 => drop(bytes.drain(at..end)),
                2 => {
                    let odd = [
                        b'0', b'9', b'-', b'.', b'e', b',', b'[', b'{', b'"', 0xff, 0,
                    ];
                    bytes.insert(at, odd[self.below(odd.len())]);
                }
                _ => {
                    let other = &inputs[self.below(inputs.len())];
                    let from = self.below(other.len());
                    let part = from..other.len().min(from + self.below(20));
                    bytes.splice(at..end, other[part].iter().copied());
                }
            }
        }
        bytes
    }
}

fn inputs(folder: &str, name: &str) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("fuzz")
        .join(folder);
    let Ok(entries) = fs::read_dir(folder.join(name)) else {
        return vec![];
    };
    let mut paths: Vec<_> = entries.map(|e| e.expect("readable").path()).collect();
    paths.sort();
    let read = |path| fs::read(path).expect("readable");
    paths.into_iter().map(read).collect()
}

#[test]
fn seeds_regressions_and_changes_of_them_break_nothing() {
    std::thread::scope(|scope| {
        for (number, subject) in (0..).zip(SUBJECTS) {
            let run = move || {
                let mut known = inputs("seeds", subject.name);
                assert!(!known.is_empty(), "{} has seeds", subject.name);
                known.extend(inputs("regressions", subject.name));
                known.iter().for_each(|input| (subject.run)(input));
                let mut dice = Dice(number);
                for _ in 0..CHANGED {
                    (subject.run)(&dice.changed(&known));
                }
            };
            let thread = std::thread::Builder::new().name(subject.name.into());
            thread.spawn_scoped(scope, run).expect("a thread");
        }
    });
}
