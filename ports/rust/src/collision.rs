//! The solvent and the collision, operator by operator: docs/port/contract.md, "The operators", "Rotation", "Thermostats".

use crate::elementary::log;
use crate::random::{
    normal, three_normals, uniform, Source, ANDERSEN_PARTICLE, ANDERSEN_VERTEX, AXIS, GRID_SHIFT, SWAP, THERMOSTAT,
};
use crate::scene::Scene;
use crate::vector::*;

const MASS_UNITS: f64 = 65536.0;
const MOMENTUM_UNITS: f64 = (1u64 << 44) as f64;
const ENERGY_UNITS: f64 = (1u64 << 32) as f64;

/// What collides: the cell, the mass and the velocity of every particle. The solvent comes first.
pub struct Members<'a> {
    pub solvent_cell: &'a [usize],
    pub vertex_cell: &'a [usize],
    pub solvent: &'a [Vector],
    pub vertex: &'a [Vector],
}

impl<'a> Members<'a> {
    fn each<'s>(&'s self, scene: &'s Scene) -> impl Iterator<Item = (usize, f64, Vector)> + 's {
        let solvent = self.solvent.iter().zip(self.solvent_cell).map(|(v, cell)| (*cell, 1.0, *v));
        let vertex = self.vertex.iter().zip(self.vertex_cell).zip(&scene.mass).map(|((v, cell), m)| (*cell, *m, *v));
        solvent.chain(vertex)
    }
}

#[derive(Clone, Default)]
pub struct Sums {
    pub momentum: Vec<[i64; 3]>,
    pub members: Vec<i64>,
    pub mass: Vec<i64>,
}

#[derive(Clone, Default)]
pub struct Cells {
    pub active: Vec<bool>,
    pub center: Vec<Vector>,
    pub axis: Vec<Vector>,
}

/// r + round((v t + ((0.5 a) t) t) 2^40), wrapped; then v + a t.
pub fn stream(scene: &Scene, time: f64, r: &mut [Point], v: &mut [Vector]) {
    let a = scene.acceleration;
    for (r, v) in r.iter_mut().zip(v) {
        for axis in 0..3 {
            let flight = (v[axis] * time + ((0.5 * a[axis]) * time) * time) * PER_CELL;
            r[axis] = (r[axis] + round(flight)).rem_euclid(scene.edges[axis]);
            v[axis] += a[axis] * time;
        }
    }
}

/// Words 0, 1, 2 in units of 2^-32 a0; here in lattice units.
pub fn shift(scene: &Scene, step: u64) -> Point {
    let words = scene.source(GRID_SHIFT, step).words(0, 0);
    [0, 1, 2].map(|axis| i64::from(words[axis]) << 8)
}

/// The cell that contains p + shift, wrapped into the box: (z Ly + y) Lx + x.
pub fn bin(scene: &Scene, shift: Point, positions: &[Point]) -> Vec<usize> {
    let place = |p: &Point, axis: usize| (p[axis] + shift[axis]).rem_euclid(scene.edges[axis]) >> 40;
    let cell = |p: &Point| (place(p, 2) * scene.cells[1] + place(p, 1)) * scene.cells[0] + place(p, 0);
    positions.iter().map(|p| cell(p) as usize).collect()
}

pub fn sum(scene: &Scene, members: &Members) -> Sums {
    let n = scene.cell_count();
    let mut sums = Sums { momentum: vec![[0; 3]; n], members: vec![0; n], mass: vec![0; n] };
    for (cell, mass, v) in members.each(scene) {
        for axis in 0..3 {
            sums.momentum[cell][axis] += round((mass * MOMENTUM_UNITS) * v[axis]);
        }
        sums.members[cell] += 1;
        sums.mass[cell] += (mass * MASS_UNITS) as i64;
    }
    sums
}

pub fn solve(scene: &Scene, step: u64, sums: &Sums) -> Cells {
    let axes = scene.source(AXIS, step);
    let mut cells = Cells::default();
    for cell in 0..sums.members.len() {
        let active = sums.members[cell] >= 2;
        let mass = sums.mass[cell] as f64 / MASS_UNITS;
        cells.active.push(active);
        if active {
            cells.center.push(scale(1.0 / MOMENTUM_UNITS / mass, lattice(sums.momentum[cell])));
            cells.axis.push(axes.axis(cell as u32));
        } else {
            cells.center.push([0.0; 3]);
            cells.axis.push([0.0; 3]);
        }
    }
    cells
}

