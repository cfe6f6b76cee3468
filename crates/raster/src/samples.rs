//! The numbers of a raster's pixels, as small as the file has them.

#[derive(Clone, Debug, PartialEq)]
pub enum Samples {
    /// Of 8 bits.
    U8(Vec<u8>),
    /// Of 16 bits.
    U16(Vec<u16>),
    F32(Vec<f32>),
}

/// Does the same with the numbers of each type.
macro_rules! each {
    ($samples:expr, $values:ident => $result:expr) => {
        match $samples {
            Samples::U8($values) => $result,
            Samples::U16($values) => $result,
            Samples::F32($values) => $result,
        }
    };
}
pub(super) use each;

impl Samples {
    /// The greatest number of an integer type, else 1.
    pub const fn full(&self) -> f64 {
        match self {
            Self::U8(_) => u8::MAX as f64,
            Self::U16(_) => u16::MAX as f64,
            Self::F32(_) => 1.0,
        }
    }

    /// The bytes of a number.
    pub const fn width(&self) -> usize {
        match self {
            Self::U8(_) => 1,
            Self::U16(_) => 2,
            Self::F32(_) => 4,
        }
    }

    pub const fn len(&self) -> usize {
        each!(self, values => values.len())
    }

    /// Whether there are none.
    pub const fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The number of a pixel.
    ///
    /// # Panics
    /// If there is no such pixel.
    pub fn get(&self, i: usize) -> f64 {
        each!(self, values => values[i].into())
    }
    /// Makes some numbers 0.
    pub(super) fn clear(&mut self, which: &[bool]) {
        fn clear<T: Default>(values: &mut [T], which: &[bool]) {
            for (value, _) in values.iter_mut().zip(which).filter(|(_, is)| **is) {
                *value = T::default();
            }
        }
        each!(self, values => clear(values, which));
    }
}
