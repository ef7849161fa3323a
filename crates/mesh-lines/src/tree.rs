//! A tree of boxes, over triangles and over pieces of lines.

use glam::{DVec3, Vec3, Vec3A};
use std::ops::ControlFlow;

/// No more leaves than these are looked through one by one.
const LEAF: usize = 4;
/// In how many slices a box is cut to find where it is split best.
const SLICES: usize = 12;

/// A box whose sides are along the axes. Its corners are such that all three axes are compared at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Box3 {
    pub(crate) low: Vec3A,
    pub(crate) high: Vec3A,
}

impl Box3 {
    pub(crate) const EMPTY: Self = Self {
        low: Vec3A::INFINITY,
        high: Vec3A::NEG_INFINITY,
    };

    pub(crate) fn of(points: impl IntoIterator<Item = Vec3>) -> Self {
        let points = points.into_iter().map(Vec3A::from);
        points.fold(Self::EMPTY, |all, point| Self {
            low: all.low.min(point),
            high: all.high.max(point),
        })
    }

    fn with(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    pub(crate) fn overlaps(&self, other: &Self) -> bool {
        self.low.cmple(other.high).all() && other.low.cmple(self.high).all()
    }

    /// Half the surface; f64, since that of a huge box is beyond f32.
    fn half_area(&self) -> f64 {
        let size = (self.high.as_dvec3() - self.low.as_dvec3()).max(DVec3::ZERO);
        size.x * size.y + size.y * size.z + size.z * size.x
    }

    fn center(&self) -> DVec3 {
        (self.low.as_dvec3() + self.high.as_dvec3()) / 2.0
    }
}

#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Box3,
    /// Of a leaf the first of its items in `order`; else the second child (the first one is the next node).
    at: u32,
    /// How many items a leaf has; 0 for the others.
    items: u32,
}

/// A tree of boxes, split where that is cheapest (the surface area heuristic, binned: Wald, *On fast construction of SAH-based bounding volume
/// hierarchies*, 2007).
#[derive(Clone, Debug, Default)]
pub(crate) struct Tree {
    nodes: Vec<Node>,
    order: Vec<u32>,
}

impl Tree {
    /// A tree over the boxes of items, which are named by their place in the list.
    pub(crate) fn new(boxes: &[Box3]) -> Self {
        let mut tree = Self {
            nodes: Vec::with_capacity(boxes.len()),
            order: (0..boxes.len() as u32).collect(),
        };
        if boxes.is_empty() {
            return tree;
        }
        let centers: Vec<Vec3> = boxes.iter().map(|b| b.center().as_vec3()).collect();
        let mut order = std::mem::take(&mut tree.order);
        // Ranges still to be made, and the node whose second child each is.
        let mut open = vec![(0..boxes.len(), None)];
        while let Some((range, parent)) = open.pop() {
            let number = tree.nodes.len() as u32;
            if let Some(parent) = parent {
                let parent: &mut Node = &mut tree.nodes[parent as usize];
                parent.at = number;
            }
            let items = &mut order[range.clone()];
            let bounds = items
                .iter()
                .fold(Box3::EMPTY, |all, &i| all.with(boxes[i as usize]));
            let split = if items.len() > LEAF {
                split(items, boxes, &centers)
            } else {
                items.len()
            };
            let is_leaf = split == items.len();
            tree.nodes.push(Node {
                bounds,
                at: range.start as u32,
                items: if is_leaf { items.len() as u32 } else { 0 },
            });
            if !is_leaf {
                let middle = range.start + split;
                open.push((middle..range.end, Some(number)));
                open.push((range.start..middle, None));
            }
        }
        tree.order = order;
        tree
    }

    /// The box around all.
    pub(crate) fn bounds(&self) -> Option<Box3> {
        self.nodes.first().map(|root| root.bounds)
    }

    /// Fits the tree to items that have moved. As fast as reading them; the tree gets slower to ask where they have changed places.
    pub(crate) fn refit(&mut self, box_of: impl Fn(u32) -> Box3) {
        for number in (0..self.nodes.len()).rev() {
            let node = self.nodes[number];
            self.nodes[number].bounds = if node.items > 0 {
                self.items(&node)
                    .iter()
                    .fold(Box3::EMPTY, |all, &i| all.with(box_of(i)))
            } else {
                self.nodes[number + 1]
                    .bounds
                    .with(self.nodes[node.at as usize].bounds)
            };
        }
    }

    /// Visits the items of all leaves whose boxes, and those around them, are `wanted`, until told to stop.
    pub(crate) fn visit(
        &self,
        mut wanted: impl FnMut(&Box3) -> bool,
        mut item: impl FnMut(u32) -> ControlFlow<()>,
    ) {
        // A tree's depth is seldom beyond 64, and where it is the list grows.
        let mut open = Vec::with_capacity(64);
        if !self.nodes.is_empty() {
            open.push(0);
        }
        while let Some(number) = open.pop() {
            let node = &self.nodes[number as usize];
            if !wanted(&node.bounds) {
                continue;
            }
            if node.items == 0 {
                open.extend([node.at, number + 1]);
            } else if self
                .items(node)
                .iter()
                .try_for_each(|&i| item(i))
                .is_break()
            {
                return;
            }
        }
    }

    fn items(&self, leaf: &Node) -> &[u32] {
        &self.order[leaf.at as usize..(leaf.at + leaf.items) as usize]
    }
}

/// Sorts items into two parts, and says how many are in the first.
fn split(items: &mut [u32], boxes: &[Box3], centers: &[Vec3]) -> usize {
    let around = Box3::of(items.iter().map(|&i| centers[i as usize]));
    let size = around.high.as_dvec3() - around.low.as_dvec3();
    let axis = size.max_position();
    if size[axis] <= 0.0 {
        // All in one place: halves keep the tree flat.
        return items.len() / 2;
    }
    let low = f64::from(around.low[axis]);
    let slice = |i: u32| {
        let share = (f64::from(centers[i as usize][axis]) - low) / size[axis];
        ((share * SLICES as f64) as usize).min(SLICES - 1)
    };
    let mut slices = [(Box3::EMPTY, 0usize); SLICES];
    for &i in &*items {
        let (bounds, count) = &mut slices[slice(i)];
        *bounds = bounds.with(boxes[i as usize]);
        *count += 1;
    }
    let firsts = costs(slices.iter());
    let lasts = costs(slices.iter().rev());
    // The first and the last slice have an item each: there is always a finite cost.
    let cut = (1..SLICES)
        .map(|cut| (firsts[cut - 1] + lasts[SLICES - cut - 1], cut))
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .map_or(1, |(_, cut)| cut);
    // In place, the first part's items to the front.
    let mut first = 0;
    for next in 0..items.len() {
        if slice(items[next]) < cut {
            items.swap(first, next);
            first += 1;
        }
    }
    first
}

/// What a part of the first slice costs, of the first two, and so on.
fn costs<'s>(slices: impl Iterator<Item = &'s (Box3, usize)>) -> [f64; SLICES] {
    let (mut bounds, mut count) = (Box3::EMPTY, 0);
    let mut costs = [f64::INFINITY; SLICES];
    for (cost, slice) in costs.iter_mut().zip(slices) {
        bounds = bounds.with(slice.0);
        count += slice.1;
        if count > 0 {
            *cost = bounds.half_area() * count as f64;
        }
    }
    costs
}
