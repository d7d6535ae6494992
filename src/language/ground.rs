//! What an operator stands on: particles, their neighbours, and the kernel between them, in floating point or exactly.

use super::tree::OfParticle;
use crate::exact::{Number, rational_to_f64};
use crate::kernel::{Evaluator, Kernel};
use crate::particles::{Cloud, Neighbours};
use thiserror::Error;

/// Particles as an operator sees them. Lengths are in the ground's own unit.
pub trait Ground<T: Number> {
    /// D.
    fn dimension(&self) -> usize;
    /// The particles in the support of `p`, itself among them, each with r_pq = r_p − r_q.
    fn neighbours(&self, p: usize) -> Vec<(usize, [T; 3])>;
    /// V, ρ, m or μ of particle `p`.
    ///
    /// # Errors
    /// [`MissingQuantity`] if the particles do not carry it.
    fn of_particle(&self, quantity: OfParticle, p: usize) -> Result<T, MissingQuantity>;
    /// h.
    fn smoothing_length(&self) -> T;
    /// W, W′/r and (W′/r)′/r of a pair at r_pq. Symmetric in p and q.
    fn kernel(&self, p: usize, q: usize, r: &[T; 3]) -> [T; 3];
}

/// The particles do not carry a quantity that the operator needs.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("the operator needs the field '{name}' of every particle: give it to the cloud")]
pub struct MissingQuantity {
    /// The name of the field.
    pub name: &'static str,
}

impl OfParticle {
    /// The name of the cloud's field that holds it; volumes are its own.
    pub fn field_name(self) -> &'static str {
        match self {
            Self::Volume => "volume",
            Self::Density => "density",
            Self::Mass => "mass",
            Self::Viscosity => "viscosity",
        }
    }
}

/// A cloud, its neighbour lists and a kernel.
pub struct CloudGround<'a> {
    cloud: &'a Cloud,
    neighbours: &'a Neighbours,
    evaluator: Evaluator<f64>,
    support_over_h: f64,
}

impl<'a> CloudGround<'a> {
    /// With the lists of all particles. The support is the cloud's; h follows from it.
    pub fn new(cloud: &'a Cloud, neighbours: &'a Neighbours, kernel: &Kernel) -> Self {
        let evaluator = Evaluator::new(kernel, cloud.dimension(), 2);
        Self { cloud, neighbours, evaluator, support_over_h: rational_to_f64(kernel.support_over_h()) }
    }
}

impl Ground<f64> for CloudGround<'_> {
    fn dimension(&self) -> usize {
        self.cloud.dimension()
    }

    fn neighbours(&self, p: usize) -> Vec<(usize, [f64; 3])> {
        self.neighbours.of(p).iter().map(|pair| (pair.j as usize, pair.r_ij)).collect()
    }

    fn of_particle(&self, quantity: OfParticle, p: usize) -> Result<f64, MissingQuantity> {
        let name = quantity.field_name();
        match quantity {
            OfParticle::Volume => Ok(self.cloud.volumes()[p]),
            _ => self.cloud.field(name).map(|values| values[p]).ok_or(MissingQuantity { name }),
        }
    }

    fn smoothing_length(&self) -> f64 {
        self.cloud.support_of(0) / self.support_over_h
    }

    fn kernel(&self, p: usize, _q: usize, r: &[f64; 3]) -> [f64; 3] {
        let support = self.cloud.support_of(p);
        let x = r.map(|r| r / support);
        let distance = (x[0] * x[0] + x[1] * x[1] + x[2] * x[2]).sqrt();
        let mut lanes = [2.0; 8];
        lanes[0] = distance;
        let g = self.evaluator.evaluate(&lanes).g;
        // W = R^{-D} F(x), and each derivative by r² brings R^{-2}.
        let scale = (0..self.cloud.dimension()).fold(1.0, |scale, _| scale / support);
        let square = support * support;
        [g[0][0] * scale, g[1][0] * scale / square, g[2][0] * scale / (square * square)]
    }
}
