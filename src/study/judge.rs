//! From finished tasks to verdicts.

use super::derive::{DerivedColumn, derived};
use super::ladder::fit_ladder;
use super::outcome::{CaseId, JudgedCase, LadderFit, MeasuredColumn, Outcome, RolledClaim, Varies};
use super::plan::{Plan, claims_in};
use super::run::TaskResult;
use super::scene::{CaseGroup, Scene};
use crate::claim::{
    CaseVerdict, Claim, Judgement, Measured, Quantity, Statement, Verdict, judge_convergence,
    judge_power_law, roll_up,
};
use crate::exact::rational_to_f64;
use crate::particles::{Disorder, PointGroup};

/// Fits the ladders that the claims need, and judges every claim in every case.
pub(super) fn judge(scene: &Scene, plan: &Plan, results: &[TaskResult]) -> Outcome {
    let margin = scene.raw.comparison.margin;
    let mut bench = Bench { plan, results, fits: Vec::new(), margin };
    let mut judged = Vec::new();
    for claim in &scene.claims {
        for CaseGroup { lattice, kernel, rule, disorders } in &scene.cases {
            if !claims_in(scene, lattice.dimension()).iter().any(|known| known.id == claim.id) {
                continue;
            }
            let vanishes = claim.subject.vanishes(lattice, &PointGroup::of(lattice));
            let disorders: Vec<Option<&Disorder>> =
                if claim.is_disordered() { disorders.iter().map(Some).collect() } else { vec![None] };
            for disorder in disorders {
                let case = CaseId::new(kernel, lattice, disorder, *rule);
                let (measured, judgement) = bench.judge_case(claim, &case, vanishes);
                let derived = derived(claim, kernel, lattice, disorder, *rule, vanishes);
                let judgement = with_derived(claim, &case, &measured, derived.as_ref(), judgement, margin);
                judged.push(JudgedCase { claim: claim.clone(), case, derived, measured, judgement });
            }
        }
    }
    let rolled = scene.claims.iter().map(|claim| roll(scene, claim, &judged)).collect();
    let (mut exact_sums, mut samples, mut pairs) = (0, 0, 0);
    for result in results {
        match result {
            TaskResult::Regular(rung) => exact_sums += rung.exact_sums,
            TaskResult::Samples { blocks, .. } => {
                samples += blocks.iter().map(|block| block.samples).sum::<u64>();
                pairs += blocks.iter().map(|block| block.pairs).sum::<u64>();
            }
        }
    }
    Outcome {
        scene: scene.clone(),
        judged,
        rolled,
        fits: bench.fits,
        omissions: plan.omissions.clone(),
        exact_sums,
        samples,
        pairs,
    }
}

/// The verdict with the derived column beside the measured one: where what was measured does not decide it and does not
/// contradict the derived exponents, these do; where both are there, the reason says whether they agree.
fn with_derived(
    claim: &Claim,
    case: &CaseId,
    measured: &MeasuredColumn,
    derived: Option<&DerivedColumn>,
    judgement: Judgement,
    margin: f64,
) -> Judgement {
    let Some(DerivedColumn::Exponents { displacement, dx_over_h, from }) = derived else { return judgement };
    let exact = [displacement, dx_over_h].map(|exponent| Measured::exactly(rational_to_f64(exponent)));
    let law = derived.map(DerivedColumn::power_law).unwrap_or_default();
    let alone = match &claim.statement {
        Statement::Zero => return judgement,
        Statement::PowerLaw { powers, .. } => {
            let published = [&powers.displacement, &powers.dx_over_h]
                .map(|exponent| rational_to_f64(&exponent.at(case.beta)));
            judge_power_law(published, exact, margin)
        }
        Statement::Convergence { rate, .. } => {
            let published = rational_to_f64(&rate.at(case.beta));
            judge_convergence(published, exact[0].plus(exact[1]), claim.subject.length_power(), margin)
        }
    };
    let Judgement { verdict, why } = judgement;
    let why = why.trim_end_matches('.');
    let inside = |measured: &Measured, exact: Measured| {
        (measured.low - margin..=measured.high + margin).contains(&exact.value)
    };
    let agree = match measured {
        MeasuredColumn::Exponents { displacement, dx_over_h, .. } => {
            inside(displacement, exact[0]) && inside(dx_over_h, exact[1])
        }
        MeasuredColumn::Rate { rate, .. } => inside(rate, exact[0].plus(exact[1])),
        _ => true,
    };
    // What contradicts the measured interval does not decide in its place.
    let coincident = matches!(measured, MeasuredColumn::Nothing { coincident: true, .. });
    if verdict == Verdict::Inconclusive && agree && !coincident {
        let why = format!("{why}. Judged by the derived {law} ({from}): {}", alone.why);
        return Judgement { verdict: alone.verdict, why };
    }
    let but = if agree { "" } else { ", which the measured exponents do not reach here" };
    Judgement { verdict, why: format!("{why}. Derived: {law} ({from}){but}.") }
}

