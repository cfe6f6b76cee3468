//! Counts, windows, cursors and splits agree with the whole answer, for 10,000 random queries: all
//! kinds of regions, all built-in profiles, warps, shares, layers, and every way to set the amount.
//!
//! Queries are read from JSON, as a client sends them; answers are compared as CSV with ids.

mod generate;
mod library;

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use serde_json::{Value, json};
use strew_encode::{Encoding, Output};
use strew_error::{Error, Fault};
use strew_plan::Planned;
use strew_testkit::random::SplitMix;

use library::{Library, library, with};

const QUERIES: u64 = 10_000;

/// The lines of an answer as CSV, without the column names.
fn lines(planned: &Planned, block_bytes: usize) -> Vec<String> {
    let answer = planned
        .answer(&Output::new(Encoding::Csv), block_bytes)
        .expect("fits");
    let mut text = vec![];
    for block in answer {
        text.extend_from_slice(&block.expect("written"));
    }
    let text = String::from_utf8(text).expect("UTF-8");
    text.lines().skip(1).map(Into::into).collect()
}

/// Checks a query with its windows, pages and splits. Returns the number of points, or `None` if
/// the query is refused for a valid reason.
fn check(library: &Library, random: &mut SplitMix, body: &Value) -> Option<usize> {
    let whole = match library.planned(body) {
        Ok(planned) => planned,
        // In a region that holds next to nothing, a count may have no spacing, or one so narrow
        // that the distance to keep clear is too wide for it.
        Err(Error::Invalid(faults)) if faults.as_slice().iter().all(is_about_counts) => {
            return None;
        }
        Err(error) => panic!("{error}: {body}"),
    };
    let all = lines(&whole, 1 << 14);
    assert_eq!(whole.count(), all.len() as u128, "{body}");
    if let Some(count) = body.get("count") {
        assert_eq!(*count, all.len(), "{body}");
    }
    assert_eq!(whole.offset(), 0, "{body}");
    assert!(whole.next().is_none(), "{body}");
    let of = |body: &Value| {
        let planned = library
            .planned(body)
            .unwrap_or_else(|e| panic!("{e}: {body}"));
        let lines = lines(&planned, 500);
        assert_eq!(planned.count(), lines.len() as u128, "{body}");
        (planned, lines)
    };

    // A window, and what follows it.
    let offset = random.below(all.len() as u64 + 3) as usize;
    let limit = 1 + random.below(all.len() as u64 + 3) as usize;
    let (start, end) = (offset.min(all.len()), (offset + limit).min(all.len()));
    let asked = with(body, &[("offset", json!(offset)), ("limit", json!(limit))]);
    let (window, some) = of(&asked);
    assert_eq!(some, all[start..end], "{asked}");
    assert_eq!(window.offset(), start as u128, "{asked}");
    assert_eq!(window.next().is_some(), end < all.len(), "{asked}");
    if let Some(token) = window.next() {
        let rest = with(body, &[("cursor", json!(token.to_string()))]);
        let (resumed, some) = of(&rest);
        assert_eq!(some, all[end..], "{rest}");
        assert_eq!(resumed.offset(), end as u128, "{rest}");
        // An offset counts from the cursor.
        let (skip, most) = (random.below(20) as usize, 1 + random.below(30) as usize);
        let asked = with(&rest, &[("offset", json!(skip)), ("limit", json!(most))]);
        let (window, some) = of(&asked);
        let start = (end + skip).min(all.len());
        let end = (start + most).min(all.len());
        assert_eq!(some, all[start..end], "{asked}");
        assert_eq!(window.next().is_some(), end < all.len(), "{asked}");
        if random.below(3) == 0 {
            check_split(library, random, &window, &asked, &all[start..end]);
        }
    }

    check_split(library, random, &whole, body, &all);
    // Page after page, to the end.
    let page = 1 + all.len().div_ceil(1 + random.below(3) as usize);
    let mut next = None;
    let mut read = vec![];
    loop {
        let mut asked = with(body, &[("limit", json!(page))]);
        if let Some(token) = next {
            asked["cursor"] = json!(token);
        }
        let (planned, lines) = of(&asked);
        assert_eq!(planned.offset(), read.len() as u128, "{asked}");
        read.extend(lines);
        next = planned.next().map(|token| token.to_string());
        if next.is_none() {
            break;
        }
    }
    assert_eq!(read, all, "{body}");
    Some(all.len())
}

fn is_about_counts(fault: &Fault) -> bool {
    fault.field.ends_with("count") || fault.field.ends_with("clear_of")
}

/// Checks that the parts of a split, each read by itself, make the whole.
fn check_split(
    library: &Library,
    random: &mut SplitMix,
    planned: &Planned,
    body: &Value,
    all: &[String],
) {
    let parts = 1 + random.below(4) as u32;
    if parts == 1 {
        return;
    }
    let split = planned.split(parts).expect("small");
    assert_eq!(split.len(), all.len().min(parts as usize), "{body}");
    let mut body = body.clone();
    body.as_object_mut().expect("an object").remove("offset");
    let mut read = vec![];
    for (token, count) in split {
        let wanted = [
            ("cursor", json!(token.to_string())),
            ("limit", json!(count)),
        ];
        let asked = with(&body, &wanted);
        let part = library
            .planned(&asked)
            .unwrap_or_else(|e| panic!("{e}: {asked}"));
        assert_eq!(part.count(), u128::from(count), "{asked}");
        assert!(count.abs_diff((all.len() / parts as usize) as u64) <= 1);
        read.extend(lines(&part, 300));
    }
    assert_eq!(read, all, "{body}");
}

#[test]
fn counts_windows_cursors_and_splits_agree_with_streams() {
    let library = library();
    let (keys, promising) = library.keys();
    let (points, refused) = (AtomicUsize::new(0), AtomicUsize::new(0));
    (0..QUERIES).into_par_iter().for_each(|number| {
        let mut random = SplitMix::new(number);
        let body = generate::query(&mut random, &keys, &promising);
        match check(library, &mut random, &body) {
            Some(found) => points.fetch_add(found, Ordering::Relaxed),
            None => refused.fetch_add(1, Ordering::Relaxed),
        };
    });
    let (points, refused) = (points.into_inner(), refused.into_inner() as u64);
    eprintln!("{QUERIES} queries, {points} points, {refused} refused");
    // Most queries were answered, with many points.
    assert!(points as u64 > 20 * QUERIES && refused < QUERIES / 50);
}
