// A campaign on the map: records, brackets, proposals; a record beside its simulation; residuals.
import { Frame, around, colour, mark, named, number, FONT } from "./draw.js";
import { button, element, make } from "./fields.js";
import { STRIP } from "./map.js";
import { facts, sampled } from "./plots.js";

/** Records of sweeps up and down lie apart, as in the report, px. */
const APART = { up: -4, down: 4 };
/** Clearances that differ by less than this share are one. */
const SAME = 5e-3;
/** The middle of a strip, px. */
const middleOf = (f, strip) => f.box.top - STRIP * (strip + 0.5);

const SYMBOLS = { "displacement x": "*x*", "displacement y": "*y*", "velocity x": "*x*′", "velocity y": "*y*′", "frame x": "frame *x*", "frame y": "frame *y*" };

function drawBracket(c, [x0, x1], y, past, faint) {
  c.strokeStyle = past ? colour("bad") : colour("ink"); c.lineWidth = past ? 2.4 : 1.6; c.globalAlpha = faint ? 0.35 : 1;
  c.beginPath(); c.moveTo(x0, y - 5); c.lineTo(x0, y + 5); c.moveTo(x0, y); c.lineTo(x1, y); c.moveTo(x1, y - 5); c.lineTo(x1, y + 5); c.stroke();
  c.globalAlpha = 1;
}

/** A factor and the prefix of its unit that make values neither tiny nor huge. */
function prefixed(lists, unit) {
  if (!unit.startsWith("m")) return [1, ""];
  let most = 0;
  for (const list of lists) for (const v of list) most = Math.max(most, Math.abs(v));
  return most >= 0.5 || most === 0 ? [1, ""] : most >= 5e-4 ? [1e3, "m"] : [1e6, "µ"];
}

export class CampaignView {
  constructor(app, facts) {
    this.app = app;
    this.replace(facts);
    new ResizeObserver(() => this.traces()).observe(element("traces"));
  }

  /** Other records: what is shown of those before is asked for again. */
  replace(facts) {
    this.facts = facts;
    this.fit = facts.fit;
    this.proposals = [];
    this.residual = null;
    this.head();
    this.select.value = this.app.state?.record ?? "";
    element("residuals").hidden = !this.fit; // its place, before there is anything in it
  }

  /** (η, ρ) of a record or bracket at the sliders. */
  at(frequency_hz, r) {
    const rig = this.app.scale();
    return [frequency_hz / rig.natural_frequency_hz, r.clearance_m / (rig.static_deflection_m * r.drive_amplitude)];
  }

  /** Clearances that have strips and lie above the view, m. */
  get far() {
    const { static_deflection_m: x } = this.app.scale() ?? {};
    return this.facts.strips_m.filter((s) => s / x > this.app.state.view.rho[1]);
  }

  placed(f) {
    return this.facts.records.filter((r) => r.frequency_hz !== null && r.clearance_m !== null).map((r) => {
      const [eta, rho] = this.at(r.frequency_hz, r), far = rho > f.y[1] ? r.clearance_m / r.drive_amplitude : NaN;
      const strip = this.far.findIndex((s) => Math.abs(s - far) <= SAME * s);
      return { r, strip, x: f.px(eta), y: (strip < 0 ? f.py(rho) : middleOf(f, strip)) + (APART[r.sweep] ?? 0) };
    });
  }

  /** Clearances far above all impacts, each in a strip above the map. */
  strips(f) {
    const { context: c, box } = f, { static_deflection_m: x } = this.app.scale() ?? {}, text = (v) => v.toFixed(1);
    this.far.forEach((s, i) => {
      const y = middleOf(f, i), bounds = [box.left + 0.5, Math.round(y - STRIP / 2) + 2.5, box.width, STRIP - 4];
      c.strokeStyle = colour("frame"); c.lineWidth = 1; c.strokeRect(...bounds);
      // the ring about a chosen mark is higher than its strip
      c.save(); c.beginPath(); c.rect(box.left, y - STRIP, box.width, 2 * STRIP); c.clip();
      this.marks(c, this.placed(f).filter((p) => p.strip === i));
      c.restore();
      c.fillStyle = colour("ink"); c.font = `13px ${FONT}`; c.textBaseline = "middle";
      c.textAlign = "right"; c.fillText(text(s / x), box.left - 5, y);
      c.textAlign = "left"; c.fillText(text(1e3 * s), box.left + box.width + 4, y);
    });
  }

