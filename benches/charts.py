"""Draws every chart of docs/charts by matplotlib, and tells whether a drawn one still shows its data.

A chart is plain data: `Panels` of curves over logarithmic axes, `Cells`, a table with colours, or `Bars`. plot.py, figures.py and
stability/report.py make it of CSV files. The same data gives the same bytes with the same matplotlib (Debian 12 has 3.6.3), but
not with every other, so `check` compares no drawing. Each file holds a digest of its chart's data and of this module, and one
of its own text: the first tells that the data, or the way to draw them, have changed, the second that the file was edited.
Only drawing needs matplotlib.
"""
import dataclasses
import enum
import hashlib
import json
import math
import os
import re
import sys
from dataclasses import dataclass

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "docs", "charts")

# Hues that the colour-blind can tell apart (Okabe and Ito 2008, Wong 2011; the dark ones are of Paul Tol's muted scheme). Lines
# of one chart differ in their markers as well.
BLUE, SKY, GREEN, ORANGE, RED, PINK = "#0072b2", "#56b4e9", "#009e73", "#e69f00", "#d55e00", "#cc79a7"
INDIGO, WINE, OLIVE, FOREST, GREY, INK = "#332288", "#882255", "#999933", "#117733", "#777777", "#222222"
FRAME, GRID = "#999999", "#e4e4e4"
SOLID, DASHED, DOTTED = "-", "--", ":"
GOOD, REFUSED = "#dcebf5", "#d9d9d9"
BAD = ("#fff3cd", "#fbd38d", "#f2a05f", "#d9603f", "#a5192d")  # from little to much; light text stands on the last two, and on navy
NAVY = "#2b7bba"
DARK = (*BAD[3:], NAVY)


# ---- what a chart is ----

@dataclass(frozen=True)
class Style:
    label: str
    colour: str
    dash: str = SOLID
    marker: str = "o"


class Kind(str, enum.Enum):
    JOINED = "a line with markers"
    DOTS = "markers alone"
    LINE = "a line alone"
    RINGS = "hollow markers"


@dataclass
class Curve:
    """Points (x, y) of a series."""
    series: str
    points: list
    kind: Kind = Kind.JOINED

    def __post_init__(self):
        # As many digits as can be seen: the last ones of a mean depend on the C library.
        self.points = [tuple(float(f"{value:.5g}") for value in point) for point in self.points]


@dataclass
class Panel:
    title: str
    curves: list


@dataclass
class Axis:
    """A logarithmic axis: where it begins and ends, and what stands where, (value, label)."""
    label: str
    low: float
    high: float
    ticks: list


@dataclass
class Row:
    panels: list
    y: Axis
    height: float


@dataclass
class Panels:
    title: str
    machine: str
    x: Axis
    styles: dict  # of each series, in the order of the legend
    rows: list
    note: str = ""


@dataclass
class Cell:
    text: str
    small: str
    colour: str


@dataclass
class Line:
    """A line of cells; `last` is what stands behind them."""
    label: str
    cells: list
    last: str = ""
    gap_before: bool = False
    bold: bool = False


@dataclass
class Cells:
    title: str
    machine: str
    subtitle: str
    columns: list  # (first line of the head, second one)
    lines: list
    legend: list  # (colour, label)
    label_width: float
    last_head: str = ""


@dataclass
class Bars:
    """Lengths from 0 on, one below the other, each with its number behind it; the first line is our own."""
    title: str
    machine: str
    lines: list  # (label, value)
    label_width: float


# ---- axes ----

def duration(ns):
    for unit, name in ((1e9, "s"), (1e6, "ms"), (1e3, "µs")):
        if ns >= unit:
            return f"{ns / unit:g} {name}"
    return f"{ns:g} ns"


def count(value):
    return f"{value:g}" if value < 1000 else f"{value / 1000:g}k" if value < 1e6 else f"{value / 1e6:g}M"


def value_axis(label, values, name):
    """From a 1, 2 or 5 of a decade below the values to one above; over more than four decades only decades are named."""
    steps = [digit * 10.0**exponent for exponent in range(-3, 12) for digit in (1, 2, 5)]
    low, high = max(s for s in steps if s <= min(values)), min(s for s in steps if s >= max(values))
    digits = (1, 2, 5) if high / low < 1e4 else (1,)
    ticks = [digit * 10.0**exponent for exponent in range(-3, 12) for digit in digits]
    return Axis(label, low, high, [(tick, name(tick)) for tick in ticks if low <= tick <= high])


