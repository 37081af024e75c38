//! Forces and kicks: docs/port/contract.md, "Forces".

use crate::scene::Scene;
use crate::vector::*;

fn accumulate(force: &mut Vector, part: Vector) {
    *force = add(*force, part);
}

/// Bond by bond, in the order of their numbers, as alone in `bond_force`.
pub fn add_bonds(scene: &Scene, position: &[Point], force: &mut [Vector]) {
    add_bonds_by(|j, r| bond(scene, j, r), scene, position, force);
}

fn add_bonds_by(pull: impl Fn(usize, Vector) -> Vector, scene: &Scene, position: &[Point], force: &mut [Vector]) {
    for j in 0..position.len() {
        if let Some(next) = scene.next[j] {
            let pull = pull(j, between(position[next], position[j]));
            accumulate(&mut force[j], pull);
            accumulate(&mut force[next], pull.map(|x| -x));
        }
    }
}

/// The force on vertex j, whose bond is R. Kinds with l0 = 0 skip the root.
fn bond(scene: &Scene, j: usize, r: Vector) -> Vector {
    if scene.bond_length[j] == 0.0 {
        scale(scene.spring[j], r)
    } else {
        stretched(scene, j, r)
    }
}

/// (k (l - l0)) u
fn stretched(scene: &Scene, j: usize, r: Vector) -> Vector {
    let length = dot(r, r).sqrt();
    let unit = scale(1.0 / length, r);
    scale(scene.spring[j] * (length - scene.bond_length[j]), unit)
}

/// Bends, vertex by vertex, where both bonds exist and kappa is not 0.
pub fn add_bends(scene: &Scene, position: &[Point], force: &mut [Vector]) {
    for j in 0..position.len() {
        if let (Some(prev), Some(next), Some((a, b))) = (scene.prev[j], scene.next[j], bend_at(scene, position, j)) {
            accumulate(&mut force[prev], a);
            accumulate(&mut force[next], b);
            accumulate(&mut force[j], add(a, b).map(|x| -x));
        }
    }
}

/// A and B of the bend of vertex j, if it has one.
fn bend_at(scene: &Scene, position: &[Point], j: usize) -> Option<(Vector, Vector)> {
    let (prev, next) = (scene.prev[j]?, scene.next[j]?);
    if scene.bending[j] == 0.0 {
        return None;
    }
    let before = between(position[j], position[prev]);
    let after = between(position[next], position[j]);
    Some(bend(scene.bending[j], before, after))
}

/// The forces on the vertex before and on the one after.
fn bend(kappa: f64, r0: Vector, r1: Vector) -> (Vector, Vector) {
    let inverse0 = 1.0 / dot(r0, r0).sqrt();
    let inverse1 = 1.0 / dot(r1, r1).sqrt();
    let (u0, u1) = (scale(inverse0, r0), scale(inverse1, r1));
    let c = dot(u0, u1);
    let a = scale(-kappa * inverse0, subtract(u1, scale(c, u0)));
    let b = scale(kappa * inverse1, subtract(u0, scale(c, u1)));
    (a, b)
}

/// The force on one vertex alone, in the order of docs/port/contacts.md, *Forces*.
pub fn on_vertex(scene: &Scene, position: &[Point], j: usize) -> Vector {
    let pull = |first: usize, last: usize| bond(scene, first, between(position[last], position[first]));
    let before = scene.prev[j].map_or([0.0; 3], |prev| pull(prev, j));
    let after = scene.next[j].map_or([0.0; 3], |next| pull(j, next));
    let mut force = add(subtract(scene.constant_force[j], before), after);
    if let Some((_, b)) = scene.prev[j].and_then(|prev| bend_at(scene, position, prev)) {
        accumulate(&mut force, b);
    }
    if let Some((a, b)) = bend_at(scene, position, j) {
        force = subtract(force, add(a, b));
    }
    if let Some((a, _)) = scene.next[j].and_then(|next| bend_at(scene, position, next)) {
        accumulate(&mut force, a);
    }
    force
}

/// The constant force, plus bonds, plus bends. Here kinds with bends take the root, whatever l0.
pub fn all(scene: &Scene, position: &[Point]) -> Vec<Vector> {
    let mut force = scene.constant_force.clone();
    let pull = |j: usize, r: Vector| if scene.bending[j] == 0.0 { bond(scene, j, r) } else { stretched(scene, j, r) };
    add_bonds_by(pull, scene, position, &mut force);
    add_bends(scene, position, &mut force);
    force
}

/// v + (time (1/M)) F
pub fn kick(scene: &Scene, time: f64, velocity: &mut [Vector], force: &[Vector]) {
    for j in 0..velocity.len() {
        velocity[j] = add(velocity[j], scale(time * (1.0 / scene.mass[j]), force[j]));
    }
}
