"""The figures of a run: one function each, of what it wrote as JSON and of what it used (`job`)."""
from dataclasses import dataclass
from typing import Callable


@dataclass
class Metric:
    unit: str
    of: Callable
    about: str
    less_is_better: bool


METRICS = {}


def metric(unit, less_is_better=True):
    def add(function):
        METRICS[function.__name__] = Metric(unit, function, function.__doc__, less_is_better)
        return function
    return add


def values(name, output):
    """The metric of a run's output, once for each part that it is of; none where the run has nothing to make it of."""
    try:
        made = METRICS[name].of(output)
        return [float(each) for each in (made if isinstance(made, list) else [made])]
    except (LookupError, TypeError, ZeroDivisionError, ValueError):
        return []


def value(name, output):
    """The metric of a whole run: the mean of its parts, or None."""
    made = values(name, output)
    return sum(made) / len(made) if made else None


def over_100_m(output, part):
    return output[part]["common_rotation_removed"]["segment_100m_percent"]


# What the reference says of the map output: of the whole run, and of each outage.
NAVIGATION = {
    "position_rms": ("m", "rmse_m", "Horizontal error of the map output, root mean square."),
    "position_largest": ("m", "max_m", "Largest horizontal error of the map output."),
    "position_share": ("%", "rmse_percent", "Horizontal error of the map output, root mean square, of the way."),
    "drift_m": ("m", "drift_m", "Error at the end without the error at the start."),
    "drift": ("%", "drift_percent", "Error at the end without the error at the start, of the way."),
    "azimuth_rms": ("deg", "azimuth_rms_deg", "Error of the azimuth, root mean square."),
    "azimuth_end": ("deg", "azimuth_end_deg", "Error of the azimuth at the end, without its sign."),
    "nees": ("1", "nees_mean", "Squared error of the position by its covariance: 2 if the covariance is right."),
    "nees_end": ("1", "nees_end", "Squared error of the position by its covariance at the end."),
    "nees_largest": ("1", "nees_max", "Largest squared error of the position by its covariance."),
    "beyond": ("s", "beyond_3_sigma_s", "Longest time for which the position was wrong by more than 3 of its own sigmas."),
    "azimuth_beyond": ("s", "azimuth_beyond_3_sigma_s", "The same time of the azimuth."),
    "way": ("m", "distance_m", "Way driven."),
}
# How much of an outage the reference must cover: all of it where its end is scored, else enough for a mean.
COVERED, COVERED_AT_ALL = 0.97, 0.3
AT_THE_END = ("drift_m", "drift", "azimuth_end", "nees_end")


def add_navigation(name, unit, key, about):
    less_is_better = name not in ("way", "nees", "nees_end")
    covered = COVERED if name in AT_THE_END else COVERED_AT_ALL

    def whole(output):
        return abs(output["navigation"][key])

    def outages(output):
        scored = [o for o in output["navigation"]["outages"] if o["covered"] > covered]
        return [abs(o[key]) for o in scored if o[key] is not None]

    METRICS[name] = Metric(unit, whole, about, less_is_better)
    METRICS[f"outage_{name}"] = Metric(unit, outages, f"{about} In each outage.", less_is_better)


for navigation_name, how in NAVIGATION.items():
    add_navigation(navigation_name, *how)


# What the reference says of the protection levels.
PROTECTION = {
    "protection_beyond": ("1", lambda p: p["horizontal"]["beyond"] / p["moments"], "Share of the moments with an error beyond the horizontal level."),
    "protection_along_beyond": ("1", lambda p: p["along"]["beyond"] / p["moments"], "The same along the way."),
    "protection_across_beyond": ("1", lambda p: p["across"]["beyond"] / p["moments"], "The same across it."),
    "protection_ratio": ("1", lambda p: p["largest_ratio"], "Largest ratio of a horizontal error to its level."),
    "protection_median": ("m", lambda p: p["horizontal"]["median_m"], "Median of the horizontal level."),
    "protection_above_10": ("1", lambda p: 1.0 - p["below_10_m"], "Share of the moments without a horizontal level below 10 m that holds."),
    "protection_doubted": ("1", lambda p: p["doubted"] / p["moments"], "Share of the moments in which an aid is doubted, so that no level holds."),
}

