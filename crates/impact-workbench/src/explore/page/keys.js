// Every key with what it does; the letters of NON-1-SIM are kept.

/** [keys, text, action(app)] */
export const KEYS = [
  ["0 … 9", "study pictures: the demos' first pictures", null],
  ["a", "initial conditions X, X′, Y, Y′, φ", (app) => app.dialogs.initial()],
  ["b", "parameters of the system: R, β, asymmetries", (app) => app.dialogs.system()],
  ["c", "parameters of the picture: ranges of η and ρ", (app) => app.dialogs.picture()],
  ["d", "parameters of the simulation: periods, settling, steps", (app) => app.dialogs.simulation()],
  ["e", "restitution R(v): constant, table, formula", (app) => app.dialogs.law()],
  ["g", "series, phase portrait, Poincaré map; run or stop the motion", (app) => app.running()],
  ["h", "characteristics over η at the cursor's ρ", (app) => app.along("eta")],
  ["i", "characteristics over ρ at the cursor's η", (app) => app.along("rho")],
  ["l", "characteristics along a line: drag it, or L again for cursor to cursor", (app) => app.drawLine()],
  ["v", "the lowest characteristic: Lyapunov exponent, autocorrelation, X′ before impacts, phase without impacts", (app) => app.otherCharacteristic()],
  ["o", "set the trajectory at the cursor into the characteristics, or take it out", (app) => app.inset()],
  ["n", "starts of the basins: ranges, number, which masses", (app) => app.dialogs.starts()],
  ["s", "basins of attraction at the cursor", (app) => app.panel("basins")],
  ["m", "the motion at the cursor", (app) => app.panel("motion")],
  ["f", "demos of the program", (app) => app.dialogs.demos()],
  ["k", "record a demo; again: save it", (app) => app.player.record()],
  ["j", "replay the recorded demo, or one from a file", (app) => app.player.replay()],
  ["arrows", "move η and ρ, the motion carried along; Shift: ten steps; Ctrl: a tenth", null],
  ["+", "zoom in; wheel: at the pointer; Shift and drag: move the picture", (app) => app.zoom(1 / 1.25)],
  ["-", "zoom out", (app) => app.zoom(1.25)],
  ["Home", "all of the plane, or all records", (app) => app.home()],
  ["q", "start again from rest at the cursor", (app) => app.start({ x: 0, vx: 0, y: 0, vy: 0 }, 0)],
  ["w", "map from rest or from a lively start", (app) => app.mapFrom(app.state.map_start.vx === 0 ? 3 : 0)],
  ["u", "phase of the Poincaré map, by an eighth of the period", (app) => app.set({ poincare_phase: (app.state.poincare_phase + Math.PI / 4) % (2 * Math.PI) }, ["motion"])],
  ["[", "campaign: the record before", (app) => app.campaign?.step(-1)],
  ["]", "campaign: the record after", (app) => app.campaign?.step(1)],
  ["Enter", "campaign: the record nearest the cursor", (app) => app.nearest()],
  ["p", "campaign: settings to measure next", (app) => app.propose()],
  ["z", "campaign: back to the fit", (app) => app.backToFit()],
  ["x", "export what is shown: PNG, SVG, CSV, study", (app) => app.dialogs.exports()],
  ["t", "light or dark", (app) => app.theme()],
  ["?", "this menu", (app) => app.dialogs.help()],
  ["Esc", "stop what runs; close", (app) => app.stop()],
];

/** What a key does, with the key. */
export const titleOf = (key) => `${KEYS.find(([k]) => k === key)[1]} (${key.toUpperCase()})`;

/** Keys by another name than in the list. */
const ALIASES = { "=": "+", "−": "-", Escape: "Esc" };

/** What a held key does again. */
const AGAIN = /^(Arrow.*|[-+=−[\]])$/;
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

/** Do what a key means; whether it means anything. */
export function press(app, key, event) {
  if (/^[0-9]$/.test(key)) { app.player.picture(Number(key)); return true; }
  const lower = key.length === 1 ? key.toLowerCase() : key;
  if (ARROWS[key]) { app.nudge(...ARROWS[key], event ?? {}); return true; }
  const action = KEYS.find(([k]) => k === (ALIASES[lower] ?? lower))?.[2];
  if (!action) return false;
  action(app);
  return true;
}

/** Listen to the keyboard; fields keep their own keys. */
export function listen(app) {
  document.addEventListener("keydown", (event) => {
    if (document.body.classList.contains("gone")) return;
    const target = event.target, kind = target.tagName;
    const closed = target.closest("dialog") && !document.getElementById("dialog").open;
    const writes = !closed && (kind === "TEXTAREA" || (kind === "SELECT" && event.key !== "Escape") || (kind === "INPUT" && target.type !== "range"));
    if (document.getElementById("dialog").open || writes || (event.repeat && !AGAIN.test(event.key))) return;
    if (target.id === "basins" && ARROWS[event.key]) { app.basins.nudge(...ARROWS[event.key], event); event.preventDefault(); return; }
    const slides = kind === "INPUT" && target.type === "range";
    const own = slides && (event.key.startsWith("Arrow") || event.key === "Home");
    const presses = (kind === "BUTTON") && (event.key === "Enter" || event.key === " ");
    const tabs = target.getAttribute("role") === "tab" && event.key.startsWith("Arrow");
    if (own || presses || tabs || event.altKey || event.metaKey || (event.ctrlKey && !event.key.startsWith("Arrow"))) return;
    if (press(app, event.key, event)) event.preventDefault();
  });
}
