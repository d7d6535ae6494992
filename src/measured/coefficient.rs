//! Coefficients of an operator's expansion on given particles, in floating point: the operator applied to monomials.

use super::stencil::{Moments, StencilError};
use crate::exact::{MultiIndex, rational_to_f64};
use crate::kernel::{Evaluator, Kernel};
use crate::language::ground::{Ground, MissingQuantity};
use crate::language::tree::{Field, OfParticle};
use crate::language::{Coefficient, Subject};
use crate::particles::{Lattice, VolumeRule};
use num_traits::ToPrimitive as _;

/// Particles around particle i, lengths in units of R: the ground of one sample, or of one regular neighbourhood.
pub(super) struct Patch<'a> {
    pub dimension: usize,
    pub evaluator: &'a Evaluator<f64>,
    /// h/R.
    pub h: f64,
    pub centre: usize,
    /// The neighbours of the centre, itself among them.
    pub of_centre: Vec<(usize, [f64; 3])>,
    /// W and its derivatives between the centre and each particle, by particle.
    pub kernel_of_centre: Vec<[f64; 3]>,
    /// Volumes by particle, in units of R^D.
    pub volumes: Vec<f64>,
    /// The places of all particles, where an operator sums over neighbours of neighbours.
    pub places: Vec<[f64; 3]>,
}

/// W and its derivatives between the centre and its neighbours, by particle, of which there are `count`.
pub(super) fn kernel_of_centre(
    evaluator: &Evaluator<f64>,
    of_centre: &[(usize, [f64; 3])],
    count: usize,
) -> Vec<[f64; 3]> {
    let mut table = vec![[0.0; 3]; count];
    for block in of_centre.chunks(8) {
        let mut lanes = [2.0; 8];
        for (lane, (_, r)) in lanes.iter_mut().zip(block) {
            *lane = (r[0] * r[0] + r[1] * r[1] + r[2] * r[2]).sqrt();
        }
        let g = evaluator.evaluate(&lanes).g;
        for (lane, (q, _)) in block.iter().enumerate() {
            table[*q] = [g[0][lane], g[1][lane], g[2][lane]];
        }
    }
    table
}

impl Ground<f64> for Patch<'_> {
    fn dimension(&self) -> usize {
        self.dimension
    }

    fn neighbours(&self, p: usize) -> Vec<(usize, [f64; 3])> {
        if p == self.centre {
            return self.of_centre.clone();
        }
        let Some(from) = self.places.get(p) else { return Vec::new() };
        let all = self.places.iter().enumerate();
        let pairs = all.map(|(q, place)| (q, std::array::from_fn(|a| from[a] - place[a])));
        pairs.filter(|(_, r): &(usize, [f64; 3])| r.iter().map(|x| x * x).sum::<f64>() < 1.0).collect()
    }

    fn of_particle(&self, quantity: OfParticle, p: usize) -> Result<f64, MissingQuantity> {
        // One fluid of unit density and viscosity.
        Ok(match quantity {
            OfParticle::Volume | OfParticle::Mass => self.volumes[p],
            OfParticle::Density | OfParticle::Viscosity => 1.0,
        })
    }

    fn smoothing_length(&self) -> f64 {
        self.h
    }

    fn kernel(&self, p: usize, q: usize, r: &[f64; 3]) -> [f64; 3] {
        if let (true, Some(known)) = (p == self.centre, self.kernel_of_centre.get(q)) {
            return *known;
        }
        let mut lanes = [2.0; 8];
        lanes[0] = (r[0] * r[0] + r[1] * r[1] + r[2] * r[2]).sqrt();
        self.evaluator.evaluate(&lanes).g.map(|values| values[0])
    }
}

