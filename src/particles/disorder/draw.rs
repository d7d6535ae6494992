//! What the displacement of one site is drawn from.

use crate::particles::{Lattice, SampleStream, Site};

/// Random words: of one site, of a row, or of a whole sample; a pure function of (seed, sample, site).
pub type SiteWords = [u64; 4];

/// A site about to be displaced.
pub struct Draw<'a> {
    /// D.
    pub dimension: usize,
    /// Where it stands.
    pub site: &'a Site,
    /// h/Δ, for lengths given in units of h.
    pub h_over_dx: f64,
    lattice: &'a Lattice,
    stream: &'a mut SampleStream,
}

impl<'a> Draw<'a> {
    /// A site in the sample whose words `stream` holds.
    pub fn new(lattice: &'a Lattice, site: &'a Site, h_over_dx: f64, stream: &'a mut SampleStream) -> Self {
        Self { dimension: lattice.dimension(), site, h_over_dx, lattice, stream }
    }

    /// Its row along the last axis, see [`Lattice::row`].
    pub fn row(&self) -> i64 {
        self.lattice.row(self.site.cell, self.site.basis)
    }

    /// The words of this site alone.
    pub fn own_words(&mut self) -> SiteWords {
        self.stream.words(self.site)
    }

    /// The words that all sites of the sample share.
    pub fn sample_words(&mut self) -> SiteWords {
        self.stream.shared_words()
    }

    /// The words that the sites of its row share.
    pub fn row_words(&mut self) -> SiteWords {
        self.stream.row_words(self.lattice.row(self.site.cell, self.site.basis))
    }
}

/// A number in [0, 1) from a random word.
pub(super) fn unit_interval(word: u64) -> f64 {
    (word >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)
}
