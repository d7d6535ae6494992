//! Instructions carried out: on the pairs of a few particles at a time, then on a few dozen particles.
//!
//! Eight particles stand side by side: lane 8k + p of a group is the k-th pair of its p-th particle, so that the sums of all
//! eight grow together. Where a particle has fewer neighbours than another of its group, lanes at distance R hold no pair. A
//! particle's pairs are added up in the order of its list, whatever stands beside it and whichever thread it is on.
//!
//! [`probe`] takes the derivative of a pass by what its particles carry.

mod probe;

pub(super) use probe::weights;

use self::probe::{At, Probe};
use super::ProgramError;
use super::compile::Program;
use super::expression::SystemKind;
use super::instruction::{Code, Instruction, Operation, Register, Source};
use super::kernel::Distance;
use super::schedule::Pass;
use super::solve;
use crate::particles::{Neighbour, Neighbours};
use rayon::prelude::*;
use std::borrow::Cow;
use std::ops::Range;

/// Rows of eight lanes in a block of pairs, so that its registers stay in the first-level cache.
const ROWS: usize = 32;
/// Particles that are computed with together after their pairs.
const PARTICLES: usize = 64;
/// Particles side by side.
const GROUP: usize = 8;

/// Numbers of the particles.
pub(super) struct Columns<'a> {
    pub(super) values: Cow<'a, [f64]>,
    /// From particle to particle.
    pub(super) stride: usize,
    /// Of the first particle.
    pub(super) offset: usize,
}

/// What the particles carry, and what they are.
pub(super) struct Inputs<'a> {
    pub(super) columns: Vec<(Source, Columns<'a>)>,
    pub(super) particles: usize,
    /// 1/R.
    pub(super) per_support: f64,
}

/// A column at hand: particle i has `values[i · stride + offset]`.
#[derive(Clone, Copy)]
struct View<'a> {
    values: &'a [f64],
    stride: usize,
    offset: usize,
}

impl View<'_> {
    /// Not a number for a particle that there is not.
    fn at(&self, particle: usize) -> f64 {
        self.values.get(particle * self.stride + self.offset).copied().unwrap_or(f64::NAN)
    }
}

/// What a pass works on, the same for every thread.
#[derive(Clone, Copy)]
pub(super) struct Context<'a> {
    pub(super) pass: &'a Pass,
    pub(super) program: &'a Program,
    pub(super) inputs: &'a Inputs<'a>,
    pub(super) stored: &'a [Columns<'a>],
    pub(super) lists: Option<&'a Neighbours>,
    pub(super) probe: Option<Probe<'a>>,
}

/// Numbers of eight particles side by side.
type Row = [f64; GROUP];

/// The lanes of eight particles.
struct Group {
    /// Place of the first of them among the particles.
    slot: usize,
    /// The pair of each that stands in the first row, by its place in the particle's list.
    first: usize,
    /// The particles themselves; where there are fewer than eight, the first of them again.
    centres: [usize; GROUP],
    rows: Range<usize>,
}

/// The registers of one thread.
#[derive(Default)]
struct Scratch {
    pairs: Vec<Vec<Row>>,
    particles: Vec<Vec<Row>>,
    /// The neighbour in each lane.
    neighbours: Vec<[u32; GROUP]>,
    groups: Vec<Group>,
    /// Rows filled with pairs.
    filled: usize,
    /// The particle in each place.
    centres: Vec<usize>,
    /// Where the pairs of each particle begin, and where those of the last one end.
    starts: Vec<usize>,
    /// The summands of each sum that depends on the field, by pair.
    terms: Vec<Vec<f64>>,
    /// In which places the particle itself carries the 1.
    own: Vec<bool>,
}

