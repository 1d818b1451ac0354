// Axes, marks and colours of the report on a canvas.

/** Colours of the theme that were asked for. */
let known = { theme: null, colours: {} };

/** A colour of the theme. */
export function colour(name) {
  const { theme } = document.documentElement.dataset;
  if (known.theme !== theme) known = { theme, colours: {} };
  return known.colours[name] ??= getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();
}

export const isDark = () => document.documentElement.dataset.theme === "dark";

const channels = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));

/** A motion's colour as a line or mark: lighter on a dark page. */
export function markColour(style) {
  if (!isDark()) return style.colour;
  const [r, g, b] = channels(style.colour).map((c) => Math.round(c + 0.45 * (255 - c)));
  return `rgb(${r},${g},${b})`;
}

/** A region's tint, [r, g, b]. */
export function tint(style) {
  const light = channels(style.tint);
  if (!isDark()) return light;
  const paper = channels(colour("paper"));
  const depth = Math.min(1, 2.4 * (255 - Math.min(...light)) / 255 + 0.02);
  return channels(style.colour).map((c, i) => {
    const lighter = c + 0.25 * (255 - c);
    return Math.round(paper[i] + 0.62 * depth * (lighter - paper[i]));
  });
}

/** A canvas beside the page, of one pixel a cell. */
export const cellCanvas = (width, height) => Object.assign(document.createElement("canvas"), { width, height });

/** Paint rows of cells, the lowest first, in the tint of each; cells without one stay clear. */
export function paintCells(canvas, cells, tints, firstRow) {
  const { width, height } = canvas, rows = cells.length / width, context = canvas.getContext("2d");
  const image = context.createImageData(width, rows);
  for (let k = 0; k < rows; k++) for (let i = 0; i < width; i++) {
    const tint = tints[cells[k * width + i]], at = 4 * ((rows - 1 - k) * width + i);
    if (!tint) continue;
    const [r, g, b] = tint;
    image.data[at] = r; image.data[at + 1] = g; image.data[at + 2] = b; image.data[at + 3] = 255;
  }
  context.putImageData(image, 0, height - firstRow - rows);
}

/** A context in which nothing is drawn. */
const NOWHERE = document.createElement("canvas").getContext("2d");
/** Where a canvas is drawn instead, for files. */
let instead = null;

/** Draw one canvas into another context; `paint` draws them all. */
export function drawnInto(context, canvas, paint) {
  instead = { context, canvas };
  try { paint(); } finally { instead = null; }
}

/** Fit a canvas to its box; returns its context in CSS pixels and its size. */
export function fit(canvas) {
  if (instead) {
    const { width, height } = canvas.getBoundingClientRect();
    return { context: instead.canvas === canvas ? instead.context : NOWHERE, width: Math.max(1, width), height: Math.max(1, height) };
  }
  const ratio = window.devicePixelRatio || 1;
  const box = canvas.getBoundingClientRect();
  const [width, height] = [Math.max(1, box.width), Math.max(1, box.height)];
  const [w, h] = [Math.round(width * ratio), Math.round(height * ratio)];
  if (canvas.width !== w || canvas.height !== h) { canvas.width = w; canvas.height = h; }
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  return { context, width, height };
}

/** Round numbers within a range, about `count` of them. */
export function ticks(low, high, count) {
  const raw = (high - low) / Math.max(1, count);
  const power = 10 ** Math.floor(Math.log10(raw));
  const steps = [10, 5, 2, 1, 0.5, 0.2].map((m) => m * power), wanted = steps.findLast((s) => s >= raw * 0.999) ?? steps[0];
  const within = (step) => {
    const first = Math.ceil(low / step - 1e-9), last = Math.floor(high / step + 1e-9);
    return Array.from({ length: last - first + 1 }, (_, i) => (first + i) * step);
  };
  // one number alone is no scale
  const step = steps.find((s) => s <= wanted && within(s).length > 1) ?? wanted, all = within(step);
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  return { all, text: (v) => v.toFixed(digits).replace("-", "−") };
}

