//! Explicit methods: Euler, midpoint, the classical Runge–Kutta method, and Runge–Kutta–Chebyshev of second order
//! (B. P. Sommeijer, L. F. Shampine & J. G. Verwer, J. Comput. Appl. Math. 88 (1998) 315–326, Eqs. 2.4–2.9).

use super::matrix::dot;
use super::{EvolveError, System, Unstable};

/// A run is unstable once it exceeds this times the largest value that it started from, its source brought along.
const GROWTH: f64 = 1e6;

/// Steps between two looks at the size of the solution.
const LOOK: u64 = 32;

/// ε of the damping of Runge–Kutta–Chebyshev.
const DAMPING: f64 = 2.0 / 13.0;

/// The first step of Runge–Kutta–Chebyshev times the spectral radius.
const FIRST_STEP: f64 = 1.0;

/// By how much each is longer than the one before.
const GROWTH_OF_STEPS: f64 = 1.3;

/// An explicit method.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Explicit {
    /// Forward Euler.
    Euler,
    /// The midpoint rule, of order two.
    Rk2,
    /// The classical method of order four.
    Rk4,
    /// Runge–Kutta–Chebyshev of order two with this many stages, at least two.
    Rkc(u32),
}

impl Explicit {
    /// The name used in scenes and reports.
    pub fn id(self) -> String {
        match self {
            Self::Euler => "euler".into(),
            Self::Rk2 => "rk2".into(),
            Self::Rk4 => "rk4".into(),
            Self::Rkc(stages) => format!("rkc{stages}"),
        }
    }

    /// Products with the matrix in a step.
    pub fn stages(self) -> u32 {
        match self {
            Self::Euler => 1,
            Self::Rk2 => 2,
            Self::Rk4 => 4,
            Self::Rkc(stages) => stages,
        }
    }

    /// The factor by which a step multiplies a mode, as a function of z = λ Δt (complex: real and imaginary part).
    pub fn amplification(self, z: nalgebra::Complex<f64>) -> nalgebra::Complex<f64> {
        let one = nalgebra::Complex::new(1.0, 0.0);
        match self {
            Self::Euler => one + z,
            Self::Rk2 => one + z + z * z * 0.5,
            Self::Rk4 => one + z * (one + z * (one + z * (one + z * 0.25) * (1.0 / 3.0)) * 0.5),
            Self::Rkc(stages) => {
                let c = Chebyshev::new(stages);
                let (mut before, mut now) = (one, one + z * c.first);
                for stage in &c.stages {
                    let rest = one * (1.0 - stage.mu - stage.nu);
                    let next =
                        rest + now * stage.mu + before * stage.nu + z * now * stage.mu_rate + z * stage.gamma;
                    (before, now) = (now, next);
                }
                now
            }
        }
    }
}

/// The fewest stages of Runge–Kutta–Chebyshev that are stable for a step Δt and a spectral radius: β(s) = 2/3 (s² − 1)
/// (1 − 2ε/15) ≥ ρ Δt.
pub fn chebyshev_stages(radius_times_step: f64) -> u32 {
    let per = 2.0 / 3.0 * (1.0 - 2.0 * DAMPING / 15.0);
    ((radius_times_step / per + 1.0).sqrt().ceil() as u32).max(2)
}

/// A few steps of Runge–Kutta–Chebyshev, of one length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// Δt.
    pub step: f64,
    /// How many.
    pub steps: u64,
    /// Stages of each, the fewest that are stable.
    pub stages: u32,
}

/// So many steps of Runge–Kutta–Chebyshev over a time, for a spectral radius ρ.
///
/// A step multiplies a mode with ρΔt ≫ 1 by up to 1 − ε/3 = 0.95 only, so what a jump at the start puts into such modes would
/// still be there after dozens of equal steps. The first step therefore is 1/ρ, and each is 1.3 times as long as the one
/// before, until the rest can be of one length: every mode is damped while the steps are still short for it.
pub fn chebyshev_stretches(time: f64, steps: u64, radius: f64) -> Vec<Stretch> {
    let growing = |count: u64| (GROWTH_OF_STEPS.powf(count as f64) - 1.0) / (GROWTH_OF_STEPS - 1.0);
    // Where even steps that grow to the end do not get there from 1/ρ, they start from a longer one.
    let first = (FIRST_STEP / radius).min(time).max(time / growing(steps));
    let of = |growth: u64| first * GROWTH_OF_STEPS.powf(growth as f64);
    let rest = |growth: u64| (time - first * growing(growth)) / (steps - growth) as f64;
    let growth = (0..steps).find(|growth| rest(*growth) <= of(*growth)).unwrap_or(steps.saturating_sub(1));
    let stretch = |step: f64, steps: u64| Stretch { step, steps, stages: chebyshev_stages(radius * step) };
    (0..growth).map(|k| stretch(of(k), 1)).chain([stretch(rest(growth), steps - growth)]).collect()
}

/// Takes these steps from `u`.
///
/// # Errors
/// As [`march`].
pub fn march_stretches(system: &System, stretches: &[Stretch], u: &mut Vec<f64>) -> Result<(), EvolveError> {
    let (mut before, mut time) = (0, 0.0);
    for Stretch { step, steps, stages } in stretches {
        march(system, Explicit::Rkc(*stages), u, *step, *steps).map_err(|error| match error {
            EvolveError::Unstable(found) => EvolveError::Unstable(Unstable {
                step: before + found.step,
                time: time + found.time,
                ..found
            }),
            other => other,
        })?;
        before += steps;
        time += step * *steps as f64;
    }
    Ok(())
}

