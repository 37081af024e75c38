//! Philox and what is made of its words: docs/port/contract.md, "Arithmetic";
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

/// -ln u, u of 40 bits: docs/elementary.md, "Three of one draw".
fn minus_log(high: u32, low: u32) -> f64 {
    const ONE: u64 = 0x3ff0000000000000;
    const ROOT_HALF: u64 = 0x3fe6a09e667f3bcd;
    let fraction = u64::from(high) << 20 | u64::from(low >> 24) << 12;
    let u = f64::from_bits(ONE | fraction) - (1.0 - 1.0 / (1u64 << 41) as f64);
    let t = u.to_bits() + (ONE - ROOT_HALF);
    let e = (t >> 52) as f64 - 1023.0;
    let f = f64::from_bits((t & 0x000fffffffffffff) + ROOT_HALF) - 1.0;
    let s = f / (2.0 + f);
    let w = s * s;
    let q = w * w;
    let odd = 2.0 / 3.0 + q * (2.0 / 7.0 + q * (2.0 / 11.0));
    let even = 2.0 + q * (2.0 / 5.0 + q * (2.0 / 9.0 + q * (2.0 / 13.0)));
    -(e * std::f64::consts::LN_2) - s * (even + w * odd)
}

/// A uniform number about 0, |t| < 1/2, of so many low bits of a word.
fn centered(word: u32, bits: u32) -> f64 {
    let k = word & ((1 << bits) - 1);
    (f64::from(k) + 0.5) / f64::from(1u32 << bits) - 0.5
}

/// Three normal deviates of one draw.
pub fn three_normals(words: Words) -> Vector {
    let a = centered(words[1], 22) * std::f64::consts::FRAC_PI_2;
    let w = a * a;
    let q = w * w;
    let s0 = 1.0 + q * (1.0 / 120.0 + q * (1.0 / 362880.0 + q * (1.0 / 6227020800.0)));
    let s1 = -1.0 / 6.0 + q * (-1.0 / 5040.0 + q * (-1.0 / 39916800.0));
    let c0 = 1.0 + q * (1.0 / 24.0 + q * (1.0 / 40320.0 + q * (1.0 / 479001600.0)));
    let c1 = -1.0 / 2.0 + q * (-1.0 / 720.0 + q * (-1.0 / 3628800.0));
    let (sine, cosine) = (a * (s0 + w * s1), c0 + w * c1);
    let root = minus_log(words[0], words[1]).sqrt();
    let signed = |place: u32, x: f64| if words[1] >> place & 1 == 1 { -x } else { x };

    let b = centered(words[3], 24) * std::f64::consts::PI;
    let w = b * b;
    let q = w * w;
    let s0 = 1.0 / 362880.0 + q * (1.0 / 6227020800.0 + q * (1.0 / 355687428096000.0));
    let s0 = 1.0 + q * (1.0 / 120.0 + q * s0);
    let s1 = -1.0 / 5040.0 + q * (-1.0 / 39916800.0 + q * (-1.0 / 1307674368000.0));
    let s1 = -1.0 / 6.0 + q * s1;
    let radius = (2.0 * minus_log(words[2], words[3])).sqrt();
    [signed(23, root * (cosine - sine)), signed(22, root * (cosine + sine)), radius * (b * (s0 + w * s1))]
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
