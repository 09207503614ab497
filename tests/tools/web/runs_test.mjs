// Two runs on one bus: the dashboard shows the one that is chosen, and says when it ends.
//
//   node runs_test.mjs MAPLOOP PICTURES CHROMIUM
import assert from "node:assert/strict";
import { join } from "node:path";
import { after, before, test } from "node:test";

import { assertAccessible } from "./accessible.mjs";
import { drive, killAll, openLive, start, startDashboard, stop } from "./dashboard.mjs";
import { launch, pictures, reachedByKeys } from "./pages.mjs";

let browser;

before(async () => {
  browser = await launch();
});

after(async () => {
  await browser?.close();
  killAll();
});

const desktop = { width: 1280, height: 860 };
const choice = (page) => page.getByLabel("Run", { exact: true });
const speed = (page) => page.getByLabel("Times real time");

test("a page shows one of the runs on a bus, can show the other, and says when it ends", async () => {
  const { child: dashboard, url } = await startDashboard();
  const [slow, fast] = [start("replay", drive, "--loop", "0", "--speed", "0.5"), start("replay", drive, "--loop", "0", "--speed", "2")];
  const page = await openLive(browser, url, desktop);
  await choice(page).locator("option").nth(1).waitFor({ state: "attached" });
  const ids = await choice(page).locator("option").evaluateAll((all) => all.map((o) => o.value));
  assert.equal(ids.length, 2);
  const speeds = [];
  for (const id of ids) {
    await choice(page).selectOption(id);
    await page.waitForURL(new RegExp(`run=${id}`));
    await page.getByText("aided").waitFor();
    assert.equal(await choice(page).inputValue(), id);
    speeds.push(await speed(page).inputValue());
    await page.waitForTimeout(1000);
    // The states of two runs between which a page cannot choose would jump from one drive's time to the other's.
    const stamps = await page.evaluate((run) => new Promise((resolve) => {
      const seen = [];
      const source = new EventSource(`/events?run=${run}`);
      source.onmessage = ({ data }) => {
        const { channel, message } = JSON.parse(data);
        if (channel === "NAV_STATE") seen.push(message.header.stamp_ns);
        if (seen.length === 10) resolve(source.close() ?? seen);
      };
    }), id);
    const backwards = stamps.filter((stamp, i) => i > 0 && stamp < stamps[i - 1]).length;
    assert.ok(backwards <= 1, `the drive begins again at most once: ${stamps}`);
  }
  assert.deepEqual([...speeds].sort(), ["0.5", "2"]);
  const reached = [...(await reachedByKeys(page, 30))].join(", ");
  assert.match(reached, /Run/);
  await page.screenshot({ path: join(pictures, "runs.png") });
  await assertAccessible(page, "two runs");

  const [shown, other] = speeds[1] === "2" ? [fast, slow] : [slow, fast];
  await stop(shown);
  await page.getByText(/^Ended: replay of/).waitFor();
  assert.match(await choice(page).locator("option").nth(1).innerText(), /ended/);
  assert.equal(await choice(page).inputValue(), ids[1], "it stays");
  await choice(page).selectOption(ids[0]);
  await page.getByText("aided").waitFor();
  assert.equal(await speed(page).inputValue(), speeds[0]);
  await page.goto(`${url}?run=01234567`);
  await page.getByText("There is no run 01234567").waitFor();
  await page.close();
  await stop(other);
  await stop(dashboard);
});

test("a page that follows begins anew with the next run", async () => {
  const { child: dashboard, url } = await startDashboard();
  const page = await openLive(browser, url, desktop);
  for (const times of ["1", "2"]) {
    const replay = start("replay", drive, "--loop", "0", "--speed", times);
    await page.waitForFunction((value) => {
      const select = document.querySelector("footer select");
      return document.querySelector(".notice").textContent === "" && select.value === value;
    }, times);
    await stop(replay);
    await page.getByText(/^Ended: replay of/).waitFor();
  }
  await page.close();
  await stop(dashboard);
});
