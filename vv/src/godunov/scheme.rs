//! The scheme of one time step, block by block: reconstruction, predictor and fluxes.
//!
//! The loops are free of branches and work on separate arrays, so that the compiler vectorizes
//! them; the sources are named in the parent module.

/// Cells processed at a time: their face states and fluxes stay in the first-level cache.
pub(super) const BLOCK: usize = 128;

/// One value for each cell or face of a block, with room for the overlaps.
pub(super) type Row = [f64; BLOCK + 2];

/// States at the left (`low`) and right (`high`) faces of the cells of a block and its neighbours.
#[derive(Clone, Debug)]
pub(super) struct Faces {
    pub(super) low: [Row; 3],
    pub(super) high: [Row; 3],
}

/// Three fields of one cell, or fluxes of mass, momentum and energy.
pub(super) type Triple = [f64; 3];

/// The smaller number (unlike `f64::min` without care for NaN, hence one instruction).
#[inline(always)]
fn lesser(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The larger number; see [`lesser`].
#[inline(always)]
pub(super) fn greater(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The monotonized-central limiter: the mean of two differences, bounded by twice either, or zero
/// if their signs differ.
#[inline(always)]
fn limited(a: f64, b: f64) -> f64 {
    let (x, y) = (a.abs(), b.abs());
    let slope = lesser(2.0 * lesser(x, y), 0.5 * (x + y));
    if a * b > 0.0 { slope.copysign(a) } else { 0.0 }
}

/// The equation of state, and the parts of the scheme that depend on nothing else.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scheme {
    pub(super) gamma: f64,
    /// `1/(gamma - 1)`.
    energy_factor: f64,
    /// Lowest pressure ascribed to a cell.
    floor: f64,
}

impl Scheme {
    pub(super) fn new(gamma: f64, floor: f64) -> Self {
        Self { gamma, energy_factor: 1.0 / (gamma - 1.0), floor }
    }

    /// Recovers the primitive from the conserved fields of equally many cells; returns the number
    /// of cells whose pressure was raised to the floor and the first inadmissible one.
    pub(super) fn recover(
        self,
        conserved: [&[f64]; 3],
        primitive: [&mut [f64]; 3],
    ) -> (u64, Option<usize>) {
        let cells = conserved[0].len();
        let [mass, momentum, energy] = conserved.map(|q| &q[..cells]);
        let [density, velocity, pressure] = primitive.map(|w| &mut w[..cells]);
        let (mut floored, mut bad) = (0_u64, 0_u64);
        for i in 0..cells {
            let u = momentum[i] / mass[i];
            let p = (self.gamma - 1.0) * (energy[i] - 0.5 * momentum[i] * u);
            density[i] = mass[i];
            velocity[i] = u;
            pressure[i] = greater(p, self.floor);
            floored += u64::from(p < self.floor);
            bad += u64::from(!is_admissible(mass[i], energy[i]));
        }
        let culprit = || (0..cells).find(|&i| !is_admissible(mass[i], energy[i]));
        (floored, if bad == 0 { None } else { culprit() })
    }

    /// Face states of the inner cells of a `stencil` of density, velocity and pressure that
    /// overlaps by one cell on each side.
    pub(super) fn reconstruct(self, stencil: [&[f64]; 3], ratio: f64, faces: &mut Faces) {
        let [density, velocity, pressure] = stencil;
        let count = density.len() - 2;
        let ([r_l, u_l, p_l], [r_h, u_h, p_h]) = (
            faces.low.each_mut().map(|face| &mut face[..count]),
            faces.high.each_mut().map(|face| &mut face[..count]),
        );
        let (velocity, pressure) = (&velocity[..count + 2], &pressure[..count + 2]);
        for i in 0..count {
            let cell = |i: usize| [density[i], velocity[i], pressure[i]];
            let (low, high) = self.faces([cell(i), cell(i + 1), cell(i + 2)], ratio);
            [r_l[i], u_l[i], p_l[i]] = low;
            [r_h[i], u_h[i], p_h[i]] = high;
        }
    }

    /// Fluxes between `count + 1` reconstructed cells; returns the fastest signal speed.
    pub(super) fn fluxes(self, faces: &Faces, count: usize, flux: &mut [Row; 3]) -> f64 {
        let [r_l, u_l, p_l] = faces.high.each_ref().map(|face| &face[..count]);
        let [r_r, u_r, p_r] = faces.low.each_ref().map(|face| &face[1..][..count]);
        let [mass, momentum, energy] = flux.each_mut().map(|flux| &mut flux[..count]);
        let mut speed = [0.0; BLOCK + 2];
        for (i, speed) in speed[..count].iter_mut().enumerate() {
            let (left, right) = ([r_l[i], u_l[i], p_l[i]], [r_r[i], u_r[i], p_r[i]]);
            ([mass[i], momentum[i], energy[i]], *speed) = self.hllc(left, right);
        }
        speed[..count].iter().fold(0.0, |a, &b| greater(a, b))
    }

    /// States at the left and right face of the middle cell after half a step (Toro 14.4).
    #[inline(always)]
    fn faces(self, [left, cell, right]: [Triple; 3], ratio: f64) -> (Triple, Triple) {
        let d: Triple = std::array::from_fn(|k| limited(cell[k] - left[k], right[k] - cell[k]));
        let [density, velocity, pressure] = cell;
        let half = 0.5 * ratio;
        let middle = [
            density - half * (velocity * d[0] + density * d[1]),
            velocity - half * (velocity * d[1] + d[2] / density),
            pressure - half * (velocity * d[2] + self.gamma * pressure * d[1]),
        ];
        let low: Triple = std::array::from_fn(|k| middle[k] - 0.5 * d[k]);
        let high: Triple = std::array::from_fn(|k| middle[k] + 0.5 * d[k]);
        if lesser(low[0], high[0]) > 0.0 && lesser(low[2], high[2]) > 0.0 {
            (low, high)
        } else {
            (cell, cell)
        }
    }

    /// HLLC flux of mass, momentum and energy (Toro 10.4), in the form whose mass flux is
    /// `rho* S*`, so that nothing passes a wall.
    #[inline(always)]
    fn hllc(self, left: Triple, right: Triple) -> (Triple, f64) {
        let ([r_l, u_l, p_l], [r_r, u_r, p_r]) = (left, right);
        let inverse = 1.0 / (r_l * r_r);
        let (a_l, a_r) = (self.gamma * p_l * r_r * inverse, self.gamma * p_r * r_l * inverse);
        // Einfeldt's average of the squared sound speeds.
        let weight = r_r * inverse.sqrt();
        let share = 1.0 / (1.0 + weight);
        let jump = u_r - u_l;
        let mean = (u_l + weight * u_r) * share;
        let sound = ((a_l + weight * a_r + 0.5 * weight * share * jump * jump) * share).sqrt();
        let s_l = lesser(u_l - a_l.sqrt(), mean - sound);
        let s_r = greater(u_r + a_r.sqrt(), mean + sound);
        let (m_l, m_r) = (r_l * (s_l - u_l), r_r * (s_r - u_r));
        let contact = (p_r - p_l + m_l * u_l - m_r * u_r) / (m_l - m_r);
        let rightward = contact >= 0.0;
        let ([density, velocity, pressure], outer, mass) =
            if rightward { (left, s_l, m_l) } else { (right, s_r, m_r) };
        let energy = self.energy_factor * pressure + 0.5 * density * velocity * velocity;
        let star_pressure = pressure + mass * (contact - velocity);
        let scale = contact / (outer - contact);
        let star_flow = mass * scale;
        let star_energy =
            (energy * (outer - velocity) - pressure * velocity + star_pressure * contact) * scale;
        let flow = density * velocity;
        // Whether all waves move to one side.
        let upwind = (outer >= 0.0) == rightward;
        let pick = |one_sided: f64, star: f64| if upwind { one_sided } else { star };
        let flux = [
            pick(flow, star_flow),
            pick(flow * velocity + pressure, star_flow * contact + star_pressure),
            pick(velocity * (energy + pressure), star_energy + star_pressure * contact),
        ];
        (flux, greater(-s_l, s_r))
    }
}

/// Whether density and total energy are positive (and no NaN).
#[inline(always)]
fn is_admissible(density: f64, energy: f64) -> bool {
    density > 0.0 && energy > 0.0
}
