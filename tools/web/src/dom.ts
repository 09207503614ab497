// Elements made in code; texts are plain, whatever is in them.

export function element(tag: string, parent: HTMLElement, text = "", className = ""): HTMLElement {
  const e = parent.appendChild(document.createElement(tag));
  e.textContent = text;
  e.className = className;
  return e;
}

export function button(parent: HTMLElement, text: string, title: string, act: () => void): HTMLButtonElement {
  const b = element("button", parent, text) as HTMLButtonElement;
  b.type = "button";
  b.title = title;
  if (!/\w/.test(text)) b.setAttribute("aria-label", title);
  b.addEventListener("click", act);
  return b;
}

export function table(parent: HTMLElement, heading: string[], rows: (string | HTMLElement)[][]): void {
  const body = document.createElement("table");
  if (heading.length > 0) {
    const row = element("tr", body);
    for (const text of heading) element(text ? "th" : "td", row, text);
  }
  for (const cells of rows) {
    const row = element("tr", body);
    for (const cell of cells) {
      const td = element("td", row, typeof cell === "string" ? cell : "");
      if (typeof cell !== "string") td.append(cell);
    }
  }
  parent.replaceChildren(body);
}
