//! Numbers of the form (a + b·√d)/c, exact: read from text and rounded to fixed point.

use core::{cmp::Ordering, fmt};

/// The largest integer of a rational number; it keeps the 256-bit comparison below exact.
const MAX_RATIONAL: i128 = 1_000_000_000_000_000_000;
/// The largest integer of a number with a root.
const MAX_QUADRATIC: i128 = 1_000_000_000;
/// The longest text, in bytes. It also bounds the depth of parentheses.
const MAX_TEXT: usize = 120;

/// (a + b·√d)/c in lowest terms: c > 0, gcd(a, b, c) = 1, d square-free; b = 0 exactly if d = 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Quadratic {
    a: i64,
    b: i64,
    c: i64,
    d: i64,
}

type Parsed<T> = Result<T, &'static str>;

impl Quadratic {
    pub(super) fn parse(text: &str) -> Parsed<Self> {
        if text.len() > MAX_TEXT {
            return Err("longer than 120 bytes");
        }
        let mut parser = Parser { rest: text };
        let value = parser.sum()?;
        parser.skip_space();
        if parser.rest.is_empty() {
            Ok(value)
        } else {
            Err("unexpected characters after the number")
        }
    }

    /// Brings (a + b·√d)/c to lowest terms.
    fn new(mut a: i128, mut b: i128, mut c: i128, mut d: i128) -> Parsed<Self> {
        if c == 0 {
            return Err("division by zero");
        }
        // Move squares out of the root.
        let mut root = 2;
        while root * root <= d {
            while d % (root * root) == 0 {
                d /= root * root;
                b = b.checked_mul(root).ok_or("numbers too large")?;
            }
            root += 1;
        }
        if d == 1 {
            a = a.checked_add(b).ok_or("numbers too large")?;
            b = 0;
        }
        if b == 0 {
            d = 1;
        }
        let divisor = gcd(gcd(a, b), c) * c.signum();
        (a, b, c) = (a / divisor, b / divisor, c / divisor);
        let limit = if b == 0 { MAX_RATIONAL } else { MAX_QUADRATIC };
        if a.abs() > limit || b.abs() > limit || c > limit {
            return Err("numbers too large (at most 10^18, with a root 10^9)");
        }
        // All fit now: the limits are below 2⁶³.
        Ok(Self {
            a: a as i64,
            b: b as i64,
            c: c as i64,
            d: d as i64,
        })
    }

    fn parts(self) -> [i128; 4] {
        [self.a.into(), self.b.into(), self.c.into(), self.d.into()]
    }

    /// The root that a sum or product of two numbers has, if it is again of this form.
    fn common_root(self, other: Self) -> Parsed<i128> {
        match (self.d, other.d) {
            (1, d) | (d, 1) => Ok(d.into()),
            (d, e) if d == e => Ok(d.into()),
            _ => Err("two different roots"),
        }
    }

    fn plus(self, other: Self) -> Parsed<Self> {
        let d = self.common_root(other)?;
        let ([a, b, c, _], [e, f, g, _]) = (self.parts(), other.parts());
        Self::new(a * g + e * c, b * g + f * c, c * g, d)
    }

    fn times(self, other: Self) -> Parsed<Self> {
        let d = self.common_root(other)?;
        let ([a, b, c, _], [e, f, g, _]) = (self.parts(), other.parts());
        Self::new(a * e + b * f * d, a * f + b * e, c * g, d)
    }

    fn negated(self) -> Self {
        Self {
            a: -self.a,
            b: -self.b,
            ..self
        }
    }

    fn inverse(self) -> Parsed<Self> {
        if self.b != 0 {
            return Err("a root in a denominator");
        }
        Self::new(self.c.into(), 0, self.a.into(), 1)
    }

    /// Compares the number with m/2ˢ, exactly; m < 2⁶⁶, s ≤ 64.
    fn compare_with(self, m: i128, s: u32) -> Ordering {
        let [a, b, c, d] = self.parts();
        // a + b·√d against m·c/2ˢ  ⇔  b·√d·2ˢ against m·c − a·2ˢ.
        let left_sign = b.signum();
        let right = m * c - (a << s);
        if left_sign != right.signum() {
            return left_sign.cmp(&right.signum());
        }
        let left_square = shift_wide((b * b * d).unsigned_abs(), 2 * s);
        let by_size = left_square.cmp(&square_wide(right.unsigned_abs()));
        if left_sign < 0 {
            by_size.reverse()
        } else {
            by_size
        }
    }

    /// a and c of a positive fraction a/c; `None` for a number with a root.
    pub(super) fn fraction(self) -> Option<(u64, u64)> {
        let part = |v: i64| u64::try_from(v).ok();
        (self.b == 0).then_some((part(self.a)?, part(self.c)?))
    }

    pub(super) fn strictly_between_one_and_two(self) -> bool {
        self.compare_with(1, 0).is_gt() && self.compare_with(2, 0).is_lt()
    }

    /// The number times 2⁶³, rounded to the nearest integer (a tie goes up); for a number in (1, 2).
    pub(super) fn times_power_63(self) -> u128 {
        // The largest m with m ≤ 2⁶⁴·value, bit by bit; then half of it, rounded.
        let mut floor = 0u128;
        for bit in (0..66).rev() {
            let candidate = floor | 1 << bit;
            if self.compare_with(candidate as i128, 64).is_ge() {
                floor = candidate;
            }
        }
        floor.div_ceil(2)
    }
}

