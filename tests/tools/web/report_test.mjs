// The report of `maploop replay` as people see it and reach it by keys.
//
//   node report_test.mjs MAPLOOP PICTURES CHROMIUM
import assert from "node:assert/strict";
import { existsSync, readdirSync, statSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";

import { cursors, drag, launch, open, pictures, reachedByKeys, run, slider, stretch, testWholePage, time } from "./pages.mjs";

const file = join(pictures, "report.html");
const drive = join(pictures, "town");
const minutes = 2;

let browser;

before(async () => {
  browser = await launch();
  if (!existsSync(drive)) run("simulate", "--out", drive, "--seconds", `${60 * minutes}`, "--sensors", "imu,gnss");
  const [town] = readdirSync(drive).filter((name) => name.endsWith("_extract"));
  const map = readdirSync(drive).find((name) => name.endsWith(".osm"));
  run("replay", join(drive, town), "--lockstep", "--no-lcm", "--config", join(drive, "vehicle.toml"), "--map", join(drive, map),
    "--gnss-outage", "40:20", "--fault", "jump@gnss:80:4,by=15", "--report", file);
});

after(() => browser?.close());

testWholePage(() => browser, file, "report", { "figure[data-plot] canvas": 10, ".contents a": 7, "#readout tr": 6, ".events li": 2 });

const chart = (page, caption) => page.locator("figure", { hasText: caption }).first();

test("the cursor of one plot moves those of all, the values, and the place on the map", async () => {
  const page = await open(browser, file, 1024);
  const linked = "figure:has(.u-over)";
  const shown = async () => [
    (await cursors(page, linked)).slice(0, 5).join(),
    await page.locator("#readout").innerText(),
    await page.locator("canvas.map").evaluate((canvas) => canvas.toDataURL()),
  ];
  const before = await shown();
  const plot = chart(page, "Error north").locator(".u-over");
  await plot.scrollIntoViewIfNeeded();
  await plot.hover({ position: { x: 200, y: 100 } });
  await page.waitForTimeout(300);
  (await shown()).forEach((now, i) => assert.notEqual(now, before[i], `${i}`));
  assert.match(await page.locator("#readout").innerText(), /Error east, m\s+fused minus truth -?\d.*3 sigma ± \d/);
  await page.close();
});

test("a part of the time is shown by all plots over time", async () => {
  const page = await open(browser, file, 1024);
  const whole = await stretch(page);
  const speed = chart(page, "Speed").locator("canvas");
  const before = await speed.evaluate((canvas) => canvas.toDataURL());
  await drag(page, chart(page, "Error east").locator(".u-over"), 0.3, 0.6);
  assert.ok(Math.abs((await stretch(page)) / whole - 0.3) < 0.02);
  assert.notEqual(await speed.evaluate((canvas) => canvas.toDataURL()), before);
  await page.getByRole("button", { name: "All", exact: true }).click();
  assert.equal(await stretch(page), whole);
  await page.close();
});

test("outages and faults are events that lead to their time and to where there is more", async () => {
  const page = await open(browser, file, 1024);
  const outage = page.locator(".events li", { hasText: "no GNSS" });
  await outage.getByRole("button").click();
  assert.ok(Math.abs((await time(page)) - 40) < 1, `${await time(page)}`);
  await page.locator(".events li", { hasText: "fault jump@gnss" }).getByRole("link").click();
  assert.ok(await page.locator(":target").isVisible());
  await page.close();
});

test("keys reach every control and move the cursor; paper has it all", async () => {
  const page = await open(browser, file, 1024);
  const reached = await reachedByKeys(page, 60);
  for (const name of ["Absolute error", "Events", "Time", "All", "more", "Light or dark"])
    assert.ok([...reached].some((r) => r.startsWith(name)), `${name} in ${[...reached].join(", ")}`);
  await slider(page).focus();
  const at = await time(page);
  await page.keyboard.press("PageUp");
  assert.ok((await time(page)) > at);
  await page.pdf({ path: join(pictures, "report.pdf"), format: "A4" });
  await page.close();
});

test("it stays small, and its first picture is there at once", async () => {
  assert.ok(statSync(file).size < 1e6 * minutes, `${statSync(file).size} bytes`);
  const page = await open(browser, file, 1024);
  const first = await page.evaluate(() => performance.getEntriesByName("first-contentful-paint")[0].startTime);
  console.log(`${statSync(file).size} bytes, first paint after ${first} ms`);
  await page.close();
});
