//! Random words of lattice sites: a pure function of (seed, sample, site).
//!
//! One ChaCha8 stream per sample (and particle of the basis); the word position is a function of the lattice coordinate,
//! so that the support radius, the order of visits and the number of threads do not change a sample. Sites that follow
//! each other along the first lattice vector follow each other in the stream.

use super::disorder::SiteWords;
use super::lattice::Site;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// 32-bit words of a site in the stream.
const WORDS_PER_SITE: u128 = 8;
/// Coefficients of the lattice vectors lie in −2²⁰ … 2²⁰.
const HALF_RANGE: i64 = 1 << 20;
/// Particles a cell may have without sharing a stream with the next sample.
const STREAMS_PER_SAMPLE: u64 = 64;

/// The random words of one sample.
pub struct SampleStream {
    generator: ChaCha8Rng,
    sample: u64,
    /// Where the generator stands: stream and word.
    at: (u64, u128),
}

impl SampleStream {
    /// The stream of this sample under this seed.
    pub fn new(seed: u64, sample: u64) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        let stream = sample.wrapping_mul(STREAMS_PER_SAMPLE);
        generator.set_stream(stream);
        Self { generator, sample, at: (stream, 0) }
    }

    /// The words of a site.
    pub fn words(&mut self, site: &Site) -> SiteWords {
        let stream = self.sample.wrapping_mul(STREAMS_PER_SAMPLE).wrapping_add(site.basis as u64);
        let place = |c: i64| (c + HALF_RANGE) as u128;
        let position = ((place(site.cell[2]) << 42) | (place(site.cell[1]) << 21) | place(site.cell[0]))
            * WORDS_PER_SITE;
        if self.at.0 != stream {
            self.generator.set_stream(stream);
            self.at = (stream, u128::MAX);
        }
        if self.at.1 != position {
            self.generator.set_word_pos(position);
        }
        self.at.1 = position + WORDS_PER_SITE;
        std::array::from_fn(|_| self.generator.next_u64())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn site(cell: [i64; 3], basis: usize) -> Site {
        Site { cell, basis, position: [0.0; 3] }
    }

    #[test]
    fn the_order_of_visits_does_not_change_a_site() {
        let sites = [
            site([0, 0, 0], 0),
            site([1, 0, 0], 0),
            site([-7, 3, 2], 0),
            site([-7, 3, 2], 1),
            site([5, 5, 5], 0),
        ];
        let mut forward = SampleStream::new(11, 3);
        let there: Vec<_> = sites.iter().map(|s| forward.words(s)).collect();
        let mut back = SampleStream::new(11, 3);
        let mut again: Vec<_> = sites.iter().rev().map(|s| back.words(s)).collect();
        again.reverse();
        assert_eq!(there, again);
    }

    #[test]
    fn samples_seeds_sites_and_basis_particles_differ() {
        let words = |seed, sample, cell, basis| SampleStream::new(seed, sample).words(&site(cell, basis));
        let reference = words(1, 0, [0, 0, 0], 0);
        for other in [
            words(2, 0, [0, 0, 0], 0),
            words(1, 1, [0, 0, 0], 0),
            words(1, 0, [1, 0, 0], 0),
            words(1, 0, [0, 0, 0], 1),
        ] {
            assert_ne!(reference, other);
        }
    }
}
