//! Eight particles at a time, each in its lane: their neighbours, the kernel, the sums.

#![allow(clippy::needless_range_loop)] // Axes, lanes and orders index several arrays at once.

use super::lanes::{Lanes, Lists};
use super::radial::Radial;
use super::reach::Reach;
use super::request::{Factor, Pass, Plan, monomials, monomials_below};
use super::sorted::Sorted;
use crate::kernel::LANES;

/// Neighbours that are taken before their sums: what is kept of them stays in the nearest cache.
const TILE: usize = 64;

/// The most sums of one pass: all degrees up to 8 in 3-D.
const MOST_SUMS: usize = 165;

/// The most sums of one degree.
const MOST_OF_DEGREE: usize = 45;

/// All that eight particles are evaluated from.
#[derive(Debug)]
pub(super) struct Task<'a> {
    pub(super) sorted: &'a Sorted,
    pub(super) plan: &'a Plan,
    pub(super) radial: &'a Radial,
    pub(super) support: f64,
}

/// One value for each neighbour of each particle.
type Values = [[f64; LANES]; TILE];

/// Memory of one thread.
#[derive(Debug)]
pub(super) struct Scratch {
    reach: Reach,
    row: Option<usize>,
    ranges: Vec<(u32, u32)>,
    lists: Lists,
    /// r_ij by axis.
    r: Vec<Values>,
    /// ω G_k.
    weighted: Vec<Values>,
    /// ω G_k (f_j − f_i) of one pass.
    differences: Vec<[f64; LANES]>,
    /// f_j − f_i by field.
    fields: Vec<Values>,
    /// f_i by field.
    own_fields: Vec<[f64; LANES]>,
    pub(super) sums: Vec<[f64; LANES]>,
    /// Neighbours seen, i itself included.
    pub(super) pairs: u64,
}

impl Scratch {
    pub(super) fn new(plan: &Plan) -> Self {
        let values = [[0.0; LANES]; TILE];
        Self {
            reach: Reach::default(),
            row: None,
            ranges: Vec::new(),
            lists: Lists::default(),
            r: vec![values; 3],
            weighted: vec![values; 3],
            differences: vec![[0.0; LANES]; TILE],
            fields: vec![values; plan.fields],
            own_fields: vec![[0.0; LANES]; plan.fields],
            sums: vec![[0.0; LANES]; plan.sums],
            pairs: 0,
        }
    }
}

/// The sums of the particles at places `first` … `first + count − 1`, count ≤ 8, into the lanes of `scratch.sums`.
#[inline(always)]
pub(super) fn eight<L: Lanes, const D: usize>(
    task: &Task<'_>,
    first: usize,
    count: usize,
    scratch: &mut Scratch,
) {
    let lengths = list_neighbours::<L, D>(task, first, count, scratch);
    let longest = lengths.iter().copied().max().unwrap_or(0);
    scratch.sums.fill([0.0; LANES]);
    let mut from = 0;
    while from < longest {
        let steps = (longest - from).min(TILE);
        evaluate::<L, D>(task, first, count, &lengths, from, steps, scratch);
        for pass in &task.plan.passes {
            let g = match pass.factor {
                Factor::One => &scratch.weighted[pass.radial][..],
                Factor::Difference(field) => {
                    let (g, f) = (&scratch.weighted[pass.radial], &scratch.fields[field]);
                    for step in 0..steps {
                        L::load(&g[step]).mul(L::load(&f[step])).store(&mut scratch.differences[step]);
                    }
                    &scratch.differences[..]
                }
            };
            take::<L, D>(pass, &scratch.r, g, steps, &mut scratch.sums);
        }
        from += steps;
    }
}

