//! Which particles interact: all pairs within the support, over every periodic image.
//!
//! Stands between the [`Cloud`] and the sums over neighbours. For each particle $i$ it lists all $(j, n)$ with
//!
//! $$ |r_{ij}| < R_i, \qquad r_{ij} = x_i - (x_j + n L), \qquad n \in \mathbb{Z}^P, $$
//!
//! where $L$ holds the lengths of the $P$ periodic axes. There is no minimum-image rule, so the support may exceed
//! half the box or the whole of it: $j$ then occurs several times, and $i$ sees its own images.
//!
//! The cell list is sparse. The first $D-1$ axes are cut into cells as wide as the median support; only occupied
//! cells are stored, sorted, and within each the particles are sorted along the last axis. A query finds its
//! range in each of these lists by bisection. Hence memory is $O(N)$ whatever the extent of the cloud, and an
//! outlier or a tiny support does no harm. Cells are numbered by integral `f64`s, which cannot wrap around.

use std::cmp::Ordering;
use std::mem::size_of;

use rayon::prelude::*;

use super::cloud::{ClosestPair, Cloud, CloudError, LENGTH_LIMIT, Support};

/// No process can address more (47 bits), so larger requests are refused before they are counted.
const ADDRESSABLE_BYTES: u64 = 1 << 47;

/// Lists sampled for the memory estimate.
const SAMPLED_LISTS: usize = 64;

/// Lists filled by one task before the work is split further.
const LISTS_PER_TASK: usize = 64;

/// Widens a query range against the few roundings in its ends; candidates are then tested exactly as documented.
const RANGE_MARGIN: f64 = 16.0 * f64::EPSILON;

/// One entry of a neighbour list.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Neighbour {
    /// The neighbour $j$.
    pub j: u32,
    /// $r_{ij} = x_i - (x_j + nL)$ as `[x, y, z]`, in the cloud's unit of length.
    pub r_ij: [f64; 3],
}

/// Neighbour lists of all particles, or of some, in compressed rows.
///
/// - A pair is listed if $r_{ij} \cdot r_{ij} < R_i^2$ as evaluated in `f64`: strictly, as kernels vanish at $R$.
///   On a lattice whose spacing is not a binary fraction, a shell at exactly $R$ may be listed or not.
/// - $R_i$ is the support of the list's own particle: with supports per particle, $j$ may be in the list of $i$
///   and not conversely. With one support, the lists hold $(j, r_{ij})$ and $(i, -r_{ij})$ alike, to the bit.
/// - The particle itself is listed once with $r_{ii} = 0$, and then through each image within $R_i$.
/// - Order: $j$ ascending, then $n$ ascending lexicographically ($x$ first), that is $r_{ij}$ descending. Neither
///   the cells nor the number of threads affect it.
/// - The error of each component of $r_{ij}$ is at most $\varepsilon |r| + \varepsilon^2 |x_i - x_j|$ with
///   $\varepsilon = 2^{-52}$, so that positions many boxes away lose nothing beyond their own last place.
///
/// # Examples
/// ```
/// use remainder::particles::{Cloud, CloudError, Support};
/// use remainder::particles::Neighbours;
///
/// let cloud = Cloud::new(1, vec![[0.0; 3], [0.25, 0.0, 0.0]], vec![0.5; 2], Support::Uniform(1.125))?
///     .with_periods([Some(1.0), None, None])?;
/// let lists = Neighbours::search(&cloud)?;
/// let of_0: Vec<_> = lists.of(0).iter().map(|pair| (pair.j, pair.r_ij[0])).collect();
/// assert_eq!(of_0, [(0, 1.0), (0, 0.0), (0, -1.0), (1, 0.75), (1, -0.25)]);
/// # Ok::<(), CloudError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Neighbours {
    centres: Vec<u32>,
    offsets: Vec<usize>,
    entries: Vec<Neighbour>,
}

impl Neighbours {
    /// The lists of all particles: list $i$ belongs to particle $i$.
    ///
    /// # Errors
    /// [`CloudError::Memory`] if the lists exceed the address space, [`CloudError::Allocation`] if the memory is
    /// not to be had. See [`search_within`](Self::search_within) for a limit of your own.
    pub fn search(cloud: &Cloud) -> Result<Self, CloudError> {
        Self::search_within(cloud, ADDRESSABLE_BYTES)
    }

