//! A drift of all vertices at once: docs/port/contacts.md, *Events* and *Clusters*.

use crate::contact::{contact, impulse, Answer, Contact, Ends};
use crate::flight::{at, Flight, TICKS};
use crate::forces;
use crate::scene::Scene;
use crate::vector::*;
use std::collections::BTreeSet;

/// Contacts of a vertex in one drift, after which it joins a cluster.
const MOST_CONTACTS: u32 = 1000;
/// Lattice units of a tick in a drift of one a0: 2^40 / 2^16.
const PER_TICK: f64 = (1u64 << 24) as f64;

/// A contact that was answered.
pub struct Row {
    pub bond: usize,
    pub other: usize,
    pub image: [i64; 3],
    pub tick: i64,
    pub contact: Contact,
    pub momentum: f64,
}

/// A contact to come. The order of the fields is the order of the answers.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Event {
    tick: i64,
    bond: usize,
    other: usize,
    image: [i64; 3],
}

struct Drift<'a> {
    scene: &'a Scene,
    time: f64,
    start: f64,
    /// Where a vertex would have been at tick 0, had it always flown as it does now.
    origin: &'a mut [Point],
    rate: Vec<Point>,
    velocity: &'a mut [Vector],
    contacts: Vec<u32>,
    /// The number of the cluster.
    cluster: Vec<Option<usize>>,
    clusters: usize,
    events: BTreeSet<Event>,
    rows: Vec<Row>,
}

/// Moves all vertices for `time`; `start` is the time from the middle between two kicks to the beginning.
pub fn drift(scene: &Scene, time: f64, start: f64, r: &mut [Point], v: &mut [Vector]) -> Vec<Row> {
    let count = r.len();
    let rate = v.iter().map(|v| rate_of(time, *v)).collect();
    let mut drift = Drift {
        scene,
        time,
        start,
        origin: r,
        rate,
        velocity: v,
        contacts: vec![0; count],
        cluster: vec![None; count],
        clusters: 0,
        events: BTreeSet::new(),
        rows: Vec::new(),
    };
    if scene.forbidden {
        drift.search(&vec![true; count], 0);
        while let Some(event) = drift.events.pop_first() {
            drift.answer(event);
        }
    }
    for (place, rate) in drift.origin.iter_mut().zip(&drift.rate) {
        *place = at(*place, *rate, TICKS);
    }
    drift.rows
}

fn rate_of(time: f64, velocity: Vector) -> Point {
    velocity.map(|v| round((time * v) * PER_TICK))
}

