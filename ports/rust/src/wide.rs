//! Exact determinants of lattice differences, in integers of 192 bits.

use crate::vector::Point;
use std::ops::Add;

/// high * 2^64 + low. The order of the two words is that of the numbers.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Wide {
    pub high: i128,
    pub low: u64,
}

pub const ZERO: Wide = Wide { high: 0, low: 0 };

impl Add for Wide {
    type Output = Wide;

    fn add(self, other: Wide) -> Wide {
        let (low, carry) = self.low.overflowing_add(other.low);
        Wide { high: self.high + other.high + i128::from(carry), low }
    }
}

impl Wide {
    /// 1, 0 or -1
    pub fn sign(self) -> i32 {
        self.cmp(&ZERO) as i32
    }
}

/// a x b
pub fn cross(a: Point, b: Point) -> [i128; 3] {
    let minor = |i: usize, j: usize| i128::from(a[i]) * i128::from(b[j]) - i128::from(a[j]) * i128::from(b[i]);
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

/// n.c, where n is a cross product
pub fn along(n: [i128; 3], c: Point) -> Wide {
    let (mut high, mut low) = (0i128, 0i128);
    for axis in 0..3 {
        high += i128::from(c[axis]) * (n[axis] >> 64);
        low += i128::from(c[axis]) * i128::from(n[axis] as u64);
    }
    Wide { high: high + (low >> 64), low: low as u64 }
}

/// (a x b).c
pub fn determinant(a: Point, b: Point, c: Point) -> Wide {
    along(cross(a, b), c)
}