/// Runs one pass; its columns, by particle.
pub(super) fn pass(context: Context<'_>) -> Result<Vec<f64>, ProgramError> {
    let width = context.pass.columns.len();
    let count = context.count();
    let mut values = vec![0.0; width * count];
    if width == 0 {
        return Ok(values);
    }
    let failures: Vec<Option<ProgramError>> = values
        .par_chunks_mut(width * PARTICLES)
        .enumerate()
        .map_init(Scratch::default, |scratch, (chunk, values)| {
            let first = chunk * PARTICLES;
            context.run(scratch, first..first + values.len() / width, values).err()
        })
        .collect();
    failures.into_iter().flatten().next().map_or(Ok(values), Err)
}

impl<'a> Context<'a> {
    /// How many particles have values.
    pub(super) fn count(&self) -> usize {
        self.lists.map_or(self.inputs.particles, Neighbours::len)
    }

    fn view(&self, source: Source) -> View<'a> {
        let (columns, offset) = match source {
            Source::Stored { pass, column } => (self.stored.get(pass), column),
            _ => (self.inputs.columns.iter().find(|(known, _)| *known == source).map(|(_, c)| c), 0),
        };
        match columns {
            Some(columns) => {
                View { values: &columns.values, stride: columns.stride, offset: columns.offset + offset }
            }
            None => View { values: &[], stride: 0, offset: 0 },
        }
    }

    fn run(
        &self,
        scratch: &mut Scratch,
        lists: Range<usize>,
        values: &mut [f64],
    ) -> Result<(), ProgramError> {
        let count = lists.len();
        self.add_up(scratch, lists)?;
        self.execute(&self.pass.particles, scratch, count, false, &[])?;
        for (column, register) in self.pass.columns.iter().enumerate() {
            let results = &scratch.particles[*register].as_flattened()[..count];
            for (value, result) in
                values.iter_mut().skip(column).step_by(self.pass.columns.len()).zip(results)
            {
                *value = *result;
            }
        }
        match values.iter().position(|value| !value.is_finite()) {
            Some(place) => Err(ProgramError::NotFinite {
                particle: scratch.centres[place / self.pass.columns.len()],
                value: values[place],
            }),
            None => Ok(()),
        }
    }

    /// The sums of a chunk of particles.
    fn add_up(&self, scratch: &mut Scratch, lists: Range<usize>) -> Result<(), ProgramError> {
        scratch.prepare(self.pass);
        scratch.centres.extend(lists.clone().map(|k| self.lists.map_or(k, |lists| lists.centre(k))));
        scratch.particles[..self.pass.sums].iter_mut().for_each(|sums| sums.fill([0.0; GROUP]));
        if let (Some(neighbours), true) = (self.lists, self.pass.sums > 0) {
            for slot in (0..lists.len()).step_by(GROUP) {
                let first = lists.start + slot;
                let here = GROUP.min(lists.end - first);
                let lists = std::array::from_fn(|p| if p < here { neighbours.of(first + p) } else { &[] });
                self.enter(scratch, slot, lists)?;
            }
            self.flush(scratch, &[])?;
        }
        Ok(())
    }

    /// Enters the pairs of eight particles, in several blocks if they are too many for one.
    fn enter(
        &self,
        scratch: &mut Scratch,
        slot: usize,
        mut lists: [&[Neighbour]; GROUP],
    ) -> Result<(), ProgramError> {
        let own = |p: usize| scratch.centres.get(slot + p).copied().unwrap_or(scratch.centres[slot]);
        let centres = std::array::from_fn(own);
        let mut first = 0;
        loop {
            let longest = lists.iter().map(|list| list.len()).max().unwrap_or(0).min(ROWS);
            if longest == 0 {
                return Ok(());
            }
            if scratch.filled + longest > ROWS {
                self.flush(scratch, &lists)?;
            }
            let rows = scratch.filled..scratch.filled + longest;
            scratch.filled = rows.end;
            let (axes, rest) = scratch.pairs.split_at_mut(self.program.dimension());
            for (axis, register) in axes.iter_mut().enumerate() {
                register[rows.clone()].fill([if axis == 0 { 1.0 } else { 0.0 }; GROUP]);
            }
            let neighbours = &mut scratch.neighbours[rows.clone()];
            neighbours.fill([centres[0] as u32; GROUP]);
            for (p, list) in lists.iter_mut().enumerate() {
                let (now, later) = list.split_at(longest.min(list.len()));
                *list = later;
                if self.pass.masked {
                    let mask = rest[0][rows.clone()].iter_mut().enumerate();
                    mask.for_each(|(k, row)| row[p] = if k < now.len() { 1.0 } else { 0.0 });
                }
                let scale = self.inputs.per_support;
                let pairs = now.iter().zip(neighbours.iter_mut());
                match &mut axes[..] {
                    [x] => {
                        for ((pair, j), x) in pairs.zip(&mut x[rows.clone()]) {
                            (j[p], x[p]) = (pair.j, pair.r_ij[0] * scale);
                        }
                    }
                    [x, y] => {
                        for (((pair, j), x), y) in pairs.zip(&mut x[rows.clone()]).zip(&mut y[rows.clone()]) {
                            (j[p], x[p], y[p]) = (pair.j, pair.r_ij[0] * scale, pair.r_ij[1] * scale);
                        }
                    }
                    [x, y, z] => {
                        let axes =
                            x[rows.clone()].iter_mut().zip(&mut y[rows.clone()]).zip(&mut z[rows.clone()]);
                        for ((pair, j), ((x, y), z)) in pairs.zip(axes) {
                            let r = pair.r_ij.map(|r| r * scale);
                            (j[p], x[p], y[p], z[p]) = (pair.j, r[0], r[1], r[2]);
                        }
                    }
                    _ => {}
                }
            }
            scratch.groups.push(Group { slot, first, centres, rows });
            first += longest;
        }
    }

    /// Computes with the block, and begins to load what comes next meanwhile.
    fn flush(&self, scratch: &mut Scratch, next: &[&[Neighbour]]) -> Result<(), ProgramError> {
        let lanes = scratch.filled * GROUP;
        if lanes > 0 {
            self.execute(&self.pass.pairs, scratch, lanes, true, next)?;
        }
        scratch.groups.clear();
        scratch.filled = 0;
        Ok(())
    }

    fn execute(
        &self,
        code: &Code,
        scratch: &mut Scratch,
        lanes: usize,
        pairs: bool,
        next: &[&[Neighbour]],
    ) -> Result<(), ProgramError> {
        let mut next = next.iter();
        let per_instruction = next.len().div_ceil(code.instructions.len().max(1));
        for instruction in &code.instructions {
            next.by_ref().take(per_instruction).for_each(|list| touch(list));
            match instruction {
                Instruction::Compute { target, operation } => {
                    let registers = if pairs { &mut scratch.pairs } else { &mut scratch.particles };
                    let mut values = std::mem::take(&mut registers[*target]);
                    self.compute(operation, scratch, &mut values.as_flattened_mut()[..lanes], pairs);
                    let registers = if pairs { &mut scratch.pairs } else { &mut scratch.particles };
                    registers[*target] = values;
                }
                Instruction::Solve { kind, size, matrix, targets } => {
                    let registers = if pairs { &mut scratch.pairs } else { &mut scratch.particles };
                    let singular = solve_all(*kind, *size, matrix, targets, registers, lanes);
                    if let Some(lane) = singular {
                        let group =
                            scratch.groups.iter().find(|group| pairs && group.rows.contains(&(lane / GROUP)));
                        let particle = match group {
                            Some(group) => group.centres[lane % GROUP],
                            None => scratch.centres[lane],
                        };
                        return Err(ProgramError::Singular {
                            particle,
                            tensor: match kind {
                                SystemKind::Renormalisation => "B",
                                SystemKind::RenormalisationHat => "B̂",
                                SystemKind::Inverse => "the inverse",
                            },
                        });
                    }
                }
                Instruction::Reduce { common, factor, others, targets } => match self.probe {
                    Some(Probe { at: At::Neighbour, .. }) => {
                        scratch.keep(*common, *factor, others, targets);
                    }
                    _ => scratch.reduce(*common, *factor, others, targets),
                },
            }
        }
        Ok(())
    }

    fn compute(&self, operation: &Operation, scratch: &Scratch, values: &mut [f64], pairs: bool) {
        let registers = if pairs { &scratch.pairs } else { &scratch.particles };
        let lanes = values.len();
        let at = |register: Register| &registers[register].as_flattened()[..lanes];
        if let (Some(probe), Some(source)) = (&self.probe, operation.source()) {
            if probe.dependent.contains(&source) {
                return self.seed(probe, operation, scratch, values, pairs);
            }
        }
        match *operation {
            Operation::Gather(source) => {
                let view = self.view(source);
                for (value, j) in values.iter_mut().zip(scratch.neighbours.as_flattened()) {
                    *value = view.at(*j as usize);
                }
            }
            Operation::Difference(source) => {
                let view = self.view(source);
                for Group { centres, rows, .. } in &scratch.groups {
                    let own = centres.map(|centre| view.at(centre));
                    let values = values[rows.start * GROUP..rows.end * GROUP].chunks_exact_mut(GROUP);
                    for (row, neighbours) in values.zip(&scratch.neighbours[rows.clone()]) {
                        for ((value, j), own) in row.iter_mut().zip(neighbours).zip(own) {
                            *value = view.at(*j as usize) - own;
                        }
                    }
                }
            }
            Operation::Own(source) => {
                let view = self.view(source);
                if pairs {
                    for Group { centres, rows, .. } in &scratch.groups {
                        let own = centres.map(|centre| view.at(centre));
                        let values = values[rows.start * GROUP..rows.end * GROUP].chunks_exact_mut(GROUP);
                        values.for_each(|row| row.copy_from_slice(&own));
                    }
                } else {
                    for (value, centre) in values.iter_mut().zip(&scratch.centres) {
                        *value = view.at(*centre);
                    }
                }
            }
            Operation::Fill(c) => values.fill(c),
            Operation::Square => {
                let r: Vec<&[f64]> = (0..self.program.dimension()).map(at).collect();
                match r[..] {
                    [x] => map(values, x, |x| x * x),
                    [x, y] => map_2(values, x, y, |x, y| x * x + y * y),
                    [x, y, z] => map_3(values, x, y, z, |x, y, z| x * x + y * y + z * z),
                    _ => {}
                }
            }
            Operation::Root(a) => map(values, at(a), f64::sqrt),
            Operation::Inverse(a) if pairs => {
                map(values, at(a), |a| if a == 0.0 { 0.0 } else { 1.0 / a });
            }
            Operation::Inverse(a) => map(values, at(a), |a| 1.0 / a),
            Operation::Radial { k, of, inverse, weight } => {
                let distance = match of {
                    Distance::Itself(register) => Distance::Itself(at(register)),
                    Distance::Square(register) => Distance::Square(at(register)),
                };
                self.program.kernel().evaluate(k, distance, inverse.map(at), weight.map(at), values);
            }
            Operation::Add(a, b) => map_2(values, at(a), at(b), |a, b| a + b),
            Operation::Subtract(a, b) => map_2(values, at(a), at(b), |a, b| a - b),
            Operation::Multiply(a, b) => map_2(values, at(a), at(b), |a, b| a * b),
            Operation::Scale(a, c) => map(values, at(a), |a| a * c),
            Operation::Shift(a, c) => map(values, at(a), |a| a + c),
            Operation::AddScaled(a, c, b) => map_2(values, at(a), at(b), |a, b| a + c * b),
            Operation::MultiplyAdd(a, b, c) => map_3(values, at(a), at(b), at(c), |a, b, c| a + b * c),
            Operation::MultiplySubtract(a, b, c) => map_3(values, at(a), at(b), at(c), |a, b, c| a - b * c),
        }
    }
}

