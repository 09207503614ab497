"""Compares two sets of runs pair by pair."""
from dataclasses import dataclass

import numpy

DRAWS = 2000
FEW = 5  # fewer pairs say nothing of significance


@dataclass
class Ratio:
    """The mean of `new` over that of `old`, with the bounds of 95 % by bootstrap over the pairs."""
    value: float
    low: float
    high: float
    pairs: int

    @property
    def significant(self):
        return self.pairs >= FEW and (self.low > 1.0 or self.high < 1.0)


def ratio(old, new):
    """None for fewer than two pairs, or without a positive mean. The draws are the same each time."""
    pairs = numpy.array([(a, b) for a, b in zip(old, new) if a is not None and b is not None], dtype=float)
    if len(pairs) < 2 or pairs[:, 0].mean() <= 0.0:
        return None
    drawn = numpy.random.default_rng(1).integers(len(pairs), size=(DRAWS, len(pairs)))
    with numpy.errstate(divide="ignore", invalid="ignore"):
        ratios = pairs[drawn, 1].mean(axis=1) / pairs[drawn, 0].mean(axis=1)
    low, high = numpy.nanpercentile(ratios, [2.5, 97.5])
    return Ratio(pairs[:, 1].mean() / pairs[:, 0].mean(), float(low), float(high), len(pairs))


def paired(old, new, what, by):
    """The values `what` of the runs of both that have the same `by`, in one order."""
    first = {tuple(r[b] for b in by): r[what] for r in old}
    second = {tuple(r[b] for b in by): r[what] for r in new}
    both = [k for k in first if k in second]
    return [first[k] for k in both], [second[k] for k in both]
