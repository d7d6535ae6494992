//! The error of ∇p against the reference pressure, the disorder and h, under every correction, in three forms.

use super::super::{SurveyTask, TaskError, table_row};
use super::part::{Common, Part, With, judge, series, sides, sides_within, slope, stored};
use crate::claim::Observed;
use crate::derived::{Setting, linearised};
use crate::language::{Coefficient, Subject};
use crate::measured::{
    Correction, GradientForm, PressureErrors, PressureField, PressureSpec, pressure_errors,
};
use crate::particles::{Disorder, VolumeRule, lattice_by_id};
use crate::record::{Case, Report, significant};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::sync::Arc;

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Errors {
    form: String,
    correction: String,
    /// By reference pressure: root mean square error over g, and its standard error.
    errors: Vec<[f64; 2]>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Found {
    disorder: String,
    amplitude: f64,
    h: f64,
    rule: String,
    errors: Vec<Errors>,
    /// Root mean square of p − p_avg over gℓ.
    reduced: f64,
    pairs: u64,
    particles: u64,
    /// rms of Σ V ∇W in 1/h, derived to second order in the displacements.
    derived: f64,
}

/// Volumes of Eq. (11) for every disorder and h; constant ones beside them at the first h.
pub(super) struct PressurePart {
    common: Arc<Common>,
}

impl PressurePart {
    pub(super) fn new(common: &Arc<Common>) -> Self {
        Self { common: Arc::clone(common) }
    }

    fn jobs(&self) -> Vec<(&Disorder, f64, VolumeRule)> {
        let p = &self.common.parameters;
        let mut jobs = Vec::new();
        for disorder in &self.common.disorders {
            jobs.extend(p.smoothing_lengths.iter().map(|h| (disorder, *h, VolumeRule::NumberDensity)));
            jobs.extend(p.smoothing_lengths.first().map(|h| (disorder, *h, VolumeRule::Constant)));
        }
        jobs
    }

    fn found(&self, disorder: &Disorder, h: f64, rule: VolumeRule) -> Result<Found, TaskError> {
        let p = &self.common.parameters;
        let square = lattice_by_id("square")?;
        let support = Common::support(p.dx_over_h);
        let spec = PressureSpec {
            kernel: &self.common.kernel,
            lattice: &square,
            support_over_dx: support,
            rule,
            disorder,
            h,
            radius: p.ball_radius,
            seed: self.common.seed,
        };
        let (errors, field): (Vec<PressureErrors>, PressureField) =
            pressure_errors(&spec, &p.reference_pressures)?;
        let setting = Setting {
            kernel: &self.common.kernel,
            lattice: &square,
            disorder,
            support_over_dx: support,
            rule,
        };
        let gradient = Coefficient::new("sum_j V_j u_j gradW_ij", 0)?;
        let derived = linearised(&setting, &Subject::Coefficient(gradient))?.rms() / p.dx_over_h;
        Ok(Found {
            disorder: disorder.to_string(),
            amplitude: disorder.amplitude(),
            h,
            rule: rule.id().into(),
            errors: errors
                .into_iter()
                .map(|e| Errors {
                    form: e.form.id().into(),
                    correction: e.correction.id().into(),
                    errors: e.errors,
                })
                .collect(),
            reduced: field.reduced,
            pairs: field.pairs,
            particles: field.particles as u64,
            derived,
        })
    }
}

impl Found {
    fn of(&self, form: GradientForm, correction: Correction) -> &[[f64; 2]] {
        let found = self.errors.iter().find(|e| e.form == form.id() && e.correction == correction.id());
        found.map_or(&[], |e| e.errors.as_slice())
    }
}

impl Part for PressurePart {
    fn tasks(&self) -> Vec<SurveyTask> {
        let p = &self.common.parameters;
        let task = |(disorder, h, rule): (&Disorder, f64, VolumeRule)| {
            let name = format!("pressure {disorder} h {h} {rule}");
            self.common.task(&name, &(p.dx_over_h, &p.reference_pressures, p.ball_radius), 6_000_000)
        };
        self.jobs().into_iter().map(task).collect()
    }

    fn compute(&self, task: usize) -> Result<Value, TaskError> {
        let jobs = self.jobs();
        let (disorder, h, rule) = jobs.get(task).ok_or("no such task")?;
        Ok(serde_json::to_value(self.found(disorder, *h, *rule)?)?)
    }

    fn report(&self, results: &[Value], report: &mut Report) -> Result<(), TaskError> {
        let all: Vec<Found> = results.iter().map(stored).collect::<Result<_, _>>()?;
        let programs = (GradientForm::ALL.len() * Correction::ALL.len()) as u64;
        let fields = self.common.parameters.reference_pressures.len() as u64;
        report.cost.pairs += all.iter().map(|found| found.pairs * programs * fields).sum::<u64>();
        report.cost.samples += all.iter().map(|found| found.particles).sum::<u64>();
        let own: Vec<&Found> = all.iter().filter(|f| f.rule == VolumeRule::NumberDensity.id()).collect();
        self.trends(&own, report)?;
        self.relations(&all, report)?;
        self.table(&all, report);
        self.figures(&own, report);
        Ok(())
    }
}

impl PressurePart {
    fn case(&self, form: GradientForm, rule: VolumeRule) -> Case {
        let case = self.common.case("square", 2, rule).with("form", form.id());
        case.with("dx_over_h", self.common.parameters.dx_over_h)
    }

    /// The highest reference pressure, where nothing else is seen.
    fn highest(&self) -> (usize, f64) {
        let all = self.common.parameters.reference_pressures.iter().copied().enumerate();
        all.fold((0, 0.0), |most, next| if next.1 > most.1 { next } else { most })
    }

    fn trends(&self, own: &[&Found], report: &mut Report) -> Result<(), TaskError> {
        let p = &self.common.parameters;
        let (highest, p0) = self.highest();
        let first_h = p.smoothing_lengths[0];
        let last = self.common.disorders[self.common.disorders.len() - 1].to_string();
        for form in GradientForm::ALL {
            let case = || self.case(form, VolumeRule::NumberDensity);
            for found in own.iter().filter(|f| f.h == first_h) {
                let points = p.reference_pressures.iter().zip(found.of(form, Correction::None));
                // Where the gradient's own error is not what is seen.
                let points: Vec<[f64; 2]> =
                    points.filter(|(p0, _)| **p0 >= 1e3).map(|(p0, e)| [*p0, e[0]]).collect();
                if points.len() >= 3 {
                    let case = case().disordered(&found.disorder);
                    judge(report, "3/value", case, None, Some(Observed::Number(slope(&points)?)))?;
                }
            }
            let by_h = own.iter().filter(|f| f.disorder == last);
            let points: Vec<[f64; 2]> =
                by_h.map(|f| [f.h, f.of(form, Correction::None)[highest][0]]).collect();
            let case_at = || case().with("reference_pressure", p0);
            judge(report, "3/h", case_at().disordered(&last), None, Some(Observed::Number(slope(&points)?)))?;
            let by_disorder = || own.iter().filter(|f| f.h == first_h);
            let points: Vec<[f64; 2]> =
                by_disorder().map(|f| [f.amplitude, f.of(form, Correction::None)[highest][0]]).collect();
            let derived: Vec<[f64; 2]> = by_disorder().map(|f| [f.amplitude, f.derived]).collect();
            let derived =
                if form == GradientForm::Volume { Some(Observed::Number(slope(&derived)?)) } else { None };
            judge(report, "3/disorder", case_at(), derived, Some(Observed::Number(slope(&points)?)))?;
        }
        Ok(())
    }

    fn relations(&self, all: &[Found], report: &mut Report) -> Result<(), TaskError> {
        let p = &self.common.parameters;
        let (first_h, references) = (p.smoothing_lengths[0], &p.reference_pressures);
        for found in all.iter().filter(|f| f.h == first_h) {
            let rule = VolumeRule::by_id(&found.rule)?;
            for form in GradientForm::ALL {
                let plain = found.of(form, Correction::None);
                for (id, correction) in
                    [("eq-20/reduces", Correction::Reduction), ("3/hydrostatic", Correction::Hydrostatic)]
                {
                    let corrected = found.of(form, correction);
                    for (place, p0) in
                        references.iter().enumerate().filter(|(_, p0)| [0.0, 1e3].contains(*p0))
                    {
                        let case =
                            self.case(form, rule).disordered(&found.disorder).with("reference_pressure", *p0);
                        judge(report, id, case, None, sides_within(corrected[place], plain[place]))?;
                    }
                }
            }
            if rule == VolumeRule::NumberDensity {
                let case = || self.case(GradientForm::Eight, rule).disordered(&found.disorder);
                // d in units of ℓ: half the rows across.
                let half_width = 0.5 * p.rows as f64 * found.h * p.dx_over_h;
                let dynamic = case().with("field", "p − p_h as large as g d");
                judge(report, "eq-20/closer", dynamic, None, sides(found.reduced, half_width))?;
                // Of the channel's own example the hydrostatic pressure is all there is.
                let channel = case().with("field", "p_h alone");
                judge(report, "eq-20/closer", channel, None, sides(found.reduced, 0.0))?;
            }
        }
        Ok(())
    }

    fn table(&self, all: &[Found], report: &mut Report) {
        #[derive(Serialize)]
        struct Row<'a> {
            form: &'a str,
            correction: &'a str,
            disorder: &'a str,
            h: f64,
            volume_rule: &'a str,
            reference_pressure: f64,
            relative_error: f64,
            standard_error: f64,
        }
        let references = &self.common.parameters.reference_pressures;
        let mut rows = Vec::new();
        for found in all {
            for e in &found.errors {
                rows.extend(references.iter().zip(&e.errors).map(|(p0, error)| {
                    table_row(&Row {
                        form: &e.form,
                        correction: &e.correction,
                        disorder: &found.disorder,
                        h: found.h,
                        volume_rule: &found.rule,
                        reference_pressure: *p0,
                        relative_error: significant(error[0], 5),
                        standard_error: significant(error[1], 2),
                    })
                }));
            }
        }
        report.tables.insert("pressure_gradient_error".into(), rows);
        #[derive(Serialize)]
        struct Slope<'a> {
            disorder: &'a str,
            volume_rule: &'a str,
            derived: f64,
            measured: f64,
        }
        let (highest, p0) = self.highest();
        let first_h = self.common.parameters.smoothing_lengths[0];
        let rows = all.iter().filter(|f| f.h == first_h).map(|f| {
            table_row(&Slope {
                disorder: &f.disorder,
                volume_rule: &f.rule,
                derived: significant(f.derived, 6),
                // The error over p₀/h.
                measured: significant(f.of(GradientForm::Volume, Correction::None)[highest][0] * f.h / p0, 6),
            })
        });
        let rows = rows.collect();
        report.tables.insert("pressure_gradient_error_over_p0_by_h".into(), rows);
    }

    fn figures(&self, own: &[&Found], report: &mut Report) {
        let p = &self.common.parameters;
        let first_h = p.smoothing_lengths[0];
        for form in GradientForm::ALL {
            let mut lines = Vec::new();
            for found in own.iter().filter(|f| f.h == first_h) {
                for correction in Correction::ALL {
                    let points = p.reference_pressures.iter().zip(found.of(form, correction));
                    let points = points.filter(|(p0, _)| **p0 > 0.0).map(|(p0, e)| vec![*p0, e[0], e[1]]);
                    lines.push((format!("{}, {}", correction.id(), found.disorder), points.collect()));
                }
            }
            report.series.push(series(
                &format!("pressure-gradient-{}", form.id().trim_matches(['(', ')'])),
                None,
                ("p₀", "gℓ", true),
                ("rms |⟨∇p⟩ − ∇p|", "g", true),
                lines,
            ));
        }
    }
}
