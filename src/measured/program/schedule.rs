//! From expressions to passes of instructions.
//!
//! Pass 0 only computes with what the particles carry; each further pass runs over the pairs, adds up its sums by particle,
//! and then computes with these. What later passes need, at a particle or at its neighbours, is stored in columns.

use super::expression::{Arena, Atom, Expression, Id, System, SystemKind};
use super::instruction::{Code, Instruction, Operation, Register, Source, allocate, fuse};
use super::kernel::{Distance, RadialFunctions};
use super::products::{self, Plan};
use std::cmp::Reverse;
use std::collections::{BTreeMap, HashMap, HashSet};

/// Sums that are added up together, so that they fit into the processor's registers.
const SUMS_TOGETHER: usize = 4;

/// One run over the particles. On the pairs, the first registers hold the components of r_ij, and the next one 1 for a pair
/// and 0 for a lane that holds none.
#[derive(Debug, Clone)]
pub(super) struct Pass {
    pub(super) pairs: Code,
    pub(super) particles: Code,
    /// Registers of the particles that hold sums over pairs.
    pub(super) sums: usize,
    /// Whether its code reads which lanes hold a pair.
    pub(super) masked: bool,
    /// Registers of the particles to be stored, column by column.
    pub(super) columns: Vec<Register>,
}

/// The passes that compute these expressions of particle 0; pass p stores what level p needs.
pub(super) fn passes(
    arena: &mut Arena,
    kernel: &RadialFunctions,
    dimension: usize,
    components: &[Id],
) -> Vec<Pass> {
    let top = components.iter().map(|id| arena.level(*id)).max().unwrap_or(0);
    let mut wanted = Wanted { by_level: vec![Vec::new(); top + 1] };
    wanted.by_level[top] = components.to_vec();
    let mut passes: Vec<Pass> = (0..=top)
        .rev()
        .map(|pass| {
            let outputs = wanted.by_level[pass].clone();
            let mut builder = Builder::new(arena, kernel, dimension, pass, false, &mut wanted);
            let outputs: Vec<Id> = outputs.iter().map(|id| builder.localise(*id)).collect();
            let sums = builder.sums_of(&outputs);
            let columns = builder.particle_code(&outputs, &sums);
            let (particles, columns) = builder.finish(sums.len(), &columns);
            let mut builder = Builder::new(arena, kernel, dimension, pass, true, &mut wanted);
            builder.pair_code(&sums);
            let (pairs, _) = builder.finish(dimension + 1, &[]);
            let masked =
                pairs.instructions.iter().any(|instruction| instruction.reads().contains(&dimension));
            Pass { pairs, particles, sums: sums.len(), masked, columns }
        })
        .collect();
    passes.reverse();
    passes
}

/// What is to be stored, by level; its place there is its column.
struct Wanted {
    by_level: Vec<Vec<Id>>,
}

impl Wanted {
    fn column(&mut self, level: usize, id: Id) -> usize {
        let columns = &mut self.by_level[level];
        columns.iter().position(|known| *known == id).unwrap_or_else(|| {
            columns.push(id);
            columns.len() - 1
        })
    }
}

/// Makes the code of one pass, for its pairs or for its particles, on as many registers as there are values.
struct Builder<'a> {
    arena: &'a mut Arena,
    kernel: &'a RadialFunctions,
    dimension: usize,
    pass: usize,
    pairs: bool,
    wanted: &'a mut Wanted,
    localised: HashMap<Id, Id>,
    instructions: Vec<Instruction>,
    next: Register,
    known: HashMap<Id, Register>,
    inverses: HashMap<Id, Register>,
    solved: HashMap<usize, Register>,
    /// Numbers of the factors of products, and the products by expression.
    factors: Vec<(Id, bool)>,
    products: HashMap<Id, usize>,
    plan: Plan,
    made: HashMap<usize, Register>,
}

