"use strict";
/* The page of a run: the timeline, and tables that readers can sort and filter. */

const data = JSON.parse(document.getElementById("timeline-data").textContent);
const canvas = document.getElementById("timeline-canvas");
const box = canvas.parentElement;
const context = canvas.getContext("2d");
const ROW = 18, TOP = 24, LEAST_BINS = 8, LEAST_EXACT = 200, MARK_REACH = 5, MOST_NAMED = 12;

/* Return the sums of a lane's counts up to each bin. The count of any time interval is then one subtraction. */
function sums(runs) {
  let length = 0;
  for (let at = 1; at < runs.length; at += 2) length += runs[at];
  const found = new Float64Array(length + 1);
  let bin = 0;
  for (let at = 0; at < runs.length; at += 2)
    for (let times = runs[at + 1]; times > 0; times--, bin++) found[bin + 1] = found[bin] + runs[at];
  return found;
}

const lanes = data.lanes.map(lane => ({ ...lane, runs: sums(lane.runs), busy: sums(lane.busy) }));

/* Return the activities of each lane in a time range whose exact times are known, as [begin, end] in ns. */
function exactOf(range) {
  const found = lanes.map(() => []), numbers = range.activities;
  let begin = range.from;
  for (let at = 0; at < numbers.length; at += 3) {
    begin += numbers[at + 1];
    found[numbers[at]].push([begin, begin + numbers[at + 2]]);
  }
  return { from: range.from, to: range.to, lanes: found };
}

const exact = data.exact.map(exactOf);
const end = Math.max(data.end, data.width);
let view = { from: 0, to: end };
let focus = null;  // the instant of the link that the reader clicked last, or of the failure
let labels = 150;

function between(table, from, to) {
  const last = table.length - 1;
  const begin = Math.min(last, Math.max(0, Math.floor(from / data.width)));
  const stop = Math.min(last, Math.max(begin, Math.ceil(to / data.width)));
  return table[stop] - table[begin];
}

function seconds(ns) {
  const span = view.to - view.from;
  const digits = Math.max(0, Math.min(9, Math.ceil(Math.log10(1e10 / span)) + 1));
  return (ns / 1e9).toFixed(digits) + " s";
}

function micro(ns) { return (ns / 1e9).toFixed(9) + " s"; }

function color(name) { return getComputedStyle(document.documentElement).getPropertyValue(name).trim(); }

function setView(from, to) {
  const middle = (from + to) / 2, isExact = exact.some(range => range.from <= middle && middle <= range.to);
  const span = Math.min(end, Math.max(isExact ? LEAST_EXACT : LEAST_BINS * data.width, to - from));
  const start = Math.min(Math.max(0, from + (to - from - span) / 2), end - span);
  view = { from: start, to: start + span };
  draw();
}

function zoom(factor, share = 0.5) {
  const span = view.to - view.from, fixed = view.from + span * share;
  setView(fixed - span * factor * share, fixed + span * factor * (1 - share));
}

function move(share) {
  const span = view.to - view.from, from = Math.min(Math.max(0, view.from + span * share), end - span);
  setView(from, from + span);
}

function draw() {
  const scale = window.devicePixelRatio || 1, width = box.clientWidth, height = TOP + lanes.length * ROW + 6;
  labels = Math.min(180, Math.max(96, width * 0.18));
  canvas.style.height = height + "px";
  canvas.width = Math.round(width * scale);
  canvas.height = Math.round(height * scale);
  context.setTransform(scale, 0, 0, scale, 0, 0);
  context.fillStyle = color("--panel");
  context.fillRect(0, 0, width, height);
  drawAxis(context, width, TOP - 4, height, 11);
  lanes.forEach((lane, row) => drawLane(lane, row, width));
  drawMarks(width, height);
  drawFocus(context, width, height);
  const shown = document.getElementById("timeline-range");
  shown.textContent = seconds(view.from) + " to " + seconds(view.to);
  shown.dataset.from = Math.round(view.from);
  shown.dataset.to = Math.round(view.to);
  drawValues();
}

