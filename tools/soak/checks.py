"""What must hold of a vehicle that runs for hours, as functions of what was observed."""
import math
import re

WRONG = 11.83  # squared distance in sigmas of what 0.27 % of honest positions exceed, two dimensions: 3 sigma of one
LASTING = 5.0  # s
WARM_UP = 120.0  # s, after which a process has taken the memory that it needs
MOST_GROWTH = 1.0  # MB an hour, beside what the slope's own standard error explains
IN_FLIGHT = 64  # samples by which a ring's counters may differ, which are read one after the other

# Sentences of HEALTH that are no warning: of a sensor that the vehicle has not, and of a silence that is over.
NO_WARNING = re.compile(r"there is none|silent for [^;]* from [^;]* on$")


def tells_of_a_sensor(sentences):
    """Returns whether a sentence of HEALTH says that a sensor, or the filter, is not well now."""
    return any(s.startswith(("imu", "gnss", "fusion")) and not NO_WARNING.search(s) for s in sentences)


def slope(samples):
    """Returns the slope of (time, value) pairs by least squares, and its standard error. Samples of a process follow
    each other closely, so that each ten count as one."""
    n = len(samples)
    mean_t = sum(t for t, _ in samples) / n
    mean_v = sum(v for _, v in samples) / n
    spread = sum((t - mean_t) ** 2 for t, _ in samples)
    steep = sum((t - mean_t) * (v - mean_v) for t, v in samples) / spread
    rest = sum((v - mean_v - steep * (t - mean_t)) ** 2 for t, v in samples)
    return steep, math.sqrt(10.0 * rest / max(n - 2, 1) / spread)


def memory_grows(samples):
    """Returns a sentence if the memory (s, MB) grows, else nothing. A run below ten minutes cannot tell."""
    warm = [(t / 3600.0, mb) for t, mb in samples if t > samples[0][0] + WARM_UP] if samples else []
    if not warm or warm[-1][0] - warm[0][0] < 600.0 / 3600.0:
        return ""
    steep, error = slope(warm)
    if steep - 3.0 * error <= MOST_GROWTH:
        return ""
    return f"memory grows by {steep:.2f} +-{error:.2f} MB an hour"


def handles_grow(samples):
    """Returns a sentence if the process has more open files at the end (s, count) than after its start."""
    warm = [n for t, n in samples if t > samples[0][0] + 30.0] if samples else []
    if len(warm) < 20 or min(warm[-10:]) <= max(warm[:10]):
        return ""
    return f"open files grow from {max(warm[:10])} to {min(warm[-10:])}"


def leaking_rings(health, tolerance=IN_FLIGHT):
    """Returns a sentence for each ring whose samples do not add up."""
    return [f"ring {r['name']}: {r['pushed']} in, but {r['popped']} out, {r['lost']} lost and {r['held']} held"
            for r in health["rings"] if abs(r["pushed"] - r["popped"] - r["lost"] - r["held"]) > tolerance]


def wrong_stretches(errors):
    """Returns (from, to, largest) of each stretch of more than LASTING seconds in which all of the errors, (time,
    squared distance in sigmas) in their order, are beyond three sigmas; `largest` in sigmas."""
    found, start, largest, last = [], None, 0.0, 0.0
    for t, squared in [*errors, (math.inf, 0.0)]:
        if squared > WRONG:
            start = t if start is None else start
            largest, last = max(largest, squared), t
        elif start is not None:
            if last - start > LASTING:
                found.append((start, last, math.sqrt(largest)))
            start, largest = None, 0.0
    return found
