//! Z(μ, e) = Σ' (−x)^μ |x|^e over the particles around particle i, itself left out, continued analytically in e.
//!
//! This is what r^μ |r|^e, e odd, leaves of a lattice sum at the origin. With θ(t) = Σ x^μ e^{−πt|x|²},
//! π^{−z} Γ(z) Z = ∫_0^∞ t^{z−1} (θ − δ_{μ0}) dt, z = −e/2: cut at t = c, its lower part turned over by Poisson's formula
//! (P. P. Ewald, Ann. Phys. 369 (1921) 253–287; R. E. Crandall, Fast evaluation of Epstein zeta functions, 1998). Both sums
//! fall like e^{−πn²}, and on a line of spacing a, Z = 2 a^{e+|μ|} ζ(−e−|μ|) is rational.

use super::spheres::{Reciprocal, monomial};
use crate::exact::{MultiIndex, Rational, int};
use crate::particles::Lattice;
use num_traits::{One, Zero};
use std::f64::consts::PI;

/// Points beyond this many units of the cut are left out: e^{−π·6²} < 1e-49.
const REACH: f64 = 6.0;

/// A rounding error of the sums below, over the sum of the moduli: a few hundred operations of half an ulp each.
const ROUNDING: f64 = 1e-13;

/// Z and a bound of its error.
pub(super) fn zeta(lattice: &Lattice, reciprocal: &Reciprocal, mu: &MultiIndex, e: i64) -> (f64, f64) {
    let d = lattice.dimension();
    let z = -e as f64 / 2.0;
    let cut = libm::pow(reciprocal.density, -2.0 / d as f64);
    let (mut sum, mut moduli) = (0.0, 0.0);
    let mut add = |term: f64| {
        sum += term;
        moduli += f64::abs(term);
    };
    for site in lattice.sites_within(REACH / cut.sqrt()) {
        let square: f64 = site.position.iter().map(|x| x * x).sum();
        if square > 0.0 {
            let x = PI * square;
            add(monomial(&site.position, mu) * libm::pow(x, -z) * incomplete_gamma(-e, x * cut));
        }
    }
    // ∫_0^c of the turned sum; K = 0 and x = 0 apart.
    let order = f64::from(mu.order());
    let contractions = super::tail::contractions(mu);
    let basis = lattice.basis().len() as f64;
    let per_volume = basis / reciprocal.density;
    reciprocal.visit(REACH * cut.sqrt(), |_, g, [cosine, sine]| {
        // Re(i^{|μ|} e^{iK·b}), averaged over b.
        let structure = match mu.order() % 4 {
            0 => cosine,
            1 => -sine,
            2 => -cosine,
            _ => sine,
        };
        let k: [f64; 3] = g.map(|x| 2.0 * PI * x);
        let quarter = g.iter().map(|x| x * x).sum::<f64>() * PI;
        for (halves, weight) in &contractions {
            let t = f64::from(mu.order() - halves.order());
            let nu = MultiIndex::new(std::array::from_fn(|a| mu.powers[a] - 2 * halves.powers[a]));
            let a = d as f64 / 2.0 + t - z;
            let twice = d as i64 + 2 * (mu.order() - halves.order()) as i64 + e;
            add(per_volume
                * structure
                * crate::exact::rational_to_f64(weight)
                * monomial(&k, &nu)
                * libm::pow(-1.0 / (2.0 * PI), t)
                * libm::pow(quarter, -a)
                * incomplete_gamma(twice, quarter / cut));
        }
    });
    if mu.powers.iter().all(|power| power % 2 == 0) {
        // i^{|μ|} (−1/2π)^{|μ|/2} = (2π)^{−|μ|/2}.
        let weight = contractions.last().map_or(0.0, |(_, weight)| crate::exact::rational_to_f64(weight));
        let pole = z - (d as f64 + order) / 2.0;
        add(per_volume * weight * libm::pow(2.0 * PI, -order / 2.0) * libm::pow(cut, pole) / pole);
    }
    if mu.order() == 0 {
        add(-libm::pow(cut, z) / z);
    }
    let sign = if mu.order() % 2 == 0 { 1.0 } else { -1.0 };
    let factor = libm::pow(PI, z) / libm::tgamma(z);
    (sign * factor * sum, (factor * moduli).abs() * ROUNDING)
}

