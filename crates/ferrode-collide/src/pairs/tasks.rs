//! The same tasks on one thread or many.

use ferrode_math::stage::{Chunks, Crew, chunks};

/// Calls `run` for each `size` items with their bits, the number of the first item, and a place for what is found.
/// `size` is a multiple of 64. Grows `outputs` as needed.
pub(super) fn each<T: Send, O: Send + Default>(
    crew: &Crew,
    items: &mut [T],
    bits: &[u64],
    size: usize,
    outputs: &mut Vec<O>,
    run: impl Fn(usize, &mut [T], &[u64], &mut O) + Sync,
) {
    let (words, places) = (size / 64, outputs_for(items.len(), size, outputs));
    crew.each((chunks(items, size), places), |task, (items, output)| {
        let bits = &bits[task * words..bits.len().min((task + 1) * words)];
        run(task * size, items, bits, &mut output[0]);
    });
}

/// Calls `run` for each `size` items with a place for what is found.
pub(super) fn each_chunk<T: Sync, O: Send + Default>(
    crew: &Crew,
    items: &[T],
    size: usize,
    outputs: &mut Vec<O>,
    run: impl Fn(&[T], &mut O) + Sync,
) {
    crew.each(outputs_for(items.len(), size, outputs), |task, output| {
        run(&items[task * size..items.len().min((task + 1) * size)], &mut output[0]);
    });
}

/// A place for what each task finds.
fn outputs_for<O: Send + Default>(items: usize, size: usize, outputs: &mut Vec<O>) -> Chunks<'_, O> {
    let tasks = items.div_ceil(size);
    if outputs.len() < tasks {
        outputs.resize_with(tasks, O::default);
    }
    chunks(&mut outputs[..tasks], 1)
}
