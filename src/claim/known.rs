//! Every built-in statement, whatever its kind, in words and as a formula.

use super::{
    Assertion, Claim, Direction, HeatStatement, Published, Sign, Statement, basa_2009, catalogue,
    chaussonnet_2015,
};

/// A published statement as a reader sees it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Known {
    /// For example `fatehi-table-2/sum_dw#disorder`.
    pub id: String,
    /// Key in `references.bib`.
    pub source: String,
    /// Equation, table, section.
    pub location: String,
    /// The statement as the paper makes it.
    pub text: String,
    /// What is checked, as a formula.
    pub formula: String,
}

/// The statements of all papers: orders of moment sums and operators, and what surveys check.
pub fn known() -> Vec<Known> {
    let claims = catalogue().into_iter().map(Known::from);
    let heat = HeatStatement::all().into_iter().map(HeatStatement::assertion);
    let assertions = basa_2009::basa_2009().into_iter().chain(chaussonnet_2015::all()).chain(heat);
    claims.chain(assertions.map(Known::from)).collect()
}

impl From<Claim> for Known {
    fn from(claim: Claim) -> Self {
        let subject = &claim.subject;
        let formula = match &claim.statement {
            Statement::Zero => format!("{} = 0 on regular particles", subject.formula()),
            Statement::PowerLaw { quantity, powers } => format!("{} = {powers}", quantity.formula(subject)),
            Statement::Convergence { quantity, rate } => {
                let length = subject.length_power();
                let formula = quantity.formula(subject);
                format!(
                    "{formula} ~ Δ^{{{rate}}} h^{{{length}−({rate})}} → 0 exactly if Δ ≪ h^κ, κ = 1 − ({length})/({rate})"
                )
            }
        };
        Self { id: claim.id, source: claim.source, location: claim.location, text: claim.text, formula }
    }
}

impl From<Assertion> for Known {
    fn from(assertion: Assertion) -> Self {
        let Assertion { id, source, location, text, published } = assertion;
        Self { id, source: source.into(), location, text, formula: published.formula() }
    }
}

impl Published {
    /// What is checked, with the margin that it is held to.
    pub fn formula(&self) -> String {
        let percent = |margin: f64| format!("held to {} %", 100.0 * margin);
        match self {
            Self::Constant { value, unit, margin } => {
                let unit = if *unit == "1" { String::new() } else { format!(" {unit}") };
                format!("value = {value}{unit} ({})", percent(*margin))
            }
            Self::Ratio { value, margin } => format!("ratio = {value} ({})", percent(*margin)),
            Self::Exponent { of, value, margin } => format!("∝ {}^{value} (held to ±{margin})", of.symbol()),
            Self::Order { of, value, margin } => format!("O({}^{value}) (held to ±{margin})", of.symbol()),
            Self::Never => "no exceptions".into(),
            Self::Zero => "= 0".into(),
            Self::Trend { of, against, direction, margin } => {
                let word = match direction {
                    Direction::Rising => "rises",
                    Direction::Falling => "falls",
                    Direction::Constant => "stays",
                };
                format!("{of} {word} with {against} (slopes within ±{margin} are none)")
            }
            Self::Relation { left, sign, right } => {
                let sign = match sign {
                    Sign::Less => "<",
                    Sign::Greater => ">",
                    Sign::Equal => "= (within 5 %)",
                };
                format!("{left} {sign} {right}")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::literature;
    use super::known;

    #[test]
    fn every_statement_has_a_formula_and_a_paper() {
        let (statements, papers) = (known(), literature().expect("BibTeX"));
        assert!(statements.len() > 150, "{}", statements.len());
        for statement in &statements {
            assert!(papers.iter().any(|paper| paper.key == statement.source), "{statement:?}");
            assert!(!statement.formula.is_empty() && !statement.text.is_empty(), "{statement:?}");
        }
        let mut ids: Vec<&str> = statements.iter().map(|statement| statement.id.as_str()).collect();
        ids.sort_unstable();
        let all = ids.len();
        ids.dedup();
        assert_eq!(ids.len(), all, "an id stands for two statements");
    }
}