  /** Brackets of boundaries with their places, and whether the boundary is past them at the sliders. */
  brackets(f) {
    const place = (b, i) => {
      const [low, rho] = this.at(b.low_hz, b), [high] = this.at(b.high_hz, b);
      return { b, x0: f.px(low), x1: f.px(high), y: f.py(rho), past: this.residual?.brackets[i]?.past_hz > 0 };
    };
    return this.facts.brackets.map(place).filter(({ b }) => b.kind !== "other");
  }

  /** Boxes of what is drawn of the campaign: middle, half the width, half the height. */
  boxes(f) {
    const records = this.placed(f).map(({ r, x, y }) => [x, y, ...(r.id === this.app.state.record ? [11, 11] : [6, 6])]);
    const brackets = this.brackets(f).map(({ x0, x1, y }) => [(x0 + x1) / 2, y, (x1 - x0) / 2 + 1, 5]);
    return [...records, ...brackets, ...this.proposals.map((p) => [f.px(p.frequency_ratio), f.py(p.clearance_ratio), 11, 11])];
  }

  near(f, p, q) {
    let best = null, least = 9;
    for (const { r, strip, x, y } of this.placed(f)) {
      const d = strip < 0 && !f.holds(x, y) ? Infinity : Math.hypot(x - p, y - q);
      if (d < least) { best = r; least = d; }
    }
    return best;
  }

  marks(c, placed) {
    const chosen = this.app.state.record, many = this.facts.records.length;
    const radius = many > 1500 ? 2.6 : many > 400 ? 3.6 : 4.6;
    for (const { r, x, y } of placed) {
      mark(c, x, y, radius, r.motion, r.out !== null);
      if (r.id === chosen) { c.beginPath(); c.arc(x, y, radius + 5, 0, 7); c.lineWidth = 2.2; c.strokeStyle = colour("bad"); c.stroke(); }
    }
  }

  draw(f, c) {
    this.marks(c, this.placed(f));
    for (const { b, x0, x1, y, past } of this.brackets(f)) {
      drawBracket(c, [x0, x1], y, past, b.out !== null);
    }
    c.font = `bold 14px ${FONT}`; c.textAlign = "center"; c.textBaseline = "middle";
    this.proposals.forEach((p, i) => {
      const x = f.px(p.frequency_ratio), y = f.py(p.clearance_ratio);
      c.beginPath(); c.arc(x, y, 9, 0, 7); c.fillStyle = colour("paper"); c.fill();
      c.lineWidth = 2; c.strokeStyle = colour("green"); c.stroke();
      c.fillStyle = colour("green"); c.fillText(String(i + 1), x, y + 1);
    });
  }

  /** What the map's key has of the campaign: marks of records by the names of their motions, and the rest. */
  samples() {
    const { records, brackets, curves } = this.facts;
    const pale = records.find((r) => r.out !== null), bracket = (past) => (c, w, h) => drawBracket(c, [2, w - 2], h / 2, past, false);
    const one = (has, draw, text) => (has ? [sampled(draw, text)] : []);
    return {
      marks: new Map(records.map(({ motion }) => [motion.label, (c, w, h) => mark(c, w / 2, h / 2, 4.6, motion)])),
      others: [
        ...one(pale, (c, w, h) => mark(c, w / 2, h / 2, 4.6, pale.motion, true), "left out"),
        ...one(brackets.length, bracket(false), "bracket"),
        ...one(this.residual?.brackets.some((b) => b.past_hz > 0), bracket(true), "boundary past it"),
        ...one(curves.some((k) => k.band.length > 1), (c, w, h) => { c.globalAlpha = 0.75; c.fillStyle = colour("band"); c.fillRect(0, h / 4, w, h / 2); c.globalAlpha = 1; }, "95 % band"),
      ],
    };
  }

  head() {
    const box = element("record-head"), label = make("label", "Record ");
    this.select = make("select");
    const text = (r) => `${r.id} (${r.decay ? "free decay" : named(r.motion)}${r.out === null ? "" : ", left out"})`;
    this.select.append(...this.facts.records.map((r) => new Option(text(r), r.id)));
    this.select.addEventListener("change", () => this.app.choose(this.facts.records.find((r) => r.id === this.select.value)));
    label.append(this.select);
    this.title = make("span");
    box.replaceChildren(label, this.title);
  }

