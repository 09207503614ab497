// The page of `maploop evaluate` with several runs, as people see it and reach it by keys.
//
//   node comparison_test.mjs MAPLOOP PICTURES CHROMIUM
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { after, before, test } from "node:test";

import { chromium } from "playwright-core";

import { assertAccessible } from "./accessible.mjs";

const [maploop, pictures, executablePath] = process.argv.slice(2);
const file = join(pictures, "comparison.html");

// Poses of a camera in east, north, up on a bend: it stands, then drives, and each run drifts in its own way.
function trajectory(drift) {
  const lines = [];
  for (let i = 0; i < 600; ++i) {
    const way = Math.max(0, i - 50) * 0.8;
    const angle = way / 150;
    const [x, y, z] = [150 * Math.sin(angle), 150 - 150 * Math.cos(angle), 0.01 * way];
    const [qx, qy, qz, qw] = [-Math.cos(angle / 2 - Math.PI / 4), -Math.sin(angle / 2 - Math.PI / 4),
      Math.sin(angle / 2 - Math.PI / 4), Math.cos(angle / 2 - Math.PI / 4)].map((v) => v * Math.SQRT1_2);
    const e = drift(i, way);
    lines.push([1e9 + 0.1 * i, x + e[0], y + e[1], z + e[2], qx, qy, qz, qw].map((v) => v.toFixed(6)).join(" "));
  }
  return lines.join("\n") + "\n";
}

let browser;

before(async () => {
  browser = await chromium.launch({ executablePath, args: ["--no-sandbox", "--disable-gpu"] });
  const write = (name, drift) => {
    writeFileSync(join(pictures, name), trajectory(drift));
    return join(pictures, name);
  };
  const truth = write("truth.tum", () => [0, 0, 0]);
  const runs = [
    write("gnss_and_stereo.tum", (i) => [0.5 * Math.sin(i / 40), 0.3 * Math.cos(i / 25), 0.2 * Math.sin(i / 60)]),
    write("stereo_alone.tum", (_, way) => [0.00001 * way * way, 0.004 * way, -0.002 * way]),
    write("lidar_alone.tum", (i, way) => [0.003 * way, 0.2 * Math.sin(i / 15), 0.001 * way]),
  ];
  const run = spawnSync(maploop, ["evaluate", ...runs, "--truth", truth, "--align", "origin", "--html", file]);
  assert.equal(run.status, 0, String(run.stderr));
});

after(() => browser?.close());

async function open(width, colorScheme = "light") {
  const page = await browser.newPage({ viewport: { width, height: 900 }, colorScheme });
  page.on("pageerror", (e) => assert.fail(`the page's script failed: ${e}`));
  page.on("console", (m) => assert.notEqual(m.type(), "error", m.text()));
  page.on("request", (r) => assert.match(r.url(), /^(file|data):/, "nothing is asked for"));
  await page.goto(pathToFileURL(file).href);
  return page;
}

const isDrawn = (canvas) =>
  canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data.some((v) => v > 0);

for (const colours of ["light", "dark"])
  for (const width of [390, 1024, 1920])
    test(`all of it is there ${width} px wide, ${colours}`, async () => {
      const page = await open(width, colours);
      await page.waitForTimeout(300);
      const canvases = await page.$$("canvas");
      assert.equal(canvases.length, 9, "a plane, six linked plots, a distribution, segments");
      for (const canvas of canvases) assert.ok(await canvas.evaluate(isDrawn));
      const overflow = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
      assert.ok(overflow <= 0, `${overflow} px beyond the edge`);
      await page.screenshot({ path: join(pictures, `comparison-${width}-${colours}.png`), fullPage: true });
      await assertAccessible(page);
      await page.close();
    });

const cursors = (page) =>
  page.$$eval("figure[data-of] .u-cursor-x", (all) => all.map((e) => new DOMMatrix(e.style.transform).m41));
const time = async (page) => Number(await page.getByRole("slider").inputValue());

