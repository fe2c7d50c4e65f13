#!/usr/bin/env python3
"""Read the folder of a run: its record, its histories and, with PyVista, its frames; print a summary, plot energies.

    python3 -m venv venv && venv/bin/pip install numpy pandas matplotlib pyvista
    venv/bin/python read_run.py FOLDER [--plot ENERGIES.png]

Only numpy and pandas are needed; matplotlib for --plot, pyvista for the frames of `run --vtu`. In a program:

    from read_run import read_run
    run = read_run("out/shield")
    run.record["norms"]            # numbers of the end
    run.history["sphere.vz"]       # pandas columns without units; run.units["sphere.vz"] is "cm/µs"
    run.ledger["total.kinetic"]    # in the units of the scene
    header, arrays = run.checkpoint()

Exit status: 0 fine, 2 wrong use, or a folder that is none of a run.
"""

import argparse
import json
import sys
from dataclasses import dataclass, field
from pathlib import Path

try:
    import numpy as np
    import pandas as pd
except ImportError:
    if __name__ != "__main__":
        raise
    print("read_run.py needs numpy and pandas: python3 -m pip install numpy pandas", file=sys.stderr)
    sys.exit(2)

# Units by the name of the unit system: time and energy, as they stand on axes.
UNITS = {"cm-g-us-mbar": ("µs", "Mbar cm³"), "in-lbf-s": ("s", "in lbf"), "none": ("", "")}

# Parts of the energy of the ledger: name of the columns, label, colour (Okabe and Ito), line.
PARTS = [
    ("kinetic", "kinetic", "#0072b2", "-"),
    ("internal", "internal", "#d55e00", "-"),
    ("shear", "shear of elements", "#009e73", "--"),
    ("tension", "tension of elements", "#cc79a7", "-."),
]


@dataclass
class Run:
    """What a run has left: `history` and `ledger` are None where it left none."""

    folder: Path
    record: dict
    history: pd.DataFrame | None = None
    ledger: pd.DataFrame | None = None
    units: dict = field(default_factory=dict)

    def labels(self):
        """Units of time and energy."""
        return UNITS.get((self.record.get("scene") or {}).get("units", "none"), ("", ""))

    def checkpoints(self):
        """Paths of the checkpoints, the oldest first."""
        return sorted(self.folder.glob("checkpoint-*.whp"))

    def checkpoint(self):
        """Header and arrays of the last checkpoint."""
        from read_checkpoint import read_checkpoint

        kept = self.checkpoints()
        if not kept:
            raise FileNotFoundError(f"{self.folder} has no checkpoint")
        return read_checkpoint(kept[-1])


def split(head):
    """A head such as `sphere.vz (cm/µs)` as name and unit."""
    name, _, unit = head.partition(" (")
    return name, unit.removesuffix(")")


def table(path):
    """A CSV file as a table, and the units of its columns."""
    data = pd.read_csv(path)
    units = dict(split(head) for head in data.columns)
    data.columns = list(units)
    return data, units


def read_run(folder):
    """The run in a folder, by its record."""
    folder = Path(folder)
    path = folder / "record.json"
    if not path.is_file():
        raise FileNotFoundError(f"{path} is not there: wanted the --out folder of a finished `whipple run`")
    run = Run(folder, json.loads(path.read_text(encoding="utf-8")))
    for name in ("history", "ledger"):
        if (folder / f"{name}.csv").is_file():
            data, units = table(folder / f"{name}.csv")
            setattr(run, name, data)
            run.units.update(units)
    return run