/// value·2^shift as (high, low) of 256 bits; value < 2⁹⁰, shift ≤ 128.
fn shift_wide(value: u128, shift: u32) -> (u128, u128) {
    match shift {
        0 => (0, value),
        128.. => (value << (shift - 128), 0),
        _ => (value >> (128 - shift), value << shift),
    }
}

/// value² as (high, low) of 256 bits.
fn square_wide(value: u128) -> (u128, u128) {
    let (high, low) = (value >> 64, value & u128::from(u64::MAX));
    let cross = high * low;
    let (square, carry) = (low * low).overflowing_add(cross << 65);
    (high * high + (cross >> 63) + u128::from(carry), square)
}

fn gcd(a: i128, b: i128) -> i128 {
    let (mut a, mut b) = (a.abs(), b.abs());
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

impl fmt::Display for Quadratic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { a, b, c, d } = *self;
        let over = |f: &mut fmt::Formatter<'_>| if c == 1 { Ok(()) } else { write!(f, "/{c}") };
        if b == 0 {
            write!(f, "{a}")?;
            return over(f);
        }
        let wrapped = a != 0 && c != 1;
        if wrapped {
            f.write_str("(")?;
        }
        match (a, b.signum()) {
            (0, 1) => {}
            (0, _) => f.write_str("-")?,
            (_, 1) => write!(f, "{a}+")?,
            (_, _) => write!(f, "{a}-")?,
        }
        if b.abs() != 1 {
            write!(f, "{}*", b.abs())?;
        }
        write!(f, "sqrt({d})")?;
        if wrapped {
            f.write_str(")")?;
        }
        over(f)
    }
}

/// Recursive descent over sums, products, signs, roots and parentheses.
struct Parser<'a> {
    rest: &'a str,
}

impl Parser<'_> {
    fn skip_space(&mut self) {
        self.rest = self.rest.trim_start();
    }

    fn eat(&mut self, token: &str) -> bool {
        self.skip_space();
        match self.rest.strip_prefix(token) {
            Some(rest) => {
                self.rest = rest;
                true
            }
            None => false,
        }
    }

    fn sum(&mut self) -> Parsed<Quadratic> {
        let mut value = self.signed_product()?;
        loop {
            if self.eat("+") {
                value = value.plus(self.product()?)?;
            } else if self.eat("-") {
                value = value.plus(self.product()?.negated())?;
            } else {
                return Ok(value);
            }
        }
    }

    fn signed_product(&mut self) -> Parsed<Quadratic> {
        if self.eat("-") {
            return Ok(self.product()?.negated());
        }
        self.eat("+");
        self.product()
    }

    fn product(&mut self) -> Parsed<Quadratic> {
        let mut value = self.primary()?;
        loop {
            if self.eat("*") || self.eat("·") {
                value = value.times(self.primary()?)?;
            } else if self.eat("/") {
                value = value.times(self.primary()?.inverse()?)?;
            } else {
                return Ok(value);
            }
        }
    }

    fn primary(&mut self) -> Parsed<Quadratic> {
        if self.eat("sqrt") {
            if !self.eat("(") {
                return Err("sqrt needs parentheses");
            }
            let inner = self.parenthesized()?;
            root(inner)
        } else if self.eat("√") {
            let inner = self.primary()?;
            root(inner)
        } else if self.eat("(") {
            self.parenthesized()
        } else {
            self.number()
        }
    }

    fn parenthesized(&mut self) -> Parsed<Quadratic> {
        let value = self.sum()?;
        if self.eat(")") {
            Ok(value)
        } else {
            Err("a closing parenthesis is missing")
        }
    }

    fn number(&mut self) -> Parsed<Quadratic> {
        self.skip_space();
        let digits = |text: &str| text.bytes().take_while(u8::is_ascii_digit).count();
        let whole = digits(self.rest);
        let (integer, mut rest) = self.rest.split_at(whole);
        let mut fraction = "";
        if let Some(after) = rest.strip_prefix('.') {
            (fraction, rest) = after.split_at(digits(after));
        }
        if integer.is_empty() && fraction.is_empty() {
            return Err("a number is missing");
        }
        let fraction = fraction.trim_end_matches('0');
        let (mut value, mut scale) = (0i128, 1i128);
        for (i, digit) in integer.bytes().chain(fraction.bytes()).enumerate() {
            value = value * 10 + i128::from(digit - b'0');
            if i >= integer.len() {
                scale *= 10;
            }
            if value > MAX_RATIONAL || scale > MAX_RATIONAL {
                return Err("too many digits (at most 18 after the point)");
            }
        }
        self.rest = rest;
        Quadratic::new(value, 0, scale, 1)
    }
}

/// √n of a positive integer n.
fn root(n: Quadratic) -> Parsed<Quadratic> {
    if n.b != 0 || n.c != 1 || n.a < 1 || i128::from(n.a) > MAX_QUADRATIC {
        return Err("a root of something other than a whole number from 1 to 10^9");
    }
    Quadratic::new(0, 1, 1, n.a.into())
}
