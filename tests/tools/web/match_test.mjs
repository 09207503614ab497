// The page of `maploop match` as people see it and reach it by keys.
//
//   node match_test.mjs MAPLOOP PICTURES CHROMIUM
import assert from "node:assert/strict";
import { statSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";

import { cursors, drag, isDrawn, launch, newPage, open, pictures, reachedByKeys, run, slider, stretch, testWholePage, time } from "./pages.mjs";

const file = join(pictures, "match.html");
const [rows, columns, block] = [8, 8, 150]; // of a town; m

const latitude = (north) => 49 + north / 111200;
const longitude = (east) => 8.4 + east / 73170;

// Streets from west to east have names, those from south to north have none. "Row 3" is open to the east alone.
function town() {
  const node = (r, c) => 100 * (r + 1) + c;
  const all = [...Array(rows).keys()], across = [...Array(columns).keys()];
  const way = (id, nodes, tags) =>
    `<way id="${id}">${nodes.map((n) => `<nd ref="${n}"/>`).join("")}${Object.entries({ highway: "residential", ...tags })
      .map(([k, v]) => `<tag k="${k}" v="${v}"/>`).join("")}</way>`;
  return ['<osm version="0.6">',
    ...all.flatMap((r) => across.map((c) =>
      `<node id="${node(r, c)}" lat="${latitude(r * block)}" lon="${longitude(c * block)}"/>`)),
    ...all.map((r) => way(r + 1, across.map((c) => node(r, c)), { name: `Row ${r}`, ...(r === 3 && { oneway: "yes" }) })),
    ...across.map((c) => way(100 + c, all.map((r) => node(r, c)), {})),
    "</osm>"].join("\n");
}

// All rows one after the other, to and fro, at ten fixes a second; then on over a field. One row comes twice.
function track() {
  const [west, east] = [0, (columns - 1) * block];
  const corners = [...Array(rows).keys()].flatMap((r) => (r % 2 === 0 ? [west, east] : [east, west]).map((x) => [x, r * block]));
  corners.push([-450, (rows - 1) * block]);
  const lines = ["t,lat,lon,sigma,speed,azimuth_deg"];
  for (let k = 1; k < corners.length; ++k) {
    const [[x, y], [to_x, to_y]] = [corners[k - 1], corners[k]];
    const length = Math.hypot(to_x - x, to_y - y);
    for (let way = 0; way < length; way += 1.5) {
      const share = way / length, wave = Math.sin(lines.length / 25);
      const place = [latitude(y + share * (to_y - y) + wave), longitude(x + share * (to_x - x) + wave)];
      const azimuth = (Math.atan2(to_x - x, to_y - y) * 180) / Math.PI;
      lines.push([1e9 + 0.1 * lines.length, ...place, 1, 15, (azimuth + 360) % 360].join(","));
      if (lines.length === 1000) lines.push(lines[lines.length - 1]);
    }
  }
  return lines.join("\n") + "\n";
}

let browser;

before(async () => {
  browser = await launch();
  const [map, csv] = [join(pictures, "town.osm"), join(pictures, "track.csv")];
  writeFileSync(map, town());
  writeFileSync(csv, track());
  run("match", map, csv, "--html", file);
});

after(() => browser?.close());

testWholePage(() => browser, file, "match", {
  "canvas.map": 1, "figure[data-plot] canvas": 3, ".lists tr": 2 * rows, ".decision tr": 2, ".decision .rule": 1, ".events li": 3,
});

const street = (page, name) => page.locator(".lists tr", { hasText: name });
const shown = async (page) => [
  ...(await cursors(page, "figure[data-plot]")),
  await page.locator(".decision").innerText(),
  await page.locator("canvas.map").evaluate((canvas) => canvas.toDataURL()),
];

test("the summary says what became of the fixes", async () => {
  const page = await open(browser, file, 1024);
  const text = await page.locator("table").first().innerText();
  for (const said of [/^fixes\s+6\d{3}\s/m, /^matched to a road\s+6\d{3}\s+9\d\.\d %$/m, /^off road.*\s+\d{2,3}\s+\d\.\d %$/m,
    /^not used: not later than the fix before\s+1\s/m, /^driven on roads\s+9\.\d+ km/m, /below 0\.9\s+\d+\s/])
    assert.match(text, said);
  await page.close();
});

test("the cursor of one plot moves those of all, the decision, and the place on the map", async () => {
  const page = await open(browser, file, 1024);
  const before = await shown(page);
  const plot = page.locator("figure", { hasText: "Distance to the road" }).locator(".u-over");
  await plot.scrollIntoViewIfNeeded();
  await plot.hover({ position: { x: 200, y: 100 } });
  await page.waitForTimeout(300);
  const now = await shown(page);
  assert.equal(now.length, 5);
  now.forEach((value, i) => assert.notEqual(value, before[i], `${i}`));
  assert.match(await page.locator(".decision").innerText(), /^Row \d \(way \d\), P \d+ %[^]*\d\.\d\d: if .* then likelihood is /);

  const map = page.locator("canvas.map");
  await map.scrollIntoViewIfNeeded();
  const at = await time(page);
  const box = await map.boundingBox();
  for (let y = 0.1; y < 0.9 && (await time(page)) === at; y += 0.05) await page.mouse.move(box.x + 0.5 * box.width, box.y + y * box.height);
  assert.notEqual(await time(page), at, "moving over the track");
  assert.match(await map.getAttribute("title"), /way \d/);
  await page.close();
});

test("a map that is zoomed goes with the cursor", async () => {
  const page = await open(browser, file, 1024);
  for (let i = 0; i < 6; ++i) await page.getByRole("button", { name: "Nearer" }).click();
  await street(page, "Row 6").first().getByRole("button").click();
  await page.waitForTimeout(300);
  const map = page.locator("canvas.map");
  await map.scrollIntoViewIfNeeded();
  const box = await map.boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  assert.match(await map.getAttribute("title"), /^Row 6, way 7|^way 1/);
  await page.close();
});

test("streets are in the order of the drive and lead to their time; those without a name are said to have none", async () => {
  const page = await open(browser, file, 1024);
  const names = await page.locator(".lists tr td:first-child").allInnerTexts();
  const order = Array.from({ length: rows }, (_, r) => names.indexOf(`Row ${r}`));
  assert.deepEqual(order, [...order].sort((a, b) => a - b), names.join());
  assert.ok(order[0] >= 0 && names.includes("unnamed road (residential)"), names.join());
  assert.match(await street(page, "Row 4").first().innerText(), /Row 4\s+\d+\.\d s\s+\d+\.\d s\s+1\d{3} m\s+[01]\.\d{3}/);
  const go = street(page, "Row 4").first().getByRole("button");
  const from = Number((await go.innerText()).split(" ")[0]);
  await go.click();
  assert.ok(Math.abs((await time(page)) - from) < 1);
  assert.match(await page.locator(".decision p").innerText(), /^Row 4/);
  assert.match(await page.locator("tr[aria-current]").innerText(), /^Row 4/);
  await page.close();
});

test("a one-way street driven the other way, a field, and a fix that was not used are doubts", async () => {
  const page = await open(browser, file, 1024);
  const doubts = page.locator(".events li");
  for (const said of ["Row 3, against its one-way direction", "on no road of the map", "not later than the fix before"])
    assert.ok((await doubts.filter({ hasText: said }).count()) > 0, `${said} in ${(await doubts.allInnerTexts()).join("\n")}`);
  await doubts.filter({ hasText: "against its one-way" }).first().getByRole("button").click();
  assert.match(await page.locator(".decision p").innerText(), /^Row 3/);
  await page.close();
});

test("a part of the time is shown by all plots and the map", async () => {
  const page = await open(browser, file, 1024);
  const whole = await stretch(page);
  const before = await page.locator("canvas.map").evaluate((canvas) => canvas.toDataURL());
  await drag(page, page.locator("figure", { hasText: "Speed" }).locator(".u-over"), 0.3, 0.6);
  assert.ok(Math.abs((await stretch(page)) / whole - 0.3) < 0.02);
  assert.notEqual(await page.locator("canvas.map").evaluate((canvas) => canvas.toDataURL()), before);
  await page.close();
});

test("keys reach every control, and go from fix to fix", async () => {
  const page = await open(browser, file, 1024);
  const reached = await reachedByKeys(page, 120);
  for (const name of ["Streets", "Time", "All", "Nearer", "The next fix", "Decision at the cursor", "0.0 s", "Light or dark"])
    assert.ok([...reached].some((r) => r.startsWith(name)), `${name} in ${[...reached].join(", ")}`);
  await page.getByRole("button", { name: "The next fix" }).focus();
  await page.keyboard.press("Enter");
  await page.getByText(/^Fix 2 of \d+, 0\.1 s/).waitFor();
  await slider(page).focus();
  await page.keyboard.press("PageUp");
  assert.ok((await time(page)) > 10);
  await page.pdf({ path: join(pictures, "match.pdf"), format: "A4" });
  await page.close();
});

test("ten minutes at ten fixes a second stay small, and the map is there at once", async () => {
  const { size } = statSync(file);
  assert.ok(size < 10e6, `${size} bytes`);
  const page = await newPage(browser);
  await page.goto(`file://${file}`);
  await page.waitForFunction(`(${isDrawn})(document.querySelector("canvas.map"))`);
  console.log(`${size} bytes, the map is drawn after ${Math.round(await page.evaluate(() => performance.now()))} ms`);
  await page.close();
});
