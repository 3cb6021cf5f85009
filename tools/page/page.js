
/* ---- page.js: what is shown now, and what changes it ---- */

const element = id => document.getElementById(id);

function readColours() {
  const style = getComputedStyle(document.documentElement);
  const names = ["paper", "ink", "quiet", "alone", "fixed", "earth", "near", "touching", "undecided", "one", "two", "normal", "manifold", "march"];
  return Object.fromEntries(names.map(name => [name, style.getPropertyValue("--" + name).trim()]));
}

/* Okabe and Ito, "Color Universal Design", 2008: those who are blind to a colour tell them apart, too. Black is left out. */
const BODY_COLOURS = ["#0072b2", "#e69f00", "#009e73", "#56b4e9", "#d55e00", "#f0e442", "#cc79a7"];

/* #rrggbb as 4 parts. */
const partsOf = (colour, alpha = 255) => [1, 3, 5].map(at => parseInt(colour.slice(at, at + 2), 16)).concat(alpha);

const mixed = (parts, others, share) => parts.map((part, k) => k < 3 ? Math.round(part + share * (others[k] - part)) : part);

function startPage(recording) {
  const canvas = element("solids"), overlay = element("overlay");
  const context = overlay.getContext("2d");
  const solids = makeSolids(canvas, recording);
  const camera = makeCamera();
  const state = { step: 0, picked: null, body: NO_BODY, isPlaying: false, begun: 0, hasGround: true };
  let colours = readColours(), spots = [], moveLine = () => {}, isDue = false, near = new Set(), answer = null;

  /* -- drawing -- */

  const paintOf = body => {
    const own = BODY_COLOURS[objectOf(recording, body) % BODY_COLOURS.length];
    const parts = partsOf(isGround(recording, body) ? colours.earth : isFixed(recording, body) ? colours.fixed : own);
    if (!state.picked || !answer) {
      return state.body === NO_BODY || near.has(body) ? parts : mixed(parts, partsOf(colours.paper), 0.75);
    }
    const place = state.picked.indexOf(body);
    const alpha = isFixed(recording, body) ? 40 : 120; /* the ground does not hide what stands on it */
    return place >= 0 ? partsOf(colours[place ? "two" : "one"], alpha) : mixed(partsOf(colours.alone), partsOf(colours.paper), 0.55);
  };

  const draw = () => {
    isDue = false;
    const ratio = overlay.width / camera.width;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, camera.width, camera.height);
    context.font = "12px " + getComputedStyle(document.body).fontFamily;
    if (solids) {
      drawSolids(solids, camera, partsOf(colours.paper), state.hasGround ? partsOf(colours.quiet) : null);
    } else {
      drawOutlines(context, recording, state.step, camera, paintOf);
    }
    const project = projector(camera);
    spots = [];
    if (state.picked && answer) {
      drawPicked(context, recording, answer, 0.6 * pairSize(), project, colours);
      drawNames(project);
    } else {
      spots = drawPairs(context, recording, state.step, project, colours);
    }
    drawAxes(context, camera, colours);
    drawScale(context, camera, colours);
  };

  /* The radius of the smaller body. */
  const pairSize = () => Math.min(...state.picked.filter(body => body !== NO_BODY)
    .map(body => recording.shapes[shapeOf(recording, body)].radius));

  const drawNames = project => state.picked.forEach(body => {
    const move = body === NO_BODY ? -1 : moveOf(recording, body, state.step);
    const spot = move < 0 ? null : project(placeOf(recording, move));
    if (spot) {
      label(context, nameOf(recording, body), [spot[0] + 8, spot[1] - 8], colours);
    }
  });

  const drawSoon = () => {
    if (!isDue) {
      isDue = true;
      requestAnimationFrame(draw);
    }
  };

  /* -- what the step and the pick say -- */

  const refresh = () => {
    const { step, picked } = state;
    const pair = picked ? findPair(recording, step, ...picked) : -1;
    answer = pair < 0 ? null : pairOf(recording, pair);
    const pairs = listedPairs(recording, state);
    near = new Set([state.body, ...pairs.flatMap(at => Array.from(recording.pairBodies.subarray(2 * at, 2 * at + 2)))]);
    if (solids) {
      loadBodies(solids, step, paintOf, answer ? picked : []);
    }
    element("step").value = step;
    element("step-text").value = `step ${step} of 0 to ${recording.stepCount - 1}`;
    showPair(element("pair"), recording, state, answer, { forget: () => pick(null), look: lookAtPair });
    showList(recording, state, pairs, pick);
    showTallies(element("tallies"), recording, step);
    moveLine(step);
    drawSoon();
  };

  /* Of the picked pair, or of the nearest in each step. */
  const refreshPlot = () => {
    const series = [];
    for (let step = 0; step < recording.stepCount; step++) {
      const nearest = recording.firstPair[step] < recording.firstPair[step + 1] ? recording.firstPair[step] : -1;
      const pair = state.picked ? findPair(recording, step, ...state.picked) : nearest;
      if (pair >= 0) {
        series.push({ step, ...gapOf(recording, pair) });
      }
    }
    const title = state.picked ? "Gap of " + pairName(recording, state.picked) : "Nearest or deepest pair of each step";
    moveLine = drawPlot(element("plot"), title, series, recording.stepCount, goByHand);
    moveLine(state.step);
  };

  const goTo = step => {
    state.step = Math.min(recording.stepCount - 1, Math.max(0, step));
    refresh();
  };

  const pick = bodies => {
    state.picked = bodies;
    refreshPlot();
    refresh();
  };

  /* -- play -- */

  const setPlaying = isPlaying => {
    state.isPlaying = isPlaying;
    element("play").textContent = isPlaying ? "Pause" : "Play";
    element("pair").setAttribute("aria-live", isPlaying ? "off" : "polite");
    if (isPlaying) {
      if (state.step === recording.stepCount - 1) {
        goTo(0);
      }
      startClock();
    }
  };

  /* Again and again, with a second's rest at the end. */
  const startClock = () => {
    const [from, start, rate] = [state.step, performance.now(), Number(element("speed").value)];
    const last = recording.stepCount - 1;
    state.begun++;
    const round = state.begun;
    const tick = now => {
      if (!state.isPlaying || round !== state.begun) {
        return;
      }
      const passed = from + Math.floor(Math.max(0, now - start) / 1000 * rate);
      const step = Math.min(last, passed % (last + rate));
      if (step !== state.step) {
        goTo(step);
      }
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  };

  const goByHand = step => {
    setPlaying(false);
    goTo(step);
  };

  /* -- clicks in the scene -- */

  const click = (x, y) => {
    const near = spots.filter(({ spot }) => Math.hypot(spot[0] - x, spot[1] - y) < 8);
    if (near.length > 0 && state.body === NO_BODY) {
      const distance = ({ spot }) => Math.hypot(spot[0] - x, spot[1] - y);
      const { pair } = near.reduce((best, other) => distance(other) < distance(best) ? other : best);
      pick(Array.from(recording.pairBodies.subarray(2 * pair, 2 * pair + 2)));
      return;
    }
    const body = solids ? bodyAt(solids, camera, x, y) : bodyNearest(recording, state.step, camera, x, y);
    clickBody(body);
  };

  const clickBody = body => {
    const both = [state.body, body].sort((a, b) => a - b);
    const isPair = state.body !== NO_BODY && body !== NO_BODY && body !== state.body && !state.picked;
    state.body = isPair || body === state.body ? NO_BODY : body;
    pick(isPair ? both : null);
    drawSoon();
  };

  const fingers = new Map();
  let travelled = 0;
  overlay.addEventListener("pointerdown", event => {
    overlay.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, [event.offsetX, event.offsetY]);
    travelled = fingers.size > 1 ? Infinity : 0;
  });
  overlay.addEventListener("pointermove", event => {
    const before = fingers.get(event.pointerId);
    if (!before) {
      return;
    }
    const now = [event.offsetX, event.offsetY];
    const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
    travelled += Math.hypot(dx, dy);
    if (fingers.size === 2) {
      const other = Array.from(fingers).find(([id]) => id !== event.pointerId)[1];
      const apart = spot => Math.max(10, Math.hypot(spot[0] - other[0], spot[1] - other[1]));
      zoomCamera(camera, apart(before) / apart(now));
      moveCamera(camera, dx / 2, dy / 2);
    } else if (event.shiftKey || event.buttons & 6) {
      moveCamera(camera, dx, dy);
    } else {
      turnCamera(camera, dx, dy);
    }
    fingers.set(event.pointerId, now);
    drawSoon();
  });
  const letGo = event => {
    const isClick = event.type === "pointerup" && fingers.has(event.pointerId) && travelled < 4;
    fingers.delete(event.pointerId);
    if (isClick && event.button === 0) {
      click(event.offsetX, event.offsetY);
    }
  };
  overlay.addEventListener("pointerup", letGo);
  overlay.addEventListener("pointercancel", letGo);
  overlay.addEventListener("contextmenu", event => event.preventDefault());
  overlay.addEventListener("wheel", event => {
    event.preventDefault();
    zoomCamera(camera, Math.exp(event.deltaY * (event.deltaMode ? 0.05 : 0.0015)));
    drawSoon();
  }, { passive: false });

  /* -- keys and controls -- */

  const showAll = () => {
    frameScene(camera, recording);
    drawSoon();
  };

  const lookAtPair = () => {
    const place = answer ? placeOfPair(answer) : null;
    if (place) {
      const apart = answer.drawn ? Math.hypot(...add(answer.drawn[0], answer.drawn[1], -1)) || 0 : 0;
      camera.target = place;
      camera.distance = 5 * Math.max(pairSize(), apart);
      drawSoon();
    }
  };

  const neighbour = offset => {
    const pairs = listedPairs(recording, state);
    const at = pairs.indexOf(state.picked ? findPair(recording, state.step, ...state.picked) : -1);
    const pair = pairs[Math.min(pairs.length - 1, Math.max(0, at + offset))];
    if (pair !== undefined) {
      pick(Array.from(recording.pairBodies.subarray(2 * pair, 2 * pair + 2)));
    }
  };

  const KEYS = {
    " ": () => setPlaying(!state.isPlaying),
    ArrowLeft: stride => goByHand(state.step - stride),
    ArrowRight: stride => goByHand(state.step + stride),
    Home: () => goByHand(0),
    End: () => goByHand(recording.stepCount - 1),
    ArrowUp: () => neighbour(-1),
    ArrowDown: () => neighbour(1),
    f: showAll,
    l: lookAtPair,
    g: () => {
      state.hasGround = !state.hasGround;
      drawSoon();
    },
    Escape: () => {
      state.body = NO_BODY;
      pick(null);
    },
  };
  document.addEventListener("keydown", event => {
    const isTyping = event.target.tagName === "SELECT" || (event.key === " " && event.target.tagName === "BUTTON");
    const act = KEYS[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (act && !isTyping && !event.ctrlKey && !event.metaKey && !event.altKey) {
      event.preventDefault();
      act(event.shiftKey ? 10 : 1);
    }
  });
  element("step").max = recording.stepCount - 1;
  element("step").addEventListener("input", () => goByHand(Number(element("step").value)));
  /* A row or a button that the next step replaces could not be clicked, nor a moving slider be held. */
  for (const id of ["step", "list", "pair"]) {
    element(id).addEventListener("pointerdown", () => setPlaying(false));
  }
  element("play").addEventListener("click", () => setPlaying(!state.isPlaying));
  element("speed").addEventListener("change", () => state.isPlaying && startClock());
  element("frame").addEventListener("click", showAll);
  element("up").addEventListener("change", () => {
    camera.up = Number(element("up").value);
    if (solids) {
      solids.ground.isShadowDue = true;
    }
    showAll();
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    colours = readColours();
    refresh();
  });
  /* Whether the size of the view has changed. */
  const fitView = () => {
    const ratio = Math.min(devicePixelRatio || 1, 2);
    const before = [overlay.width, overlay.height];
    [camera.width, camera.height] = [Math.max(1, overlay.clientWidth), Math.max(1, overlay.clientHeight)];
    const size = [camera.width, camera.height].map(length => Math.round(length * ratio));
    if (size.every((length, k) => length === before[k])) {
      return false;
    }
    for (const surface of [canvas, overlay]) {
      [surface.width, surface.height] = size;
    }
    return true;
  };
  /* A new size empties a canvas: it is drawn at once. */
  new ResizeObserver(() => fitView() && draw()).observe(overlay);

  fitView();
  frameScene(camera, recording);
  describe(recording, Boolean(solids));
  refreshPlot();
  refresh();
  /* The slowest speed that shows all within ten seconds. A large scene waits: its frames are not free. */
  const speeds = Array.from(element("speed").options, option => option.value);
  element("speed").value = speeds.find(speed => 10 * speed >= recording.stepCount) || speeds[speeds.length - 1];
  if (recording.stepCount > 1 && !isLarge(recording) && !matchMedia("(prefers-reduced-motion: reduce)").matches) {
    setPlaying(true);
  }
  return { state, camera, recording, goTo, pick, draw, isSolid: Boolean(solids),
    spotOfBody: body => projector(camera)(placeOf(recording, moveOf(recording, body, state.step))) };
}

