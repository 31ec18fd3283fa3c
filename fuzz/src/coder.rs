//! Bytes to cases, and cases to bytes. A case says once, field by field, what it consists of; [`Reading`] fills the fields from
//! the fuzzer's bytes, [`Writing`] makes of a good case the bytes that would give it.

/// One pass over the fields of a case, in order.
pub trait Coder {
    /// A small choice or a count.
    fn byte(&mut self, x: &mut u8);
    /// Any number of 32 bits.
    fn word(&mut self, x: &mut u32);
    /// A double: mostly one that a designer would give, but any bit pattern is possible.
    fn number(&mut self, x: &mut f64);

    /// A vector.
    fn vector(&mut self, x: &mut [f64; 3]) {
        x.iter_mut().for_each(|x| self.number(x));
    }

    /// One of these words, the first before all, or any word.
    fn one_of(&mut self, x: &mut u32, usual: &[u32]) {
        let known = usual.iter().position(|usual| usual == x);
        let mut choice = known.map_or(u8::MAX, |known| known as u8);
        self.byte(&mut choice);
        if choice < ANY {
            *x = usual[usize::from(choice) % usual.len()];
        } else {
            self.word(x);
        }
    }

    /// One of these numbers, the first before all, or any number.
    fn number_of(&mut self, x: &mut f64, usual: &[f64]) {
        let known = usual.iter().position(|usual| usual.to_bits() == x.to_bits());
        let mut choice = known.map_or(u8::MAX, |known| known as u8);
        self.byte(&mut choice);
        if choice < ANY {
            *x = usual[usize::from(choice) % usual.len()];
        } else {
            self.number(x);
        }
    }

    /// A list of at most `most` entries.
    fn list<T: Clone>(
        &mut self,
        list: &mut Vec<T>,
        most: u8,
        empty: T,
        mut each: impl FnMut(&mut Self, &mut T),
    ) where
        Self: Sized,
    {
        let mut count = list.len() as u8;
        self.byte(&mut count);
        list.resize(usize::from(count % (most + 1)), empty);
        list.iter_mut().for_each(|one| each(self, one));
    }
}

/// Choices from here on are followed by the word or number itself.
const ANY: u8 = 240;

/// What breaks arithmetic, and the limits that minvar's own checks have.
const SPECIAL: [f64; 24] = [
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    -0.0,
    5e-324,
    f64::MIN_POSITIVE,
    f64::MAX,
    f64::MIN,
    f64::EPSILON,
    1e-12,
    1e-9,
    1e-6,
    1e-3,
    1e6,
    1e90,
    1.1e90,
    1e-90,
    0.9e-90,
    1e100,
    1.1e100,
    1e154,
    1e-154,
    0.27,
    std::f64::consts::PI,
];

/// A number's first byte: eighths from here on,
const EIGHTHS: u8 = 0;
/// then [`SPECIAL`],
const SPECIALS: u8 = 161;
/// the eight numbers read last,
const AGAIN: u8 = SPECIALS + SPECIAL.len() as u8;
/// the same but for the last bit, up and down,
const NUDGED: u8 = AGAIN + 8;
/// the same with the other sign,
const NEGATED: u8 = NUDGED + 16;
/// hundredths in two bytes,
const HUNDREDTHS: u8 = NEGATED + 8;
/// single precision in four bytes,
const SINGLE: u8 = HUNDREDTHS + 10;
/// a bit pattern in eight.
const BITS: u8 = SINGLE + 8;

const _: () = assert!(BITS < 250);

/// Takes fields from bytes; where they end, all is zero.
pub struct Reading<'a> {
    bytes: &'a [u8],
    last: [f64; 8],
    at: usize,
}

impl<'a> Reading<'a> {
    /// From the fuzzer's bytes.
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, last: [0.0; 8], at: 0 }
    }

    fn take<const N: usize>(&mut self) -> [u8; N] {
        let mut out = [0; N];
        let count = N.min(self.bytes.len());
        let (now, rest) = self.bytes.split_at(count);
        out[..count].copy_from_slice(now);
        self.bytes = rest;
        out
    }

    fn earlier(&self, back: u8) -> f64 {
        self.last[(self.at + 7 - usize::from(back) % 8) % 8]
    }
}

impl Coder for Reading<'_> {
    fn byte(&mut self, x: &mut u8) {
        [*x] = self.take();
    }

    fn word(&mut self, x: &mut u32) {
        *x = u32::from_le_bytes(self.take());
    }

    fn number(&mut self, x: &mut f64) {
        let [tag] = self.take();
        *x = match tag {
            EIGHTHS..SPECIALS => (f64::from(tag) - 80.0) / 8.0,
            SPECIALS..AGAIN => SPECIAL[usize::from(tag - SPECIALS)],
            AGAIN..NUDGED => self.earlier(tag - AGAIN),
            NUDGED..NEGATED => {
                let (back, up) = ((tag - NUDGED) / 2, tag % 2 == 0);
                let x = self.earlier(back);
                if up { x.next_up() } else { x.next_down() }
            }
            NEGATED..HUNDREDTHS => -self.earlier(tag - NEGATED),
            HUNDREDTHS..SINGLE => f64::from(i16::from_le_bytes(self.take())) / 100.0,
            SINGLE..BITS => f64::from(f32::from_le_bytes(self.take())),
            _ => f64::from_le_bytes(self.take()),
        };
        self.last[self.at % 8] = *x;
        self.at += 1;
    }
}

/// Turns fields into bytes.
#[derive(Default)]
pub struct Writing {
    /// What [`Reading`] makes the same case of.
    pub bytes: Vec<u8>,
}

impl Coder for Writing {
    fn byte(&mut self, x: &mut u8) {
        self.bytes.push(*x);
    }

    fn word(&mut self, x: &mut u32) {
        self.bytes.extend(x.to_le_bytes());
    }

    fn number(&mut self, x: &mut f64) {
        let tag = (*x * 8.0 + 80.0).clamp(0.0, 160.0) as u8;
        if ((f64::from(tag) - 80.0) / 8.0).to_bits() == x.to_bits() {
            self.bytes.push(tag);
        } else {
            self.bytes.push(BITS);
            self.bytes.extend(x.to_le_bytes());
        }
    }
}
