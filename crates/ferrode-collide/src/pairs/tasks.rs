//! The same tasks on one thread or many.

#[cfg(feature = "parallel")]
use rayon::prelude::*;

/// Calls `run` for each `size` items with their bits, the number of the first item, and a place for what is found.
/// `size` is a multiple of 64. Grows `outputs` as needed.
pub(super) fn each<T: Send, O: Send + Default>(
    items: &mut [T],
    bits: &[u64],
    size: usize,
    outputs: &mut Vec<O>,
    run: impl Fn(usize, &mut [T], &[u64], &mut O) + Sync,
) {
    let tasks = items.len().div_ceil(size);
    if outputs.len() < tasks {
        outputs.resize_with(tasks, O::default);
    }
    let words = size / 64;
    #[cfg(feature = "parallel")]
    if tasks > 1 && rayon::current_num_threads() > 1 {
        items
            .par_chunks_mut(size)
            .zip(bits.par_chunks(words))
            .zip(outputs.par_iter_mut())
            .enumerate()
            .for_each(|(i, ((items, bits), output))| run(i * size, items, bits, output));
        return;
    }
    for (i, ((items, bits), output)) in
        items.chunks_mut(size).zip(bits.chunks(words)).zip(outputs.iter_mut()).enumerate()
    {
        run(i * size, items, bits, output);
    }
}

/// Calls `run` for each `size` items with a place for what is found.
pub(super) fn each_chunk<T: Sync, O: Send + Default>(
    items: &[T],
    size: usize,
    outputs: &mut Vec<O>,
    run: impl Fn(&[T], &mut O) + Sync,
) {
    let tasks = items.len().div_ceil(size);
    if outputs.len() < tasks {
        outputs.resize_with(tasks, O::default);
    }
    #[cfg(feature = "parallel")]
    if tasks > 1 && rayon::current_num_threads() > 1 {
        items.par_chunks(size).zip(outputs.par_iter_mut()).for_each(|(items, output)| run(items, output));
        return;
    }
    items.chunks(size).zip(outputs.iter_mut()).for_each(|(items, output)| run(items, output));
}
