#!/usr/bin/env python3
"""tools/lcm-spy shows every channel, decoded: looked at on a screen in memory.

    lcm_spy_test.py PUBLISHER LCM_SPY PICTURES

PUBLISHER sends one message of every type on the vehicle's channels, LCM_SPY is the script under test;
the pictures looked at are kept in the folder PICTURES. Everything runs in a network namespace of its
own, so that no other LCM traffic of this machine is seen or disturbed. Exit status 77: skipped, with
the reason.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time

sys.path.append(os.path.join(os.path.dirname(__file__), "../.."))
import own_network

PATIENCE = 60.0  # s, for any one thing to appear; a loaded machine is slow
SCALE = 2  # of the spy's window, so that its text can be read from a picture
SCREEN = (3000, 1300)
WINDOW = (800 * SCALE, 600 * SCALE)  # the spy's own size

# Each channel with its type and a field near the top of the window of decoded fields.
CHANNELS = {
    "DEADLINES": ("deadlines_t", "deadline_us"),
    "GNSS_FIX": ("gnss_fix_t", "latitude"),
    "HEALTH": ("health_t", "scheduling"),
    "IMU": ("imu_t", "yaw_rate"),
    "LIDAR_ODOMETRY": ("lidar_motion_t", "translation"),
    "MAP_DOUBT": ("map_doubt_t", "explanation"),
    "MAP_FEEDBACK": ("map_feedback_t", "cross_track"),
    "MAP_MATCH": ("map_match_t", "explanation"),
    "NAV_PROTECTION": ("nav_protection_t", "doubted"),
    "NAV_STATE": ("nav_state_t", "origin_latitude"),
    "ODOMETRY": ("relative_motion_t", "translation"),
    "PPP_STATE": ("ppp_state_t", "latitude"),
    "PREVIEW": ("preview_t", "track_count"),
    "SELF_CALIBRATION": ("self_calibration_t", "sigma_at_start"),
    "TRUTH": ("reference_pose_t", "azimuth"),
    "WHEEL_SPEED": ("wheel_speed_t", "sigma"),
    "VO": ("relative_motion_t", "translation"),
}
TOOLS = ["ip", "unshare", "setpriv", "Xvfb", "import", "convert", "tesseract", "xdotool", "java", "javac"]


class Failure(Exception):
    pass


def wait_for(what, look):
    """The first true value of look(), or a Failure after PATIENCE."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        found = look()
        if found:
            return found
        time.sleep(0.2)
    raise Failure(f"waited {PATIENCE:.0f} s in vain for {what}")


def start_screen(children):
    """Starts an X server on the first free number, and gives the number."""
    read, write = os.pipe()
    server = children.start("Xvfb", "-displayfd", str(write), "-nolisten", "tcp", "-screen", "0",
                            f"{SCREEN[0]}x{SCREEN[1]}x24", pass_fds=[write],
                            stderr=subprocess.DEVNULL)
    os.close(write)
    with os.fdopen(read) as answer:
        number = answer.readline().strip()
    if not number:
        raise Failure(f"Xvfb ended with status {server.wait()}")
    return f":{number}"


def read_text(picture, area):
    """The words in a part (width, height, x, y) of the screen; blanks and _ are left out, since
    character recognition confuses them."""
    width, height, x, y = area
    # The grid's lines are lighter than the text, and disappear.
    with tempfile.NamedTemporaryFile(suffix=".png") as clean:
        subprocess.run(["convert", picture, "-crop", f"{width}x{height}+{x}+{y}", "+repage", "-colorspace",
                        "gray", "-threshold", "45%", clean.name], check=True)
        text = subprocess.run(["tesseract", clean.name, "-", "--psm", "6"], check=True, text=True,
                              capture_output=True, env={**os.environ, "OMP_THREAD_LIMIT": "1"}).stdout
    return [squeeze(line) for line in text.splitlines() if line.strip()]


def squeeze(text):
    return re.sub(r"[\s_]", "", text)


def photograph(folder, name):
    picture = os.path.join(folder, name)
    subprocess.run(["import", "-window", "root", picture], check=True)
    return picture


