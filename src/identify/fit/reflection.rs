//! Householder reflections that fold rows into an upper triangle (Golub and Van Loan, Matrix
//! Computations, chapter 5), two at a time: each column is read and written once for both.
//!
//! The same arithmetic, in the same order, on vectors of any width: no bit depends on the processor.

use multiversion::multiversion;

/// Rows that are held together, so that a column needs no loop over what remains.
const LANES: usize = 8;
type Lanes = [f64; LANES];

/// Columns that are reflected together.
const PANEL: usize = 2;

/// Square of rows that are nothing: what rounding leaves of rounding, whose reciprocal overflows.
const NOTHING: f64 = 1e-280;

/// Rows that are to be folded into a triangle, column by column, filled up with rows of zeros.
pub(super) struct NewRows {
    columns: Vec<Lanes>,
    /// Lanes of a column.
    high: usize,
}

impl NewRows {
    /// So many rows of zeros over so many columns.
    pub(super) fn zeros(width: usize, height: usize) -> Self {
        let high = height.div_ceil(LANES).max(1);
        Self {
            columns: vec![[0.0; LANES]; width * high],
            high,
        }
    }

    /// Entries of a column.
    pub(super) fn column_mut(&mut self, i: usize) -> &mut [f64] {
        self.columns[i * self.high..][..self.high].as_flattened_mut()
    }

    /// Fold them into an upper triangle, which is given column by column.
    pub(super) fn fold_into(mut self, triangle: &mut [f64]) {
        let filled = self.filled();
        fold(triangle, &mut self.columns, &filled);
    }

    /// Of each column the lanes that it and those before it have entries in.
    fn filled(&self) -> Vec<usize> {
        let mut most = 0;
        let columns = self.columns.chunks_exact(self.high);
        let last = |column: &[Lanes]| column.iter().rposition(|x| *x != [0.0; LANES]);
        columns
            .map(|column| {
                most = most.max(last(column).map_or(0, |i| i + 1));
                most
            })
            .collect()
    }
}

#[multiversion(targets("x86_64+avx2"))]
fn fold(triangle: &mut [f64], rows: &mut [Lanes], filled: &[usize]) {
    let mut first = 0;
    while first + PANEL <= filled.len() {
        fold_panel::<PANEL>(triangle, rows, filled, first);
        first += PANEL;
    }
    for last in first..filled.len() {
        fold_panel::<1>(triangle, rows, filled, last);
    }
}

/// Fold the rows of N columns, from the first on, into the diagonal entries, and reflect the rows of all
/// later columns.
#[inline(always)]
fn fold_panel<const N: usize>(
    triangle: &mut [f64],
    rows: &mut [Lanes],
    filled: &[usize],
    first: usize,
) {
    let (width, high) = (filled.len(), rows.len() / filled.len());
    let filled = filled[first + N - 1];
    let (done, later) = rows.split_at_mut((first + N) * high);
    let panel = &mut done[first * high..];
    let mut reflections = [Reflection::default(); N];
    let mut products = [[0.0; N]; N];
    for k in 0..N {
        let (before, column) = panel.split_at_mut(k * high);
        let column = &mut column[..filled];
        let heads = &mut triangle[(first + k) * width + first..][..=k];
        for (i, pivot) in before.chunks_exact(high).enumerate() {
            let pivot = [&pivot[..filled]];
            reflect([reflections[i]], [[0.0]], pivot, &mut heads[i..=i], column);
        }
        reflections[k] = Reflection::of(&mut heads[k], column);
        for (i, pivot) in before.chunks_exact(high).enumerate() {
            products[i][k] = inner(pivot, column);
        }
    }
    if reflections.iter().all(|r| r.scale == 0.0) {
        return;
    }
    let pivots = std::array::from_fn(|k| &panel[k * high..][..filled]);
    for (i, column) in later.chunks_exact_mut(high).enumerate() {
        let heads = &mut triangle[(first + N + i) * width + first..][..N];
        reflect(reflections, products, pivots, heads, &mut column[..filled]);
    }
}

/// I − scale·vvᵀ with v = (lead, pivot); a scale of zero reflects nothing.
#[derive(Clone, Copy, Default)]
struct Reflection {
    lead: f64,
    scale: f64,
}

impl Reflection {
    /// That which folds a pivot into the head above it.
    #[inline(always)]
    fn of(head: &mut f64, pivot: &[Lanes]) -> Self {
        let below = inner(pivot, pivot);
        if below < NOTHING {
            return Self::default();
        }
        let top = *head;
        *head = -(top * top + below).sqrt().copysign(top);
        let lead = top - *head;
        // vᵀv = −2·head·lead
        Self {
            lead,
            scale: -(*head * lead).recip(),
        }
    }
}

/// Reflect a column N times; `products` are those of the pivots with each other.
#[inline(always)]
fn reflect<const N: usize>(
    reflections: [Reflection; N],
    products: [[f64; N]; N],
    pivots: [&[Lanes]; N],
    heads: &mut [f64],
    column: &mut [Lanes],
) {
    let pivots: [&[Lanes]; N] = pivots.map(|pivot| &pivot[..column.len()]);
    let mut sums = [[0.0; LANES]; N];
    for (i, x) in column.iter().enumerate() {
        for k in 0..N {
            sums[k] = std::array::from_fn(|l| sums[k][l] + pivots[k][i][l] * x[l]);
        }
    }
    let mut shares = [0.0; N];
    for k in 0..N {
        // what the reflections before this one take away from the column's product with its pivot
        let taken: f64 = (0..k).map(|i| shares[i] * products[i][k]).sum();
        let Reflection { lead, scale } = reflections[k];
        shares[k] = scale * (lead * heads[k] + (total(sums[k]) - taken));
        heads[k] -= shares[k] * lead;
    }
    for (i, x) in column.iter_mut().enumerate() {
        for k in 0..N {
            *x = std::array::from_fn(|l| x[l] - shares[k] * pivots[k][i][l]);
        }
    }
}

#[inline(always)]
fn inner(a: &[Lanes], b: &[Lanes]) -> f64 {
    let mut sums = [0.0; LANES];
    for (x, y) in a.iter().zip(b) {
        sums = std::array::from_fn(|l| sums[l] + x[l] * y[l]);
    }
    total(sums)
}

#[inline(always)]
fn total(sums: Lanes) -> f64 {
    let [a, b, c, d, e, f, g, h] = sums;
    ((a + e) + (c + g)) + ((b + f) + (d + h))
}
