// The way to the server: its token, and what to do where it is wrong or the server is gone.
import { kept, make } from "./fields.js";

/** Time between two looks at whether the server is back, ms. */
const AGAIN = 1500;
const TOKEN = /[0-9a-f]{32}/;

/** Whether a token opens the door: "open", "wrong", "full" or "gone". */
async function ask(token) {
  try {
    const { status } = await fetch("/door", { headers: { "x-token": token } });
    return { 204: "open", 403: "wrong", 503: "full" }[status] ?? "gone";
  } catch { return "gone"; }
}

/** The first that opens the door of the tokens at hand, a page's own and that of the newest address that was opened on this
 * port; `null` where none does. */
async function known(token) {
  for (const t of new Set([token, kept("token")])) if (t && (await ask(t)) === "open") { kept("token", t); return t; }
  return null;
}

/** The token for this page: the address' own, one that was kept, or one that is asked for. */
export async function enter(app, token) {
  const found = await known(token);
  if (found) return found;
  const state = await ask(token);
  if (state === "full") app.message("Twelve pages are open, which is the most.", "Close one and load this page again.", true);
  if (state === "gone") lost(app);
  if (state !== "wrong") return new Promise(() => {});
  return new Promise((resolve) => {
    const label = make("label", "Address that `impactid explore` prints "), input = make("input"), fault = make("p", "", "fault");
    const { box } = app.dialogs;
    const show = () => app.dialogs.open("Which explorer?", make("p", "This address is that of an explorer that has ended. What it shows is kept: give the address of the one that runs now.", "note"), label, fault);
    // without the address there is nothing to show: the question comes back
    const again = () => { fault.textContent ||= "Without the address this page has nothing to show."; show(); };
    fault.setAttribute("role", "alert"); box.addEventListener("close", again);
    input.type = "text"; input.autocomplete = "off"; label.append(input);
    input.addEventListener("keydown", (e) => { if (e.key === "Enter") { e.preventDefault(); input.blur(); } });
    input.addEventListener("change", async () => {
      const given = TOKEN.exec(input.value)?.[0];
      if (given && (await ask(given)) === "open") { kept("token", given); box.removeEventListener("close", again); box.close(); resolve(given); } else fault.textContent = given ? "The server does not know this token." : "This address has no token: it has 32 digits and letters after t=.";
    });
    show();
  });
}

/** The server is gone: say so until it is back, and then go on with what was shown. */
export function lost(app) {
  document.body.classList.add("gone");
  app.stop();
  app.dialogs.box.close();
  for (const orders of document.querySelectorAll("nav, main")) orders.inert = true;
  app.message("The server is gone: what is shown stays as it is.", "Start `impactid explore` again on the same port; this page goes on as soon as it knows the new address, which another tab may open.", true);
  const timer = setInterval(async () => {
    const token = await known(app.token);
    if (!token) return;
    clearInterval(timer);
    app.token = token;
    if (app.state) history.replaceState(null, "", "#" + app.address());
    location.reload();
  }, AGAIN);
}
