// The (η, ρ) map: tiles, boundaries, records, brackets, bands, cursor, line.
import { Frame, cellCanvas, colour, markColour, named, paintCells, rich, rows, ticks, tint, FONT } from "./draw.js";

const KINDS = {
  s2: { text: "saddle-node *s*₂", colour: "ink", width: 1.6 },
  s1: { text: "period doubling *s*₁", colour: "mark", width: 1.5, dash: [7, 3] },
  grazing: { text: "grazing *ρ*′", colour: "blue", width: 1.8 },
  sticking: { text: "stay together *ρ*ₚ", colour: "quiet", width: 2 },
};

/** Time within which a map comes at once, ms. */
const AT_ONCE = 150;
/** Opacity of a map that another one is replacing. */
const FAINT = 0.2;
/** A cell that is not computed yet. */
const EMPTY = 0xffffffff;

/** How far a finger, or the end of a line, moves before it has moved, px. */
const FINGER = 6;
/** Distance of the stripes where motions coexist, px. */
const STRIPES = 7;
/** Height of a strip above the map, with its gap, px. */
export const STRIP = 22;
/** Names of boundaries on the map. */
const NAMES = { s2: "s₂", s1: "s₁", grazing: "ρ′", sticking: "ρₚ" };
/** How far beside a boundary its name is where it has no place on it, px. */
const BESIDE = 13;
/** Least length of a boundary that is named, px. */
const ROOM_OF_A_NAME = 45;
/** Side of the squares by which names find their room, px. */
const GRAIN = 3;
/** Places along a name at which it is looked whether it lies in its region, over half its width; and how many must. */
const LETTERS = [-1, -0.75, -0.5, -0.25, 0, 0.25, 0.5, 0.75, 1];
const MOST_LETTERS = 0.85;
/** Places of a region that are tried for its name. */
const MOST_PLACES = 400;

/** The map's canvases, from below: only that which changes is drawn again. */
const LAYERS = { tiles: "map-tiles", lines: "map", cursor: "map-cursor" };

export class MapView {
  constructor(app) {
    this.layers = Object.fromEntries(Object.entries(LAYERS).map(([name, id]) => [name, document.getElementById(id)]));
    this.canvas = this.layers.lines;
    this.app = app;
    this.tiles = [];        // { level, eta, rho, size, image, styles, known, cells, id }
    this.curves = {};       // "s2:1" → { eta, rho, exists }
    this.styles = new Map(); // label → style, of what is in view
    this.due = new Set();    // layers to be drawn
    this.drawn = false;      // whether something was, for the next picture of the screen
    this.regions = [];       // of what is in view, with places for their names
    this.finished = 0;       // id of the newest request whose map came to its end
    this.late = false;       // whether what is wanted has not come yet: what is older is faint
    this.unnamed = false;    // whether names and legend are those of a map before: hidden and faint
    this.waiting = {};       // timers after which a map is late or unnamed
    this.theme = "";
    this.pointer();
    new ResizeObserver(() => this.redraw()).observe(this.canvas);
  }

  /** Draw layers, all of them where none is named: at once where nothing was drawn for the next picture of the
   * screen, else again with that picture, so that what comes in quick succession is drawn twice at most. */
  redraw(...layers) {
    for (const layer of layers.length ? layers : Object.keys(LAYERS)) this.due.add(layer);
    if (this.drawn) return;
    this.drawn = true;
    this.draw();
    requestAnimationFrame(() => { this.drawn = false; this.draw(); });
  }

  /** Another map was asked for: what is shown is that of another machine or view, and faint unless one that is wanted
   * comes at once, however many are asked for until then. */
  asked() {
    for (const what of ["late", "unnamed"]) if (!this[what]) this.waiting[what] ??= setTimeout(() => this.mark(what, true), AT_ONCE);
  }

  /** Say whether cells are `late`, or names and legend `unnamed`, which follow only with the second level of a map. */
  mark(what, is) {
    clearTimeout(this.waiting[what]);
    this.waiting[what] = undefined;
    if (this[what] === is) return;
    this[what] = is;
    document.getElementById("legend").classList.toggle("late", this.unnamed);
    this.redraw("tiles", "lines");
  }