/** Below this a number is the rounding of zero. */
const DUST = 1e-12;

/** A number as text, with so many significant digits. */
export function number(v, digits = 4) {
  if (v === null || v === undefined || !Number.isFinite(v)) return "–";
  if (Math.abs(v) < DUST) return "0";
  const text = Math.abs(v) >= 1e5 || (v !== 0 && Math.abs(v) < 1e-4)
    ? v.toExponential(digits - 1) : String(Number(v.toPrecision(digits)));
  return text.replace("-", "−");
}

/** A number with its 95 % half width, both to two digits of the latter. */
export function plusMinus(v, half) {
  if (!(half > 1e-7)) return number(v, 4);
  const digits = Math.min(8, Math.max(0, 1 - Math.floor(Math.log10(half))));
  return `${v.toFixed(digits)} ± ${half.toFixed(digits)}`.replace("-", "−");
}

/** A motion by name: z = p/n, or the word for it. */
export const named = ({ label }) => (/^\d/.test(label) ? `z = ${label}` : label);

export const FONT = '"Libertinus Serif", Georgia, serif';

/** Room of the title beside the numbers of an axis, px. */
const TITLE = 26;
/** About how many numbers an axis of a length has. */
export const rows = (height) => Math.max(2.4, height / 42), columns = (width) => Math.max(2.4, width / 75);

