//! Householder reflections that fold rows into an upper triangle (Golub and Van Loan, Matrix
//! Computations, chapter 5), two at a time, of two columns at a time: each column is read and written once
//! for both reflections, and the reflections are read once for both columns.
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
            let rows = &mut *column;
            let heads = &mut heads[i..=i];
            reflect([reflections[i]], [[0.0]], [pivot], [Column { heads, rows }]);
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
    let heads = triangle[(first + N) * width..].chunks_exact_mut(width);
    let mut columns = later
        .chunks_exact_mut(high)
        .zip(heads)
        .map(|(rows, heads)| {
            let (rows, heads) = (&mut rows[..filled], &mut heads[first..][..N]);
            Column { heads, rows }
        });
    while let Some(column) = columns.next() {
        match columns.next() {
            Some(next) => reflect(reflections, products, pivots, [column, next]),
            None => reflect(reflections, products, pivots, [column]),
        }
    }
}

/// Entries of a column: those of the triangle above the pivots, and the new rows.
struct Column<'a> {
    heads: &'a mut [f64],
    rows: &'a mut [Lanes],
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

/// Reflect M columns N times; `products` are those of the pivots with each other.
#[inline(always)]
fn reflect<const N: usize, const M: usize>(
    reflections: [Reflection; N],
    products: [[f64; N]; N],
    pivots: [&[Lanes]; N],
    mut columns: [Column<'_>; M],
) {
    let sums = inner_products(pivots, &columns);
    let mut shares = [[0.0; N]; M];
    for (m, Column { heads, .. }) in columns.iter_mut().enumerate() {
        for k in 0..N {
            // what the reflections before this one take away from the column's product with its pivot
            let taken: f64 = (0..k).map(|i| shares[m][i] * products[i][k]).sum();
            let Reflection { lead, scale } = reflections[k];
            shares[m][k] = scale * (lead * heads[k] + (sums[m][k] - taken));
            heads[k] -= shares[m][k] * lead;
        }
    }
    for i in 0..columns[0].rows.len() {
        for (m, Column { rows, .. }) in columns.iter_mut().enumerate() {
            for k in 0..N {
                rows[i] = plus_products(rows[i], &pivots[k][i], &[-shares[m][k]; LANES]);
            }
        }
    }
}

/// Inner products of the new rows of M columns with N pivots.
#[inline(always)]
fn inner_products<const N: usize, const M: usize>(
    pivots: [&[Lanes]; N],
    columns: &[Column<'_>; M],
) -> [[f64; N]; M] {
    let mut sums = [[[0.0; LANES]; N]; M];
    for i in 0..columns[0].rows.len() {
        for (sums, column) in sums.iter_mut().zip(columns) {
            for (sum, pivot) in sums.iter_mut().zip(&pivots) {
                *sum = plus_products(*sum, &pivot[i], &column.rows[i]);
            }
        }
    }
    let mut products = [[0.0; N]; M];
    for (products, sums) in products.iter_mut().zip(sums) {
        for (product, sum) in products.iter_mut().zip(sums) {
            *product = total(sum);
        }
    }
    products
}

#[inline(always)]
fn inner(a: &[Lanes], b: &[Lanes]) -> f64 {
    let mut sums = [0.0; LANES];
    for (x, y) in a.iter().zip(b) {
        sums = plus_products(sums, x, y);
    }
    total(sums)
}

/// x + ab, lane by lane. Written out: closures and loops over the lanes are at times compiled without the
/// vectors of the processor that a function is for.
#[inline(always)]
fn plus_products(x: Lanes, a: &Lanes, b: &Lanes) -> Lanes {
    [
        x[0] + a[0] * b[0],
        x[1] + a[1] * b[1],
        x[2] + a[2] * b[2],
        x[3] + a[3] * b[3],
        x[4] + a[4] * b[4],
        x[5] + a[5] * b[5],
        x[6] + a[6] * b[6],
        x[7] + a[7] * b[7],
    ]
}

#[inline(always)]
fn total(sums: Lanes) -> f64 {
    // opaque, so that the sums stay in vectors as wide as the processor's while they are formed
    let sums = std::hint::black_box(sums);
    let (low, high) = sums.split_at(LANES / 2);
    let half = |i: usize| low[i] + high[i];
    (half(0) + half(2)) + (half(1) + half(3))
}
