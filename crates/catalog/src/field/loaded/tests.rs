//! Fields of folders and configurations.

use std::fs;

use strew_core::Field as _;

use super::*;

fn settings(folder: &Path) -> Settings {
    Settings {
        embedded: false,
        folder: folder.into(),
        max_bytes: 1 << 20,
        max_sent_bytes: 0,
        named: BTreeMap::new(),
    }
}

fn write(folder: &Path, name: &str, content: impl AsRef<[u8]>) {
    fs::write(folder.join(name), content).expect("writable");
}

fn gray(size: [u32; 2], value: u8) -> Vec<u8> {
    let mut file = vec![];
    let mut encoder = png::Encoder::new(&mut file, size[0], size[1]);
    encoder.set_color(png::ColorType::Grayscale);
    let mut writer = encoder.write_header().expect("a header");
    let pixels = vec![value; (size[0] * size[1]) as usize];
    writer.write_image_data(&pixels).expect("written");
    writer.finish().expect("written");
    file
}

#[test]
fn rasters_documents_and_sections_are_fields() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    write(path, "bare.png", gray([4, 2], 51));
    write(path, "wide.png", gray([2, 2], 255));
    write(
        path,
        "wide.toml",
        "[raster]\nfile = 'wide.png'\nbbox = [0, 0, 100, 100]",
    );
    // It names one that comes later.
    write(
        path,
        "a.json",
        r#"{"multiply": [{"name": "wide"}, {"name": "half"}]}"#,
    );
    write(path, "notes.txt", "nothing");
    let mut settings = settings(path);
    let half = "constant = 0.5".parse().expect("TOML");
    settings.named.insert("half".into(), half);
    let fields = Fields::load(&settings).expect("valid");
    assert_eq!(fields.names(), "a, bare, half, wide");
    let share = |name, at| fields.get(name).expect("loaded").spec.share(at);
    assert!((share("bare", [2.0, 1.0]) - 0.2).abs() < 1e-6);
    assert_eq!(share("bare", [9.0, 1.0]), 0.0);
    assert_eq!(share("a", [50.0, 50.0]), 0.5);
    assert_eq!(fields.get("bare").expect("loaded").bytes, 8);
}

fn npy(descr: &str, data: &[u8]) -> Vec<u8> {
    let header = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': (1, 2), }}");
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    file.extend((header.len() as u16).to_le_bytes());
    file.extend(header.as_bytes());
    file.extend(data);
    file
}

