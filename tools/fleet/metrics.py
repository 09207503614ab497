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


def value(name, output):
    """The metric of a run's output; None where the run has nothing to make it of."""
    try:
        return float(METRICS[name].of(output))
    except (KeyError, TypeError, ZeroDivisionError, ValueError):
        return None


def over_100_m(output, part):
    return output[part]["common_rotation_removed"]["segment_100m_percent"]


@metric("m")
def position_rms(output):
    """Horizontal error of the map output, root mean square."""
    return output["navigation"]["rmse_m"]


@metric("m")
def position_largest(output):
    """Largest horizontal error of the map output."""
    return output["navigation"]["max_m"]


@metric("deg")
def azimuth_rms(output):
    """Error of the azimuth, root mean square."""
    return output["navigation"]["azimuth_rms_deg"]


@metric("%")
def drift(output):
    """Error at the end without the error at the start, of the way."""
    return output["navigation"]["drift_percent"]


@metric("1", less_is_better=False)
def nees(output):
    """Squared error of the position by its covariance: 2 if the covariance is right."""
    return output["navigation"]["nees_mean"]


@metric("1")
def nees_largest(output):
    """Largest squared error of the position by its covariance."""
    return output["navigation"]["nees_max"]


@metric("s")
def beyond(output):
    """Longest time for which the position was wrong by more than 3 of its own sigmas."""
    return output["navigation"]["beyond_3_sigma_s"]


@metric("s")
def azimuth_beyond(output):
    """The same of the azimuth."""
    return output["navigation"]["azimuth_beyond_3_sigma_s"]


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
