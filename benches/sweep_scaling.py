#!/usr/bin/env python3
"""How a sweep would scale: the share-out of swiftprox-sweep played with the measured times of shares.

usage: sweep_scaling.py TIMES ITEMS SHARE [HANDLING]

TIMES is what `swiftprox-sweep --times` wrote on one rank: seconds of each share of SHARE items. ITEMS are swept. Each share takes
one of these times, drawn at random. Rank 0 hands out shares one after another, which takes HANDLING seconds each (20e-6), and works
between two of them, too, as in tools/sweep_shares.c. Prints a table: ranks, hours, how much of all ranks' time is work, and the same
with shares as large as keep rank 0 free: 16 of them a rank.
"""
import heapq
import random
import sys

RANKS = (1, 2, 10, 100, 1000, 10000)
MOST_SHARES = 100_000  # that are played; more are scaled from so many
SHARES_OF_A_RANK = 16
LATENCY = 20e-6  # seconds from a question to its answer, beside the handling


def play(ranks, shares, times, scale, handling, chance):
    """Seconds until the last share is done. Ranks ask when they are free; rank 0 answers in the order in which they asked."""
    free = [(0.0, rank) for rank in range(ranks)]
    heapq.heapify(free)
    desk, last = 0.0, 0.0
    for _ in range(shares):
        asked, rank = heapq.heappop(free)
        # Rank 0 itself takes its next share without a message.
        begun = asked if rank == 0 else max(asked, desk) + handling
        if rank != 0:
            desk = begun
        done = begun + scale * chance.choice(times) + (0 if rank == 0 else LATENCY)
        last = max(last, done)
        heapq.heappush(free, (done, rank))
    return last


def line(ranks, items, share, times, measured_share, handling):
    """Hours and the share of work."""
    shares = max(1, items // share)
    played = min(shares, MOST_SHARES)
    scale = share / measured_share
    seconds = play(ranks, played, times, scale, handling, random.Random(1)) * shares / played
    work = shares * scale * sum(times) / len(times)
    return seconds / 3600, work / (ranks * seconds)


def main():
    if len(sys.argv) not in (4, 5):
        sys.exit(__doc__)
    with open(sys.argv[1]) as file:
        times = [float(word) for word in file.read().split()]
    items, share = int(float(sys.argv[2])), int(sys.argv[3])
    handling = float(sys.argv[4]) if len(sys.argv) == 5 else 20e-6
    print(f"| ranks | hours, {share:,} a share | work | hours, {SHARES_OF_A_RANK} shares a rank | work |")
    print("|--:|--:|--:|--:|--:|")
    for ranks in RANKS:
        larger = max(share, items // (ranks * SHARES_OF_A_RANK))
        hours, work = line(ranks, items, share, times, share, handling)
        hours2, work2 = line(ranks, items, larger, times, share, handling)
        print(f"| {ranks:,} | {hours:.3g} | {100 * work:.0f} % | {hours2:.3g} | {100 * work2:.0f} % |")


if __name__ == "__main__":
    main()