for protection_name, (its_unit, figure, its_about) in PROTECTION.items():
    METRICS[protection_name] = Metric(its_unit, lambda output, f=figure: f(output["protection"]), its_about, True)


@metric("s")
def unsaid(output):
    """Longest time of either before HEALTH named anything."""
    return output["navigation"]["unsaid_s"]


# What HEALTH may say of a fault of each sensor.
SAID_OF = {"camera": ("camera", "image pairs", "motions"), "velodyne": ("velodyne", "scans", "motions"),
           "imu": ("imu", "inertial samples"), "gyro": ("imu", "inertial samples"),
           "accelerometer": ("imu", "inertial samples"), "gnss": ("gnss", "GNSS fixes", "epochs"),
           "wheel": ("wheel", "wheel speeds")}


def namings(output, right):
    """Seconds from the first fault on after which its own sensor was named, or (not `right`) another one."""
    target, start = (output["faults"][0]["fault"].split("@")[1].split(",")[0].split(":") + ["0"])[:2]
    return [each["at_s"] - float(start) for each in output["named"]
            if each["what"].endswith(SAID_OF[target]) == right]


def refused(output, *reasons):
    of_fusion = output["refusals"].get("fusion", {})
    return sum(of_fusion.get(reason, 0) for reason in reasons)


@metric("s")
def named_after(output):
    """Time after which HEALTH named the sensor that is at fault."""
    return min(namings(output, True))


@metric("1")
def named_others(output):
    """How many others were named."""
    return len(namings(output, False)) if output["faults"] else len(output["named"])


def made_outages(output):
    """Those of a recording with fixes to score with, in which the car drove far enough to show something."""
    return [end for end in output["outage_ends"] if end["distance_m"] >= 50.0]


@metric("m")
def end_error(output):
    """At the end of each made outage: distance from its last fix."""
    return [end["error_m"] for end in made_outages(output)]


@metric("%")
def end_error_share(output):
    """At the end of each made outage: distance from its last fix, of the way."""
    return [end["error_percent"] for end in made_outages(output)]


@metric("1")
def end_error_sigmas(output):
    """At the end of each made outage: distance from its last fix, in standard deviations of position and fix."""
    return [end["error_m"] / end["sigma_m"] for end in made_outages(output)]


@metric("m", less_is_better=False)
def end_way(output):
    """Way driven in each made outage."""
    return [end["distance_m"] for end in made_outages(output)]


@metric("m")
def end_peer(output):
    """At the end of each made outage: distance of the reference, a peer, from its last fix."""
    return [end["reference_error_m"] for end in made_outages(output) if end["reference_error_m"] is not None]


def share_right(part):
    """In percent; nothing where no match was scored."""
    return [100.0 * part["right"]] if part["fixes"] > 0 else []


@metric("%", less_is_better=False)
def links(output):
    """Share of the matches that are on the road really driven."""
    return share_right(output["links"]["all"])


@metric("%", less_is_better=False)
def links_certain(output):
    """Share of the matches that are on the road really driven, where that one is certain."""
    return share_right(output["links"]["certain"])


@metric("1")
def links_p(output):
    """P(link) that is said, mean of all matches."""
    bins = output["links"]["reliability"]
    return sum(b["p_said"] * b["fixes"] for b in bins) / sum(b["fixes"] for b in bins)


@metric("1")
def links_lacking_p(output):
    """P(link) that is said on roads that the map lacks, mean."""
    return output["links"]["lacking"]["p_said"]


@metric("1", less_is_better=False)
def fed_back(output):
    """How often the map fed something back."""
    return output["map_feedback"]["fed back"]


@metric("1")
def gated(output):
    """How often what was fed back contradicted the prediction."""
    return refused(output, "road contradicts the predicted position", "road contradicts the predicted azimuth")


@metric("1")
def restored(output):
    """How often the filter undid what the map had led to."""
    return refused(output, "undone: the map had led astray")


@metric("%")
def odom_track(output):
    """Error of the odom output over 100 m, one rotation of the body removed; also of drives without images."""
    return output["navigation"]["odom_100m_percent"]


@metric("%")
def odom(output):
    """Error of the odom output over 100 m, one rotation removed."""
    return over_100_m(output, "odom")


@metric("%")
def map_motion(output):
    """Error of the map output over 100 m, one rotation removed."""
    return over_100_m(output, "fused")


