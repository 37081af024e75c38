//! Vectors and roundings: docs/port/contract.md, "Arithmetic".

pub type Vector = [f64; 3];
pub type Point = [i64; 3];

/// One lattice unit, 2^-40 a0.
pub const UNIT: f64 = 1.0 / (1u64 << 40) as f64;
pub const PER_CELL: f64 = (1u64 << 40) as f64;

pub fn dot(a: Vector, b: Vector) -> f64 {
    (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]
}

pub fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub fn subtract(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub fn scale(s: f64, a: Vector) -> Vector {
    [s * a[0], s * a[1], s * a[2]]
}

/// A difference of positions is made as an integer.
pub fn difference(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Lattice units as doubles, unscaled.
pub fn lattice(a: Point) -> Vector {
    [a[0] as f64, a[1] as f64, a[2] as f64]
}

/// A difference of positions in a0.
pub fn between(to: Point, from: Point) -> Vector {
    scale(UNIT, lattice(difference(to, from)))
}

/// The nearest integer, ties to even, as a double.
pub fn nearest(x: f64) -> f64 {
    const WHOLE: f64 = (1u64 << 52) as f64;
    if x.abs() >= WHOLE {
        x
    } else if x >= 0.0 {
        (x + WHOLE) - WHOLE
    } else {
        (x - WHOLE) + WHOLE
    }
}

pub fn round(x: f64) -> i64 {
    nearest(x) as i64
}