    /// As [`search`](Self::search), but refuses to use more than `max_bytes`.
    ///
    /// The limit holds for the exact size, which is counted before the lists are allocated. Only if the estimate
    /// is more than twice the limit is the search refused without counting.
    ///
    /// # Errors
    /// [`CloudError::Memory`] if the lists need more than `max_bytes`, [`CloudError::Allocation`] if the memory
    /// is not to be had.
    pub fn search_within(cloud: &Cloud, max_bytes: u64) -> Result<Self, CloudError> {
        search_lists(cloud, all_particles(cloud), max_bytes)
    }

    /// The lists of the given particles only: list $k$ belongs to particle `centres[k]`.
    ///
    /// The neighbours are still sought among all particles, and each list equals that of [`search`](Self::search).
    ///
    /// # Errors
    /// [`CloudError::NoSuchParticle`] for a centre out of range, otherwise as [`search`](Self::search).
    pub fn search_at(cloud: &Cloud, centres: &[usize]) -> Result<Self, CloudError> {
        let count = cloud.len();
        let number = |(position, &particle): (usize, &usize)| match u32::try_from(particle) {
            Ok(centre) if particle < count => Ok(centre),
            _ => Err(CloudError::NoSuchParticle { position, particle, count }),
        };
        let centres = centres.iter().enumerate().map(number).collect::<Result<_, _>>()?;
        search_lists(cloud, centres, ADDRESSABLE_BYTES)
    }

    /// Bytes that [`search`](Self::search) will need, without searching.
    ///
    /// Counts the neighbours of up to 64 particles spread over the cloud. Along a periodic axis shorter than half
    /// the support, images are not counted but integrated, $\sum_n \to \int \mathrm{d}n$, so that the cost is
    /// $O(N)$ however large the support.
    #[must_use]
    pub fn estimate_bytes(cloud: &Cloud) -> u64 {
        estimate_for(cloud, &all_particles(cloud))
    }

    /// The number of lists.
    #[must_use]
    pub fn len(&self) -> usize {
        self.centres.len()
    }

    /// Whether there are no lists (a partial search without centres).
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.centres.is_empty()
    }

    /// The number of entries in all lists together.
    #[must_use]
    pub fn entry_count(&self) -> usize {
        self.entries.len()
    }

    /// The particle that list `k` belongs to: `k` itself after a full search.
    ///
    /// # Panics
    /// As a slice does, if there is no list `k`.
    #[must_use]
    pub fn centre(&self, k: usize) -> usize {
        self.centres[k] as usize
    }

    /// List `i`: the neighbours of particle `i` after a full search, of `centres[i]` after a partial one.
    ///
    /// # Panics
    /// As a slice does, if there is no list `i`.
    #[must_use]
    pub fn of(&self, i: usize) -> &[Neighbour] {
        &self.entries[self.offsets[i]..self.offsets[i + 1]]
    }
}

fn all_particles(cloud: &Cloud) -> Vec<u32> {
    // A cloud has at most u32::MAX particles, so the zip ends with the particles.
    (0..u32::MAX).zip(cloud.positions()).map(|(i, _)| i).collect()
}

fn search_lists(cloud: &Cloud, centres: Vec<u32>, max_bytes: u64) -> Result<Neighbours, CloudError> {
    let estimate = estimate_for(cloud, &centres);
    if estimate / 2 > max_bytes {
        return Err(CloudError::Memory { needed: estimate, allowed: max_bytes });
    }
    let cells = CellList::new(cloud, median_support(cloud));
    let counts: Vec<usize> = centres
        .par_iter()
        .map(|&i| {
            let mut count = 0;
            cells.visit_support(cloud, i as usize, |_| count += 1);
            count
        })
        .collect();
    let mut offsets = Vec::with_capacity(counts.len() + 1);
    offsets.push(0);
    let mut total = 0;
    for count in counts {
        total += count;
        offsets.push(total);
    }

    let needed = bytes(cloud, centres.len(), total as f64);
    if needed > max_bytes {
        return Err(CloudError::Memory { needed, allowed: max_bytes });
    }
    let mut entries = Vec::new();
    entries.try_reserve_exact(total).map_err(|_| CloudError::Allocation { needed })?;
    entries.resize(total, Neighbour { j: 0, r_ij: [0.0; 3] });
    fill(&cells, cloud, &centres, &offsets, &mut entries);
    Ok(Neighbours { centres, offsets, entries })
}

