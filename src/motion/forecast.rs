//! A guess at the coming gap, and how long a step is likely to be proved by it. It proves nothing.

use super::bound::least_between;

/// The part of the room that a forecast keeps back is this many times the error of the one before, as its error grows with the
/// square of the time …
const CAUTION: f64 = 8.0;

/// … and at most so much for a step: of what only moves straight on it is right, and its gap closes to the time tolerance in one.
const SHARE_OF_ROOM: f64 = 1.0 / 16.0;

/// room + speed·h + curve·h² beyond what is needed, a time h later.
#[derive(Debug, Clone, Copy)]
pub(super) struct Forecast {
    time: f64,
    room: f64,
    speed: f64,
    curve: f64,
    acceleration: f64,
    /// The error of the previous forecast, as a part of the room for each unit of time; infinite without one.
    off: f64,
}

impl Forecast {
    /// From the room at a time, how fast the distance grows there, the largest acceleration and the forecast made before.
    pub fn new(time: f64, room: f64, speed: f64, acceleration: f64, before: Option<&Forecast>) -> Forecast {
        let mut forecast = Forecast { time, room, speed, curve: 0.0, acceleration, off: f64::INFINITY };
        if let Some(before) = before.filter(|_| acceleration > 0.0) {
            let length = time - before.time;
            let curve = 0.5 * (speed - before.speed) / length;
            if curve.is_finite() {
                forecast.curve = curve;
            }
            forecast.off = (room - before.after(length)).abs() / (before.room * length);
        }
        forecast
    }

    fn after(&self, length: f64) -> f64 {
        self.room + self.speed * length + self.curve * length * length
    }

    /// The longest step up to a limit that is likely to be proved, no shorter than `shortest`; and whether it ends where the gap is
    /// about to close.
    pub fn step(&self, limit: f64, shortest: f64) -> (f64, bool) {
        let (mut length, mut closes) = (limit, false);
        if let Some(root) = self.root() {
            let before = root - (self.share(root, SHARE_OF_ROOM) * root).max(0.5 * shortest);
            if before < length {
                (length, closes) = (before, true);
            }
        }
        // The bend's largest loss must leave some of the chord.
        while length > shortest {
            let sag = 0.5 * self.acceleration * length * length;
            if least_between([self.room, self.after(length)], sag) > 0.0 {
                return (length, closes);
            }
            length *= 0.75;
        }
        (shortest, closes)
    }

    /// How much of the way to a root is kept back, at most a share: nothing of a way along which no point accelerates.
    pub fn share(&self, root: f64, most: f64) -> f64 {
        // A NaN is not the smaller.
        if self.acceleration == 0.0 { 0.0 } else { (CAUTION * self.off * root).min(most) }
    }

    /// After which time it first closes.
    pub fn root(&self) -> Option<f64> {
        let Forecast { room, speed, curve, .. } = *self;
        let discriminant = speed * speed - 4.0 * curve * room;
        let steep = -speed + discriminant.sqrt();
        // NaN where it does not close.
        (discriminant >= 0.0 && steep > 0.0).then(|| 2.0 * room / steep)
    }

    /// By how much the gap has grown after a step, if it goes on as smoothly.
    pub fn learn_curve(&mut self, rise: f64, length: f64) {
        let curve = (rise / length - self.speed) / length;
        if curve.is_finite() {
            self.curve = curve;
        }
    }

    /// The same where other points come nearest soon, say of faces that are parallel: the gap then goes straight from here.
    pub fn learn_kink(&mut self, rise: f64, length: f64) {
        let speed = rise / length;
        if speed.is_finite() {
            (self.speed, self.curve) = (speed, 0.0);
        }
    }
}
