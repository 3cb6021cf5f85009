
/* ---- panel.js: the picked pair, the list of pairs and the counts, in words and numbers ---- */

function make(tag, attributes, ...children) {
  const element = document.createElement(tag);
  Object.assign(element, attributes);
  element.append(...children);
  return element;
}

const pairName = (recording, bodies) => bodies.map(body => nameOf(recording, body).replace("-", "–")).join(" and ");

const pointText = point => point.map(x => printed(x)).join(" ");

function featureText({ kind, ids }) {
  const numbers = FEATURES[kind] === "edge" ? ids[0] + "–" + ids[1] : ids[0];
  return kind === 0 ? "not said" : FEATURES[kind] + " " + numbers;
}

function levelText(levels) {
  return levels.map(level => level === 255 ? "255 or more" : level).join(" and ") + (levels[0] + levels[1] ? "" : ": the bodies themselves");
}

/* Rows of the picked pair, what and its number: those that count most, and the others. */
function rowsOf(answer) {
  const interval = answer.depth && !Number.isNaN(answer.depth.value) ? answer.depth : answer;
  const first = [["outcome", OUTCOMES[answer.outcome] + ", decided by " + DECISIONS[answer.decidedBy]],
    answer.depth ? ["depth", printed(answer.depth.value)] : ["distance", printed(answer.distance)],
    ["at least", printed(interval.lower, -1)], ["at most", printed(interval.upper, 1)],
    ["width", shortly(interval.upper - interval.lower, 3)],
    ["levels", levelText(answer.levels)]];
  const others = [];
  if (answer.world) {
    others.push(["point on 1", pointText(answer.world[0])], ["point on 2", pointText(answer.world[1])],
      ["normal", pointText(answer.normal)], ["feature of 1", featureText(answer.features[0])],
      ["feature of 2", featureText(answer.features[1])]);
  }
  if (answer.manifold.length > 0) {
    const gaps = answer.manifold.map(({ lower, upper }) => printed(lower, -1) + " to " + printed(upper, 1)).join("\n");
    others.push(["manifold", counted(answer.manifold.length, "point") + ", gaps\n" + gaps]);
  }
  return [first, others];
}

const WORDS = new Set(["outcome", "levels", "feature of 1", "feature of 2"]);

function tableOf(rows) {
  const body = make("tbody", {});
  for (const [what, text] of rows) {
    const cell = make("td", { className: WORDS.has(what) ? "" : "number" });
    text.split("\n").forEach((part, i) => cell.append(...(i ? [make("br", {})] : []), part));
    cell.dataset.what = what;
    body.append(make("tr", {}, make("td", {}, what), cell));
  }
  return make("table", {}, body);
}

function dotOf(colour) {
  const dot = make("i", { className: "dot" });
  dot.style.background = `var(--${colour})`;
  return dot;
}

/* `answer` is null where the pair is not among those of the step. `acts`: what forgets the pair, and what looks at it. */
function showPair(box, recording, state, answer, acts) {
  if (!state.picked) {
    const words = state.body === NO_BODY ? "Pick a pair: click it in the list, or the line between two bodies." :
      `Body ${nameOf(recording, state.body)} is picked: click another, or a pair in the list.`;
    box.replaceChildren(make("p", {}, words));
    return;
  }
  const [one, two] = state.picked.map(body => nameOf(recording, body));
  const heading = make("div", { className: "heading" }, make("h2", {}, "Pair ", dotOf("one"), one + "  ", dotOf("two"), two),
    make("span", {}, make("button", { onclick: acts.look, title: "L" }, "Look at it"), " ",
      make("button", { onclick: acts.forget, title: "Esc" }, "Close")));
  if (!answer) {
    const held = recording.firstPair[state.step + 1] - recording.firstPair[state.step];
    const isWhole = held === recording.steps[STEP_WORDS * state.step + 3];
    box.replaceChildren(heading, make("p", {}, isWhole ? "The query of this step did not list the pair." :
      "The pair is not among those of this step that the page holds."));
    return;
  }
  const [first, others] = rowsOf(answer);
  const wasOpen = box.querySelector("details")?.open ?? false;
  const more = make("details", { open: wasOpen }, make("summary", {}, "Points, normal, features, manifold"), tableOf(others));
  box.replaceChildren(heading, make("output", { id: "line", title: "as swiftprox-replay prints it" }, lineOf(recording, state.step, answer)),
    tableOf(first), ...(others.length ? [more] : []));
}

