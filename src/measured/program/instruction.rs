//! What a program is made of in the end: instructions on registers, each of which holds a column of numbers.

use super::expression::SystemKind;
use super::kernel::Distance;
use crate::language::tree::OfParticle;
use std::collections::HashMap;

/// A column of numbers, one for each pair of a block, or for each particle of it.
pub(super) type Register = usize;

/// Where a number of a particle comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Source {
    Quantity(OfParticle),
    /// A component of the field.
    Field(usize),
    /// A column of an earlier pass.
    Stored {
        pass: usize,
        column: usize,
    },
}

/// What is done to each pair, or to each particle.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Operation {
    /// The number of the neighbour.
    Gather(Source),
    /// The number of the neighbour, less that of the particle.
    Difference(Source),
    /// The number of the particle itself.
    Own(Source),
    Fill(f64),
    /// |r|².
    Square,
    Root(Register),
    /// 1/a, but 0 for pairs where a is 0.
    Inverse(Register),
    /// G_k from |r| or |r|² and, if it is needed, 1/|r|; times a weight.
    Radial {
        k: usize,
        of: Distance<Register>,
        inverse: Option<Register>,
        weight: Option<Register>,
    },
    Add(Register, Register),
    Subtract(Register, Register),
    Multiply(Register, Register),
    Scale(Register, f64),
    Shift(Register, f64),
    /// a + c b.
    AddScaled(Register, f64, Register),
    /// a + b c.
    MultiplyAdd(Register, Register, Register),
    /// a − b c.
    MultiplySubtract(Register, Register, Register),
}

/// An instruction.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Instruction {
    Compute {
        target: Register,
        operation: Operation,
    },
    /// Targets: by right side, then by unknown.
    Solve {
        kind: SystemKind,
        size: usize,
        matrix: Vec<Register>,
        targets: Vec<Register>,
    },
    /// Adds Σ `common` `factor` a over the pairs of each particle, for each a of `others`, to registers of the particles.
    Reduce {
        common: Register,
        factor: Option<Register>,
        others: Vec<Register>,
        targets: Vec<Register>,
    },
}

/// Instructions and the number of registers they work on.
#[derive(Debug, Clone, Default)]
pub(super) struct Code {
    pub(super) instructions: Vec<Instruction>,
    pub(super) registers: usize,
}

impl Operation {
    /// Where it takes a number of a particle from.
    pub(super) fn source(&self) -> Option<Source> {
        match self {
            Self::Gather(source) | Self::Difference(source) | Self::Own(source) => Some(*source),
            _ => None,
        }
    }

    pub(super) fn reads(&self) -> Vec<Register> {
        match self {
            Self::Gather(_) | Self::Difference(_) | Self::Own(_) | Self::Fill(_) | Self::Square => Vec::new(),
            Self::Root(a) | Self::Inverse(a) | Self::Scale(a, _) | Self::Shift(a, _) => vec![*a],
            Self::Radial { of, inverse, weight, .. } => {
                let (Distance::Itself(of) | Distance::Square(of)) = of;
                std::iter::once(*of).chain(*inverse).chain(*weight).collect()
            }
            Self::Add(a, b) | Self::Subtract(a, b) | Self::Multiply(a, b) | Self::AddScaled(a, _, b) => {
                vec![*a, *b]
            }
            Self::MultiplyAdd(a, b, c) | Self::MultiplySubtract(a, b, c) => vec![*a, *b, *c],
        }
    }

    fn renamed(&self, name: &dyn Fn(Register) -> Register) -> Self {
        match self.clone() {
            Self::Root(a) => Self::Root(name(a)),
            Self::Inverse(a) => Self::Inverse(name(a)),
            Self::Scale(a, c) => Self::Scale(name(a), c),
            Self::Shift(a, c) => Self::Shift(name(a), c),
            Self::Radial { k, of, inverse, weight } => {
                let of = match of {
                    Distance::Itself(register) => Distance::Itself(name(register)),
                    Distance::Square(register) => Distance::Square(name(register)),
                };
                Self::Radial { k, of, inverse: inverse.map(name), weight: weight.map(name) }
            }
            Self::Add(a, b) => Self::Add(name(a), name(b)),
            Self::Subtract(a, b) => Self::Subtract(name(a), name(b)),
            Self::Multiply(a, b) => Self::Multiply(name(a), name(b)),
            Self::AddScaled(a, c, b) => Self::AddScaled(name(a), c, name(b)),
            Self::MultiplyAdd(a, b, c) => Self::MultiplyAdd(name(a), name(b), name(c)),
            Self::MultiplySubtract(a, b, c) => Self::MultiplySubtract(name(a), name(b), name(c)),
            other => other,
        }
    }
}

impl Instruction {
    pub(super) fn reads(&self) -> Vec<Register> {
        match self {
            Self::Compute { operation, .. } => operation.reads(),
            Self::Solve { matrix, .. } => matrix.clone(),
            Self::Reduce { common, factor, others, .. } => {
                others.iter().copied().chain([*common]).chain(*factor).collect()
            }
        }
    }