#[test]
fn integers_of_arrays_are_shares_of_a_known_number() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    write(path, "mask.npy", npy("|u1", &[0, 1]));
    write(path, "words.npy", npy("<u2", &[0, 0, 0xe8, 3]));
    write(path, "bytes.npy", npy("|u1", &[0, 57]));
    write(path, "truth.npy", npy("|b1", &[0, 1]));
    let share = |name: &str, more: &str, at| {
        let json = format!(r#"{{"raster": {{"file": "{name}"{more}}}}}"#);
        write(path, "field.json", json);
        let field = from_file(&path.join("field.json"), &Fields::default());
        field
            .map(|field| field.spec.share(at))
            .map_err(|error| error.detail)
    };
    let refused = share("mask.npy", "", [1.5, 0.5]).expect_err("a share of 1/255");
    assert!(
        refused.contains("reach to 1 of 255") && refused.contains("a white: 1 if"),
        "{refused}"
    );
    let refused = share("words.npy", "", [1.5, 0.5]).expect_err("a share of 1/65");
    assert!(refused.contains("reach to 1000 of 65535"), "{refused}");
    assert_eq!(
        share("words.npy", r#", "white": 1000"#, [1.5, 0.5]),
        Ok(1.0)
    );
    assert!(share("bytes.npy", "", [1.5, 0.5]).is_ok_and(|share| share < 0.23));
    // Nothing is between bits, unless it is requested.
    for (name, white) in [("mask.npy", r#", "white": 1"#), ("truth.npy", "")] {
        assert_eq!(share(name, white, [0.99, 0.5]), Ok(0.0));
        assert_eq!(share(name, white, [1.0, 0.5]), Ok(1.0));
        let linear = format!(r#"{white}, "filter": "linear""#);
        assert_eq!(share(name, &linear, [1.0, 0.5]), Ok(0.5));
    }
    assert_eq!(
        heights(&path.join("words.npy")).expect("heights"),
        Some([0.0, 1000.0])
    );
    assert_eq!(heights(&path.join("field.json")).expect("no raster"), None);
}

#[test]
fn world_files_place_rasters() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    write(path, "a.png", gray([4, 2], 255));
    let settings = settings(path);
    let bbox = |fields: &Fields| fields.get("a").expect("loaded").bbox;
    let first = Fields::load(&settings).expect("valid");
    assert_eq!(bbox(&first), Some([0.0, 0.0, 4.0, 2.0]));
    // The center of the first pixel is at 105, 195.
    write(path, "a.pgw", "10\n0\n0\n-10\n105\n195\n");
    let (placed, changes, _) = first.reload(&settings);
    assert_eq!(bbox(&placed), Some([100.0, 180.0, 140.0, 200.0]));
    assert_eq!(changes.loaded, ["a"]);
    for (world, why) in [
        ("10 1 0 -10 105 195", "it is turned or sheared"),
        ("10 0 0", "is not read; allowed: six numbers"),
    ] {
        write(path, "a.pgw", world);
        let error = Fields::load(&settings).expect_err(why);
        assert!(error.detail.contains(why), "{error}");
    }
}

#[test]
fn the_built_in_fields_are_a_forest_and_a_portrait_unless_others_have_their_names() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut settings = settings(folder.path());
    settings.embedded = true;
    let fields = Fields::load(&settings).expect("valid");
    let forest = |fields: &Fields, at| fields.get("forest").expect("loaded").spec.share(at);
    assert_eq!(forest(&fields, [-10.0, 22.0]), 0.0);
    let places = (0..400).map(|i| [f64::from(i % 20) * 20.0, 100.0 + f64::from(i / 20) * 20.0]);
    let sum: f64 = places.map(|at| forest(&fields, at)).sum();
    assert!((0.3..0.7).contains(&(sum / 400.0)), "{sum}");
    // The other one has dark hair, a light forehead, and nothing around it.
    let portrait = |at| fields.get("portrait").expect("loaded").spec.share(at);
    assert!(portrait([25.0, 70.0]) > 0.5 && portrait([45.0, 82.0]) < 0.2);
    assert_eq!(portrait([-10.0, 50.0]), 0.0);
    write(folder.path(), "forest.toml", "constant = 0.25");
    let (fields, changes, _) = fields.reload(&settings);
    assert_eq!(changes.loaded, ["forest"]);
    assert_eq!(forest(&fields, [-10.0, 22.0]), 0.25);
}

#[test]
fn what_is_wrong_names_the_file() {
    for (name, content, expected) in [
        ("a.png", b"no".to_vec(), "it is of no known format"),
        ("a.toml", b"constant = 7".to_vec(), "field.constant"),
        ("a.toml", b"constant =".to_vec(), "TOML parse error"),
        (
            "a.json",
            b"{\"name\": \"b\"}".to_vec(),
            "no such field is loaded",
        ),
        (
            "a.json",
            b"{\"name\": \"a\"}".to_vec(),
            "no such field is loaded",
        ),
        (
            "a.json",
            b"{\"raster\": {\"file\": \"b.png\"}}".to_vec(),
            "it cannot be read",
        ),
        ("a b.png", gray([1, 1], 0), "is no name"),
        ("a.png", gray([1024, 1025], 0), "it has 1024 × 1025 pixels"),
    ] {
        let folder = tempfile::tempdir().expect("a folder");
        write(folder.path(), name, content);
        let error = Fields::load(&settings(folder.path())).expect_err(name);
        assert!(error.source_name.ends_with(name), "{error}");
        assert!(error.detail.contains(expected), "{error}");
    }
    let folder = tempfile::tempdir().expect("a folder");
    write(folder.path(), "a.png", gray([1, 1], 0));
    write(folder.path(), "a.npy", "");
    let error = Fields::load(&settings(folder.path())).expect_err("twice");
    assert!(error.detail.contains("has the name `a`, too"), "{error}");
    let error = Fields::load(&settings(&folder.path().join("none"))).expect_err("no folder");
    assert!(error.source_name.starts_with("folder"), "{error}");
}

#[test]
fn reading_again_takes_what_is_good_and_keeps_what_was() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    let settings = settings(path);
    write(path, "a.png", gray([2, 2], 10));
    write(path, "b.json", r#"{"constant": 1}"#);
    write(path, "c.json", r#"{"constant": 1}"#);
    let first = Fields::load(&settings).expect("valid");
    let (same, changes, refused) = first.reload(&settings);
    assert_eq!(
        (changes.kept.len(), changes.loaded.len(), refused.len()),
        (3, 0, 0)
    );
    let held = |fields: &Fields| Arc::as_ptr(fields.get("a").expect("loaded"));
    assert_eq!(held(&first), held(&same));
    write(path, "a.png", "damaged");
    write(path, "b.json", r#"{"constant": 0.5}"#);
    fs::remove_file(path.join("c.json")).expect("there");
    write(path, "d.toml", "constant = 0.25");
    let (after, changes, refused) = same.reload(&settings);
    assert_eq!(changes.loaded, ["b", "d"]);
    assert_eq!(changes.kept, ["a"]);
    assert_eq!(changes.removed, ["c"]);
    let [(error, serving)] = refused.as_slice() else {
        panic!("one is refused: {refused:?}");
    };
    assert!(error.source_name.ends_with("a.png"));
    assert_eq!(*serving, first.get("a").map(|field| field.digest()));
    assert_eq!(held(&after), held(&first));
    assert!((after.get("a").expect("kept").spec.share([1.0, 1.0]) - 10.0 / 255.0).abs() < 1e-6);
}
