// Dialogs: initial conditions, parameters, R(v), exports, demos, keys.
import { KEYS } from "./keys.js";

const make = (name, text, className) => {
  const e = document.createElement(name);
  if (text !== undefined) e.textContent = text;
  if (className) e.className = className;
  return e;
};

export class Dialogs {
  constructor(app) {
    this.app = app;
    this.box = document.getElementById("dialog");
    this.before = null;
    // the focus goes back at once, so that the next key counts
    this.box.addEventListener("close", () => {
      const back = this.before?.isConnected && this.before !== document.body ? this.before : document.getElementById("map");
      document.activeElement?.blur();
      back.focus({ preventScroll: true });
    });
  }

  open(title, ...content) {
    document.getElementById("dialog-title").textContent = title;
    document.getElementById("dialog-body").replaceChildren(...content);
    if (!this.box.open) { this.before = document.activeElement; this.box.showModal(); }
    this.box.querySelector("input, select, textarea, #dialog-body button, button")?.focus();
  }

  /** Fields [name, value, apply(number)]; what is typed counts at once. */
  fields(title, rows, note) {
    const grid = make("div", undefined, "fields");
    for (const [name, value, apply] of rows) {
      const label = make("label", name), input = make("input");
      input.type = "text"; input.inputMode = "decimal"; input.value = String(value);
      input.addEventListener("change", () => {
        const v = Number(input.value.replace(",", ".").replace("−", "-"));
        const good = input.value.trim() !== "" && Number.isFinite(v);
        input.setAttribute("aria-invalid", String(!good));
        if (good) apply(v);
      });
      label.append(input); label.style.display = "contents"; grid.append(label);
    }
    this.open(title, ...(note ? [make("p", note, "note")] : []), grid);
  }

  initial() {
    const { app } = this, c = () => app.state.cursor;
    const start = (key) => (v) => app.start({ ...c().start, [key]: v });
    const rows = [["X(0)", c().start.x, start("x")], ["X′(0)", c().start.vx, start("vx")], ["Y(0)", c().start.y, start("y")], ["Y′(0)", c().start.vy, start("vy")], ["phase φ, rad", c().phase, (v) => app.start(c().start, v)]];
    this.fields("Initial conditions (A)", rows, "The motion is shown from this start, not settled. Q starts it from rest.");
  }

  system() {
    const { app } = this, s = app.state, change = (part) => app.parameters(part);
    const rows = [["R", typeof s.restitution === "number" ? s.restitution : "R(v)", (v) => change({ restitution: v })], ["β", s.damping_ratio, (v) => change({ damping_ratio: v })]];
    for (const [key, name] of [["drive_amplitude", "drive of Y over X"], ["stiffness", "stiffness of Y over X"], ["mass", "mass of Y over X"]]) {
      rows.push([name, s.asymmetry[key], (v) => change({ asymmetry: { ...app.state.asymmetry, [key]: v } })]);
    }
    rows.push(["masses (1 or 2)", s.single ? 1 : 2, (v) => change({ single: v === 1 })]);
    this.fields("Parameters of the system (B)", rows);
  }

  picture() {
    const { app } = this, v = () => app.state.view;
    const end = (key, i) => (x) => { const r = [...v()[key]]; r[i] = x; app.look(...(key === "eta" ? [r, v().rho] : [v().eta, r])); };
    this.fields("Parameters of the picture (C)", [["η from", v().eta[0], end("eta", 0)], ["η to", v().eta[1], end("eta", 1)], ["ρ from", v().rho[0], end("rho", 0)], ["ρ to", v().rho[1], end("rho", 1)], ["drive periods of the series", app.state.periods, (x) => app.set({ periods: x }, ["motion"])]]);
  }

  simulation() {
    const { app } = this, w = app.state.watch;
    const watch = (key) => (v) => app.set({ watch: { ...app.state.watch, [key]: v } }, ["motion", "panel"]);
    const line = (v) => app.state.line && app.set({ line: { ...app.state.line, steps: Math.round(v) } }, ["panel"]);
    const cells = (v) => { const b = app.state.basins ?? app.ownBasins(); app.set({ basins: { ...b, cells: [Math.round(v), Math.round(v)] } }, ["panel"]); };
    this.fields("Parameters of the simulation (D)", [["periods to settle", w.settle_periods, watch("settle_periods")], ["periods watched", w.watch_periods, watch("watch_periods")], ["tolerance of recurrence", w.tolerance, watch("tolerance")], ["Poincaré phase, rad", app.state.poincare_phase, (v) => app.set({ poincare_phase: v }, ["motion"])], ["steps of characteristics", app.state.line?.steps ?? 200, line], ["starts of basins, each way", app.state.basins?.cells[0] ?? 101, cells]]);
  }