/// Fills the lists of `centres`; `offsets` has one element more, and `entries` spans the first to the last of them.
fn fill(cells: &CellList, cloud: &Cloud, centres: &[u32], offsets: &[usize], entries: &mut [Neighbour]) {
    if centres.len() > LISTS_PER_TASK {
        let half = centres.len() / 2;
        let (left, right) = entries.split_at_mut(offsets[half] - offsets[0]);
        rayon::join(
            || fill(cells, cloud, &centres[..half], &offsets[..=half], left),
            || fill(cells, cloud, &centres[half..], &offsets[half..], right),
        );
        return;
    }
    let mut rest = entries;
    for (&i, ends) in centres.iter().zip(offsets.windows(2)) {
        let (list, tail) = rest.split_at_mut(ends[1] - ends[0]);
        let mut slots = list.iter_mut();
        cells.visit_support(cloud, i as usize, |pair| {
            if let Some(slot) = slots.next() {
                *slot = pair;
            }
        });
        list.sort_unstable_by(in_list_order);
        rest = tail;
    }
}

/// Ascending $j$, then ascending image $n$: for one pair $i, j$ that is descending $r_{ij}$.
fn in_list_order(a: &Neighbour, b: &Neighbour) -> Ordering {
    let descending = |axis: usize| b.r_ij[axis].total_cmp(&a.r_ij[axis]);
    a.j.cmp(&b.j).then_with(|| descending(0)).then_with(|| descending(1)).then_with(|| descending(2))
}

fn median_support(cloud: &Cloud) -> f64 {
    match cloud.support() {
        Support::Uniform(radius) => *radius,
        Support::PerParticle(radii) => {
            let mut radii = radii.clone();
            let middle = radii.len() / 2; // in range: a cloud has at least one particle
            *radii.select_nth_unstable_by(middle, f64::total_cmp).1
        }
    }
}

/// A particle in the cell list.
struct Site {
    /// Position as given.
    x: [f64; 3],
    /// The box it lies in, for each axis: $\lfloor x / L \rfloor$, 0 where open.
    in_box: [f64; 3],
    j: u32,
}

/// A run of equal cell numbers in a sorted list.
struct Run {
    cell: f64,
    start: usize,
    end: usize,
}

/// The part of an axis that a query covers, and the images that reach into it.
struct Span {
    low: f64,
    high: f64,
    first_image: f64,
    last_image: f64,
    /// 0 where open, so that images do not move.
    period: f64,
}

impl Span {
    fn images(&self) -> impl Iterator<Item = f64> + use<> {
        let first = self.first_image;
        let more = (self.last_image - first) as u64; // a non-negative integer
        (0..=more).map(move |image| first + image as f64)
    }

    /// Where to look in the box for particles whose image `m` is in the span.
    fn window(&self, m: f64) -> (f64, f64) {
        (self.low - m * self.period, self.high - m * self.period)
    }
}

/// The sparse cell list described at the head of this module.
struct CellList {
    /// The two axes cut into cells, then the one sorted along; unused axes come first.
    axes: [usize; 3],
    width: f64,
    /// 0 where open.
    periods: [f64; 3],
    /// Runs of equal cells along the first axis, in `rows`.
    planes: Vec<Run>,
    /// Runs of equal cells along the first two axes, in `sites`.
    rows: Vec<Run>,
    sites: Vec<Site>,
    /// The wrapped coordinates of `sites` along the third axis, ascending in each row.
    along: Vec<f64>,
}

