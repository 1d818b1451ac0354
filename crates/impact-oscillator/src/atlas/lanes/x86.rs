//! Four and eight lanes of x86-64: AVX2 with FMA, and AVX-512.

use std::arch::x86_64::*;

use super::Lanes;

/// Four lanes, AVX2 and FMA.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub(in crate::atlas) struct Avx2(__m256d);

/// Eight lanes, AVX-512 F.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub(in crate::atlas) struct Avx512(__m512d);

/// The methods of [`Lanes`] that are one instruction: of one number, of one vector, of two and of
/// three vectors.
macro_rules! instructions {
    ($splat:ident; $($one:ident $f1:ident),*; $($two:ident $f2:ident),*; $($three:ident $f3:ident),*) => {
        #[inline(always)]
        fn splat(a: f64) -> Self {
            Self(unsafe { $splat(a) })
        }
        $(#[inline(always)]
        fn $one(self) -> Self {
            Self(unsafe { $f1(self.0) })
        })*
        $(#[inline(always)]
        fn $two(self, b: Self) -> Self {
            Self(unsafe { $f2(self.0, b.0) })
        })*
        $(#[inline(always)]
        fn $three(self, b: Self, c: Self) -> Self {
            Self(unsafe { $f3(self.0, b.0, c.0) })
        })*
    };
}

// SAFETY of all blocks below: the caller of a kernel over these types has checked that the
// processor has the instruction set (see `Kernel::is_available`).
impl Lanes for Avx2 {
    const WIDTH: usize = 4;
    type Mask = __m256d;
    instructions!(
        _mm256_set1_pd;
        sqrt _mm256_sqrt_pd;
        add _mm256_add_pd, sub _mm256_sub_pd, mul _mm256_mul_pd, div _mm256_div_pd,
        min _mm256_min_pd, max _mm256_max_pd;
        mul_add _mm256_fmadd_pd, neg_mul_add _mm256_fnmadd_pd, mul_sub _mm256_fmsub_pd
    );
    #[inline(always)]
    fn abs(self) -> Self {
        Self(unsafe { _mm256_andnot_pd(_mm256_set1_pd(-0.0), self.0) })
    }
    #[inline(always)]
    fn reciprocal_rough(self) -> Self {
        Self(unsafe { _mm256_cvtps_pd(_mm_rcp_ps(_mm256_cvtpd_ps(self.0))) })
    }
    #[inline(always)]
    fn lt(self, b: Self) -> __m256d {
        unsafe { _mm256_cmp_pd::<_CMP_LT_OQ>(self.0, b.0) }
    }
    #[inline(always)]
    fn le(self, b: Self) -> __m256d {
        unsafe { _mm256_cmp_pd::<_CMP_LE_OQ>(self.0, b.0) }
    }
    #[inline(always)]
    fn and(a: __m256d, b: __m256d) -> __m256d {
        unsafe { _mm256_and_pd(a, b) }
    }
    #[inline(always)]
    fn and_not(a: __m256d, b: __m256d) -> __m256d {
        unsafe { _mm256_andnot_pd(b, a) }
    }
    #[inline(always)]
    fn or(a: __m256d, b: __m256d) -> __m256d {
        unsafe { _mm256_or_pd(a, b) }
    }
    #[inline(always)]
    fn or_else(self, mask: __m256d, other: Self) -> Self {
        Self(unsafe { _mm256_blendv_pd(other.0, self.0, mask) })
    }
    #[inline(always)]
    fn bits(mask: __m256d) -> u32 {
        unsafe { _mm256_movemask_pd(mask) }.cast_unsigned()
    }
}

impl Lanes for Avx512 {
    const WIDTH: usize = 8;
    type Mask = __mmask8;
    instructions!(
        _mm512_set1_pd;
        sqrt _mm512_sqrt_pd, abs _mm512_abs_pd, reciprocal_rough _mm512_rcp14_pd;
        add _mm512_add_pd, sub _mm512_sub_pd, mul _mm512_mul_pd, div _mm512_div_pd,
        min _mm512_min_pd, max _mm512_max_pd;
        mul_add _mm512_fmadd_pd, neg_mul_add _mm512_fnmadd_pd, mul_sub _mm512_fmsub_pd
    );
    #[inline(always)]
    fn lt(self, b: Self) -> __mmask8 {
        unsafe { _mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.0, b.0) }
    }
    #[inline(always)]
    fn le(self, b: Self) -> __mmask8 {
        unsafe { _mm512_cmp_pd_mask::<_CMP_LE_OQ>(self.0, b.0) }
    }
    #[inline(always)]
    fn and(a: __mmask8, b: __mmask8) -> __mmask8 {
        a & b
    }
    #[inline(always)]
    fn and_not(a: __mmask8, b: __mmask8) -> __mmask8 {
        a & !b
    }
    #[inline(always)]
    fn or(a: __mmask8, b: __mmask8) -> __mmask8 {
        a | b
    }
    #[inline(always)]
    fn or_else(self, mask: __mmask8, other: Self) -> Self {
        Self(unsafe { _mm512_mask_blend_pd(mask, other.0, self.0) })
    }
    #[inline(always)]
    fn bits(mask: __mmask8) -> u32 {
        u32::from(mask)
    }
}
