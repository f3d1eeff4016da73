//! The runs as a picture: per scene a bar for each engine, as a multiple of the fastest peer's time.

use crate::report::{fastest_peer, groups};
use crate::run::Run;
use plotters::prelude::*;

const COLOURS: [RGBColor; 10] = [
    RGBColor(200, 80, 30),
    RGBColor(60, 110, 180),
    RGBColor(90, 160, 90),
    RGBColor(150, 190, 150),
    RGBColor(140, 140, 140),
    RGBColor(190, 160, 60),
    RGBColor(140, 90, 170),
    RGBColor(60, 160, 170),
    RGBColor(200, 110, 150),
    RGBColor(110, 80, 60),
];
/// Longer bars are cut.
const LONGEST: f64 = 5.0;

/// The picture.
///
/// # Errors
/// What the drawing library says.
pub fn svg(runs: &[Run]) -> Result<String, String> {
    let mut names: Vec<&str> = Vec::new();
    for run in runs {
        if !names.contains(&run.engine.as_str()) {
            names.push(&run.engine);
        }
    }
    let groups = groups(runs);
    let (row, bar) = (names.len() as i32 * 12 + 14, 12);
    let (width, left, top) = (1000, 300, 50);
    let height = top + row * groups.len() as i32 + 20;
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, (width as u32, height as u32)).into_drawing_area();
        let text = |size: i32| ("sans-serif", size).into_font();
        let draw = || -> Result<(), DrawingAreaErrorKind<std::io::Error>> {
            area.fill(&WHITE)?;
            let title = "Time of a step over that of the fastest peer (shorter is better)";
            area.draw(&Text::new(title, (10, 8), text(16)))?;
            for (i, name) in names.iter().enumerate() {
                let x = 10 + 980 / names.len() as i32 * i as i32;
                area.draw(&Rectangle::new([(x, 30), (x + 10, 40)], COLOURS[i % COLOURS.len()].filled()))?;
                area.draw(&Text::new((*name).to_owned(), (x + 14, 28), text(13)))?;
            }
            let scale = f64::from(width - left - 60) / LONGEST;
            for (g, group) in groups.iter().enumerate() {
                let y = top + row * g as i32;
                let Some(first) = group.first() else { continue };
                let threads =
                    if first.threads == 1 { String::new() } else { format!(", {} threads", first.threads) };
                area.draw(&Text::new(format!("{}{threads}", first.scene), (10, y + row / 2 - 12), text(12)))?;
                let best = fastest_peer(group).unwrap_or(1.0);
                for (k, run) in group.iter().filter(|run| run.refused.is_none()).enumerate() {
                    let colour = names.iter().position(|n| *n == run.engine).unwrap_or(0);
                    let ratio = run.time() / best;
                    let (y, length) = (y + bar * k as i32, (ratio.min(LONGEST) * scale) as i32);
                    let bar = [(left, y), (left + length, y + 10)];
                    area.draw(&Rectangle::new(bar, COLOURS[colour % COLOURS.len()].filled()))?;
                    area.draw(&Text::new(format!("{ratio:.2}"), (left + length + 4, y), text(11)))?;
                }
            }
            let one = left + scale as i32;
            area.draw(&PathElement::new([(one, top - 4), (one, height - 10)], BLACK))?;
            area.present()
        };
        draw().map_err(|e| e.to_string())?;
    }
    Ok(svg)
}
