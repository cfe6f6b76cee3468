//! Tables with kinds of points.

use std::sync::OnceLock;

use strew_core::{
    Table,
    table::{Ladder, Mix, Ranks, Rung},
};

/// A hashed order.
fn ranks(blocks: u32) -> Ranks {
    let mut order: Vec<u32> = (0..blocks).collect();
    order.sort_by_key(|&block| block.wrapping_mul(0x9e37_79b1).swap_bytes());
    let mut positions = vec![0; blocks as usize];
    for (position, &block) in (0..).zip(&order) {
        positions[block as usize] = position;
    }
    Ranks::new(positions).expect("an order")
}

/// A table with kinds in some shares, and with a ladder of arbitrary vectors if wanted.
pub fn mixed(table: &Table, shares: &str, has_ladder: bool) -> Table {
    let mix = Mix::scattered(table.map(), shares.parse().expect("valid")).expect("near");
    assert!(!mix.splits().is_empty());
    let blocks = mix.labels().len();
    let table = table.with_mix(mix, ranks(blocks as u32)).expect("fits");
    if !has_ladder {
        return table;
    }
    let rung = |i: usize| {
        let [x, y] = [71, 173].map(|f| (i * f % 1201) as i16 - 600);
        let event = [i * 7 % 100, 100 + i * 3 % 100].map(|v| v as u8);
        Rung {
            vector: [x, y],
            event,
        }
    };
    let level = (0.4, (0..blocks).map(rung).collect());
    let ladder = Ladder::new(vec![level]).expect("valid");
    table.with_ladder(ladder).expect("a vector for each block")
}

/// Tables with kinds, of three maps.
pub fn tables() -> &'static [Table] {
    static ONCE: OnceLock<Vec<Table>> = OnceLock::new();
    ONCE.get_or_init(|| {
        let [a, b, c] = super::tables();
        vec![
            mixed(a, "1:3", false),
            mixed(b, "1:3:10", false),
            mixed(c, "1:1:1:1:1", false),
            mixed(a, "2:3:5:7:11", true),
            mixed(&super::table("(5-sqrt(3))/2", 5), "1:1", false),
        ]
    })
}