  /** A strip of motions that coexist with those of the map's cells. */
  coexisting(frame) {
    const [columns, rows] = frame.size, known = this.cells128;
    if (known?.id !== frame.id) return;
    if (frame.first_row === 0) this.building = { id: frame.id, size: frame.size, eta: frame.eta, rho: frame.rho, styles: [], known: new Map(), cells: new Uint32Array(columns * rows), canvas: cellCanvas(columns, rows) };
    const b = this.building, c = b.canvas.getContext("2d"), first = frame.first_row * columns;
    frame.cell.forEach((cell, i) => {
      const at = first + i, here = known.styles[known.cells[at]], there = frame.motions[cell], both = here.label === there.label ? here.label : `${here.label} · ${there.label}`;
      if (!b.known.has(both)) b.known.set(both, b.styles.push({ ...here, label: both }) - 1);
      b.cells[at] = b.known.get(both);
      if (here.label === there.label) return;
      c.fillStyle = markColour(there); c.fillRect(at % columns, rows - 1 - Math.floor(at / columns), 1, 1);
    });
    if (first + frame.cell.length < b.cells.length) return;
    this.other = b;
    this.regions = regions(b);
    this.app.legend();
    this.redraw("tiles", "lines");
  }

  /** The motion at a place by name, and the one that coexists with it. */
  named(eta, rho) {
    const label = (t) => {
      const at = (v, [a, b], n) => Math.min(n - 1, Math.max(0, Math.round((v - a) / (b - a) * (n - 1))));
      return t.styles[t.cells[at(rho, t.rho, t.size[1]) * t.size[0] + at(eta, t.eta, t.size[0])]]?.label;
    };
    const { other } = this, tile = this.tiles.at(-1);
    if (!tile || this.isOld(tile)) return "";
    const both = other?.id === tile.id ? label(other) : label(tile);
    const names = (both ?? "").split(" · ").filter(Boolean).map((l) => named({ label: l }));
    return names.length > 1 ? `${names.join(" and ")} coexist` : names[0] ?? "";
  }

  /** Stripes in the colour of the motion that coexists with that of the cells. */
  hatching(f, c) {
    const { other } = this;
    if (!other || this.late || other.id !== this.app.wire.newest.map) return;
    const [x0, y0] = [f.px(other.eta[0]), f.py(other.rho[1])], [w, h] = [f.px(other.eta[1]) - x0, f.py(other.rho[0]) - y0];
    const stripes = cellCanvas(Math.max(1, w), Math.max(1, h)), s = stripes.getContext("2d");
    s.imageSmoothingEnabled = false;
    s.drawImage(other.canvas, 0, 0, w, h);
    s.globalCompositeOperation = "destination-in";
    s.lineWidth = 1; s.beginPath();
    for (let x = -h; x < w; x += STRIPES) { s.moveTo(x, h); s.lineTo(x + h, 0); }
    s.stroke();
    c.globalAlpha = 0.55; c.drawImage(stripes, x0, y0, w, h); c.globalAlpha = 1;
  }

  /** A strip of a tile. */
  tile(frame) {
    let tile = this.tiles.find((t) => t.id === frame.id && t.level === frame.level);
    if (!tile) {
      const [columns, rows] = frame.size;
      tile = { id: frame.id, level: frame.level, eta: frame.eta, rho: frame.rho, size: frame.size, canvas: cellCanvas(columns, rows), styles: [], known: new Map(), cells: new Uint32Array(columns * rows).fill(EMPTY), filled: 0 };
      // what is older stays below until the first strip of the new one is there
      this.tiles = this.tiles.filter((t) => t.id === frame.id || t.level <= 1).slice(-3);
      this.tiles.push(tile);
    }
    const index = frame.motions.map((style) => {
      if (!tile.known.has(style.label)) tile.known.set(style.label, tile.styles.push(style) - 1);
      return tile.known.get(style.label);
    });
    const first = frame.first_row * tile.size[0];
    for (let i = 0; i < frame.cell.length; i++) tile.cells[first + i] = index[frame.cell[i]];
    this.paint(tile, frame.first_row, frame.cell.length / tile.size[0]);
    tile.filled += frame.cell.length;
    tile.complete = tile.filled >= tile.cells.length;
    // never the cells of two machines side by side
    this.mark("late", !tile.complete && this.tiles.some((t) => t.id !== tile.id));
    if (tile.complete) {
      this.tiles = this.tiles.filter((t) => t === tile || (t.id === tile.id && t.level > tile.level));
      if (tile.level === 1) { this.regions = regions(tile); this.cells128 = tile; this.mark("unnamed", false); }
      if (tile.level >= 1) this.app.legend(commonest(tile));
    }
    if (frame.last) this.finished = frame.id;
    const labelled = tile.complete && tile.level === 1;
    this.redraw("tiles", ...(labelled ? ["lines"] : []));
    return tile;
  }