impl CellList {
    fn new(cloud: &Cloud, width: f64) -> Self {
        let axes = match cloud.dimension() {
            1 => [1, 2, 0],
            2 => [2, 0, 1],
            _ => [0, 1, 2],
        };
        let periods = cloud.periods().map(|period| period.unwrap_or(0.0));
        let mut keyed: Vec<(f64, f64, f64, Site)> = cloud
            .positions()
            .par_iter()
            .zip(all_particles(cloud))
            .map(|(&x, j)| {
                let (wrapped, in_box) = wrap(x, periods);
                let [a, b, c] = axes.map(|axis| wrapped[axis]);
                (cell(a, width), cell(b, width), c, Site { x, in_box, j })
            })
            .collect();
        keyed.par_sort_unstable_by(|p, q| {
            let coordinates = p.0.total_cmp(&q.0).then(p.1.total_cmp(&q.1)).then(p.2.total_cmp(&q.2));
            coordinates.then(p.3.j.cmp(&q.3.j))
        });

        let (mut planes, mut rows) = (Vec::<Run>::new(), Vec::<Run>::new());
        let (mut sites, mut along) = (Vec::with_capacity(keyed.len()), Vec::with_capacity(keyed.len()));
        for (index, (a, b, c, site)) in keyed.into_iter().enumerate() {
            let new_plane = planes.last().is_none_or(|plane| plane.cell != a);
            if new_plane || rows.last().is_none_or(|row| row.cell != b) {
                rows.push(Run { cell: b, start: index, end: index });
            }
            if new_plane {
                planes.push(Run { cell: a, start: rows.len() - 1, end: rows.len() });
            }
            if let (Some(plane), Some(row)) = (planes.last_mut(), rows.last_mut()) {
                row.end = index + 1;
                plane.end = rows.len();
            }
            sites.push(site);
            along.push(c);
        }
        Self { axes, width, periods, planes, rows, sites, along }
    }

    /// Visits the neighbours of particle `i` in no particular, but always the same, order.
    fn visit_support(&self, cloud: &Cloud, i: usize, mut found: impl FnMut(Neighbour)) {
        let radius = cloud.support_of(i);
        let radius_squared = radius * radius;
        self.visit(cloud.positions()[i], [radius; 3], |j, r_ij| {
            if norm_squared(r_ij) < radius_squared {
                found(Neighbour { j, r_ij });
            }
        });
    }

    /// Visits at least all images with $|r_a| <$ `reach[a]` on every axis $a$, and some more.
    fn visit(&self, x: [f64; 3], reach: [f64; 3], mut candidate: impl FnMut(u32, [f64; 3])) {
        let (wrapped, in_box) = wrap(x, self.periods);
        let spans = self.axes.map(|axis| span(wrapped[axis], reach[axis], self.periods[axis]));
        let mut image = [0.0; 3];
        for m_a in spans[0].images() {
            image[self.axes[0]] = m_a;
            for plane in self.between(&self.planes, spans[0].window(m_a)) {
                for m_b in spans[1].images() {
                    image[self.axes[1]] = m_b;
                    for row in self.between(&self.rows[plane.start..plane.end], spans[1].window(m_b)) {
                        for m_c in spans[2].images() {
                            image[self.axes[2]] = m_c;
                            for site in self.stretch(row, spans[2].window(m_c)) {
                                candidate(site.j, self.separation(x, in_box, site, image));
                            }
                        }
                    }
                }
            }
        }
    }

    /// The runs whose cells meet the window. Division and rounding down are monotone in `f64`, so none is missed.
    fn between<'a>(&self, runs: &'a [Run], (low, high): (f64, f64)) -> &'a [Run] {
        let (low, high) = (cell(low, self.width), cell(high, self.width));
        let start = runs.partition_point(|run| run.cell < low);
        let length = runs[start..].partition_point(|run| run.cell <= high);
        &runs[start..start + length]
    }

    /// The sites of a row whose wrapped coordinate is in the window.
    fn stretch(&self, row: &Run, (low, high): (f64, f64)) -> &[Site] {
        let along = &self.along[row.start..row.end];
        let start = along.partition_point(|&c| c < low);
        let length = along[start..].partition_point(|&c| c <= high);
        &self.sites[row.start + start..row.start + start + length]
    }

    /// $r_{ij}$ to image $m$ of the wrapped $j$, computed from the positions as given.
    fn separation(&self, x: [f64; 3], in_box: [f64; 3], site: &Site, m: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|axis| {
            let n = m[axis] + in_box[axis] - site.in_box[axis];
            difference(x[axis], site.x[axis], n, self.periods[axis])
        })
    }
}

