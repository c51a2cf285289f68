//! The painter's order: what hides something is drawn after it.
//!
//! Two convex bodies that do not touch hide each other in one way only, the same wherever on the panel both are; so one
//! point where both are decides.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::outline::{area, common, middle};
use super::pieces::{Look, Piece};

/// Common areas smaller than this decide nothing, square pixels.
const SMALLEST: f64 = 0.02;

/// From the back to the front.
pub(super) fn sorted(pieces: Vec<Piece>) -> Vec<Piece> {
    let order = order(&pieces);
    let mut pieces: Vec<_> = pieces.into_iter().map(Some).collect();
    order.into_iter().filter_map(|index| pieces[index].take()).collect()
}

/// Which piece comes first, second, and so on. Where some hide each other in a circle, the farthest comes first.
fn order(pieces: &[Piece]) -> Vec<usize> {
    let (over, mut waits_for) = hidden(pieces);
    let key = |index: usize| Reverse((Ordered(pieces[index].depth), index));
    let mut ready: BinaryHeap<_> = (0..pieces.len()).filter(|&index| waits_for[index] == 0).map(key).collect();
    let mut rest: BinaryHeap<_> = (0..pieces.len()).map(key).collect();
    let mut done = vec![false; pieces.len()];
    let mut order: Vec<usize> = Vec::with_capacity(pieces.len());
    let mut next = None;
    while order.len() < pieces.len() {
        let Some(index) = next.take().or_else(|| ready.pop().or_else(|| rest.pop()).map(|Reverse((_, index))| index))
        else {
            break;
        };
        if std::mem::replace(&mut done[index], true) {
            continue;
        }
        order.push(index);
        for &above in &over[index] {
            waits_for[above] -= 1;
            if waits_for[above] == 0 {
                ready.push(key(above));
            }
        }
        // Where nothing is in the way, a stroke goes on.
        let follows =
            |after: &usize| !done[*after] && waits_for[*after] == 0 && continues(&pieces[index], &pieces[*after]);
        next = Some(index + 1).filter(|after| *after < pieces.len()).filter(follows);
    }
    order
}

/// For each piece what hides it, and by how many it hides others.
fn hidden(pieces: &[Piece]) -> (Vec<Vec<usize>>, Vec<usize>) {
    let bounds: Vec<[f64; 4]> = pieces.iter().map(bounds).collect();
    let mut by_left: Vec<usize> = (0..pieces.len()).collect();
    by_left.sort_by(|&a, &b| bounds[a][0].total_cmp(&bounds[b][0]).then(a.cmp(&b)));
    let (mut over, mut waits_for) = (vec![vec![]; pieces.len()], vec![0_usize; pieces.len()]);
    for (at, &a) in by_left.iter().enumerate() {
        for &b in by_left[at + 1..].iter().take_while(|&&b| bounds[b][0] <= bounds[a][1]) {
            if bounds[a][2] > bounds[b][3] || bounds[b][2] > bounds[a][3] {
                continue;
            }
            if let Some(a_hides) = hides(&pieces[a], &pieces[b], a > b) {
                let (below, above) = if a_hides { (b, a) } else { (a, b) };
                over[below].push(above);
                waits_for[above] += 1;
            }
        }
    }
    (over, waits_for)
}

/// Whether `a` hides a part of `b`, or the other way round, or neither; where both are equally near, `later` decides.
fn hides(a: &Piece, b: &Piece, later: bool) -> Option<bool> {
    if let (Look::Stroke { style: one, .. }, Look::Stroke { style: other, .. }) = (&a.look, &b.look)
        && one == other
    {
        return None;
    }
    let both = common(&a.outline, &b.outline);
    if both.len() < 3 || area(&both) < SMALLEST {
        return None;
    }
    let at = middle(&both);
    let ahead = a.front.nearness(&at) - b.front.nearness(&at);
    Some(if ahead.abs() < 1e-6 { later } else { ahead > 0.0 })
}

fn continues(before: &Piece, after: &Piece) -> bool {
    match (&before.look, &after.look) {
        (Look::Stroke { stroke: a, place: p, .. }, Look::Stroke { stroke: b, place: q, .. }) => a == b && p + 1 == *q,
        _ => false,
    }
}

/// Left, right, top, bottom.
fn bounds(piece: &Piece) -> [f64; 4] {
    let start = [f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY, f64::NEG_INFINITY];
    let grow = |[l, r, t, b]: [f64; 4], p: &nalgebra::Point2<f64>| [l.min(p.x), r.max(p.x), t.min(p.y), b.max(p.y)];
    piece.outline.iter().fold(start, grow)
}

/// Numbers in their order.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Ordered(f64);

impl Eq for Ordered {}

impl PartialOrd for Ordered {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Ordered {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}