struct Stage {
    mu: f64,
    nu: f64,
    mu_rate: f64,
    gamma: f64,
}

/// The coefficients of Runge–Kutta–Chebyshev.
struct Chebyshev {
    first: f64,
    stages: Vec<Stage>,
}

impl Chebyshev {
    fn new(stages: u32) -> Self {
        let s = f64::from(stages);
        let w0 = 1.0 + DAMPING / (s * s);
        // T_j, T_j′ and T_j″ at w0.
        let mut t = vec![[1.0, 0.0, 0.0], [w0, 1.0, 0.0]];
        for j in 2..=stages as usize {
            let (a, b) = (t[j - 1], t[j - 2]);
            t.push([
                2.0 * w0 * a[0] - b[0],
                2.0 * a[0] + 2.0 * w0 * a[1] - b[1],
                4.0 * a[1] + 2.0 * w0 * a[2] - b[2],
            ]);
        }
        let last = t[stages as usize];
        let w1 = last[1] / last[2];
        let mut b: Vec<f64> = t.iter().map(|t| t[2] / (t[1] * t[1])).collect();
        b[0] = b[2];
        b[1] = 1.0 / w0;
        let stages = (2..=stages as usize)
            .map(|j| {
                let mu_rate = 2.0 * b[j] * w1 / b[j - 1];
                let a = 1.0 - b[j - 1] * t[j - 1][0];
                Stage { mu: 2.0 * b[j] * w0 / b[j - 1], nu: -b[j] / b[j - 2], mu_rate, gamma: -a * mu_rate }
            })
            .collect();
        Self { first: b[1] * w1, stages }
    }
}

/// Takes `steps` steps of length `step` from `u`.
///
/// # Errors
/// [`EvolveError::Step`]; [`EvolveError::Unstable`] as soon as the solution has grown beyond all reason.
pub fn march(
    system: &System,
    method: Explicit,
    u: &mut Vec<f64>,
    step: f64,
    steps: u64,
) -> Result<(), EvolveError> {
    if !(step.is_finite() && step > 0.0) {
        return Err(EvolveError::Step { step });
    }
    let largest = |u: &[f64]| {
        u.iter().fold(0.0_f64, |largest, u| if u.is_nan() { f64::INFINITY } else { largest.max(u.abs()) })
    };
    let time = step * steps as f64;
    let start = largest(u).max(time * largest(&system.source)).max(f64::MIN_POSITIVE);
    let chebyshev = match method {
        Explicit::Rkc(stages) => Some(Chebyshev::new(stages.max(2))),
        _ => None,
    };
    let mut next = vec![0.0; u.len()];
    for done in 1..=steps {
        match method {
            Explicit::Euler => {
                system.step(u, step, &mut next);
                std::mem::swap(u, &mut next);
            }
            Explicit::Rk2 => {
                system.step(u, 0.5 * step, &mut next);
                let rate = system.rate(&next);
                super::matrix::add(u, step, &rate);
            }
            Explicit::Rk4 => {
                let k1 = system.rate(u);
                let at = |factor: f64, k: &[f64]| {
                    let mut v = u.clone();
                    super::matrix::add(&mut v, factor * step, k);
                    system.rate(&v)
                };
                let k2 = at(0.5, &k1);
                let k3 = at(0.5, &k2);
                let k4 = at(1.0, &k3);
                for (k, weight) in [(&k1, 1.0), (&k2, 2.0), (&k3, 2.0), (&k4, 1.0)] {
                    super::matrix::add(u, weight * step / 6.0, k);
                }
            }
            Explicit::Rkc(_) => {
                if let Some(chebyshev) = &chebyshev {
                    chebyshev_step(system, chebyshev, u, step);
                }
            }
        }
        if done % LOOK == 0 || done == steps {
            let now = largest(u);
            if now > GROWTH * start {
                let unknown = u.iter().position(|u| u.is_nan() || u.abs() == now).unwrap_or(0);
                let scaled: Vec<f64> = u.iter().map(|u| u / now).collect();
                let rate = dot(&scaled, &system.matrix.apply(&scaled)) / dot(&scaled, &scaled);
                let time = step * done as f64;
                return Err(EvolveError::Unstable(Unstable {
                    step: done,
                    time,
                    largest: now,
                    unknown,
                    rate,
                }));
            }
        }
    }
    Ok(())
}

fn chebyshev_step(system: &System, chebyshev: &Chebyshev, u: &mut Vec<f64>, step: f64) {
    let rate = system.rate(u);
    let mut before = u.clone();
    let mut now = u.clone();
    super::matrix::add(&mut now, chebyshev.first * step, &rate);
    let mut next = vec![0.0; u.len()];
    for stage in &chebyshev.stages {
        let rest = 1.0 - stage.mu - stage.nu;
        system.matrix.rows_with(&now, &mut next, |i, value| {
            rest * u[i]
                + stage.mu * now[i]
                + stage.nu * before[i]
                + step * (stage.mu_rate * (value + system.source[i]) + stage.gamma * rate[i])
        });
        std::mem::swap(&mut before, &mut now);
        std::mem::swap(&mut now, &mut next);
    }
    *u = now;
}
