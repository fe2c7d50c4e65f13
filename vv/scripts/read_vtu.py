#!/usr/bin/env python3
"""Read a VTU/PVD collection with VTK itself, and check it against a table or the ledger of its run.

    python3 -m venv venv && venv/bin/pip install pyvista
    venv/bin/python read_vtu.py RUN.pvd [EXPECTED.csv] [--ledger LEDGER.csv] [--tolerance 1e-12]

Without a table all states must be readable. With the ledger of the run each state must have a row of its
time, the particles the mass of that row, and the elements its number of dead ones.

The table has the columns

    time,part,kind,name,count,minimum,maximum,total

with one row for each thing that a state must hold:

    kind    name                  count    minimum, maximum, total
    cells   vertices, hexahedra   cells    (empty)
    point   name of the field     points   over all components; an empty entry is not checked
    cell    name of the field     cells    over all components; an empty entry is not checked

The total of the point field `mass` is the mass of the state. Undefined values (NaN) count as
entries but not in the figures. Times, parts and field names must be exactly those of the table:
what is missing and what is extra are both failures. The tolerance is relative, to the largest
magnitude of the field for its range and to the sum of magnitudes for its total.

Exit status: 0 all as expected, 1 a difference, 2 wrong use or an unreadable file.
"""

import argparse
import csv
import sys
from collections import defaultdict
from pathlib import Path
from xml.etree import ElementTree

try:
    import numpy as np
    import pyvista as pv
except ImportError:
    print("read_vtu.py needs PyVista: python3 -m pip install pyvista", file=sys.stderr)
    sys.exit(2)

CELL_TYPES = {"vertices": pv.CellType.VERTEX, "hexahedra": pv.CellType.HEXAHEDRON}


def read_table(path):
    """Rows of the table by (time, part)."""
    wanted = defaultdict(list)
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            wanted[float(row["time"]), row["part"]].append(row)
    return wanted


def read_collection(path):
    """States of the collection by (time, part), read by VTK; and the times VTK itself sees."""
    reader = pv.PVDReader(str(path))
    states = {}
    for entry in ElementTree.parse(path).iter("DataSet"):
        key = float(entry.get("timestep")), entry.get("name")
        states[key] = pv.read(Path(path).parent / entry.get("file"))
    parts_at = defaultdict(int)
    for time, _ in states:
        parts_at[time] += 1
    for time, parts in parts_at.items():
        reader.set_active_time_value(time)
        blocks = reader.read()
        if blocks.n_blocks != parts:
            raise SystemExit(f"{path}: VTK reads {blocks.n_blocks} parts at {time}, listed {parts}")
    return states, list(reader.time_values)


def check_field(row, values, tolerance):
    """Differences between one row and the values of its field."""
    if len(values) != int(row["count"]):
        yield f"has {len(values)} entries, wanted {row['count']}"
    values = np.asarray(values, dtype=np.float64).ravel()
    values = values[~np.isnan(values)]
    size = np.abs(values)
    figures = {
        "minimum": (values.min(initial=np.inf), size.max(initial=0.0)),
        "maximum": (values.max(initial=-np.inf), size.max(initial=0.0)),
        "total": (values.sum(), size.sum()),
    }
    for figure, (found, scale) in figures.items():
        if row[figure] == "":
            continue
        found, wanted = float(found), float(row[figure])
        if found != wanted and not abs(found - wanted) <= tolerance * scale:
            yield f"{figure} is {found!r}, wanted {wanted!r}"


def check_ledger(rows, grid, time, tolerance):
    """Differences between a state and the row of its time."""
    if time not in rows:
        yield "no row of its time in the ledger"
        return
    row = rows[time]
    if "mass" in grid.point_data:
        found, wanted = float(grid.point_data["mass"].sum()), float(row["total.mass"])
        # The order of the sums differs.
        if not abs(found - wanted) <= max(tolerance, 1e-12) * wanted:
            yield f"mass is {found!r}, in the ledger {wanted!r}"
    if "live" in grid.cell_data:
        found, wanted = int((grid.cell_data["live"] == 0).sum()), int(row["dead_elements"])
        if found != wanted:
            yield f"has {found} dead elements, in the ledger {wanted}"


