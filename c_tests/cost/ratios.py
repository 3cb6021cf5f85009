#!/usr/bin/env python3
"""Counts the instructions of scenes beside those of the pairs in them:  ratios.py VALGRIND PROGRAM

PROGRAM is ratios.c. What instructions.py says of counts holds here, too.
"""
import sys

from instructions import count, has_avx2

# Case, what it is held against, and how many times as much it may cost.
RATIOS = (
    ("scene", "pair", 2.4),
    ("scene, tolerance", "scene", 1.1),
    ("all pairs, kept", "all pairs", 0.9),
    # Levels do not answer for these bodies: nothing may be lost by asking. tests/scene/scenes.rs has large ones.
    ("approximate", "exact", 1.1),
    ("approximate, at rest", "exact, at rest", 1.1),
    ("budget", "exact", 1.1),
    ("budget, at rest", "exact, at rest", 1.1),
)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    if not has_avx2():
        print("no AVX2: nothing is counted")
        return
    found = count(*sys.argv[1:])
    are_too_dear = False
    for case, other, most in RATIOS:
        ratio = found[case] / found[other]
        are_too_dear |= ratio > most
        print(f"{case}: {ratio:.2f} times {other}, at most {most}")
    sys.exit(are_too_dear)


if __name__ == "__main__":
    main()
