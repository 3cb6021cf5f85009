//! How a task is handed over to threads and given back: the states between callers and threads that wait, and every interleaving of
//! their steps tried in a model.

/// The assignment of threads to tasks. Threads change it one at a time, each step as a whole.
///
/// ```text
/// caller: offer ─► takes parts ─► waits until take_back                    (at the end of all: end)
/// thread: next = Join ─► takes parts ─► leave ─► next …       next = Wait ─► waits until posted ─► next …
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Handover<T> {
    /// The task that may be joined.
    task: Option<T>,
    /// A caller has not taken its task back. Until it has, there is no other: only one waits for a wake, and a panic in a thread
    /// is its own.
    is_lent: bool,
    /// Threads that have joined and not left.
    active: usize,
    ended: bool,
}

/// A thread's next step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum NextTask<T> {
    Wait,
    Join(T),
    End,
}

impl<T: Clone> Handover<T> {
    pub const IDLE: Handover<T> = Handover { task: None, is_lent: false, active: 0, ended: false };

    /// The caller lets threads join; false if another has not taken its task back yet. All that wait are to be woken.
    pub fn offer(&mut self, task: T) -> bool {
        let is_free = !self.is_lent;
        if is_free {
            self.task = Some(task);
            self.is_lent = true;
        }
        is_free
    }

    /// The next step of an idle thread.
    pub fn next(&mut self) -> NextTask<T> {
        match &self.task {
            _ if self.ended => NextTask::End,
            Some(task) => {
                self.active += 1;
                NextTask::Join(task.clone())
            }
            None => NextTask::Wait,
        }
    }

    /// A thread has found no more parts: no other need join. True if this was the last, so that the caller is to be woken.
    pub fn leave(&mut self) -> bool {
        self.task = None;
        self.active -= 1;
        self.active == 0
    }

    /// The caller has found no more parts: nobody else need join. False while threads have not left.
    pub fn take_back(&mut self) -> bool {
        debug_assert!(self.is_lent);
        self.task = None;
        self.is_lent = self.active > 0;
        !self.is_lent
    }

