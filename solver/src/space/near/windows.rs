//! Cells within reach of a cell: a window in each of five rows, which marches along with the cell.

use super::grid::{Grid, MARGIN};
use super::trace::Trace;

/// Rows of cells that are searched: the own one, and those in front of it.
const ROWS: usize = 5;

/// The windows of one cell.
#[derive(Debug)]
pub(super) struct Windows {
    /// First and last key in the window of each row, relative to that of the cell.
    offsets: [[u64; 2]; ROWS],
    /// Where the windows start and end.
    ends: [[usize; 2]; ROWS],
    /// Ranges of cells in which there may be contacts.
    pub(super) cells: [[usize; 2]; ROWS],
    /// There may be contacts within the cell.
    pub(super) own: bool,
}

impl Windows {
    /// Windows for the cells from number `first` on, in order.
    pub(super) fn new(grid: &Grid, first: usize) -> Self {
        let row = 1 << grid.bits[0];
        let plane = 1 << (grid.bits[0] + grid.bits[1]);
        let around = |middle: u64| [middle - MARGIN, middle + MARGIN];
        let offsets =
            [[1, MARGIN], around(row), around(plane - row), around(plane), around(plane + row)];
        let ends = offsets.map(|[low, _]| {
            let place = grid.keys.partition_point(|&key| key < grid.keys[first] + low);
            [place, place]
        });
        Self { offsets, ends, cells: ends, own: true }
    }

    /// Moves on to a cell, which must not be in front of the one before.
    #[inline(always)]
    pub(super) fn advance(&mut self, grid: &Grid, cell: usize) {
        let key = grid.keys[cell];
        for (ends, [low, high]) in self.ends.iter_mut().zip(self.offsets) {
            while grid.keys.get(ends[0]).is_some_and(|&k| k < key + low) {
                ends[0] += 1;
            }
            ends[1] = ends[1].max(ends[0]);
            while grid.keys.get(ends[1]).is_some_and(|&k| k <= key + high) {
                ends[1] += 1;
            }
        }
        self.cells = self.ends;
        if !grid.traces.is_empty() {
            self.drop_quiet(&grid.traces, cell);
        }
    }

    /// Empties the windows in which no contact can arise.
    fn drop_quiet(&mut self, traces: &[Trace], cell: usize) {
        let own = traces[cell];
        self.own = !own.is_quiet();
        for [start, end] in &mut self.cells {
            let all = traces[*start..*end].iter().fold(own, |all, trace| all.join(trace));
            if all.is_quiet() {
                *end = *start;
            }
        }
    }
}
