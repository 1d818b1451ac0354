// axe on the explorer's page: every panel and dialog, in light and in dark, on a screen and on a phone. See check-browser.
import fs from "node:fs";
import { chromium } from "playwright-core";

const [url, executablePath] = process.argv.slice(2);
const flags = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
const keys = ["m", "h", "s", "Enter", "a", "b", "c", "d", "e", "n", "f", "x", "?", "l", "g", "2"];
const sizes = [{ width: 1280, height: 800 }, { width: 390, height: 844 }];
const browser = await chromium.launch({ executablePath, args: flags });
let faults = 0;
for (const colorScheme of ["light", "dark"]) for (const viewport of sizes) {
  const context = await browser.newContext({ bypassCSP: true, viewport, colorScheme });
  const page = await context.newPage();
  await page.goto(url);
  await page.waitForFunction(() => window.impactid?.ready === true);
  await page.addScriptTag({ content: fs.readFileSync("node_modules/axe-core/axe.min.js", "utf8") });
  for (const key of keys) {
    await page.keyboard.press("Escape");
    await page.keyboard.press(key);
    await page.waitForTimeout(1500);
    for (const found of (await page.evaluate(() => axe.run())).violations) {
      faults++;
      console.log(`${colorScheme} ${viewport.width} ${key}: ${found.impact} ${found.id}: ${found.nodes.map((n) => n.target).join(", ")}`);
    }
  }
  await context.close();
}
await browser.close();
console.log(faults ? `${faults} faults` : "nothing");
process.exit(faults ? 1 : 0);
