// Demos: recorded, replayed, played step by step.
import { download } from "./exports.js";

/** Parts of a state that describe the machine. */
const MACHINE = ["damping_ratio", "restitution", "single", "asymmetry"];
/** Time between two looks at whether the state has changed, while a demo is recorded, ms. */
const SAMPLE = 250;

export class Demos {
  constructor(app) {
    this.app = app;
    this.recording = null;
    this.recorded = null;
    this.playing = 0;
  }

  record() {
    const { app } = this, button = document.querySelector('[data-key="k"]');
    if (!this.recording) {
      this.recording = { steps: [], since: performance.now(), last: structuredClone(app.state) };
      this.sampler = setInterval(() => this.sample(), SAMPLE);
      button.setAttribute("aria-pressed", "true");
      app.said("recording; K again saves the demo");
      return;
    }
    clearInterval(this.sampler);
    this.sample(true);
    const { steps } = this.recording;
    this.recording = null;
    button.setAttribute("aria-pressed", "false");
    this.once(app.wire.once({ kind: "write_demo", title: "Recorded in the explorer", steps }, app.state), (f) => {
      this.recorded = f.text;
      download("demo.toml", f.text, "application/toml");
      app.said(`${steps.length} steps recorded; J replays them`);
    });
  }

  sample(always) {
    const r = this.recording, now = performance.now(), { state } = this.app;
    if (!always && JSON.stringify(r.last) === JSON.stringify(state)) return;
    r.steps.push([(now - r.since) / 1000, r.last]);
    r.since = now; r.last = structuredClone(state);
    if (always) r.steps.push([1, r.last]);
  }

  replay() {
    const input = document.getElementById("file"), play = (text) => this.once(this.read(text), (demo) => this.play(demo));
    if (this.recorded) { play(this.recorded); return; }
    input.onchange = async () => {
      const [file] = input.files;
      input.value = "";
      if (file) play(await file.text());
    };
    input.click();
  }

  read(text) { return this.app.wire.once({ kind: "read_demo", text }); }

  shipped(name) { return this.app.wire.once({ kind: "demo", name }); }

  /** Do something with what was asked for; where it does not come, say why. */
  once(asked, action) { return asked.then(action, (error) => this.app.message(error.message, error.remedy)); }

  start(name) { return this.once(this.shipped(name), (demo) => { this.play(demo); }); }

  /** The first picture of a demo. */
  picture(n) {
    const name = this.app.demos.find((d) => d.startsWith(`${n} `));
    if (!name) return;
    this.once(this.shipped(name), ({ steps: [first] }) => {
      this.playing++;
      this.step(first);
      this.app.said(first.caption);
    });
  }

  async play(demo) {
    const mine = ++this.playing;
    for (const step of demo.steps) {
      this.step(step);
      if (step.caption) this.app.said(step.caption, Infinity, true);
      await new Promise((resolve) => setTimeout(resolve, 1000 * step.seconds));
      if (this.playing !== mine) return;
    }
    this.app.said(`end of “${demo.title}”`);
  }

  stop() { this.playing++; }

  step({ state, carry }) {
    const { app } = this, before = app.state;
    const same = (key) => JSON.stringify(state[key]) === JSON.stringify(before[key]);
    const machine = MACHINE.every(same);
    const next = app.here({ ...state, rig: state.rig ?? before.rig, record: state.record ?? before.record });
    if (carry) next.cursor = { ...state.cursor, start: before.cursor.start, phase: before.cursor.phase };
    else app.at = null;
    const plane = machine && same("view") && same("map_start") ? [] : ["map", "boundaries"];
    const line = state.panel === "line" && machine && same("line") && same("panel") && same("watch");
    app.become(next, [...plane, carry ? "carried" : "motion", ...(line ? [] : ["panel"]), "residuals"]);
  }
}
