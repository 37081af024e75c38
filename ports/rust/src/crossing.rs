//! One crossing test and one exchange of momentum:
//! docs/conventions.md, "The crossing test"; docs/port/contract.md, "Sweep".

use crate::vector::*;
use crate::wide;

/// The points of one test. `flip`: the moving vertex is the first of its bond.
#[derive(Clone, Copy)]
pub struct Test {
    pub from: Point,
    pub to: Point,
    pub pivot: Point,
    pub a: Point,
    pub b: Point,
    pub flip: bool,
}

#[derive(Clone, Copy, Default)]
pub struct Hit {
    pub time: f64,
    pub s: f64,
    pub s_standing: f64,
    pub normal: Vector,
}

/// (p x q).r of lattice differences, in doubles, or rounded from the exact integer.
fn determinant(p: Point, q: Point, r: Point) -> f64 {
    let (pd, qd, rd) = (lattice(p), lattice(q), lattice(r));
    let minor = |i: usize, j: usize| pd[i] * qd[j] - pd[j] * qd[i];
    let size_of = |i: usize, j: usize| (pd[i] * qd[j]).abs() + (pd[j] * qd[i]).abs();
    let value = rd[0] * minor(1, 2) + rd[1] * minor(2, 0) + rd[2] * minor(0, 1);
    let size = rd[0].abs() * size_of(1, 2) + rd[1].abs() * size_of(2, 0) + rd[2].abs() * size_of(0, 1);
    if value.abs() > 16.0 / (1u64 << 53) as f64 * size {
        value
    } else {
        exact(p, q, r)
    }
}

/// The exact determinant, rounded.
fn exact(p: Point, q: Point, r: Point) -> f64 {
    let value = wide::determinant(p, q, r);
    rounded(value.high, value.low)
}

/// The size is rounded: all above the low 64 bits first, then the sum.
fn rounded(high: i128, low: u64) -> f64 {
    const WORD: f64 = (1u128 << 64) as f64;
    if high >= 0 {
        high as f64 * WORD + low as f64
    } else {
        // -(high * 2^64 + low)
        let (rest, borrow) = (low.wrapping_neg(), i128::from(low != 0));
        -((-high - borrow) as f64 * WORD + rest as f64)
    }
}

/// The three conditions. A determinant of zero counts as positive, but for `flip` in condition 1.
/// The two volumes of condition 1, if the bonds cross.
fn volumes(test: &Test) -> Option<(f64, f64)> {
    let bond = difference(test.b, test.a);
    let pivot = difference(test.pivot, test.a);
    let (from, to) = (difference(test.from, test.a), difference(test.to, test.a));
    let negative = |volume: f64| volume < 0.0 || (test.flip && volume == 0.0);
    let before = determinant(bond, pivot, from);
    let after = determinant(bond, pivot, to);
    if negative(before) == negative(after) {
        return None;
    }
    if (determinant(bond, from, to) < 0.0) != negative(before) {
        return None;
    }
    let step = difference(test.to, test.from);
    let moving = difference(test.pivot, test.from);
    let side = |point: Point| determinant(step, moving, difference(point, test.from)) < 0.0;
    if side(test.a) == side(test.b) {
        return None;
    }
    Some((before, after))
}

fn clamp(x: f64) -> f64 {
    x.clamp(0.0, 1.0)
}

/// t_I, s, s' and n, if the test finds a crossing.
pub fn cross_bonds(test: &Test) -> Option<Hit> {
    let (before, after) = volumes(test)?;
    let time = clamp(before / (before - after));
    let step = between(test.to, test.from);
    let at = add(between(test.from, test.a), scale(time, step));
    let p = subtract(between(test.pivot, test.a), at);
    let q = between(test.b, test.a);
    let (a, b, c, d, e) = (dot(p, p), dot(p, q), dot(q, q), dot(p, at), dot(q, at));
    let denominator = a * c - b * b;
    let (mut s, mut s_standing) = (0.5, 0.5);
    if denominator > 0.0 {
        s = (b * e - c * d) / denominator;
        s_standing = (a * e - b * d) / denominator;
    }
    Some(Hit { time, s: clamp(s), s_standing: clamp(s_standing), normal: normal(p, q, step) })
}

/// The unit vector along p x q that points in the direction in which the vertex moves.
fn normal(p: Vector, q: Vector, step: Vector) -> Vector {
    let mut along = cross(p, q);
    if along == [0.0; 3] {
        along = subtract(step, scale(dot(step, q) / dot(q, q), q));
    }
    let unit = scale(1.0 / dot(along, along).sqrt(), along);
    if dot(unit, step) < 0.0 {
        unit.map(|x| -x)
    } else {
        unit
    }
}

/// Velocities and masses of moving vertex, pivot, a, b.
pub struct Four {
    pub velocity: [Vector; 4],
    pub mass: [f64; 4],
}

/// The momentum of a hit; changes the four velocities.
pub fn exchange(four: &mut Four, s: f64, s_standing: f64, normal: Vector) -> f64 {
    let levers = [1.0 - s, s, s_standing - 1.0, -s_standing];
    let (mut approach, mut inertia) = (0.0, 0.0);
    for k in 0..4 {
        approach += levers[k] * dot(four.velocity[k], normal);
        inertia += (levers[k] * levers[k]) * (1.0 / four.mass[k]);
    }
    let momentum = 2.0 * approach / inertia;
    for k in 0..4 {
        let change = scale((levers[k] * momentum) * (1.0 / four.mass[k]), normal);
        four.velocity[k] = subtract(four.velocity[k], change);
    }
    momentum
}
