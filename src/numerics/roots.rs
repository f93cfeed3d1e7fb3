//! Bracketed roots of functions of one variable.

/// Finds the root of a continuous `f` between `a` and `b`, where `f(a)` and `f(b)` have opposite signs or one is zero.
///
/// Method: secant steps; a step that does not halve the bracket is followed by a bisection. A root of the size of the bracket takes
/// at most about 120 evaluations; a root much nearer to zero takes two more for every halving of the way there.
/// Accuracy: the bracket shrinks until its ends are neighbouring numbers or `f` vanishes exactly. Of the last two ends the one with
/// the smaller |f| is returned.
/// Degenerate: `None` when the signs are equal or a value is NaN.
pub fn bracketed(mut f: impl FnMut(f64) -> f64, a: f64, b: f64) -> Option<f64> {
    let (mut low, mut high) = (a, b);
    let (mut f_low, mut f_high) = (f(low), f(high));
    if f_low == 0.0 {
        return Some(low);
    }
    if f_high == 0.0 {
        return Some(high);
    }
    if f_low.is_nan() || f_high.is_nan() || (f_low > 0.0) == (f_high > 0.0) {
        return None;
    }
    let mut halve = false;
    loop {
        let middle = low + (high - low) / 2.0;
        if middle == low || middle == high {
            return Some(if f_low.abs() <= f_high.abs() { low } else { high });
        }
        let secant = low - f_low * ((high - low) / (f_high - f_low));
        let inside = (secant - low) * (secant - high) < 0.0;
        let x = if halve || !inside { middle } else { secant };
        let width = (high - low).abs();
        let value = f(x);
        if value == 0.0 {
            return Some(x);
        }
        if value.is_nan() {
            return None;
        }
        if (value > 0.0) == (f_low > 0.0) {
            (low, f_low) = (x, value);
        } else {
            (high, f_high) = (x, value);
        }
        halve = (high - low).abs() > 0.5 * width;
    }
}

/// Largest number of secant steps.
const MOST_SECANTS: usize = 8;

/// Finds the root of a smooth `f` between two places by a few secant steps; the last one is at most `enough`.
///
/// Accuracy: where f bends by little over the bracket, far better than `enough`.
/// Degenerate: `None` where the signs are equal, where a value is 0 or NaN, where a step leaves the bracket, and after eight steps.
fn secant(mut f: impl FnMut(f64) -> f64, [mut last, mut at]: [f64; 2], enough: f64) -> Option<f64> {
    let bounds = [last.min(at), last.max(at)];
    let (mut before, mut value) = (f(last), f(at));
    // False for NaN, too.
    let opposite = before * value < 0.0;
    if !opposite {
        return None;
    }
    for _ in 0..MOST_SECANTS {
        let next = at - value * ((at - last) / (value - before));
        if !(bounds[0] <= next && next <= bounds[1]) {
            return None;
        }
        if (next - at).abs() <= enough {
            return Some(next);
        }
        (last, before) = (at, value);
        (at, value) = (next, f(next));
    }
    None
}

/// Finds, to `enough`, a place between `below`, where `f` < 0, and `above`, where `f` ≥ 0 or NaN, at which the one becomes the other:
/// by secant steps where `f` is smooth, by bisection where it is not. Of several such places it is any one.
///
/// Degenerate: a place next to `below` where `f` is not negative there.
pub fn change(mut f: impl FnMut(f64) -> f64, [below, above]: [f64; 2], enough: f64) -> f64 {
    secant(&mut f, [below, above], enough)
        .unwrap_or_else(|| last_within(|x| f(x) < 0.0, below, above, enough))
}

/// Finds the last number for which `holds` is true, from `on`, where it is true, towards `off`, where it is false. Of several such
/// numbers it is any one.
///
/// Method: bisection until `on` and `off` are neighbouring numbers. Cost: some 60 evaluations for a number of the size of the bracket,
/// and one more for every halving of the way to a number nearer to zero.
/// Degenerate: `on` where the two are equal or neighbours, and where one is NaN.
pub fn last_where(holds: impl FnMut(f64) -> bool, on: f64, off: f64) -> f64 {
    last_within(holds, on, off, 0.0)
}

/// Bisects until `on`, where `holds` is true, and `off`, where it is false, are neighbours or at most `enough` apart, and gives `on`.
fn last_within(mut holds: impl FnMut(f64) -> bool, mut on: f64, mut off: f64, enough: f64) -> f64 {
    loop {
        let middle = on + (off - on) / 2.0;
        if middle == on || middle == off || middle.is_nan() || (off - on).abs() <= enough {
            return on;
        }
        if holds(middle) { on = middle } else { off = middle }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_simple_roots_to_the_last_bit() {
        let root = bracketed(|x| x * x - 2.0, 0.0, 2.0);
        assert!(root.is_some_and(|x| (x - 2f64.sqrt()).abs() <= f64::EPSILON * 2.0));
        let flat = bracketed(|x| (x - 0.3).powi(5), -1.0, 1.0);
        assert!(flat.is_some_and(|x| (x - 0.3).abs() < 1e-10), "{flat:?}");
    }

    #[test]
    fn secants_find_smooth_roots_between_their_ends_alone() {
        let root = secant(|x| x * x - 2.0, [1.2, 1.6], 1e-6);
        assert!(root.is_some_and(|x| (x - 2f64.sqrt()).abs() < 1e-11), "{root:?}");
        assert_eq!(secant(|x| x * x - 2.0, [1.5, 1.6], 1e-6), None);
        assert_eq!(secant(|x| if x < 0.0 { f64::NAN } else { x - 0.5 }, [-1.0, 1.0], 1e-6), None);
        // A step is no root.
        assert_eq!(secant(|x| if x < 0.3 { -1.0 } else { 5.0 }, [0.0, 1.0], 1e-12), None);
    }

    #[test]
    fn ends_that_are_roots_count_and_equal_signs_do_not() {
        assert_eq!(bracketed(|x| x, 0.0, 1.0), Some(0.0));
        assert_eq!(bracketed(|x| x - 1.0, 0.0, 1.0), Some(1.0));
        assert_eq!(bracketed(|x| x * x + 1.0, -1.0, 1.0), None);
        assert_eq!(bracketed(|_| f64::NAN, -1.0, 1.0), None);
    }

    #[test]
    fn changes_of_sign_are_found_at_roots_and_at_steps() {
        let at = |f: fn(f64) -> f64| change(f, [0.0, 1.0], 1e-9);
        assert!((at(|x| x * x - 0.5) - 0.5f64.sqrt()).abs() < 1e-12);
        assert!((at(|x| if x < 0.3 { -1.0 } else { 5.0 }) - 0.3).abs() < 1e-9);
        assert!((at(|x| if x < 0.3 { -1.0 } else { f64::NAN }) - 0.3).abs() < 1e-9);
    }

    #[test]
    fn the_last_number_with_a_property_is_found_from_either_side() {
        assert_eq!(last_where(|x| x <= 0.3, 0.0, 1.0), 0.3);
        assert_eq!(last_where(|x| x >= 0.3, 1.0, 0.0), 0.3);
        assert_eq!(last_where(|_| true, 0.0, f64::NAN), 0.0);
    }
}
