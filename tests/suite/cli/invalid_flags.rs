//! Wrong flags and wrong files: the message and the exit code.

use std::path::Path;

use crate::support::{command::run, table::rows};

/// Commands, and words of their messages. `~` is a query that lacks nothing.
const FLAGS: &str = r"
# Queries
~ -o trees.shp | --output | .shp | --format | parquet
~ --set limits.max_points=10 | has 81 points | allow 10 | --set limits.max_points=81
~ --set limits.max_streams=3 | --set limits.max_streams=3 | no effect | limits.max_rows
~ --tables /a --set tables.folder=/b | `tables.folder` | --set tables.folder=/b and by --tables
probe --url http://127.0.0.1:1 --listen 127.0.0.1:2 | --listen has no effect | --url
nearest --at 0,0 | --spacing, --min-distance
nearest --at 0,0 --spacing 1 --radius 1000 | --radius 1000 | 3141593 | 10000
sample | --bbox | --query | --min-distance
sample --spacing 1 | region is missing | --chunk | --region
sample --bbox 0,0,1,1 | amount is missing | --density | --count
sample --bbox 0,0,1 --spacing x --keep 3 | 3 errors | --bbox 0,0,1 | --spacing x | --keep 3 | 1e-6
sample --bbox 0,0,1,1 --chunk 1/1/1 --spacing 1 | --bbox and --chunk
sample --chunk 64/1 --spacing 1 | --chunk 64/1 | not a chunk | SIZE/CX/CY
sample --chunk 0/1/1 --spacing 1 | --chunk 0 | above 0
sample --region /nowhere --spacing 1 | --region | /nowhere | No such file
sample --query /nowhere | --query | /nowhere | No such file
sample --query - --seed 3 --chunk 1/1/1 | --seed, --chunk | --query - | --decimals
~ --format cvs | --format cvs | ndjson | parquet
~ --format png --decimals 2 | --decimals 2 | png | csv
~ --attributes variant | --variants is missing | oak:3
~ --attributes angel | --attributes angel | rank
~ --scale-range 1 | --scale-range 1 | expected 2 numbers, got 1
~ --limit 0 | --limit 0
~ --cursor 00 | --cursor 00 | earlier answer
~ --table 00 | --table 00 | 64 hexadecimal
~ --profile mauve | --profile mauve | blue
sample --bbox 0,0,9,9 --profile step --min-distance 1 | --min-distance 1 | step | no least distance
sample --bbox 0,0,9,9 --count 99999999999 | 99999999999 | limits.max_points=
count --circle 0,0,1e8 --spacing 1 | lattice rows | limits.max_rows=
count --bbox 0,0,9,9 --spacing 1 --format csv | --format
point abc --spacing 1 | abc | -31:52
point 0:0 | amount is missing
nearest --spacing 1 | --at is missing
nearest --spacing 1 --at 1 | --at 1 | expected 2 numbers, got 1
nearest --spacing 1 --at 1,1 --k 0 | --k 0 | 1 to 10000
split --bbox 0,0,9,9 --spacing 1 | --parts is missing
split --bbox 0,0,9,9 --spacing 1 --parts 0 | --parts 0 | 1 to 10000
# Space
sample --ball=0,0,0,1 --spacing=1 | --space
sample --space --bbox=0,0,1,1 --spacing=1 | expected 6 numbers
sample --bbox=0,0,0,1,1,1 --spacing=1 | expected 4 numbers
sample --space --circle=0,0,1 --spacing=1 | circle
sample --space --chunk=4/0/0 --spacing=1 | SIZE/CX/CY/CZ
sample --chunk=4/0/0/0 --spacing=1 | SIZE/CX/CY,
point --space --spacing=1 0:0 | three integers
nearest --space --spacing=1 --at=0,0 | expected 3 numbers
# Patterns
figure index --alpha 1 | between 1 and 2
figure index --alpha 2 | between 1 and 2
figure index --window 5000 | --window 5000
figure map --radius 1000000 | --radius 1000000
figure map --block 27,0 | two integers from 0 to 26
figure clusters --distance 99 | --distance 99
figure index -o x.gif | .svg or .png
figure index -o x.png --size 20 | --size 20
arrangement 2 | two integers joined by a comma
arrangement 2,9007199254740994 | out of range
arrangement 2,1 --grid 5,0,4,9 | --grid
arrangement 2,1 --list | beside grid
arrangement '' | has no offsets
arrangement 2,1.5 | 1.5 must be an integer
arrangement 2,1 --alpha 2 | --alpha
arrangement 2,1 --warp on | beside density
# Probes
probe --url https:/x | allowed: http://host:port
probe --timeout 0 | allowed: a number from 0.001 to 3600
probe --timeout NaN | allowed: a number from 0.001 to 3600
probe --listen 127.0.0.1:0 | name it with --url
probe --live --ready | cannot be used with
probe --insecure | --insecure: the URL is http
probe --url http://x --ca y | --ca: the URL is http
probe --ca x --insecure | cannot be used with
probe --certificate x | --key <FILE>
probe --url https://x --ca /nowhere | --ca /nowhere: it cannot be read
# Exports
export --spacing=1 --bbox=0,0,64,64 -o w | use --chunk
export --spacing=1 --bbox=0,0,64,64 -o w --chunk=0 | --chunk 0: out of range
export --spacing=1 --bbox=0,0,64,64 --chunk=16 | use --output DIR, or --dry-run
export --spacing=1 --bbox=0,0,64,64 -o w --chunk=16 --compress=none,gz | --compress none stands alone
export --spacing=1 --bbox=0,0,64,64 -o w/W.ZIP --chunk=16 | not a zip file; allowed: --output w/W, and after it `zip -r w/W.ZIP w/W`
export --spacing=1 --bbox=0,0,64,64 -o w --chunk=1e-9 | chunks; allowed
export --spacing=1 --bbox=0,0,64,64 -o w --chunk=0.01 | chunks; allowed: at most 10000000
export --spacing=1 --bbox=0,0,64,64 -o w --chunk=16 --levels=11 | --levels
export --spacing=1 --bbox=0,0,64,64 -o w --chunk=16 --levels=9 --lod=0.01 | --levels 9: level 7
export --check /dev/full | not a folder
# Kinds
forge mix --shares 1:0 | greater than 0
forge mix --shares 1:1000000 | 1000000
forge mix --shares 1:3 --table blau | no built-in table
forge mix --shares 1:3 --table no.strew | no.strew
forge mix --shares 1:3 --joint --steps 0 | steps is 0
forge mix --shares 1:3 --radius 20 | --radius
forge mix | --shares
";