#[inline(always)]
fn map(values: &mut [f64], a: &[f64], f: impl Fn(f64) -> f64) {
    for (value, a) in values.iter_mut().zip(a) {
        *value = f(*a);
    }
}

#[inline(always)]
fn map_2(values: &mut [f64], a: &[f64], b: &[f64], f: impl Fn(f64, f64) -> f64) {
    for ((value, a), b) in values.iter_mut().zip(a).zip(b) {
        *value = f(*a, *b);
    }
}

#[inline(always)]
fn map_3(values: &mut [f64], a: &[f64], b: &[f64], c: &[f64], f: impl Fn(f64, f64, f64) -> f64) {
    for (((value, a), b), c) in values.iter_mut().zip(a).zip(b).zip(c) {
        *value = f(*a, *b, *c);
    }
}

impl Scratch {
    fn prepare(&mut self, pass: &Pass) {
        self.pairs.resize_with(pass.pairs.registers, || vec![[0.0; GROUP]; ROWS]);
        self.particles.resize_with(pass.particles.registers, || vec![[0.0; GROUP]; PARTICLES / GROUP]);
        self.neighbours.resize(ROWS, [0; GROUP]);
        self.groups.clear();
        self.centres.clear();
        self.filled = 0;
    }

    /// See [`Instruction::Reduce`].
    fn reduce(
        &mut self,
        common: Register,
        factor: Option<Register>,
        others: &[Register],
        targets: &[Register],
    ) {
        match (others, targets) {
            ([a], [r]) => self.reduce_together(common, factor, [*a], [*r]),
            ([a, b], [r, s]) => self.reduce_together(common, factor, [*a, *b], [*r, *s]),
            ([a, b, c], [r, s, t]) => self.reduce_together(common, factor, [*a, *b, *c], [*r, *s, *t]),
            ([a, b, c, d], [r, s, t, u]) => {
                self.reduce_together(common, factor, [*a, *b, *c, *d], [*r, *s, *t, *u]);
            }
            _ => {}
        }
    }

