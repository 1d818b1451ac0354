// Fields for numbers: what is typed counts where it is in its range, else the field says why and what is shown stays.
export const element = (id) => document.getElementById(id);
export const make = (name, text, className) => {
  const e = document.createElement(name);
  if (text !== undefined) e.textContent = text;
  if (className) e.className = className;
  return e;
};

/** A button that does something where it is pressed. */
export function button(text, action) {
  const b = make("button", text);
  b.type = "button";
  b.addEventListener("click", action);
  return b;
}

/** A text as a sentence: names that it begins with, such as `view.eta`, stay as they are. */
export const sentence = (text) => text.replace(/^[a-z]+(?=[ ,])/, (word) => word[0].toUpperCase() + word.slice(1)).replace(/[^.?!]$/, "$&.");

/** A range as text. */
export const between = ([low, high]) => `${low} to ${high}`.replaceAll("-", "−");

/** Whether a line's ends are two places. */
export const hasLength = ({ eta, rho }) => eta[0] !== eta[1] || rho[0] !== rho[1];

/** A number as it is typed, with a comma or a point; `null` where it is none. */
export function typed(text) {
  const v = Number(text.trim().replace(",", ".").replace("−", "-"));
  return text.trim() !== "" && Number.isFinite(v) ? v : null;
}

/** What the browser keeps under a name, a new value where one is given; a private window keeps nothing. */
export function kept(name, value) {
  try {
    if (value !== undefined) localStorage.setItem(name, value);
    return localStorage.getItem(name);
  } catch { return null; }
}

let fields = 0;
/** Says beside the dialog's field that was changed last why the server refused it; whether there is such a field. */
let refuse = () => false;
export const refusedInField = ({ message, remedy }) => refuse([message, remedy].map(sentence).join(" "));

/** A field [label, range, get, put] of a number, with the place where it says what is wrong. `put` may refuse a value
 * with a text. */
export function numberField(name, range, get, put) {
  const input = make("input"), fault = make("span", undefined, "fault");
  Object.assign(input, { type: "text", inputMode: "decimal" });
  fault.id = `fault-${++fields}`; fault.setAttribute("role", "alert");
  input.setAttribute("aria-errormessage", fault.id);
  const say = (why) => { fault.textContent = why; fault.hidden = !why; input.setAttribute("aria-invalid", String(Boolean(why))); };
  /** What the state holds, unless something else is being typed. */
  const show = () => {
    if (document.activeElement === input && input.value !== input.defaultValue) return;
    const v = get();
    input.defaultValue = input.value = v === null ? "R(v)" : String(Number(v.toPrecision(7)));
    say("");
  };
  input.addEventListener("change", () => {
    const v = typed(input.value), [low, high] = range;
    if (v === null || v < low || v > high) { say(`${name}: ${between(range)}`); return; }
    say("");
    input.defaultValue = input.value;
    refuse = (why) => { const seen = element("dialog").open && input.isConnected && input.closest("dialog") !== null; if (seen) say(`${name}: ${why}`); return seen; };
    const refused = put(v);
    if (refused) say(`${name}: ${refused}`);
  });
  input.addEventListener("keydown", (e) => {
    if (e.key === "Enter") { e.preventDefault(); input.blur(); }
    if (e.key !== "Escape") return;
    // what was typed goes first; of a field beside the map the next one leads back to it
    if (input.value !== input.defaultValue) { e.preventDefault(); input.value = input.defaultValue; say(""); }
    else if (!input.closest("dialog")) element("map").focus({ preventScroll: true });
  });
  show();
  return { input, fault, show };
}

/** The sliders under the map, each with a field. */
export class Sliders {
  constructor(app) {
    this.app = app;
    this.rows = this.list().map((row) => this.row(...row));
    element("sliders").replaceChildren(...this.rows.map((r) => r.row));
    element("sliders").addEventListener("submit", (e) => e.preventDefault());
    this.show();
  }

  /** [label, limit, factor of the unit shown, least, greatest, step, get, put] */
  list() {
    const { app } = this, fit = app.first.rig, state = () => app.state;
    const asym = (key) => [() => state().asymmetry[key], (v) => ({ asymmetry: { ...state().asymmetry, [key]: v } })];
    const rig = (key) => [() => state().rig[key], (v) => ({ rig: { ...state().rig, [key]: v } })];
    const constant = () => (typeof state().restitution === "number" ? state().restitution : null);
    const rows = [
      ["restitution R", "restitution", 1, 0, 1, 0.001, constant, (v) => ({ restitution: v })],
      ["damping β", "damping_ratio", 1, 0, 0.3, 0.0005, () => state().damping_ratio, (v) => ({ damping_ratio: v })],
    ];
    if (fit) {
      const f0 = fit.natural_frequency_hz, xst = 1e3 * fit.static_deflection_m;
      rows.push(["f₀, Hz", "natural_frequency_hz", 1, 0.8 * f0, 1.2 * f0, f0 / 5000, ...rig("natural_frequency_hz")]);
      rows.push(["xₛₜ, mm", "static_deflection_m", 1e3, 0.6 * xst, 1.4 * xst, xst / 5000, ...rig("static_deflection_m")]);
    }
    if (!fit || !app.first.single) {
      rows.push(["drive Y/X", "drive_amplitude", 1, 0.8, 1.2, 0.001, ...asym("drive_amplitude")], ["stiffness Y/X", "stiffness", 1, 0.8, 1.2, 0.001, ...asym("stiffness")]);
      if (!fit) rows.push(["mass Y/X", "mass", 1, 0.5, 2, 0.001, ...asym("mass")]);
    }
    return rows;
  }

  row(name, limit, factor, low, high, step, get, put) {
    const { app } = this, row = make("div", undefined, "slider"), range = make("input");
    const shown = () => { const v = get(); return v === null ? null : v * factor; };
    const limits = app.limits[limit].map((v) => v * factor);
    const within = (v) => Number(Math.min(limits[1], Math.max(limits[0], v)).toPrecision(12)) / factor;
    const change = (v) => app.parameters(put(within(v)));
    const field = numberField(name, limits, shown, change);
    Object.assign(range, { type: "range", min: low, max: high, step });
    range.setAttribute("aria-label", name); field.input.setAttribute("aria-label", `${name}, typed`);
    const next = () => app.lookAhead([-step, step].map((by) => ({ ...app.state, ...put(within(Number(range.value) + by)) })));
    range.addEventListener("focus", next);
    range.addEventListener("input", () => { change(Number(range.value)); next(); });
    row.append(make("span", name), range, field.fault, field.input);
    return { row, range, ends: [low, high], step, shown, field, pair: name.endsWith("Y/X") };
  }

  /** Thumbs and fields at what the state holds. */
  show() {
    for (const { row, range, ends, step, shown, field, pair } of this.rows) {
      const v = shown();
      range.disabled = v === null;
      // what compares two masses has no meaning for one
      row.style.visibility = pair && this.app.state.single ? "hidden" : "";
      // a value that was typed beyond the ends is within reach of the thumb too, which never jumps from it
      if (v !== null) {
        const [least, most] = document.activeElement === range ? [Number(range.min), Number(range.max)] : ends;
        range.min = Math.min(least, v); range.max = Math.max(most, v);
        if (Number(range.value) !== v) range.value = v;
        // steps are counted from the least value: from one beside a step on they go through the value itself
        if (Math.abs(range.value - v) > 1e-6 * step) { range.min = v - Math.ceil((v - range.min) / step) * step; range.value = v; }
      }
      field.show();
    }
  }
}