/// Lists the neighbours of each particle and returns how many each has. Lists are filled up with the particle itself.
#[inline(always)]
fn list_neighbours<L: Lanes, const D: usize>(
    task: &Task<'_>,
    first: usize,
    count: usize,
    scratch: &mut Scratch,
) -> [usize; LANES] {
    let sorted = task.sorted;
    let axes: [&[f64]; D] = std::array::from_fn(|a| &sorted.columns[a][..]);
    let square = task.support * task.support;
    let mut lengths = [0; LANES];
    for (lane, length) in lengths.iter_mut().enumerate().take(count) {
        let place = first + lane;
        let row = match scratch.row {
            Some(row) if (place as u32) < sorted.rows[row].end && place as u32 >= sorted.rows[row].first => {
                row
            }
            _ => {
                let row = sorted.row_at(place);
                scratch.reach.aim(sorted, row, D);
                scratch.row = Some(row);
                row
            }
        };
        debug_assert!(sorted.rows[row].end as usize > place);
        let centre: [f64; D] = std::array::from_fn(|a| axes[a][place]);
        scratch.reach.ranges::<L, D>(sorted, centre, square, &mut scratch.ranges);
        let most: usize = scratch.ranges.iter().map(|(from, to)| (to - from) as usize).sum();
        make_room(&mut scratch.lists, most + LANES, lane);
        let at = lane * scratch.lists.stride;
        let list = &mut scratch.lists.of[at..at + scratch.lists.stride];
        let mut len = 0;
        for (from, to) in &scratch.ranges {
            len = L::select(axes, centre, square, (*from as usize, *to as usize), list, len);
        }
        *length = len;
        scratch.pairs += len as u64;
    }
    let longest = lengths.iter().copied().max().unwrap_or(0);
    for (lane, length) in lengths.iter().enumerate() {
        let own = first + if lane < count { lane } else { 0 };
        let at = lane * scratch.lists.stride;
        scratch.lists.of[at + length..at + longest].fill(own as u32);
    }
    lengths
}

/// Lists of at least `most` entries, those of the lanes below `lane` kept.
#[inline(always)]
fn make_room(lists: &mut Lists, most: usize, lane: usize) {
    if most > lists.stride {
        grow(lists, most, lane);
    }
}

#[cold]
fn grow(lists: &mut Lists, most: usize, lane: usize) {
    let stride = most.next_power_of_two().max(64) + LANES;
    let mut of = vec![0; stride * LANES];
    for lane in 0..lane {
        of[lane * stride..][..lists.stride].copy_from_slice(&lists.of[lane * lists.stride..][..lists.stride]);
    }
    *lists = Lists { of, stride };
}

/// r_ij, ω G_k and f_j − f_i of the neighbours `from` … `from + steps − 1` of each particle.
#[inline(always)]
fn evaluate<L: Lanes, const D: usize>(
    task: &Task<'_>,
    first: usize,
    count: usize,
    lengths: &[usize; LANES],
    from: usize,
    steps: usize,
    scratch: &mut Scratch,
) {
    let sorted = task.sorted;
    let own: [usize; LANES] = std::array::from_fn(|lane| first + if lane < count { lane } else { 0 });
    let of_own = |column: usize| L::load(&own.map(|place| sorted.columns[column][place]));
    let centre: [L; D] = std::array::from_fn(of_own);
    let (zero, one) = (L::splat(0.0), L::splat(1.0));
    let length = L::load(&lengths.map(|length| length as f64));
    let inverse_support = L::splat(1.0 / task.support);
    let axes: [&[f64]; D] = std::array::from_fn(|a| &sorted.columns[a][..]);
    let weights = &sorted.columns[D][..];
    for (field, values) in scratch.own_fields.iter_mut().enumerate() {
        of_own(D + 1 + field).store(values);
    }
    for step in 0..steps {
        let index = L::entries(&scratch.lists, from + step);
        let position = L::gather(axes, index);
        let [weight] = L::gather([weights], index);
        // Behind the end of its list a lane sees its own particle, without weight.
        let weight = L::splat((from + step) as f64).where_below(length, weight, zero);
        let mut square = zero;
        for a in 0..D {
            let r = centre[a].sub(position[a]);
            r.store(&mut scratch.r[a][step]);
            square = if a == 0 { r.mul(r) } else { square.add(r.mul(r)) };
        }
        let x = square.sqrt().mul(inverse_support).min(one);
        let g = task.radial.evaluate::<L>(x, &task.plan.radials);
        for k in 0..3 {
            if task.plan.radials[k] {
                g[k].mul(weight).store(&mut scratch.weighted[k][step]);
            }
        }
        for (field, values) in scratch.fields.iter_mut().enumerate() {
            let [f] = L::gather([&sorted.columns[D + 1 + field][..]], index);
            f.sub(L::load(&scratch.own_fields[field])).store(&mut values[step]);
        }
    }
}