def motion_axis(steps):
    """Degrees a query, random poses apart at the right end; and the place of each step."""
    degrees = [float(step) for step in steps if step != "random"] or [1.0]
    place = {step: 3.4 * max(degrees) if step == "random" else float(step) for step in steps}
    ticks = [(at, step if step == "random" else step + "°") for step, at in place.items()]
    return Axis("motion from one query to the next", min(degrees) / 1.35, max(place.values()) * 1.9, ticks), place


def over_motion(series, points):
    """The curves of a series of points by step: those in order joined, that of random poses apart."""
    joined = [point for step, point in points.items() if step != "random"]
    apart = [point for step, point in points.items() if step == "random"]
    return [Curve(series, found, kind) for found, kind in ((joined, Kind.JOINED), (apart, Kind.DOTS)) if found]


# ---- whether a drawn chart is that of the data ----

def digest(chart):
    with open(os.path.abspath(__file__), "rb") as source:
        return hashlib.sha256(json.dumps(dataclasses.asdict(chart)).encode() + source.read()).hexdigest()


def sealed(text):
    return f"{text}<!-- sha256 of all above: {hashlib.sha256(text.encode()).hexdigest()} -->\n"


def source(path):
    """The CSV files of which a drawn chart was made."""
    with open(path) as file:
        found = re.search("<dc:source>(.*)</dc:source>", file.read())
    return found[1].split(", ") if found else []


def check(path, chart):
    """Ends the program where the file is not the drawing of the chart."""
    name = os.path.basename(path)
    if not os.path.exists(path):
        sys.exit(f"{name} is missing: run make charts")
    with open(path) as file:
        text = file.read()
    if f"<dc:identifier>sha256:{digest(chart)}</dc:identifier>" not in text:
        sys.exit(f"{name} does not show what the CSV files say, or was drawn by another benches/charts.py: run make charts")
    if sealed(text.rpartition("<!-- sha256")[0]) != text:
        sys.exit(f"{name} was changed after it was drawn: run make charts")


# ---- drawing ----

WIDTH, LEFT, RIGHT, GAP = 720, 62, 8, 14  # in points, like all lengths
HEAD, PANEL_HEAD, TICKS, LEGEND_LINE = 38, 16, 16, 13
LINE, GROUP_GAP, CELLS_TOP, LAST_WIDTH = 16, 7, 78, 44
GAP_IN_LINE = (math.nan, math.nan)
RC = {
    "font.family": "sans-serif", "font.sans-serif": ["DejaVu Sans"], "font.size": 8, "text.color": INK,
    # Text stays text: a browser finds it and shows it sharp, in a font of its own if need be, and all common ones are narrower.
    "svg.fonttype": "none", "svg.hashsalt": "swiftprox", "path.simplify": False,
    "axes.edgecolor": FRAME, "axes.linewidth": 0.8, "axes.axisbelow": True, "axes.titlesize": 8.5, "axes.titleweight": "bold",
    "xtick.color": INK, "ytick.color": INK, "xtick.labelsize": 7.5, "ytick.labelsize": 7.5,
    "lines.linewidth": 1.3,
    "legend.fontsize": 8, "legend.frameon": False, "legend.handlelength": 2.6, "legend.labelspacing": 0.62,
}


def draw(path, chart, csv_paths):
    """Writes the SVG."""
    try:
        import matplotlib
        from matplotlib.backends.backend_svg import FigureCanvasSVG
        from matplotlib.figure import Figure
    except ImportError:
        sys.exit(f"{sys.executable} has no matplotlib, which draws the charts: install python3-matplotlib and run /usr/bin/python3")
    matplotlib.rcdefaults()  # nothing of the user's own matplotlibrc
    matplotlib.rcParams.update(RC)
    canvas = Canvas(Figure, height(chart))
    FigureCanvasSVG(canvas.figure)
    canvas.text(8, 15, chart.title, weight="bold", size=10)
    canvas.text(8, 27, chart.machine, color=GREY)
    {Panels: draw_panels, Cells: draw_cells, Bars: draw_bars}[type(chart)](canvas, chart)
    os.makedirs(os.path.dirname(path) or ".", exist_ok=True)
    said = {"Date": None, "Title": chart.title, "Identifier": "sha256:" + digest(chart),
            "Source": ", ".join(os.path.basename(csv_path) for csv_path in csv_paths)}
    canvas.figure.savefig(path, format="svg", metadata=said)
    with open(path) as file:
        text = file.read()
    with open(path, "w") as file:
        file.write(sealed(compact(text)))
    print(os.path.relpath(path))


