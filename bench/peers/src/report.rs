//! Runs as tables.

use crate::run::Run;
use std::fmt::Write;

/// The runs of one scene and number of threads, in the order they came.
pub fn groups(runs: &[Run]) -> Vec<&[Run]> {
    runs.chunk_by(|a, b| a.scene == b.scene && a.threads == b.threads).collect()
}

/// The fastest peer of a group, among those that lost nothing.
pub fn fastest_peer(group: &[Run]) -> Option<f64> {
    let peers = group.iter().filter(|r| r.engine != "ferrode" && r.refused.is_none() && r.quality.lost == 0);
    peers.map(Run::time).min_by(f64::total_cmp)
}

fn millimetres(metres: f64) -> String {
    if metres.is_finite() { format!("{:.2}", 1e3 * metres) } else { "—".into() }
}

/// All tables, as Markdown.
pub fn text(runs: &[Run]) -> String {
    let mut text = format!(
        "# Worlds, engines side by side: {}\n\n",
        [crate::stamp::processor(), crate::stamp::today()].join(", ")
    );
    text += "From `cargo run --release -p ferrode-bench-peers`, steps of 1/60 s. Times are means over the timed steps of the median run, \
             as processor time on one thread and time of the clock on two; depths, joint errors and speeds are those of the last \
             step, measured from the bodies' poses by one program for all engines. Memory is the peak over the program without a world.\n\n";
    let mut abouts: Vec<&str> =
        runs.iter().filter(|r| r.refused.is_none()).map(|r| r.about.as_str()).collect();
    abouts.sort_unstable();
    abouts.dedup();
    for about in abouts {
        // Writing to a string can't fail.
        let _ = writeln!(text, "- {about}");
    }
    for group in groups(runs) {
        let Some(first) = group.first() else { continue };
        let threads =
            if first.threads == 1 { "1 thread".into() } else { format!("{} threads", first.threads) };
        let _ = write!(
            text,
            "\n## {}, {threads}\n\n| engine | ms a step | of the fastest peer | memory, MB | deepest, mm | mean depth, mm | joint error, mm | axis error, mrad | moved, m | fastest, m/s | lost |\n|---|---|---|---|---|---|---|---|---|---|---|\n",
            first.scene
        );
        let best = fastest_peer(group);
        for run in group {
            if let Some(why) = &run.refused {
                let _ = writeln!(text, "| {} | not run: {why} | | | | | | | | | |", run.engine);
                continue;
            }
            let q = &run.quality;
            let _ = writeln!(
                text,
                "| {} | {:.3} | {} | {:.0} | {} | {} | {} | {:.2} | {:.3} | {:.4} | {} |",
                run.engine,
                run.time(),
                best.map_or("—".into(), |best| format!("{:.2}", run.time() / best)),
                run.memory,
                millimetres(q.deepest),
                millimetres(q.mean_depth),
                millimetres(q.joint_error),
                1e3 * q.axis_error,
                q.moved,
                q.fastest,
                q.lost
            );
        }
    }
    text
}
