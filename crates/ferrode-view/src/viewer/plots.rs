//! Plots of recorded values.

use super::series::{Quantity, Series};
use super::{Viewer, Wish};
use egui_plot::{Legend, Line, Plot as Chart, PlotPoints};
use std::path::{Path, PathBuf};

/// A plot: values that share an axis.
#[derive(Clone, Debug)]
pub struct Plot {
    title: String,
    quantities: Vec<Quantity>,
    visible: bool,
}

impl Plot {
    fn new(title: &str, quantities: &[Quantity], visible: bool) -> Self {
        Self { title: title.to_owned(), quantities: quantities.to_vec(), visible }
    }

    /// The plots that every world has.
    pub fn usual() -> Vec<Self> {
        use Quantity::{Contacts, Depth, Kinetic, Potential, Residual, StepTime, Total};
        vec![
            Self::new("energies [J]", &[Kinetic, Potential, Total], true),
            Self::new("step time [ms]", &[StepTime], false),
            Self::new("contacts", &[Contacts], false),
            Self::new("penetration [mm]", &[Depth], false),
            Self::new("residual", &[Residual], false),
        ]
    }
}

impl Viewer {
    /// Plots a value of a body or joint from now on.
    pub fn plot(&mut self, quantity: Quantity) {
        self.series.add(quantity);
        let known = self.shown.iter().any(|plot| plot.quantities == [quantity]);
        if !known {
            let title = quantity.name(&self.playback);
            self.shown.push(Plot::new(&title, &[quantity], true));
        }
    }

    pub(super) fn plots(&mut self, ui: &mut egui::Ui) {
        ui.horizontal_wrapped(|ui| {
            for plot in &mut self.shown {
                ui.toggle_value(&mut plot.visible, &plot.title);
            }
        });
        let mut area: Option<egui::Rect> = None;
        for (number, plot) in self.shown.iter().enumerate().filter(|(_, plot)| plot.visible) {
            let rect = chart(ui, number, plot, &self.series, &|q| q.name(&self.playback));
            area = Some(area.map_or(rect, |sum| sum.union(rect)));
        }
        ui.horizontal(|ui| {
            if ui.button("save CSV").clicked() {
                let path = Path::new("ferrode-values.csv");
                self.message = format!("saved {}", path.display());
                let done = self.series.save_csv(path, &self.playback);
                self.tell(done);
            }
            if ui.button("save PNG").clicked()
                && let Some(area) = area
            {
                let path = PathBuf::from("ferrode-plots.png");
                self.message = format!("saved {}", path.display());
                let corners = [[area.min.x, area.min.y], [area.max.x, area.max.y]];
                self.wishes.push(Wish::Shot(path, Some(corners)));
            }
        });
    }
}

fn chart(
    ui: &mut egui::Ui,
    number: usize,
    plot: &Plot,
    series: &Series,
    name: &dyn Fn(Quantity) -> String,
) -> egui::Rect {
    let mut chart = Chart::new(("plot", number))
        .height(120.0)
        .allow_scroll(false)
        .allow_zoom(false)
        .allow_drag(false)
        .show_x(true)
        .y_axis_min_width(44.0);
    if plot.quantities.len() > 1 {
        chart = chart.legend(Legend::default().background_alpha(0.5));
    } else {
        ui.small(&plot.title);
    }
    let lines: Vec<(String, Vec<[f64; 2]>)> =
        plot.quantities.iter().map(|quantity| (name(*quantity), thinned(series.points(*quantity)))).collect();
    let shown = chart.show(ui, |ui| {
        for (name, points) in lines {
            ui.line(Line::new(name, PlotPoints::from(points)));
        }
    });
    shown.response.rect
}

/// At most about a thousand points: a line of more is no finer on a screen.
fn thinned(points: impl Iterator<Item = [f64; 2]>) -> Vec<[f64; 2]> {
    let points: Vec<[f64; 2]> = points.collect();
    let every = points.len().div_ceil(1000).max(1);
    points.into_iter().step_by(every).collect()
}
