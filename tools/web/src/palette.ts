// The colours of the design (design/tokens.css) for canvases, which do not know CSS's variables.

const probe = document.createElement("i");
let known = new Map<string, string>();
let listeners: (() => void)[] = [];

// The colour of a token now, such as ink("truth").
export function ink(token: string): string {
  let colour = known.get(token);
  if (!colour) {
    if (!probe.isConnected) {
      probe.hidden = true;
      document.documentElement.append(probe);
    }
    probe.style.color = `var(--${token})`;
    colour = getComputedStyle(probe).color;
    known.set(token, colour);
  }
  return colour;
}

// Calls when the colours have changed.
export function onColours(draw: () => void): void {
  listeners.push(draw);
}

function changed(): void {
  known = new Map();
  for (const draw of listeners) draw();
}

function setScheme(scheme: string): void {
  document.documentElement.style.colorScheme = scheme;
  changed();
}

const prefersDark = matchMedia("(prefers-color-scheme: dark)");
prefersDark.addEventListener("change", changed);

// Paper is light.
let onScreen = "";
addEventListener("beforeprint", () => {
  onScreen = document.documentElement.style.colorScheme;
  setScheme("light");
});
addEventListener("afterprint", () => setScheme(onScreen));

// A button for light and dark.
export function themeSwitch(parent: HTMLElement): void {
  const button = parent.appendChild(document.createElement("button"));
  button.type = "button";
  button.className = "theme";
  button.textContent = "◐";
  button.title = "Light or dark";
  button.setAttribute("aria-label", button.title);
  button.addEventListener("click", () => {
    const chosen = document.documentElement.style.colorScheme;
    const isDark = chosen ? chosen === "dark" : prefersDark.matches;
    setScheme(isDark ? "light" : "dark");
  });
}

const meanings: [RegExp, string][] = [
  [/truth|reference/i, "truth"],
  [/fused/i, "fused"],
  [/\bVO\b|visual|stereo/i, "visual"],
  [/lidar/i, "lidar"],
  [/\bPPP\b/i, "ppp"],
  [/gnss|\bfix(es)?\b/i, "gnss"],
  [/matched/i, "matched"],
  [/^converging/, "gnss"],
  [/^converged/, "ppp"],
  [/^fixed/, "good"],
];
// What the name says first: "fused minus truth" is of the fused state.
function meaningOf(name: string): string | undefined {
  const found = meanings.map(([pattern, token]) => ({ at: name.search(pattern), token })).filter(({ at }) => at >= 0);
  return found.sort((a, b) => a.at - b.at)[0]?.token;
}

const series = [1, 2, 3, 4, 5, 6, 7, 8].map((i) => `series-${i}`);

// The token of each line: of what its name says, else the next one that no other line has.
export function tokensOf(names: string[]): string[] {
  const own = names.map(meaningOf);
  const used = new Set(own.map((token) => token && ink(token)));
  const free = series.filter((token) => !used.has(ink(token)));
  let next = 0;
  return own.map((token, i) => {
    if (token && own.indexOf(token) === i) return token;
    return free.length > 0 ? free[next++ % free.length]! : series[i % series.length]!;
  });
}
