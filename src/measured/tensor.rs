//! Dense tensors of equal extent D in every index; the first index is the slowest.

use crate::exact::{Number, int};
use smallvec::{SmallVec, smallvec};

/// Up to rank 2 in space without an allocation.
type Values<T> = SmallVec<[T; 9]>;

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tensor<T> {
    dimension: usize,
    rank: usize,
    pub(super) values: Values<T>,
}

impl<T: Number> Tensor<T> {
    pub(super) fn zero(dimension: usize, rank: usize) -> Self {
        Self { dimension, rank, values: SmallVec::from_elem(T::nought(), dimension.pow(rank as u32)) }
    }

    pub(super) fn scalar(dimension: usize, value: T) -> Self {
        Self { dimension, rank: 0, values: smallvec![value] }
    }

    pub(super) fn vector(dimension: usize, values: &[T; 3]) -> Self {
        Self { dimension, rank: 1, values: values[..dimension].iter().cloned().collect() }
    }

    pub(super) fn unit(dimension: usize) -> Self {
        let mut unit = Self::zero(dimension, 2);
        for a in 0..dimension {
            unit.set(&[a, a], T::from_rational(&int(1)));
        }
        unit
    }

    pub(super) fn from_rows(dimension: usize, rows: Vec<Vec<T>>) -> Self {
        Self { dimension, rank: 2, values: rows.into_iter().flatten().collect() }
    }

    pub(super) fn rows(&self) -> Vec<Vec<T>> {
        self.values.chunks(self.dimension).map(<[T]>::to_vec).collect()
    }

    pub(super) fn into_scalar(self) -> T {
        self.values.into_iter().next().unwrap_or_else(T::nought)
    }

    fn place(&self, indices: &[usize]) -> usize {
        indices.iter().fold(0, |place, index| place * self.dimension + index)
    }

    pub(super) fn at(&self, indices: &[usize]) -> T {
        self.values[self.place(indices)].clone()
    }

    pub(super) fn set(&mut self, indices: &[usize], value: T) {
        let place = self.place(indices);
        self.values[place] = value;
    }

    pub(super) fn scaled(mut self, factor: &T) -> Self {
        for value in &mut self.values {
            *value = value.clone() * factor.clone();
        }
        self
    }

    pub(super) fn negated(mut self) -> Self {
        for value in &mut self.values {
            *value = -value.clone();
        }
        self
    }

    pub(super) fn plus(&self, other: &Self) -> Self {
        let values = self.values.iter().zip(&other.values).map(|(a, b)| a.clone() + b.clone());
        Self { dimension: self.dimension, rank: self.rank, values: values.collect() }
    }

    pub(super) fn outer(&self, other: &Self) -> Self {
        self.contract(other, 0)
    }

    /// The last `count` indices of this with the first of `other`, in order.
    pub(super) fn contract(&self, other: &Self, count: usize) -> Self {
        let inner = self.dimension.pow(count as u32);
        let (rows, columns) = (self.values.len() / inner, other.values.len() / inner);
        let mut values = Values::with_capacity(rows * columns);
        for row in 0..rows {
            for column in 0..columns {
                let products = (0..inner).map(|k| {
                    self.values[row * inner + k].clone() * other.values[k * columns + column].clone()
                });
                values.push(products.fold(T::nought(), |sum, product| sum + product));
            }
        }
        Self { dimension: self.dimension, rank: self.rank + other.rank - 2 * count, values }
    }
}
