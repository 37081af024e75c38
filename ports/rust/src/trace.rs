//! whole steps: docs/port/contract.md, "A step"; docs/port/formats.md (starts, traces);
//! docs/conventions.md, "Order of operations" and "The same bits".

use crate::collision::{self as mpc, Members};
use crate::events;
use crate::forces;
use crate::pack::{Group, Pack};
use crate::random::VERTEX_ORDER;
use crate::scene::Scene;
use crate::sweep::sweep;
use crate::vector::*;
use std::fmt::Write;

struct Run {
    scene: Scene,
    scheme: i64,
    thermostat: i64,
    hydrodynamics: bool,
    /// Steps that are finished.
    step: u64,
    lag: u64,
    solvent: Vec<Point>,
    solvent_velocity: Vec<Vector>,
    vertex: Vec<Point>,
    vertex_velocity: Vec<Vector>,
    force: Vec<Vector>,
    event_driven: bool,
    /// The collision rule is at-a.
    andersen: bool,
    /// Bond, other, image and tick of the contacts since the last row.
    contacts: Vec<[i64; 6]>,
    table: String,
}

/// The largest value of each switch that this port knows: what it does not know is other physics.
const SWITCHES: [(&str, i64); 7] = [
    ("version", 2),
    ("crossing", 2),
    ("exclusion", 1),
    ("collision", 1),
    ("thermostat", 2),
    ("order", 2),
    ("swap", 1),
];

fn refuse_unknown(start: &Group) -> Result<(), String> {
    for (name, values) in start.columns_of("switches") {
        let largest = SWITCHES.iter().find(|known| known.0 == name).map_or(0, |known| known.1);
        if values.iter().any(|value| *value < 0 || *value > largest) {
            return Err(format!("this port does not know the switch {} with the values {:?}", name, values));
        }
    }
    Ok(())
}

pub fn trace(pack: &Pack) -> Result<String, String> {
    let start = pack.group("start", 0)?;
    refuse_unknown(start)?;
    let mut run = Run {
        scene: Scene::read(pack)?,
        scheme: start.integer("run", "scheme"),
        thermostat: start.integer("run", "thermostat"),
        hydrodynamics: start.integer("run", "hydrodynamics") != 0,
        step: start.integer("counters", "step") as u64,
        lag: start.integer("counters", "lag") as u64,
        solvent: start.points("solvent"),
        solvent_velocity: start.vectors("solvent_velocity"),
        vertex: start.points("vertex"),
        vertex_velocity: start.vectors("vertex_velocity"),
        force: Vec::new(),
        event_driven: start.integers("rule", "event_driven").first() == Some(&1),
        andersen: start.integers("collision", "rule").first() == Some(&1),
        contacts: Vec::new(),
        table: "step,stage,state_hash".to_string(),
    };
    run.table.push_str(if run.event_driven { ",contacts,contacts_hash\n" } else { "\n" });
    run.row(run.step, "start");
    for _ in 0..start.integer("run", "steps") {
        run.one_step();
    }
    Ok(run.table)
}

impl Run {
    fn one_step(&mut self) {
        let number = self.step + 1;
        let dt = self.scene.time_step;
        match (number % self.scene.interval == 0, self.scheme) {
            (false, _) => {
                self.drift(number, dt, 0);
                self.force(number);
                self.kick(number, dt);
            }
            (true, 0) => {
                self.drift(number, dt, 0);
                self.collide(number);
                self.force(number);
                self.kick(number, dt);
            }
            (true, 1) => {
                self.drift(number, dt, 0);
                self.force(number);
                self.kick(number, 0.5 * dt);
                self.collide(number);
                self.kick(number, 0.5 * dt);
            }
            (true, _) => {
                self.drift(number, 0.5 * dt, 0);
                self.collide(number);
                self.drift(number, 0.5 * dt, 1);
                self.force(number);
                self.kick(number, dt);
            }
        }
        self.step = number;
        self.row(number, "end");
    }