def check_state(rows, grid, time, tolerance):
    """Differences between the rows of one state and the state."""
    stamp = grid.field_data.get("TimeValue")
    if stamp is None or stamp[0] != time:
        yield f"TimeValue is {stamp}, wanted {time!r}"
    data = {"point": grid.point_data, "cell": grid.cell_data}
    for kind, fields in data.items():
        names = {row["name"] for row in rows if row["kind"] == kind}
        for name in names.symmetric_difference(fields.keys()):
            yield f"{kind} field {name!r} is {'missing' if name in names else 'not in the table'}"
    for row in rows:
        kind, name = row["kind"], row["name"]
        if kind == "cells":
            found = int(np.count_nonzero(grid.celltypes == CELL_TYPES[name]))
            if found != int(row["count"]):
                yield f"has {found} {name}, wanted {row['count']}"
        elif name in data[kind]:
            for difference in check_field(row, data[kind][name], tolerance):
                yield f"{kind} field {name!r} {difference}"
    counted = sum(int(row["count"]) for row in rows if row["kind"] == "cells")
    if counted != grid.n_cells:
        yield f"has {grid.n_cells} cells, wanted {counted}"
    if not grid.n_cells or CELL_TYPES["hexahedra"] not in grid.celltypes:
        return
    solid = grid.extract_cells(grid.celltypes == CELL_TYPES["hexahedra"])
    volumes = solid.compute_cell_sizes(length=False, area=False)["Volume"]
    if volumes.min() <= 0.0:
        print(f"note: {np.count_nonzero(volumes <= 0.0)} hexahedra have no positive volume")


def main():
    parser = argparse.ArgumentParser(description="Read a VTU/PVD collection with VTK.")
    parser.add_argument("collection", type=Path, help="the .pvd file")
    parser.add_argument("table", type=Path, nargs="?", help="what it must hold, as .csv file")
    parser.add_argument("--ledger", type=Path, help="the ledger.csv of the run")
    parser.add_argument("--tolerance", type=float, default=1e-12, help="relative tolerance")
    options = parser.parse_args()
    try:
        states, times = read_collection(options.collection)
        wanted = read_table(options.table) if options.table else {key: None for key in states}
        ledger = None
        if options.ledger:
            with open(options.ledger, newline="", encoding="utf-8") as file:
                ledger = {float(row["time"]): row for row in csv.DictReader(file)}
    except (OSError, KeyError, ValueError, RuntimeError, ElementTree.ParseError) as error:
        print(f"cannot read: {error}", file=sys.stderr)
        return 2
    failures = 0
    if times != sorted({time for time, _ in wanted}):
        failures += 1
        print(f"FAIL times are {times}, wanted {sorted({time for time, _ in wanted})}")
    for key in sorted(wanted.keys() | states.keys()):
        time, part = key
        if key not in states or key not in wanted:
            differences = ["missing" if key in wanted else "not in the table"]
        else:
            differences = []
            if wanted[key] is not None:
                differences += check_state(wanted[key], states[key], time, options.tolerance)
            if ledger is not None:
                differences += check_ledger(ledger, states[key], time, options.tolerance)
        failures += len(differences)
        for difference in differences:
            print(f"FAIL t = {time!r}, {part}: {difference}")
        if not differences:
            grid = states[key]
            mass = float(grid.point_data["mass"].sum()) if "mass" in grid.point_data else None
            told = "" if mass is None else f", mass {mass!r}"
            print(f"ok   t = {time!r}, {part}: {grid.n_points} points, {grid.n_cells} cells{told}")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