impl<'a> Builder<'a> {
    fn new(
        arena: &'a mut Arena,
        kernel: &'a RadialFunctions,
        dimension: usize,
        pass: usize,
        pairs: bool,
        wanted: &'a mut Wanted,
    ) -> Self {
        Self {
            arena,
            kernel,
            dimension,
            pass,
            pairs,
            wanted,
            localised: HashMap::new(),
            instructions: Vec::new(),
            next: 0,
            known: HashMap::new(),
            inverses: HashMap::new(),
            solved: HashMap::new(),
            factors: Vec::new(),
            products: HashMap::new(),
            plan: Plan::default(),
            made: HashMap::new(),
        }
    }

    /// Whether it belongs to one particle and is to be computed in an earlier pass: it must be if it is made of sums, and
    /// had better be if there is a division for every pair otherwise.
    fn is_stored(&self, id: Id) -> bool {
        let level = self.arena.level(id);
        let early = level >= 1 || (self.pairs && self.arena.divides(id));
        self.arena.particles(id).len() == 1 && level < self.pass && early
    }

    fn store(&mut self, id: Id) -> Id {
        let particle = self.arena.particles(id)[0];
        let own = self.arena.rename(id, &[(particle, 0)]);
        if self.is_stored(own) { self.arena.atom(Atom::Stored(own, particle)) } else { id }
    }

    /// The expression with what earlier passes compute in one piece each.
    fn localise(&mut self, id: Id) -> Id {
        if let Some(known) = self.localised.get(&id) {
            return *known;
        }
        let localised = if self.is_stored(id) {
            self.store(id)
        } else {
            match self.arena.get(id).clone() {
                Expression::Atom(Atom::Solution(system, side, unknown)) => {
                    let System { kind, size, matrix } = self.arena.systems[system].clone();
                    let matrix = matrix.iter().map(|id| self.localise(*id)).collect();
                    self.arena.solution(System { kind, size, matrix }, side, unknown)
                }
                Expression::Atom(_) => id,
                Expression::Linear(constant, terms) => {
                    let mut sum = vec![(1.0, self.arena.constant(constant.get()))];
                    let mut groups: BTreeMap<usize, Vec<(f64, Id)>> = BTreeMap::new();
                    for (coefficient, term) in terms {
                        match *self.arena.particles(term) {
                            [p] if self.arena.level(term) < self.pass => {
                                groups.entry(p).or_default().push((coefficient.get(), term));
                            }
                            _ => sum.push((coefficient.get(), self.localise(term))),
                        }
                    }
                    for group in groups.into_values() {
                        if group.iter().any(|(_, id)| self.is_stored(*id)) {
                            let whole = self.arena.linear(&group);
                            sum.push((1.0, self.store(whole)));
                        } else {
                            sum.extend(group);
                        }
                    }
                    self.arena.linear(&sum)
                }
                Expression::Product(factors) => {
                    let mut product = Vec::new();
                    let mut groups: BTreeMap<usize, Vec<(Id, i32)>> = BTreeMap::new();
                    for (factor, power) in factors {
                        let stored = self.is_stored(factor)
                            || (self.pairs && power < 0 && self.arena.particles(factor).len() == 1);
                        if stored {
                            let particle = self.arena.particles(factor)[0];
                            groups.entry(particle).or_default().push((factor, power));
                        } else {
                            product.push((self.localise(factor), power));
                        }
                    }
                    for group in groups.into_values() {
                        let whole = self.arena.product(&group);
                        product.push((self.store(whole), 1));
                    }
                    self.arena.product(&product)
                }
            }
        };
        self.localised.insert(id, localised);
        localised
    }

    /// The sums that these expressions need of this pass.
    fn sums_of(&self, ids: &[Id]) -> Vec<usize> {
        let (mut seen, mut sums) = (HashSet::new(), Vec::new());
        let mut open: Vec<Id> = ids.iter().rev().copied().collect();
        while let Some(id) = open.pop() {
            if !seen.insert(id) {
                continue;
            }
            if let Expression::Atom(Atom::Sum(sum, _)) = self.arena.get(id) {
                sums.push(*sum);
            }
            open.extend(self.children(id));
        }
        sums
    }

