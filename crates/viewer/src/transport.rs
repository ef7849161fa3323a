//! Time: playing, pausing, stepping, looping.

/// Speeds of playing, of a second each.
pub const SPEEDS: [f32; 5] = [0.1, 0.25, 0.5, 1.0, 2.0];
/// How long a scene without an end is shown on a timeline, seconds.
const SHORTEST_SPAN_S: f32 = 4.0;
/// How long hair is given to settle after the last move, seconds.
pub const SETTLING_S: f32 = 2.0;
/// The longest that a frame of the window lets pass, beyond what it was told to wait: a slow machine shows time slowly.
const LONGEST_TICK_S: f32 = 0.5;
/// Where time starts again in a scene without an end, seconds: hair is simulated from the beginning to wherever it is looked at.
const LONGEST_S: f64 = 600.0;

/// The time of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Transport {
    /// Seconds, between two frames of the preset's.
    time_s: f64,
    /// Whether it goes on.
    pub is_playing: bool,
    /// Seconds of the scene in one of the window's.
    pub speed: f32,
    /// Whether it starts again at the end.
    pub is_looping: bool,
    /// Frames a second.
    fps: f32,
    /// Where the script ends, seconds; 0 where it never does.
    end_s: f32,
}

impl Default for Transport {
    fn default() -> Self {
        Self {
            time_s: 0.0,
            is_playing: false,
            speed: 1.0,
            is_looping: true,
            fps: 24.0,
            end_s: 0.0,
        }
    }
}

impl Transport {
    /// Takes on the preset's frames a second, and where its script ends (seconds, 0 for never).
    pub fn follow(&mut self, fps: f32, end_s: f32) {
        (self.fps, self.end_s) = (fps, end_s);
    }

    /// The number of the frame that is shown.
    #[must_use]
    pub fn frame(&self) -> u32 {
        // A frame that was stepped to is that frame, whatever its seconds were rounded to.
        (self.time_s * f64::from(self.fps) + 1e-3) as u32
    }

    /// The time of the frame that is shown, seconds, as the command line has it.
    #[must_use]
    pub fn shown_s(&self) -> f32 {
        self.frame() as f32 / self.fps
    }

    /// Frames a second.
    #[must_use]
    pub fn fps(&self) -> f32 {
        self.fps
    }

    /// Seconds that a timeline shows.
    #[must_use]
    pub fn span_s(&self) -> f32 {
        if self.end_s > 0.0 {
            self.end_s
        } else {
            SHORTEST_SPAN_S.max(self.shown_s())
        }
    }

    /// Lets so many seconds of the window's pass. Whether another frame is shown now.
    pub fn tick(&mut self, passed_s: f32) -> bool {
        if !self.is_playing {
            return false;
        }
        let before = self.frame();
        let longest = LONGEST_TICK_S + self.next_frame_in_s();
        self.time_s += f64::from(passed_s.clamp(0.0, longest) * self.speed);
        let has_end = self.end_s > 0.0;
        let end = if has_end {
            f64::from(self.end_s)
        } else {
            LONGEST_S
        };
        if self.time_s >= end {
            if self.is_looping || !has_end {
                self.time_s %= end;
            } else {
                self.time_s = end;
                self.is_playing = false;
            }
        }
        self.frame() != before
    }

    /// Seconds until the next frame is due.
    #[must_use]
    pub fn next_frame_in_s(&self) -> f32 {
        let next = f64::from(self.frame() + 1) / f64::from(self.fps);
        (((next - self.time_s) as f32) / self.speed).max(0.0)
    }

    /// Goes to a time, seconds.
    pub fn seek(&mut self, time_s: f32) {
        if time_s.is_finite() {
            let last = if self.end_s > 0.0 {
                self.end_s
            } else {
                LONGEST_S as f32
            };
            self.time_s = f64::from(time_s.clamp(0.0, last));
        }
    }

    /// Pauses, and goes so many frames on, or back.
    pub fn step(&mut self, frames: i64) {
        self.is_playing = false;
        let frame = (i64::from(self.frame()) + frames).max(0);
        self.seek((frame as f64 / f64::from(self.fps)) as f32);
    }

    /// Pauses at the beginning.
    pub fn rewind(&mut self) {
        self.is_playing = false;
        self.time_s = 0.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_those_of_the_command_line() {
        for fps in [12.0, 23.976, 24.0, 30.0, 60.0] {
            let mut transport = Transport::default();
            transport.follow(fps, 0.0);
            for frame in 1..2_000 {
                transport.step(1);
                assert_eq!(transport.frame(), frame, "{fps}");
                assert_eq!(transport.shown_s(), frame as f32 / fps);
            }
            transport.step(-5_000);
            assert_eq!(transport.frame(), 0);
        }
    }

    #[test]
    fn it_loops_or_stops_at_the_end() {
        let mut transport = Transport {
            is_playing: true,
            ..Transport::default()
        };
        transport.follow(24.0, 1.0);
        let shown: Vec<bool> = (0..60).map(|_| transport.tick(1.0 / 60.0)).collect();
        assert_eq!(shown.iter().filter(|is_new| **is_new).count(), 24);
        assert!(transport.is_playing && transport.shown_s() < 0.1);
        transport.is_looping = false;
        for _ in 0..200 {
            transport.tick(1.0 / 60.0);
        }
        assert!(!transport.is_playing);
        assert_eq!(transport.frame(), 24);
    }

    #[test]
    fn a_window_that_hung_loses_time_not_frames() {
        let mut transport = Transport {
            is_playing: true,
            ..Transport::default()
        };
        transport.tick(100.0);
        assert!(transport.shown_s() <= LONGEST_TICK_S + 1.0 / 24.0);
        assert!((0.0..0.05).contains(&transport.next_frame_in_s()));
        transport.seek(f32::NAN);
        assert!(transport.shown_s() <= LONGEST_TICK_S + 1.0 / 24.0);
    }
}
