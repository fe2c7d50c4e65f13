//! What is listed.

use rayon::ThreadPoolBuilder;

use super::*;

proptest! {
    #![proptest_config(config())]

    #[test]
    fn lists_what_brute_force_finds(cloud in clouds(), skin in prop_oneof![Just(0.0), Just(0.7)]) {
        let reach = Reach { factor: 1.12, skin };
        let far = reach.factor * cloud.longest() + skin;
        let keep = |i: u32, j: u32| !(i + j).is_multiple_of(5);
        let mut list = PairList::new();
        // The second time with memory in use.
        for _ in 0..2 {
            list.rebuild(&cloud.points(), reach, keep);
            prop_assert!(is_strictly_sorted(list.pairs()));
            let mut needed = cloud.brute(reach.factor, skin);
            needed.retain(|&[i, j]| keep(i, j));
            prop_assert!(lists_all(&list, &needed));
            let mut allowed = cloud.brute(reach.factor, skin + 3e-5 * far);
            allowed.retain(|&[i, j]| keep(i, j));
            for pair in list.pairs() {
                prop_assert!(allowed.binary_search(pair).is_ok(), "{pair:?}");
            }
        }
    }

    #[test]
    fn members_that_open_later_are_listed_as_if_they_had_been_open(
        cloud in clouds(),
        every in 1..7_u32,
        skin in prop_oneof![Just(0.0), Just(0.7)],
    ) {
        let reach = Reach { factor: 1.12, skin };
        let far = reach.factor * cloud.longest() + skin;
        let keep = |i: u32, j: u32| !(i + j).is_multiple_of(5);
        let fresh = |i: u32| i.is_multiple_of(every);
        let mut list = PairList::new();
        list.rebuild(&cloud.points(), reach, keep);
        let mut open = cloud.clone();
        for (i, flags) in (0..).zip(&mut open.flags) {
            *flags |= if fresh(i) { EXPOSED } else { 0 };
        }
        list.extend(&cloud.length, fresh, keep);
        prop_assert!(is_strictly_sorted(list.pairs()));
        let kept = |mut pairs: Vec<[u32; 2]>| {
            pairs.retain(|&[i, j]| keep(i, j));
            pairs
        };
        prop_assert!(lists_all(&list, &kept(open.brute(reach.factor, skin))));
        let allowed = kept(open.brute(reach.factor, skin + 3e-5 * far));
        for pair in list.pairs() {
            prop_assert!(allowed.binary_search(pair).is_ok(), "{pair:?}");
        }
    }

    #[test]
    fn inserts_pairs_at_their_places(
        cloud in clouds(),
        extra in prop::collection::vec((0..300_u32, 1..300_u32), 0..40),
    ) {
        let mut list = PairList::new();
        list.rebuild(&cloud.points(), REACH, all);
        let mut batch: Vec<_> = extra.iter().map(|&(i, more)| [i, i + more]).collect();
        let mut expected = [list.pairs(), &batch[..]].concat();
        expected.sort_unstable();
        expected.dedup();
        let before = list.pairs().len();
        list.insert(&mut batch);
        prop_assert_eq!(list.pairs(), &expected[..]);
        prop_assert_eq!(batch.len(), expected.len() - before);
        prop_assert_eq!(list.counters().pairs, expected.len() as u64);
    }
}

/// Two blocks that touch, and debris between and around them.
fn scene() -> Cloud {
    let mut cloud = Cloud::default();
    block(&mut cloud, [20, 20, 6], [0.0; 3], 0);
    block(&mut cloud, [8, 8, 8], [6.0, 6.0, 6.9], 1);
    let mut seed = 1_u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 40) as f64 / (1_u64 << 24) as f64
    };
    for _ in 0..3000 {
        cloud.push([20.0 * random(), 20.0 * random(), 7.0 + 30.0 * random()], 0.866, 3);
    }
    cloud
}

/// Leaves out what the lattice says about intact members of one body.
fn kept(cloud: &Cloud, i: u32, j: u32) -> bool {
    let [i, j] = [i as usize, j as usize];
    let near = (0..3).all(|k| (cloud.lattice[i][k] - cloud.lattice[j][k]).abs() <= 12);
    cloud.body[i] != cloud.body[j] || (cloud.flags[i] | cloud.flags[j]) & DEBRIS != 0 || !near
}

#[test]
fn lattice_spares_tests_and_loses_no_pair() {
    let mut cloud = scene();
    // The first body is bent back onto itself.
    for i in 0..cloud.len() {
        if cloud.body[i] == 0 && cloud.lattice[i][0] > 36 {
            cloud.shift(i, [-16.0, 0.0, 3.1]);
        }
    }
    let (mut plain, mut spared) = (PairList::new(), PairList::new());
    plain.rebuild(&cloud.points(), REACH, |i, j| kept(&cloud, i, j));
    spared.rebuild(&cloud.points_in_lattice(), REACH, |i, j| kept(&cloud, i, j));
    assert!(!plain.pairs().is_empty());
    assert_eq!(plain.pairs(), spared.pairs());
    assert!(spared.counters().tests < plain.counters().tests * 9 / 10);
}