  /** Choose the record so many places further in the list. */
  step(by) {
    const all = this.facts.records, now = all.findIndex((r) => r.id === this.app.state.record);
    this.app.choose(all[(now + by + all.length) % all.length]);
  }

  show(frame) {
    this.frame = frame;
    this.select.value = frame.record;
    const s = frame.stated, same = frame.simulated?.label === s.motion.label;
    const measured = frame.shown === "decay" ? "free decay" : `measured ${named(s.motion)} (confidence ${number(s.confidence, 2)})`;
    const simulated = frame.simulated ? `, simulated ${named(frame.simulated)}` : frame.not_simulated && frame.shown === "motion" ? `; not simulated: ${frame.not_simulated}` : "";
    this.title.textContent = measured + simulated;
    this.title.className = !frame.simulated ? "" : same ? "good" : "bad";
    this.traces();
    this.evidence();
  }

  traces() {
    const frame = this.frame, box = element("traces");
    if (!frame || element("panel-record").hidden) return;
    if (frame.shown === "nothing") { box.replaceChildren(make("p", frame.why, "bad")); return; }
    const list = frame.shown === "decay" ? [0] : frame.traces.map((_, i) => i);
    if (box.childElementCount !== list.length || box.firstElementChild?.tagName !== "CANVAS") {
      box.replaceChildren(...list.map(() => { const c = make("canvas"); c.setAttribute("role", "img"); return c; }));
    }
    const col = frame.column;
    list.forEach((i, place) => {
      const canvas = box.children[place], t = col["t" + i], m = col["measured" + i];
      const decay = frame.shown === "decay";
      const st = decay ? col.t1 : t, s = decay ? col.simulated1 : col["simulated" + i], r = col["residual" + i] ?? [];
      const unit = decay ? frame.unit : frame.traces[i].unit, role = decay ? "free decay" : frame.traces[i].role.replace("_", " ");
      const [factor, prefix] = prefixed([m, s], unit);
      const scaled = (values) => Float32Array.from(values, (v) => v * factor);
      canvas.setAttribute("aria-label", `${role}: measured and simulated`);
      const last = place === list.length - 1;
      const f = new Frame(canvas, [t[0], t[t.length - 1]], around([scaled(m), scaled(s)]), [last ? "time, s" : "", `${SYMBOLS[role] ?? role}${unit ? ", " + prefix + unit : ""}`], { bottom: last ? 36 : 18, left: 56, top: 4 }).axes();
      f.clip((c) => {
        f.curve(t, scaled(m), { colour: colour("ink"), width: 1.3 });
        f.curve(st, scaled(s), { colour: colour("blue"), width: 1.6, dash: [6, 3] });
        f.curve(t, scaled(r), { colour: colour("bad"), width: 0.9 });
        const tick = (x, top, ink) => { c.beginPath(); c.moveTo(f.px(x), top); c.lineTo(f.px(x), top + 6); c.strokeStyle = ink; c.lineWidth = 1.5; c.stroke(); };
        for (const x of col.impacts ?? []) tick(x, f.box.top, colour("ink"));
        for (const x of col.simulated_impacts ?? []) tick(x, f.box.top + 7, colour("blue"));
      });
    });
  }

  /** The open record as tables: each trace measured, simulated and their difference; impacts; what it rests on. */
  tables() {
    const { frame } = this;
    if (!frame || frame.shown === "nothing") return [];
    const name = frame.record.replace(/[^\w.-]+/g, "_"), c = frame.column;
    const table = (what, columns) => {
      const rows = Array.from({ length: Math.max(...columns.map(([, v]) => v?.length ?? 0)) }, (_, i) => columns.map(([, v]) => (v && i < v.length ? v[i] : "")).join(","));
      return { name: `${name}-${what}.csv`, text: [columns.map(([key]) => key).join(","), ...rows, ""].join("\n") };
    };
    if (frame.shown === "decay") return [table("measured", [["time_s", c.t0], ["measured", c.measured0]]), table("fitted", [["time_s", c.t1], ["fitted", c.simulated1]])];
    const traces = frame.traces.map((t, i) => table(t.role.replace(" ", "_"), [["time_s", c["t" + i]], [`measured_${t.unit}`, c["measured" + i]], ["simulated", c["simulated" + i]], ["difference", c["residual" + i]]]));
    return [...traces, table("impacts", [["measured_s", c.impacts], ["simulated_s", c.simulated_impacts]])];
  }

