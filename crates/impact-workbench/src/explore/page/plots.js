// Beside the map: the motion, characteristics, basins.
import { Frame, around, cellCanvas, colour, fit, markColour, named, number, paintCells, plusMinus, tint, FONT } from "./draw.js";
import { element, make } from "./fields.js";

/** Cell of a start that is beyond the contact. */
const BEYOND = 0xffff;

/** A panel whose pictures are painted once a frame, however often they are asked for. */
class Panel {
  constructor(app, ...pictures) {
    this.app = app;
    for (const id of pictures) new ResizeObserver(() => this.draw()).observe(element(id));
  }

  draw() {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => {
      this.pending = false;
      this.paint();
    });
  }
}

/** The motion at the cursor: series, phase portrait, Poincaré map, autocorrelation, numbers. */
export class MotionPanel extends Panel {
  constructor(app) {
    super(app, "series", "phase", "poincare", "autocorrelation");
    this.frame = null;
    this.hover = null; // where the pointer is over the series, px
    const series = element("series");
    series.addEventListener("pointermove", (event) => { this.hover = this.timeFrame?.holds(event.offsetX, event.offsetY) ? event.offsetX : null; this.draw(); });
    series.addEventListener("pointerleave", () => { this.hover = null; this.draw(); });
  }

  show(frame) {
    this.frame = frame;
    this.live = null;
    this.coexisting = null;
    this.draw();
  }

  /** What starts at the cursor settle on. */
  others(frame) {
    this.coexisting = frame;
    this.draw();
  }

  /** The motions that coexist at the cursor, with the share of starts that settle on each. */
  shares() {
    if (!this.coexisting) return "…";
    const { motions, counts } = this.coexisting, all = counts.reduce((sum, n) => sum + n, 0);
    const sorted = motions.map((m, i) => [m.label, counts[i]]).sort((a, b) => b[1] - a[1]);
    const most = sorted.slice(0, 5).map(([label, n]) => `${named({ label })}: ${n < 0.005 * all ? "< 1" : Math.round(100 * n / all)} %`);
    return most.join(", ") + (sorted.length > 5 ? ", …" : "");
  }

  /** The next stretch of the running motion joins what is shown. */
  run(frame) {
    const span = this.app.state.periods;
    const { damping_ratio, restitution, asymmetry } = this.app.state;
    const at = JSON.stringify([frame.cursor.eta, frame.cursor.rho, damping_ratio, restitution, asymmetry]);
    const old = this.live ?? { t: [], x: [], other: [], jumps: [], px: [], pv: [], pt: [], end: 0, moved: 0, at };
    if (old.at !== at) old.moved = old.end;
    old.at = at;
    if (frame.motion) this.frame = { ...this.frame, ...frame, column: { ...this.frame?.column, lag: frame.column.lag, autocorrelation: frame.column.autocorrelation } };
    const c = frame.column, n = c.periods.length, jumps = withJumps(c);
    old.jumps.push(...jumps.map((p) => [old.end + p[0], p[1], p[2]]));
    for (let i = old.t.length ? 1 : 0; i < n; i++) {
      old.t.push(old.end + c.periods[i]); old.x.push(c.x[i]); old.other.push(frame.gap - c.y[i]);
    }
    old.px.push(...c.poincare_x); old.pv.push(...c.poincare_vx); old.pt.push(...Array(c.poincare_x.length).fill(old.end));
    old.end += c.periods[n - 1];
    const first = old.t.findIndex((t) => t >= old.end - span);
    if (first > 0) for (const key of ["t", "x", "other"]) old[key].splice(0, first);
    old.jumps = old.jumps.filter((p) => p[0] >= old.end - span);
    for (const key of ["px", "pv", "pt"]) old[key].splice(0, Math.max(0, old[key].length - 500));
    this.live = old;
    this.draw();
  }

