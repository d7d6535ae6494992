//! The small linear systems of each particle: B, B̂, inverses.

/// A pivot below this fraction of the largest entry is rounding: the system is singular.
const LEAST_PIVOT: f64 = 1e-13;

/// Inverts each 2 × 2 matrix of the columns; says at which place the first singular one stands.
pub(super) fn invert_2(m: [&[f64]; 4], out: [&mut [f64]; 4]) -> Option<usize> {
    let [xx, xy, yx, yy] = out;
    let mut worst = f64::INFINITY;
    for place in 0..xx.len() {
        let (a, b, c, d) = (m[0][place], m[1][place], m[2][place], m[3][place]);
        let determinant = a * d - b * c;
        let largest = a.abs().max(b.abs()).max(c.abs().max(d.abs()));
        // Not a number where the matrix is not one either; `min` would pass over it.
        let margin = determinant.abs() - LEAST_PIVOT * largest * largest;
        worst = if margin > 0.0 { worst } else { -1.0 };
        let inverse = 1.0 / determinant;
        // By column of the inverse: right side, then unknown.
        xx[place] = d * inverse;
        xy[place] = -c * inverse;
        yx[place] = -b * inverse;
        yy[place] = a * inverse;
    }
    let is_singular = |place: usize| {
        let [a, b, c, d] = m.map(|column| column[place]);
        let largest = a.abs().max(b.abs()).max(c.abs().max(d.abs()));
        let regular = (a * d - b * c).abs() > LEAST_PIVOT * largest * largest;
        !regular
    };
    if worst < 0.0 { (0..xx.len()).find(|place| is_singular(*place)) } else { None }
}

/// Solves A x = b for each right side by elimination with partial pivoting; false if A is singular to rounding.
pub(super) fn solve<const N: usize, const SIDES: usize>(
    mut a: [[f64; N]; N],
    sides: &mut [[f64; SIDES]; N],
) -> bool {
    let largest = a.iter().flatten().fold(0.0, |largest: f64, entry| largest.max(entry.abs()));
    for column in 0..N {
        let mut pivot = column;
        for row in column + 1..N {
            if a[row][column].abs() > a[pivot][column].abs() {
                pivot = row;
            }
        }
        a.swap(column, pivot);
        sides.swap(column, pivot);
        let regular = a[column][column].abs() > LEAST_PIVOT * largest;
        if !regular {
            return false;
        }
        let inverse = 1.0 / a[column][column];
        let (own, own_sides) = (a[column], sides[column]);
        for row in column + 1..N {
            let factor = a[row][column] * inverse;
            for k in column..N {
                a[row][k] -= factor * own[k];
            }
            for k in 0..SIDES {
                sides[row][k] -= factor * own_sides[k];
            }
        }
    }
    for column in (0..N).rev() {
        let inverse = 1.0 / a[column][column];
        sides[column] = sides[column].map(|value| value * inverse);
        let own = sides[column];
        for row in 0..column {
            for k in 0..SIDES {
                sides[row][k] -= a[row][column] * own[k];
            }
        }
    }
    true
}