/// The lattice around a particle, out to R/Δ = `radius`, twice as far if an operator sums over neighbours of neighbours.
pub(super) fn regular_patch<'a>(
    evaluator: &'a Evaluator<f64>,
    h: f64,
    lattice: &Lattice,
    radius: f64,
    rule: VolumeRule,
    nested: bool,
) -> Patch<'a> {
    let dimension = lattice.dimension();
    let reach = if nested { 2.0 } else { 1.0 };
    let sites = lattice.sites_within(reach * radius);
    let places: Vec<[f64; 3]> = sites.iter().map(|site| site.position.map(|x| x / radius)).collect();
    let centre = sites.iter().position(|site| site.cell == [0; 3] && site.basis == 0).unwrap_or(0);
    let square = |x: &[f64; 3]| x.iter().map(|x| x * x).sum::<f64>();
    let inside = places.iter().enumerate().filter(|(_, place)| square(place) < 1.0);
    let of_centre: Vec<(usize, [f64; 3])> = inside.map(|(q, place)| (q, place.map(|x| -x))).collect();
    let volume = match rule {
        VolumeRule::Constant => {
            let volume = lattice.particle_volume().enclose(96).midpoint_f64();
            (0..dimension).fold(volume, |volume, _| volume / radius)
        }
        VolumeRule::NumberDensity => {
            let patch_kernel = |x: f64| {
                let mut lanes = [2.0; 8];
                lanes[0] = x;
                evaluator.evaluate(&lanes).g[0][0]
            };
            1.0 / of_centre.iter().map(|(_, r)| patch_kernel(square(r).sqrt())).sum::<f64>()
        }
    };
    let volumes = vec![volume; places.len()];
    let kernel_of_centre = kernel_of_centre(evaluator, &of_centre, places.len());
    Patch { dimension, evaluator, h, centre, of_centre, kernel_of_centre, volumes, places }
}

/// The components of each coefficient among the subjects, in units of R, the target not taken off; and the magnitude of
/// their terms, which rounding errors are relative to.
pub(super) fn coefficients(
    subjects: &[Subject],
    patch: &Patch<'_>,
) -> Result<Vec<(Vec<f64>, f64)>, StencilError> {
    let mut found = Vec::new();
    let mut last: Option<(&str, Moments<'_, f64>)> = None;
    for coefficient in subjects.iter().filter_map(Subject::coefficient) {
        // Subjects are sorted: orders of one operator follow each other and share its tensors B and B̂.
        let mut moments = match last.take().filter(|(id, _)| *id == coefficient.id()) {
            Some((_, known)) => known,
            None => Moments::new(coefficient.operator(), patch, patch.centre),
        };
        let all = MultiIndex::all(patch.dimension, coefficient.order()).unwrap_or_default();
        let (values, magnitude) = moments.of(&all)?;
        found.push((values.concat(), magnitude));
        last = Some((coefficient.id(), moments));
    }
    Ok(found)
}

/// The components of the target, in the order of [`coefficients`]; zeros where it has none of this order.
pub(super) fn target_components(coefficient: &Coefficient, dimension: usize) -> Vec<f64> {
    let field = coefficient.operator().field;
    let rank = u32::from(coefficient.operator().rank());
    let components = if field == Field::Vector { dimension } else { 1 };
    let all = MultiIndex::all(dimension, coefficient.order()).unwrap_or_default();
    let mut values = Vec::new();
    for alpha in &all {
        let letters: Vec<usize> =
            (0..3).flat_map(|axis| std::iter::repeat_n(axis, usize::from(alpha.powers[axis]))).collect();
        for component in 0..components {
            for out in 0..dimension.pow(rank) {
                let mut rest = out;
                let mut value: Vec<usize> = (0..rank)
                    .map(|_| {
                        let index = rest % dimension;
                        rest /= dimension;
                        index
                    })
                    .collect();
                value.reverse();
                let target = coefficient
                    .target()
                    .map(|target| rational_to_f64(&target.coefficient(field, &value, &letters, component)));
                values.push(target.unwrap_or(0.0));
            }
        }
    }
    values
}

/// The Frobenius norm of the tensor: what multiplies ∂_α u is its component times the number of orders of α.
pub(super) fn norm(coefficient: &Coefficient, dimension: usize, components: &[f64]) -> f64 {
    let all = MultiIndex::all(dimension, coefficient.order()).unwrap_or_default();
    let each = components.len() / all.len().max(1);
    let squares = all.iter().zip(components.chunks(each.max(1))).map(|(alpha, values)| {
        let multiplicity = alpha.multiplicity().to_f64().unwrap_or(1.0);
        values.iter().map(|value| value * value).sum::<f64>() / multiplicity
    });
    squares.sum::<f64>().sqrt()
}

/// A kernel's evaluator and h/R.
pub(super) fn made_ready(kernel: &Kernel, dimension: usize) -> (Evaluator<f64>, f64) {
    (Evaluator::new(kernel, dimension, 2), 1.0 / rational_to_f64(kernel.support_over_h()))
}
