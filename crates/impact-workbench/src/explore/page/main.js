// The page: its state, what asks for what, sliders, demos, exports.
import { Wire } from "./wire.js";
import { MapView } from "./map.js";
import { BasinsPanel, CHARACTERISTICS, LinePanel, MotionPanel, swatch } from "./plots.js";
import { CampaignView } from "./campaign.js";
import { Dialogs } from "./dialogs.js";
import { listen, press, titleOf } from "./keys.js";
import { enter, lost } from "./door.js";
import { Demos } from "./demos.js";
import { Sliders, button, element, hasLength, kept, make, refusedInField, sentence } from "./fields.js";
import { fit, number, named, colour, markColour } from "./draw.js";
import { formulaOf, tableOf } from "./formula.js";

/** Points of a boundary. */
const POINTS = 240;
/** Boundaries asked for ahead that are kept. */
const MOST_AHEAD = 8;
/** What of a state the boundaries depend on. */
const planeOf = ({ damping_ratio, restitution, single, asymmetry, view }) =>
  JSON.stringify([damping_ratio, restitution, single, asymmetry, view.eta], (_, v) => (typeof v === "number" ? Number(v.toPrecision(9)) : v));
/** The machine and its rig, of a state. */
const machineOf = ({ restitution, damping_ratio, single, asymmetry, rig }) => ({ restitution, damping_ratio, single, asymmetry, rig });
/** What is asked for where anything may have changed. */
const EVERYTHING = ["map", "boundaries", "carried", "panel", "residuals"];
/** Parts of the state that only the map's uppermost layer shows. */
const CURSOR_PARTS = new Set(["cursor", "line"]);
/** Time without a new motion after which the motions that coexist with it are looked for, ms. */
const PAUSE = 250;
/** Time between two looks at what a running motion is, ms. */
const LOOK = 200;
/** What to do while a line is drawn. */
const DRAW = "drag the line on the map, or move the cursor with the arrows and press L again";
/** Most trajectories that are set into a picture. */
const MOST_INSETS = 12;

class App {
  constructor() {
    this.state = null;
    this.demos = [];
    this.good = null;       // the newest state that the server took
    this.ahead = new Map(); // bare boundaries of states that a slider's next step leads to
    this.timings = [];      // { kind, level, drawn, ms, at } of what was asked for and first drawn
    this.dialogs = new Dialogs(this);
    this.player = new Demos(this);
    this.map = new MapView(this);
    this.motion = new MotionPanel(this);
    this.line = new LinePanel(this);
    this.basins = new BasinsPanel(this);
  }

  // ---- start ---------------------------------------------------------------
  async open() {
    const saved = new URLSearchParams(location.hash.slice(1));
    this.token = await enter(this, saved.get("t") ?? "");
    this.wire = new Wire(this.token, (...of) => this.receive(...of), () => lost(this));
    await this.wire.opened;
    const written = this.written(saved.get("s"));
    const { hello, restored } = await this.hello(written);
    this.first = hello.state; this.demos = hello.demos; this.limits = hello.limits; [, this.wire.most] = hello.limits.message;
    if (hello.title) element("title").textContent = hello.title;
    if (hello.campaign) {
      this.campaign = new CampaignView(this, hello.campaign);
      element("title").textContent = hello.campaign.name + (hello.campaign.synthetic ? " (simulated)" : "");
      element("tab-record").hidden = hello.campaign.records.length === 0;
    }
    document.title = `${element("title").textContent} – impactid explore`;
    this.state = this.here(restored ?? structuredClone(hello.state));
    this.good = this.state;
    this.sliders = new Sliders(this);
    listen(this);
    this.buttons();
    this.restorePanel();
    this.refresh(["map", "boundaries", restored ? "motion" : "carried", "panel", "residuals"]);
    const notes = [...hello.notes, ...(restored ? this.notHere(restored) : [])];
    if (notes.length) this.message(notes.join(" "));
    if (hello.demo) this.player.play(await this.player.read(hello.demo));
    this.ready = true;
    if (this.early) this.arrived(this.early);
  }

