//! Import circles: a crate's files that all lead to each other.

use super::imports::components;

/// Fails if files in one of these source folders import each other in a circle.
pub fn check(folders: &[String], sources: &[(String, String)]) {
    let circles: Vec<String> = folders
        .iter()
        .flat_map(|folder| {
            let inside = |(name, text): &(String, String)| {
                let name = name.strip_prefix(folder.as_str())?.strip_prefix('/')?;
                Some((name.to_owned(), text.clone()))
            };
            let components = components(&sources.iter().filter_map(inside).collect());
            let circles = components.into_iter().flatten();
            circles.map(move |(file, circle)| format!("{folder}/{file}: {circle}"))
        })
        .collect();
    assert!(circles.is_empty(), "{}", circles.join("\n"));
}
