use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::qr::no_pivoting::factor::{qr_in_place, qr_in_place_scratch, recommended_block_size};
use faer::{Mat, Par, Spec};
use nalgebra::DMatrix;

use crate::view::view_mut;

/// R of A = QR, (c, c), zero below the diagonal, of A with any number of rows and c columns.
pub fn qr_triangle(mut matrix: DMatrix<f64>) -> DMatrix<f64> {
    let (rows, columns) = matrix.shape();
    let block = recommended_block_size::<f64>(rows, columns);
    let mut reflectors = Mat::zeros(block, rows.min(columns));
    let mut memory = MemBuffer::new(qr_in_place_scratch::<f64>(rows, columns, block, Par::Seq, Spec::default()));
    let stack = MemStack::new(&mut memory);
    qr_in_place(view_mut(&mut matrix), reflectors.as_mut(), Par::Seq, stack, Spec::default());
    matrix.fill_lower_triangle(0.0, 1);
    matrix.resize_vertically(columns, 0.0)
}