  paint() {
    if (element("panel-motion").hidden || !this.frame) return;
    this.series(); this.phase(); this.poincare(); this.correlation(); this.numbers();
    const { motion, x_min, x_max, approach_speeds: w } = this.frame, of = `${named(motion)}, X from ${number(x_min)} to ${number(x_max)}`;
    for (const [id, name] of [["series", "Displacements in time"], ["phase", "Phase portrait"], ["poincare", "Poincaré map"], ["autocorrelation", "Autocorrelation"]]) {
      element(id).setAttribute("aria-label", `${name}: ${of}, ${w.length ? `approach speeds ${number(Math.min(...w))} to ${number(Math.max(...w))}` : "no impacts"}`);
    }
  }

  series() {
    const l = this.live, c = this.frame?.column, two = this.frame?.two_masses ?? true;
    const t = l ? l.t : c.periods, x = l ? l.x : c.x;
    const other = l ? l.other : Float32Array.from(c.y, (y) => this.frame.gap - y);
    this.span = [t[0], Math.max(t[t.length - 1], t[0] + 0.1)];
    const f = this.timeFrame = new Frame(element("series"), this.span, around([x, other]), ["time *τ*/*T*", "displacement"], { top: 24 });
    const curves = [["*X*", x, colour("blue")], [two ? "2*ρ* − *Y*" : "stop", other, two ? colour("vermilion") : colour("ink")]];
    f.clip(() => {
      if (!l && c.sticking) this.together(f, c);
      for (const [, values, paint] of curves) f.curve(t, values, { colour: paint, width: 1.5 });
    });
    f.axes();
    const at = this.hover === null ? -1 : t.findIndex((v) => v >= f.ux(this.hover));
    if (at >= 0) f.clip(() => f.curve([t[at], t[at]], f.y, { colour: colour("quiet"), dash: [3, 3], width: 1 }));
    f.key([...(at >= 0 ? [[`*τ*/*T* = ${number(t[at], 5)}`, null]] : []), ...curves.map(([name, values, paint]) => [name + (at >= 0 ? ` = ${number(values[at], 5)}` : ""), paint])]);
  }

  /** Grey where the masses stick together. */
  together(f, { sticking, periods }) {
    f.context.fillStyle = colour("together");
    for (let i = 0, from = -1; i <= sticking.length; i++) {
      const on = i < sticking.length && sticking[i] > 0;
      if (on && from < 0) from = i;
      if (!on && from >= 0) {
        const left = f.px(periods[from]);
        f.context.fillRect(left, f.box.top, Math.max(1, f.px(periods[i - 1]) - left), f.box.height);
        from = -1;
      }
    }
  }

  phase() {
    const l = this.live, c = this.frame?.column, path = l ? l.jumps : withJumps(c);
    const xs = path.map((p) => p[1]), vs = path.map((p) => p[2]);
    const f = new Frame(element("phase"), around([xs]), around([vs]), ["*X*", "*X*′"]).axes();
    const wall = this.frame ? this.frame.gap / (this.frame.two_masses ? 2 : 1) : null;
    f.clip(() => {
      if (wall !== null) f.curve([wall, wall], f.y, { colour: colour("quiet"), dash: [3, 3], width: 1 });
      const before = l ? path.findLastIndex((p) => p[0] < l.moved) + 1 : 0;
      f.curve(xs.slice(0, before + 1), vs.slice(0, before + 1), { colour: colour("quiet"), width: 1, alpha: 0.35 });
      f.curve(xs.slice(before), vs.slice(before), { colour: colour("blue"), width: 1.3 });
      if (!l) f.dots(c.impact_x, c.impact_vx_before, 2, colour("ink"));
    });
  }