function place(ns, width) { return labels + (ns - view.from) / (view.to - view.from) * (width - labels); }

function drawFocus(on, width, height) {
  if (focus === null || focus < view.from || focus > view.to) return;
  on.fillStyle = color("--accent");
  on.fillRect(Math.round(place(focus, width)) - 1, 0, 2, height);
}

/* Draw vertical lines at round times between two heights, with the times as text. */
function drawAxis(on, width, top, height, textAt) {
  const span = view.to - view.from, room = width - labels;
  let step = 10 ** Math.ceil(Math.log10(span / Math.max(2, room / 110)));
  if (step / 2 * room / span > 90) step /= 2;
  on.font = "11px system-ui, sans-serif";
  on.textBaseline = "middle";
  for (let at = Math.ceil(view.from / step) * step; at <= view.to; at += step) {
    const x = labels + (at - view.from) / span * room;
    on.fillStyle = color("--line");
    on.fillRect(x, top, 1, height);
    on.fillStyle = color("--soft");
    const text = seconds(at);
    on.fillText(text, Math.min(x + 3, width - on.measureText(text).width - 2), textAt);
  }
}

function drawLane(lane, row, width) {
  const y = TOP + row * ROW, room = width - labels, span = view.to - view.from;
  context.fillStyle = color("--soft");
  context.save();
  context.beginPath();
  context.rect(0, y, labels - 6, ROW);
  context.clip();
  context.fillText(lane.name, 6, y + ROW / 2);
  context.restore();
  const columns = Math.max(1, Math.floor(room)), found = new Float64Array(columns);
  let most = 0;
  for (let x = 0; x < columns; x++) {
    found[x] = between(lane.runs, view.from + x / columns * span, view.from + (x + 1) / columns * span);
    most = Math.max(most, found[x]);
  }
  context.fillStyle = color(lane.kind === "app" ? "--app" : "--topic");
  const ranges = shownExactly(span / room);
  const isKnown = at => ranges.some(range => range.from <= at && at <= range.to);
  for (let x = 0; x < columns; x++) {
    if (!found[x] || isKnown(view.from + (x + 0.5) / columns * span)) continue;
    context.globalAlpha = 0.25 + 0.75 * found[x] / most;
    context.fillRect(labels + x, y + 3, 1, ROW - 6);
  }
  context.globalAlpha = 1;
  for (const range of ranges)
    for (const [begin, stop] of range.lanes[row]) {
      if (stop < view.from || begin > view.to) continue;
      const x = Math.max(labels, place(begin, width));
      context.fillRect(x, y + 3, Math.max(2, place(Math.min(stop, view.to), width) - x), ROW - 6);
    }
}

/* Return the ranges that are drawn exactly, when a pixel of so many ns is shorter than a bin. */
function shownExactly(pixel) {
  return pixel >= data.width ? [] : exact.filter(range => range.from <= view.to && range.to >= view.from);
}

/* Draw each mark as a tick at the top and a line across the lanes. The lines are fainter if there are many marks. */
function drawMarks(width, height) {
  const room = width - labels, span = view.to - view.from;
  const seen = data.marks.filter(mark => mark[0] >= view.from && mark[0] <= view.to);
  for (const [at, kind] of seen) {
    context.fillStyle = color(kind === "note" ? "--warn" : kind === "switch" ? "--switch" : "--bad");
    const x = labels + (at - view.from) / span * room;
    context.globalAlpha = Math.min(0.7, 8 / seen.length);
    context.fillRect(x, TOP, 1, height);
    context.globalAlpha = 1;
    context.fillRect(x - 1, TOP - 5, 3, 5);
    if (kind === "switch" && seen.length <= MOST_NAMED) context.fillText("switch", x + 4, TOP - 3);
  }
}

