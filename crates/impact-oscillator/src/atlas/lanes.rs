//! Vectors of f64 of several widths behind one trait, so that the marching kernel is written
//! once: AVX-512, AVX2 with FMA, and one lane of plain arithmetic for every other machine.
//!
//! The methods are inlined into functions that enable the instruction set; they must only be
//! called where the processor has it, which [`Kernel`](super::kernel::Kernel) checks at run time.

#[cfg(target_arch = "x86_64")]
pub(super) mod x86;

/// A vector of lanes.
pub(super) trait Lanes: Copy {
    /// Number of lanes.
    const WIDTH: usize;
    /// One truth value per lane.
    type Mask: Copy;
    /// The same number in every lane.
    fn splat(a: f64) -> Self;
    /// self + b
    fn add(self, b: Self) -> Self;
    /// self − b
    fn sub(self, b: Self) -> Self;
    /// self · b
    fn mul(self, b: Self) -> Self;
    /// self / b
    fn div(self, b: Self) -> Self;
    /// self · b + c
    fn mul_add(self, b: Self, c: Self) -> Self;
    /// c − self · b
    fn neg_mul_add(self, b: Self, c: Self) -> Self;
    /// self · b − c
    fn mul_sub(self, b: Self, c: Self) -> Self;
    /// Smaller of both.
    fn min(self, b: Self) -> Self;
    /// Greater of both.
    fn max(self, b: Self) -> Self;
    /// |self|
    fn abs(self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// 1/self to three digits at least; anything where self is zero or less.
    fn reciprocal_rough(self) -> Self;
    /// self < b
    fn lt(self, b: Self) -> Self::Mask;
    /// self ≤ b
    fn le(self, b: Self) -> Self::Mask;
    /// Both.
    fn and(a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// The first without the second.
    fn and_not(a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// Either.
    fn or(a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// Where the mask holds `self`, elsewhere `other`.
    fn or_else(self, mask: Self::Mask, other: Self) -> Self;
    /// One bit per lane, lane 0 lowest.
    fn bits(mask: Self::Mask) -> u32;
    /// The value in one lane.
    fn get(&self, lane: usize) -> f64 {
        assert!(lane < Self::WIDTH);
        // SAFETY: every implementor is WIDTH f64 in memory without padding.
        unsafe { *std::ptr::from_ref(self).cast::<f64>().add(lane) }
    }
    /// Set the value in one lane.
    fn set(&mut self, lane: usize, value: f64) {
        assert!(lane < Self::WIDTH);
        // SAFETY: as in `get`.
        unsafe { *std::ptr::from_mut(self).cast::<f64>().add(lane) = value }
    }
}

impl Lanes for f64 {
    const WIDTH: usize = 1;
    type Mask = bool;
    #[inline(always)]
    fn splat(a: f64) -> Self {
        a
    }
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        self + b
    }
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        self - b
    }
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        self * b
    }
    #[inline(always)]
    fn div(self, b: Self) -> Self {
        self / b
    }
    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        self * b + c
    }
    #[inline(always)]
    fn neg_mul_add(self, b: Self, c: Self) -> Self {
        c - self * b
    }
    #[inline(always)]
    fn mul_sub(self, b: Self, c: Self) -> Self {
        self * b - c
    }
    #[inline(always)]
    fn min(self, b: Self) -> Self {
        if self < b { self } else { b }
    }
    #[inline(always)]
    fn max(self, b: Self) -> Self {
        if self > b { self } else { b }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self::abs(self)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::sqrt(self)
    }
    #[inline(always)]
    fn reciprocal_rough(self) -> Self {
        1.0 / self
    }
    #[inline(always)]
    fn lt(self, b: Self) -> bool {
        self < b
    }
    #[inline(always)]
    fn le(self, b: Self) -> bool {
        self <= b
    }
    #[inline(always)]
    fn and(a: bool, b: bool) -> bool {
        a & b
    }
    #[inline(always)]
    fn and_not(a: bool, b: bool) -> bool {
        a & !b
    }
    #[inline(always)]
    fn or(a: bool, b: bool) -> bool {
        a | b
    }
    #[inline(always)]
    fn or_else(self, mask: bool, other: Self) -> Self {
        if mask { self } else { other }
    }
    #[inline(always)]
    fn bits(mask: bool) -> u32 {
        u32::from(mask)
    }
}

/// Methods of two vectors side by side: of one, two and three operands, and comparisons.
macro_rules! both {
    ($($one:ident),*; $($two:ident),*; $($three:ident),*; $($compare:ident),*; $($logic:ident),*) => {
        $(#[inline(always)]
        fn $one(self) -> Self {
            Self(self.0.$one(), self.1.$one())
        })*
        $(#[inline(always)]
        fn $two(self, b: Self) -> Self {
            Self(self.0.$two(b.0), self.1.$two(b.1))
        })*
        $(#[inline(always)]
        fn $three(self, b: Self, c: Self) -> Self {
            Self(self.0.$three(b.0, c.0), self.1.$three(b.1, c.1))
        })*
        $(#[inline(always)]
        fn $compare(self, b: Self) -> Self::Mask {
            (self.0.$compare(b.0), self.1.$compare(b.1))
        })*
        $(#[inline(always)]
        fn $logic(a: Self::Mask, b: Self::Mask) -> Self::Mask {
            (V::$logic(a.0, b.0), V::$logic(a.1, b.1))
        })*
    };
}

/// Two vectors side by side: their instructions interleave, which hides the latency of each.
#[derive(Clone, Copy)]
#[repr(C)]
pub(super) struct Two<V>(V, V);

impl<V: Lanes> Lanes for Two<V> {
    const WIDTH: usize = 2 * V::WIDTH;
    type Mask = (V::Mask, V::Mask);
    both!(
        abs, sqrt, reciprocal_rough;
        add, sub, mul, div, min, max;
        mul_add, neg_mul_add, mul_sub;
        lt, le;
        and, and_not, or
    );
    #[inline(always)]
    fn splat(a: f64) -> Self {
        Self(V::splat(a), V::splat(a))
    }
    #[inline(always)]
    fn or_else(self, mask: Self::Mask, other: Self) -> Self {
        Self(
            self.0.or_else(mask.0, other.0),
            self.1.or_else(mask.1, other.1),
        )
    }
    #[inline(always)]
    fn bits(mask: Self::Mask) -> u32 {
        V::bits(mask.0) | (V::bits(mask.1) << V::WIDTH)
    }
}
