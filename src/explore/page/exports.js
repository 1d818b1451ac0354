// Files of what is shown.
import { FONT, colour } from "./draw.js";

const element = (id) => document.getElementById(id);

export function download(name, content, type) {
  const link = document.createElement("a"), blob = content instanceof Blob ? content : new Blob([content], { type });
  link.href = URL.createObjectURL(blob); link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** The files that the server makes of what is shown. */
export async function exportFiles(app, file) {
  app.said("computing the files");
  try {
    const found = await app.wire.once({ kind: "export", file }, app.state);
    for (const f of found.files) download(f.name, f.text, "text/plain");
    app.said(`${found.files.map((f) => f.name).join(", ")}`);
  } catch (error) { app.message(error.message, error.remedy); }
}

/** Every picture of the page in one PNG, with its readout. */
export function png() {
  const shown = [...document.querySelectorAll("canvas")].filter((c) => c.offsetParent !== null && c.width > 1);
  const boxes = shown.map((c) => c.getBoundingClientRect()), ratio = window.devicePixelRatio || 1;
  const left = Math.min(...boxes.map((b) => b.left)), top = Math.min(...boxes.map((b) => b.top));
  const right = Math.max(...boxes.map((b) => b.right)), bottom = Math.max(...boxes.map((b) => b.bottom));
  const sheet = document.createElement("canvas"), head = 34;
  sheet.width = ratio * (right - left + 20); sheet.height = ratio * (bottom - top + head + 20);
  const c = sheet.getContext("2d");
  c.scale(ratio, ratio); c.fillStyle = colour("paper"); c.fillRect(0, 0, sheet.width, sheet.height);
  c.fillStyle = colour("ink"); c.font = `17px ${FONT}`; c.fillText(element("readout").textContent, 12, 24);
  shown.forEach((s, i) => c.drawImage(s, boxes[i].left - left + 10, boxes[i].top - top + head + 10, boxes[i].width, boxes[i].height));
  sheet.toBlob((blob) => download("explorer.png", blob, "image/png"));
}

export async function copyAddress(app) {
  history.replaceState(null, "", "#" + app.address());
  try { await navigator.clipboard.writeText(location.href); app.said("the address is on the clipboard"); } catch { app.said("copy the address from the browser's bar"); }
}