  poincare() {
    const l = this.live, c = this.frame?.column;
    const xs = l ? l.px : c.poincare_x, vs = l ? l.pv : c.poincare_vx;
    const grown = (list) => { const [a, b] = around([list], 0.1), m = 0.1, at = m * Math.round((a + b) / 2 / m); return b - a < m ? [at - m, at + m] : [a, b]; };
    const before = l ? l.pt.findLastIndex((t) => t < l.moved) + 1 : 0, size = xs.length > 50 ? 1.2 : 2.5;
    const f = new Frame(element("poincare"), grown(xs), grown(vs), [before ? "*X* each period; grey: before the move" : "*X* once a drive period", "*X*′"]).axes();
    f.clip(() => {
      f.dots(xs.slice(0, before), vs.slice(0, before), size, colour("band"));
      f.dots(xs.slice(before), vs.slice(before), size, colour("vermilion"));
    });
  }

  correlation() {
    const c = this.frame.column;
    if (!c.lag.length) { fit(element("autocorrelation")); return; }
    const f = new Frame(element("autocorrelation"), [0, c.lag[c.lag.length - 1]], [-1.05, 1.05], ["lag, drive periods", "autocorrelation"]).axes();
    f.clip(() => f.curve(c.lag, c.autocorrelation, { colour: colour("green") }));
  }

  numbers() {
    const f = this.frame, s = this.app.state, w = f.approach_speeds;
    const speeds = w.length === 0 ? "none" : w.length <= 4 ? w.map((v) => number(v, 6)).join(", ") : `${number(Math.min(...w), 5)} to ${number(Math.max(...w), 5)}`;
    const { start, phase } = s.cursor;
    const rows = [
      [this.live ? "now" : "settles on", named(f.motion)],
      ["of all starts", this.shares()],
      ["approach speed", speeds],
      ["X greatest, least", `${number(f.x_max, 6)}, ${number(f.x_min, 6)}`],
      ["Lyapunov, per τ", f.lyapunov === null ? "−∞ (a dead zone)" : plusMinus(f.lyapunov, 1.96 * f.lyapunov_error)],
      ["without impacts", `${number(f.impactless.x[0], 5)}, ${number(f.impactless.x[1] * 180 / Math.PI, 4)}° behind`],
      ["start X, X′", `${number(start.x, 5)}, ${number(start.vx, 5)}`],
    ];
    if (f.two_masses && (start.x !== start.y || start.vx !== start.vy)) rows.push(["start Y, Y′", `${number(start.y, 5)}, ${number(start.vy, 5)}`]);
    rows.push(["phase φ", `${number(turned(phase), 5)} rad`], ["Poincaré at", `${number(turned(s.poincare_phase), 4)} rad`]);
    element("numbers").replaceChildren(...facts(rows));
  }
}

/** [time, X, X′] of a series with the instants just before and after each impact. */
function withJumps(c) {
  const path = [], hits = c.impact_periods;
  let k = 0;
  for (let i = 0; i < c.periods.length; i++) {
    for (; k < hits.length && hits[k] <= c.periods[i]; k++) {
      path.push([hits[k], c.impact_x[k], c.impact_vx_before[k]], [hits[k], c.impact_x[k], c.impact_vx_after[k]]);
    }
    path.push([c.periods[i], c.x[i], c.vx[i]]);
  }
  return path;
}

/** A phase in [0, 2π), without the dust of arithmetic. */
export function turned(phase) {
  const turn = 2 * Math.PI, within = ((phase % turn) + turn) % turn;
  return Math.min(within, turn - within) < 1e-6 ? 0 : within;
}

/** Rows of a definition list. */
export function facts(rows) {
  return rows.flatMap(([name, value]) => [make("dt", name), make("dd", value)]);
}

/** What the lowest picture of the characteristics can show: its name, axis, and how it is drawn. */
export const CHARACTERISTICS = {
  lyapunov: { text: "Lyapunov exponent", axis: "Lyapunov exponent per *τ*", zero: true, of: (d) => d.lyapunov, error: (d) => d.lyapunov_error },
  autocorrelation: { text: "autocorrelation at one drive period", axis: "autocorrelation", range: [-1.05, 1.05], zero: true, of: (d) => d.correlation },
  approach_of_x: { text: "X′ before impacts", axis: "*X*′ before impacts", dots: (d, key) => d.impact_step.map((s) => d[key][s]), of: (d) => d.impact_x_speed },
  impactless_phase: { text: "phase without impacts", axis: "phase lag, °", range: [0, 180], of: (d) => d.impactless_phase.map((p) => p * 180 / Math.PI) },
};
/** Share of the uppermost picture that trajectories take above its box. */
const INSETS = 0.36;
/** Space about each of them, px. */
const SPACE = 6;

