//! Reading the members of a JSON object, with every fault named by its path.

use serde_json::{Map, Value};

use super::super::faults::Faults;
use crate::service::Fault;

/// The members of an object at some path, and the faults found so far.
pub(super) struct Reader<'a> {
    path: String,
    members: &'a Map<String, Value>,
    faults: &'a mut Faults,
}

impl<'a> Reader<'a> {
    /// `path` is put before the names of members.
    pub(super) fn new(path: &str, members: &'a Map<String, Value>, faults: &'a mut Faults) -> Self {
        Self {
            path: path.into(),
            members,
            faults,
        }
    }

    pub(super) const fn members(&self) -> &'a Map<String, Value> {
        self.members
    }

    /// A reader of an object within this one.
    pub(super) fn inner<'b>(
        &'b mut self,
        path: &str,
        members: &'b Map<String, Value>,
    ) -> Reader<'b> {
        Reader::new(path, members, self.faults)
    }

    pub(super) fn fault(&mut self, name: &str, value: &str, detail: &str, allowed: &str) {
        let field = format!("{}{name}", self.path);
        self.faults.add(Fault::new(&field, value, detail, allowed));
    }

    pub(super) fn found(&mut self, fault: Fault) {
        self.faults.add(fault);
    }

    /// A fault of something named by its whole path.
    pub(super) fn fault_at(&mut self, path: &str, value: &Value, detail: &str, allowed: &str) {
        self.faults.add(Fault::new(path, value, detail, allowed));
    }

    /// Faults all other members.
    pub(super) fn only(&mut self, known: &[&str]) {
        for (name, value) in self.members {
            let name = name.as_str();
            let is_shape = ["bbox", "circle", "polygon", "chunk"].contains(&name);
            if !known.contains(&name) {
                let detail = if is_shape && known.contains(&"region") {
                    "it belongs into the member region"
                } else {
                    "there is no such member"
                };
                self.fault(name, &value.to_string(), detail, &known.join(", "));
            }
        }
    }

    /// A member, unless it is absent or null; a fault if it cannot be read.
    pub(super) fn member<T>(
        &mut self,
        name: &str,
        allowed: &str,
        read: impl FnOnce(&Value, &mut Self) -> Option<T>,
    ) -> Option<T> {
        self.member_or(name, "it is not of that form", allowed, read)
    }

    /// The same with words for what cannot be read.
    fn member_or<T>(
        &mut self,
        name: &str,
        wrong: &str,
        allowed: &str,
        read: impl FnOnce(&Value, &mut Self) -> Option<T>,
    ) -> Option<T> {
        let value = self.members.get(name).filter(|value| !value.is_null())?;
        let read = read(value, self);
        if read.is_none() {
            self.fault(name, &value.to_string(), wrong, allowed);
        }
        read
    }

    pub(super) fn number(&mut self, name: &str, allowed: &str) -> Option<f64> {
        let wrong = "it is not a number";
        self.member_or(name, wrong, allowed, |value, _| value.as_f64())
    }

    /// An integer from 0 on; large ones may be given as text, since not every client has them.
    pub(super) fn integer(&mut self, name: &str, allowed: &str) -> Option<u64> {
        let wrong = "it is not such an integer";
        self.member_or(name, wrong, allowed, |value, _| match value {
            Value::String(digits) => digits.parse().ok(),
            value => value.as_u64(),
        })
    }

    pub(super) fn text(&mut self, name: &str, allowed: &str) -> Option<String> {
        let read = |value: &Value, _: &mut Self| value.as_str().map(Into::into);
        self.member_or(name, "it is not text", allowed, read)
    }
}
