// Dialogs: initial conditions, parameters, R(v), exports, demos, keys.
import { KEYS } from "./keys.js";
import { copyAddress, exportFiles, png, svg } from "./exports.js";
import { between, button, element, hasLength, make, numberField, typed } from "./fields.js";
import { formulaOf, tableOf } from "./formula.js";
import { turned } from "./plots.js";

/** The law R(v) that a text states in one of the forms; throws where it states none. */
function lawOf(form, text) {
  if (form === "formula") return { table: tableOf(text) };
  const need = (holds, why) => { if (!holds) throw new Error(why); };
  const share = (name, v) => need(v >= 0 && v <= 1, `${name} = ${v} is not between 0 and 1`);
  const lines = text.trim().split(/\n+/).map((l) => l.trim().split(/[\s;]+/).map(typed)), all = lines.flat();
  need(!all.includes(null), "Numbers alone are understood here");
  if (form === "table") {
    lines.forEach((l, i) => need(l.length === 2, `Line ${i + 1} has ${l.length} of 2 numbers`));
    lines.forEach(([v, r], i) => { need(v >= 0 && !(i && v <= lines[i - 1][0]), `Line ${i + 1}: speeds rise, from 0 at least`); share(`Line ${i + 1}: R`, r); });
  } else {
    const count = form === "constant" ? 1 : 3;
    need(all.length === count, `${all.length} of ${count} numbers`);
  }
  const [a, b, c] = all;
  if (form === "constant") share("R", a);
  if (form === "power_law") { need(a >= 0, `coefficient = ${a} is negative`); need(b > 0, `exponent = ${b} is not above 0`); share("floor", c); }
  if (form === "exponential") { share("slow", a); share("fast", b); need(c > 0, `speed = ${c} is not above 0`); }
  return { constant: a, table: { table: lines }, power_law: { power_law: { coefficient: a, exponent: b, floor: c } }, exponential: { exponential: { slow: a, fast: b, speed: c } } }[form];
}

/** The field of one end of a range, which rises. */
function rangeEnd(name, limit, range, i, put) {
  return [name, limit, () => range()[i], (v) => {
    const next = range().with(i, v);
    if (!(next[1] > next[0])) return i ? `above ${next[0]}` : `below ${next[1]}`;
    return put(next);
  }];
}

export class Dialogs {
  constructor(app) {
    this.app = app;
    this.box = element("dialog");
    this.before = null;
    // the focus goes back at once, so that the next key counts
    this.box.addEventListener("close", () => {
      if (this.box.open) return; // another one is open by now
      const back = this.before?.isConnected && this.before !== document.body ? this.before : element("map");
      document.activeElement?.blur();
      back.focus({ preventScroll: true });
    });
  }

  open(title, ...content) {
    element("dialog-title").textContent = title;
    element("dialog-body").replaceChildren(...content);
    if (!this.box.open) { this.before = document.activeElement; this.box.showModal(); }
    this.box.querySelector("input, select, textarea, #dialog-body button, button")?.focus();
  }

  /** Fields [name, limit, get, put] with their ranges; what is typed counts at once. */
  fields(title, rows, note) {
    const grid = make("div", undefined, "fields");
    for (const [name, limit, get, put] of rows) {
      const label = make("label", name), range = this.app.limits[limit], { input, fault } = numberField(name, range, get, put), within = make("span", between(range), "note");
      within.id = fault.id.replace("fault", "range"); input.setAttribute("aria-describedby", within.id);
      label.append(input); label.style.display = "contents"; grid.append(label, within, fault);
    }
    this.open(title, ...(note ? [make("p", note, "note")] : []), grid);
  }

  initial() {
    const { app } = this, c = () => app.state.cursor;
    const start = (name, key) => [name, "start", () => c().start[key], (v) => app.start({ ...c().start, [key]: v })];
    const rows = [start("X(0)", "x"), start("X′(0)", "vx"), start("Y(0)", "y"), start("Y′(0)", "vy"), ["phase φ, rad", "phase", () => turned(c().phase), (v) => app.start(c().start, v)]];
    const map = ["X′ = Y′ of the map's start", "start", () => app.state.map_start.vx, (v) => { app.mapFrom(v); }];
    this.fields("Initial conditions (A)", [...rows, map], "The motion is shown from this start, not settled; a start beyond the contact is moved back to it. Q starts it from rest.");
  }

