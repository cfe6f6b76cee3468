//! Collecting everything that is wrong with a query, so that a client needs one round to learn it all.

use crate::fault::Fault;

/// The most faults that are reported at once.
pub const MOST_FAULTS: usize = 16;

pub type Checked<T> = Result<T, Faults>;

/// At least one fault, at most `MOST_FAULTS`, one for each field.
#[derive(Clone, Debug, PartialEq)]
pub struct Faults(Vec<Fault>);

impl Faults {
    pub fn and(mut self, others: Self) -> Self {
        for fault in others.0 {
            let is_known = self.0.iter().any(|known| known.field == fault.field);
            if !is_known && self.0.len() < MOST_FAULTS {
                self.0.push(fault);
            }
        }
        self
    }

    pub fn as_slice(&self) -> &[Fault] {
        &self.0
    }

    /// Whether the number of faults has reached the most that are reported.
    pub const fn is_full(&self) -> bool {
        self.0.len() >= MOST_FAULTS
    }

    /// The faults with other names of fields.
    pub fn rename(mut self, name: impl Fn(&str) -> String) -> Self {
        for fault in &mut self.0 {
            fault.field = name(&fault.field);
        }
        self
    }

    /// Adds a fault to those found so far.
    pub fn add(found: &mut Checked<()>, fault: Fault) {
        *found = match std::mem::replace(found, Ok(())) {
            Ok(()) => Err(fault.into()),
            Err(faults) => Err(faults.and(fault.into())),
        };
    }
}

impl From<Fault> for Faults {
    fn from(fault: Fault) -> Self {
        Self(vec![fault])
    }
}

pub fn all<T>(checked: impl IntoIterator<Item = Checked<T>>) -> Checked<Vec<T>> {
    let (mut values, mut faults) = (vec![], None);
    for one in checked {
        match one {
            Ok(value) => values.push(value),
            Err(more) => join(&mut faults, more),
        }
    }
    faults.map_or(Ok(values), Err)
}

/// Puts faults to those found so far.
fn join(found: &mut Option<Faults>, more: Faults) {
    *found = Some(match found.take() {
        Some(faults) => faults.and(more),
        None => more,
    });
}

pub trait Together {
    type Values;

    fn together(self) -> Checked<Self::Values>;
}

/// Each value is moved once: some are large.
macro_rules! together {
    ($($kind:ident $name:ident),+) => {
        impl<$($kind),+> Together for ($(Checked<$kind>,)+) {
            type Values = ($($kind,)+);

            #[inline]
            fn together(self) -> Checked<Self::Values> {
                match self {
                    ($(Ok($name),)+) => Ok(($($name,)+)),
                    ($($name,)+) => {
                        let mut faults = None;
                        $(if let Err(more) = $name {
                            join(&mut faults, more);
                        })+
                        Err(faults.expect("one of them is no value"))
                    }
                }
            }
        }
    };
}

together!(A a, B b);
together!(A a, B b, C c);
together!(A a, B b, C c, D d);
together!(A a, B b, C c, D d, E e);
together!(A a, B b, C c, D d, E e, F f);
together!(A a, B b, C c, D d, E e, F f, G g);

#[cfg(test)]
mod tests {
    use super::*;

    fn fault(field: &str) -> Faults {
        Fault::new(field, 1, "wrong", "right").into()
    }

    #[test]
    fn all_faults_are_kept_a_field_once() {
        let (a, b, c) = (
            Ok::<_, Faults>(1),
            Err::<u8, _>(fault("b")),
            Err::<u8, _>(fault("c")),
        );
        let faults = (a, b, c).together().expect_err("two");
        let fields: Vec<_> = faults
            .as_slice()
            .iter()
            .map(|fault| &*fault.field)
            .collect();
        assert_eq!(fields, ["b", "c"]);
        assert_eq!(faults.clone().and(fault("b")), faults);
        assert_eq!(
            (Ok::<_, Faults>(1), Ok::<_, Faults>("2")).together(),
            Ok((1, "2"))
        );
        let many = all((0..99).map(|i| Err::<(), _>(fault(&i.to_string()))));
        assert!(many.expect_err("99").is_full());
    }
}
