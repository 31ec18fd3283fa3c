//! The square root, which IEEE 754 rounds the same way everywhere.
//!
//! Stable Rust's `core` has none. libm's has the same bits, but with SSE it is an instruction in the old encoding
//! behind the compiler's back: it never takes two numbers at once, and in a program built for AVX it stalls the vector
//! units (a whole solve was three times slower). There the instruction is asked for by its intrinsic.

#[cfg(all(any(target_arch = "x86", target_arch = "x86_64"), target_feature = "sse2"))]
mod machine {
    use safe_arch::{get_f64_from_m128d_s, m128d, set_m128d_s, sqrt_m128d, sqrt_m128d_s};

    #[inline(always)]
    pub(crate) fn sqrt(x: f64) -> f64 {
        let x = set_m128d_s(x);
        get_f64_from_m128d_s(sqrt_m128d_s(x, x))
    }

    #[inline(always)]
    pub(crate) fn sqrt_pair(pair: [f64; 2]) -> [f64; 2] {
        sqrt_m128d(m128d::from_array(pair)).to_array()
    }
}

#[cfg(not(all(any(target_arch = "x86", target_arch = "x86_64"), target_feature = "sse2")))]
mod machine {
    #[inline(always)]
    #[expect(clippy::disallowed_methods, reason = "the one place where it is used")]
    pub(crate) fn sqrt(x: f64) -> f64 {
        libm::sqrt(x)
    }

    #[inline(always)]
    pub(crate) fn sqrt_pair(pair: [f64; 2]) -> [f64; 2] {
        pair.map(sqrt)
    }
}

pub(crate) use machine::{sqrt, sqrt_pair};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[expect(clippy::disallowed_methods, reason = "what it is compared with")]
    fn has_the_bits_of_libm() {
        let mut bits = 0x9e37_79b9_7f4a_7c15_u64;
        let special =
            [0.0, -0.0, f64::INFINITY, f64::MIN_POSITIVE, 5e-324, f64::MAX, 1.0 + f64::EPSILON, 2.0, 4.0];
        for k in 0..200_000 {
            bits ^= bits << 13;
            bits ^= bits >> 7;
            bits ^= bits << 17;
            let x = special.get(k).copied().unwrap_or(f64::from_bits(bits).abs());
            let (one, pair) = (sqrt(x), sqrt_pair([x, 2.0]));
            let of_libm = libm::sqrt(x);
            assert!(one.to_bits() == of_libm.to_bits() || (one.is_nan() && of_libm.is_nan()), "{x:e}");
            assert!(pair[0].to_bits() == one.to_bits() && pair[1].to_bits() == libm::sqrt(2.0).to_bits());
        }
        assert!(sqrt(-1.0).is_nan() && sqrt_pair([1.0, -1.0])[1].is_nan());
    }
}
