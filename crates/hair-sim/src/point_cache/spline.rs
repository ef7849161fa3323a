//! Keyframes joined by a spline.

/// The keys that decide the spline at `time`, by their indices, with weights that add up to 1.
///
/// The spline is Hermite's cubic through `count` keys at increasing times, 1 or more, with the slopes of the
/// neighbours (Catmull and Rom's). It rests at both ends, and stays there before the first key and after
/// the last. It rests, too, at keys that are held: those of which `is_held` says, by the earlier one's index, that the next one is the same. With the
/// neighbours' slopes it would go on beyond them and come back in between.
#[must_use]
pub fn key_weights(
    count: usize,
    time_of: impl Fn(usize) -> f64,
    is_held: impl Fn(usize) -> bool,
    time: f64,
) -> [(usize, f64); 4] {
    let next = (0..count).find(|&key| time_of(key) > time).unwrap_or(count);
    if next == 0 || next == count {
        let end = next.saturating_sub(1);
        return [(end, 1.0), (end, 0.0), (end, 0.0), (end, 0.0)];
    }
    let [a, b] = [next - 1, next];
    let seconds = time_of(b) - time_of(a);
    let t = (time - time_of(a)) / seconds;
    let (t2, t3) = (t * t, t * t * t);
    let slope_a = seconds * (t3 - 2.0 * t2 + t);
    let slope_b = seconds * (t3 - t2);
    let (mut at_a, mut at_b) = (2.0 * t3 - 3.0 * t2 + 1.0, 3.0 * t2 - 2.0 * t3);
    let (mut before, mut after) = ((a, 0.0), (b, 0.0));
    if a > 0 && !is_held(a - 1) && !is_held(a) {
        let share = slope_a / (time_of(b) - time_of(a - 1));
        before = (a - 1, -share);
        at_b += share;
    }
    if b + 1 < count && !is_held(a) && !is_held(b) {
        let share = slope_b / (time_of(b + 1) - time_of(a));
        after = (b + 1, share);
        at_a -= share;
    }
    [before, (a, at_a), (b, at_b), after]
}

#[cfg(test)]
mod tests {
    use super::*;

    const TIMES: [f64; 4] = [0.0, 1.0, 1.5, 3.0];

    fn at(keys: [f64; 4], time: f64) -> f64 {
        let weights = key_weights(4, |key| TIMES[key], |_| false, time);
        weights
            .iter()
            .map(|(key, weight)| keys[*key] * weight)
            .sum()
    }

    #[test]
    fn keys_are_passed_through_without_a_corner() {
        let keys = [2.0, -1.0, 5.0, 0.5];
        for (key, time) in keys.iter().zip(TIMES) {
            assert!((at(keys, time) - key).abs() < 1e-12);
        }
        for time in TIMES {
            let slopes = [-1e-6, 1e-6].map(|step| (at(keys, time + step) - at(keys, time)) / step);
            assert!((slopes[0] - slopes[1]).abs() < 1e-4, "{time}: {slopes:?}");
        }
        assert_eq!((at(keys, -7.0), at(keys, 9.0)), (2.0, 0.5));
    }

    #[test]
    fn what_is_held_stays() {
        let keys = [2.0, 5.0, 5.0, 0.5];
        let at = |time: f64| {
            let is_held = |key: usize| keys[key] == keys[key + 1];
            let weights = key_weights(4, |key| TIMES[key], is_held, time);
            let sum = weights
                .iter()
                .map(|(key, weight)| keys[*key] * weight)
                .sum::<f64>();
            // Never beyond the keys on both sides.
            assert!((0.5 - 1e-12..=5.0 + 1e-12).contains(&sum), "{time}: {sum}");
            sum
        };
        for i in 0..=300 {
            let time = 0.01 * f64::from(i);
            let now = at(time);
            if (1.0..=1.5).contains(&time) {
                assert!((now - 5.0).abs() < 1e-12, "{time}: {now}");
            }
        }
        for time in TIMES {
            let slopes = [-1e-6, 1e-6].map(|step| (at(time + step) - at(time)) / step);
            assert!(
                slopes.iter().all(|slope| slope.abs() < 1e-4),
                "{time}: {slopes:?}"
            );
        }
    }

    #[test]
    fn weights_add_up_to_one_and_a_straight_way_stays_straight() {
        for i in 0..=60 {
            let time = f64::from(i) * 0.05;
            let sum: f64 = key_weights(4, |key| TIMES[key], |_| false, time)
                .iter()
                .map(|(_, w)| w)
                .sum();
            assert!((sum - 1.0).abs() < 1e-12);
            // Between inner keys, where slopes are the neighbours', a straight way in time is kept.
            if (1.0..=1.5).contains(&time) {
                assert!((at(TIMES, time) - time).abs() < 1e-12, "{time}");
            }
        }
    }
}
