//! The code of a pass's particles in two parts: what the field does not enter, and what is linear in it.

use super::instruction::{Code, Instruction, Operation, Register, Source, allocate};
use super::schedule::Pass;
use std::collections::HashMap;

/// The two parts. The second begins with its inputs in its first registers.
pub(super) struct Split {
    /// For each particle, with the sums over pairs in its first registers.
    pub(super) once: Code,
    pub(super) each: Code,
    pub(super) inputs: Vec<Input>,
    /// Registers of the second part that hold the columns of the pass.
    pub(super) columns: Vec<Register>,
}

/// What the second part starts from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Input {
    /// A sum over pairs that depends on the field.
    Sum(usize),
    /// A register of the first part.
    Once(Register),
}

impl Pass {
    /// The particles' code, parted by whether the field enters through these sources.
    pub(super) fn split(&self, dependent: &[Source]) -> Split {
        let (depends, _) = self.depends_on(dependent);
        // Every value by a number of its own: the sums first, then what the instructions write.
        let mut instructions = self.particles.instructions.clone();
        let mut depends: Vec<bool> = depends;
        let mut value_in: Vec<usize> = (0..self.particles.registers).collect();
        for instruction in &mut instructions {
            let reads =
                |operation: &Operation| operation.source().is_some_and(|source| dependent.contains(&source));
            let own = match instruction {
                Instruction::Compute { operation, .. } => reads(operation),
                _ => false,
            } || instruction.reads().iter().any(|register| depends[value_in[*register]]);
            for register in instruction.writes() {
                value_in[register] = depends.len();
                depends.push(own);
            }
            instruction.rename(&|register| value_in[register]);
        }
        let columns: Vec<usize> = self.columns.iter().map(|register| value_in[*register]).collect();
        let of_field = |instruction: &Instruction| instruction.writes().iter().any(|value| depends[*value]);
        let (mut each, once): (Vec<_>, Vec<_>) = instructions.into_iter().partition(of_field);
        let given = |value: usize| !depends[value] || value < self.sums;
        let mut entering: Vec<usize> = Vec::new();
        for value in each.iter().flat_map(Instruction::reads).chain(columns.iter().copied()) {
            if given(value) && !entering.contains(&value) {
                entering.push(value);
            }
        }
        let (once, places) = allocate(once, depends.len(), self.sums, &entering);
        let inputs = entering.iter().zip(places);
        let inputs = inputs
            .map(|(value, place)| if depends[*value] { Input::Sum(*value) } else { Input::Once(place) })
            .collect();
        // The second part counts its inputs first.
        let mut numbers: HashMap<usize, usize> =
            entering.iter().enumerate().map(|(number, value)| (*value, number)).collect();
        for instruction in &each {
            for value in instruction.writes() {
                let number = numbers.len();
                numbers.insert(value, number);
            }
        }
        each.iter_mut().for_each(|instruction| instruction.rename(&|value| numbers[&value]));
        let columns: Vec<usize> = columns.iter().map(|value| numbers[value]).collect();
        let (each, columns) = allocate(each, numbers.len(), entering.len(), &columns);
        Split { once, each, inputs, columns }
    }
}
