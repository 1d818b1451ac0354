// The page: its state, what asks for what, sliders, demos, exports.
import { Wire } from "./wire.js";
import { MapView } from "./map.js";
import { BasinsPanel, CHARACTERISTICS, LinePanel, MotionPanel, swatch } from "./plots.js";
import { CampaignView } from "./campaign.js";
import { Dialogs } from "./dialogs.js";
import { listen } from "./keys.js";
import { number, FONT, colour, markColour } from "./draw.js";

const element = (id) => document.getElementById(id);
const STATE_VERSION = 1;
/** Points of a boundary. */
const POINTS = 240;
/** Boundaries asked for ahead that are kept. */
const MOST_AHEAD = 8;
/** What of a state the boundaries depend on. */
const planeOf = ({ damping_ratio, restitution, single, asymmetry, view }) =>
  JSON.stringify([damping_ratio, restitution, single, asymmetry, view.eta], (_, v) => (typeof v === "number" ? Number(v.toPrecision(9)) : v));
/** Parts of the state that only the map's uppermost layer shows. */
const CURSOR_PARTS = new Set(["cursor", "line"]);
/** Time without a new motion after which the motions that coexist with it are looked for, ms. */
const PAUSE = 250;
/** Most trajectories that are set into a picture. */
const MOST_INSETS = 12;

class App {
  constructor() {
    this.state = null;
    this.demos = [];
    this.recording = null;
    this.recorded = null;
    this.playing = 0;
    this.ahead = new Map(); // bare boundaries of states that a slider's next step leads to
    this.timings = [];      // { kind, level, drawn, ms, at } of what was asked for and first drawn
    this.dialogs = new Dialogs(this);
    this.map = new MapView(this);
    this.motion = new MotionPanel(this);
    this.line = new LinePanel(this);
    this.basins = new BasinsPanel(this);
  }

  // ---- start ---------------------------------------------------------------
  async open() {
    const saved = new URLSearchParams(location.hash.slice(1));
    this.token = saved.get("t") ?? "";
    if (!/^[0-9a-f]{32}$/.test(this.token)) { this.message("This address has no token: use the one that `impactid explore` prints.", "", true); return; }
    this.wire = new Wire(this.token, (f, slot, since) => this.receive(f, slot, since), () => this.message("The server is gone.", "Start `impactid explore` again and open the address that it prints.", true));
    await this.wire.opened;
    const hello = await this.wire.once({ kind: "hello" });
    this.first = hello.state; this.demos = hello.demos;
    if (hello.campaign) {
      this.campaign = new CampaignView(this, hello.campaign);
      element("title").textContent = hello.campaign.name + (hello.campaign.synthetic ? " (simulated)" : "");
      element("tab-record").hidden = false;
    }
    const restored = this.restored(saved.get("s"));
    this.state = restored ?? structuredClone(hello.state);
    this.sliders();
    listen(this);
    this.buttons();
    this.restorePanel();
    this.refresh(["map", "boundaries", restored ? "motion" : "carried", "panel", "residuals"]);
    for (const note of hello.notes) this.message(note, "");
    if (hello.demo) this.play(await this.wire.once({ kind: "read_demo", text: hello.demo }));
    this.ready = true;
    if (this.early) this.arrived(this.early);
  }

  restored(text) {
    if (!text) return null;
    try {
      const state = JSON.parse(text);
      if (state.version !== STATE_VERSION) { this.message(`The address holds a state of version ${state.version}; this program reads version ${STATE_VERSION}.`, "Open it with the version of impactid that made it; this page starts afresh."); return null; }
      return state;
    } catch (error) {
      this.message("The state in the address cannot be read.", String(error));
      return null;
    }
  }

  // ---- state ---------------------------------------------------------------
  set(part, what) {
    this.state = { ...this.state, ...part };
    this.save();
    this.note();
    // a picture that is about to come need not be drawn before
    if (!what.includes("boundaries") || part.view) this.map.redraw(...(CURSOR_PARTS.has(Object.keys(part).join()) ? ["cursor"] : []));
    this.refresh(what);
  }

