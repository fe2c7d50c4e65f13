//! What a group reads of its particles and adds to them.

use super::{CENTRE, Read, Sink, V3};
use crate::space::columns::SumsSlices;
use crate::space::lanes::{F8, LANES, Lanes, Mask, each};
use crate::space::mesh::Group;

impl Group {
    /// Asks for what tells where the group's particles are.
    #[inline(always)]
    pub fn fetch<F: Lanes>(&self) {
        F::fetch(&self.rows);
        F::fetch(&self.beyond);
    }

    /// Asks for what the first pass reads and writes of the group, and for those of its particles
    /// that no group before it has touched.
    #[inline(always)]
    pub fn fetch_load<F: Lanes>(&self, read: &Read<'_>, sink: &Sink<SumsSlices<'_>>) {
        self.fetch_eights::<F>(&self.plastic);
        self.fetch_work::<F>();
        for eight in [&self.strain, &self.flow, &self.rate] {
            self.fetch_eights::<F>(std::slice::from_ref(eight));
        }
        let (node, centre) = (self.rows[3] as usize + LANES, self.centre as usize + LANES);
        for column in
            read.displacement.into_iter().chain([read.grip, read.theta, read.sound, read.rho])
        {
            F::fetch(column.get(node..).unwrap_or_default());
            F::fetch(column.get(centre..).unwrap_or_default());
        }
        for column in read.velocity {
            F::fetch(column.get(node..).unwrap_or_default());
            F::fetch(column.get(self.beyond[7] as usize + LANES..).unwrap_or_default());
        }
        let (node, centre) = (node - sink.first_node, centre - sink.first_centre);
        for (sums, at) in [(&sink.nodes, node), (&sink.centres, centre)] {
            for column in [&*sums.fx, &*sums.fy, &*sums.fz, &*sums.heat] {
                F::fetch(column.get(at..).unwrap_or_default());
            }
        }
    }

    /// Asks for what the second pass reads of the group.
    #[inline(always)]
    pub fn fetch_work<F: Lanes>(&self) {
        self.fetch_eights::<F>(&self.stress);
        self.fetch_eights::<F>(&self.bonds);
        self.fetch_eights::<F>(std::slice::from_ref(&self.damage));
    }

    #[inline(always)]
    pub(super) fn fetch_eights<F: Lanes>(&self, eights: &[F8]) {
        for k in 0..eights.len() {
            F::fetch(&eights[k..]);
        }
    }

    /// A column at the nine slots.
    #[inline(always)]
    pub(super) fn gather<F: Lanes>(&self, column: &[f64]) -> [F; 9] {
        let rows = each!(row in 4 => {
            let at = self.rows[row] as usize;
            &column[at..at + LANES + 1]
        });
        let centre = F::load(column, self.centre as usize);
        each!(slot in 9 => if slot == CENTRE { centre } else { F::load(rows[slot / 2 % 4], slot % 2) })
    }

    /// A vector column at the nine slots.
    #[inline(always)]
    pub(super) fn gather_vector<F: Lanes>(&self, columns: [&[f64]; 3]) -> [V3<F>; 9] {
        let [x, y, z] = columns;
        let (x, y, z): ([F; 9], [F; 9], [F; 9]) = (self.gather(x), self.gather(y), self.gather(z));
        each!(slot in 9 => [x[slot], y[slot], z[slot]])
    }

    /// A vector column at the nine slots, from those of nodes and centroids whose first are `first`.
    #[inline(always)]
    pub(super) fn gather_own<F: Lanes>(
        &self,
        nodes: [&[f64]; 3],
        centres: [&[f64]; 3],
        first: [usize; 2],
    ) -> [V3<F>; 9] {
        each!(slot in 9 => {
            let (columns, at) = if slot == CENTRE {
                (centres, self.centre as usize - first[1])
            } else {
                (nodes, self.node(slot % CENTRE) - first[0])
            };
            each!(d in 3 => F::load_some(columns[d], at))
        })
    }

    /// Adds the corners' values to a column of nodes whose first is `first`.
    #[inline(always)]
    pub(super) fn scatter<F: Lanes>(&self, values: &[F; 9], to: &mut [f64], first: usize) {
        let own = Mask::MAX >> (LANES - self.lanes as usize);
        for row in 0..4 {
            let at = self.rows[row] as usize - first;
            let (low, high) = (values[2 * row].keep(own), values[2 * row + 1].keep(own));
            (low + high.shifted()).add_some(to, at);
            if let Some(last) = to.get_mut(at + LANES) {
                *last += high.pack().0[LANES - 1];
            }
        }
    }

    /// Adds the centroids' values to a column of centroids whose first is `first`.
    #[inline(always)]
    pub(super) fn scatter_centre<F: Lanes>(&self, value: F, to: &mut [f64], first: usize) {
        let own = Mask::MAX >> (LANES - self.lanes as usize);
        value.keep(own).add_some(to, self.centre as usize - first);
    }

    #[inline(always)]
    pub(super) fn scatter_vector<F: Lanes>(
        &self,
        values: &[V3<F>; 9],
        sink: &mut Sink<SumsSlices<'_>>,
    ) {
        let (nodes, centres) = (&mut sink.nodes, &mut sink.centres);
        let columns = [
            (&mut *nodes.fx, &mut *centres.fx),
            (&mut *nodes.fy, &mut *centres.fy),
            (&mut *nodes.fz, &mut *centres.fz),
        ];
        for (d, (node, centre)) in columns.into_iter().enumerate() {
            let own: [F; 9] = each!(slot in 9 => values[slot][d]);
            self.scatter(&own, node, sink.first_node);
            self.scatter_centre(own[CENTRE], centre, sink.first_centre);
        }
    }
}
