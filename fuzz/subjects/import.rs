//! The published text format: any text, for a map of 4 × 4 blocks or of the published size.

use std::sync::LazyLock;

use strew_core::{Alpha, Map, Table};

static MAPS: LazyLock<[Map; 2]> = LazyLock::new(|| {
    let alpha: Alpha = "(5-sqrt(3))/2".parse().expect("valid");
    [1, 49].map(|radius| Map::new(alpha, radius).expect("small"))
});

pub fn run(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else {
        return;
    };
    for map in MAPS.iter() {
        let Ok(table) = Table::from_text(map.clone(), "imported", text) else {
            continue;
        };
        let mut written = String::new();
        table.write_text(&mut written).expect("memory takes it");
        let again = Table::from_text(map.clone(), "imported", &written).expect("our own text");
        assert_eq!(again.displacements(), table.displacements());
    }
}