/** A frame with axes; maps values to pixels. */
export class Frame {
  constructor(canvas, x, y, titles, margin = {}) {
    const { context, width, height } = fit(canvas);
    const m = { left: 46, right: 10, top: 8, bottom: 36, ...margin };
    Object.assign(this, { context, width, height, x, y, titles });
    // the numbers beside the box leave room for its title, and those below it have room themselves
    context.font = `13px ${FONT}`;
    const widest = ({ all, text }) => Math.max(0, ...all.map((v) => context.measureText(text(v)).width));
    const room = (scale) => TITLE + widest(ticks(...y.map((v) => v * scale), rows(height - m.top - m.bottom)));
    m.left = Math.max(m.left, room(1));
    if (m.beside) m.right = Math.max(m.right, room(m.beside));
    m.right = Math.max(m.right, widest(ticks(...x, columns(width - m.left - m.right))) / 2);
    this.box = { left: m.left, top: m.top, width: Math.max(10, width - m.left - m.right), height: Math.max(10, height - m.top - m.bottom) };
  }
  px(v) { return this.box.left + this.box.width * (v - this.x[0]) / (this.x[1] - this.x[0]); }
  py(v) { return this.box.top + this.box.height * (1 - (v - this.y[0]) / (this.y[1] - this.y[0])); }
  ux(p) { return this.x[0] + (this.x[1] - this.x[0]) * (p - this.box.left) / this.box.width; }
  uy(p) { return this.y[0] + (this.y[1] - this.y[0]) * (1 - (p - this.box.top) / this.box.height); }
  holds(p, q) { const b = this.box; return p >= b.left && p <= b.left + b.width && q >= b.top && q <= b.top + b.height; }
  clip(draw) {
    const { context: c, box: b } = this;
    c.save(); c.beginPath(); c.rect(b.left, b.top, b.width, b.height); c.clip(); draw(c); c.restore();
  }
  axes() {
    const { context: c, box: b } = this;
    c.strokeStyle = colour("frame"); c.fillStyle = colour("ink"); c.lineWidth = 1;
    c.strokeRect(b.left + 0.5, b.top + 0.5, b.width, b.height);
    c.font = `13px ${FONT}`; c.textAlign = "center"; c.textBaseline = "top";
    c.beginPath();
    const tx = ticks(...this.x, columns(b.width)), ty = ticks(...this.y, rows(b.height));
    for (const v of tx.all) {
      const p = Math.round(this.px(v)) + 0.5;
      c.moveTo(p, b.top + b.height); c.lineTo(p, b.top + b.height - 4);
      c.fillText(tx.text(v), p, b.top + b.height + 3);
    }
    c.textAlign = "right"; c.textBaseline = "middle";
    for (const v of ty.all) {
      const p = Math.round(this.py(v)) + 0.5;
      c.moveTo(b.left, p); c.lineTo(b.left + 4, p);
      c.fillText(ty.text(v), b.left - 5, p);
    }
    c.stroke();
    c.font = `14px ${FONT}`; c.textAlign = "center"; c.textBaseline = "alphabetic";
    // as long as the picture at most
    const [across, down] = [b.left + b.width / 2, b.top + b.height / 2], room = (at, size) => 2 * Math.min(at, size - at) - 4;
    rich(c, this.titles[0], across, this.height - 5, room(across, this.width));
    c.save(); c.translate(12, down); c.rotate(-Math.PI / 2);
    rich(c, this.titles[1], 0, 0, room(down, this.height)); c.restore();
    return this;
  }
  /** Names of what is drawn, [text, colour], in a row above the box. */
  key(entries) {
    const { context: c, box: b } = this;
    let at = b.left;
    c.textAlign = "left"; c.textBaseline = "alphabetic"; c.font = `14px ${FONT}`;
    for (const [text, paint] of entries) {
      if (paint) { c.beginPath(); c.moveTo(at, b.top - 10); c.lineTo(at + 18, b.top - 10); c.strokeStyle = paint; c.lineWidth = 2; c.stroke(); at += 23; }
      c.fillStyle = colour("ink");
      at += rich(c, text, at, b.top - 6) + 16;
    }
  }
  curve(xs, ys, style = {}) {
    const { context: c } = this;
    c.beginPath();
    let pen = false;
    for (let i = 0; i < xs.length; i++) {
      const [x, y] = [xs[i], ys[i]];
      if (!Number.isFinite(x) || !Number.isFinite(y) || style.skip?.(i)) { pen = false; continue; }
      const p = this.px(x), q = Math.max(-1e4, Math.min(1e4, this.py(y)));
      if (pen) c.lineTo(p, q); else c.moveTo(p, q);
      pen = true;
    }
    c.strokeStyle = style.colour ?? colour("ink"); c.lineWidth = style.width ?? 1.4;
    c.setLineDash(style.dash ?? []); c.globalAlpha = style.alpha ?? 1; c.lineJoin = "round";
    c.stroke(); c.setLineDash([]); c.globalAlpha = 1;
  }
  /** Half widths as thin bars. */
  bars(xs, ys, halves, paint) {
    const { context: c } = this;
    c.beginPath(); c.strokeStyle = paint; c.lineWidth = 0.7; c.globalAlpha = 0.5;
    for (let i = 0; i < xs.length; i++) {
      if (!Number.isFinite(ys[i]) || !(halves[i] > 0)) continue;
      c.moveTo(this.px(xs[i]), this.py(ys[i] - halves[i])); c.lineTo(this.px(xs[i]), this.py(ys[i] + halves[i]));
    }
    c.stroke(); c.globalAlpha = 1;
  }
  dots(xs, ys, radius, fill) {
    const { context: c } = this;
    c.fillStyle = fill;
    for (let i = 0; i < xs.length; i++) {
      if (!Number.isFinite(ys[i])) continue;
      c.fillRect(this.px(xs[i]) - radius, this.py(ys[i]) - radius, 2 * radius, 2 * radius);
    }
  }
}

/** Text in which *symbols* are slanted, smaller where it has no room. */
export function rich(c, text, x, y, room = Infinity) {
  const wanted = Number(c.font.match(/(\d+(\.\d+)?)px/)[1]);
  const styled = (size) => text.split("*").map((t, i) => [t, `${i % 2 ? "italic " : ""}${size}px ${FONT}`]);
  const long = (parts) => parts.reduce((sum, [t, font]) => { c.font = font; return sum + c.measureText(t).width; }, 0);
  const size = Math.max(9, wanted * Math.min(1, room / long(styled(wanted))));
  const parts = styled(size), width = long(parts);
  const align = c.textAlign;
  let at = align === "center" ? x - width / 2 : align === "right" ? x - width : x;
  c.textAlign = "left";
  for (const [t, font] of parts) { c.font = font; c.fillText(t, at, y); at += c.measureText(t).width; }
  c.textAlign = align; c.font = `${wanted}px ${FONT}`;
  return width;
}

