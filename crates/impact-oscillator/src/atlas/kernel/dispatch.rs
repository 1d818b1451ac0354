//! The kernel for every instruction set, chosen at run time by what the processor has.

use serde::{Deserialize, Serialize};

use super::cell::{Course, Feed};
use super::march::march;
use crate::atlas::lanes::Two;

/// Instruction sets that the kernel is compiled for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kernel {
    /// One lane, any processor.
    Scalar,
    /// Four lanes.
    Avx2,
    /// Eight lanes.
    Avx512,
}

impl Kernel {
    /// The widest kernel that this processor runs.
    pub fn of_this_machine() -> Self {
        [Self::Avx512, Self::Avx2]
            .into_iter()
            .find(|k| k.is_available())
            .unwrap_or(Self::Scalar)
    }

    /// Whether this processor runs it.
    pub fn is_available(self) -> bool {
        match self {
            Self::Scalar => true,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma"),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => {
                is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx2")
                    && is_x86_feature_detected!("fma")
            }
            #[cfg(not(target_arch = "x86_64"))]
            _ => false,
        }
    }
}

/// Greatest β for which the short polynomial of the decay is exact to rounding.
const LIGHT_DAMPING: f64 = 0.08;

/// March a feed with a kernel that this processor runs.
pub(in crate::atlas) fn run(kernel: Kernel, course: &Course, feed: &mut impl Feed) {
    let light = course.damping_ratio <= LIGHT_DAMPING;
    match kernel {
        Kernel::Scalar if light => march::<Two<f64>, 8>(course, feed),
        Kernel::Scalar => march::<Two<f64>, 17>(course, feed),
        // SAFETY: `march_all` and the caller checked that the processor has the instruction set.
        #[cfg(target_arch = "x86_64")]
        Kernel::Avx2 => unsafe { x86::march_avx2(light, course, feed) },
        // SAFETY: as above.
        #[cfg(target_arch = "x86_64")]
        Kernel::Avx512 => unsafe { x86::march_avx512(light, course, feed) },
        #[cfg(not(target_arch = "x86_64"))]
        _ => march::<Two<f64>, 17>(course, feed),
    }
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::{Course, Feed, march};
    use crate::atlas::lanes::Two;
    use crate::atlas::lanes::x86::{Avx2, Avx512};

    #[target_feature(enable = "avx2,fma")]
    pub(super) fn march_avx2(light: bool, course: &Course, feed: &mut impl Feed) {
        if light {
            march::<Two<Avx2>, 8>(course, feed);
        } else {
            march::<Two<Avx2>, 17>(course, feed);
        }
    }

    #[target_feature(enable = "avx512f,avx2,fma")]
    pub(super) fn march_avx512(light: bool, course: &Course, feed: &mut impl Feed) {
        if light {
            march::<Two<Avx512>, 8>(course, feed);
        } else {
            march::<Two<Avx512>, 17>(course, feed);
        }
    }
}
