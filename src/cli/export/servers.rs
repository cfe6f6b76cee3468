//! Settings with which static servers answer as the daemon does: content types, headers, and no other query.

use std::fmt::Write as _;

use strew_core::ALGORITHM_VERSION;
use strew_query::parameters::FORMAT;

use super::{
    grid::{Grid, Level},
    spec::Spec,
};

/// Settings for nginx, to be included in a server whose root is the export.
pub(super) const NGINX: &str = "strew.nginx.conf";
/// Headers for hosts of static pages (Netlify, Cloudflare Pages).
pub(super) const HEADERS: &str = "_headers";

/// Headers that let pages of all origins read answers, as the daemon's default settings do.
const ORIGINS: [(&str, &str); 2] = [
    ("access-control-allow-origin", "*"),
    ("access-control-expose-headers", "*"),
];

/// An export that is to be served.
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

    /// Settings for nginx.
    pub(super) fn nginx(&self) -> String {
        let mut text = String::from(
            "# Answers as the daemon does, from the files of this folder. Include it in a server:\n\
             #     server { listen 80; root /srv/world; include /srv/world/strew.nginx.conf; }\n",
        );
        if self.spec.compressed.iter().any(|ending| ending == "gz") {
            text += "gzip_static on;\n";
        }
        if let Some(world) = &self.spec.world {
            let _ = write!(
                text,
                "location = /v1/worlds/{} {{\n    types {{ }}\n    default_type application/json;\n    \
                 try_files /v1/worlds/{}/index.json =404;\n",
                world.name, world.name
            );
            for (name, value) in ORIGINS {
                let _ = writeln!(text, "    add_header {name} '{value}';");
            }
            text += "}\n";
        }
        for level in &self.grid.levels {
            self.location(level, &mut text);
        }
        text
    }

    /// Whether addresses may omit a parameter. They may omit the format of a world's files, on which points do not
    /// depend.
    fn may_lack(&self, name: &str) -> bool {
        self.spec.world.is_some() && name == FORMAT.name
    }

    fn location(&self, level: &Level, text: &mut String) {
        let mut pairs: Vec<String> = level.query.split('&').map(escaped).collect();
        pairs.retain(|pair| !pair.is_empty());
        if let Some(world) = &self.spec.world {
            pairs.push(format!("world_digest={}", world.digest));
        }
        let _ = writeln!(text, "location /{}/ {{", self.grid.folder(level));
        let _ = writeln!(
            text,
            "    if ($args !~ \"^(?:(?:{})(?:&|$))*$\") {{ return 404; }}",
            pairs.join("|")
        );
        // Values are compared as addresses have them, encoded as in the level's query.
        let given = level
            .query
            .split('&')
            .filter_map(|pair| pair.split_once('='));
        for (name, value) in given.filter(|(name, _)| !self.may_lack(name)) {
            let _ = writeln!(
                text,
                "    if ($arg_{name} != \"{value}\") {{ return 404; }}"
            );
        }
        let _ = writeln!(
            text,
            "    types {{ }}\n    default_type \"{}\";",
            self.spec.content_type
        );
        *text += "    set $strew_kept \"public, max-age=300\";\n    \
                  if ($arg_world_digest) { set $strew_kept \"public, max-age=31536000, immutable\"; }\n    \
                  add_header cache-control $strew_kept;\n";
        for (name, value) in self.constant() {
            let value = value.replace('\\', "\\\\").replace('\'', "\\'");
            let _ = writeln!(text, "    add_header {name} '{value}';");
        }
        *text += "}\n";
    }

    /// Headers by path, in the syntax of hosts of static pages.
    pub(super) fn headers(&self) -> String {
        let mut text = format!(
            "/{}/*\n  Content-Type: {}\n  Cache-Control: public, max-age=300\n",
            self.grid.path(),
            self.spec.content_type
        );
        for (name, value) in self.constant() {
            let _ = writeln!(text, "  {name}: {value}");
        }
        text
    }
}

/// A part of a query as a part of a regular expression.
fn escaped(pair: &str) -> String {
    let escape = |c: char| match c {
        '.' | '-' | '+' | '*' | '?' | '(' | ')' | '[' | ']' => format!("\\{c}"),
        c => c.to_string(),
    };
    pair.chars().map(escape).collect()
}
