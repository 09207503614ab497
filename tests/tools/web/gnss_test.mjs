// The page of `maploop ppp` as people see it and reach it by keys.
//
//   node gnss_test.mjs MAPLOOP PICTURES CHROMIUM
import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";

import { cursors, drag, launch, open, pictures, reachedByKeys, run, slider, stretch, testWholePage, time } from "./pages.mjs";

const folder = join(process.env.MAPLOOP_DATA, "gnss");
const car = (name) => join(folder, "kamakura_kinematic", name);
const drive = (name) => join(folder, "riverside_drive", name);
if (!existsSync(folder)) {
  console.error(`SKIPPED, NOT TESTED: there is no ${folder}`);
  process.exit(77);
}

const file = join(pictures, "gnss.html"); // two frequencies, smoothed
const single = join(pictures, "gnss-single.html"); // one frequency, with an outage

let browser;

before(async () => {
  browser = await launch();
  run("ppp", car("SEPT265G.21O.gz"), join(folder, "models/igs14_rebuilt_GE.atx.gz"), car("SEPT2650.21P.gz"),
    car("COD0MGXFIN_20212650000_01D_05M_ORB.SP3.gz"), car("COD0MGXFIN_20212650000_01D_01D_OSB.BIA.gz"), "--systems", "GE",
    "--direction", "smoothed", "--truth", car("rtk_reference.pos.gz"), "--compare", car("rtklib_ppp_kinematic_ge.pos.gz"),
    "--html", file);
  run("ppp", drive("COM3_200712.obs.gz"), drive("COM3_200712.nav.gz"), join(folder, "esbc_static/ESBC00DNK_R_20201770000_01D_MN.rnx.gz"),
    "--end", "600", "--gnss-outage", "200:60", "--html", single);
});

after(() => browser?.close());

testWholePage(() => browser, file, "gnss", { "#positions canvas": 3, "#satellites canvas": 10, "canvas.map": 1, ".contents a": 7 });

test("the cursor of one plot moves those of all, the values, and the place on the map", async () => {
  const page = await open(browser, file, 1024);
  const linked = "#positions figure";
  const shown = async () => [
    ...(await cursors(page, linked)),
    await page.locator("#readout").innerText(),
    await page.locator(".satellites").innerText(),
    await page.locator("canvas.map").evaluate((canvas) => canvas.toDataURL()),
    await page.locator("canvas.sky").evaluate((canvas) => canvas.toDataURL()),
  ];
  const before = await shown();
  const plot = page.locator("#positions .u-over").nth(1);
  await plot.scrollIntoViewIfNeeded();
  await plot.hover({ position: { x: 200, y: 100 } });
  await page.waitForTimeout(300);
  (await shown()).forEach((now, i) => assert.notEqual(now, before[i], `${i}`));
  assert.match(await page.locator("#readout").innerText(), /East, m\s+-?\d.* ± /);
  await page.close();
});

test("one solution is subtracted from another one", async () => {
  const page = await open(browser, file, 1024);
  const statistics = () => page.locator("#positions > .wide table").innerText();
  const errors = await statistics();
  assert.match(errors, /Up\s+357/);
  const names = await page.getByLabel("minus").locator("option").allInnerTexts();
  assert.deepEqual(names, ["its mean", "this solution", "truth", "forward", "backward", "rtklib_ppp_kinematic_ge.pos.gz"]);
  for (const name of ["forward", "rtklib_ppp_kinematic_ge.pos.gz", "its mean"]) {
    const before = await statistics();
    await page.getByLabel("minus").selectOption(name);
    assert.notEqual(await statistics(), before, name);
  }
  await page.getByLabel("minus").selectOption("this solution");
  assert.match(await statistics(), /East\s+360(\s+-?0\.0000)+/);
  await page.close();
});

test("a part of the time is dragged, and satellites are chosen", async () => {
  const page = await open(browser, file, 1024);
  const whole = await stretch(page);
  await drag(page, page.locator("#positions .u-over").first(), 0.3, 0.6);
  assert.ok(Math.abs((await stretch(page)) / whole - 0.3) < 0.02);
  await page.getByRole("button", { name: "All", exact: true }).click();
  assert.equal(await stretch(page), whole);
  const rows = () => page.locator(".satellites tr").count();
  const all = await rows();
  await page.getByRole("button", { name: "Galileo" }).click();
  const gps = await rows();
  assert.ok(gps < all);
  await page.getByLabel("Satellite", { exact: true }).selectOption({ index: 1 });
  assert.equal(await rows(), 2);
  await page.close();
});

test("keys reach every control and move the cursor", async () => {
  const page = await open(browser, file, 1024);
  const reached = await reachedByKeys(page, 60);
  for (const name of ["Time", "All", "minus", "Scale", "GPS", "Satellite", "Satellites at the cursor", "Light or dark"])
    assert.ok([...reached].some((r) => r.startsWith(name)), `${name} in ${[...reached].join(", ")}`);
  await slider(page).focus();
  const at = await time(page);
  await page.keyboard.press("PageUp");
  assert.ok((await time(page)) > at);
  await page.pdf({ path: join(pictures, "gnss.pdf"), format: "A4" });
  await page.close();
});

test("an outage is a gap and an event that leads to its time", async () => {
  const page = await open(browser, single, 1920);
  const event = page.locator(".events li", { hasText: "no observations" }).getByRole("button");
  await event.click();
  assert.ok(Math.abs((await time(page)) - 200) < 2, `${await time(page)}`);
  await page.screenshot({ path: join(pictures, "gnss-single.png"), fullPage: true });
  await page.close();
});
