//! Errors of the configuration.

use std::path::PathBuf;

#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ConfigError {
    #[error("cannot read the configuration file {}: {error}", path.display())]
    Unreadable {
        path: PathBuf,
        error: std::io::Error,
    },
    #[error("{source_name} is not valid TOML: {error}")]
    Syntax {
        source_name: String,
        error: Box<toml::de::Error>,
    },
    #[error(
        "{source_name}: there is no setting `{key}`; {}",
        suggestion(suggestions)
    )]
    UnknownKey {
        source_name: String,
        key: String,
        /// Keys that exist, the likeliest first.
        suggestions: Vec<String>,
    },
    #[error("{source_name}: `{key}` is {value}; allowed: {allowed}")]
    WrongType {
        source_name: String,
        key: String,
        value: String,
        allowed: &'static str,
    },
    #[error("{}", each_on_a_line(.0))]
    Several(Vec<ConfigError>),
    #[error("--set {text}: expected key=value, for example limits.max_points=1000")]
    Assignment { text: String },
    #[error("`{key}` is set twice, by {first} and by {second}; allowed: one of them")]
    Twice {
        key: String,
        /// The first flag.
        first: String,
        /// The second one.
        second: String,
    },
    #[error(
        "{source_name}: `{key}` has no effect on this command; allowed: {}",
        list(used)
    )]
    Unused {
        source_name: String,
        key: String,
        used: Vec<String>,
    },
    #[error("the settings are not valid: {}", in_a_line(.0))]
    Invalid(Box<toml::de::Error>),
    #[error("the settings are not valid: {}", faults.join("; "))]
    OutOfRange {
        /// The faults, each with its key, its value and the allowed values.
        faults: Vec<String>,
    },
}

fn in_a_line(error: &toml::de::Error) -> String {
    let text = error.to_string();
    let text = text.trim();
    // Some messages begin with their key, which the reader puts behind them once more.
    let text = match text.rsplit_once("\nin `") {
        Some((message, key)) if message.starts_with(key.trim_end_matches('`')) => message,
        _ => text,
    };
    text.replace('\n', " ")
}

fn each_on_a_line(errors: &[ConfigError]) -> String {
    let texts: Vec<String> = errors.iter().map(ToString::to_string).collect();
    texts.join("\n")
}

fn list(keys: &[String]) -> String {
    match keys {
        [] => "no settings".into(),
        keys => keys.join(", "),
    }
}

fn suggestion(keys: &[String]) -> String {
    match keys {
        [] => "run `strew config` to see all".into(),
        [key] => format!("did you mean `{key}`?"),
        keys => format!(
            "the nearest are {}; `strew config` prints all",
            keys.join(", ")
        ),
    }
}
