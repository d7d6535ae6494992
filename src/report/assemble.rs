//! From an outcome to the record.

use crate::claim::{Claim, Measured, Statement, convergence_power};
use crate::derived::{Conservation, Conserved, Expansion, Format};
use crate::exact::{Rational, int, rational_text};
use crate::language::{Coefficient, Subject};
use crate::record::*;
use crate::study::{CaseId, DerivedColumn, JudgedCase, LadderFit, MeasuredColumn, Outcome, Varies};
use serde_json::Value;
use std::collections::BTreeMap;

/// Significant digits of fitted numbers: what passes through statrs is the same on every machine to that many.
const DIGITS: usize = 8;

/// The unit of κ in "Δ must fall faster than h^κ".
pub(super) const POWER: &str = "power of h that Δ must fall faster than";

/// The record of an outcome: a pure function of it.
pub fn assemble(outcome: &Outcome) -> Report {
    let scene = &outcome.scene;
    let margin = scene.raw.comparison.margin;
    Report {
        schema: SCHEMA.into(),
        provenance: Provenance {
            version: env!("CARGO_PKG_VERSION").into(),
            scene: scene.name.clone(),
            title: scene.raw.study.title.clone(),
            scene_sha256: scene.sha256.clone(),
            seed: scene.raw.study.seed,
            features: Vec::new(),
            quick: scene.quick,
        },
        claims: outcome.judged.iter().map(|judged| entry(judged, margin)).collect(),
        verdicts: outcome
            .rolled
            .iter()
            .map(|rolled| RolledVerdict {
                id: rolled.id.clone(),
                verdict: rolled.judgement.verdict,
                why: rolled.judgement.why.clone(),
                expected: rolled.expected,
                cases: rolled.cases,
            })
            .collect(),
        fits: outcome.fits.iter().filter_map(fit).collect(),
        left_out: outcome
            .omissions
            .iter()
            .map(|omission| LeftOut {
                what: omission.what.clone(),
                why: omission.why.clone(),
                saved: omission.saved.clone(),
            })
            .collect(),
        cost: Cost { exact_sums: outcome.exact_sums, samples: outcome.samples, pairs: outcome.pairs },
        ..Report::default()
    }
}

fn entry(judged: &JudgedCase, margin: f64) -> ClaimEntry {
    let claim = &judged.claim;
    let (kind, published) = match &claim.statement {
        Statement::Zero => (
            ClaimKind::Zero,
            Column { zero: Some(Zero { holds: true, by: None, bound: None }), ..Column::default() },
        ),
        Statement::PowerLaw { powers, .. } => {
            let printed = |exponent: &crate::claim::BetaExponent| {
                Some(Estimate::exact(rational_text(&exponent.at(judged.case.beta)), Source::Print))
            };
            let exponents = Exponents {
                displacement: printed(&powers.displacement),
                h: printed(&powers.h),
                dx_over_h: printed(&powers.dx_over_h),
                ..Exponents::default()
            };
            (ClaimKind::PowerLaw, Column { exponents: Some(exponents), ..Column::default() })
        }
        Statement::Convergence { rate, .. } => {
            let power = int(1) - int(i64::from(claim.subject.length_power())) / rate.at(judged.case.beta);
            let power = Estimate::exact(rational_text(&power), Source::Print);
            (
                ClaimKind::Constant,
                Column { value: Some(power), unit: Some(POWER.into()), ..Column::default() },
            )
        }
    };
    let measured = match &judged.measured {
        MeasuredColumn::Exponents { displacement, dx_over_h, fits } => {
            let disordered = judged.case.disorder.is_some();
            let power = f64::from(claim.subject.length_power());
            let h = Estimate::float(
                significant(power - displacement.value, DIGITS),
                significant(power - displacement.high, DIGITS),
                significant(power - displacement.low, DIGITS),
                Source::Identity,
            );
            let exponents = Exponents {
                displacement: Some(if disordered {
                    fitted(*displacement)
                } else {
                    Estimate::exact("0", Source::Identity)
                }),
                h: Some(if disordered {
                    h
                } else {
                    Estimate::exact(claim.subject.length_power().to_string(), Source::Identity)
                }),
                dx_over_h: Some(fitted(*dx_over_h)),
                ..Exponents::default()
            };
            Some(Column { exponents: Some(exponents), fits: fits.clone(), ..Column::default() })
        }
        MeasuredColumn::Rate { rate, fits } => {
            let power = |rate| significant(convergence_power(rate, claim.subject.length_power()), DIGITS);
            let ends = [power(rate.low), power(rate.high)];
            let value =
                Estimate::float(power(rate.value), ends[0].min(ends[1]), ends[0].max(ends[1]), Source::Fit);
            Some(Column {
                value: Some(value),
                unit: Some(POWER.into()),
                fits: fits.clone(),
                ..Column::default()
            })
        }
        MeasuredColumn::ZeroBySymmetry => {
            let zero = Zero { holds: true, by: Some("symmetry".into()), bound: Some(0.0) };
            Some(Column { zero: Some(zero), ..Column::default() })
        }
        MeasuredColumn::NotZero(largest) => {
            let zero = Zero { holds: false, by: None, bound: Some(significant(*largest, DIGITS)) };
            Some(Column { zero: Some(zero), ..Column::default() })
        }
        MeasuredColumn::Nothing { fits, .. } => {
            (!fits.is_empty()).then(|| Column { fits: fits.clone(), ..Column::default() })
        }
    };
    ClaimEntry {
        id: claim.id.clone(),
        kind,
        citation: Citation { source: claim.source.clone(), location: claim.location.clone() },
        statement: claim.text.clone(),
        case: case(&judged.case, &claim.subject),
        published: Some(published),
        derived: judged.derived.as_ref().map(|derived| derived_column(claim, derived)),
        measured,
        margin: (kind != ClaimKind::Zero).then_some(margin),
        verdict: judged.judgement.verdict,
        why: judged.judgement.why.clone(),
    }
}

