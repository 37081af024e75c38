//! Philox and what is made of its words: docs/porting.md, "Arithmetic";
//! docs/conventions.md, "Random numbers have addresses".

use crate::elementary::{log, turns};
use crate::vector::Vector;

pub const GRID_SHIFT: u32 = 1;
pub const AXIS: u32 = 2;
pub const VERTEX_ORDER: u32 = 3;
pub const SWAP: u32 = 4;
pub const THERMOSTAT: u32 = 5;
pub const ANDERSEN_PARTICLE: u32 = 8;
pub const ANDERSEN_VERTEX: u32 = 9;

/// All but the entity and the draw of an address.
#[derive(Clone, Copy)]
pub struct Source {
    pub key: [u32; 2],
    pub purpose: u32,
    pub step: u64,
}

pub type Words = [u32; 4];

fn philox(mut c: Words, mut key: [u32; 2]) -> Words {
    for round in 0..10 {
        if round > 0 {
            key = [key[0].wrapping_add(0x9E3779B9), key[1].wrapping_add(0xBB67AE85)];
        }
        let first = 0xD2511F53u64 * u64::from(c[0]);
        let second = 0xCD9E8D57u64 * u64::from(c[2]);
        let (h0, l0) = ((first >> 32) as u32, first as u32);
        let (h1, l1) = ((second >> 32) as u32, second as u32);
        c = [h1 ^ c[1] ^ key[0], l1, h0 ^ c[3] ^ key[1], l0];
    }
    c
}

impl Source {
    /// The counter is (entity, purpose + 256 draw, step low, step high).
    pub fn words(&self, draw: u32, entity: u32) -> Words {
        let second = self.purpose.wrapping_add(draw.wrapping_mul(256));
        philox([entity, second, self.step as u32, (self.step >> 32) as u32], self.key)
    }

    /// Words 0, 1 of draw 0, then words 2, 3, then the next draw (Marsaglia 1972).
    pub fn axis(&self, entity: u32) -> Vector {
        let mut draw = 0;
        loop {
            let words = self.words(draw, entity);
            for pair in [[words[0], words[1]], [words[2], words[3]]] {
                if let Some(axis) = axis_of(pair) {
                    return axis;
                }
            }
            draw += 1;
        }
    }

    /// Fisher and Yates.
    pub fn permutation(&self, draw: u32, size: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..size).collect();
        for k in (1..size).rev() {
            let words = self.words(draw, (k / 2) as u32);
            let product = (k as u128 + 1) * u128::from(integer(words, k % 2));
            order.swap(k, (product >> 64) as usize);
        }
        order
    }
}

pub fn integer(words: Words, k: usize) -> u64 {
    u64::from(words[2 * k]) | u64::from(words[2 * k + 1]) << 32
}

pub fn uniform(words: Words, k: usize) -> f64 {
    ((integer(words, k) >> 12) as f64 + 0.5) / (1u64 << 52) as f64
}

pub fn normal(words: Words) -> (f64, f64) {
    let radius = (-2.0 * log(uniform(words, 0))).sqrt();
    let (cosine, sine) = turns(uniform(words, 1));
    (radius * cosine, radius * sine)
}

fn axis_of(pair: [u32; 2]) -> Option<Vector> {
    let [u, v] = pair.map(|word| (f64::from(word as i32) + 0.5) / (1u64 << 31) as f64);
    let q = u * u + v * v;
    if q < 1.0 {
        let root = (1.0 - q).sqrt();
        Some([2.0 * u * root, 2.0 * v * root, 1.0 - 2.0 * q])
    } else {
        None
    }
}
