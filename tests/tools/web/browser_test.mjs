// maploop's dashboard as people see it.
//
//   node browser_test.mjs MAPLOOP PICTURES CHROMIUM
import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";

import { assertAccessible } from "./accessible.mjs";
import { drive, killAll, openLive, start, startDashboard, stop } from "./dashboard.mjs";
import { isDrawn, launch, pictures } from "./pages.mjs";

const desktop = { width: 1280, height: 860 };
const phone = { width: 390, height: 844 };

let browser;

before(async () => {
  browser = await launch();
});

after(async () => {
  await browser?.close();
  killAll();
});

const open = (viewport, url) => openLive(browser, url, viewport);

test("the dashboard follows a replay, controls it, and survives restarts of either side", async () => {
  let { child: dashboard, url } = await startDashboard();
  const port = new URL(url).port;
  const page = await open(desktop, url);
  await page.getByText("Nothing comes on the bus").waitFor();

  const play = () => start("replay", drive, "--loop", "0");
  let replay = play();
  await page.getByText("aided").waitFor();
  assert.equal(await page.locator(".notice").innerText(), "");
  await page.locator(".strip").first().waitFor();
  assert.ok((await page.locator(".strip").count()) >= 4);
  assert.ok(await page.locator(".place canvas:not(.space)").evaluate(isDrawn));
  for (const view of ["camera", "scan"]) {
    const canvas = page.locator(`.view.${view} canvas`);
    await canvas.waitFor();
    assert.ok(await canvas.evaluate(isDrawn), view);
  }
  await page.getByText(/[1-9]\d* features followed/).waitFor();

  await page.getByText("Curves of any signals").click();
  const curve = page.locator(".curve canvas").first();
  await curve.waitFor();
  await page.getByText("Signals: press one").click();
  await page.getByLabel("Only signals whose name has").fill("lidar.p99");
  await page.getByRole("button", { name: "Add a chart" }).click();
  await page.getByRole("button", { name: "threads.lidar.p99_us", exact: true }).click();
  assert.match(decodeURIComponent(page.url()), /#curves=NAV_STATE\/velocity_enu.0,NAV_STATE\/velocity_enu.1;DEADLINES\/threads.lidar.p99_us$/);
  await page.waitForTimeout(1500);
  assert.equal(await page.locator(".curve canvas").count(), 2);
  for (const canvas of await page.$$(".curve canvas")) assert.ok(await canvas.evaluate(isDrawn), "curves are drawn");
  const legend = page.locator(".curve").nth(1).locator(".u-legend");
  assert.match(await legend.innerText(), /p99_us/);
  await page.getByRole("button", { name: "Freeze" }).click();
  await page.getByRole("button", { name: "Go on" }).click();
  const linked = await open(desktop, page.url());
  await linked.getByRole("button", { name: "DEADLINES/threads.lidar.p99_us ×" }).waitFor();
  await linked.screenshot({ path: join(pictures, "dashboard-curves.png") });
  await linked.close();
  await page.getByText("Curves of any signals").click();

  const others = await Promise.all([open(phone, url), open(desktop, url)]);
  for (const other of others) await other.getByText("aided").waitFor();
  await others[0].screenshot({ path: join(pictures, "dashboard-phone.png") });
  await Promise.all(others.map((other) => other.close()));

  await page.keyboard.press("Space");
  await page.getByRole("button", { name: "Play", exact: true }).waitFor();
  await page.locator("footer input").fill("6"); // and says that it changed
  await page.getByText(/^6\.\d of/).waitFor();
  await page.keyboard.press("Space");
  await page.getByRole("button", { name: "Pause", exact: true }).waitFor();
  await page.waitForTimeout(1500);
  await page.screenshot({ path: join(pictures, "dashboard-desktop.png") });
  await assertAccessible(page, "the dashboard");

  await stop(replay);
  await page.getByText("Nothing comes on the bus").waitFor();
  replay = play();
  await page.waitForFunction(() => document.querySelector(".notice").textContent === "");

  await stop(dashboard);
  await page.getByText("No connection").waitFor();
  dashboard = start("dashboard", "--port", port);
  await page.waitForFunction(() => document.querySelector(".notice").textContent === "");
  await stop(replay);
  await stop(dashboard);
});

test("the dashboard shows the sky of a GNSS receiver and why satellites are not used", async (t) => {
  const folder = join(process.env.MAPLOOP_DATA, "gnss/riverside_drive");
  if (!existsSync(folder)) return t.skip(`SKIPPED, NOT TESTED: there is no ${folder}`);
  const { child: dashboard, url } = await startDashboard();
  const replay = start("replay", folder, "--loop", "0");
  for (const [name, viewport] of Object.entries({ desktop, phone })) {
    const page = await open(viewport, url);
    await page.getByText(/Sky: \d+ of \d+ satellites/).waitFor();
    assert.ok(await page.locator(".view.sky canvas").evaluate(isDrawn));
    await page.locator(".satellites tr").nth(4).waitFor();
    assert.match(await page.locator(".satellites").innerText(), /used/);
    const overflow = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
    assert.ok(overflow <= 0, `${overflow} px beyond the edge of the ${name}`);
    await page.screenshot({ path: join(pictures, `sky-${name}.png`) });
    await page.close();
  }
  await stop(replay);
  await stop(dashboard);
});

test("a page of another site cannot control the replay", async () => {
  const { child: dashboard, url } = await startDashboard();
  const post = (headers, body) => fetch(`${url}control`, { method: "POST", headers, body });
  const command = (kind) => JSON.stringify({ run: "0123abcd", kind });
  const pause = command("pause");
  assert.equal((await post({ Origin: "http://elsewhere.example" }, pause)).status, 403);
  assert.equal((await post({}, pause)).status, 200);
  assert.equal((await post({}, "nonsense")).status, 400);
  assert.equal((await post({}, JSON.stringify({ kind: "pause" }))).status, 400, "of no run");
  assert.equal((await post({}, command("explode"))).status, 400);
  await stop(dashboard);
});