  /** The state that an address holds. */
  written(text) {
    if (!text) return null;
    try {
      const state = JSON.parse(text), { formula } = state.restitution ?? {};
      return formula ? { ...state, restitution: { table: tableOf(formula) } } : state;
    } catch (error) { this.message("The state in the address cannot be read.", `${error}; this page starts afresh.`); return null; }
  }

  /** What the server starts from, and the address' state where it takes it. */
  async hello(state) {
    if (state !== null) {
      try { return { hello: await this.wire.once({ kind: "hello" }, state), restored: state }; } catch (error) { this.message(`The state in the address is refused: ${error.message}.`, "This page starts afresh."); }
    }
    return { hello: await this.wire.once({ kind: "hello" }), restored: null };
  }

  // ---- state ---------------------------------------------------------------
  /** A state from elsewhere as it can be shown here: with the scales of the rig that is open, and a record that there is. */
  here({ rig, record, ...state }) {
    const own = this.first.rig, known = this.campaign?.facts.records.some((r) => r.id === record);
    const panel = state.panel === "record" && !known ? "motion" : state.panel;
    return { ...state, panel, ...(own && { rig: rig ?? own }), ...(known && { record }) };
  }

  /** What of the address' state has no place here. */
  notHere({ rig, record }) {
    return [
      ...(this.state.rig && !rig ? ["The address has no f₀ and xₛₜ: those of this campaign are taken."] : []),
      ...(rig && !this.state.rig ? ["The address is that of a campaign, which is not open here: its machine is shown without records."] : []),
      ...(record && this.state.rig && !this.state.record ? [`This campaign has no record ${record}.`] : []),
    ];
  }

  set(part, what) {
    this.state = { ...this.state, ...part };
    this.save();
    this.note();
    this.sliders.show();
    if (this.refusal) { this.refusal = false; element("message").hidden = true; }
    // a picture that is about to come need not be drawn before
    if (!what.includes("boundaries") || part.view) this.map.redraw(...(CURSOR_PARTS.has(Object.keys(part).join()) ? ["cursor"] : []));
    this.refresh(what);
  }

  /** Take over a whole state. */
  become(state, what) {
    this.state = state;
    this.save(); this.note(); this.sliders.show(); this.restorePanel(); this.map.redraw();
    this.refresh(what);
  }

  /** The server refused a state as a whole: the last one that it took counts. */
  refused(frame) {
    if (frame.taken !== false || !refusedInField(frame)) this.message(frame.message, frame.remedy);
    this.refusal = true;
    if (frame.taken === false && this.good) this.become(structuredClone(this.good), EVERYTHING);
    else if (this.run && frame.id === this.wire.newest.motion) this.running();
  }

  save() {
    clearTimeout(this.saving);
    this.saving = setTimeout(() => history.replaceState(null, "", "#" + this.address()), 250);
  }

  /** The page's address: of an R(v) that a formula states, the formula. */
  address() {
    const formula = formulaOf(this.state.restitution), state = formula ? { ...this.state, restitution: { formula } } : this.state;
    return `t=${this.token}&s=${encodeURIComponent(JSON.stringify(state))}`;
  }

  /** Ask again for what has changed. */
  refresh(what) {
    const s = () => this.state;
    for (const kind of what) {
      if (kind === "map") { this.wire.ask("map", { kind: "map" }, s()); this.map.asked(); }
      else if (kind === "boundaries") this.boundaries();
      else if (kind === "motion") this.wire.askAfter("motion", () => { this.chosen = false; return [{ kind: "motion", carried_from: null }, s()]; });
      else if (kind === "carried") this.wire.askAfter("motion", () => [{ kind: "motion", carried_from: this.from() }, s()]);
      else if (kind === "residuals" && this.campaign) this.wire.askAfter("residuals", () => [{ kind: "residuals" }, s()]);
      else if (kind === "panel") this.refreshPanel();
    }
  }