  law() {
    const { app } = this, r = app.state.restitution;
    const kind = typeof r === "number" ? "constant" : Object.keys(r)[0];
    const select = make("select"), text = make("textarea"), note = make("p", "", "note");
    const forms = {
      constant: ["0.9", "R at every speed."],
      table: ["0 0.95\n6 0.85", "One pair a line: approach speed, R; linear between, constant beyond. Speeds rise."],
      power_law: ["0.05 0.4 0", "coefficient, exponent, floor: R = max(floor, 1 − coefficient·v^exponent)."],
      exponential: ["0.95 0.8 3", "slow, fast, speed: R = fast + (slow − fast)·exp(−v/speed)."],
    };
    for (const [name, label] of [["constant", "constant"], ["table", "table"], ["power_law", "power law"], ["exponential", "exponential"]]) {
      const o = make("option", label); o.value = name; select.append(o);
    }
    const fill = (name) => {
      const now = name === kind ? { constant: () => String(r), table: () => r.table.map((p) => p.join(" ")).join("\n"), power_law: () => [r.power_law.coefficient, r.power_law.exponent, r.power_law.floor].join(" "), exponential: () => [r.exponential.slow, r.exponential.fast, r.exponential.speed].join(" ") }[name]() : forms[name][0];
      text.value = now; note.textContent = forms[name][1];
    };
    select.value = kind; fill(kind);
    select.addEventListener("change", () => fill(select.value));
    const apply = make("button", "Apply"); apply.type = "button";
    apply.addEventListener("click", () => {
      const lines = text.value.trim().split(/\n+/).map((l) => l.trim().split(/[\s;]+/).map((v) => Number(v.replace(",", "."))));
      const [a, b, c] = lines[0];
      const law = { constant: a, table: { table: lines.map(([v, w]) => [v, w]) }, power_law: { power_law: { coefficient: a, exponent: b, floor: c } }, exponential: { exponential: { slow: a, fast: b, speed: c } } }[select.value];
      if (lines.flat().some((v) => !Number.isFinite(v))) { note.textContent = `Numbers alone, please. ${forms[select.value][1]}`; return; }
      app.parameters({ restitution: law });
    });
    const label = make("label", "R(v) as a "), area = make("label", "Numbers");
    label.append(select); area.append(text);
    this.open("Restitution R(v) (E)", label, area, note, apply);
  }

  choices(title, list, note) {
    const box = make("div", undefined, "choices");
    for (const [name, action] of list) {
      const b = make("button", name); b.type = "button";
      b.addEventListener("click", () => { this.box.close(); action(); });
      box.append(b);
    }
    this.open(title, ...(note ? [make("p", note, "note")] : []), box);
  }

  exports() {
    const { app } = this;
    this.choices("Export what is shown (X)", [
      ["PNG: the pictures as they are on this page", () => app.png()],
      ["SVG: the figures in the report's style", () => app.exportFiles("svg")],
      ["CSV: the numbers of the map and of the panel", () => app.exportFiles("csv")],
      ["TOML: the study that reproduces them under `impactid study`", () => app.exportFiles("study")],
      ["Address: copy it; it restores this page", () => app.copyAddress()],
    ], "Files go where your browser saves downloads.");
  }

  demos() {
    this.choices("Demos (F)", this.app.demos.map((name) => [name, () => this.app.demo(name)]), "A key ends a demo; the number alone shows its first picture.");
  }

  help() {
    const list = make("div", undefined, "keys");
    for (const [key, text] of KEYS) {
      const row = make("div"), k = make("kbd", key.length === 1 ? key.toUpperCase() : key);
      row.append(k, make("span", text)); list.append(row);
    }
    this.open("Keys (?)", make("p", "Drag on the map: the motion is carried along. Click a record: measured beside simulated. Tab reaches everything.", "note"), list);
  }
}
