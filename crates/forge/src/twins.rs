//! The twins a table is optimized and judged on: those next to α.
//!
//! The twins of a map lie on the interval of α on which its thresholds keep their order. For small
//! maps this interval is wide, and a twin far from α has another density and other frequencies. So
//! of the twins with the same side t only the two fractions around α are considered. Maps of useful
//! size have no other twins of moderate size.

use strew_core::{Alpha, Map, Twin};

/// The largest side t of a twin that is considered: 17 million points.
const MAX_SIDE: u64 = 4096;

/// Returns the twins of a map next to its α, smallest first, up to [`MAX_SIDE`]. An α that is a
/// fraction of small integers may have none: some of its thresholds coincide, those of twins do
/// not.
pub(crate) fn next_to_alpha(map: &Map) -> impl Iterator<Item = Twin> {
    let excess = map.alpha().to_f64() - 1.0;
    (1..=MAX_SIDE).flat_map(move |t| {
        let q = (t as f64 / excess) as u64;
        [q, q + 1]
            .into_iter()
            .filter_map(move |q| Twin::new(t + q, q))
            .filter(|&twin| map.has_twin(twin) && map_of_twin(map, twin).is_some())
    })
}

/// The least number of points of a large twin. In smaller ones a ring holds so few Bragg peaks that
/// its mean power shows their speckle.
pub(crate) const LARGE_TWIN: u64 = 65_000;
/// The number of large twins that the farthest are chosen from: for the default map, all of up to
/// 200,000 points. Larger ones hardly lie farther out.
const LARGE_TWINS: usize = 40;

/// Returns the large twins of a map with the least and the greatest α.
pub(crate) fn farthest(map: &Map) -> Option<[Twin; 2]> {
    let large = next_to_alpha(map).filter(|twin| twin.points() >= LARGE_TWIN);
    let twins: Vec<Twin> = large.take(LARGE_TWINS).collect();
    let least = twins
        .iter()
        .min_by(|a, b| fraction(a).total_cmp(&fraction(b)))?;
    let greatest = twins
        .iter()
        .max_by(|a, b| fraction(a).total_cmp(&fraction(b)))?;
    Some([*least, *greatest])
}

/// The nearest to α of the twins from [`LARGE_TWIN`] to some number of points.
pub(crate) fn nearest(map: &Map, most: u64) -> Option<Twin> {
    let alpha = map.alpha().to_f64();
    let twins = next_to_alpha(map).take_while(|twin| twin.points() <= most);
    let large = twins.filter(|twin| twin.points() >= LARGE_TWIN);
    let far = |twin: &Twin| (fraction(twin) - alpha).abs();
    large.min_by(|a, b| far(a).total_cmp(&far(b)))
}

/// The α of a twin, p/q.
pub(crate) fn fraction(twin: &Twin) -> f64 {
    twin.p() as f64 / twin.q() as f64
}

/// The map at the α of a twin, or `None` if it has other intervals.
pub(crate) fn map_of_twin(map: &Map, twin: Twin) -> Option<Map> {
    let alpha = Alpha::from_fraction(twin.p(), twin.q()).ok()?;
    let same = |found: &Map| found.intervals() == map.intervals();
    Map::new(alpha, map.radius()).ok().filter(same)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maps_of_useful_size_have_no_other_twins() {
        for alpha in ["(5-sqrt(3))/2", "sqrt(3)", "(1+sqrt(5))/2"] {
            let map = Map::new(alpha.parse().expect("valid"), 49).expect("small");
            let all: Vec<Twin> = map.twins().take(60).collect();
            let found: Vec<Twin> = next_to_alpha(&map).take(60).collect();
            assert_eq!(found, all, "{alpha}");
        }
    }

    #[test]
    fn they_are_near_alpha_and_finitely_many() {
        for (alpha, radius) in [("1.1", 1), ("1.95", 1), ("sqrt(2)", 3), ("3/2", 4)] {
            let map = Map::new(alpha.parse().expect("valid"), radius).expect("small");
            for twin in next_to_alpha(&map)
                .skip_while(|twin| twin.points() < 4000)
                .take(50)
            {
                let fraction = twin.p() as f64 / twin.q() as f64;
                assert!(
                    (fraction - map.alpha().to_f64()).abs() < 0.02,
                    "{alpha} {twin}"
                );
                let finer = map_of_twin(&map, twin).expect("the same map");
                assert_eq!(finer.intervals(), map.intervals());
            }
        }
        let tied = Map::new("3/2".parse().expect("valid"), 4).expect("small");
        assert_eq!(next_to_alpha(&tied).filter(|t| t.points() > 1).count(), 0);
    }
}
