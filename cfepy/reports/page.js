"use strict";
/* The page of a run: the timeline, tables that sort, tables that are filtered. */

const data = JSON.parse(document.getElementById("timeline-data").textContent);
const canvas = document.getElementById("timeline-canvas");
const box = canvas.parentElement;
const context = canvas.getContext("2d");
const ROW = 18, TOP = 24, LEAST_BINS = 8, MARK_REACH = 5;

/* Counts of a lane as sums up to each bin, so that any stretch of time is one subtraction. */
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
const end = Math.max(data.end, data.width);
let view = { from: 0, to: end };
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

function color(name) { return getComputedStyle(document.documentElement).getPropertyValue(name).trim(); }

function setView(from, to) {
  const span = Math.min(end, Math.max(LEAST_BINS * data.width, to - from));
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
  drawAxis(width, height);
  lanes.forEach((lane, row) => drawLane(lane, row, width));
  drawMarks(width, height);
  const shown = document.getElementById("timeline-range");
  shown.textContent = seconds(view.from) + " to " + seconds(view.to);
  shown.dataset.from = Math.round(view.from);
  shown.dataset.to = Math.round(view.to);
}

function drawAxis(width, height) {
  const span = view.to - view.from, room = width - labels;
  let step = 10 ** Math.ceil(Math.log10(span / Math.max(2, room / 110)));
  if (step / 2 * room / span > 90) step /= 2;
  context.font = "11px system-ui, sans-serif";
  context.textBaseline = "middle";
  for (let at = Math.ceil(view.from / step) * step; at <= view.to; at += step) {
    const x = labels + (at - view.from) / span * room;
    context.fillStyle = color("--line");
    context.fillRect(x, TOP - 4, 1, height);
    context.fillStyle = color("--soft");
    const text = seconds(at);
    context.fillText(text, Math.min(x + 3, width - context.measureText(text).width - 2), 11);
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
  for (let x = 0; x < columns; x++) {
    if (!found[x]) continue;
    context.globalAlpha = 0.25 + 0.75 * found[x] / most;
    context.fillRect(labels + x, y + 3, 1, ROW - 6);
  }
  context.globalAlpha = 1;
}

/* A tick at the top for each, and a line down the lanes that is the fainter the more there are. */
function drawMarks(width, height) {
  const room = width - labels, span = view.to - view.from;
  const seen = data.marks.filter(mark => mark[0] >= view.from && mark[0] <= view.to);
  for (const [at, kind] of seen) {
    context.fillStyle = color(kind === "note" ? "--warn" : "--bad");
    const x = labels + (at - view.from) / span * room;
    context.globalAlpha = Math.min(0.7, 8 / seen.length);
    context.fillRect(x, TOP, 1, height);
    context.globalAlpha = 1;
    context.fillRect(x - 1, TOP - 5, 3, 5);
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
  const lane = lanes[row];
  if (lane) {
    const from = Math.floor(at / data.width) * data.width, to = Math.max(from + data.width, at + span / room);
    const count = between(lane.runs, from, to), busy = between(lane.busy, from, to);
    const what = lane.kind === "app" ? " times on the processor" : " sent";
    const used = busy ? ", " + (busy / 1e3).toLocaleString("en") + " us of it" : "";
    texts.unshift(lane.name + " from " + seconds(from) + " to " + seconds(to) + ": " + count + what + used);
  }
  tip.textContent = texts.join(" | ");
}

let dragged = null;
canvas.addEventListener("pointerdown", event => { dragged = event.clientX; canvas.setPointerCapture(event.pointerId); });
canvas.addEventListener("pointerup", () => { dragged = null; });
canvas.addEventListener("pointermove", event => {
  if (dragged === null) { describe(event); return; }
  move((dragged - event.clientX) / (box.clientWidth - labels));
  dragged = event.clientX;
});
canvas.addEventListener("wheel", event => {
  if (event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY)) move(Math.sign(event.deltaX || event.deltaY) / 10);
  else {
    const place = canvas.getBoundingClientRect();
    const share = (event.clientX - place.left - labels) / (place.width - labels);
    zoom(event.deltaY > 0 ? 1.25 : 0.8, Math.min(1, Math.max(0, share)));
  }
  event.preventDefault();
}, { passive: false });

const ACTIONS = {
  in: () => zoom(0.5), out: () => zoom(2), left: () => move(-0.25), right: () => move(0.25), all: () => setView(0, end),
};
const KEYS = { "+": "in", "=": "in", "-": "out", ArrowLeft: "left", ArrowRight: "right", Home: "all", 0: "all" };
for (const name in ACTIONS) document.getElementById("timeline-" + name).addEventListener("click", ACTIONS[name]);
canvas.addEventListener("keydown", event => {
  const name = KEYS[event.key];
  if (name) { ACTIONS[name](); event.preventDefault(); }
});
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
