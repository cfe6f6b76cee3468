//! A short run of the fuzzed subjects (`fuzz/`) without a fuzzer: their seeds, inputs that once
//! failed, and pseudo-random changes of both, the same in every run.

#[path = "../../fuzz/subjects/mod.rs"]
mod subjects;

use std::{fs, path::Path};

use strew_testkit::random::SplitMix;

use subjects::SUBJECTS;

/// The number of changed inputs tried for each subject.
const CHANGED: u64 = 1500;

/// The longest input that repetition makes.
const LONGEST: usize = 1 << 20;

/// An input with a few bytes changed, cut out, inserted, or taken from another one; of some, a few bytes
/// are repeated up to thousands of times.
fn changed(random: &mut SplitMix, inputs: &[Vec<u8>]) -> Vec<u8> {
    let mut bytes = inputs[random.index(inputs.len())].clone();
    for _ in 0..=random.below(4) {
        let at = random.index(bytes.len() + 1);
        let end = bytes.len().min(at + random.index(9));
        match random.below(4) {
            0 if at < bytes.len() => bytes[at] = random.bits() as u8,
            1 => drop(bytes.drain(at..end)),
            2 => {
                let odd = [
                    b'0', b'9', b'-', b'.', b'e', b',', b'[', b'{', b'"', 0xff, 0,
                ];
                bytes.insert(at, odd[random.index(odd.len())]);
            }
            _ => {
                let other = &inputs[random.index(inputs.len())];
                let from = random.index(other.len());
                let part = from..other.len().min(from + random.index(20));
                bytes.splice(at..end, other[part].iter().copied());
            }
        }
    }
    if random.below(32) == 0 {
        let at = random.index(bytes.len() + 1);
        let end = bytes.len().min(at + 1 + random.index(24));
        let times = (1 << random.below(17)).min(LONGEST / (end - at + 1));
        let again = bytes[at..end].repeat(times);
        bytes.splice(at..at, again);
    }
    bytes
}

/// The inputs of a subject in a folder of `fuzz/`, in the order of their names.
fn inputs(folder: &str, name: &str) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("fuzz")
        .join(folder);
    let Ok(entries) = fs::read_dir(folder.join(name)) else {
        return vec![];
    };
    let mut paths: Vec<_> = entries.map(|e| e.expect("readable").path()).collect();
    paths.sort();
    paths.iter().map(|path| input(path)).collect()
}

/// The input in a file. A file named `….repeat` describes one that is repetition. Its lines say how often to repeat which
/// words; words are hexadecimal digits, and may be repeated themselves:
///
/// ```text
/// # The byte 00, then 2000 times: 12 68, and 50 times 0a 00.
/// 1 00
/// 2000 1268 0a00*50
/// ```
fn input(path: &Path) -> Vec<u8> {
    let bytes = fs::read(path).expect("readable");
    if path.extension().is_none_or(|ending| ending != "repeat") {
        return bytes;
    }
    let text = String::from_utf8(bytes).expect("UTF-8");
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    let repeated = lines.map(|line| {
        let (times, words) = line.split_once(' ').expect("a number and words");
        let words: Vec<Vec<u8>> = words.split(' ').map(word).collect();
        words.concat().repeat(times.parse().expect("a number"))
    });
    repeated.collect::<Vec<_>>().concat()
}

/// The bytes of `DIGITS` or `DIGITS*TIMES`.
fn word(text: &str) -> Vec<u8> {
    let (digits, times) = text.split_once('*').unwrap_or((text, "1"));
    let byte = |at| u8::from_str_radix(&digits[at..at + 2], 16).expect("two digits");
    let bytes: Vec<u8> = (0..digits.len()).step_by(2).map(byte).collect();
    bytes.repeat(times.parse().expect("a number"))
}

#[test]
fn seeds_regressions_and_changes_of_them_break_nothing_and_take_little() {
    for (number, subject) in (0..).zip(SUBJECTS) {
        let mut known = inputs("seeds", subject.name);
        assert!(!known.is_empty(), "{} has seeds", subject.name);
        known.extend(inputs("regressions", subject.name));
        known.iter().for_each(|input| subject.check(input));
        let mut random = SplitMix::new(number);
        for _ in 0..CHANGED {
            subject.check(&changed(&mut random, &known));
        }
    }
}