  save() {
    clearTimeout(this.saving);
    this.saving = setTimeout(() => history.replaceState(null, "", "#" + this.address()), 250);
  }

  address() { return `t=${this.token}&s=${encodeURIComponent(JSON.stringify(this.state))}`; }

  /** Ask again for what has changed. */
  refresh(what) {
    const s = () => this.state;
    for (const kind of what) {
      if (kind === "map") this.wire.ask("map", { kind: "map" }, s());
      else if (kind === "boundaries") this.boundaries();
      else if (kind === "motion") this.wire.askAfter("motion", () => [{ kind: "motion", carried_from: null }, s()]);
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
    if (panel === "line" && this.state.line) { this.wire.ask("line", { kind: "line" }, this.state); this.line.fetchInsets(); }
    if (panel === "basins") this.wire.ask("basins", { kind: "basins" }, this.state);
    if (panel === "record" && this.campaign && this.state.record) this.wire.askAfter("record", () => [{ kind: "record" }, this.state]);
  }

  /** Once the cursor rests, what other starts settle on. */
  coexisting() {
    clearTimeout(this.resting);
    if (this.state.panel === "motion") this.resting = setTimeout(() => { if (!this.run) this.wire.ask("coexisting", { kind: "coexisting" }, this.state); }, PAUSE);
  }

  /** Where the motion was when the answer before came. */
  from() { return this.at ?? [this.state.cursor.eta, this.state.cursor.rho]; }

  receive(frame, slot, since) {
    if (frame.kind === "campaign") { this.arrived(frame); return; }
    if (frame.kind === "refused") { this.message(frame.message, frame.remedy); return; }
    const time = (kind, level) => this.timed(kind, level, since);
    if (frame.kind === "map") {
      const tile = this.map.tile(frame);
      this.progress(tile);
      if (tile.complete) time("map", frame.level);
    } else if (frame.kind === "boundaries") { this.map.bare(frame); time("boundaries", 0); }
    else if (frame.kind === "boundary") { this.map.boundary(frame); if (frame.last) time("boundaries", 1); }
    else if (frame.kind === "motion") { this.carriedTo(frame); this.motion.show(frame); time("motion", 0); this.coexisting(); }
    else if (frame.kind === "run") { this.carriedTo(frame); this.motion.run(frame); this.runOn(); }
    else if (frame.kind === "coexisting") this.motion.others(frame);
    else if (frame.kind === "line") { this.line.add(frame); }
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
    this.state = { ...this.state, cursor: { ...cursor, start: frame.cursor.start, phase: frame.cursor.phase } };
    if (frame.motion) this.shown = frame;
    this.save();
    this.note();
  }

  note() {
    const { cursor, restitution, damping_ratio } = this.state, z = this.shown?.motion;
    const box = element("readout"), bold = document.createElement("span");
    bold.className = "z";
    if (z) { bold.textContent = `z = ${z.label}`; bold.style.color = markColour(z); }
    const rig = this.scale();
    const hz = rig ? ` = ${number(cursor.eta * rig.natural_frequency_hz, 5)} Hz` : "", mm = rig ? ` = ${number(1e3 * cursor.rho * rig.static_deflection_m, 4)} mm` : "";
    const r = typeof restitution === "number" ? number(restitution, 4) : "R(v)";
    box.replaceChildren(bold, ` at η = ${number(cursor.eta, 5)}${hz}, ρ = ${number(cursor.rho, 5)}${mm}; R = ${r}, β = ${number(damping_ratio, 4)}`);
  }

  progress(tile) {
    const bar = element("progress"), share = tile.filled / tile.cells.length;
    bar.hidden = share >= 1; bar.style.width = `${100 * share}%`;
    bar.setAttribute("aria-valuenow", String(Math.round(100 * share)));
  }

  // ---- what a user does ------------------------------------------------------
  moved() { return ["carried", ...(this.state.panel === "basins" ? ["panel"] : [])]; }

  /** Move the cursor and carry the motion along. */
  carry(eta, rho) {
    if (!(eta > 0)) return;
    this.set({ cursor: { ...this.state.cursor, eta, rho } }, this.run ? [] : this.moved());
  }

  nudge(de, dr, event) {
    const { view, cursor } = this.state, by = event.shiftKey ? 10 : event.ctrlKey ? 0.1 : 1;
    const step = (range) => by * (range[1] - range[0]) / 200;
    const eta = Math.max(1e-3, cursor.eta + de * step(view.eta)), rho = cursor.rho + dr * step(view.rho);
    this.carry(eta, rho);
    if (eta < view.eta[0] || eta > view.eta[1] || rho < view.rho[0] || rho > view.rho[1]) {
      const mid = (r) => (r[1] - r[0]) / 2;
      this.look([Math.max(1e-3, eta - mid(view.eta)), Math.max(1e-3, eta - mid(view.eta)) + 2 * mid(view.eta)], [rho - mid(view.rho), rho + mid(view.rho)]);
    }
  }

  /** Start the motion afresh, and show it unsettled. */
  start(start, phase) {
    const { cursor } = this.state;
    this.at = null;
    this.set({ cursor: { ...cursor, start, phase: phase ?? cursor.phase } }, ["motion"]);
    if (this.state.panel === "basins") this.basins.draw();
  }

  /** Change the machine: everything follows, the motion is carried along. */
  parameters(part) {
    this.set(part, ["map", "boundaries", ...(this.run ? [] : ["carried"]), "residuals", "panel"]);
    this.showSliders();
  }

  look(eta, rho) {
    if (!(eta[0] > 0)) eta = [1e-3, eta[1] - eta[0] + 1e-3];
    if (!(eta[1] > eta[0] && rho[1] > rho[0])) { this.message("A range must rise.", "Give a greater upper end."); return; }
    this.set({ view: { eta, rho } }, ["map", "boundaries"]);
  }

  zoom(by, eta, rho) {
    const { view, cursor } = this.state;
    const about = (r, at) => [at - by * (at - r[0]), at + by * (r[1] - at)];
    const e = about(view.eta, eta ?? cursor.eta);
    this.look([Math.max(1e-3, e[0]), e[1]], about(view.rho, rho ?? cursor.rho));
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

  along(key) {
    const { view, cursor } = this.state;
    const line = key === "eta" ? { eta: view.eta, rho: [cursor.rho, cursor.rho] } : { eta: [cursor.eta, cursor.eta], rho: view.rho };
    this.state = { ...this.state, line: { ...line, steps: this.state.line?.steps ?? 200 } };
    this.panel("line");
  }

  /** The next drag on the map draws the line; a second L takes the cursor before and now as its ends. */
  drawLine() {
    const { cursor } = this.state;
    if (this.map.drawing) {
      this.map.drawing = false;
      const [eta, rho] = this.lineFrom;
      this.state = { ...this.state, line: { eta: [eta, cursor.eta], rho: [rho, cursor.rho], steps: this.state.line?.steps ?? 200 } };
      this.panel("line");
      return;
    }
    this.map.drawing = true;
    this.lineFrom = [cursor.eta, cursor.rho];
    this.said("drag the line on the map, or move the cursor with the arrows and press L again");
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

  toggleStart() {
    const rest = this.state.map_start.vx === 0;
    const v = rest ? 3 : 0;
    this.said(rest ? "the map is computed from X′ = Y′ = 3" : "the map is computed from rest");
    this.set({ map_start: { x: 0, vx: v, y: 0, vy: v } }, ["map"]);
  }

  strobe() {
    const next = (this.state.poincare_phase + Math.PI / 4) % (2 * Math.PI);
    this.set({ poincare_phase: next }, ["motion"]);
  }

  /** Run the motion in real time, or stop it. */
  running() {
    if (this.state.panel !== "motion") this.panel("motion");
    this.run = !this.run;
    document.querySelector('[data-key="g"]').setAttribute("aria-pressed", String(this.run));
    if (this.run) { this.motion.live = null; this.last = performance.now(); this.runOn(); } else this.refresh(["motion"]);
  }

  runOn() {
    if (!this.run) return;
    requestAnimationFrame((now) => {
      const periods = Math.min(2, Math.max(0.02, 2.2 * (now - this.last) / 1000));
      this.last = now;
      this.wire.askAfter("motion", () => [{ kind: "run", periods }, this.state]);
    });
  }

  stop() {
    if (this.run) this.running();
    this.playing++;
    this.map.drawing = false;
    element("caption").hidden = true; element("message").hidden = true;
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
    const fit = this.campaign?.fit;
    if (!fit) return;
    this.parameters({ restitution: fit.restitution, damping_ratio: fit.damping_ratio, rig: { natural_frequency_hz: fit.natural_frequency_hz, static_deflection_m: fit.static_deflection_m } });
  }

  /** More records were fitted. Sliders and view that are still where the fit before put them follow. */
  arrived(frame) {
    if (!this.ready) { this.early = frame; return; }
    if (!this.campaign) return;
    const same = (a, b) => JSON.stringify(a) === JSON.stringify(b);
    const { restitution, damping_ratio, rig, view } = this.state, first = this.first;
    const atFit = same([restitution, damping_ratio, rig], [first.restitution, first.damping_ratio, first.rig]);
    const atView = same(view, first.view);
    this.first = frame.state;
    this.campaign.replace(frame.campaign);
    const next = frame.state;
    if (atFit) this.parameters({ restitution: next.restitution, damping_ratio: next.damping_ratio, rig: next.rig });
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

  // ---- demos ---------------------------------------------------------------------
  record() {
    const button = document.querySelector('[data-key="k"]');
    if (!this.recording) {
      this.recording = { steps: [], since: performance.now(), last: structuredClone(this.state) };
      this.sampler = setInterval(() => this.sample(), 250);
      button.setAttribute("aria-pressed", "true");
      this.said("recording; K again saves the demo");
      return;
    }
    clearInterval(this.sampler);
    this.sample(true);
    const { steps } = this.recording;
    this.recording = null;
    button.setAttribute("aria-pressed", "false");
    this.wire.once({ kind: "write_demo", title: "Recorded in the explorer", steps }, this.state).then((f) => {
      this.recorded = f.text;
      download("demo.toml", f.text, "application/toml");
      this.said(`${steps.length} steps recorded; J replays them`);
    }, (error) => this.message(error.message, error.remedy));
  }

  sample(always) {
    const r = this.recording, now = performance.now();
    if (!always && JSON.stringify(r.last) === JSON.stringify(this.state)) return;
    r.steps.push([(now - r.since) / 1000, r.last]);
    r.since = now; r.last = structuredClone(this.state);
    if (always) r.steps.push([1, r.last]);
  }

  async replay() {
    if (this.recorded) { this.play(await this.wire.once({ kind: "read_demo", text: this.recorded })); return; }
    const input = element("file");
    input.onchange = async () => {
      const file = input.files[0];
      input.value = "";
      if (!file) return;
      try { this.play(await this.wire.once({ kind: "read_demo", text: await file.text() })); } catch (error) { this.message(error.message, error.remedy); }
    };
    input.click();
  }

  async demo(name) { this.play(await this.wire.once({ kind: "demo", name })); }

  /** The first picture of a demo. */
  async picture(n) {
    const name = this.demos.find((d) => d.startsWith(`${n} `));
    if (!name) return;
    const demo = await this.wire.once({ kind: "demo", name });
    this.playing++;
    this.step(demo.steps[0]);
    this.said(demo.steps[0].caption);
  }

  async play(demo) {
    const mine = ++this.playing;
    for (const step of demo.steps) {
      this.step(step);
      if (step.caption) this.said(step.caption, 1e6);
      await new Promise((resolve) => setTimeout(resolve, 1000 * step.seconds));
      if (this.playing !== mine) return;
    }
    this.said(`end of “${demo.title}”`);
  }

  step({ state, carry }) {
    const before = this.state;
    const same = (key) => JSON.stringify(state[key]) === JSON.stringify(before[key]);
    const machine = ["damping_ratio", "restitution", "single", "asymmetry"].every(same);
    const next = { ...state, rig: state.rig ?? before.rig, record: state.record ?? before.record };
    for (const key of ["rig", "record"]) if (next[key] === undefined || next[key] === null) delete next[key];
    if (carry) next.cursor = { ...state.cursor, start: before.cursor.start, phase: before.cursor.phase };
    else this.at = null;
    this.state = next;
    this.save(); this.note(); this.showSliders(); this.restorePanel(); this.map.redraw();
    const plane = machine && same("view") && same("map_start") ? [] : ["map", "boundaries"];
    const line = state.panel === "line" && machine && same("line") && same("panel") && same("watch");
    this.refresh([...plane, carry ? "carried" : "motion", ...(line ? [] : ["panel"]), "residuals"]);
  }

  // ---- exports ---------------------------------------------------------------------
  async exportFiles(file) {
    this.said("computing the files");
    try {
      const found = await this.wire.once({ kind: "export", file }, this.state);
      for (const f of found.files) download(f.name, f.text, "text/plain");
      this.said(`${found.files.map((f) => f.name).join(", ")}`);
    } catch (error) { this.message(error.message, error.remedy); }
  }

  /** Every picture of the page in one PNG, with its readout. */
  png() {
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

  async copyAddress() {
    history.replaceState(null, "", "#" + this.address());
    try { await navigator.clipboard.writeText(location.href); this.said("the address is on the clipboard"); } catch { this.said("copy the address from the browser's bar"); }
  }

  // ---- looks ---------------------------------------------------------------------
  theme() {
    const root = document.documentElement;
    root.dataset.theme = root.dataset.theme === "dark" ? "light" : "dark";
    try { localStorage.setItem("theme", root.dataset.theme); } catch { /* a private window keeps none */ }
    this.map.redraw(); this.restorePanel(); this.note(); this.legend(this.legendStyles ?? []);
  }

  legend(styles) {
    this.legendStyles = styles;
    const place = (s) => s.order[0] * 1e6 + s.order[1] * 1e3 + s.order[2];
    const items = [...styles].sort((a, b) => place(a) - place(b)).map((s) => swatch(s, `z = ${s.label}`));
    for (const kind of this.map.kinds()) {
      const span = document.createElement("span"), canvas = document.createElement("span");
      canvas.style.cssText = `width:1.6rem;border-top:${kind.width}px ${kind.dash ? "dashed" : "solid"} ${colour(kind.colour)}`;
      const text = document.createElement("span");
      kind.text.split("*").forEach((t, i) => { const e = document.createElement(i % 2 ? "i" : "span"); e.textContent = t; text.append(e); });
      text.style.gap = "0"; span.append(canvas, text); items.push(span);
    }
    element("legend").replaceChildren(...items);
  }

  said(text, ms = 4000) {
    const box = element("caption");
    clearTimeout(this.saying);
    box.textContent = text; box.hidden = !text;
    this.saying = setTimeout(() => { box.hidden = true; }, ms);
  }

  message(text, remedy, fixed = false) {
    const box = element("message"), close = document.createElement("button");
    close.textContent = "Close"; close.type = "button";
    close.addEventListener("click", () => { box.hidden = true; });
    box.dataset.fixed = fixed ? "yes" : "no";
    box.replaceChildren(`${text} ${remedy ?? ""}`, close);
    box.hidden = false;
    clearTimeout(this.closing);
    if (!fixed) this.closing = setTimeout(() => { box.hidden = true; }, 15_000);
  }

  // ---- sliders ---------------------------------------------------------------------
  sliders() {
    const fit = this.first.rig;
    const asym = (key) => [() => this.state.asymmetry[key], (v) => ({ asymmetry: { ...this.state.asymmetry, [key]: v } })];
    const rig = (key) => [() => this.state.rig[key], (v) => ({ rig: { ...this.state.rig, [key]: v } })];
    const constant = () => (typeof this.state.restitution === "number" ? this.state.restitution : null);
    const rows = [
      ["restitution R", 0, 1, 0.001, constant, (v) => ({ restitution: v })],
      ["damping β", 0, 0.3, 0.0005, () => this.state.damping_ratio, (v) => ({ damping_ratio: v })],
    ];
    if (fit) {
      const f0 = fit.natural_frequency_hz, xst = fit.static_deflection_m;
      rows.push(["f₀, Hz", 0.8 * f0, 1.2 * f0, f0 / 5000, ...rig("natural_frequency_hz")], ["x_st, mm", 600 * xst, 1400 * xst, xst / 5, () => 1e3 * this.state.rig.static_deflection_m, (v) => ({ rig: { ...this.state.rig, static_deflection_m: v / 1e3 } })]);
    }
    if (!fit || !this.first.single) {
      rows.push(["drive Y/X", 0.8, 1.2, 0.001, ...asym("drive_amplitude")], ["stiffness Y/X", 0.8, 1.2, 0.001, ...asym("stiffness")]);
      if (!fit) rows.push(["mass Y/X", 0.5, 2, 0.001, ...asym("mass")]);
    }
    this.rows = rows.map(([name, low, high, step, get, put]) => {
      const row = document.createElement("div"), range = document.createElement("input"), text = document.createElement("input"), label = document.createElement("span");
      row.className = "slider";
      label.textContent = name;
      Object.assign(range, { type: "range", min: low, max: high, step });
      Object.assign(text, { type: "text", inputMode: "decimal" });
      range.setAttribute("aria-label", name); text.setAttribute("aria-label", `${name}, typed`);
      const next = () => this.lookAhead([-step, step].map((by) => ({ ...this.state, ...put(Number((Number(range.value) + by).toPrecision(12))) })));
      range.addEventListener("focus", next);
      range.addEventListener("input", () => { this.parameters(put(Number(range.value))); next(); });
      text.addEventListener("change", () => {
        const v = Number(text.value.replace(",", ".")), good = text.value.trim() !== "" && Number.isFinite(v);
        text.setAttribute("aria-invalid", String(!good));
        if (good) this.parameters(put(v));
      });
      text.addEventListener("keydown", (e) => { if (e.key === "Enter") { e.preventDefault(); text.blur(); } });
      row.append(label, range, text);
      return { row, range, text, get };
    });
    element("sliders").replaceChildren(...this.rows.map((r) => r.row));
    element("sliders").addEventListener("submit", (e) => e.preventDefault());
    this.showSliders();
  }

  showSliders() {
    for (const { range, text, get } of this.rows ?? []) {
      const v = get();
      range.disabled = v === null;
      if (v === null) { text.value = "R(v)"; continue; }
      if (document.activeElement !== range) range.value = v;
      if (document.activeElement !== text) text.value = String(Number(v.toPrecision(7)));
      text.setAttribute("aria-invalid", "false");
    }
  }

  buttons() {
    const act = { g: () => this.running(), f: () => this.dialogs.demos(), k: () => this.record(), j: () => this.replay(), x: () => this.dialogs.exports(), t: () => this.theme(), "?": () => this.dialogs.help() };
    for (const b of document.querySelectorAll("nav button")) b.addEventListener("click", () => act[b.dataset.key]());
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

function download(name, content, type) {
  const link = document.createElement("a"), blob = content instanceof Blob ? content : new Blob([content], { type });
  link.href = URL.createObjectURL(blob); link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

let theme = null;
try { theme = localStorage.getItem("theme"); } catch { /* a private window keeps none */ }
document.documentElement.dataset.theme = theme ?? (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
const app = new App();
window.impactid = app;
app.open();