/// Twice the energy of each cell relative to its center, in units of 2^-32. 0 for fewer than two members.
pub fn relative(scene: &Scene, members: &Members, sums: &Sums, center: &[Vector]) -> Vec<i64> {
    let mut relative = vec![0; center.len()];
    for (cell, mass, v) in members.each(scene) {
        if sums.members[cell] >= 2 {
            let w = subtract(v, center[cell]);
            relative[cell] += round((ENERGY_UNITS * mass) * dot(w, w));
        }
    }
    relative
}

/// One factor for all active cells; 1 elsewhere.
pub fn rescale(sums: &Sums, relative: &[i64]) -> Vec<f64> {
    let (mut wanted, mut found) = (0.0, 0.0);
    for (cell, &members) in sums.members.iter().enumerate() {
        if members >= 2 {
            wanted += 3.0 * (members - 1) as f64;
            found += relative[cell] as f64 / ENERGY_UNITS;
        }
    }
    let factor = if found > 0.0 { (wanted / found).sqrt() } else { 1.0 };
    sums.members.iter().map(|&members| if members >= 2 { factor } else { 1.0 }).collect()
}

pub fn maxwell_boltzmann(scene: &Scene, step: u64, sums: &Sums, relative: &[i64]) -> Vec<f64> {
    let source = scene.source(THERMOSTAT, step);
    let factor = |cell: usize| {
        let energy = 0.5 * (relative[cell] as f64 / ENERGY_UNITS);
        if sums.members[cell] < 2 || energy <= 0.0 {
            return 1.0;
        }
        let shape = 1.5 * (sums.members[cell] - 1) as f64;
        (gamma(&source, cell as u32, shape) / energy).sqrt()
    };
    (0..relative.len()).map(factor).collect()
}

/// A Gamma deviate (Marsaglia and Tsang).
fn gamma(source: &Source, cell: u32, shape: f64) -> f64 {
    let d = shape - 1.0 / 3.0;
    let c = 1.0 / (9.0 * d).sqrt();
    for k in 0.. {
        let x = normal(source.words(2 * k, cell)).0;
        let w = uniform(source.words(2 * k + 1, cell), 0);
        let root = 1.0 + c * x;
        let v = root * root * root;
        if v > 0.0 && log(w) < 0.5 * x * x + d - d * v + d * log(v) {
            return d * v;
        }
    }
    unreachable!()
}

/// R w
fn turn(scene: &Scene, axis: Vector, w: Vector) -> Vector {
    let along = dot(axis, w);
    let across = cross(axis, w);
    if scene.cosine == 0.0 {
        return add(scale(along, axis), across);
    }
    let still = scale((1.0 - scene.cosine) * along, axis);
    add(add(scale(scene.cosine, w), still), scale(scene.sine, across))
}

/// v' = center + factor R w
pub fn rotate(scene: &Scene, cells: &Cells, factor: &[f64], cell_of: &[usize], velocity: &mut [Vector]) {
    for (v, &cell) in velocity.iter_mut().zip(cell_of) {
        if cells.active[cell] {
            let w = subtract(*v, cells.center[cell]);
            *v = add(cells.center[cell], scale(factor[cell], turn(scene, cells.axis[cell], w)));
        }
    }
}

/// The rule at-a: three normal deviates for each of these entities, of draw 0.
fn normals(source: &Source, count: usize) -> Vec<Vector> {
    (0..count as u32).map(|entity| three_normals(source.words(0, entity))).collect()
}

/// The velocities that solvent and vertices draw.
pub fn draw(scene: &Scene, step: u64, particles: usize) -> (Vec<Vector>, Vec<Vector>) {
    let vertex = normals(&scene.source(ANDERSEN_VERTEX, step), scene.vertices());
    let over_root = |(v, mass): (&Vector, &f64)| scale(1.0 / mass.sqrt(), *v);
    let vertex = vertex.iter().zip(&scene.mass).map(over_root).collect();
    (normals(&scene.source(ANDERSEN_PARTICLE, step), particles), vertex)
}

/// v' = center + the drawn velocity
pub fn give(cells: &Cells, cell_of: &[usize], drawn: &[Vector], velocity: &mut [Vector]) {
    for ((v, &cell), xi) in velocity.iter_mut().zip(cell_of).zip(drawn) {
        if cells.active[cell] {
            *v = add(cells.center[cell], *xi);
        }
    }
}

/// id takes the velocity of particle order[id].
pub fn swap(scene: &Scene, step: u64, velocity: &mut [Vector]) -> Vec<usize> {
    let order = scene.source(SWAP, step).permutation(0, velocity.len());
    let old = velocity.to_vec();
    for (id, &from) in order.iter().enumerate() {
        velocity[id] = old[from];
    }
    order
}
