//! Expansions as text and LaTeX: in the notation of Fatehi & Manzari's Eqs. (17)–(27) where every sum hangs on one
//! derivative, with indices where it does not.

use super::algebra::{Expression, Factor, Index, Label, Symbol, Term};
use super::expansion::Expansion;
use crate::exact::{Rational, int};
use crate::language::Field;
use crate::language::tree::OfParticle;
use num_traits::{One, Signed};
use serde::Serialize;

/// How to print.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Unicode.
    Text,
    /// LaTeX, for use in mathematics mode.
    Latex,
}

/// An expansion printed, order by order.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Printed {
    /// m.
    pub order: usize,
    /// The derivative that every term multiplies, `∇∇u`.
    pub derivative: String,
    /// The terms of the truncation error with their signs.
    pub terms: Vec<String>,
}

impl Expansion {
    /// The truncation error, or the approximation where no target is known.
    pub fn printed(&self, format: Format) -> Vec<Printed> {
        let field = self.operator.field;
        let printed = self.orders.iter().map(|terms| Printed {
            order: terms.order,
            derivative: derivative(field, terms.order, format),
            terms: terms
                .error
                .terms
                .iter()
                .map(|t| Writer::new(t, &terms.error, field, format).term())
                .collect(),
        });
        printed.collect()
    }
}

/// ∇…∇u.
fn derivative(field: Field, order: usize, format: Format) -> String {
    let (nabla, name) = match format {
        Format::Text => ("∇", if field == Field::Vector { "v" } else { "u" }),
        Format::Latex => ("\\nabla ", if field == Field::Vector { "\\mathbf{v}" } else { "u" }),
    };
    match order {
        0 => format!("{name}_i"),
        1..=4 => format!("{}{name}", nabla.repeat(order)),
        _ if format == Format::Text => format!("∇^{order}{name}"),
        _ => format!("\\nabla^{{{order}}}{name}"),
    }
}

struct Writer<'a> {
    term: &'a Term,
    free: &'a [Index],
    field: Field,
    format: Format,
}

impl<'a> Writer<'a> {
    fn new(term: &'a Term, expression: &'a Expression, field: Field, format: Format) -> Self {
        Self { term, free: &expression.free, field, format }
    }

    fn term(&self) -> String {
        let magnitude = self.term.coefficient.abs();
        let sign = if self.term.coefficient.is_negative() { self.pick("−", "-") } else { "+" };
        let (rest, flip) = match self.without_indices() {
            Some((text, flip)) => (text, flip),
            None => (self.with_indices(), false),
        };
        let sign = match (flip, sign) {
            (true, "+") => self.pick("−", "-"),
            (true, _) => "+",
            (false, sign) => sign,
        };
        let space = if rest.is_empty() { "" } else { " " };
        let number = if magnitude.is_one() && !rest.is_empty() {
            String::new()
        } else {
            format!("{}{space}", self.number(&magnitude))
        };
        format!("{sign} {number}{rest}")
    }

    fn pick<'b>(&self, text: &'b str, latex: &'b str) -> &'b str {
        if self.format == Format::Text { text } else { latex }
    }

    fn number(&self, value: &Rational) -> String {
        match self.format {
            Format::Latex if !value.is_integer() => {
                format!("\\frac{{{}}}{{{}}}", value.numer(), value.denom())
            }
            _ => value.to_string(),
        }
    }

    fn order(&self) -> usize {
        self.term.order()
    }