test("the cursor of one plot moves those of all, the values and the place on the way", async () => {
  const page = await open(1024);
  const before = { cursors: await cursors(page), values: await page.locator(".readout").innerText() };
  const map = page.locator("canvas.map");
  const shown = () => map.evaluate((canvas) => canvas.toDataURL());
  const place = await shown();
  const plot = page.locator("figure[data-of=horizontal-way] .u-over");
  await plot.scrollIntoViewIfNeeded();
  await plot.hover({ position: { x: 200, y: 100 } });
  await page.waitForTimeout(200);
  const now = await cursors(page);
  assert.equal(now.length, 6);
  now.forEach((x, i) => assert.notEqual(x, before.cursors[i], `plot ${i}`));
  assert.notEqual(await page.locator(".readout").innerText(), before.values);
  assert.notEqual(await shown(), place);

  await map.scrollIntoViewIfNeeded();
  const at = await time(page);
  const box = await map.boundingBox();
  for (let x = 0.1; x < 0.9 && (await time(page)) === at; x += 0.02)
    for (let y = 0.1; y < 0.9; y += 0.05) await page.mouse.move(box.x + x * box.width, box.y + y * box.height);
  assert.notEqual(await time(page), at, "moving over the way");
  await page.close();
});

test("a part of the drive that is dragged is shown by all plots, and a button shows all again", async () => {
  const page = await open(1024);
  const slider = page.getByRole("slider");
  const stretch = () => slider.evaluate((s) => Number(s.max) - Number(s.min));
  const whole = await stretch();
  const plot = page.locator("figure[data-of=absolute-time] .u-over");
  await plot.scrollIntoViewIfNeeded();
  const box = await plot.boundingBox();
  const others = page.locator("figure[data-of=vertical-way] canvas");
  const before = await others.evaluate((canvas) => canvas.toDataURL());
  await page.mouse.move(box.x + 0.3 * box.width, box.y + 50);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.6 * box.width, box.y + 50, { steps: 5 });
  await page.mouse.up();
  await page.waitForTimeout(200);
  assert.ok(Math.abs((await stretch()) / whole - 0.3) < 0.02);
  assert.notEqual(await others.evaluate((canvas) => canvas.toDataURL()), before);
  await page.getByRole("button", { name: "All", exact: true }).click();
  assert.equal(await stretch(), whole);
  await page.close();
});

test("keys reach every control, move the cursor, and hide a run", async () => {
  const page = await open(1024);
  const reached = new Set();
  for (let i = 0; i < 40; ++i) {
    await page.keyboard.press("Tab");
    reached.add(await page.evaluate(() => document.activeElement.getAttribute("aria-label") ?? (document.activeElement.innerText || document.activeElement.type)));
  }
  for (const name of ["stereo_alone.tum", "range", "All", "checkbox", "Copy as LaTeX", "Light or dark"])
    assert.ok(reached.has(name), `${name} in ${[...reached].join(", ")}`);
  await page.getByRole("slider").focus();
  const at = await time(page);
  await page.keyboard.press("PageUp");
  assert.ok((await time(page)) > at);
  await page.getByRole("button", { name: "stereo_alone.tum" }).focus();
  await page.keyboard.press("Space");
  assert.doesNotMatch(await page.locator(".readout").innerText(), /stereo_alone/);
  await page.getByRole("checkbox").focus();
  await page.keyboard.press("Space");
  await page.locator("figure.map .legend span").nth(4).waitFor();
  await page.screenshot({ path: join(pictures, "comparison-coloured.png") });
  await page.getByRole("button", { name: "Copy as LaTeX" }).click();
  assert.match(await page.locator("textarea").inputValue(), /tabular/);
  await page.close();
});

test("the switch changes light to dark and back; paper is light", async () => {
  const page = await open(1024, "dark");
  const colour = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const dark = await colour();
  await page.getByRole("button", { name: "Light or dark" }).click();
  const light = await colour();
  assert.notEqual(light, dark);
  await page.getByRole("button", { name: "Light or dark" }).click();
  assert.equal(await colour(), dark);
  await page.emulateMedia({ media: "print" });
  assert.equal(await colour(), light);
  await page.pdf({ path: join(pictures, "comparison.pdf"), format: "A4" });
  await page.close();
});
