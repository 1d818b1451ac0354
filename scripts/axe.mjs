// axe on the explorer's page: every panel and the dialogs, in light and in dark. See check-browser.
import fs from "node:fs";
import { chromium } from "playwright-core";

const [url, executablePath] = process.argv.slice(2);
const flags = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
const browser = await chromium.launch({ executablePath, args: flags });
let serious = 0;
for (const colorScheme of ["light", "dark"]) {
  const context = await browser.newContext({ bypassCSP: true, viewport: { width: 1280, height: 800 }, colorScheme });
  const page = await context.newPage();
  await page.goto(url);
  await page.waitForFunction(() => window.impactid?.ready === true);
  await page.addScriptTag({ content: fs.readFileSync("node_modules/axe-core/axe.min.js", "utf8") });
  for (const key of ["m", "h", "s", "Enter", "a", "b", "e", "f", "x", "?"]) {
    await page.keyboard.press("Escape");
    await page.keyboard.press(key);
    await page.waitForTimeout(1500);
    for (const found of (await page.evaluate(() => axe.run())).violations) {
      if (["serious", "critical"].includes(found.impact)) serious++;
      console.log(`${colorScheme} ${key}: ${found.impact} ${found.id}: ${found.nodes.map((n) => n.target).join(", ")}`);
    }
  }
  await context.close();
}
await browser.close();
console.log(serious ? `${serious} serious faults` : "nothing serious");
process.exit(serious ? 1 : 0);
