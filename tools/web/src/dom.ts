// Elements made in code; texts are plain, whatever is in them.

export function element(tag: string, parent: HTMLElement, text = "", className = ""): HTMLElement {
  const e = parent.appendChild(document.createElement(tag));
  e.textContent = text;
  e.className = className;
  return e;
}

// A part that may scroll, which keys reach.
export function region(parent: HTMLElement, name: string, className: string): HTMLElement {
  const e = element("div", parent, "", className);
  e.tabIndex = 0;
  e.setAttribute("role", "region");
  e.setAttribute("aria-label", name);
  return e;
}

export function figureIn(parent: HTMLElement, title: string): HTMLElement {
  const figure = element("figure", parent);
  element("figcaption", figure, title);
  return figure;
}

export function button(parent: HTMLElement, text: string, title: string, act: () => void): HTMLButtonElement {
  const b = element("button", parent, text) as HTMLButtonElement;
  b.type = "button";
  b.title = title;
  if (!/\w/.test(text)) b.setAttribute("aria-label", title);
  b.addEventListener("click", act);
  return b;
}

// A choice of one of some values, which are shown by their names.
export function choice<T extends string | number>(
  parent: HTMLElement, label: string, options: [name: string, value: T][], value: T, act: (value: T) => void,
): void {
  const text = element("label", parent, `${label} `);
  const select = element("select", text) as HTMLSelectElement;
  select.setAttribute("aria-label", label);
  for (const [name, v] of options) select.append(new Option(name, `${v}`, false, v === value));
  select.addEventListener("change", () => act(options[select.selectedIndex]![1]));
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
