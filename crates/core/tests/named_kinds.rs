//! Kinds by name, from what is built into the crate.

use strew_core::{
    Circle, ErrorKind, Kinds, PointSet, Region, Table, VaryingKinds,
    table::{Mix, Ranks},
};

fn region() -> Region {
    Region::new([-40.0, 10.0], [60.0, 90.0]).expect("ordered")
}

fn forest() -> PointSet {
    PointSet::blue().spacing(2.0).expect("valid").seed(7)
}

#[test]
fn even_kinds_move_nothing_and_are_parts_of_the_whole() {
    for (text, shares) in [
        ("birch:1,oak:1", "1:1"),
        ("oak:3,birch:1", "1:3"),
        ("oak:2,birch:1,ash:1", "1:1:2"),
        ("oak:10,birch:3,bush:1", "1:3:10"),
    ] {
        let kinds = Kinds::even(text).expect("valid");
        assert_eq!(kinds.shares().to_string(), shares);
        let set = forest().kinds(kinds.clone()).expect("built in");
        let plain = forest().within(region()).expect("near").to_vec();
        assert_eq!(set.within(region()).expect("near").to_vec(), plain);
        let counts = set.kind_counts(region()).expect("near");
        let mut all = 0;
        for (name, count) in kinds.names().zip(&counts) {
            let only = set.clone().only(name).expect("a kind");
            assert_eq!(only.count(region()), Ok(*count));
            assert_eq!(only.kind(), kinds.number(name));
            for tree in only.within(region()).expect("near") {
                assert_eq!(set.kind_name(tree.id()), Some(name));
                assert_eq!(set.point(tree.id()), Some(tree));
            }
            let share = kinds
                .shares()
                .of(kinds.number(name).expect("one of the names"));
            let of_all = *count as f64 / plain.len() as f64;
            assert!((of_all - share).abs() < 0.02, "{text} {name}: {of_all}");
            let own = set.least_distance_of(name, name).expect("a kind");
            assert!(own >= set.least_distance());
            all += count;
        }
        assert_eq!(all, plain.len() as u128);
    }
}

#[test]
fn joint_kinds_have_a_table_of_their_own() {
    for text in [
        "birch:1,oak:1",
        "oak:3,birch:1",
        "oak:2,birch:1,ash:1",
        "oak:10,birch:3,bush:1",
    ] {
        let set = forest().kinds(Kinds::joint(text).expect("valid"));
        let set = set.expect("built in");
        assert_ne!(set.table(), forest().table());
        let joint = PointSet::new(set.table().clone());
        let joint = joint.spacing(2.0).expect("valid").seed(7);
        let points = set.within(region()).expect("near").to_vec();
        assert_eq!(points, joint.within(region()).expect("near").to_vec());
        let rare = set.least_distance_of(0, 0).expect("a kind");
        assert!(rare > set.least_distance(), "{text}: {rare}");
    }
}

#[test]
fn the_order_of_the_methods_does_not_matter() {
    let slope = |[x, _]: [f64; 2]| 0.2 + x.abs() / 100.0;
    for kinds in [Kinds::even("birch:1,oak:3"), Kinds::joint("birch:1,oak:3")] {
        let kinds = kinds.expect("valid");
        let pond = Circle::new([0.0, 30.0], 9.0).expect("valid");
        let first = PointSet::blue().kinds(kinds.clone()).expect("built in");
        let first = first.spacing(2.0).expect("valid").seed(7);
        let first = first.keep(0.8).expect("a share").in_field(slope);
        let last = forest().keep(0.8).expect("a share").in_field(slope);
        let last = last.kinds(kinds).expect("built in");
        for (a, b) in [
            (first.clone(), last.clone()),
            (
                first.clone().limited_to(pond),
                last.clone().limited_to(pond),
            ),
            (
                first.only("birch").expect("a kind"),
                last.only("birch").expect("a kind"),
            ),
        ] {
            let points = |set: PointSet| set.within(region()).expect("near").to_vec();
            assert_eq!(points(a.clone()), points(b.clone()));
            assert_eq!(a.kind_counts(region()), b.kind_counts(region()));
        }
    }
}

