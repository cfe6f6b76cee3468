//! Settings with which static servers answer as the daemon does: content types, headers, and no other query.

use strew_core::ALGORITHM_VERSION;
use strew_query::parameters::FORMAT;

use super::{
    grid::{Grid, Level},
    spec::{Spec, WorldName},
};
use crate::cli::compression::Compression;

/// Settings for nginx, to be included in a server whose root is the export.
pub(super) const NGINX: &str = "strew.nginx.conf";
/// Headers for hosts of static pages (Netlify, Cloudflare Pages).
pub(super) const HEADERS: &str = "_headers";

const LOCATION: &str = include_str!("nginx.conf");

/// Headers that let pages of all origins read answers, as the daemon's default settings do.
const ORIGINS: [(&str, &str); 2] = [
    ("access-control-allow-origin", "*"),
    ("access-control-expose-headers", "*"),
];

#[derive(Clone, Debug)]
pub(super) struct Served<'a> {
    pub(super) spec: &'a Spec,
    pub(super) grid: &'a Grid,
    pub(super) tables: String,
    pub(super) columns: Option<&'a str>,
}

impl Served<'_> {
    /// The headers of all chunks.
    fn constant(&self) -> Vec<(&'static str, String)> {
        let mut headers = ORIGINS
            .map(|(name, value)| (name, value.to_owned()))
            .to_vec();
        headers.extend([
            ("strew-table", self.tables.clone()),
            ("strew-algorithm", ALGORITHM_VERSION.to_string()),
        ]);
        let world = self.spec.world.iter();
        headers.extend(world.map(|world| ("strew-world", world.digest.clone())));
        headers.extend(
            self.columns
                .map(|columns| ("strew-columns", columns.to_owned())),
        );
        headers
    }

    pub(super) fn nginx(&self) -> String {
        let mut text = String::from(
            "# Answers as the daemon does, from the files of this folder. Include it in a server:\n\
             #     server { listen 80; root /srv/world; include /srv/world/strew.nginx.conf; }\n",
        );
        if self.spec.compressions().contains(&Compression::Gzip) {
            text += "gzip_static on;\n";
        }
        if let Some(WorldName { name, .. }) = &self.spec.world {
            let headers = ORIGINS.map(|(name, value)| (name, value.to_owned()));
            text += &format!(
                "location = /v1/worlds/{name} {{\n    types {{ }}\n    default_type application/json;\n    try_files \
                 /v1/worlds/{name}/index.json =404;\n{}}}\n",
                added(&headers)
            );
        }
        text.extend(self.grid.levels.iter().map(|level| self.location(level)));
        text
    }

    fn location(&self, level: &Level) -> String {
        let mut pairs: Vec<String> = level.query.split('&').map(escaped).collect();
        pairs.retain(|pair| !pair.is_empty());
        if let Some(world) = &self.spec.world {
            pairs.push(format!("world_digest={}", world.digest));
        }
        // Values are compared as addresses have them, encoded as in the level's query. Addresses may omit the format of a
        // world's files, on which points do not depend.
        let given = { level.query.split('&') }.filter_map(|pair| pair.split_once('='));
        let given = given.filter(|(name, _)| self.spec.world.is_none() || *name != FORMAT.name);
        let given: String = given
            .map(|(name, value)| format!("    if ($arg_{name} != \"{value}\") {{ return 404; }}\n"))
            .collect();
        [
            ("{folder}", self.grid.folder(level)),
            ("{pairs}", pairs.join("|")),
            ("{given}", given),
            ("{content_type}", self.spec.content_type.clone()),
            ("{headers}", added(&self.constant())),
        ]
        .iter()
        .fold(LOCATION.into(), |text: String, (name, value)| {
            text.replace(name, value)
        })
    }

    /// Headers by path, in the syntax of hosts of static pages.
    pub(super) fn headers(&self) -> String {
        let mut text = format!(
            "/{}/*\n  Content-Type: {}\n  Cache-Control: public, max-age=300\n",
            self.grid.path(),
            self.spec.content_type
        );
        for (name, value) in self.constant() {
            text += &format!("  {name}: {value}\n");
        }
        text
    }
}

fn added(headers: &[(&str, String)]) -> String {
    let line = |(name, value): &(&str, String)| {
        let value = value.replace('\\', "\\\\").replace('\'', "\\'");
        format!("    add_header {name} '{value}';\n")
    };
    headers.iter().map(line).collect()
}

/// A part of a query as a part of a regular expression.
fn escaped(pair: &str) -> String {
    let escape = |c: char| match c {
        '.' | '-' | '+' | '*' | '?' | '(' | ')' | '[' | ']' => format!("\\{c}"),
        c => c.to_string(),
    };
    pair.chars().map(escape).collect()
}