function describe(event) {
  const place = canvas.getBoundingClientRect(), x = event.clientX - place.left - labels;
  const room = place.width - labels, row = Math.floor((event.clientY - place.top - TOP) / ROW);
  const tip = document.getElementById("timeline-tip"), span = view.to - view.from;
  if (x < 0) { tip.textContent = ""; return; }
  const at = view.from + x / room * span, reach = MARK_REACH / room * span;
  const marks = data.marks.filter(mark => Math.abs(mark[0] - at) < reach).slice(0, 3);
  const texts = marks.map(mark => mark[1] + " at " + (mark[0] / 1e9).toFixed(6) + " s: " + mark[2]);
  const lane = lanes[row], range = shownExactly(span / room).find(each => each.from <= at && at <= each.to);
  if (lane && range) {
    const near = range.lanes[row].filter(([begin, stop]) => begin - reach < at && at < stop + reach).slice(0, 3);
    const what = lane.kind === "app" ? "ran from " : "sent at ";
    const times = near.map(([begin, stop]) => what + micro(begin) + (lane.kind === "app" ? " to " + micro(stop) : ""));
    if (times.length) texts.unshift(lane.name + " " + times.join(", "));
  } else if (lane) {
    const from = Math.floor(at / data.width) * data.width, to = Math.max(from + data.width, at + span / room);
    const count = between(lane.runs, from, to), busy = between(lane.busy, from, to);
    const what = lane.kind === "app" ? " runs" : " sent";
    const used = busy ? ", " + (busy / 1e3).toLocaleString("en") + " us of CPU time" : "";
    texts.unshift(lane.name + " from " + seconds(from) + " to " + seconds(to) + ": " + count + what + used);
  }
  tip.textContent = texts.join(" | ");
}

/* Zoom and move with the mouse. Without a pressed button, call `tell` to describe the place of the mouse. */
function movable(surface, tell) {
  let dragged = null;
  surface.addEventListener("pointerdown", event => { dragged = event.clientX; surface.setPointerCapture(event.pointerId); });
  surface.addEventListener("pointerup", () => { dragged = null; });
  surface.addEventListener("pointermove", event => {
    if (dragged === null) { tell(event); return; }
    move((dragged - event.clientX) / (box.clientWidth - labels));
    dragged = event.clientX;
  });
  surface.addEventListener("wheel", event => {
    if (event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY)) move(Math.sign(event.deltaX || event.deltaY) / 10);
    else {
      const place = surface.getBoundingClientRect();
      const share = (event.clientX - place.left - labels) / (place.width - labels);
      zoom(event.deltaY > 0 ? 1.25 : 0.8, Math.min(1, Math.max(0, share)));
    }
    event.preventDefault();
  }, { passive: false });
  surface.addEventListener("keydown", event => {
    const name = KEYS[event.key];
    if (name) { ACTIONS[name](); event.preventDefault(); }
  });
}

const ACTIONS = {
  in: () => zoom(0.5), out: () => zoom(2), left: () => move(-0.25), right: () => move(0.25), all: () => setView(0, end),
};
const KEYS = { "+": "in", "=": "in", "-": "out", ArrowLeft: "left", ArrowRight: "right", Home: "all", 0: "all" };
for (const name in ACTIONS) document.getElementById("timeline-" + name).addEventListener("click", ACTIONS[name]);
movable(canvas, describe);
/* Values over time. */
const STEP_MISSING = 65535, FIRST_GROUPS = 2, PLOT = 170, PLOT_TOP = 28, PLOT_BOTTOM = 12, TEXTS = 36, TIMES = 20;
const SELECT = "Select fields to draw them.";
const valuesCanvas = document.getElementById("values-canvas");
const COLORS = ["--line-1", "--line-2", "--line-3", "--line-4", "--line-5", "--line-6", "--line-7", "--line-8"];

function decoded(line, count) {
  const found = new Float64Array(count).fill(line.low);
  if (line.data === undefined) return found;
  const bytes = atob(line.data);
  for (let at = 0; at < count; at++) {
    const step = bytes.charCodeAt(2 * at) | bytes.charCodeAt(2 * at + 1) << 8;
    found[at] = step === STEP_MISSING ? NaN : line.low + step * line.step;
  }
  return found;
}

function timesOf(steps) {
  let at = 0;
  return Float64Array.from(steps, step => (at += step) * 1e3);
}

