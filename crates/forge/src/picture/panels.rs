//! The six panels of a picture: points, 2-D spectrum, radial power, anisotropy, RDF, figures.

use std::{error::Error, ops::Range};

use plotters::{coord::Shift, prelude::*};

use super::overlay::{self, Frame};
use crate::{Report, Target};

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// The plotting library failed.
#[derive(Debug, thiserror::Error)]
#[error("cannot draw the picture: {0}")]
pub struct PictureError(String);

/// The side of the panel of points, in mean spacings.
const POINTS_SIDE: f64 = 32.0;
/// The largest ν along an axis of the panel of the 2-D spectrum.
const SPECTRUM_END: f64 = 2.5;
/// The number of cells along an axis of that panel.
const SPECTRUM_CELLS: i64 = 100;
/// The power that is drawn white.
const WHITE_POWER: f64 = 2.5;
/// The number of shades of gray. More would only store noise.
const SHADES: f64 = 32.0;

/// Draws a report as SVG, under `title`. If there is a power curve that the points should follow,
/// `target`, it is drawn over their own.
///
/// # Errors
/// [`PictureError`] if the plotting library fails.
pub fn picture(
    report: &Report,
    title: &str,
    target: Option<&Target>,
) -> Result<String, PictureError> {
    let failed = |error: &dyn Error| PictureError(error.to_string());
    let mut svg = String::new();
    let [dotted, shaded] =
        draw(report, title, target, &mut svg).map_err(|error| failed(&*error))?;
    let shown = report.points.iter().map(|p| p.map(|v| v / POINTS_SIDE));
    let inside = shown.filter(|p| p.iter().all(|v| (0.0..1.0).contains(v)));
    let mut marks = overlay::dots(&dotted, inside);
    let cells = shades(report);
    marks += &overlay::gray(&shaded, SPECTRUM_CELLS as u32, &cells).map_err(|e| failed(&e))?;
    if let Some(end) = svg.rfind("</svg>") {
        svg.insert_str(end, &marks);
    }
    Ok(svg)
}

/// Draws everything but the dots and the shades of gray. Returns the frames for these two.
fn draw(
    report: &Report,
    title: &str,
    target: Option<&Target>,
    svg: &mut String,
) -> Result<[Frame; 2], Box<dyn Error>> {
    let root = SVGBackend::with_string(svg, (1200, 830)).into_drawing_area();
    root.fill(&WHITE)?;
    let root = root.titled(title, ("sans-serif", 22))?;
    let panels = root.split_evenly((2, 3));
    let dotted = frame(&panels[0], "points (in mean spacings)", 0.0..POINTS_SIDE)?;
    let end = spectrum_end(report);
    let shaded = frame(&panels[1], "power spectrum", -end..end)?;
    let power: Vec<[f64; 2]> = report
        .rings
        .iter()
        .map(|ring| [ring.nu, ring.power])
        .collect();
    let wanted: Vec<[f64; 2]> = target.map_or_else(Vec::new, |target| {
        power.iter().map(|&[nu, _]| [nu, target.at(nu)]).collect()
    });
    let caption = match target {
        Some(_) => "radial power over frequency (target in red)",
        None => "radial power over frequency",
    };
    curve(&panels[2], caption, &[&power, &wanted], (0.0, 2.0))?;
    let anisotropy: Vec<[f64; 2]> = report
        .rings
        .iter()
        .skip(4)
        .map(|ring| [ring.nu, ring.anisotropy_db.max(-20.0)])
        .collect();
    curve(
        &panels[3],
        "anisotropy (dB) over frequency",
        &[&anisotropy],
        (-5.0, 5.0),
    )?;
    let rdf = &report.rdf.bins;
    curve(&panels[4], "RDF over distance", &[rdf], (0.0, 2.0))?;
    figures(&panels[5], report)?;
    root.present()?;
    Ok([dotted, shaded])
}

/// Draws a square panel with axes. Returns the frame of its plot.
fn frame(area: &Area<'_>, caption: &str, range: Range<f64>) -> Result<Frame, Box<dyn Error>> {
    let mut chart = ChartBuilder::on(area)
        .caption(caption, ("sans-serif", 16))
        .margin(10)
        .x_label_area_size(24)
        .y_label_area_size(36)
        .build_cartesian_2d(range.clone(), range.clone())?;
    chart.configure_mesh().disable_mesh().draw()?;
    let corner = |v: f64| chart.backend_coord(&(v, v));
    let ((left, bottom), (right, top)) = (corner(range.start), corner(range.end));
    Ok(Frame {
        x: left.into()..right.into(),
        y: top.into()..bottom.into(),
    })
}

/// The largest ν along an axis that is both shown and measured.
fn spectrum_end(report: &Report) -> f64 {
    SPECTRUM_END.min(report.spectrum.nu_max())
}

/// The mean power in each cell of the frequency plane, as a gray value; rows from the top.
fn shades(report: &Report) -> Vec<u8> {
    let end = spectrum_end(report);
    let modes = (report.points.len() as f64).sqrt();
    let edge = |i: i64| (2.0 * i as f64 / SPECTRUM_CELLS as f64 - 1.0) * end;
    let span = |i: i64| (edge(i) * modes).ceil() as i64..(edge(i + 1) * modes).ceil() as i64;
    let mut cells = Vec::new();
    for row in (0..SPECTRUM_CELLS).rev() {
        for column in 0..SPECTRUM_CELLS {
            let (mut sum, mut count) = (0.0, 0u32);
            for ky in span(row) {
                for kx in span(column).filter(|&kx| (kx, ky) != (0, 0)) {
                    if let Some(power) = report.spectrum.at(kx, ky) {
                        sum += power;
                        count += 1;
                    }
                }
            }
            let part = (sum / f64::from(count.max(1)) / WHITE_POWER).min(1.0);
            cells.push(((part * (SHADES - 1.0)).round() * (255.0 / (SHADES - 1.0))) as u8);
        }
    }
    cells
}

/// Draws a panel with curves. The vertical axis shows at least `range`.
fn curve(
    area: &Area<'_>,
    caption: &str,
    curves: &[&[[f64; 2]]],
    range: (f64, f64),
) -> Result<(), Box<dyn Error>> {
    let values = || curves.iter().flat_map(|curve| curve.iter());
    let end = values().map(|v| v[0]).fold(0.0, f64::max);
    let low = values().map(|v| v[1]).fold(range.0, f64::min);
    let high = values().map(|v| v[1] * 1.05).fold(range.1, f64::max);
    let mut chart = ChartBuilder::on(area)
        .caption(caption, ("sans-serif", 16))
        .margin(10)
        .x_label_area_size(24)
        .y_label_area_size(36)
        .build_cartesian_2d(0.0..end, low..high)?;
    chart
        .configure_mesh()
        .max_light_lines(1)
        .light_line_style(WHITE)
        .draw()?;
    for (curve, color) in curves.iter().zip([&BLUE, &RED]) {
        let line = curve.iter().map(|v| (v[0], v[1]));
        chart.draw_series(LineSeries::new(line, color))?;
    }
    Ok(())
}

/// Writes the figures, one a line.
fn figures(area: &Area<'_>, report: &Report) -> Result<(), Box<dyn Error>> {
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
