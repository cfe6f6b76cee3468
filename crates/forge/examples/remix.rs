use strew_forge::{MixJob, mix, read_table, write_table};
use std::path::Path;
fn main() {
    let of = read_table(Path::new("crates/core/tables/blue-5-sqrt3-over-2-m.strew")).unwrap();
    for shares in ["1:1", "1:3", "1:1:2", "1:3:10"] {
        let path = format!("crates/catalog/tables/mix/blue-5-sqrt3-over-2-m-mix-{}.strew", shares.replace(':', "-"));
        let old = read_table(Path::new(&path)).unwrap();
        let made = mix(&of, &MixJob::joint(shares.parse().unwrap()), &()).unwrap().unwrap();
        assert!(made.accepted);
        assert_eq!(old.displacements(), made.table.displacements());
        assert_eq!(old.ranks(), made.table.ranks());
        assert_eq!(old.mix(), made.table.mix());
        assert_eq!(old.provenance().figures, made.table.provenance().figures);
        println!("{path}: {} -> {}", old.digest(), made.table.digest());
        write_table(Path::new(&path), &made.table).unwrap();
    }
}
