use super::super::testing::cases;
use super::*;
use proptest::prelude::*;

fn block(length: f64, density: f64, wave_speed: f64, velocity: f64) -> Block {
    Block { length, density, wave_speed, velocity }
}

#[test]
fn equal_blocks_exchange_their_velocities() {
    let result = collide(block(2.0, 3.0, 5.0, 0.7), block(2.0, 3.0, 5.0, 0.0)).unwrap();
    assert!(result.left_velocity.abs() < 1e-14);
    assert!((result.right_velocity - 0.7).abs() < 1e-14);
    assert!((result.contact_time - 4.0 / 5.0).abs() < 1e-12, "one round trip");
    assert!((result.peak_pressure - 0.5 * 15.0 * 0.7).abs() < 1e-12, "z V/2");
}

/// Equal impedance: the shorter block stops, whichever moves (Saint-Venant).
#[test]
fn a_short_block_stops_on_a_long_one_of_equal_impedance() {
    let result = collide(block(1.0, 2.0, 3.0, 1.0), block(2.5, 2.0, 3.0, 0.0)).unwrap();
    assert!(result.left_velocity.abs() < 1e-13);
    assert!((result.right_velocity - 0.4).abs() < 1e-13);
    let result = collide(block(2.5, 2.0, 3.0, 0.0), block(1.0, 2.0, 3.0, -1.0)).unwrap();
    assert!(result.right_velocity.abs() < 1e-13);
    assert!((result.left_velocity + 0.4).abs() < 1e-13);
}

/// A soft rod on a hard mass of many transits: nearly the rigid elastic rebound.
#[test]
fn a_soft_rod_rebounds_from_a_stiff_wall() {
    let result = collide(block(1.0, 1.0, 1.0, 1.0), block(1.0, 1e6, 1e3, 0.0)).unwrap();
    assert!((result.left_velocity + 1.0).abs() < 1e-5, "{result:?}");
}

/// A block of equal cells that signals cross in one step: `[p + z v, p - z v]` of each.
struct Lattice {
    impedance: f64,
    rightward: VecDeque<f64>,
    leftward: VecDeque<f64>,
}

impl Lattice {
    fn new(cells: usize, impedance: f64, velocity: f64) -> Self {
        let signal = |value: f64| VecDeque::from(vec![value; cells]);
        let (rightward, leftward) = (impedance * velocity, -impedance * velocity);
        Self { impedance, rightward: signal(rightward), leftward: signal(leftward) }
    }

    fn velocity(&self) -> f64 {
        let sum: f64 = self.rightward.iter().zip(&self.leftward).map(|(r, l)| r - l).sum();
        sum / (2.0 * self.impedance * self.rightward.len() as f64)
    }

    /// Moves all signals by one cell, given the pressure at the left and at the right end.
    fn step(&mut self, left: f64, right: f64) {
        let (at_right, at_left) =
            (self.rightward.pop_back().unwrap(), self.leftward.pop_front().unwrap());
        self.rightward.push_front(2.0 * left - at_left);
        self.leftward.push_back(2.0 * right - at_right);
    }
}

/// Unequal impedances and lengths against the exact method of characteristics on a lattice.
#[test]
fn agrees_with_the_method_of_characteristics() {
    for (n_1, n_2, z) in [(3, 5, 2.0), (5, 3, 2.0), (4, 4, 0.3), (2, 9, 0.5), (7, 3, 5.0)] {
        let mut a = Lattice::new(n_1, z, 1.0);
        let mut b = Lattice::new(n_2, 1.0, 0.0);
        let (mut gap, mut contact) = (0.0_f64, 0);
        for step in 1..400 {
            let (from_a, from_b) = (a.rightward[n_1 - 1], b.leftward[0]);
            let common = (from_a + z * from_b) / (1.0 + z);
            let pressure = if gap <= 1e-12 { common.max(0.0) } else { 0.0 };
            gap += (pressure - from_b) - (from_a - pressure) / z;
            contact = if pressure > 1e-12 { step } else { contact };
            a.step(0.0, pressure);
            b.step(pressure, 0.0);
        }
        assert!(gap > 10.0, "parted");
        let result =
            collide(block(n_1 as f64, z, 1.0, 1.0), block(n_2 as f64, 1.0, 1.0, 0.0)).unwrap();
        assert!((result.left_velocity - a.velocity()).abs() < 1e-11, "{n_1} {n_2} {z}");
        assert!((result.right_velocity - b.velocity()).abs() < 1e-11, "{n_1} {n_2} {z}");
        assert!((result.contact_time - f64::from(contact)).abs() < 1e-9, "{n_1} {n_2} {z}");
    }
}

#[test]
fn refuses_what_does_not_collide() {
    let still = block(1.0, 1.0, 1.0, 0.0);
    assert_eq!(collide(still, still), Err(CollisionError::NoApproach));
    assert!(matches!(collide(block(-1.0, 1.0, 1.0, 1.0), still), Err(CollisionError::Input(_))));
}

proptest! {
    #![proptest_config(cases(96))]

    /// Momentum is kept, kinetic energy is not gained, the blocks part; the result does not
    /// depend on the frame and follows a reflection of space.
    #[test]
    fn obeys_the_invariances(
        (l_1, l_2) in (0.2..3.0, 0.2..3.0),
        (d_1, d_2) in (0.2..3.0, 0.2..3.0),
        (c_1, c_2) in (0.5..3.0, 0.5..3.0),
        (v, boost) in (0.1..2.0_f64, -5.0..5.0_f64),
    ) {
        let (left, right) = (block(l_1, d_1, c_1, v), block(l_2, d_2, c_2, 0.0));
        let result = collide(left, right).unwrap();
        let (m_1, m_2) = (left.mass(), right.mass());
        let (v_1, v_2) = (result.left_velocity, result.right_velocity);
        prop_assert!((m_1 * v_1 + m_2 * v_2 - m_1 * v).abs() < 1e-12 * m_1 * v);
        prop_assert!(m_1 * v_1 * v_1 + m_2 * v_2 * v_2 <= m_1 * v * v * (1.0 + 1e-10));
        prop_assert!(v_2 >= v_1);
        let shift = |b: Block| Block { velocity: b.velocity + boost, ..b };
        let boosted = collide(shift(left), shift(right)).unwrap();
        prop_assert!((boosted.left_velocity - boost - v_1).abs() < 1e-9);
        let flip = |b: Block| Block { velocity: -b.velocity, ..b };
        let mirrored = collide(flip(right), flip(left)).unwrap();
        prop_assert!((mirrored.right_velocity + v_1).abs() < 1e-9);
        prop_assert!((mirrored.left_velocity + v_2).abs() < 1e-9);
    }

    /// Impedance ratio one, lengths different: the exact result in closed form.
    #[test]
    fn equal_impedance_stops_the_shorter(
        transit in 0.1..0.999_f64, c_1 in 0.5..3.0, c_2 in 0.5..3.0, z in 0.5..3.0,
    ) {
        let left = block(transit * c_1, z / c_1, c_1, 1.0);
        let right = block(c_2, z / c_2, c_2, 0.0);
        let result = collide(left, right).unwrap();
        prop_assert!(result.left_velocity.abs() < 1e-11);
        prop_assert!((result.right_velocity - transit).abs() < 1e-11);
    }
}
