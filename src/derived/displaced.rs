//! Lattice sites about particle i, displaced: the ground on which an expansion or a moment sum is differentiated with
//! respect to every particle that enters it. Lengths are in units of Δ.

use super::jet::{Jet, LANES};
use super::modes::Mode;
use crate::exact::{Number, rational_to_f64};
use crate::kernel::{Evaluator, Kernel};
use crate::language::ground::{Ground, MissingQuantity};
use crate::language::tree::OfParticle;
use crate::particles::{Lattice, Site, VolumeRule};

/// Numbers that functions of one variable are known for: floating-point numbers, and jets of them.
pub(super) trait Analytic: Number {
    /// A number that does not change.
    fn constant(value: f64) -> Self;
    /// The value, derivatives left out.
    fn value(&self) -> f64;
    /// f of it, for f with these value and first two derivatives at its value.
    fn through(&self, f: [f64; 3]) -> Self;
}

impl Analytic for f64 {
    fn constant(value: f64) -> Self {
        value
    }
    fn value(&self) -> f64 {
        *self
    }
    fn through(&self, f: [f64; 3]) -> Self {
        f[0]
    }
}

impl Analytic for Jet {
    fn constant(value: f64) -> Self {
        Jet::constant(value)
    }
    fn value(&self) -> f64 {
        self.value
    }
    fn through(&self, f: [f64; 3]) -> Self {
        Jet::through(self, f)
    }
}

/// A neighbourhood of particle i on a lattice.
pub(super) struct Neighbourhood<'a> {
    pub lattice: &'a Lattice,
    evaluator: Evaluator<f64>,
    /// R/Δ.
    pub support: f64,
    /// h/Δ.
    pub h: f64,
    pub rule: VolumeRule,
    pub sites: Vec<Site>,
    /// The place of particle i among the sites.
    pub centre: usize,
    /// The sites within R of each site that sums run over, by its place.
    near: Vec<Vec<usize>>,
    /// ω/Δ^D of the constant rule.
    pub volume: f64,
}

impl<'a> Neighbourhood<'a> {
    /// All sites whose displacement can change a sum at particle i: within R, or 2R if sums run over the neighbours of
    /// neighbours; R further where volumes depend on the neighbours.
    pub(super) fn new(
        kernel: &Kernel,
        lattice: &'a Lattice,
        support: f64,
        rule: VolumeRule,
        nested: bool,
    ) -> Self {
        let summed = if nested { 2.0 * support } else { support };
        let reach = summed + if rule == VolumeRule::NumberDensity { support } else { 0.0 };
        let sites = lattice.sites_within(reach);
        let centre = sites.iter().position(|site| site.cell == [0; 3] && site.basis == 0).unwrap_or(0);
        let square = |a: &Site, b: &Site| {
            a.position.iter().zip(b.position).map(|(x, y)| (x - y) * (x - y)).sum::<f64>()
        };
        let within = |site: &Site, radius: f64| square(site, &sites[centre]) < radius * radius;
        // The lists of particle i, of its neighbours if they sum, and of all whose volumes enter.
        let lists = if rule == VolumeRule::NumberDensity || nested { summed } else { 0.0 };
        let near = sites.iter().enumerate().map(|(p, site)| {
            if p != centre && !within(site, lists) {
                return Vec::new();
            }
            let inside = |q: &usize| square(site, &sites[*q]) < support * support;
            (0..sites.len()).filter(inside).collect()
        });
        let near = near.collect();
        Self {
            lattice,
            evaluator: Evaluator::new(kernel, lattice.dimension(), 4),
            support,
            h: support / rational_to_f64(kernel.support_over_h()),
            rule,
            centre,
            near,
            volume: lattice.particle_volume().enclose(96).midpoint_f64(),
            sites,
        }
    }

    /// W between two sites.
    fn kernel(&self, p: usize, q: usize) -> f64 {
        let (a, b) = (self.sites[p].position, self.sites[q].position);
        let square: f64 = a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum();
        let scale = (0..self.lattice.dimension()).fold(1.0, |scale, _| scale / self.support);
        scale * self.evaluator.radial(square.sqrt() / self.support)[0]
    }

    /// G_0, G_1, G_2 at r² = `square`, in units of Δ.
    fn radial<T: Analytic>(&self, square: &T) -> [T; 3] {
        let r = self.support;
        let g = self.evaluator.radial(square.value().sqrt() / r);
        let mut scale = (0..self.lattice.dimension()).fold(1.0, |scale, _| scale / r);
        let g = g.map(|g| {
            let scaled = g * scale;
            scale /= r * r;
            scaled
        });
        // dG_k/d(r²) = G_{k+1}/2.
        [0, 1, 2].map(|k| square.through([g[k], 0.5 * g[k + 1], 0.25 * g[k + 2]]))
    }
}