  /** Paint rows of a tile. */
  paint(tile, firstRow, count) {
    const [columns] = tile.size;
    paintCells(tile.canvas, tile.cells.subarray(firstRow * columns, (firstRow + count) * columns), tile.styles.map(tint), firstRow);
  }

  /** All boundaries, bare: where they exist is taken from those before until it is known. */
  bare(frame) {
    const eta = frame.column.eta;
    for (const [name, rho] of Object.entries(frame.column)) {
      if (name === "eta" || rho.length === 0) continue;
      const before = this.curves[name], same = before?.eta.length === eta.length && before.eta[0] === eta[0] && before.eta.at(-1) === eta.at(-1);
      const always = name === "grazing" || name === "sticking";
      this.curves[name] = { eta, rho, exists: same ? before.exists : null, bare: !always };
    }
    for (const name of Object.keys(this.curves)) {
      if (!(name in frame.column) || frame.column[name].length === 0) this.curves[name].stale = true;
    }
    this.listKinds();
  }

  /** One boundary with where it exists. */
  boundary(frame) {
    this.curves[frame.name] = { eta: frame.column.eta, rho: frame.column.rho, exists: frame.column.exists, bare: false };
    this.listKinds();
  }

  /** Draw the boundaries, and list their kinds where others are in view. */
  listKinds() {
    const kinds = this.kinds().map((k) => k.text).join();
    if (this.listed !== kinds) { this.listed = kinds; this.app.legend(); }
    this.redraw("lines");
  }

  draw() {
    const { app, due } = this;
    if (!app.state || due.size === 0) return;
    if (this.theme !== document.documentElement.dataset.theme) {
      this.theme = document.documentElement.dataset.theme;
      for (const t of this.tiles) this.paint(t, 0, t.size[1]);
    }
    for (const layer of due) this[layer + "Layer"](this.frameOf(this.layers[layer]));
    due.clear();
  }

  frameOf(canvas) {
    const { state } = this.app, scale = this.app.scale();
    const titles = ["frequency ratio *η* = *ω*/*Ω*", "clearance ratio *ρ* = *r*/*x*ₛₜ"];
    const margin = { left: 50, right: scale ? 50 : 10, top: (scale ? 40 : 8) + STRIP * (this.app.campaign?.facts.strips_m.length ?? 0), beside: scale && 1e3 * scale.static_deflection_m };
    return new Frame(canvas, state.view.eta, state.view.rho, titles, margin);
  }

  /** Whether a tile is of another map than the one that is late. */
  isOld(tile) { return this.late && tile.id !== this.app.wire.newest.map; }

  tilesLayer(f) {
    f.clip((c) => {
      c.imageSmoothingEnabled = false;
      for (const t of this.tiles) {
        const dx = (t.eta[1] - t.eta[0]) / (t.size[0] - 1) / 2, dy = (t.rho[1] - t.rho[0]) / (t.size[1] - 1) / 2;
        const [x0, x1] = [f.px(t.eta[0] - dx), f.px(t.eta[1] + dx)], [y0, y1] = [f.py(t.rho[1] + dy), f.py(t.rho[0] - dy)];
        c.globalAlpha = this.isOld(t) ? FAINT : 1;
        c.drawImage(t.canvas, x0, y0, x1 - x0, y1 - y0);
      }
      c.globalAlpha = 1;
      this.hatching(f, c);
    });
  }

