//! Finds grooves, and so the part of a grooved rail, a crossing or a guarded rail on which wheels run.

/// Least depth \[mm\] of a groove below both its tops. Flangeways are at least 38 mm deep; hollow crowns, worn ones too,
/// are less than 5 mm deep.
const LEAST_DEPTH: f64 = 10.0;

/// Returns the index of the bottom of the last groove in a profile's heights \[mm\], which are in order of x. Returns
/// `None` for a single head. On the right of it is the head on which wheels run; on the left is a keeper, check rail or
/// wing rail, which may be higher than the head.
///
/// Cost: one pass.
pub fn last_groove(heights: &[f64]) -> Option<usize> {
    let mut top = f64::NEG_INFINITY;
    let mut bottom = (heights.len(), f64::INFINITY);
    for (k, &height) in heights.iter().enumerate().rev() {
        if top - bottom.1 >= LEAST_DEPTH && height - bottom.1 >= LEAST_DEPTH {
            return Some(bottom.0);
        }
        if height > top {
            (top, bottom) = (height, (k, height));
        } else if height < bottom.1 {
            bottom = (k, height);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_running_head_is_right_of_the_groove_however_high_the_keeper() {
        for keeper in [-9.0, -2.0, 6.0, 40.0] {
            let heights = [-30.0, keeper, keeper, -47.0, -46.0, -1.0, 0.0, -1.0, -30.0];
            assert_eq!(last_groove(&heights), Some(3), "{keeper}");
        }
        // A hollow crown, a single head, a step down to a plate, and a wall at the field side.
        for single in [&[-30.0, -1.0, -4.0, 0.0, -30.0][..], &[-30.0, 0.0, -30.0], &[-30.0, 0.0, -20.0], &[]]
        {
            assert_eq!(last_groove(single), None, "{single:?}");
        }
    }
}