  system() {
    const { app } = this, s = () => app.state, change = (part) => { app.parameters(part); };
    const rows = [
      ["η of the motion", "eta", () => s().cursor.eta, (v) => { app.goTo(v, s().cursor.rho); }],
      ["ρ of the motion", "rho", () => s().cursor.rho, (v) => { app.goTo(s().cursor.eta, v); }],
      ["R", "restitution", () => (typeof s().restitution === "number" ? s().restitution : null), (v) => change({ restitution: v })],
      ["β", "damping_ratio", () => s().damping_ratio, (v) => change({ damping_ratio: v })],
    ];
    for (const [key, name] of [["drive_amplitude", "drive of Y over X"], ["stiffness", "stiffness of Y over X"], ["mass", "mass of Y over X"]]) {
      rows.push([name, key, () => s().asymmetry[key], (v) => change({ asymmetry: { ...s().asymmetry, [key]: v } })]);
    }
    rows.push(["masses (1 or 2)", "masses", () => (s().single ? 1 : 2), (v) => (Number.isInteger(v) ? change({ single: v === 1 }) : "1 or 2")]);
    this.fields("Parameters of the system (B)", rows);
  }

  picture() {
    const { app } = this, v = () => app.state.view;
    const end = (name, key, i) => rangeEnd(name, key, () => v()[key], i, (r) => { app.look(...(key === "eta" ? [r, v().rho] : [v().eta, r])); });
    this.fields("Parameters of the picture (C)", [end("η from", "eta", 0), end("η to", "eta", 1), end("ρ from", "rho", 0), end("ρ to", "rho", 1), ["drive periods of the series", "periods", () => app.state.periods, (x) => { app.set({ periods: x }, ["motion"]); }], ["its samples in a period", "samples", () => app.state.samples_per_period, (x) => { app.set({ samples_per_period: Math.round(x) }, ["motion"]); }]]);
  }

  simulation() {
    const { app } = this, s = () => app.state;
    const watch = (name, key) => [name, key, () => s().watch[key], (v) => { app.set({ watch: { ...s().watch, [key]: v } }, ["motion", "panel"]); }];
    const l = () => s().line ?? app.ownLine("eta"), line = (part) => { app.set({ line: { ...l(), ...part } }, ["panel"]); };
    const end = (name, key, i) => [name, key, () => l()[key][i], (v) => {
      const next = { ...l(), [key]: l()[key].with(i, v) };
      return hasLength(next) ? line(next) : "the line's other end is there";
    }];
    const ends = [end("line from η", "eta", 0), end("line from ρ", "rho", 0), end("line to η", "eta", 1), end("line to ρ", "rho", 1)];
    this.fields("Parameters of the simulation (D)", [watch("periods to settle", "settle_periods"), watch("periods watched", "watch_periods"), watch("tolerance of recurrence", "tolerance"), ["Poincaré phase, rad", "phase", () => turned(s().poincare_phase), (v) => { app.set({ poincare_phase: v }, ["motion"]); }], ["steps of characteristics", "steps", () => l().steps, (v) => line({ steps: Math.round(v) })], ...ends]);
  }

  /** Where the starts of the basins lie, and which masses take them. */
  starts() {
    const { app } = this, b = () => app.state.basins ?? app.ownBasins();
    const change = (part) => { app.set({ basins: { ...b(), ...part }, panel: "basins" }, ["panel"]); app.restorePanel(); };
    const end = (name, key, i) => rangeEnd(name, "start", () => b()[key], i, (r) => { change({ [key]: r }); });
    const masses = ["masses that take the start (1: X alone, 2)", "masses", () => (b().starts === "one_mass" ? 1 : 2), (v) => (Number.isInteger(v) ? change({ starts: v === 1 ? "one_mass" : "both_masses" }) : "1 or 2")];
    const size = (name, i) => [name, "cells", () => b().cells[i], (v) => { const cells = [...b().cells]; cells[i] = Math.round(v); change({ cells }); }];
    this.fields("Starts of the basins (N)", [end("X(0) from", "x", 0), end("X(0) to", "x", 1), end("X′(0) from", "vx", 0), end("X′(0) to", "vx", 1), size("columns", 0), size("rows", 1), masses]);
  }