/* What does not change. */
function describe(recording, isSolid) {
  const { head } = recording;
  document.title = head.scene + " – swiftprox";
  element("title").textContent = head.scene;
  const bounds = head.maxDistance === undefined ? "" : ", max distance " + head.maxDistance;
  const grounds = Array.from({ length: recording.bodyCount }, (_, body) => isGround(recording, body)).filter(Boolean).length;
  const bodies = counted(recording.bodyCount - grounds, "convex body").replace("bodys", "bodies");
  element("about").textContent = `${counted(recording.stepCount, "step")}, ${bodies}, ` + (grounds ? counted(grounds, "ground") + ", " : "") +
    `${counted(recording.pairCount, "pair")}${bounds}; swiftprox ${head.version}`;
  if (head.cutOff) {
    element("caution").hidden = false;
    element("caution").textContent = "The recording was not ended; this is what there is of it.";
  }
  if (!isSolid) {
    element("notice").hidden = false;
    element("notice").textContent = "This browser gives no WebGL 2, so that bodies are drawn as their edges alone, and of a large scene not all.";
  }
  const entries = [["touching", "intersecting"], ["near", "near"], ["undecided", "undecided"], ["fixed", "fixed"],
    ["earth", "ground"]];
  const used = entries.filter(([name]) => (name !== "undecided" || hasUndecided(recording)) && (name !== "earth" || hasGrounds(recording)));
  element("legend").replaceChildren(...used.map(([name, words]) => {
    const dot = make("i", {});
    dot.style.background = `var(--${name})`;
    return make("li", {}, dot, words);
  }));
  const origin = head.origin.map(x => shortly(x)).join(", ");
  element("precision").textContent = "Numbers of pairs are the doubles of the answers, rounded as swiftprox-replay prints them: " +
    "lower ends down, upper ends up. Bodies are drawn from places in single precision, seen from (" + origin + "), and from turns " +
    `of which each part is rounded to 1/${head.turnScale}. Lengths are in the unit of the shapes' vertices; a step is a query.`;
}

function hasUndecided(recording) {
  for (let pair = 0; pair < recording.pairCount; pair++) {
    if (colourOfOutcome(recording.code(pair, 0)) === "undecided") {
      return true;
    }
  }
  return false;
}

/* For the console, and for tests. */
const page = startPage(readRecording());