impl Drift<'_> {
    /// i, next[i], j, next[j]
    fn ends(&self, event: &Event) -> [usize; 4] {
        let last = |bond: usize| self.scene.next[bond].unwrap();
        [event.bond, last(event.bond), event.other, last(event.other)]
    }

    fn flight(&self, ends: [usize; 4], image: [i64; 3]) -> Flight {
        let three = |of: &[Point]| {
            let [i, i1, j, j1] = ends.map(|vertex| of[vertex]);
            [difference(i1, i), difference(j1, j), difference(j, i)]
        };
        let (mut place, rate) = (three(self.origin), three(&self.rate));
        for axis in 0..3 {
            place[2][axis] += image[axis] * self.scene.edges[axis];
        }
        Flight { place, rate }
    }

    /// All pairs with at least one bond that has an end among the marked vertices, from a tick on.
    fn search(&mut self, marked: &[bool], from: i64) {
        let next = &self.scene.next;
        let bonds: Vec<(usize, usize)> = (0..next.len()).filter_map(|j| next[j].map(|end| (j, end))).collect();
        for (k, &(i, i1)) in bonds.iter().enumerate() {
            for &(j, j1) in &bonds[k + 1..] {
                let ends = [i, i1, j, j1];
                let apart = i != j && i != j1 && i1 != j && i1 != j1;
                if apart && ends.iter().any(|&vertex| marked[vertex]) {
                    self.search_pair(ends, from);
                }
            }
        }
    }

    /// All images that the bonds may come near to.
    fn search_pair(&mut self, ends: [usize; 4], from: i64) {
        let flight = self.flight(ends, [0; 3]);
        if flight.is_rigid() {
            return;
        }
        let bounds = flight.bounds(from);
        // low + k edge <= 0 <= high + k edge
        let range = |axis: usize| {
            let ((low, high), edge) = (bounds[axis], self.scene.edges[axis]);
            -high.div_euclid(edge)..=(-low).div_euclid(edge)
        };
        for x in range(0) {
            for y in range(1) {
                for z in range(2) {
                    self.search_image(ends, [x, y, z], from);
                }
            }
        }
    }

    fn search_image(&mut self, ends: [usize; 4], image: [i64; 3], from: i64) {
        let tick = self.flight(ends, image).search(from);
        if tick < TICKS {
            self.events.insert(Event { tick, bond: ends[0], other: ends[2], image });
        }
    }

    fn answer(&mut self, event: Event) {
        let four = self.ends(&event);
        let places = self.flight(four, event.image).at(event.tick);
        let Some(contact) = contact(places, &four.map(|j| self.velocity[j])) else {
            self.search_image(four, event.image, event.tick + 1);
            return;
        };
        let worn = |&j: &usize| self.cluster[j].is_some() || self.contacts[j] >= MOST_CONTACTS;
        if four.iter().any(worn) || !self.exchange(&event, four, contact) {
            self.freeze(&event, four);
        }
    }

    /// Answers by the impulse, if there is one.
    fn exchange(&mut self, event: &Event, four: [usize; 4], contact: Contact) -> bool {
        let places: Vec<Point> =
            self.origin.iter().zip(&self.rate).map(|(place, rate)| at(*place, *rate, event.tick)).collect();
        let mut ends = Ends {
            velocity: four.map(|j| self.velocity[j]),
            force: four.map(|j| forces::on_vertex(self.scene, &places, j)),
            mass: four.map(|j| self.scene.mass[j]),
        };
        let tau = self.start + self.time * (event.tick as f64 / TICKS as f64);
        let (answer, momentum) = impulse(&mut ends, contact.s, contact.t, contact.normal, tau);
        if answer == Answer::None {
            return false;
        }
        for (k, &j) in four.iter().enumerate() {
            self.velocity[j] = ends.velocity[k];
            self.contacts[j] += 1;
            self.bend(j, rate_of(self.time, ends.velocity[k]), event.tick);
        }
        let Event { tick, bond, other, image } = *event;
        self.rows.push(Row { bond, other, image, tick, contact, momentum });
        self.search_again(&four, tick);
        true
    }

    /// The last resort: a cluster with one rate.
    fn freeze(&mut self, event: &Event, four: [usize; 4]) {
        let leader = four.iter().find(|&&j| self.cluster[j].is_some());
        let rate = match leader {
            Some(&j) => self.rate[j],
            None => [0, 1, 2].map(|axis| four.iter().map(|&j| self.rate[j][axis]).sum::<i64>() / 4),
        };
        let old = four.map(|j| self.cluster[j]);
        let joins = |j: usize| four.contains(&j) || (self.cluster[j].is_some() && old.contains(&self.cluster[j]));
        let members: Vec<usize> = (0..self.rate.len()).filter(|&j| joins(j)).collect();
        for &j in &members {
            self.cluster[j] = Some(self.clusters);
            self.bend(j, rate, event.tick);
        }
        self.clusters += 1;
        self.search_again(&members, event.tick);
    }

    /// A new rate, with the place at this tick kept.
    fn bend(&mut self, j: usize, rate: Point, tick: i64) {
        let place = at(self.origin[j], self.rate[j], tick);
        self.origin[j] = at(place, rate, -tick);
        self.rate[j] = rate;
    }

    /// Drops the events of all bonds of these vertices, and searches their pairs anew.
    fn search_again(&mut self, vertices: &[usize], tick: i64) {
        let mut marked = vec![false; self.rate.len()];
        vertices.iter().for_each(|&j| marked[j] = true);
        let next = &self.scene.next;
        let flies_on = |bond: usize| !marked[bond] && !marked[next[bond].unwrap()];
        self.events.retain(|event| flies_on(event.bond) && flies_on(event.other));
        self.search(&marked, tick);
    }
}
