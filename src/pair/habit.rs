//! Which way a pair answers approximate queries: by look-ups of support functions, or by marching. If it moves little, marching
//! from its last features costs less.

/// A habit. Any bits make one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Habit {
    marches: bool,
    /// Marching has not yet begun: its first search starts anew, and predicts nothing for the next.
    is_new: bool,
    /// Consecutive queries that favour the other way: for a pair that looks up, those that hardly moved; for one that marches,
    /// those that took many steps.
    against: u8,
    /// Consecutive failed look-ups.
    failed: u8,
    /// Queries that still have to run without look-ups.
    pause: u8,
}

impl Habit {
    /// This many consecutive queries change the habit.
    const ENOUGH: u8 = 2;
    /// Steps of marching that are many.
    const MANY_STEPS: u32 = 4;

    /// As it was packed.
    #[inline(always)]
    pub(super) fn of(word: u32) -> Habit {
        let [flags, against, failed, pause] = word.to_le_bytes();
        Habit { marches: flags & 1 != 0, is_new: flags & 2 != 0, against, failed, pause }
    }

    /// Packed.
    #[inline(always)]
    pub(super) fn word(self) -> u32 {
        let flags = u8::from(self.marches) | u8::from(self.is_new) << 1;
        u32::from_le_bytes([flags, self.against, self.failed, self.pause])
    }

    /// Whether the next query looks up.
    #[inline(always)]
    pub(super) fn looks_up(self) -> bool {
        !self.marches & (self.pause == 0)
    }

    /// After look-ups that answered; `is_still`: the pair has hardly moved since the last time.
    #[inline(always)]
    pub(super) fn looked_up(self, is_still: bool) -> Habit {
        let against = if is_still { self.against.saturating_add(1) } else { 0 };
        let marches = against >= Self::ENOUGH;
        Habit { marches, is_new: marches, against: if marches { 0 } else { against }, failed: 0, pause: 0 }
    }

    /// After failed look-ups: the second consecutive failure brings a short pause, the sixth and all after it a long one.
    #[inline(always)]
    pub(super) fn failed(self) -> Habit {
        let failed = self.failed.saturating_add(1);
        let pause = match failed {
            0 | 1 => 0,
            2..=5 => 4,
            _ => 16,
        };
        Habit { failed, pause, ..self }
    }

    /// After marching of this many steps.
    #[inline(always)]
    pub(super) fn marched(self, steps: u32) -> Habit {
        let against = if (steps >= Self::MANY_STEPS) & !self.is_new { self.against.saturating_add(1) } else { 0 };
        let marches = self.marches & (against < Self::ENOUGH);
        let against = if marches { against } else { 0 };
        Habit { marches, is_new: false, against, pause: self.pause.saturating_sub(1), ..self }
    }
}
