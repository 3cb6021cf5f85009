"""What Ehmann & Lin (2000) conclude from their figures, beside what the figures say when measured anew (benches/figures.py)."""
import math
import re
import sys

import charts
from rows import geometric_mean, in_order

LOW_COHERENCE = ("20", "45", "90", "random")
HOLDS, HOLDS_NOT, PARTLY = "holds", "**does not hold**", "**holds in part**"


def mean(rows, **wanted):
    """The geometric mean of the times of the rows with these values; a tuple means any of them."""
    def fits(row, key, value):
        return row[key] in value if isinstance(value, tuple) else row[key] == value

    times = [row["best_ns"] for row in rows if all(fits(row, key, value) for key, value in wanted.items())]
    if not times:
        raise SystemExit(f"no rows with {wanted}")
    return geometric_mean(times)


def by_series(rows, **wanted):
    """The mean of each series, in order of its first appearance."""
    here = [row for row in rows if all(row[key] == value for key, value in wanted.items())]
    return {name: mean(here, series=name) for name in in_order(row["series"] for row in here)}


def verdict(is_true):
    return HOLDS if is_true else HOLDS_NOT


def ns(time):
    return f"{time:.0f}" if time < 10000 else f"{time / 1000:.1f}k"


def listed(means):
    return ", ".join(f"{name} {ns(time)}" for name, time in means.items())


def cells(rows, figure):
    """{(query, n, orbit, model, step): {series: row}} of the rows without an error asked for, or with the only one."""
    found = {}
    for r in rows:
        if r["figure"] == figure:
            found.setdefault((r["query"], r["n"], r["orbit"], r["model"], r["step"]), {})[r["series"]] = r
    return found


def share(here, is_true):
    count = sum(1 for cell in here if is_true(cell))
    return f"{count} of {len(here)} cells"


def times(cell):
    return {name: row["best_ns"] for name, row in cell.items()}


def choice_cells(rows):
    """{(query, orbit, model, step): (automatic / best fixed, name of the best, its time)}"""
    found = {}
    for (query, _, orbit, model, step), cell in cells(rows, "choice").items():
        own = times(cell)
        automatic = own.pop("automatic")
        name = min(own, key=own.get)
        found[query, orbit, model, step] = automatic / own[name], name, own[name]
    return found


# ---- the claims: each a name, what the paper says, a verdict, what is measured ----

def marching_rule(rows):
    rows = [r for r in rows if r["figure"] == "5"]
    steps = ("0.1", "1", "10", "45", "random")
    ratio = {s: mean(rows, step=s, series="first violated") / mean(rows, step=s, series="most violated") for s in steps}
    worst = max(ratio.values())
    text = ", ".join(f"{value:.2f} at {s if s == 'random' else s + '°'}" for s, value in ratio.items())
    return ("Fig. 5", "marching to the most violated plane is faster than V-Clip, by less than two times",
            verdict(min(ratio.values()) > 0.97 and 1.05 < worst < 2), f"first / most violated: {text}")


def tables_on_fat(rows):
    means = by_series(rows, figure="6", model="fat")
    own = {name: time for name, time in means.items() if name != "shells"}
    factors = [max(t for n, t in own.items() if n.endswith(d)) / min(t for n, t in own.items() if n.endswith(d)) for d in ("5.625", "11.25")]
    resolution = mean([r for r in rows if r["figure"] == "6" and r["model"] == "fat"], series="2 11.25") / own["2 5.625"]
    return ("Fig. 6, claim 1", "for tables on fat bodies the resolution matters, the radius factor does not",
            HOLDS if max(factors) < min(1.05, resolution) else PARTLY if max(factors) < resolution else HOLDS_NOT,
            f"between factors {100 * (max(factors) - 1):.0f} %, between 5.625° and 11.25° {100 * (resolution - 1):.0f} %")


def tables_by_model(rows):
    means = {m: mean(rows, figure="6", model=m, series="2 5.625") for m in ("fat", "plate", "long")}
    ours = {m: mean(rows, figure="6", model=m, series="shells") for m in means}
    return ("Fig. 6, claim 2", "tables are much better on fat bodies than on plates and long ones",
            verdict(min(means["plate"], means["long"]) > 1.3 * means["fat"]),
            f"LUT 2 5.625: {listed(means)} ns; from shells (ours): {listed(ours)} ns")