    fn children(&self, id: Id) -> Vec<Id> {
        match self.arena.get(id) {
            Expression::Atom(Atom::Solution(system, ..)) => self.arena.systems[*system].matrix.clone(),
            Expression::Atom(_) => Vec::new(),
            Expression::Linear(_, terms) => terms.iter().map(|(_, id)| *id).collect(),
            Expression::Product(factors) => factors.iter().map(|(id, _)| *id).collect(),
        }
    }

    /// Plans all products in these expressions.
    fn plan_products(&mut self, ids: &[Id]) {
        let mut seen = HashSet::new();
        let mut open: Vec<Id> = ids.iter().rev().copied().collect();
        let mut numbers: HashMap<(Id, bool), usize> = HashMap::new();
        let mut products = Vec::new();
        while let Some(id) = open.pop() {
            if !seen.insert(id) {
                continue;
            }
            if let Expression::Product(factors) = self.arena.get(id) {
                let mut expanded = Vec::new();
                for (factor, power) in factors {
                    let key = (*factor, *power < 0);
                    let count = numbers.len();
                    let number = *numbers.entry(key).or_insert(count);
                    if number == self.factors.len() {
                        self.factors.push(key);
                    }
                    expanded.extend(std::iter::repeat_n(number, power.unsigned_abs() as usize));
                }
                self.products.insert(id, products.len());
                products.push(expanded);
            }
            open.extend(self.children(id));
        }
        self.plan = products::plan(products, self.factors.len());
    }

    /// Registers of the outputs. Those of the sums come first.
    fn particle_code(&mut self, outputs: &[Id], sums: &[usize]) -> Vec<Register> {
        for sum in sums {
            let id = self.arena.atom(Atom::Sum(*sum, 0));
            self.known.insert(id, self.next);
            self.next += 1;
        }
        self.plan_products(outputs);
        outputs.iter().map(|id| self.emit(*id)).collect()
    }

    fn pair_code(&mut self, sums: &[usize]) {
        self.next = self.dimension + 1;
        let mask = self.dimension;
        let summands: Vec<Id> = sums.iter().map(|sum| self.arena.sums[*sum]).collect();
        let summands: Vec<Id> = summands.iter().map(|id| self.localise(*id)).collect();
        self.plan_products(&summands);
        // The two factors of each, by number; what has more to it than a product is one factor, the mask the other.
        let (mut open, mut whole) = (Vec::new(), BTreeMap::new());
        let first_whole = usize::MAX - summands.len();
        for (target, summand) in summands.iter().enumerate() {
            let plain = self.products.get(summand).map(|product| self.plan.products[*product].as_slice());
            open.push(match plain {
                Some([a, b]) if self.vanishes_without_pair(*summand) => (target, *a, *b),
                _ => {
                    whole.insert(first_whole + target, *summand);
                    (target, usize::MAX, first_whole + target)
                }
            });
        }
        let register = |this: &mut Self, number: usize| match whole.get(&number) {
            Some(summand) => this.emit(*summand),
            None if number == usize::MAX => mask,
            None => this.factor(number),
        };
        // Sums with a factor in common are taken together, the commonest factor first.
        while !open.is_empty() {
            let mut counts: BTreeMap<usize, usize> = BTreeMap::new();
            for (_, a, b) in &open {
                *counts.entry(*a).or_default() += 1;
                *counts.entry(*b).or_default() += usize::from(a != b);
            }
            let Some((common, _)) =
                counts.into_iter().max_by_key(|(number, count)| (*count, Reverse(*number)))
            else {
                break;
            };
            let (mut others, mut targets) = (Vec::new(), Vec::new());
            open.retain(|(target, a, b)| {
                let taken = others.len() < SUMS_TOGETHER && (*a == common || *b == common);
                if taken {
                    others.push(if *a == common { *b } else { *a });
                    targets.push(*target);
                }
                !taken
            });
            let common = register(self, common);
            let others = others.iter().map(|other| register(self, *other)).collect();
            self.instructions.push(Instruction::Reduce { common, factor: None, others, targets });
        }
    }