    fn reduce_together<const N: usize>(
        &mut self,
        common: Register,
        factor: Option<Register>,
        others: [Register; N],
        targets: [Register; N],
    ) {
        for Group { slot, rows, .. } in &self.groups {
            let at = |register: Register| &self.pairs[register][rows.clone()];
            let place = slot / GROUP;
            let mut sums = targets.map(|target| self.particles[target][place]);
            match factor {
                None => add_rows(&mut sums, at(common), others.map(at)),
                Some(factor) => add_multiplied_rows(&mut sums, at(common), at(factor), others.map(at)),
            }
            for (target, sums) in targets.iter().zip(sums) {
                self.particles[*target][place] = sums;
            }
        }
    }
}

/// Lanes whose sums the processor's registers hold together.
const HALF: usize = GROUP / 2;

#[inline(always)]
fn half(row: &Row, second: bool) -> [f64; HALF] {
    let [a, b, c, d, e, f, g, h] = *row;
    if second { [e, f, g, h] } else { [a, b, c, d] }
}

#[inline(always)]
fn add_rows<const N: usize>(sums: &mut [Row; N], common: &[Row], others: [&[Row]; N]) {
    let others = others.map(|other| &other[..common.len()]);
    for second in [false, true] {
        let mut own = std::array::from_fn(|n| half(&sums[n], second));
        for row in 0..common.len() {
            let weight = half(&common[row], second);
            add_products(&mut own, weight, std::array::from_fn(|n| half(&others[n][row], second)));
        }
        put_back(sums, own, second);
    }
}