/// $x - y - nL$, the rounding error of $x - y$ put back after $nL$ has cancelled the most of it.
fn difference(x: f64, y: f64, n: f64, period: f64) -> f64 {
    let d = x - y;
    if n == 0.0 {
        return d;
    }
    // Knuth's two-sum: x - y = d + lost exactly.
    let back = d - x;
    let lost = (x - (d - back)) - (y + back);
    (-n).mul_add(period, d) + lost
}

fn norm_squared(r: [f64; 3]) -> f64 {
    r[0] * r[0] + r[1] * r[1] + r[2] * r[2]
}

/// The number of the cell that holds a coordinate, never -0.
fn cell(coordinate: f64, width: f64) -> f64 {
    (coordinate / width).floor() + 0.0
}

/// $x - kL$ within a rounding of $[0, L]$, and $k$, for each axis; $(x, 0)$ where open.
fn wrap(x: [f64; 3], periods: [f64; 3]) -> ([f64; 3], [f64; 3]) {
    let (mut wrapped, mut in_box) = (x, [0.0; 3]);
    for axis in 0..3 {
        if periods[axis] > 0.0 {
            in_box[axis] = (x[axis] / periods[axis]).floor();
            wrapped[axis] = (-in_box[axis]).mul_add(periods[axis], x[axis]);
        }
    }
    (wrapped, in_box)
}

fn span(wrapped: f64, reach: f64, period: f64) -> Span {
    let margin = RANGE_MARGIN * (wrapped.abs() + reach + period);
    let (low, high) = (wrapped - reach - margin, wrapped + reach + margin);
    let image = |edge: f64| if period > 0.0 { (edge / period).floor() } else { 0.0 };
    Span { low, high, first_image: image(low), last_image: image(high), period }
}

/// Bytes of the cell list and of `lists` lists with `entries` entries together.
fn bytes(cloud: &Cloud, lists: usize, entries: f64) -> u64 {
    let per_particle = size_of::<Site>() + 3 * size_of::<f64>() + size_of::<f64>() + 2 * size_of::<Run>();
    let per_list = size_of::<u32>() + 2 * size_of::<usize>();
    let cells = cloud.len() as f64 * per_particle as f64;
    let index = lists as f64 * per_list as f64;
    (cells + index + entries * size_of::<Neighbour>() as f64).round() as u64 // saturates
}

fn estimate_for(cloud: &Cloud, centres: &[u32]) -> u64 {
    let lists = centres.len();
    let sampled: Vec<usize> = if lists <= SAMPLED_LISTS {
        centres.iter().map(|&i| i as usize).collect()
    } else {
        // Multiples of the golden ratio are spread evenly and in step with no lattice.
        let golden = (5.0_f64.sqrt() - 1.0) / 2.0;
        let spread = |k: usize| ((k as f64 * golden).fract() * lists as f64) as usize;
        (0..SAMPLED_LISTS).map(|k| centres[spread(k).min(lists - 1)] as usize).collect()
    };
    let expected: Vec<f64> = sampled.par_iter().map(|&i| expected_entries(cloud, i)).collect();
    let mean = expected.iter().sum::<f64>() / expected.len().max(1) as f64;
    bytes(cloud, lists, mean * lists as f64)
}

/// The length of list `i`, with images along short periodic axes integrated instead of counted.
fn expected_entries(cloud: &Cloud, i: usize) -> f64 {
    let radius = cloud.support_of(i);
    let axes = cloud.periods().map(|period| match period {
        None => Images::None,
        Some(length) if radius > 2.0 * length => Images::Integrated(length),
        Some(length) => Images::Counted(length),
    });
    let axes = &axes[..cloud.dimension()];
    let x_i = cloud.positions()[i];
    let entries_of = |x_j: &[f64; 3]| {
        let d = [x_i[0] - x_j[0], x_i[1] - x_j[1], x_i[2] - x_j[2]];
        images_within(axes, &d, radius * radius, 0)
    };
    cloud.positions().iter().map(entries_of).sum()
}

