//! The derivative of a pass by what its particles carry. As the pass is linear in that, the weight of
//! a neighbour is the value where it alone carries 1: its own term stands for the whole sum, and what the particles' code does
//! with such sums is done for every pair.

use super::super::ProgramError;
use super::super::instruction::{Operation, Register, Source};
use super::super::split::{Input, Split};
use super::{Context, GROUP, Group, PARTICLES, Row, Scratch};
use rayon::prelude::*;
use std::ops::Range;

/// Of all that depends on the field, one source is 1 at one particle, and everything else 0.
#[derive(Clone, Copy)]
pub(in super::super) struct Probe<'a> {
    pub(super) dependent: &'a [Source],
    pub(super) source: Source,
    pub(super) at: At,
}

/// Where the source is 1.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum At {
    /// At the neighbour of each pair by itself, if that is another particle: every pair is a case of its own.
    Neighbour,
    /// At the particle.
    Centre,
}

/// The derivatives of a pass's columns by one of its sources: column by column, one for each pair of the lists, or, where there
/// are none, for each particle.
pub(in super::super) fn weights<'a>(
    context: Context<'a>,
    source: Source,
    dependent: &'a [Source],
) -> Result<Vec<Vec<f64>>, ProgramError> {
    let probe = |at| Context { probe: Some(Probe { dependent, source, at }), ..context };
    let (neighbour, centre) = (probe(At::Neighbour), probe(At::Centre));
    let (depends, _) = context.pass.depends_on(dependent);
    let split = context.pass.split(dependent);
    let count = context.count();
    let chunks: Vec<Vec<Vec<f64>>> = (0..count.div_ceil(PARTICLES))
        .into_par_iter()
        .map_init(Scratch::default, |scratch, chunk| {
            let first = chunk * PARTICLES;
            let lists = first..count.min(first + PARTICLES);
            scratch.begin_terms(&context, &lists, &depends);
            neighbour.add_up(scratch, lists.clone())?;
            centre.add_up(scratch, lists)?;
            centre.weigh(scratch, &split)
        })
        .collect::<Result<_, _>>()?;
    let column = |c: usize| chunks.iter().flat_map(|columns| columns[c].iter().copied()).collect();
    Ok((0..context.pass.columns.len()).map(column).collect())
}