#[inline(always)]
fn add_multiplied_rows<const N: usize>(
    sums: &mut [Row; N],
    common: &[Row],
    factor: &[Row],
    others: [&[Row]; N],
) {
    let others = others.map(|other| &other[..common.len()]);
    let factor = &factor[..common.len()];
    for second in [false, true] {
        let mut own = std::array::from_fn(|n| half(&sums[n], second));
        for row in 0..common.len() {
            let (a, b) = (half(&common[row], second), half(&factor[row], second));
            let weight = std::array::from_fn(|lane| a[lane] * b[lane]);
            add_products(&mut own, weight, std::array::from_fn(|n| half(&others[n][row], second)));
        }
        put_back(sums, own, second);
    }
}

#[inline(always)]
fn add_products<const N: usize>(sums: &mut [[f64; HALF]; N], weight: [f64; HALF], others: [[f64; HALF]; N]) {
    for n in 0..N {
        for lane in 0..HALF {
            sums[n][lane] += weight[lane] * others[n][lane];
        }
    }
}

#[inline(always)]
fn put_back<const N: usize>(sums: &mut [Row; N], own: [[f64; HALF]; N], second: bool) {
    for (sums, own) in sums.iter_mut().zip(own) {
        let (first_half, second_half) = sums.split_at_mut(HALF);
        if second { second_half.copy_from_slice(&own) } else { first_half.copy_from_slice(&own) }
    }
}