def tables_factor(rows):
    best = {}
    for model in ("plate", "long"):
        means = {f: mean(rows, figure="6", model=model, series=f"{f} 5.625") for f in (1, 2, 4)}
        best[model] = means
    is_best = all(means[2] <= 1.02 * min(means.values()) for means in best.values())
    text = "; ".join(f"{m}: " + ", ".join(f"factor {f} {ns(t)}" for f, t in means.items()) for m, means in best.items())
    return ("Fig. 6, claim 3", "on plates and long bodies the factor 2 is best", verdict(is_best), f"{text} ns")


def removal_intersection(rows):
    means = by_series(rows, figure="7")
    by_cut_off = {c: geometric_mean([t for n, t in means.items() if n.startswith(f"{c} ")]) for c in (20, 100, 250)}
    spread = max(means.values()) / min(means.values())
    coarse = by_cut_off[20] == min(by_cut_off.values())
    return ("Fig. 7", "Dobkin-Kirkpatrick, intersection: little difference among settings; the coarser the coarsest level the better",
            HOLDS if spread < 1.5 and coarse else PARTLY if spread < 1.5 or coarse else HOLDS_NOT,
            f"slowest / fastest setting {spread:.2f}; by cut-off {listed(by_cut_off)} ns")


def removal_distance(rows):
    means = by_series(rows, figure="8")
    policies = {p: geometric_mean([t for n, t in means.items() if n.endswith(f" {p}")]) for p in ("Single", "Single-Single", "Double-Double")}
    return ("Fig. 8", "Dobkin-Kirkpatrick, exact distance: Double-Double is best", verdict(min(policies, key=policies.get) == "Double-Double"),
            f"{listed(policies)} ns")


def rate_means(rows, figure):
    means = by_series(rows, figure=figure)
    found = {}
    for name, time in means.items():
        if name.startswith("quadric"):
            found[float(name.split()[1])] = found.get(float(name.split()[1]), []) + [time]
    return {rate: geometric_mean(values) for rate, values in found.items()}


def quadric_intersection(rows):
    means = rate_means(rows, "9")
    slower = means[0.125] > 1.05 * max(means[0.25], means[0.0625])
    coarse = means[0.03125] <= 1.02 * min(means.values())
    return ("Fig. 9", "quadric levels, intersection: 0.125 is slower; the coarsest hierarchy is best",
            HOLDS if slower and coarse else PARTLY if slower or coarse else HOLDS_NOT, f"{listed(means)} ns")


def quadric_distance(rows):
    means = rate_means(rows, "10")
    two = [means[r] for r in (0.125, 0.0625, 0.03125)]
    return ("Fig. 10", "quadric levels, exact distance: two levels beat more; coarser is better",
            HOLDS if max(two) < means[0.25] < means[0.5] and means[0.03125] == min(two) else PARTLY if max(two) < means[0.25] < means[0.5] else HOLDS_NOT,
            f"{listed(means)} ns")


def against_nothing(rows, figure, name):
    here = [r for r in rows if r["figure"] == figure]
    return {word: mean(here, series="nothing", step=steps) / mean(here, series=name, step=steps)
            for word, steps in (("0.1°", "0.1"), ("1°", "1"), ("10°", "10"), ("random", "random"))}


def gains(rows, figure, name):
    return ", ".join(f"{gain:.2f} at {step}" for step, gain in against_nothing(rows, figure, name).items())


def best_intersection(rows):
    gain = against_nothing(rows, "11", "quadric 0.03125")
    return ("Fig. 11", "hierarchies do well for intersection", verdict(gain["10°"] > 1.2 and gain["random"] > 1.2),
            f"speed-up over nothing, quadric 0.03125: {gains(rows, '11', 'quadric 0.03125')}")