    /// Whether it is zero at distance R, where lanes without a pair are put.
    fn vanishes_without_pair(&self, id: Id) -> bool {
        match self.arena.get(id) {
            Expression::Atom(atom) => matches!(atom, Atom::Radial(..)),
            Expression::Linear(constant, terms) => {
                constant.get() == 0.0 && terms.iter().all(|(_, id)| self.vanishes_without_pair(*id))
            }
            Expression::Product(factors) => {
                factors.iter().any(|(id, power)| *power > 0 && self.vanishes_without_pair(*id))
            }
        }
    }

    fn compute(&mut self, operation: Operation) -> Register {
        let target = self.next;
        self.next += 1;
        self.instructions.push(Instruction::Compute { target, operation });
        target
    }

    /// A factor of a product, by its number in the plan.
    fn factor(&mut self, number: usize) -> Register {
        if let Some((id, inverted)) = self.factors.get(number).copied() {
            let register = self.emit(id);
            if !inverted {
                return register;
            }
            if let Some(known) = self.inverses.get(&id) {
                return *known;
            }
            let inverse = self.compute(Operation::Inverse(register));
            self.inverses.insert(id, inverse);
            return inverse;
        }
        if let Some(known) = self.made.get(&number) {
            return *known;
        }
        let (a, b) = self.plan.made.get(&number).copied().unwrap_or((0, 0));
        let (a, b) = (self.factor(a), self.factor(b));
        let register = self.compute(Operation::Multiply(a, b));
        self.made.insert(number, register);
        register
    }

    fn emit(&mut self, id: Id) -> Register {
        if let Some(register) = self.known.get(&id) {
            return *register;
        }
        let register = match self.arena.get(id).clone() {
            Expression::Atom(atom) => self.emit_atom(atom),
            Expression::Linear(constant, terms) => self.emit_linear(constant.get(), &terms_of(&terms)),
            Expression::Product(_) => {
                let product = self.products.get(&id).copied();
                let factors = product.map(|product| self.plan.products[product].clone()).unwrap_or_default();
                let made = match factors[..] {
                    [a, b] => self.plan.made.iter().find(|(_, pair)| **pair == (a, b)).map(|(made, _)| *made),
                    _ => None,
                };
                match (made, &factors[..]) {
                    (Some(made), _) => self.factor(made),
                    (None, [a, b]) => {
                        let (a, b) = (self.factor(*a), self.factor(*b));
                        self.compute(Operation::Multiply(a, b))
                    }
                    (None, [a]) => self.factor(*a),
                    (None, _) => self.compute(Operation::Fill(1.0)),
                }
            }
        };
        self.known.insert(id, register);
        register
    }

    fn emit_linear(&mut self, constant: f64, terms: &[(f64, Id)]) -> Register {
        // A difference of one quantity at the two particles is one instruction.
        if let (true, 0.0, [(c, a), (d, b)]) = (self.pairs, constant, terms) {
            let source = |this: &mut Self, id: Id| match this.arena.get(id).clone() {
                Expression::Atom(atom) => this.source(atom),
                _ => None,
            };
            let sources = (source(self, *a), source(self, *b));
            if let (Some((a, p)), Some((b, q)), true) = (sources.0, sources.1, c + d == 0.0 && c.abs() == 1.0)
            {
                if a == b && p != q {
                    // Gathered less own: the sign is that of the neighbour's, particle 1.
                    let sign = if p == 1 { *c } else { *d };
                    let difference = self.compute(Operation::Difference(a));
                    return if sign == 1.0 {
                        difference
                    } else {
                        self.compute(Operation::Scale(difference, -1.0))
                    };
                }
            }
        }
        let mut ordered: Vec<(f64, Id)> = terms.to_vec();
        ordered.sort_by_key(|(coefficient, _)| *coefficient != 1.0);
        let mut sum = None;
        for (coefficient, id) in ordered {
            let term = self.emit(id);
            sum = Some(match (sum, coefficient) {
                (None, 1.0) => term,
                (None, c) => self.compute(Operation::Scale(term, c)),
                (Some(sum), 1.0) => self.compute(Operation::Add(sum, term)),
                (Some(sum), -1.0) => self.compute(Operation::Subtract(sum, term)),
                (Some(sum), c) => self.compute(Operation::AddScaled(sum, c, term)),
            });
        }
        match sum {
            None => self.compute(Operation::Fill(constant)),
            Some(sum) if constant == 0.0 => sum,
            Some(sum) => self.compute(Operation::Shift(sum, constant)),
        }
    }

