// Buttons of a page that lead to a time (web::time_button); the row of the one at the cursor is marked.
import type { Timeline } from "./timeline";

export function linkMoments(timeline: Timeline): void {
  const buttons = [...document.querySelectorAll<HTMLButtonElement>("button[data-from]")];
  const moments = buttons.map((button) => {
    const [from, to] = [Number(button.dataset["from"]), Number(button.dataset["to"])];
    button.addEventListener("click", () => timeline.goTo({ from, to }));
    return { from, row: button.closest("tr") };
  });
  let marked: HTMLElement | null = null;
  timeline.follow(({ at }) => {
    const row = moments.filter(({ from }) => from <= at).pop()?.row ?? null;
    if (row === marked) return;
    marked?.removeAttribute("aria-current");
    row?.setAttribute("aria-current", "true");
    const list = row?.closest<HTMLElement>(".wide");
    if (list) list.scrollTop = row!.offsetTop - list.clientHeight / 2;
    marked = row;
  });
}