    /// The registers that it gives a value; sums are not counted among them.
    pub(super) fn writes(&self) -> Vec<Register> {
        match self {
            Self::Compute { target, .. } => vec![*target],
            Self::Solve { targets, .. } => targets.clone(),
            Self::Reduce { .. } => Vec::new(),
        }
    }

    /// Gives other names to what it reads and writes.
    pub(super) fn rename(&mut self, name: &dyn Fn(Register) -> Register) {
        match self {
            Self::Compute { target, operation } => {
                *operation = operation.renamed(name);
                *target = name(*target);
            }
            Self::Solve { matrix, targets, .. } => {
                matrix.iter_mut().chain(targets).for_each(|register| *register = name(*register));
            }
            Self::Reduce { common, factor, others, .. } => {
                others
                    .iter_mut()
                    .chain([common])
                    .chain(factor)
                    .for_each(|register| *register = name(*register));
            }
        }
    }
}

/// What is used only once is drawn into the instruction that uses it: a product into a sum, a root or a weight into the
/// kernel.
pub(super) fn fuse(
    mut instructions: Vec<Instruction>,
    registers: usize,
    outputs: &[Register],
) -> Vec<Instruction> {
    let mut uses = vec![0_usize; registers];
    for register in instructions.iter().flat_map(Instruction::reads).chain(outputs.iter().copied()) {
        uses[register] += 1;
    }
    // Computed by register, if used once.
    let mut single: HashMap<Register, Operation> = HashMap::new();
    for instruction in &mut instructions {
        if let Instruction::Reduce { common, factor, .. } = instruction {
            if let Some(Operation::Multiply(a, b)) = single.get(common) {
                uses[*common] = 0;
                (*common, *factor) = (*a, Some(*b));
            }
        }
        let Instruction::Compute { target, operation } = instruction else { continue };
        let of = |register: &Register| single.get(register).cloned();
        let (drawn, fused) = match &*operation {
            Operation::Add(a, b) => match (of(a), of(b)) {
                (_, Some(Operation::Multiply(x, y))) => (*b, Operation::MultiplyAdd(*a, x, y)),
                (Some(Operation::Multiply(x, y)), _) => (*a, Operation::MultiplyAdd(*b, x, y)),
                _ => (*target, operation.clone()),
            },
            Operation::Subtract(a, b) => match of(b) {
                Some(Operation::Multiply(x, y)) => (*b, Operation::MultiplySubtract(*a, x, y)),
                _ => (*target, operation.clone()),
            },
            Operation::Radial { k, of: Distance::Itself(distance), inverse, weight } => match of(distance) {
                Some(Operation::Root(square)) => {
                    let (k, inverse, weight) = (*k, *inverse, *weight);
                    (*distance, Operation::Radial { k, of: Distance::Square(square), inverse, weight })
                }
                _ => (*target, operation.clone()),
            },
            Operation::Multiply(a, b) => {
                let weighted = |own: Option<Operation>, other: Register| match own {
                    Some(Operation::Radial { k, of, inverse, weight: None }) => {
                        Some(Operation::Radial { k, of, inverse, weight: Some(other) })
                    }
                    _ => None,
                };
                match (weighted(of(a), *b), weighted(of(b), *a)) {
                    (Some(radial), _) => (*a, radial),
                    (None, Some(radial)) => (*b, radial),
                    _ => (*target, operation.clone()),
                }
            }
            _ => (*target, operation.clone()),
        };
        if drawn != *target {
            uses[drawn] = 0;
            *operation = fused;
        }
        if uses[*target] == 1 {
            single.insert(*target, operation.clone());
        }
    }
    instructions.retain(|instruction| match instruction {
        Instruction::Compute { target, .. } => uses[*target] > 0,
        _ => true,
    });
    instructions
}

/// Puts values that are not alive together into one register; the first `fixed` have one to themselves. Also where the
/// outputs are.
pub(super) fn allocate(
    mut instructions: Vec<Instruction>,
    values: usize,
    fixed: usize,
    outputs: &[Register],
) -> (Code, Vec<Register>) {
    let mut last_use = vec![0; values];
    for (place, instruction) in instructions.iter().enumerate() {
        instruction.reads().iter().for_each(|register| last_use[*register] = place);
    }
    outputs.iter().for_each(|register| last_use[*register] = usize::MAX);
    let mut places: Vec<Register> = (0..values).collect();
    let (mut free, mut registers) = (Vec::new(), fixed);
    let mut give = |free: &mut Vec<Register>| {
        free.pop().unwrap_or_else(|| {
            registers += 1;
            registers - 1
        })
    };
    for (place, instruction) in instructions.iter_mut().enumerate() {
        let reads = instruction.reads();
        let written = instruction.writes();
        for value in &written {
            places[*value] = give(&mut free);
        }
        instruction.rename(&|register| places[register]);
        let mut dead: Vec<Register> =
            reads.iter().chain(&written).copied().filter(|v| last_use[*v] <= place).collect();
        dead.sort_unstable();
        dead.dedup();
        free.extend(dead.iter().filter(|value| **value >= fixed).map(|value| places[*value]));
    }
    let outputs = outputs.iter().map(|value| places[*value]).collect();
    (Code { instructions, registers }, outputs)
}
