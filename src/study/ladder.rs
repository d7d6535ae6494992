//! Ladders from finished tasks: the points, then the fit.

use super::outcome::{CaseId, LadderFit, Rung, Varies};
use super::plan::{LadderPlan, Plan, Task};
use super::run::TaskResult;
use crate::claim::Quantity;
use crate::kernel::Kernel;
use crate::language::Subject;
use crate::measured::summarise;
use crate::measured::window::{LadderPoint, WindowOptions, power_law};

/// The ladder of one quantity, fitted.
pub(super) fn fit_ladder(
    plan: &Plan,
    ladder: &LadderPlan,
    results: &[TaskResult],
    subject: &Subject,
    quantity: Quantity,
) -> Option<LadderFit> {
    let index = ladder.subjects.iter().position(|known| known == subject)?;
    let mut rungs: Vec<Rung> = ladder
        .rungs
        .iter()
        .filter_map(|tasks| {
            let points =
                tasks.iter().flat_map(|task| points_of(plan, *task, results, index, quantity, ladder));
            // The envelope: the largest over the offsets of R/Δ, at the R/Δ where it is reached.
            points.max_by(|a, b| a.y.total_cmp(&b.y))
        })
        .collect();
    rungs.sort_by(|a, b| b.x.total_cmp(&a.x));
    let points: Vec<LadderPoint> = rungs
        .iter()
        .map(|rung| LadderPoint {
            x: rung.x,
            y: rung.y,
            relative_error: rung.y_error.filter(|_| rung.y > 0.0).map(|error| error / rung.y),
            floor: rung.floor,
        })
        .collect();
    let fit = power_law(&points, &WindowOptions::default()).map_err(|error| error.to_string());
    let id = format!("{}/{}/{}/{}", subject.name(), quantity.id(), ladder.case.path(), ladder.varies.id());
    let mut held = held(&ladder.case, ladder.varies, &rungs);
    if quantity == Quantity::RegularDeviation && subject.moment().is_some() {
        let kernel = ladder.rungs.iter().flatten().next().map(|task| plan.tasks[*task].kernel());
        held.extend(kernel.and_then(Kernel::remark).map(|remark| ("kernel".to_owned(), remark)));
    }
    Some(LadderFit {
        id,
        case: ladder.case.clone(),
        subject: subject.clone(),
        quantity,
        varies: ladder.varies,
        held,
        rungs,
        fit,
    })
}

fn points_of(
    plan: &Plan,
    task: usize,
    results: &[TaskResult],
    subject: usize,
    quantity: Quantity,
    ladder: &LadderPlan,
) -> Vec<Rung> {
    let kappa = ladder.case.support_over_h;
    match (&plan.tasks[task], &results[task]) {
        (Task::Regular(_), TaskResult::Regular(rung)) => rung
            .supports
            .iter()
            .zip(&rung.norms)
            .map(|(support, norms)| {
                let norm = norms[subject];
                let y = if quantity == Quantity::RegularValue { norm.value } else { norm.deviation };
                Rung {
                    x: kappa / support,
                    y,
                    y_error: None,
                    floor: norm.radius,
                    mean: None,
                    max: None,
                    samples: None,
                    support_over_dx: *support,
                }
            })
            .collect(),
        (Task::Samples { spec, .. }, TaskResult::Samples { blocks, floors }) => {
            let summary = summarise(blocks, subject);
            let dx_over_h = kappa / spec.support_over_dx;
            let x = match ladder.varies {
                Varies::DxOverH => dx_over_h,
                Varies::Displacement => spec.amplitude * dx_over_h,
            };
            vec![Rung {
                x,
                y: summary.rms,
                y_error: Some(summary.rms_error),
                floor: floors[subject],
                mean: Some(summary.mean),
                max: Some(summary.max),
                samples: Some(summary.samples),
                support_over_dx: spec.support_over_dx,
            }]
        }
        _ => Vec::new(),
    }
}

fn held(case: &CaseId, varies: Varies, rungs: &[Rung]) -> Vec<(String, String)> {
    let mut held = vec![("h".to_owned(), "1".to_owned())];
    match (varies, &case.disorder) {
        (Varies::DxOverH, Some(disorder)) => {
            held.push(("d̃".into(), format!("{disorder} at the finest rung")));
        }
        (Varies::Displacement, _) => {
            if let Some(rung) = rungs.first() {
                held.push(("R/Δ".into(), rung.support_over_dx.to_string()));
            }
        }
        _ => {}
    }
    held
}