  /** Draw the boundaries at once where they were asked for ahead; ask for them with where they exist. */
  boundaries() {
    const plane = planeOf(this.state), bare = this.ahead.get(plane);
    this.drawnAhead = bare ? plane : null;
    if (bare) { this.map.bare(bare); this.timed("boundaries", 0, this.wire.clock()); }
    this.wire.askAfter("boundaries", () => [{ kind: "boundaries", points: POINTS, known: this.drawnAhead === planeOf(this.state) }, this.state]);
  }

  /** Ask for the boundaries of states that may come next; the oldest are forgotten. */
  lookAhead(states) {
    for (const state of states) {
      const plane = planeOf(state);
      if (this.ahead.has(plane)) continue;
      this.wire.once({ kind: "ahead", points: POINTS }, state).then((frame) => {
        this.ahead.set(plane, frame);
        if (this.ahead.size > MOST_AHEAD) this.ahead.delete(this.ahead.keys().next().value);
      }, () => {});
    }
  }

  refreshPanel() {
    const { panel } = this.state;
    if (!this.motion.coexisting) this.coexisting();
    if (panel === "line" && this.state.line) { this.wire.ask("line", { kind: "line" }, this.state); this.line.fetchInsets(); }
    if (panel === "basins") this.wire.ask("basins", { kind: "basins" }, this.state);
    if (panel === "record" && this.campaign && this.state.record) this.wire.askAfter("record", () => [{ kind: "record" }, this.state]);
  }

  /** Once the cursor rests, what other starts settle on. */
  coexisting() {
    clearTimeout(this.resting);
    if (this.state.panel === "motion") this.resting = setTimeout(() => this.wire.ask("coexisting", { kind: "coexisting" }, this.state), PAUSE);
  }

  /** Where the motion was when the answer before came. */
  from() { return this.at ?? [this.state.cursor.eta, this.state.cursor.rho]; }

  receive(frame, since, asked) {
    if (frame.kind === "campaign") { this.arrived(frame); return; }
    if (frame.kind === "refused") { this.refused(frame); return; }
    if (asked) this.good = asked;
    const time = (kind, level) => this.timed(kind, level, since);
    if (frame.kind === "beside") this.map.coexisting(frame);
    else if (frame.kind === "map") {
      const tile = this.map.tile(frame);
      this.progress(tile);
      if (tile.complete) time("map", frame.level);
    } else if (frame.kind === "boundaries") { this.map.bare(frame); time("boundaries", 0); }
    else if (frame.kind === "boundary") { this.map.boundary(frame); if (frame.last) time("boundaries", 1); }
    else if (frame.kind === "motion") { this.carriedTo(frame); this.motion.show(frame); time("motion", 0); this.coexisting(); this.runOn(); }
    else if (frame.kind === "run") { this.carriedTo(frame); this.motion.run(frame); this.runOn(); }
    else if (frame.kind === "coexisting") this.motion.others(frame);
    else if (frame.kind === "line") this.line.add(frame, asked.line);
    else if (frame.kind === "basins") { this.basins.add(frame); if (frame.level === 1 && this.basins.tile.filled === frame.size[1]) time("basins", 1); }
    else if (frame.kind === "record") { this.campaign.show(frame); time("record", 0); }
    else if (frame.kind === "residuals") { this.campaign.residuals(frame); time("residuals", 0); }
  }

  /** The times from asking until it is drawn, and until the screen's next picture is made of it. What waits for
   * that picture is drawn by callbacks that were asked for before this one. */
  timed(kind, level, since) {
    const atOnce = (kind === "map" || kind === "boundaries") && this.map.due.size === 0 ? performance.now() - since : null;
    requestAnimationFrame(() => {
      const drawn = atOnce ?? performance.now() - since;
      setTimeout(() => this.timings.push({ kind, level, drawn, ms: performance.now() - since, at: performance.now() }));
    });
  }

