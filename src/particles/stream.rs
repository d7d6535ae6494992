//! Random words of lattice sites: a pure function of (seed, sample, site).
//!
//! One ChaCha8 stream per sample (and particle of the basis); the word position is a function of the lattice coordinate,
//! so that the support radius, the order of visits and the number of threads do not change a sample. Sites that follow
//! each other along the first lattice vector follow each other in the stream. One more stream per sample holds the words
//! that particles share: those of the sample, and those of each row.

use super::disorder::SiteWords;
use super::lattice::{MOST_PARTICLES, Site};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// 32-bit words of a site in the stream.
const WORDS_PER_SITE: u128 = 8;
/// Coefficients of the lattice vectors lie in −2²⁰ … 2²⁰.
const HALF_RANGE: i64 = 1 << 20;
/// One for each particle a cell may have, and the last for what particles share.
const STREAMS_PER_SAMPLE: u64 = MOST_PARTICLES as u64 + 1;

/// The random words of one sample.
pub struct SampleStream {
    generator: ChaCha8Rng,
    sample: u64,
    /// Where the generator stands: stream and word.
    at: (u64, u128),
    seed: u64,
    /// The words of the sample, once asked for.
    shared: Option<SiteWords>,
    /// The row asked for last, and its words.
    row: Option<(i64, SiteWords)>,
}

impl SampleStream {
    /// The stream of this sample under this seed.
    pub fn new(seed: u64, sample: u64) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        let stream = sample.wrapping_mul(STREAMS_PER_SAMPLE);
        generator.set_stream(stream);
        Self { generator, sample, at: (stream, 0), seed, shared: None, row: None }
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

    /// The words that all particles of the sample share.
    pub fn shared_words(&mut self) -> SiteWords {
        let words = self.shared.unwrap_or_else(|| self.apart(0));
        self.shared = Some(words);
        words
    }

    /// The words that the particles of a row share (see [`super::Lattice::row`]).
    pub fn row_words(&mut self, row: i64) -> SiteWords {
        let words = match self.row {
            Some((known, words)) if known == row => words,
            _ => self.apart(1 + i128::from(row + HALF_RANGE).unsigned_abs()),
        };
        self.row = Some((row, words));
        words
    }

    /// Words of the sample's last stream.
    fn apart(&self, place: u128) -> SiteWords {
        let mut generator = ChaCha8Rng::seed_from_u64(self.seed);
        generator
            .set_stream(self.sample.wrapping_mul(STREAMS_PER_SAMPLE).wrapping_add(MOST_PARTICLES as u64));
        generator.set_word_pos(place * WORDS_PER_SITE);
        std::array::from_fn(|_| generator.next_u64())
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
    fn shared_words_depend_on_seed_sample_and_row_alone() {
        let mut stream = SampleStream::new(11, 3);
        let (all, row) = (stream.shared_words(), stream.row_words(-2));
        stream.words(&site([4, 0, 0], 0));
        assert_ne!(stream.row_words(1), row);
        assert_eq!((stream.shared_words(), stream.row_words(-2)), (all, row));
        let mut again = SampleStream::new(11, 3);
        assert_eq!((again.row_words(-2), again.shared_words()), (row, all));
        assert_ne!(SampleStream::new(11, 4).shared_words(), all);
        assert_ne!(all, row);
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