/// Reads a list so that it is in the cache when it is needed: the lists are the bulk of the memory that goes through, and a
/// block waits for all of its own at once.
fn touch(list: &[Neighbour]) {
    let per_line = 64 / size_of::<Neighbour>();
    let read = list.iter().step_by(per_line).fold(0_u32, |read, pair| read.wrapping_add(pair.j));
    std::hint::black_box(read);
}

/// Solves the systems of all lanes; says at which lane the first singular one stands.
fn solve_all(
    kind: SystemKind,
    size: usize,
    matrix: &[Register],
    targets: &[Register],
    registers: &mut [Vec<Row>],
    lanes: usize,
) -> Option<usize> {
    let mut results: Vec<Vec<Row>> =
        targets.iter().map(|target| std::mem::take(&mut registers[*target])).collect();
    let columns: Vec<&[f64]> =
        matrix.iter().map(|entry| &registers[*entry].as_flattened()[..lanes]).collect();
    let mut out: Vec<&mut [f64]> =
        results.iter_mut().map(|result| &mut result.as_flattened_mut()[..lanes]).collect();
    let singular = match (kind, size, &mut out[..], &columns[..]) {
        (SystemKind::Renormalisation | SystemKind::Inverse, 2, [a, b, c, d], [m, n, o, p]) => {
            solve::invert_2([m, n, o, p], [a, b, c, d])
        }
        (SystemKind::Renormalisation | SystemKind::Inverse, 1, ..) => {
            each::<1, 1>(&columns, &mut out, identity, lanes)
        }
        (SystemKind::Renormalisation | SystemKind::Inverse, ..) => {
            each::<3, 3>(&columns, &mut out, identity, lanes)
        }
        (SystemKind::RenormalisationHat, 1, ..) => each::<1, 1>(&columns, &mut out, |_| [-1.0], lanes),
        (SystemKind::RenormalisationHat, 3, ..) => {
            each::<3, 1>(&columns, &mut out, |row| [[-1.0, 0.0, -1.0][row]], lanes)
        }
        (SystemKind::RenormalisationHat, ..) => {
            each::<6, 1>(&columns, &mut out, |row| [[-1.0, 0.0, 0.0, -1.0, 0.0, -1.0][row]], lanes)
        }
    };
    for (target, result) in targets.iter().zip(results) {
        registers[*target] = result;
    }
    singular
}

fn identity<const N: usize>(row: usize) -> [f64; N] {
    std::array::from_fn(|column| if column == row { 1.0 } else { 0.0 })
}

fn each<const N: usize, const SIDES: usize>(
    matrix: &[&[f64]],
    results: &mut [&mut [f64]],
    side: impl Fn(usize) -> [f64; SIDES],
    lanes: usize,
) -> Option<usize> {
    for lane in 0..lanes {
        let a = std::array::from_fn(|row| std::array::from_fn(|column| matrix[row * N + column][lane]));
        let mut sides: [[f64; SIDES]; N] = std::array::from_fn(&side);
        if !solve::solve(a, &mut sides) {
            return Some(lane);
        }
        for (unknown, values) in sides.iter().enumerate() {
            for (number, value) in values.iter().enumerate() {
                results[number * N + unknown][lane] = *value;
            }
        }
    }
    None
}
