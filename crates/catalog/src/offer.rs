//! How a table that is not loaded can be had: in words, for the errors of queries that name one.

use strew_core::{Alpha, map::Size};
use strew_error::Audience;
use strew_forge::{
    Job, MAX_RADIUS, Profile, Task as _,
    space::{SpaceJob, SpaceProfile},
};

use crate::Dimension;

/// How a table that is not loaded can be had.
#[derive(Clone, Copy, Debug)]
pub struct Offer(pub &'static Audience);

impl Offer {
    /// A remedy for a profile that is not loaded; empty if there is none.
    pub fn of_profile(self, dimension: Dimension, profile: &str) -> String {
        let is_known = match dimension {
            Dimension::Plane => Profile::named(profile).is_ok(),
            Dimension::Space => SpaceProfile::named(profile).is_some(),
        };
        match is_known {
            true => self.made(dimension, &format!("--profile {profile}")),
            false => String::new(),
        }
    }

    /// A remedy for a table that is not loaded; empty if there is none.
    pub fn of_table(
        self,
        dimension: Dimension,
        profile: &str,
        alpha: Alpha,
        map: Option<&str>,
    ) -> String {
        let size = map.map(str::parse::<Size>).transpose();
        let Ok(radius) = size.map(|size| size.map(|size| size.radius())) else {
            return String::new();
        };
        let radius = match dimension {
            Dimension::Plane => {
                let radius = radius.unwrap_or(Size::S.radius());
                if Profile::named(profile).is_err() || !(1..=MAX_RADIUS).contains(&radius) {
                    return String::new();
                }
                let job = Job {
                    radius,
                    profile: profile.into(),
                    ..Job::new(alpha)
                };
                // Said before any work is done.
                if let Some(hopeless) = job.prospect().hopeless() {
                    return format!(", and no table of it can be good there: {hopeless}");
                }
                radius
            }
            Dimension::Space => {
                let Some(profile) = SpaceProfile::named(profile) else {
                    return String::new();
                };
                let usual = SpaceJob::new(profile);
                let radius = radius.unwrap_or(usual.radius);
                let job = SpaceJob {
                    alpha,
                    radius,
                    ..usual
                };
                if job.plan().is_err() {
                    return String::new();
                }
                radius
            }
        };
        let flags = format!("--profile {profile} --alpha '{alpha}' --radius {radius}");
        self.made(dimension, &flags)
    }

    fn made(self, dimension: Dimension, flags: &str) -> String {
        let space = match dimension {
            Dimension::Plane => "",
            Dimension::Space => "--space ",
        };
        let made = || {
            format!(
                "; it can be made with strew forge {space}{flags}, and its file put into the folder of tables \
                 (tables.folder)"
            )
        };
        self.0.table.map_or_else(made, Into::into)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_table_comes_with_the_command_that_makes_it() {
        let alpha: Alpha = "sqrt(3)".parse().expect("valid");
        let of = |audience, dimension, map| {
            let profile = ["blue", "spaced"][usize::from(dimension == Dimension::Space)];
            Offer(audience).of_table(dimension, profile, alpha, map)
        };
        let plane = |map| of(&Audience::DAEMON, Dimension::Plane, map);
        let space = |map| of(&Audience::DAEMON, Dimension::Space, map);
        let profile = |name| Offer(&Audience::DAEMON).of_profile(Dimension::Space, name);
        for (text, command) in [
            (plane(None), "--profile blue --alpha 'sqrt(3)' --radius 49,"),
            (
                plane(Some("m")),
                "--profile blue --alpha 'sqrt(3)' --radius 100,",
            ),
            (
                space(None),
                "--space --profile spaced --alpha 'sqrt(3)' --radius 16,",
            ),
            (profile("blue"), "--space --profile blue,"),
        ] {
            let is_whole = text.contains("tables.folder");
            assert!(
                is_whole && text.contains(&format!("strew forge {command}")),
                "{text}"
            );
        }
        // Beyond the maps of the forge, and of a profile that it does not know.
        for none in [
            plane(Some("r257")),
            plane(Some("huge")),
            space(Some("s")),
            profile("pink"),
        ] {
            assert_eq!(none, "");
        }
        let way = of(&Audience::C, Dimension::Plane, None);
        assert_eq!(Some(&*way), Audience::C.table);
    }
}
