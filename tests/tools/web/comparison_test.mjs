// The page of `maploop evaluate` with several runs, as people see it and reach it by keys.
//
//   node comparison_test.mjs MAPLOOP PICTURES CHROMIUM
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";

import { cursors, drag, launch, open, pictures, reachedByKeys, run, slider, stretch, testWholePage, time } from "./pages.mjs";

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
  browser = await launch();
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
  run("evaluate", ...runs, "--truth", truth, "--align", "origin", "--html", file);
});

after(() => browser?.close());

const linked = "figure[data-of]"; // plots
testWholePage(() => browser, file, "comparison", { canvas: 9, [linked]: 6 });

test("the cursor of one plot moves those of all, the values and the place on the way", async () => {
  const page = await open(browser, file, 1024);
  const before = { cursors: await cursors(page, linked), values: await page.locator(".readout").innerText() };
  const map = page.locator("canvas.map");
  const shown = () => map.evaluate((canvas) => canvas.toDataURL());
  const place = await shown();
  const plot = page.locator("figure[data-of=horizontal-way] .u-over");
  await plot.scrollIntoViewIfNeeded();
  await plot.hover({ position: { x: 200, y: 100 } });
  await page.waitForTimeout(200);
  const now = await cursors(page, linked);
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

test("the best run is named first, and the largest error of each leads to its place", async () => {
  const page = await open(browser, file, 1024);
  const ranking = page.locator("ol li");
  assert.match(await ranking.first().innerText(), /^gnss_and_stereo.tum: median 3-D error 0\.\d+ m, 95 % within/);
  await ranking.nth(1).getByRole("button").click();
  assert.ok((await time(page)) > 50, "it drifts to the end");
  await page.close();
});

test("a part of the drive that is dragged is shown by all plots, and a button shows all again", async () => {
  const page = await open(browser, file, 1024);
  const whole = await stretch(page);
  const others = page.locator("figure[data-of=vertical-way] canvas");
  const before = await others.evaluate((canvas) => canvas.toDataURL());
  await drag(page, page.locator("figure[data-of=absolute-time] .u-over"), 0.3, 0.6);
  assert.ok(Math.abs((await stretch(page)) / whole - 0.3) < 0.02);
  assert.notEqual(await others.evaluate((canvas) => canvas.toDataURL()), before);
  await page.getByRole("button", { name: "All", exact: true }).click();
  assert.equal(await stretch(page), whole);
  await page.close();
});

test("keys reach every control, move the cursor, and hide a run", async () => {
  const page = await open(browser, file, 1024);
  const reached = await reachedByKeys(page, 40);
  for (const name of ["stereo_alone.tum", "Time", "All", "Colour the way (last run on top) by", "Copy as LaTeX", "Light or dark"])
    assert.ok([...reached].some((r) => r.startsWith(name)), `${name} in ${[...reached].join(", ")}`);
  await slider(page).focus();
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
  const page = await open(browser, file, 1024, "dark");
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