def compact(svg):
    """A third as long: no comments, indents, groups of one text or none, or turns by nothing; lengths to a hundredth of a point;
    styles as classes; short names."""
    for useless in (r"\n *<!--.*?-->", r"(?<=\n) +", r' transform="rotate\(-?0 [^"]*"', r'<g id="\w+"/>\n',
                    r' *\n(?=[Lz]\b|" style)'):
        svg = re.sub(useless, "", svg)

    def shorter(length):
        return f"{float(length[0]):.2f}".rstrip("0").rstrip(".")

    svg = re.sub(r"<(?:path|use|text)\b[^>]*>", lambda tag: re.sub(r"-?\d+\.\d{3,}", shorter, tag[0]), svg)
    names = list(dict.fromkeys(re.findall(r'id="([mp][0-9a-f]{10})"', svg)))
    svg = re.sub(r'(?<=[#"])[mp][0-9a-f]{10}\b', lambda name: f"{name[0][0]}{names.index(name[0])}", svg)
    svg = re.sub(r'<g id="text_\d+">\n(<text\b.*</text>)\n</g>', r"\1", svg)
    styles = list(dict.fromkeys(re.findall(r' style="([^"]*)"', svg)))
    svg = re.sub(r' style="([^"]*)"', lambda style: f' class="s{styles.index(style[1])}"', svg)
    return svg.replace("</style>", "".join(f"\n.s{k}{{{style}}}" for k, style in enumerate(styles)) + "</style>", 1)


class Canvas:
    """A figure measured in points from its top left corner."""

    def __init__(self, figure, height):
        self.height = height
        self.figure = figure(figsize=(WIDTH / 72, height / 72))

    def text(self, x, y, text, **how):
        return self.figure.text(x / WIDTH, 1 - y / self.height, text, **how)

    def axes(self, x, y, width, height):
        return self.figure.add_axes([x / WIDTH, 1 - (y + height) / self.height, width / WIDTH, height / self.height])


