//! What planes of symmetry let be of a rotation: a particle that lies on one turns about its normal, as its image does
//! (decision 0021). Mirrors are the bits of the axes to which they are normal.

use super::Rigid;

/// One less the cosine between an axis of an ellipsoid and the normal of its mirror from which it counts as askew.
const ASKEW: f64 = 1e-12;

/// Whether mirrors, by the bits of their axes, bar torques about an axis: one is normal to another.
pub(super) fn bars(mirrors: u8, axis: usize) -> bool {
    mirrors & !(1 << axis) != 0
}

/// Whether an ellipsoid has an axis along the normal of every one of these mirrors. One that lies askew has no image that it
/// could turn with, and does not turn; nor do round ones that could, whatever their axes.
pub(super) fn lies_on(rigid: &Rigid, mirrors: u8) -> bool {
    let axes = rigid.axes();
    let along = |normal: usize| axes.iter().any(|own| own[normal].abs() > 1.0 - ASKEW);
    (0..3).all(|normal| mirrors >> normal & 1 == 0 || along(normal))
}

/// Takes what these mirrors do not let be from the angular momentum of what lies on them.
pub(super) fn bound(rigid: &mut Rigid, mirrors: u8) {
    let lies = lies_on(rigid, mirrors);
    let mut momentum: [f64; 3] = (rigid.turn * rigid.momentum).into();
    for (d, momentum) in momentum.iter_mut().enumerate() {
        if !lies || bars(mirrors, d) {
            *momentum = 0.0;
        }
    }
    rigid.momentum = rigid.turn.inverse_transform_vector(&momentum.into());
}

/// Mirrors that a particle lies on.
pub(super) fn mirrors_of(mirrors: &[u8], i: usize) -> u8 {
    mirrors.get(i).copied().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use nalgebra::{UnitQuaternion, Vector3};

    use super::*;

    /// About its middle axis, along which the normal lies but for round-off, nothing tips over.
    #[test]
    fn what_lies_on_a_mirror_does_not_tip_over() {
        let softness = Vector3::new(1.0, 0.5, 0.25);
        let turn = UnitQuaternion::from_euler_angles(std::f64::consts::FRAC_PI_2, 0.0, 0.3);
        let start = Rigid { turn, momentum: turn.inverse() * Vector3::new(0.0, 0.0, 3.0) };
        let (mut alone, mut on, mut tips) = (start, start, false);
        for _ in 0..20_000 {
            alone.rotate(&softness, 0.02);
            on.rotate_about(2, &softness, 0.02);
            tips |= !lies_on(&alone, 0b100);
            assert!(lies_on(&on, 0b100));
        }
        assert!(tips);
        assert!(((on.turn * on.momentum).z / 3.0 - 1.0).abs() < 1e-11);
        // Askew, and on two mirrors, nothing turns at all.
        let energy = |rigid: &Rigid| rigid.momentum.dot(&rigid.momentum.component_mul(&softness));
        assert!((energy(&on) / energy(&start) - 1.0).abs() < 1e-11);
        let mut askew = Rigid { turn: UnitQuaternion::from_euler_angles(0.3, 0.5, 0.0), ..start };
        bound(&mut askew, 0b100);
        bound(&mut on, 0b101);
        assert_eq!([askew.momentum, on.momentum], [Vector3::zeros(); 2]);
    }
}
