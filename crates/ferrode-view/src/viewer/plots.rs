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
        use Quantity::{Contacts, Depth, Kinetic, Phase, Potential, Residual, StepTime, Total};
        vec![
            Self::new("energies [J]", &[Kinetic, Potential, Total], true),
            Self::new("step time [ms]", &[StepTime, Phase(0), Phase(1), Phase(2), Phase(3)], false),
            Self::new("contacts", &[Contacts], false),
            Self::new("penetration [mm]", &[Depth], false),
            Self::new("residual", &[Residual], false),
        ]
    }
}

impl Viewer {
    /// Plots a value that a text asks for: `link.NAME.VALUE` or `joint.NAME.VALUE`.
    ///
    /// # Errors
    /// There is no such value.
    pub fn plot_named(&mut self, text: &str) -> Result<(), String> {
        let quantity = Quantity::parse(text, &self.playback)?;
        self.plot(quantity);
        Ok(())
    }

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
        self.charts(ui, 120.0);
        ui.horizontal(|ui| {
            if ui.button("save CSV").clicked() {
                let path = Path::new("ferrode-values.csv");
                self.message = format!("saved {}", path.display());
                let done = self.series.save_csv(path, &self.playback);
                self.tell(done);
            }
            if ui.button("save PNG").clicked() {
                let path = PathBuf::from("ferrode-plots.png");
                self.message = format!("saved {}", path.display());
                self.wishes.push(Wish::Plots(path));
            }
        });
    }
}

/// Size of a plot in a picture of its own, in pixels.
const CHART: [u32; 2] = [900, 280];

impl Viewer {
    /// The plots that are shown, of a height each.
    fn charts(&self, ui: &mut egui::Ui, height: f32) {
        for (number, plot) in self.shown.iter().enumerate().filter(|(_, plot)| plot.visible) {
            chart(ui, (number, height), plot, &self.series, &|q| q.name(&self.playback));
        }
    }

    /// Size of the picture of all plots that are shown, in pixels.
    pub fn plots_size(&self) -> [u32; 2] {
        let count = self.shown.iter().filter(|plot| plot.visible).count().max(1) as u32;
        [CHART[0], CHART[1] * count + 20]
    }

    /// Fills a picture of [`Viewer::plots_size`] with all plots that are shown.
    pub fn plots_sheet(&self, ui: &mut egui::Ui) {
        egui::CentralPanel::default().show(ui, |ui| self.charts(ui, CHART[1] as f32 - 36.0));
    }
}

fn chart(
    ui: &mut egui::Ui,
    (number, height): (usize, f32),
    plot: &Plot,
    series: &Series,
    name: &dyn Fn(Quantity) -> String,
) {
    let mut chart = Chart::new(("plot", number))
        .height(height)
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
    chart.show(ui, |ui| {
        for (name, points) in lines {
            ui.line(Line::new(name, PlotPoints::from(points)));
        }
    });
}

/// At most about a thousand points: a line of more is no finer on a screen.
fn thinned(points: impl Iterator<Item = [f64; 2]>) -> Vec<[f64; 2]> {
    let points: Vec<[f64; 2]> = points.collect();
    let every = points.len().div_ceil(1000).max(1);
    points.into_iter().step_by(every).collect()
}