  linesLayer(f) {
    this.frame = f;
    const { app } = this, scale = app.scale();
    f.clip((c) => {
      this.bands(f, c);
      this.boundaries(f);
      if (app.campaign) app.campaign.draw(f, c);
      this.writeNames(f, c);
    });
    f.axes();
    app.campaign?.strips(f);
    if (scale) this.rigAxes(f, scale);
  }

  cursorLayer(f) {
    f.clip((c) => { this.line(f, c); this.cursor(f, c); });
  }

  bands(f, c) {
    for (const curve of this.app.campaign?.facts.curves ?? []) {
      if (curve.band.length < 2) continue;
      c.beginPath();
      curve.band.forEach(([e, lo], i) => (i ? c.lineTo(f.px(e), f.py(lo)) : c.moveTo(f.px(e), f.py(lo))));
      [...curve.band].reverse().forEach(([e, , hi]) => c.lineTo(f.px(e), f.py(hi)));
      c.closePath(); c.fillStyle = colour("band"); c.globalAlpha = 0.75; c.fill();
      // a band thinner than a line is seen as one
      c.lineWidth = 4; c.strokeStyle = colour("band"); c.stroke(); c.globalAlpha = 1;
    }
  }

  boundaries(f) {
    const c = f.context;
    for (const [name, curve] of Object.entries(this.curves)) {
      if (curve.stale) continue;
      const [kind, n] = name.split(":");
      const style = KINDS[kind], width = style.width * (n > 1 ? 0.75 : 1);
      const line = { colour: colour(style.colour), width, dash: style.dash };
      if (curve.exists) {
        f.curve(curve.eta, curve.rho, { ...line, skip: (i) => !(curve.exists[i] > 0) });
        f.curve(curve.eta, curve.rho, { ...line, width: 0.8, alpha: 0.25, dash: [2, 3], skip: (i) => curve.exists[i] > 0 && curve.exists[i + 1] > 0 });
      } else {
        f.curve(curve.eta, curve.rho, { ...line, alpha: curve.bare ? 0.45 : 1 });
      }
    }
  }

  /** Names of boundaries and regions, beside what the campaign has there; one without a place is left to the legend. */
  writeNames(f, c) {
    const room = new Room(f.box);
    for (const box of this.app.campaign?.boxes(f) ?? []) if (f.holds(box[0], box[1])) room.take(...box);
    this.names = Object.entries(this.curves).flatMap(([name, curve]) => this.boundaryName(f, name, curve, room));
    this.labels = this.unnamed ? [] : this.regions.flatMap((region) => this.regionName(f, region, room));
    c.textAlign = "center"; c.textBaseline = "middle"; c.strokeStyle = colour("paper");
    for (const { text, x, y, font, paint, halo, alpha } of [...this.names, ...this.labels]) {
      c.font = font; c.lineWidth = halo; c.globalAlpha = alpha;
      c.strokeText(text, x, y); c.globalAlpha = 1;
      c.fillStyle = paint; c.fillText(text, x, y);
    }
  }

  /** A boundary's name on the longest stretch on which a stable motion ends: near its middle, on it or beside it. */
  boundaryName(f, name, { eta, rho, exists, stale }, room) {
    const [kind, n] = name.split(":");
    if (stale || (n && !exists)) return [];
    let best = [0, 0];
    for (let i = 0, from = 0; i <= eta.length; i++) {
      if (i < eta.length && (!n || exists[i] > 0) && f.holds(f.px(eta[i]), f.py(rho[i]))) continue;
      if (i - from > best[1] - best[0]) best = [from, i];
      from = i + 1;
    }
    const [from, end] = best, middle = (from + end) / 2;
    if (!(f.px(eta[end - 1] ?? 0) - f.px(eta[from]) > ROOM_OF_A_NAME)) return [];
    const outwards = Array.from({ length: end - from }, (_, i) => from + i).sort((i, k) => Math.abs(i - middle) - Math.abs(k - middle));
    const beside = [0, -BESIDE, BESIDE].flatMap((by) => outwards.map((i) => [f.px(eta[i]), f.py(rho[i]) + by]));
    const text = NAMES[kind] + (n ? `(${n === "1" ? "1" : `1/${n}`})` : "");
    return room.name(f, beside, text, { font: `13px ${FONT}`, size: 13, paint: colour(KINDS[kind].colour), halo: 4, alpha: 1 });
  }

