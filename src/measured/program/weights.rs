//! An operator's weights: on particles that do not move, its value is Σ_j w_ij u_j.
//!
//! Pass by pass: what a pass computes of a particle is linear in each source that depends on the field, u itself or a column of
//! an earlier pass, and [`run::weights`] gives its derivatives by them. With those of the columns by u, the chain rule gives
//! its derivatives by u.

use super::ProgramError;
use super::compile::{Fields, Program};
use super::instruction::Source;
use super::run::{self, Columns, Context};
use super::schedule::{self, Pass};
use crate::particles::{Cloud, Neighbours};
use rayon::prelude::*;
use std::borrow::Cow;

/// The weights of one particle's value: those of u_j, by ascending j.
pub type Weights = Vec<(u32, f64)>;

impl Program {
    /// The weights of the values on a scalar field: for each component, one row for each list of neighbours.
    ///
    /// Kernels are taken twice for each pair, tensors once for each particle, and both again for each inner operator that the
    /// outer one reads.
    ///
    /// # Errors
    /// As [`apply`](Self::apply).
    ///
    /// # Examples
    /// ```
    /// use remainder::kernel::by_id;
    /// use remainder::language::Operator;
    /// use remainder::measured::Program;
    /// use remainder::particles::{Cloud, Neighbours, Support};
    ///
    /// // Three particles, and the middle one's weights are those of the central difference.
    /// let f4 = Operator::parse("sum_j V_j (u_j - u_i) B_i . gradW_ij").unwrap();
    /// let program = Program::new(&f4, &by_id("wendland-c2").unwrap(), 1).unwrap();
    /// let x = [0.0, 1.0, 2.0];
    /// let cloud = Cloud::new(1, x.map(|x| [x, 0.0, 0.0]).to_vec(), vec![1.0; 3], Support::Uniform(1.5)).unwrap();
    /// let weights = program.weights(&cloud, &Neighbours::search(&cloud).unwrap()).unwrap();
    /// assert_eq!(weights[0][1], [(0, -0.5), (1, 0.0), (2, 0.5)]);
    /// ```
    pub fn weights(&self, cloud: &Cloud, neighbours: &Neighbours) -> Result<Vec<Vec<Weights>>, ProgramError> {
        let zeros = vec![0.0; cloud.len()];
        let support = self.check(cloud, neighbours, Fields::Scalar(&zeros))?;
        let inputs = self.inputs(cloud, Fields::Scalar(&zeros), support)?;
        let dependent = schedule::dependent(self.all_passes());
        // Of each pass, the columns that do not depend on the field, and the weights of those that do.
        let mut stored: Vec<Columns<'_>> = Vec::new();
        let mut weights: Vec<Vec<Vec<Weights>>> = Vec::new();
        for (index, pass) in self.all_passes().iter().enumerate() {
            let last = index + 1 == self.all_passes().len();
            let lists = (index > 0 || last).then_some(neighbours);
            let context =
                Context { pass, program: self, inputs: &inputs, stored: &stored, lists, probe: None };
            let mut columns = vec![vec![Weights::new(); context.count()]; pass.columns.len()];
            for source in self.sources_of(pass, &dependent) {
                let by_pair = run::weights(context, source, &dependent)?;
                let inner = match source {
                    Source::Stored { pass, column } => Some(&weights[pass][column]),
                    _ => None,
                };
                for (rows, values) in columns.iter_mut().zip(&by_pair) {
                    chain(rows, values, lists, inner, cloud.len());
                }
            }
            weights.push(columns);
            if !last {
                let values = run::pass(context)?;
                stored.push(Columns { values: Cow::Owned(values), stride: pass.columns.len(), offset: 0 });
            }
        }
        let unit = self.unit(support);
        let mut components = weights.pop().unwrap_or_default();
        for rows in &mut components {
            let values = rows.iter_mut().enumerate();
            let values = values.flat_map(|(k, row)| row.iter_mut().map(move |(_, value)| (k, value)));
            Self::in_units(values, unit, |k| neighbours.centre(k))?;
        }
        Ok(components)
    }

    /// What a pass reads of what depends on the field.
    fn sources_of(&self, pass: &Pass, dependent: &[Source]) -> Vec<Source> {
        dependent.iter().copied().filter(|source| pass.sources().any(|read| read == *source)).collect()
    }

    /// Operations of [`weights`](Self::weights) for each particle, if each has so many pairs, itself included.
    pub fn operations_of_weights(&self, pairs: f64) -> f64 {
        let dependent = schedule::dependent(self.all_passes());
        let passes = self.all_passes().iter().enumerate();
        passes
            .map(|(index, pass)| {
                let lanes = if index == 0 { 1.0 } else { pairs };
                let counted = self.operations_of(pass);
                let (pair, particle) = (counted.per_pair as f64, counted.per_particle as f64);
                let split = pass.split(&dependent);
                let [once, each] = [&split.once, &split.each].map(|code| self.of_code(code).per_pair as f64);
                let sources = self.sources_of(pass, &dependent);
                let chained = sources.iter().filter_map(|source| match source {
                    // Rows grow with the reach.
                    Source::Stored { pass: inner, .. } => {
                        let row = (pairs * (*inner as f64).powi(self.dimension() as i32)).max(1.0);
                        Some(2.0 * lanes * row * pass.columns.len() as f64)
                    }
                    _ => None,
                });
                let values = if index + 1 < self.all_passes().len() { pair * lanes + particle } else { 0.0 };
                sources.len() as f64 * (lanes * (2.0 * pair + each) + once) + chained.sum::<f64>() + values
            })
            .sum()
    }
}

/// Adds to each row Σ_j `values`_ij × row j of `inner`, which is the unit matrix where there is none.
fn chain(
    rows: &mut [Weights],
    values: &[f64],
    lists: Option<&Neighbours>,
    inner: Option<&Vec<Weights>>,
    width: usize,
) {
    let mut rest = values;
    let values: Vec<&[f64]> = (0..rows.len())
        .map(|k| {
            let (own, later) = rest.split_at(lists.map_or(1, |lists| lists.of(k).len()));
            rest = later;
            own
        })
        .collect();
    rows.par_iter_mut().zip(values).enumerate().with_min_len(64).for_each_init(
        || (vec![0.0; width], Vec::new()),
        |(sums, touched), (k, (row, values))| {
            let mut add = |j: u32, value: f64| {
                touched.push(j);
                sums[j as usize] += value;
            };
            row.drain(..).for_each(|(j, value)| add(j, value));
            for (place, value) in values.iter().enumerate() {
                let j = lists.map_or(k as u32, |lists| lists.of(k)[place].j);
                match inner {
                    None => add(j, *value),
                    Some(inner) => {
                        inner[j as usize].iter().for_each(|(j, weight)| add(*j, value * weight));
                    }
                }
            }
            touched.sort_unstable();
            touched.dedup();
            row.extend(touched.drain(..).map(|j| (j, std::mem::take(&mut sums[j as usize]))));
        },
    );
}
