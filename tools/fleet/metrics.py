"""The figures of a run: one function each, of what `maploop replay --json` wrote."""
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
    except (KeyError, TypeError, ZeroDivisionError, ValueError):
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
COVERED = 0.97  # of an outage; in others the reference itself was silent


def add_navigation(name, unit, key, about):
    less_is_better = name not in ("way", "nees", "nees_end")

    def whole(output):
        return abs(output["navigation"][key])

    def outages(output):
        scored = [o for o in output["navigation"]["outages"] if o["covered"] > COVERED]
        return [abs(o[key]) for o in scored if o[key] is not None]

    METRICS[name] = Metric(unit, whole, about, less_is_better)
    METRICS[f"outage_{name}"] = Metric(unit, outages, f"{about} In each outage.", less_is_better)


for navigation_name, how in NAVIGATION.items():
    add_navigation(navigation_name, *how)


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


@metric("s")
def named_after(output):
    """Time after which HEALTH named the sensor that is at fault."""
    return min(namings(output, True))


@metric("1")
def named_others(output):
    """How many others were named."""
    return len(namings(output, False)) if output["faults"] else len(output["named"])


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


@metric("1")
def processor(output):
    """Processor time a second of the recording."""
    return output["replay"]["cpu_s"] / output["replay"]["data_s"]


@metric("MB")
def memory(output):
    """Peak memory."""
    return output["replay"]["peak_memory_bytes"] / 1e6
