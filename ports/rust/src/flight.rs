//! When two bonds in flight may touch, in integers: docs/port/contacts.md, *The search*.

use crate::vector::*;
use crate::wide::{self, along, determinant, Wide, ZERO};

/// Ticks of a drift; the answer of a search without a contact.
pub const TICKS: i64 = 65536;

/// p, q and w at tick 0, and what they change by in a tick.
#[derive(Clone, Copy)]
pub struct Flight {
    pub place: [Point; 3],
    pub rate: [Point; 3],
}

fn plus(a: Point, b: Point) -> Point {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// Where a point is at a tick.
pub fn at(place: Point, rate: Point, tick: i64) -> Point {
    [0, 1, 2].map(|axis| place[axis] + tick * rate[axis])
}

/// w + t q - s p at the corners of the square of s and t.
fn corners([p, q, w]: [Point; 3]) -> [Point; 4] {
    let before = difference(w, p);
    [w, plus(w, q), before, plus(before, q)]
}

impl Flight {
    pub fn at(&self, tick: i64) -> [Point; 3] {
        [0, 1, 2].map(|k| at(self.place[k], self.rate[k], tick))
    }

    fn hull(&self, from: i64, to: i64) -> [Point; 8] {
        let (a, b) = (corners(self.at(from)), corners(self.at(to)));
        [a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3]]
    }

    pub fn is_rigid(&self) -> bool {
        self.rate == [[0; 3]; 3]
    }

    /// The least and the largest coordinate along each axis, from a tick to the end of the drift.
    pub fn bounds(&self, from: i64) -> [(i64, i64); 3] {
        let points = self.hull(from, TICKS);
        [0, 1, 2].map(|axis| {
            let of_axis = || points.iter().map(|point| point[axis]);
            (of_axis().min().unwrap(), of_axis().max().unwrap())
        })
    }

    /// The first tick from `from` that is not excluded.
    pub fn search(&self, from: i64) -> i64 {
        if self.is_rigid() || from >= TICKS {
            return TICKS;
        }
        self.first(from, TICKS).unwrap_or(TICKS)
    }

    /// Intervals are halved until one is excluded or is a single tick.
    fn first(&self, from: i64, to: i64) -> Option<i64> {
        if self.excluded(from, to) {
            return None;
        }
        if to - from == 1 {
            return Some(from);
        }
        let middle = (from + to) / 2;
        self.first(from, middle).or_else(|| self.first(middle, to))
    }

    fn excluded(&self, from: i64, to: i64) -> bool {
        let points = self.hull(from, to);
        beside_an_axis(&points) || keeps_its_sign(self.at(from), self.at(to)) || has_plane(&points)
    }
}

/// Condition (ii) for the planes across the three axes.
fn beside_an_axis(points: &[Point; 8]) -> bool {
    (0..3).any(|axis| points.iter().all(|point| point[axis] > 0) || points.iter().all(|point| point[axis] < 0))
}

/// Condition (i).
fn keeps_its_sign([p, q, w]: [Point; 3], [p1, q1, w1]: [Point; 3]) -> bool {
    let sum = |a: Wide, b: Wide, c: Wide| a + b + c;
    let coefficients = [
        determinant(p, q, w),
        sum(determinant(p1, q, w), determinant(p, q1, w), determinant(p, q, w1)),
        sum(determinant(p1, q1, w), determinant(p1, q, w1), determinant(p, q1, w1)),
        determinant(p1, q1, w1),
    ];
    coefficients.iter().all(|c| *c > ZERO) || coefficients.iter().all(|c| *c < ZERO)
}

fn dot_exact(a: Point, b: Point) -> i128 {
    (0..3).map(|axis| i128::from(a[axis]) * i128::from(b[axis])).sum()
}

/// Condition (ii), by the planes through pairs of points.
fn has_plane(points: &[Point; 8]) -> bool {
    let mut one_line = true;
    for a in 0..8 {
        for b in a + 1..8 {
            let n = wide::cross(points[a], points[b]);
            if n == [0; 3] {
                continue;
            }
            one_line = false;
            if let Some(inside) = supported(points, n) {
                return on_one_side(&inside, n);
            }
        }
    }
    one_line && points.iter().all(|c| dot_exact(points[0], *c) > 0)
}

/// If no two points lie strictly on different sides of the plane: those within it.
fn supported(points: &[Point; 8], n: [i128; 3]) -> Option<Vec<Point>> {
    let mut inside = Vec::new();
    let mut side = 0;
    for point in points {
        let sign = along(n, *point).sign();
        if sign == 0 {
            inside.push(*point);
        } else if side == -sign {
            return None;
        } else {
            side = sign;
        }
    }
    Some(inside)
}

/// The points of a plane lie strictly on one side of a line through the origin. (d x c).n has more than 192 bits; d x c
/// is along n, so the signs of one component decide.
fn on_one_side(points: &[Point], n: [i128; 3]) -> bool {
    let axis = (0..3).find(|&axis| n[axis] != 0).unwrap();
    let follows = |d: Point, c: Point| {
        let turn = wide::cross(d, c)[axis].signum() * n[axis].signum();
        turn > 0 || (turn == 0 && dot_exact(d, c) > 0)
    };
    (0..points.len()).any(|d| (0..points.len()).all(|c| c == d || follows(points[d], points[c])))
}