  /** A region's name as large as the region allows, or small, as far inside as there is room. */
  regionName(f, { places, text, share, holds }, room) {
    const largest = Math.round(13 + 14 * Math.min(1, Math.sqrt(share) * 2.2)), at = places.map(([eta, rho]) => [f.px(eta), f.py(rho)]);
    const within = (x, y, wide) => LETTERS.filter((k) => holds(f.ux(x + k * wide), f.uy(y))).length > MOST_LETTERS * LETTERS.length;
    for (const size of new Set([largest, 13, 11])) {
      const found = room.name(f, at, text, { within, font: `bold ${size}px ${FONT}`, size, paint: colour("ink"), halo: 3, alpha: 0.75 });
      if (found.length) return found;
    }
    return [];
  }

  line(f, c) {
    const { line } = this.app.state;
    if (!line || (this.app.state.panel !== "line" && !this.drawing)) return;
    const ends = [0, 1].map((i) => [f.px(line.eta[i]), f.py(line.rho[i])]);
    c.beginPath(); c.moveTo(...ends[0]); c.lineTo(...ends[1]);
    c.lineWidth = 2.2; c.strokeStyle = colour("green"); c.stroke();
    c.fillStyle = colour("green"); c.font = `bold 15px ${FONT}`;
    ends.forEach(([x, y], i) => { c.beginPath(); c.arc(x, y, 4, 0, 7); c.fill(); c.fillText("ab"[i], x + (x > f.box.left + f.box.width - 20 ? -16 : 9), y - 8 < f.box.top + 12 ? y + 18 : y - 8); });
  }

  cursor(f, c) {
    const { eta, rho } = this.app.state.cursor;
    const [x, y] = [f.px(eta), f.py(rho)], b = f.box;
    c.strokeStyle = colour("ink"); c.lineWidth = 1; c.globalAlpha = 0.55; c.setLineDash([3, 3]);
    c.beginPath(); c.moveTo(x, b.top); c.lineTo(x, b.top + b.height); c.moveTo(b.left, y); c.lineTo(b.left + b.width, y); c.stroke();
    c.setLineDash([]); c.globalAlpha = 1;
    c.beginPath(); c.arc(x, y, 7, 0, 7); c.lineWidth = 3.4; c.strokeStyle = colour("paper"); c.stroke();
    c.lineWidth = 1.8; c.strokeStyle = colour("ink"); c.stroke();
  }

  /** Frequency in Hz above, clearance in mm on the right. */
  rigAxes(f, scale) {
    const { context: c, box: b } = f, hz = scale.natural_frequency_hz, mm = 1e3 * scale.static_deflection_m;
    const across = ticks(...f.x.map((v) => v * hz), b.width / 80), up = ticks(...f.y.map((v) => v * mm), rows(b.height));
    c.fillStyle = colour("ink"); c.strokeStyle = colour("frame"); c.font = `13px ${FONT}`;
    c.textAlign = "center"; c.textBaseline = "alphabetic"; c.beginPath(); c.lineWidth = 1;
    const top = b.top - STRIP * (this.app.campaign?.far.length ?? 0);
    for (const v of across.all) { const p = Math.round(f.px(v / hz)) + 0.5; c.moveTo(p, top); c.lineTo(p, top + 4); c.fillText(across.text(v), p, top - 4); }
    c.textAlign = "left"; c.textBaseline = "middle";
    for (const v of up.all) { const p = Math.round(f.py(v / mm)) + 0.5; c.moveTo(b.left + b.width, p); c.lineTo(b.left + b.width - 4, p); c.fillText(up.text(v), b.left + b.width + 4, p); }
    c.stroke(); c.textAlign = "center"; c.textBaseline = "alphabetic"; c.font = `14px ${FONT}`;
    rich(c, "drive frequency, Hz", b.left + b.width / 2, top - 22);
    c.save(); c.translate(f.width - 6, b.top + b.height / 2); c.rotate(-Math.PI / 2); rich(c, "clearance *r*, mm", 0, 0); c.restore();
  }

