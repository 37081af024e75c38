//! `model`: the constants of the scene, for all operators.

use crate::pack::Pack;
use crate::random::Source;
use crate::vector::Vector;

pub struct Scene {
    pub cells: [i64; 3],
    pub edges: [i64; 3],
    pub key: [u32; 2],
    pub interval: u64,
    pub particles: usize,
    pub forbidden: bool,
    pub exclusion_paper: bool,
    pub time_step: f64,
    pub cosine: f64,
    pub sine: f64,
    pub acceleration: Vector,
    /// The next and the previous vertex of the fiber, if any.
    pub next: Vec<Option<usize>>,
    pub prev: Vec<Option<usize>>,
    pub mass: Vec<f64>,
    pub bond_length: Vec<f64>,
    pub spring: Vec<f64>,
    pub bending: Vec<f64>,
    pub constant_force: Vec<Vector>,
}

fn neighbors(column: Vec<i64>) -> Vec<Option<usize>> {
    column.iter().map(|&other| if other < 0 { None } else { Some(other as usize) }).collect()
}

impl Scene {
    pub fn read(pack: &Pack) -> Result<Scene, String> {
        let model = pack.group("model", 0)?;
        let cells = model.points("box")[0];
        Ok(Scene {
            cells,
            edges: cells.map(|n| n << 40),
            key: [model.integer("numbers", "seed_low") as u32, model.integer("numbers", "seed_high") as u32],
            particles: model.integer("numbers", "particles") as usize,
            interval: model.integer("numbers", "interval") as u64,
            forbidden: model.integer("numbers", "forbidden") != 0,
            exclusion_paper: model.integer("numbers", "exclusion_paper") != 0,
            time_step: model.real("reals", "time_step"),
            cosine: model.real("reals", "cosine"),
            sine: model.real("reals", "sine"),
            acceleration: ["acceleration_x", "acceleration_y", "acceleration_z"].map(|name| model.real("reals", name)),
            next: neighbors(model.integers("chain", "next")),
            prev: neighbors(model.integers("chain", "prev")),
            mass: model.reals("vertex", "mass"),
            bond_length: model.reals("vertex", "bond_length"),
            spring: model.reals("vertex", "spring"),
            bending: model.reals("vertex", "bending"),
            constant_force: model.triples("vertex", ["force_x", "force_y", "force_z"]),
        })
    }

    pub fn source(&self, purpose: u32, step: u64) -> Source {
        Source { key: self.key, purpose, step }
    }

    pub fn cell_count(&self) -> usize {
        (self.cells[0] * self.cells[1] * self.cells[2]) as usize
    }

    pub fn vertices(&self) -> usize {
        self.mass.len()
    }
}