def best_distance(rows):
    here = {f: mean(rows, figure=f, series="nothing") / mean(rows, figure=f, series="quadric 0.03125") for f in ("11", "12")}
    return ("Fig. 12", "for exact distance hierarchies do less well than for intersection", verdict(here["12"] < here["11"]),
            f"speed-up over nothing, quadric 0.03125: {gains(rows, '12', 'quadric 0.03125')}; over all motions {here['12']:.2f}, for "
            f"intersection {here['11']:.2f}")


def quadric_beats_removal(rows):
    here = [times(cell) for figure in ("11", "12") for cell in cells(rows, figure).values()]
    faster = [cell for cell in here if cell["quadric 0.03125"] < cell["DK 100 Double-Double"]]
    return ("Conclusion 1", "quadric levels always outperform Dobkin-Kirkpatrick's", HOLDS if len(faster) == len(here) else PARTLY,
            f"in {len(faster)} of {len(here)} cells of figures 11 and 12; overall "
            + ", ".join(f"{mean(rows, figure=f, series='DK 100 Double-Double') / mean(rows, figure=f, series='quadric 0.03125'):.2f} times "
                        f"faster for {q}" for f, q in (("11", "intersection"), ("12", "exact distance"))))


def speed_ups(rows):
    parts, good = [], True
    for figure, query in (("11", "intersection"), ("12", "exact distance")):
        here = [r for r in rows if r["figure"] == figure]
        nothing = mean(here, series="nothing", step=LOW_COHERENCE)
        found = {n: nothing / mean(here, series=n, step=LOW_COHERENCE) for n in ("LUT 2 5.625", "quadric 0.03125", "DK 100 Double-Double", "automatic")}
        good &= max(v for n, v in found.items() if n != "automatic") > 1.2
        parts.append(f"{query}: " + ", ".join(f"{n} {v:.2f}" for n, v in found.items()))
    return ("Conclusion 2", "speed-ups over simple marching, chiefly at low coherence", verdict(good),
            "speed-up over nothing, 20° to random: " + "; ".join(parts))


def flatness(rows):
    here = [r for r in rows if r["figure"] == "12"]
    slope = {n: mean(here, series=n, step="random") / mean(here, series=n, step="0.1") for n in in_order(r["series"] for r in here)}
    return ("Conclusion 3", "levels limit the impact of motion, and so does a simple table",
            verdict(slope["quadric 0.03125"] < 0.3 * slope["nothing"] and slope["LUT 2 5.625"] < 0.3 * slope["nothing"]),
            "exact distance, random over 0.1°: " + ", ".join(f"{n} {v:.1f}" for n, v in slope.items()))


def between(rows):
    """{series: {(orbit, model, step): {error: time, "intersection": …, "distance": …}}}"""
    found = {}
    for r in rows:
        if r["figure"] == "error":
            key = r["error"] if r["query"] == "approximate" else r["query"]
            found.setdefault(r["series"], {}).setdefault((r["orbit"], r["model"], r["step"]), {})[key] = r["best_ns"]
    return found


def approximate_between(rows):
    parts, good = [], True
    for series, here in between(rows).items():
        errors = [(cell, t) for cell in here.values() for e, t in cell.items() if isinstance(e, float)]
        inside = [1 for cell, t in errors if 0.9 * min(cell["intersection"], cell["distance"]) <= t <= 1.1 * max(cell["intersection"], cell["distance"])]
        good &= len(inside) >= 0.9 * len(errors)
        parts.append(f"{series} {100 * len(inside) / len(errors):.0f} %")
    return ("Conclusion 4", "approximate distance costs between intersection and exact distance",
            verdict(good) if good else PARTLY, "answers between the two (to 10 %): " + ", ".join(parts))


def larger(rows):
    here = [r for r in rows if r["figure"] == "size"]
    parts, wins = [], []
    for n in in_order(r["n"] for r in here):
        for query in ("intersection", "distance"):
            means = by_series(here, n=n, query=query)
            more = min(means["3 levels"], means["4 levels"])
            wins.append((n, query, more < means["2 levels"] and more < means["LUT 2 5.625"]))
            if query == "distance":
                shown = {series: means[series] for series in ("nothing", "LUT 2 5.625", "2 levels", "3 levels", "4 levels")}
                parts.append(f"{2 * n - 4:,} triangles: " + listed(shown))
    big = [won for n, _, won in wins if n > 1002]
    return ("Conclusion 5", "with 10,000 to 100,000 triangles three or four levels may beat tables and two levels",
            HOLDS if all(big) else PARTLY if any(big) else HOLDS_NOT, "exact distance, " + ";<br>".join(parts) + " ns")


