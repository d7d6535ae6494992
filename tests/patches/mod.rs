//! Patches of particles that operators are tried on, each with the particle that is looked at.

use remainder::kernel::Kernel;
use remainder::language::ground::CloudGround;
use remainder::particles::lattice::lattice_by_id;
use remainder::particles::{Cloud, Neighbours, Support};

/// A cloud with volumes, densities, masses and viscosities in no order, its lists and a kernel. Lengths are in Δ.
pub(crate) struct Patch {
    pub(crate) cloud: Cloud,
    pub(crate) lists: Neighbours,
    pub(crate) kernel: Kernel,
    /// The particle nearest to the origin: far enough from the rim of what was built.
    pub(crate) centre: usize,
}

/// What a patch is built from.
#[derive(Clone, Copy)]
pub(crate) struct Recipe {
    pub(crate) lattice: &'static str,
    /// R/Δ.
    pub(crate) support: f64,
    /// Sites up to this distance, in R.
    pub(crate) reach: f64,
    /// The greatest displacement along an axis, in Δ.
    pub(crate) jitter: f64,
    /// Particles at x·n above this are cut away, in Δ: a free surface.
    pub(crate) surface: Option<f64>,
    pub(crate) seed: u64,
}

/// Steele, Lea & Flood's SplitMix64: numbers in [−1, 1).
pub(crate) fn noise(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

impl Recipe {
    pub(crate) fn patch(self, kernel: &Kernel) -> Patch {
        let lattice = lattice_by_id(self.lattice).unwrap();
        let mut state = self.seed;
        let normal = [0.6, 0.64, 0.48];
        let sites = lattice.sites_within(self.reach * self.support).into_iter();
        let mut positions: Vec<[f64; 3]> = sites.map(|site| site.position).collect();
        for place in &mut positions {
            for x in &mut place[..lattice.dimension()] {
                *x += self.jitter * noise(&mut state);
            }
        }
        positions.retain(|x| {
            let height: f64 = x.iter().zip(normal).map(|(x, n)| x * n).sum();
            self.surface.is_none_or(|surface| height <= surface)
        });
        let volume = lattice.particle_volume().enclose(64).midpoint_f64();
        Patch::new(lattice.dimension(), positions, volume, self.support, kernel, state)
    }
}

impl Patch {
    pub(crate) fn new(
        dimension: usize,
        positions: Vec<[f64; 3]>,
        volume: f64,
        support: f64,
        kernel: &Kernel,
        mut state: u64,
    ) -> Self {
        let count = positions.len();
        let mut around = |mean: f64| (0..count).map(|_| mean * (1.0 + 0.3 * noise(&mut state))).collect();
        let (volumes, density, mass, viscosity) = (around(volume), around(1.2), around(0.9), around(0.4));
        let square = |x: &[f64; 3]| x.iter().map(|x| x * x).sum::<f64>();
        let nearest = |a: &usize, b: &usize| square(&positions[*a]).total_cmp(&square(&positions[*b]));
        let centre = (0..count).min_by(nearest).unwrap();
        let cloud = Cloud::new(dimension, positions, volumes, Support::Uniform(support))
            .and_then(|cloud| cloud.with_field("density", density))
            .and_then(|cloud| cloud.with_field("mass", mass))
            .and_then(|cloud| cloud.with_field("viscosity", viscosity))
            .unwrap();
        let lists = Neighbours::search(&cloud).unwrap();
        Self { cloud, lists, kernel: kernel.clone(), centre }
    }

    pub(crate) fn ground(&self) -> CloudGround<'_> {
        CloudGround::new(&self.cloud, &self.lists, &self.kernel)
    }
}

/// cond(B)·cond(B̂) of a particle: by what rounding errors grow in what they multiply. Taken with nalgebra from Eqs. (6) and
/// (40) of Fatehi & Manzari.
pub(crate) fn conditions(ground: &dyn remainder::language::ground::Ground<f64>, i: usize) -> f64 {
    use nalgebra::DMatrix;
    use remainder::language::tree::OfParticle;
    let d = ground.dimension();
    let ratio = |matrix: &DMatrix<f64>| {
        let values = matrix.singular_values();
        values.max() / values.min()
    };
    // Σ ω (W′/r) r^{-2s} r_a r_b …, by indices.
    let pairs: Vec<([f64; 3], f64)> = ground
        .neighbours(i)
        .into_iter()
        .filter(|(_, r)| r.iter().any(|x| *x != 0.0))
        .map(|(j, r)| (r, ground.of_particle(OfParticle::Volume, j).unwrap() * ground.kernel(i, j, &r)[1]))
        .collect();
    let sum = |indices: &[usize], over_square: bool| -> f64 {
        let term = |(r, weight): &([f64; 3], f64)| {
            let square = if over_square { r.iter().map(|x| x * x).sum() } else { 1.0 };
            weight * indices.iter().map(|a| r[*a]).product::<f64>() / square
        };
        pairs.iter().map(term).sum()
    };
    let second = DMatrix::from_fn(d, d, |a, b| sum(&[a, b], false));
    let Some(inverse) = second.clone().try_inverse() else { return f64::INFINITY };
    let unknowns: Vec<(usize, usize)> = (0..d).flat_map(|a| (a..d).map(move |b| (a, b))).collect();
    let entry = |(a, b): (usize, usize), (e, f): (usize, usize)| {
        let through = (0..d).flat_map(|c| (0..d).map(move |g| (c, g)));
        let rest: f64 =
            through.map(|(c, g)| sum(&[a, b, c], true) * -inverse[(c, g)] * sum(&[g, e, f], false)).sum();
        sum(&[a, b, e, f], true) + rest
    };
    let hat = DMatrix::from_fn(unknowns.len(), unknowns.len(), |row, column| {
        entry(unknowns[column], unknowns[row])
    });
    ratio(&second) * ratio(&hat)
}
