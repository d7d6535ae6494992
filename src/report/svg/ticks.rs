//! Where an axis has its ticks, and what stands at them.

/// A tick; small ones have no label.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tick {
    pub(super) at: f64,
    pub(super) label: Option<String>,
}

/// Ticks from `low` to `high`, about `most` of them with labels.
pub(super) fn ticks(low: f64, high: f64, log: bool, most: usize) -> Vec<Tick> {
    if log { logarithmic(low, high, most) } else { linear(low, high, most) }
}

fn linear(low: f64, high: f64, most: usize) -> Vec<Tick> {
    let step = nice((high - low) / most.max(1) as f64);
    let (first, last) = ((low / step).ceil() as i64, (high / step).floor() as i64);
    let tick = |k: i64| {
        let at = k as f64 * step;
        Tick { at, label: Some(plain(at, step)) }
    };
    (first..=last).map(tick).collect()
}

/// The smallest of 1, 2, 5 × 10^k that is not smaller.
fn nice(step: f64) -> f64 {
    let decade = libm::pow(10.0, libm::floor(libm::log10(step)));
    let factor = [1.0, 2.0, 5.0].into_iter().find(|factor| factor * decade >= step * (1.0 - 1e-9));
    factor.unwrap_or(10.0) * decade
}

/// A number as fine as the step between ticks.
fn plain(value: f64, step: f64) -> String {
    if value == 0.0 {
        return "0".into();
    }
    if value.abs() >= 1e5 || step < 1e-4 {
        return scientific(value);
    }
    let digits = (-libm::floor(libm::log10(step) + 1e-9)).max(0.0) as usize;
    format!("{value:.digits$}").replace('-', "−")
}

fn scientific(value: f64) -> String {
    let text = format!("{value:.1e}");
    let (digits, power) = text.split_once('e').unwrap_or((&text, "0"));
    let digits = digits.strip_suffix(".0").unwrap_or(digits).replace('-', "−");
    if digits == "1" { format!("10^{{{power}}}") } else { format!("{digits}×10^{{{power}}}") }
}

fn logarithmic(low: f64, high: f64, most: usize) -> Vec<Tick> {
    let (first, last) =
        (libm::ceil(libm::log10(low) - 1e-9) as i32, libm::floor(libm::log10(high) + 1e-9) as i32);
    let decades = usize::try_from(last - first + 1).unwrap_or(0);
    let within = |at: f64| at >= low * (1.0 - 1e-9) && at <= high * (1.0 + 1e-9);
    let power = |k: i32| libm::pow(10.0, f64::from(k));
    let mut found = Vec::new();
    if decades < 2 {
        // Hardly a decade: numbers within it have labels too.
        let labelled: &[i32] = if high / low > 2.5 { &[1, 2, 5] } else { &[1, 2, 3, 4, 5, 6, 7, 8, 9] };
        for k in first - 1..=last {
            for digit in 1..=9 {
                let at = f64::from(digit) * power(k);
                if within(at) {
                    let label = labelled.contains(&digit).then(|| small_number(digit, k));
                    found.push(Tick { at, label });
                }
            }
        }
        if found.iter().filter(|tick| tick.label.is_some()).count() >= 2 {
            return found;
        }
        return linear(low, high, most);
    }
    let every = decades.div_ceil(most.max(1));
    for k in first - 1..=last {
        if within(power(k)) {
            let label = (k.rem_euclid(every as i32) == 0).then(|| format!("10^{{{k}}}"));
            found.push(Tick { at: power(k), label });
        }
        if decades <= 5 {
            let between = (2..=9).map(|digit| f64::from(digit) * power(k)).filter(|at| within(*at));
            found.extend(between.map(|at| Tick { at, label: None }));
        }
    }
    found
}

/// d × 10^k.
fn small_number(digit: i32, k: i32) -> String {
    match k {
        0..=3 => format!("{digit}{}", "0".repeat(k as usize)),
        -3..=-1 => format!("0.{}{digit}", "0".repeat((-k - 1) as usize)),
        _ if digit == 1 => format!("10^{{{k}}}"),
        _ => format!("{digit}×10^{{{k}}}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(low: f64, high: f64, log: bool) -> Vec<String> {
        ticks(low, high, log, 5).into_iter().filter_map(|tick| tick.label).collect()
    }

    #[test]
    fn decades_are_powers_of_ten() {
        assert_eq!(labels(0.5e-3, 2.0, true), ["10^{-3}", "10^{-2}", "10^{-1}", "10^{0}"]);
    }

    #[test]
    fn less_than_a_decade_has_numbers() {
        assert_eq!(labels(0.015, 0.09, true), ["0.02", "0.05"]);
        assert_eq!(labels(0.6, 3.0, true), ["1", "2"]);
    }

    #[test]
    fn straight_axes_step_evenly() {
        assert_eq!(
            labels(-0.42, 0.41, false),
            ["−0.4", "−0.2", "0.0", "0.2", "0.4"].map(|t| t.replace("0.0", "0"))
        );
    }
}