fn roll(scene: &Scene, claim: &Claim, judged: &[JudgedCase]) -> RolledClaim {
    let cases: Vec<CaseVerdict> = judged
        .iter()
        .filter(|entry| entry.claim.id == claim.id)
        .map(|entry| {
            let case = &entry.case;
            let disorder = case.disorder.as_ref().map_or("regular", Disorder::model);
            CaseVerdict {
                labels: [
                    format!("{}-D", case.dimension),
                    disorder.to_owned(),
                    case.kernel.clone(),
                    case.lattice.clone(),
                    case.rule.to_string(),
                ]
                .to_vec(),
                verdict: entry.judgement.verdict,
            }
        })
        .collect();
    RolledClaim {
        id: claim.id.clone(),
        judgement: roll_up(&cases),
        expected: scene.raw.expect.get(&claim.id).copied(),
        cases: cases.len(),
    }
}

struct Bench<'a> {
    plan: &'a Plan,
    results: &'a [TaskResult],
    fits: Vec<LadderFit>,
    margin: f64,
}

impl Bench<'_> {
    fn judge_case(&mut self, claim: &Claim, case: &CaseId, vanishes: bool) -> (MeasuredColumn, Judgement) {
        match &claim.statement {
            Statement::Zero if vanishes => (
                MeasuredColumn::ZeroBySymmetry,
                Judgement {
                    verdict: Verdict::Confirmed,
                    why: "every component vanishes by the point group of the site, for every radial kernel."
                        .into(),
                },
            ),
            Statement::Zero => {
                let fit = self.fit(claim, case, Quantity::RegularValue, Varies::DxOverH);
                let largest = fit.map_or(0.0, |fit| fit.rungs.iter().map(|rung| rung.y).fold(0.0, f64::max));
                let judgement = Judgement {
                    verdict: if largest > 0.0 { Verdict::Refuted } else { Verdict::Inconclusive },
                    why: format!(
                        "the point group of the site does not force it, and it reaches {largest:.2e} in units of h."
                    ),
                };
                (MeasuredColumn::NotZero(largest), judgement)
            }
            Statement::PowerLaw { .. } | Statement::Convergence { .. }
                if !claim.is_disordered() && vanishes =>
            {
                (
                    MeasuredColumn::ZeroBySymmetry,
                    Judgement {
                        verdict: Verdict::Bound,
                        why: "the sum vanishes by symmetry, so every order holds as an upper bound.".into(),
                    },
                )
            }
            Statement::PowerLaw { quantity, powers } => {
                let published = [&powers.displacement, &powers.dx_over_h]
                    .map(|exponent| rational_to_f64(&exponent.at(case.beta)));
                self.judge_exponents(claim, case, *quantity, |[displacement, dx_over_h], fits, margin| {
                    let judgement = judge_power_law(published, [displacement, dx_over_h], margin);
                    (MeasuredColumn::Exponents { displacement, dx_over_h, fits }, judgement)
                })
            }
            Statement::Convergence { quantity, rate } => {
                let published = rational_to_f64(&rate.at(case.beta));
                let length = claim.subject.length_power();
                self.judge_exponents(claim, case, *quantity, |[displacement, dx_over_h], fits, margin| {
                    let rate = displacement.plus(dx_over_h);
                    let judgement = judge_convergence(published, rate, length, margin);
                    (MeasuredColumn::Rate { rate, fits }, judgement)
                })
            }
        }
    }

    /// What `judge` says of the exponents of d̃ and Δ/h, if both are measured.
    fn judge_exponents(
        &mut self,
        claim: &Claim,
        case: &CaseId,
        quantity: Quantity,
        judge: impl FnOnce([Measured; 2], Vec<String>, f64) -> (MeasuredColumn, Judgement),
    ) -> (MeasuredColumn, Judgement) {
        let mut fits = Vec::new();
        let mut exponent = |bench: &mut Self, varies: Varies| {
            let fit = bench.fit(claim, case, quantity, varies).ok_or("no ladder was planned for it")?;
            fits.push(fit.id.clone());
            let lost = bench.degenerate(case, varies);
            if lost > 0 {
                return Err(format!(
                    "{lost} samples had two particles within 1e-12 Δ and were not evaluated"
                ));
            }
            match &fit.fit {
                Err(error) => Err(format!("along {}: {error}", varies.id())),
                Ok(law) => match &law.unsettled {
                    Some(unsettled) => Err(format!("along {}: {unsettled}", varies.id())),
                    None => Ok(Measured { value: law.slope.value, low: law.slope.low, high: law.slope.high }),
                },
            }
        };
        let along_dx = exponent(self, Varies::DxOverH);
        let along_d = if quantity.is_disordered() {
            exponent(self, Varies::Displacement)
        } else {
            Ok(Measured::exactly(0.0))
        };
        match (along_d, along_dx) {
            (Ok(displacement), Ok(dx_over_h)) => judge([displacement, dx_over_h], fits, self.margin),
            (Err(why), _) | (_, Err(why)) => {
                let judgement = Judgement { verdict: Verdict::Inconclusive, why: format!("{why}.") };
                let coincident = [Varies::DxOverH, Varies::Displacement]
                    .iter()
                    .any(|varies| self.degenerate(case, *varies) > 0);
                (MeasuredColumn::Nothing { fits, coincident }, judgement)
            }
        }
    }

    /// The fit, made once.
    fn fit(&mut self, claim: &Claim, case: &CaseId, quantity: Quantity, varies: Varies) -> Option<LadderFit> {
        let known = self.fits.iter().find(|fit| {
            fit.subject == claim.subject
                && fit.quantity == quantity
                && fit.varies == varies
                && fit.case == *case
        });
        if let Some(fit) = known {
            return Some(fit.clone());
        }
        let ladder =
            self.plan.ladders.iter().find(|ladder| ladder.case == *case && ladder.varies == varies)?;
        let fit = fit_ladder(self.plan, ladder, self.results, &claim.subject, quantity)?;
        self.fits.push(fit.clone());
        Some(fit)
    }

    /// Samples of a ladder that were not evaluated because particles coincide.
    fn degenerate(&self, case: &CaseId, varies: Varies) -> u64 {
        let ladders =
            self.plan.ladders.iter().filter(|ladder| ladder.case == *case && ladder.varies == varies);
        let tasks = ladders.flat_map(|ladder| ladder.rungs.iter().flatten());
        tasks
            .map(|task| match &self.results[*task] {
                TaskResult::Samples { blocks, .. } => blocks.iter().map(|block| block.degenerate).sum(),
                TaskResult::Regular(_) => 0,
            })
            .sum()
    }
}