  /** The motion goes on from where an answer left it; η and ρ may have moved since. */
  carriedTo(frame) {
    const { cursor } = this.state;
    this.at = [frame.cursor.eta, frame.cursor.rho];
    if (!this.chosen) this.state = { ...this.state, cursor: { ...cursor, start: frame.cursor.start, phase: frame.cursor.phase } };
    if (frame.motion) this.shown = frame;
    this.save();
    this.note();
  }

  note() {
    const { cursor, restitution, damping_ratio } = this.state, z = this.shown?.motion;
    const box = element("readout"), bold = make("span", z && named(z), "z");
    if (z) bold.style.color = markColour(z);
    const rig = this.scale();
    const hz = rig ? ` = ${number(cursor.eta * rig.natural_frequency_hz, 5)} Hz` : "", mm = rig ? ` = ${number(1e3 * cursor.rho * rig.static_deflection_m, 4)} mm` : "";
    const law = formulaOf(restitution), r = typeof restitution === "number" ? ` = ${number(restitution, 4)}` : law ? `(v) = ${law}` : `(v): ${Object.keys(restitution)[0].replace("_", " ")}`;
    box.replaceChildren(bold, ` at η = ${number(cursor.eta, 5)}${hz}, ρ = ${number(cursor.rho, 5)}${mm}; R${r}, β = ${number(damping_ratio, 4)}`);
  }

  progress(tile) {
    const bar = element("progress"), share = tile.filled / tile.cells.length;
    bar.hidden = share >= 1; bar.style.width = `${100 * share}%`;
    bar.setAttribute("aria-valuenow", String(Math.round(100 * share)));
  }

  // ---- what a user does ------------------------------------------------------
  /** What follows a move: a running motion goes on by itself, what coexists with it does not. */
  moved() {
    if (this.run) { this.motion.others(null); this.coexisting(); }
    return [...(this.run ? [] : ["carried"]), ...(this.state.panel === "basins" ? ["panel"] : [])];
  }

  /** Move the cursor and carry the motion along. */
  carry(eta, rho) {
    const within = ([low, high], v) => Math.min(high, Math.max(low, v));
    this.set({ cursor: { ...this.state.cursor, eta: within(this.limits.eta, eta), rho: within(this.limits.rho, rho) } }, this.moved());
  }

  nudge(de, dr, event) {
    const { view, cursor } = this.state, by = event.shiftKey ? 10 : event.ctrlKey ? 0.1 : 1;
    const step = (range) => by * (range[1] - range[0]) / 200;
    this.goTo(cursor.eta + de * step(view.eta), cursor.rho + dr * step(view.rho));
  }

  /** Carry the motion to a place, which the view follows. */
  goTo(...to) {
    this.carry(...to);
    const { cursor: { eta, rho }, view } = this.state;
    const about = (at, r) => (r[0] <= at && at <= r[1] ? r : [at - (r[1] - r[0]) / 2, at + (r[1] - r[0]) / 2]);
    const next = [about(eta, view.eta), about(rho, view.rho)];
    if (next[0] !== view.eta || next[1] !== view.rho) this.look(...next);
  }

  /** Start the motion afresh, and show it unsettled. */
  start(start, phase) {
    const { cursor } = this.state;
    this.at = null;
    this.chosen = true; // answers under way are of the start before
    this.set({ cursor: { ...cursor, start, phase: phase ?? cursor.phase } }, ["motion"]);
    if (this.state.panel === "basins") this.basins.draw();
  }

  /** Change the machine: everything follows, the motion is carried along. */
  parameters(part) {
    this.set(part, ["map", "boundaries", "residuals", ...new Set(["panel", ...this.moved()])]);
  }

  /** Show a part of the plane, moved to where it is within the limits. */
  look(eta, rho) {
    const inside = ([a, b], [low, high]) => { const size = Math.min(b - a, high - low), from = Math.max(low, Math.min(a, high - size)); return [from, Math.min(high, from + size)]; };
    this.set({ view: { eta: inside(eta, this.limits.eta), rho: inside(rho, this.limits.rho) } }, ["map", "boundaries"]);
  }