/** Values below this are all 0 in a picture. */
const NOTHING = 1e-9;

/** The range of values with a margin. */
export function around(lists, margin = 0.06) {
  let [low, high] = [Infinity, -Infinity];
  for (const list of lists) for (const v of list) if (Number.isFinite(v)) { if (v < low) low = v; if (v > high) high = v; }
  if (low > high) return [0, 1];
  if (Math.max(Math.abs(low), Math.abs(high)) < NOTHING) return [-1, 1];
  // a constant is a line in the middle, and its ticks need few digits
  const spread = Math.max(high - low, 0.02 * Math.max(Math.abs(high), Math.abs(low))), room = margin * spread + (spread - (high - low)) / 2;
  return [low - room, high + room];
}

const turned = (n, r, start) => Array.from({ length: n }, (_, i) => {
  const a = (start + 360 * i / n) * Math.PI / 180;
  return [r * Math.cos(a), -r * Math.sin(a)];
});

/** A motion's mark, as in the report. */
export function mark(c, x, y, r, style, faint = false) {
  const stroke = markColour(style), paper = colour("paper");
  c.globalAlpha = faint ? 0.35 : 1;
  const disc = (radius, fill) => { c.beginPath(); c.arc(x, y, radius, 0, 7); c.fillStyle = fill; c.fill(); };
  const poly = (points, filled) => {
    c.beginPath();
    points.forEach(([dx, dy], i) => (i ? c.lineTo(x + dx, y + dy) : c.moveTo(x + dx, y + dy)));
    c.closePath(); c.fillStyle = filled ? stroke : paper; c.fill();
    c.lineWidth = filled ? 0.6 : 1.6; c.strokeStyle = filled ? paper : stroke; c.stroke();
  };
  const cross = (turn) => {
    c.lineWidth = 0.42 * r; c.strokeStyle = stroke;
    for (const q of [0, 90]) {
      const a = (turn + q) * Math.PI / 180, dx = r * Math.cos(a), dy = r * Math.sin(a);
      c.beginPath(); c.moveTo(x - dx, y - dy); c.lineTo(x + dx, y + dy); c.stroke();
    }
  };
  const shapes = {
    circle: () => { disc(r, paper); c.beginPath(); c.arc(x, y, 0.85 * r, 0, 7); c.lineWidth = 1.6; c.strokeStyle = stroke; c.stroke(); },
    disc: () => disc(r, stroke), target: () => { disc(r, stroke); disc(0.42 * r, paper); }, dot: () => disc(0.55 * r, stroke),
    square: () => poly(turned(4, 1.15 * r, 45), true), box: () => poly(turned(4, 1.1 * r, 45), false),
    triangle: () => poly(turned(3, 1.3 * r, 90), true), delta: () => poly(turned(3, 1.2 * r, 90), false),
    wedge: () => poly(turned(3, 1.3 * r, -90), true), diamond: () => poly(turned(4, 1.3 * r, 0), true),
    lozenge: () => poly(turned(4, 1.2 * r, 0), false),
    star: () => poly(Array.from({ length: 10 }, (_, i) => turned(10, i % 2 ? 0.63 * r : 1.4 * r, 90)[i]), true),
    plus: () => cross(0), cross: () => cross(45),
    bar: () => { c.fillStyle = stroke; c.fillRect(x - r, y - 0.3 * r, 2 * r, 0.6 * r); },
  };
  (shapes[style.shape] ?? shapes.dot)();
  c.globalAlpha = 1;
}
