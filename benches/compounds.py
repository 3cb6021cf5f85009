#!/usr/bin/env python3
"""Draws the charts of compounds, docs/charts/compounds.svg and compounds-ratios.svg, and fills the tables of docs/compounds.md, from
what compare --compounds wrote.

usage: compounds.py RESULTS.csv
       compounds.py --check RESULTS.csv      nothing is written, and it fails where page or charts do not say what the file says
"""
import os

import charts
import claims
from charts import Axis, Cell, Cells, Curve, Line, Panel, Panels, Row, Style
from rows import geometric_mean, in_order, machine, read, with_numbers

PAGE = os.path.join(charts.FOLDER, "..", "compounds.md")
MOTIONS = {"random": "random", "near": "near", "orbit": "1°", "slow": "0.1°", "far": "far", "linked": "linked"}
METHODS = {
    "swiftprox": Style("swiftprox", charts.BLUE),
    "parry": Style("parry3d, Compound", charts.RED, marker="s"),
    "coal-pieces": Style("coal, pieces in managers", charts.GREEN, charts.DASHED, "^"),
    "coal-bvh": Style("coal, BVH of the surface", charts.INDIGO, charts.DOTTED, "D"),
    "fcl": Style("FCL, pieces in managers", charts.PINK, charts.DASHED, "v"),
    "bullet": Style("Bullet, btCompoundShape", charts.ORANGE, charts.DOTTED, "o"),
}
PEERS = {"parry": "parry", "coal-pieces": "coal pieces", "coal-bvh": "coal BVH", "fcl": "FCL", "bullet": "Bullet"}
# Up to how many times as long a peer takes as we do.
RATIOS = ((1, charts.BAD[1]), (2, charts.BAD[0]), (10, charts.GOOD), (float("inf"), charts.NAVY))


def is_of_two(row):
    """Verdicts and distances of two equal bodies."""
    return row["motion"] in MOTIONS and row["bodies"].split("-")[0] in ("gear", "torus")


def times_of(rows):
    return {(r["asked"], r["bodies"], r["motion"], r["method"]): r["best_ns"] for r in rows}


def over_pieces(head, rows):
    """Tori by their pieces: a row a question, a panel a motion."""
    tori = [r for r in rows if is_of_two(r) and r["bodies"].startswith("torus")]
    counts = sorted({r["pieces"] for r in tori})
    x = Axis("pieces of each of two tori", counts[0] / 1.5, counts[-1] * 1.5, [(n, f"{n:.0f}") for n in counts])

    def row(asked, height):
        here = [r for r in tori if r["asked"] == asked]

        def curve(motion, method):
            return Curve(method, sorted((r["pieces"], r["best_ns"]) for r in here if (r["motion"], r["method"]) == (motion, method)))

        methods = in_order(r["method"] for r in here)
        panels = [Panel(f"{asked}, {name}", [curve(motion, method) for method in methods]) for motion, name in MOTIONS.items()]
        # Room for a marker at either end.
        times = [r["best_ns"] * factor for r in here for factor in (0.7, 1.4)]
        return Row(panels, charts.value_axis(f"time per {asked}", times, charts.duration), height)

    styles = {method: style for method, style in METHODS.items() if any(r["method"] == method for r in tori)}
    return Panels("Two tori of convex pieces: time per query", machine(head), x, styles, [row("verdict", 150), row("distance", 150)])


def ratio_cell(times, asked, bodies, motion):
    """How many times as long the quickest peer takes, and which that is."""
    own = times.get((asked, bodies, motion, "swiftprox"))
    if own is None:
        return Cell("–", "", charts.REFUSED)
    ratio, peer = min((times[asked, bodies, motion, peer] / own, peer) for peer in PEERS if (asked, bodies, motion, peer) in times)
    colour = next(colour for limit, colour in RATIOS if ratio < limit)
    return Cell(digits(ratio), PEERS[peer], colour)


def digits(value):
    return f"{value:,.0f}" if value >= 100 else f"{value:.1f}" if value >= 10 else f"{value:.2f}"


