//! What is measured of a table: twins, and windows at seeds and places.

/// Flags of the sets of a table.
#[derive(Debug, clap::Args)]
#[group(skip)]
pub(super) struct Subjects {
    /// With --table: a twin p/q; may be repeated [default: the first unseen ones with 70,225 points
    /// or more].
    #[arg(long, value_name = "P/Q", requires = "table")]
    pub(super) twin: Vec<String>,
    /// With --table: the approximate number of points of a window [default: 80000; in space 314432].
    #[arg(long, value_name = "N", requires = "table")]
    pub(super) window_points: Option<u64>,
    /// With --table: the seed of a window; may be repeated. In the plane it chooses a place, by default 1 and
    /// 2; in space it is that of the set, by default 0, which is the plain set, 1 and 2.
    #[arg(long, value_name = "SEED", requires = "table")]
    pub(super) window_seed: Vec<u64>,
    /// With --table of points in space: the least corner of the windows, in mean spacings [default: 0,0,0].
    #[arg(long, value_name = "X,Y,Z", requires = "table")]
    pub(super) window_at: Option<Corner>,
    /// With --table of points in space: the seed of the 60 places whose small windows show a local lattice.
    #[arg(long, value_name = "SEED", requires = "table", default_value_t = 12)]
    pub(super) places_seed: u64,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Corner(pub(super) [f64; 3]);

impl std::str::FromStr for Corner {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Vec<f64> = text
            .split(',')
            .map_while(|v| v.trim().parse().ok())
            .filter(|v: &f64| v.abs() <= 1e6)
            .collect();
        match <[f64; 3]>::try_from(numbers) {
            Ok(at) if text.split(',').count() == 3 => Ok(Self(at)),
            _ => Err("allowed: three numbers X,Y,Z from -1000000 to 1000000".into()),
        }
    }
}