    fn row(&mut self, step: u64, stage: &str) {
        let hash = self.hash();
        write!(self.table, "{},{},{:016x}", step, stage, hash).unwrap();
        if self.event_driven {
            let bytes: Vec<u8> = self.contacts.iter().flatten().flat_map(|word| word.to_le_bytes()).collect();
            write!(self.table, ",{},{:016x}", self.contacts.len(), xxh64(&bytes)).unwrap();
            self.contacts.clear();
        }
        self.table.push('\n');
    }

    /// A drift adds 2 to the lag, half a drift 1.
    fn drift(&mut self, number: u64, time: f64, which: u32) {
        if self.event_driven {
            self.fly(time, which);
        } else {
            self.sweep(number, time, which);
        }
        self.lag += if time == self.scene.time_step { 2 } else { 1 };
        self.row(number, "drift");
    }

    /// `event_drift`. The first drift of a step begins half a step before the middle, the second one in the middle.
    fn fly(&mut self, time: f64, which: u32) {
        let start = if which == 0 { -0.5 * self.scene.time_step } else { 0.0 };
        let rows = events::drift(&self.scene, time, start, &mut self.vertex, &mut self.vertex_velocity);
        self.contacts.extend(rows.iter().map(|row| {
            let [x, y, z] = row.image;
            [row.bond as i64, row.other as i64, x, y, z, row.tick]
        }));
    }

    /// `order` and `sweep`
    fn sweep(&mut self, number: u64, time: f64, which: u32) {
        let scene = &self.scene;
        let order = if scene.forbidden {
            scene.source(VERTEX_ORDER, number).permutation(which, scene.vertices())
        } else {
            (0..scene.vertices()).collect()
        };
        sweep(scene, time, &order, &mut self.vertex, &mut self.vertex_velocity);
    }

    fn force(&mut self, number: u64) {
        self.force = forces::all(&self.scene, &self.vertex);
        if !self.vertex.is_empty() {
            self.row(number, "force");
        }
    }

    fn kick(&mut self, number: u64, time: f64) {
        forces::kick(&self.scene, time, &mut self.vertex_velocity, &self.force);
        if !self.vertex.is_empty() {
            self.row(number, "kick");
        }
    }

    fn collide(&mut self, number: u64) {
        let scene = &self.scene;
        let time = self.lag as f64 * (scene.time_step / 2.0);
        mpc::stream(scene, time, &mut self.solvent, &mut self.solvent_velocity);
        self.lag = 0;
        let shift = mpc::shift(scene, number);
        let solvent_cell = mpc::bin(scene, shift, &self.solvent);
        let vertex_cell = mpc::bin(scene, shift, &self.vertex);
        if self.andersen {
            self.collide_andersen(number, &solvent_cell, &vertex_cell);
        } else {
            self.collide_srd(number, &solvent_cell, &vertex_cell);
        }
        if !self.hydrodynamics {
            mpc::swap(&self.scene, number, &mut self.solvent_velocity);
        }
        self.row(number, "collide");
    }

    /// The rule at-a: `sum` takes velocities less the drawn ones.
    fn collide_andersen(&mut self, number: u64, solvent_cell: &[usize], vertex_cell: &[usize]) {
        let scene = &self.scene;
        let (solvent_drawn, vertex_drawn) = mpc::draw(scene, number, self.solvent.len());
        let less = |v: &[Vector], xi: &[Vector]| v.iter().zip(xi).map(|(v, xi)| subtract(*v, *xi)).collect::<Vec<_>>();
        let solvent = less(&self.solvent_velocity, &solvent_drawn);
        let vertex = less(&self.vertex_velocity, &vertex_drawn);
        let members = Members { solvent_cell, vertex_cell, solvent: &solvent, vertex: &vertex };
        let cells = mpc::solve(scene, number, &mpc::sum(scene, &members));
        mpc::give(&cells, solvent_cell, &solvent_drawn, &mut self.solvent_velocity);
        mpc::give(&cells, vertex_cell, &vertex_drawn, &mut self.vertex_velocity);
    }

