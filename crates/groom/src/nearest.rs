//! Nearest points: a k-d tree in any number of dimensions.

/// Points ordered so that each half of a range lies on one side of its middle point.
///
/// Answers do not depend on the order of equal distances: ties go to the lower index.
#[derive(Clone, Debug)]
pub(crate) struct Nearest<const D: usize> {
    nodes: Vec<Node<D>>,
}

#[derive(Clone, Debug)]
struct Node<const D: usize> {
    point: [f64; D],
    /// The point's index in the list the tree was made from.
    index: usize,
    /// The axis along which the range of this middle point is halved.
    axis: usize,
}

/// A point that was found: its squared distance and its index. Nearer ones are less.
pub(crate) type Found = (f64, usize);

impl<const D: usize> Nearest<D> {
    /// A tree of finite points.
    pub(crate) fn new(points: impl IntoIterator<Item = [f64; D]>) -> Self {
        let node = |(index, point)| Node {
            point,
            index,
            axis: 0,
        };
        let mut nodes: Vec<_> = points.into_iter().enumerate().map(node).collect();
        halve(&mut nodes);
        Self { nodes }
    }

    /// Puts the `count` points nearest to `from` into `found`, nearest first; fewer where there are
    /// fewer.
    ///
    /// What `found` holds already counts as found: points known to be near spare looking at others.
    /// They must be points of this tree, at their distance, none of them twice or more than `count`.
    pub(crate) fn find(&self, from: &[f64; D], count: usize, found: &mut Vec<Found>) {
        if count > 0 {
            search(&self.nodes, from, count, found);
        }
    }
}

/// The squared distance between two points.
pub(crate) fn distance_squared<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
}

fn halve<const D: usize>(nodes: &mut [Node<D>]) {
    if nodes.len() > 1 {
        let axis = widest_axis(nodes);
        let middle = nodes.len() / 2;
        let (low, node, high) = nodes.select_nth_unstable_by(middle, |a, b| {
            a.point[axis]
                .total_cmp(&b.point[axis])
                .then(a.index.cmp(&b.index))
        });
        node.axis = axis;
        halve(low);
        halve(high);
    }
}

fn widest_axis<const D: usize>(nodes: &[Node<D>]) -> usize {
    let mut low = [f64::INFINITY; D];
    let mut high = [f64::NEG_INFINITY; D];
    for node in nodes {
        for axis in 0..D {
            low[axis] = low[axis].min(node.point[axis]);
            high[axis] = high[axis].max(node.point[axis]);
        }
    }
    (1..D).fold(0, |widest, axis| {
        let is_wider = high[axis] - low[axis] > high[widest] - low[widest];
        if is_wider { axis } else { widest }
    })
}

fn search<const D: usize>(
    nodes: &[Node<D>],
    from: &[f64; D],
    count: usize,
    found: &mut Vec<Found>,
) {
    if nodes.is_empty() {
        return;
    }
    let middle = nodes.len() / 2;
    let Node { point, index, axis } = &nodes[middle];
    let here = (distance_squared(point, from), *index);
    let place = found.partition_point(|f| *f < here);
    if place < count && found.get(place) != Some(&here) {
        found.insert(place, here);
        found.truncate(count);
    }
    let (low, high) = (&nodes[..middle], &nodes[middle + 1..]);
    let across = from[*axis] - point[*axis];
    let (near, far) = if across < 0.0 {
        (low, high)
    } else {
        (high, low)
    };
    search(near, from, count, found);
    // Equal distances are looked at too: a lower index may be there.
    if found.len() < count || across * across <= found[found.len() - 1].0 {
        search(far, from, count, found);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn finds_what_looking_at_all_points_finds(
            points in prop::collection::vec(prop::array::uniform4(-4i8..4), 0..80),
            from in prop::array::uniform4(-5.0f64..5.0), count in 0usize..8, known in 0usize..80,
        ) {
            let points: Vec<[f64; 4]> = points.iter().map(|p| p.map(f64::from)).collect();
            let found = |i: usize| (distance_squared(&points[i], &from), i);
            let mut all: Vec<Found> = (0..points.len()).map(found).collect();
            all.sort_by(|a, b| a.partial_cmp(b).unwrap());
            all.truncate(count);
            let tree = Nearest::new(points.iter().copied());
            let mut nearest = Vec::new();
            tree.find(&from, count, &mut nearest);
            prop_assert_eq!(&nearest, &all);
            if known < points.len() && count > 0 {
                let mut nearest = vec![found(known)];
                tree.find(&from, count, &mut nearest);
                prop_assert_eq!(&nearest, &all);
            }
        }
    }
}