    /// Where a number of one particle comes from, and which particle.
    fn source(&mut self, atom: Atom) -> Option<(Source, usize)> {
        Some(match atom {
            Atom::Quantity(quantity, p) => (Source::Quantity(quantity), p),
            Atom::Field(component, p) => (Source::Field(component), p),
            Atom::Stored(id, p) => {
                let pass = self.arena.level(id);
                (Source::Stored { pass, column: self.wanted.column(pass, id) }, p)
            }
            _ => return None,
        })
    }

    fn emit_atom(&mut self, atom: Atom) -> Register {
        if let Some((source, particle)) = self.source(atom) {
            let own = particle == 0;
            return self.compute(if own { Operation::Own(source) } else { Operation::Gather(source) });
        }
        match atom {
            Atom::Separation(axis, ..) => axis,
            Atom::Square(..) => self.compute(Operation::Square),
            Atom::Distance(p, q) => {
                let square = self.emit_other(Atom::Square(p, q));
                self.compute(Operation::Root(square))
            }
            Atom::InverseDistance(p, q) => {
                let distance = self.emit_other(Atom::Distance(p, q));
                self.compute(Operation::Inverse(distance))
            }
            Atom::InverseSquare(p, q) => {
                let square = self.emit_other(Atom::Square(p, q));
                self.compute(Operation::Inverse(square))
            }
            Atom::Radial(k, p, q) => {
                let distance = self.emit_other(Atom::Distance(p, q));
                let inverse =
                    self.kernel.needs_inverse(k).then(|| self.emit_other(Atom::InverseDistance(p, q)));
                self.compute(Operation::Radial { k, of: Distance::Itself(distance), inverse, weight: None })
            }
            Atom::Solution(system, side, unknown) => {
                let System { kind, size, matrix } = self.arena.systems[system].clone();
                let sides = if kind == SystemKind::RenormalisationHat { 1 } else { size };
                let first = match self.solved.get(&system) {
                    Some(first) => *first,
                    None => {
                        let matrix = matrix.iter().map(|id| self.emit(*id)).collect();
                        let first = self.next;
                        self.next += sides * size;
                        let targets = (first..self.next).collect();
                        self.instructions.push(Instruction::Solve { kind, size, matrix, targets });
                        self.solved.insert(system, first);
                        first
                    }
                };
                first + side * size + unknown
            }
            // The sums of this pass are known from the start, and no pair code contains others.
            _ => self.compute(Operation::Fill(f64::NAN)),
        }
    }

    fn emit_other(&mut self, atom: Atom) -> Register {
        let id = self.arena.atom(atom);
        self.emit(id)
    }

    /// The code with single-use products drawn into the sums they are terms of, on as few registers as will do, the first
    /// `fixed` of them kept. Also where the outputs are.
    fn finish(self, fixed: usize, outputs: &[Register]) -> (Code, Vec<Register>) {
        let instructions = fuse(self.instructions, self.next, outputs);
        allocate(instructions, self.next, fixed, outputs)
    }
}

fn terms_of(terms: &[(super::expression::Real, Id)]) -> Vec<(f64, Id)> {
    terms.iter().map(|(coefficient, id)| (coefficient.get(), *id)).collect()
}