  // ---- the pointer -------------------------------------------------------
  pointer() {
    const { canvas, app } = this;
    let mode = null, from = null, view = null, rests = false;
    const isThere = ({ offsetX: p, offsetY: q }) => Math.hypot(p - from[0], q - from[1]) <= FINGER;
    canvas.addEventListener("pointerdown", (event) => {
      // two fingers zoom the page
      if (!event.isPrimary) mode = null;
      if (!this.frame || !event.isPrimary) return;
      const { offsetX: p, offsetY: q } = event;
      const record = app.campaign?.near(this.frame, p, q);
      if (!record && !this.frame.holds(p, q)) return;
      canvas.focus(); canvas.setPointerCapture(event.pointerId);
      from = [p, q]; view = app.state.view;
      if (this.drawing) mode = "line";
      else if (event.button === 2 || event.button === 1 || event.shiftKey) mode = "pan";
      else if (record) { mode = null; app.choose(record); return; }
      else mode = "cursor";
      // a finger may be the first of two: it counts once it moves or leaves
      rests = mode === "line" || event.pointerType === "touch";
      if (!rests) this.moved(mode, p, q, from, view);
    });
    canvas.addEventListener("pointermove", (event) => {
      const { offsetX: p, offsetY: q } = event;
      rests &&= !mode || isThere(event);
      if (mode && !rests) this.moved(mode, p, q, from, view);
      else if (this.frame) canvas.title = app.campaign?.near(this.frame, p, q)?.id ?? (this.frame.holds(p, q) ? this.named(this.frame.ux(p), this.frame.uy(q)) : "");
    });
    canvas.addEventListener("pointerup", (event) => {
      if (mode && mode !== "line" && rests) this.moved(mode, ...from, from, view);
      if (mode === "line" && !rests) { this.drawing = false; app.panel("line"); app.said("characteristics along the line"); }
      mode = null;
    });
    canvas.addEventListener("pointercancel", () => { mode = null; });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      if (!this.frame) return;
      const { offsetX: p, offsetY: q } = event;
      app.zoom(Math.exp(0.0015 * event.deltaY), this.frame.ux(p), this.frame.uy(q));
    }, { passive: false });
  }

  moved(mode, p, q, from, view) {
    const f = this.frame, { app } = this;
    const b = f.box, inside = [Math.min(Math.max(p, b.left), b.left + b.width), Math.min(Math.max(q, b.top), b.top + b.height)];
    const at = [f.ux(inside[0]), f.uy(inside[1])];
    if (mode === "cursor") app.carry(at[0], at[1]);
    else if (mode === "line") {
      app.set({ line: { eta: [f.ux(from[0]), at[0]], rho: [f.uy(from[1]), at[1]], steps: app.state.line?.steps ?? 200 } }, []);
    } else if (mode === "pan") {
      const de = (f.x[1] - f.x[0]) * (p - from[0]) / b.width, dr = (f.y[1] - f.y[0]) * (q - from[1]) / b.height;
      app.look([view.eta[0] - de, view.eta[1] - de], [view.rho[0] + dr, view.rho[1] + dr]);
    }
  }

  /** The kinds of boundaries that are in view, for the legend. */
  kinds() {
    const { view } = this.app.state, meets = (list, i, [low, high]) => Math.min(list[i - 1], list[i]) <= high && Math.max(list[i - 1], list[i]) >= low;
    const inView = ({ eta, rho, stale }) => !stale && eta.some((_, i) => i > 0 && meets(eta, i, view.eta) && meets(rho, i, view.rho));
    const seen = new Set(Object.entries(this.curves).filter(([, c]) => inView(c)).map(([k]) => k.split(":")[0]));
    return Object.entries(KINDS).filter(([k]) => seen.has(k)).map(([, style]) => style);
  }
}

/** The motions that take most of a tile. */
function commonest(tile) {
  const counts = new Uint32Array(tile.styles.length);
  for (const cell of tile.cells) counts[cell]++;
  const order = tile.styles.map((_, i) => i).sort((a, b) => counts[b] - counts[a]);
  return order.slice(0, 9).filter((i) => counts[i] > 2e-4 * tile.cells.length).map((i) => tile.styles[i]);
}