/* The groups that a reader can select: lines of numbers, and texts that change. Lines are decoded when first drawn. */
const groups = [];
for (const series of JSON.parse(document.getElementById("values-data").textContent)) {
  for (const group of series.groups)
    groups.push({ ...group, series, title: series.name + "." + group.name, count: group.lines.length });
  if (series.changes.length) {
    const changes = series.changes.map(([at, text]) => [at * 1e3, text]);
    groups.push({ name: "changes", unit: "text", series, title: series.name, changes, count: changes.length });
  }
}
const chosen = new Set();

function linesOf(group) {
  group.times ??= timesOf(group.series.times);
  group.decoded ??= group.lines.map(line => ({ name: line.name, values: decoded(line, group.times.length) }));
  return group.decoded;
}

/* Return the index of the first point at or after an instant. */
function firstAt(times, ns) {
  let low = 0, high = times.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] < ns) low = middle + 1; else high = middle;
  }
  return low;
}

function limits(group) {
  const from = Math.max(0, firstAt(group.times, view.from) - 1), to = firstAt(group.times, view.to) + 1;
  let low = Infinity, high = -Infinity;
  for (const line of linesOf(group))
    for (const value of line.values.subarray(from, to))
      if (value === value) { low = Math.min(low, value); high = Math.max(high, value); }
  if (low > high) return { low: 0, high: 1, from, to };
  const rim = (high - low) * 0.06 || Math.abs(high) * 0.1 || 1;
  return { low: low - rim, high: high + rim, from, to };
}

function number(value, span) {
  if (value !== 0 && (Math.abs(value) >= 1e7 || span < 1e-5)) return value.toPrecision(6);
  return value.toFixed(Math.max(0, Math.min(9, Math.ceil(-Math.log10(span || 1)) + 1)));
}

function drawValues() {
  if (!valuesCanvas) return;
  const shown = groups.filter(group => chosen.has(group)), plots = shown.filter(group => group.lines);
  const texts = shown.flatMap(group => group.changes || []);
  const width = valuesCanvas.parentElement.clientWidth, scale = window.devicePixelRatio || 1;
  const top = texts.length ? TEXTS : 0, height = top + Math.max(1, plots.length) * PLOT + TIMES;
  valuesCanvas.hidden = !shown.length;
  valuesCanvas.style.height = height + "px";
  valuesCanvas.width = Math.round(width * scale);
  valuesCanvas.height = Math.round(height * scale);
  const on = valuesCanvas.getContext("2d");
  on.setTransform(scale, 0, 0, scale, 0, 0);
  on.fillStyle = color("--panel");
  on.fillRect(0, 0, width, height);
  drawAxis(on, width, top, height - top - TIMES, height - TIMES / 2);
  plots.forEach((group, index) => drawPlot(on, group, top + index * PLOT, width));
  on.fillStyle = color("--soft");
  let last = -Infinity;
  for (const [at, text] of texts) {
    if (at < view.from || at > view.to) continue;
    const x = place(at, width);
    for (let y = top; y < height - TIMES; y += 7) on.fillRect(x, y, 1, 4);
    if (x > last + 4) { on.fillText(text, x, top / 2 + 4); last = x + on.measureText(text).width; }
  }
  drawFocus(on, width, height);
}

function drawPlot(on, group, top, width) {
  linesOf(group);
  const range = limits(group), begin = top + PLOT_TOP, room = PLOT - PLOT_TOP - PLOT_BOTTOM;
  const y = value => begin + (range.high - value) / (range.high - range.low) * room;
  drawGrid(on, range, y, width);
  on.fillStyle = color("--ink");
  on.fillText(group.title + (group.unit ? ", " + group.unit : ""), labels, top + 9);
  on.save();
  on.beginPath();
  on.rect(labels, top, width - labels, PLOT);
  on.clip();
  drawLimits(on, group, range, y, width);
  group.decoded.forEach((line, index) => drawLine(on, group, line, index, range, y, width));
  on.restore();
  drawNames(on, group, top);
}