/** Characteristics along a line, up and down, as they arrive. */
export class LinePanel extends Panel {
  constructor(app) {
    super(app, "line-x", "line-v", "line-l");
    this.trajectories = new Map(); // of insets, by machine and cursor
    this.clear(0);
  }

  clear(id, line) { this.id = id; this.of = JSON.stringify(line); this.ways = {}; this.all = 0; }

  add(frame, line) {
    if (frame.id !== this.id) this.clear(frame.id, line);
    this.all = frame.all;
    const way = this.ways[frame.way] ??= {};
    for (const [key, values] of Object.entries(frame.column)) (way[key] ??= []).push(...values);
    this.draw();
  }

  /** What an inset's trajectory depends on. */
  static insetKey({ damping_ratio, restitution, single, asymmetry, periods, watch }, cursor) {
    return JSON.stringify([damping_ratio, restitution, single, asymmetry, periods, watch, cursor]);
  }

  /** Ask for the trajectories of insets that are not there yet; those of other machines are forgotten. */
  async fetchInsets() {
    const { state } = this.app, insets = state.insets ?? [];
    const wanted = new Map(insets.map((cursor) => [LinePanel.insetKey(state, cursor), cursor]));
    for (const key of this.trajectories.keys()) if (!wanted.has(key)) this.trajectories.delete(key);
    this.draw();
    for (const [key, cursor] of wanted) {
      if (this.trajectories.has(key)) continue;
      this.trajectories.set(key, null);
      try {
        this.trajectories.set(key, await this.app.wire.once({ kind: "inset" }, { ...state, cursor }));
      } catch (error) { this.trajectories.delete(key); this.app.message(error.message, error.remedy); return; }
      this.draw();
    }
  }

  /** Phase trajectories in a row above the box, each with a line to its place. */
  insets(f, key) {
    const { state } = this.app;
    const found = (state.insets ?? []).map((cursor) => this.trajectories.get(LinePanel.insetKey(state, cursor))).filter((t) => t);
    const inside = found.filter((t) => f.x[0] <= t.cursor[key] && t.cursor[key] <= f.x[1]);
    inside.sort((a, b) => a.cursor[key] - b.cursor[key]);
    const { context: c, box } = f, room = (box.width + SPACE) / Math.max(1, inside.length);
    const width = Math.min(room - SPACE, 84), top = 1, height = box.top - SPACE - top;
    let free = box.left;
    inside.forEach((t, i) => {
      const at = f.px(t.cursor[key]), last = box.left + box.width + SPACE - (inside.length - i) * (width + SPACE);
      const left = Math.max(free, Math.min(at - width / 2, last));
      free = left + width + SPACE;
      c.strokeStyle = colour("quiet"); c.lineWidth = 1;
      c.beginPath(); c.moveTo(left + width / 2, top + height); c.lineTo(at, f.py(t.x_max)); c.stroke();
      c.beginPath(); c.arc(at, f.py(t.x_max), 3, 0, 7); c.fillStyle = markColour(t.motion); c.fill();
      c.fillStyle = colour("paper"); c.fillRect(left, top, width, height); c.strokeRect(left, top, width, height);
      const path = withJumps(t.column), xs = path.map((p) => p[1]), vs = path.map((p) => p[2]);
      const small = Object.create(f);
      Object.assign(small, { x: around([xs]), y: around([vs]), box: { left, top: top + 13, width, height: height - 14 } });
      small.clip(() => small.curve(xs, vs, { colour: colour("blue"), width: 1 }));
      c.font = `12px ${FONT}`; c.textAlign = "center"; c.textBaseline = "top"; c.fillStyle = markColour(t.motion);
      c.fillText(named(t.motion), left + width / 2, top + 1);
    });
  }

