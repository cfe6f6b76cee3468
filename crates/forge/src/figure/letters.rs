//! Letters as lines: a plain font for painted figures.
//!
//! A letter is a list of lines, each through places of two digits, x and y. The line of writing is at y = 2, small
//! letters reach to 6, capitals to 8. A unit is 0.115 of the size of the font.

/// A unit of letters, in sizes of the font.
const UNIT: f64 = 0.115;
/// The space after a letter, in units.
const SPACE: f64 = 1.7;
/// The width of the lines, in sizes of the font.
pub(super) const WIDTH: f64 = 0.09;

/// The letters, each with its lines after it and two spaces between; some share theirs.
const LETTERS: &str = "\
    0O 030718384743321203  1 072822 0242  2 07183847460242  3 07183847463515 354443321203  4 32380444  \
    5 480805354443321203  6 473818070312324344351504  7 084812  8 15060718384746351504031232434435  \
    9 031232434738180706153546  A 022842 1434  B 02083847463505 3544433202  C 4738180703123243  D 02082846442202  \
    E 48080242 0535  F 480802 0535  G 47381807031232434525  H 0208 4248 0545  I 0208  J 3833221203  \
    K 0208 4804 1542  L 080242  M 0208254842  N 02084248  P 02083847463505  Q 030718384743321203 2442  \
    R 02083847463505 2542  S 473818070615354443321203  T 0848 2822  U 080312324348  V 082248  W 0812263248  \
    X 0248 0842  Y 082548 2522  Z 08480242  a 06263532 341403122233  b 0802 0516263533221203  c 361605031232  \
    d 3832 3526160503122233  e 043435261605031232  f 281712 0626  g 3631201001 3526160503122233  \
    h 0802 0516263532  i 0206 0808  j 161100 1818  k 0802 3604 1432  l 080312  m 0206 05162522 25364542  \
    n 0206 0516263532  o 050312223335261605  p 0600 0516263533221203  q 3630 3526160503122233  r 0206 041626  \
    s 3616051424332202  t 181322 0626  u 0603122233 3632  vν 061226  w 0612253246  x 0236 0632  y 0612 361200  \
    z 06360232  . 0202  , 1201  : 0202 0505  ; 0505 1201  ( 19060411  ) 09161401  [ 19090111  ] 09191101  \
    { 29181605141221  } 09181625141201  + 0444 2226  - 0424  −– 0444  = 0343 0545  / 0139  * 0543 0345 2226  \
    × 0336 0633  · 0404  < 360432  > 063402  ² 0828270525  ¹ 071815  ½ 071815 0248 3444433242  \
    α 3623120305162532  √ 0414223949  π 0646 1612 3632  ≤ 370533 0232  ≥ 073503 0232  ° 0708181707  ' 0806  \
    \" 0806 2826  % 0248 0707 4343  _ 0141  ! 0804 0202  ? 07183847462524 2222  | 0109  & 432212030427180742  \
    # 1218 3238 0444 0646  δ 27160503122233352618  Σ 4808250242  λ 081832 2502";
/// The lines of a letter that is not known: a box.
const BOX: &str = "0208484202";

/// The lines of a letter.
fn lines(letter: char) -> &'static str {
    let all = LETTERS
        .split("  ")
        .filter_map(|entry| entry.split_once(' '));
    let mut own = all.filter(|(letters, _)| letters.contains(letter));
    own.next().map_or(BOX, |(_, lines)| lines)
}

/// The width of a letter, in units.
fn width(letter: char) -> f64 {
    match letter {
        ' ' => 1.2,
        _ => {
            let xs = lines(letter)
                .split(' ')
                .flat_map(|line| line.bytes().step_by(2));
            f64::from(xs.max().unwrap_or(b'0') - b'0')
        }
    }
}

/// The length of a text of a size.
pub(super) fn length(text: &str, size: f64) -> f64 {
    let all: f64 = text.chars().map(|letter| width(letter) + SPACE).sum();
    (all - SPACE).max(0.0) * UNIT * size
}

/// The lines of a text that begins at a place.
pub(super) fn strokes([mut x, y]: [f64; 2], size: f64, text: &str) -> Vec<[[f64; 2]; 2]> {
    let unit = UNIT * size;
    let mut all = vec![];
    for letter in text.chars() {
        let lines = if letter == ' ' { "" } else { lines(letter) };
        for line in lines.split_ascii_whitespace() {
            let digit = |byte: u8| f64::from(byte - b'0');
            let (pairs, _) = line.as_bytes().as_chunks::<2>();
            let places = pairs
                .iter()
                .map(|[a, b]| [x + digit(*a) * unit, y - (digit(*b) - 2.0) * unit]);
            let places: Vec<_> = places.collect();
            all.extend(places.windows(2).map(|pair| [pair[0], pair[1]]));
        }
        x += (width(letter) + SPACE) * unit;
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_letters_of_figures_are_known() {
        let all = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz.,:;()[]{}+-−=/×·<>²¹½α√|";
        for letter in all.chars() {
            let own = lines(letter);
            assert!(own != BOX, "{letter}");
            let is_right = |line: &str| {
                line.len().is_multiple_of(2) && line.bytes().all(|b| b.is_ascii_digit())
            };
            assert!(own.split(' ').all(is_right), "{letter}");
        }
        assert_eq!(lines('文'), BOX);
    }

    #[test]
    fn texts_begin_where_they_should_and_have_their_length() {
        let text = "R = 20 is α";
        let strokes = strokes([10.0, 50.0], 12.0, text);
        let xs = || strokes.iter().flatten().map(|p| p[0]);
        let (least, most) = (xs().fold(f64::INFINITY, f64::min), xs().fold(0.0, f64::max));
        assert!((least - 10.0).abs() < 1e-9);
        assert!((most - least - length(text, 12.0)).abs() < 1e-9);
        assert!(
            strokes
                .iter()
                .flatten()
                .all(|p| (38.0..54.0).contains(&p[1]))
        );
    }
}