/// Γ(a, x) for 2a = `twice`, x > 0, by recurrence from Γ(1/2, x) = √π erfc √x or Γ(1, x) = e^{−x}.
fn incomplete_gamma(twice: i64, x: f64) -> f64 {
    let (mut at, mut value) =
        if twice % 2 == 0 { (2, libm::exp(-x)) } else { (1, PI.sqrt() * libm::erfc(x.sqrt())) };
    while at < twice {
        let a = at as f64 / 2.0;
        value = a * value + libm::pow(x, a) * libm::exp(-x);
        at += 2;
    }
    while at > twice {
        at -= 2;
        let a = at as f64 / 2.0;
        value = (value - libm::pow(x, a) * libm::exp(-x)) / a;
    }
    value
}

/// 2ζ(−n) = −2 B_{n+1}/(n + 1) for n ≥ 0.
pub(super) fn twice_zeta_at_minus(n: usize) -> Rational {
    // ζ(0) = −1/2 goes with B_1 = +1/2.
    let bernoulli = if n == 0 { Rational::one() / int(2) } else { bernoulli(n + 1).swap_remove(n + 1) };
    bernoulli * int(-2) / int(n as i64 + 1)
}

/// B_0 … B_n, from Σ_{k<m} C(m, k) B_k = 0; B_1 = −1/2.
pub(super) fn bernoulli(n: usize) -> Vec<Rational> {
    let mut numbers = vec![Rational::one()];
    for m in 2..=n as i64 + 1 {
        let (mut binomial, mut sum) = (Rational::one(), Rational::zero());
        for (k, number) in numbers.iter().enumerate() {
            sum += &binomial * number;
            binomial = binomial * int(m - k as i64) / int(k as i64 + 1);
        }
        numbers.push(-sum / int(m));
    }
    numbers
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::particles::lattice_by_id;

    /// Against closed forms: 2ζ(−n) on the line, 4ζ(s)β(s) on the square lattice (Hardy), the constant of Madelung's
    /// kind Σ' |x|⁻¹ on the cubic one.
    #[test]
    fn known_values() {
        let at = |lattice: &str, letters: &str, e: i64| {
            let lattice = lattice_by_id(lattice).unwrap_or_else(|error| unreachable!("{error}"));
            let mu = MultiIndex::from_letters(letters).unwrap_or_default();
            zeta(&lattice, &Reciprocal::of(&lattice), &mu, e)
        };
        for (letters, e, n) in [("", 1, 1), ("", 3, 3), ("xx", 1, 3), ("xx", -1, 1), ("xxxx", -1, 3)] {
            let (value, radius) = at("line", letters, e);
            let exact = crate::exact::rational_to_f64(&twice_zeta_at_minus(n));
            assert!((value - exact).abs() <= radius, "{letters} {e}: {value} ± {radius}, {exact}");
        }
        // Σ' |x| = 4 ζ(−1/2) β(−1/2), and half of it for x²/|x|; Σ' 1/|x| on the cubic lattice is −2.8372974794806….
        let (value, radius) = at("square", "", 1);
        assert!((value - -0.228_824_310_377).abs() < 1e-11 + radius, "{value}");
        let (half, radius) = at("square", "xx", -1);
        assert!((2.0 * half - value).abs() <= 4.0 * radius, "{half}");
        let (value, radius) = at("simple-cubic", "", -1);
        assert!((value - -2.837_297_479_480_6).abs() < 1e-12 + radius, "{value} ± {radius}");
    }
}
