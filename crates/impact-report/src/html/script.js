"use strict";
// Figures can be zoomed (buttons, Ctrl + wheel, drag) and their points tell their record.
(() => {
  const tip = document.getElementById("tip");
  const reach = 9;
  const words = JSON.parse(document.getElementById("words").textContent);

  function point(svg, event) {
    const matrix = svg.getScreenCTM();
    return matrix ? new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix.inverse()) : null;
  }

  function setBox(drawing, box) {
    const { svg, full } = drawing;
    const w = Math.min(box.w, full.w), h = Math.min(box.h, full.h);
    const x = Math.max(full.x, Math.min(box.x, full.x + full.w - w));
    const y = Math.max(full.y, Math.min(box.y, full.y + full.h - h));
    drawing.box = { x, y, w, h };
    svg.setAttribute("viewBox", `${x} ${y} ${w} ${h}`);
    svg.classList.toggle("zoomed", w < full.w);
  }

  function zoom(drawing, factor, at) {
    const b = drawing.box;
    const w = Math.max(b.w / factor, drawing.full.w / 40), h = w * b.h / b.w;
    const p = at || { x: b.x + b.w / 2, y: b.y + b.h / 2 };
    setBox(drawing, { x: p.x - (p.x - b.x) * w / b.w, y: p.y - (p.y - b.y) * h / b.h, w, h });
  }

  function nearest(drawing, p) {
    const rect = drawing.svg.getBoundingClientRect();
    const perPixel = rect.width > 0 ? drawing.box.w / rect.width : 1;
    let best = null, least = reach * perPixel;
    for (const spot of drawing.spots) {
      const distance = Math.hypot(spot.x * drawing.scale - p.x, spot.y * drawing.scale - p.y);
      if (distance < least) { least = distance; best = spot; }
    }
    return best;
  }

  function show(spot, event) {
    tip.textContent = spot ? spot.text : "";
    tip.style.visibility = spot ? "visible" : "hidden";
    if (spot) {
      const left = Math.min(event.clientX + 14, window.innerWidth - tip.offsetWidth - 6);
      tip.style.left = `${left}px`;
      tip.style.top = `${event.clientY + 14}px`;
    }
  }

  function save(drawing) {
    const copy = drawing.svg.cloneNode(true);
    const f = drawing.full;
    copy.setAttribute("viewBox", `${f.x} ${f.y} ${f.w} ${f.h}`);
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([new XMLSerializer().serializeToString(copy)], { type: "image/svg+xml" }));
    link.download = `${drawing.name}.svg`;
    link.click();
    URL.revokeObjectURL(link.href);
  }

  function tools(drawing, element) {
    const bar = document.createElement("div");
    bar.className = "tools";
    const actions = [["+", "zoom in", () => zoom(drawing, 1.6)], ["−", "zoom out", () => zoom(drawing, 1 / 1.6)],
      ["⟲", "whole figure", () => setBox(drawing, drawing.full)], ["SVG", "save as SVG", () => save(drawing)]];
    for (const [text, title, action] of actions) {
      const button = document.createElement("button");
      Object.assign(button, { type: "button", textContent: text, title: words[title] ?? title, onclick: action });
      bar.append(button);
    }
    element.append(bar);
  }

  function prepare(element) {
    const svg = element.querySelector("svg");
    const [x, y, w, h] = svg.getAttribute("viewBox").split(/\s+/).map(Number);
    const data = element.querySelector("script");
    const drawing = { svg, full: { x, y, w, h }, box: { x, y, w, h }, name: element.dataset.name,
      scale: w / Number(element.dataset.width), spots: data ? JSON.parse(data.textContent) : [] };
    tools(drawing, element);
    let drag = null;
    svg.addEventListener("wheel", (e) => {
      if (!e.ctrlKey) return;
      e.preventDefault();
      zoom(drawing, e.deltaY < 0 ? 1.2 : 1 / 1.2, point(svg, e));
    }, { passive: false });
    svg.addEventListener("pointerdown", (e) => { if (drawing.box.w < drawing.full.w) { drag = point(svg, e); svg.setPointerCapture(e.pointerId); } });
    svg.addEventListener("pointerup", () => { drag = null; });
    svg.addEventListener("pointermove", (e) => {
      const p = point(svg, e);
      if (!p) return;
      if (drag) setBox(drawing, { ...drawing.box, x: drawing.box.x - p.x + drag.x, y: drawing.box.y - p.y + drag.y });
      show(drag ? null : nearest(drawing, p), e);
    });
    svg.addEventListener("pointerleave", (e) => show(null, e));
    svg.addEventListener("dblclick", () => setBox(drawing, drawing.full));
    return drawing;
  }

  const drawings = [...document.querySelectorAll(".drawing")].map(prepare);
  document.body.dataset.figures = drawings.length;

  // With #check in the address the page tries itself: it zooms a figure and hovers over a point.
  if (location.hash === "#check") {
    const drawing = drawings.find((d) => d.spots.length > 0);
    if (drawing) {
      const spot = drawing.spots[0];
      const matrix = drawing.svg.getScreenCTM();
      const on = new DOMPoint(spot.x * drawing.scale, spot.y * drawing.scale).matrixTransform(matrix);
      drawing.svg.dispatchEvent(new PointerEvent("pointermove", { clientX: on.x, clientY: on.y, bubbles: true }));
      document.body.dataset.hovered = tip.textContent;
      zoom(drawing, 2);
      document.body.dataset.zoomed = (drawing.full.w / drawing.svg.viewBox.baseVal.width).toFixed(2);
    }
  }
})();
