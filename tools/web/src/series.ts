// Values over an increasing list, such as of times.
import type { Numbers } from "./plot";

// The index of the value nearest to `at`.
export function nearest(list: number[], at: number): number {
  let [low, high] = [0, list.length - 1];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (list[middle]! <= at) low = middle;
    else high = middle;
  }
  return at - list[low]! < list[high]! - at ? low : high;
}

// The value of `to` where `from` is `at`; null in a gap.
export function between(from: number[], to: Numbers, at: number): number | null {
  const i = nearest(from, at);
  const j = Math.min(Math.max(at >= from[i]! ? i + 1 : i - 1, 0), from.length - 1);
  const span = from[j]! - from[i]!;
  const share = span === 0 ? 0 : Math.min(Math.max((at - from[i]!) / span, 0), 1);
  const [a, b] = [to[i], to[j]];
  return a == null ? null : b == null ? (share < 0.5 ? a : null) : a + share * (b - a);
}
