//! What `dsElapsedTime` tells.

use std::time::Instant;

/// Time, of the wall or counted in frames.
#[derive(Clone, Copy, Debug)]
pub enum Clock {
    /// Of the wall.
    Wall {
        /// When it was last asked; `None` before.
        asked: Option<Instant>,
    },
    /// So many seconds a frame, whatever the wall says, so that every run is the same.
    Frames {
        /// Seconds a frame.
        step: f64,
        /// Frames that have begun.
        begun: u64,
        /// Of them, those that were over when it was last asked.
        asked: u64,
    },
}

impl Clock {
    /// A frame begins.
    pub fn begin_frame(&mut self) {
        if let Self::Frames { begun, .. } = self {
            *begun += 1;
        }
    }

    /// Seconds since this was last asked; the first time since the loop began, 0 before that.
    pub fn elapsed(&mut self) -> f64 {
        match self {
            Self::Wall { asked } => {
                let now = Instant::now();
                asked.replace(now).map_or(0.0, |asked| (now - asked).as_secs_f64())
            }
            Self::Frames { step, begun, asked } => {
                let frames = *begun - *asked;
                *asked = *begun;
                frames as f64 * *step
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Clock;

    #[test]
    fn frames_are_counted() {
        let mut clock = Clock::Frames { step: 0.25, begun: 0, asked: 0 };
        assert_eq!(clock.elapsed(), 0.0);
        clock.begin_frame();
        assert_eq!((clock.elapsed(), clock.elapsed()), (0.25, 0.0));
        clock.begin_frame();
        clock.begin_frame();
        assert_eq!(clock.elapsed(), 0.5);
        assert_eq!(Clock::Wall { asked: None }.elapsed(), 0.0);
    }
}
