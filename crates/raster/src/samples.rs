//! The numbers of a raster's pixels, as small as the file has them.

#[derive(Clone, Debug, PartialEq)]
pub enum Samples {
    /// Of 8 bits.
    U8(Vec<u8>),
    /// Of 16 bits.
    U16(Vec<u16>),
    F32(Vec<f32>),
}

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
        match self {
            Self::U8(values) => values.len(),
            Self::U16(values) => values.len(),
            Self::F32(values) => values.len(),
        }
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
        match self {
            Self::U8(values) => values[i].into(),
            Self::U16(values) => values[i].into(),
            Self::F32(values) => values[i].into(),
        }
    }
    /// Makes some numbers 0.
    pub(super) fn clear(&mut self, which: &[bool]) {
        fn clear<T: Default>(values: &mut [T], which: &[bool]) {
            for (value, _) in values.iter_mut().zip(which).filter(|(_, is)| **is) {
                *value = T::default();
            }
        }
        match self {
            Self::U8(values) => clear(values, which),
            Self::U16(values) => clear(values, which),
            Self::F32(values) => clear(values, which),
        }
    }
}