def ratios(head, rows):
    two = [r for r in rows if is_of_two(r)]
    times = times_of(two)
    lines = []
    for asked in ("verdict", "distance"):
        for k, bodies in enumerate(in_order(r["bodies"] for r in two)):
            pieces = next(r["pieces"] for r in two if r["bodies"] == bodies)
            cells = [ratio_cell(times, asked, bodies, motion) for motion in MOTIONS]
            lines.append(Line(f"{asked}, {bodies.split('-')[0]} of {pieces:.0f}", cells, gap_before=k == 0 and asked == "distance"))
    legend = [(colour, f"below {limit}" if limit < float("inf") else "more") for limit, colour in RATIOS]
    return Cells("Two bodies of convex pieces: time of the quickest other library over ours", machine(head),
                 "beside it which that is: parry's Compound, pieces in managers of coal or FCL, coal's BVH of the surface, Bullet's compound",
                 [(name, "") for name in MOTIONS.values()], lines, legend, 140)


def pair_table(rows):
    """Geometric means over the bodies, and how many times as long others take."""
    two = [r for r in rows if is_of_two(r)]
    of = {}
    for r in two:
        of.setdefault((r["asked"], r["motion"], r["method"]), []).append(r["best_ns"])
    mean = {key: geometric_mean(times) for key, times in of.items()}
    # Bullet is asked for no distance.
    peers = {asked: [peer for peer in PEERS if any((asked, motion, peer) in mean for motion in MOTIONS)] for asked in ("verdict", "distance")}
    heads = ["motion"] + [word for asked, here in peers.items() for word in (f"{asked}, ns", *(PEERS[peer] for peer in here))]
    lines = ["| " + " | ".join(heads) + " |", "|---|" + "--:|" * (len(heads) - 1)]
    for motion, name in MOTIONS.items():
        cells = [name]
        for asked, here in peers.items():
            own = mean[asked, motion, "swiftprox"]
            found = [mean.get((asked, motion, peer)) for peer in here]
            cells += [f"{own:,.0f}"] + [digits(time / own) if time else "–" for time in found]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def micro(ns):
    return f"{ns / 1000:,.2f}" if ns < 1e5 else f"{ns / 1000:,.0f}"


def scene_table(rows):
    """Contacts of two, the arm and scenes, in which there are other ways of ours, too: µs, and how many times as long parry takes."""
    motions = {"rest": "at rest", "random": "random states", "edges": "edges in fine steps", "all": "all move"}
    others = {"swiftprox-call": "one call, no cache", "swiftprox-scene": "by the scene", "swiftprox-rows": "pieces as rows"}
    lines = ["| bodies | asked | µs | parry, µs | parry / ours | another way of ours, µs |", "|---|---|--:|--:|--:|---|"]
    times = times_of(rows)
    for asked, bodies, motion in in_order((r["asked"], r["bodies"], r["motion"]) for r in rows if not is_of_two(r)):
        own, parry = (times[asked, bodies, motion, method] for method in ("swiftprox", "parry"))
        other = [f"{words}: {micro(times[asked, bodies, motion, method])}" for method, words in others.items()
                 if (asked, bodies, motion, method) in times]
        lines.append(f"| {bodies.replace('1000', '1,000')}, {motions[motion]} | {asked} | {micro(own)} | {micro(parry)} | {parry / own:.2f} | "
                     f"{'; '.join(other)} |")
    return "\n".join(lines)


def main():
    [path], check = claims.files_and_check(1, __doc__)
    head, rows = read(path)
    with_numbers(rows, ("pieces", "count", "found", "best_ns"))
    made = {"compounds": pair_table(rows), "scenes": scene_table(rows)}
    claims.show(PAGE, made, (os.path.join(charts.FOLDER, "compounds.svg"), over_pieces(head[0], rows)), path, check)
    claims.show(PAGE, made, (os.path.join(charts.FOLDER, "compounds-ratios.svg"), ratios(head[0], rows)), path, check)


if __name__ == "__main__":
    main()