/// A flag for standard input, what it reads, and words of the message.
const INPUTS: &str = r#"
--query | { | --query - | not JSON
--query | [] | --query - | must be an object
--query | {} | 2 errors | `region` | `spacing`
--query | {"region": {"bbox": [0, 0, 1, 1]}, "spacin": 1} | `spacin` = `1` | spacing
--query | {"bbox": [0, 0, 1, 1], "spacing": 1} | `bbox` | belongs in `region`
--query | {"region": {"circle": [0, 0, 1]}, "layers": [{"spacing": 1}]} | `region.circle` | center | `layers[0].name`: missing
--region | { | --region - | not JSON
--region | {"type": "Feature", "geometry": {"type": "LineString", "coordinates": [[0, 0], [1, 1]]}} | has the type `LineString` | GeoJSON
--region | {"type": "Polygon", "coordinates": [[[0, 0], [1, 1]]]} | --region | coordinates[0] has 2 positions
"#;

/// Fails unless a command is refused with these words.
fn assert_refused(arguments: &[&str], input: &str, texts: &[&str]) {
    let output = run(arguments, input);
    let message = String::from_utf8(output.stderr).expect("UTF-8");
    let asked = format!("{arguments:?} {input}");
    assert_eq!(output.status.code(), Some(2), "{asked}: {message}");
    assert!(output.stdout.is_empty(), "{asked}");
    for text in texts {
        assert!(message.contains(text), "{asked}: no `{text}`: {message}");
    }
}

#[test]
fn errors_name_the_flag_and_what_is_allowed() {
    for row in rows(FLAGS) {
        let command = row[0].replace('~', "sample --bbox 0,0,9,9 --spacing 1");
        let words = command.split_whitespace();
        let words: Vec<&str> = words.map(|word| word.trim_matches('\'')).collect();
        assert_refused(&words, "{}", &row[1..]);
    }
    assert!(!Path::new("w").exists());
}

#[test]
fn errors_name_the_file_and_the_member() {
    for row in rows(INPUTS) {
        let set = (row[0] == "--region").then_some("--spacing=1");
        let arguments: Vec<&str> = ["sample", row[0], "-"].into_iter().chain(set).collect();
        assert_refused(&arguments, row[1], &row[2..]);
    }
}

#[test]
fn a_missing_point_is_not_a_usage_error() {
    let output = run(&["point", "1:0", "--spacing=1"], "");
    let message = String::from_utf8(output.stderr).expect("UTF-8");
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.contains("1:0"), "{message}");
}
