//! Tables with kinds of points.

use std::sync::OnceLock;

use strew_core::{
    Table,
    table::{Mix, Ranks},
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

/// A table with kinds in some shares.
pub fn mixed(table: &Table, shares: &str) -> Table {
    let mix = Mix::scattered(table.map(), shares.parse().expect("valid")).expect("near");
    assert!(!mix.splits().is_empty());
    let blocks = mix.labels().len();
    table.with_mix(mix, ranks(blocks as u32)).expect("fits")
}

/// Tables with kinds, of three maps.
pub fn tables() -> &'static [Table] {
    static ONCE: OnceLock<Vec<Table>> = OnceLock::new();
    ONCE.get_or_init(|| {
        let [a, b, c] = super::tables();
        vec![
            mixed(a, "1:3"),
            mixed(b, "1:3:10"),
            mixed(c, "1:1:1:1:1"),
            mixed(a, "2:3:5:7:11"),
            mixed(&super::table("(5-sqrt(3))/2", 5), "1:1"),
        ]
    })
}