CLAIMS = (marching_rule, tables_on_fat, tables_by_model, tables_factor, removal_intersection, removal_distance, quadric_intersection,
          quadric_distance, best_intersection, best_distance, quadric_beats_removal, speed_ups, flatness, approximate_between, larger)


# ---- the tables of docs/research/figures.md ----

def table(head, lines, rest="--:"):
    """Markdown; the columns but the first are of numbers, unless `rest` says otherwise."""
    rule = ["---"] + [rest] * (len(head) - 1)
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in [head, rule] + lines)


def claims_table(rows):
    return table(["", "the paper", "here", "measured"],
                 [claim(rows) for claim in CLAIMS], rest="---")


PARTS = {"swiftprox-mesh": "body", "table": "table", "quadric": "quadric", "outer cuts": "outer cuts", "Dobkin-Kirkpatrick": "Dobkin-Kirkpatrick"}


def build_table(builds):
    """Milliseconds and bytes of each part of a shape by size, means over the models; and the exponents of their growth from size to size."""
    sizes = in_order(row["n"] for row in builds)
    found = {(n, part): {key: geometric_mean([row[key] for row in builds if (row["n"], row["method"]) == (n, part)])
                         for key in ("best_ms", "bytes")} for n in sizes for part in PARTS}
    lines = []
    for part, name in PARTS.items():
        line = [name]
        for n, before in zip(sizes, [None] + sizes):
            here = found[n, part]
            line.append(f'{here["best_ms"]:.1f}' if here["best_ms"] < 100 else f'{here["best_ms"]:.0f}')
            line.append(f'{here["bytes"] / 1e6:.2f}' if here["bytes"] < 1e7 else f'{here["bytes"] / 1e6:.0f}')
            if before:
                growth = math.log(n / before)
                line += [f'{math.log(here[key] / found[before, part][key]) / growth:.2f}' for key in ("best_ms", "bytes")]
        lines.append(line)
    limit = ["*n* log *n*"]
    for n, before in zip(sizes, [None] + sizes):
        limit += ["", ""]
        if before:
            limit += [f"{math.log(n * math.log(n) / (before * math.log(before))) / math.log(n / before):.2f}"] * 2
    head = ["part"]
    for n, before in zip(sizes, [None] + sizes):
        head += [f"{2 * n - 4:,} triangles: ms", "MB"] + (["exponent of ms", "of MB"] if before else [])
    return table(head, lines + [limit])


def tables(rows, builds):
    return {"claims": claims_table(rows), "build": build_table(builds)}


def fill(page, made):
    """The page with its tables made anew."""
    def anew(match):
        return f"<!-- table: {match[1]} -->\n{made[match[1]]}\n<!-- end -->"

    return re.sub(r"<!-- table: (\w+) -->\n.*?<!-- end -->", anew, page, flags=re.DOTALL)


def files_and_check(count, usage):
    """The files that a program of charts is called with, so many, and whether --check stands before them."""
    arguments = sys.argv[1:]
    check = arguments[:1] == ["--check"]
    if len(arguments) != count + check:
        sys.exit(usage)
    return arguments[check:], check


def show(page, made, drawn, csv_path, check):
    """Fills a page's tables and draws a chart, (path, chart). With `check` nothing is written, and the program ends where page or chart
    do not say what the CSV file says."""
    with open(page) as file:
        text = file.read()
    filled = fill(text, made)
    if check:
        if filled != text:
            sys.exit(f"{page} does not say what {csv_path} says: run {sys.argv[0]}")
        charts.check(*drawn)
        return
    with open(page, "w") as file:
        file.write(filled)
    charts.draw(*drawn, [csv_path])