  zoom(by, eta, rho) {
    const { view, cursor } = this.state;
    const about = (r, at) => [at - by * (at - r[0]), at + by * (r[1] - at)];
    const next = [about(view.eta, eta ?? cursor.eta), about(view.rho, rho ?? cursor.rho)];
    if (next.every(([a, b]) => b - a > 1e-9)) this.look(...next);
  }

  home() { this.look(this.first.view.eta, this.first.view.rho); }

  panel(name) {
    if (name === "record" && !this.campaign) return;
    this.set({ panel: name }, []);
    this.restorePanel();
    this.refreshPanel();
  }

  restorePanel() {
    const { panel } = this.state;
    for (const p of ["motion", "line", "basins", "record"]) {
      element("panel-" + p).hidden = p !== panel;
      element("tab-" + p).setAttribute("aria-selected", String(p === panel));
      element("tab-" + p).tabIndex = p === panel ? 0 : -1;
    }
    element("panel").setAttribute("aria-labelledby", "tab-" + panel);
    this.motion.draw(); this.line.draw(); this.basins.draw(); this.campaign?.traces();
  }

  /** The line over η or over ρ through the cursor. */
  ownLine(key) {
    const { view, cursor, line } = this.state;
    const ends = key === "eta" ? { eta: view.eta, rho: [cursor.rho, cursor.rho] } : { eta: [cursor.eta, cursor.eta], rho: view.rho };
    return { ...ends, steps: line?.steps ?? 200 };
  }

  along(key) {
    this.state = { ...this.state, line: this.ownLine(key) };
    this.panel("line");
  }

  /** The next drag on the map draws the line; a second L takes the cursor before and now as its ends. */
  drawLine() {
    const { cursor } = this.state;
    if (this.map.drawing) {
      const [eta, rho] = this.lineFrom, line = { eta: [eta, cursor.eta], rho: [rho, cursor.rho], steps: this.state.line?.steps ?? 200 };
      if (!hasLength(line)) { this.said(`a line has two ends: ${DRAW}`, Infinity); return; }
      this.map.drawing = false;
      this.said("");
      this.state = { ...this.state, line };
      this.panel("line");
      return;
    }
    this.map.drawing = true;
    this.lineFrom = [cursor.eta, cursor.rho];
    this.said(DRAW, Infinity);
  }

  otherCharacteristic(name) {
    const all = Object.keys(CHARACTERISTICS), now = all.indexOf(this.state.characteristic ?? all[0]);
    this.set({ characteristic: name ?? all[(now + 1) % all.length] }, []);
    if (this.state.panel !== "line") { if (this.state.line) this.panel("line"); else this.along("eta"); } else this.line.draw();
  }

  /** Set the trajectory at the cursor into the characteristics, or take it out again. */
  inset() {
    const { cursor } = this.state, insets = this.state.insets ?? [];
    const rest = insets.filter((c) => c.eta !== cursor.eta || c.rho !== cursor.rho);
    if (rest.length === insets.length && insets.length === MOST_INSETS) { this.said("no more than 12 trajectories fit into the picture; O at one of them takes it out"); return; }
    this.set({ insets: rest.length < insets.length ? rest : [...insets, structuredClone(cursor)] }, []);
    if (this.state.panel !== "line" && this.state.line) this.panel("line"); else this.line.fetchInsets();
  }

  ownBasins() {
    const size = 4 * Math.max(1, Math.abs(this.state.cursor.rho));
    return { x: [-size, Math.max(this.state.cursor.rho, -0.9 * size)], vx: [-size, size], cells: [101, 101] };
  }

  mapFrom(v) {
    this.said(v === 0 ? "the map is computed from rest" : `the map is computed from X′ = Y′ = ${number(v)}`);
    this.set({ map_start: { x: 0, vx: v, y: 0, vy: v } }, ["map"]);
  }