  evidence() {
    const { frame } = this, { evidence: e, stated: s } = frame, box = element("record-evidence");
    const words = (key) => key.replaceAll("_", " ");
    const flat = (o, prefix = "") => Object.entries(o ?? {}).flatMap(([k, v]) => (v === null ? [] : typeof v === "object" ? flat(v, words(k) + ": ") : [[prefix + words(k), typeof v === "number" ? number(v, 4) : String(v)]]));
    const rows = [["drive", s.frequency_hz === null ? "none" : `${number(s.frequency_hz, 6)} Hz`], ["clearance r", s.clearance_m === null ? "not stated" : `${number(1e3 * s.clearance_m, 5)} mm`], ["sweep", s.sweep]];
    if (s.specimen) rows.push(["specimen", s.specimen]);
    if (frame.shown === "decay") {
      const plus = ([v, d]) => `${number(v, 6)} ± ${number(1.96 * d, 2)}`;
      rows.push(["f0, Hz", plus(frame.natural_frequency_hz)], ["β", plus(frame.damping_ratio)]);
    } else rows.push(...flat(e.measures));
    rows.push(["used by", e.used_by.join(", ") || "no method"]);
    const list = make("dl", undefined, "facts");
    list.append(...facts(rows));
    const faults = [...(e.undetermined && frame.shown !== "decay" ? [`Undetermined: ${e.undetermined}`] : []), ...e.left_out.map((reason) => `Left out: ${reason}`)];
    const notes = [...faults.map((text) => make("p", text, "bad")), ...e.flags.map((f) => make("p", `${f.message}; ${f.remedy}.`, f.excludes ? "bad" : "note"))];
    const key = make("p", frame.shown === "decay" ? "Solid: measured; blue dashed: the fitted decay." : frame.shown === "nothing" ? "" : frame.not_simulated ? "Solid: measured; ticks: impacts." : "Solid: measured; blue dashed: simulated at the sliders; thin red: their difference; ticks: impacts.", "note");
    box.replaceChildren(key, make("h2", frame.shown === "decay" ? "Fit" : "What the label rests on"), list, ...notes);
  }

  residuals(frame) {
    this.residual = frame.none ? null : frame;
    if (!this.fit) return;
    element("residuals").replaceChildren(...(frame.none ? [make("span", `No residuals at the sliders: ${frame.none}.`)] : this.misfits(frame)), button("Back to the fit (Z)", () => this.app.backToFit()));
    this.app.legend();
    this.app.map.redraw();
  }

  /** Residuals of the joint fit and of each method, and the boundaries past their brackets. */
  misfits(frame) {
    // a method that the joint fit trusts less than its own noise is judged as the joint fit weighs it
    const item = (name, rms, tip, { weight, apart, remarks = [] } = {}) => {
      const span = make("span"), weighed = weight ?? 1, aside = apart && rms > 2;
      const value = make("b", rms === null ? "no model" : number(rms, 3), rms === null || rms * Math.sqrt(weighed) > 2 ? "worse" : aside ? "" : "fits");
      span.append(`${name} `, value, aside ? ` (${apart})` : "");
      const larger = weighed > 0 && weighed < 0.5 ? [`the joint fit takes its errors ${number(1 / Math.sqrt(weighed), 2)} times as large`] : [];
      span.title = [tip, ...larger, ...remarks].join("; ");
      return span;
    };
    const parts = frame.methods.map((m) => item(m.method, m.rms, `${m.count} residuals over their standard errors, root mean square${m.without ? `; ${m.without} observations have no such motion here` : ""}`, m));
    if (frame.joint !== null) parts.unshift(item("Joint", frame.joint, "root mean square of all weighted residuals of the joint fit"));
    const known = frame.brackets.filter((b) => b.boundary_hz !== null), past = known.filter((b) => b.past_hz > 0);
    const most = Math.max(0, ...past.map((b) => b.past_hz));
    if (known.length) parts.push(make("span", `Boundaries: ${past.length} of ${known.length} past their brackets${past.length ? `, by up to ${number(most, 3)} Hz` : ""}`));
    return [make("span", "Residuals at the sliders:"), ...parts];
  }
}
