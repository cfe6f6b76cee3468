//! Who reads an error, and what it can advise them.

/// The readers of errors: advice is in the words of what they can do.
#[derive(Clone, Copy, Debug)]
pub struct Audience {
    /// Whose limits they are.
    pub here: &'static str,
    /// How a table can be had that lies in a file; a daemon's operator can have any made.
    pub table: Option<&'static str>,
    /// What to do about a list of points that is gone.
    pub list: &'static str,
    /// What is allowed where a field does not fit into the memory for fields.
    pub field: &'static str,
}

impl Audience {
    /// A daemon, whose operator has the command line and settings.
    pub const DAEMON: Self = Self {
        here: "this server",
        table: None,
        list: "; a list that the server no longer holds must be sent again (POST /v1/except)",
        field: "a smaller field, or fields.max_sent_bytes raised",
    };

    /// A program with the built-in tables.
    pub const PROCESS: Self = Self {
        here: "this process",
        table: Some("; a daemon that has its file answers: connect to one"),
        list: "",
        field: "a smaller field",
    };

    /// A program in C, which opens folders and files of tables.
    pub const C: Self = Self {
        table: Some("; open a folder that has its file, such as share/strew/tables"),
        ..Self::PROCESS
    };

    /// A page or a program in JavaScript, which opens files of tables.
    pub const SCRIPT: Self = Self {
        table: Some(
            "; load its file beside the others, open({ tables: [...DEFAULT_TABLES, file] }): those of the package \
             strew-tables",
        ),
        ..Self::PROCESS
    };
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Error;

    #[test]
    fn advice_is_for_its_reader() {
        let points = Error::TooManyPoints { count: 9, limit: 8 };
        let rows = Error::TooManyRows { rows: 9, limit: 8 };
        for (of, here, table, list) in [
            (Audience::DAEMON, "this server", "", "POST /v1/except"),
            (Audience::PROCESS, "this process", "connect", ""),
            (Audience::C, "this process", "share/strew/tables", ""),
            (Audience::SCRIPT, "this process", "open({ tables", ""),
        ] {
            let told = [&points, &rows].map(|error| error.message_for(&of));
            let limits = ["returns at most 8", "allows 8"].map(|limit| format!("{here} {limit}"));
            assert!((0..2).all(|i| told[i].contains(&limits[i])), "{told:?}");
            let own = [of.table.unwrap_or_default(), of.list, of.field];
            assert!(own[0].contains(table) && own[1].contains(list), "{own:?}");
            // What only a daemon's clients and its operator can do.
            let foreign = ["server", "POST ", "max_sent_bytes", "strew forge"];
            let is_foreign = foreign.iter().any(|part| own.concat().contains(part));
            assert_eq!(is_foreign, here == "this server", "{own:?}");
        }
    }
}
