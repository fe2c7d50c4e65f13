//! When the list is no longer good.

use super::*;

/// A rebuild, and then steps in which clusters and members move; returns the steps it stayed fresh.
fn fly(mut cloud: Cloud, common: &[[f64; 3]], own: &[[f64; 3]]) -> Result<usize, TestCaseError> {
    let mut list = PairList::new();
    list.rebuild(&cloud.points(), REACH, all);
    for step in 0..12 {
        for i in 0..cloud.len() {
            let (a, b) = (common[i % common.len()], own[i % own.len()]);
            cloud.shift(i, [0, 1, 2].map(|k| a[k] + b[k]));
        }
        if list.is_stale(&cloud.points()) {
            return Ok(step);
        }
        prop_assert!(lists_all(&list, &cloud.brute(REACH.factor, 0.0)), "step {step}");
    }
    Ok(12)
}

fn speeds(most: f64) -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(-most..most)
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn lists_all_contacts_while_it_is_fresh(
        cloud in clouds(),
        fast in prop_oneof![Just(0.0), Just(1.0), Just(1e3)],
        common in prop::collection::vec(speeds(1.0), 1..3),
        own in prop::collection::vec(speeds(0.15), 1..40),
    ) {
        let common: Vec<_> = common.iter().map(|v| v.map(|c| c * fast)).collect();
        fly(cloud, &common, &own)?;
    }

    #[test]
    fn common_motion_is_never_stale(cloud in clouds(), v in speeds(50.0)) {
        prop_assert_eq!(fly(cloud, &[v], &[[0.0; 3]])?, 12);
    }
}

/// Two blocks, `gap` apart along z.
fn bodies(gap: f64) -> Cloud {
    let mut cloud = Cloud::default();
    block(&mut cloud, [5, 5, 5], [0.0; 3], 0);
    block(&mut cloud, [5, 5, 5], [0.3, 0.2, 5.0 + gap], 1);
    cloud
}

/// Flies the second block into the first by `step` a step; rebuilds until there is contact.
fn close_in(gap: f64, step: f64) -> u64 {
    let mut cloud = bodies(gap);
    let mut list = PairList::new();
    let apart = |cloud: &Cloud, [i, j]: [u32; 2]| cloud.body[i as usize] != cloud.body[j as usize];
    loop {
        if list.is_stale(&cloud.points()) {
            list.rebuild(&cloud.points(), REACH, all);
        }
        let mut contacts = cloud.brute(1.12, 0.0);
        contacts.retain(|&pair| apart(&cloud, pair));
        assert!(lists_all(&list, &contacts));
        if contacts.len() > 100 {
            return list.counters().rebuilds;
        }
        for i in 0..cloud.len() {
            if cloud.body[i] == 1 {
                cloud.shift(i, [0.0, 0.0, -step]);
            }
        }
    }
}

#[test]
fn bodies_meet_with_few_rebuilds() {
    // Far apart the free way is the gap; only the last stretch goes by skins.
    assert!(close_in(200.0, 1.7) < 20);
    assert!(close_in(20.0, 0.1) < 14);
    assert!(close_in(2.0, 0.01) < 8);
}

#[test]
fn bodies_that_part_are_fresh_until_they_slide() {
    let mut cloud = bodies(9.0);
    let mut list = PairList::new();
    list.rebuild(&cloud.points(), REACH, all);
    for i in 0..cloud.len() {
        if cloud.body[i] == 1 {
            cloud.shift(i, [0.0, 0.0, 6.0]);
        }
    }
    assert!(!list.is_stale(&cloud.points()));
    cloud.shift(0, [0.0, 0.0, 0.8]);
    assert!(list.is_stale(&cloud.points()));
}