/// One pass: Σ r^μ g of every wanted degree.
#[inline(always)]
fn take<L: Lanes, const D: usize>(
    pass: &Pass,
    r: &[Values],
    g: &[[f64; LANES]],
    steps: usize,
    sums: &mut [[f64; LANES]],
) {
    let sums = &mut sums[pass.offset..];
    match pass.highest() {
        0 => up_to::<L, D, 0>(pass.degrees, r, g, steps, sums),
        1 => up_to::<L, D, 1>(pass.degrees, r, g, steps, sums),
        2 => up_to::<L, D, 2>(pass.degrees, r, g, steps, sums),
        3 => up_to::<L, D, 3>(pass.degrees, r, g, steps, sums),
        4 => up_to::<L, D, 4>(pass.degrees, r, g, steps, sums),
        5 => up_to::<L, D, 5>(pass.degrees, r, g, steps, sums),
        6 => up_to::<L, D, 6>(pass.degrees, r, g, steps, sums),
        7 => up_to::<L, D, 7>(pass.degrees, r, g, steps, sums),
        _ => up_to::<L, D, 8>(pass.degrees, r, g, steps, sums),
    }
}

#[inline(always)]
fn up_to<L: Lanes, const D: usize, const HIGHEST: usize>(
    degrees: u16,
    r: &[Values],
    g: &[[f64; LANES]],
    steps: usize,
    sums: &mut [[f64; LANES]],
) {
    let count = monomials_below(D, HIGHEST + 1);
    let mut own = [L::splat(0.0); MOST_SUMS];
    for (own, sum) in own.iter_mut().zip(&sums[..count]) {
        *own = L::load(sum);
    }
    for step in 0..steps {
        let x: [L; D] = std::array::from_fn(|a| L::load(&r[a][step]));
        let mut products = [L::load(&g[step]); MOST_OF_DEGREE];
        add::<L, D, 0>(degrees, &products, &mut own);
        if HIGHEST >= 1 {
            raise::<L, D, 1>(&mut products, x);
            add::<L, D, 1>(degrees, &products, &mut own);
        }
        if HIGHEST >= 2 {
            raise::<L, D, 2>(&mut products, x);
            add::<L, D, 2>(degrees, &products, &mut own);
        }
        if HIGHEST >= 3 {
            raise::<L, D, 3>(&mut products, x);
            add::<L, D, 3>(degrees, &products, &mut own);
        }
        if HIGHEST >= 4 {
            raise::<L, D, 4>(&mut products, x);
            add::<L, D, 4>(degrees, &products, &mut own);
        }
        if HIGHEST >= 5 {
            raise::<L, D, 5>(&mut products, x);
            add::<L, D, 5>(degrees, &products, &mut own);
        }
        if HIGHEST >= 6 {
            raise::<L, D, 6>(&mut products, x);
            add::<L, D, 6>(degrees, &products, &mut own);
        }
        if HIGHEST >= 7 {
            raise::<L, D, 7>(&mut products, x);
            add::<L, D, 7>(degrees, &products, &mut own);
        }
        if HIGHEST >= 8 {
            raise::<L, D, 8>(&mut products, x);
            add::<L, D, 8>(degrees, &products, &mut own);
        }
    }
    for (sum, own) in sums[..count].iter_mut().zip(&own) {
        own.store(sum);
    }
}

/// The products of degree N − 1 become those of degree N: all times x, those without x times y, the last times z.
#[inline(always)]
fn raise<L: Lanes, const D: usize, const N: usize>(products: &mut [L; MOST_OF_DEGREE], x: [L; D]) {
    let before = monomials(D, N - 1);
    if D == 3 {
        products[before + N] = products[before - 1].mul(x[2]);
        for a in 0..N {
            products[before + a] = products[before - N + a].mul(x[1]);
        }
    } else if D == 2 {
        products[before] = products[before - 1].mul(x[1]);
    }
    for product in products.iter_mut().take(before) {
        *product = product.mul(x[0]);
    }
}

#[inline(always)]
fn add<L: Lanes, const D: usize, const N: usize>(
    degrees: u16,
    products: &[L; MOST_OF_DEGREE],
    own: &mut [L; MOST_SUMS],
) {
    if degrees & (1 << N) != 0 {
        let from = monomials_below(D, N);
        for a in 0..monomials(D, N) {
            own[from + a] = own[from + a].add(products[a]);
        }
    }
}
