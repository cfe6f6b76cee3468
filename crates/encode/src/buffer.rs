//! Buffers that come back: a stream's blocks take turns in the same memory.
//!
//! Fresh memory for every block would be cleared and mapped in again and again, which costs more
//! than making the points. A buffer returns when the network is done with its block.

use std::sync::{Arc, Mutex, PoisonError};

use bytemuck::NoUninit;
use bytes::Bytes;

/// Some buffers of one size, shared by a maker of blocks and the blocks under way.
#[derive(Clone, Debug)]
pub struct Pool<T> {
    free: Arc<Mutex<Vec<Vec<T>>>>,
    length: usize,
}

/// The most free buffers that are kept: the usual number to come back between two turns of making.
const KEPT: usize = 3;

impl<T: Default + Clone + NoUninit + Send + 'static> Pool<T> {
    /// A pool of buffers of `length` items.
    pub fn new(length: usize) -> Self {
        Self {
            free: Arc::default(),
            length,
        }
    }

    /// A buffer with some content.
    pub fn take(&self) -> Vec<T> {
        let mut free = self.free.lock().unwrap_or_else(PoisonError::into_inner);
        free.pop()
            .unwrap_or_else(|| vec![T::default(); self.length])
    }

    /// A buffer without content, but with room for as much as one of this pool has had.
    pub(super) fn take_empty(&self) -> Vec<T> {
        let mut free = self.free.lock().unwrap_or_else(PoisonError::into_inner);
        let mut buffer = free.pop().unwrap_or_default();
        buffer.clear();
        buffer
    }

    /// The first `used` items of a buffer as bytes, in memory order. The buffer comes back when
    /// they are dropped.
    pub fn lend(&self, buffer: Vec<T>, used: usize) -> Bytes {
        Bytes::from_owner(Lent {
            used,
            buffer,
            pool: self.clone(),
        })
    }

    fn put_back(&self, buffer: Vec<T>) {
        let mut free = self.free.lock().unwrap_or_else(PoisonError::into_inner);
        if free.len() < KEPT {
            free.push(buffer);
        }
    }
}

/// A buffer that finds its way home.
struct Lent<T: Default + Clone + NoUninit + Send + 'static> {
    buffer: Vec<T>,
    used: usize,
    pool: Pool<T>,
}

impl<T: Default + Clone + NoUninit + Send + 'static> AsRef<[u8]> for Lent<T> {
    fn as_ref(&self) -> &[u8] {
        bytemuck::cast_slice(self.buffer.get(..self.used).unwrap_or_default())
    }
}

impl<T: Default + Clone + NoUninit + Send + 'static> Drop for Lent<T> {
    fn drop(&mut self) {
        self.pool.put_back(std::mem::take(&mut self.buffer));
    }
}