    /// In the notation of Eq. (20), and whether the sign turns (B⁻¹ = −Σ ω r ∇W).
    fn without_indices(&self) -> Option<(String, bool)> {
        let order = self.order();
        if self.field == Field::Vector {
            return None;
        }
        let derivative_at =
            self.term.factors.iter().position(|factor| matches!(factor.symbol, Symbol::Derivative(_)))?;
        let derived = &self.term.factors[derivative_at].indices;
        let written = derivative(self.field, order, self.format);
        let outside: Vec<&Factor> = self.scalars_outside(derivative_at)?;
        let scalars: String = outside.iter().map(|factor| format!("{} ", self.factor(factor))).collect();
        let after = |rest: String| match order {
            0 => format!("{scalars}{written} {rest}"),
            1 => format!("{scalars}{written} {} {rest}", self.pick("·", "\\cdot")),
            2 => format!("{scalars}{written} {} {rest}", self.pick(":", ":")),
            3 => format!("{scalars}{written} {} {rest}", self.pick("⋮", "\\vdots")),
            _ => format!("{scalars}{written} {} {rest}", self.pick("::", "::")),
        };
        let tensors: Vec<&Factor> = self
            .term
            .factors
            .iter()
            .filter(|factor| {
                matches!(factor.symbol, Symbol::Delta | Symbol::Renormalisation) && !factor.indices.is_empty()
            })
            .collect();
        if self.term.bounds.is_empty() {
            // The target itself: ∇u, ∇²u, ∇∇u.
            let plain = tensors.is_empty();
            let laplacian = derived.len() == 2 && derived[0] == derived[1];
            return match (plain, laplacian) {
                (true, true) => Some((format!("{scalars}{}u", self.pick("∇²", "\\nabla^{2}")), false)),
                (true, false) => Some((format!("{scalars}{written}"), false)),
                _ => None,
            };
        }
        let [bound] = &self.term.bounds[..] else { return None };
        if bound.centre != 0 || tensors.len() > 1 {
            return None;
        }
        let mut middle = String::new();
        let mut leads_out: Vec<Index> = self.free.to_vec();
        if let [b] = &tensors[..] {
            // B_i stands between the sum and the free index.
            if b.symbol != Symbol::Renormalisation || b.particles != [0] {
                return None;
            }
            let outer = b.indices.iter().position(|index| self.free.contains(index))?;
            leads_out = vec![b.indices[1 - outer]];
            middle = self.pick("B_i·", "\\mathbf{B}_i\\cdot ").to_owned();
        }
        let inside: Vec<&Factor> =
            self.term.naming(bound.particle).into_iter().map(|place| &self.term.factors[place]).collect();
        let separations: Vec<Index> = inside
            .iter()
            .filter(|factor| factor.symbol == Symbol::Separation)
            .map(|factor| factor.indices[0])
            .collect();
        let hessians = inside.iter().filter(|factor| factor.symbol == Symbol::Hessian).count();
        let met = |index: &Index| derived.contains(index) || leads_out.contains(index);
        if hessians > 0 || !separations.iter().all(met) || leads_out.len() > 1 {
            return None;
        }
        if leads_out.iter().any(|index| !separations.contains(index))
            || derived.iter().any(|i| !separations.contains(i))
        {
            return None;
        }
        let find = |wanted: &Symbol| inside.iter().find(|factor| factor.symbol == *wanted);
        let slope = find(&Symbol::Slope).is_some_and(|factor| factor.power == 1);
        if slope && separations.is_empty() || !slope && !leads_out.is_empty() {
            return None;
        }
        let mut rest: Vec<&&Factor> = inside
            .iter()
            .filter(|factor| !matches!(factor.symbol, Symbol::Separation | Symbol::Slope))
            .collect();
        let is_volume =
            |factor: &&&Factor| factor.symbol == Symbol::OfParticle(OfParticle::Volume) && factor.power == 1;
        if !rest.iter().any(is_volume) {
            return None;
        }
        rest.retain(|factor| !is_volume(factor));
        let positions = separations.len() - usize::from(slope);
        if slope && rest.is_empty() && positions == 1 && middle.is_empty() {
            let inverse = self.pick("B_i⁻¹", "\\mathbf{B}_i^{-1}").to_owned();
            return Some((after(inverse), true));
        }
        let mut sum = self.pick("Σ_j ω_j ", "\\sum_j \\omega_j ").to_owned();
        // Scalars first, the kernel last.
        let last = |factor: &&&Factor| matches!(factor.symbol, Symbol::Kernel | Symbol::Laplacian);
        for factor in rest.iter().filter(|factor| !last(factor)) {
            sum += &self.factor(factor);
            sum.push(' ');
        }
        sum += &self.pick("r_ij ", "\\mathbf{r}_{ij} ").repeat(positions);
        sum += &middle;
        if slope {
            sum += self.pick("∇W_ij", "\\nabla W_{ij}");
        }
        for factor in rest.iter().filter(|factor| last(factor)) {
            sum += &self.factor(factor);
        }
        Some((after(sum), false))
    }

    /// The scalars outside every sum, if all else outside is the derivative, δ or B.
    fn scalars_outside(&self, derivative: usize) -> Option<Vec<&Factor>> {
        let bound = |label: &Label| self.term.bounds.iter().any(|bound| bound.particle == *label);
        let outside = self
            .term
            .factors
            .iter()
            .enumerate()
            .filter(|(place, factor)| *place != derivative && !factor.particles.iter().any(bound));
        let mut scalars = Vec::new();
        for (_, factor) in outside {
            match factor.symbol {
                Symbol::Delta | Symbol::Renormalisation => {}
                _ if factor.indices.is_empty() => scalars.push(factor),
                _ => return None,
            }
        }
        Some(scalars)
    }

