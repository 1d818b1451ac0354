// Files of what is shown: the page as a picture, its tables, the study.
import { FONT, colour, drawnInto } from "./draw.js";
import { SvgContext } from "./svg.js";

/** Texts that belong to what is shown, beside the pictures. */
const TEXTS = "h1, #readout, #legend, #sliders, #residuals, #numbers, #line-note, .tools select, #basin-shares, #record-head, #record-evidence, #caption.demo";
/** Space around the pictures, px. */
const MARGIN = 12;

const visible = (e) => e.checkVisibility() && e.getBoundingClientRect().width > 0;

export function download(name, content, type) {
  const link = document.createElement("a"), blob = content instanceof Blob ? content : new Blob([content], { type });
  link.href = URL.createObjectURL(blob); link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** The files that the server makes of what is shown, its `study` or its `tables`, and the record's. */
export async function exportFiles(app, kind) {
  app.said("computing the files");
  try {
    const found = await app.wire.once({ kind }, app.state);
    const files = [...found.files, ...(kind === "tables" && app.state.panel === "record" ? app.campaign.tables() : [])];
    for (const f of files) download(f.name, f.text, "text/plain");
    app.said(files.map((f) => f.name).join(", "));
  } catch (error) { app.message(error.message, error.remedy); }
}

/** The runs of letters within an element as they lie on the page: [text, box, style]. */
function* texts(element) {
  const walker = document.createTreeWalker(element, NodeFilter.SHOW_TEXT), range = document.createRange();
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    if (!visible(node.parentElement) || node.parentElement.closest("option, button")) continue;
    const style = getComputedStyle(node.parentElement);
    // a text that is broken into lines is drawn line by line
    let line = "", box = null;
    for (let i = 0; i < node.length; i++) {
      range.setStart(node, i); range.setEnd(node, i + 1);
      const at = range.getBoundingClientRect();
      if (box && at.width > 0 && at.top > box.bottom - 2) { yield [line, box, style]; line = ""; box = null; }
      line += node.data[i];
      if (at.width > 0) box ??= at;
    }
    if (box && line.trim()) yield [line.trimEnd(), box, style];
  }
}

/** Draw what surrounds the pictures: samples of the keys, and all texts. */
function drawSurroundings(c) {
  const elements = [...document.querySelectorAll(TEXTS)].filter(visible);
  for (const e of elements) {
    for (const sample of e.querySelectorAll(".swatch, .sample")) {
      const b = sample.getBoundingClientRect(), style = getComputedStyle(sample);
      if (sample.className === "swatch") {
        c.fillStyle = style.backgroundColor; c.fillRect(b.left, b.top, b.width, b.height);
        c.strokeStyle = style.borderTopColor; c.lineWidth = 1; c.strokeRect(b.left, b.top, b.width, b.height);
      } else {
        c.strokeStyle = style.borderTopColor; c.lineWidth = parseFloat(style.borderTopWidth);
        c.setLineDash(style.borderTopStyle === "dashed" ? [5, 3] : []);
        c.beginPath(); c.moveTo(b.left, b.top); c.lineTo(b.right, b.top); c.stroke(); c.setLineDash([]);
      }
    }
    c.textAlign = "left"; c.textBaseline = "alphabetic";
    for (const [text, b, style] of texts(e)) {
      c.font = `${style.fontStyle === "italic" ? "italic " : ""}${Number(style.fontWeight) >= 600 ? "bold " : ""}${style.fontSize} ${FONT}`;
      c.fillStyle = style.color;
      c.fillText(text, b.left, b.bottom - 0.27 * parseFloat(style.fontSize));
    }
    for (const field of e.matches("select") ? [e] : e.querySelectorAll("select, input[type=text]")) {
      const b = field.getBoundingClientRect();
      c.font = `14px ${FONT}`; c.fillStyle = colour("ink");
      c.fillText(field.selectedOptions?.[0]?.text ?? field.value, b.left + 6, b.bottom - 7);
    }
  }
}

/** What is shown, in a context: pictures by `picture`, then what surrounds them; and its size. */
function sheet(context, picture) {
  const pictures = [...document.querySelectorAll("main canvas")].filter((e) => visible(e) && e.width > 1);
  const boxes = [...pictures, ...[...document.querySelectorAll(TEXTS)].filter(visible)].map((e) => e.getBoundingClientRect());
  const [left, top] = ["left", "top"].map((side) => Math.floor(Math.min(...boxes.map((b) => b[side]))) - MARGIN);
  const [right, bottom] = ["right", "bottom"].map((side) => Math.max(...boxes.map((b) => b[side])) + MARGIN);
  return { width: right - left, height: bottom - top, draw: () => {
    const c = context();
    c.fillStyle = colour("paper"); c.fillRect(0, 0, right - left, bottom - top);
    c.save(); c.translate(-left, -top);
    for (const e of pictures) picture(c, e, e.getBoundingClientRect());
    drawSurroundings(c);
    c.restore();
    return c;
  } };
}

/** Every picture of the page with its keys and numbers, as PNG. */
export function png() {
  const canvas = document.createElement("canvas"), ratio = window.devicePixelRatio || 1;
  const all = sheet(() => {
    canvas.width = ratio * all.width; canvas.height = ratio * all.height;
    const c = canvas.getContext("2d");
    c.scale(ratio, ratio);
    return c;
  }, (c, picture, b) => c.drawImage(picture, Math.round(b.left), Math.round(b.top), b.width, b.height));
  all.draw();
  canvas.toBlob((blob) => download("explorer.png", blob, "image/png"));
}

/** The same as SVG: the pictures are drawn again, as lines. */
export function svg(app) {
  const c = new SvgContext();
  const all = sheet(() => c, (_, picture, b) => {
    c.save(); c.translate(b.left, b.top);
    drawnInto(c, picture, () => app.paint());
    c.restore();
  });
  all.draw();
  app.paint();
  download("explorer.svg", c.document(all.width, all.height), "image/svg+xml");
}

export async function copyAddress(app) {
  history.replaceState(null, "", "#" + app.address());
  try { await navigator.clipboard.writeText(location.href); app.said("the address is on the clipboard"); } catch { app.said("copy the address from the browser's bar"); }
}