/// A neighbourhood with its particles displaced.
pub(super) struct DisplacedGround<'a, T> {
    around: &'a Neighbourhood<'a>,
    places: Vec<[T; 3]>,
    /// Of the particles that sums run over.
    volumes: Vec<T>,
}

impl<'a> DisplacedGround<'a, Jet> {
    /// At the lattice sites, to be differentiated along these directions, at most [`LANES`] of them.
    pub(super) fn along(around: &'a Neighbourhood<'a>, modes: &[Mode]) -> Self {
        let mut places: Vec<[Jet; 3]> =
            around.sites.iter().map(|site| site.position.map(Jet::constant)).collect();
        let mut moves = vec![false; places.len()];
        for (lane, mode) in modes.iter().enumerate().take(LANES) {
            for (site, d) in mode {
                moves[*site] = true;
                for (x, d) in places[*site].iter_mut().zip(d) {
                    x.first[lane] = *d;
                }
            }
        }
        Self::at(around, places, &moves)
    }
}

impl<'a> DisplacedGround<'a, f64> {
    /// With the particles moved by `sign` times a pattern.
    pub(super) fn by(around: &'a Neighbourhood<'a>, mode: &Mode, sign: f64) -> Self {
        let mut places: Vec<[f64; 3]> = around.sites.iter().map(|site| site.position).collect();
        for (site, d) in mode {
            for (x, d) in places[*site].iter_mut().zip(d) {
                *x += sign * d;
            }
        }
        let moves = vec![true; places.len()];
        Self::at(around, places, &moves)
    }
}

impl<'a, T: Analytic> DisplacedGround<'a, T> {
    fn at(around: &'a Neighbourhood<'a>, places: Vec<[T; 3]>, moves: &[bool]) -> Self {
        let mut ground = Self { around, places, volumes: Vec::new() };
        let volume = |p: usize| match around.rule {
            VolumeRule::NumberDensity if !around.near[p].is_empty() => {
                // Most pairs stand still along the few directions of a block.
                let mut still = 0.0;
                let mut sum = T::nought();
                for q in &around.near[p] {
                    if moves[p] || moves[*q] {
                        let [w, ..] = around.radial(&square(&ground.separation(p, *q)));
                        sum = sum + w;
                    } else {
                        still += around.kernel(p, *q);
                    }
                }
                T::constant(1.0) / (sum + T::constant(still))
            }
            _ => T::constant(around.volume),
        };
        ground.volumes = (0..around.sites.len()).map(volume).collect();
        ground
    }

    /// Particle i.
    pub(super) fn centre(&self) -> usize {
        self.around.centre
    }

    fn separation(&self, p: usize, q: usize) -> [T; 3] {
        std::array::from_fn(|a| self.places[p][a].clone() - self.places[q][a].clone())
    }

    /// The neighbours of particle i with r_ij, V_j and G_0, G_1, G_2.
    pub(super) fn pairs(&self) -> impl Iterator<Item = ([T; 3], T, [T; 3])> {
        self.around.near[self.around.centre].iter().map(|q| {
            let r = self.separation(self.around.centre, *q);
            let g = self.around.radial(&square(&r));
            (r, self.volumes[*q].clone(), g)
        })
    }
}

impl<T: Analytic> Ground<T> for DisplacedGround<'_, T> {
    fn dimension(&self) -> usize {
        self.around.lattice.dimension()
    }

    fn neighbours(&self, p: usize) -> Vec<(usize, [T; 3])> {
        self.around.near[p].iter().map(|q| (*q, self.separation(p, *q))).collect()
    }

    fn of_particle(&self, quantity: OfParticle, p: usize) -> Result<T, MissingQuantity> {
        // One fluid of unit density and viscosity.
        Ok(match quantity {
            OfParticle::Volume | OfParticle::Mass => self.volumes[p].clone(),
            OfParticle::Density | OfParticle::Viscosity => T::constant(1.0),
        })
    }

    fn smoothing_length(&self) -> T {
        T::constant(self.around.h)
    }

    fn kernel(&self, _p: usize, _q: usize, r: &[T; 3]) -> [T; 3] {
        self.around.radial(&square(r))
    }
}

fn square<T: Analytic>(r: &[T; 3]) -> T {
    r.iter().fold(T::constant(0.0), |sum, x| sum + x.clone() * x.clone())
}
