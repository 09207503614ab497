// The step of a scale: the largest of 1, 2 and 5 times a power of ten that is not above `most`.
export function roundStep(most: number): number {
  const power = 10 ** Math.floor(Math.log10(most));
  return power * (most / power >= 5 ? 5 : most / power >= 2 ? 2 : 1);
}
