//! Thumb machine code, as far as calls and the stack are concerned: where a function goes, and what it pushes.

/// Where an instruction may go beside to the next one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Go {
    /// To an address, for good or as a call.
    To(u64),
    /// To where a register or memory says: a function pointer.
    Anywhere,
}

/// One instruction: its length in bytes, where it goes, how many bytes it takes from the stack.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Instruction {
    /// 2 or 4.
    pub bytes: u64,
    /// Calls and jumps.
    pub go: Option<Go>,
    /// Bytes pushed, or by which the stack pointer is lowered.
    pub pushed: u64,
}

/// The low `bits` of a number as a signed offset.
fn signed(value: u32, bits: u32) -> i64 {
    i64::from((value << (32 - bits)) as i32 >> (32 - bits))
}

/// The instruction at an address, from its first half-word and the one after it (Arm v7-M reference manual, chapter A7).
///
/// Returns to the caller (`bx lr`, and `pc` among what is popped) and jumps through a table of the function's own go nowhere.
pub fn decode(address: u64, first: u16, second: u16) -> Instruction {
    let (a, b) = (u32::from(first), u32::from(second));
    let bit = |word: u32, n: u32| (word >> n) & 1;
    let to = |offset: i64| Some(Go::To((address + 4).wrapping_add_signed(offset)));
    if a >> 11 < 0b11101 {
        let go = match a {
            // B, with a condition and without.
            _ if a >> 12 == 0b1101 && (a >> 8) & 15 < 14 => to(signed((a & 0xff) << 1, 9)),
            _ if a >> 11 == 0b11100 => to(signed((a & 0x7ff) << 1, 12)),
            // CBZ, CBNZ.
            _ if a & 0xf500 == 0xb100 => to(i64::from((bit(a, 9) << 6) | ((a >> 3) & 31) << 1)),
            // BX and BLX by a register; MOV to the program counter.
            _ if a & 0xff00 == 0x4700 && a != 0x4770 => Some(Go::Anywhere),
            _ if a & 0xff87 == 0x4687 => Some(Go::Anywhere),
            _ => None,
        };
        let pushed = match a {
            _ if a >> 9 == 0b101_1010 => 4 * u64::from((a & 0x1ff).count_ones()),
            _ if a >> 7 == 0b1_0110_0001 => 4 * u64::from(a & 0x7f),
            _ => 0,
        };
        return Instruction { bytes: 2, go, pushed };
    }
    let branch = a >> 11 == 0b11110 && bit(b, 15) == 1;
    let sign = bit(a, 10);
    let go = if branch && (bit(b, 12) == 1) {
        // BL and B without a condition.
        let [i1, i2] = [13, 11].map(|n| bit(b, n) ^ sign ^ 1);
        to(signed((sign << 24) | (i1 << 23) | (i2 << 22) | ((a & 0x3ff) << 12) | ((b & 0x7ff) << 1), 25))
    } else if branch && bit(b, 14) == 0 && (a >> 6) & 15 < 14 {
        let offset =
            (sign << 20) | (bit(b, 11) << 19) | (bit(b, 13) << 18) | ((a & 63) << 12) | ((b & 0x7ff) << 1);
        to(signed(offset, 21))
    } else if (a & 0xff70 == 0xf850 && b >> 12 == 15) && !(a == 0xf85d && b & 0xfff == 0xb04) {
        // LDR to the program counter, but for POP.
        Some(Go::Anywhere)
    } else {
        None
    };
    let twelve_bits = (sign << 11) | ((b >> 4) & 0x700) | (b & 0xff);
    let pushed = match (a, b) {
        // STMDB sp!, STR [sp, #-n]!, VPUSH, SUB sp.
        (0xe92d, _) => 4 * u64::from(b.count_ones()),
        (0xf84d, _) if b & 0xf00 == 0xd00 => u64::from(b & 0xff),
        (0xed2d | 0xed6d, _) => 4 * u64::from(b & 0xff),
        (0xf2ad | 0xf6ad, _) if b & 0x8f00 == 0x0d00 => u64::from(twelve_bits),
        (0xf1ad | 0xf5ad, _) if b & 0x8f00 == 0x0d00 => u64::from(expand(twelve_bits)),
        _ => 0,
    };
    Instruction { bytes: 4, go, pushed }
}

/// `ThumbExpandImm` of twelve bits.
fn expand(imm: u32) -> u32 {
    let byte = imm & 0xff;
    match imm >> 8 {
        0 => byte,
        1 => byte << 16 | byte,
        2 => byte << 24 | byte << 8,
        3 => byte * 0x0101_0101,
        _ => (0x80 | imm & 0x7f).rotate_right(imm >> 7),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(first: u16, second: u16) -> (u64, Option<Go>, u64) {
        let found = decode(0x1000, first, second);
        (found.bytes, found.go, found.pushed)
    }

    #[test]
    fn calls_and_jumps_go_where_the_assembler_says() {
        // Assembled at 0x1000: bl, b.w, b, beq, beq.w, cbz, blx r3, bx r4, mov pc, r1, ldr.w pc, [r0].
        assert_eq!(of(0xf000, 0xf87e), (4, Some(Go::To(0x1100)), 0));
        assert_eq!(of(0xf7ff, 0xbf7e), (4, Some(Go::To(0xf00)), 0));
        assert_eq!(of(0xe7fe, 0), (2, Some(Go::To(0x1000)), 0));
        assert_eq!(of(0xd07e, 0), (2, Some(Go::To(0x1100)), 0));
        assert_eq!(of(0xf000, 0x807e), (4, Some(Go::To(0x1100)), 0));
        assert_eq!(of(0xb1f8, 0), (2, Some(Go::To(0x1042)), 0));
        for (first, second) in [(0x4798, 0), (0x4720, 0), (0x468f, 0), (0xf8d0, 0xf000)] {
            assert_eq!(of(first, second).1, Some(Go::Anywhere), "{first:x}");
        }
    }

    #[test]
    fn returns_and_arithmetic_go_nowhere() {
        // bx lr, pop {r4, pc}, pop.w {pc}, vadd.f64, add.
        for (first, second) in [(0x4770, 0), (0xbd10, 0), (0xf85d, 0xfb04), (0xee30, 0x0b01), (0x1840, 0)] {
            assert_eq!(of(first, second).1, None, "{first:x}");
        }
    }

    #[test]
    fn what_is_pushed_is_counted() {
        // push {r4, r7, lr}, sub sp, #16, push.w {r4-r11, lr}, vpush {d8-d15}, sub.w sp, #2304, subw sp, #2316,
        // str lr, [sp, #-4]!.
        assert_eq!(of(0xb590, 0).2, 12);
        assert_eq!(of(0xb084, 0).2, 16);
        assert_eq!(of(0xe92d, 0x4ff0).2, 36);
        assert_eq!(of(0xed2d, 0x8b10).2, 64);
        assert_eq!(of(0xf5ad, 0x6d10).2, 2304);
        assert_eq!(of(0xf6ad, 0x1d0c).2, 2316);
        assert_eq!(of(0xf84d, 0xed04).2, 4);
    }
}
