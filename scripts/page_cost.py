#!/usr/bin/env python3
"""Opens a page of swiftprox-replay --html in headless Chromium, without a graphics card, and says what that took:

  page_cost.py PAGE.html [TIMES]

Seconds until it was loaded and until it was drawn, by the clock, and of processor time in Chromium's processes: the renderer reads
and runs the page, the GPU process draws by SwiftShader what a graphics card would draw."""
import os
import sys
import time

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
sys.path.insert(0, os.path.join(ROOT, "tools"))
import browser  # noqa: E402

TICKS = os.sysconf("SC_CLK_TCK")
USER, SYSTEM = 11, 12  # in /proc/PID/stat, counted from the state


def processes():
    """Parent, seconds of processor time and kind of each process."""
    found = {}
    for name in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{name}/stat") as stat, open(f"/proc/{name}/cmdline") as command:
                numbers = stat.read().rpartition(")")[2].split()
                words = command.read().replace("\0", " ").split()
        except OSError:
            continue  # it has ended
        kind = next((word.partition("=")[2] for word in words if word.startswith("--type=")), "browser")
        found[int(name)] = (int(numbers[1]), (int(numbers[USER]) + int(numbers[SYSTEM])) / TICKS, kind)
    return found


def spent(root):
    """Seconds of processor time of a process and all below it, by kind."""
    found, seconds = processes(), {}
    for process, (parent, time_spent, kind) in found.items():
        while process != root and parent in found:
            process, parent = parent, found[parent][0]
        if process == root:
            seconds[kind] = seconds.get(kind, 0) + time_spent
    return seconds


def measure(page):
    with browser.Browser() as tab:
        tab.frame()
        before, start = spent(tab.process.pid), time.monotonic()
        tab.open("file://" + os.path.abspath(page))
        loaded = time.monotonic() - start
        tab.frame()
        drawn = time.monotonic() - start
        after = spent(tab.process.pid)
        parts = ", ".join(f"{kind} {after[kind] - before.get(kind, 0):.2f}" for kind in ("browser", "renderer", "gpu-process"))
        print(f"loaded in {loaded:.2f} s, drawn in {drawn:.2f} s; processor time: {parts}", flush=True)


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    for _ in range(int(sys.argv[2]) if len(sys.argv) == 3 else 1):
        measure(sys.argv[1])


if __name__ == "__main__":
    main()