def summary(run):
    """What a reader wants to know first, line by line."""
    record = run.record
    key = record["key"]
    yield f"{key['case']} {key['variant']}".strip() + f", n = {key['n']}: {outcome(record['outcome'])}"
    yield f"made by: {record['provenance']['command']}"
    yield f"steps: {record['steps']}, CPU time: {record['cpu_seconds']:.3g} s"
    yield f"energy drift: {record['energy_drift']:.2g}, momentum drift: {record['momentum_drift']:.2g}"
    space = record.get("space") or {}
    if space:
        yield f"particles: {space['particles']}, elements: {space['elements']}, failed: {space['failed_elements']}"
        yield f"residual of elements: {space['ledger_residual']:.2g}"
    for name, value in record["norms"].items():
        yield f"  {name}: {value}"
    if run.ledger is not None:
        time, energy = run.labels()
        first, last = run.ledger.iloc[0], run.ledger.iloc[-1]
        unit = f", in {energy}" if energy else ""
        yield f"energies at t = {last['time']:g} {time}{unit}; at the start in brackets"
        for part, label, _, _ in PARTS:
            yield f"  {label}: {last[f'total.{part}']:.5g} ({first[f'total.{part}']:.5g})"
        deciders = run.ledger["limiter"].dropna().value_counts(normalize=True)
        told = ", ".join(f"{name} {share:.0%}" for name, share in deciders.items())
        yield f"rows of the ledger by who decided the time step: {told}"
    if run.history is not None:
        yield f"history: {len(run.history)} rows of {', '.join(run.history.columns)}"
    yield from frames(run)
    if run.checkpoints():
        try:
            header, arrays = run.checkpoint()
        except (ImportError, ValueError) as error:
            yield f"checkpoint: {error}"
        else:
            size = sum(array.nbytes for array in arrays.values())
            yield f"checkpoint: step {header['step']}, t = {float(header['time']):g}, {len(arrays)} arrays, {size} bytes"


def outcome(value):
    """How a run ended."""
    if isinstance(value, str):
        return value
    (kind, what), *_ = value.items()
    return f"{kind}: {what.get('message', what)}"


def frames(run):
    """What the frames hold, if there are any and PyVista is there to read them."""
    path = run.folder / "vtu" / "run.pvd"
    if not path.is_file():
        return
    try:
        import pyvista
    except ImportError:
        yield f"frames: {path}; PyVista reads them (python3 -m pip install pyvista)"
        return
    reader = pyvista.get_reader(str(path))
    times = reader.time_values
    yield f"frames: {len(times)} from t = {times[0]:g} to {times[-1]:g}"
    reader.set_active_time_value(times[-1])
    blocks = reader.read()
    for number in range(len(blocks)):
        block = blocks[number]
        if block is None or block.n_points == 0:
            continue
        names = sorted({*block.point_data.keys(), *block.cell_data.keys()})
        low, high = (np.round(block.bounds[k::2], 4) + 0.0 for k in (0, 1))
        box = ", ".join(f"{a:g} to {b:g}" for a, b in zip(low, high))
        yield f"  {block.n_points} points, {block.n_cells} cells, within {box}; fields: {', '.join(names)}"


def plot(run, path):
    """Energies over time, as a picture."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    if run.ledger is None:
        raise FileNotFoundError(f"{run.folder} has no ledger.csv, which --plot needs")
    time, energy = run.labels()
    figure, axes = pyplot.subplots(figsize=(7, 4.2), layout="constrained")
    total = 0
    for part, label, colour, line in PARTS:
        values = run.ledger[f"total.{part}"]
        total = total + values
        if values.abs().max() > 0:
            axes.plot(run.ledger["time"], values, line, color=colour, label=label)
    axes.plot(run.ledger["time"], total, ":", color="#555555", label="sum of these")
    axes.set_xlabel(f"time ({time})" if time else "time")
    axes.set_ylabel(f"energy ({energy})" if energy else "energy")
    axes.set_title(run.record["key"]["case"], loc="left", fontsize="medium")
    axes.set_ylim(bottom=0)
    axes.spines[["top", "right"]].set_visible(False)
    figure.legend(loc="outside right center", frameon=False)
    figure.savefig(path, dpi=150)
    pyplot.close(figure)


def main():
    parser = argparse.ArgumentParser(description="Summary of the folder of a run, and a plot of its energies.")
    parser.add_argument("folder", help="--out folder of a run")
    parser.add_argument("--plot", metavar="FILE", help="draw the energies over time, as PNG, SVG or PDF")
    arguments = parser.parse_args()
    try:
        run = read_run(arguments.folder)
        for line in summary(run):
            print(line)
        if arguments.plot:
            plot(run, arguments.plot)
            print(f"plot: {arguments.plot}")
    except (OSError, ImportError, KeyError, ValueError) as error:
        print(f"read_run.py: {error}", file=sys.stderr)
        sys.exit(2)


if __name__ == "__main__":
    main()
