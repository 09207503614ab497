// Opens written pages in a browser, and asserts what holds for every one of them.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { test } from "node:test";

import { chromium } from "playwright-core";

import { assertAccessible } from "./accessible.mjs";

export const [maploop, pictures, executablePath] = process.argv.slice(2);

// Runs a command of maploop to its end.
export function run(...args) {
  const { status, stderr } = spawnSync(maploop, args);
  assert.equal(status, 0, String(stderr));
}

export function launch() {
  return chromium.launch({ executablePath, args: ["--no-sandbox", "--disable-gpu"] });
}

// How long a test waits for what must come, ms: a bound for what hangs, not a demand on a slow computer.
export const patience = 180000;

// An empty page with that patience.
export async function newPage(browser, options) {
  const page = await browser.newPage(options);
  page.setDefaultTimeout(patience);
  return page;
}

// A page that fails the test when its script does, when it complains, or when it asks for anything.
export async function open(browser, file, width, colorScheme = "light") {
  const page = await newPage(browser, { viewport: { width, height: 900 }, colorScheme });
  page.on("pageerror", (e) => assert.fail(`the page's script failed: ${e}`));
  page.on("console", (m) => assert.notEqual(m.type(), "error", m.text()));
  page.on("request", (r) => assert.match(r.url(), /^(file|data):/, "nothing is asked for"));
  await page.goto(pathToFileURL(file).href);
  await page.waitForFunction(() => document.querySelectorAll(".without").length === 0);
  await page.waitForTimeout(300);
  return page;
}

export const isDrawn = (canvas) =>
  canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data.some((v) => v > 0);

// Tests that all of a page is there at the usual widths, light and dark. `counts` is what to wait for: a number for each
// selector.
export function testWholePage(browser, file, name, counts) {
  for (const colours of ["light", "dark"])
    for (const width of [390, 1024, 1920])
      test(`all of ${name} is there ${width} px wide, ${colours}`, async () => {
        const page = await open(browser(), file, width, colours);
        for (const [selector, count] of Object.entries(counts)) {
          const found = await page.locator(selector).count();
          assert.ok(found >= count, `${found} of ${selector}`);
        }
        for (const canvas of await page.$$("canvas"))
          assert.ok(await canvas.evaluate(isDrawn), await canvas.evaluate((c) => c.closest("figure").innerText));
        const overflow = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
        assert.ok(overflow <= 0, `${overflow} px beyond the edge`);
        await page.screenshot({ path: join(pictures, `${name}-${width}-${colours}.png`), fullPage: true });
        await assertAccessible(page, `${name}, ${width} px, ${colours}`);
        await page.close();
      });
}

// The names or texts of what the Tab key comes to.
export async function reachedByKeys(page, presses) {
  const reached = new Set();
  for (let i = 0; i < presses; ++i) {
    await page.keyboard.press("Tab");
    reached.add(await page.evaluate(() => {
      const { ariaLabel, innerText, type, labels } = document.activeElement;
      return ariaLabel || labels?.[0]?.innerText.trim() || innerText || type;
    }));
  }
  return reached;
}

export const cursors = (page, selector) =>
  page.$$eval(`${selector} .u-cursor-x`, (all) => all.map((e) => new DOMMatrix(e.style.transform).m41));

export const slider = (page) => page.getByRole("slider");
export const time = async (page) => Number(await slider(page).inputValue());
export const stretch = (page) => slider(page).evaluate((s) => Number(s.max) - Number(s.min));

// Drags across the middle of a plot, from and to a share of its width.
export async function drag(page, plot, from, to) {
  await plot.scrollIntoViewIfNeeded();
  const box = await plot.boundingBox();
  const y = box.y + box.height / 2;
  await page.mouse.move(box.x + from * box.width, y);
  await page.mouse.down();
  await page.mouse.move(box.x + to * box.width, y, { steps: 5 });
  await page.mouse.up();
  await page.waitForTimeout(200);
}
