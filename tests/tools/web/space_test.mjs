// The dashboard in 3-D, as people see it and turn it.
//
//   node space_test.mjs MAPLOOP PICTURES CHROMIUM
import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";

import { assertAccessible } from "./accessible.mjs";
import { drive, killAll, openLive, start, startDashboard } from "./dashboard.mjs";
import { launch, newPage, patience, pictures, reachedByKeys } from "./pages.mjs";

const map = join(process.env.MAPLOOP_DATA ?? "", "maps/karlsruhe_2012-04.osm.pbf");
const roads = existsSync(map) ? ["--map", map] : [];
let browser, url;

before(async () => {
  browser = await launch();
  ({ url } = await startDashboard(...roads));
  start("replay", drive, "--loop", "0", ...roads);
});

after(async () => {
  await browser?.close();
  killAll();
});

async function openSpace(width, colours, hash = "#3d=") {
  const page = await openLive(browser, url + hash, { width, height: 860 }, colours);
  page.on("console", (m) => assert.notEqual(m.type(), "error", m.text()));
  await page.getByText("aided").waitFor();
  await page.locator(".view.scan canvas").waitFor();
  return page;
}

const space = (page) => page.locator("canvas.space");

// Takes pictures until one satisfies: a slow computer draws late, so nothing is judged by a time.
async function pictureThat(satisfies, page, what, options = {}) {
  const end = Date.now() + patience;
  for (;;) {
    const picture = await space(page).screenshot(options);
    if (satisfies(picture)) return picture;
    assert.ok(Date.now() < end, what(picture));
    await page.waitForTimeout(200);
  }
}

// The picture of a view in which nothing moves any more.
function settled(page) {
  let last = Buffer.alloc(0);
  const unchanged = (picture) => {
    const same = picture.equals(last);
    last = picture;
    return same;
  };
  return pictureThat(unchanged, page, () => "the picture does not come to rest");
}

// Pauses, so that only the eye moves.
async function pause(page) {
  await page.getByRole("button", { name: "Pause", exact: true }).click();
  await page.getByRole("button", { name: "Play", exact: true }).waitFor();
}

for (const colours of ["light", "dark"])
  test(`the 3-D view is drawn in every width, ${colours}`, async () => {
    const page = await openSpace(1920, colours);
    await page.getByLabel("show", { exact: true }).first().selectOption({ label: "10 scans" });
    for (const width of [1920, 1024, 390]) {
      await page.setViewportSize({ width, height: 860 });
      const cloudy = (picture) => picture.length > 20000;
      const path = join(pictures, `space-${width}-${colours}.png`);
      await pictureThat(cloudy, page, (picture) => `${picture.length} bytes are hardly a cloud of points`, { path });
      const overflow = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
      assert.ok(overflow <= 0, `${overflow} px beyond the edge`);
      await assertAccessible(page, `in 3-D, ${width} px, ${colours}`);
    }
    await page.close();
  });

test("mouse and keys turn, move and zoom it; the button goes to the map and back, and is in the address", async () => {
  const page = await openSpace(1024, "light", "");
  await page.getByRole("button", { name: "3-D" }).click();
  assert.match(page.url(), /#3d=$/);
  await pause(page);
  const canvas = space(page);
  const differs = async (what, act) => {
    const before = await settled(page);
    await act();
    await pictureThat((picture) => !picture.equals(before), page, () => `${what} changes nothing`);
  };
  const box = await canvas.boundingBox();
  const dragged = (button) => async () => {
    await page.mouse.move(box.x + 200, box.y + 200);
    await page.mouse.down({ button });
    await page.mouse.move(box.x + 260, box.y + 230, { steps: 5 });
    await page.mouse.up({ button });
  };
  await differs("a drag turns", dragged("left"));
  assert.equal(await page.getByRole("button", { name: "Follow the vehicle" }).getAttribute("aria-pressed"), "true");
  await differs("the right button moves", dragged("right"));
  assert.equal(await page.getByRole("button", { name: "Follow the vehicle" }).getAttribute("aria-pressed"), "false");
  await differs("the wheel zooms", () => page.mouse.wheel(0, 300));
  for (const key of ["ArrowLeft", "ArrowUp", "Shift+ArrowRight", "+", "-"]) await differs(key, () => canvas.press(key));
  await differs("following again", () => page.getByRole("button", { name: "Follow the vehicle" }).click());
  await differs("all", () => page.getByRole("button", { name: "Show all" }).click());
  await differs("dark", () => page.getByRole("button", { name: "Light or dark" }).click());
  const reached = [...(await reachedByKeys(page, 30))].join(", ");
  for (const name of ["The vehicle, its scans and its road in 3-D", "show", "3-D", "◎", "+"]) assert.ok(reached.includes(name), `${name} in ${reached}`);
  await page.getByRole("button", { name: "3-D" }).click();
  assert.ok(!(await canvas.isVisible()));
  await page.getByRole("button", { name: "Play", exact: true }).click();
  await page.close();
});

test("two fingers move and zoom it", async () => {
  const page = await openSpace(1024, "light");
  await pause(page);
  const canvas = space(page);
  const before = await settled(page);
  await canvas.evaluate((element) => {
    element.setPointerCapture = () => undefined;
    const finger = (type, pointerId, clientX) =>
      element.dispatchEvent(new PointerEvent(type, { pointerId, clientX, clientY: 300, pointerType: "touch", bubbles: true }));
    finger("pointerdown", 1, 200);
    finger("pointerdown", 2, 300);
    finger("pointermove", 2, 400);
    finger("pointerup", 1, 200);
    finger("pointerup", 2, 400);
  });
  await pictureThat((picture) => !picture.equals(before), page, () => "two fingers change nothing");
  await page.getByRole("button", { name: "Play", exact: true }).click();
  await page.close();
});

test("a browser without WebGL says so", async () => {
  const page = await newPage(browser, { viewport: { width: 1024, height: 860 } });
  await page.addInitScript(() => {
    const { getContext } = HTMLCanvasElement.prototype;
    HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
      return kind === "webgl2" ? null : getContext.call(this, kind, ...rest);
    };
  });
  await page.goto(`${url}#3d=`);
  await page.locator(".empty", { hasText: "no WebGL 2" }).waitFor();
  await page.getByRole("button", { name: "3-D" }).click();
  assert.ok(!(await page.locator(".empty", { hasText: "no WebGL 2" }).isVisible()));
  await page.close();
});