#[test]
fn refusals_say_what_to_do() {
    let refused = |set: PointSet, kinds: Result<Kinds, _>| {
        let error = set.kinds(kinds.expect("valid")).expect_err("refused");
        assert_eq!(error.kind(), ErrorKind::Kinds);
        error.to_string()
    };
    assert_eq!(
        refused(forest(), Kinds::even("birch:1,oak:4")),
        "the ratio of even kinds is 1:4: the table has no kinds, and none of this ratio are built in; it must be 1:1, \
         1:3, 1:1:2 or 1:3:10, with features such as `even-1-3`, or that of a table from `strew forge mix --shares 1:4`"
    );
    let other = Table::undisplaced("sqrt(3)".parse().expect("valid"), 20, "pattern");
    let other = PointSet::new(other.expect("small"));
    assert_eq!(
        refused(other.clone(), Kinds::joint("birch:1,oak:3")),
        "the ratio of joint kinds is 1:3: the table has no kinds, and none of this ratio are built in; it must be that \
         of a table from `strew forge mix --shares 1:3 --joint`"
    );
    let named = forest().kinds(Kinds::even("birch:1,oak:3").expect("valid"));
    let named = named.expect("built in");
    assert_eq!(
        refused(named.clone(), Kinds::even("birch:1,oak:1")),
        "the ratio of the table's kinds is 1:3; it must be 1:1, that of the named kinds"
    );
    let error = named.clone().only("elm").expect_err("another name");
    assert_eq!(
        error.to_string(),
        "the name of the kind is `elm`; it must be `birch` or `oak`"
    );
    let error = named.clone().only(2).expect_err("two kinds");
    assert_eq!(error.to_string(), "only is 2; it must be from 0 to 1");
    assert_eq!(named.least_distance_of("birch", "elm"), None);
    let error = forest().only("oak").expect_err("no names");
    assert!(error.to_string().contains("PointSet::kinds"), "{error}");
    let error = other.only(0).expect_err("no kinds");
    assert!(error.to_string().contains("no kinds of points"), "{error}");
}

#[test]
fn kinds_that_vary_keep_names_of_their_ratio() {
    let named = forest().kinds(Kinds::even("birch:1,oak:3").expect("valid"));
    let named = named.expect("built in");
    let varying = |shares: &str| {
        let half = |[x, _]: [f64; 2]| x.abs() / 100.0;
        let mut fields: Vec<Option<std::sync::Arc<dyn strew_core::Field>>> =
            vec![None; shares.split(':').count()];
        fields[0] = Some(std::sync::Arc::new(half));
        let blue = PointSet::blue().table().clone();
        let order = Ranks::new((0..blue.displacements().len() as u32).collect());
        let order = blue.with_ranks(order.expect("an order")).expect("fits");
        VaryingKinds::new(&order, shares.parse().expect("shares"), fields).expect("one field")
    };
    let same = named.clone().with_varying_kinds(varying("1:3"));
    assert!(same.expect("the same map").only("birch").is_ok());
    let other = named.with_varying_kinds(varying("1:1"));
    assert!(other.expect("the same map").named_kinds().is_none());
}

#[test]
fn fields_of_varying_kinds_are_asked_for_in_plain_words() {
    let table = PointSet::blue().table().clone();
    let refused = |fields: usize| {
        let shares = "1:3".parse().expect("shares");
        let error = VaryingKinds::new(&table, shares, vec![None; fields]).expect_err("no field");
        assert_eq!(error.kind(), ErrorKind::Kinds);
        error.to_string()
    };
    assert_eq!(
        refused(2),
        "every place of the list of fields is None; it must be a field for at least one kind; kinds in the same shares \
         everywhere need no fields: see PointSet::kinds"
    );
    assert_eq!(
        refused(3),
        "the length of the list of fields is 3; it must be 2, one place for each kind"
    );
}

#[test]
fn names_are_those_of_a_file_with_kinds() {
    let blue = PointSet::blue().table().clone();
    let mix = Mix::scattered(blue.map(), "1:4".parse().expect("shares")).expect("near");
    let ranks = Ranks::new((0..mix.labels().len() as u32).collect()).expect("an order");
    let file = blue.with_mix(mix, ranks).expect("fits").to_bytes();
    let set = PointSet::new(Table::from_bytes(&file).expect("valid")).seed(7);
    let set = set.kinds(Kinds::even("oak:4,birch:1").expect("valid"));
    let birches = set.expect("its kinds").only("birch").expect("a kind");
    assert_eq!(birches.kind(), Some(0));
}
