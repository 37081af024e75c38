//! Moves of all vertices, one at a time: docs/port/contract.md, "Sweep".

use crate::crossing::{cross_bonds, exchange, Four, Hit, Test};
use crate::scene::Scene;
use crate::vector::*;

/// One crossing that a move found.
#[derive(Clone, Copy)]
pub struct Event {
    pub vertex: usize,
    pub moving: usize,
    pub standing: usize,
    pub image: [i64; 3],
    pub executed: bool,
    pub hit: Hit,
    pub momentum: f64,
}

/// The moving bond: its number, the vertex that stands still, and whether the moving vertex is its first.
#[derive(Clone, Copy)]
struct Bond {
    number: usize,
    pivot: usize,
    flip: bool,
}

/// The bonds of a vertex, the smaller way round first.
fn bonds_of(scene: &Scene, vertex: usize) -> Vec<Bond> {
    let before = scene.prev[vertex].map(|pivot| Bond { number: pivot, pivot, flip: false });
    let after = scene.next[vertex].map(|pivot| Bond { number: vertex, pivot, flip: true });
    before.into_iter().chain(after).collect()
}

pub fn trial(position: Point, velocity: Vector, time: f64) -> Point {
    let step = |axis: usize| position[axis] + round((time * velocity[axis]) * PER_CELL);
    [step(0), step(1), step(2)]
}

/// Moves all vertices in `order`. Events in the order of the moves.
pub fn sweep(scene: &Scene, time: f64, order: &[usize], r: &mut [Point], v: &mut [Vector]) -> Vec<Event> {
    let mut events = Vec::new();
    for &vertex in order {
        let to = trial(r[vertex], v[vertex], time);
        let mut hits = if scene.forbidden { hits_of(scene, vertex, to, r) } else { Vec::new() };
        if hits.is_empty() {
            r[vertex] = to;
        } else {
            hits.sort_by(first_in_time);
            execute(scene, &mut hits[0], v);
            events.extend(hits);
        }
    }
    events
}

/// The order of hits of one move: time, then moving bond, standing bond, image.
fn first_in_time(a: &Event, b: &Event) -> std::cmp::Ordering {
    let numbers = |event: &Event| (event.moving, event.standing, event.image);
    a.hit.time.partial_cmp(&b.hit.time).unwrap().then(numbers(a).cmp(&numbers(b)))
}

/// Exchanges the momentum of the first hit.
fn execute(scene: &Scene, event: &mut Event, v: &mut [Vector]) {
    let pivot = if event.moving == event.vertex { scene.next[event.vertex] } else { scene.prev[event.vertex] };
    let four = [event.vertex, pivot.unwrap(), event.standing, scene.next[event.standing].unwrap()];
    let mut state = Four { velocity: four.map(|j| v[j]), mass: four.map(|j| scene.mass[j]) };
    event.momentum = exchange(&mut state, event.hit.s, event.hit.s_standing, event.hit.normal);
    event.executed = true;
    for (k, &j) in four.iter().enumerate() {
        v[j] = state.velocity[k];
    }
}

/// All hits of one move, over both bonds of the vertex, in no order. Bonds that share a vertex with the moving bond are not tested; with the
/// paper's exclusion neither are those that share one with the other moving bond, but their images are.
fn hits_of(scene: &Scene, vertex: usize, to: Point, r: &[Point]) -> Vec<Event> {
    let bonds = bonds_of(scene, vertex);
    let mut hits = Vec::new();
    for bond in &bonds {
        for standing in 0..r.len() {
            if let Some(end) = scene.next[standing] {
                let touches = |j: usize| standing == j || end == j;
                if !(touches(vertex) || touches(bond.pivot)) {
                    let linked = scene.exclusion_paper && bonds.iter().any(|other| touches(other.pivot));
                    let test =
                        Test { from: r[vertex], to, pivot: r[bond.pivot], a: r[standing], b: r[end], flip: bond.flip };
                    images(scene, &test, |image, hit| {
                        let (moving, executed) = (bond.number, false);
                        if !(linked && image == [0; 3]) {
                            hits.push(Event { vertex, moving, standing, image, executed, hit, momentum: 0.0 });
                        }
                    });
                }
            }
        }
    }
    hits
}

/// The test of every image whose box touches the box of the swept triangle.
fn images(scene: &Scene, test: &Test, mut found: impl FnMut([i64; 3], Hit)) {
    let mut first = [0; 3];
    let mut last = [0; 3];
    for axis in 0..3 {
        let corners = [test.from[axis], test.to[axis], test.pivot[axis]];
        let (low, high) = (corners.iter().min().unwrap(), corners.iter().max().unwrap());
        let (a, b) = (test.a[axis], test.b[axis]);
        // low <= max(a, b) + i edge, and min(a, b) + i edge <= high
        let edge = scene.edges[axis];
        first[axis] = -(a.max(b) - low).div_euclid(edge);
        last[axis] = (high - a.min(b)).div_euclid(edge);
    }
    for x in first[0]..=last[0] {
        for y in first[1]..=last[1] {
            for z in first[2]..=last[2] {
                let image = [x, y, z];
                let shifted = |point: Point| {
                    let along = |axis: usize| point[axis] + image[axis] * scene.edges[axis];
                    [along(0), along(1), along(2)]
                };
                if let Some(hit) = cross_bonds(&Test { a: shifted(test.a), b: shifted(test.b), ..*test }) {
                    found(image, hit);
                }
            }
        }
    }
}
