//! From the many contacts of a surface to the few that matter.

use crate::{Contacts, GeomContact};

/// Contacts of one place and normal are one: the deeper stays, of equals the first, whatever rounding makes of them. Then, if there are more than wanted, the deepest and
/// those that differ most, in place and normal, from the ones that stay. `size` is that of the smaller body.
pub(crate) fn reduce(out: &mut Contacts<'_>, size: f64) {
    let (near, equal) = (1e-4 * size, 1e-12 * size);
    let wanted = out.capacity();
    let list = out.added();
    let mut count = 0;
    for i in 0..list.len() {
        let c = list[i];
        let twin = list[..count].iter_mut().find(|k| {
            (k.point.position - c.point.position).length_squared() < near * near
                && k.point.normal.dot(c.point.normal) > 1.0 - 1e-8
        });
        match twin {
            Some(k) => {
                if c.point.depth > k.point.depth + equal {
                    *k = c;
                }
            }
            None => {
                list[count] = c;
                count += 1;
            }
        }
    }
    if count > wanted {
        spread(&mut list[..count], wanted, size);
        count = wanted;
    }
    out.truncate(count);
}

/// If there are more contacts than wanted, the deepest and those that differ most stay, as in [`reduce`].
pub(crate) fn keep_wanted(out: &mut Contacts<'_>, size: f64) {
    let wanted = out.capacity();
    let list = out.added();
    if list.len() > wanted {
        spread(list, wanted, size);
        out.truncate(wanted);
    }
}

/// Brings the `wanted` contacts to the front.
fn spread(list: &mut [GeomContact], wanted: usize, size: f64) {
    let deepest =
        (0..list.len()).fold(0, |b, i| if list[i].point.depth > list[b].point.depth { i } else { b });
    list.swap(0, deepest);
    let difference = |a: &GeomContact, b: &GeomContact| {
        (a.point.position - b.point.position).length_squared()
            + (a.point.normal - b.point.normal).length_squared() * size * size
    };
    // Of each that is left, how much it differs from those chosen; of many, it is found again each time.
    const KEPT: usize = 64;
    let mut least = [f64::INFINITY; KEPT];
    let kept = list.len() <= KEPT;
    for chosen in 1..wanted {
        let mut best = (f64::NEG_INFINITY, chosen);
        for i in chosen..list.len() {
            let differs = if kept {
                least[i] = least[i].min(difference(&list[chosen - 1], &list[i]));
                least[i]
            } else {
                list[..chosen].iter().map(|c| difference(c, &list[i])).fold(f64::INFINITY, f64::min)
            };
            if differs > best.0 {
                best = (differs, i);
            }
        }
        list.swap(chosen, best.1);
        if kept {
            least.swap(chosen, best.1);
        }
    }
}