    /// With indices: those that stand twice are summed over.
    fn with_indices(&self) -> String {
        let mut parts: Vec<String> = Vec::new();
        let order = self.order();
        let mut used = vec![false; self.term.factors.len()];
        if let Some(place) =
            self.term.factors.iter().position(|factor| matches!(factor.symbol, Symbol::Derivative(_)))
        {
            used[place] = true;
            let indices = &self.term.factors[place].indices;
            let letters: String = indices[..order].iter().map(|index| self.letter(*index)).collect();
            let own: String = indices[order..].iter().map(|index| self.letter(*index)).collect();
            let name = self.field.name();
            parts.push(match (self.format, order, own.is_empty()) {
                (Format::Text, 0, true) => "u_i".into(),
                (Format::Text, 0, false) => format!("v_{own}"),
                (Format::Text, _, true) => format!("∂_{letters} {name}"),
                (Format::Text, _, false) => format!("∂_{letters} v_{own}"),
                (Format::Latex, 0, true) => "u_i".into(),
                (Format::Latex, 0, false) => format!("v_{{{own}}}"),
                (Format::Latex, _, true) => format!("\\partial_{{{letters}}} {name}"),
                (Format::Latex, _, false) => format!("\\partial_{{{letters}}} v_{{{own}}}"),
            });
        }
        for bound in &self.term.bounds {
            let (particle, centre) = (self.particle(bound.particle), self.particle(bound.centre));
            parts.push(match self.format {
                Format::Text if bound.centre == 0 => format!("Σ_{particle}"),
                Format::Text => format!("Σ_{particle}({centre})"),
                Format::Latex => format!("\\sum_{{{particle}}}"),
            });
        }
        let mut gradients: Vec<String> = Vec::new();
        // ∂_a W in place of (W′/r) r_a where one r of the pair is there.
        for place in 0..self.term.factors.len() {
            let factor = &self.term.factors[place];
            if factor.symbol != Symbol::Slope || factor.power != 1 {
                continue;
            }
            let twin = (0..self.term.factors.len()).rev().find(|other| {
                let other_factor = &self.term.factors[*other];
                let mut pair = other_factor.particles.clone();
                pair.sort_unstable();
                !used[*other] && other_factor.symbol == Symbol::Separation && pair == factor.particles
            });
            if let Some(twin) = twin {
                used[place] = true;
                used[twin] = true;
                let separation = &self.term.factors[twin];
                let letter = self.letter(separation.indices[0]);
                let pair = self.pair(&separation.particles);
                gradients.push(match self.format {
                    Format::Text => format!("∂_{letter}W_{pair}"),
                    Format::Latex => format!("\\partial_{{{letter}}} W_{{{pair}}}"),
                });
            }
        }
        for (place, factor) in self.term.factors.iter().enumerate() {
            if !used[place] {
                parts.push(self.factor(factor));
            }
        }
        parts.extend(gradients);
        // A sum of nothing else counts.
        if !self.term.bounds.is_empty() && self.term.factors.is_empty() {
            parts.push("1".into());
        }
        parts.join(" ")
    }

    fn factor(&self, factor: &Factor) -> String {
        let letters: Vec<String> = factor.indices.iter().map(|index| self.letter(*index)).collect();
        let letters = letters.concat();
        let pair = self.pair(&factor.particles);
        let latex = self.format == Format::Latex;
        let under = |name: &str, below: &str| {
            if latex { format!("{name}_{{{below}}}") } else { format!("{name}_{below}") }
        };
        let base = match &factor.symbol {
            Symbol::Dimension => "D".to_owned(),
            Symbol::Pi => self.pick("π", "\\pi").to_owned(),
            Symbol::SmoothingLength => "h".to_owned(),
            Symbol::OfParticle(OfParticle::Volume) => under(self.pick("ω", "\\omega"), &pair),
            Symbol::OfParticle(OfParticle::Density) => under(self.pick("ρ", "\\rho"), &pair),
            Symbol::OfParticle(OfParticle::Mass) => under("m", &pair),
            Symbol::OfParticle(OfParticle::Viscosity) => under(self.pick("μ", "\\mu"), &pair),
            Symbol::Distance if factor.power == 0 => {
                let [p, q] = [0, 1].map(|place| self.particle(factor.particles[place]));
                return format!("[{p} {} {q}]", self.pick("≠", "\\neq"));
            }
            Symbol::Distance => format!("|{}|", under(self.pick("r", "\\mathbf{r}"), &pair)),
            Symbol::Kernel => under("W", &pair),
            Symbol::Slope => under(self.pick("(W′/r)", "(W'/r)"), &pair),
            Symbol::Laplacian => under(self.pick("∇·∇W", "\\nabla\\cdot\\nabla W"), &pair),
            Symbol::Delta => under(self.pick("δ", "\\delta"), &letters),
            Symbol::Renormalisation => self.tensor(self.pick("B", "B"), &pair, &letters),
            Symbol::RenormalisationHat => self.tensor(self.pick("B̂", "\\hat{B}"), &pair, &letters),
            Symbol::Hessian => match self.format {
                Format::Text => format!("∂_{letters}W_{pair}"),
                Format::Latex => format!("\\partial_{{{letters}}} W_{{{pair}}}"),
            },
            Symbol::Separation => match self.format {
                Format::Text => format!("r_{pair}^{letters}"),
                Format::Latex => format!("r_{{{pair}}}^{{{letters}}}"),
            },
            Symbol::Reciprocal(body) => {
                let inner = self.body(body, factor);
                return match (self.format, factor.power) {
                    (Format::Text, 1) => format!("1/({inner})"),
                    (Format::Text, n) => format!("1/({inner})^{n}"),
                    (Format::Latex, 1) => format!("\\frac{{1}}{{{inner}}}"),
                    (Format::Latex, n) => format!("\\frac{{1}}{{({inner})^{{{n}}}}}"),
                };
            }
            Symbol::Inverse(body) => {
                let inner = self.body(body, factor);
                match self.format {
                    Format::Text => format!("[{inner}]⁻¹_{letters}"),
                    Format::Latex => format!("\\left[{inner}\\right]^{{-1}}_{{{letters}}}"),
                }
            }
            Symbol::Derivative(_) | Symbol::FieldAt(_) => under(self.field.name(), &pair),
        };
        match (factor.power, latex) {
            (1, _) => base,
            (n, true) => format!("{base}^{{{n}}}"),
            (n, false) => format!("{base}^{n}"),
        }
    }

