"""Sod's shock tube by a first-order finite-volume method (Rusanov fluxes): results of "another program" to score.

Writes what many codes write: a table with blanks between columns, names with units above it. The numbers 1 of the
problem stand for 1 cm, 1 g/cm^3, 1 Mbar.

    python3 sod_first_order.py 100 > sod_first_order_100.dat
"""
import sys

GAMMA, END, CFL = 1.4, 0.2, 0.4


def primitive(state):
    rho, momentum, energy = state
    v = momentum / rho
    return rho, v, (GAMMA - 1) * (energy - 0.5 * rho * v * v)


def flux(left, right):
    sides = []
    for state in (left, right):
        rho, v, p = primitive(state)
        sides.append(((rho * v, rho * v * v + p, (state[2] + p) * v), abs(v) + (GAMMA * p / rho) ** 0.5))
    speed = max(sides[0][1], sides[1][1])
    return [0.5 * (f + g - speed * (r - l)) for f, g, l, r in zip(sides[0][0], sides[1][0], left, right)]


def main(n):
    width = 1.0 / n
    gas = [(1.0, 1.0) if (k + 0.5) * width < 0.5 else (0.125, 0.1) for k in range(n)]
    cells = [[rho, 0.0, p / (GAMMA - 1)] for rho, p in gas]
    time = 0.0
    while time < END:
        waves = (abs(v) + (GAMMA * p / rho) ** 0.5 for rho, v, p in map(primitive, cells))
        step = min(CFL * width / max(waves), END - time)
        # Nothing moves at the ends before the end time.
        padded = [cells[0]] + cells + [cells[-1]]
        fluxes = [flux(a, b) for a, b in zip(padded, padded[1:])]
        for k, cell in enumerate(cells):
            cells[k] = [u - step / width * (b - a) for u, a, b in zip(cell, fluxes[k], fluxes[k + 1])]
        time += step
    print("# first-order finite volumes, Rusanov fluxes, n =", n, "t = 0.2 us")
    print("#", "zone_centre[mm]", "rho[kg/m^3]", "vel[km/s]", "pres[GPa]", "eint[MJ/kg]")
    for k, cell in enumerate(cells):
        rho, v, p = primitive(cell)
        energy = p / (GAMMA - 1) / rho
        row = (10 * (k + 0.5) * width, 1000 * rho, 10 * v, 100 * p, 100 * energy)
        print(*(f"{value:13.6e}" for value in row))


main(int(sys.argv[1]))