/// However a pair at the end of the reach is come upon, one arithmetic says whether it is listed: a list
/// that was added to is one made anew at the same places.
#[test]
fn pairs_at_the_end_of_the_reach_do_not_depend_on_how_they_are_found() {
    let far = REACH.factor * f64::from(0.866_f32) + REACH.skin;
    let mut cloud = Cloud::default();
    for k in 0..8000_u32 {
        let (k, at) =
            (f64::from(k), [f64::from(k % 20), f64::from(k / 20 % 20), f64::from(k / 400)]);
        let at = at.map(|x| 7.1 * x + (0.37 * k).sin());
        let away = far * (1.0 + 4e-5 * k / 8000.0);
        let (sin, cos) = (1.7 * k).sin_cos();
        cloud.push(at, 0.866, 0);
        cloud.push([at[0] + away * cos, at[1], at[2] + away * sin], 0.866, 0);
    }
    let mut grown = PairList::new();
    grown.rebuild(&cloud.points(), REACH, all);
    assert!(grown.pairs().is_empty());
    cloud.flags.iter_mut().step_by(2).for_each(|flags| *flags = EXPOSED);
    grown.extend(&cloud.length, |i| i.is_multiple_of(2), all);
    let mut anew = PairList::new();
    anew.rebuild(&cloud.points(), REACH, all);
    assert!((1000..7000).contains(&anew.pairs().len()), "{}", anew.pairs().len());
    assert!(grown.pairs() == anew.pairs());
    // Which of them come first in their cells is another thing.
    let before = anew.pairs().to_vec();
    cloud.flags.iter_mut().skip(1).step_by(2).for_each(|flags| *flags = EXPOSED);
    cloud.flags.iter_mut().step_by(6).for_each(|flags| *flags = 0);
    anew.rebuild(&cloud.points(), REACH, all);
    assert!(anew.pairs() == before);
}

#[test]
fn intact_block_needs_no_test() {
    let mut cloud = Cloud::default();
    block(&mut cloud, [6, 6, 6], [0.0; 3], 7);
    let mut list = PairList::new();
    list.rebuild(&cloud.points_in_lattice(), REACH, all);
    assert_eq!((list.counters().tests, list.pairs().len()), (0, 0));
}

#[test]
fn same_list_on_any_number_of_threads() {
    let cloud = scene();
    let run = |threads: usize| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut list = PairList::new();
        pool.install(|| {
            list.rebuild(&cloud.points_in_lattice(), REACH, |i, j| !(i ^ j).is_multiple_of(7));
        });
        (list.pairs().to_vec(), list.counters())
    };
    let one = run(1);
    assert!(one.0.len() > 5000);
    assert_eq!(one, run(2));
    assert_eq!(one, run(8));
}

#[test]
fn second_rebuild_allocates_nothing() {
    let mut cloud = scene();
    // Counts are of the thread that asks: it must be the only one of its pool.
    let pool = ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    pool.install(|| {
        let mut list = PairList::new();
        list.rebuild(&cloud.points_in_lattice(), REACH, all);
        let batch = &mut vec![[0, 1], [5, 9000]];
        list.insert(batch);
        let info = allocation_counter::measure(|| {
            for i in 0..cloud.len() {
                cloud.shift(i, [0.01, 0.0, if i % 2 == 0 { 0.02 } else { -0.02 }]);
            }
            std::hint::black_box(list.is_stale(&cloud.points_in_lattice()));
            list.rebuild(&cloud.points_in_lattice(), REACH, all);
            list.insert(batch);
        });
        assert_eq!(info.count_total, 0);
    });
}

#[test]
fn lost_member_disturbs_no_other() {
    for lost in [-1e7, 1e9, -1e13, 1e17, -1e60, f64::INFINITY] {
        let mut cloud = Cloud::default();
        block(&mut cloud, [6, 6, 6], [-3.0; 3], 0);
        cloud.flags.fill(EXPOSED);
        let mut list = PairList::new();
        list.rebuild(&cloud.points(), REACH, all);
        let (alone, tests) = (list.pairs().to_vec(), list.counters().tests);
        assert_eq!(alone, cloud.brute(REACH.factor, REACH.skin));
        cloud.push([lost, 0.5 * lost, -lost], 0.866, EXPOSED);
        list.rebuild(&cloud.points(), REACH, all);
        assert_eq!(list.pairs(), alone);
        assert!(list.counters().tests - tests < 2 * tests);
    }
}

#[test]
fn folded_cells_hold_true_distances() {
    let far = REACH.factor * f64::from(0.866_f32) + REACH.skin;
    // So far apart that the cells of one block fall onto those of the other.
    let period = 2.0 * ((1_i64 << 21) - 8) as f64 * far * (1.0 + 4e-5);
    let mut cloud = Cloud::default();
    block(&mut cloud, [5, 5, 5], [0.1; 3], 0);
    block(&mut cloud, [5, 5, 5], [0.2 - period, 0.15 + period, 0.1], 1);
    cloud.flags.fill(EXPOSED);
    let mut list = PairList::new();
    list.rebuild(&cloud.points(), REACH, all);
    assert_eq!(list.pairs(), cloud.brute(REACH.factor, REACH.skin));
}

#[test]
fn degenerate_clouds_have_no_pairs() {
    let mut list = PairList::new();
    let mut cloud = Cloud::default();
    list.rebuild(&cloud.points(), REACH, all);
    assert!(list.pairs().is_empty() && !list.is_stale(&cloud.points()));
    cloud.push([1e30, -1e30, 0.0], 1.0, EXPOSED);
    assert!(list.is_stale(&cloud.points()));
    list.rebuild(&cloud.points(), REACH, all);
    assert!(list.pairs().is_empty() && !list.is_stale(&cloud.points()));
    cloud.push([1e30, -1e30, 0.0], 1.0, EXPOSED);
    list.rebuild(&cloud.points(), REACH, all);
    assert_eq!(list.pairs(), [[0, 1]]);
    cloud.length.fill(0.0);
    list.rebuild(&cloud.points(), Reach { factor: 1.0, skin: 0.0 }, all);
    assert!(list.pairs().is_empty() && !list.is_stale(&cloud.points()));
}