@metric("%")
def lidar(output):
    """Error of LiDAR odometry over 100 m, one rotation removed."""
    return over_100_m(output, "lidar")


@metric("%")
def stereo(output):
    """Error of stereo odometry over 100 m, one rotation removed."""
    return over_100_m(output, "vo")


@metric("1")
def odom_to_best(output):
    """Error of the odom output over that of the best odometry."""
    return odom(output) / min(over_100_m(output, part) for part in ("lidar", "vo") if part in output)


def of_map(name, unit, part, key, about):
    METRICS[name] = Metric(unit, lambda output: output["map"]["comparison"][part][key], about, True)


for without, part in (("", "with"), ("_without", "without")):
    of_map("across" + without, "m", part, "across_rmse_m", f"Error across the way {part} the map, root mean square.")
    of_map("horizontal" + without, "m", part, "horizontal_rmse_m", f"Horizontal error {part} the map, root mean square.")
    of_map("stays_below" + without, "s", part, "across_stays_below_1.5_m_after_s",
           f"Time until the error across the way stays below 1.5 m {part} the map.")


@metric("1", less_is_better=False)
def useful_epochs(output):
    """Epochs that the errors with and without the map are of."""
    return output["map"]["comparison"]["epochs"]


for odometry_name, (unit, key, about) in {
    "vo_tracks": ("1", "tracks_a_pair", "Features that are tracked over a pair of frames, mean."),
    "vo_life": ("1", "pairs_a_track", "Pairs of frames over which a feature is tracked, mean."),
    "vo_inliers": ("%", "inliers_percent", "Tracks that agree with the motion."),
    "vo_refused": ("1", "refused", "Pairs of frames without a motion."),
    "vo_end": ("%", "end_point_percent", "Error at the end, of the way."),
    "vo_25": ("%", "segment_25m_turned_percent", "Error over 25 m, one rotation removed."),
    "vo_100": ("%", "segment_100m_percent", "Error over 100 m."),
    "vo_100_turned": ("%", "segment_100m_turned_percent", "Error over 100 m, one rotation removed."),
    "vo_turning": ("deg/m", "segment_100m_turned_deg_per_m", "Error of the rotation over 100 m, one rotation removed."),
    "vo_nees": ("1", "nees", "Squared error of increments of 1 s by their covariance, a degree of freedom: 1 if it is right."),
    "vo_time": ("ms", "processor_ms", "Processor time of a pair of frames, median."),
}.items():
    less_is_better = odometry_name not in ("vo_tracks", "vo_life", "vo_inliers", "vo_nees")
    METRICS[odometry_name] = Metric(unit, lambda output, key=key: output[key], about, less_is_better)


# How `maploop evaluate` scores what a program wrote.
for score_name, (unit, part, key, about) in {
    "horizontal": ("m", "horizontal_m", "rmse", "Horizontal error, root mean square."),
    "horizontal_median": ("m", "horizontal_m", "median", "Horizontal error, median."),
    "horizontal_95": ("m", "horizontal_m", "p95", "Horizontal error, 95 %."),
    "vertical": ("m", "vertical_m", "rmse", "Vertical error, root mean square."),
}.items():
    METRICS[f"score_{score_name}"] = Metric(unit, lambda output, part=part, key=key: output["score"]["runs"][0][part][key],
                                            about, True)


@metric("%", less_is_better=False)
def score_answered(output):
    """Epochs of the truth for which there is a position."""
    run = output["score"]["runs"][0]
    return 100.0 * run["frames"] / (run["frames"] + run["unmatched"]["truth"])


def score_over_100_m(output, part, key):
    return next(length for length in output["score"]["lengths"] if length["length_m"] == 100.0)[part][key]


@metric("%")
def score_100(output):
    """Error over 100 m, one rotation removed."""
    return score_over_100_m(output, "common_rotation_removed", "percent")


@metric("deg/m")
def score_turning(output):
    """Error of the rotation over 100 m, one rotation removed."""
    return score_over_100_m(output, "common_rotation_removed", "deg_per_m")


@metric("m")
def score_end(output):
    """Error at the end."""
    return output["score"]["end_point_m"]


@metric("s")
def processor(output):
    """Processor time of the run."""
    return output["job"]["cpu_s"]


@metric("MB")
def memory(output):
    """Peak memory of the run."""
    return output["job"]["peak_mb"]