  /** Run the motion in real time, or stop it. */
  running() {
    if (this.state.panel !== "motion") this.panel("motion");
    this.run = !this.run;
    document.querySelector('[data-key="g"]').setAttribute("aria-pressed", String(this.run));
    if (this.run) { this.motion.live = null; this.last = performance.now(); this.lookedAt = 0; this.runOn(); } else this.refresh(["carried"]);
  }

  /** Ask for the next stretch with the screen's next picture, unless it is asked for already. */
  runOn() {
    if (!this.run || this.goesOn || this.wire.waiting.motion) return;
    this.goesOn = true;
    requestAnimationFrame(() => {
      this.goesOn = false;
      if (this.run) this.wire.askAfter("motion", () => this.stretch());
    });
  }

  stretch() {
    const now = performance.now(), facts = now - this.lookedAt > LOOK;
    if (facts) this.lookedAt = now;
    const periods = Math.min(2, Math.max(0.02, 2.2 * (now - this.last) / 1000));
    this.last = now;
    return [{ kind: "run", periods, facts }, this.state];
  }

  stop() {
    if (this.run) this.running();
    this.player.stop();
    element("map").focus({ preventScroll: true });
    this.map.drawing = false;
    element("caption").hidden = true;
    if (element("message").dataset.fixed !== "yes") element("message").hidden = true;
  }

  // ---- campaign ----------------------------------------------------------------
  scale() { return this.state?.rig ?? null; }

  choose(record) {
    if (!record) return;
    this.set({ record: record.id }, []);
    this.panel("record");
  }

  nearest() {
    if (!this.campaign || !this.map.frame) return;
    const f = this.map.frame, { eta, rho } = this.state.cursor;
    let best = null, least = Infinity;
    for (const { r, x, y } of this.campaign.placed(f)) {
      const d = Math.hypot(x - f.px(eta), y - f.py(rho));
      if (d < least) { best = r; least = d; }
    }
    this.choose(best ?? this.campaign.facts.records[0]);
  }

  backToFit() {
    if (this.campaign) this.parameters(machineOf(this.first));
  }

  /** More records were fitted. Sliders and view that are still where the fit before put them follow. */
  arrived(frame) {
    if (!this.ready) { this.early = frame; return; }
    if (!this.campaign) return;
    const same = (a, b) => JSON.stringify(a) === JSON.stringify(b);
    const atFit = same(machineOf(this.state), machineOf(this.first)), atView = same(this.state.view, this.first.view);
    this.first = frame.state;
    this.campaign.replace(frame.campaign);
    if (atFit) this.parameters(machineOf(this.first));
    else this.refresh(["residuals"]);
    if (atView) this.home(); else this.map.redraw();
    this.refreshPanel();
    this.said(`${frame.campaign.records.length} records`);
  }

  async propose() {
    if (!this.campaign) return;
    if (this.campaign.proposals.length) { this.campaign.proposals = []; this.map.redraw(); return; }
    this.said("searching the settings to measure next");
    try {
      const found = await this.wire.once({ kind: "proposals" }, this.state);
      this.campaign.proposals = found.proposals;
      const best = found.proposals[0];
      this.said(best ? `measure next: 1 at ${number(best.frequency_hz, 5)} Hz, r = ${number(1e3 * best.clearance_m, 4)} mm; the standard error of R is then ${number(best.restitution_error_after, 2)}` : "nothing can be proposed: R was not fitted");
      this.map.redraw();
    } catch (error) { this.message(error.message, error.remedy); }
  }

  /** Draw every picture now. */
  paint() {
    this.samples(); this.map.redraw(); this.map.draw(); this.motion.paint(); this.line.paint(); this.basins.paint(); this.campaign?.traces();
  }

  // ---- looks ---------------------------------------------------------------------
  theme() {
    const root = document.documentElement;
    root.dataset.theme = root.dataset.theme === "dark" ? "light" : "dark";
    kept("theme", root.dataset.theme);
    this.map.redraw(); this.restorePanel(); this.note(); this.legend();
  }