function drawGrid(on, range, y, width) {
  const span = range.high - range.low;
  let step = 10 ** Math.floor(Math.log10(span / 2));
  while (span / step > 5) step *= span / step > 10 ? 2.5 : 2;
  for (let value = Math.ceil(range.low / step) * step; value <= range.high; value += step) {
    on.fillStyle = color("--line");
    on.fillRect(labels, y(value), width - labels, 1);
    on.fillStyle = color("--soft");
    on.fillText(number(Math.abs(value) < step / 1e6 ? 0 : value, step), labels + 3, y(value) - 6);
  }
}

/* Draw the limits of a measurement as dashed lines with their names; those outside of the shown values are left out. */
function drawLimits(on, group, range, y, width) {
  for (const [name, value] of group.limits) {
    if (value < range.low || value > range.high) continue;
    on.fillStyle = color(name === "red" ? "--bad" : "--warn");
    for (let x = labels; x < width; x += name === "red" ? 9 : 5) on.fillRect(x, y(value), name === "red" ? 6 : 2, 1);
    on.fillText(name, width - on.measureText(name).width - 4, y(value) - 6);
  }
}

function drawLine(on, group, line, index, range, y, width) {
  on.strokeStyle = on.fillStyle = color(COLORS[index % COLORS.length]);
  on.lineWidth = 1.4;
  on.beginPath();
  let isDown = false;
  const few = range.to - range.from < 60;
  for (let at = range.from; at < Math.min(range.to, line.values.length); at++) {
    const value = line.values[at], x = place(group.times[at], width);
    if (value !== value) { isDown = false; continue; }
    if (isDown) on.lineTo(x, y(value)); else on.moveTo(x, y(value));
    if (few) on.fillRect(x - 1.5, y(value) - 1.5, 3, 3);
    isDown = true;
  }
  on.stroke();
}

/* Draw the names of the lines, in the column that has the names of the lanes in the timeline. */
function drawNames(on, group, top) {
  const room = Math.floor((PLOT - PLOT_TOP) / 14);
  on.save();
  on.beginPath();
  on.rect(0, top, labels - 6, PLOT);
  on.clip();
  group.decoded.slice(0, room).forEach((line, index) => {
    const more = group.decoded.length - room, isLast = index === room - 1 && more > 0;
    on.fillStyle = color(isLast ? "--soft" : COLORS[index % COLORS.length]);
    const name = line.name.startsWith(group.name) ? line.name.slice(group.name.length).replace(/^\./, "") : line.name;
    on.fillText(isLast ? more + 1 + " more" : name || group.name, 6, top + PLOT_TOP + index * 14 + 5);
  });
  on.restore();
}

/* Show the values at the mouse: the last point at or before its time. */
function tellValues(event) {
  const box = valuesCanvas.getBoundingClientRect(), x = event.clientX - box.left - labels;
  const plots = groups.filter(group => chosen.has(group) && group.lines);
  const top = groups.some(group => chosen.has(group) && group.changes) ? TEXTS : 0;
  const group = plots[Math.floor((event.clientY - box.top - top) / PLOT)];
  const tip = document.getElementById("values-tip");
  if (x < 0 || !group) { tip.textContent = ""; return; }
  const at = view.from + x / (box.width - labels) * (view.to - view.from);
  const point = firstAt(group.times, at + 1) - 1;
  const texts = point < 0 ? [] : linesOf(group).map(line => line.name + " " + +line.values[point].toPrecision(7));
  tip.textContent = group.series.name + " at " + seconds(at) + ": " + texts.join(", ");
}

function choose(group, box) {
  if (box.checked) chosen.add(group); else chosen.delete(group);
  document.getElementById("values-tip").textContent = chosen.size ? "" : SELECT;
  drawValues();
}

/* Return the groups that are drawn before the reader selects some: of topics, else of the packets of the mission's own
   applications, else of cFE's, and of events at last. Values that never change say little. */