    /// There will be no more tasks. All that wait are to be woken.
    pub fn end(&mut self) {
        self.ended = true;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    /// State of a thread of the model.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
    enum At {
        /// About to look for its next step, woken on purpose or by chance.
        Looking,
        /// Waits until it is told.
        Waiting,
        /// Has joined this task, and is about to take a part of it.
        Taking(usize),
        /// Does a part of it.
        Working(usize, usize),
        /// About to leave.
        Leaving,
        Gone,
    }

    /// State of the caller.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
    enum Caller {
        Offering(usize),
        Telling(usize),
        Taking(usize),
        Working(usize, usize),
        /// About to look whether all have left.
        TakingBack(usize),
        /// Waits until it is told so.
        Waiting(usize),
        Ending,
        TellingEnd,
        Joining,
        Finished,
    }

    const TASKS: usize = 2;
    const PARTS: usize = 2;

    #[derive(Debug, Clone, PartialEq, Eq, Hash)]
    struct Interleaving<const THREADS: usize> {
        handover: Handover<usize>,
        caller: Caller,
        threads: [At; THREADS],
        /// The next part of each task, how often each was done, and whether the task still lives.
        next: [usize; TASKS],
        done: [[u8; PARTS]; TASKS],
        lives: [bool; TASKS],
    }

    impl<const THREADS: usize> Interleaving<THREADS> {
        fn tell_all(&mut self) {
            for thread in &mut self.threads {
                if *thread == At::Waiting {
                    *thread = At::Looking;
                }
            }
        }

        /// Takes a part of a task that must still live.
        fn take(&mut self, task: usize) -> Option<usize> {
            assert!(self.lives[task], "a task is used after it is given back: {self:?}");
            self.next[task] += 1;
            Some(self.next[task] - 1).filter(|&part| part < PARTS)
        }

        /// The world after the caller's next step, if it can make one.
        fn after_caller(&self) -> Option<Self> {
            let mut world = self.clone();
            world.caller = match self.caller {
                Caller::Offering(task) => {
                    world.lives[task] = true;
                    assert!(world.handover.offer(task), "the last task was given back: {self:?}");
                    Caller::Telling(task)
                }
                Caller::Telling(task) => {
                    world.tell_all();
                    Caller::Taking(task)
                }
                Caller::Taking(task) => match world.take(task) {
                    Some(part) => Caller::Working(task, part),
                    None => Caller::TakingBack(task),
                },
                Caller::Working(task, part) => {
                    world.done[task][part] += 1;
                    Caller::Taking(task)
                }
                Caller::TakingBack(task) => {
                    if world.handover.take_back() {
                        assert_eq!(self.done[task], [1; PARTS], "a part is left: {self:?}");
                        world.lives[task] = false;
                        if task + 1 < TASKS { Caller::Offering(task + 1) } else { Caller::Ending }
                    } else {
                        Caller::Waiting(task)
                    }
                }
                Caller::Ending => {
                    world.handover.end();
                    Caller::TellingEnd
                }
                Caller::TellingEnd => {
                    world.tell_all();
                    Caller::Joining
                }
                Caller::Joining if self.threads == [At::Gone; THREADS] => Caller::Finished,
                Caller::Waiting(_) | Caller::Joining | Caller::Finished => return None,
            };
            Some(world)
        }

        /// The same of a thread.
        fn after_thread(&self, k: usize) -> Option<Self> {
            let mut world = self.clone();
            world.threads[k] = match self.threads[k] {
                At::Looking => match world.handover.next() {
                    NextTask::Wait => At::Waiting,
                    NextTask::Join(task) => At::Taking(task),
                    NextTask::End => At::Gone,
                },
                At::Taking(task) => match world.take(task) {
                    Some(part) => At::Working(task, part),
                    None => At::Leaving,
                },
                At::Working(task, part) => {
                    assert!(world.lives[task]);
                    world.done[task][part] += 1;
                    At::Taking(task)
                }
                At::Leaving => {
                    if world.handover.leave()
                        && let Caller::Waiting(task) = world.caller
                    {
                        world.caller = Caller::TakingBack(task);
                    }
                    At::Looking
                }
                At::Waiting | At::Gone => return None,
            };
            Some(world)
        }

        /// All worlds that one step leads to; with `chance` a thread or the caller may also wake without being told.
        fn steps(&self, chance: bool) -> Vec<Self> {
            let mut steps: Vec<Self> = (0..THREADS).filter_map(|k| self.after_thread(k)).collect();
            steps.extend(self.after_caller());
            assert!(!steps.is_empty() || self.caller == Caller::Finished, "nobody can go on: {self:?}");
            if chance {
                for k in (0..THREADS).filter(|&k| self.threads[k] == At::Waiting) {
                    let mut world = self.clone();
                    world.threads[k] = At::Looking;
                    steps.push(world);
                }
                if let Caller::Waiting(task) = self.caller {
                    steps.push(Interleaving { caller: Caller::TakingBack(task), ..self.clone() });
                }
            }
            steps
        }
    }

    /// Every world that can be reached: in each somebody can go on or all is finished, tasks are used only while they live, and
    /// each part is done once. Without wakes by chance a lost notice would leave a world in which nobody can go on.
    fn explore<const THREADS: usize>(chance: bool) -> usize {
        let first = Interleaving {
            handover: Handover::IDLE,
            caller: Caller::Offering(0),
            threads: [At::Looking; THREADS],
            next: [0; TASKS],
            done: [[0; PARTS]; TASKS],
            lives: [false; TASKS],
        };
        let (mut seen, mut open, mut ends) = (HashSet::from([first.clone()]), vec![first], 0);
        while let Some(world) = open.pop() {
            ends += usize::from(world.caller == Caller::Finished);
            for next in world.steps(chance) {
                if seen.insert(next.clone()) {
                    open.push(next);
                }
            }
        }
        assert!(ends > 0);
        seen.len()
    }

    /// With several threads, and with spurious wakes, `loom/` tries only those interleavings that have few interruptions: for the
    /// code around this, all are too many. Here a step is as long as the lock is held, and no state is tried twice.
    #[test]
    #[cfg_attr(miri, ignore = "long")]
    fn every_interleaving_ends_with_each_part_done_once() {
        for chance in [false, true] {
            let sizes = [explore::<1>(chance), explore::<2>(chance), explore::<3>(chance)];
            assert!(sizes[0] > 50 && sizes[1] > 10 * sizes[0] / 2 && sizes[2] > 3 * sizes[1], "{sizes:?}");
        }
    }

    /// A second caller could offer when the threads had left the task of the first, who was yet to look. Then the first, too,
    /// waited for the second's threads, and only one of them was told that these had left: the other waited for ever. Either
    /// could get a panic of the other's parts. About one in 100,000 pairs of calls at once met it; `make loom` does, with two
    /// callers.
    #[test]
    fn there_is_no_other_task_before_one_is_taken_back() {
        let mut handover = Handover::IDLE;
        assert!(handover.offer(1) && handover.next() == NextTask::Join(1) && handover.leave());
        assert!(!handover.offer(2) && handover.next() == NextTask::Wait);
        assert!(handover.take_back() && handover.offer(2));
    }
}