  legend(styles = this.legendStyles ?? []) {
    this.legendStyles = styles;
    const place = (s) => s.order[0] * 1e6 + s.order[1] * 1e3 + s.order[2], samples = this.campaign?.samples() ?? {};
    const items = [...styles].sort((a, b) => place(a) - place(b)).map((s) => swatch(s, named(s), samples.marks?.get(s.label)));
    for (const kind of this.map.kinds()) {
      const span = make("span"), sample = make("span", undefined, "sample"), text = make("span");
      sample.style.cssText = `width:1.6rem;border-top:${kind.width}px ${kind.dash ? "dashed" : "solid"} ${colour(kind.colour)}`;
      text.append(...kind.text.split("*").map((t, i) => make(i % 2 ? "i" : "span", t)));
      text.style.gap = "0"; span.append(sample, text); items.push(span);
    }
    const { vx } = this.state.map_start, from = vx === 0 ? "cells: from rest" : `cells: from X′ = Y′ = ${number(vx)}`;
    const striped = this.map.other && this.map.other.id === this.wire.newest.map ? "; striped: another motion coexists" : "";
    element("legend").replaceChildren(...items, ...(samples.others ?? []), make("span", from + striped));
    this.samples();
  }

  /** Draw what the legend shows of the campaign. */
  samples() {
    for (const canvas of document.querySelectorAll("#legend canvas")) { const f = fit(canvas); canvas.sample(f.context, f.width, f.height); }
  }

  /** Say something for a time; what a demo says has a row of its own, and belongs to the pictures. */
  said(text, ms = 4000, demo = false) {
    const box = element("caption");
    clearTimeout(this.saying);
    box.textContent = text; box.hidden = !text;
    box.classList.toggle("demo", demo);
    if (ms < Infinity) this.saying = setTimeout(() => { box.hidden = true; if (this.map.drawing) this.said(DRAW, Infinity); }, ms);
  }

  /** A text with what can be done; one that is fixed stays, alone. */
  message(text, remedy, fixed = false) {
    const box = element("message"), close = button("Close", () => { box.hidden = true; });
    if (box.dataset.fixed === "yes" && !fixed) return;
    box.dataset.fixed = fixed ? "yes" : "no";
    box.replaceChildren([text, remedy].filter(Boolean).map(sentence).join(" "), ...(fixed ? [] : [close]));
    box.hidden = false;
    clearTimeout(this.closing);
    if (!fixed) this.closing = setTimeout(() => { box.hidden = true; }, 15_000);
  }

  // ---- buttons ---------------------------------------------------------------------
  buttons() {
    for (const b of document.querySelectorAll("button[data-key]")) {
      b.title = titleOf(b.dataset.key);
      b.addEventListener("click", () => press(this, b.dataset.key));
    }
    element("inset").addEventListener("click", () => this.inset());
    element("characteristic").append(...Object.entries(CHARACTERISTICS).map(([value, c]) => new Option(c.text, value)));
    element("characteristic").addEventListener("change", (e) => this.otherCharacteristic(e.target.value));
    const tabs = [...document.querySelectorAll("[role=tab]")];
    for (const tab of tabs) {
      tab.addEventListener("click", () => (tab.dataset.panel === "line" && !this.state.line ? this.along("eta") : tab.dataset.panel === "record" && !this.state.record ? this.nearest() : this.panel(tab.dataset.panel)));
      tab.addEventListener("keydown", (e) => {
        const by = { ArrowLeft: -1, ArrowRight: 1 }[e.key];
        if (!by) return;
        const shown = tabs.filter((t) => !t.hidden), next = shown[(shown.indexOf(tab) + by + shown.length) % shown.length];
        next.focus(); next.click(); e.preventDefault();
      });
    }
  }
}

document.documentElement.dataset.theme = kept("theme") ?? (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
const app = new App();
window.impactid = app;
app.open();
// another address in the same tab is another page
addEventListener("hashchange", () => location.reload());