  paint() {
    const line = this.app.state?.line;
    if (!element("panel-line").hidden && line) this.pictures(line);
  }

  pictures(line) {
    const { view } = this.app.state;
    const share = (range, whole) => Math.abs(range[1] - range[0]) / (whole[1] - whole[0]);
    const byEta = share(line.eta, view.eta) >= share(line.rho, view.rho);
    const key = byEta ? "eta" : "rho", range = [...line[key]].sort((a, b) => a - b);
    const title = byEta ? "frequency ratio *η*" : "clearance ratio *ρ*";
    if (this.of !== JSON.stringify(line)) this.clear(0, line); // what is there is of another line
    const ways = Object.entries(this.ways);
    const paint = { up: colour("blue"), down: colour("vermilion") };
    const panel = (id, values, name, draw, above = 8) => {
      const f = new Frame(element(id), range, values, [title, name], { left: 62, top: above }).axes();
      f.clip(() => { for (const [way, data] of ways) draw(f, data, paint[way]); });
      const at = this.app.state.cursor[key];
      f.clip(() => f.curve([at, at], f.y, { colour: colour("quiet"), dash: [3, 3], width: 1 }));
      return f;
    };
    const lists = (k) => ways.map(([, d]) => d[k]);
    element("panel-line").classList.toggle("insets", this.app.state.insets?.length > 0);
    const above = this.app.state.insets?.length ? INSETS * element("line-x").clientHeight : 8;
    const greatest = panel("line-x", around([...lists("x_max"), ...lists("x_min")]), "*X* greatest and least", (f, d, ink) => {
      f.curve(d[key], d.impactless, { colour: colour("quiet"), width: 1, dash: [4, 3] });
      f.dots(d[key], d.x_max, 1.3, ink); f.dots(d[key], d.x_min, 0.8, ink);
    }, above);
    this.insets(greatest, key);
    panel("line-v", around([...lists("impact_speed"), [0]]), `approach speed *X*′₋${this.app.state.single ? "" : " + *Y*′₋"}`, (f, d, ink) => f.dots(d.impact_step.map((s) => d[key][s]), d.impact_speed, 1, ink));
    const name = this.app.state.characteristic ?? "lyapunov", shown = CHARACTERISTICS[name];
    element("characteristic").value = name;
    element("line-l").setAttribute("aria-label", `${shown.text} along the line`);
    const values = ways.map(([, d]) => shown.of(d));
    const ends = shown.error ? ways.flatMap(([, d]) => [-1.96, 1.96].map((by) => shown.of(d).map((v, i) => v + by * shown.error(d)[i]))) : [];
    panel("line-l", shown.range ?? around([...values, ...ends, [0]]), shown.axis, (f, d, ink) => {
      if (shown.zero) f.curve(range, [0, 0], { colour: colour("quiet"), width: 1 });
      if (shown.error) f.bars(d[key], shown.of(d), shown.error(d).map((e) => 1.96 * e), ink);
      if (shown.dots) f.dots(shown.dots(d, key), shown.of(d), 1, ink);
      else f.curve(d[key], shown.of(d), { colour: ink, width: 1.1 });
    });
    const done = Math.min(...["up", "down"].map((w) => this.ways[w]?.eta.length ?? 0));
    element("line-note").textContent = `Blue: from a to b; orange: from b to a; dashed: amplitude without impacts. ${done < this.all ? `${done} of ${this.all} steps` : `${this.all} steps each way`}`;
    this.done = done === this.all && this.all > 0;
  }
}

