//! Particles placed on a lattice, disordered and given volumes: clouds for operators to be applied to.

use super::program::{Fields, Program, ProgramError};
use crate::exact::rational_to_f64;
use crate::kernel::{Evaluator, Kernel, KernelError};
use crate::language::{LanguageError, Operator};
use crate::particles::disorder::Draw;
use crate::particles::{
    Cloud, CloudError, Disorder, Lattice, Neighbours, SampleStream, Site, Support, VolumeRule,
};
use thiserror::Error;

/// Why particles could not be placed or an operator not be applied.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PlaceError {
    /// The cloud.
    #[error(transparent)]
    Cloud(#[from] CloudError),
    /// The operator's text.
    #[error(transparent)]
    Language(#[from] LanguageError),
    /// Its program.
    #[error(transparent)]
    Program(#[from] ProgramError),
    /// The kernel.
    #[error(transparent)]
    Kernel(#[from] KernelError),
}

/// A cloud with unit density or unit masses, its lists, and the particles that are looked at.
pub struct Placed {
    /// The cloud; lengths in Δ.
    pub cloud: Cloud,
    /// The lists of all particles.
    pub lists: Neighbours,
    /// The particles whose neighbourhoods, and those of their neighbours, are complete.
    pub inner: Vec<usize>,
}

impl Placed {
    /// The lattice out to `reach` · R about its first particle, which alone is looked at, with unit density.
    ///
    /// # Errors
    /// [`PlaceError`].
    pub fn regular(
        kernel: &Kernel,
        lattice: &Lattice,
        support: f64,
        rule: VolumeRule,
        reach: f64,
    ) -> Result<Self, PlaceError> {
        let sites = lattice.sites_within(reach * support * (1.0 + 1e-12));
        let centre = sites.iter().position(|site| site.cell == [0; 3] && site.basis == 0).unwrap_or(0);
        let places: Vec<[f64; 3]> = sites.iter().map(|site| site.position).collect();
        let volume = match rule {
            VolumeRule::Constant => particle_volume(lattice),
            VolumeRule::NumberDensity => number_volume(kernel, lattice.dimension(), support, &places, centre),
        };
        let count = places.len();
        let cloud = Cloud::new(lattice.dimension(), places, vec![volume; count], Support::Uniform(support))?
            .with_field("density", vec![1.0; count])?
            .with_field("mass", vec![volume; count])?
            .with_field("viscosity", vec![1.0; count])?;
        let lists = Neighbours::search(&cloud)?;
        Ok(Self { cloud, lists, inner: vec![centre] })
    }

    /// A disordered ball of a lattice: all particles within `radius` Δ of its first one, of which those 2R from the rim
    /// are looked at. Masses are those of the lattice; the density is 1 with constant volumes, Σ m W (Basa et al. 2009,
    /// Eq. 11) with V = 1/ΣW.
    ///
    /// # Errors
    /// [`PlaceError`].
    pub fn disordered(
        kernel: &Kernel,
        lattice: &Lattice,
        support: f64,
        rule: VolumeRule,
        disorder: &Disorder,
        radius: f64,
        seed: u64,
    ) -> Result<Self, PlaceError> {
        let sites = lattice.sites_within(radius);
        let h = support / rational_to_f64(kernel.support_over_h());
        let places = displaced(lattice, &sites, disorder, h, seed);
        let square = |x: &[f64; 3]| x.iter().map(|x| x * x).sum::<f64>();
        let limit = (radius - 2.0 * support).max(0.0);
        let inner = (0..sites.len()).filter(|i| square(&sites[*i].position) <= limit * limit).collect();
        Self::with_volumes(kernel, lattice, support, rule, places, inner)
    }

    /// Particles at these places.
    ///
    /// # Errors
    /// [`PlaceError`].
    pub fn with_volumes(
        kernel: &Kernel,
        lattice: &Lattice,
        support: f64,
        rule: VolumeRule,
        places: Vec<[f64; 3]>,
        inner: Vec<usize>,
    ) -> Result<Self, PlaceError> {
        let (count, mass) = (places.len(), particle_volume(lattice));
        let mut cloud =
            Cloud::new(lattice.dimension(), places, vec![mass; count], Support::Uniform(support))?;
        let lists = Neighbours::search(&cloud)?;
        if rule == VolumeRule::NumberDensity {
            let volumes = number_volumes(kernel, &cloud, &lists);
            cloud = Cloud::new(
                cloud.dimension(),
                cloud.positions().to_vec(),
                volumes,
                Support::Uniform(support),
            )?;
        }
        let density = cloud.volumes().iter().map(|volume| mass / volume).collect();
        let cloud = cloud
            .with_field("density", density)?
            .with_field("mass", vec![mass; count])?
            .with_field("viscosity", vec![1.0; count])?;
        Ok(Self { cloud, lists, inner })
    }

    /// An operator on a scalar field, its components at the particles looked at.
    ///
    /// # Errors
    /// [`PlaceError`].
    pub fn scalar(
        &self,
        kernel: &Kernel,
        operator: &Operator,
        field: impl Fn(&[f64; 3]) -> f64,
    ) -> Result<Vec<Vec<f64>>, PlaceError> {
        let program = Program::new(operator, kernel, self.cloud.dimension())?;
        let values: Vec<f64> = self.cloud.positions().iter().map(field).collect();
        self.apply(&program, Fields::Scalar(&values))
    }

    /// The same on a vector field.
    ///
    /// # Errors
    /// [`PlaceError`].
    pub fn vector(
        &self,
        kernel: &Kernel,
        operator: &Operator,
        field: impl Fn(&[f64; 3]) -> [f64; 3],
    ) -> Result<Vec<Vec<f64>>, PlaceError> {
        let program = Program::new(operator, kernel, self.cloud.dimension())?;
        let values: Vec<[f64; 3]> = self.cloud.positions().iter().map(field).collect();
        self.apply(&program, Fields::Vector(&values))
    }

    /// A program's values at the particles looked at.
    ///
    /// # Errors
    /// [`PlaceError`].
    pub fn apply(&self, program: &Program, fields: Fields<'_>) -> Result<Vec<Vec<f64>>, PlaceError> {
        let values = program.apply(&self.cloud, &self.lists, fields)?;
        let each = program.components();
        Ok(self.inner.iter().map(|i| values[i * each..(i + 1) * each].to_vec()).collect())
    }
}

/// Where the sites of a sample stand.
fn displaced(
    lattice: &Lattice,
    sites: &[Site],
    disorder: &Disorder,
    h_over_dx: f64,
    seed: u64,
) -> Vec<[f64; 3]> {
    let motion = disorder.motion();
    let mut stream = SampleStream::new(seed, 0);
    sites
        .iter()
        .map(|site| {
            let u = (motion.unit)(&mut Draw::new(lattice, site, h_over_dx, &mut stream));
            std::array::from_fn(|a| site.position[a] + disorder.amplitude() * u[a])
        })
        .collect()
}

/// The volume of a particle of the lattice, in Δ^D.
fn particle_volume(lattice: &Lattice) -> f64 {
    lattice.particle_volume().enclose(96).midpoint_f64()
}

/// 1/Σ_j W_ij of every particle.
pub(super) fn number_volumes(kernel: &Kernel, cloud: &Cloud, lists: &Neighbours) -> Vec<f64> {
    let evaluator = Evaluator::<f64>::new(kernel, cloud.dimension(), 0);
    let support = cloud.support_of(0);
    let scale = (0..cloud.dimension()).fold(1.0, |scale, _| scale / support);
    let density = |i: usize| {
        let pairs = lists.of(i).iter();
        pairs
            .map(|pair| {
                let square = pair.r_ij.iter().map(|x| x * x).sum::<f64>();
                evaluator.radial(square.sqrt() / support)[0] * scale
            })
            .sum::<f64>()
    };
    (0..cloud.len()).map(|i| 1.0 / density(i)).collect()
}

fn number_volume(kernel: &Kernel, dimension: usize, support: f64, places: &[[f64; 3]], centre: usize) -> f64 {
    let evaluator = Evaluator::<f64>::new(kernel, dimension, 0);
    let scale = (0..dimension).fold(1.0, |scale, _| scale / support);
    let distance =
        |x: &[f64; 3]| x.iter().zip(places[centre]).map(|(x, c)| (x - c) * (x - c)).sum::<f64>().sqrt();
    1.0 / places.iter().map(|x| evaluator.radial(distance(x) / support)[0] * scale).sum::<f64>()
}