/// How the estimate treats the images along an axis of the given period.
enum Images {
    None,
    Counted(f64),
    Integrated(f64),
}

/// The number of images of $d$ with $|d - nL|^2 <$ `left`, over the remaining axes and `integrated` earlier ones.
fn images_within(axes: &[Images], d: &[f64], left: f64, integrated: usize) -> f64 {
    if left <= 0.0 {
        return 0.0;
    }
    let (Some((first, axes)), Some((&d_a, d))) = (axes.split_first(), d.split_first()) else {
        return ball_volume(integrated, left.sqrt());
    };
    match *first {
        Images::None => images_within(axes, d, left - d_a * d_a, integrated),
        Images::Integrated(length) => images_within(axes, d, left, integrated + 1) / length,
        Images::Counted(length) => {
            let reach = left.sqrt();
            let (low, high) = (((d_a - reach) / length).floor(), ((d_a + reach) / length).ceil());
            let shifted = (0..=(high - low) as u64).map(|n| difference(d_a, 0.0, low + n as f64, length));
            shifted.map(|r| images_within(axes, d, left - r * r, integrated)).sum()
        }
    }
}

/// Volume of the ball in 0 to 3 dimensions: $1,\ 2\rho,\ \pi\rho^2,\ \tfrac43\pi\rho^3$.
fn ball_volume(dimension: usize, radius: f64) -> f64 {
    match dimension {
        0 => 1.0,
        1 => 2.0 * radius,
        2 => std::f64::consts::PI * radius * radius,
        _ => 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3),
    }
}

/// See [`Cloud::closest_pair`].
///
/// Particles next to each other in lexicographic order give an upper bound, which is then the reach of one search.
pub(super) fn closest_pair(cloud: &Cloud) -> Option<ClosestPair> {
    let periods = cloud.periods().map(|period| period.unwrap_or(0.0));
    let mut sorted: Vec<([f64; 3], usize)> =
        cloud.positions().iter().enumerate().map(|(i, &x)| (wrap(x, periods).0, i)).collect();
    sorted.par_sort_unstable_by(|(x, i), (y, j)| {
        let axis = |a: usize| x[a].total_cmp(&y[a]);
        axis(0).then(axis(1)).then(axis(2)).then(i.cmp(j))
    });
    let bound = sorted
        .windows(2)
        .map(|pair| {
            let (i, j) = (pair[0].1, pair[1].1);
            let r_ij = nearest_image(cloud.positions()[i], cloud.positions()[j], periods);
            ClosestPair { i: i.min(j), j: i.max(j), distance: norm_squared(r_ij).sqrt() }
        })
        .min_by(by_distance)?;
    if bound.distance == 0.0 {
        return Some(bound);
    }

    let reach = (bound.distance * (1.0 + RANGE_MARGIN)).max(LENGTH_LIMIT.recip());
    let cells = CellList::new(cloud, reach);
    // The nearest image lies within half a period along each axis, whatever the reach.
    let halves =
        periods.map(|period| if period > 0.0 { reach.min(period * (0.5 + RANGE_MARGIN)) } else { reach });
    let closest_to = |i: usize| {
        let mut closest = bound;
        cells.visit(cloud.positions()[i], halves, |j, r_ij| {
            let j = j as usize;
            let pair = ClosestPair { i, j, distance: norm_squared(r_ij).sqrt() };
            if i < j && by_distance(&pair, &closest).is_lt() {
                closest = pair;
            }
        });
        closest
    };
    (0..cloud.len()).into_par_iter().map(closest_to).min_by(by_distance)
}

fn by_distance(a: &ClosestPair, b: &ClosestPair) -> Ordering {
    a.distance.total_cmp(&b.distance).then(a.i.cmp(&b.i)).then(a.j.cmp(&b.j))
}

/// $x - y - nL$ with the $n$ that makes it shortest, axis by axis.
fn nearest_image(x: [f64; 3], y: [f64; 3], periods: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| {
        let period = periods[axis];
        let n = if period > 0.0 { ((x[axis] - y[axis]) / period).round() } else { 0.0 };
        difference(x[axis], y[axis], n, period)
    })
}
