//! The values of a request's parameters, those that could be read.

use std::borrow::Cow;

use serde_json::{Map, Value as Json, value::RawValue};
use strew_catalog::{Dimension, field};
use strew_error::{Checked, Fault, Faults, unknown};

use crate::{
    json::object::shown,
    lookup::{find, names, of},
    parameter::{Group, Parameter, groups},
    shape::Shape,
    value::Value,
};

/// The values of parameters, each read or with its fault in its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Values {
    groups: &'static [Group],
    /// The prefix of their names in faults: empty, or `layers[3].`.
    path: String,
    given: Vec<(&'static Parameter, Checked<Value>)>,
    /// The faults of names that are no parameters.
    others: Checked<()>,
}

/// What is wrong with a parameter of the plane in space.
pub(crate) const NOT_IN_SPACE: &str = "not for points in space";

impl Values {
    /// No values, of a request that takes these groups; `path` is put before names in faults.
    pub fn new(groups: &'static [Group], path: &str) -> Self {
        Self {
            groups,
            path: path.into(),
            given: vec![],
            others: Ok(()),
        }
    }

    pub fn path(&self) -> &str {
        &self.path
    }

    /// Whether the request is about points of the plane or in space.
    pub fn dimension(&self) -> Dimension {
        match self.groups.contains(&Group::SpaceAttributes) {
            true => Dimension::Space,
            false => Dimension::Plane,
        }
    }