    fn collide_srd(&mut self, number: u64, solvent_cell: &[usize], vertex_cell: &[usize]) {
        let scene = &self.scene;
        let members = Members {
            solvent_cell,
            vertex_cell,
            solvent: &self.solvent_velocity,
            vertex: &self.vertex_velocity,
        };
        let sums = mpc::sum(scene, &members);
        let cells = mpc::solve(scene, number, &sums);
        let relative = || mpc::relative(scene, &members, &sums, &cells.center);
        let factor = match self.thermostat {
            0 => vec![1.0; sums.members.len()],
            1 => mpc::rescale(&sums, &relative()),
            _ => mpc::maxwell_boltzmann(scene, number, &sums, &relative()),
        };
        mpc::rotate(scene, &cells, &factor, solvent_cell, &mut self.solvent_velocity);
        mpc::rotate(scene, &cells, &factor, vertex_cell, &mut self.vertex_velocity);
    }

    /// The state hash: XXH64 with seed 0.
    fn hash(&self) -> u64 {
        let mut bytes: Vec<u8> = Vec::new();
        let counts = [self.step, self.lag, self.solvent.len() as u64, self.vertex.len() as u64];
        counts.iter().for_each(|count| bytes.extend(count.to_le_bytes()));
        let both = [(&self.solvent, &self.solvent_velocity), (&self.vertex, &self.vertex_velocity)];
        for (positions, velocities) in both {
            for (r, v) in positions.iter().zip(velocities) {
                r.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
                v.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
            }
        }
        xxh64(&bytes)
    }
}

const PRIMES: [u64; 5] =
    [0x9E3779B185EBCA87, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9, 0x85EBCA77C2B2AE63, 0x27D4EB2F165667C5];

fn mix(lane: u64, input: u64) -> u64 {
    lane.wrapping_add(input.wrapping_mul(PRIMES[1])).rotate_left(31).wrapping_mul(PRIMES[0])
}

/// XXH64 with seed 0 of whole 64-bit words.
fn xxh64(bytes: &[u8]) -> u64 {
    let word = |chunk: &[u8]| {
        let mut eight = [0; 8];
        eight.copy_from_slice(chunk);
        u64::from_le_bytes(eight)
    };
    let mut lanes = [PRIMES[0].wrapping_add(PRIMES[1]), PRIMES[1], 0, PRIMES[0].wrapping_neg()];
    let stripes = bytes.chunks_exact(32);
    let rest = stripes.remainder();
    for stripe in stripes {
        for (lane, chunk) in lanes.iter_mut().zip(stripe.chunks_exact(8)) {
            *lane = mix(*lane, word(chunk));
        }
    }
    let mut hash = if bytes.len() < 32 {
        PRIMES[4]
    } else {
        let turned = [1, 7, 12, 18].iter().zip(lanes).map(|(bits, lane)| lane.rotate_left(*bits));
        let start = turned.fold(0u64, u64::wrapping_add);
        lanes.iter().fold(start, |hash, lane| (hash ^ mix(0, *lane)).wrapping_mul(PRIMES[0]).wrapping_add(PRIMES[3]))
    };
    hash = hash.wrapping_add(bytes.len() as u64);
    for chunk in rest.chunks_exact(8) {
        hash = (hash ^ mix(0, word(chunk))).rotate_left(27).wrapping_mul(PRIMES[0]).wrapping_add(PRIMES[3]);
    }
    hash = (hash ^ hash >> 33).wrapping_mul(PRIMES[1]);
    hash = (hash ^ hash >> 29).wrapping_mul(PRIMES[2]);
    hash ^ hash >> 32
}