    fn tensor(&self, name: &str, pair: &str, letters: &str) -> String {
        match self.format {
            Format::Text => format!("{name}_{pair}^{letters}"),
            Format::Latex => format!("{name}_{{{pair}}}^{{{letters}}}"),
        }
    }

    /// What stands inside a reciprocal or an inverse, with the particles of this term.
    fn body(&self, body: &Expression, factor: &Factor) -> String {
        let outer = factor.particles.len() as Label;
        let beyond = self.term.bounds.len() as Label + 1;
        let terms = body.terms.iter().enumerate().map(|(place, term)| {
            let mut term = term.clone();
            let rename = |label: &mut Label| {
                *label = match factor.particles.get(usize::from(*label)) {
                    Some(own) => *own,
                    None => beyond + (*label - outer),
                };
            };
            for bound in &mut term.bounds {
                rename(&mut bound.particle);
                rename(&mut bound.centre);
            }
            term.factors.iter_mut().flat_map(|factor| &mut factor.particles).for_each(rename);
            // The free indices of the body read as those of the factor, its own as later letters.
            for index in term.factors.iter_mut().flat_map(|factor| &mut factor.indices) {
                *index = match body.free.iter().position(|known| known == index) {
                    Some(at) => factor.indices.get(at).copied().unwrap_or(*index),
                    None => *index + 12,
                };
            }
            let expression = Expression { free: factor.indices.clone(), terms: Vec::new() };
            let writer =
                Writer { term: &term, free: &expression.free, field: self.field, format: self.format };
            let magnitude = term.coefficient.abs();
            let rest = writer.with_indices();
            let number = match (magnitude == int(1), rest.is_empty()) {
                (true, false) => String::new(),
                (_, true) => self.number(&magnitude),
                _ => format!("{} ", self.number(&magnitude)),
            };
            let sign = match (term.coefficient.is_negative(), place) {
                (true, 0) => self.pick("−", "-").to_owned(),
                (true, _) => format!(" {} ", self.pick("−", "-")),
                (false, 0) => String::new(),
                (false, _) => " + ".to_owned(),
            };
            format!("{sign}{number}{rest}")
        });
        terms.collect()
    }

    fn particle(&self, label: Label) -> String {
        let names = ["i", "j", "k", "l", "m", "n", "p", "q", "s", "t"];
        names.get(usize::from(label)).map_or_else(|| format!("p{label}"), |name| (*name).to_owned())
    }

    fn pair(&self, particles: &[Label]) -> String {
        particles.iter().map(|label| self.particle(*label)).collect()
    }

    fn letter(&self, index: Index) -> String {
        let names = "abcdefgxyzwopqrstαβγδεζηθλμνξπρστφχψω";
        // Free indices come first, then the others in their order.
        let place = match self.free.iter().position(|known| *known == index) {
            Some(at) => at,
            None => {
                let most = self.free.iter().copied().max().unwrap_or(0);
                self.free.len() + usize::from(index.saturating_sub(most + 1))
            }
        };
        names.chars().nth(place).map_or_else(|| format!("{{{place}}}"), |name| name.to_string())
    }
}
