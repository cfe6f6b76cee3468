//! A picture of a measured set: points, 2-D spectrum, radial power, anisotropy, RDF.

use plotters::{coord::Shift, prelude::*};

use crate::Report;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn = Result<(), Box<dyn std::error::Error>>;

/// A picture cannot be drawn.
#[derive(Debug, thiserror::Error)]
#[error("cannot draw the picture: {0}")]
pub struct PictureError(String);

/// Mean spacings along the side of the panel with points.
const SHOWN: f64 = 32.0;
/// The 2-D spectrum is shown up to this frequency, in this many cells.
const SPECTRUM_END: f64 = 2.5;
const SPECTRUM_CELLS: i64 = 100;
/// Power that is shown white.
const WHITE_POWER: f64 = 2.5;

/// An SVG picture of a report; `title` stands above it.
///
/// # Errors
/// [`PictureError`] if the plotting library fails.
pub fn picture(report: &Report, title: &str) -> Result<String, PictureError> {
    let mut svg = String::new();
    draw(report, title, &mut svg).map_err(|error| PictureError(error.to_string()))?;
    Ok(svg)
}

fn draw(report: &Report, title: &str, svg: &mut String) -> Drawn {
    let root = SVGBackend::with_string(svg, (1200, 830)).into_drawing_area();
    root.fill(&WHITE)?;
    let root = root.titled(title, ("sans-serif", 22))?;
    let panels = root.split_evenly((2, 3));
    points(&panels[0], report)?;
    spectrum(&panels[1], report)?;
    let power: Vec<[f64; 2]> = report
        .rings
        .iter()
        .map(|ring| [ring.nu, ring.power])
        .collect();
    curve(
        &panels[2],
        "radial power over frequency",
        &power,
        (0.0, 2.0),
    )?;
    let anisotropy = report
        .rings
        .iter()
        .skip(4)
        .map(|ring| [ring.nu, ring.anisotropy_db.max(-20.0)]);
    curve(
        &panels[3],
        "anisotropy (dB) over frequency",
        &anisotropy.collect::<Vec<_>>(),
        (-5.0, 5.0),
    )?;
    curve(
        &panels[4],
        "RDF over distance",
        &report.rdf.bins,
        (0.0, 2.0),
    )?;
    figures(&panels[5], report)?;
    root.present()?;
    Ok(())
}

fn points(area: &Area<'_>, report: &Report) -> Drawn {
    let mut chart = ChartBuilder::on(area)
        .caption("points (in mean spacings)", ("sans-serif", 16))
        .margin(10)
        .x_label_area_size(24)
        .y_label_area_size(36)
        .build_cartesian_2d(0.0..SHOWN, 0.0..SHOWN)?;
    chart.configure_mesh().disable_mesh().draw()?;
    let shown = report
        .points
        .iter()
        .filter(|p| p.iter().all(|v| (0.0..SHOWN).contains(v)));
    chart.draw_series(shown.map(|p| Circle::new((p[0], p[1]), 2, BLACK.filled())))?;
    Ok(())
}

fn spectrum(area: &Area<'_>, report: &Report) -> Drawn {
    let end = SPECTRUM_END.min(report.spectrum.nu_max());
    let mut chart = ChartBuilder::on(area)
        .caption("power spectrum", ("sans-serif", 16))
        .margin(10)
        .x_label_area_size(24)
        .y_label_area_size(36)
        .build_cartesian_2d(-end..end, -end..end)?;
    chart.configure_mesh().disable_mesh().draw()?;
    let modes = (report.points.len() as f64).sqrt();
    let edge = |i: i64| (2.0 * i as f64 / SPECTRUM_CELLS as f64 - 1.0) * end;
    for row in 0..SPECTRUM_CELLS {
        for column in 0..SPECTRUM_CELLS {
            let span =
                |i: i64| (edge(i) * modes).ceil() as i64..(edge(i + 1) * modes).ceil() as i64;
            let (mut sum, mut count) = (0.0, 0u32);
            for ky in span(row) {
                for kx in span(column).filter(|&kx| (kx, ky) != (0, 0)) {
                    if let Some(power) = report.spectrum.at(kx, ky) {
                        sum += power;
                        count += 1;
                    }
                }
            }
            let shade = (255.0 * (sum / f64::from(count.max(1)) / WHITE_POWER).min(1.0)) as u8;
            let corners = [(edge(column), edge(row)), (edge(column + 1), edge(row + 1))];
            let cell = Rectangle::new(corners, RGBColor(shade, shade, shade).filled());
            chart.draw_series(std::iter::once(cell))?;
        }
    }
    Ok(())
}

/// A curve, with at least `range` of the vertical axis shown.
fn curve(area: &Area<'_>, caption: &str, values: &[[f64; 2]], range: (f64, f64)) -> Drawn {
    let end = values.last().map_or(1.0, |last| last[0]);
    let low = values.iter().map(|v| v[1]).fold(range.0, f64::min);
    let high = values.iter().map(|v| v[1] * 1.05).fold(range.1, f64::max);
    let mut chart = ChartBuilder::on(area)
        .caption(caption, ("sans-serif", 16))
        .margin(10)
        .x_label_area_size(24)
        .y_label_area_size(36)
        .build_cartesian_2d(0.0..end, low..high)?;
    chart.configure_mesh().light_line_style(WHITE).draw()?;
    chart.draw_series(LineSeries::new(values.iter().map(|v| (v[0], v[1])), &BLUE))?;
    Ok(())
}

fn figures(area: &Area<'_>, report: &Report) -> Drawn {
    let of = &report.figures;
    let lines = [format!("{} points", of.points)];
    let named = of
        .values
        .iter()
        .map(|(name, value)| format!("{name} = {value}"));
    for (i, line) in lines.into_iter().chain(named).enumerate() {
        let place = (30, 40 + 22 * i as i32);
        area.draw(&Text::new(line, place, ("sans-serif", 16)))?;
    }
    Ok(())
}
