// A drawing context that writes SVG: the pictures' own code draws into it.

const escape = (text) => String(text).replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`);
const short = (v) => String(Math.round(v * 100) / 100);
/** Of texts: how far below a place the baseline lies, in their size. */
const BASELINES = { alphabetic: 0, top: 0.8, middle: 0.32, bottom: -0.2 };
const ANCHORS = { left: "start", center: "middle", right: "end" };

/** What the page's pictures use of a canvas' context. */
export class SvgContext {
  constructor() {
    this.parts = [];
    this.clips = 0;
    this.measure = document.createElement("canvas").getContext("2d");
    this.state = { fillStyle: "#000", strokeStyle: "#000", lineWidth: 1, globalAlpha: 1, font: "10px serif", textAlign: "left", textBaseline: "alphabetic", lineJoin: "miter", dash: [], groups: 0 };
    this.stack = [];
    this.path = "";
    for (const key of Object.keys(this.state)) Object.defineProperty(this, key, { get: () => this.state[key], set: (v) => { this.state[key] = v; } });
  }

  /** All that was drawn, as a document of a size. */
  document(width, height) {
    const holder = document.createElement("template");
    holder.innerHTML = `<svg width="${short(width)}" height="${short(height)}" viewBox="0 0 ${short(width)} ${short(height)}">${this.parts.join("\n")}</svg>`;
    return new XMLSerializer().serializeToString(holder.content.firstChild);
  }

  save() { this.stack.push(this.state); this.state = { ...this.state, groups: 0 }; }
  restore() { this.parts.push("</g>".repeat(this.state.groups)); this.state = this.stack.pop(); }
  group(attributes) { this.parts.push(`<g ${attributes}>`); this.state.groups++; }
  translate(x, y) { this.group(`transform="translate(${short(x)} ${short(y)})"`); }
  rotate(angle) { this.group(`transform="rotate(${short(angle * 180 / Math.PI)})"`); }
  clip() {
    const id = `clip${++this.clips}`;
    this.parts.push(`<clipPath id="${id}"><path d="${this.path}"/></clipPath>`);
    this.group(`clip-path="url(#${id})"`);
  }

  beginPath() { this.path = ""; }
  moveTo(x, y) { this.path += `M${short(x)} ${short(y)}`; }
  lineTo(x, y) { this.path += `${this.path ? "L" : "M"}${short(x)} ${short(y)}`; }
  closePath() { this.path += "Z"; }
  rect(x, y, w, h) { this.path += `M${short(x)} ${short(y)}h${short(w)}v${short(h)}h${short(-w)}Z`; }
  /** Whole circles alone: the pictures draw no others. */
  arc(x, y, r) { this.path += `M${short(x - r)} ${short(y)}a${short(r)} ${short(r)} 0 1 0 ${short(2 * r)} 0a${short(r)} ${short(r)} 0 1 0 ${short(-2 * r)} 0Z`; }
  setLineDash(dash) { this.state.dash = dash; }

  get faint() { return this.state.globalAlpha < 1 ? ` opacity="${this.state.globalAlpha}"` : ""; }
  get line() {
    const s = this.state, dash = s.dash.length ? ` stroke-dasharray="${s.dash.join(" ")}"` : "";
    return `stroke="${s.strokeStyle}" stroke-width="${short(s.lineWidth)}" stroke-linejoin="${s.lineJoin}"${dash}`;
  }
  stroke() { if (this.path) this.parts.push(`<path d="${this.path}" fill="none" ${this.line}${this.faint}/>`); }
  fill() { if (this.path) this.parts.push(`<path d="${this.path}" fill="${this.state.fillStyle}"${this.faint}/>`); }
  box(x, y, w, h) { return `<rect x="${short(x)}" y="${short(y)}" width="${short(w)}" height="${short(h)}"`; }
  fillRect(x, y, w, h) { this.parts.push(`${this.box(x, y, w, h)} fill="${this.state.fillStyle}"${this.faint}/>`); }
  strokeRect(x, y, w, h) { this.parts.push(`${this.box(x, y, w, h)} fill="none" ${this.line}${this.faint}/>`); }

  measureText(text) { this.measure.font = this.state.font; return this.measure.measureText(text); }
  text(text, x, y, paint) {
    const s = this.state, [, slant, weight, size, family] = /^(italic )?(bold )?([\d.]+)px (.*)$/.exec(s.font);
    const font = `font-family="${escape(family)}" font-size="${size}"${slant ? ' font-style="italic"' : ""}${weight ? ' font-weight="bold"' : ""}`;
    const place = `x="${short(x)}" y="${short(y + BASELINES[s.textBaseline] * size)}" text-anchor="${ANCHORS[s.textAlign]}"`;
    // as wide as here where the typeface is another one
    const width = `textLength="${short(this.measureText(text).width)}" lengthAdjust="spacingAndGlyphs"`;
    this.parts.push(`<text ${place} ${width} ${font} xml:space="preserve" ${paint}${this.faint}>${escape(text)}</text>`);
  }
  fillText(text, x, y) { this.text(text, x, y, `fill="${this.state.fillStyle}"`); }
  strokeText(text, x, y) { this.text(text, x, y, `fill="none" ${this.line}`); }

  /** A canvas as a picture in the picture: the map's cells, which are as large as they are. */
  drawImage(canvas, x, y, w, h) {
    this.parts.push(`<image x="${short(x)}" y="${short(y)}" width="${short(w)}" height="${short(h)}" preserveAspectRatio="none" image-rendering="pixelated" href="${canvas.toDataURL()}"${this.faint}/>`);
  }
}
