//! Where two bonds touch, and the impulse: docs/port/contacts.md, *The contact*, *The impulse*.

use crate::vector::*;
use crate::wide;

/// 2^-1000
const TINY: f64 = f64::from_bits((1023 - 1000) << 52);
/// 2^-42
const TOUCHING: f64 = 1.0 / (1u64 << 42) as f64;
const PARALLEL: f64 = 1e-24;

#[derive(Clone, Copy)]
pub struct Contact {
    pub s: f64,
    pub t: f64,
    pub normal: Vector,
}

pub fn levers(s: f64, t: f64) -> [f64; 4] {
    [1.0 - s, s, t - 1.0, -t]
}

fn clamp(x: f64) -> f64 {
    x.clamp(0.0, 1.0)
}

/// s, t and n of bonds p, q a distance w apart, in lattice units. None if they touch already.
pub fn contact([p, q, w]: [Point; 3], velocity: &[Vector; 4]) -> Option<Contact> {
    let side = wide::determinant(p, q, w).sign();
    let [p, q, w] = [p, q, w].map(|difference| scale(UNIT, lattice(difference)));
    let across = cross(p, q);
    let (pp, qq, nn) = (dot(p, p) + TINY, dot(q, q) + TINY, dot(across, across) + TINY);
    let (pq, pw, qw) = (dot(p, q), dot(p, w), dot(q, w));
    let start = clamp((pw * qq - pq * qw) / nn);
    let t = clamp((start * pq - qw) / qq);
    let s = clamp((t * pq + pw) / pp);
    let gap = add(add(w, scale(t, q)), scale(-s, p));
    if side == 0 && dot(gap, gap).sqrt() < TOUCHING {
        return None;
    }
    let parts = levers(s, t);
    let approach = (1..4).fold(scale(parts[0], velocity[0]), |sum, k| add(sum, scale(parts[k], velocity[k])));
    let normal = normal(p, q, gap, approach, side);
    Some(Contact { s, t, normal })
}

/// The unit vector from the first bond to the other. `side` is the sign of the volume.
fn normal(p: Vector, q: Vector, gap: Vector, approach: Vector, side: i32) -> Vector {
    let mut along = cross(p, q);
    let mut speed = dot(along, approach);
    if side < 0 || (side == 0 && speed < 0.0) {
        along = along.map(|x| -x);
        speed = -speed;
    }
    let skew = dot(along, along) > (PARALLEL * dot(p, p)) * dot(q, q);
    if !skew || (side == 0 && !(speed > 0.0)) {
        along = gap;
        if dot(gap, gap) == 0.0 {
            along = add(approach, scale(-dot(approach, q) / dot(q, q), q));
        }
    }
    scale(1.0 / dot(along, along).sqrt(), along)
}

/// Velocities, forces and masses of the four ends.
pub struct Ends {
    pub velocity: [Vector; 4],
    pub force: [Vector; 4],
    pub mass: [f64; 4],
}

#[derive(Clone, Copy, PartialEq)]
pub enum Answer {
    None = 0,
    Full = 1,
    Softened = 2,
}

/// The answer and the momentum; changes the four velocities.
pub fn impulse(ends: &mut Ends, s: f64, t: f64, normal: Vector, tau: f64) -> (Answer, f64) {
    let levers = levers(s, t);
    let (mut approach, mut forces, mut inertia) = (0.0, 0.0, 0.0);
    for k in 0..4 {
        let inverse = 1.0 / ends.mass[k];
        approach += levers[k] * dot(ends.velocity[k], normal);
        forces += levers[k] * (dot(ends.force[k], normal) * inverse);
        inertia += (levers[k] * levers[k]) * inverse;
    }
    if !(approach > 0.0) {
        return (Answer::None, 0.0);
    }
    let (answer, rebound) = rebound(approach, tau * forces);
    let momentum = (approach + rebound) / inertia;
    for k in 0..4 {
        let change = scale((-levers[k] * momentum) * (1.0 / ends.mass[k]), normal);
        ends.velocity[k] = add(ends.velocity[k], change);
    }
    (answer, momentum)
}

/// a', softened beyond a fifth and five times of a.
fn rebound(a: f64, h: f64) -> (Answer, f64) {
    let full = a + 2.0 * h;
    if full < 0.2 * a {
        (Answer::Softened, (a * h.abs()) / (h.abs() + 1.6 * a))
    } else if 0.2 * full > a {
        (Answer::Softened, (a * h.abs()) / (h.abs() - 1.6 * a))
    } else {
        (Answer::Full, full)
    }
}