    pub fn takes(&self) -> impl Iterator<Item = &'static Parameter> + Clone {
        of(self.groups)
    }

    /// Whether a request about points in space has a parameter of those of the plane.
    pub(crate) fn is_of_the_plane(&self, name: &str) -> bool {
        let named = Parameter::named(name);
        let is_of_query = named.is_some_and(|named| groups::QUERY.contains(&named.group));
        is_of_query
            && self.dimension() == Dimension::Space
            && find(groups::SPACE_QUERY, name).is_none()
    }

    /// Adds a value as text, under a name that may not be a parameter's.
    pub fn add_text(&mut self, name: &str, text: &str) {
        let Some(parameter) = self.parameter("parameter", name, || text.into()) else {
            return;
        };
        let value = parameter.shape.read(text);
        let fault = |detail| self.described(parameter, text, detail).into();
        self.add(parameter, value.map_err(fault), || text.into());
    }

    /// Adds a member of JSON, under a name that may not be a parameter's.
    pub fn add_json(&mut self, name: &str, json: &RawValue) {
        let Some(parameter) = self.parameter("member", name, || shown(json).into()) else {
            return;
        };
        // Faults of a field have paths of their own.
        if let Shape::Field = parameter.shape {
            let path = format!("{}{name}", self.path);
            let field = field::read_json(&path, json.get());
            let value = field.map(|field| Value::Field(field.into()));
            return self.add(parameter, value, || shown(json).into());
        }
        if matches!(parameter.shape, Shape::Fields) && json.get().starts_with('{') {
            let path = format!("{}{name}", self.path);
            let fields = crate::json::object::fields(&path, json, parameter.allowed());
            let value = fields.and_then(|fields| {
                let checked = parameter.shape.check(Value::Fields(fields));
                checked.map_err(|detail| self.described(parameter, shown(json), detail).into())
            });
            return self.add(parameter, value, || shown(json).into());
        }
        let value = parameter.shape.read_json(json);
        let fault = |detail: Cow<'static, str>| {
            // Some programs write `null` for members without a value.
            let detail = match json.get() {
                "null" => format!("{detail}; leave the member out for its default").into(),
                _ => detail,
            };
            self.described(parameter, shown(json), detail).into()
        };
        self.add(parameter, value.map_err(fault), || shown(json).into());
    }

    pub fn add_values(
        &mut self,
        values: impl IntoIterator<Item = (&'static Parameter, Option<Value>)>,
    ) {
        for (parameter, value) in values {
            if let Some(value) = value {
                self.add_value(parameter, value);
            }
        }
    }

    pub fn add_value(&mut self, parameter: &'static Parameter, value: Value) {
        if !self.takes().any(|taken| taken == parameter) {
            let field = format!("{}{}", self.path, parameter.name);
            let allowed = names(self.groups);
            return self.refuse(Fault::new(
                &field,
                value.to_text(),
                "not allowed here",
                allowed,
            ));
        }
        let checked = parameter.shape.check(value.clone());
        let fault = |detail| self.described(parameter, &value.to_text(), detail).into();
        self.add(parameter, checked.map_err(fault), || value.to_text());
    }

    /// Adds the fault of a field that is no parameter.
    pub fn refuse(&mut self, fault: Fault) {
        Faults::add(&mut self.others, fault);
    }

    /// Whether the number of faults has reached the most that are reported, so that reading can stop.
    pub fn is_full(&self) -> bool {
        let faulty = self.given.iter().filter(|(_, value)| value.is_err());
        faulty.count() >= strew_error::faults::MOST_FAULTS
            || self.others.as_ref().is_err_and(Faults::is_full)
    }

    /// The parameter with a name, if the request takes it; else notes the fault.
    fn parameter(
        &mut self,
        what: &str,
        name: &str,
        value: impl FnOnce() -> String,
    ) -> Option<&'static Parameter> {
        let named = find(self.groups, name);
        if named.is_none() {
            let detail = match Parameter::named(name) {
                _ if self.is_of_the_plane(name) => NOT_IN_SPACE.into(),
                Some(_) => "not allowed here".into(),
                None => unknown(what, name, self.takes().map(|parameter| parameter.name)),
            };
            let field = format!("{}{name}", self.path);
            self.refuse(Fault::new(&field, value(), detail, names(self.groups)));
        }
        named
    }

    fn add(
        &mut self,
        parameter: &'static Parameter,
        value: Checked<Value>,
        text: impl FnOnce() -> String,
    ) {
        let Some((_, first)) = self.given.iter().find(|(known, _)| *known == parameter) else {
            self.given.push((parameter, value));
            return;
        };
        let first = match first {
            Ok(value) => Some(value.to_text()),
            Err(faults) => faults.as_slice()[0].value.clone(),
        };
        let first = first.unwrap_or_default();
        let detail = format!("given twice (first as `{first}`)");
        let field = format!("{}{}", self.path, parameter.name);
        self.refuse(Fault::new(&field, text(), detail, "each parameter once"));
    }

    fn described(&self, parameter: &Parameter, text: &str, detail: Cow<'_, str>) -> Fault {
        let field = format!("{}{}", self.path, parameter.name);
        Fault::new(&field, text, detail, parameter.allowed())
    }

    /// Nothing, or the faults of all that could not be read.
    pub fn read(&self) -> Checked<()> {
        let unread = self
            .given
            .iter()
            .filter_map(|(_, value)| value.as_ref().err());
        unread.fold(self.others.clone(), |all, faults| match all {
            Ok(()) => Err(faults.clone()),
            Err(others) => Err(others.and(faults.clone())),
        })
    }

    pub fn has(&self, parameter: &Parameter) -> bool {
        self.of(parameter).is_some()
    }

    /// A parameter with its value, if it is given.
    fn of(&self, parameter: &Parameter) -> Option<&(&'static Parameter, Checked<Value>)> {
        self.given.iter().find(|(known, _)| *known == parameter)
    }

    /// The first two given parameters of some groups, in the order of the table.
    pub(crate) fn two_of(&self, groups: &[Group]) -> [Option<&'static Parameter>; 2] {
        let given = self.given.iter().map(|(parameter, _)| *parameter);
        let mut given = given.filter(|parameter| groups.contains(&parameter.group));
        let first = given.next();
        if given.next().is_none() {
            return [first, None];
        }
        let taken = self.takes();
        let mut in_order = taken.filter(|of| groups.contains(&of.group) && self.has(of));
        [in_order.next(), in_order.next()]
    }

    /// The value of a parameter, if it is given.
    pub fn get<T>(&self, parameter: &Parameter) -> Checked<Option<T>>
    where
        T: for<'a> TryFrom<&'a Value, Error = &'static str>,
    {
        let Some((parameter, value)) = self.of(parameter) else {
            return Ok(None);
        };
        let value = value.as_ref().map_err(Clone::clone)?;
        match T::try_from(value) {
            Ok(value) => Ok(Some(value)),
            Err(detail) => Err(self.fault(parameter, detail).into()),
        }
    }

    pub fn require<T>(&self, parameter: &Parameter) -> Checked<T>
    where
        T: for<'a> TryFrom<&'a Value, Error = &'static str>,
    {
        self.get(parameter)?
            .ok_or_else(|| self.missing(parameter).into())
    }

    pub fn fault(&self, parameter: &Parameter, detail: impl Into<String>) -> Fault {
        // Parameters of space have names of the plane, and rules of their own.
        let parameter = self.of(parameter).map_or(parameter, |(given, _)| given);
        let field = format!("{}{}", self.path, parameter.name);
        Fault::new(&field, self.text(parameter), detail, parameter.allowed())
    }

    /// The fault of a value that is not given.
    pub fn missing(&self, parameter: &Parameter) -> Fault {
        let field = format!("{}{}", self.path, parameter.name);
        Fault::missing(&field, parameter.allowed())
    }

    /// The text of a value; empty if it is not given or could not be read.
    pub fn text(&self, parameter: &Parameter) -> String {
        let mut given = self.given();
        let value = given.find(|(known, _)| *known == parameter);
        value.map_or_else(String::new, |(_, value)| value.to_text())
    }

    /// The values that could be read, in the order in which they were given.
    pub fn given(&self) -> impl Iterator<Item = (&'static Parameter, &Value)> {
        let given = self.given.iter();
        given.filter_map(|(parameter, value)| Some((*parameter, value.as_ref().ok()?)))
    }

    pub fn replace(&mut self, parameter: &'static Parameter, value: Option<Value>) {
        self.given.retain(|(known, _)| *known != parameter);
        let value = value.map(|value| (parameter, Ok(value)));
        self.given.extend(value);
    }

    /// Takes over the values of some groups that others have and these lack. Of amounts there is one.
    pub fn fill_from(&mut self, others: &Self, groups: &[Group]) {
        let is_amount =
            |parameter: &Parameter| [Group::Amount, Group::Count].contains(&parameter.group);
        let has_amount = self.given.iter().any(|(parameter, _)| is_amount(parameter));
        for (parameter, value) in &others.given {
            let is_wanted =
                self.groups.contains(&parameter.group) && groups.contains(&parameter.group);
            let is_second = has_amount && is_amount(parameter);
            if is_wanted && !is_second && !self.has(parameter) {
                self.given.push((parameter, value.clone()));
            }
        }
    }

    pub(crate) fn written(&self) -> Map<String, Json> {
        let in_body =
            |group: &Group| groups::QUERY.contains(group) || groups::SPACE_QUERY.contains(group);
        let given = self
            .given()
            .filter(|(parameter, _)| in_body(&parameter.group));
        let member = given.filter_map(|(parameter, value)| {
            Some((parameter.name.to_owned(), serde_json::to_value(value).ok()?))
        });
        member.collect()
    }
}