  law() {
    const { app } = this, r = app.state.restitution;
    const made = formulaOf(r), kind = made ? "formula" : typeof r === "number" ? "constant" : Object.keys(r)[0];
    const select = make("select"), text = make("textarea"), note = make("p", "", "note"), kindOf = make("span");
    // of each form: an example, what it says, and the text of the law that there is
    const forms = {
      constant: ["0.9", "R at every speed.", () => String(r)],
      table: ["0 0.95\n6 0.85", "One pair a line: approach speed, R; linear between, constant beyond. Speeds rise.", () => r.table.map((p) => p.join(" ")).join("\n")],
      formula: ["0.95 - 0.05*v^0.4", "R as a formula in the approach speed v: + − * / ^ ( ) exp log sqrt abs min max tanh. It is computed at 121 speeds up to 30, linear between.", () => made],
      power_law: ["0.05 0.4 0", "coefficient, exponent, floor: R = max(floor, 1 − coefficient·v^exponent).", () => numbers("coefficient", "exponent", "floor")],
      exponential: ["0.95 0.8 3", "slow, fast, speed: R = fast + (slow − fast)·exp(−v/speed).", () => numbers("slow", "fast", "speed")],
    };
    const numbers = (...names) => names.map((name) => r[kind][name]).join(" ");
    select.append(...Object.keys(forms).map((name) => new Option(name.replace("_", " "), name)));
    note.id = "law-note"; note.setAttribute("role", "status"); text.setAttribute("aria-errormessage", note.id);
    const say = (of, why) => { note.textContent = (why ? `${why}. ` : "") + forms[of][1]; note.className = why ? "fault" : "note"; text.setAttribute("aria-invalid", String(Boolean(why))); };
    const fill = (name) => {
      text.value = name === kind ? forms[name][2]() : forms[name][0]; say(name);
      kindOf.textContent = name === "formula" ? "Formula" : "Numbers";
    };
    select.value = kind; fill(kind);
    select.addEventListener("change", () => fill(select.value));
    const apply = button("Apply", () => {
      try { app.parameters({ restitution: lawOf(select.value, text.value) }); this.box.close(); } catch (error) { say(select.value, error.message); text.focus(); }
    });
    const label = make("label", "R(v) as a "), area = make("label");
    label.append(select); area.append(kindOf, text);
    this.open("Restitution R(v) (E)", label, area, note, apply);
  }

  choices(title, list, note) {
    const box = make("div", undefined, "choices");
    box.append(...list.map(([name, action]) => button(name, () => { this.box.close(); action(); })));
    this.open(title, ...(note ? [make("p", note, "note")] : []), box);
  }

  exports() {
    const { app } = this;
    this.choices("Export what is shown (X)", [
      ["PNG: the pictures of this page with their keys and numbers", () => png()],
      ["SVG: the same, drawn as lines", () => svg(app)],
      ["CSV: the numbers of the map and of the panel; with a record, its traces and its simulation", () => exportFiles(app, "tables")],
      ["TOML: the study that reproduces them under `impactid study`", () => exportFiles(app, "study")],
      ["Address: copy it; it restores this page", () => copyAddress(app)],
    ], "Files go where your browser saves downloads.");
  }

  demos() {
    this.choices("Demos (F)", this.app.demos.map((name) => [name, () => this.app.player.start(name)]), "Esc ends a demo; the number alone shows its first picture.");
  }

  /** Every key with what it does: a button where it does something at once. */
  help() {
    const list = make("div", undefined, "keys");
    for (const [key, text, action] of KEYS) {
      const row = action ? button("", () => { this.box.close(); action(this.app); }) : make("div");
      row.append(make("kbd", key.length === 1 ? key.toUpperCase() : key), make("span", text)); list.append(row);
    }
    this.open("Menu: everything, with its key (?)", make("p", "Drag on the map: the motion is carried along. Click a record: measured beside simulated. Tab reaches everything.", "note"), list);
  }
}