/** The large connected regions of a tile, with places from their innermost outwards. */
function regions(tile) {
  const [w, h] = tile.size, seen = new Int32Array(w * h).fill(-1), found = [];
  const stack = [];
  for (let start = 0; start < w * h; start++) {
    if (seen[start] >= 0) continue;
    const label = tile.cells[start], members = [];
    stack.push(start); seen[start] = start;
    while (stack.length) {
      const at = stack.pop(), x = at % w;
      members.push(at);
      for (const next of [x > 0 ? at - 1 : -1, x < w - 1 ? at + 1 : -1, at - w, at + w]) {
        if (next >= 0 && next < w * h && seen[next] < 0 && tile.cells[next] === label) { seen[next] = start; stack.push(next); }
      }
    }
    const share = members.length / (w * h);
    if (share < 0.006) continue;
    const depth = depths(members.sort((a, b) => a - b), (x, y) => x >= 0 && y >= 0 && x < w && y < h && seen[y * w + x] === start, w, h);
    const inner = members.filter((at) => depth[at] >= 3).sort((a, b) => depth[b] - depth[a]), step = Math.ceil(inner.length / MOST_PLACES);
    const value = ([low, high], i, count) => low + (high - low) * i / (count - 1);
    const places = inner.filter((_, i) => i % step === 0).map((at) => [value(tile.eta, at % w, w), value(tile.rho, Math.floor(at / w), h)]);
    const index = (v, [low, high], count) => Math.round((v - low) / (high - low) * (count - 1));
    const holds = (eta, rho) => seen[index(rho, tile.rho, h) * w + index(eta, tile.eta, w)] === start;
    found.push({ places, text: tile.styles[label].label, share, holds });
  }
  return found.sort((a, b) => b.share - a.share);
}

/** How far each of the members, which are sorted, is from the edge of what is inside. */
function depths(members, inside, w, h) {
  const depth = new Int16Array(w * h);
  const relax = (at, dx, dy) => {
    const x = at % w, y = (at - x) / w, look = (a, b) => (inside(x + a, y + b) ? depth[(y + b) * w + x + a] : 0);
    return Math.min(look(dx, 0), look(0, dy), look(dx, dy), look(-dx, dy)) + 1;
  };
  for (const at of members) depth[at] = relax(at, -1, -1);
  for (const at of [...members].reverse()) depth[at] = Math.min(depth[at], relax(at, 1, 1));
  return depth;
}

/** What marks and names have taken of a picture's box, in squares. */
class Room {
  constructor({ left, top, width, height }) {
    Object.assign(this, { left, top, columns: Math.ceil(width / GRAIN), rows: Math.ceil(height / GRAIN) });
    this.taken = new Uint8Array(this.columns * this.rows);
  }

  /** The squares under a box about a place: their columns and rows. */
  squares(x, y, wide, high) {
    const at = (v, from, count) => Math.min(count - 1, Math.max(0, Math.floor((v - from) / GRAIN)));
    const [left, right] = [x - wide, x + wide].map((v) => at(v, this.left, this.columns));
    const [top, bottom] = [y - high, y + high].map((v) => at(v, this.top, this.rows));
    return { left, right, top, bottom };
  }

  take(...box) {
    const { left, right, top, bottom } = this.squares(...box);
    for (let row = top; row <= bottom; row++) this.taken.fill(1, row * this.columns + left, row * this.columns + right + 1);
  }

  isFree(...box) {
    const { left, right, top, bottom } = this.squares(...box);
    for (let row = top; row <= bottom; row++) for (let i = left; i <= right; i++) if (this.taken[row * this.columns + i]) return false;
    return true;
  }

  /** A name at the first of some places at which it is free, moved into the box; it is taken then. */
  name({ context: c, box }, places, text, style) {
    c.font = style.font;
    const wide = c.measureText(text).width / 2 + 2, high = style.size / 2 + 1;
    const inside = (v, from, length, half) => Math.max(from + half, Math.min(from + length - half, v));
    for (const place of places) {
      const x = inside(place[0], box.left, box.width, wide), y = inside(place[1], box.top, box.height, high);
      if (!this.isFree(x, y, wide, high) || style.within?.(x, y, wide) === false) continue;
      this.take(x, y, wide, high);
      return [{ text, x, y, ...style }];
    }
    return [];
  }
}
