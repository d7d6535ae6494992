//! What a program costs, counted on its instructions.

use super::compile::Program;
use super::instruction::{Code, Instruction, Operation};
use super::kernel::RadialFunctions;
use super::schedule::Pass;

/// Additions, multiplications, divisions and roots of one application.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Operations {
    /// For each pair of a particle and one in its support, itself included.
    pub per_pair: u64,
    /// For each particle besides.
    pub per_particle: u64,
    /// Kernel functions evaluated for each pair: W, W′/r or (W′/r)′/r.
    pub kernels_per_pair: u64,
    /// Systems of equations solved for each particle: B, B̂, inverses.
    pub systems_per_particle: u64,
}

impl Program {
    /// Operations of one application, all passes together.
    pub fn operations(&self) -> Operations {
        let mut operations = Operations::default();
        for pass in self.all_passes() {
            let pass = self.operations_of(pass);
            operations.per_pair += pass.per_pair;
            operations.kernels_per_pair += pass.kernels_per_pair;
            operations.per_particle += pass.per_particle;
            operations.systems_per_particle += pass.systems_per_particle;
        }
        operations
    }

    pub(super) fn operations_of(&self, pass: &Pass) -> Operations {
        let (pair, particle) = (self.of_code(&pass.pairs), self.of_code(&pass.particles));
        Operations {
            per_pair: pair.per_pair,
            per_particle: particle.per_pair,
            kernels_per_pair: pair.kernels_per_pair,
            systems_per_particle: pair.systems_per_particle + particle.systems_per_particle,
        }
    }

    pub(super) fn of_code(&self, code: &Code) -> Operations {
        let mut found = Operations::default();
        for instruction in &code.instructions {
            found.per_pair += match instruction {
                Instruction::Compute { operation, .. } => match operation {
                    Operation::Gather(_) | Operation::Own(_) | Operation::Fill(_) => 0,
                    Operation::Square => 2 * self.dimension() as u64 - 1,
                    Operation::Radial { k, weight, .. } => {
                        found.kernels_per_pair += 1;
                        self.kernel().operations(*k) + u64::from(weight.is_some())
                    }
                    Operation::AddScaled(..)
                    | Operation::MultiplyAdd(..)
                    | Operation::MultiplySubtract(..) => 2,
                    _ => 1,
                },
                Instruction::Solve { size, targets, .. } => {
                    found.systems_per_particle += 1;
                    let (n, sides) = (*size as u64, (targets.len() / size) as u64);
                    2 * n * n * n / 3 + 2 * n * n * sides
                }
                Instruction::Reduce { factor, others, .. } => {
                    2 * others.len() as u64 + u64::from(factor.is_some())
                }
            };
        }
        found
    }
}

impl RadialFunctions {
    /// Operations of one evaluation of G_k: the longest piece, and the distance to its end.
    fn operations(&self, k: usize) -> u64 {
        match self {
            // exp counts as ten.
            Self::Gaussian { .. } => 12,
            Self::Pieces(functions) => {
                functions[k].iter().map(super::kernel::Piece::operations).max().unwrap_or(0)
            }
        }
    }
}