function firstGroups() {
  const found = groups.filter(group => group.lines && group.lines.some(line => line.data !== undefined));
  const kinds = [/^\//, /^(?!CFE_)/, /^(?!CFE_EVS_)/, /^/].map(kind => found.filter(group => kind.test(group.series.name)));
  return new Set((kinds.find(kind => kind.length) || []).slice(0, FIRST_GROUPS));
}

function fillPicker() {
  const picker = document.getElementById("values-fields"), filter = document.getElementById("values-filter");
  const parts = new Map(), rows = [], first = firstGroups();
  for (const group of groups) {
    if (!parts.has(group.series)) {
      const part = document.createElement("details"), head = document.createElement("summary");
      head.textContent = group.series.name;
      head.title = group.series.type + ", " + group.series.count + " messages";
      part.append(head);
      parts.set(group.series, part);
      picker.append(part);
    }
    const row = document.createElement("label"), box = document.createElement("input"), about = document.createElement("span");
    box.type = "checkbox";
    box.checked = first.has(group);
    if (box.checked) { chosen.add(group); parts.get(group.series).open = true; }
    box.addEventListener("change", () => choose(group, box));
    about.className = "type";
    about.textContent = [group.count > 1 ? "[" + group.count + "]" : "", group.unit].filter(Boolean).join(" ");
    row.append(box, group.name, about);
    parts.get(group.series).append(row);
    rows.push([row, (group.title + " " + (group.lines || []).map(line => line.name).join(" ")).toLowerCase()]);
  }
  filter.addEventListener("input", () => {
    const words = filter.value.toLowerCase().split(/\s+/).filter(Boolean);
    for (const [row, text] of rows) row.hidden = !words.every(word => text.includes(word));
    for (const part of parts.values()) {
      part.hidden = ![...part.querySelectorAll("label")].some(row => !row.hidden);
      part.open = words.length > 0 && !part.hidden;
    }
  });
}

if (valuesCanvas) {
  fillPicker();
  document.getElementById("values-tip").textContent = chosen.size ? "" : SELECT;
  movable(valuesCanvas, tellValues);
}

/* Links to an instant. */
for (const link of document.querySelectorAll("a[data-at]"))
  link.addEventListener("click", () => {
    focus = Number(link.dataset.at);
    const span = Number(link.dataset.span) || Math.max(end / 50, 4 * LEAST_BINS * data.width);
    setView(focus - span / 2, focus + span / 2);
  });

/* Open on the failure, and with the first fields that change. */
if (data.open) {
  focus = data.open[2];
  setView(data.open[0], data.open[1]);
}

new ResizeObserver(draw).observe(box);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
draw();

/* Tables. */
for (const field of document.querySelectorAll("input[data-table]")) {
  const rows = [...document.getElementById(field.dataset.table).tBodies[0].rows];
  const texts = rows.map(row => row.textContent.toLowerCase());
  const count = field.parentElement.querySelector("output");
  const show = () => {
    const words = field.value.toLowerCase().split(/\s+/).filter(Boolean);
    let shown = 0;
    rows.forEach((row, index) => {
      row.hidden = !words.every(word => texts[index].includes(word));
      shown += !row.hidden;
    });
    count.textContent = shown + " of " + rows.length;
  };
  field.addEventListener("input", show);
  show();
}

function sort(table, column) {
  const head = table.tHead.rows[0].cells[column];
  const down = head.getAttribute("aria-sort") !== "descending";
  for (const each of table.tHead.rows[0].cells) each.removeAttribute("aria-sort");
  head.setAttribute("aria-sort", down ? "descending" : "ascending");
  const key = row => {
    const cell = row.cells[column];
    return cell.dataset.order === undefined ? cell.textContent : Number(cell.dataset.order);
  };
  const order = (one, other) => one < other ? -1 : one > other ? 1 : 0;
  const rows = [...table.tBodies[0].rows].sort((one, other) => order(key(one), key(other)) * (down ? -1 : 1));
  table.tBodies[0].append(...rows);
}

for (const table of document.querySelectorAll("table.sortable"))
  [...table.tHead.rows[0].cells].forEach((head, column) => {
    if (table.tBodies[0].querySelector("tr > :nth-child(" + (column + 1) + ") svg")) return;  // a picture has no order
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = head.textContent;
    button.addEventListener("click", () => sort(table, column));
    head.replaceChildren(button);
  });