/** Basins of attraction over the start. */
export class BasinsPanel extends Panel {
  constructor(app) {
    super(app, "basins");
    this.tile = null;
    element("basins").addEventListener("click", (event) => {
      const { frame: f } = this, { offsetX: p, offsetY: q } = event;
      if (f?.holds(p, q)) this.choose(f.ux(p), f.uy(q));
    });
  }

  /** Move the start that is chosen by a fiftieth of the picture. */
  nudge(dx, dv, event) {
    if (!this.tile) return;
    const { x, vx } = this.tile, { start } = this.app.state.cursor, by = event.shiftKey ? 0.2 : 0.02;
    const move = (v, d, [low, high]) => Math.min(high, Math.max(low, v + d * by * (high - low)));
    this.choose(move(start.x, dx, x), move(start.vx, dv, vx));
  }

  /** Start the motion there, both masses or one as the basins have it. */
  choose(x, vx) {
    const one = this.app.state.basins?.starts === "one_mass";
    this.app.start({ x, vx, y: one ? 0 : x, vy: one ? 0 : vx });
  }

  add(frame) {
    if (!this.tile || this.tile.id !== frame.id || this.tile.level !== frame.level) {
      this.below = this.tile?.id === frame.id ? this.tile : null;
      this.tile = { id: frame.id, level: frame.level, canvas: cellCanvas(...frame.size), size: frame.size, x: frame.x, vx: frame.vx, counts: new Map(), total: 0 };
    }
    const t = this.tile;
    paintCells(t.canvas, frame.cell, frame.motions.map(tint), frame.first_row);
    for (const cell of frame.cell) {
      if (cell === BEYOND) continue;
      const style = frame.motions[cell], seen = t.counts.get(style.label) ?? { style, count: 0 };
      seen.count++; t.total++; t.counts.set(style.label, seen);
    }
    t.filled = frame.first_row + frame.cell.length / t.size[0];
    this.draw();
  }

  paint() {
    if (!this.tile || element("panel-basins").hidden) return;
    const t = this.tile, f = this.frame = new Frame(element("basins"), t.x, t.vx, [`start *X*(0)${this.app.state.single ? "" : this.app.state.basins?.starts === "one_mass" ? " of X alone" : " of both masses"}`, "start *X*′(0)"]);
    f.clip((c) => {
      c.imageSmoothingEnabled = false;
      for (const tile of [this.below, t]) if (tile) c.drawImage(tile.canvas, f.box.left, f.box.top, f.box.width, f.box.height);
      const s = this.app.state.cursor.start;
      c.beginPath(); c.arc(f.px(s.x), f.py(s.vx), 5, 0, 7); c.strokeStyle = colour("ink"); c.lineWidth = 1.8; c.stroke();
    });
    f.axes();
    const shares = [...t.counts.values()].sort((a, b) => b.count - a.count).slice(0, 8);
    const share = ({ style, count }) => `${named(style)}: ${count < 5e-4 * t.total ? "< 0.1" : (100 * count / t.total).toFixed(1)} %`;
    element("basin-shares").replaceChildren(...shares.map((s) => swatch(s.style, share(s))));
    element("basins").setAttribute("aria-label", `Basins of attraction over the start, ${shares.map(share).join(", ")}. Arrow keys move the start.`);
  }
}

/** A picture that a function (context, width, height) draws, with a text. */
export function sampled(draw, text) {
  const span = make("span"), canvas = Object.assign(make("canvas"), { sample: draw });
  canvas.setAttribute("aria-hidden", "true");
  span.append(canvas, text);
  return span;
}

/** A tint, with what is drawn on it, and a text. */
export function swatch(style, text, drawn) {
  if (drawn) return sampled((c, w, h) => { c.fillStyle = `rgb(${tint(style).join(",")})`; c.fillRect(0, 0, w, h); drawn(c, w, h); }, text);
  const span = make("span"), box = make("span", undefined, "swatch");
  box.style.background = `rgb(${tint(style).join(",")})`; box.style.borderColor = markColour(style);
  span.append(box, text);
  return span;
}
