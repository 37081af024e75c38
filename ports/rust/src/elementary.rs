//! Logarithm, cosine and sine: docs/elementary.md, operation by operation.

const fn power(n: u32) -> u128 {
    1u128 << n
}

// Hexadecimal doubles: the digits as an integer, divided by a power of two.
const LN2_HIGH: f64 = 0x162e42fefa38u64 as f64 / power(45) as f64;
const LN2_LOW: f64 = 0x1ef35793c7673u64 as f64 / power(93) as f64;
const HALF_PI_HIGH: f64 = 0x1921fb54u64 as f64 / power(28) as f64;
const HALF_PI_LOW: f64 = 0x110b4611a62633u64 as f64 / power(82) as f64;
const ROUND: f64 = 1.5 * power(52) as f64;
const ROOT_HALF_BITS: u64 = 0x3fe6a09e667f3bcd;

/// H(w; c0, c1, ..., cn), from the innermost term.
fn horner(w: f64, coefficients: &[f64]) -> f64 {
    coefficients.iter().rev().skip(1).fold(coefficients[coefficients.len() - 1], |sum, c| c + w * sum)
}

fn factorial(n: u32) -> f64 {
    (1..=n).map(f64::from).product()
}

/// "log x"
pub fn log(x: f64) -> f64 {
    let t = x.to_bits().wrapping_add(0x3ff0000000000000 - ROOT_HALF_BITS);
    let e = ((t >> 52) as i64 - 1023) as f64;
    let f = f64::from_bits((t & 0x000fffffffffffff) + ROOT_HALF_BITS) - 1.0;
    let h = 0.5 * f * f;
    let s = f / (2.0 + f);
    let z = s * s;
    let w = z * z;
    let odd = horner(w, &[2.0 / 3.0, 2.0 / 7.0, 2.0 / 11.0, 2.0 / 15.0, 2.0 / 19.0]);
    let even = horner(w, &[2.0 / 5.0, 2.0 / 9.0, 2.0 / 13.0, 2.0 / 17.0, 2.0 / 21.0]);
    let rest = s * (h + (z * odd + w * even)) - h;
    let whole = e * LN2_HIGH;
    let sum = whole + f;
    let lost = (whole - sum) + f;
    sum + (rest + (lost + e * LN2_LOW))
}

/// "Circle", with the unit of turns: cosine and sine of u turns.
pub fn turns(u: f64) -> (f64, f64) {
    let turned = 4.0 * u + ROUND;
    let k = turned - ROUND;
    let t = 4.0 * u - k;
    circle(t, HALF_PI_HIGH, HALF_PI_LOW, k as i64)
}

fn circle(t: f64, high: f64, low: f64, quarters: i64) -> (f64, f64) {
    let t1 = f64::from_bits(t.to_bits() & !((1u64 << 27) - 1));
    let t2 = t - t1;
    let exact = t1 * high;
    let rest = t2 * high + t * low;
    let x = exact + rest;
    let lost = rest - (x - exact);
    let z = x * x;
    let w = z * z;
    let s0 = horner(w, &[-1.0 / factorial(3), -1.0 / factorial(7), -1.0 / factorial(11), -1.0 / factorial(15)]);
    let s1 = horner(w, &[1.0 / factorial(5), 1.0 / factorial(9), 1.0 / factorial(13), 1.0 / factorial(17)]);
    let along = x + (lost + x * (z * (s0 + z * s1)));
    let c0 = horner(w, &[1.0 / factorial(4), 1.0 / factorial(8), 1.0 / factorial(12), 1.0 / factorial(16)]);
    let c1 = horner(w, &[-1.0 / factorial(6), -1.0 / factorial(10), -1.0 / factorial(14)]);
    let h = 0.5 * z;
    let less = 1.0 - h;
    let across = less + (((1.0 - less) - h) + (w * (c0 + z * c1) - x * lost));
    let (cosine, sine) = match quarters.rem_euclid(4) {
        0 => (across, along),
        1 => (-along, across),
        2 => (-across, -along),
        _ => (along, -across),
    };
    (cosine + 0.0, sine + 0.0)
}