/// What depends on the field: its components, and columns of passes.
pub(super) fn dependent(passes: &[Pass]) -> Vec<Source> {
    let mut found: Vec<Source> = Vec::new();
    for (index, pass) in passes.iter().enumerate() {
        for source in pass.sources() {
            if matches!(source, Source::Field(_)) && !found.contains(&source) {
                found.push(source);
            }
        }
        let (_, columns) = pass.depends_on(&found);
        let stored =
            |(column, depends): (usize, bool)| depends.then_some(Source::Stored { pass: index, column });
        found.extend(columns.into_iter().enumerate().filter_map(stored));
    }
    found
}

/// Whether the field is read where it stands, and nothing that depends on it is taken from a neighbour: u − u_i may then stand
/// for u everywhere, i the particle that the value is of.
pub(super) fn takes_values(passes: &[Pass]) -> bool {
    let dependent = dependent(passes);
    let taken_from_neighbour = |operation: &Operation| match operation {
        Operation::Gather(source @ Source::Stored { .. })
        | Operation::Difference(source @ Source::Stored { .. }) => dependent.contains(source),
        _ => false,
    };
    if passes.iter().flat_map(Pass::operations).any(taken_from_neighbour) {
        return false;
    }
    let reads = |operation: &Operation| {
        matches!(operation, Operation::Gather(Source::Field(_)) | Operation::Own(Source::Field(_)))
    };
    passes.iter().flat_map(Pass::operations).any(reads)
}

/// Has u − u_i read for u.
pub(super) fn take_differences(passes: &mut [Pass]) {
    let code = passes.iter_mut().flat_map(|pass| [&mut pass.pairs, &mut pass.particles]);
    for instruction in code.flat_map(|code| &mut code.instructions) {
        if let Instruction::Compute { operation, .. } = instruction {
            match operation {
                Operation::Gather(source @ Source::Field(_)) => *operation = Operation::Difference(*source),
                Operation::Own(Source::Field(_)) => *operation = Operation::Fill(0.0),
                _ => {}
            }
        }
    }
}

impl Pass {
    fn operations(&self) -> impl Iterator<Item = &Operation> {
        let instructions = self.pairs.instructions.iter().chain(&self.particles.instructions);
        instructions.filter_map(|instruction| match instruction {
            Instruction::Compute { operation, .. } => Some(operation),
            _ => None,
        })
    }

    /// Where its code reads from.
    pub(super) fn sources(&self) -> impl Iterator<Item = Source> {
        self.operations().filter_map(Operation::source)
    }

    /// Which of its sums, and which of its columns, depend on these.
    pub(super) fn depends_on(&self, sources: &[Source]) -> (Vec<bool>, Vec<bool>) {
        let mut sums = vec![false; self.sums];
        let mut registers = vec![false; self.pairs.registers];
        trace(&self.pairs, sources, &mut registers, &mut sums);
        let mut registers = sums.clone();
        registers.resize(self.particles.registers, false);
        trace(&self.particles, sources, &mut registers, &mut []);
        (sums, self.columns.iter().map(|register| registers[*register]).collect())
    }
}

/// Follows what depends on the sources from register to register, and into sums.
fn trace(code: &Code, sources: &[Source], registers: &mut [bool], sums: &mut [bool]) {
    for instruction in &code.instructions {
        let depends = instruction.reads().iter().any(|register| registers[*register]);
        match instruction {
            Instruction::Compute { target, operation } => {
                let reads = operation.source().is_some_and(|source| sources.contains(&source));
                registers[*target] = depends || reads;
            }
            Instruction::Solve { targets, .. } => {
                targets.iter().for_each(|target| registers[*target] = depends);
            }
            Instruction::Reduce { common, factor, others, targets } => {
                let weight = std::iter::once(*common).chain(*factor).any(|register| registers[register]);
                for (other, target) in others.iter().zip(targets) {
                    sums[*target] |= weight || registers[*other];
                }
            }
        }
    }
}
