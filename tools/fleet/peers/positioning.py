#!/usr/bin/python3
"""Positions of a receiver, by maploop ppp or by RTKLIB, from the same files.

    positioning.py --program maploop|rtklib-ppp|rtklib-single --systems GE --truth FILE ... OBSERVATIONS [PRODUCTS]...
"""
import gzip
import sys
from datetime import datetime, timedelta
from pathlib import Path

import contender

NUMBERS = {"G": 1, "R": 4, "E": 8, "J": 16, "C": 32}  # of RTKLIB's pos1-navsys


def text_of(path):
    opened = gzip.open if str(path).endswith(".gz") else open
    with opened(path, "rt", encoding="latin-1") as file:
        return file.read()


def orbits_of(text, systems):
    """An SP3 file with the satellites of these systems alone: RTKLIB 2.4.3 misreads one with more than 99."""
    lines = text.splitlines()
    cells = [line[i:i + 3].strip() for line in lines if line.startswith("+ ") for i in range(9, 60, 3)]
    names = [name for name in cells if name and name[0] in systems]
    if len(names) > 99:
        raise ValueError(f"{len(names)} satellites of {systems} are more than RTKLIB reads")
    rows = [names[i:i + 17] for i in range(0, max(len(names), 85), 17)]
    heads = [f"+  {len(names) if not i else '':>3}   " + "".join(f"{name:>3}" for name in row + ["0"] * (17 - len(row)))
             for i, row in enumerate(rows)]
    accuracies = ["++       " + "  0" * 17 for _ in rows]
    kept = [line for line in lines[2:] if not line.startswith("+") and
            not (line[:1] in "PVE" and line[:3] not in ("EOF", "EP ", "EV ") and line[1:2] not in systems)]
    return "\n".join([*lines[:2], *heads, *accuracies, *kept]) + "\n"


def truth_of(o, positions):
    """The truth as a file with dates: rows of 'index,GPS second of the week,X,Y,Z' have none, so they get those of the positions."""
    rows = text_of(o.truth).splitlines()
    if "," not in rows[0]:
        return o.truth
    date = next(line for line in text_of(positions).splitlines() if not line.startswith("%"))[:10]
    day = datetime.strptime(date, "%Y/%m/%d")
    week = day - timedelta(days=day.isoweekday() % 7)
    lines = []
    for row in rows:
        cells = row.split(",")
        if cells[0].strip().isdigit():
            at = week + timedelta(seconds=float(cells[1]))
            place = "".join(f"{float(cell):15.4f}" for cell in cells[2:5])
            lines.append(f"{at:%Y/%m/%d %H:%M:%S}.{at.microsecond // 1000:03d}{place}   1  10" + "   0.0100" * 6 + "   0.00    0.0")
    truth = o.raw / "truth.pos"
    truth.write_text("%  GPST  x-ecef(m)  y-ecef(m)  z-ecef(m)\n" + "\n".join(lines) + "\n", encoding="utf-8")
    return truth


def rtklib_files(files, folder, systems):
    """The files as rnx2rtkp tells them apart, by extension; and the file of antennas apart from them."""
    inputs, antennas = [], None
    for path in map(Path, files):
        text, name = text_of(path), path.name.removesuffix(".gz")
        if "ANTENNA PCV" in text[:400] or name.endswith(".atx"):
            antennas = folder / "antennas.atx"
            with open(antennas, "a", encoding="latin-1") as file:
                file.write(text)
            continue
        if text.startswith("%=BIA"):
            continue  # it does not read Bias-SINEX
        if text.startswith("#"):
            name, text = Path(name).stem + ".sp3", orbits_of(text, systems)
        inputs.append(folder / name)
        inputs[-1].write_text(text, encoding="latin-1")
    return inputs, antennas


def rtklib(o, files):
    inputs, antennas = rtklib_files(files, o.raw, o.systems)
    settings = (Path(__file__).parent / f"{o.program}.conf").read_text(encoding="utf-8")
    settings += f"pos1-navsys={sum(NUMBERS[s] for s in o.systems)}\n"
    if antennas:
        settings += f"file-satantfile={antennas}\nfile-rcvantfile={antennas}\n"
    precise = any(path.suffix == ".sp3" for path in inputs)
    settings += f"pos1-sateph={'precise' if precise else 'brdc'}\n"
    configuration = o.raw / "rtklib.conf"
    configuration.write_text(settings, encoding="utf-8")
    return contender.run(["rnx2rtkp", "-k", configuration, "-o", o.raw / "positions.pos", *inputs], o.raw)


def main():
    parser = contender.options("Positions of a receiver, by one of these programs.",
                               ["maploop", "rtklib-ppp", "rtklib-single"])
    parser.add_argument("products", nargs="*")
    parser.add_argument("--systems", default="GE")
    o = parser.parse_args()
    o.raw = o.raw.resolve()
    recording = Path(o.recording)
    files = [*(sorted(recording.iterdir()) if recording.is_dir() else [recording]), *o.products]
    files = [f for f in files if str(f) != o.truth and Path(f).name != "truth.csv"]
    positions = o.raw / "positions.pos"
    if o.program == "maploop":
        job = contender.run([o.maploop, "ppp", *files, "--systems", o.systems, "--pos", positions], o.raw)
    else:
        job = rtklib(o, files)
    contender.score(o, positions, job, "--truth", truth_of(o, positions), "--align", "none", "--max-difference", "0.05")


if __name__ == "__main__":
    sys.exit(main())