def legend_shape(labels):
    """How many columns the longest label leaves room for, and the height of the lines."""
    lines = math.ceil(len(labels) / int((WIDTH - LEFT) // (34 + 5.0 * max(map(len, labels)))))
    return math.ceil(len(labels) / lines), LEGEND_LINE * lines


def height(chart):
    if isinstance(chart, Panels):
        _, legend = legend_shape([style.label for style in chart.styles.values()])
        rows = sum(PANEL_HEAD + row.height + TICKS for row in chart.rows)
        return HEAD + legend + rows + 18 + 12 * len(chart.note.splitlines()) + 4
    if isinstance(chart, Bars):
        return HEAD + LINE * len(chart.lines) + 6
    return CELLS_TOP + sum(LINE + GROUP_GAP * line.gap_before for line in chart.lines) + 28


def draw_bars(canvas, chart):
    from matplotlib.patches import Rectangle
    width = WIDTH - chart.label_width - LAST_WIDTH - RIGHT
    most = max(value for _, value in chart.lines)
    for k, (label, value) in enumerate(chart.lines):
        y, length = HEAD + LINE * k, width * value / most
        weight = "bold" if k == 0 else "normal"
        canvas.text(chart.label_width - 6, y + 11, label, ha="right", weight=weight)
        canvas.text(chart.label_width + length + 4, y + 11, f"{value:,}", weight=weight)
        corner = (chart.label_width / WIDTH, 1 - (y + LINE - 2) / canvas.height)
        canvas.figure.add_artist(Rectangle(corner, length / WIDTH, (LINE - 4) / canvas.height, facecolor=BLUE if k == 0 else RED,
                                           linewidth=0, transform=canvas.figure.transFigure))


def draw_panels(canvas, chart):
    from matplotlib.lines import Line2D
    columns, y = legend_shape([style.label for style in chart.styles.values()])
    curves = [curve for row in chart.rows for panel in row.panels for curve in panel.curves]
    # In the legend a series looks like most of it: the first of the kinds that it has.
    kinds = {name: next(kind for kind in Kind if any((curve.series, curve.kind) == (name, kind) for curve in curves))
             for name in chart.styles}
    handles = [Line2D([], [], label=style.label, **looks(style, kinds[name])) for name, style in chart.styles.items()]
    canvas.figure.legend(handles=handles, ncol=columns, loc="upper left", bbox_to_anchor=(LEFT / WIDTH, 1 - HEAD / canvas.height),
                         borderaxespad=0, borderpad=0)
    y += HEAD
    for row in chart.rows:
        y += PANEL_HEAD
        width = (WIDTH - LEFT - RIGHT - GAP * (len(row.panels) - 1)) / len(row.panels)
        for k, panel in enumerate(row.panels):
            axes = canvas.axes(LEFT + k * (width + GAP), y, width, row.height)
            draw_panel(axes, panel, chart, row, is_first=k == 0)
        canvas.text(14, y + row.height / 2, row.y.label, rotation=90, ha="center", va="center")
        y += row.height + TICKS
    canvas.text((LEFT + WIDTH - RIGHT) / 2, y + 11, chart.x.label, ha="center")
    for k, line in enumerate(chart.note.splitlines()):
        canvas.text(8, y + 26 + 12 * k, line, color=GREY)


def draw_panel(axes, panel, chart, row, is_first):
    axes.set_title(panel.title, pad=4)
    axes.set(xscale="log", yscale="log", xlim=(chart.x.low, chart.x.high), ylim=(row.y.low, row.y.high))
    for axis, ticks in ((axes.xaxis, chart.x), (axes.yaxis, row.y)):
        axis.set_ticks([value for value, _ in ticks.ticks], labels=[label for _, label in ticks.ticks])
        axis.set_ticks([], minor=True)
    axes.tick_params(length=0, pad=4, labelleft=is_first)
    # One line with gaps: a grid of the axes' own would be a group of elements for each of its lines.
    across = [point for value, _ in row.y.ticks for point in ((chart.x.low, value), (chart.x.high, value), GAP_IN_LINE)]
    along = [point for value, _ in chart.x.ticks for point in ((value, row.y.low), (value, row.y.high), GAP_IN_LINE)]
    axes.plot(*zip(*(across + along)), color=GRID, linewidth=0.8, zorder=1)
    for curve in panel.curves:
        axes.plot(*zip(*curve.points), clip_on=False, **looks(chart.styles[curve.series], curve.kind))


def looks(style, kind):
    line = style.dash if kind in (Kind.JOINED, Kind.LINE) else "none"
    marker = "none" if kind == Kind.LINE else style.marker
    size = 5.6 if kind == Kind.RINGS or marker in ("P", "X") else 4.4
    hollow = {"markerfacecolor": "white", "markeredgewidth": 1.1} if kind == Kind.RINGS else {"markeredgewidth": 0}
    return {"color": style.colour, "linestyle": line, "marker": marker, "markersize": size, **hollow}


def draw_cells(canvas, chart):
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path
    from matplotlib.transforms import Affine2D
    left, right = chart.label_width, WIDTH - RIGHT - (LAST_WIDTH if chart.last_head else 0)
    width = (right - left) / len(chart.columns)
    boxes = {}  # of each colour
    has_second = any(second for _, second in chart.columns)
    canvas.text(8, 42, chart.subtitle)
    for k, (first, second) in enumerate(chart.columns):
        canvas.text(left + (k + 0.5) * width, CELLS_TOP - (15 if has_second else 5), first, ha="center", weight="bold")
        canvas.text(left + (k + 0.5) * width, CELLS_TOP - 5, second, ha="center")
    canvas.text(WIDTH - RIGHT, CELLS_TOP - 5, chart.last_head, ha="right")
    y = CELLS_TOP
    for line in chart.lines:
        y += GROUP_GAP * line.gap_before
        weight = "bold" if line.bold else "normal"
        canvas.text(left - 6, y + 11, line.label, ha="right", weight=weight)
        canvas.text(WIDTH - RIGHT, y + 11, line.last, ha="right", weight=weight)
        for k, cell in enumerate(line.cells):
            x = left + k * width
            boxes.setdefault(cell.colour, []).append((x, y, width - 1.5, LINE - 1.5))
            middle, ink = x + width / 2 - 0.75, "white" if cell.colour in DARK else INK
            canvas.text(middle - (4 if cell.small else 0), y + 10.5, cell.text, ha="right" if cell.small else "center", color=ink)
            if cell.small:
                canvas.text(middle, y + 10.5, cell.small, ha="left", size=6.5, color=ink)
        y += LINE
    x = left
    for colour, label in chart.legend:
        boxes.setdefault(colour, []).append((x, y + 10, 18, 10))
        canvas.text(x + 22, y + 18, label)
        x += 34 + 4.6 * len(label)
    for colour, rectangles in boxes.items():
        # One path a colour: a patch for each cell would take half the file.
        corners = [(x + dx * w, canvas.height - y - dy * h) for x, y, w, h in rectangles
                   for dx, dy in ((0, 0), (1, 0), (1, 1), (0, 1), (0, 0))]
        codes = [Path.MOVETO, Path.LINETO, Path.LINETO, Path.LINETO, Path.CLOSEPOLY] * len(rectangles)
        in_points = Affine2D().scale(1 / 72) + canvas.figure.dpi_scale_trans
        canvas.figure.add_artist(PathPatch(Path(corners, codes), facecolor=colour, linewidth=0, transform=in_points))
