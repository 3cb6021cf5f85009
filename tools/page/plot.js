
/* ---- plot.js: intervals over time ---- */

const PLOT = { width: 368, left: 58, right: 12, panels: [{ top: 20, height: 112 }, { top: 158, height: 66 }], bottom: 258 };

function svg(tag, attributes, words) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) {
    element.setAttribute(name, value);
  }
  if (words !== undefined) {
    element.textContent = words;
  }
  return element;
}

/* Round numbers that divide a range in up to so many parts. */
function ticksOf(low, high, parts) {
  const least = (high - low) / parts;
  const stride = [1, 2, 2.5, 5, 10].map(part => part * roundLength(least)).find(length => length >= least * (1 - 1e-9));
  const ticks = [];
  for (let i = Math.ceil(low / stride - 1e-9); i * stride <= high + 1e-9 * stride; i++) {
    ticks.push(i * stride);
  }
  return ticks;
}

/* Neighbouring steps as one path: a step without a value parts two. */
function runsOf(series, isShown) {
  const runs = [];
  for (const point of series) {
    const last = runs[runs.length - 1];
    if (!isShown(point)) {
      continue;
    }
    if (last && last[last.length - 1].step === point.step - 1) {
      last.push(point);
    } else {
      runs.push([point]);
    }
  }
  return runs;
}

const pathOf = spots => "M" + spots.map(spot => spot.map(x => x.toFixed(2)).join(" ")).join("L");

function drawAxis(root, panel, words, ticks, yOf, textOf) {
  const { left, width, right } = PLOT;
  for (const tick of ticks) {
    const y = yOf(tick);
    root.append(svg("path", { class: "axis", d: `M${left} ${y}H${width - right}` }),
      svg("text", { x: left - 6, y: y + 4, "text-anchor": "end" }, textOf(tick)));
  }
  root.append(svg("text", { x: left, y: panel.top - 7 }, words));
}

/* A few steps far from all others do not flatten them: what is beyond is drawn at the edge, and words say how far it goes. */
function rangeOf(values) {
  const sorted = Float64Array.from(values).sort();
  const at = part => sorted[Math.round(part * (sorted.length - 1))];
  const ends = (lower, upper) => [Math.min(at(lower), 0), Math.max(at(upper), 0)];
  const [lowest, highest] = ends(0, 1);
  let [low, high] = ends(0.02, 0.98);
  const isCut = high > low && highest - lowest > 4 * (high - low);
  [low, high] = isCut ? [low, high] : [lowest, highest];
  const margin = (high - low || 1) * 0.06;
  return { low: low - (low < 0 ? margin : 0), high: high + margin,
    words: isCut ? `; all: ${shortly(lowest, 3)} to ${shortly(highest, 3)}` : "" };
}

function drawGaps(root, series, xOf) {
  const panel = PLOT.panels[0];
  const values = series.flatMap(({ value, lower, upper }) => [value, lower, upper]).filter(Number.isFinite);
  if (values.length === 0) {
    return;
  }
  const { low, high, words } = rangeOf(values);
  const yOf = value => panel.top + panel.height * (high - Math.min(high, Math.max(low, value))) / (high - low);
  drawAxis(root, panel, "gap, below 0 depth (length)" + words, ticksOf(low, high, 5), yOf, shortly);
  root.append(svg("path", { class: "zero", d: `M${PLOT.left} ${yOf(0)}H${PLOT.width - PLOT.right}` }));
  for (const run of runsOf(series, point => Number.isFinite(point.value))) {
    const ends = end => run.map(point => [xOf(point.step), yOf(Number.isFinite(point[end]) ? point[end] : point.value)]);
    root.append(svg("path", { class: "band", d: pathOf([...ends("upper"), ...ends("lower").reverse()]) + "Z" }),
      run.length > 1 ? svg("path", { class: "curve", d: pathOf(ends("value")) }) :
        svg("circle", { class: "spot", cx: ends("value")[0][0], cy: ends("value")[0][1], r: 2 }));
  }
}

/* By powers of ten. A width of 0, of a verdict without a depth, is not on such an axis. */
function drawWidths(root, series, xOf) {
  const panel = PLOT.panels[1];
  const widths = series.map(({ step, lower, upper }) => ({ step, power: Math.log10(upper - lower) }));
  const powers = widths.map(({ power }) => power).filter(Number.isFinite);
  const words = "width of the interval (length)";
  if (powers.length === 0) {
    drawAxis(root, panel, words + ": 0 or not said", [], null, null);
    return;
  }
  const ends = powers.reduce(([least, most], power) => [Math.min(least, power), Math.max(most, power)], [Infinity, -Infinity]);
  const low = Math.floor(ends[0] - 0.2), high = Math.ceil(ends[1] + 0.2);
  const yOf = power => panel.top + panel.height * (high - power) / (high - low);
  const ticks = ticksOf(low, high, 3).filter(Number.isInteger);
  drawAxis(root, panel, words, ticks, yOf, power => "1e" + String(power).replace("-", "−"));
  for (const run of runsOf(widths, point => Number.isFinite(point.power))) {
    const spots = run.map(point => [xOf(point.step), yOf(point.power)]);
    root.append(run.length > 1 ? svg("path", { class: "curve", d: pathOf(spots) }) :
      svg("circle", { class: "spot", cx: spots[0][0], cy: spots[0][1], r: 2 }));
  }
}

/* Draws the intervals of `series`, each with its step. Returns what moves the line that shows the step. */
function drawPlot(box, title, series, stepCount, onStep) {
  const { width, left, right, bottom, panels } = PLOT;
  const last = Math.max(stepCount - 1, 1);
  const xOf = step => left + (width - left - right) * step / last;
  const root = svg("svg", { viewBox: `0 0 ${width} ${bottom}`, role: "img", "aria-label": title });
  const foot = panels[1].top + panels[1].height;
  for (const panel of panels) {
    root.append(svg("path", { class: "axis", d: `M${left} ${panel.top}V${panel.top + panel.height}H${width - right}` }));
  }
  drawGaps(root, series, xOf);
  drawWidths(root, series, xOf);
  for (const tick of ticksOf(0, last, 6).filter(Number.isInteger)) {
    root.append(svg("text", { x: xOf(tick), y: foot + 14, "text-anchor": "middle" }, tick));
  }
  root.append(svg("text", { x: width - right, y: foot + 29, "text-anchor": "end" }, "step"));
  const now = svg("path", { class: "now" });
  root.append(now);
  const choose = event => {
    const box = root.getBoundingClientRect();
    const x = (event.clientX - box.left) * width / box.width;
    onStep(Math.round(Math.min(1, Math.max(0, (x - left) / (width - left - right))) * (stepCount - 1)));
  };
  root.addEventListener("pointerdown", choose);
  root.addEventListener("pointermove", event => event.buttons && choose(event));
  const heading = document.createElement("h2");
  heading.textContent = title;
  box.replaceChildren(heading, root);
  return step => now.setAttribute("d", `M${xOf(step)} ${panels[0].top}V${foot}`);
}