fn derived_column(claim: &Claim, derived: &DerivedColumn) -> Column {
    let DerivedColumn::Exponents { displacement, dx_over_h, from } = derived else {
        let zero = Zero { holds: true, by: Some("symmetry".into()), bound: Some(0.0) };
        return Column { zero: Some(zero), ..Column::default() };
    };
    let exact = |exponent: &Rational| Some(Estimate::exact(rational_text(exponent), Source::Derivation));
    let length = int(i64::from(claim.subject.length_power()));
    let value = matches!(claim.statement, Statement::Convergence { .. })
        .then(|| int(1) - &length / (displacement + dx_over_h));
    let exponents = Exponents {
        displacement: exact(displacement),
        h: exact(&(length - displacement)),
        dx_over_h: exact(dx_over_h),
        ..Exponents::default()
    };
    Column {
        exponents: Some(exponents),
        unit: value.is_some().then(|| POWER.into()),
        value: value.as_ref().and_then(exact),
        from: Some(from.clone()),
        ..Column::default()
    }
}

fn fitted(measured: Measured) -> Estimate {
    let round = |value| significant(value, DIGITS);
    Estimate::float(round(measured.value), round(measured.low), round(measured.high), Source::Fit)
}

fn case(case: &CaseId, subject: &Subject) -> Case {
    let more = subject.coefficient().map(of_operator).unwrap_or_default();
    Case {
        source: "lattice".into(),
        dimension: case.dimension as u8,
        kernel: case.kernel.clone(),
        lattice: Some(case.lattice.clone()),
        disorder: Some(case.disorder.as_ref().map_or("none".into(), ToString::to_string)),
        volume_rule: case.rule.to_string(),
        more,
    }
}

fn fit(ladder: &LadderFit) -> Option<Fit> {
    let law = ladder.fit.as_ref().ok()?;
    let round = |value| significant(value, DIGITS);
    let estimate = |e: crate::measured::fit::Estimate| {
        Estimate::float(round(e.value), round(e.low), round(e.high), Source::Fit)
    };
    let mut residuals = law.residuals.iter();
    let points = ladder.rungs.iter().enumerate().map(|(index, rung)| {
        let reason = ladder.reason(index);
        FitPoint {
            x: round(rung.x),
            y: round(rung.y),
            y_error: rung.y_error.map(round),
            mean: rung.mean.map(round),
            max: rung.max.map(round),
            samples: rung.samples,
            support_over_dx: Some(rung.support_over_dx),
            kept: reason.is_none(),
            why: reason.map(|reason| reason.to_string()),
            residual: if reason.is_none() { residuals.next().copied().map(round) } else { None },
        }
    });
    let points = points.collect();
    let sum: f64 = law.residuals.iter().map(|r| r * r).sum();
    let freedom = law.degrees_of_freedom;
    let abscissa = match ladder.varies {
        Varies::DxOverH => "Δ/h",
        Varies::Displacement => "d̃/h",
    };
    let power = ladder.subject.length_power();
    let unit = if power == 0 { "1".to_owned() } else { format!("h^{power}") };
    Some(Fit {
        id: ladder.id.clone(),
        quantity: ladder.quantity.formula(&ladder.subject),
        case: case(&ladder.case, &ladder.subject),
        varies: ladder.varies.id().into(),
        held: ladder.held.iter().cloned().collect(),
        x: Axis { name: abscissa.into(), unit: "1".into(), log: true },
        y: Axis { name: ladder.quantity.formula(&ladder.subject), unit, log: true },
        points,
        slope: estimate(law.slope),
        intercept: estimate(law.intercept),
        residual_sd: round((sum / freedom.max(1) as f64).sqrt()),
        degrees_of_freedom: freedom,
        coverage: 0.95,
        interval: "Student-t on the residuals of ln y (or the sampling errors where these are larger), widened to reach \
                   the slope of the finer half of the window"
            .into(),
    })
}

/// Which coefficient of which operator, as the expansion has it, and what the operator conserves.
fn of_operator(coefficient: &Coefficient) -> BTreeMap<String, Value> {
    let mut more = BTreeMap::from([
        ("operator".to_owned(), Value::from(coefficient.id())),
        ("order".to_owned(), Value::from(coefficient.order())),
    ]);
    let order = usize::from(coefficient.order());
    let operator = coefficient.operator().clone();
    if let Ok(expansion) = Expansion::of(operator, coefficient.target().cloned(), order) {
        let terms = expansion.printed(Format::Text).pop().map(|printed| printed.terms).unwrap_or_default();
        let text = if terms.is_empty() { "0".to_owned() } else { terms.join(" ") };
        more.insert("expansion".into(), text.trim_start_matches("+ ").into());
    }
    if let Ok(conserves) = Conservation::of(coefficient.operator()) {
        let text = match (conserves.total, conserves.angular) {
            (Conserved::Yes, Conserved::Yes) => "linear and angular momentum",
            (Conserved::Yes, Conserved::No) => "linear momentum",
            (Conserved::Yes, Conserved::DoesNotApply) => "the total",
            (Conserved::No, _) => "nothing",
            (Conserved::DoesNotApply, _) => "does not apply",
        };
        more.insert("conserves".into(), text.into());
    }
    more
}