def wait_for_channels(spy, pictures):
    """The table's rows, once every channel and its type are in it."""
    seen = []

    def look():
        if spy.poll() is not None:
            raise Failure(f"lcm-spy ended with status {spy.returncode}")
        seen[:] = read_text(photograph(pictures, "channels.png"), (*WINDOW, 0, 0))
        return all(any(row.startswith(squeeze(channel + kind)) for row in seen)
                   for channel, (kind, _) in CHANNELS.items())

    try:
        wait_for("every channel in lcm-spy's table", look)
    except Failure as failure:
        raise Failure(f"{failure}; it reads: {seen}") from None


def xdotool(*command):
    return subprocess.run(["xdotool", *command], capture_output=True, text=True).stdout.split()


def check_decoded_fields(row, channel, field, pictures):
    """A double click on the channel's row opens a window with its fields."""
    kind = CHANNELS[channel][0]
    header, height = 20 * SCALE, 16 * SCALE

    def open_window():
        xdotool("mousemove", str(20 * SCALE), str(header + row * height + height // 2), "click",
                "--repeat", "2", "--delay", "80", "1")
        for _ in range(25):  # 5 s: on a loaded machine two clicks may not count as a double one
            found = xdotool("search", "--onlyvisible", "--name", f"^{channel}$")
            if found:
                return found[0]
            time.sleep(0.2)
        return None

    window = wait_for(f"the window of {channel}", open_window)
    seen = []

    def look():
        # Off the table and to the front; again each time, for Java may place it after it is shown.
        xdotool("windowmove", window, str(WINDOW[0]), "0", "windowraise", window)
        picture = photograph(pictures, f"{channel.lower()}.png")
        seen[:] = read_text(picture, (SCREEN[0] - WINDOW[0], 800, WINDOW[0], 0))
        text = "".join(seen)
        return squeeze(kind) in text and squeeze(field) in text

    try:
        wait_for(f"the field '{field}' of {channel}", look)
    except Failure as failure:
        raise Failure(f"{failure}; its window reads: {seen}") from None


def check_refusals(lcm_spy):
    """Without a screen or without Java it says what to do."""
    environment = {key: value for key, value in os.environ.items() if key != "DISPLAY"}
    with tempfile.TemporaryDirectory() as bare:
        for program in ("bash", "dirname", "sed", "cat"):
            os.symlink(shutil.which(program), os.path.join(bare, program))
        for what, path, remedy in (("no screen", os.environ["PATH"], "xvfb-run"),
                                   ("no Java", bare, "tools/install-packages watch")):
            done = subprocess.run([lcm_spy], env={**environment, "PATH": path}, text=True,
                                  capture_output=True, timeout=PATIENCE)
            if done.returncode == 0 or remedy not in done.stderr:
                raise Failure(f"{what}: status {done.returncode}, it says: {done.stderr}")


def run(publisher, lcm_spy, pictures):
    os.makedirs(pictures, exist_ok=True)
    check_refusals(lcm_spy)
    with tempfile.TemporaryDirectory() as cache, own_network.Children() as children:
        os.environ["DISPLAY"] = start_screen(children)
        os.environ.pop("LCM_DEFAULT_URL", None)
        children.start(publisher, "500")
        spy = children.start(lcm_spy, env={**os.environ, "MAPLOOP_CACHE": cache,
                                           "JAVA_TOOL_OPTIONS": f"-Dsun.java2d.uiScale={SCALE}"})
        wait_for_channels(spy, pictures)
        for row, (channel, (_, field)) in enumerate(sorted(CHANNELS.items())):
            check_decoded_fields(row, channel, field, pictures)
        compiled = os.listdir(cache)
        if len(compiled) != 1 or not compiled[0].endswith(".jar"):
            raise Failure(f"the cache should hold the types' jar alone, but holds {compiled}")
    print(f"{len(CHANNELS)} channels shown with decoded fields; pictures in {pictures}")


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    missing = [tool for tool in TOOLS if shutil.which(tool) is None]
    if missing:
        own_network.skip(f"not installed: {', '.join(missing)}; run tools/install-packages watch test")
    own_network.enter()
    try:
        run(*sys.argv[1:])
    except Failure as failure:
        sys.exit(f"FAILED: {failure}")


if __name__ == "__main__":
    main()
