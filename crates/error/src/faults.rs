//! Collecting everything that is wrong with a query, so that a client needs one round to learn it all.

use crate::fault::Fault;

/// The most faults that are reported at once.
pub const MOST_FAULTS: usize = 16;

/// A value, or everything that is wrong with it.
pub type Checked<T> = Result<T, Faults>;

/// At least one fault, at most `MOST_FAULTS`, one for each field.
#[derive(Clone, Debug, PartialEq)]
pub struct Faults(Vec<Fault>);

impl Faults {
    /// These faults and others.
    #[must_use]
    pub fn and(mut self, others: Self) -> Self {
        for fault in others.0 {
            let is_known = self.0.iter().any(|known| known.field == fault.field);
            if !is_known && self.0.len() < MOST_FAULTS {
                self.0.push(fault);
            }
        }
        self
    }

    /// The faults, at least one.
    #[must_use]
    pub fn as_slice(&self) -> &[Fault] {
        &self.0
    }

    /// Whether the number of faults has reached the most that are reported.
    #[must_use]
    pub const fn is_full(&self) -> bool {
        self.0.len() >= MOST_FAULTS
    }

    /// The faults with other names of fields.
    #[must_use]
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

/// All values, or the faults of all.
pub fn all<T>(checked: impl IntoIterator<Item = Checked<T>>) -> Checked<Vec<T>> {
    let mut values = Ok(vec![]);
    for one in checked {
        values = both(values, one).map(|(mut values, one)| {
            values.push(one);
            values
        });
    }
    values
}

fn both<A, B>(a: Checked<A>, b: Checked<B>) -> Checked<(A, B)> {
    match (a, b) {
        (Ok(a), Ok(b)) => Ok((a, b)),
        (Err(a), Err(b)) => Err(a.and(b)),
        (Err(faults), Ok(_)) | (Ok(_), Err(faults)) => Err(faults),
    }
}

/// Checked values of different types that belong together.
pub trait Together {
    /// The values.
    type Values;

    /// All values, or the faults of all.
    ///
    /// # Errors
    /// The faults, if any of them has some.
    fn together(self) -> Checked<Self::Values>;
}

impl<A> Together for (Checked<A>,) {
    type Values = (A,);

    fn together(self) -> Checked<Self::Values> {
        self.0.map(|value| (value,))
    }
}

/// A tuple is a shorter one and a last value.
macro_rules! longer {
    ($($kind:ident $name:ident),+; $last_kind:ident $last:ident) => {
        impl<$($kind,)+ $last_kind> Together for ($(Checked<$kind>,)+ Checked<$last_kind>,) {
            type Values = ($($kind,)+ $last_kind,);

            fn together(self) -> Checked<Self::Values> {
                let ($($name,)+ $last,) = self;
                let values = both(($($name,)+).together(), $last);
                values.map(|(($($name,)+), $last)| ($($name,)+ $last,))
            }
        }
    };
}

longer!(A a; B b);
longer!(A a, B b; C c);
longer!(A a, B b, C c; D d);
longer!(A a, B b, C c, D d; E e);
longer!(A a, B b, C c, D d, E e; F f);
longer!(A a, B b, C c, D d, E e, F f; G g);

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
