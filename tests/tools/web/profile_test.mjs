// The page of `maploop profile`: any tick of a traced run as a time line.
//
//   node profile_test.mjs MAPLOOP PICTURES CHROMIUM
import assert from "node:assert/strict";
import { existsSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";

import { launch, open, pictures, reachedByKeys, run, testWholePage } from "./pages.mjs";

const file = join(pictures, "profile.html");
const lockstep = join(pictures, "profile-lockstep.html");
const untraced = join(pictures, "profile-untraced.html");

let browser;

before(async () => {
  browser = await launch();
  const town = join(pictures, "town");
  if (!existsSync(town)) run("simulate", "--out", town, "--seconds", "12", "--sensors", "imu,gnss");
  const drive = join(town, readdirSync(town).find((name) => name.endsWith("_extract")));
  const [log, trace] = [join(pictures, "run.lcmlog"), join(pictures, "run.json")];
  const replay = (...more) => run("replay", drive, "--no-lcm", "--config", join(town, "vehicle.toml"), "--record", log, "--trace", trace, ...more);
  replay("--lockstep");
  run("profile", log, "--trace", trace, "--html", lockstep);
  replay("--fault", "slow@fusion:5:0.3,by=0.02");
  run("profile", log, "--trace", trace, "--html", file);
  run("profile", log, "--html", untraced);
});

after(() => browser?.close());

testWholePage(() => browser, file, "profile", { canvas: 3, "#ticks .threads .row": 3, "#ticks tr": 3, "#ticks .guilty": 1, ".contents a": 4 });

const said = (page) => page.locator("#ticks p[aria-live]").innerText();
const press = (page, name) => page.getByRole("button", { name, exact: true }).click();

test("a tick is chosen by its number, its time, its share of the latencies, and because it missed", async () => {
  const page = await open(browser, file, 1024);
  await page.getByLabel("of", { exact: true }).selectOption("fusion tick");
  const worst = await said(page);
  assert.match(worst, /^fusion tick \d+ of 1\d\d\d: [\d.]+ ms; a deadline was missed by fusion/);
  const length = async () => Number((await said(page)).match(/: ([\d.]+) ms/)[1]);
  const longest = await length();
  assert.ok(longest > 19, "the fault took 20 ms");
  await press(page, "p50");
  assert.ok((await length()) < 5);
  await press(page, "p99");
  const p99 = await length();
  assert.ok(p99 <= longest);
  await press(page, "next missed");
  const missed = await said(page);
  assert.match(missed, /missed by fusion/);
  await press(page, "The next one");
  assert.notEqual(await said(page), missed);
  await page.getByLabel("number").fill("3");
  await page.keyboard.press("Enter");
  assert.match(await said(page), /^fusion tick 3 of/);
  await page.getByLabel("at, s").fill("5");
  await page.keyboard.press("Enter");
  const number = Number(await page.getByLabel("number").inputValue());
  assert.ok(number > 100, `${number}`);
  await page.getByLabel("of", { exact: true }).selectOption("imu");
  assert.match(await said(page), /^imu \d+ of \d+/);
  assert.match(await page.locator("#ticks .wide").innerText(), /waiting for fusion[\s\S]*publisher: NAV_STATE/);
  const before = await said(page);
  await page.locator("#ticks .u-over").click({ position: { x: 120, y: 100 } });
  assert.notEqual(await said(page), before, "a press on the chart");
  await page.close();
});

test("keys reach it", async () => {
  const page = await open(browser, file, 1024);
  const reached = [...(await reachedByKeys(page, 60))];
  for (const name of ["of", "number", "at, s", "p50", "p99", "worst", "next missed", "What each thread did"])
    assert.ok(reached.some((r) => r.startsWith(name)), `${name} in ${reached.join(", ")}`);
  await page.close();
});

test("on virtual time no deadline is judged, and without a trace the page says how to record one", async () => {
  let page = await open(browser, lockstep, 1024);
  assert.match(await page.locator("main").innerText(), /Any tick[\s\S]*deadlines have no meaning/);
  await press(page, "next missed");
  assert.match(await said(page), /None of these missed a deadline/);
  await page.close();
  page = await open(browser, untraced, 1024);
  assert.match(await page.locator(".empty").innerText(), /--trace/);
  await page.close();
});