impl Context<'_> {
    /// The weights of a chunk of particles, whose sums and terms are there: columns by pair.
    fn weigh(&self, scratch: &mut Scratch, split: &Split) -> Result<Vec<Vec<f64>>, ProgramError> {
        let registers = split.once.registers.max(split.each.registers);
        if scratch.particles.len() < registers {
            scratch.particles.resize_with(registers, || vec![[0.0; GROUP]; PARTICLES / GROUP]);
        }
        let sums: Vec<Vec<Row>> = scratch.particles[..self.pass.sums].to_vec();
        self.execute(&split.once, scratch, scratch.centres.len(), false, &[])?;
        // By input, for each particle: its own value, which for a sum is that of its own weight.
        let inputs: Vec<Vec<Row>> = split
            .inputs
            .iter()
            .map(|input| match input {
                Input::Sum(sum) => sums[*sum].clone(),
                Input::Once(register) => scratch.particles[*register].clone(),
            })
            .collect();
        let (centres, own) = (std::mem::take(&mut scratch.centres), std::mem::take(&mut scratch.own));
        let pairs_of = scratch.starts.windows(2).map(|range| range[1] - range[0]).enumerate();
        let of_pair: Vec<usize> =
            pairs_of.flat_map(|(place, count)| std::iter::repeat_n(place, count)).collect();
        let mut columns = vec![Vec::with_capacity(of_pair.len()); self.pass.columns.len()];
        for (block, places) in of_pair.chunks(PARTICLES).enumerate() {
            let pairs = block * PARTICLES..block * PARTICLES + places.len();
            scratch.own.clear();
            scratch.own.extend_from_slice(&own[pairs.clone()]);
            scratch.centres.clear();
            scratch.centres.extend(places.iter().map(|place| centres[*place]));
            for ((register, of_particle), input) in
                scratch.particles.iter_mut().zip(&inputs).zip(&split.inputs)
            {
                let (values, of_particle) = (register.as_flattened_mut(), of_particle.as_flattened());
                values.iter_mut().zip(places).for_each(|(value, place)| *value = of_particle[*place]);
                if let Input::Sum(sum) = input {
                    let terms = scratch.terms[*sum][pairs.clone()].iter().zip(&scratch.own);
                    for (value, (term, own)) in values.iter_mut().zip(terms) {
                        if !own {
                            *value = *term;
                        }
                    }
                }
            }
            self.execute(&split.each, scratch, places.len(), false, &[])?;
            for (column, register) in columns.iter_mut().zip(&split.columns) {
                let values = &scratch.particles[*register].as_flattened()[..places.len()];
                if let Some(lane) = values.iter().position(|value| !value.is_finite()) {
                    let (particle, value) = (scratch.centres[lane], values[lane]);
                    return Err(ProgramError::NotFinite { particle, value });
                }
                column.extend_from_slice(values);
            }
        }
        Ok(columns)
    }

    /// What stands for a source that depends on the field.
    pub(super) fn seed(
        &self,
        probe: &Probe<'_>,
        operation: &Operation,
        scratch: &Scratch,
        values: &mut [f64],
        pairs: bool,
    ) {
        let one = f64::from(u8::from(operation.source() == Some(probe.source)));
        if !pairs {
            for (value, own) in values.iter_mut().zip(&scratch.own) {
                *value = if *own { one } else { 0.0 };
            }
            return;
        }
        let own = if probe.at == At::Centre { one } else { 0.0 };
        for Group { centres, rows, .. } in &scratch.groups {
            let values = values[rows.start * GROUP..rows.end * GROUP].chunks_exact_mut(GROUP);
            for (row, neighbours) in values.zip(&scratch.neighbours[rows.clone()]) {
                for ((value, j), centre) in row.iter_mut().zip(neighbours).zip(centres) {
                    let carries = (*j as usize == *centre) == (probe.at == At::Centre);
                    let gathered = if carries { one } else { 0.0 };
                    *value = match operation {
                        Operation::Gather(_) => gathered,
                        Operation::Difference(_) => gathered - own,
                        _ => own,
                    };
                }
            }
        }
    }
}

impl Scratch {
    /// Room for the terms of these particles' pairs.
    fn begin_terms(&mut self, context: &Context<'_>, lists: &Range<usize>, depends: &[bool]) {
        (self.starts, self.own) = (vec![0], Vec::new());
        for k in lists.clone() {
            match context.lists {
                Some(neighbours) => {
                    let (list, centre) = (neighbours.of(k), neighbours.centre(k));
                    let first = list.iter().position(|pair| pair.j as usize == centre);
                    self.own.extend((0..list.len()).map(|place| Some(place) == first));
                }
                None => self.own.push(true),
            }
            self.starts.push(self.own.len());
        }
        let terms = |depends: &bool| if *depends { vec![0.0; self.own.len()] } else { Vec::new() };
        self.terms = depends.iter().map(terms).collect();
    }

    /// The summands of what depends on the field, each in the place of its pair.
    pub(super) fn keep(
        &mut self,
        common: Register,
        factor: Option<Register>,
        others: &[Register],
        targets: &[Register],
    ) {
        for (other, target) in others.iter().zip(targets) {
            let terms = &mut self.terms[*target];
            if terms.is_empty() {
                continue;
            }
            for Group { slot, first, rows, .. } in &self.groups {
                for (p, range) in self.starts[*slot..].windows(2).take(GROUP).enumerate() {
                    let begin = range[1].min(range[0] + first);
                    for (row, term) in rows.clone().zip(&mut terms[begin..range[1]]) {
                        let value = |register: Register| self.pairs[register][row][p];
                        let weight = factor.map_or(1.0, value) * value(common);
                        *term = weight * value(*other);
                    }
                }
            }
        }
    }
}