/* The pairs of the step, nearest first, those of the picked body alone if there is one. */
function listedPairs(recording, state) {
  const pairs = [];
  for (let pair = recording.firstPair[state.step]; pair < recording.firstPair[state.step + 1]; pair++) {
    if (state.body === NO_BODY || recording.pairBodies[2 * pair] === state.body || recording.pairBodies[2 * pair + 1] === state.body) {
      pairs.push(pair);
    }
  }
  return pairs;
}

function showList(recording, state, pairs, onPick) {
  const MOST = 200;
  const rows = pairs.slice(0, MOST).map(pair => {
    const bodies = Array.from(recording.pairBodies.subarray(2 * pair, 2 * pair + 2));
    const isPicked = state.picked && bodies.every((body, i) => body === state.picked[i]);
    const outcome = OUTCOMES[recording.code(pair, 0)];
    const dot = dotOf(colourOfOutcome(recording.code(pair, 0)));
    const row = make("tr", { className: isPicked ? "picked" : "", onclick: () => onPick(bodies) },
      make("td", {}, pairName(recording, bodies)), make("td", {}, shortly(gapOf(recording, pair).value)), make("td", {}, dot, outcome),
      make("td", {}, DECISIONS[recording.code(pair, 1)]));
    row.dataset.pair = bodies.join(" ");
    return row;
  });
  const tbody = document.querySelector("#list tbody");
  tbody.replaceChildren(...rows);
  const row = tbody.querySelector(".picked");
  if (row) {
    const box = document.getElementById("list-box");
    const [top, height] = [row.offsetTop, row.offsetHeight];
    box.scrollTop = Math.min(Math.max(box.scrollTop, top + height - box.clientHeight), top - 2 * height);
  }
  const kept = recording.firstPair[state.step + 1] - recording.firstPair[state.step];
  const listed = recording.steps[STEP_WORDS * state.step + 3];
  const notes = [];
  if (kept < listed) {
    notes.push(`The page holds the ${counted(kept)} deepest and nearest of ${counted(listed, "pair")}.`);
  }
  if (pairs.length > MOST) {
    notes.push(`${counted(MOST)} of ${counted(pairs.length)} are shown; click a body to see all of its own.`);
  }
  document.getElementById("list-title").textContent = state.body === NO_BODY ? "Near pairs" :
    "Near pairs of body " + nameOf(recording, state.body);
  document.getElementById("list-note").textContent = notes.join(" ") || (pairs.length ? "" : "No pair in this step.");
}

function colourOfOutcome(outcome) {
  return outcome === INTERSECTING ? "touching" : outcome === SEPARATED ? "near" : "undecided";
}

/* How many pairs of the step were decided by what, and at which levels: of all that were listed. */
function showTallies(box, recording, step) {
  const words = recording.steps.subarray(STEP_WORDS * step, STEP_WORDS * (step + 1));
  const table = (title, counts, nameOfRow) => {
    const rows = Array.from(counts, (count, i) => [nameOfRow(i), count]).filter(([, count]) => count > 0)
      .map(([name, count]) => make("tr", {}, make("td", {}, name), make("td", {}, counted(count))));
    return make("div", {}, make("h2", {}, title), make("table", {}, make("tbody", {}, ...rows)));
  };
  box.replaceChildren(
    table("Decided by", words.subarray(5, 5 + DECISIONS.length), i => DECISIONS[i]),
    table("Levels of detail", words.subarray(5 + DECISIONS.length), i => i === 0 ? "0: the bodies" : i === LEVELS - 1 ? `${i} or more` : i),
    make("p", {}, `${KINDS[words[0]]} query: ${counted(words[3], "pair")} listed, ${counted(words[4])} intersecting.`));
}
